//! Options and result of a run.

use std::path::PathBuf;
use std::sync::Arc;

use crate::venue::site::Site;
use soffio_detector::AmbientSpread;
use soffio_exhibit::Exhibit;
use soffio_offline::feed::WavFeed;
use soffio_simulation::MotionMode;

/// Options of a run.
pub struct Options {
    /// The first exhibit.
    pub exhibit: Arc<Exhibit>,
    /// Settings of the site.
    pub site: Site,
    /// Is the venue closed when the run begins?
    pub closed: bool,
    /// What an earlier run knew of the room.
    pub ambient_spread: Option<AmbientSpread>,
    /// Recording that replaces the microphone.
    pub recording: Option<WavFeed>,
    /// End after so many steps.
    pub steps: Option<u64>,
    /// Path of the trace.
    pub trace: Option<PathBuf>,
    /// Path of the record.
    pub record: Option<PathBuf>,
    /// Solver of the exhibits' motion; `None` is their own choice.
    pub mode: Option<MotionMode>,
}

/// Result of a run.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Report {
    /// Steps done.
    pub steps: u64,
    /// Steps dropped because the machine was too slow.
    pub dropped: u64,
    /// Impacts of the last exhibit.
    pub impacts: u64,
    /// Gaps of microphone and loudspeaker.
    pub xruns: u64,
    /// A-weighted mean level of all that was played, dB of a full-scale sine; null for silence.
    pub level_dba: Option<f64>,
    /// Hash of the final state: equal for identical runs.
    #[serde(serialize_with = "hex")]
    pub state_hash: u64,
}

/// A hash as text: JSON numbers lose bits beyond 2⁵³.
fn hex<S: serde::Serializer>(hash: &u64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&format!("{hash:016x}"))
}
