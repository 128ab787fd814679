//! Wind on whole exhibits: what a visitor's breath does to a sculpture.

mod aim;
mod idle_damping;
mod visits;
