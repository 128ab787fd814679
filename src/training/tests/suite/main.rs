//! The training tool: its scores, and its messages on wrong input.

mod scores;
mod small_set;
mod tool;
