//! Bounds between which samples are sound: what is quieter is not heard, what is louder is a fault.

/// Amplitude below which nothing is heard, of full scale: −100 dB, below the steps of 16 bits.
pub(crate) const INAUDIBLE: f64 = 1e-5;
/// Amplitude above which a sample is a fault and not loud, of full scale: 60 dB above it.
pub(crate) const FAULT_LEVEL: f32 = 1000.0;
