//! Where the breath comes from, joined into one source speed: the microphone, a hold (button, finger, key, switch), a
//! controller that says how hard (gamepad trigger, MIDI or OSC breath controller, a sensor on a serial line), a script.
//!
//! Whoever cannot blow is as good a visitor: the strongest source counts, and none can be stuck. A hold swells and
//! fades as a breath does and ends when the lungs are empty; a controller that repeats the same strength for as long
//! has been left lying, or its cable was pulled.

use super::input::{Microphone, StepInput};
use super::onset::Onset;
use super::rate::DT;
use soffio_detector::{BlowDetector, BlowEstimate, BlowSettings};
use soffio_math::exp;

/// Speed at the lips of a held key or touch, m/s: a normal breath, 42 L/min through lips of 10 mm.
const HELD_SPEED: f64 = 9.0;
/// Speed at the lips of a controller at its end, m/s: the hardest blow of the detector.
const HARDEST_SPEED: f64 = 17.0;
/// A held breath swells and fades with these times, s.
const HELD: Swing = Swing { attack: 0.10, release: 0.12 };
/// A controller shapes its own breath; these take the steps of seven bits out of it, s.
const CONTROLLED: Swing = Swing { attack: 0.015, release: 0.03 };
/// The lungs are empty after this long, s; letting go fills them.
const LUNGS: f64 = 6.0;
/// Slower than this is no breath, m/s.
const STILL: f64 = 0.05;

/// How fast a source follows what it is asked for, s.
struct Swing {
    attack: f64,
    release: f64,
}

impl Swing {
    /// `speed` one step of `dt` seconds later; exactly 0 soon after the goal is 0.
    fn follow(&self, speed: f64, goal: f64, dt: f64) -> f64 {
        if speed == goal {
            return goal;
        }
        let time = if goal > speed { self.attack } else { self.release };
        let next = goal + (speed - goal) * exp(-dt / time);
        if goal == 0.0 && next < STILL { 0.0 } else { next }
    }
}

impl Microphone<'_> {
    /// Lets a detector hear it.
    pub fn reach(&self, detector: &mut BlowDetector) {
        match self.second {
            Some(second) => detector.push_stereo(self.samples, second, self.reference),
            None => detector.push(self.samples, self.reference),
        }
    }
}

/// All sources of breath of one kiosk.
#[derive(Clone, Default)]
pub struct BreathSource {
    settings: BlowSettings,
    detector: Option<(u32, BlowDetector)>,
    held: f64,
    held_for: f64,
    controlled: f64,
    /// Strength of the controllers, and for how long it has been just that.
    strength: (f64, f64),
    commanded: Option<f64>,
}

impl BreathSource {
    /// Sources whose microphone's level counts so many dB more.
    pub fn new(sensitivity_db: f64) -> Self {
        Self { settings: BlowSettings { sensitivity_db, ..BlowSettings::default() }, ..Self::default() }
    }

    /// Listens with the ear that another one has listened with so far: it knows the room, and the kiosk's own sound in it.
    pub fn listen_on(&mut self, before: &mut Self) {
        self.detector = before.detector.take();
        if let Some((_, detector)) = &mut self.detector {
            detector.set_sensitivity(self.settings.sensitivity_db);
        }
    }

    /// Sets or releases the commanded speed, m/s.
    pub fn command(&mut self, speed: Option<f64>) {
        self.commanded = speed.filter(|s| s.is_finite()).map(|s| s.max(0.0));
    }

    /// Hears one step of `dt` seconds. Returns the source speed (m/s, exactly 0 when nobody blows) and what the
    /// detector says.
    pub fn advance(&mut self, input: &StepInput, dt: f64) -> (f64, BlowEstimate) {
        let heard = self.hear(input.microphone);
        let estimate = if input.deaf { BlowEstimate::default() } else { heard };
        self.held_for = if input.hold { self.held_for + dt } else { 0.0 };
        let hold = input.hold && self.held_for < LUNGS;
        self.held = HELD.follow(self.held, if hold { HELD_SPEED } else { 0.0 }, dt);

        let strength = if input.strength.is_finite() { input.strength.clamp(0.0, 1.0) } else { 0.0 };
        let unchanged = if strength == self.strength.0 { self.strength.1 + dt } else { 0.0 };
        self.strength = (strength, unchanged);
        let goal = if unchanged < LUNGS { HARDEST_SPEED * strength } else { 0.0 };
        self.controlled = CONTROLLED.follow(self.controlled, goal, dt);

        let commanded = self.commanded.unwrap_or(0.0);
        (estimate.speed.max(self.held).max(self.controlled).max(commanded), estimate)
    }

    fn hear(&mut self, microphone: Option<Microphone>) -> BlowEstimate {
        // Gone: the room is learnt anew when it comes back.
        let Some(heard) = microphone else {
            self.detector = None;
            return BlowEstimate::default();
        };
        if self.detector.as_ref().is_none_or(|(rate, _)| *rate != heard.sample_rate) {
            self.detector =
                Some((heard.sample_rate, BlowDetector::with_settings(heard.sample_rate, self.settings.clone())));
        }
        self.detector.as_mut().map_or_else(BlowEstimate::default, |(_, detector)| {
            heard.reach(detector);
            detector.estimate()
        })
    }
}

/// The breath at the lips.
#[derive(Clone)]
pub(crate) struct Breathing {
    source: BreathSource,
    pub onset: Onset,
    /// After all sources are joined, m/s; exactly 0 when nobody blows.
    pub speed: f64,
    /// What the detector says.
    pub estimate: BlowEstimate,
}

impl Breathing {
    /// Nobody blows; `sensitivity_db` is the detector's.
    pub fn new(sensitivity_db: f64) -> Self {
        Self {
            source: BreathSource::new(sensitivity_db),
            onset: Onset::default(),
            speed: 0.0,
            estimate: BlowEstimate::default(),
        }
    }

    /// Goes on with the detector that has listened `before`.
    pub fn listen_on(&mut self, before: &mut Self) {
        self.source.listen_on(&mut before.source);
    }

    /// Blows at this speed (m/s) by command, until told otherwise.
    pub fn command(&mut self, speed: Option<f64>) {
        self.source.command(speed);
    }

    /// Joins the sources of a step.
    pub fn advance(&mut self, input: &StepInput) {
        (self.speed, self.estimate) = self.source.advance(input, DT);
        self.onset.advance(self.speed, DT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1.0 / 240.0;

    /// Speeds of so many seconds of the same input.
    fn blow(source: &mut BreathSource, input: &StepInput, seconds: f64) -> Vec<f64> {
        (0..(seconds / DT) as usize).map(|_| source.advance(input, DT).0).collect()
    }

    #[test]
    fn a_controller_blows_as_hard_as_it_says_and_at_once() {
        let mut source = BreathSource::default();
        let half = StepInput { strength: 0.5, ..StepInput::default() };
        let speeds = blow(&mut source, &half, 0.2);
        // Within 5 % after three times the attack.
        assert!((speeds[11] - 8.5).abs() < 0.05 * 8.5, "{}", speeds[11]);
        let after = blow(&mut source, &StepInput::default(), 0.3);
        assert_eq!(after.last(), Some(&0.0));
        for wrong in [f64::NAN, f64::INFINITY, -1.0] {
            let input = StepInput { strength: wrong, ..StepInput::default() };
            assert!(blow(&mut source, &input, 0.1).iter().all(|&speed| speed == 0.0), "{wrong}");
        }
        let beyond = StepInput { strength: 7.0, ..StepInput::default() };
        assert!(blow(&mut source, &beyond, 0.5).iter().all(|&speed| speed <= HARDEST_SPEED));
    }

    #[test]
    fn nothing_held_or_left_lying_blows_for_ever() {
        for input in
            [StepInput { hold: true, ..StepInput::default() }, StepInput { strength: 0.3, ..StepInput::default() }]
        {
            let mut source = BreathSource::default();
            let speeds = blow(&mut source, &input, LUNGS + 1.0);
            assert!(speeds[240] > 5.0 && speeds[(5.9 / DT) as usize] > 5.0, "{input:?}");
            assert_eq!(speeds.last(), Some(&0.0), "{input:?}");
            // Letting go fills the lungs.
            blow(&mut source, &StepInput::default(), 0.1);
            assert!(blow(&mut source, &input, 1.0).last().is_some_and(|&speed| speed > 5.0), "{input:?}");
        }
    }
}
