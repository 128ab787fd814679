//! Hanging plates: discs and other sheets with a hole, on stems.

use soffio_math::{DVec2, DVec3, PI, Pose};

use super::mobile::{EYE_STEPS, STEEL};
use super::outline::{Polygon, area_and_centroid, ellipse, ring};
use super::piece::{BentWire, Part, Piece};
use super::solid::{Solid, extrude, wire_mass};

/// A millimetre, m.
const MM: f64 = 1e-3;
/// Segments of a circle.
const ROUND: usize = 64;
/// Width of the bevel of a sheet's edges, m.
pub const BEVEL: f64 = 0.12 * MM;
/// Distance of a plate's hole from its rim, mm.
const HOLE_INSET: f64 = 2.4;
/// Radius of the hole by which a plate hangs, mm.
pub const HOLE_RADIUS: f64 = 1.0;

/// Sheet from which plates are cut.
#[derive(Clone, Copy, Debug)]
pub struct SheetStock {
    /// Thickness, m.
    pub thickness: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Index of the finish.
    pub finish: usize,
}

/// What a finished plate is to weigh.
#[derive(Clone, Copy, Debug)]
pub struct SheetMass {
    /// Thickness of the sheet, m.
    pub thickness: f64,
    /// Density of the sheet, kg/m³.
    pub density: f64,
    /// Mass of the plate, kg.
    pub mass: f64,
}

/// A plate with the matter and the look of its sheet.
#[derive(Clone, Debug)]
pub struct PlateSolid {
    /// Shape, the origin at the hole by which it hangs.
    pub solid: Solid,
    /// Density, kg/m³.
    pub density: f64,
    /// Index of the finish.
    pub finish: usize,
}

/// A stem that hangs by its eye from the origin straight down to `length` m; it ends in a small eye through a plate.
fn stem(name: &'static str, length: f64) -> BentWire {
    let (radius, eye, foot) = (0.3 * MM, 1.6 * MM, 1.2 * MM);
    let mut points = ring(DVec3::new(0.0, radius - eye, 0.0), eye, DVec3::NEG_Y, DVec3::X, EYE_STEPS);
    points.push(DVec3::new(0.0, 2.0 * foot - length, 0.0));
    points.extend(ring(DVec3::new(0.0, foot - length, 0.0), foot, DVec3::Y, DVec3::Z, EYE_STEPS).split_off(1));
    BentWire { name, points, radius, density: STEEL }
}

/// A plate on a stem: the hole of the plate is at the stem's foot, `length` m below the hook.
/// `names` are those of the piece, its hook and its stem.
pub fn hanging_plate(names: [&'static str; 3], plate: PlateSolid, length: f64) -> Piece {
    let [name, hook, stem_name] = names;
    let PlateSolid { solid, density, finish } = plate;
    Piece {
        name,
        parts: vec![Part { name, solid: solid.translated(-length * DVec3::Y), place: Pose::IDENTITY, density, finish }],
        wires: vec![stem(stem_name, length)],
        markers: vec![(hook, DVec3::ZERO)],
    }
}

/// A disc of `diameter` m on a stem of `length` m, cut from `stock`.
pub fn disc(names: [&'static str; 3], diameter: f64, length: f64, stock: SheetStock) -> Piece {
    let radius = 0.5 * diameter;
    let hole = ellipse(DVec2::ZERO, DVec2::splat(HOLE_RADIUS * MM), 0.0, ROUND / 4);
    let outline = ellipse(DVec2::new(0.0, HOLE_INSET * MM - radius), DVec2::splat(radius), 0.5 * PI, ROUND);
    let SheetStock { thickness, density, finish } = stock;
    hanging_plate(names, PlateSolid { solid: extrude(&outline, &[hole], thickness, BEVEL), density, finish }, length)
}

/// A plate of outline and holes, in mm, scaled so that it has the mass that `sheet` gives.
pub fn to_mass(outline: Polygon, holes: Vec<Polygon>, sheet: SheetMass) -> Solid {
    let SheetMass { thickness, density, mass } = sheet;
    let cut = |scale: f64| {
        let size = |polygon: &Polygon| polygon.iter().map(|p| *p * scale * MM).collect();
        extrude(&size(&outline), &holes.iter().map(size).collect::<Vec<_>>(), thickness, BEVEL)
    };
    // The mass is proportional to the square of the scale, except for the bevel, a thousandth: three iterations are
    // exact.
    let scale = (0..3).fold(1.0, |scale: f64, _| scale * (mass / cut(scale).mass(density).mass).sqrt());
    cut(scale)
}

/// Outline and holes in mm, moved so that the origin is a hole `inset` mm below the upper edge, straight above the
/// centroid. That hole is the last.
pub fn hang_by_hole((outline, holes): &(Polygon, Vec<Polygon>), inset: f64) -> (Polygon, Vec<Polygon>) {
    let (mut area, mut moment) = area_and_centroid(outline);
    moment *= area;
    for hole in holes {
        let (own, center) = area_and_centroid(hole);
        area -= own;
        moment -= own * center;
    }
    let middle = moment.x / area;
    // Where a vertical line through the centroid leaves the sheet.
    let edge = outline.iter().zip(outline.iter().cycle().skip(1)).filter_map(|(p, q)| {
        let t = (middle - p.x) / (q.x - p.x);
        (0.0..=1.0).contains(&t).then_some(p.y + t * (q.y - p.y))
    });
    let top = edge.fold(f64::NEG_INFINITY, f64::max);
    let from = DVec2::new(middle, top - inset);
    let moved = |polygon: &Polygon| polygon.iter().map(|p| *p - from).collect::<Polygon>();
    let mut cuts: Vec<Polygon> = holes.iter().map(moved).collect();
    cuts.push(ellipse(DVec2::ZERO, DVec2::splat(HOLE_RADIUS), 0.0, ROUND / 4));
    (moved(outline), cuts)
}

/// A plate of this mass on a stem, cut from an outline and holes in mm: it hangs by a hole `inset` mm below its upper
/// edge, straight above its centroid. `mass`, in kg, is that of plate and stem together.
pub fn cut_plate(
    names: [&'static str; 3],
    drawn: (Polygon, Vec<Polygon>),
    inset: f64,
    length: f64,
    stock: SheetStock,
    mass: f64,
) -> Piece {
    let (outline, cuts) = hang_by_hole(&drawn, inset);
    let stem_wire = stem(names[2], length);
    let stem_mass = wire_mass(&stem_wire.points, stem_wire.radius, stem_wire.density).mass;
    let SheetStock { thickness, density, finish } = stock;
    let solid = to_mass(outline, cuts, SheetMass { thickness, density, mass: mass - stem_mass });
    plumb(names, PlateSolid { solid, density, finish }, length)
}

/// A plate in the size of its drawing, else as [`cut_plate`].
pub fn drawn_plate(
    names: [&'static str; 3],
    drawn: &(Polygon, Vec<Polygon>),
    inset: f64,
    length: f64,
    stock: SheetStock,
) -> Piece {
    let (outline, cuts) = hang_by_hole(drawn, inset);
    let size = |polygon: &Polygon| polygon.iter().map(|p| *p * MM).collect::<Polygon>();
    let SheetStock { thickness, density, finish } = stock;
    let solid = extrude(&size(&outline), &cuts.iter().map(size).collect::<Vec<_>>(), thickness, BEVEL);
    plumb(names, PlateSolid { solid, density, finish }, length)
}

/// A plate on its stem with its centre of mass exactly below its hole: bevels move it by micrometres.
fn plumb(names: [&'static str; 3], mut plate: PlateSolid, length: f64) -> Piece {
    let offset = plate.solid.mass(plate.density).center.x;
    plate.solid = plate.solid.translated(DVec3::new(-offset, 0.0, 0.0));
    hanging_plate(names, plate, length)
}
