//! The live kiosk: window, visitor, attract mode, staff.
//!
//! Two threads do the work. The simulation thread ([`live`]) owns everything that moves and keeps the time; the window
//! thread ([`window`]) draws the latest two moments and passes on what the visitor does. What happens in one step is in
//! [`step`], which knows no clock and no device, so that tests and recordings run exactly what visitors see.
//!
//! The rooms stand in their order: each uses only those before it (`tests/suite/kiosk/rooms.rs`).

// What visitors do and find.
pub mod attract;

pub mod visitor;

pub mod venue;

pub mod pages;

// What moves.
pub mod step;

pub mod live;

// Who looks after it.
pub mod fleet;

pub mod staff;

// What shows it.
pub mod window;

// The panel library: its types stand in what pages and panels take and give.
pub use {egui, egui_wgpu};
