//! Every system of the method at work: its exhibit is visited and measured, and so is a twin without the system.
//!
//! A row names a system, the exhibit that shows it, a visit, and the bars that the visit must pass: measured quantities and their
//! bounds. The visit is played with the exhibit as shipped, which must pass all bars, and with a twin whose sidecar lacks
//! the system, which must fail at least one. `cargo test … systems -- --nocapture` prints what was measured.

mod collisions;
mod gears;
mod joints;
mod limits;
mod motion;
pub mod rendered;
pub mod run;
mod sound;
mod time;
mod twin;
mod wind;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use run::{Run, Visit};
use soffio_exhibit::Exhibit;
use twin::Cut;

/// A system of the method, and how an exhibit shows it.
pub struct Row {
    /// Its name.
    system: &'static str,
    /// The exhibit that shows it.
    exhibit: &'static str,
    /// What a visitor does there.
    visit: Visit,
    /// What its twin lacks.
    without: &'static [Cut],
    /// The bars that the visit must pass.
    shows: fn(&Run) -> Vec<Bar>,
}

/// A measured quantity and its bound.
pub struct Bar {
    what: &'static str,
    value: f64,
    bound: Bound,
}

#[derive(Clone, Copy)]
enum Bound {
    AtLeast(f64),
    AtMost(f64),
}

/// A quantity that must not be less.
fn at_least(bound: f64, what: &'static str, value: f64) -> Bar {
    Bar { what, value, bound: Bound::AtLeast(bound) }
}

/// A quantity that must not be more.
fn at_most(bound: f64, what: &'static str, value: f64) -> Bar {
    Bar { what, value, bound: Bound::AtMost(bound) }
}

impl Bar {
    fn passed(&self) -> bool {
        match self.bound {
            Bound::AtLeast(bound) => self.value >= bound,
            Bound::AtMost(bound) => self.value <= bound,
        }
    }
}

impl fmt::Display for Bar {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (sign, bound) = match self.bound {
            Bound::AtLeast(bound) => ('≥', bound),
            Bound::AtMost(bound) => ('≤', bound),
        };
        write!(f, "{} {:.3e} ({sign} {bound:.3e}{})", self.what, self.value, if self.passed() { "" } else { ", fails" })
    }
}

fn listed(bars: &[Bar]) -> String {
    bars.iter().map(Bar::to_string).collect::<Vec<_>>().join("; ")
}

/// Runs of exhibits as shipped, by exhibit, script, length and machine.
type Shared<'a> = BTreeMap<(&'a str, &'a str, u64, bool), (Arc<Exhibit>, Run)>;

/// Plays all rows of a table, each with its exhibit and its twin. Rows with the same visit share the run of the exhibit.
fn prove(rows: &[Row]) {
    let mut runs = Shared::new();
    let mut wrong = Vec::new();
    for Row { system, exhibit, visit, without, shows } in rows {
        let (shipped, run) =
            runs.entry((exhibit, visit.script, visit.seconds.to_bits(), visit.slow_machine)).or_insert_with(|| {
                let shipped = Arc::new(twin::shipped(exhibit));
                let run = Run::new(&shipped, shipped.clone(), *visit);
                (shipped, run)
            });
        let bars = shows(run);
        let sabotaged = shows(&Run::new(shipped, Arc::new(twin::twin(exhibit, without)), *visit));
        println!("{system} | {exhibit} | {} | {}", listed(&bars), listed(&sabotaged));
        if !bars.iter().all(Bar::passed) {
            wrong.push(format!("{exhibit} does not show {system}: {}", listed(&bars)));
        }
        if sabotaged.iter().all(Bar::passed) {
            wrong.push(format!("the twin of {exhibit} shows {system} without {without:?}: {}", listed(&sabotaged)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// All tables.
const TABLES: [&[Row]; 8] =
    [joints::ROWS, gears::ROWS, limits::ROWS, time::ROWS, motion::ROWS, collisions::ROWS, wind::ROWS, sound::ROWS];

#[test]
fn each_small_exhibit_shows_what_its_label_says() {
    let labels = [
        ("blown-together", "self-assembly in the course of it"),
        ("blown-together", "event trigger"),
        ("blown-together", "ramp"),
        ("loose-nail", "ball joint minus an element"),
        ("loose-nail", "periodic window"),
        ("universal-joint", "universal joint"),
        ("moving-path", "point on a moving path"),
        ("axis-wheel", "transition between axes"),
        ("breaking-chain", "breaking at a limit"),
        ("windmill", "windmill joint"),
        ("gear-train", "gear to weight"),
        ("terry-clock", "teeth that touch"),
        ("terry-clock", "line"),
        ("breath-clock", "ratchet"),
        ("strikers", "weld"),
        ("strikers", "spring and damper, angular"),
        ("marionette", "taken by the hand"),
        ("billiards", "rolling and sliding balls"),
        ("scratch-board", "scratching wood"),
        ("hang-it", "point on plane"),
        ("windy-corner", "fan"),
        ("chains", "body that follows a path"),
        ("steel-fish", "plates that ring"),
        ("wind-chimes", "a tube that rings"),
    ];
    // The tables' own tests play the rows.
    for (exhibit, system) in labels {
        let shown =
            TABLES.iter().flat_map(|rows| rows.iter()).any(|row| row.system == system && row.exhibit == exhibit);
        assert!(shown, "{exhibit} has no row: {system}");
    }
}

#[test]
fn no_system_has_two_rows() {
    let mut names: Vec<&str> = TABLES.iter().flat_map(|rows| rows.iter()).map(|row| row.system).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
}
