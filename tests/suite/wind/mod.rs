//! Wind: forces against formulas, sight against a depth buffer, and what a visitor's breath does to a sculpture.

mod aim;
mod bodies;
mod calm;
mod depth_buffer;
mod forces;
mod sight;
mod visits;
