//! Pictures of the day, drawn only where they are judged.
//!
//! Every eighth step's moment is kept for some seconds; what is asked about later is drawn then, by the kiosk's own
//! renderer, before a plain ground. Dust, and shadows on the wall, are left out: the question is whether the work itself
//! moves, and without them a picture costs a tenth.

use std::collections::VecDeque;
use std::sync::Arc;

use super::judge::{Answer, BEFORE, FPS, Picture, answer};
use crate::exhibit::Exhibit;
use crate::math::Pose;
use crate::render::{Frame, ImageRenderer, Look, RenderError};
use crate::simulation::{STEPS_PER_SECOND, Snapshot};

/// Pixels: 4 mm each on a 55-inch screen, whose edges four samples a pixel make a millimetre fine.
pub const SIZE: (u32, u32) = (320, 180);
/// Steps from picture to picture.
const EVERY: u64 = STEPS_PER_SECOND / FPS;
/// Linear lightness of the ground: a white wall in the gallery's light.
const GROUND: f32 = 0.6;
/// Moments that are kept: two seconds about an onset, and some more.
const KEPT: usize = 3 * FPS as usize;

/// The onlooker.
pub struct Eyes {
    works: Vec<(Arc<Exhibit>, ImageRenderer)>,
    /// Number, work, time since its reset, poses.
    moments: VecDeque<(u64, usize, f64, Vec<Pose>)>,
    /// Pictures drawn so far.
    pub drawn: u64,
}

impl Eyes {
    /// Before these works. Needs a Vulkan driver; software is enough.
    pub fn new(works: &[Arc<Exhibit>]) -> Result<Self, RenderError> {
        let before_a_ground = |work: &Arc<Exhibit>| {
            let ground = |look: &mut Look| look.background = Some(glam::Vec3::splat(GROUND));
            Ok((work.clone(), ImageRenderer::new(work, |options| ground(&mut options.look))?))
        };
        let works = works.iter().map(before_a_ground).collect::<Result<_, RenderError>>()?;
        Ok(Self { works, moments: VecDeque::new(), drawn: 0 })
    }

    /// The number of the picture at a time or the last one before it.
    pub fn picture_at(seconds: f64) -> u64 {
        (seconds * FPS as f64).floor().max(0.0) as u64
    }

    /// Takes notice of the moment after a step, with the work on show.
    pub fn look(&mut self, step: u64, work: usize, now: &Snapshot) {
        if step.is_multiple_of(EVERY) {
            self.moments.push_back((step / EVERY, work, now.time, now.poses.clone()));
            while self.moments.len() > KEPT {
                self.moments.pop_front();
            }
        }
    }

    /// What is seen of the second before and after a picture, beside the poses of those after it had nobody come. `None` where
    /// another work came in between, or some are not kept.
    pub fn judge(&mut self, middle: u64, alone: &[Vec<Pose>]) -> Result<Option<Answer>, RenderError> {
        let span = middle.saturating_sub(BEFORE as u64)..=middle + BEFORE as u64;
        let kept = self.moments.iter().filter(|(number, ..)| span.contains(number)).collect::<Vec<_>>();
        let work = kept.first().map_or(0, |(_, work, ..)| *work);
        if kept.len() != 2 * BEFORE + 1 || kept.iter().any(|(_, other, ..)| *other != work) {
            return Ok(None);
        }
        let (exhibit, renderer) = &mut self.works[work];
        let view = exhibit.view(f64::from(SIZE.0) / f64::from(SIZE.1));
        let mut draw = |poses: &[Pose], time: f64| -> Result<Picture, RenderError> {
            let picture = renderer.draw(&Frame { poses, motes: &[], view, size: SIZE, exposure: 1.0, time })?;
            Ok(Picture(picture.pixels().flat_map(|p| [p[0], p[1], p[2]]).collect()))
        };
        let pictures = kept.iter().map(|(.., time, poses)| draw(poses, *time)).collect::<Result<Vec<_>, _>>()?;
        // Bodies that stand alike look alike: most visits begin so, and are drawn once.
        let mut drawn = pictures.len();
        let mut beside = Vec::with_capacity(alone.len());
        for ((poses, (.., time, own)), picture) in alone.iter().zip(&kept[BEFORE + 1..]).zip(&pictures[BEFORE + 1..]) {
            let alike = poses == own;
            beside.push(if alike { picture.clone() } else { draw(poses, *time)? });
            drawn += usize::from(!alike);
        }
        self.drawn += drawn as u64;
        Ok(answer(&pictures, &beside))
    }
}
