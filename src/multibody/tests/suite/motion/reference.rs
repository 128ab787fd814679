//! Ordinary differential equations to rounding: extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer), of
//! order sixteen.

/// y at the time `t + h` by one step; `rate(t, y)` is ẏ.
pub fn advance(rate: &impl Fn(f64, &[f64]) -> Vec<f64>, t: f64, y: &[f64], h: f64) -> Vec<f64> {
    let mut table: Vec<Vec<Vec<f64>>> = Vec::new();
    for row in 0..8 {
        let n = 2 * (row + 1);
        let mut line = vec![midpoints(rate, t, y, h, n)];
        for column in 1..=row {
            let ratio = n as f64 / (2 * (row + 1 - column)) as f64;
            let next = line[column - 1]
                .iter()
                .zip(&table[row - 1][column - 1])
                .map(|(fine, coarse)| fine + (fine - coarse) / (ratio * ratio - 1.0))
                .collect();
            line.push(next);
        }
        table.push(line);
    }
    table[7][7].clone()
}

/// y at the time `t`, from `y` at 0, in steps of `h` or a little less.
pub fn flow(rate: &impl Fn(f64, &[f64]) -> Vec<f64>, y: &[f64], t: f64, h: f64) -> Vec<f64> {
    let steps = (t / h).ceil().max(1.0);
    let h = t / steps;
    (0..steps as usize).fold(y.to_vec(), |y, k| advance(rate, k as f64 * h, &y, h))
}

fn midpoints(rate: &impl Fn(f64, &[f64]) -> Vec<f64>, t: f64, y: &[f64], h: f64, n: usize) -> Vec<f64> {
    let step = h / n as f64;
    let plus = |y: &[f64], s: f64, f: &[f64]| -> Vec<f64> { y.iter().zip(f).map(|(y, f)| y + s * f).collect() };
    let mut before = y.to_vec();
    let mut now = plus(y, step, &rate(t, y));
    for k in 1..n {
        let next = plus(&before, 2.0 * step, &rate(t + k as f64 * step, &now));
        before = std::mem::replace(&mut now, next);
    }
    let end = plus(&before, step, &rate(t + h, &now));
    now.iter().zip(&end).map(|(a, b)| 0.5 * (a + b)).collect()
}

#[test]
fn the_reference_knows_the_sine_to_rounding() {
    let y = flow(&|_, y: &[f64]| vec![y[1], -y[0]], &[0.0, 1.0], 10.0, 0.05);
    assert!((y[0] - 10.0_f64.sin()).abs() < 1e-13 && (y[1] - 10.0_f64.cos()).abs() < 1e-13, "{y:?}");
}
