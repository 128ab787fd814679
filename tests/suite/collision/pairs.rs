//! Which pairs can meet.
