//! The staff panel: status of the kiosk, and settings that a curator can view, try, measure or change.
//!
//! A key chord opens it (`staff.chord`), and a PIN unlocks it (`staff.pin`, [`gate`]). Without a configured PIN the panel shows
//! everything and changes nothing; in a window on a desk it can change settings too. It closes after a while without a touch,
//! and then needs the PIN again.
//!
//! Pages return the actions of staff as a [`StaffAction`]; they change files of the site through [`edit`], and never the running
//! simulation.

mod action;
pub mod edit;
pub mod gate;
pub mod log;
mod pages;
mod panel;
mod panel_input;

pub use action::StaffAction;
pub use pages::Page;
pub use panel::StaffPanel;
pub use panel_input::{PanelInput, WindowStats};
