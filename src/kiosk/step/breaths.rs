//! The log of breaths: when each began and ended, where it came from, how strong it was; of the sound itself nothing.
//!
//! Each source has its own breath, so that a microphone that answers the kiosk's own wind is seen beside the hold
//! that made the wind. A held or scripted breath is over when its wind is, not when the key comes up.

use std::fmt;

use soffio_simulation::{BreathView, STEPS_PER_SECOND};

/// Where a breath came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Somebody blew at the microphone, or at the one of the recording in its place.
    Microphone,
    /// A button, finger or key is held.
    Hold,
    /// A breath controller: gamepad trigger, MIDI, OSC, serial line.
    Controller,
    /// The attract script.
    Script,
}

const SOURCES: [Source; 4] = [Source::Microphone, Source::Hold, Source::Controller, Source::Script];

/// What there is to say about one source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// A breath began at this speed, m/s.
    Begins(Source, f64),
    /// It ended.
    Ends {
        /// Where it came from.
        source: Source,
        /// How long it was, s.
        seconds: f64,
        /// Its highest speed, m/s.
        peak: f64,
    },
}

/// How many breaths began, by their source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Blows([u64; SOURCES.len()]);

impl Blows {
    /// Counts a breath that begins.
    pub fn note(&mut self, turn: &Turn) {
        if let Turn::Begins(begun, _) = turn {
            let counted = self.0.iter_mut().zip(SOURCES).find(|(_, source)| source == begun);
            counted.into_iter().for_each(|(count, _)| *count += 1);
        }
    }

    /// Each source with its count.
    pub fn iter(&self) -> impl Iterator<Item = (Source, u64)> {
        SOURCES.into_iter().zip(self.0)
    }
}

/// Tells from step to step where a breath begins and ends.
#[derive(Clone, Debug, Default)]
pub struct Breaths {
    /// Step of the begin and highest speed, for each of [`SOURCES`].
    running: [Option<(u64, f64)>; SOURCES.len()],
}

impl Breaths {
    /// Takes notice of a step and what blew in it (a hold, and how hard a controller); what began or ended.
    pub fn note(
        &mut self,
        step: u64,
        breath: &BreathView,
        (hold, strength): (bool, f64),
        attracts: bool,
    ) -> impl Iterator<Item = Turn> {
        let from_microphone = breath.estimate.speed;
        let turns = std::array::from_fn::<_, { SOURCES.len() }, _>(|i| {
            let lasts = self.running[i].is_some();
            let speed = match SOURCES[i] {
                Source::Microphone => from_microphone,
                Source::Hold if hold || lasts && breath.speed > from_microphone => breath.speed,
                Source::Controller if strength > 0.0 => breath.speed,
                Source::Script if attracts => breath.speed,
                Source::Hold | Source::Controller | Source::Script => 0.0,
            };
            match &mut self.running[i] {
                Some((_, peak)) if speed > 0.0 => {
                    *peak = peak.max(speed);
                    None
                }
                None if speed > 0.0 => {
                    self.running[i] = Some((step, speed));
                    Some(Turn::Begins(SOURCES[i], speed))
                }
                running => running.take().map(|(began, peak)| Turn::Ends {
                    source: SOURCES[i],
                    seconds: (step - began) as f64 / STEPS_PER_SECOND as f64,
                    peak,
                }),
            }
        });
        turns.into_iter().flatten()
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Microphone => "microphone",
            Self::Hold => "hold",
            Self::Controller => "controller",
            Self::Script => "script",
        })
    }
}

impl fmt::Display for Turn {
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
        let mut breaths = Breaths::default();
        let mut turns =
            |step, view: BreathView, hold| breaths.note(step, &view, (hold, 0.0), false).collect::<Vec<_>>();
        assert_eq!(turns(0, view(0.0, 0.0), false), []);
        assert_eq!(turns(1, view(9.0, 0.0), true), [Turn::Begins(Source::Hold, 9.0)]);
        // The microphone answers in the middle of the hold.
        assert_eq!(turns(100, view(9.0, 2.0), true), [Turn::Begins(Source::Microphone, 2.0)]);
        let end = |source, seconds, peak| Turn::Ends { source, seconds, peak };
        assert_eq!(turns(121, view(9.0, 0.0), true), [end(Source::Microphone, 0.0875, 2.0)]);
        // The wind of a hold outlasts the key.
        assert_eq!(turns(200, view(5.0, 0.0), false), []);
        assert_eq!(turns(241, view(0.0, 0.0), false), [end(Source::Hold, 1.0, 9.0)]);
    }

    #[test]
    fn the_script_is_no_visitor() {
        let mut breaths = Breaths::default();
        let begins: Vec<_> = breaths.note(0, &view(3.0, 0.0), (false, 0.0), true).collect();
        assert_eq!(begins, [Turn::Begins(Source::Script, 3.0)]);
        // A visitor's breath ends the show within the step.
        let both: Vec<_> = breaths.note(1, &view(4.0, 4.0), (false, 0.0), false).collect();
        assert_eq!(both[0], Turn::Begins(Source::Microphone, 4.0));
        assert!(matches!(both[1], Turn::Ends { source: Source::Script, .. }), "{both:?}");
    }
}
