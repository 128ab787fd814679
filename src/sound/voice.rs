//! A voice: the sound of an impact beside its modal part, or the sustained sound of wind or a slide on one instrument.

use super::bounds::{FAULT_LEVEL, INAUDIBLE};
use super::graph::{AudioBlock, Bus, CONTROL_PERIOD, Graph, OperatorState};
use super::instrument::Instrument;
use super::timbre::{Inputs, MAX_NODES};
use super::true_peak::peak;

/// Grid points of silence after which a voice ends: 5 ms at 48 kHz.
const QUIET_GRID_POINTS: u32 = 4;

pub(super) struct Voice {
    /// Does it sound?
    pub state: VoiceState,
    /// Index of its instrument in the synth.
    pub instrument: usize,
    /// Values of the inputs that its numbers are bound to.
    pub inputs: Inputs,
    /// State of each node of its timbre.
    pub operators: [OperatorState; MAX_NODES],
    /// Left and right, distance included.
    pub gains: [f32; 2],
    /// Multiplies the voice; falls while it fades.
    fade: f32,
    fade_step: f32,
    /// Largest sample since the last grid point, and between the two before.
    peak: f32,
    last_peak: f32,
    quiet: u32,
}

/// Whether a voice sounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VoiceState {
    Free,
    Sounding,
    Fading,
}

impl Voice {
    /// A voice that is free.
    pub fn new() -> Self {
        Self {
            state: VoiceState::Free,
            instrument: 0,
            inputs: Inputs::default(),
            operators: std::array::from_fn(|_| OperatorState::new(0)),
            gains: [0.0; 2],
            fade: 1.0,
            fade_step: 0.0,
            peak: 0.0,
            last_peak: 0.0,
            quiet: 0,
        }
    }

    /// Starts; the caller sets inputs and operators.
    pub fn begin(&mut self, instrument: usize, gains: [f32; 2]) {
        self.state = VoiceState::Sounding;
        (self.instrument, self.gains) = (instrument, gains);
        (self.fade, self.fade_step) = (1.0, 0.0);
        (self.peak, self.last_peak, self.quiet) = (0.0, 0.0, 0);
    }

    /// Fades out in `samples`; then it is free.
    pub fn fade_out(&mut self, samples: f32) {
        if self.state == VoiceState::Sounding {
            self.state = VoiceState::Fading;
            self.fade_step = -1.0 / samples;
        }
    }

    /// Present loudness, for stealing the quietest.
    pub fn loudness(&self) -> f32 {
        self.gains[0].max(self.gains[1]) * self.fade * self.peak.max(self.last_peak)
    }

    /// Updates the state at a grid point: a silent voice becomes free.
    pub fn grid_point(&mut self, graph: &Graph) {
        let silent = self.peak < INAUDIBLE as f32 && !graph.holds(&self.operators);
        self.quiet = if silent { self.quiet + 1 } else { 0 };
        if self.quiet > QUIET_GRID_POINTS {
            self.state = VoiceState::Free;
        }
        self.last_peak = std::mem::take(&mut self.peak);
    }

    /// Adds its next samples to the mix, and to the force on the modal bank. `false` for invalid numbers: nothing was added and the
    /// voice is free.
    #[must_use]
    pub fn mix(
        &mut self,
        instrument: &Instrument,
        blocks: &mut [AudioBlock; MAX_NODES],
        left: &mut [f32],
        right: &mut [f32],
        force: Option<&mut [f32]>,
    ) -> bool {
        let n = left.len();
        let (out, push) =
            instrument.graph.render(Bus::Voice, &mut self.operators, &[0.0; CONTROL_PERIOD][..n], blocks, n);
        let push = push.unwrap_or_default();
        // The comparison is false for NaN too.
        if ![out, push].into_iter().flatten().fold(true, |valid, x| valid & (x.abs() <= FAULT_LEVEL)) {
            self.state = VoiceState::Free;
            return false;
        }
        self.peak = self.peak.max(peak(out)).max(peak(push));
        let mut fades = [1.0; CONTROL_PERIOD];
        let fades = &mut fades[..n];
        if self.fade != 1.0 || self.fade_step != 0.0 {
            for fade in &mut *fades {
                *fade = self.fade;
                self.fade = (self.fade + self.fade_step).max(0.0);
            }
        }
        for (mix, gain) in [left, right].into_iter().zip(self.gains) {
            mix.iter_mut().zip(out).zip(&*fades).for_each(|((y, x), fade)| *y += x * fade * gain);
        }
        for ((f, x), fade) in force.unwrap_or_default().iter_mut().zip(push).zip(fades) {
            *f += x * *fade;
        }
        if self.fade == 0.0 {
            self.state = VoiceState::Free;
        }
        true
    }
}
