//! Modal synthesis (Adrien, "The missing link: modal synthesis", 1991): banks of decaying partials. A bank belongs to
//! a body, not to an impact. The synthesis is linear, so an impact adds to the present vibration at any time, and no voice is ever stolen for it.
//!
//! | file | contents |
//! |---|---|
//! | `kernel` | the inner loops, for every set of vector instructions |
//! | `pulse` | force of an impact over time, and the free decay after it |
//! | `peak_throughput` | for benchmarks: peak rate of multiply-adds |
//! | `bank` | the partials of one body: impacts, a force at audio rate, damping, release |

mod bank;
mod kernel;
mod peak_throughput;
mod pulse;

pub use bank::{Bank, Partial};
pub use kernel::{BLOCK, FRAME, GROUP, fuses};
pub use peak_throughput::multiply_adds;
