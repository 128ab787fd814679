//! Bending beams against closed forms, published tables and an independent discretisation.

use soffio_math::{PI, exp, ln};
use soffio_sound::modes::{BeamMode, Section, beam_modes};

use super::steel;

fn cents(a: f64, b: f64) -> f64 {
    1200.0 * ln(a / b) / ln(2.0)
}

/// An aluminium tube of 25.4 mm by 1.65 mm.
fn tube(length: f64, outer: f64, wall: f64, material: (f64, f64, f64)) -> Section {
    let (e, density, g) = material;
    let inner = outer - 2.0 * wall;
    Section {
        length,
        area: PI / 4.0 * (outer * outer - inner * inner),
        gyration: 0.25 * (outer * outer + inner * inner).sqrt(),
        youngs_modulus: e,
        shear_stiffness: 0.53 * g,
        density,
    }
}

const ALUMINIUM: (f64, f64, f64) = (68.9e9, 2710.0, 68.9e9 / 2.66);

#[test]
fn the_thesis_model_has_the_exact_roots() {
    // Roots of cos x cosh x = 1 by bisection of cos x − 1/cosh x here, and the thesis' series with m = 3.0112, 5, 7, …
    const CENTS: f64 = 0.5;
    let section = Section { shear_stiffness: f64::INFINITY, ..tube(1.2, 0.0254, 0.00165, ALUMINIUM) };
    let modes = beam_modes(&section, 12);
    let factor = section.gyration / (section.length * section.length) * (68.9e9f64 / 2710.0).sqrt();
    for (i, mode) in modes.iter().enumerate() {
        let n = i as f64 + 1.0;
        let f = |x: f64| soffio_math::cos(x) - 2.0 / (exp(x) + exp(-x));
        let (mut low, mut high) = ((n + 0.5) * PI - 0.5, (n + 0.5) * PI + 0.5);
        let sign = f(low) < 0.0;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (f(middle) < 0.0) == sign { low = middle } else { high = middle }
        }
        let exact = low * low * factor / (2.0 * PI);
        assert!(cents(mode.frequency, exact).abs() < 1e-6, "mode {n}: {} is not {exact}", mode.frequency);
        let m = if i == 0 { 3.0112 } else { 2.0 * n + 1.0 };
        let series = PI * factor / 8.0 * m * m;
        assert!(
            cents(mode.frequency, series).abs() < CENTS,
            "mode {n}: {} against the series' {series}",
            mode.frequency
        );
    }
    assert_eq!(modes.len(), 12);
}

#[test]
fn tubes_are_as_long_as_the_tables_of_chime_makers_say() {
    // Exact Timoshenko solutions of ready-cut tubes: length of C5 … and the ratios of its partials, 1 %.
    const TOLERANCE: f64 = 0.01;
    let mut worst = 0f64;
    let mut check = |value: f64, wanted: f64, what: &str| {
        worst = worst.max((value / wanted - 1.0).abs());
        assert!((value / wanted - 1.0).abs() < TOLERANCE, "{what}: {value} is not {wanted}");
    };
    let aluminium = [
        (523.25, 0.5338, [2.684, 5.073, 8.018, 11.39]),
        (587.33, 0.5034, [2.676, 5.038, 7.929, 11.22]),
        (659.26, 0.4747, [2.667, 4.999, 7.833, 11.03]),
        (783.99, 0.4346, [2.652, 4.936, 7.676, 10.73]),
        (880.00, 0.4097, [2.640, 4.889, 7.564, 10.52]),
        (1046.5, 0.3749, [2.621, 4.813, 7.382, 10.19]),
    ];
    for (f1, length, ratios) in aluminium {
        let modes = beam_modes(&tube(length, 0.0254, 0.00165, ALUMINIUM), 5);
        check(modes[0].frequency, f1, "aluminium, first partial");
        for (mode, ratio) in modes[1..].iter().zip(ratios) {
            check(mode.frequency / modes[0].frequency, ratio, "aluminium, ratio");
        }
    }
    // Length of C5 and ratios of partials 2 to 4; the modulus is the one that the length implies within the range of handbooks.
    let others = [
        ("brass", 0.3859, 0.01905, 0.00165, (110e9, 8500.0, 110e9 / 2.68), [2.68, 5.06, 7.99]),
        ("copper", 0.4254, 0.0222, 0.00114, (117e9, 8900.0, 117e9 / 2.68), [2.67, 5.01, 7.85]),
        ("steel", 0.4504, 0.0179, 0.00107, (200e9, 7850.0, 200e9 / 2.58), [2.71, 5.17, 8.26]),
        ("glass", 0.4803, 0.020, 0.0018, (70e9, 2500.0, 70e9 / 2.44), [2.71, 5.17, 8.27]),
        ("bamboo", 0.497, 0.030, 0.004, (11.2e9, 660.0, 11.2e9 / 12.0), [2.47, 4.24, 6.12]),
        ("wide aluminium", 0.9305, 0.0381, 0.00211, ALUMINIUM, [2.70, 5.15, 8.21]),
    ];
    for (name, length, outer, wall, material, ratios) in others {
        let modes = beam_modes(&tube(length, outer, wall, material), 4);
        println!("{name}: {:.2} Hz", modes[0].frequency);
        for (mode, ratio) in modes[1..].iter().zip(ratios) {
            check(mode.frequency / modes[0].frequency, ratio, name);
        }
        check(modes[0].frequency, if name.starts_with("wide") { 261.63 } else { 523.25 }, name);
    }
    println!("worst {:.2} %", 100.0 * worst);
}

/// Frequencies of a free Timoshenko beam by Ritz's method: w and ψ as Legendre polynomials, the energies
/// ½∫ EI ψ'² + κGA (w' − ψ)² and ½∫ ρA ẇ² + ρI ψ̇². No root of a transcendental equation in it.
fn ritz(section: &Section, modes: usize) -> Vec<f64> {
    const N: usize = 26;
    // Gauss-Legendre points by Newton's method.
    let legendre = |x: f64| {
        let mut p = [1.0; N + 1];
        p[1] = x;
        for k in 1..N {
            p[k + 1] = ((2 * k + 1) as f64 * x * p[k] - k as f64 * p[k - 1]) / (k + 1) as f64;
        }
        p
    };
    let slopes = |p: &[f64; N + 1]| {
        let mut d = [0.0; N + 1];
        d[1] = 1.0;
        for k in 1..N {
            d[k + 1] = d[k - 1] + (2 * k + 1) as f64 * p[k];
        }
        d
    };
    let points: Vec<(f64, f64)> = (0..N)
        .map(|i| {
            let mut x = soffio_math::cos(PI * (i as f64 + 0.75) / (N as f64 + 0.5));
            for _ in 0..10 {
                let p = legendre(x);
                x -= p[N] / slopes(&p)[N];
            }
            let d = slopes(&legendre(x))[N];
            (x, 2.0 / ((1.0 - x * x) * d * d))
        })
        .collect();
    // Lengths in L/2, energies over ρA (L/2): the unknowns are w and (L/2) ψ.
    let half = 0.5 * section.length;
    let r2 = section.gyration * section.gyration / (half * half);
    let speed2 = section.youngs_modulus / section.density / (half * half);
    let shear2 = section.shear_stiffness / section.density / (half * half);
    let size = 2 * N;
    let (mut k, mut m) = (vec![vec![0.0; size]; size], vec![vec![0.0; size]; size]);
    for &(x, weight) in &points {
        let p = legendre(x);
        let d = slopes(&p);
        for i in 0..N {
            for j in 0..N {
                m[i][j] += weight * p[i] * p[j];
                m[N + i][N + j] += weight * r2 * p[i] * p[j];
                k[i][j] += weight * shear2 * d[i] * d[j];
                k[i][N + j] -= weight * shear2 * d[i] * p[j];
                k[N + i][j] -= weight * shear2 * p[i] * d[j];
                k[N + i][N + j] += weight * (speed2 * r2 * d[i] * d[j] + shear2 * p[i] * p[j]);
            }
        }
    }
    // Masses are diagonal for Legendre polynomials: an ordinary symmetric problem, solved by Jacobi rotations.
    let scale: Vec<f64> = (0..size).map(|i| 1.0 / m[i][i].sqrt()).collect();
    let mut a: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| k[i][j] * scale[i] * scale[j]).collect()).collect();
    for _ in 0..30 {
        for p in 0..size {
            for q in p + 1..size {
                if a[p][q].abs() < 1e-300 {
                    continue;
                }
                let theta: f64 = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in &mut a {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                }
                for j in 0..size {
                    let (x, y) = (a[p][j], a[q][j]);
                    (a[p][j], a[q][j]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    let mut found: Vec<f64> = (0..size).map(|i| a[i][i].max(0.0).sqrt() / (2.0 * PI)).collect();
    found.sort_by(f64::total_cmp);
    found.into_iter().skip(2).take(modes).collect()
}

#[test]
fn thick_beams_agree_with_an_independent_solution() {
    // Ritz's method converges from above; with 26 polynomials ten modes have settled to this.
    const TOLERANCE: f64 = 1e-6;
    let bar = |length: f64, h: f64, ratio: f64| Section {
        length,
        area: 0.03 * h,
        gyration: h / 12f64.sqrt(),
        youngs_modulus: 1e10,
        shear_stiffness: 0.85 * 1e10 / ratio,
        density: 700.0,
    };
    let sections = [
        tube(0.5338, 0.0254, 0.00165, ALUMINIUM),
        tube(0.497, 0.030, 0.004, (11.2e9, 660.0, 11.2e9 / 12.0)),
        // So thick that modes beyond the cut-off b r s = 1, of the second spectrum, are among them.
        bar(0.5, 0.1, 2.6),
        bar(0.4, 0.04, 15.0),
    ];
    for section in sections {
        let modes = beam_modes(&section, 10);
        let cut_off = (section.shear_stiffness / section.density).sqrt() / section.gyration / (2.0 * PI);
        let reference = ritz(&section, modes.len());
        println!("{} modes, cut-off {cut_off:.0} Hz, highest {:.0} Hz", modes.len(), modes[modes.len() - 1].frequency);
        assert!(modes.len() >= 8);
        for (mode, exact) in modes.iter().zip(&reference) {
            assert!(
                (mode.frequency / exact - 1.0).abs() < TOLERANCE,
                "{} is not {exact} ({section:?})",
                mode.frequency
            );
        }
    }
}

/// ∫ over the length by the midpoint rule.
fn mean(f: impl Fn(f64) -> f64) -> f64 {
    const N: usize = 2000;
    (0..N).map(|i| f((i as f64 + 0.5) / N as f64 - 0.5)).sum::<f64>() / N as f64
}

#[test]
fn shapes_are_those_of_the_tables_and_orthogonal() {
    let section = Section { shear_stiffness: f64::INFINITY, ..tube(0.5338, 0.0254, 0.00165, ALUMINIUM) };
    let mass = section.density * section.area * section.length;
    let modes = beam_modes(&section, 5);
    // Weights of a free slender beam, 2 at the ends: two digits are published.
    const TOLERANCE: f64 = 0.006;
    let table = [
        (0.50, [-1.22, 0.0, 1.42, 0.0, -1.41]),
        (0.40, [-1.04, -0.97, 0.66, 1.40, 0.22]),
        (0.30, [-0.54, -1.32, -0.79, 0.45, 1.35]),
        (0.2242, [0.0, -1.00, -1.32, -0.93, -0.06]),
        (0.0, [2.0, 2.0, 2.0, 2.0, 2.0]),
    ];
    let unit = |mode: &BeamMode, x: f64| mode.shape(x - 0.5) * mass.sqrt();
    for (x, weights) in table {
        for (mode, weight) in modes.iter().zip(weights) {
            // From the other end odd shapes have the other sign.
            let value = unit(mode, 1.0 - x);
            let value = if unit(mode, 1.0) * 2.0 < 0.0 { -value } else { value };
            assert!((value - weight).abs() < TOLERANCE, "at {x}, {} Hz: {value} is not {weight}", mode.frequency);
        }
    }
    for (i, a) in modes.iter().enumerate() {
        for (j, b) in modes.iter().enumerate() {
            let product = mean(|xi| a.shape(xi) * b.shape(xi)) * mass;
            let wanted = if i == j { 1.0 } else { 0.0 };
            // The midpoint rule's own error with 2000 intervals.
            assert!((product - wanted).abs() < 1e-4, "{i}, {j}: {product}");
        }
    }
}

#[test]
fn absurd_beams_have_no_modes_and_no_panic() {
    let good = tube(0.5, 0.02, 0.001, (steel().youngs_modulus, 7850.0, 8e10));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(beam_modes(&Section { length: bad, ..good }, 5).is_empty());
        assert!(beam_modes(&Section { gyration: bad, ..good }, 5).is_empty());
        assert!(beam_modes(&Section { youngs_modulus: bad, ..good }, 5).is_empty());
    }
    // A cable and a pebble: many, and none below the limit of hearing.
    assert!(beam_modes(&Section { length: 1000.0, ..good }, 40).len() <= 40);
    assert!(beam_modes(&Section { length: 0.01, ..good }, 40).iter().all(|mode| mode.frequency <= 20_000.0));
}
