//! Position-based motion of whole exhibits, and the change from one kind of motion to the other.

mod chains;
mod collection;
mod marionette;
mod modes;
