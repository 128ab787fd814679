//! Which colliders can meet at all, in a stable order.

use super::Collider;

/// Two colliders of different bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    /// Index of the first collider; it belongs to a moving body.
    pub a: usize,
    /// Index of the second collider.
    pub b: usize,
}

/// All pairs of colliders whose bodies differ, move, and are not excluded (joined bodies are). Pairs of the same two
/// bodies stand together, so that whole bodies can be told apart before their colliders are.
pub fn pairs(colliders: &[Collider], excluded: &[(Option<usize>, Option<usize>)]) -> Vec<Pair> {
    let mut out = Vec::new();
    for i in 0..colliders.len() {
        for j in i + 1..colliders.len() {
            let (x, y) = (colliders[i].body, colliders[j].body);
            if x == y || excluded.contains(&(x, y)) || excluded.contains(&(y, x)) {
                continue;
            }
            out.push(if x.is_some() { Pair { a: i, b: j } } else { Pair { a: j, b: i } });
        }
    }
    out.sort_by_key(|pair: &Pair| (colliders[pair.a].body, colliders[pair.b].body));
    out
}
