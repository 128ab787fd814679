//! Radiance along a ray: a path with next-event estimation.
//!
//! ```text
//! L(x, v) = Lₑ + ∫ f(v, l) L(x, l) dl        the rendering equation (Kajiya 1986), f with the cosine
//! ```
//!
//! At each vertex one light is chosen and one of its points is tested, and one direction is drawn by the surface's
//! reflection. Light found both ways is weighted by the power heuristic w = p² / (p² + q²), with p the density of
//! the way that found it and q that of the other (Veach 1997). From the fourth reflection on a path ends with a
//! probability that its weight determines (Russian roulette). Nothing is clamped, so the mean of many paths is exact.
//!
//! Glass and blended surfaces have straight transmission. A ray goes on behind them as the same ray, with the density of the
//! vertex where its direction was drawn, so light behind them is found both ways too. Lamps and the scenario's
//! rectangle are not seen by the camera and hide nothing, as in the live picture.

use std::ops::Range;

use glam::Vec3;

use super::super::gallery::Gallery;
use super::super::scene::SurfaceKind;
use super::bsdf::Bsdf;
use super::gloss::AlbedoTable;
use super::lights::{Light, MAX_LIGHTS, Rectangle};
use super::sequence::Sequence;
use super::walls;
use super::world::{World, leave};

/// Reflections after which Russian roulette begins.
const ROULETTE_AFTER: u32 = 3;
/// Largest probability of going on.
const LONGEST_ODDS: f32 = 0.95;
/// Probabilities between which a ray at glass goes on straight.
const THROUGH: [f32; 2] = [0.1, 0.9];
/// Straight crossings after which a path is given up: more than any glass here has, a bound on rounding alone.
const MAX_CROSSINGS: u32 = 256;

/// Everything that a path meets.
pub(super) struct Stage<'a> {
    /// The exhibit.
    pub world: &'a World<'a>,
    /// Without one, rays end in the sky.
    pub gallery: Option<&'a Gallery>,
    /// The fields of the gallery come first, in its order.
    pub lights: &'a [Light],
    /// Number of wide lights, which come before lamps and punctual lights: rectangles and the sky.
    pub wide: usize,
    /// Index of the sky among the lights.
    pub sky: Option<usize>,
    /// What the camera sees where there is nothing.
    pub background: Vec3,
    /// The split-sum table.
    pub table: &'a AlbedoTable,
    /// Has the floor of the gallery its varnish? Radiosity is without.
    pub varnish: bool,
    /// Largest coordinate, m: rays are moved off surfaces by its rounding.
    pub scale: f32,
}

/// Where a direction was drawn.
struct Vertex {
    position: Vec3,
    /// Density per solid angle with which the direction was drawn.
    density: f32,
    chances: [f32; MAX_LIGHTS],
}

impl Vertex {
    /// Weight of light that the drawn direction found, where choosing the light has this density.
    fn weight(&self, light: usize, density: f32) -> f32 {
        power(self.density, self.chances[light] * density)
    }
}

/// The power heuristic for what was found with density `p`.
fn power(p: f32, q: f32) -> f32 {
    let r = q / p;
    1.0 / (1.0 + r * r)
}

/// What a path meets at a point.
struct Met {
    point: Vec3,
    bsdf: Bsdf,
    /// Emitted towards the viewer, weighted.
    glow: Vec3,
    /// What goes on straight through glass.
    through: Option<Vec3>,
}

/// What a ray meets.
#[expect(clippy::large_enum_variant, reason = "it lives on the stack, one at a time")]
enum Event {
    /// Light that ends the path, weighted.
    End(Vec3),
    /// A blended surface that is not there for this path: the point and its normal.
    Gap(Vec3, Vec3),
    /// A surface.
    Surface(Met),
}

impl Stage<'_> {
    /// Radiance that arrives at `origin` against the unit direction.
    pub fn radiance(&self, mut origin: Vec3, mut direction: Vec3, sequence: &mut Sequence) -> Vec3 {
        let (mut sum, mut carried) = (Vec3::ZERO, Vec3::ONE);
        let mut last: Option<Vertex> = None;
        let (mut reflections, mut crossings) = (0, 0);
        while crossings < MAX_CROSSINGS {
            let met = match self.meet(origin, direction, last.as_ref(), sequence) {
                (light, Event::End(end)) => return sum + carried * (light + end),
                (light, Event::Gap(point, normal)) => {
                    sum += carried * light;
                    origin = leave(point, normal, direction, self.scale);
                    crossings += 1;
                    continue;
                }
                (light, Event::Surface(met)) => {
                    sum += carried * (light + met.glow);
                    met
                }
            };
            let Met { point, bsdf, through, .. } = met;
            let [choice, u, v, straight] = sequence.next();
            let chances = if last.is_none() {
                // What the camera sees has a sample of each kind of light.
                let groups = [0..self.wide, self.wide..self.lights.len()];
                let chances = self.chances(point, &bsdf, &groups);
                let [a, b, c, _] = sequence.next();
                sum += carried * self.direct(point, &bsdf, &chances, &groups[0], [a, b, c]);
                sum += carried * self.direct(point, &bsdf, &chances, &groups[1], [choice, u, v]);
                chances
            } else {
                let all = 0..self.lights.len();
                let chances = self.chances(point, &bsdf, std::slice::from_ref(&all));
                sum += carried * self.direct(point, &bsdf, &chances, &all, [choice, u, v]);
                chances
            };
            if let Some(through) = through {
                let most = through.max_element();
                let odds = (most / (most + bsdf.albedo).max(1e-6)).clamp(THROUGH[0], THROUGH[1]);
                if straight < odds {
                    carried *= through / odds;
                    if carried == Vec3::ZERO {
                        return sum;
                    }
                    origin = leave(point, bsdf.facing, direction, self.scale);
                    crossings += 1;
                    continue;
                }
                carried /= 1.0 - odds;
            }
            let [choice, u, v, end] = sequence.next();
            let drawn = bsdf.draw([choice, u, v]);
            let (f, density) = bsdf.value(drawn);
            if density <= 0.0 || f == Vec3::ZERO {
                return sum;
            }
            carried *= f / density;
            reflections += 1;
            if reflections > ROULETTE_AFTER {
                let odds = carried.max_element().min(LONGEST_ODDS);
                if end >= odds {
                    return sum;
                }
                carried /= odds;
            }
            origin = leave(point, bsdf.facing, drawn, self.scale);
            direction = drawn;
            last = Some(Vertex { position: point, density, chances });
        }
        sum
    }

    /// Light that the ray crosses on its way, and what it meets.
    fn meet(&self, origin: Vec3, direction: Vec3, last: Option<&Vertex>, sequence: &mut Sequence) -> (Vec3, Event) {
        let hit = self.world.nearest(origin, direction, last.is_none());
        let far = hit.as_ref().map_or(f32::INFINITY, |hit| hit.distance);
        let wall = self.gallery.and_then(|gallery| Some((gallery, walls::hit(gallery, origin, direction)?)));
        let view = -direction;
        if let Some((gallery, wall)) = wall
            && wall.distance < far
        {
            let light = self.crossed(last, origin, direction, wall.distance);
            let point = origin + direction * wall.distance;
            let mut glow = Vec3::ZERO;
            for field in wall.fields(gallery) {
                let Light::Rectangle(Rectangle { of, area, .. }) = &self.lights[field] else { continue };
                let seen = area * view.dot(wall.normal);
                let weight = |last: &Vertex| last.weight(field, last.position.distance_squared(point) / seen);
                glow += of.radiance * last.map_or(1.0, weight);
            }
            let bsdf = wall.bsdf(view, gallery.half.y, self.varnish.then_some(self.table));
            return (light, Event::Surface(Met { point, bsdf, glow, through: None }));
        }
        let light = self.crossed(last, origin, direction, far);
        let Some(hit) = hit else { return (light, Event::End(self.beyond(last, direction))) };
        let (surface, point) = (&hit.surface, origin + direction * hit.distance);
        // A blended surface is there with the probability alpha.
        if hit.kind == SurfaceKind::Blend && sequence.next()[0] >= surface.alpha {
            return (light, Event::Gap(point, surface.facing));
        }
        if surface.unlit {
            return (light, Event::End(surface.albedo));
        }
        let through = (hit.kind == SurfaceKind::Glass).then(|| surface.transmittance(view));
        let bsdf = Bsdf::new(surface, view, self.table);
        (light, Event::Surface(Met { point, bsdf, glow: surface.glow, through }))
    }

    /// Weighted light of the lamps and rectangles that a drawn ray crosses in free space.
    fn crossed(&self, last: Option<&Vertex>, origin: Vec3, direction: Vec3, far: f32) -> Vec3 {
        let Some(last) = last else { return Vec3::ZERO };
        let fields = self.gallery.map_or(0, |gallery| gallery.fields.len());
        let mut sum = Vec3::ZERO;
        for (index, light) in self.lights.iter().enumerate().skip(fields) {
            if let Some((radiance, density, t)) = light.crossed(origin, direction, far) {
                let d2 = last.position.distance_squared(origin + direction * t);
                sum += radiance * last.weight(index, density * d2);
            }
        }
        sum
    }

    /// Weighted light from beyond everything.
    fn beyond(&self, last: Option<&Vertex>, direction: Vec3) -> Vec3 {
        let Some(last) = last else { return self.background };
        let Some((index, Light::Sky(sky))) = self.sky.map(|index| (index, &self.lights[index])) else {
            return Vec3::ZERO;
        };
        sky.radiance(direction) * last.weight(index, sky.density(direction))
    }

    /// Probabilities with which the lights are chosen at a point, each group by itself; 0 where it is dark.
    fn chances(&self, point: Vec3, bsdf: &Bsdf, groups: &[Range<usize>]) -> [f32; MAX_LIGHTS] {
        let mut chances = [0.0; MAX_LIGHTS];
        for group in groups {
            let chances = &mut chances[group.clone()];
            let mut sum = 0.0;
            for (chance, light) in chances.iter_mut().zip(&self.lights[group.clone()]) {
                *chance = light.estimate(point, bsdf.facing);
                sum += *chance;
            }
            if sum > 0.0 {
                chances.iter_mut().for_each(|chance| *chance /= sum);
            }
        }
        chances
    }

    /// Reflected light of one point of one light of a group.
    fn direct(
        &self,
        point: Vec3,
        bsdf: &Bsdf,
        chances: &[f32; MAX_LIGHTS],
        group: &Range<usize>,
        [choice, u, v]: [f32; 3],
    ) -> Vec3 {
        let mut before = 0.0;
        for (light, &chance) in self.lights[group.clone()].iter().zip(&chances[group.clone()]) {
            if choice >= before + chance {
                before += chance;
                continue;
            }
            let Some(sample) = light.draw(point, [u, v]) else { return Vec3::ZERO };
            let (f, density) = bsdf.value(sample.direction);
            if f == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let weight = sample.density.map_or(1.0, |p| power(chance * p, density));
            let origin = leave(point, bsdf.facing, sample.direction, self.scale);
            let seen = self.world.transmittance(origin, sample.direction, sample.distance);
            return f * sample.weighted * seen * (weight / chance);
        }
        Vec3::ZERO
    }
}
