//! Frame pacing: chooses the time that a frame shows.
//!
//! The display shows frames at even times, one refresh after the other, but the system starts them with a jitter of some
//! milliseconds. If a frame showed its start time, even motion would judder. So the shown time advances by whole refreshes,
//!
//! ```text
//! n = round((now − s) / T), at least 1        s ← s + n T + a e,    T ← T + b e / n,    e = now − (s + n T)
//! ```
//!
//! where s is the time that the last frame showed and T the refresh interval. This is a second-order phase-locked loop. It
//! follows the display's own clock and passes on a fortieth of a frame's delay. A missed refresh adds one more T, so the motion
//! stays correct. If the display does not report T, the median of the first intervals is used.
//!
//! The caller passes all times: nothing here reads a clock.

/// Loop gains: of the shown time (a) and of the refresh interval (b). Critically damped, b = a²/4.
const PULL: f64 = 0.025;
const LEARN: f64 = PULL * PULL / 4.0;
/// Largest relative change of the refresh interval from its nominal value. Displays report rounded rates (60 Hz for 59.94).
const LEEWAY: f64 = 0.02;
/// Pause after which the loop restarts, s.
const PAUSE: f64 = 0.1;
/// Number of intervals whose median estimates the refresh interval.
const SEEN: usize = 15;

/// State of the frame pacing.
#[derive(Clone, Debug, Default)]
pub struct FramePacer {
    /// Refresh interval reported by the display, s.
    reported: Option<f64>,
    /// Nominal and estimated refresh interval, s.
    nominal: Option<f64>,
    refresh: f64,
    /// Start of the last frame, and the time that it showed, s.
    last: Option<(f64, f64)>,
    intervals: Vec<f64>,
}

impl FramePacer {
    /// Sets the refresh interval of the display, s; `None` where it is unknown.
    pub fn set_refresh(&mut self, refresh: Option<f64>) {
        if self.reported != refresh {
            *self =
                Self { reported: refresh, nominal: refresh, refresh: refresh.unwrap_or_default(), ..Self::default() };
        }
    }

    /// Estimated refresh interval, s; `None` before it is known.
    pub fn refresh(&self) -> Option<f64> {
        self.nominal.map(|_| self.refresh)
    }

    /// The time that a frame started at `now` shows, s; both by the caller's clock.
    pub fn next(&mut self, now: f64) -> f64 {
        let shown = match self.last {
            Some((before, shown)) if now - before <= PAUSE && now > before => {
                self.learn(now - before);
                self.follow(shown, now)
            }
            _ => now,
        };
        self.last = Some((now, shown));
        shown
    }

    fn follow(&mut self, shown: f64, now: f64) -> f64 {
        let Some(nominal) = self.nominal else { return now };
        let refreshes = ((now - shown) / self.refresh).round().max(1.0);
        let even = shown + refreshes * self.refresh;
        let late = now - even;
        let refresh = self.refresh + LEARN * late / refreshes;
        self.refresh = refresh.clamp(nominal * (1.0 - LEEWAY), nominal * (1.0 + LEEWAY));
        even + PULL * late
    }

    /// Estimates the refresh interval by the median of the first intervals.
    fn learn(&mut self, interval: f64) {
        if self.nominal.is_some() {
            return;
        }
        self.intervals.push(interval);
        if self.intervals.len() == SEEN {
            self.intervals.sort_unstable_by(f64::total_cmp);
            self.refresh = self.intervals[SEEN / 2];
            self.nominal = Some(self.refresh);
        }
    }
}
