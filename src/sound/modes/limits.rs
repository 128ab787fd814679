//! Audible range of modes.

/// T60 · c = ln 1000: a fall by 60 dB is e^(−6.908).
pub const T60_DECAYS: f64 = 6.907_755_278_982_137;
/// Highest audible frequency, Hz: of a young ear.
pub const HIGHEST: f64 = 20_000.0;
