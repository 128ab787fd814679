//! Rigid bodies with exact joints.

pub mod articulation;
pub mod collision;
pub mod dynamics;
pub mod procedural;
