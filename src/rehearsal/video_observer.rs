//! Video observer: draws pictures of the day, only where they are scored.
//!
//! Every eighth step is recorded for some seconds. When a score is requested, the kiosk's own renderer draws the recorded moments in
//! front of a plain background. Dust and shadows on the wall are left out: only the motion of the exhibit matters, and without them a
//! picture costs a tenth. It still takes longer than real time, so the observer has a thread of its own. Its results do not depend on
//! timing.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use super::scorer::{BEFORE, FPS, Picture, Response, score};
use soffio_exhibit::Exhibit;
use soffio_math::Pose;
use soffio_render::{FrameInput, ImageRenderer, Lighting, RenderError};
use soffio_simulation::{STEPS_PER_SECOND, Snapshot};

/// Size of a picture, pixels: 4 mm each on a 55-inch screen; with four samples a pixel, edges are accurate to a millimetre.
pub const SIZE: (u32, u32) = (320, 180);
/// Steps from picture to picture.
const EVERY: u64 = STEPS_PER_SECOND / FPS;
/// Linear lightness of the background: a white wall in the gallery's light.
const BACKGROUND: f32 = 0.6;
/// Recorded moments: two seconds about an onset, and one more.
const CAPACITY: usize = 3 * FPS as usize;
/// Largest number of pending requests; the day waits beyond it.
const PENDING: usize = 8;

/// One recorded moment.
#[derive(Clone)]
struct Moment {
    /// Number of its picture.
    picture: u64,
    /// Index of the exhibit on show.
    exhibit: usize,
    /// Time since the exhibit's reset, s.
    time: f64,
    poses: Vec<Pose>,
}

/// Recorder of the day, with a thread that draws and scores. When it is dropped, the thread ends after the current picture.
pub struct VideoObserver<Q> {
    moments: VecDeque<Moment>,
    /// `None` once all requests are made.
    requests: Option<SyncSender<Request<Q>>>,
    /// `None` once the thread has ended.
    thread: Option<JoinHandle<Result<Observations<Q>, RenderError>>>,
    stop: Arc<AtomicBool>,
}

/// A request for a score: its key, the moments of two seconds, and the poses of the control run.
struct Request<Q> {
    key: Q,
    moments: Vec<Moment>,
    control: Vec<Vec<Pose>>,
}

/// Results of the observer, in the order of the requests.
#[derive(Debug)]
pub struct Observations<Q> {
    /// Key and response of each request; `None` where the exhibit changed in between, or moments are missing.
    pub responses: Vec<(Q, Option<Response>)>,
    /// Number of pictures drawn.
    pub drawn: u64,
}

impl<Q: Send + 'static> VideoObserver<Q> {
    /// An observer of these exhibits.
    ///
    /// # Errors
    /// There is no Vulkan driver; a software driver is enough.
    pub fn new(exhibits: &[Arc<Exhibit>]) -> Result<Self, RenderError> {
        let renderer = |exhibit: &Arc<Exhibit>| {
            let background = |lighting: &mut Lighting| lighting.background = Some(glam::Vec3::splat(BACKGROUND));
            Ok((exhibit.clone(), ImageRenderer::new(exhibit, |options| background(&mut options.lighting))?))
        };
        let exhibits = exhibits.iter().map(renderer).collect::<Result<_, RenderError>>()?;
        let (requests, receiver) = sync_channel(PENDING);
        let stop = Arc::new(AtomicBool::new(false));
        let worker = Worker { exhibits, drawn: 0, stop: stop.clone() };
        let thread = std::thread::spawn(move || worker.run(receiver));
        Ok(Self { moments: VecDeque::new(), requests: Some(requests), thread: Some(thread), stop })
    }

    /// Records the moment after a step, with the exhibit on show.
    pub fn record(&mut self, step: u64, exhibit: usize, now: &Snapshot) {
        if step.is_multiple_of(EVERY) {
            let moment = Moment { picture: step / EVERY, exhibit, time: now.time, poses: now.poses.clone() };
            self.moments.push_back(moment);
            while self.moments.len() > CAPACITY {
                self.moments.pop_front();
            }
        }
    }

    /// True where a picture could not be drawn: no more requests are served, and [`Self::finish`] returns the error.
    pub fn has_failed(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Requests the response in the second after the picture `middle`, compared with the second before it and with the poses of the
    /// control run. Blocks while too many requests are pending.
    pub fn request(&self, key: Q, middle: u64, control: Vec<Vec<Pose>>) {
        let span = middle.saturating_sub(BEFORE as u64)..=middle + BEFORE as u64;
        let moments = self.moments.iter().filter(|moment| span.contains(&moment.picture)).cloned().collect();
        // A failed thread receives no more requests.
        let _ = self.requests.as_ref().map(|requests| requests.send(Request { key, moments, control }));
    }

    /// Waits for all results.
    ///
    /// # Errors
    /// A picture could not be drawn.
    pub fn finish(mut self) -> Result<Observations<Q>, RenderError> {
        self.requests = None;
        let nothing = || Ok(Observations { responses: Vec::new(), drawn: 0 });
        let result = self.thread.take().map(JoinHandle::join);
        result.map_or_else(nothing, |result| result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    }
}

impl<Q> Drop for VideoObserver<Q> {
    /// Waits for the thread: the program must not exit while a driver's threads draw a picture.
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        self.requests = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Number of the picture at a time, s, or of the last one before it.
pub fn picture_at(seconds: f64) -> u64 {
    (seconds * FPS as f64).floor().max(0.0) as u64
}

/// State of the drawing thread.
struct Worker {
    exhibits: Vec<(Arc<Exhibit>, ImageRenderer)>,
    drawn: u64,
    /// The results are no longer needed.
    stop: Arc<AtomicBool>,
}

impl Worker {
    fn run<Q>(mut self, requests: Receiver<Request<Q>>) -> Result<Observations<Q>, RenderError> {
        let responses = requests.into_iter().map(|Request { key, moments, control }| {
            let response = self.score(&moments, &control)?;
            Ok((key, response))
        });
        let responses = responses.collect::<Result<_, RenderError>>()?;
        Ok(Observations { responses, drawn: self.drawn })
    }

    fn score(&mut self, moments: &[Moment], control: &[Vec<Pose>]) -> Result<Option<Response>, RenderError> {
        let exhibit = moments.first().map_or(0, |moment| moment.exhibit);
        if moments.len() != 2 * BEFORE + 1 || moments.iter().any(|moment| moment.exhibit != exhibit) {
            return Ok(None);
        }
        let (exhibit, renderer) = &mut self.exhibits[exhibit];
        let view = exhibit.view(f64::from(SIZE.0) / f64::from(SIZE.1));
        let mut draw = |poses: &[Pose], time: f64| -> Result<Option<Picture>, RenderError> {
            if self.stop.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let picture =
                renderer.draw(&FrameInput { poses, dust: &[], curves: &[], view, size: SIZE, exposure: 1.0, time })?;
            Ok(Some(Picture(picture.pixels().flat_map(|p| [p[0], p[1], p[2]]).collect())))
        };
        let pictures = moments.iter().map(|moment| draw(&moment.poses, moment.time).transpose());
        let Some(pictures) = pictures.collect::<Option<Result<Vec<_>, _>>>().transpose()? else {
            return Ok(None);
        };
        // Equal poses give equal pictures: most visits begin so, and are drawn once.
        let mut drawn = pictures.len();
        let mut control_pictures = Vec::with_capacity(control.len());
        for ((poses, moment), picture) in control.iter().zip(&moments[BEFORE + 1..]).zip(&pictures[BEFORE + 1..]) {
            let alike = *poses == moment.poses;
            let Some(picture) = (if alike { Some(picture.clone()) } else { draw(poses, moment.time)? }) else {
                return Ok(None);
            };
            control_pictures.push(picture);
            drawn += usize::from(!alike);
        }
        self.drawn += drawn as u64;
        Ok(score(&pictures, &control_pictures))
    }
}
