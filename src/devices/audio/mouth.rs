//! Words that the kiosk says, mixed into what the loudspeaker plays: so they pass through the volume, and the ear knows
//! them as it knows every other sound of the kiosk.
//!
//! What is said last takes the place of what was being said, and nothing at all hushes. While something is said the work is
//! softer. With d gliding between 1 and [`DUCK`],
//!
//! ```text
//! out = d · work + (1 − d) / (1 − DUCK) · words        |work| ≤ 1, |words| ≤ 1 − DUCK  ⇒  |out| ≤ 1
//! ```
//!
//! so one number fades the words in and out and full scale is never passed.

use std::sync::Arc;

use rtrb::{Consumer, Producer, RingBuffer};

use soffio_math::exp;

/// What is left of the work while something is said: −12 dB.
const DUCK: f32 = 0.25;
/// Greatest sample of words.
pub const LOUDEST: f32 = 1.0 - DUCK;
/// Time constant of the fade, s: no click, and no word loses its first sound.
const GLIDE: f64 = 0.02;
/// Words this far gone are not heard.
const GONE: f32 = 1e-3;
/// Utterances that can wait; those that are over go back through twice as many places.
const WAITING: usize = 8;

/// Something to say.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// One channel, none greater than [`LOUDEST`].
    pub samples: Arc<[f32]>,
    /// Hz: the loudspeaker's, or it cannot be said.
    pub sample_rate: u32,
}

/// The real-time end.
pub(super) struct Mouth {
    waiting: Consumer<Arc<[f32]>>,
    spent: Producer<Arc<[f32]>>,
    words: Option<Arc<[f32]>>,
    at: usize,
    /// Others wait: these fade.
    leaves: bool,
    duck: f32,
    glide: f32,
}

/// The kiosk's end.
pub(super) struct Prompter {
    waiting: Producer<Arc<[f32]>>,
    spent: Consumer<Arc<[f32]>>,
}

/// Both ends, for a loudspeaker of this rate, Hz.
pub(super) fn open(sample_rate: u32) -> (Mouth, Prompter) {
    let (to_mouth, waiting) = RingBuffer::new(WAITING);
    let (spent, back) = RingBuffer::new(2 * WAITING);
    let glide = (1.0 - exp(-1.0 / (GLIDE * f64::from(sample_rate.max(1))))) as f32;
    let mouth = Mouth { waiting, spent, words: None, at: 0, leaves: false, duck: 1.0, glide };
    (mouth, Prompter { waiting: to_mouth, spent: back })
}

impl Mouth {
    /// Adds words to stereo frames. Real-time: bounded, no allocation; what is over goes back through a ring.
    pub fn speak(&mut self, stereo: &mut [f32]) {
        self.turn();
        let words = self.words.as_deref().unwrap_or_default();
        if words.len() <= self.at && self.duck == 1.0 {
            return;
        }
        for frame in stereo.as_chunks_mut::<2>().0 {
            let word = words.get(self.at).copied();
            self.at += usize::from(word.is_some());
            let target = if word.is_some() && !self.leaves { DUCK } else { 1.0 };
            self.duck += (target - self.duck) * self.glide;
            let said = word.unwrap_or_default() * (1.0 - self.duck) / LOUDEST;
            frame.iter_mut().for_each(|sample| *sample = self.duck * *sample + said);
        }
        if 1.0 - self.duck < GONE && self.at >= words.len() {
            self.duck = 1.0;
        }
    }

    /// Is something being said, or about to be?
    pub fn speaks(&self) -> bool {
        !self.leaves && self.words.as_ref().is_some_and(|words| self.at < words.len()) || !self.waiting.is_empty()
    }

    /// Goes on to the newest that waits as soon as what was said has faded. Without room for the rest to go back, it waits
    /// longer.
    fn turn(&mut self) {
        let waiting = self.waiting.slots();
        self.leaves |= waiting > 0;
        let faded = 1.0 - self.duck < GONE || self.words.as_ref().is_none_or(|words| self.at >= words.len());
        if !(self.leaves && faded) || self.spent.slots() <= waiting {
            return;
        }
        for next in (0..waiting).map_while(|_| self.waiting.pop().ok()) {
            if let Some(old) = self.words.replace(next) {
                // There is room: only this end pushes.
                let _ = self.spent.push(old);
            }
        }
        (self.at, self.leaves) = (0, false);
    }
}

impl Prompter {
    /// Has this said instead of what is being said, and drops what is over.
    pub fn say(&mut self, samples: Arc<[f32]>) {
        while self.spent.pop().is_ok() {}
        // A full ring means that the device stands still; what it missed is not wanted later.
        let _ = self.waiting.push(samples);
    }
}
