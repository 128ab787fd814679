//! Statistics: quantiles, rank correlation, and 95 % bounds of counts.
//!
//! The bounds of a share k of n are Wilson's interval (JASA 22, 1927). Those of a rate of k events are the exact Poisson interval
//! (Garwood 1936), with the approximation of Wilson and Hilferty (1931) for the quantiles of χ². Equal values share their mean rank,
//! and the rank correlation is Pearson's of the ranks (Kendall 1948).

/// Two-sided 95 % of the normal distribution.
const Z: f64 = 1.959_964;

/// Wilson's bounds of the share `hits` of `all`.
pub fn wilson(hits: usize, all: usize) -> (f64, f64) {
    let n = (all as f64).max(1e-9);
    let (p, z2) = (hits as f64 / n, Z * Z);
    let middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let half = Z / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    if all == 0 { (0.0, 1.0) } else { ((middle - half).max(0.0), (middle + half).min(1.0)) }
}

/// 95 % bounds of the mean number of events, from the number counted.
pub fn poisson(events: usize) -> (f64, f64) {
    let bound = |k: f64, z: f64| {
        let root = 1.0 - 1.0 / (9.0 * k) + z / (3.0 * k.sqrt());
        k * root * root * root
    };
    let k = events as f64;
    (if events == 0 { 0.0 } else { bound(k, -Z) }, bound(k + 1.0, Z))
}

/// Quantile of the values at a share, 0 … 1.
pub fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1);
    sorted.get((part * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

/// Ranks of the values; equal values share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut out = vec![0.0; values.len()];
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]).scan(0, |from, equal| {
        let first = *from;
        *from += equal.len();
        Some((first, equal))
    }) {
        let (first, members) = equal;
        let mean = first as f64 + 0.5 * (members.len() as f64 - 1.0);
        members.iter().for_each(|i| out[*i] = mean);
    }
    out
}

/// Spearman's rank correlation of pairs; NaN where one side is constant.
pub fn spearman(pairs: &[(f64, f64)]) -> f64 {
    let (first, second): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let [a, b] = [ranks(&first), ranks(&second)];
    let mean = 0.5 * (pairs.len() as f64 - 1.0);
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum::<f64>();
    product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_share_their_rank() {
        /// Rounding.
        const EXACT: f64 = 1e-12;
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [2.5, 0.0, 2.5, 1.0]);
        assert!((spearman(&[(1.0, 2.0), (2.0, 4.0), (3.0, 9.0)]) - 1.0).abs() < EXACT);
        assert!((spearman(&[(1.0, 2.0), (2.0, 1.0), (3.0, 0.0)]) + 1.0).abs() < EXACT);
        assert!(spearman(&[(1.0, 2.0), (1.0, 1.0)]).is_nan());
    }
}
