//! The training tool: what it scores, and what it says to wrong input.

mod scores;
mod small_set;
mod tool;
