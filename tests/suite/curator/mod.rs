//! What a curator does: begins an exhibit, takes one over from a model, translates its labels, makes mistakes.

mod import;
mod labels;
mod mistakes;
mod new;
