//! Models made from stated dimensions: sheet metal, wire, wood, and where they balance; glTF and sidecars written down.
//!
//! The shipped exhibits (`exhibits/forge`) and those that a curator begins (`soffio new`) are made by the same code.
//! Invariant: no clock, no randomness without a stated seed, software transcendentals: the same dimensions give the same
//! bytes on any machine.

pub mod chimes;
pub mod glb;
pub mod hung;
pub mod mobile;
pub mod outline;
pub mod piece;
pub mod solid;
pub mod stock;
pub mod tree;

