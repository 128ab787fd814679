//! When constraints act and break.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::sidecar::{self, Restore, Start, Timing, Windows};
use super::super::context::Context;
use super::{Header, Joints};
use soffio_multibody::articulation::{Breaking, Constraint, Schedule, Spring, Trigger, Window};
use soffio_multibody::collision::Collider;

impl Context<'_> {
    /// What all rows of a table share; the name is taken.
    pub(super) fn header<'n>(&mut self, name: &'n str, timing: &Timing, at: &'n str, out: &mut Joints) -> Header<'n> {
        self.name(name, at, out);
        let schedule = self.schedule(timing, at, name);
        let breaking = timing.breaking.as_ref().and_then(|given| self.breaking(given, &format!("{at}/break"), name));
        self.enable(name, timing.enabled, at, out);
        let place = format!("{at}/stabilize/time_constant");
        let time = timing.stabilize.as_ref().and_then(|given| given.time_constant);
        let stabilization_time = time.map(|time| self.positive(time.0, &place));
        Header { name, at, schedule, breaking, stabilization_time }
    }

    fn schedule(&mut self, timing: &Timing, at: &str, name: &str) -> Schedule {
        let list: &[sidecar::Window] = match &timing.window {
            None => &[],
            Some(Windows::One(one)) => std::slice::from_ref(one),
            Some(Windows::Several(several)) => several,
        };
        let trigger = timing.trigger.as_ref().and_then(|start| self.trigger(start, at, name));
        let period = timing.period.map(|p| self.positive(p.0, &format!("{at}/period")));
        let mut schedule = Schedule { period, trigger, ..Schedule::default() };
        for (i, given) in list.iter().enumerate() {
            let place = match timing.window {
                Some(Windows::Several(_)) => format!("{at}/window/{i}"),
                _ => format!("{at}/window"),
            };
            let window = Window { start: given.start.0, end: given.end.map_or(f64::INFINITY, |end| end.seconds()) };
            let (ramp_in, ramp_out) = (given.ramp_in.0, given.ramp_out.0);
            if i == 0 {
                (schedule.ramp_in, schedule.ramp_out) = (ramp_in, ramp_out);
            }
            let after = schedule.windows.last().map(|before| before.end);
            let same = (ramp_in, ramp_out) == (schedule.ramp_in, schedule.ramp_out);
            if let Some((what, help)) = self.window_problem(&schedule, window, ramp_in, ramp_out, after, same) {
                let message = format!("the window of \"{name}\" {what}");
                self.report(&place, Diagnostic::new(codes::WINDOW, message).help(help));
            } else {
                schedule.windows.push(window);
            }
        }
        if list.is_empty() && timing.period.is_some() {
            let message = format!("\"{name}\" has a period and no window that could repeat");
            let help = "add window = { start = 0, end = 2 }";
            self.report(&format!("{at}/period"), Diagnostic::new(codes::WINDOW, message).help(help));
        }
        schedule
    }

    /// What is wrong with a window, and what to do.
    fn window_problem(
        &self,
        schedule: &Schedule,
        Window { start, end }: Window,
        ramp_in: f64,
        ramp_out: f64,
        after: Option<f64>,
        same_ramps: bool,
    ) -> Option<(String, &'static str)> {
        let duration = self.sidecar.scene.duration.map_or(f64::INFINITY, |end| end.seconds());
        let late = schedule.trigger.is_none() && start >= duration;
        if start < 0.0 || ramp_in < 0.0 || ramp_out < 0.0 {
            Some(("has a time below zero".into(), "time counts from the start of the exhibit"))
        } else if end <= start {
            Some((format!("ends at {end} s, before it starts at {start} s"), "end must come after start"))
        } else if ramp_in + ramp_out > end - start {
            let length = end - start;
            Some((format!("is {length} s long, shorter than its ramps"), "shorten ramp_in and ramp_out"))
        } else if after.is_some_and(|before| start < before) {
            Some(("starts before the one above it ends".into(), "write windows in increasing time, without overlap"))
        } else if late {
            Some((format!("starts at {start} s, after the run of {duration} s"), "see [scene] duration"))
        } else if schedule.period.is_some_and(|period| start >= period || (end.is_finite() && end > period)) {
            Some((format!("reaches to {end} s, beyond its period"), "windows repeat within the period"))
        } else if !same_ramps {
            Some(("has ramps of its own".into(), "all windows of one constraint have the ramps of the first"))
        } else {
            None
        }
    }

    fn trigger(&mut self, given: &Start, at: &str, name: &str) -> Option<Trigger> {
        let place = format!("{at}/trigger");
        match given {
            Start::Breath { least } => {
                Some(Trigger::Breath { least_speed: self.not_negative(least.0, &format!("{place}/least")) })
            }
            Start::Impact { body, least } => {
                let at_body = format!("{place}/body");
                let node = self.node(body, &at_body, &format!("the trigger of \"{name}\""))?;
                let Some(index) = self.owner[node] else {
                    let message = format!("node \"{body}\" is fixed, so its impacts are not reported");
                    let problem = Diagnostic::new(codes::UNKNOWN_BODY, message);
                    self.report(&at_body, problem.help("name the moving body of the impact"));
                    return None;
                };
                let least_impulse = self.not_negative(least.0, &format!("{place}/least"));
                Some(Trigger::Impact { body: index, least_impulse })
            }
        }
    }

    /// Reports triggers that wait for hits on a body which cannot be hit.
    pub(in super::super) fn check_triggers(
        &mut self,
        constraints: &[Constraint],
        springs: &[Spring],
        colliders: &[Collider],
    ) {
        let schedules = constraints.iter().map(|c| (c.group(), &c.schedule));
        let mut reported: Vec<&str> = Vec::new();
        for (name, schedule) in schedules.chain(springs.iter().map(|s| (s.name.as_str(), &s.schedule))) {
            let Some(Trigger::Impact { body, .. }) = schedule.trigger else { continue };
            if colliders.iter().any(|c| c.body == Some(body)) || reported.contains(&name) {
                continue;
            }
            reported.push(name);
            let body = self.body_name(Some(body)).to_owned();
            let message = format!("\"{name}\" waits for impacts on \"{body}\", which has no collider");
            let help = format!("add [[collider]] node = \"{body}\"");
            let place = format!("{}/trigger", self.place(name));
            self.report(&place, Diagnostic::new(codes::TRIGGER, message).help(help));
        }
    }

    fn breaking(&mut self, given: &sidecar::Break, at: &str, name: &str) -> Option<Breaking> {
        let loads = [
            ("force", given.force.map(|x| x.0)),
            ("torque", given.torque.map(|x| x.0)),
            ("impulse", given.impulse.map(|x| x.0)),
        ];
        if loads.iter().all(|(_, load)| load.is_none()) {
            let message = format!("\"{name}\" has no breaking load");
            let help = "add force = \"25 N\", torque or impulse; or leave `break` out";
            self.report(at, Diagnostic::new(codes::NO_BREAK, message).help(help));
            return None;
        }
        let [force, torque, impulse] =
            loads.map(|(key, load)| load.map_or(f64::INFINITY, |load| self.positive(load, &format!("{at}/{key}"))));
        let restore = match given.restore {
            Some(Restore::After(time)) => self.positive(time.0, &format!("{at}/restore")),
            Some(Restore::Word(_)) | None => f64::INFINITY,
        };
        Some(Breaking { force, torque, impulse, restore })
    }

    /// Notes when the rows of a table act and break.
    pub(super) fn record_timing_origins(&mut self, of: &str, header: &Header) {
        let Header { schedule, breaking, at, stabilization_time, .. } = header;
        if let Some(time) = stabilization_time {
            self.record_origin(of, "time_constant", format!("{time} s"), &format!("{at}/stabilize/time_constant"), "");
        }
        if !schedule.windows.is_empty() {
            let spans = schedule.windows.iter().map(|w| format!("{} to {} s", w.start, w.end));
            let repeated = schedule.period.map(|p| format!(", every {p} s")).unwrap_or_default();
            let ramps = format!("; ramps {} s and {} s", schedule.ramp_in, schedule.ramp_out);
            let value = spans.collect::<Vec<_>>().join(", ") + &repeated + &ramps;
            self.record_origin(of, "window", value, &format!("{at}/window"), "");
        }
        if let Some(trigger) = schedule.trigger {
            let value = match trigger {
                Trigger::Impact { body, least_impulse } => {
                    format!("an impact on {} of {least_impulse} N s", self.body_name(Some(body)))
                }
                Trigger::Breath { least_speed } => format!("a breath of {least_speed} m/s"),
            };
            self.record_origin(of, "trigger", value, &format!("{at}/trigger"), "");
        }
        if let Some(Breaking { force, torque, impulse, restore }) = breaking {
            let loads = [(force, "N"), (torque, "N m"), (impulse, "N s")];
            let loads = loads.iter().filter(|(load, _)| load.is_finite()).map(|(load, unit)| format!("{load} {unit}"));
            let back = if restore.is_finite() { format!("closes after {restore} s") } else { "until reset".into() };
            let value = format!("{}, {back}", loads.collect::<Vec<_>>().join(" or "));
            self.record_origin(of, "break", value, &format!("{at}/break"), "");
        }
    }
}
