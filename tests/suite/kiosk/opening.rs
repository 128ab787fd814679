//! Opening hours and holidays.

use std::path::Path;

use soffio_config::{Config, Day, Opening, TimeOfDay};

/// A day of January 2026, which begins on a Thursday.
fn january(day: u8) -> Day {
    Day { year: 2026, month: 1, day, weekday: (day + 2) % 7 }
}

fn opening(hours: &[&str], holidays: &[&str]) -> Opening {
    Opening {
        hours: hours.iter().map(|text| text.parse().expect("hours")).collect(),
        holidays: holidays.iter().map(|text| text.parse().expect("a day")).collect(),
    }
}

/// Is it open on this day of January at this time?
fn is_open(opening: &Opening, day: u8, time: &str) -> bool {
    let time: TimeOfDay = time.parse().expect("a time");
    opening.contains(january(day), january(day - 1), time)
}

#[test]
fn hours_are_those_of_their_weekdays_to_the_minute() {
    // The 5th is a Monday.
    let house = opening(&["Tue-Fri 10:00-18:00", "Sat, Sun 11:00-20:30"], &[]);
    for (day, time, open) in [
        (5, "12:00", false),
        (6, "09:59", false),
        (6, "10:00", true),
        (6, "17:59", true),
        (6, "18:00", false),
        (9, "12:00", true),
        (10, "10:30", false),
        (10, "20:29", true),
        (11, "20:30", false),
    ] {
        assert_eq!(is_open(&house, day, time), open, "January {day}, {time}");
    }
    assert!(is_open(&opening(&[], &[]), 5, "03:00"), "without hours it is always open");
}

#[test]
fn a_long_night_belongs_to_the_day_that_it_began_on() {
    let house = opening(&["Fri-Sat 18:00-02:00"], &["2026-01-10"]);
    for (day, time, open) in [
        (9, "18:00", true),
        (10, "01:59", true),
        (10, "02:00", false),
        // The 10th is a holiday: its evening and the night after it are closed.
        (10, "19:00", false),
        (11, "01:00", false),
        (17, "01:00", true),
        (18, "01:00", true),
        (19, "01:00", false),
    ] {
        assert_eq!(is_open(&house, day, time), open, "January {day}, {time}");
    }
    assert!(is_open(&opening(&["Sat-Mon 10:00-11:00"], &[]), 5, "10:30"), "over the end of the week");
}

#[test]
fn holidays_are_of_one_year_or_of_all() {
    let house = opening(&[], &["01-06", "2027-01-07"]);
    assert!(!is_open(&house, 6, "12:00"));
    assert!(is_open(&house, 7, "12:00"));
    let later = Day { year: 2027, month: 1, day: 7, weekday: 3 };
    assert!(!house.contains(later, later, "12:00".parse().expect("a time")));
}

#[test]
fn what_is_written_is_read_back_and_what_is_wrong_is_located() {
    let text = "[opening]\nhours = [\"tue-fri 9:00-18:00\"]\nholidays = [\"12-25\", \"2027-05-01\"]\n";
    let config = Config::parse(text, Path::new("kiosk.toml")).expect("good hours");
    let again = toml::to_string(&config).expect("it serialises");
    assert!(again.contains("Tue,Wed,Thu,Fri 09:00-18:00") && again.contains("\"12-25\""), "{again}");
    assert_eq!(Config::parse(&again, Path::new("kiosk.toml")), Ok(config));
    for (wrong, word) in [
        ("hours = [\"10:00-18:00\"]", "no hours"),
        ("hours = [\"Tues 10:00-18:00\"]", "Mon, Tue"),
        ("hours = [\"Tue 10:00-25:00\"]", "25:00"),
        ("holidays = [\"02-30\"]", "no day"),
        ("holidays = [\"13-01\"]", "no day"),
        ("holidays = [\"Christmas\"]", "no day"),
    ] {
        let error = Config::parse(&format!("[opening]\n{wrong}\n"), Path::new("kiosk.toml")).expect_err(wrong);
        let problem = &error.problems[0];
        assert!(problem.line == 2 && problem.message.contains(word), "{wrong}: {problem:?}");
    }
}
