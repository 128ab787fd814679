//! What a run is made of, and how it ended.

use std::path::PathBuf;
use std::sync::Arc;

use crate::venue::site::Site;
use soffio_exhibit::Exhibit;
use soffio_offline::feed::WavFeed;
use soffio_simulation::MotionMode;

/// What a run is made of.
pub struct Options {
    /// What is shown first.
    pub exhibit: Arc<Exhibit>,
    /// What the site says.
    pub site: Site,
    /// Is the house closed when the run begins?
    pub closed: bool,
    /// A recording in the microphone's place.
    pub recording: Option<WavFeed>,
    /// End after so many steps.
    pub steps: Option<u64>,
    /// Where the trace goes.
    pub trace: Option<PathBuf>,
    /// Where the record goes.
    pub record: Option<PathBuf>,
    /// What moves the exhibits; `None` is their own choice.
    pub mode: Option<MotionMode>,
}

/// How a run ended.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Report {
    /// Steps done.
    pub steps: u64,
    /// Steps of time that were dropped because the machine was too slow.
    pub dropped: u64,
    /// Impacts of the last exhibit.
    pub impacts: u64,
    /// Gaps of microphone and loudspeaker.
    pub xruns: u64,
    /// A-weighted mean level of all that was played, dB of a full-scale sine; null for silence.
    pub level_dba: Option<f64>,
    /// Says whether two runs are the same run.
    #[serde(serialize_with = "hex")]
    pub state_hash: u64,
}

/// A hash as text: JSON numbers lose bits beyond 2⁵³.
fn hex<S: serde::Serializer>(hash: &u64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&format!("{hash:016x}"))
}
