//! The live kiosk: window, visitor, attract mode, staff.
//!
//! There are two threads. The simulation thread ([`live`]) owns everything that moves and keeps the time. The window thread
//! ([`window`]) draws frames between the last steps, and sends the visitor's input. A single step is in [`step`], which knows
//! no clock and no device, so that tests and recordings run exactly the code that visitors see.
//!
//! The modules are in order: each uses only those before it (`tests/suite/kiosk/modules.rs`).

// Visitors.
pub mod attract;

pub mod visitor;

pub mod venue;

pub mod pages;

// Simulation.
pub mod step;

pub mod live;

// Operation.
pub mod fleet;

pub mod staff;

// Window.
pub mod window;

// The panel library: its types are in the signatures of pages and panels.
pub use {egui, egui_wgpu};
