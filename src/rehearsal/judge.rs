//! What an onlooker sees of an answer: from pictures alone.
//!
//! ```text
//! n(a, b)     part of the pixels that differ between two pictures by more than 4 % of full scale in some channel
//! changed at  the first picture k within 0.3 s of the onset with n(picture k, picture k had nobody come) > least
//! D(k)        most that n(p, p + k pictures) came to in the second before the onset: what moves anyhow
//! seen at     the first picture k within 0.3 s of the onset with n(onset, onset + k) > D(k) + least
//! energy      mean squared difference of successive pictures
//! contingency energy in the second after the onset over that in the second before
//! ```
//!
//! A visit is answered that changes the work at a contingency of 3. *Seen* asks more, and is told beside it: that the
//! change stands out from whatever moved already.
//!
//! 4 % is twice what the eye tells at an edge under a museum's light (Weber's fraction of 1 to 2 %).

/// Pictures a second.
pub const FPS: u64 = 30;
/// Pictures of a second before and after an onset, and one at the onset.
pub const BEFORE: usize = FPS as usize;
/// From the onset to the change that is to be seen, pictures: 0.3 s.
pub const SOON: usize = 9;
/// Differences of this and less are not seen, of 255.
const UNSEEN: u8 = 10;
/// Least part of the picture that is seen to change: on a 55-inch screen 1.6 cm².
const LEAST: f64 = 2e-4;

/// One picture: RGB as it is displayed, 8 bits each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture(pub Vec<u8>);

impl Picture {
    /// Part of the pixels that differ by more than can be overlooked.
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

/// Motion that nobody sees: in every picture so much as the least part that is seen, changed by no more than is overlooked.
const STILL: f64 = FPS as f64 * LEAST * (UNSEEN as f64 / 255.0) * (UNSEEN as f64 / 255.0);

/// What followed an onset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// From the onset to the first picture that is visibly another one than had nobody come, pictures; `None` if there is
    /// none soon.
    pub changed: Option<usize>,
    /// From the onset to the first picture in which more has changed than does anyhow, pictures.
    pub seen: Option<usize>,
    /// Motion energy of the second before, and of the second after; full scale 1.
    pub energy: [f64; 2],
    /// The one over the other.
    pub contingency: f64,
}

/// What doing makes, at least: three times as much motion as there was.
pub const CONTINGENT: f64 = 3.0;

impl Answer {
    /// Did the work visibly answer?
    pub fn is_answer(&self) -> bool {
        self.changed.is_some() && self.contingency >= CONTINGENT
    }
}

/// Judges the pictures of a second before an onset, at it, and of a second after it, 2 · [`BEFORE`] + 1 of them; `alone` are
/// the first [`SOON`] after it had nobody come.
pub fn answer(pictures: &[Picture], alone: &[Picture]) -> Option<Answer> {
    if pictures.len() != 2 * BEFORE + 1 || alone.len() != SOON {
        return None;
    }
    let changed = (1..=SOON).find(|&k| pictures[BEFORE + k].changed(&alone[k - 1]) > LEAST);
    let onset = &pictures[BEFORE];
    let anyhow = |lapse: usize| {
        let pairs = (0..=BEFORE - lapse).map(|i| pictures[i].changed(&pictures[i + lapse]));
        pairs.fold(0.0, f64::max)
    };
    let seen = (1..=SOON).find(|&k| {
        let change = onset.changed(&pictures[BEFORE + k]);
        change > LEAST && change > anyhow(k) + LEAST
    });
    let energy = |pictures: &[Picture]| pictures.windows(2).map(|pair| pair[0].energy(&pair[1])).sum::<f64>();
    let [before, after] = [&pictures[..=BEFORE], &pictures[BEFORE..]].map(energy);
    Some(Answer { changed, seen, energy: [before, after], contingency: (after + STILL) / (before + STILL) })
}

/// The middle of some numbers; `None` of none.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some(0.5 * (values[middle - 1] + values[middle])),
    }
}
