//! Breath sources joined into one source speed: the microphone, a hold (button, finger, key, switch), a controller with a
//! strength (gamepad trigger, MIDI or OSC breath controller, a sensor on a serial line), and commands of a script.
//!
//! All sources count alike: the strongest one sets the speed, and none can stay on for ever. A hold swells and fades as a breath
//! does and ends when the lungs are empty. A controller that repeats the same strength for as long has been left lying, or
//! is disconnected.

use super::input::{Microphone, StepInput};
use super::onset_compensation::OnsetCompensation;
use super::rate::DT;
use soffio_detector::{AmbientSpread, BlowDetector, BlowEstimate, BlowSettings};
use soffio_math::exp;

/// Source speed of a held key or touch, m/s: a normal breath, 42 L/min through lips of 10 mm.
const HOLD_SPEED: f64 = 9.0;
/// Source speed of a controller at full strength, m/s: the hardest blow of the detector.
const FULL_STRENGTH_SPEED: f64 = 17.0;
/// Envelope of a hold: that of a breath.
const HOLD: AttackRelease = AttackRelease { attack: 0.10, release: 0.12 };
/// Envelope of a controller, which shapes its own breath: it only smooths the steps of seven-bit values.
const CONTROLLER: AttackRelease = AttackRelease { attack: 0.015, release: 0.03 };
/// Longest hold, s: the lungs are empty then; releasing fills them.
const LONGEST_HOLD: f64 = 6.0;
/// A fading source below this speed stops, m/s.
const LEAST_SPEED: f64 = 0.05;

/// Time constants of an attack–release envelope, s.
struct AttackRelease {
    attack: f64,
    release: f64,
}

impl AttackRelease {
    /// `speed` (m/s) after one step of `dt` seconds towards `goal`; exactly 0 soon after the goal is 0.
    fn step(&self, speed: f64, goal: f64, dt: f64) -> f64 {
        if speed == goal {
            return goal;
        }
        let time = if goal > speed { self.attack } else { self.release };
        let next = goal + (speed - goal) * exp(-dt / time);
        if goal == 0.0 && next < LEAST_SPEED { 0.0 } else { next }
    }
}

impl Microphone<'_> {
    /// Feeds the samples to a detector.
    pub fn feed(&self, detector: &mut BlowDetector) {
        match self.second {
            Some(second) => detector.push_stereo(self.samples, second, self.reference),
            None => detector.push(self.samples, self.reference),
        }
    }
}

/// A detector, and the sample rate it is made for.
#[derive(Clone)]
struct RunningDetector {
    /// Hz.
    sample_rate: u32,
    detector: BlowDetector,
}

/// Strength of the controllers.
#[derive(Clone, Copy, Default)]
struct Strength {
    /// 0 … 1.
    value: f64,
    /// Since its last change, s.
    unchanged: f64,
}

/// All sources of breath of one kiosk.
#[derive(Clone, Default)]
pub struct BreathSource {
    settings: BlowSettings,
    detector: Option<RunningDetector>,
    /// What the last detector knew of the room, for the next one; `None` before there was one.
    ambient_spread: Option<AmbientSpread>,
    /// Speed of the hold, m/s.
    hold_speed: f64,
    /// Length of the present hold, s.
    hold_time: f64,
    /// Speed of the controllers, m/s.
    controller_speed: f64,
    strength: Strength,
    commanded: Option<f64>,
}

impl BreathSource {
    /// All sources silent; `settings` are the detector's.
    pub fn new(settings: BlowSettings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// Ambient spread of the running detector, else of the last one.
    pub fn ambient_spread(&self) -> Option<AmbientSpread> {
        self.detector.as_ref().map(|running| running.detector.ambient_spread()).or(self.ambient_spread)
    }

    /// Sets what an earlier run knew of the room, for the next detector.
    pub fn recall(&mut self, ambient_spread: AmbientSpread) {
        self.ambient_spread = Some(ambient_spread);
    }

    /// Takes over the detector of another source, which has adapted to the noise floor and to the kiosk's own sound.
    pub fn adopt_detector(&mut self, before: &mut Self) {
        (self.detector, self.ambient_spread) = (before.detector.take(), before.ambient_spread);
        if let Some(running) = &mut self.detector {
            running.detector.set(self.settings.sensitivity_db, self.settings.threshold);
        }
    }

    /// Sets or releases the commanded speed, m/s.
    pub fn command(&mut self, speed: Option<f64>) {
        self.commanded = speed.filter(|s| s.is_finite()).map(|s| s.max(0.0));
    }

    /// Advances all sources by a step of `dt` seconds. Returns the joint source speed (m/s, exactly 0 without a breath) and
    /// the detector's estimate.
    pub fn advance(&mut self, input: &StepInput, dt: f64) -> (f64, BlowEstimate) {
        let detected = self.detect(input.microphone);
        let estimate = if input.ignore_microphone { BlowEstimate::default() } else { detected };
        self.hold_time = if input.hold { self.hold_time + dt } else { 0.0 };
        let hold = input.hold && self.hold_time < LONGEST_HOLD;
        self.hold_speed = HOLD.step(self.hold_speed, if hold { HOLD_SPEED } else { 0.0 }, dt);

        let value = if input.strength.is_finite() { input.strength.clamp(0.0, 1.0) } else { 0.0 };
        let unchanged = if value == self.strength.value { self.strength.unchanged + dt } else { 0.0 };
        self.strength = Strength { value, unchanged };
        let goal = if unchanged < LONGEST_HOLD { FULL_STRENGTH_SPEED * value } else { 0.0 };
        self.controller_speed = CONTROLLER.step(self.controller_speed, goal, dt);

        let commanded = self.commanded.unwrap_or(0.0);
        (estimate.speed.max(self.hold_speed).max(self.controller_speed).max(commanded), estimate)
    }

    /// Feeds the microphone to the detector. Without a microphone the detector is dropped, but for what it knows of the room: a new one
    /// adapts later.
    fn detect(&mut self, microphone: Option<Microphone>) -> BlowEstimate {
        let Some(microphone) = microphone else {
            self.ambient_spread = self.ambient_spread();
            self.detector = None;
            return BlowEstimate::default();
        };
        let sample_rate = microphone.sample_rate;
        if self.detector.as_ref().is_none_or(|running| running.sample_rate != sample_rate) {
            let mut detector = BlowDetector::with_settings(sample_rate, self.settings.clone());
            self.ambient_spread = self.ambient_spread();
            self.ambient_spread.iter().for_each(|ambient_spread| detector.recall(ambient_spread));
            self.detector = Some(RunningDetector { sample_rate, detector });
        }
        self.detector.as_mut().map_or_else(BlowEstimate::default, |running| {
            microphone.feed(&mut running.detector);
            running.detector.estimate()
        })
    }
}

/// State of the breath at the lips.
#[derive(Clone)]
pub(crate) struct BreathState {
    source: BreathSource,
    /// Compensation of the detector's latency.
    pub onset: OnsetCompensation,
    /// Joint speed of all sources, m/s; exactly 0 without a breath.
    pub speed: f64,
    /// Of the detector.
    pub estimate: BlowEstimate,
}

impl BreathState {
    /// No breath; `settings` are the detector's.
    pub fn new(settings: BlowSettings) -> Self {
        Self {
            source: BreathSource::new(settings),
            onset: OnsetCompensation::default(),
            speed: 0.0,
            estimate: BlowEstimate::default(),
        }
    }

    /// Takes over the detector of another breath.
    pub fn adopt_detector(&mut self, before: &mut Self) {
        self.source.adopt_detector(&mut before.source);
    }

    /// Ambient spread; `None` where there was no microphone yet.
    pub fn ambient_spread(&self) -> Option<AmbientSpread> {
        self.source.ambient_spread()
    }

    /// Sets what an earlier run knew of the room.
    pub fn recall(&mut self, ambient_spread: AmbientSpread) {
        self.source.recall(ambient_spread);
    }

    /// Sets or releases the commanded speed, m/s.
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

    /// Speeds during `seconds` of the same input.
    fn blow(source: &mut BreathSource, input: &StepInput, seconds: f64) -> Vec<f64> {
        (0..(seconds / DT) as usize).map(|_| source.advance(input, DT).0).collect()
    }

    #[test]
    fn a_controller_sets_the_speed_at_once() {
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
        assert!(blow(&mut source, &beyond, 0.5).iter().all(|&speed| speed <= FULL_STRENGTH_SPEED));
    }

    #[test]
    fn a_microphone_that_comes_back_finds_the_room_as_it_was() {
        let mut source = BreathSource::default();
        let samples = vec![0.01; 200];
        let microphone = Microphone { samples: &samples, second: None, reference: &[], sample_rate: 48_000 };
        let listens = StepInput { microphone: Some(microphone), ..StepInput::default() };
        assert_eq!(source.ambient_spread(), None);
        blow(&mut source, &listens, 20.0);
        let known = source.ambient_spread().expect("a room");
        assert!(known.bands.seconds > 19.0, "{known:?}");
        blow(&mut source, &StepInput::default(), 1.0);
        assert_eq!(source.ambient_spread(), Some(known), "without a microphone");
        blow(&mut source, &listens, 5.0);
        let again = source.ambient_spread().expect("a room");
        assert!(again.bands.seconds > known.bands.seconds + 4.0, "learning goes on: {again:?}");
    }

    #[test]
    fn no_source_stays_on_for_ever() {
        for input in
            [StepInput { hold: true, ..StepInput::default() }, StepInput { strength: 0.3, ..StepInput::default() }]
        {
            let mut source = BreathSource::default();
            let speeds = blow(&mut source, &input, LONGEST_HOLD + 1.0);
            assert!(speeds[240] > 5.0 && speeds[(5.9 / DT) as usize] > 5.0, "{input:?}");
            assert_eq!(speeds.last(), Some(&0.0), "{input:?}");
            // Releasing fills the lungs.
            blow(&mut source, &StepInput::default(), 0.1);
            assert!(blow(&mut source, &input, 1.0).last().is_some_and(|&speed| speed > 5.0), "{input:?}");
        }
    }
}
