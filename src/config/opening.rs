//! Opening hours: ranges of weekdays with their times, and closed days.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::hours::TimeOfDay;

/// Weekdays as the file spells them, Monday first.
const WEEKDAYS: [&str; 7] = ["Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"];
/// Days of the longest months.
const MONTHS: [u8; 12] = [31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

/// A day of the calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Day {
    /// Of the common era.
    pub year: i16,
    /// From 1.
    pub month: u8,
    /// From 1.
    pub day: u8,
    /// 0 is Monday.
    pub weekday: u8,
}

/// Opening hours of the venue. Without hours it is open on every day that is no holiday.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Opening {
    /// Weekdays and local times such as "Tue-Fri 10:00-18:00", "Sat,Sun 10:00-20:00"; over midnight where the second
    /// time is the earlier.
    pub hours: Vec<OpenHours>,
    /// Closed days: "2027-05-01", or "12-25" in every year.
    pub holidays: Vec<Holiday>,
}

impl Opening {
    /// Is the venue open at this time of `today`? Hours that began before midnight belong to `yesterday`.
    pub fn contains(&self, today: Day, yesterday: Day, time: TimeOfDay) -> bool {
        let is_open_day = |day: Day| !self.holidays.iter().any(|holiday| holiday.is(day));
        if self.hours.is_empty() {
            return is_open_day(today);
        }
        self.hours.iter().any(|hours| {
            let over_midnight = hours.to <= hours.from;
            let evening = hours.days[usize::from(today.weekday % 7)]
                && is_open_day(today)
                && time >= hours.from
                && (over_midnight || time < hours.to);
            let night = over_midnight
                && hours.days[usize::from(yesterday.weekday % 7)]
                && is_open_day(yesterday)
                && time < hours.to;
            evening || night
        })
    }
}

/// The same hours on some weekdays.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(with = "String")]
pub struct OpenHours {
    /// Monday first.
    days: [bool; 7],
    from: TimeOfDay,
    to: TimeOfDay,
}

impl FromStr for OpenHours {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" are no hours: write weekdays and times, as in \"Tue-Fri 10:00-18:00\"");
        let (named, times) = text.trim().rsplit_once(' ').ok_or_else(wrong)?;
        let (from, to) = times.split_once('-').ok_or_else(wrong)?;
        let (from, to) = (from.parse()?, to.parse()?);
        let weekday = |name: &str| {
            let known = WEEKDAYS.iter().position(|day| day.eq_ignore_ascii_case(name.trim()));
            known.ok_or_else(|| format!("\"{}\" is no weekday: one of {}", name.trim(), WEEKDAYS.join(", ")))
        };
        let mut days = [false; 7];
        for part in named.split(',') {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let (first, last) = (weekday(first)?, weekday(last)?);
            // "Sat-Mon" goes over the end of the week.
            (0..=(last + 7 - first) % 7).for_each(|i| days[(first + i) % 7] = true);
        }
        Ok(Self { days, from, to })
    }
}

impl fmt::Display for OpenHours {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named: Vec<&str> = WEEKDAYS.iter().zip(self.days).filter(|(_, on)| *on).map(|(name, _)| *name).collect();
        write!(f, "{} {}-{}", named.join(","), self.from, self.to)
    }
}

/// A closed day.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(with = "String")]
pub struct Holiday {
    /// `None`: in every year.
    year: Option<i16>,
    month: u8,
    day: u8,
}

impl Holiday {
    fn is(self, day: Day) -> bool {
        self.year.is_none_or(|year| year == day.year) && (self.month, self.day) == (day.month, day.day)
    }
}

impl FromStr for Holiday {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is no day: write \"2027-05-01\", or \"12-25\" for every year");
        let parts: Vec<&str> = text.trim().split('-').collect();
        let (year, month, day) = match parts.as_slice() {
            [year, month, day] if year.len() == 4 => (Some(year.parse().map_err(|_| wrong())?), *month, *day),
            [month, day] => (None, *month, *day),
            _ => return Err(wrong()),
        };
        let month: u8 = month.parse().map_err(|_| wrong())?;
        let day: u8 = day.parse().map_err(|_| wrong())?;
        let last = MONTHS.get(usize::from(month).wrapping_sub(1)).ok_or_else(wrong)?;
        if day == 0 || day > *last {
            return Err(wrong());
        }
        Ok(Self { year, month, day })
    }
}

impl fmt::Display for Holiday {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(year) = self.year {
            write!(f, "{year:04}-")?;
        }
        write!(f, "{:02}-{:02}", self.month, self.day)
    }
}

macro_rules! as_text {
    ($($name:ident),+) => {$(
        impl TryFrom<String> for $name {
            type Error = String;

            fn try_from(text: String) -> Result<Self, String> {
                text.parse()
            }
        }

        impl From<$name> for String {
            fn from(value: $name) -> Self {
                value.to_string()
            }
        }
    )+};
}

as_text!(OpenHours, Holiday);
