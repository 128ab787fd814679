//! The staff panel: whether the kiosk is well, and whatever a curator wants to see, hear, measure or change.
//!
//! A key chord opens it (`staff.chord`), a PIN what is on it (`staff.pin`, [`gate`]). Where the site has set no PIN, the
//! panel shows all and changes nothing; on somebody's desk, where Esc ends the kiosk anyway, it does both. It closes
//! when nobody has touched it for a while, and asks for the PIN anew.
//!
//! Pages report what staff want as a [`Wish`]; they change files of the site through [`edit`], and never the running
//! simulation.

pub mod edit;
pub mod gate;
pub mod log;
mod pages;
mod panel;
mod sight;
mod wish;

pub use pages::Page;
pub use panel::Staff;
pub use sight::{Sight, Vitals};
pub use wish::Wish;
