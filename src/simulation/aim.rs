//! Where the breath goes: from the pointer to lips before the sculpture.
//!
//! The lips lie on the camera ray of the pointer, `distance` before the plane through the view's target that faces
//! the eye. In the *true* profile the breath follows the ray. In the *gallery* profile it leans towards the nearest
//! surface when the ray passes it by, as a visitor leans to blow at a thing: without it, a breath at the centre of
//! the picture could pass between the plates and move nothing.
//!
//! Pointer and finger say where; a stick says which way: it pushes the place it finds, which then stays until a pointer
//! takes it over.

use super::Profile;
use crate::exhibit::View;
use crate::math::{DVec3, exp};

/// A surface to lean towards: the ball around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AimTarget {
    /// World, m.
    pub center: DVec3,
    /// m.
    pub radius: f64,
}

/// Another surface must be nearer to the ray by this share before the breath leaves the one it leans to.
const LOYALTY: f64 = 0.7;
/// The ray itself is followed within this share of a surface's ball. Farther out a long plate leaves most of its ball
/// to the air, so there the breath slides back towards the middle.
const INNER: f64 = 0.5;
/// A ray that misses the ball altogether is drawn this near to the middle: on the surface, wherever it has turned.
const MIDDLE: f64 = 0.2;
/// The lean follows its goal with this time constant, s: no jumps while blowing.
const LEAN_TIME: f64 = 0.08;

/// A stick held over crosses the height of the picture in this time, s.
const STICK_TIME: f64 = 1.4;
/// A stick deflected by less than this rests.
const STICK_REST: f64 = 0.12;

/// Where in the picture the breath is pointed: by pointer, finger or stick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pointing {
    steered: Option<[f64; 2]>,
}

impl Pointing {
    /// Picture coordinates after `dt` seconds, given the pointer's and the stick's deflection (right and down, −1 … 1).
    /// Without either it is the centre.
    pub fn follow(&mut self, pointer: Option<[f64; 2]>, stick: [f64; 2], aspect: f64, dt: f64) -> [f64; 2] {
        let deflection = (stick[0] * stick[0] + stick[1] * stick[1]).sqrt();
        // Written so that what is not a number rests.
        if deflection > STICK_REST && deflection.is_finite() {
            let from = self.steered.or(pointer).unwrap_or(CENTER);
            // Beyond the rest it begins from nothing, and a corner is no faster than a side.
            let speed = (deflection.min(1.0) - STICK_REST) / (1.0 - STICK_REST) / deflection / STICK_TIME;
            let to = [from[0] + dt * speed * stick[0] / aspect, from[1] + dt * speed * stick[1]];
            self.steered = Some(to.map(|x| x.clamp(0.0, 1.0)));
        } else if pointer.is_some() {
            self.steered = None;
        }
        self.steered.or(pointer).unwrap_or(CENTER)
    }
}

/// The middle of the picture.
const CENTER: [f64; 2] = [0.5, 0.5];

/// The breath's axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Aim {
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Unit.
    pub direction: DVec3,
    /// Where the axis comes nearest to what it is aimed at, world, m.
    pub target: DVec3,
    chosen: Option<usize>,
}

impl Aim {
    /// Follows the sight line through the pointer (origin and unit direction) for `dt` seconds.
    pub fn follow(
        &mut self,
        view: &View,
        (origin, ray): (DVec3, DVec3),
        distance: f64,
        profile: Profile,
        targets: &[AimTarget],
        dt: f64,
    ) {
        let facing = (view.eye - view.target).normalize();
        let depth = (view.target - origin).dot(facing) / ray.dot(facing);
        let on_plane = origin + depth * ray;
        let mouth = on_plane - distance * ray;
        let goal = match profile {
            Profile::True => on_plane,
            Profile::Gallery => self.lean(origin, ray, targets).unwrap_or(on_plane),
        };
        let direction = (goal - mouth).try_normalize().unwrap_or(ray);
        let first = self.direction == DVec3::ZERO;
        let share = if first { 1.0 } else { 1.0 - exp(-dt / LEAN_TIME) };
        self.mouth = mouth;
        self.direction = self.direction.lerp(direction, share).try_normalize().unwrap_or(direction);
        self.target = mouth + self.direction * (goal - mouth).dot(self.direction);
    }

    /// The point of the chosen surface's ball that the breath goes to. How far a surface is off the ray counts in
    /// its own radii: a large plate draws a breath from farther than a small one.
    fn lean(&mut self, origin: DVec3, ray: DVec3, targets: &[AimTarget]) -> Option<DVec3> {
        let offset = |t: &AimTarget| {
            let from = t.center - origin;
            from - from.dot(ray) * ray
        };
        let miss = |index: usize| offset(&targets[index]).length() / targets[index].radius;
        let nearest = (0..targets.len()).min_by(|&a, &b| miss(a).total_cmp(&miss(b)))?;
        let keep = self.chosen.filter(|&old| old < targets.len() && miss(old) * LOYALTY < miss(nearest));
        let chosen = keep.unwrap_or(nearest);
        self.chosen = Some(chosen);
        let target = &targets[chosen];
        let off = offset(target);
        let miss = miss(chosen);
        let back = INNER - (INNER - MIDDLE) * (miss - INNER) / (1.0 - INNER);
        let kept = miss.min(back.max(MIDDLE));
        Some(target.center - off.normalize_or_zero() * (kept * target.radius))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1.0 / 240.0;

    #[test]
    fn a_stick_pushes_the_place_and_a_pointer_takes_it_over() {
        let mut pointing = Pointing::default();
        assert_eq!(pointing.follow(None, [0.0; 2], 16.0 / 9.0, DT), CENTER);
        assert_eq!(pointing.follow(Some([0.2, 0.3]), [0.05, 0.0], 16.0 / 9.0, DT), [0.2, 0.3], "a stick at rest");
        let steps = (0.7 / DT) as usize;
        let mut at = CENTER;
        for _ in 0..steps {
            at = pointing.follow(None, [0.0, -1.0], 16.0 / 9.0, DT);
        }
        // Half the height in half the time that the whole takes.
        assert!(at[1].abs() < 1e-2 && at[0] == 0.5, "{at:?}");
        assert_eq!(pointing.follow(None, [0.0; 2], 16.0 / 9.0, DT), at, "it stays");
        assert_eq!(pointing.follow(Some([0.9, 0.9]), [0.0; 2], 16.0 / 9.0, DT), [0.9, 0.9]);
        for _ in 0..10 * steps {
            at = pointing.follow(None, [3.0, f64::MAX.sqrt() * 0.1], 16.0 / 9.0, DT);
            assert!(at.iter().all(|x| (0.0..=1.0).contains(x)), "{at:?}");
        }
        assert_eq!(pointing.follow(Some([0.4, 0.6]), [f64::NAN, 0.0], 16.0 / 9.0, DT), [0.4, 0.6]);
    }
}
