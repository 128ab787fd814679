//! Mesh refinement for baked light: halves edges until none is longer than a limit, the longest ones first. So a tray of twelve triangles
//! is refined even where balls of thousands of triangles lie in it.
//!
//! Whether an edge is halved depends only on its own two ends. So triangles on both sides of it, of one mesh or of two,
//! agree, and no gap opens.

use std::collections::HashMap;

use glam::Vec4;

use super::scene::Scene;
use super::skins::Skinned;
use super::vertex::Vertex;

/// First limit relative to the last: a longer edge is halved several times at the first limit.
const FIRST_LIMIT: f32 = 32.0;

impl Scene {
    /// Halves edges longer than `longest`, m, repeatedly, until about `added` vertices are added.
    pub fn refine(&mut self, longest: f32, added: usize) {
        let most = self.vertices.len() + added;
        let mut limit = FIRST_LIMIT * longest;
        while limit >= longest {
            while self.halve(limit) {
                if self.vertices.len() > most {
                    return;
                }
            }
            limit *= 0.5;
        }
    }

    /// Halves each edge that is too long, once; returns whether there was any.
    fn halve(&mut self, longest: f32) -> bool {
        // Skins place their own vertices in each frame, and no others.
        let skins: Vec<_> = self.skins.iter().map(Skinned::range).collect();
        let is_skin = |vertex: u32| skins.iter().any(|range| range.contains(&vertex));
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let vertices = &mut self.vertices;
        let mut middle = |a: u32, b: u32| -> Option<u32> {
            let (p, q) = (vertices[a.min(b) as usize], vertices[a.max(b) as usize]);
            (p.position.distance(q.position) > longest && !is_skin(a)).then(|| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    vertices.push(between(&p, &q));
                    vertices.len() as u32 - 1
                })
            })
        };
        let mut indices = Vec::with_capacity(2 * self.indices.len());
        let (mut opaque, mut casters, mut plates) = (0, 0, 0);
        for batch in &mut self.batches {
            let start = indices.len() as u32;
            for t in self.indices[batch.indices.start as usize..batch.indices.end as usize].chunks_exact(3) {
                let [a, b, c] = [t[0], t[1], t[2]];
                match (middle(a, b), middle(b, c), middle(c, a)) {
                    (None, None, None) => indices.extend([a, b, c]),
                    (Some(ab), None, None) => indices.extend([a, ab, c, ab, b, c]),
                    (None, Some(bc), None) => indices.extend([b, bc, a, bc, c, a]),
                    (None, None, Some(ca)) => indices.extend([c, ca, b, ca, a, b]),
                    (Some(ab), Some(bc), None) => indices.extend([ab, b, bc, a, ab, bc, a, bc, c]),
                    (None, Some(bc), Some(ca)) => indices.extend([bc, c, ca, b, bc, ca, b, ca, a]),
                    (Some(ab), None, Some(ca)) => indices.extend([ca, a, ab, c, ca, ab, c, ab, b]),
                    (Some(ab), Some(bc), Some(ca)) => {
                        indices.extend([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]);
                    }
                }
            }
            let end = indices.len() as u32;
            if batch.indices.end <= self.plate_casters_end {
                plates = end;
            }
            if batch.indices.end <= self.opaque_end {
                opaque = end;
            }
            if batch.indices.end <= self.casters_end {
                casters = end;
            }
            batch.indices = start..end;
        }
        self.indices = indices;
        (self.plate_casters_end, self.opaque_end, self.casters_end) = (plates, opaque, casters);
        !middles.is_empty()
    }
}

/// The vertex half way between two.
fn between(p: &Vertex, q: &Vertex) -> Vertex {
    let mean = |a: [f32; 4], b: [f32; 4]| (0.5 * (Vec4::from(a) + Vec4::from(b))).to_array();
    let along = mean(p.tangent, q.tangent);
    Vertex {
        position: 0.5 * (p.position + q.position),
        normal: (p.normal + q.normal).normalize_or(p.normal),
        tangent: [along[0], along[1], along[2], p.tangent[3]],
        uv: mean(p.uv, q.uv),
        color: mean(p.color, q.color),
        bounce: 0.5 * (p.bounce + q.bounce),
        fill: 0.5 * (p.fill + q.fill),
        ..*p
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::super::bounce::tests::hollow_cube;
    use super::super::scene::tests::of_primitive;

    #[test]
    fn a_cube_made_finer_has_no_gap_and_no_long_edge() {
        /// Longest edge of the test's mesh, m.
        const LONGEST: f32 = 0.3;
        let (_, mut scene) = of_primitive(hollow_cube(), Vec::new());
        let before = scene.vertices.len();
        scene.refine(LONGEST, 100_000);
        assert!(scene.vertices.len() > 10 * before && scene.opaque_end as usize == scene.indices.len());
        // By position: where faces meet, each has vertices of its own.
        let key = |i: u32| scene.vertices[i as usize].position.to_array().map(f32::to_bits);
        let mut sides: HashMap<_, i32> = HashMap::new();
        for t in scene.indices.chunks_exact(3) {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let length = scene.vertices[a as usize].position.distance(scene.vertices[b as usize].position);
                assert!(length <= LONGEST, "{length} m");
                *sides.entry((key(a).min(key(b)), key(a).max(key(b)))).or_default() += 1;
            }
        }
        assert!(sides.values().all(|&triangles| triangles == 2), "an edge has not two triangles");
    }
}
