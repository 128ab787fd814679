//! MIDI breath controllers: control change 2 (Breath Controller, MIDI 1.0), 7 bits, on any channel.
//!
//! The library calls back on its own thread; a port that is pulled out is noticed because it is no longer listed.

use std::path::Path;
use std::time::{Duration, Instant};

use midir::{Ignore, MidiInput, MidiInputConnection};

use super::driver::{Driver, Slot};

/// Client name for other programs.
const CLIENT: &str = "soffio";
/// Interval of the checks whether the port still exists.
const ROLL_CALL: Duration = Duration::from_secs(2);
/// MIDI sequencer device of Linux.
const SEQUENCER: &str = "/dev/snd/seq";
/// The kernel's own loop-back port, which is no controller.
const NOT_AN_INSTRUMENT: &str = "Midi Through";

/// One MIDI port.
pub struct Midi {
    wanted: String,
    controller: u8,
    line: Option<(String, MidiInputConnection<()>)>,
    looked: Instant,
}

impl Midi {
    /// The first port with this in its name; empty is any. `controller` is the number of the control change.
    pub fn new(wanted: &str, controller: u8) -> Self {
        Self { wanted: wanted.to_owned(), controller, line: None, looked: Instant::now() }
    }
}

impl Driver for Midi {
    fn open(&mut self, slot: &Slot) -> Result<String, String> {
        self.line = None;
        let mut midi = client()?;
        midi.ignore(Ignore::All);
        let named = names(&midi);
        let wanted = self.wanted.to_lowercase();
        let fits = |name: &str| name.to_lowercase().contains(&wanted) && !name.starts_with(NOT_AN_INSTRUMENT);
        let Some(index) = named.iter().position(|name| fits(name)) else {
            return Err(match self.wanted.as_str() {
                "" => "no MIDI instrument is plugged in".into(),
                wanted => format!("no MIDI port is called \"{wanted}\"; there are: {}", named.join(", ")),
            });
        };
        let port = midi.ports().into_iter().nth(index).ok_or("the port has just gone")?;
        let (slot, controller) = (slot.clone(), self.controller);
        let on_message = move |_: u64, message: &[u8], (): &mut ()| {
            if let Some(strength) = strength(message, controller) {
                slot.update(|reading| reading.blow(strength));
            }
        };
        let line = midi.connect(&port, "breath", on_message, ()).map_err(|error| error.to_string())?;
        let name = named[index].clone();
        (self.line, self.looked) = (Some((name.clone(), line)), Instant::now());
        Ok(format!("{name}, control {controller}"))
    }

    fn listen(&mut self, _: &Slot, wait: Duration) -> Result<(), String> {
        std::thread::sleep(wait);
        if self.looked.elapsed() < ROLL_CALL {
            return Ok(());
        }
        self.looked = Instant::now();
        let there = names(&client()?);
        match &self.line {
            Some((name, _)) if there.contains(name) => Ok(()),
            _ => Err("the MIDI port is gone".into()),
        }
    }
}

fn client() -> Result<MidiInput, String> {
    // Without its device ALSA's library would complain on stderr at each look.
    if cfg!(target_os = "linux") && !Path::new(SEQUENCER).exists() {
        return Err(format!("no MIDI here: there is no {SEQUENCER} (kernel module snd-seq)"));
    }
    MidiInput::new(CLIENT).map_err(|error| format!("no MIDI here: {error}"))
}

/// Names of all ports, in their order; one that goes in between has an empty name.
fn names(midi: &MidiInput) -> Vec<String> {
    midi.ports().iter().map(|port| midi.port_name(port).unwrap_or_default()).collect()
}

/// Breath strength of a message, 0 … 1.
fn strength(message: &[u8], controller: u8) -> Option<f64> {
    match *message {
        [status, number, value] if status & 0xF0 == 0xB0 && number == controller && value < 128 => {
            Some(f64::from(value) / 127.0)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_breath_controller_blows() {
        assert_eq!(strength(&[0xB0, 2, 127], 2), Some(1.0));
        assert_eq!(strength(&[0xBF, 2, 0], 2), Some(0.0), "any channel");
        assert_eq!(strength(&[0xB3, 11, 64], 11), Some(64.0 / 127.0));
        for other in [&[0xB0, 7, 100][..], &[0x90, 2, 100], &[0xB0, 2], &[0xB0, 2, 200], &[0xF8], &[]] {
            assert_eq!(strength(other, 2), None, "{other:?}");
        }
    }
}
