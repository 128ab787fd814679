//! Where partials come from: every source of modes gives a plain list of them.
//!
//! A mode has a frequency f (Hz), a decay c (1/s), a level and a shape φ. An impulse J at x sets it ringing as
//! level · J φ(x) · e^(−ct) sin 2πft, full scale at 1 m. Shapes of plates and beams are mass-normalised (∫ φ² dm = 1,
//! so 1/√kg); shapes of sources that know no mass are of mean square 1 at most, and their level is per N s.
//!
//! **Decay**: c = π η f of the material and its mounting (T60 = 6.908/c = 2.2/(η f)), what the support takes, and what
//! the sound itself takes away.

mod bars;
mod beam;
mod eigen;
mod limits;
mod membrane;
mod mode;
mod plate;
mod random;
mod shape;
mod string;

pub use beam::{BeamMode, Section, beam_modes};
pub use limits::{HIGHEST, T60_DECAYS};
pub use membrane::zeros as membrane_zeros;
pub use mode::Mode;
pub(super) use mode::ModeError;
pub use plate::{PlateMode, free_plate_modes};
pub(super) use shape::Place;
pub use shape::Shape;

use super::InstrumentSpec;
use super::excitation::Radiator;
use super::shared::Shared;
use super::timbre::{Modal, Source, Table};
use mode::Matter;
use plate::outline_exponent;

/// Ratio of length to width from which a body that is no sheet is a bar or a tube: beam theory is good to some per cent
/// from there on.
const SLENDER: f64 = 4.0;
/// Ratio of thickness to width below which a body is a sheet, whose modes are those of a plate. A judgement by shape:
/// between a lid and a block.
const SHEET: f64 = 0.3;

/// The partials of a modal node on a body, in ascending order, and the exponent of the outline that plates have;
/// `shared` keeps what was found for earlier instruments.
pub(super) fn modes(modal: &Modal, spec: &InstrumentSpec, shared: &mut Shared) -> Result<(Vec<Mode>, f64), ModeError> {
    let mut modes = match &modal.source {
        Source::Plate(plate) => plate_partials(&Matter::new(spec, &plate.material), modal, shared)?,
        Source::Mesh(mesh) => mesh_partials(&Matter::new(spec, &mesh.material), modal, shared)?,
        Source::Table(table) => sized(tabled(table), table.radius, modal, spec),
        Source::Tube(tube) => bars::tube(tube, &Matter::new(spec, &tube.material), modal)?,
        Source::Bar(bar) => bars::bar(bar, &Matter::new(spec, &bar.material), modal)?,
        Source::String(given) => string::string(given, &Matter::new(spec, &given.material), modal)?,
        Source::MassSpring(spring) => string::mass_spring(spring, &spec.body, modal.support_loss)?,
        Source::Membrane(head) => sized(membrane::partials(head, modal.partials), Some(head.radius), modal, spec),
        Source::Random(drawn) => sized(random::partials(drawn, modal), drawn.radius, modal, spec),
    };
    modes.truncate(modal.partials);
    Ok((modes, outline_exponent(&spec.body)))
}

fn plate_partials(matter: &Matter, modal: &Modal, shared: &mut Shared) -> Result<Vec<Mode>, ModeError> {
    let body = &matter.body;
    let modes = shared.plate_modes(body, &matter.material);
    if modes.is_empty() {
        let problem = format!(
            "no plate of half extents {:?} m, thickness {} m, area {} m², mass {} kg can ring; all must be above 0",
            body.half_extents, body.thickness, body.area, body.mass
        );
        return Err(("from", problem));
    }
    let radiator = Radiator::new(body, &matter.material);
    let partial = |mode: PlateMode| Mode {
        frequency: mode.frequency,
        decay: matter.loss(mode.frequency) + modal.support_loss + radiator.loss(mode.frequency),
        amplitude: radiator.amplitude(mode.frequency),
        shape: Shape::Plate(mode),
    };
    Ok(modes.into_iter().map(partial).collect())
}

/// Sheets are plates. What is long is a tube where its mass leaves a hole or fills a circle, and a bar where it fills
/// more than a circle would.
fn mesh_partials(matter: &Matter, modal: &Modal, shared: &mut Shared) -> Result<Vec<Mode>, ModeError> {
    let [long, wide] = matter.body.half_extents;
    let sheet = matter.body.thickness < SHEET * 2.0 * wide;
    if sheet || long < SLENDER * wide {
        return plate_partials(matter, modal, shared);
    }
    /// Share of the bounding rectangle's area that a circle fills, π/4, and a little.
    const ROUND: f64 = 0.8;
    let filled = matter.volume / (2.0 * long) / (4.0 * wide * wide);
    if filled <= ROUND && matter.body.thickness > 0.9 * 2.0 * wide {
        bars::tube(&bars::BODYS_TUBE, matter, modal)
    } else {
        bars::bar(&bars::BODYS_BAR, matter, modal)
    }
}

/// Partials of a body of another size. Elasticity has no length of its own, so of bodies of one form and material all frequencies go
/// with 1/size. So do decays, as each loses the same share of its energy a period. The support takes its part besides.
fn sized(mut modes: Vec<Mode>, radius: Option<f64>, modal: &Modal, spec: &InstrumentSpec) -> Vec<Mode> {
    let [long, wide] = spec.body.half_extents;
    let size = (long * wide).sqrt();
    let ratio = radius.filter(|_| size > 0.0).map_or(1.0, |radius| radius / size);
    for mode in &mut modes {
        mode.frequency *= ratio;
        mode.decay = ratio * mode.decay + modal.support_loss;
    }
    modes.retain(|mode| mode.frequency <= HIGHEST);
    modes
}

fn tabled(table: &Table) -> Vec<Mode> {
    let partial = |p: &super::timbre::TablePartial| Mode {
        frequency: table.fundamental * p.ratio,
        decay: T60_DECAYS / p.t60,
        amplitude: p.gain,
        shape: Shape::Even,
    };
    table.table.iter().map(partial).collect()
}
