//! Microphone and loudspeaker: the only module that names the audio crate.
