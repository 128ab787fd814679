//! The synth: commands in, stereo out.
//!
//! Time is the sample counter [`Synth::position`]. A block is cut at commands and at the points of the control grid,
//! so each hit starts on its own sample, and the output does not depend on how the caller cuts its blocks.
//!
//! Invariant: same rate, instruments, seed and commands → the same bits, in debug and release, on all processors that
//! fuse multiply-adds and on all that do not ([`fuses`](super::modal::fuses)).
//!
//! What rings belongs to bodies and adds up there; what else a hit is heard by has a voice of its own.
//!
//! Real-time: after [`Synth::new`] nothing allocates, frees, locks or calls the system, and the work per sample is
//! bounded by [`MAX_VOICES`] + [`FADING_VOICES`] voices and by [`Synth::set_most_partials`].

use std::collections::VecDeque;

use super::body::Body;
use super::graph::{Block, CONTROL, Part};
use super::habit::Habit;
use super::instrument::Instrument;
use super::master::Master;
use super::motion::{Heard, Motion, NEAREST};
use super::reverb::ReverbSpec;
use super::shared::Shared;
use super::timbre::{Inputs, MAX_NODES, Preset, TimbreError};
use super::voice::{Voice, VoiceState};
use super::{Damp, InstrumentSpec, SoundCommand, Strike};
use soffio_math::noise::hash_words;
use soffio_math::{PI, sincos};

/// Partials that ring at once where nothing else is said: two and a half times the heaviest scene.
pub const MOST_PARTIALS: usize = 16_384;
/// Most hits with a voice of their own at once. One more makes the quietest fade.
pub const MAX_VOICES: usize = 48;
/// Places for voices that are fading because others took over.
pub const FADING_VOICES: usize = 16;
/// Commands that can wait.
pub const MAX_COMMANDS: usize = 1024;

/// A voice that must make room fades in this time, s: short, yet no click.
const STEAL_FADE: f64 = 0.003;
/// [`SoundCommand::Silence`] takes this long, s.
const SILENCE_FADE: f64 = 0.04;
/// Plays the instruments of one exhibit.
pub struct Synth {
    sample_rate: f64,
    seed: u64,
    instruments: Vec<Instrument>,
    bodies: Vec<Body>,
    /// Index of an instrument's body.
    body_of: Vec<Option<usize>>,
    most_partials: usize,
    voices: Vec<Voice>,
    /// None from here on sounds.
    used: usize,
    /// Voices that go on as long as the wind or a slide plays them.
    lasting: Vec<Voice>,
    motion: Motion,
    /// In the order of their times.
    commands: VecDeque<SoundCommand>,
    blocks: Box<[Block; MAX_NODES]>,
    /// One for each instrument.
    habits: Vec<Habit>,
    master: Master,
    dry: bool,
    position: u64,
    strikes: u64,
    faults: u64,
    lost: u64,
}

impl Synth {
    /// A silent synth at sample 0.
    ///
    /// Solves the plates' modes, so it takes milliseconds per instrument; everything afterwards is real-time.
    pub fn new(sample_rate: u32, instruments: &[InstrumentSpec], seed: u64) -> Result<Self, TimbreError> {
        let mut shared = Shared::default();
        let mut compiled = Vec::with_capacity(instruments.len());
        for spec in instruments {
            compiled.push(Instrument::compile(spec, &mut shared)?);
        }
        Ok(Self::with_instruments(sample_rate, compiled, seed))
    }

    /// A synth of one instrument with a preset that need not be a shipped one.
    pub fn with_preset(
        sample_rate: u32,
        preset: &Preset,
        spec: &InstrumentSpec,
        seed: u64,
    ) -> Result<Self, TimbreError> {
        Self::with_presets(sample_rate, &[(preset, spec)], seed)
    }

    /// A synth of instruments with presets that need not be shipped ones.
    pub fn with_presets(
        sample_rate: u32,
        instruments: &[(&Preset, &InstrumentSpec)],
        seed: u64,
    ) -> Result<Self, TimbreError> {
        let mut shared = Shared::default();
        let mut compiled = Vec::with_capacity(instruments.len());
        for (preset, spec) in instruments {
            compiled.push(Instrument::from_preset(preset, spec, &mut shared)?);
        }
        Ok(Self::with_instruments(sample_rate, compiled, seed))
    }

    /// A synth without a voice, for an exhibit whose instruments cannot be built.
    pub fn silent(sample_rate: u32) -> Self {
        Self::with_instruments(sample_rate, Vec::new(), 0)
    }

    fn with_instruments(sample_rate: u32, instruments: Vec<Instrument>, seed: u64) -> Self {
        let sample_rate = f64::from(sample_rate.max(1));
        let mut bodies = Vec::new();
        let mut body_of = Vec::with_capacity(instruments.len());
        for (i, instrument) in instruments.iter().enumerate() {
            let bank = instrument.bank(hash_words(&[seed, i as u64]), sample_rate);
            body_of.push(bank.is_some().then_some(bodies.len()));
            bodies.extend(bank.map(|bank| Body::new(i, instrument, bank, sample_rate)));
        }
        let mut lasting = Vec::new();
        for (i, instrument) in instruments.iter().enumerate().filter(|(_, instrument)| !instrument.is_hit()) {
            let mut voice = Voice::new();
            voice.instrument = i;
            instrument.graph.make_room(&mut voice.operators, sample_rate);
            lasting.push(voice);
        }
        let mut voices: Vec<Voice> = (0..MAX_VOICES + FADING_VOICES).map(|_| Voice::new()).collect();
        for instrument in instruments.iter().filter(|instrument| instrument.is_hit()) {
            voices.iter_mut().for_each(|voice| instrument.graph.make_room(&mut voice.operators, sample_rate));
        }
        Self {
            motion: Motion::new(instruments.len(), sample_rate),
            sample_rate,
            seed,
            habits: vec![Habit::default(); instruments.len()],
            instruments,
            bodies,
            body_of,
            most_partials: MOST_PARTIALS,
            voices,
            used: 0,
            lasting,
            commands: VecDeque::with_capacity(MAX_COMMANDS),
            blocks: Box::new([[0.0; CONTROL]; MAX_NODES]),
            master: Master::new(sample_rate),
            dry: false,
            position: 0,
            strikes: 0,
            faults: 0,
            lost: 0,
        }
    }

    /// Hz.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate as u32
    }

    /// Frames rendered so far: the synth's clock.
    pub fn position(&self) -> u64 {
        self.position
    }

    /// Frames by which the output comes after the synth's clock: the limiter's look-ahead, 0 when dry.
    pub fn latency(&self) -> usize {
        if self.dry { 0 } else { self.master.latency() }
    }

    /// Bypasses room, limiter and whatever else comes after the sum of all sounds, and eases no repetition. To be called
    /// before the first sample: it changes the latency.
    pub fn set_dry(&mut self, dry: bool) {
        self.dry = dry;
    }

    /// The room that all is heard in; `None`, which is also the beginning, is the open air. Allocates.
    pub fn set_reverb(&mut self, room: Option<&ReverbSpec>) {
        self.master.set_room(room);
    }

    /// The night's sound or the day's, to which it glides; before the first sample it is so at once. Real-time.
    pub fn set_night(&mut self, night: bool) {
        self.master.set_night(night);
    }

    /// Bounds the partials that ring at once: the quietest leave first, by groups of sixteen.
    pub fn set_most_partials(&mut self, most: usize) {
        self.most_partials = most;
    }

    /// Bodies and voices that sound now, the wind's included.
    pub fn sounding(&self) -> usize {
        let voices = self.voices.iter().chain(&self.lasting).filter(|voice| voice.state != VoiceState::Free);
        voices.count() + self.bodies.iter().filter(|body| body.sounds()).count()
    }

    /// Partials that ring now.
    pub fn partials(&self) -> usize {
        self.bodies.iter().map(|body| body.bank.ringing()).sum()
    }

    /// Commands and voices with bad numbers so far; they were left out.
    pub fn faults(&self) -> u64 {
        self.faults
    }

    /// Commands that found no room so far.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Hertz contact time of a hit, s; `None` when there is no such instrument.
    pub fn contact_time(&self, instrument: u16, mass: f64, speed: f64) -> Option<f64> {
        self.instruments.get(usize::from(instrument)).map(|i| i.contact_time(mass, speed))
    }

    /// Takes a command for its own time; one whose time has come or is over is carried out at once, and needs no room: a
    /// burst of late ones is heard, however many wait for their time.
    pub fn command(&mut self, command: SoundCommand) {
        if !is_finite(&command) {
            self.faults += 1;
        } else if command.sample() <= self.position {
            self.carry_out_due();
            self.carry_out(command);
        } else if self.commands.len() == MAX_COMMANDS {
            self.lost += 1;
        } else {
            // Commands come nearly in order: look for the place from the end. Equal times keep their order.
            let time = command.sample();
            let after = self.commands.iter().rposition(|c| c.sample() <= time).map_or(0, |i| i + 1);
            self.commands.insert(after, command);
        }
    }

    /// Renders interleaved stereo, left first; a last odd sample is left silent.
    pub fn render(&mut self, out: &mut [f32]) {
        let (mut left, mut right) = ([0.0f32; CONTROL], [0.0f32; CONTROL]);
        let (mut frames, rest) = out.as_chunks_mut::<2>();
        rest.fill(0.0);
        while !frames.is_empty() {
            let n = self.next_cut(frames.len());
            let (now, later) = frames.split_at_mut(n);
            let (left, right) = (&mut left[..n], &mut right[..n]);
            left.fill(0.0);
            right.fill(0.0);
            self.mix(left, right);
            for ((frame, l), r) in now.iter_mut().zip(left).zip(right) {
                *frame = [*l, *r];
            }
            self.position += n as u64;
            frames = later;
        }
        if !self.dry {
            self.master.process(out.as_chunks_mut::<2>().0);
        }
    }

    /// Carries out what is due now and tells how many frames there are until the next thing is.
    fn next_cut(&mut self, most: usize) -> usize {
        self.carry_out_due();
        let since_grid = (self.position % CONTROL as u64) as usize;
        if since_grid == 0 {
            self.grid_point();
        }
        let to_command = self.commands.front().map_or(u64::MAX, |command| command.sample() - self.position);
        most.min(CONTROL - since_grid).min(usize::try_from(to_command).unwrap_or(usize::MAX))
    }

    fn carry_out_due(&mut self) {
        while self.commands.front().is_some_and(|command| command.sample() <= self.position) {
            if let Some(command) = self.commands.pop_front() {
                self.carry_out(command);
            }
        }
    }

    fn carry_out(&mut self, command: SoundCommand) {
        match command {
            SoundCommand::Strike(strike) => self.strike(&strike),
            SoundCommand::Damp(touch) => self.touch(&touch),
            SoundCommand::Slide(_) | SoundCommand::Wind(_) | SoundCommand::WindExposure(_) => {
                if !self.motion.command(&command) {
                    self.faults += 1;
                }
            }
            SoundCommand::Silence { .. } => {
                let samples = (SILENCE_FADE * self.sample_rate) as f32;
                self.voices.iter_mut().for_each(|voice| voice.fade_out(samples));
                self.bodies.iter_mut().for_each(|body| body.fade_out(samples));
                self.motion.silence();
            }
        }
    }

    fn strike(&mut self, strike: &Strike) {
        let index = usize::from(strike.instrument);
        let Some(instrument) = self.instruments.get(index).filter(|instrument| instrument.is_hit()) else {
            self.faults += 1;
            return;
        };
        self.strikes += 1;
        let [l, r] = equal_power(f64::from(strike.pan));
        let time = self.position as f64 / self.sample_rate;
        let eased = if self.dry { 1.0 } else { self.habits[index].hit(f64::from(strike.impulse), time) };
        let gain = eased * instrument.gain as f32 / strike.distance.max(NEAREST);
        let gains = [l * gain, r * gain];
        let inputs = instrument.inputs(strike);
        let clock = self.clock();
        if let Some(body) = self.body_of[index] {
            let since = (self.position % CONTROL as u64) as usize;
            let since = if since == 0 { CONTROL } else { since };
            if !self.bodies[body].strike(instrument, &inputs, gains, since, clock) {
                self.faults += 1;
                return;
            }
        }
        if !instrument.graph.has(Part::Hit) {
            return;
        }
        let most = instrument.max_voices;
        self.make_room(most, |voice| voice.instrument == index);
        self.make_room(MAX_VOICES, |_| true);
        let Some(free) = self.voices.iter().position(|voice| voice.state == VoiceState::Free) else {
            // Every place fades: more than FADING_VOICES hits in 3 ms. Its click is not heard; what rings is.
            self.lost += 1;
            return;
        };
        self.used = self.used.max(free + 1);
        let (voice, instrument) = (&mut self.voices[free], &self.instruments[index]);
        let seed = hash_words(&[self.seed, self.strikes]);
        voice.begin(index, gains);
        voice.inputs = inputs;
        instrument.graph.begin(Part::Hit, &mut voice.operators, &voice.inputs, seed, clock.0, clock.1);
        if let Some(body) = self.body_of[index].filter(|_| instrument.graph.drives()) {
            self.bodies[body].push(instrument, &inputs, gains, clock);
        }
    }

    /// Something rests on a body from now on, or no longer.
    fn touch(&mut self, touch: &Damp) {
        let index = usize::from(touch.instrument);
        match self.body_of.get(index) {
            Some(Some(body)) => {
                let position = touch.position.map(f64::from);
                let bank = &mut self.bodies[*body].bank;
                self.instruments[index].touch(bank, position, f64::from(touch.resistance));
            }
            // Nothing of it rings.
            Some(None) => {}
            None => self.faults += 1,
        }
    }

    /// Time now, s, and the sample rate.
    fn clock(&self) -> (f64, f64) {
        (self.position as f64 / self.sample_rate, self.sample_rate)
    }

    /// Lets the quietest of these voices fade until there is room for one more among `most`.
    fn make_room(&mut self, most: usize, among: impl Fn(&Voice) -> bool) {
        let samples = (STEAL_FADE * self.sample_rate) as f32;
        let sounding = |voice: &Voice| voice.state == VoiceState::Sounding && among(voice);
        if self.voices.iter().filter(|voice| sounding(voice)).count() < most {
            return;
        }
        let quietest =
            self.voices.iter_mut().filter(|voice| sounding(voice)).min_by(|a, b| a.loudness().total_cmp(&b.loudness()));
        if let Some(voice) = quietest {
            voice.fade_out(samples);
        }
    }

    /// A point of the control grid.
    fn grid_point(&mut self) {
        let clock = self.clock();
        let (time, sample_rate) = clock;
        for body in &mut self.bodies {
            if !body.grid_point(&self.instruments[body.instrument], clock) {
                self.faults += 1;
            }
        }
        self.keep_few();
        while self.used > 0 && self.voices[self.used - 1].state == VoiceState::Free {
            self.used -= 1;
        }
        for voice in self.voices[..self.used].iter_mut().filter(|voice| voice.state != VoiceState::Free) {
            let graph = &self.instruments[voice.instrument].graph;
            voice.grid_point(graph);
            graph.control(Part::Hit, &mut voice.operators, &voice.inputs, time, sample_rate);
        }
        self.motion.glide();
        for voice in &mut self.lasting {
            let instrument = &self.instruments[voice.instrument];
            let Heard { inputs, pan, distance, still_before, still } =
                self.motion.heard(voice.instrument, instrument.player);
            let gains = equal_power(pan).map(|side| side * instrument.gain as f32 / distance);
            let drives = self.body_of[voice.instrument].filter(|_| instrument.graph.drives());
            match (voice.state, still) {
                (VoiceState::Free, true) => continue,
                (VoiceState::Free, false) => {
                    voice.begin(voice.instrument, gains);
                    let calm = Inputs { position: inputs.position, ..Inputs::default() };
                    let seed = hash_words(&[self.seed, voice.instrument as u64, u64::MAX]);
                    instrument.graph.begin(Part::Hit, &mut voice.operators, &calm, seed, time, sample_rate);
                    if let Some(body) = drives {
                        self.bodies[body].push(instrument, &inputs, gains, clock);
                    }
                }
                // The levels had one grid interval to reach their value in still air; what rings, rings out.
                (_, true) if still_before => {
                    voice.state = VoiceState::Free;
                    continue;
                }
                _ => {
                    if let Some(body) = drives {
                        self.bodies[body].push_on(instrument, &inputs, gains, clock);
                    }
                }
            }
            voice.gains = gains;
            voice.inputs = inputs;
            // Only the wind and the slide end it.
            voice.state = VoiceState::Sounding;
            instrument.graph.control(Part::Hit, &mut voice.operators, &voice.inputs, time, sample_rate);
        }
    }

    /// Lets the quietest partials go while more ring than may.
    fn keep_few(&mut self) {
        let mut ringing = self.partials();
        while ringing > self.most_partials {
            let quietest = self.bodies.iter().enumerate().filter_map(|(i, body)| {
                let (group, amplitude) = body.bank.quietest()?;
                Some((i, group, amplitude * body.loudest_gain()))
            });
            let Some((body, group, _)) = quietest.min_by(|a, b| a.2.total_cmp(&b.2)) else { return };
            ringing -= self.bodies[body].bank.leave(group);
        }
    }

    fn mix(&mut self, left: &mut [f32], right: &mut [f32]) {
        let at = (self.position % CONTROL as u64) as usize;
        let voices = self.voices[..self.used].iter_mut().chain(&mut self.lasting);
        for voice in voices.filter(|voice| voice.state != VoiceState::Free) {
            let instrument = &self.instruments[voice.instrument];
            let body = self.body_of[voice.instrument].filter(|_| instrument.graph.drives());
            let force = body.map(|body| self.bodies[body].force(at));
            if !voice.mix(instrument, &mut self.blocks, left, right, force) {
                self.faults += 1;
            }
        }
        for body in self.bodies.iter_mut().filter(|body| body.sounds()) {
            body.mix(&self.instruments[body.instrument], &mut self.blocks, at, left, right);
        }
    }
}

/// Left and right with l² + r² = 1 for a pan of −1…1.
fn equal_power(pan: f64) -> [f32; 2] {
    let (s, c) = sincos((pan.clamp(-1.0, 1.0) + 1.0) * PI / 4.0);
    [c as f32, s as f32]
}

fn is_finite(command: &SoundCommand) -> bool {
    match command {
        SoundCommand::Strike(s) => {
            [s.impulse, s.speed, s.mass, s.position[0], s.position[1], s.pan, s.distance].iter().all(|v| v.is_finite())
                && s.impulse >= 0.0
        }
        SoundCommand::Damp(t) => {
            [t.position[0], t.position[1], t.resistance].iter().all(|v| v.is_finite()) && t.resistance >= 0.0
        }
        SoundCommand::Slide(s) => {
            [s.speed, s.force, s.position[0], s.position[1], s.pan, s.distance].iter().all(|v| v.is_finite())
        }
        SoundCommand::Wind(w) => [w.speed, w.gust, w.direction, w.pan].iter().all(|v| v.is_finite()),
        SoundCommand::WindExposure(across) => across.share.is_finite(),
        SoundCommand::Silence { .. } => true,
    }
}
