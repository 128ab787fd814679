//! What the kiosk hears, plays and is played by.
//!
//! Each kind of device runs on a thread of its own, is opened again after it was lost, and says how it is; nothing here ends
//! the program because a cable was pulled. Between these threads and the caller are wait-free rings.
//!
//! It never writes a microphone sample to a file, a log or the network, and overwrites each one after its use. It decides
//! nothing: the detector and the simulation do. The audio callback never allocates, locks, logs or makes a system call.
//!
//! | module or type | holds |
//! |---|---|
//! | [`audio`] | [`audio::AudioIo`]: microphone, loudspeaker, and what was played when |
//! | [`controllers`] | gamepads, MIDI breath controllers, OSC messages, sensors on a serial line |
//! | [`protection`] | no core dumps, and pages that are locked in memory |
//!
//! ```no_run
//! use soffio_devices::audio::{AudioIo, AudioSettings, MicrophoneSamples};
//! use soffio_sound::Synth;
//!
//! // Opens the default devices on a thread of its own; a synthesizer is made for the rate that the loudspeaker has.
//! let mut io = AudioIo::start(&AudioSettings::default(), Synth::silent);
//! let mut samples = MicrophoneSamples::default();
//! loop {
//!     match io.read_microphone(&mut samples) {
//!         Some(rate) => println!("{} samples at {rate} Hz", samples.samples.len()),
//!         None => println!("no microphone yet: {:?}", io.status()),
//!     }
//!     samples.clear();
//!     std::thread::sleep(std::time::Duration::from_millis(10));
//! }
//! ```

pub mod audio;
pub mod controllers;
pub mod protection;
