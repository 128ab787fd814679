//! The presets that the program ships.

/// In the order in which they are listed.
const SHIPPED: &[(&str, &str)] = &[
    ("plate", include_str!("../../../audio/timbres/plate.toml")),
    ("bell", include_str!("../../../audio/timbres/bell.toml")),
    ("wind-room", include_str!("../../../audio/timbres/wind-room.toml")),
    ("chime-aluminium", include_str!("../../../audio/timbres/chime-aluminium.toml")),
    ("chime-brass", include_str!("../../../audio/timbres/chime-brass.toml")),
    ("chime-copper", include_str!("../../../audio/timbres/chime-copper.toml")),
    ("chime-steel", include_str!("../../../audio/timbres/chime-steel.toml")),
    ("chime-glass", include_str!("../../../audio/timbres/chime-glass.toml")),
    ("chime-bamboo", include_str!("../../../audio/timbres/chime-bamboo.toml")),
    ("drum", include_str!("../../../audio/timbres/drum.toml")),
    ("metal", include_str!("../../../audio/timbres/metal.toml")),
    ("wood", include_str!("../../../audio/timbres/wood.toml")),
    ("ivory", include_str!("../../../audio/timbres/ivory.toml")),
    ("string", include_str!("../../../audio/timbres/string.toml")),
    ("scrape-wood", include_str!("../../../audio/timbres/scrape-wood.toml")),
    ("scrape-metal", include_str!("../../../audio/timbres/scrape-metal.toml")),
    ("scrape-stone", include_str!("../../../audio/timbres/scrape-stone.toml")),
    ("wind-wire", include_str!("../../../audio/timbres/wind-wire.toml")),
    ("clock-tick", include_str!("../../../audio/timbres/clock-tick.toml")),
    ("clock-bell", include_str!("../../../audio/timbres/clock-bell.toml")),
];

/// Names of the shipped timbres.
pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    SHIPPED.iter().map(|(name, _)| *name)
}

/// The text of a shipped preset.
pub fn source(name: &str) -> Option<&'static str> {
    SHIPPED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
