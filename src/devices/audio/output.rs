//! The loudspeaker: a real-time thread that owns the synth.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

use cpal::{FromSample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};

use super::clock::ClockMap;
use super::hearing::Tail;
use super::knobs::Knobs;
use super::mouth::{self, Mouth, Prompter, Words};
use soffio_math::exp;
use soffio_sound::{AWeighting, SoundCommand, Synth};

/// Frames rendered at once, however long the device's blocks are.
const CHUNK: usize = 256;
/// Room in the ring of commands.
const COMMANDS: usize = 2048;
/// Room in the ring of the reference, s.
const REFERENCE: u32 = 1;
/// A synth that was replaced fades and is dropped after this time, s.
const FAREWELL: f64 = 0.1;
/// Time constant with which the volume follows its knob, s: no click, and no jump in loudness.
const VOLUME_GLIDE: f64 = 0.05;
/// A volume this near to its knob is there.
const THERE: f32 = 1e-5;

/// A command for the loudspeaker's own clock and for one generation of instruments.
#[derive(Clone, Copy, Debug)]
struct Timed {
    command: SoundCommand,
    generation: u64,
}

/// A synth with the generation of commands that it understands.
pub struct Engine {
    /// Plays.
    pub synth: Box<Synth>,
    /// Commands of other generations are not for it.
    pub generation: u64,
}

/// What the real-time thread lets others see.
#[derive(Debug, Default)]
pub struct Shared {
    /// Frames played.
    pub played: AtomicU64,
    /// Length of the last block, frames.
    pub block: AtomicU32,
    /// Of the instruments that play.
    pub generation: AtomicU64,
    /// Are words being said?
    pub speaks: AtomicBool,
}

/// The real-time end: everything that the loudspeaker's callback touches.
pub struct Player {
    engine: Option<Engine>,
    /// Frame at which the engine's own clock was 0.
    origin: u64,
    /// A replaced engine and the frames it still has to fade.
    leaving: Option<(Engine, usize)>,
    commands: Consumer<Timed>,
    engines: Consumer<Engine>,
    retired: Producer<Engine>,
    mouth: Mouth,
    reference: Producer<f32>,
    second: SecondOutput,
    shared: Arc<Shared>,
    knobs: Arc<Knobs>,
    channels: usize,
    gain: f32,
    glide: f32,
    weighting: AWeighting,
    seconds: f64,
    farewell: usize,
    frame: u64,
}

/// The way to a second output, where there is one.
struct SecondOutput {
    tail: Option<Tail>,
    /// Others wait here, and those that are over go back.
    tails: Consumer<Tail>,
    spent_tails: Producer<Tail>,
    /// Follows whether anything is to be heard at all.
    sounds: f32,
}

impl SecondOutput {
    /// Takes a new way where one waits. Frees nothing.
    fn change(&mut self) {
        while self.spent_tails.slots() > 0
            && let Ok(tail) = self.tails.pop()
        {
            if let Some(old) = self.tail.replace(tail) {
                // There is room: only this end pushes.
                let _ = self.spent_tails.push(old);
            }
        }
    }

    /// Passes on what is played; whether it is `audible` glides by `glide` a frame.
    fn feed(&mut self, stereo: &[f32], audible: bool, glide: f32) {
        if let Some(Tail(tail)) = &mut self.tail {
            let target = if audible { 1.0 } else { 0.0 };
            for [left, right] in stereo.as_chunks::<2>().0 {
                self.sounds += (target - self.sounds) * glide;
                // A full ring means that the second output stands still.
                let _ = tail.push(0.5 * (left + right) * self.sounds);
            }
        }
    }
}

/// The kiosk's end.
pub struct Voice {
    commands: Producer<Timed>,
    prompter: Prompter,
    reference: Consumer<f32>,
    shared: Arc<Shared>,
    clock: ClockMap,
    sample_rate: u32,
}

/// The supervisor's end: engines go in, retired ones come out.
pub struct Workshop {
    engines: Producer<Engine>,
    retired: Consumer<Engine>,
    tails: Producer<Tail>,
    spent_tails: Consumer<Tail>,
}

/// The three ends of one loudspeaker.
pub fn open(sample_rate: u32, channels: usize, knobs: Arc<Knobs>) -> (Player, Voice, Workshop) {
    let (to_player, commands) = RingBuffer::new(COMMANDS);
    let (reference, from_player) = RingBuffer::new((REFERENCE * sample_rate) as usize);
    let (new_engines, engines) = RingBuffer::new(4);
    let (retired, old_engines) = RingBuffer::new(8);
    let (to_tails, tails) = RingBuffer::new(4);
    let (spent_tails, old_tails) = RingBuffer::new(8);
    let (mouth, prompter) = mouth::open(sample_rate);
    let shared = Arc::new(Shared::default());
    let player = Player {
        engine: None,
        origin: 0,
        leaving: None,
        commands,
        engines,
        retired,
        mouth,
        reference,
        second: SecondOutput { tail: None, tails, spent_tails, sounds: 0.0 },
        shared: shared.clone(),
        channels: channels.max(1),
        // From silence: a loudspeaker that comes back in the middle of a sound does not bang.
        gain: 0.0,
        glide: (1.0 - exp(-1.0 / (VOLUME_GLIDE * f64::from(sample_rate)))) as f32,
        weighting: AWeighting::new(f64::from(sample_rate)),
        seconds: 1.0 / f64::from(sample_rate),
        knobs,
        farewell: (FAREWELL * f64::from(sample_rate)) as usize,
        frame: 0,
    };
    let clock = ClockMap::new(sample_rate);
    let voice = Voice { commands: to_player, prompter, reference: from_player, shared, clock, sample_rate };
    (player, voice, Workshop { engines: new_engines, retired: old_engines, tails: to_tails, spent_tails: old_tails })
}

impl Player {
    /// The callback's whole body. Real-time: bounded, no allocation, no lock, no system call.
    pub fn play<T: SizedSample + FromSample<f32>>(&mut self, data: &mut [T]) {
        let frames = data.len() / self.channels;
        self.change_engine();
        self.second.change();
        let night = self.knobs.night();
        for engine in self.engine.iter_mut().chain(self.leaving.iter_mut().map(|(engine, _)| engine)) {
            engine.synth.set_night(night);
        }
        let mut power = 0.0;
        while let Ok(Timed { command, generation }) = self.commands.pop() {
            if let Some(engine) = self.engine.as_mut().filter(|engine| engine.generation == generation) {
                engine.synth.command(command.at(command.sample().saturating_sub(self.origin)));
            }
        }
        let mut stereo = [0.0f32; 2 * CHUNK];
        for out in data.chunks_mut(CHUNK * self.channels) {
            let stereo = &mut stereo[..2 * (out.len() / self.channels)];
            self.render(stereo);
            for (frame, lr) in out.chunks_mut(self.channels).zip(stereo.as_chunks::<2>().0) {
                put(frame, *lr);
                power += self.weighting.power(*lr);
                // A full ring means that nobody listens.
                let _ = self.reference.push(0.5 * (lr[0] + lr[1]));
            }
        }
        self.knobs.note(power * self.seconds, frames as f64 * self.seconds);
        self.frame += frames as u64;
        self.shared.played.store(self.frame, Ordering::Release);
        self.shared.block.store(frames as u32, Ordering::Relaxed);
        self.shared.speaks.store(self.mouth.speaks(), Ordering::Relaxed);
    }

    /// Frees nothing: what is over goes back through a ring. Without room there, everything stays as it is.
    fn change_engine(&mut self) {
        if let Some((engine, 0)) = self.leaving.take_if(|(_, frames)| *frames == 0)
            && let Err(rtrb::PushError::Full(engine)) = self.retired.push(engine)
        {
            self.leaving = Some((engine, 0));
        }
        if self.leaving.is_none()
            && let Ok(engine) = self.engines.pop()
        {
            self.shared.generation.store(engine.generation, Ordering::Release);
            self.leaving = self.engine.replace(engine).map(|mut old| {
                let sample = old.synth.position();
                old.synth.command(SoundCommand::Silence { sample });
                (old, self.farewell)
            });
            self.origin = self.frame;
        }
    }

    fn render(&mut self, stereo: &mut [f32]) {
        match &mut self.engine {
            Some(engine) => engine.synth.render(stereo),
            None => stereo.fill(0.0),
        }
        if let Some((engine, left)) = &mut self.leaving {
            let mut old = [0.0f32; 2 * CHUNK];
            let old = &mut old[..stereo.len()];
            engine.synth.render(old);
            // Together they may pass full scale; each alone cannot.
            stereo.iter_mut().zip(old).for_each(|(s, o)| *s = (*s + *o).clamp(-1.0, 1.0));
            *left = left.saturating_sub(stereo.len() / 2);
        }
        self.mouth.speak(stereo);
        let volume = self.knobs.volume();
        self.second.feed(stereo, volume > 0.0, self.glide);
        for frame in stereo.as_chunks_mut::<2>().0 {
            let off = volume - self.gain;
            self.gain = if off.abs() < THERE { volume } else { self.gain + off * self.glide };
            frame.iter_mut().for_each(|sample| *sample *= self.gain);
        }
    }
}

/// Stereo to the device's channels: one hears both, the third and later are silent.
fn put<T: SizedSample + FromSample<f32>>(frame: &mut [T], [left, right]: [f32; 2]) {
    match frame {
        [] => {}
        [mono] => *mono = T::from_sample(0.5 * (left + right)),
        [l, r, others @ ..] => {
            (*l, *r) = (T::from_sample(left), T::from_sample(right));
            others.fill(T::EQUILIBRIUM);
        }
    }
}

impl Voice {
    /// Hz.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// What was played, mono.
    pub fn reference(&mut self) -> &mut Consumer<f32> {
        &mut self.reference
    }

    /// What the real-time thread shows.
    pub fn shared(&self) -> &Shared {
        &self.shared
    }

    /// Has words said instead of those that are being said; none hush. Words at another rate are not said.
    pub fn say(&mut self, words: &Words) {
        if words.samples.is_empty() || words.sample_rate == self.sample_rate {
            self.prompter.say(words.samples.clone());
        }
    }

    /// Sends commands with sample times of the simulation, whose present is `now`.
    pub fn send(&mut self, now: u64, commands: &[SoundCommand], generation: u64) {
        let (played, block) = (self.shared.played.load(Ordering::Acquire), self.shared.block.load(Ordering::Relaxed));
        self.clock.look(now, played, block);
        for command in commands {
            let command = command.at(self.clock.frame(command.sample()));
            // A full ring means that the device stands still; what it missed is not wanted later.
            let _ = self.commands.push(Timed { command, generation });
        }
    }
}

impl Workshop {
    /// Gives the player another engine; drops the ones it has given back.
    pub fn exchange(&mut self, engine: Option<Engine>) {
        self.clear();
        if let Some(engine) = engine {
            // Full only if four were sent within one fade; the next wins soon enough.
            let _ = self.engines.push(engine);
        }
    }

    /// Has the player give what it plays to a second output, instead of to another one before.
    pub fn lead(&mut self, tail: Tail) {
        self.clear();
        // Full only if four were opened within one block.
        let _ = self.tails.push(tail);
    }

    /// Drops what the player has given back.
    pub fn clear(&mut self) {
        while self.spent_tails.pop().is_ok() {}
        while self.retired.pop().is_ok() {}
    }
}
