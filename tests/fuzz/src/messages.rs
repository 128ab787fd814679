//! What is done with bytes that come from outside while the kiosk runs: orders of a broker, packets and lines of controllers.

use std::path::Path;

use soffio_devices::controllers::{Lines, Reading, enter_packet};
use soffio_kiosk::fleet::Order;

use super::inputs::Reader;

/// A kind of message by its name.
pub const KINDS: &[(&str, Reader)] = &[("order", order), ("osc", osc), ("serial", serial)];

/// The text of an order over MQTT.
pub fn order(_: &Path, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match text.parse::<Order>() {
        Ok(order) => drop(order.kind()),
        Err(why) => assert!(!why.is_empty()),
    }
}

/// A packet of Open Sound Control.
pub fn osc(_: &Path, bytes: &[u8]) {
    let mut reading = Reading::default();
    enter_packet(&mut reading, bytes);
    within(&reading);
}

/// Bytes of a sensor on a serial line.
pub fn serial(_: &Path, bytes: &[u8]) {
    let mut lines = Lines::default();
    let numbers = bytes.iter().filter_map(|&byte| lines.push(byte));
    numbers.for_each(|number| assert!(number.is_finite()));
}

fn within(reading: &Reading) {
    assert!((0.0..=1.0).contains(&reading.strength), "{reading:?}");
    let aim = reading.aim.map_or([0.5; 2], |(aim, _)| aim);
    assert!(aim.iter().all(|x| (0.0..=1.0).contains(x)), "{reading:?}");
}
