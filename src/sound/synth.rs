//! The synthesizer: sound commands in, stereo out.
//!
//! Time is the sample counter [`Synth::position`]. A block is cut at commands and at the points of the control grid,
//! so each impact starts on its own sample, and the output does not depend on how the caller cuts its blocks.
//!
//! Invariant: same rate, instruments, seed and commands → the same bits, in debug and release, on all processors that
//! fuse multiply-adds and on all that do not ([`fuses`](super::modal::fuses)).
//!
//! Modal sound belongs to bodies and adds up there; other sound of an impact has its own voice.
//!
//! Real-time: after [`Synth::new`] nothing allocates, frees, locks or calls the system, and the work per sample is
//! bounded by [`MAX_VOICES`] + [`FADING_VOICES`] voices and by [`Synth::set_most_partials`].

use std::collections::VecDeque;

use super::controls::{ControlValues, MIN_DISTANCE, SustainedControls};
use super::ducking::Ducking;
use super::graph::{AudioBlock, Bus, CONTROL_PERIOD};
use super::instrument::Instrument;
use super::master::Master;
use super::repetition::RepetitionAttenuation;
use super::reverb::ReverbSpec;
use super::shared::Shared;
use super::sounding_body::{SoundingBody, SynthClock};
use super::timbre::{Inputs, MAX_NODES, Preset, TimbreError};
use super::voice::{Voice, VoiceState};
use super::{BodyMotion, Damp, InstrumentSpec, SoundCommand, Strike};
use soffio_math::noise::hash_words;
use soffio_math::{PI, sincos};

/// Default bound of the ringing partials: two and a half times the heaviest scene.
pub const MOST_PARTIALS: usize = 16_384;
/// Most voices of impacts at once; one more steals the quietest. It bounds the work; more are heard as one texture.
pub const MAX_VOICES: usize = 48;
/// Additional voices that fade after being stolen: a third of the voices can be stolen within one fade.
pub const FADING_VOICES: usize = 16;
/// Commands that can wait for their sample: several simulation steps of the busiest scene.
pub const MAX_COMMANDS: usize = 1024;

/// Fade of a stolen voice, s: short, yet without a click.
const STEAL_FADE: f64 = 0.003;
/// Duration of the fade of [`SoundCommand::Silence`], s: no click, and over before the next exhibit sounds.
const SILENCE_FADE: f64 = 0.04;
/// Plays the instruments of one exhibit.
pub struct Synth {
    sample_rate: f64,
    seed: u64,
    instruments: Vec<Instrument>,
    bodies: Vec<SoundingBody>,
    /// Index of an instrument's body.
    body_index: Vec<Option<usize>>,
    most_partials: usize,
    voices: Vec<Voice>,
    /// Voices from this index on are free.
    used_voices: usize,
    /// Sustained voices of wind, slides and motion.
    sustained: Vec<Voice>,
    controls: SustainedControls,
    /// In the order of their times.
    commands: VecDeque<SoundCommand>,
    blocks: Box<[AudioBlock; MAX_NODES]>,
    /// One for each instrument.
    repetitions: Vec<RepetitionAttenuation>,
    ducking: Ducking,
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
    ///
    /// # Errors
    /// An instrument names no shipped preset, or its preset does not fit its body.
    pub fn new(sample_rate: u32, instruments: &[InstrumentSpec], seed: u64) -> Result<Self, TimbreError> {
        let mut shared = Shared::default();
        let mut compiled = Vec::with_capacity(instruments.len());
        for spec in instruments {
            compiled.push(Instrument::compile(spec, &mut shared)?);
        }
        Ok(Self::with_instruments(sample_rate, compiled, seed))
    }

    /// A synth of one instrument with a preset that need not be a shipped one.
    ///
    /// # Errors
    /// The preset does not fit the body.
    pub fn with_preset(
        sample_rate: u32,
        preset: &Preset,
        spec: &InstrumentSpec,
        seed: u64,
    ) -> Result<Self, TimbreError> {
        Self::with_presets(sample_rate, &[(preset, spec)], seed)
    }

    /// A synth of instruments with presets that need not be shipped ones.
    ///
    /// # Errors
    /// A preset does not fit its body.
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
        let mut body_index = Vec::with_capacity(instruments.len());
        for (i, instrument) in instruments.iter().enumerate() {
            let bank = instrument.bank(hash_words(&[seed, i as u64]), sample_rate);
            body_index.push(bank.is_some().then_some(bodies.len()));
            bodies.extend(bank.map(|bank| SoundingBody::new(i, instrument, bank, sample_rate)));
        }
        let mut sustained = Vec::new();
        for (i, instrument) in instruments.iter().enumerate().filter(|(_, instrument)| !instrument.is_hit()) {
            let mut voice = Voice::new();
            voice.instrument = i;
            instrument.graph.allocate(&mut voice.operators, sample_rate);
            sustained.push(voice);
        }
        let mut voices: Vec<Voice> = (0..MAX_VOICES + FADING_VOICES).map(|_| Voice::new()).collect();
        for instrument in instruments.iter().filter(|instrument| instrument.is_hit()) {
            voices.iter_mut().for_each(|voice| instrument.graph.allocate(&mut voice.operators, sample_rate));
        }
        Self {
            controls: SustainedControls::new(instruments.len(), sample_rate),
            sample_rate,
            seed,
            repetitions: vec![RepetitionAttenuation::default(); instruments.len()],
            instruments,
            bodies,
            body_index,
            most_partials: MOST_PARTIALS,
            voices,
            used_voices: 0,
            sustained,
            commands: VecDeque::with_capacity(MAX_COMMANDS),
            blocks: Box::new([[0.0; CONTROL_PERIOD]; MAX_NODES]),
            ducking: Ducking::new(sample_rate),
            master: Master::new(sample_rate),
            dry: false,
            position: 0,
            strikes: 0,
            faults: 0,
            lost: 0,
        }
    }

    /// Sample rate, Hz.
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

    /// Bypasses reverb, night mode and limiter, and turns repetition attenuation and ducking off. To be called before the first sample, because
    /// it changes the latency.
    pub fn set_dry(&mut self, dry: bool) {
        self.dry = dry;
    }

    /// Sets the reverb; `None`, the initial state, is dry. Allocates.
    pub fn set_reverb(&mut self, reverb: Option<&ReverbSpec>) {
        self.master.set_reverb(reverb);
    }

    /// Turns night mode on or off with a fade; before the first sample immediately. Real-time.
    pub fn set_night(&mut self, night: bool) {
        self.master.set_night(night);
    }

    /// Bounds the ringing partials: the quietest are released first, in groups of sixteen.
    pub fn set_most_partials(&mut self, most: usize) {
        self.most_partials = most;
    }

    /// Number of sounding bodies and voices, sustained ones included.
    pub fn sounding(&self) -> usize {
        let voices = self.voices.iter().chain(&self.sustained).filter(|voice| voice.state != VoiceState::Free);
        voices.count() + self.bodies.iter().filter(|body| body.sounds()).count()
    }

    /// Number of ringing partials.
    pub fn partials(&self) -> usize {
        self.bodies.iter().map(|body| body.bank.ringing()).sum()
    }

    /// Number of commands and voices with invalid numbers so far; they were skipped.
    pub fn faults(&self) -> u64 {
        self.faults
    }

    /// Number of commands and voices dropped so far for lack of space.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Hertz contact time of a hit, s; `None` when there is no such instrument.
    pub fn contact_time(&self, instrument: u16, mass: f64, speed: f64) -> Option<f64> {
        self.instruments.get(usize::from(instrument)).map(|i| i.contact_time(mass, speed))
    }

    /// Queues a command for its sample. A command that is due or late is executed at once and needs no space in the queue, so a
    /// burst of late commands is not lost.
    pub fn command(&mut self, command: SoundCommand) {
        if !is_finite(&command) {
            self.faults += 1;
        } else if command.sample() <= self.position {
            self.execute_due();
            self.execute(command);
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
        let (mut left, mut right) = ([0.0f32; CONTROL_PERIOD], [0.0f32; CONTROL_PERIOD]);
        let (mut frames, rest) = out.as_chunks_mut::<2>();
        rest.fill(0.0);
        while !frames.is_empty() {
            let n = self.next_boundary(frames.len());
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

    /// Executes all that is due and returns the number of frames until the next boundary.
    fn next_boundary(&mut self, most: usize) -> usize {
        self.execute_due();
        let since_grid = (self.position % CONTROL_PERIOD as u64) as usize;
        if since_grid == 0 {
            self.grid_point();
        }
        let to_command = self.commands.front().map_or(u64::MAX, |command| command.sample() - self.position);
        most.min(CONTROL_PERIOD - since_grid).min(usize::try_from(to_command).unwrap_or(usize::MAX))
    }

    fn execute_due(&mut self) {
        while self.commands.front().is_some_and(|command| command.sample() <= self.position) {
            if let Some(command) = self.commands.pop_front() {
                self.execute(command);
            }
        }
    }

    fn execute(&mut self, command: SoundCommand) {
        match command {
            SoundCommand::Strike(strike) => self.strike(&strike),
            SoundCommand::Damp(damp) => self.damp(&damp),
            SoundCommand::Slide(_) | SoundCommand::Wind(_) | SoundCommand::Motion(_) => {
                if !self.controls.command(&command, self.position) {
                    self.faults += 1;
                }
            }
            SoundCommand::Silence { .. } => {
                let samples = (SILENCE_FADE * self.sample_rate) as f32;
                self.voices.iter_mut().for_each(|voice| voice.fade_out(samples));
                self.bodies.iter_mut().for_each(|body| body.fade_out(samples));
                self.controls.silence();
            }
        }
    }

    fn strike(&mut self, strike: &Strike) {
        let index = usize::from(strike.instrument);
        let Some(instrument) = self.instruments.get(index).filter(|instrument| instrument.is_struck()) else {
            self.faults += 1;
            return;
        };
        self.strikes += 1;
        let [l, r] = equal_power(f64::from(strike.pan));
        let time = self.position as f64 / self.sample_rate;
        let repetition_gain =
            if self.dry { 1.0 } else { self.repetitions[index].strike_gain(f64::from(strike.impulse), time) };
        let gain = repetition_gain * instrument.gain as f32 / strike.distance.max(MIN_DISTANCE);
        let gains = [l * gain, r * gain];
        let mut inputs = instrument.inputs(strike);
        self.controls.add_motion(index, &mut inputs);
        let clock = self.clock();
        if let Some(body) = self.body_index[index] {
            let since = (self.position % CONTROL_PERIOD as u64) as usize;
            let since = if since == 0 { CONTROL_PERIOD } else { since };
            if !self.bodies[body].strike(instrument, &inputs, gains, since, clock) {
                self.faults += 1;
                return;
            }
        }
        if !instrument.is_hit() || !instrument.graph.has(Bus::Voice) {
            return;
        }
        let most = instrument.max_voices;
        self.steal_voices(most, |voice| voice.instrument == index);
        self.steal_voices(MAX_VOICES, |_| true);
        let Some(free) = self.voices.iter().position(|voice| voice.state == VoiceState::Free) else {
            // All fading voices are in use: more than FADING_VOICES impacts in 3 ms. Only the modal part sounds.
            self.lost += 1;
            return;
        };
        self.used_voices = self.used_voices.max(free + 1);
        let (voice, instrument) = (&mut self.voices[free], &self.instruments[index]);
        let seed = hash_words(&[self.seed, self.strikes]);
        voice.begin(index, gains);
        voice.inputs = inputs;
        instrument.graph.begin(Bus::Voice, &mut voice.operators, &voice.inputs, seed, clock.time, clock.sample_rate);
        if let Some(body) = self.body_index[index].filter(|_| instrument.graph.drives()) {
            self.bodies[body].start_drive(instrument, &inputs, gains, clock);
        }
    }

    /// Sets the damping of a body by a resting contact.
    fn damp(&mut self, damp: &Damp) {
        let index = usize::from(damp.instrument);
        match self.body_index.get(index) {
            Some(Some(body)) => {
                let position = damp.position.map(f64::from);
                let bank = &mut self.bodies[*body].bank;
                self.instruments[index].damp(bank, position, f64::from(damp.resistance));
            }
            // It has no modal part.
            Some(None) => {}
            None => self.faults += 1,
        }
    }

    /// Time now, s, and the sample rate.
    fn clock(&self) -> SynthClock {
        SynthClock { time: self.position as f64 / self.sample_rate, sample_rate: self.sample_rate }
    }

    /// Steals the quietest of these voices if there are `most` already.
    fn steal_voices(&mut self, most: usize, among: impl Fn(&Voice) -> bool) {
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
        let SynthClock { time, sample_rate } = clock;
        self.controls.glide();
        for body in &mut self.bodies {
            self.controls.add_motion(body.instrument, &mut body.inputs);
            if !body.grid_point(&self.instruments[body.instrument], clock) {
                self.faults += 1;
            }
        }
        self.steal_partials();
        while self.used_voices > 0 && self.voices[self.used_voices - 1].state == VoiceState::Free {
            self.used_voices -= 1;
        }
        for voice in self.voices[..self.used_voices].iter_mut().filter(|voice| voice.state != VoiceState::Free) {
            let graph = &self.instruments[voice.instrument].graph;
            voice.grid_point(graph);
            self.controls.add_motion(voice.instrument, &mut voice.inputs);
            graph.control(Bus::Voice, &mut voice.operators, &voice.inputs, time, sample_rate);
        }
        for voice in &mut self.sustained {
            let instrument = &self.instruments[voice.instrument];
            let ControlValues { inputs, pan, distance, still_before, still } =
                self.controls.values(voice.instrument, instrument.player, self.position);
            let gains = equal_power(pan).map(|side| side * instrument.gain as f32 / distance);
            let drives = self.body_index[voice.instrument].filter(|_| instrument.graph.drives());
            match (voice.state, still) {
                (VoiceState::Free, true) => continue,
                (VoiceState::Free, false) => {
                    voice.begin(voice.instrument, gains);
                    let calm = Inputs { position: inputs.position, ..Inputs::default() };
                    let seed = hash_words(&[self.seed, voice.instrument as u64, u64::MAX]);
                    instrument.graph.begin(Bus::Voice, &mut voice.operators, &calm, seed, time, sample_rate);
                    if let Some(body) = drives {
                        self.bodies[body].start_drive(instrument, &inputs, gains, clock);
                    }
                }
                // The levels had one grid interval to reach their value in still air; modal sound decays by itself.
                (_, true) if still_before => {
                    voice.state = VoiceState::Free;
                    continue;
                }
                _ => {
                    if let Some(body) = drives {
                        self.bodies[body].continue_drive(instrument, &inputs, gains, clock);
                    }
                }
            }
            voice.gains = gains;
            voice.inputs = inputs;
            // Only what plays a sustained voice ends it.
            voice.state = VoiceState::Sounding;
            instrument.graph.control(Bus::Voice, &mut voice.operators, &voice.inputs, time, sample_rate);
        }
    }

    /// Releases the quietest partials while more than the bound ring.
    fn steal_partials(&mut self) {
        let mut ringing = self.partials();
        while ringing > self.most_partials {
            let quietest = self.bodies.iter().enumerate().filter_map(|(i, body)| {
                let (group, amplitude) = body.bank.quietest()?;
                Some((i, group, amplitude * body.loudest_gain()))
            });
            let Some((body, group, _)) = quietest.min_by(|a, b| a.2.total_cmp(&b.2)) else { return };
            ringing -= self.bodies[body].bank.release(group);
        }
    }

    fn mix(&mut self, left: &mut [f32], right: &mut [f32]) {
        let at = (self.position % CONTROL_PERIOD as u64) as usize;
        let n = left.len();
        let mut wind = [[0.0f32; CONTROL_PERIOD]; 2];
        let [wind_left, wind_right] = wind.each_mut().map(|side| &mut side[..n]);
        let mut blows = false;
        let voices = self.voices[..self.used_voices].iter_mut().chain(&mut self.sustained);
        for voice in voices.filter(|voice| voice.state != VoiceState::Free) {
            let instrument = &self.instruments[voice.instrument];
            let is_wind = instrument.is_hiss() && !self.dry;
            blows |= is_wind;
            let [left, right] = if is_wind { [&mut *wind_left, &mut *wind_right] } else { [&mut *left, &mut *right] };
            let body = self.body_index[voice.instrument].filter(|_| instrument.graph.drives());
            let force = body.map(|body| self.bodies[body].force(at));
            if !voice.mix(instrument, &mut self.blocks, left, right, force) {
                self.faults += 1;
            }
        }
        for body in self.bodies.iter_mut().filter(|body| body.sounds()) {
            body.mix(&self.instruments[body.instrument], &mut self.blocks, at, left, right);
        }
        if blows {
            self.ducking.mix([wind_left, wind_right], [left, right]);
        } else {
            self.ducking.skip([left, right]);
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
        SoundCommand::Wind(w) => [w.speed, w.gust, w.direction, w.pan, w.distance].iter().all(|v| v.is_finite()),
        SoundCommand::Motion(m) => {
            let BodyMotion { speed, spin, joint_force, tension, way, height, parameter } = m.motion;
            [speed, spin, joint_force, tension, way, height, parameter, m.pan, m.distance].iter().all(|v| v.is_finite())
        }
        SoundCommand::Silence { .. } => true,
    }
}
