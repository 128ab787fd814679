//! Pictures of the day, drawn only where they are judged.
//!
//! Every eighth step's moment is kept for some seconds; what is asked about later is drawn then, by the kiosk's own
//! renderer, before a plain ground. Dust, and shadows on the wall, are left out: the question is whether the work itself
//! moves, and without them a picture costs a tenth. It still costs more than the kiosk's second that it shows, so the
//! onlooker has a thread of its own; what it says does not depend on when it says it.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use super::judge::{Answer, BEFORE, FPS, Picture, answer};
use soffio_exhibit::Exhibit;
use soffio_math::Pose;
use soffio_render::{FrameInput, ImageRenderer, Lighting, RenderError};
use soffio_simulation::{STEPS_PER_SECOND, Snapshot};

/// Pixels: 4 mm each on a 55-inch screen, whose edges four samples a pixel make a millimetre fine.
pub const SIZE: (u32, u32) = (320, 180);
/// Steps from picture to picture.
const EVERY: u64 = STEPS_PER_SECOND / FPS;
/// Linear lightness of the ground: a white wall in the gallery's light.
const GROUND: f32 = 0.6;
/// Moments that are kept: two seconds about an onset, and some more.
const KEPT: usize = 3 * FPS as usize;
/// Questions that wait to be looked at, at most: the day waits then.
const WAITING: usize = 8;

/// A moment that was kept: number, work, time since its reset, poses.
type Moment = (u64, usize, f64, Vec<Pose>);

/// The onlooker: what it keeps of the day. Dropped unseen, it leaves after the picture at hand.
pub struct Eyes<Q> {
    moments: VecDeque<Moment>,
    /// `None` once nothing more is asked.
    asked: Option<SyncSender<Case<Q>>>,
    /// `None` once it has come back.
    onlooker: Option<JoinHandle<Result<Seen<Q>, RenderError>>>,
    leave: Arc<AtomicBool>,
}

/// What an onlooker is asked: a name for the answer, the moments of two seconds, the poses had nobody come.
struct Case<Q> {
    question: Q,
    kept: Vec<Moment>,
    alone: Vec<Vec<Pose>>,
}

/// What an onlooker has seen, in the order of the questions.
#[derive(Debug)]
pub struct Seen<Q> {
    /// Each question and its answer; `None` where another work came in between, or some moments are not kept.
    pub answers: Vec<(Q, Option<Answer>)>,
    /// Pictures drawn.
    pub drawn: u64,
}

impl<Q: Send + 'static> Eyes<Q> {
    /// Before these works. Needs a Vulkan driver; software is enough.
    pub fn new(works: &[Arc<Exhibit>]) -> Result<Self, RenderError> {
        let before_a_ground = |work: &Arc<Exhibit>| {
            let ground = |look: &mut Lighting| look.background = Some(glam::Vec3::splat(GROUND));
            Ok((work.clone(), ImageRenderer::new(work, |options| ground(&mut options.lighting))?))
        };
        let works = works.iter().map(before_a_ground).collect::<Result<_, RenderError>>()?;
        let (asked, questions) = sync_channel(WAITING);
        let leave = Arc::new(AtomicBool::new(false));
        let onlooker = Onlooker { works, drawn: 0, leave: leave.clone() };
        let onlooker = std::thread::spawn(move || onlooker.look_on(questions));
        Ok(Self { moments: VecDeque::new(), asked: Some(asked), onlooker: Some(onlooker), leave })
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

    /// Could a picture not be drawn? Then nothing more is looked at, and [`Self::seen`] says why.
    pub fn have_failed(&self) -> bool {
        self.onlooker.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Asks what is seen of the second before and after a picture, beside the poses of those after it had nobody come.
    /// Waits where too much is asked already.
    pub fn ask(&self, question: Q, middle: u64, alone: Vec<Vec<Pose>>) {
        let span = middle.saturating_sub(BEFORE as u64)..=middle + BEFORE as u64;
        let kept = self.moments.iter().filter(|(number, ..)| span.contains(number)).cloned().collect();
        // Who has failed takes no more questions.
        let _ = self.asked.as_ref().map(|asked| asked.send(Case { question, kept, alone }));
    }

    /// All answers.
    ///
    /// # Errors
    /// A picture could not be drawn.
    pub fn seen(mut self) -> Result<Seen<Q>, RenderError> {
        self.asked = None;
        let nothing = || Ok(Seen { answers: Vec::new(), drawn: 0 });
        let come_back = self.onlooker.take().map(JoinHandle::join);
        come_back.map_or_else(nothing, |seen| seen.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    }
}

impl<Q> Drop for Eyes<Q> {
    /// A program must not end while a picture is drawn: the driver's own threads would work on memory that is gone.
    fn drop(&mut self) {
        self.leave.store(true, Ordering::Relaxed);
        self.asked = None;
        if let Some(onlooker) = self.onlooker.take() {
            let _ = onlooker.join();
        }
    }
}

/// The number of the picture at a time or the last one before it.
pub fn picture_at(seconds: f64) -> u64 {
    (seconds * FPS as f64).floor().max(0.0) as u64
}

/// Who draws and looks.
struct Onlooker {
    works: Vec<(Arc<Exhibit>, ImageRenderer)>,
    drawn: u64,
    /// Nobody wants to know any more.
    leave: Arc<AtomicBool>,
}

impl Onlooker {
    fn look_on<Q>(mut self, questions: Receiver<Case<Q>>) -> Result<Seen<Q>, RenderError> {
        let answers = questions.into_iter().map(|Case { question, kept, alone }| {
            let answer = self.judge(&kept, &alone)?;
            Ok((question, answer))
        });
        let answers = answers.collect::<Result<_, RenderError>>()?;
        Ok(Seen { answers, drawn: self.drawn })
    }

    fn judge(&mut self, kept: &[Moment], alone: &[Vec<Pose>]) -> Result<Option<Answer>, RenderError> {
        let work = kept.first().map_or(0, |(_, work, ..)| *work);
        if kept.len() != 2 * BEFORE + 1 || kept.iter().any(|(_, other, ..)| *other != work) {
            return Ok(None);
        }
        let (exhibit, renderer) = &mut self.works[work];
        let view = exhibit.view(f64::from(SIZE.0) / f64::from(SIZE.1));
        let mut draw = |poses: &[Pose], time: f64| -> Result<Option<Picture>, RenderError> {
            if self.leave.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let picture = renderer.draw(&FrameInput { poses, dust: &[], view, size: SIZE, exposure: 1.0, time })?;
            Ok(Some(Picture(picture.pixels().flat_map(|p| [p[0], p[1], p[2]]).collect())))
        };
        let pictures = kept.iter().map(|(.., time, poses)| draw(poses, *time).transpose());
        let Some(pictures) = pictures.collect::<Option<Result<Vec<_>, _>>>().transpose()? else {
            return Ok(None);
        };
        // Bodies that stand alike look alike: most visits begin so, and are drawn once.
        let mut drawn = pictures.len();
        let mut beside = Vec::with_capacity(alone.len());
        for ((poses, (.., time, own)), picture) in alone.iter().zip(&kept[BEFORE + 1..]).zip(&pictures[BEFORE + 1..]) {
            let alike = poses == own;
            let Some(picture) = (if alike { Some(picture.clone()) } else { draw(poses, *time)? }) else {
                return Ok(None);
            };
            beside.push(picture);
            drawn += usize::from(!alike);
        }
        self.drawn += drawn as u64;
        Ok(answer(&pictures, &beside))
    }
}
