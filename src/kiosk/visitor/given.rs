//! How long visitors have blown at a work: in this visit, and today. A number of seconds; nothing about anybody.

use jiff::civil::Date;
use serde::{Deserialize, Serialize};

use soffio_exhibit::Label;

/// Key of the text that says it: `{visit}` stands for seconds, `{day}` for seconds or `minutes:seconds`. A label without it says nothing.
pub const KEY: &str = "given";

/// What was given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Given {
    #[serde(skip)]
    visit: f64,
    /// By exhibit.
    day: Vec<(String, f64)>,
    date: Option<Date>,
}

impl Given {
    /// Adds seconds that were blown at an exhibit on a day. A day before the last one is a clock that was set: the sum
    /// stays.
    pub fn note(&mut self, exhibit: &str, date: Date, seconds: f64) {
        if self.date.is_none_or(|last| last < date) {
            self.day.clear();
        }
        self.date = Some(date);
        self.visit += seconds;
        match self.day.iter_mut().find(|(id, _)| id == exhibit) {
            Some((_, sum)) => *sum += seconds,
            None => self.day.push((exhibit.to_owned(), seconds)),
        }
    }

    /// The visitor has left, or gone to another work.
    pub fn leave(&mut self) {
        self.visit = 0.0;
    }

    /// Seconds of this visit and of this day, for an exhibit.
    pub fn of(&self, exhibit: &str) -> [f64; 2] {
        [self.visit, self.day.iter().find(|(id, _)| id == exhibit).map_or(0.0, |(_, sum)| *sum)]
    }
}

/// What a label says of it; nothing before the first second of the day.
pub fn said(label: &Label, [visit, day]: [f64; 2]) -> Option<String> {
    let (_, text) = label.text.iter().find(|(key, _)| key == KEY)?;
    (day >= 1.0).then(|| text.replace("{visit}", &(visit.floor() as u64).to_string()).replace("{day}", &time(day)))
}

/// Seconds as minutes and seconds, `1:05`, or seconds alone.
fn time(seconds: f64) -> String {
    let whole = seconds.floor() as u64;
    if whole < 60 { whole.to_string() } else { format!("{}:{:02}", whole / 60, whole % 60) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_visit_and_a_day_are_counted_apart_and_begin_anew() {
        let (monday, tuesday) = (Date::constant(2026, 1, 5), Date::constant(2026, 1, 6));
        let mut given = Given::default();
        (0..20).for_each(|_| given.note("clock", monday, 1.0));
        given.leave();
        (0..50).for_each(|_| given.note("clock", monday, 1.0));
        given.note("fish", monday, 3.0);
        assert_eq!((given.of("clock"), given.of("fish")), ([53.0, 70.0], [53.0, 3.0]));
        given.note("clock", tuesday, 2.0);
        assert_eq!(given.of("clock")[1], 2.0);
        given.note("clock", monday, 1.0);
        assert_eq!(given.of("clock")[1], 3.0, "a clock that is set back takes nothing away");
        let text = vec![(KEY.to_owned(), "You: {visit}. All: {day}.".to_owned())];
        let label = Label { text, ..Label::default() };
        assert_eq!(said(&label, [20.9, 65.0]).as_deref(), Some("You: 20. All: 1:05."));
        assert_eq!((said(&label, [0.0, 0.0]), said(&Label::default(), [9.0, 9.0])), (None, None));
    }
}
