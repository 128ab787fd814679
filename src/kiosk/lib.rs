//! The live kiosk: window, visitor, attract mode, staff.
//!
//! Two threads do the work. The simulation thread ([`live`]) owns everything that moves and keeps the time; the window
//! thread ([`window`]) draws the latest two moments and passes on what the visitor does. What happens in one step is in
//! [`step`], which knows no clock and no device, so that tests and recordings run exactly what visitors see.
//!
//! The rooms, in their order; each may use only those before it:

pub mod attract;
pub mod fleet;
pub mod live;
pub mod pages;
pub mod staff;
pub mod step;
pub mod venue;
pub mod visitor;
pub mod window;
