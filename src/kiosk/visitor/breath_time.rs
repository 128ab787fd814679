//! Breath time: how long visitors have blown at an exhibit, in this visit and today, s. Nothing about a person.

use jiff::civil::Date;
use serde::{Deserialize, Serialize};

use soffio_exhibit::Label;

/// Key of the label text for it: `{visit}` stands for seconds, `{day}` for seconds or `minutes:seconds`. A label without this
/// text shows nothing.
pub const KEY: &str = "breath_time";

/// Breath time of this visit and of the day.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BreathTime {
    #[serde(skip)]
    visit: f64,
    /// By exhibit.
    day: Vec<(String, f64)>,
    date: Option<Date>,
}

impl BreathTime {
    /// Adds seconds of breath at an exhibit on a day. A day before the last one means that the clock was set: the sum stays.
    pub fn add(&mut self, exhibit: &str, date: Date, seconds: f64) {
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

    /// The visitor has left, or gone to another exhibit.
    pub fn end_visit(&mut self) {
        self.visit = 0.0;
    }

    /// Seconds in this visit and in this day at an exhibit.
    pub fn of(&self, exhibit: &str) -> [f64; 2] {
        [self.visit, self.day.iter().find(|(id, _)| id == exhibit).map_or(0.0, |(_, sum)| *sum)]
    }
}

/// Label text for these seconds of visit and day; `None` before the first second of the day.
pub fn label_text(label: &Label, [visit, day]: [f64; 2]) -> Option<String> {
    let (_, text) = label.text.iter().find(|(key, _)| key == KEY)?;
    (day >= 1.0).then(|| text.replace("{visit}", &(visit.floor() as u64).to_string()).replace("{day}", &time(day)))
}

/// Formats seconds as minutes and seconds, `1:05`, or as seconds alone.
fn time(seconds: f64) -> String {
    let whole = seconds.floor() as u64;
    if whole < 60 { whole.to_string() } else { format!("{}:{:02}", whole / 60, whole % 60) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_visit_and_a_day_are_counted_apart_and_start_again() {
        let (monday, tuesday) = (Date::constant(2026, 1, 5), Date::constant(2026, 1, 6));
        let mut breath_time = BreathTime::default();
        (0..20).for_each(|_| breath_time.add("clock", monday, 1.0));
        breath_time.end_visit();
        (0..50).for_each(|_| breath_time.add("clock", monday, 1.0));
        breath_time.add("fish", monday, 3.0);
        assert_eq!((breath_time.of("clock"), breath_time.of("fish")), ([53.0, 70.0], [53.0, 3.0]));
        breath_time.add("clock", tuesday, 2.0);
        assert_eq!(breath_time.of("clock")[1], 2.0);
        breath_time.add("clock", monday, 1.0);
        assert_eq!(breath_time.of("clock")[1], 3.0, "a clock that is set back takes nothing away");
        let text = vec![(KEY.to_owned(), "You: {visit}. All: {day}.".to_owned())];
        let label = Label { text, ..Label::default() };
        assert_eq!(label_text(&label, [20.9, 65.0]).as_deref(), Some("You: 20. All: 1:05."));
        assert_eq!((label_text(&label, [0.0, 0.0]), label_text(&Label::default(), [9.0, 9.0])), (None, None));
    }
}
