//! `soffio-record-breaths`: guides staff through ten breaths and two recordings of the room, to set the detector for their venue.
//!
//! It is a program of its own and not part of the kiosk, which has no code that writes microphone samples. It asks for consent first,
//! and says what it writes. It writes WAV files and a table of distance, angle and group of age, and no names.
//!
//! | module | holds |
//! |---|---|
//! | [`session`] | the questions and the recordings |
//! | [`microphone`] | the kiosk's microphone, as kiosk.toml names it |

pub mod microphone;
pub mod session;
