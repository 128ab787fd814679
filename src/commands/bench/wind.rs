//! Cost of the wind of one step on a crowd of bodies in one breath. Every patch tests whether the lips are visible from it, and
//! the hierarchies are refitted as everything moves. The same rays are also tested against every triangle.

use std::hint::black_box;

use cpu_time::ThreadTime;
use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use soffio_geometry::TriangleMesh;
use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::noise::Random;
use soffio_math::{DMat3, DVec3, PI, Pose, rotation, sincos};
use soffio_wind::breath::{Breath, SpreadLaw};
use soffio_wind::force::{BreathJet, TURBULENCE, WindField};
use soffio_wind::{Shelter, Surface, SurfaceShape};

/// Parts of the crowd, patches on each, and rings of a ball: 10,000 patches and 5,000 triangles.
const PARTS: usize = 50;
const PATCHES: usize = 200;
const RINGS: usize = 5;
/// Steps of a round; the best round counts, as other load on the machine can only add.
const STEPS: usize = 24;
const ROUNDS: usize = 5;
const SEED: u64 = 1;

/// Costs of one step, thread CPU time.
#[derive(Serialize)]
struct Row {
    parts: usize,
    patches: usize,
    triangles: usize,
    /// Patches in the breath that see the lips, mean over the steps.
    seen: f64,
    /// ms of a whole step: refit, sight, forces.
    ms_per_step: f64,
    /// ms of the refit and the rays alone.
    sight_ms: f64,
    /// ms of the same rays against every triangle.
    each_triangle_ms: f64,
    /// Each triangle over the whole step.
    ratio: f64,
}

/// Measures the crowd.
pub fn run(json: bool) -> Outcome {
    let row = measure();
    if json {
        println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
    } else {
        println!(
            "{} patches, {} triangles, {} parts; {:.0} see the lips",
            row.patches, row.triangles, row.parts, row.seen
        );
        println!("a step   {:>9.3} ms, of it sight {:.3} ms", row.ms_per_step, row.sight_ms);
        println!("each     {:>9.3} ms, every patch against every triangle", row.each_triangle_ms);
        println!("ratio    {:>9.1}", row.ratio);
    }
    Ok(())
}

fn measure() -> Row {
    let mut random = Random::new(SEED);
    let surfaces: Vec<Surface> = (0..PARTS).map(surface).collect();
    let steps: Vec<Vec<RigidBody>> = crowd(&mut random);
    let breath =
        Breath { mouth: DVec3::Z * 0.5, direction: DVec3::NEG_Z, lip_diameter: 0.01, speed: 17.0, law: SpreadLaw::Jet };
    let mut field = WindField::new(&surfaces, &Shelter::of(&surfaces), &[], PARTS, SEED);
    let blown = BreathJet { breath, jet_front: None, gain: 1.0, turbulence: TURBULENCE };
    let mut out = vec![[0.0; 6]; PARTS];
    let whole = best(&steps, |step, bodies| {
        out.fill([0.0; 6]);
        black_box(field.apply_forces(bodies, step as f64 / 240.0, Some(&blown), &mut out));
    });
    let mut seen = 0;
    let sight = best(&steps, |_, bodies| {
        seen = black_box(field.sample_patches(bodies, &breath)).iter().filter(|sample| sample.visible).count();
    });
    let each = best(&steps[..1], |_, bodies| {
        for sample in field.sample_patches(bodies, &breath) {
            let way = breath.origin(sample.point) - sample.point;
            // A hand's breadth of the way is left out as the rays of a step leave out their own face.
            let start = sample.point + way * 1e-3;
            black_box(field.occluders().block_by_each(start, way.normalize(), way.length() * 0.999));
        }
    });
    Row {
        parts: PARTS,
        patches: field.patch_count(),
        triangles: field.occluders().triangles(),
        seen: seen as f64,
        ms_per_step: 1e3 * whole,
        sight_ms: 1e3 * sight,
        each_triangle_ms: 1e3 * each,
        ratio: each / whole,
    }
}

/// Seconds of processor time a step, of the best round.
fn best(steps: &[Vec<RigidBody>], mut step: impl FnMut(usize, &[RigidBody])) -> f64 {
    (0..ROUNDS)
        .map(|_| {
            let start = ThreadTime::now();
            steps.iter().enumerate().for_each(|(index, bodies)| step(index, bodies));
            start.elapsed().as_secs_f64() / steps.len() as f64
        })
        .fold(f64::INFINITY, f64::min)
}

/// Where everything is in each step: in the breath's cone, turning once a second.
fn crowd(random: &mut Random) -> Vec<Vec<RigidBody>> {
    let properties =
        MassProperties { mass: 0.01, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(1e-5)) };
    let any = |random: &mut Random| DVec3::new(random.signed(), random.signed(), random.signed());
    let starts: Vec<(DVec3, DVec3)> =
        (0..PARTS).map(|_| (any(random) * DVec3::new(0.06, 0.06, 0.2), any(random))).collect();
    (0..STEPS)
        .map(|step| {
            let turned = |&(position, axis): &(DVec3, DVec3)| {
                let pose =
                    Pose { rotation: rotation(axis + axis.normalize() * (2.0 * PI * step as f64 / 240.0)), position };
                RigidBody::at_rest(properties, pose)
            };
            starts.iter().map(turned).collect()
        })
        .collect()
}

/// A ball, felt on both sides so that all of its patches ask.
fn surface(body: usize) -> Surface {
    let shape = SurfaceShape::Mesh {
        mesh: ball(0.02),
        per_area: 1.0,
        count: PATCHES..=PATCHES,
        sheet: true,
        seed: body as u64,
    };
    Surface { body, node: String::new(), shape, drag_normal: 1.17, drag_tangential: 0.02, gain: 1.0 }
}

/// A ball with a waist, of 2 · 2 R · R triangles.
fn ball(radius: f64) -> TriangleMesh {
    let sectors = 2 * RINGS;
    let mut mesh = TriangleMesh::default();
    for i in 0..=RINGS {
        let (s, c) = sincos(PI * i as f64 / RINGS as f64);
        for j in 0..sectors {
            let (t, u) = sincos(2.0 * PI * j as f64 / sectors as f64);
            mesh.positions.push(radius * (0.7 + 0.3 * c * c) * DVec3::new(s * u, s * t, c));
        }
    }
    let at = |i: usize, j: usize| (i * sectors + j % sectors) as u32;
    for i in 0..RINGS {
        for j in 0..sectors {
            mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}
