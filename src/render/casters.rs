//! What throws shadows in a still scene: the shadow map is drawn around that and no more, so that its texels are spent on
//! the work and not on the wall behind it.
//!
//! Triangles that touch belong together. Small pieces may shade something and always count; a large one, such as a wall or
//! a floor, only where rays from the scene's corners to the light meet it often.

use std::collections::HashMap;

use glam::Vec3;

use super::occlusion::Solid;
use super::scene::Scene;

/// A piece is small below this share of the scene's radius.
const SMALL: f32 = 0.35;
/// Share of all corners that a large piece must shade to count: floors reach a little under walls, which nobody sees.
const OFTEN: f32 = 0.1;

/// Corners of what throws shadows from a light at `eye`, of a scene at rest with its corners at `places`.
pub(super) fn casters(scene: &Scene, places: &[Vec3], radius: f32, eye: Vec3) -> Vec<Vec3> {
    let pieces = pieces(scene, places, radius);
    let count = pieces.iter().max().map_or(0, |last| last + 1);
    let mut bounds = vec![(Vec3::INFINITY, Vec3::NEG_INFINITY); count];
    for (&piece, &place) in pieces.iter().zip(places) {
        bounds[piece] = (bounds[piece].0.min(place), bounds[piece].1.max(place));
    }
    let mut counts: Vec<bool> =
        bounds.iter().map(|(low, high)| 0.5 * (*high - *low).length() < SMALL * radius).collect();
    if counts.iter().any(|counts| !counts)
        && let Some(solid) = Solid::new(scene, places, false)
    {
        let mut shaded = vec![0; count];
        for (&place, &own) in places.iter().zip(&pieces) {
            let mut met = vec![];
            solid.between(place, eye, |corner| {
                let piece = pieces[corner as usize];
                if piece != own && !counts[piece] && !met.contains(&piece) {
                    met.push(piece);
                }
            });
            met.iter().for_each(|&piece| shaded[piece] += 1);
        }
        for (counts, shaded) in counts.iter_mut().zip(shaded) {
            *counts |= shaded as f32 > OFTEN * places.len() as f32;
        }
    }
    let drawn = scene.indices[..scene.opaque as usize].iter().map(|&i| i as usize);
    drawn.filter(|&i| counts[pieces[i]]).map(|i| places[i]).collect()
}

/// The piece of each corner: corners of a triangle are of one, and so are corners at one place.
fn pieces(scene: &Scene, places: &[Vec3], radius: f32) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..places.len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let mut first = HashMap::new();
    for (i, place) in places.iter().enumerate() {
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
    (0..places.len())
        .map(|i| {
            let root = root(&mut parent, i);
            let next = numbers.len();
            *numbers.entry(root).or_insert(next)
        })
        .collect()
}
