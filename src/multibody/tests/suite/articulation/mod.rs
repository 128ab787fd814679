//! Constraint rows against their own finite differences, and the solvers against an elimination of their own.

mod figures;
mod kkt;
mod lanes;
mod loops;
mod rows;
mod shares;
mod solvers;
