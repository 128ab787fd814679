//! The other sources of partials: strings, springs, draws, tubes with losses, and what a mesh's dimensions say.

use soffio_math::{PI, ln};
use soffio_sound::modes::{Mode, T60_DECAYS};
use soffio_sound::{InstrumentSpec, Preset, free_plate_modes, partials};

use super::{spec, steel};

/// A preset with one modal node.
fn modal(lines: &str) -> Preset {
    let text = format!(
        "timbre = 1\nname = \"one\"\ndescription = \"\"\n[node.out]\ntype = \"modal\"\ncontact_radius = 0.003\n{lines}\n"
    );
    Preset::parse("one", &text).unwrap_or_else(|e| panic!("{e}"))
}

fn modes(lines: &str, spec: &InstrumentSpec) -> Vec<Mode> {
    partials(&modal(lines), spec).expect("it can ring")
}

/// What is exact but for rounding.
const ROUNDING: f64 = 1e-12;

fn same(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < ROUNDING
}

#[test]
fn strings_and_springs_follow_their_formulas() {
    let string = modes(
        "from = \"string\"\nlength = 0.65\ntension = 93\nmass = 7.4e-4\ninharmonicity = 8e-5\npartials = 30",
        &spec("one"),
    );
    let v = (93.0 * 0.65 / 7.4e-4f64).sqrt();
    for (i, mode) in string.iter().enumerate() {
        let n = i as f64 + 1.0;
        assert!(same(mode.frequency, n * v / 1.3 * (1.0 + 8e-5 * n * n).sqrt()), "{n}: {}", mode.frequency);
        assert!(same(mode.decay, PI * steel().loss_factor * mode.frequency));
    }
    // Longitudinal, as the thesis has it: v = √(E/ρ).
    let rod = modes("from = \"string\"\nlength = 2\npartials = 3", &spec("one"));
    assert!(same(rod[2].frequency, 3.0 * (2e11f64 / 7850.0).sqrt() / 4.0));
    let spring = modes("from = \"mass-spring\"\nstiffness = 1e5\nmass = 0.02\nt60 = 2", &spec("one"));
    assert!(spring.len() == 1 && same(spring[0].frequency, (1e5 / 0.02f64).sqrt() / (2.0 * PI)));
    assert!(same(spring[0].decay, T60_DECAYS / 2.0));
}

#[test]
fn tubes_decay_by_their_material_their_cord_and_their_own_sound() {
    let tube = |more: &str| {
        let size = "from = \"tube\"\nlength = 0.5338\nouter = 0.0254\ninner = 0.0221\npartials = 5\n";
        let material = "material = { youngs_modulus = 68.9e9, poisson = 0.33, density = 2710, loss_factor = 4e-4 }\n";
        modes(&format!("{size}{material}{more}"), &spec("one"))
    };
    for mode in tube("") {
        assert!(same(mode.decay, PI * 4e-4 * mode.frequency));
    }
    // Support loss times φ², 2 at the ends and of mean square 1; the published weights at 0.2242 have two digits.
    const WEIGHT: f64 = 0.12;
    let hung = tube("support_loss = 2");
    for (mode, weight) in hung.iter().zip([0.0, -1.00, -1.32, -0.93, -0.06]) {
        let support = mode.decay - PI * 4e-4 * mode.frequency;
        assert!((support - 2.0 * weight * weight).abs() < 2.0 * WEIGHT, "{} Hz: {support} 1/s", mode.frequency);
    }
    // Radiation: hardly anything at the first partial, most of the loss at the fifth.
    let heard = tube("radiation_loss = true");
    let own = |i: usize| heard[i].decay / (PI * 4e-4 * heard[i].frequency) - 1.0;
    assert!((0.0..0.1).contains(&own(0)) && own(4) > 0.5, "{} and {}", own(0), own(4));
}

#[test]
fn a_tube_has_two_planes_as_far_apart_as_asked() {
    // Cents; the frequencies are exact but for rounding.
    const TOLERANCE: f64 = 1e-9;
    let split =
        modes("from = \"tube\"\nlength = 0.5\nouter = 0.02\ninner = 0.018\nsplit = 6\npartials = 8", &spec("one"));
    assert_eq!(split.len(), 8);
    for pair in split.as_chunks::<2>().0 {
        let cents = 1200.0 * ln(pair[1].frequency / pair[0].frequency) / ln(2.0);
        assert!((cents - 6.0).abs() < TOLERANCE, "{cents}");
    }
}

#[test]
fn draws_keep_to_their_distributions() {
    let lines = "from = \"random\"\npartials = 600\nlow = 200\nhigh = 8000\nt60 = [0.3, 0.05]\nt60_spread = 1.5\ntilt = -6\nseed = 3";
    let drawn = modes(lines, &spec("one"));
    assert_eq!(drawn.len(), 600);
    assert!(drawn.windows(2).all(|m| m[0].frequency < m[1].frequency));
    assert!(drawn[0].frequency >= 200.0 && drawn[599].frequency <= 8000.0);
    // As many below the middle of the band as above it: one in each of 600 equal parts.
    assert_eq!(drawn.iter().filter(|m| m.frequency < 4100.0).count(), 300);
    // c = c₀ + c₂ ω² between 1/1.5 and 1.5 times.
    let (low, high) = (T60_DECAYS / 0.3, T60_DECAYS / 0.05);
    for mode in &drawn {
        let share = (mode.frequency * mode.frequency - 4e4) / (6.4e7 - 4e4);
        let times = mode.decay / (low + share * (high - low));
        assert!((1.0 / 1.5 - 1e-9..=1.5 + 1e-9).contains(&times), "{} Hz: {times}", mode.frequency);
    }
    // −6 dB per octave: a regression over 600 Rayleigh levels, whose logarithm spreads by 5.6 dB, is this good.
    const TILT: f64 = 1.0;
    let points: Vec<(f64, f64)> =
        drawn.iter().map(|m| (ln(m.frequency) / ln(2.0), soffio_math::amplitude_to_db(m.amplitude))).collect();
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let slope = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
        / points.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>();
    assert!((slope + 6.0).abs() < TILT, "{slope} dB per octave");
    let power: f64 = drawn.iter().map(|m| m.amplitude * m.amplitude).sum();
    assert!((power - 1.0).abs() < 1e-9);
    // Another seed is another draw, the same seed the same.
    assert!(modes(lines, &spec("one"))[7].frequency == drawn[7].frequency);
    assert!(modes(&lines.replace("seed = 3", "seed = 4"), &spec("one"))[7].frequency != drawn[7].frequency);
}

#[test]
fn a_meshs_dimensions_choose_the_theory() {
    let body = |lines: &str, half: [f64; 2], thickness: f64, mass: f64| {
        let mut spec = spec("one");
        spec.body.half_extents = half;
        (spec.body.thickness, spec.body.mass, spec.body.area) = (thickness, mass, 4.0 * half[0] * half[1]);
        modes(lines, &spec)[0].frequency
    };
    let mesh = "from = \"mesh\"\npartials = 4";
    // A steel tube of 40 cm, 20 mm by 1 mm, given by its mass alone.
    let mass = 7850.0 * 0.4 * PI / 4.0 * (0.02 * 0.02 - 0.018 * 0.018);
    let tube = body("from = \"tube\"\nouter = 0.02\ninner = 0.018", [0.2, 0.01], 0.02, mass);
    assert!((body(mesh, [0.2, 0.01], 0.02, mass) / tube - 1.0).abs() < 1e-9);
    // A square bar, and a sheet.
    let mass = 7850.0 * 0.4 * 0.02 * 0.02;
    let bar = body("from = \"bar\"", [0.2, 0.01], 0.02, mass);
    assert_eq!(body(mesh, [0.2, 0.01], 0.02, mass), bar);
    let plate = spec("one");
    assert_eq!(modes(mesh, &plate)[0].frequency, free_plate_modes(&plate.body, &plate.material)[0].frequency);
}
