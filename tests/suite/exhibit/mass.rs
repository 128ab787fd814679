//! Moments against the formulas of the textbook.

use soffio_geometry::mass::principal_axes;
use soffio_geometry::{Moments, TriangleMesh};
use soffio_math::{DMat3, DVec3, PI, cos, rotation, sin};

/// Sums of some hundred products near 1 in double precision.
const ROUNDING: f64 = 1e-12;

fn close(a: DMat3, b: DMat3) -> bool {
    (a - b).to_cols_array().iter().all(|x| x.abs() < ROUNDING)
}

fn cuboid(size: DVec3) -> TriangleMesh {
    let (positions, indices) = super::glb::cuboid([1.0; 3]);
    TriangleMesh {
        positions: positions.iter().map(|p| DVec3::from(p.map(f64::from)) * size).collect(),
        triangles: indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    }
}

#[test]
fn a_box_far_from_the_origin_and_turned_has_the_moments_of_the_formula() {
    let size = DVec3::new(0.3, 0.5, 0.7);
    let turn = rotation(DVec3::new(0.4, -1.1, 0.7));
    let offset = DVec3::new(3.0, -2.0, 1.0);
    let mut mesh = cuboid(size);
    mesh.positions.iter_mut().for_each(|p| *p = turn * *p + offset);
    let moments = mesh.solid_moments(1000.0);
    let mass = 1000.0 * size.element_product();
    let s = size * size;
    let about_axes = DMat3::from_diagonal(DVec3::new(s.y + s.z, s.z + s.x, s.x + s.y) * (mass / 12.0));
    let frame = DMat3::from_quat(turn);
    assert!(mesh.is_closed());
    assert!((moments.mass - mass).abs() < mass * ROUNDING);
    assert!(moments.center().distance(offset) < ROUNDING);
    assert!(close(moments.inertia() / mass, frame * about_axes * frame.transpose() / mass));
}

#[test]
fn a_sheet_weighs_and_turns_as_the_thin_box_it_is() {
    let (size, thickness) = (DVec3::new(0.4, 0.2, 0.01), 0.01);
    let solid = cuboid(size).solid_moments(7850.0);
    let (positions, indices) = super::glb::sheet(1.0, 1.0);
    let sheet = TriangleMesh {
        positions: positions.iter().map(|p| DVec3::from(p.map(f64::from)) * size).collect(),
        triangles: indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    };
    assert!(!sheet.is_closed());
    let moments = sheet.sheet_moments(thickness, 7850.0);
    assert!((moments.mass - solid.mass).abs() < ROUNDING);
    assert!(close(moments.inertia(), solid.inertia()));
}

#[test]
fn a_wire_turns_as_the_cylinder_it_is() {
    let (length, radius, density) = (0.6, 0.02, 7850.0);
    let points: Vec<DVec3> = (0..=6).map(|i| DVec3::new(f64::from(i) * 0.1, 1.0, 0.0)).collect();
    let mut wire = Moments::default();
    wire.add_wire(&points, radius, density);
    let mass = PI * radius * radius * length * density;
    let across = mass * (length * length / 12.0 + radius * radius / 4.0);
    assert!((wire.mass - mass).abs() < mass * ROUNDING);
    assert!(wire.center().distance(DVec3::new(0.3, 1.0, 0.0)) < ROUNDING);
    assert!(close(wire.inertia(), DMat3::from_diagonal(DVec3::new(mass * radius * radius / 2.0, across, across))));
}

#[test]
fn no_matter_has_no_mass() {
    let nothing = Moments::default();
    assert_eq!((nothing.mass, nothing.inertia()), (0.0, DMat3::ZERO));
}

#[test]
fn split_corners_leave_a_surface_closed_and_a_missing_triangle_opens_it() {
    let whole = cuboid(DVec3::ONE);
    let mut split = TriangleMesh::default();
    for corners in whole.corners() {
        split.append(&TriangleMesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2]] });
    }
    assert_eq!(split.open_edges(), 0);
    split.triangles.pop();
    assert_eq!(split.open_edges(), 3);
}

#[test]
fn principal_axes_diagonalise_a_turned_tensor() {
    let turn = DMat3::from_quat(rotation(DVec3::new(1.0, 2.0, -0.5)));
    let tensor = turn * DMat3::from_diagonal(DVec3::new(3.0, 1.0, 2.0)) * turn.transpose();
    let (values, axes) = principal_axes(tensor);
    assert!((values - DVec3::new(1.0, 2.0, 3.0)).abs().max_element() < ROUNDING);
    assert!(close(axes * DMat3::from_diagonal(values) * axes.transpose(), tensor));
    assert!((axes.determinant() - 1.0).abs() < ROUNDING);
}

#[test]
fn extents_find_the_box_around_a_turned_disc() {
    let turn = rotation(DVec3::new(0.3, 0.9, -0.2));
    let mut mesh = TriangleMesh::default();
    let n = 48;
    for i in 0..n {
        let at = |k: u32| 2.0 * PI * f64::from(k) / f64::from(n);
        let (a, b) = (at(i), at((i + 1) % n));
        let rim = |t: f64, z: f64| turn * DVec3::new(0.2 * cos(t), 0.2 * sin(t), z);
        let (h, axis) = (0.001, turn * DVec3::Z);
        for (z, flip) in [(h, false), (-h, true)] {
            let (p, q) = if flip { (rim(b, z), rim(a, z)) } else { (rim(a, z), rim(b, z)) };
            mesh.append(&TriangleMesh { positions: vec![axis * z, p, q], triangles: vec![[0, 1, 2]] });
        }
        let quad = vec![rim(a, -h), rim(b, -h), rim(b, h), rim(a, h)];
        mesh.append(&TriangleMesh { positions: quad, triangles: vec![[0, 1, 2], [0, 2, 3]] });
    }
    assert!(mesh.is_closed());
    let extents = mesh.extents().expect("a mesh with area");
    // The rim's corners lie on the circle; across the flats it is short by 1 − cos(π/48), 0.2 %.
    assert!((extents.half - DVec3::new(0.2, 0.2, 0.001)).abs().max_element() < 0.2 * 0.0022, "{extents:?}");
    assert!(extents.axes.z_axis.dot(turn * DVec3::Z).abs() > 1.0 - ROUNDING);
}
