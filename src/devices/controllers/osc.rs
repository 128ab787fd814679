//! Open Sound Control over UDP: `/breath f` (0 … 1) blows, `/aim x y` aims (picture coordinates), `/hold 0|1` holds.
//!
//! A sender of packets to the port can blow and nothing else: other addresses are not answered, and logged only once. The default listens to this machine alone.

use std::io::ErrorKind;
use std::net::UdpSocket;
use std::time::Duration;

use rosc::{OscMessage, OscPacket, OscType};

use super::driver::{Driver, Reading, Slot};

/// Longest packet, bytes: more than any known message.
const PACKET: usize = 1536;
/// Greatest nesting of bundles.
const DEPTH: u32 = 8;

/// A UDP port.
pub struct Osc {
    address: String,
    socket: Option<UdpSocket>,
    packet: [u8; PACKET],
    puzzled: bool,
}

impl Osc {
    /// Listens at `address`, such as `127.0.0.1:9000`.
    pub fn new(address: &str) -> Self {
        Self { address: address.to_owned(), socket: None, packet: [0; PACKET], puzzled: false }
    }
}

impl Driver for Osc {
    fn open(&mut self, _: &Slot) -> Result<String, String> {
        // The old socket goes first: the address is its own.
        self.socket = None;
        let socket = UdpSocket::bind(&self.address).map_err(|error| format!("{}: {error}", self.address))?;
        let at = socket.local_addr().map_err(|error| error.to_string())?;
        self.socket = Some(socket);
        Ok(format!("udp {at}"))
    }

    fn listen(&mut self, slot: &Slot, wait: Duration) -> Result<(), String> {
        let socket = self.socket.as_ref().ok_or("not opened")?;
        socket.set_read_timeout(Some(wait)).map_err(|error| error.to_string())?;
        let length = match socket.recv(&mut self.packet) {
            Ok(length) => length,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Ok(()),
            Err(error) => return Err(error.to_string()),
        };
        let mut understood = false;
        slot.update(|reading| understood = enter_packet(reading, &self.packet[..length]));
        if !understood && !self.puzzled {
            self.puzzled = true;
            tracing::warn!("osc: a packet says none of /breath, /aim, /hold with their numbers; it is left out");
        }
        Ok(())
    }
}

/// Enters the messages of a packet's bytes. Returns whether all were understood.
pub fn enter_packet(reading: &mut Reading, bytes: &[u8]) -> bool {
    rosc::decoder::decode_udp(bytes).is_ok_and(|(_, packet)| enter(reading, &packet, DEPTH))
}

/// Enters all messages of a packet. Returns whether all were understood.
fn enter(reading: &mut Reading, packet: &OscPacket, depth: u32) -> bool {
    match packet {
        OscPacket::Message(message) => say(reading, message),
        OscPacket::Bundle(bundle) if depth > 0 => {
            // All of them, whatever the first says.
            bundle.content.iter().map(|packet| enter(reading, packet, depth - 1)).filter(|good| !good).count() == 0
        }
        OscPacket::Bundle(_) => false,
    }
}

fn say(reading: &mut Reading, message: &OscMessage) -> bool {
    let numbers: Vec<f64> = message.args.iter().map_while(number).take(2).collect();
    match (message.addr.as_str(), numbers.as_slice()) {
        ("/breath", [strength, ..]) => reading.blow(*strength),
        ("/hold", [down, ..]) => reading.press(*down > 0.5),
        ("/aim", [x, y]) => reading.point([*x, *y]),
        _ => return false,
    }
    true
}

fn number(argument: &OscType) -> Option<f64> {
    match *argument {
        OscType::Float(x) => Some(f64::from(x)),
        OscType::Double(x) => Some(x),
        OscType::Int(x) => Some(f64::from(x)),
        OscType::Long(x) => Some(x as f64),
        OscType::Bool(x) => Some(f64::from(u8::from(x))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sends real packets through a real socket.
    #[test]
    fn packets_blow_aim_and_hold_and_rubbish_does_nothing() {
        let slot = Slot::default();
        let mut osc = Osc::new("127.0.0.1:0");
        let name = osc.open(&slot).expect("a free port");
        let at = name.strip_prefix("udp ").expect("an address");
        let sender = UdpSocket::bind("127.0.0.1:0").expect("a sender");
        let mut send = |packet: &[u8]| {
            sender.send_to(packet, at).expect("sent");
            osc.listen(&slot, Duration::from_secs(2)).expect("listens");
            slot.read()
        };
        let message = |addr: &str, args: Vec<OscType>| OscMessage { addr: addr.into(), args };
        let encode = |packet| rosc::encoder::encode(&packet).expect("a packet");
        let breath = message("/breath", vec![OscType::Float(0.75)]);
        assert_eq!(send(&encode(OscPacket::Message(breath.clone()))).strength, 0.75);
        let aim = message("/aim", vec![OscType::Double(0.25), OscType::Int(2)]);
        let hold = message("/hold", vec![OscType::Bool(true)]);
        let bundle = rosc::OscBundle {
            timetag: (0, 1).into(),
            content: vec![OscPacket::Message(aim), OscPacket::Message(hold)],
        };
        let reading = send(&encode(OscPacket::Bundle(bundle)));
        assert_eq!((reading.hold, reading.aim), (true, Some(([0.25, 1.0], 1))));
        for rubbish in [&b"/breath"[..], &[0xFF; 64], &encode(OscPacket::Message(message("/reboot", vec![])))] {
            assert_eq!(send(rubbish), reading, "{rubbish:?}");
        }
        let mut nan = breath;
        nan.args = vec![OscType::Float(f32::NAN)];
        assert_eq!(send(&encode(OscPacket::Message(nan))).strength, 0.0);
    }
}
