//! Plates, balls and breaths for the tests of wind.

use soffio_geometry::TriangleMesh;
use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::noise::Random;
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose, rotation, sincos};
use soffio_wind::breath::{Breath, SpreadLaw};
use soffio_wind::force::{BreathJet, TURBULENCE, WindField};
use soffio_wind::{Shelter, Surface, SurfaceShape};

pub const C_D: f64 = 1.17;
pub const C_F: f64 = 0.02;

/// A closed box with these edges.
pub fn cuboid(size: DVec3) -> TriangleMesh {
    let corner = |i: usize| {
        let sign = |bit: usize| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
        DVec3::new(sign(0), sign(1), sign(2)) * size
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    }
}

/// A closed square plate of side `a` and thickness `t`, its faces along z.
pub fn plate(a: f64, t: f64) -> TriangleMesh {
    cuboid(DVec3::new(a, a, t))
}

/// One face of a square of side `a`, its normal along z.
pub fn face(a: f64) -> TriangleMesh {
    TriangleMesh { positions: plate(a, 0.0).positions[4..].to_vec(), triangles: vec![[0, 1, 3], [0, 3, 2]] }
}

/// A ball of this many rings and twice as many sectors.
pub fn ball(radius: f64, rings: usize) -> TriangleMesh {
    let sectors = 2 * rings;
    let mut mesh = TriangleMesh::default();
    for i in 0..=rings {
        let (s, c) = sincos(PI * i as f64 / rings as f64);
        for j in 0..sectors {
            let (t, u) = sincos(2.0 * PI * j as f64 / sectors as f64);
            mesh.positions.push(radius * DVec3::new(s * u, s * t, c));
        }
    }
    let at = |i: usize, j: usize| (i * sectors + j % sectors) as u32;
    for i in 0..rings {
        for j in 0..sectors {
            mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

/// The outside of a solid as a surface of `count` patches.
pub fn solid(body: usize, mesh: TriangleMesh, count: usize) -> Surface {
    let shape = SurfaceShape::Mesh { mesh, per_area: 1.0, count: count..=count, sheet: false, seed: 3 };
    Surface { body, node: String::new(), shape, drag_normal: C_D, drag_tangential: C_F, gain: 1.0 }
}

/// A thin sheet as a surface of `count` patches.
pub fn sheet(body: usize, mesh: TriangleMesh, count: usize) -> Surface {
    let shape = SurfaceShape::Mesh { mesh, per_area: 1.0, count: count..=count, sheet: true, seed: 3 };
    Surface { shape, ..solid(body, TriangleMesh::default(), 1) }
}

/// A body at rest.
pub fn body(position: DVec3) -> RigidBody {
    turned(position, DQuat::IDENTITY)
}

/// A body at rest in this pose.
pub fn turned(position: DVec3, rotation: DQuat) -> RigidBody {
    let properties =
        MassProperties { mass: 0.01, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(1e-5)) };
    RigidBody::at_rest(properties, Pose { position, rotation })
}

/// Surfaces that shelter each other, in still air.
pub fn field(surfaces: &[Surface], bodies: usize) -> WindField {
    WindField::new(surfaces, &Shelter::of(surfaces), &[], bodies, 1)
}

/// A breath from half a metre up the z axis, down it.
pub fn breath(speed: f64) -> Breath {
    Breath { mouth: DVec3::new(0.0, 0.0, 0.5), direction: DVec3::NEG_Z, lip_diameter: 0.01, speed, law: SpreadLaw::Jet }
}

/// The same as a jet without delay.
pub fn jet(speed: f64) -> BreathJet<'static> {
    BreathJet { breath: breath(speed), jet_front: None, gain: 1.0, turbulence: TURBULENCE }
}

/// A random vector of length below `most`.
pub fn any_vector(random: &mut Random, most: f64) -> DVec3 {
    loop {
        let v = DVec3::new(random.signed(), random.signed(), random.signed());
        if v.length() < 1.0 {
            return v * most;
        }
    }
}

/// A random orientation.
pub fn any_turn(random: &mut Random) -> DQuat {
    rotation(any_vector(random, PI))
}
