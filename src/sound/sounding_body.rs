//! A sounding body: its bank of partials, its look-ahead samples, and its position about the listener.
//!
//! Blocks lie on the synth's control grid. At a grid point the bank renders the next block; impacts between two grid points
//! add to the look-ahead samples. The force of voices on the body ([`SoundingBody::force`]) sounds one block later, 1.3 ms at
//! 48 kHz, when it is complete, however the caller cuts its blocks.

use super::bounds::{FAULT_LEVEL, INAUDIBLE};
use super::excitation::LONGEST_CONTACT;
use super::graph::{AudioBlock, Bus, CONTROL_PERIOD, OperatorState};
use super::instrument::{DriveMove, Instrument};
use super::modal::{BLOCK, Bank};
use super::timbre::{Inputs, MAX_NODES};
use super::true_peak::peak;

const _: () = assert!(BLOCK == CONTROL_PERIOD, "banks are rendered on the control grid");

/// Share of the step to the target gains per grid point: a time constant of 20 ms at 48 kHz.
const GAIN_GLIDE: f32 = 0.065;
/// Grid points of silence after which a body is at rest: 21 ms at 48 kHz, longer than the longest contact.
const QUIET_GRID_POINTS: u32 = 16;
/// Moves of a contact below this are ignored, in half extents of the body: shapes change by less than a per cent.
const LEAST_MOVE: f64 = 2e-3;
/// Impacts on one body between two grid points that are executed one by one; more merge at the next grid point. It
/// bounds the work of a block.
const MAX_STRIKES: u32 = 6;

/// Time of the synth.
#[derive(Clone, Copy, Debug)]
pub(super) struct SynthClock {
    /// Time since sample 0, s.
    pub time: f64,
    /// Sample rate, Hz.
    pub sample_rate: f64,
}

/// The modal part of one instrument.
pub(super) struct SoundingBody {
    /// Index of its instrument in the synth.
    pub instrument: usize,
    /// Its partials.
    pub bank: Bank,
    operators: Box<[OperatorState; MAX_NODES]>,
    /// Values of the inputs that its numbers are bound to.
    pub inputs: Inputs,
    /// The block that is playing, and the contribution of impacts to later blocks.
    look_ahead: Vec<f32>,
    /// End of the last sample of `look_ahead` that is not 0.
    look_ahead_end: usize,
    /// Sum of the forces since the last grid point, N, and whether there was any.
    force: [f32; BLOCK],
    is_driven: bool,
    /// Where on the body it acts, −1…1.
    drive_point: [f64; 2],
    /// Gains of left and right, distance included: now, change per sample, and target.
    gains: [f32; 2],
    steps: [f32; 2],
    target_gains: [f32; 2],
    /// Fade-out gain.
    fade: f32,
    fade_step: f32,
    /// Largest sample since the last grid point.
    peak: f32,
    quiet: u32,
    sounds: bool,
    /// Impacts since the last grid point, and the merged one that pends.
    strikes: u32,
    pending: Option<(Inputs, [f32; 2])>,
}

impl SoundingBody {
    /// A silent body; `index` is that of its instrument in the synth.
    pub fn new(index: usize, instrument: &Instrument, bank: Bank, sample_rate: f64) -> Self {
        let mut operators = Box::new(std::array::from_fn(|_| OperatorState::new(0)));
        instrument.graph.allocate(&mut operators, sample_rate);
        Self {
            instrument: index,
            bank,
            operators,
            inputs: Inputs::default(),
            look_ahead: vec![0.0; Bank::look_ahead_len(LONGEST_CONTACT, sample_rate)],
            look_ahead_end: 0,
            force: [0.0; BLOCK],
            is_driven: false,
            drive_point: [0.0; 2],
            gains: [0.0; 2],
            steps: [0.0; 2],
            target_gains: [0.0; 2],
            fade: 1.0,
            fade_step: 0.0,
            peak: 0.0,
            quiet: 0,
            sounds: false,
            strikes: 0,
            pending: None,
        }
    }

    /// Whether it sounds.
    pub fn sounds(&self) -> bool {
        self.sounds
    }

    /// Greater gain of the two sides at the listener.
    pub fn loudest_gain(&self) -> f64 {
        f64::from(self.target_gains[0].max(self.target_gains[1]))
    }

    /// Fades out in `samples`.
    pub fn fade_out(&mut self, samples: f32) {
        if self.sounds {
            self.fade_step = -1.0 / samples;
        }
    }

    /// An impact `since` samples after the last grid point (1 … [`BLOCK`]). `false` for invalid numbers.
    #[must_use]
    pub fn strike(
        &mut self,
        instrument: &Instrument,
        inputs: &Inputs,
        gains: [f32; 2],
        since: usize,
        clock: SynthClock,
    ) -> bool {
        self.strikes += 1;
        if self.strikes > MAX_STRIKES {
            let impulse = self.pending.map_or(0.0, |(pending, _)| pending.impulse);
            self.pending = Some((Inputs { impulse: impulse + inputs.impulse, ..*inputs }, gains));
            return inputs.impulse.is_finite();
        }
        self.begin(instrument, inputs, gains, clock);
        let reached = instrument.strike(&mut self.bank, inputs, since, &mut self.look_ahead);
        self.look_ahead_end = self.look_ahead_end.max(reached.unwrap_or_default());
        reached.is_some()
    }

    /// Starts to sound at this position.
    fn begin(&mut self, instrument: &Instrument, inputs: &Inputs, gains: [f32; 2], clock: SynthClock) {
        self.target_gains = gains;
        self.inputs = *inputs;
        self.quiet = 0;
        // Partials below the bound at the listener end.
        self.bank.set_threshold(INAUDIBLE / self.loudest_gain().max(1e-6));
        if !self.sounds {
            self.sounds = true;
            (self.gains, self.steps) = (gains, [0.0; 2]);
            (self.fade, self.fade_step) = (1.0, 0.0);
            instrument.graph.begin(Bus::Body, &mut self.operators, inputs, 0, clock.time, clock.sample_rate);
        } else if self.fade_step < 0.0 {
            self.fade_step = 1.0 / BLOCK as f32;
        }
    }

    /// The force buffer from `at` samples after the last grid point on.
    pub fn force(&mut self, at: usize) -> &mut [f32] {
        self.is_driven = true;
        &mut self.force[at..]
    }

    /// A voice starts to drive it at this position.
    pub fn start_drive(&mut self, instrument: &Instrument, inputs: &Inputs, gains: [f32; 2], clock: SynthClock) {
        self.begin(instrument, inputs, gains, clock);
        self.drive_point = inputs.position;
        instrument.set_drive_point(&mut self.bank, inputs, DriveMove::Jump, clock.sample_rate);
    }

    /// The voice continues to drive it at this position.
    pub fn continue_drive(&mut self, instrument: &Instrument, inputs: &Inputs, gains: [f32; 2], clock: SynthClock) {
        if !self.sounds {
            self.start_drive(instrument, inputs, gains, clock);
            return;
        }
        (self.target_gains, self.inputs) = (gains, *inputs);
        if (0..2).any(|k| (inputs.position[k] - self.drive_point[k]).abs() > LEAST_MOVE) {
            self.drive_point = inputs.position;
            instrument.set_drive_point(&mut self.bank, inputs, DriveMove::Glide, clock.sample_rate);
        }
    }

    /// Renders the next block. `false` for invalid numbers; the body is then silent.
    #[must_use]
    pub fn grid_point(&mut self, instrument: &Instrument, clock: SynthClock) -> bool {
        let mut valid = true;
        self.strikes = 0;
        if let Some((inputs, gains)) = self.pending.take() {
            valid = self.strike(instrument, &inputs, gains, BLOCK, clock);
        }
        if !self.sounds {
            return valid;
        }
        if self.fade == 0.0 {
            self.rest();
            return valid;
        }
        let kept = self.look_ahead_end.saturating_sub(BLOCK);
        self.look_ahead.copy_within(BLOCK..BLOCK + kept, 0);
        self.look_ahead[kept..self.look_ahead_end.max(BLOCK)].fill(0.0);
        let block = self.look_ahead.first_chunk_mut::<BLOCK>().expect("room for two blocks");
        self.bank.render(self.is_driven.then_some(&self.force), block);
        if std::mem::take(&mut self.is_driven) {
            self.force = [0.0; BLOCK];
        }
        self.look_ahead_end = kept.max(BLOCK);
        // The comparison is false for NaN too.
        if !block.iter().fold(true, |valid, y| valid & (y.abs() < FAULT_LEVEL)) {
            self.rest();
            return false;
        }
        let quiet = std::mem::take(&mut self.peak) < INAUDIBLE as f32 && !instrument.graph.holds(&self.operators);
        let silent = self.bank.ringing() == 0 && quiet;
        self.quiet = if silent { self.quiet + 1 } else { 0 };
        if self.quiet > QUIET_GRID_POINTS {
            self.rest();
            return valid;
        }
        for side in 0..2 {
            self.steps[side] = (self.target_gains[side] - self.gains[side]) * GAIN_GLIDE / BLOCK as f32;
        }
        instrument.graph.control(Bus::Body, &mut self.operators, &self.inputs, clock.time, clock.sample_rate);
        valid
    }

    /// Clears all state.
    pub fn rest(&mut self) {
        self.bank.clear();
        self.look_ahead.fill(0.0);
        self.look_ahead_end = 0;
        self.sounds = false;
        self.is_driven = false;
        self.force = [0.0; BLOCK];
        self.pending = None;
    }

    /// Adds the samples from `at` after the last grid point on to the mix.
    pub fn mix(
        &mut self,
        instrument: &Instrument,
        blocks: &mut [AudioBlock; MAX_NODES],
        at: usize,
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let n = left.len();
        let ringing = &self.look_ahead[at..at + n];
        let (out, _) = instrument.graph.render(Bus::Body, &mut self.operators, ringing, blocks, n);
        self.peak = self.peak.max(peak(out));
        let mut faded = [0.0; CONTROL_PERIOD];
        let faded = &mut faded[..n];
        faded.copy_from_slice(out);
        if self.fade != 1.0 || self.fade_step != 0.0 {
            for sample in &mut *faded {
                *sample *= self.fade;
                self.fade = (self.fade + self.fade_step).clamp(0.0, 1.0);
            }
        }
        for ((mix, gain), step) in [left, right].into_iter().zip(&mut self.gains).zip(self.steps) {
            add_gliding(faded, gain, step, mix);
        }
    }
}

/// Adds samples with a gain that changes by `step` a sample.
fn add_gliding(samples: &[f32], gain: &mut f32, step: f32, mix: &mut [f32]) {
    if *gain + step == *gain {
        // The gain is constant to the last bit: no dependency between samples.
        let gain = *gain;
        mix.iter_mut().zip(samples).for_each(|(y, x)| *y += x * gain);
        return;
    }
    for (y, x) in mix.iter_mut().zip(samples) {
        *y += x * *gain;
        *gain += step;
    }
}
