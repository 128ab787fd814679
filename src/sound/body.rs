//! A sounding body: its bank of partials, the samples that are ready, and where it is heard.
//!
//! Blocks lie on the synth's control grid. At a grid point the bank renders the next block; hits between two grid points
//! add to the samples that are ready. What voices push the body with ([`Body::force`]) is heard one block later,
//! 1.3 ms at 48 kHz: then it is complete, however the caller cuts his blocks.

use super::excitation::LONGEST_CONTACT;
use super::graph::{Block, CONTROL, Part, State};
use super::instrument::Instrument;
use super::modal::{BLOCK, Bank};
use super::timbre::{Inputs, MAX_NODES};
use super::true_peak::peak;
use super::voice::BROKEN;

const _: () = assert!(BLOCK == CONTROL, "banks are rendered on the control grid");

/// Partials below this at the listener are over: −100 dB of full scale.
const INAUDIBLE: f64 = 1e-5;
/// Share of the way to where it is heard from, per grid point: 20 ms.
const GLIDE: f32 = 0.065;
/// Grid points of silence after which a body is at rest.
const QUIET_GRID_POINTS: u32 = 16;
/// A contact that has moved by less than this part of the body's half extents acts where it did.
const MOVED: f64 = 2e-3;
/// Hits of one body between two grid points that are carried out one by one; more are one hit at the next grid point.
const HITS: u32 = 6;

/// What rings of one instrument.
pub(super) struct Body {
    pub instrument: usize,
    pub bank: Bank,
    operators: Box<[State; MAX_NODES]>,
    inputs: Inputs,
    /// What the bank and the hits have made ready: the block that is playing, and what hits will add to those after it.
    ahead: Vec<f32>,
    /// Behind the last sample of `ahead` that is not 0.
    ready: usize,
    /// Sum of the forces since the last grid point, N, and whether there was one.
    force: [f32; BLOCK],
    pushed: bool,
    /// Where on the body it acts.
    pushed_at: [f64; 2],
    /// Left and right, distance included: now, their change per sample, and where they go.
    gains: [f32; 2],
    steps: [f32; 2],
    places: [f32; 2],
    /// Falls to 0 when the body is to be silent.
    fade: f32,
    fade_step: f32,
    /// Largest sample since the last grid point.
    peak: f32,
    quiet: u32,
    sounds: bool,
    /// Hits since the last grid point, and those that are to be one.
    hits: u32,
    waiting: Option<(Inputs, [f32; 2])>,
}

impl Body {
    pub fn new(index: usize, instrument: &Instrument, bank: Bank, sample_rate: f64) -> Self {
        let mut operators = Box::new(std::array::from_fn(|_| State::new(0)));
        instrument.graph.make_room(&mut operators, sample_rate);
        Self {
            instrument: index,
            bank,
            operators,
            inputs: Inputs::default(),
            ahead: vec![0.0; Bank::reach(LONGEST_CONTACT, sample_rate)],
            ready: 0,
            force: [0.0; BLOCK],
            pushed: false,
            pushed_at: [0.0; 2],
            gains: [0.0; 2],
            steps: [0.0; 2],
            places: [0.0; 2],
            fade: 1.0,
            fade_step: 0.0,
            peak: 0.0,
            quiet: 0,
            sounds: false,
            hits: 0,
            waiting: None,
        }
    }

    /// Whether it is heard.
    pub fn sounds(&self) -> bool {
        self.sounds
    }

    /// How loud a bank's amplitude is at the listener.
    pub fn loudest_gain(&self) -> f64 {
        f64::from(self.places[0].max(self.places[1]))
    }

    /// Falls to silence in `samples`.
    pub fn fade_out(&mut self, samples: f32) {
        if self.sounds {
            self.fade_step = -1.0 / samples;
        }
    }

    /// A hit, `since` samples after the last grid point (1 … [`BLOCK`]). `false`: it cannot be played.
    #[must_use]
    pub fn strike(
        &mut self,
        instrument: &Instrument,
        inputs: &Inputs,
        gains: [f32; 2],
        since: usize,
        clock: (f64, f64),
    ) -> bool {
        self.hits += 1;
        if self.hits > HITS {
            let impulse = self.waiting.map_or(0.0, |(waiting, _)| waiting.impulse);
            self.waiting = Some((Inputs { impulse: impulse + inputs.impulse, ..*inputs }, gains));
            return inputs.impulse.is_finite();
        }
        self.begin(instrument, inputs, gains, clock);
        let reached = instrument.strike(&mut self.bank, inputs, since, &mut self.ahead);
        self.ready = self.ready.max(reached.unwrap_or_default());
        reached.is_some()
    }

    /// Wakes it, and lets it be heard from where it is now.
    fn begin(&mut self, instrument: &Instrument, inputs: &Inputs, gains: [f32; 2], (time, sample_rate): (f64, f64)) {
        self.places = gains;
        self.inputs = *inputs;
        self.quiet = 0;
        self.bank.set_threshold(INAUDIBLE / self.loudest_gain().max(1e-6));
        if !self.sounds {
            self.sounds = true;
            (self.gains, self.steps) = (gains, [0.0; 2]);
            (self.fade, self.fade_step) = (1.0, 0.0);
            instrument.graph.begin(Part::Body, &mut self.operators, inputs, 0, time, sample_rate);
        } else if self.fade_step < 0.0 {
            self.fade_step = 1.0 / BLOCK as f32;
        }
    }

    /// Adds a force from `at` samples after the last grid point on.
    pub fn force(&mut self, at: usize) -> &mut [f32] {
        self.pushed = true;
        &mut self.force[at..]
    }

    /// A voice pushes it: it sounds, from there.
    pub fn push(&mut self, instrument: &Instrument, inputs: &Inputs, gains: [f32; 2], clock: (f64, f64)) {
        self.begin(instrument, inputs, gains, clock);
        self.pushed_at = inputs.position;
        instrument.push_at(&mut self.bank, inputs, false, clock.1);
    }

    /// The voice that pushes it goes on, from there.
    pub fn push_on(&mut self, instrument: &Instrument, inputs: &Inputs, gains: [f32; 2], clock: (f64, f64)) {
        if !self.sounds {
            self.push(instrument, inputs, gains, clock);
            return;
        }
        (self.places, self.inputs) = (gains, *inputs);
        if (0..2).any(|k| (inputs.position[k] - self.pushed_at[k]).abs() > MOVED) {
            self.pushed_at = inputs.position;
            instrument.push_at(&mut self.bank, inputs, true, clock.1);
        }
    }

    /// A grid point: the next block is made. `false`: bad numbers were found; the body is silent and at rest.
    #[must_use]
    pub fn grid_point(&mut self, instrument: &Instrument, clock: (f64, f64)) -> bool {
        let mut fine = true;
        self.hits = 0;
        if let Some((inputs, gains)) = self.waiting.take() {
            fine = self.strike(instrument, &inputs, gains, BLOCK, clock);
        }
        if !self.sounds {
            return fine;
        }
        if self.fade == 0.0 {
            self.rest();
            return fine;
        }
        let kept = self.ready.saturating_sub(BLOCK);
        self.ahead.copy_within(BLOCK..BLOCK + kept, 0);
        self.ahead[kept..self.ready.max(BLOCK)].fill(0.0);
        let block = self.ahead.first_chunk_mut::<BLOCK>().expect("room for two blocks");
        self.bank.render(self.pushed.then_some(&self.force), block);
        if std::mem::take(&mut self.pushed) {
            self.force = [0.0; BLOCK];
        }
        self.ready = kept.max(BLOCK);
        // Not a number is not below either.
        if !block.iter().fold(true, |fine, y| fine & (y.abs() < BROKEN)) {
            self.rest();
            return false;
        }
        let quiet = std::mem::take(&mut self.peak) < INAUDIBLE as f32 && !instrument.graph.holds(&self.operators);
        let silent = self.bank.ringing() == 0 && quiet;
        self.quiet = if silent { self.quiet + 1 } else { 0 };
        if self.quiet > QUIET_GRID_POINTS {
            self.rest();
            return fine;
        }
        for side in 0..2 {
            self.steps[side] = (self.places[side] - self.gains[side]) * GLIDE / BLOCK as f32;
        }
        instrument.graph.control(Part::Body, &mut self.operators, &self.inputs, clock.0, clock.1);
        fine
    }

    /// Silent and at rest.
    pub fn rest(&mut self) {
        self.bank.clear();
        self.ahead.fill(0.0);
        self.ready = 0;
        self.sounds = false;
        self.pushed = false;
        self.force = [0.0; BLOCK];
        self.waiting = None;
    }

    /// Adds the samples from `at` after the last grid point on to the mix.
    pub fn mix(
        &mut self,
        instrument: &Instrument,
        blocks: &mut [Block; MAX_NODES],
        at: usize,
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let n = left.len();
        let ringing = &self.ahead[at..at + n];
        let (out, _) = instrument.graph.render(Part::Body, &mut self.operators, ringing, blocks, n);
        self.peak = self.peak.max(peak(out));
        let mut faded = [0.0; CONTROL];
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

/// Adds samples at a gain that grows by `step` from one to the next.
fn add_gliding(samples: &[f32], gain: &mut f32, step: f32, mix: &mut [f32]) {
    if *gain + step == *gain {
        // It has arrived, to the last bit: nothing waits for the sample before.
        let gain = *gain;
        mix.iter_mut().zip(samples).for_each(|(y, x)| *y += x * gain);
        return;
    }
    for (y, x) in mix.iter_mut().zip(samples) {
        *y += x * *gain;
        *gain += step;
    }
}
