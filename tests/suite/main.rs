//! The test suite: one binary, one module per room.

mod exhibit;
