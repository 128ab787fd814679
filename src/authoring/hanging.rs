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

/// A stem that hangs by its eye from the origin straight down to `length` m; it ends in a small eye through a plate.
fn stem(name: &'static str, length: f64) -> BentWire {
    let (radius, eye, foot) = (0.3 * MM, 1.6 * MM, 1.2 * MM);
    let mut points = ring(DVec3::new(0.0, radius - eye, 0.0), eye, DVec3::NEG_Y, DVec3::X, EYE_STEPS);
    points.push(DVec3::new(0.0, 2.0 * foot - length, 0.0));
    points.extend(ring(DVec3::new(0.0, foot - length, 0.0), foot, DVec3::Y, DVec3::Z, EYE_STEPS).split_off(1));
    BentWire { name, points, radius, density: STEEL }
}

/// A plate (solid, density, finish) on a stem: the hole of the plate is at the stem's foot, `length` m below the hook.
/// `names` are those of the piece, its hook and its stem.
pub fn hanging_plate(names: [&'static str; 3], plate: (Solid, f64, usize), length: f64) -> Piece {
    let [name, hook, stem_name] = names;
    let (solid, density, finish) = plate;
    Piece {
        name,
        parts: vec![Part { name, solid: solid.translated(-length * DVec3::Y), place: Pose::IDENTITY, density, finish }],
        wires: vec![stem(stem_name, length)],
        markers: vec![(hook, DVec3::ZERO)],
    }
}

/// A disc (diameter and thickness, m) on a stem of `length` m; `stuff` is its density and finish.
pub fn disc(names: [&'static str; 3], (diameter, thickness): (f64, f64), length: f64, stuff: (f64, usize)) -> Piece {
    let radius = 0.5 * diameter;
    let hole = ellipse(DVec2::ZERO, DVec2::splat(HOLE_RADIUS * MM), 0.0, ROUND / 4);
    let outline = ellipse(DVec2::new(0.0, HOLE_INSET * MM - radius), DVec2::splat(radius), 0.5 * PI, ROUND);
    hanging_plate(names, (extrude(&outline, &[hole], thickness, BEVEL), stuff.0, stuff.1), length)
}

/// Scales outline and holes, in mm, so that the finished sheet (thickness in m) has this density and mass.
pub fn to_mass(outline: Polygon, holes: Vec<Polygon>, thickness: f64, (density, mass): (f64, f64)) -> Solid {
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
/// edge, straight above its centroid. The tuple is thickness, density, mass of plate and stem, and finish.
pub fn cut_plate(
    names: [&'static str; 3],
    drawn: (Polygon, Vec<Polygon>),
    inset: f64,
    length: f64,
    (thickness, density, mass, finish): (f64, f64, f64, usize),
) -> Piece {
    let (outline, cuts) = hang_by_hole(&drawn, inset);
    let stem_wire = stem(names[2], length);
    let stem_mass = wire_mass(&stem_wire.points, stem_wire.radius, stem_wire.density).mass;
    plumb(names, to_mass(outline, cuts, thickness, (density, mass - stem_mass)), length, (density, finish))
}

/// A plate in the size of its drawing, else as [`cut_plate`]; the tuple is thickness, density and finish.
pub fn drawn_plate(
    names: [&'static str; 3],
    drawn: &(Polygon, Vec<Polygon>),
    inset: f64,
    length: f64,
    (thickness, density, finish): (f64, f64, usize),
) -> Piece {
    let (outline, cuts) = hang_by_hole(drawn, inset);
    let size = |polygon: &Polygon| polygon.iter().map(|p| *p * MM).collect::<Polygon>();
    let solid = extrude(&size(&outline), &cuts.iter().map(size).collect::<Vec<_>>(), thickness, BEVEL);
    plumb(names, solid, length, (density, finish))
}

/// A plate on its stem with its centre of mass exactly below its hole: bevels move it by micrometres.
fn plumb(names: [&'static str; 3], solid: Solid, length: f64, (density, finish): (f64, usize)) -> Piece {
    let aside = solid.mass(density).center.x;
    hanging_plate(names, (solid.translated(DVec3::new(-aside, 0.0, 0.0)), density, finish), length)
}
