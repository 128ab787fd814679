//! Activation of constraints (or springs) over time: schedules, breaks, triggers.
//!
//! Activations are set once a substep, for its middle. A substep never straddles the edge of a window
//! ([`Activity::next_edge`]), so a row is present in all stages of the substep or in none.

use super::schedule::{Breaking, Schedule, Trigger};
use super::{Constraint, Spring};

/// State of one constraint or spring.
#[derive(Clone, Debug)]
struct Entry {
    schedule: Schedule,
    breaking: Option<Breaking>,
    /// Entries of one group break together.
    group: usize,
    triggered: Option<f64>,
    broken: Option<f64>,
    /// It acts again after a break, and stabilisation is still closing it.
    reclosing: bool,
    /// Whether a clutch slips now; `None`: not a clutch.
    slipping: Option<bool>,
    activation: f64,
}

/// Load of a constraint or spring: N and N m, or of an impact N s and N m s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Norm of the multipliers of its length rows, N (impact: N s).
    pub force: f64,
    /// Norm of the multipliers of its angle rows, N m (impact: N m s).
    pub torque: f64,
}

/// What a [`Load`] is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadKind {
    /// Forces and torques.
    Continuous,
    /// Impulses of an impact.
    Impact,
}

/// A constraint or spring that broke under its load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Break {
    /// Index of the constraint (or spring) that was overloaded.
    pub index: usize,
    /// Time of the break, s since reset.
    pub time: f64,
}

/// Activations, breaks and triggers of all constraints, or of all springs.
#[derive(Clone, Debug, Default)]
pub struct Activity {
    time: f64,
    entries: Vec<Entry>,
    /// Entries whose activation can change.
    changing: Vec<usize>,
    /// Entries that can break.
    fragile: Vec<usize>,
    /// Whether any activation is between 0 and 1.
    partial: bool,
    /// Breaks in order of time, since the list was last cleared.
    pub breaks: Vec<Break>,
    /// Triggers that fired since this was last cleared: index of the entry, seconds since reset.
    pub fired: Vec<(usize, f64)>,
}

impl Activity {
    /// Activity of constraints. Those with the same name before the `/` form a group.
    pub fn new(constraints: &[Constraint]) -> Self {
        let group =
            |c: &Constraint| constraints.iter().position(|other| other.group() == c.group()).unwrap_or_default();
        let mut activity = Self::of(constraints.iter().map(|c| (c.schedule.clone(), c.breaking, group(c))));
        for (index, _) in constraints.iter().enumerate().filter(|(_, c)| c.slips.is_some()) {
            activity.entries[index].slipping = Some(false);
            activity.changing.retain(|&other| other != index);
            activity.changing.push(index);
        }
        activity
    }

    /// Activity of springs.
    pub fn of_springs(springs: &[Spring]) -> Self {
        Self::of(springs.iter().enumerate().map(|(i, s)| (s.schedule.clone(), s.breaking, i)))
    }

    fn of(all: impl Iterator<Item = (Schedule, Option<Breaking>, usize)>) -> Self {
        let entries: Vec<Entry> = all
            .map(|(schedule, breaking, group)| Entry {
                schedule,
                breaking,
                group,
                triggered: None,
                broken: None,
                reclosing: false,
                slipping: None,
                activation: 1.0,
            })
            .collect();
        let fragile: Vec<usize> = (0..entries.len()).filter(|&i| entries[i].breaking.is_some()).collect();
        let whole_group = |i: &usize| entries.iter().any(|m| m.group == entries[*i].group && m.breaking.is_some());
        let changing: Vec<usize> =
            (0..entries.len()).filter(|i| !entries[*i].schedule.is_always() || whole_group(i)).collect();
        let mut activity = Self {
            breaks: Vec::with_capacity(entries.len()),
            fired: Vec::with_capacity(entries.len()),
            entries,
            changing,
            fragile,
            partial: false,
            time: 0.0,
        };
        activity.update_activations(0.0);
        activity
    }

    /// Seconds since reset, for functions of time.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets the time for functions of time; activations stay.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// Sets all activations for the time `t` (s), and restores breaks whose time is over. Returns whether any
    /// activation changed.
    pub fn update_activations(&mut self, t: f64) -> bool {
        let mut changed = false;
        self.partial = false;
        for &index in &self.changing {
            let entry = &mut self.entries[index];
            if let (Some(since), Some(breaking)) = (entry.broken, entry.breaking)
                && t - since >= breaking.restore
            {
                entry.broken = None;
                entry.reclosing = true;
            }
            let whole = entry.schedule.activation(t, entry.triggered);
            let loose = entry.broken.is_some() || entry.slipping == Some(true);
            let activation = if loose { 0.0 } else { whole };
            changed |= activation != entry.activation;
            self.partial |= activation > 0.0 && activation < 1.0;
            entry.activation = activation;
        }
        changed
    }

    /// Whether any activation is between 0 and 1.
    pub fn is_partial(&self) -> bool {
        self.partial
    }

    /// Activation of an entry, 0 … 1.
    pub fn activation(&self, index: usize) -> f64 {
        self.entries[index].activation
    }

    /// First time after `t` (s) at which a window opens or closes, or a break is restored; infinite if there is none.
    pub fn next_edge(&self, t: f64) -> f64 {
        let mut next = f64::INFINITY;
        for &index in &self.changing {
            let entry = &self.entries[index];
            let mut offer = |edge: f64| {
                if edge > t {
                    next = next.min(edge);
                }
            };
            if let (Some(since), Some(breaking)) = (entry.broken, entry.breaking) {
                offer(since + breaking.restore);
            }
            let origin = match (&entry.schedule.trigger, entry.triggered) {
                (None, _) => 0.0,
                (Some(_), Some(at)) => at,
                (Some(_), None) => continue,
            };
            let period = entry.schedule.period;
            let current_period = period.map_or(0.0, |period| period * ((t - origin) / period).floor());
            for window in &entry.schedule.windows {
                // Windows may extend over the period's end.
                for shift in [0.0, -period.unwrap_or(0.0)] {
                    offer(origin + current_period + shift + window.start);
                    offer(origin + current_period + shift + window.end);
                }
            }
            if let Some(period) = period {
                offer(origin + current_period + period);
            }
        }
        next
    }

    /// Indices of the entries that can break.
    pub fn fragile(&self) -> &[usize] {
        &self.fragile
    }

    /// Reports whether a restored entry is closed. Until then no load breaks it, since the stabilising force is not a
    /// load.
    pub fn set_reclosed(&mut self, index: usize, closed: bool) {
        self.entries[index].reclosing &= !closed;
    }

    /// Whether it acts again after a break, but is not closed yet.
    pub fn is_reclosing(&self, index: usize) -> bool {
        self.entries[index].reclosing
    }

    /// Lets a clutch slip or stick. A clutch has no windows: its activation is 0 or 1.
    pub fn set_slipping(&mut self, index: usize, slipping: bool) {
        let entry = &mut self.entries[index];
        (entry.slipping, entry.activation) = (Some(slipping), if slipping { 0.0 } else { 1.0 });
    }

    /// Whether a load breaks the entry. `load` is (of lengths, of angles): N and N m, or with `impulse` N s and N m
    /// s.
    pub fn overloaded(&self, index: usize, load: Load, kind: LoadKind) -> bool {
        let entry = &self.entries[index];
        let Some(limit) = entry.breaking.filter(|_| entry.activation > 0.0 && !entry.reclosing) else { return false };
        match kind {
            LoadKind::Impact => load.force.max(load.torque) > limit.impulse,
            LoadKind::Continuous => load.force > limit.force || load.torque > limit.torque,
        }
    }

    /// Breaks an entry and its group.
    pub fn break_at(&mut self, index: usize, time: f64) {
        let (group, breaking) = (self.entries[index].group, self.entries[index].breaking);
        for entry in self.entries.iter_mut().filter(|entry| entry.group == group) {
            entry.broken = Some(time);
            entry.reclosing = false;
            entry.breaking = entry.breaking.or(breaking);
            entry.activation = 0.0;
        }
        self.breaks.push(Break { index, time });
    }

    /// Fires the triggers that wait for an impact of at least `impulse` (N s) on a body.
    pub fn trigger_by_impact(&mut self, body: usize, impulse: f64, time: f64) {
        self.fire(time, |trigger| {
            matches!(*trigger, Trigger::Impact { body: b, least_impulse } if b == body && impulse >= least_impulse)
        });
    }

    /// Fires the triggers that wait for a breath of `speed` (m/s). A sustained breath fires once.
    pub fn trigger_by_breath(&mut self, before: f64, speed: f64, time: f64) {
        self.fire(time, |trigger| {
            matches!(*trigger, Trigger::Breath { least_speed } if speed >= least_speed && before < least_speed)
        });
    }

    fn fire(&mut self, time: f64, matches_trigger: impl Fn(&Trigger) -> bool) {
        for &index in &self.changing {
            let entry = &mut self.entries[index];
            if entry.schedule.trigger.as_ref().is_some_and(&matches_trigger) {
                entry.triggered = Some(time);
                self.fired.push((index, time));
            }
        }
    }
}
