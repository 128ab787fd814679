//! Shadow casters of a static scene. The shadow map is fitted to them alone, so that no texels are spent on the wall
//! behind the exhibit.
//!
//! Triangles that touch form a piece. Small pieces always count as casters; a large one, such as a wall or a floor,
//! only where rays from the scene's vertices to the light hit it often.

use std::collections::HashMap;

use glam::Vec3;

use super::occlusion::RayCaster;
use super::scene::Scene;

/// Size below which a piece is small, as a fraction of the scene's radius: chosen between furniture and walls of the
/// shipped scenes.
const SMALL: f32 = 0.35;
/// Fraction of all vertices that a large piece must shade to count: floors extend a little under walls, which is
/// invisible.
const OFTEN: f32 = 0.1;

/// Vertices of the shadow casters of a light at `eye`, for a static scene with its vertices at `positions`.
pub(super) fn casters(scene: &Scene, positions: &[Vec3], radius: f32, eye: Vec3) -> Vec<Vec3> {
    let pieces = pieces(scene, positions, radius);
    let count = pieces.iter().max().map_or(0, |last| last + 1);
    let mut bounds = vec![(Vec3::INFINITY, Vec3::NEG_INFINITY); count];
    for (&piece, &place) in pieces.iter().zip(positions) {
        bounds[piece] = (bounds[piece].0.min(place), bounds[piece].1.max(place));
    }
    let mut counts: Vec<bool> =
        bounds.iter().map(|(low, high)| 0.5 * (*high - *low).length() < SMALL * radius).collect();
    if counts.iter().any(|counts| !counts)
        && let Some(solid) = RayCaster::of_opaque(scene, positions)
    {
        let mut shaded = vec![0; count];
        for (&place, &own) in positions.iter().zip(&pieces) {
            let mut met = vec![];
            solid.for_each_hit(place, eye, |corner| {
                let piece = pieces[corner as usize];
                if piece != own && !counts[piece] && !met.contains(&piece) {
                    met.push(piece);
                }
            });
            met.iter().for_each(|&piece| shaded[piece] += 1);
        }
        for (counts, shaded) in counts.iter_mut().zip(shaded) {
            *counts |= shaded as f32 > OFTEN * positions.len() as f32;
        }
    }
    let drawn = scene.indices[..scene.opaque_end as usize].iter().map(|&i| i as usize);
    drawn.filter(|&i| counts[pieces[i]]).map(|i| positions[i]).collect()
}

/// The piece of each vertex: vertices of one triangle, or at one position, belong together.
fn pieces(scene: &Scene, positions: &[Vec3], radius: f32) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..positions.len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let mut first = HashMap::new();
    for (i, place) in positions.iter().enumerate() {
        let key = place.to_array().map(|c| (c / (1e-5 * radius)).round() as i64);
        let (a, b) = (root(&mut parent, *first.entry(key).or_insert(i)), root(&mut parent, i));
        parent[b] = a;
    }
    for t in scene.indices.chunks_exact(3) {
        let [a, b, c] = [t[0], t[1], t[2]].map(|i| root(&mut parent, i as usize));
        parent[b] = a;
        let c = root(&mut parent, c);
        parent[c] = a;
    }
    let mut numbers = HashMap::new();
    (0..positions.len())
        .map(|i| {
            let root = root(&mut parent, i);
            let next = numbers.len();
            *numbers.entry(root).or_insert(next)
        })
        .collect()
}
