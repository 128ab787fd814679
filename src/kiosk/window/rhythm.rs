//! What time a picture shows.
//!
//! Pictures are seen at even times, one refresh of the display after the other, but begun whenever the system lets us: a
//! millisecond early here, two late there. Drawn at the time at which it was begun, a body that moves evenly would be
//! seen to judder. So a picture shows a time that goes on by whole refreshes,
//!
//! ```text
//! n = round((now − s) / T), at least 1        s ← s + n T + a e,    T ← T + b e / n,    e = now − (s + n T)
//! ```
//!
//! where s is the time that the last picture showed and T the refresh: a phase-locked loop of second order, which follows
//! the display's own clock and passes on a fortieth of a picture's delay. A refresh that was missed is one more T, so the
//! body is where it should be all the same. Where the display does not say its T, the median of the first pictures does.
//!
//! The times are the caller's: nothing here reads a clock.

/// How much of a delay the time shown takes over at once (a), and the refresh (b): critically damped, b = a²/4.
const PULL: f64 = 0.025;
const LEARN: f64 = PULL * PULL / 4.0;
/// How far the refresh may be learnt away from what it was taken for, as a share: clocks of displays are better, their words
/// (60 Hz for 59.94) are not.
const LEEWAY: f64 = 0.02;
/// A pause after which it begins anew, s.
const PAUSE: f64 = 0.1;
/// Pictures whose median says how long a refresh is.
const SEEN: usize = 15;

/// The times that pictures show.
#[derive(Clone, Debug, Default)]
pub struct Rhythm {
    /// Refresh as the display says it, s.
    said: Option<f64>,
    /// Refresh as it was taken for, and as it is learnt, s.
    nominal: Option<f64>,
    refresh: f64,
    /// When the last picture was begun, and what it showed, s.
    last: Option<(f64, f64)>,
    ways: Vec<f64>,
}

impl Rhythm {
    /// The display refreshes every so many seconds; `None` where it does not say.
    pub fn set_refresh(&mut self, refresh: Option<f64>) {
        if self.said != refresh {
            *self = Self { said: refresh, nominal: refresh, refresh: refresh.unwrap_or_default(), ..Self::default() };
        }
    }

    /// Refresh as it is known by now, s; `None` before it is.
    pub fn refresh(&self) -> Option<f64> {
        self.nominal.map(|_| self.refresh)
    }

    /// The time that a picture shows which is begun at `now`, s; both on the caller's clock.
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

    /// Takes the median of the first ways from picture to picture for the refresh.
    fn learn(&mut self, way: f64) {
        if self.nominal.is_some() {
            return;
        }
        self.ways.push(way);
        if self.ways.len() == SEEN {
            self.ways.sort_unstable_by(f64::total_cmp);
            self.refresh = self.ways[SEEN / 2];
            self.nominal = Some(self.refresh);
        }
    }
}
