//! Breath sensor on a serial line: one number a line, 0 (still) … 1 (full strength), such as `0.42\n`.

use std::io::{ErrorKind, Read};
use std::time::Duration;

use serialport::SerialPort;

use super::driver::{Driver, Slot};

/// Longest line, bytes; longer ones are ignored.
const LINE: usize = 32;

/// A serial line.
pub struct Serial {
    path: String,
    baud: u32,
    port: Option<Box<dyn SerialPort>>,
    lines: Lines,
}

impl Serial {
    /// The device at `path`, such as `/dev/ttyACM0`.
    pub fn new(path: &str, baud: u32) -> Self {
        Self { path: path.to_owned(), baud, port: None, lines: Lines::default() }
    }
}

impl Driver for Serial {
    fn open(&mut self, _: &Slot) -> Result<String, String> {
        self.port = None;
        if self.path.is_empty() {
            return Err("controllers.serial names no device, such as \"/dev/ttyACM0\"".into());
        }
        let opened = serialport::new(&self.path, self.baud).open();
        self.port = Some(opened.map_err(|error| format!("{}: {error}", self.path))?);
        self.lines = Lines::default();
        Ok(format!("{}, {} baud", self.path, self.baud))
    }

    fn listen(&mut self, slot: &Slot, wait: Duration) -> Result<(), String> {
        let port = self.port.as_mut().ok_or("not opened")?;
        port.set_timeout(wait).map_err(|error| error.to_string())?;
        let mut bytes = [0; 64];
        match port.read(&mut bytes) {
            Ok(0) => Err(format!("{}: the line is closed", self.path)),
            Ok(count) => {
                for &byte in &bytes[..count] {
                    if let Some(strength) = self.lines.push(byte) {
                        slot.update(|reading| reading.blow(strength));
                    }
                }
                Ok(())
            }
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => Ok(()),
            Err(error) => Err(format!("{}: {error}", self.path)),
        }
    }
}

/// Parser of the lines that a sensor sends.
#[derive(Debug, Default)]
pub struct Lines {
    line: Vec<u8>,
    /// Whether the line is too long and is ignored.
    spoilt: bool,
}

impl Lines {
    /// The number of a line that ends with this byte, if it is valid.
    pub fn push(&mut self, byte: u8) -> Option<f64> {
        if byte != b'\n' {
            self.spoilt |= self.line.len() == LINE;
            if !self.spoilt {
                self.line.push(byte);
            }
            return None;
        }
        let text = std::str::from_utf8(&self.line).ok().filter(|_| !self.spoilt);
        let number = text.and_then(|text| text.trim().parse::<f64>().ok()).filter(|number| number.is_finite());
        self.line.clear();
        self.spoilt = false;
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_are_no_numbers_do_nothing() {
        let mut lines = Lines::default();
        let text = "0.42\r\n\nbreath\n1\n0.3\u{fe}\n99999999999999999999999999999999999999\nnan\n.5\n";
        let numbers: Vec<f64> = text.bytes().filter_map(|byte| lines.push(byte)).collect();
        assert_eq!(numbers, [0.42, 1.0, 0.5]);
    }

    #[cfg(unix)]
    #[test]
    fn a_sensor_blows_through_a_real_line_and_lets_go_when_it_is_pulled() {
        use std::io::Write;

        let (mut sensor, line) = serialport::TTYPort::pair().expect("a pseudo terminal");
        let path = line.name().expect("a name");
        let slot = Slot::default();
        let mut serial = Serial::new(&path, 115_200);
        serial.open(&slot).expect("opens");
        drop(line);
        sensor.write_all(b"0.25\n0.").expect("written");
        let mut until = |strength: f64| {
            (0..40)
                .any(|_| serial.listen(&slot, Duration::from_millis(50)).is_err() || slot.read().strength == strength)
        };
        assert!(until(0.25), "{:?}", slot.read());
        sensor.write_all(b"5\n").expect("written");
        assert!(until(0.5), "{:?}", slot.read());
        drop(sensor);
        assert!((0..40).any(|_| serial.listen(&slot, Duration::from_millis(50)).is_err()), "a pulled line is lost");
    }
}
