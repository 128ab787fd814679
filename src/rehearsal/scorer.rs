//! Scorer: whether the exhibit visibly responds to a visitor, from pictures alone.
//!
//! ```text
//! n(a, b)     share of the pixels that differ between two pictures by more than 4 % of full scale in some channel
//! changed at  first picture k within 0.3 s of the onset with n(picture k, picture k of the control run) > least
//! D(k)        largest n(p, p + k pictures) in the second before the onset: motion without the visitor
//! seen at     first picture k within 0.3 s of the onset with n(onset, onset + k) > D(k) + least
//! energy      mean squared difference of successive pictures
//! contingency energy in the second after the onset over that in the second before
//! ```
//!
//! A response changes the exhibit with a contingency of 3 or more. *Seen* is stricter, and only reported: the change stands out from
//! the motion before it.
//!
//! 4 % is twice the contrast that the eye detects at an edge in a museum's light (Weber's fraction of 1 to 2 %).

/// Pictures a second.
pub const FPS: u64 = 30;
/// Pictures in the second before and in the second after an onset.
pub const BEFORE: usize = FPS as usize;
/// Pictures after the onset in which a change counts: 0.3 s.
pub const SOON: usize = 9;
/// Largest invisible difference, of 255.
const UNSEEN: u8 = 10;
/// Smallest visible share of the picture: 1.6 cm² on a 55-inch screen.
const LEAST: f64 = 2e-4;

/// One picture: RGB as it is displayed, 8 bits each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture(pub Vec<u8>);

impl Picture {
    /// Share of the pixels that differ visibly.
    pub fn changed(&self, other: &Self) -> f64 {
        let pixels = self.0.as_chunks::<3>().0.iter().zip(other.0.as_chunks::<3>().0);
        let seen = pixels.filter(|(a, b)| (0..3).any(|i| a[i].abs_diff(b[i]) > UNSEEN));
        seen.count() as f64 / (self.0.len() / 3).max(1) as f64
    }

    /// Mean squared difference, full scale 1.
    pub fn energy(&self, other: &Self) -> f64 {
        let square = |(a, b): (&u8, &u8)| u64::from(a.abs_diff(*b)) * u64::from(a.abs_diff(*b));
        let sum: u64 = self.0.iter().zip(&other.0).map(square).sum();
        sum as f64 / (255.0 * 255.0 * self.0.len().max(1) as f64)
    }
}

/// Invisible motion energy: in every picture the smallest visible share changes by the largest invisible difference.
const STILL: f64 = FPS as f64 * LEAST * (UNSEEN as f64 / 255.0) * (UNSEEN as f64 / 255.0);

/// Response of the exhibit to an onset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Pictures from the onset to the first one that differs visibly from the control run; `None` if there is none soon.
    pub changed: Option<usize>,
    /// Pictures from the onset to the first one that changes more than without the visitor.
    pub seen: Option<usize>,
    /// Motion energy of the second before, and of the second after; full scale 1.
    pub energy: [f64; 2],
    /// Ratio of the energy after to the energy before.
    pub contingency: f64,
}

/// Smallest contingency of a response: three times the motion before it.
pub const CONTINGENT: f64 = 3.0;

impl Response {
    /// True where the exhibit responds visibly.
    pub fn is_visible(&self) -> bool {
        self.changed.is_some() && self.contingency >= CONTINGENT
    }
}

/// Scores 2 · [`BEFORE`] + 1 pictures, from a second before an onset to a second after it; `control` are the first [`SOON`] pictures
/// after it in the control run. `None` for other numbers of pictures.
pub fn score(pictures: &[Picture], control: &[Picture]) -> Option<Response> {
    if pictures.len() != 2 * BEFORE + 1 || control.len() != SOON {
        return None;
    }
    let changed = (1..=SOON).find(|&k| pictures[BEFORE + k].changed(&control[k - 1]) > LEAST);
    let onset = &pictures[BEFORE];
    let without_visitor = |lapse: usize| {
        let pairs = (0..=BEFORE - lapse).map(|i| pictures[i].changed(&pictures[i + lapse]));
        pairs.fold(0.0, f64::max)
    };
    let seen = (1..=SOON).find(|&k| {
        let change = onset.changed(&pictures[BEFORE + k]);
        change > LEAST && change > without_visitor(k) + LEAST
    });
    let energy = |pictures: &[Picture]| pictures.windows(2).map(|pair| pair[0].energy(&pair[1])).sum::<f64>();
    let [before, after] = [&pictures[..=BEFORE], &pictures[BEFORE..]].map(energy);
    Some(Response { changed, seen, energy: [before, after], contingency: (after + STILL) / (before + STILL) })
}

/// Median; `None` for no values.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some(0.5 * (values[middle - 1] + values[middle])),
    }
}
