//! Reference pictures: an unbiased path tracer of the same scene as the live picture.
//!
//! It judges the live picture in tests, and it draws golden pictures and posters. Geometry, materials, lamps and tone
//! curve are the live picture's, read from the same values. What the live picture approximates is computed here
//! instead: reflections between all surfaces, soft shadows, glass in front of glass, mirrors that show the exhibit.
//!
//! | file | holds |
//! |---|---|
//! | `path` | the estimator: one path per sample |
//! | `sequence` | random numbers: scrambled Sobol points |
//! | `lights` | lamps, rectangles, punctual lights and the sky, as they are sampled |
//! | `bsdf`, `gloss` | reflection: its value, and directions by its density |
//! | `camera` | view rays through the filter of a pixel |
//! | `material`, `texture` | materials at a point, textures |
//! | `world`, `rod` | triangles and wires at the poses of a frame, for rays |
//! | `walls` | the gallery's box |
//!
//! A picture is the mean radiance under each pixel's filter, then exposure and tone curve. Left out are dust, which only
//! the live picture shows, and dither.
//!
//! Each number depends on the pixel and the sample alone, so a picture has the same bits for any number of threads.

mod bsdf;
mod camera;
mod gloss;
mod lights;
mod material;
mod path;
mod rod;
mod sequence;
#[cfg(test)]
mod tests;
mod texture;
mod walls;
mod world;

use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::{Mat4, Vec3};

use super::environment::Environment;
use super::frames::rows;
use super::gallery::Gallery;
use super::punctual::Punctual;
use super::scene::Scene;
use super::textures::to_srgb;
use super::tone::tone_mapped;
use super::vertex::Vertex;
use super::wires::Lines;
use super::{FrameInput, Lighting, RenderError};
use camera::Camera;
use gloss::AlbedoTable;
use lights::{Light, MAX_LIGHTS, Rectangle, Sky};
use material::Materials;
use path::Stage;
use rod::Rod;
use sequence::Sobol;
use soffio_exhibit::Exhibit;
use soffio_math::Pose;
use world::World;

/// Largest side of a picture, pixels: a poster of 1.3 m at 300 dpi.
const LARGEST_SIDE: u32 = 16_384;

/// Quality of a reference picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Paths per pixel; powers of two are stratified best.
    pub samples: u32,
    /// Threads; `None` takes one for each processor. The picture does not depend on it.
    pub threads: Option<usize>,
}

impl Default for Settings {
    /// 256 paths: noise of about 1 % on the walls of the gallery.
    fn default() -> Self {
        Self { samples: 256, threads: None }
    }
}

/// Draws reference pictures of one exhibit.
pub struct Reference<'a> {
    exhibit: &'a Exhibit,
    lighting: Lighting,
    scene: Scene,
    gallery: Gallery,
    materials: Materials<'a>,
    lines: Lines,
    table: AlbedoTable,
    /// Wide lights, then lamps and punctual lights.
    lights: Vec<Light>,
    wide_lights: usize,
    /// Number of those that do not move; they come first.
    fixed_lights: usize,
    sky: Option<usize>,
}

impl<'a> Reference<'a> {
    /// Prepares an exhibit under a lighting.
    ///
    /// # Errors
    /// The exhibit has more bodies than the live picture can draw.
    pub fn new(exhibit: &'a Exhibit, lighting: &Lighting) -> Result<Self, RenderError> {
        let mut scene = Scene::new(exhibit)?;
        scene.skins.iter_mut().for_each(|skin| skin.fill(&scene.vertices));
        let gallery = Gallery::around(exhibit);
        let mut lights = Vec::new();
        let mut sky = None;
        if lighting.background.is_some() {
            let environment = match &lighting.environment {
                Some(environment) => environment.clone(),
                None => Environment::new(|direction| gallery.radiance(direction)).into(),
            };
            sky = Some(0);
            lights.push(Light::Sky(Sky::new(environment, lighting.env_intensity)));
        } else {
            lights.extend(walls::fields(&gallery).into_iter().map(|field| Light::Rectangle(Rectangle::new(field))));
        }
        lights.extend(lighting.area_light.map(|area| Light::Rectangle(Rectangle::new(area))));
        let wide_lights = lights.len();
        if lighting.background.is_none() {
            lights.extend(gallery.lamps.map(Light::Lamp));
        }
        Ok(Self {
            exhibit,
            lighting: lighting.clone(),
            scene,
            gallery,
            materials: Materials::new(&exhibit.model),
            lines: Lines::new(exhibit),
            table: AlbedoTable::new(),
            fixed_lights: lights.len(),
            wide_lights,
            lights,
            sky,
        })
    }

    /// Draws one frame. `progress` receives the number of finished rows, from any thread.
    ///
    /// # Errors
    /// The picture has no pixels, or a side beyond 16 384.
    pub fn picture(
        &mut self,
        frame: &FrameInput,
        settings: Settings,
        progress: &(dyn Fn(u32) + Sync),
    ) -> Result<image::RgbaImage, RenderError> {
        let light = self.radiance(frame, settings, progress)?;
        let (width, height) = frame.size;
        Ok(image::RgbaImage::from_fn(width, height, |x, y| {
            let shown = tone_mapped(light[(y * width + x) as usize] * frame.exposure, self.lighting.tonemap);
            let [r, g, b] = shown.to_array().map(|c| (255.0 * to_srgb(c) + 0.5) as u8);
            image::Rgba([r, g, b, 255])
        }))
    }

    /// Mean radiance of each pixel, row by row, relative to exposure 1.
    ///
    /// # Errors
    /// As [`Self::picture`].
    pub fn radiance(
        &mut self,
        frame: &FrameInput,
        settings: Settings,
        progress: &(dyn Fn(u32) + Sync),
    ) -> Result<Vec<Vec3>, RenderError> {
        let (width, height) = frame.size;
        if width == 0 || height == 0 || width.max(height) > LARGEST_SIDE {
            return Err(RenderError::Size { width, height, limit: LARGEST_SIDE });
        }
        self.place_lights(frame);
        let vertices = self.vertices(frame);
        let mut segments = Vec::with_capacity(self.lines.count());
        let start: Vec<Pose> = self.exhibit.bodies.iter().map(|body| body.pose).collect();
        self.lines.fill(&start, frame.poses, frame.curves, frame.view.eye.as_vec3(), &mut segments);
        let rods: Vec<Rod> = segments.iter().filter_map(Rod::new).collect();
        let gallery = self.lighting.background.is_none().then_some(&self.gallery);
        let stage = Stage {
            world: &World::new(&self.scene, vertices, &rods, &self.materials),
            gallery,
            lights: &self.lights,
            wide: self.wide_lights,
            sky: self.sky,
            background: self.lighting.background.unwrap_or_default(),
            table: &self.table,
            varnish: true,
            scale: self.gallery.center.abs().max_element() + self.gallery.half.max_element(),
        };
        let camera = Camera::new(frame);
        let sobol = Sobol::new(settings.samples);
        let row = |y: u32| -> Vec<Vec3> {
            let mean = |x: u32| {
                let sum: Vec3 = (0..settings.samples.max(1))
                    .map(|sample| {
                        let mut sequence = sobol.sequence((x, y), sample);
                        let direction = camera.direction((x, y), sequence.next());
                        stage.radiance(camera.eye, direction, &mut sequence)
                    })
                    .sum();
                sum / settings.samples.max(1) as f32
            };
            (0..width).map(mean).collect()
        };
        Ok(in_rows(height, settings.threads, row, progress))
    }

    /// Fixed lights first, then the model's punctual lights at the poses of a frame.
    fn place_lights(&mut self, frame: &FrameInput) {
        self.lights.truncate(self.fixed_lights);
        let poses = std::iter::once(Pose::IDENTITY).chain(self.poses(frame)).collect::<Vec<_>>();
        let world = |light: &Punctual| light.uniform(poses[light.frame].matrix().as_mat4());
        self.lights.extend(self.scene.lights.iter().map(|light| Light::Punctual(world(light))));
        debug_assert!(self.lights.len() <= MAX_LIGHTS, "{} lights", self.lights.len());
    }

    /// Poses of all bodies; those that the frame leaves out are at the start.
    fn poses(&self, frame: &FrameInput) -> Vec<Pose> {
        let bodies = self.exhibit.bodies.iter().enumerate();
        bodies.map(|(index, body)| *frame.poses.get(index).unwrap_or(&body.pose)).collect()
    }

    /// Vertices in the world.
    fn vertices(&mut self, frame: &FrameInput) -> Vec<Vertex> {
        let poses: Vec<Pose> = std::iter::once(Pose::IDENTITY).chain(self.poses(frame)).collect();
        let frames: Vec<_> = poses.iter().map(rows).collect();
        let mut vertices = self.scene.vertices.clone();
        for skin in &mut self.scene.skins {
            skin.place(&frames, frame.time);
            let first = skin.first as usize;
            vertices[first..first + skin.vertices.len()].copy_from_slice(&skin.vertices);
        }
        let matrices: Vec<Mat4> = poses.iter().map(|pose| pose.matrix().as_mat4()).collect();
        for vertex in &mut vertices {
            let world = &matrices[vertex.frame()];
            vertex.position = world.transform_point3(vertex.position);
            vertex.normal = world.transform_vector3(vertex.normal);
            let along = world.transform_vector3(Vec3::from_slice(&vertex.tangent));
            vertex.tangent = [along.x, along.y, along.z, vertex.tangent[3]];
        }
        vertices
    }
}

/// All rows of a picture, computed by several threads in any order.
fn in_rows(
    height: u32,
    threads: Option<usize>,
    row: impl Fn(u32) -> Vec<Vec3> + Sync,
    progress: &(dyn Fn(u32) + Sync),
) -> Vec<Vec3> {
    let threads = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, |n| n.get())).max(1);
    let (next, finished) = (AtomicU32::new(0), AtomicU32::new(0));
    let rows = Mutex::new(vec![Vec::new(); height as usize]);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let y = next.fetch_add(1, Ordering::Relaxed);
                    if y >= height {
                        break;
                    }
                    let pixels = row(y);
                    // A thread that panicked has written no part of a row.
                    rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner)[y as usize] = pixels;
                    progress(finished.fetch_add(1, Ordering::Relaxed) + 1);
                }
            });
        }
    });
    rows.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).concat()
}
