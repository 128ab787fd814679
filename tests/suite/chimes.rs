//! Wind chimes: what a real collision sounds like, when it is heard, and that a child's breath makes one ring.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::{PI, cos, sin};
use soffio_simulation::{Command, EventKind, STEPS_PER_SECOND, Settings, Simulation, StepInput};
use soffio_sound::{SoundCommand, Strike, Synth};

const RATE: u32 = 48_000;

fn shipped(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text())))
}

fn steps(seconds: f64) -> usize {
    (seconds * STEPS_PER_SECOND as f64).round() as usize
}

/// The first strike of each tube by the striker or another tube, in the course of a few breaths.
fn strikes(exhibit: &Arc<Exhibit>) -> Vec<Strike> {
    let tubes: Vec<u16> = (exhibit.sounds.iter())
        .filter(|sound| sound.name.starts_with("tube"))
        .map(|sound| sound.instrument as u16)
        .collect();
    let mut found: Vec<Option<Strike>> = vec![None; tubes.len()];
    for seed in 1..20 {
        let mut simulation = Simulation::new(exhibit.clone(), Settings { seed, ..Settings::default() });
        for step in 0..steps(12.0) {
            let speed = Some(8.0).filter(|_| step % steps(4.0) < steps(2.0));
            let commands = [Command::Blow(speed)];
            // From the left, the front, the right: so that all of them are met.
            let pointer = Some([0.1 + 0.4 * (step / steps(4.0)) as f64, 0.5]);
            simulation.step(&StepInput { commands: &commands, pointer, ..StepInput::default() });
            for sound in simulation.sounds() {
                let SoundCommand::Strike(strike) = sound else { continue };
                if let Some(k) = tubes.iter().position(|tube| *tube == strike.instrument) {
                    // Loud enough that its last partial is not rounding.
                    if found[k].is_none() && strike.impulse > 3e-4 {
                        found[k] = Some(*strike);
                    }
                }
            }
            if found.iter().all(Option::is_some) {
                return found.into_iter().flatten().collect();
            }
        }
    }
    panic!("{}: not every tube was struck: {found:?}", exhibit.id);
}

/// The sound of one strike, dry, its left side.
fn rendered(exhibit: &Exhibit, strike: Strike, seconds: f64) -> Vec<f64> {
    let mut synth = Synth::new(RATE, &exhibit.instruments, 1).expect("shipped timbres");
    synth.set_dry(true);
    synth.command(SoundCommand::Strike(Strike { sample: 64, ..strike }));
    let mut out = vec![0.0; 2 * (seconds * f64::from(RATE)) as usize];
    synth.render(&mut out);
    out.chunks(2).skip(64).map(|frame| f64::from(frame[0] + frame[1])).collect()
}

/// Amplitude at a frequency, through Hann's window.
fn amplitude(samples: &[f64], frequency: f64) -> f64 {
    let n = samples.len() as f64;
    let (mut re, mut im) = (0.0, 0.0);
    for (i, sample) in samples.iter().enumerate() {
        let window = 0.5 - 0.5 * cos(2.0 * PI * (i as f64 + 0.5) / n);
        let angle = 2.0 * PI * frequency * i as f64 / f64::from(RATE);
        re += window * sample * cos(angle);
        im += window * sample * sin(angle);
    }
    (re * re + im * im).sqrt() / n
}

/// Where the spectrum is highest within ±4 % of a frequency, Hz, and how much it stands above its surroundings.
fn peak(samples: &[f64], near: f64) -> (f64, f64) {
    let grid: Vec<(f64, f64)> = (-40..=40)
        .map(|k| near * (1.0 + 1e-3 * f64::from(k)))
        .map(|frequency| (frequency, amplitude(samples, frequency)))
        .collect();
    let best = grid.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).expect("a grid");
    let mut levels: Vec<f64> = grid.iter().map(|(_, level)| *level).collect();
    levels.sort_by(f64::total_cmp);
    (best.0, best.1 / levels[levels.len() / 2].max(1e-300))
}

/// Notes and ratios of the first five partials of ready tubes (exact solutions), C5 to C6.
const ALUMINIUM: [(f64, [f64; 4]); 6] = [
    (523.25, [2.684, 5.073, 8.018, 11.39]),
    (587.33, [2.676, 5.038, 7.929, 11.22]),
    (659.26, [2.667, 4.999, 7.833, 11.03]),
    (783.99, [2.652, 4.936, 7.676, 10.73]),
    (880.00, [2.640, 4.889, 7.564, 10.52]),
    (1046.5, [2.621, 4.813, 7.382, 10.19]),
];
/// Of partials.
const TUNED: f64 = 0.01;

#[test]
fn each_tube_rings_its_five_partials_when_something_meets_it() {
    /// A partial is a peak this much higher than the middle of what is 4 % around it.
    const STANDS_OUT: f64 = 3.0;
    let exhibit = shipped("wind-chimes");
    for ((note, ratios), strike) in ALUMINIUM.into_iter().zip(strikes(&exhibit)) {
        // The highest partials are gone in a tenth of a second.
        let sound = rendered(&exhibit, strike, 0.3);
        let (first, _) = peak(&sound, note);
        assert!((first / note - 1.0).abs() < TUNED, "{first} Hz, not {note}");
        for ratio in ratios {
            let (found, out) = peak(&sound, note * ratio);
            println!(
                "{note} Hz, struck at {:.2}: {:.3} for {ratio}, {out:.0} times",
                strike.position[0],
                found / first
            );
            assert!((found / first / ratio - 1.0).abs() < TUNED, "{note} Hz: {}, not {ratio}", found / first);
            assert!(out > STANDS_OUT, "{note} Hz: no partial at {ratio}");
        }
    }
}

#[test]
fn bamboo_and_glass_ring_their_own_partials() {
    for (id, ratios) in [("wind-chimes-bamboo", [2.47, 4.24, 6.12]), ("wind-chimes-glass", [2.71, 5.17, 8.27])] {
        let exhibit = shipped(id);
        let strike = strikes(&exhibit)[0];
        let sound = rendered(&exhibit, strike, 0.3);
        let (first, _) = peak(&sound, 523.25);
        assert!((first / 523.25 - 1.0).abs() < TUNED, "{id}: {first} Hz");
        for ratio in ratios {
            let (found, out) = peak(&sound, 523.25 * ratio);
            println!("{id}: {:.3} for {ratio}, {out:.1} times", found / first);
            assert!((found / first / ratio - 1.0).abs() < TUNED, "{id}: {}, not {ratio}", found / first);
        }
    }
}

#[test]
fn two_tubes_of_each_metal_ring_the_same_two_notes() {
    let exhibit = shipped("wind-chimes-metals");
    let metals = ["chime-steel", "chime-copper", "chime-brass"];
    for (k, strike) in strikes(&exhibit).into_iter().enumerate() {
        let note = if k < 3 { 523.25 } else { 783.99 };
        assert_eq!(exhibit.instruments[usize::from(strike.instrument)].timbre, metals[k % 3]);
        let (found, _) = peak(&rendered(&exhibit, strike, 0.5), note);
        println!("tube {}, {}: {found:.1} Hz", k + 1, metals[k % 3]);
        assert!((found / note - 1.0).abs() < TUNED, "tube {}: {found} Hz, not {note} Hz", k + 1);
    }
}

#[test]
fn a_tube_of_c5_rings_as_long_as_its_material() {
    // T60 of the first partial, C5: 2.2/(η f) with the loss factors of mounted tubes. Radiation and the beats of the
    // two bending planes reduce it.
    const ABOUT: f64 = 0.15;
    for (id, tube, expected) in [
        ("wind-chimes", 0, 10.5),
        ("wind-chimes-bamboo", 0, 0.28),
        ("wind-chimes-glass", 0, 2.1),
        // Steel, copper and brass in turns.
        ("wind-chimes-metals", 0, 7.0),
        ("wind-chimes-metals", 1, 1.9),
        ("wind-chimes-metals", 2, 4.2),
    ] {
        let exhibit = shipped(id);
        let sound = rendered(&exhibit, strikes(&exhibit)[tube], 0.8 * expected + 0.2);
        let (note, _) = peak(&sound[..(0.3 * f64::from(RATE)) as usize], 523.25);
        // Level of windows, and the line through it.
        let window = (0.04 * f64::from(RATE)) as usize;
        let levels: Vec<(f64, f64)> = sound
            .chunks_exact(window)
            .enumerate()
            .map(|(k, part)| ((k * window) as f64 / f64::from(RATE), 20.0 * amplitude(part, note).log10()))
            .collect();
        // What is lower is rounding.
        let top = levels[0].1;
        let levels: Vec<(f64, f64)> = levels.into_iter().take_while(|(_, level)| *level > top - 50.0).collect();
        let n = levels.len() as f64;
        let (t, l) = levels.iter().fold((0.0, 0.0), |(t, l), (a, b)| (t + a / n, l + b / n));
        let slope = levels.iter().map(|(a, b)| (a - t) * (b - l)).sum::<f64>()
            / levels.iter().map(|(a, _)| (a - t) * (a - t)).sum::<f64>();
        let found = -60.0 / slope;
        println!("{id}: T60 {found:.2} s, material {expected} s");
        assert!((found / expected - 1.0).abs() < ABOUT, "{id}: {found} s, not {expected} s");
    }
}

#[test]
fn a_tube_is_heard_from_the_sample_of_its_collision_on() {
    // A struck mode begins as a sine: its first sample may be zero.
    const ONSET: u64 = 2;
    let exhibit = shipped("wind-chimes");
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let mut synth = Synth::new(RATE, &exhibit.instruments, 1).expect("shipped timbres");
    synth.set_dry(true);
    let (mut heard, mut hit) = (None, None);
    let mut block = vec![0.0; 400];
    for step in 0..steps(8.0) {
        let commands = [Command::Blow(Some(6.0))];
        simulation.step(&StepInput { commands: &commands, ..StepInput::default() });
        let impact = simulation.events().iter().find(|event| event.kind == EventKind::Impact);
        hit = hit.or(impact.map(|event| event.sample));
        // Only hits are heard here.
        let struck = simulation.sounds().iter().filter(|sound| matches!(sound, SoundCommand::Strike(_)));
        struck.for_each(|sound| synth.command(*sound));
        synth.render(&mut block);
        let first = block.chunks(2).position(|frame| frame[0] != 0.0 || frame[1] != 0.0);
        heard = heard.or(first.map(|k| 200 * step as u64 + k as u64));
        if heard.is_some() && hit.is_some() {
            break;
        }
    }
    let (heard, hit) = (heard.expect("a sound"), hit.expect("a hit"));
    assert!((hit..=hit + ONSET).contains(&heard), "hit at {hit}, heard at {heard}");
}

#[test]
fn a_childs_breath_rings_a_chime() {
    /// Speed at the lips of 0.3 L/s through 10 mm, m/s.
    const CHILD: f64 = 3.82;
    const SHARE: f64 = 0.8;
    for (id, tries) in
        [("wind-chimes", 100), ("wind-chimes-bamboo", 20), ("wind-chimes-glass", 20), ("wind-chimes-metals", 20)]
    {
        let exhibit = shipped(id);
        let rings = |seed: u64| {
            let mut random = soffio_math::noise::Random::new(seed);
            let mut simulation = Simulation::new(exhibit.clone(), Settings { seed, ..Settings::default() });
            // Somewhere in the middle of the picture, after some while, for a second.
            let pointer = Some([random.range(0.4, 0.6), random.range(0.2, 0.9)]);
            let begin = steps(random.range(0.5, 2.0));
            (0..begin + steps(2.5)).any(|step| {
                let blows = (begin..begin + steps(1.0)).contains(&step);
                let commands = [Command::Blow(Some(CHILD).filter(|_| blows))];
                simulation.step(&StepInput { commands: &commands, pointer, ..StepInput::default() });
                step >= begin && simulation.events().iter().any(|event| event.kind == EventKind::Impact)
            })
        };
        let rung = (0..tries).filter(|seed| rings(*seed)).count();
        println!("{id}: {rung} of {tries} breaths ring it");
        assert!(rung as f64 >= SHARE * tries as f64, "{id}: {rung} of {tries}");
    }
}
