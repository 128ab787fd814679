//! systemd notifications: the kiosk is ready, its status, and the watchdog's keep-alive.
//!
//! A keep-alive is sent only if three things made progress since the last one: frames were presented (or offered to a display
//! that is off), the simulation advanced, and the loudspeaker played, where there is one. None is sent while the loader of exhibits is
//! stuck. Without keep-alives systemd restarts the unit after `WatchdogSec`. Without systemd nothing is sent.

use std::time::{Duration, Instant};

/// Keep-alives a watchdog period: a lost or late one does no harm.
const MESSAGES_PER_PERIOD: u32 = 3;

/// Progress of frames, simulation and sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Frames presented, or offered while the display is off.
    pub pictures: u64,
    /// When the last step was due.
    pub due: Instant,
    /// Frames that the loudspeaker has played; `None` where there is none.
    pub played: Option<u64>,
    /// Is the loader of exhibits stuck? Nothing but a restart frees its thread.
    pub loader_stuck: bool,
}

impl Progress {
    /// Has everything advanced since `before`? A lost or new loudspeaker is not counted: its supervisor handles it.
    pub fn beyond(&self, before: &Self) -> bool {
        let plays = match (self.played, before.played) {
            (Some(now), Some(then)) => now != then,
            _ => true,
        };
        self.pictures > before.pictures && self.due > before.due && plays && !self.loader_stuck
    }
}

/// Sends the notifications.
#[derive(Debug)]
pub struct Watchdog {
    every: Option<Duration>,
    last: Option<(Instant, Progress)>,
    status: String,
}

impl Default for Watchdog {
    fn default() -> Self {
        let period = sd_notify::watchdog_enabled();
        Self { every: period.map(|period| period / MESSAGES_PER_PERIOD), last: None, status: String::new() }
    }
}

impl Watchdog {
    /// Call after each frame. Sends that the kiosk is ready, once; then a keep-alive at every third of the watchdog's period;
    /// and a changed status, one line.
    pub fn update(&mut self, now: Instant, progress: Progress, status: &str) {
        let mut messages = Vec::new();
        match &self.last {
            None => messages.push(sd_notify::NotifyState::Ready),
            Some((at, before)) => {
                let due = self.every.is_some_and(|every| now.duration_since(*at) >= every);
                if !(due && progress.beyond(before)) {
                    if status != self.status {
                        self.send(&[sd_notify::NotifyState::Status(status)]);
                        self.status = status.to_owned();
                    }
                    return;
                }
                messages.push(sd_notify::NotifyState::Watchdog);
            }
        }
        self.last = Some((now, progress));
        self.send(&messages);
    }

    /// Sends that the kiosk ends.
    pub fn end(&self) {
        self.send(&[sd_notify::NotifyState::Stopping]);
    }

    fn send(&self, messages: &[sd_notify::NotifyState]) {
        // Without NOTIFY_SOCKET this does nothing; a closed socket is the supervisor's concern.
        if let Err(error) = sd_notify::notify(messages) {
            tracing::debug!("systemd is not notified: {error}");
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
        let before = Progress { pictures: 3, due, played: Some(100), loader_stuck: false };
        let good = Progress { pictures: 4, due: later, played: Some(200), loader_stuck: false };
        assert!(good.beyond(&before));
        assert!(!Progress { pictures: 3, ..good }.beyond(&before), "no picture");
        assert!(!Progress { due, ..good }.beyond(&before), "no motion");
        assert!(!Progress { played: Some(100), ..good }.beyond(&before), "no sound");
        assert!(!Progress { loader_stuck: true, ..good }.beyond(&before), "no exhibit can be loaded");
        assert!(Progress { played: None, ..good }.beyond(&before), "the loudspeaker was pulled out");
        assert!(Progress { played: Some(0), ..good }.beyond(&Progress { played: None, ..before }), "a new one");
    }
}
