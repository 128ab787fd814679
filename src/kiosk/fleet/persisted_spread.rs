//! What the breath detector knows of the room, as it is persisted in `state.json`: numbers that it learns over minutes, and no sound.

use serde::{Deserialize, Serialize};

use soffio_detector::AmbientSpread;
use soffio_detector::noise_floor::Spreads;

/// A [`AmbientSpread`] in the state file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PersistedSpread {
    /// Spread of each band about its noise floor, dB.
    pub spread_db: Vec<f64>,
    /// The same of the incoherent power of two capsules.
    pub incoherent_spread_db: Vec<f64>,
    /// Times in which both were learnt, s.
    pub learnt_s: [f64; 2],
}

impl From<AmbientSpread> for PersistedSpread {
    fn from(ambient_spread: AmbientSpread) -> Self {
        Self {
            spread_db: ambient_spread.bands.db.to_vec(),
            incoherent_spread_db: ambient_spread.incoherent.db.to_vec(),
            learnt_s: [ambient_spread.bands.seconds, ambient_spread.incoherent.seconds],
        }
    }
}

impl PersistedSpread {
    /// The room; `None` where it has other bands than this program.
    pub fn ambient_spread(&self) -> Option<AmbientSpread> {
        Some(AmbientSpread {
            bands: Spreads { db: self.spread_db[..].try_into().ok()?, seconds: self.learnt_s[0] },
            incoherent: Spreads { db: self.incoherent_spread_db[..].try_into().ok()?, seconds: self.learnt_s[1] },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_detector::BlowDetector;

    #[test]
    fn a_room_comes_back_from_the_file_and_one_of_another_program_does_not() {
        let ambient_spread = BlowDetector::new(16_000).ambient_spread();
        let text = serde_json::to_string(&PersistedSpread::from(ambient_spread)).expect("a file");
        let persisted: PersistedSpread = serde_json::from_str(&text).expect("the same file");
        assert_eq!(persisted.ambient_spread(), Some(ambient_spread));
        assert_eq!(PersistedSpread { spread_db: vec![3.0; 4], ..persisted }.ambient_spread(), None);
    }
}
