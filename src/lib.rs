//! The program's commands. Everything else is a crate of its own under `src/`.

pub mod commands;
