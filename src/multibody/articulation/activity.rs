//! What acts now: the shares of all constraints (or springs), what has broken, what has been triggered.
//!
//! Shares are set once a substep, for its middle; a substep never straddles the edge of a window
//! ([`Activity::next_edge`]), so that a row is either there for all of its stages or for none.

use super::schedule::{Breaking, Schedule, Trigger};
use super::{Constraint, Spring};

/// One thing that may come and go.
#[derive(Clone, Debug)]
struct Member {
    schedule: Schedule,
    breaking: Option<Breaking>,
    /// Members of one group break together.
    group: usize,
    triggered: Option<f64>,
    broken: Option<f64>,
    /// Closed again, but not yet drawn together.
    mends: bool,
    /// A clutch that gives way now; `None`: not a clutch.
    slips: Option<bool>,
    share: f64,
}

/// Something that gave way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Break {
    /// Index of the constraint (or spring) that was overloaded.
    pub index: usize,
    /// Seconds since reset.
    pub time: f64,
}

/// What acts now.
#[derive(Clone, Debug, Default)]
pub struct Activity {
    time: f64,
    members: Vec<Member>,
    /// Members whose share can change: the others are looked at once.
    changing: Vec<usize>,
    /// Members that can break.
    fragile: Vec<usize>,
    /// Is any share between 0 and 1?
    partial: bool,
    /// What broke since it was last cleared.
    pub breaks: Vec<Break>,
    /// Triggers that fired since this was last cleared: index of the member, seconds since reset.
    pub fired: Vec<(usize, f64)>,
}

impl Activity {
    /// Of constraints; those of one name before the `/` are a group.
    pub fn new(constraints: &[Constraint]) -> Self {
        let group =
            |c: &Constraint| constraints.iter().position(|other| other.group() == c.group()).unwrap_or_default();
        let mut activity = Self::of(constraints.iter().map(|c| (c.schedule.clone(), c.breaking, group(c))));
        for (index, _) in constraints.iter().enumerate().filter(|(_, c)| c.slips.is_some()) {
            activity.members[index].slips = Some(false);
            activity.changing.retain(|&other| other != index);
            activity.changing.push(index);
        }
        activity
    }

    /// Of springs.
    pub fn of_springs(springs: &[Spring]) -> Self {
        Self::of(springs.iter().enumerate().map(|(i, s)| (s.schedule.clone(), s.breaking, i)))
    }

    fn of(all: impl Iterator<Item = (Schedule, Option<Breaking>, usize)>) -> Self {
        let members: Vec<Member> = all
            .map(|(schedule, breaking, group)| Member {
                schedule,
                breaking,
                group,
                triggered: None,
                broken: None,
                mends: false,
                slips: None,
                share: 1.0,
            })
            .collect();
        let fragile: Vec<usize> = (0..members.len()).filter(|&i| members[i].breaking.is_some()).collect();
        let whole_group = |i: &usize| members.iter().any(|m| m.group == members[*i].group && m.breaking.is_some());
        let changing: Vec<usize> =
            (0..members.len()).filter(|i| !members[*i].schedule.is_always() || whole_group(i)).collect();
        let mut activity = Self {
            breaks: Vec::with_capacity(members.len()),
            fired: Vec::with_capacity(members.len()),
            members,
            changing,
            fragile,
            partial: false,
            time: 0.0,
        };
        activity.set_shares(0.0);
        activity
    }

    /// Seconds since reset, for functions of time.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets the time of functions, not the shares.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// Sets the shares for the time `t`, and closes again what has been broken long enough. Did any change?
    pub fn set_shares(&mut self, t: f64) -> bool {
        let mut changed = false;
        self.partial = false;
        for &index in &self.changing {
            let member = &mut self.members[index];
            if let (Some(since), Some(breaking)) = (member.broken, member.breaking)
                && t - since >= breaking.restore
            {
                member.broken = None;
                member.mends = true;
            }
            let whole = member.schedule.share(t, member.triggered);
            let loose = member.broken.is_some() || member.slips == Some(true);
            let share = if loose { 0.0 } else { whole };
            changed |= share != member.share;
            self.partial |= share > 0.0 && share < 1.0;
            member.share = share;
        }
        changed
    }

    /// Does anything act in part only?
    pub fn is_partial(&self) -> bool {
        self.partial
    }

    /// Share of a member, 0 … 1.
    pub fn share(&self, index: usize) -> f64 {
        self.members[index].share
    }

    /// The first time after `t` at which a window opens or closes, or something broken closes again.
    pub fn next_edge(&self, t: f64) -> f64 {
        let mut next = f64::INFINITY;
        for &index in &self.changing {
            let member = &self.members[index];
            let mut offer = |edge: f64| {
                if edge > t {
                    next = next.min(edge);
                }
            };
            if let (Some(since), Some(breaking)) = (member.broken, member.breaking) {
                offer(since + breaking.restore);
            }
            let origin = match (&member.schedule.trigger, member.triggered) {
                (None, _) => 0.0,
                (Some(_), Some(at)) => at,
                (Some(_), None) => continue,
            };
            let period = member.schedule.period;
            let round = period.map_or(0.0, |period| period * ((t - origin) / period).floor());
            for window in &member.schedule.windows {
                // Windows may reach over the period's end.
                for shift in [0.0, -period.unwrap_or(0.0)] {
                    offer(origin + round + shift + window.start);
                    offer(origin + round + shift + window.end);
                }
            }
            if let Some(period) = period {
                offer(origin + round + period);
            }
        }
        next
    }

    /// Indices of what can break.
    pub fn fragile(&self) -> &[usize] {
        &self.fragile
    }

    /// Says that a member that has closed again is drawn together, or not yet: until then no load breaks it, as the
    /// force that draws it is none of the figure's own.
    pub fn mended(&mut self, index: usize, together: bool) {
        self.members[index].mends &= !together;
    }

    /// Has it closed again, and is still being drawn together?
    pub fn mends(&self, index: usize) -> bool {
        self.members[index].mends
    }

    /// Lets a clutch slip, or hold again. It has no windows: it acts wholly or not at all.
    pub fn slip(&mut self, index: usize, slips: bool) {
        let member = &mut self.members[index];
        (member.slips, member.share) = (Some(slips), if slips { 0.0 } else { 1.0 });
    }

    /// Does this load break it? `load` is (of lengths, of angles): N and N m, or with `impulse` N s and N m s.
    pub fn overloaded(&self, index: usize, load: (f64, f64), impulse: bool) -> bool {
        let member = &self.members[index];
        let Some(limit) = member.breaking.filter(|_| member.share > 0.0 && !member.mends) else { return false };
        if impulse { load.0.max(load.1) > limit.impulse } else { load.0 > limit.force || load.1 > limit.torque }
    }

    /// Breaks a member and its group.
    pub fn break_at(&mut self, index: usize, time: f64) {
        let (group, breaking) = (self.members[index].group, self.members[index].breaking);
        for member in self.members.iter_mut().filter(|member| member.group == group) {
            member.broken = Some(time);
            member.mends = false;
            member.breaking = member.breaking.or(breaking);
            member.share = 0.0;
        }
        self.breaks.push(Break { index, time });
    }

    /// Fires the triggers that wait for a hit of `impulse` (N s) on a body.
    pub fn hit(&mut self, body: usize, impulse: f64, time: f64) {
        self.fire(time, |trigger| {
            matches!(*trigger, Trigger::Impact { body: b, least_impulse } if b == body && impulse >= least_impulse)
        });
    }

    /// Fires the triggers that wait for a breath of `speed` (m/s). A breath that goes on fires once.
    pub fn breathe(&mut self, before: f64, speed: f64, time: f64) {
        self.fire(time, |trigger| {
            matches!(*trigger, Trigger::Breath { least_speed } if speed >= least_speed && before < least_speed)
        });
    }

    fn fire(&mut self, time: f64, answers: impl Fn(&Trigger) -> bool) {
        for &index in &self.changing {
            let member = &mut self.members[index];
            if member.schedule.trigger.as_ref().is_some_and(&answers) {
                member.triggered = Some(time);
                self.fired.push((index, time));
            }
        }
    }
}
