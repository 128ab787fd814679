//! Tests of finishes: their maps, and how these are laid on pieces.

mod laying;
mod maps;
