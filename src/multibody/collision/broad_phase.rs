//! Broad phase by sort and sweep (D. Baraff 1992) over the boxes of swept colliders.
//!
//! The boxes of the bodies are sorted by their lower ends along the axis on which they spread most, and only boxes that overlap
//! there are compared. The order changes little from step to step, so insertion sort is linear. The boxes are enlarged, and sorted
//! again only when a body leaves its enlarged box. Bodies whose boxes overlap are then compared collider by collider. Each
//! static collider has a box of its own.

use super::conservative_advancement::{BoxSize, CONTACT_MARGIN, Sweep};
use super::pair_cache::{MIN_CACHED_PAIRS, PairCache};
use super::pairs::ColliderPair;
use super::shape::{Collider, Shape};
use soffio_math::{DMat3, DVec3, Pose};

/// A box along the world's axes, m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    const NOTHING: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn about(middle: DVec3, half: DVec3) -> Self {
        Self { low: middle - half, high: middle + half }
    }

    fn join(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    fn contains(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && other.high.cmple(self.high).all()
    }

    /// Wider by this share of its greatest half extent on each side.
    fn enlarge(&self, fraction: f64) -> Self {
        let margin = DVec3::splat(0.5 * fraction * (self.high - self.low).max_element());
        Self { low: self.low - margin, high: self.high + margin }
    }

    fn middle_and_half(&self) -> (DVec3, DVec3) {
        (0.5 * (self.low + self.high), 0.5 * (self.high - self.low))
    }
}

/// How much wider a body's wide box is than its own, as a share of this: a wider one holds more pairs, a closer one is sooner left.
const ENLARGEMENT: f64 = 0.05;

/// Pairs of the colliders of two units: a range of `BroadPhase::sorted`.
#[derive(Clone, Copy, Debug)]
struct PairRun {
    units: (usize, usize),
    first: usize,
    end: usize,
}

/// Finds the pairs that can meet. Nothing allocates after [`BroadPhase::new`] but what `out` lacks.
#[derive(Clone, Debug)]
pub struct BroadPhase {
    shapes: Vec<(Option<usize>, Option<Plane>)>,
    /// Middle and half extents of each collider's box, and of all of each body's, node frame.
    colliders: Vec<(DVec3, DVec3)>,
    bodies: Vec<(DVec3, DVec3)>,
    pairs: Vec<ColliderPair>,
    /// Indices of pairs, runs of the same two units together.
    sorted: Vec<usize>,
    runs: Vec<PairRun>,
    /// Of runs of many pairs between two bodies, those that are near.
    pair_cache: Vec<Option<PairCache>>,
    /// Swept boxes of the units (the bodies, then each collider that stands still), and units in order.
    units: Vec<Bounds>,
    order: Vec<usize>,
    /// Wide boxes of the units, and the runs of those that meet, not both asleep; out of date when others sleep.
    enlarged: Vec<Bounds>,
    nearby_runs: Vec<usize>,
    outdated: bool,
    /// Where each body is at the two ends of its way.
    ends: Vec<[(Pose, DMat3); 2]>,
    /// Swept boxes of the colliders whose turn it was to be looked at, and before that cubes around these.
    swept: Vec<Option<Bounds>>,
    cubes: Vec<Option<Bounds>>,
    /// Colliders of bodies that have such boxes: a few of a wheel's teeth.
    cached_colliders: Vec<usize>,
    /// Sizes of the boxes that have been asked for.
    sizes: Vec<Option<BoxSize>>,
    /// Which units sleep (what never moves does), and which of their boxes are known.
    asleep: Vec<bool>,
    known: Vec<bool>,
}

/// A half-space that stands still.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    fn of(shape: &Shape) -> Option<Self> {
        let normal = shape.place.vector(DVec3::Y);
        shape.is_plane().then(|| Self { normal, offset: normal.dot(shape.place.position) })
    }

    fn overlaps(&self, bounds: &Bounds) -> bool {
        let (middle, half) = bounds.middle_and_half();
        middle.dot(self.normal) - half.dot(self.normal.abs()) <= self.offset + CONTACT_MARGIN
    }
}

impl BroadPhase {
    /// For these pairs of colliders.
    pub fn new(colliders: &[Collider], pairs: &[ColliderPair]) -> Self {
        let boxes: Vec<_> = colliders.iter().map(|c| c.shape.extents()).collect();
        let count = colliders.iter().filter_map(|c| c.body).max().map_or(0, |most| most + 1);
        let own = |body: usize| colliders.iter().zip(&boxes).filter(move |(c, _)| c.body == Some(body));
        let bodies = (0..count)
            .map(|body| {
                let all = own(body).map(|(_, &(middle, half))| Bounds::about(middle, half));
                let whole = all.fold(Bounds::NOTHING, |whole, one| whole.join(&one));
                // A body without colliders is in no pair.
                if whole == Bounds::NOTHING { (DVec3::ZERO, DVec3::ZERO) } else { whole.middle_and_half() }
            })
            .collect();
        let mut units = vec![Bounds::NOTHING; count];
        let unit: Vec<usize> = colliders
            .iter()
            .zip(&boxes)
            .map(|(collider, &(middle, half))| {
                collider.body.unwrap_or_else(|| {
                    units.push(Bounds::about(middle, half));
                    units.len() - 1
                })
            })
            .collect();
        let key = |pair: &ColliderPair| (unit[pair.a].min(unit[pair.b]), unit[pair.a].max(unit[pair.b]));
        let mut sorted: Vec<usize> = (0..pairs.len()).collect();
        sorted.sort_by_key(|&i| (key(&pairs[i]), i));
        let mut runs: Vec<PairRun> = Vec::new();
        for (at, &pair) in sorted.iter().enumerate() {
            let units = key(&pairs[pair]);
            match runs.last_mut() {
                Some(run) if run.units == units => run.end = at + 1,
                _ => runs.push(PairRun { units, first: at, end: at + 1 }),
            }
        }
        let many = |run: &PairRun| run.end - run.first >= MIN_CACHED_PAIRS && run.units.0.max(run.units.1) < count;
        let pair_cache = runs.iter().map(|run| many(run).then(|| PairCache::new(run.end - run.first))).collect();
        // Units in no pair need not be sorted.
        let order = (0..units.len()).filter(|u| runs.iter().any(|r| r.units.0 == *u || r.units.1 == *u)).collect();
        Self {
            shapes: colliders.iter().map(|c| (c.body, c.body.map_or_else(|| Plane::of(&c.shape), |_| None))).collect(),
            swept: vec![None; colliders.len()],
            cubes: vec![None; colliders.len()],
            cached_colliders: Vec::with_capacity(2 * colliders.len()),
            sizes: vec![None; colliders.len()],
            ends: vec![[(Pose::IDENTITY, DMat3::IDENTITY); 2]; count],
            colliders: boxes,
            bodies,
            asleep: (0..units.len()).map(|unit| unit >= count).collect(),
            known: vec![false; units.len()],
            pairs: pairs.to_vec(),
            sorted,
            enlarged: units.clone(),
            nearby_runs: Vec::with_capacity(runs.len()),
            outdated: true,
            runs,
            pair_cache,
            units,
            order,
        }
    }

    /// Lets bodies sleep: their sweeps stay as they are, and sleeping bodies form no pairs with each other.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        for (unit, asleep) in asleep.iter().enumerate().take(self.bodies.len()) {
            (self.asleep[unit], self.known[unit]) = (*asleep, false);
        }
        self.outdated = true;
    }

    /// Indices of the pairs whose swept boxes overlap, ascending, into `out`. One sweep for each body.
    pub fn candidates(&mut self, sweeps: &[Sweep], out: &mut Vec<usize>) {
        out.clear();
        if self.runs.is_empty() {
            return;
        }
        for &unit in &self.order {
            if self.known[unit] {
                continue;
            }
            if let Some(&(middle, half)) = self.bodies.get(unit) {
                self.ends[unit] = sweeps[unit].ends();
                self.units[unit] = swept(&sweeps[unit], &self.ends[unit], middle, half);
                self.outdated |= !self.enlarged[unit].contains(&self.units[unit]);
            }
        }
        let (known, shapes) = (&self.known, &self.shapes);
        self.cached_colliders.retain(|&collider| {
            let stays = shapes[collider].0.is_none_or(|body| known[body]);
            if !stays {
                (self.swept[collider], self.cubes[collider]) = (None, None);
            }
            stays
        });
        for (known, asleep) in self.known.iter_mut().zip(&self.asleep) {
            *known = *asleep;
        }
        if std::mem::take(&mut self.outdated) {
            self.find_overlapping_units();
        }
        for nearby_runs in 0..self.nearby_runs.len() {
            let run = self.nearby_runs[nearby_runs];
            let (one, other) = self.runs[run].units;
            if self.units[one].overlaps(&self.units[other]) {
                self.test_pairs(run, sweeps, out);
            }
        }
        out.sort_unstable();
    }

    /// Finds the units whose wide boxes meet.
    fn find_overlapping_units(&mut self) {
        for &unit in &self.order {
            let own = self.units[unit];
            self.enlarged[unit] = if self.asleep[unit] { own } else { own.enlarge(ENLARGEMENT) };
        }
        let axis = self.widest_axis();
        let low = |unit: usize| self.enlarged[unit].low[axis];
        for i in 1..self.order.len() {
            let mut at = i;
            while at > 0 && low(self.order[at - 1]) > low(self.order[at]) {
                self.order.swap(at - 1, at);
                at -= 1;
            }
        }
        self.nearby_runs.clear();
        for i in 0..self.order.len() {
            let one = self.order[i];
            for &other in &self.order[i + 1..] {
                if self.enlarged[other].low[axis] > self.enlarged[one].high[axis] {
                    break;
                }
                if !(self.asleep[one] && self.asleep[other]) && self.enlarged[one].overlaps(&self.enlarged[other]) {
                    let units = (one.min(other), one.max(other));
                    self.nearby_runs.extend(self.runs.binary_search_by_key(&units, |run| run.units).ok());
                }
            }
        }
    }

    /// The axis along which the middles of the boxes spread most.
    fn widest_axis(&self) -> usize {
        let (mut count, mut sum, mut squares) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for &unit in &self.order {
            let middle = self.units[unit].middle_and_half().0;
            if middle.is_finite() {
                count += 1.0;
                sum += middle;
                squares += middle * middle;
            }
        }
        (count * squares - sum * sum).max_position()
    }

    /// Adds the pairs of a run whose own boxes overlap.
    fn test_pairs(&mut self, run: usize, sweeps: &[Sweep], out: &mut Vec<usize>) {
        let PairRun { units, first, end } = self.runs[run];
        let Some(pair_cache) = &mut self.pair_cache[run] else {
            return (first..end).for_each(|at| self.test_pair(self.sorted[at], sweeps, out));
        };
        let unit_sweeps = [&sweeps[units.0], &sweeps[units.1]];
        if !pair_cache.contains(unit_sweeps) {
            let (shapes, colliders, ends) = (&self.shapes, &self.colliders, &self.ends);
            let cube = |collider: usize, body: usize| {
                let (middle, half) = colliders[collider];
                let (pose, axes) = &ends[body][0];
                (pose.position + *axes * middle, sweeps[body].size(middle, half))
            };
            pair_cache.refresh(unit_sweeps, &self.sorted[first..end], |pair| {
                let ColliderPair { a, b } = self.pairs[pair];
                let (a, b) = if shapes[a].0 == Some(units.0) { (a, b) } else { (b, a) };
                [cube(a, units.0), cube(b, units.1)]
            });
            // What goes farther than that within this interval is looked at each time.
            if !pair_cache.contains(unit_sweeps) {
                return (first..end).for_each(|at| self.test_pair(self.sorted[at], sweeps, out));
            }
        }
        let pairs = std::mem::take(&mut pair_cache.pairs);
        pairs.iter().for_each(|&pair| self.test_pair(pair, sweeps, out));
        if let Some(pair_cache) = &mut self.pair_cache[run] {
            pair_cache.pairs = pairs;
        }
    }

    /// Adds a pair if its colliders' own boxes overlap.
    fn test_pair(&mut self, index: usize, sweeps: &[Sweep], out: &mut Vec<usize>) {
        let ColliderPair { a, b } = self.pairs[index];
        let overlap = match (self.shapes[a].1, self.shapes[b].1) {
            (Some(plane), None) => plane.overlaps(&self.bounds(b, sweeps)),
            (None, Some(plane)) => plane.overlaps(&self.bounds(a, sweeps)),
            _ => {
                self.cube(a, sweeps).overlaps(&self.cube(b, sweeps))
                    && self.bounds(a, sweeps).overlaps(&self.bounds(b, sweeps))
            }
        };
        if overlap {
            out.push(index);
        }
    }

    /// A cube that a collider's swept box lies in, for less: of a wheel's teeth few are near anything.
    fn cube(&mut self, collider: usize, sweeps: &[Sweep]) -> Bounds {
        let ((middle, half), (body, _)) = (self.colliders[collider], self.shapes[collider]);
        *self.cubes[collider].get_or_insert_with(|| match body {
            Some(body) => {
                self.cached_colliders.push(collider);
                let (pose, axes) = &self.ends[body][0];
                let size = self.sizes[collider].get_or_insert_with(|| sweeps[body].size(middle, half));
                let half_edge = size.half + sweeps[body].max_deviation(size) + CONTACT_MARGIN;
                Bounds::about(pose.position + *axes * middle, DVec3::splat(half_edge))
            }
            None => Bounds::about(middle, half),
        })
    }

    fn bounds(&mut self, collider: usize, sweeps: &[Sweep]) -> Bounds {
        let ((middle, half), (body, _)) = (self.colliders[collider], self.shapes[collider]);
        *self.swept[collider].get_or_insert_with(|| match body {
            Some(body) => {
                self.cached_colliders.push(collider);
                swept(&sweeps[body], &self.ends[body], middle, half)
            }
            None => Bounds::about(middle, half),
        })
    }
}

/// A box around a box of the node frame all along its way.
///
/// At either end it is the turned box. Between, a point with the arm ρ leaves its chord by ρ θ²/8 at most, and is as
/// much before or behind its uniform pace; `TOUCH` is added once, for each pair's touching layer.
fn swept(sweep: &Sweep, [from, to]: &[(Pose, DMat3); 2], middle: DVec3, half: DVec3) -> Bounds {
    let at = |(pose, axes): &(Pose, DMat3)| {
        let half = axes.x_axis.abs() * half.x + axes.y_axis.abs() * half.y + axes.z_axis.abs() * half.z;
        Bounds::about(pose.position + *axes * middle, half)
    };
    let both = at(from).join(&at(to));
    let margin = DVec3::splat(sweep.arc_deviation(middle, half) + CONTACT_MARGIN);
    Bounds { low: both.low - margin, high: both.high + margin }
}
