//! Audio output: a real-time callback that owns the synth.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

use cpal::{FromSample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};

use super::clock::ClockMap;
use super::hearing_loop::Tail;
use super::knobs::Knobs;
use super::speech_mixer::{self, SpeechMixer, SpeechQueue, Utterance};
use soffio_math::exp;
use soffio_sound::{AWeighting, SoundCommand, Synth};

/// Frames rendered at once, however long the device's blocks are.
const CHUNK: usize = 256;
/// Capacity of the command ring.
const COMMAND_CAPACITY: usize = 2048;
/// Capacity of the reference ring, s.
const REFERENCE: u32 = 1;
/// Fade-out of a replaced synth, s.
const FADE_OUT: f64 = 0.1;
/// Time constant of the volume, s: no click, and no jump in loudness.
const VOLUME_GLIDE: f64 = 0.05;
/// Difference at which the volume has reached its target.
const VOLUME_TOLERANCE: f32 = 1e-5;

/// A command in output frames, for one generation of instruments.
#[derive(Clone, Copy, Debug)]
struct TimedCommand {
    command: SoundCommand,
    generation: u64,
}

/// A synth and its generation of instruments.
pub struct Engine {
    /// The synth.
    pub synth: Box<Synth>,
    /// Commands of other generations are ignored.
    pub generation: u64,
}

/// State of the callback for other threads.
#[derive(Debug, Default)]
pub struct Shared {
    /// Frames played.
    pub played: AtomicU64,
    /// Length of the last block, frames.
    pub block: AtomicU32,
    /// Of the instruments that play.
    pub generation: AtomicU64,
    /// Whether an utterance is being spoken.
    pub speaks: AtomicBool,
    /// Commands dropped by the synth.
    pub lost: AtomicU64,
}

/// The real-time end: all that the output's callback uses.
pub struct Player {
    engine: Option<Engine>,
    /// Frame at which the engine's own clock was 0.
    origin: u64,
    /// A replaced engine and the frames it still has to fade.
    leaving: Option<(Engine, usize)>,
    commands: Consumer<TimedCommand>,
    engines: Consumer<Engine>,
    retired: Producer<Engine>,
    speech_mixer: SpeechMixer,
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
pub struct OutputHandle {
    commands: Producer<TimedCommand>,
    speech_queue: SpeechQueue,
    reference: Consumer<f32>,
    shared: Arc<Shared>,
    clock: ClockMap,
    sample_rate: u32,
    /// Commands that found no room in the ring.
    lost: u64,
}

/// The supervisor's end: engines go in, retired ones come out.
pub struct SynthInstaller {
    engines: Producer<Engine>,
    retired: Consumer<Engine>,
    tails: Producer<Tail>,
    spent_tails: Consumer<Tail>,
}

/// The three ends of one loudspeaker.
pub fn open(sample_rate: u32, channels: usize, knobs: Arc<Knobs>) -> (Player, OutputHandle, SynthInstaller) {
    let (to_player, commands) = RingBuffer::new(COMMAND_CAPACITY);
    let (reference, from_player) = RingBuffer::new((REFERENCE * sample_rate) as usize);
    let (new_engines, engines) = RingBuffer::new(4);
    let (retired, old_engines) = RingBuffer::new(8);
    let (to_tails, tails) = RingBuffer::new(4);
    let (spent_tails, old_tails) = RingBuffer::new(8);
    let (speech_mixer, speech_queue) = speech_mixer::open(sample_rate);
    let shared = Arc::new(Shared::default());
    let player = Player {
        engine: None,
        origin: 0,
        leaving: None,
        commands,
        engines,
        retired,
        speech_mixer,
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
        farewell: (FADE_OUT * f64::from(sample_rate)) as usize,
        frame: 0,
    };
    let clock = ClockMap::new(sample_rate);
    let handle =
        OutputHandle { commands: to_player, speech_queue, reference: from_player, shared, clock, sample_rate, lost: 0 };
    (
        player,
        handle,
        SynthInstaller { engines: new_engines, retired: old_engines, tails: to_tails, spent_tails: old_tails },
    )
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
        while let Ok(TimedCommand { command, generation }) = self.commands.pop() {
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
        self.shared.speaks.store(self.speech_mixer.is_speaking(), Ordering::Relaxed);
        let lost = self.engine.as_ref().map_or(0, |engine| engine.synth.lost());
        self.shared.lost.store(lost, Ordering::Relaxed);
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
        self.speech_mixer.mix(stereo);
        let volume = self.knobs.volume();
        self.second.feed(stereo, volume > 0.0, self.glide);
        for frame in stereo.as_chunks_mut::<2>().0 {
            let off = volume - self.gain;
            self.gain = if off.abs() < VOLUME_TOLERANCE { volume } else { self.gain + off * self.glide };
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

impl OutputHandle {
    /// Sample rate of the output, Hz.
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
    pub fn say(&mut self, words: &Utterance) {
        if words.samples.is_empty() || words.sample_rate == self.sample_rate {
            self.speech_queue.say(words.samples.clone());
        }
    }

    /// Commands lost so far: in the ring, or where the instruments that play had no room.
    pub fn lost(&self) -> u64 {
        self.lost + self.shared.lost.load(Ordering::Relaxed)
    }

    /// Sends commands with sample times of the simulation, whose present is `now`. Those of late steps are heard at once;
    /// where the steps made up for are so many that the ring has no room, only the last word of what goes on is sent.
    pub fn send(&mut self, now: u64, commands: &[SoundCommand], generation: u64) {
        let (played, block) = (self.shared.played.load(Ordering::Acquire), self.shared.block.load(Ordering::Relaxed));
        self.clock.look(now, played, block);
        let last = (commands.len() > self.commands.slots()).then(|| last_words(commands));
        for command in last.as_deref().unwrap_or(commands) {
            let command = command.at(self.clock.frame(command.sample()));
            // A ring that is full even so means that the device stands still; what it missed is not wanted later.
            self.lost += u64::from(self.commands.push(TimedCommand { command, generation }).is_err());
        }
    }
}

/// Of many late commands those that still matter: each strike, damp and silence, and the last wind, motion and slide of each
/// instrument.
fn last_words(commands: &[SoundCommand]) -> Vec<SoundCommand> {
    let goes_on = |command: &SoundCommand| match command {
        SoundCommand::Wind(wind) => Some((0, wind.instrument)),
        SoundCommand::Motion(motion) => Some((1, motion.instrument)),
        SoundCommand::Slide(slide) => Some((2, slide.instrument)),
        SoundCommand::Strike(_) | SoundCommand::Damp(_) | SoundCommand::Silence { .. } => None,
    };
    let mut said = BTreeSet::new();
    let from_the_end = commands.iter().rev().filter(|command| goes_on(command).is_none_or(|key| said.insert(key)));
    let mut last: Vec<SoundCommand> = from_the_end.copied().collect();
    last.reverse();
    last
}

impl SynthInstaller {
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

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_simulation::SAMPLES_PER_STEP;
    use soffio_sound::{InstrumentSpec, SoundBody, SoundMaterial, Strike, WindSound};

    const RATE: u32 = 48_000;
    const BLOCK: usize = 480;

    fn plate() -> Synth {
        let material = SoundMaterial { youngs_modulus: 2e11, poisson: 0.3, density: 7850.0, loss_factor: 6e-4 };
        let body = SoundBody { half_extents: [0.06; 2], thickness: 5e-4, area: 0.0113, mass: 0.044 };
        let spec = InstrumentSpec {
            timbre: "plate".into(),
            own: None,
            body,
            material,
            surface: None,
            gain: 1.0,
            max_voices: 8,
        };
        Synth::new(RATE, &[spec], 1).expect("a shipped timbre")
    }

    fn hit(sample: u64) -> SoundCommand {
        let position = [0.5, 0.1];
        let (impulse, speed, mass) = (1e-2, 1.0, 0.02);
        SoundCommand::Strike(Strike { sample, instrument: 0, impulse, speed, mass, position, pan: 0.0, distance: 1.0 })
    }

    fn play(player: &mut Player) -> f32 {
        let mut stereo = [0.0f32; 2 * BLOCK];
        player.play(&mut stereo);
        stereo.iter().fold(0.0, |most, x| most.max(x.abs()))
    }

    /// Steps of 4.17 ms beside blocks of 10 ms until both clocks are known; the sample at which it ends.
    fn settled(player: &mut Player, handle: &mut OutputHandle) -> u64 {
        let mut now = 0;
        for _ in 0..100 {
            for _ in 0..2 {
                now += SAMPLES_PER_STEP;
                handle.send(now, &[], 0);
            }
            // 2.4 steps a block.
            now += 80;
            assert_eq!(play(player), 0.0);
        }
        now
    }

    #[test]
    fn hits_of_steps_that_end_late_sound_in_the_next_block() {
        // Steps that are late: one, a fifth of a second, and as many as the pacer makes up for; commands of each.
        for (steps, winds) in [(1u64, 1usize), (48, 30), (60, 60)] {
            let (mut player, mut handle, mut installer) = open(RATE, 2, Arc::new(Knobs::new(1.0)));
            installer.exchange(Some(Engine { synth: Box::new(plate()), generation: 0 }));
            let now = settled(&mut player, &mut handle);
            let late = steps * SAMPLES_PER_STEP;
            // The loudspeaker goes on while they are computed.
            for _ in 0..=late / BLOCK as u64 {
                assert_eq!(play(&mut player), 0.0);
            }
            let mut commands = Vec::new();
            for step in 0..steps {
                let sample = now + step * SAMPLES_PER_STEP;
                commands.extend((0..winds).map(|_| SoundCommand::Wind(WindSound { sample, ..WindSound::default() })));
            }
            // Within the last late step, behind all that goes on.
            commands.push(hit(now + late - 150));
            handle.send(now + late, &commands, 0);
            let peak = play(&mut player).max(play(&mut player));
            assert!(peak > 0.01, "{steps} late steps: {peak}");
            assert_eq!(handle.lost(), 0, "{steps} late steps");
        }
    }

    #[test]
    fn the_last_word_of_what_goes_on_is_kept_with_every_hit_in_order() {
        let wind = |sample| SoundCommand::Wind(WindSound { sample, ..WindSound::default() });
        let all = [wind(1), hit(2), wind(3), hit(4), wind(5), hit(6)];
        assert_eq!(last_words(&all), [hit(2), hit(4), wind(5), hit(6)]);
    }
}
