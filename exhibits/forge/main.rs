//! The forge: makes every shipped model from stated dimensions.

fn main() {}
