//! Log of breaths: begin, end, source and strength of each; never the sound itself.
//!
//! Each source has a breath of its own, so a false trigger of the microphone by the kiosk's own sound shows beside the key
//! that caused it. A held or scripted breath ends with its wind, not when the key comes up.

use std::fmt;

use soffio_simulation::{BreathView, STEPS_PER_SECOND};

/// Source of a breath.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BreathSource {
    /// The microphone, or a recording in its place.
    Microphone,
    /// A held button, finger or key.
    Hold,
    /// A breath controller: gamepad trigger, MIDI, OSC, serial line.
    Controller,
    /// The attract script.
    Script,
}

const SOURCES: [BreathSource; 4] =
    [BreathSource::Microphone, BreathSource::Hold, BreathSource::Controller, BreathSource::Script];

/// Begin or end of a breath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BreathEvent {
    /// A breath began at this speed, m/s.
    Begins(BreathSource, f64),
    /// It ended.
    Ends {
        /// Its source.
        source: BreathSource,
        /// Its length, s.
        seconds: f64,
        /// Its highest speed, m/s.
        peak: f64,
    },
}

/// Number of breaths begun, by source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BreathCounts([u64; SOURCES.len()]);

impl BreathCounts {
    /// Counts a breath that begins.
    pub fn record(&mut self, turn: &BreathEvent) {
        if let BreathEvent::Begins(begun, _) = turn {
            let counted = self.0.iter_mut().zip(SOURCES).find(|(_, source)| source == begun);
            counted.into_iter().for_each(|(count, _)| *count += 1);
        }
    }

    /// Each source with its count.
    pub fn iter(&self) -> impl Iterator<Item = (BreathSource, u64)> {
        SOURCES.into_iter().zip(self.0)
    }
}

/// Devices besides the microphone that make a breath.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BreathDevices {
    /// Does a held key or press blow?
    pub hold: bool,
    /// Strength of a controller, 0 … 1.
    pub strength: f64,
}

/// Detects from step to step where a breath begins and ends.
#[derive(Clone, Debug, Default)]
pub struct BreathLog {
    /// First step and highest speed of a running breath, for each of [`SOURCES`].
    running: [Option<(u64, f64)>; SOURCES.len()],
}

impl BreathLog {
    /// Records a step; `attracts` says whether attract mode plays. Returns the breaths that begin or end.
    pub fn record(
        &mut self,
        step: u64,
        breath: &BreathView,
        devices: BreathDevices,
        attracts: bool,
    ) -> impl Iterator<Item = BreathEvent> {
        let BreathDevices { hold, strength } = devices;
        let from_microphone = breath.estimate.speed;
        let turns = std::array::from_fn::<_, { SOURCES.len() }, _>(|i| {
            let lasts = self.running[i].is_some();
            let speed = match SOURCES[i] {
                BreathSource::Microphone => from_microphone,
                BreathSource::Hold if hold || lasts && breath.speed > from_microphone => breath.speed,
                BreathSource::Controller if strength > 0.0 => breath.speed,
                BreathSource::Script if attracts => breath.speed,
                BreathSource::Hold | BreathSource::Controller | BreathSource::Script => 0.0,
            };
            match &mut self.running[i] {
                Some((_, peak)) if speed > 0.0 => {
                    *peak = peak.max(speed);
                    None
                }
                None if speed > 0.0 => {
                    self.running[i] = Some((step, speed));
                    Some(BreathEvent::Begins(SOURCES[i], speed))
                }
                running => running.take().map(|(began, peak)| BreathEvent::Ends {
                    source: SOURCES[i],
                    seconds: (step - began) as f64 / STEPS_PER_SECOND as f64,
                    peak,
                }),
            }
        });
        turns.into_iter().flatten()
    }
}

impl fmt::Display for BreathSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Microphone => "microphone",
            Self::Hold => "hold",
            Self::Controller => "controller",
            Self::Script => "script",
        })
    }
}

impl fmt::Display for BreathEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Begins(source, speed) => write!(f, "a breath begins ({source}): {speed:.1} m/s"),
            Self::Ends { source, seconds, peak } => {
                write!(f, "a breath ends ({source}): {seconds:.2} s long, at most {peak:.1} m/s")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_detector::BlowEstimate;

    fn view(speed: f64, from_microphone: f64) -> BreathView {
        let estimate = BlowEstimate { speed: from_microphone, ..BlowEstimate::default() };
        BreathView { speed, estimate, ..BreathView::default() }
    }

    #[test]
    fn each_source_begins_and_ends_by_itself() {
        let mut breaths = BreathLog::default();
        let mut turns = |step, view: BreathView, hold| {
            breaths.record(step, &view, BreathDevices { hold, strength: 0.0 }, false).collect::<Vec<_>>()
        };
        assert_eq!(turns(0, view(0.0, 0.0), false), []);
        assert_eq!(turns(1, view(9.0, 0.0), true), [BreathEvent::Begins(BreathSource::Hold, 9.0)]);
        // The microphone answers in the middle of the hold.
        assert_eq!(turns(100, view(9.0, 2.0), true), [BreathEvent::Begins(BreathSource::Microphone, 2.0)]);
        let end = |source, seconds, peak| BreathEvent::Ends { source, seconds, peak };
        assert_eq!(turns(121, view(9.0, 0.0), true), [end(BreathSource::Microphone, 0.0875, 2.0)]);
        // The wind of a hold outlasts the key.
        assert_eq!(turns(200, view(5.0, 0.0), false), []);
        assert_eq!(turns(241, view(0.0, 0.0), false), [end(BreathSource::Hold, 1.0, 9.0)]);
    }

    #[test]
    fn the_script_is_no_visitor() {
        let mut breaths = BreathLog::default();
        let begins: Vec<_> = breaths.record(0, &view(3.0, 0.0), BreathDevices::default(), true).collect();
        assert_eq!(begins, [BreathEvent::Begins(BreathSource::Script, 3.0)]);
        // A visitor's breath ends the show within the step.
        let both: Vec<_> = breaths.record(1, &view(4.0, 4.0), BreathDevices::default(), false).collect();
        assert_eq!(both[0], BreathEvent::Begins(BreathSource::Microphone, 4.0));
        assert!(matches!(both[1], BreathEvent::Ends { source: BreathSource::Script, .. }), "{both:?}");
    }
}
