//! Schedules of constraints: windows, ramps, periods, triggers, breaking.
//!
//! A row has an *activation* s ∈ [0, 1], the fraction of the force that would hold it: 0 is absent, 1 is hard
//! (`partial_rows.rs`). Two rows whose activations cross morph one constraint into the other. A row that is partially
//! active, or acts again after a break, is closed by the critically damped Baumgarte stabiliser, never snapped.

/// When a constraint acts. The default is always.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schedule {
    /// Times during which it acts, in order and disjoint; none at all is always. The first may begin before time 0,
    /// and the last extend over the period: it does not ramp there.
    pub windows: Vec<Window>,
    /// The windows repeat after this time, s.
    pub period: Option<f64>,
    /// Seconds over which the activation grows from 0 at a window's start.
    pub ramp_in: f64,
    /// Seconds over which it falls to 0 before a window's end.
    pub ramp_out: f64,
    /// Event that starts the clock of the windows; without it they count from the exhibit's reset.
    pub trigger: Option<Trigger>,
}

/// A span of time, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Start, s.
    pub start: f64,
    /// End, s, exclusive; may be infinite.
    pub end: f64,
}

/// Event that starts a schedule's clock; each new event restarts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trigger {
    /// An impact on a body.
    Impact {
        /// Index of the body.
        body: usize,
        /// Least impulse, N s.
        least_impulse: f64,
    },
    /// A breath.
    Breath {
        /// Least speed at the lips, m/s.
        least_speed: f64,
    },
}

/// Load at which a constraint breaks; infinite by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breaking {
    /// Force: norm of the multipliers of its length rows, N.
    pub force: f64,
    /// Torque: norm of the multipliers of its angle rows, N m.
    pub torque: f64,
    /// Impulse of an impact through it, N s (angle rows: N m s).
    pub impulse: f64,
    /// Time from the break until the constraint is restored, s; infinite: at the next reset.
    pub restore: f64,
}

impl Default for Breaking {
    fn default() -> Self {
        Self { force: f64::INFINITY, torque: f64::INFINITY, impulse: f64::INFINITY, restore: f64::INFINITY }
    }
}

impl Schedule {
    /// Whether it acts at all times.
    pub fn is_always(&self) -> bool {
        self.windows.is_empty() && self.trigger.is_none()
    }

    /// Activation at `t` seconds after reset; `triggered` is when the trigger last fired, if it did.
    pub fn activation(&self, t: f64, triggered: Option<f64>) -> f64 {
        let t = match (&self.trigger, triggered) {
            (None, _) => t,
            (Some(_), Some(at)) => t - at,
            (Some(_), None) => return 0.0,
        };
        if self.windows.is_empty() {
            return 1.0;
        }
        let t = self.period.map_or(t, |period| t - period * (t / period).floor());
        let Some(window) = self.windows.iter().find(|w| w.start <= t && t < w.end) else { return 0.0 };
        let rise = if self.ramp_in > 0.0 { (t - window.start) / self.ramp_in } else { 1.0 };
        let fall = if self.ramp_out > 0.0 { (window.end - t) / self.ramp_out } else { 1.0 };
        rise.min(fall).clamp(0.0, 1.0)
    }

    /// This schedule without the windows of `other`: its activation fades as `other` grows, so that where it was hard
    /// it is 1 less the activation of `other`. If this one always acts and `other` repeats, the result repeats too.
    pub fn without(&self, other: &Self) -> Self {
        let always = |period: Option<f64>| match period {
            // A window extends round the period's end, so that nothing ramps there.
            Some(period) => Window { start: -period, end: 2.0 * period },
            None => Window { start: f64::NEG_INFINITY, end: f64::INFINITY },
        };
        let period = self.period.or(if self.windows.is_empty() { other.period } else { None });
        let own = if self.windows.is_empty() { vec![always(period)] } else { self.windows.clone() };
        let holes = if other.windows.is_empty() { vec![always(None)] } else { other.windows.clone() };
        let shifts = match period {
            Some(period) => vec![-period, 0.0, period],
            None => vec![0.0],
        };
        let mut left = own;
        for (hole, shift) in shifts.iter().flat_map(|shift| holes.iter().map(move |hole| (hole, shift))) {
            // The ramps of both cross inside the window of `other`.
            let end = period.map_or(hole.end, |period| hole.end.min(period));
            let hole = Window { start: hole.start + other.ramp_in, end: end - other.ramp_out };
            let mut remaining = Vec::new();
            for window in left {
                let before = Window { start: window.start, end: window.end.min(hole.start + shift) };
                let after = Window { start: window.start.max(hole.end + shift), end: window.end };
                remaining.extend([before, after].into_iter().filter(|w| w.start < w.end));
            }
            left = remaining;
        }
        // Windows outside the period are never looked up.
        left.retain(|window| window.end > 0.0 && period.is_none_or(|period| window.start < period));
        if left.is_empty() {
            // Never: a window that is over before it begins.
            left.push(Window { start: 0.0, end: 0.0 });
        }
        Self { windows: left, period, ramp_in: other.ramp_out, ramp_out: other.ramp_in, trigger: self.trigger }
    }
}
