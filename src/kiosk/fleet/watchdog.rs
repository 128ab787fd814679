//! What systemd is told: that the kiosk is ready, what it shows, and that it is alive.
//!
//! Alive means that since the last word a picture was handed to the display, or offered to one that is off, the simulation
//! has gone on, and the loudspeaker, where there is one, has played. If any of the three stands still no word is sent, and after
//! `WatchdogSec` the unit is started anew. Where no systemd waits for it nothing is sent.

use std::time::{Duration, Instant};

/// Words a watchdog period: one that is lost, or late, does no harm.
const WORDS: u32 = 3;

/// How far everything has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Pictures handed to the display, or offered while it is off.
    pub pictures: u64,
    /// When the last step was due.
    pub due: Instant,
    /// Frames that the loudspeaker has played; `None` where there is none.
    pub played: Option<u64>,
}

impl Progress {
    /// Has all gone on since `before`? A loudspeaker that was lost or has just come is under the care of its supervisor.
    pub fn beyond(&self, before: &Self) -> bool {
        let plays = match (self.played, before.played) {
            (Some(now), Some(then)) => now != then,
            _ => true,
        };
        self.pictures > before.pictures && self.due > before.due && plays
    }
}

/// Tells systemd.
#[derive(Debug)]
pub struct Watchdog {
    every: Option<Duration>,
    last: Option<(Instant, Progress)>,
    status: String,
}

impl Default for Watchdog {
    fn default() -> Self {
        let period = sd_notify::watchdog_enabled();
        Self { every: period.map(|period| period / WORDS), last: None, status: String::new() }
    }
}

impl Watchdog {
    /// After a picture: says that the kiosk is ready once, then at every third of the watchdog's period that it is alive,
    /// if it is; and whatever is new of the status, one line.
    pub fn tend(&mut self, now: Instant, progress: Progress, status: &str) {
        let mut words = Vec::new();
        match &self.last {
            None => words.push(sd_notify::NotifyState::Ready),
            Some((at, before)) => {
                let due = self.every.is_some_and(|every| now.duration_since(*at) >= every);
                if !(due && progress.beyond(before)) {
                    if status != self.status {
                        self.send(&[sd_notify::NotifyState::Status(status)]);
                        self.status = status.to_owned();
                    }
                    return;
                }
                words.push(sd_notify::NotifyState::Watchdog);
            }
        }
        self.last = Some((now, progress));
        self.send(&words);
    }

    /// The kiosk ends by itself.
    pub fn end(&self) {
        self.send(&[sd_notify::NotifyState::Stopping]);
    }

    fn send(&self, words: &[sd_notify::NotifyState]) {
        // Without NOTIFY_SOCKET this does nothing; a socket that is gone is the supervisor's own affair.
        if let Err(error) = sd_notify::notify(words) {
            tracing::debug!("systemd is not told: {error}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_where_pictures_motion_and_sound_all_went_on_is_it_alive() {
        let due = Instant::now();
        let later = due + Duration::from_millis(5);
        let before = Progress { pictures: 3, due, played: Some(100) };
        let good = Progress { pictures: 4, due: later, played: Some(200) };
        assert!(good.beyond(&before));
        assert!(!Progress { pictures: 3, ..good }.beyond(&before), "no picture");
        assert!(!Progress { due, ..good }.beyond(&before), "no motion");
        assert!(!Progress { played: Some(100), ..good }.beyond(&before), "no sound");
        assert!(Progress { played: None, ..good }.beyond(&before), "the loudspeaker was pulled out");
        assert!(Progress { played: Some(0), ..good }.beyond(&Progress { played: None, ..before }), "a new one");
    }
}
