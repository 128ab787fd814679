//! What the breath detector knows of the room, as it is kept in `state.json`: numbers that it learns over minutes, and no sound.

use serde::{Deserialize, Serialize};

use soffio_detector::Room;
use soffio_detector::noise_floor::Spreads;

/// A [`Room`] in the state file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptRoom {
    /// Spread of each band about its noise floor, dB.
    pub spread_db: Vec<f64>,
    /// The same of the incoherent power of two capsules.
    pub incoherent_spread_db: Vec<f64>,
    /// Times in which both were learnt, s.
    pub learnt_s: [f64; 2],
}

impl From<Room> for KeptRoom {
    fn from(room: Room) -> Self {
        Self {
            spread_db: room.bands.db.to_vec(),
            incoherent_spread_db: room.incoherent.db.to_vec(),
            learnt_s: [room.bands.seconds, room.incoherent.seconds],
        }
    }
}

impl KeptRoom {
    /// The room; `None` where it has other bands than this program.
    pub fn room(&self) -> Option<Room> {
        Some(Room {
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
        let room = BlowDetector::new(16_000).room();
        let text = serde_json::to_string(&KeptRoom::from(room)).expect("a file");
        let kept: KeptRoom = serde_json::from_str(&text).expect("the same file");
        assert_eq!(kept.room(), Some(room));
        assert_eq!(KeptRoom { spread_db: vec![3.0; 4], ..kept }.room(), None);
    }
}
