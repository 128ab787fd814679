//! Constraint rows against their own finite differences, and the solvers against an elimination of their own.

mod kkt;
mod lanes;
mod loops;
mod mechanisms;
mod partial_rows;
mod rows;
mod solvers;
