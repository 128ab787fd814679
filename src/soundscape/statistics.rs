//! Statistics: quantiles, rank correlation, and 95 % bounds of counts.
//!
//! The bounds of a share k of n are Wilson's interval (JASA 22, 1927). Those of a rate of k events are the exact Poisson interval
//! (Garwood 1936), with the approximation of Wilson and Hilferty (1931) for the quantiles of χ².

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

/// Spearman's rank correlation of pairs without ties.
pub fn spearman(pairs: &[(f64, f64)]) -> f64 {
    let rank = |x: f64, of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().filter(|p| of(p) < x).count() as f64;
    let n = pairs.len() as f64;
    let squares: f64 = pairs
        .iter()
        .map(|(a, b)| {
            let d = rank(*a, &|p| p.0) - rank(*b, &|p| p.1);
            d * d
        })
        .sum();
    1.0 - 6.0 * squares / (n * (n * n - 1.0))
}
