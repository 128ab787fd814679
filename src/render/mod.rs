//! Snapshot to pixels.
