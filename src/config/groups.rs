//! Groups on the page of exhibits: a heading in each language, and the exhibits under it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A group of exhibits.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExhibitGroup {
    /// Heading by language code.
    pub heading: BTreeMap<String, String>,
    /// Ids of its exhibits; `*` stands for all that no other group names.
    pub exhibits: Vec<String>,
}

impl ExhibitGroup {
    /// The groups of the shipped exhibits.
    pub fn shipped() -> Vec<Self> {
        let group = |heading: [&str; 7], exhibits: &[&str]| Self {
            heading: ["en", "de", "fr", "it", "es", "ko", "ja"]
                .into_iter()
                .zip(heading)
                .map(|(code, text)| (code.to_owned(), text.to_owned()))
                .collect(),
            exhibits: exhibits.iter().map(|id| (*id).to_owned()).collect(),
        };
        vec![
            group(
                ["Mobiles", "Mobiles", "Mobiles", "Mobile", "Móviles", "모빌", "モビール"],
                &["steel-fish", "twelve-moons", "noise-mobile", "snow", "lobster-tree", "plates", "hang-it"],
            ),
            group(
                ["Clocks", "Uhren", "Horloges", "Orologi", "Relojes", "시계", "時計"],
                &["terry-clock", "breath-clock", "pendulum"],
            ),
            group(
                ["Chimes", "Klangspiele", "Carillons", "Campane a vento", "Campanillas", "풍경", "風鈴"],
                &["wind-chimes", "wind-chimes-bamboo", "wind-chimes-glass", "wind-chimes-metals", "harp", "strikers"],
            ),
            group(
                [
                    "Cabinet of motion",
                    "Kabinett der Bewegung",
                    "Cabinet du mouvement",
                    "Gabinetto del moto",
                    "Gabinete del movimiento",
                    "움직임의 방",
                    "動きの部屋",
                ],
                &["*"],
            ),
        ]
    }
}
