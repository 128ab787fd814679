//! Key frames that are not missed: straight lines between those that stay lead past all others.

use soffio_math::{DQuat, DVec3, rotation, rotation_vector};

/// Farthest that any point of a body may be from where the run had it, by what was left out, m.
const ERROR: f64 = 1e-5;
/// Half of it is the place's, half the turn's.
const SHARE: f64 = 0.5 * ERROR;
/// A key at least so often, so that finding them takes no longer the longer a body rests.
const LONGEST: usize = 120;
/// A body reaches this far at least, m.
const REACH: f64 = 1e-3;

/// Indices of the places to keep.
pub(super) fn places(places: &[DVec3]) -> Vec<usize> {
    keep(places.len(), |from, to, i| {
        let share = (i - from) as f64 / (to - from) as f64;
        places[from].lerp(places[to], share).distance(places[i]) <= SHARE
    })
}

/// Indices of the rotations to keep, for a body whose points are up to `reach` metres from its origin. Programs turn from
/// key to key at an even rate, as the standard says, or straight and normalised; both must do.
pub(super) fn turns(turns: &[DQuat], reach: f64) -> Vec<usize> {
    let most = SHARE / reach.max(REACH);
    keep(turns.len(), |from, to, i| {
        let share = (i - from) as f64 / (to - from) as f64;
        let (p, q) = (turns[from], turns[to]);
        let way = rotation_vector(near(q * p.conjugate(), DQuat::IDENTITY));
        let straight = (p * (1.0 - share) + near(q, p) * share).normalize();
        [rotation(share * way) * p, straight].into_iter().all(|between| angle(between, turns[i]) <= most)
    })
}

/// Keeps the first and the last, and of the rest as few as `fits(from, to, between)` allows, one after another.
fn keep(count: usize, fits: impl Fn(usize, usize, usize) -> bool) -> Vec<usize> {
    let mut kept = vec![0];
    let mut from = 0;
    while from + 1 < count {
        let mut to = from + 1;
        while to + 1 < count && to - from < LONGEST && (from + 1..=to).all(|i| fits(from, to + 1, i)) {
            to += 1;
        }
        kept.push(to);
        from = to;
    }
    kept
}

/// The one of a rotation's two quaternions that is nearer to another.
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
        assert_eq!(places(&straight), [0, 99]);
        let mut bent = straight.clone();
        bent[40..].iter_mut().for_each(|p| p.y = 3.0 * ERROR);
        let kept = places(&bent);
        assert!(kept.contains(&39) && kept.contains(&40), "{kept:?}");
        // A quarter of a milliradian a frame: straight and even interpolation agree over all of them.
        let turning: Vec<DQuat> = (0..100).map(|i| rotation(DVec3::Y * 2.5e-4 * f64::from(i))).collect();
        assert_eq!(turns(&turning, 0.1), [0, 99]);
    }

    #[test]
    fn what_is_left_out_is_found_again_within_the_error() {
        let way = |i: usize| DVec3::new(0.1 * soffio_math::sin(0.005 * i as f64), 0.0, 0.0);
        let all: Vec<DVec3> = (0..500).map(way).collect();
        let kept = places(&all);
        // The bend is at most a = 2.5 µm a frame², so that n frames may lie between two keys with a n²/8 = 5 µm: four.
        assert!(kept.len() < 250, "{}", kept.len());
        for pair in kept.windows(2) {
            for i in pair[0]..pair[1] {
                let share = (i - pair[0]) as f64 / (pair[1] - pair[0]) as f64;
                assert!(all[pair[0]].lerp(all[pair[1]], share).distance(all[i]) <= SHARE);
            }
        }
    }
}
