//! The presets that the program ships.

/// Names and texts of the shipped timbres, in the order in which they are listed.
const SHIPPED: &[(&str, &str)] = &[
    ("plate", include_str!("../timbres/plate.toml")),
    ("bell", include_str!("../timbres/bell.toml")),
    ("wind-room", include_str!("../timbres/wind-room.toml")),
    ("chime-aluminium", include_str!("../timbres/chime-aluminium.toml")),
    ("chime-brass", include_str!("../timbres/chime-brass.toml")),
    ("chime-copper", include_str!("../timbres/chime-copper.toml")),
    ("chime-steel", include_str!("../timbres/chime-steel.toml")),
    ("chime-glass", include_str!("../timbres/chime-glass.toml")),
    ("chime-bamboo", include_str!("../timbres/chime-bamboo.toml")),
    ("drum", include_str!("../timbres/drum.toml")),
    ("metal", include_str!("../timbres/metal.toml")),
    ("wood", include_str!("../timbres/wood.toml")),
    ("ivory", include_str!("../timbres/ivory.toml")),
    ("string", include_str!("../timbres/string.toml")),
    ("scrape-wood", include_str!("../timbres/scrape-wood.toml")),
    ("scrape-metal", include_str!("../timbres/scrape-metal.toml")),
    ("scrape-stone", include_str!("../timbres/scrape-stone.toml")),
    ("ratchet", include_str!("../timbres/ratchet.toml")),
    ("rustle", include_str!("../timbres/rustle.toml")),
    ("creak", include_str!("../timbres/creak.toml")),
    ("clatter", include_str!("../timbres/clatter.toml")),
    ("wind-wire", include_str!("../timbres/wind-wire.toml")),
    ("clock-tick", include_str!("../timbres/clock-tick.toml")),
    ("clock-bell", include_str!("../timbres/clock-bell.toml")),
];

/// Names of the shipped timbres.
pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    SHIPPED.iter().map(|(name, _)| *name)
}

/// The text of a shipped preset.
pub fn source(name: &str) -> Option<&'static str> {
    SHIPPED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
