//! Commands of a broker, and those that wait.
//!
//! A broker may send thousands of commands in a second, by mistake or on purpose. So at most one of each kind waits: a later one replaces the
//! earlier one, as it would do on the screen. The window takes one in each turn of its loop. Commands that load an exhibit are due once in
//! `LOADS_EVERY`, since loading takes processor time from motion and sound.

use std::fmt;
use std::str::FromStr;
use std::time::{Duration, Instant};

use soffio_config::MqttOrder;

/// Least time between two commands that load an exhibit.
const LOADS_EVERY: Duration = Duration::from_secs(1);
/// Least time between two lines of the log about refused messages.
const LOGS_EVERY: Duration = Duration::from_secs(10);

/// A command to the kiosk, parsed from the text of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// `reload`: load the exhibit on show from its files again.
    Reload,
    /// `blank`: black screen, no sound, the microphone off.
    Blank,
    /// `wake`: end `blank`.
    Wake,
    /// `mute` or `mute on`; `mute off`.
    Mute(bool),
    /// `exhibit ID`: show another exhibit.
    Exhibit(String),
}

impl Order {
    /// Its kind, as the configuration allows it.
    pub fn kind(&self) -> MqttOrder {
        match self {
            Self::Reload => MqttOrder::Reload,
            Self::Blank => MqttOrder::Blank,
            Self::Wake => MqttOrder::Wake,
            Self::Mute(_) => MqttOrder::Mute,
            Self::Exhibit(_) => MqttOrder::Exhibit,
        }
    }

    /// Does this one make an earlier one pointless?
    fn replaces(&self, earlier: &Self) -> bool {
        use Order::{Blank, Exhibit, Mute, Reload, Wake};
        match self {
            Blank | Wake => matches!(earlier, Blank | Wake),
            Mute(_) => matches!(earlier, Mute(_)),
            // Another exhibit is loaded from its files anyway.
            Exhibit(_) => matches!(earlier, Exhibit(_) | Reload),
            Reload => *earlier == Reload,
        }
    }

    /// Does it load an exhibit?
    fn loads(&self) -> bool {
        matches!(self, Self::Reload | Self::Exhibit(_))
    }
}

impl fmt::Display for Order {
    /// The text of its message.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reload => f.write_str("reload"),
            Self::Blank => f.write_str("blank"),
            Self::Wake => f.write_str("wake"),
            Self::Mute(true) => f.write_str("mute on"),
            Self::Mute(false) => f.write_str("mute off"),
            Self::Exhibit(id) => write!(f, "exhibit {id}"),
        }
    }
}

impl FromStr for Order {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split_whitespace().collect();
        Ok(match parts[..] {
            ["reload"] => Self::Reload,
            ["blank"] => Self::Blank,
            ["wake"] => Self::Wake,
            ["mute"] | ["mute", "on"] => Self::Mute(true),
            ["mute", "off"] => Self::Mute(false),
            ["exhibit", id] => Self::Exhibit(id.to_owned()),
            _ => return Err("send reload, blank, wake, mute on, mute off, or exhibit and an id".into()),
        })
    }
}

/// Commands that wait, the oldest first, with the number of those that each has replaced. It holds one of each kind at most.
#[derive(Debug, Default)]
pub struct Orders {
    waiting: Vec<(Order, u64)>,
    /// When a command that loads was taken last.
    loaded: Option<Instant>,
    /// When a refusal was logged last, and the number of refusals since then.
    refused: (Option<Instant>, u64),
}

impl Orders {
    /// Adds a command in place of those that it makes pointless.
    pub fn push(&mut self, order: Order) {
        let mut replaced = 0;
        self.waiting.retain(|(earlier, before)| {
            let gone = order.replaces(earlier);
            replaced += if gone { before + 1 } else { 0 };
            !gone
        });
        self.waiting.push((order, replaced));
    }

    /// Takes the oldest command that is due, and logs it.
    pub fn next(&mut self, now: Instant) -> Option<Order> {
        let may_load = self.loaded.is_none_or(|at| now.duration_since(at) >= LOADS_EVERY);
        let due = self.waiting.iter().position(|(order, _)| may_load || !order.loads())?;
        let (order, replaced) = self.waiting.remove(due);
        if order.loads() {
            self.loaded = Some(now);
        }
        match replaced {
            0 => tracing::info!("mqtt: command: {order}"),
            _ => tracing::info!("mqtt: command: {order}, which replaces {replaced} others"),
        }
        Some(order)
    }

    /// Counts a refused message; returns the number of refused ones that were not logged, if this one is to be.
    pub fn refuse(&mut self, now: Instant) -> Option<u64> {
        let (logged, since) = &mut self.refused;
        if logged.is_some_and(|at| now.duration_since(at) < LOGS_EVERY) {
            *since += 1;
            return None;
        }
        *logged = Some(now);
        Some(std::mem::take(since))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(orders: &mut Orders, now: Instant) -> Vec<Order> {
        std::iter::from_fn(|| orders.next(now)).collect()
    }

    #[test]
    fn orders_are_words_and_nothing_else_is_obeyed() {
        for (text, order) in [
            ("reload", Order::Reload),
            (" blank\n", Order::Blank),
            ("wake", Order::Wake),
            ("mute", Order::Mute(true)),
            ("mute on", Order::Mute(true)),
            ("mute off", Order::Mute(false)),
            ("exhibit terry-clock", Order::Exhibit("terry-clock".into())),
        ] {
            assert_eq!(order.to_string().parse(), Ok(order.clone()), "{order}");
            assert_eq!(text.parse(), Ok(order), "{text}");
        }
        for text in ["", "Reload", "exhibit", "exhibit a b", "mute maybe", "reload now", "shutdown"] {
            assert!(text.parse::<Order>().is_err_and(|help| help.contains("exhibit and an id")), "{text}");
        }
    }

    #[test]
    fn of_a_burst_the_last_one_of_each_kind_is_left_in_the_order_of_arrival() {
        let (mut orders, now) = (Orders::default(), Instant::now());
        for i in 0..3000 {
            for order in
                [Order::Exhibit(format!("n{i}")), Order::Mute(i % 2 == 0), Order::Blank, Order::Reload, Order::Wake]
            {
                orders.push(order);
            }
            assert!(orders.waiting.len() <= 4, "{:?}", orders.waiting);
        }
        orders.push(Order::Exhibit("last".into()));
        let all = [Order::Mute(false), Order::Wake, Order::Exhibit("last".into())];
        assert_eq!(taken(&mut orders, now), all, "an exhibit is loaded anyway, so its reload is gone");
    }

    #[test]
    fn an_exhibit_is_loaded_once_a_second_and_the_rest_at_once() {
        let (mut orders, now) = (Orders::default(), Instant::now());
        let ms = |ms: u64| now + Duration::from_millis(ms);
        orders.push(Order::Exhibit("a".into()));
        assert_eq!(taken(&mut orders, ms(0)), [Order::Exhibit("a".into())]);
        orders.push(Order::Exhibit("b".into()));
        orders.push(Order::Blank);
        assert_eq!(taken(&mut orders, ms(10)), [Order::Blank]);
        orders.push(Order::Exhibit("c".into()));
        assert_eq!(taken(&mut orders, ms(999)), []);
        assert_eq!(taken(&mut orders, ms(1000)), [Order::Exhibit("c".into())]);
        orders.push(Order::Reload);
        assert_eq!((taken(&mut orders, ms(1500)), taken(&mut orders, ms(2000))), (vec![], vec![Order::Reload]));
    }

    #[test]
    fn refusals_are_logged_once_in_ten_seconds_with_their_number() {
        let (mut orders, now) = (Orders::default(), Instant::now());
        assert_eq!(orders.refuse(now), Some(0));
        assert!((1..100).all(|ms| orders.refuse(now + Duration::from_millis(ms)).is_none()));
        assert_eq!(orders.refuse(now + LOGS_EVERY), Some(99));
    }
}
