//! Key-frame reduction: leaves out keys that interpolation between the remaining ones reproduces.

use soffio_math::{DQuat, DVec3, rotation, rotation_vector};

/// Largest deviation of any point of a body from the run, m.
const ERROR: f64 = 1e-5;
/// Half of the error is allowed to the position, half to the rotation.
const KEY_ERROR: f64 = 0.5 * ERROR;
/// Most frames between two keys, which bounds the time of the search.
const MAX_INTERVAL: usize = 120;
/// Least bounding radius of a body, m.
const MIN_RADIUS: f64 = 1e-3;

/// Indices of the position keys to keep.
pub(super) fn position_keys(position_keys: &[DVec3]) -> Vec<usize> {
    keep(position_keys.len(), |from, to, i| {
        let share = (i - from) as f64 / (to - from) as f64;
        position_keys[from].lerp(position_keys[to], share).distance(position_keys[i]) <= KEY_ERROR
    })
}

/// Indices of the rotation keys to keep, for a body of bounding radius `reach`, m. Both spherical interpolation, which
/// the standard prescribes, and normalised linear interpolation stay within the error.
pub(super) fn rotation_keys(rotation_keys: &[DQuat], reach: f64) -> Vec<usize> {
    let most = KEY_ERROR / reach.max(MIN_RADIUS);
    keep(rotation_keys.len(), |from, to, i| {
        let share = (i - from) as f64 / (to - from) as f64;
        let (p, q) = (rotation_keys[from], rotation_keys[to]);
        let difference = rotation_vector(near(q * p.conjugate(), DQuat::IDENTITY));
        let straight = (p * (1.0 - share) + near(q, p) * share).normalize();
        [rotation(share * difference) * p, straight].into_iter().all(|between| angle(between, rotation_keys[i]) <= most)
    })
}

/// Keeps the first and the last key and greedily as few others as `fits(from, to, between)` allows.
fn keep(count: usize, fits: impl Fn(usize, usize, usize) -> bool) -> Vec<usize> {
    let mut kept = vec![0];
    let mut from = 0;
    while from + 1 < count {
        let mut to = from + 1;
        while to + 1 < count && to - from < MAX_INTERVAL && (from + 1..=to).all(|i| fits(from, to + 1, i)) {
            to += 1;
        }
        kept.push(to);
        from = to;
    }
    kept
}

/// Of a rotation's two quaternions, the one nearer to `to`.
pub(super) fn near(q: DQuat, to: DQuat) -> DQuat {
    if q.dot(to) < 0.0 { -q } else { q }
}

/// Angle from one rotation to another, rad.
fn angle(p: DQuat, q: DQuat) -> f64 {
    rotation_vector(near(q * p.conjugate(), DQuat::IDENTITY)).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_ways_and_even_turns_need_few_keys_and_bends_keep_theirs() {
        let straight: Vec<DVec3> = (0..100).map(|i| DVec3::X * 0.01 * f64::from(i)).collect();
        assert_eq!(position_keys(&straight), [0, 99]);
        let mut bent = straight.clone();
        bent[40..].iter_mut().for_each(|p| p.y = 3.0 * ERROR);
        let kept = position_keys(&bent);
        assert!(kept.contains(&39) && kept.contains(&40), "{kept:?}");
        // At a quarter of a milliradian a frame both interpolations agree.
        let turning: Vec<DQuat> = (0..100).map(|i| rotation(DVec3::Y * 2.5e-4 * f64::from(i))).collect();
        assert_eq!(rotation_keys(&turning, 0.1), [0, 99]);
    }

    #[test]
    fn omitted_keys_are_interpolated_within_the_error() {
        let positions_at = |i: usize| DVec3::new(0.1 * soffio_math::sin(0.005 * i as f64), 0.0, 0.0);
        let all: Vec<DVec3> = (0..500).map(positions_at).collect();
        let kept = position_keys(&all);
        // The curvature is at most a = 2.5 µm a frame², so n frames can lie between two keys with a n²/8 = 5 µm: four.
        assert!(kept.len() < 250, "{}", kept.len());
        for pair in kept.windows(2) {
            for i in pair[0]..pair[1] {
                let share = (i - pair[0]) as f64 / (pair[1] - pair[0]) as f64;
                assert!(all[pair[0]].lerp(all[pair[1]], share).distance(all[i]) <= KEY_ERROR);
            }
        }
    }
}
