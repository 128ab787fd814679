//! One voice: what a hit sounds like apart from what it sets ringing, or one instrument that the wind plays.

use super::graph::{Block, CONTROL, Graph, Part, State};
use super::instrument::Instrument;
use super::timbre::{Inputs, MAX_NODES};
use super::true_peak::peak;

/// Below this a voice is silent: −100 dB of full scale.
const INAUDIBLE: f32 = 1e-5;
/// Grid points of silence after which a voice is over.
const QUIET_GRID_POINTS: u32 = 4;
/// A voice beyond this is broken, not loud.
pub(super) const BROKEN: f32 = 1000.0;

pub(super) struct Voice {
    pub state: VoiceState,
    pub instrument: usize,
    pub inputs: Inputs,
    pub operators: [State; MAX_NODES],
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
    pub fn new() -> Self {
        Self {
            state: VoiceState::Free,
            instrument: 0,
            inputs: Inputs::default(),
            operators: std::array::from_fn(|_| State::new(0)),
            gains: [0.0; 2],
            fade: 1.0,
            fade_step: 0.0,
            peak: 0.0,
            last_peak: 0.0,
            quiet: 0,
        }
    }

    /// Takes up its place; the caller fills in inputs and operators.
    pub fn begin(&mut self, instrument: usize, gains: [f32; 2]) {
        self.state = VoiceState::Sounding;
        (self.instrument, self.gains) = (instrument, gains);
        (self.fade, self.fade_step) = (1.0, 0.0);
        (self.peak, self.last_peak, self.quiet) = (0.0, 0.0, 0);
    }

    /// Falls to silence in `samples` and is free then.
    pub fn fade_out(&mut self, samples: f32) {
        if self.state == VoiceState::Sounding {
            self.state = VoiceState::Fading;
            self.fade_step = -1.0 / samples;
        }
    }

    /// How loud it is now, to choose the quietest.
    pub fn loudness(&self) -> f32 {
        self.gains[0].max(self.gains[1]) * self.fade * self.peak.max(self.last_peak)
    }

    /// A grid point: is it over?
    pub fn grid_point(&mut self, graph: &Graph) {
        let silent = self.peak < INAUDIBLE && !graph.holds(&self.operators);
        self.quiet = if silent { self.quiet + 1 } else { 0 };
        if self.quiet > QUIET_GRID_POINTS {
            self.state = VoiceState::Free;
        }
        self.last_peak = std::mem::take(&mut self.peak);
    }

    /// Adds as many samples to the mix as it has, and to the force on what rings. `false`: bad numbers were found,
    /// nothing was added and the voice is free.
    #[must_use]
    pub fn mix(
        &mut self,
        instrument: &Instrument,
        blocks: &mut [Block; MAX_NODES],
        left: &mut [f32],
        right: &mut [f32],
        force: Option<&mut [f32]>,
    ) -> bool {
        let n = left.len();
        let (out, push) = instrument.graph.render(Part::Hit, &mut self.operators, &[0.0; CONTROL][..n], blocks, n);
        let push = push.unwrap_or_default();
        // What is not a number is not within it either.
        if ![out, push].into_iter().flatten().fold(true, |fine, x| fine & (x.abs() <= BROKEN)) {
            self.state = VoiceState::Free;
            return false;
        }
        self.peak = self.peak.max(peak(out)).max(peak(push));
        let mut fades = [1.0; CONTROL];
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
