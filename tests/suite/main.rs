//! The test suite: one binary, one module per room.

mod articulation;
mod dynamics;
mod blow;
mod forge;
mod sound;
