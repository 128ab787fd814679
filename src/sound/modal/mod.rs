//! What rings: banks of decaying partials that belong to bodies, not to hits. Ringing is linear, so a hit adds to what
//! rings already, wherever it falls, and nothing is ever cut off to make room for it.
//!
//! | file | what |
//! |---|---|
//! | `kernel` | the inner loops, for every set of vector instructions |
//! | `pulse` | a hit's force over time and the ringing it leaves |
//! | `ceiling` | for benchmarks: what the processor allows |
//! | `bank` | the partials of one body: hits, a force at audio rate, touch, what has died away |

mod bank;
mod ceiling;
mod kernel;
mod pulse;

pub use bank::{Bank, Partial};
pub use ceiling::multiply_adds;
pub use kernel::{BLOCK, FRAME, GROUP, fuses};
