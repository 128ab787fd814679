//! The synth: pitch, decay, level, place, timing, limits, determinism.

mod beams;
mod moving_contact;
pub mod presets;
mod sizes;
mod sources;
mod surfaces;
mod timbres;
mod tones;
mod winds;

use fearless_simd::Level;
use proptest::prelude::*;
use soffio_math::noise::Random;
use soffio_math::{PI, StateHash, amplitude_to_db};
use soffio_sound::modal::fuses;
use soffio_sound::{
    CEILING, Damp, FADING_VOICES, InstrumentSpec, MAX_COMMANDS, MAX_VOICES, Preset, SoundBody, SoundCommand,
    SoundMaterial, Strike, Synth, WindSound, free_plate_modes, timbre,
};

const RATE: u32 = 48_000;

fn steel() -> SoundMaterial {
    SoundMaterial { youngs_modulus: 2e11, poisson: 0.3, density: 7850.0, loss_factor: 6e-4 }
}

fn disc(radius: f64, thickness: f64) -> SoundBody {
    let area = PI * radius * radius;
    SoundBody { half_extents: [radius; 2], thickness, area, mass: area * thickness * steel().density }
}

fn spec(timbre: &str) -> InstrumentSpec {
    InstrumentSpec {
        timbre: timbre.into(),
        own: None,
        body: disc(0.06, 5e-4),
        material: steel(),
        surface: None,
        gain: 1.0,
        max_voices: 8,
    }
}

fn strike(sample: u64, impulse: f32) -> Strike {
    Strike { sample, instrument: 0, impulse, speed: 0.3, mass: 0.003, position: [0.8, 0.1], pan: 0.0, distance: 0.7 }
}

fn synth(specs: &[InstrumentSpec]) -> Synth {
    Synth::new(RATE, specs, 1).expect("shipped timbres compile")
}

fn render(synth: &mut Synth, frames: usize) -> Vec<f32> {
    let mut out = vec![0.0; 2 * frames];
    synth.render(&mut out);
    out
}

fn peak(samples: &[f32]) -> f32 {
    samples.iter().fold(0.0, |m, s| m.max(s.abs()))
}

fn rms(samples: &[f32]) -> f64 {
    (samples.iter().map(|s| f64::from(*s) * f64::from(*s)).sum::<f64>() / samples.len() as f64).sqrt()
}

/// Amplitude of one frequency (Goertzel's sum, f64).
fn amplitude(samples: &[f64], frequency: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (t, x) in samples.iter().enumerate() {
        // Hann window: distant bins do not leak in.
        let window = 1.0 - soffio_math::cos(2.0 * PI * t as f64 / samples.len() as f64);
        let (s, c) = soffio_math::sincos(2.0 * PI * frequency * t as f64 / f64::from(RATE));
        re += window * x * c;
        im += window * x * s;
    }
    2.0 * (re * re + im * im).sqrt() / samples.len() as f64
}

#[test]
fn free_plates_sound_where_published_tables_say() {
    // Leissa, NASA SP-160, and later more exact values of the same constants, λ = ω a² √(μ/D): four digits.
    const TOLERANCE: f64 = 1.5e-3;
    let material = steel();
    let h = 5e-4;
    let root = |mu: f64| (mu / (material.youngs_modulus * h * h * h / (12.0 * (1.0 - 0.09)))).sqrt();
    let check = |body: SoundBody, size: f64, table: &[f64]| {
        let modes = free_plate_modes(&body, &material);
        for (mode, expected) in modes.iter().zip(table) {
            let lambda = 2.0 * PI * mode.frequency * size * size * root(body.mass / body.area);
            assert!((lambda / expected - 1.0).abs() < TOLERANCE, "{lambda} is not {expected}");
        }
        assert!(modes.len() >= 60);
    };
    // Disc, by its radius; each mode with nodal diameters is a pair.
    check(disc(0.06, h), 0.06, &[5.3583, 5.3583, 9.0031, 12.439, 12.439, 20.475, 20.475, 21.835, 21.835]);
    // Square, by its side.
    let side = 0.1;
    let area = side * side;
    let square = SoundBody { half_extents: [0.05; 2], thickness: h, area, mass: area * h * material.density };
    check(square, side, &[13.468, 19.596, 24.270, 34.801, 34.801, 61.093, 61.093, 63.687, 69.265, 77.173]);
}

#[test]
fn a_slender_plate_is_a_free_beam() {
    // Euler-Bernoulli: f = (β²/2π L²) √(E h²/12 ρ), β = 4.730041, 7.853205, 10.995608. A strip of ν = 0 is one exactly.
    const TOLERANCE: f64 = 2e-3;
    let material = SoundMaterial { poisson: 0.0, ..steel() };
    let (length, width, h) = (0.3, 0.01, 1e-3);
    let area = length * width;
    let body =
        SoundBody { half_extents: [length / 2.0, width / 2.0], thickness: h, area, mass: area * h * material.density };
    let speed = (material.youngs_modulus / (12.0 * material.density)).sqrt() * h;
    // Bending modes are even in y; the torsion between them is not.
    let bending: Vec<_> = free_plate_modes(&body, &material).into_iter().filter(|m| m.parity[1] == 0).collect();
    for (mode, beta) in bending.iter().zip([4.730_041, 7.853_205, 10.995_608]) {
        let exact = beta * beta / (2.0 * PI * length * length) * speed;
        assert!((mode.frequency / exact - 1.0).abs() < TOLERANCE, "{} is not {exact}", mode.frequency);
    }
}

/// A timbre of one partial.
fn single(frequency: f64, t60: f64) -> Preset {
    let text = format!(
        "timbre = 1\nname = \"one\"\ndescription = \"\"\n[node.out]\ntype = \"modal\"\nfrom = \"table\"\n\
         fundamental = {frequency}\ncontact_radius = 0.003\ntable = [{{ ratio = 1.0, gain = 1.0, t60 = {t60} }}]\ngain = 1000\n"
    );
    Preset::parse("one", &text).expect("a valid preset")
}

#[test]
fn pitch_is_exact_to_a_thousandth_of_a_cent() {
    // The error of the kernel: f64 phasors leave only rounding and the window's leakage.
    const CENTS: f64 = 1e-3;
    for frequency in [41.2, 180.0, 1234.5, 9876.5] {
        let mut synth = Synth::with_preset(RATE, &single(frequency, 30.0), &spec("plate"), 1).expect("compiles");
        synth.set_dry(true);
        synth.command(SoundCommand::Strike(strike(0, 1e-3)));
        let out: Vec<f64> = render(&mut synth, 4 * RATE as usize).chunks(2).map(|f| f64::from(f[0])).collect();
        // Phase of two halves against the wanted frequency: its drift is the error.
        let half = out.len() / 2;
        let phase = |part: &[f64], start: usize| {
            let (mut re, mut im) = (0.0, 0.0);
            for (t, x) in part.iter().enumerate() {
                let window = 1.0 - soffio_math::cos(2.0 * PI * t as f64 / part.len() as f64);
                let (s, c) = soffio_math::sincos(2.0 * PI * frequency * (t + start) as f64 / f64::from(RATE));
                re += window * x * c;
                im -= window * x * s;
            }
            soffio_math::atan2(im, re)
        };
        let drift = phase(&out[half..], half) - phase(&out[..half], 0);
        let error = drift / (2.0 * PI) / (half as f64 / f64::from(RATE));
        let cents = 1200.0 * error / frequency / std::f64::consts::LN_2;
        assert!(cents.abs() < CENTS, "{frequency} Hz: {cents} cents");
    }
}

#[test]
fn decay_takes_the_time_asked_for() {
    // Windowed level at two moments; the ratio of two equal windows of one exponential is exact but for rounding.
    const TOLERANCE: f64 = 2e-3;
    for t60 in [0.2, 2.0, 8.0] {
        let mut synth = Synth::with_preset(RATE, &single(1000.0, t60), &spec("plate"), 1).expect("compiles");
        synth.set_dry(true);
        synth.command(SoundCommand::Strike(strike(0, 1e-3)));
        let out: Vec<f64> = render(&mut synth, (t60 * 0.6 * f64::from(RATE)) as usize + 9600)
            .chunks(2)
            .map(|f| f64::from(f[0]))
            .collect();
        let apart = (t60 * 0.5 * f64::from(RATE)) as usize;
        let (early, late) = (amplitude(&out[480..2880], 1000.0), amplitude(&out[480 + apart..2880 + apart], 1000.0));
        let fall = amplitude_to_db(early / late);
        assert!((fall / 30.0 - 1.0).abs() < TOLERANCE, "T60 {t60} s: {fall} dB in half of it");
    }
}

#[test]
fn the_place_of_a_hit_is_heard() {
    // The centre of a disc is on every nodal diameter: its first mode is silent there and loud at the rim.
    const SILENT: f64 = 1e-3;
    let first = free_plate_modes(&spec("plate").body, &steel())[0].frequency;
    let level = |position: [f32; 2]| {
        let mut synth = synth(&[spec("plate")]);
        synth.set_dry(true);
        synth.command(SoundCommand::Strike(Strike { position, ..strike(0, 5e-4) }));
        let out: Vec<f64> = render(&mut synth, RATE as usize).chunks(2).map(|f| f64::from(f[0])).collect();
        amplitude(&out[2400..], first)
    };
    let (rim, centre) = (level([0.9, 0.0]), level([0.0, 0.0]));
    assert!(rim > 1e-4 && centre < SILENT * rim, "rim {rim}, centre {centre}");
}

#[test]
fn harder_hits_are_louder_and_faster_hits_brighter() {
    let hit = |impulse: f32, speed: f32| {
        let mut synth = synth(&[spec("plate")]);
        synth.set_dry(true);
        synth.command(SoundCommand::Strike(Strike { speed, ..strike(0, impulse) }));
        render(&mut synth, RATE as usize / 2)
    };
    // Spectral centroid by differences: rms of the slope over rms.
    let brightness = |x: &[f32]| {
        let slope: Vec<f32> = x.iter().zip(&x[2..]).map(|(a, b)| b - a).collect();
        rms(&slope) / rms(x)
    };
    let (soft, hard) = (hit(1e-5, 0.3), hit(1e-4, 0.3));
    let ratio = amplitude_to_db(rms(&hard) / rms(&soft));
    // Linear but for partials that were never started because they are inaudible.
    assert!((ratio - 20.0).abs() < 0.5, "{ratio} dB");
    assert!(brightness(&hit(1e-4, 1.5)) > 1.1 * brightness(&hit(1e-4, 0.05)));
}

#[test]
fn a_mobiles_hits_are_clearly_heard_and_its_touches_soft() {
    let body = |radius: f64| InstrumentSpec { body: disc(radius, 5e-4), ..spec("plate") };
    for radius in [0.02, 0.04, 0.06] {
        for (impulse, speed) in [(1e-4, 0.1), (3e-4, 0.2), (1e-3, 0.5)] {
            let mut synth = synth(&[body(radius)]);
            synth.set_dry(true);
            synth.command(SoundCommand::Strike(Strike { speed, ..strike(0, impulse) }));
            let db = amplitude_to_db(f64::from(peak(&render(&mut synth, RATE as usize / 2))));
            println!("disc of {radius} m, {impulse} N s at {speed} m/s: {db:.1} dBFS");
            assert!((-34.0..0.0).contains(&db), "disc of {radius} m, {impulse} N s at {speed} m/s: {db} dBFS");
        }
        let mut synth = synth(&[body(radius)]);
        synth.command(SoundCommand::Strike(Strike { speed: 0.02, ..strike(0, 5e-6) }));
        let db = amplitude_to_db(f64::from(peak(&render(&mut synth, RATE as usize / 2))));
        assert!(db < -40.0, "a touch: {db} dBFS");
    }
}

/// A busy second: hits at odd times, wind that changes, a silence.
fn scene(seed: u64) -> (Vec<InstrumentSpec>, Vec<SoundCommand>) {
    let mut random = Random::new(seed);
    let small = InstrumentSpec { body: disc(0.03, 8e-4), max_voices: 3, ..spec("plate") };
    let specs = vec![spec("plate"), small, spec("bell"), spec("wind-room")];
    let mut commands = Vec::new();
    for _ in 0..60 {
        let sample = random.range(0.0, 40_000.0) as u64;
        commands.push(SoundCommand::Strike(Strike {
            sample,
            instrument: (random.word() % 3) as u16,
            impulse: random.range(1e-5, 2e-3) as f32,
            speed: random.range(0.02, 1.0) as f32,
            mass: random.range(5e-4, 7e-3) as f32,
            position: [random.signed() as f32, random.signed() as f32],
            pan: random.signed() as f32,
            distance: random.range(0.3, 1.5) as f32,
        }));
    }
    for step in 0..200 {
        let (speed, gust) = (random.range(0.0, 4.0) as f32, random.signed() as f32);
        commands.push(SoundCommand::Wind(WindSound {
            sample: step * 200,
            instrument: 3,
            speed,
            gust,
            pan: 0.2,
            ..WindSound::default()
        }));
    }
    commands.push(SoundCommand::Silence { sample: 41_003 });
    commands.sort_by_key(SoundCommand::sample);
    (specs, commands)
}

#[test]
fn output_does_not_depend_on_how_it_is_cut_into_blocks() {
    let (specs, commands) = scene(5);
    let whole = {
        let mut synth = synth(&specs);
        commands.iter().for_each(|c| synth.command(*c));
        render(&mut synth, RATE as usize)
    };
    assert!(peak(&whole) > 0.1);
    for block in [1, 17, 64, 200, 480, 512, 1024, 2048] {
        let mut synth = synth(&specs);
        let mut pending = commands.iter().peekable();
        let mut out = Vec::with_capacity(whole.len());
        while out.len() < whole.len() {
            // As late as possible: only commands of this block.
            let frames = block.min((whole.len() - out.len()) / 2);
            while let Some(c) = pending.next_if(|c| c.sample() < synth.position() + frames as u64) {
                synth.command(*c);
            }
            out.extend(render(&mut synth, frames));
        }
        assert!(out == whole, "block of {block}");
    }
}

#[test]
fn the_same_scene_has_the_same_bits_in_every_build() {
    let (specs, commands) = scene(9);
    let mut synth = synth(&specs);
    commands.iter().for_each(|c| synth.command(*c));
    let out = render(&mut synth, RATE as usize);
    let mut hash = StateHash::default();
    out.iter().for_each(|s| hash.add(f64::from(*s)));
    // What the hash stands for, so that a change can be judged.
    println!("hash {:#x}, rms {:.6}, peak {:.6}", hash.0, rms(&out), peak(&out));
    let golden = if fuses(Level::new()) { FUSED } else { ROUNDED_TWICE };
    assert_eq!(hash.0, golden, "the sound of a scene changed: listen, then store the new hash");
}

/// Hash of the scene of seed 9, equal in debug and release: where the processor fuses multiply-adds, and where not.
const FUSED: u64 = 0x3a78_ac2b_fc66_6bab;
const ROUNDED_TWICE: u64 = 0x2779_ddf5_d8a3_a2d5;

#[test]
fn a_hit_starts_on_its_own_sample() {
    for sample in [0, 1, 63, 64, 777, 48_001] {
        let mut synth = synth(&[spec("plate")]);
        synth.set_dry(true);
        synth.command(SoundCommand::Strike(strike(sample, 1e-3)));
        let out = render(&mut synth, sample as usize + 100);
        let first = out.iter().position(|s| *s != 0.0).expect("a sound") as u64 / 2;
        // A partial begins with sine phase, so its own first sample is 0; the click's is not.
        assert!(first == sample || first == sample + 1, "asked for {sample}, heard at {first}");
    }
}

#[test]
fn late_hits_are_heard_though_nothing_more_can_wait() {
    let mut synth = synth(&[spec("plate")]);
    synth.set_dry(true);
    render(&mut synth, 1000);
    for later in 0..MAX_COMMANDS as u64 {
        synth.command(SoundCommand::Wind(WindSound { sample: 90_000 + later, ..WindSound::default() }));
    }
    for _ in 0..2 * MAX_COMMANDS {
        synth.command(SoundCommand::Wind(WindSound { sample: 10, ..WindSound::default() }));
    }
    synth.command(SoundCommand::Strike(strike(10, 1e-3)));
    assert_eq!(synth.lost(), 0);
    assert!(peak(&render(&mut synth, 200)) > 0.01);
    // One more that must wait finds no room.
    synth.command(SoundCommand::Strike(strike(80_000, 1e-3)));
    assert_eq!(synth.lost(), 1);
}

#[test]
fn late_commands_start_at_once_and_the_limiter_tells_its_latency() {
    let mut synth = synth(&[spec("plate")]);
    render(&mut synth, 1000);
    synth.command(SoundCommand::Strike(strike(10, 1e-3)));
    let out = render(&mut synth, 200);
    let first = out.iter().position(|s| *s != 0.0).expect("a sound") / 2;
    assert!(first.abs_diff(synth.latency()) <= 1, "{first}");
}

#[test]
fn nothing_leaves_above_the_ceiling() {
    let (specs, mut commands) = scene(11);
    for command in &mut commands {
        if let SoundCommand::Strike(s) = command {
            s.impulse *= 300.0;
        }
    }
    let mut synth = synth(&specs);
    commands.iter().for_each(|c| synth.command(*c));
    let out = render(&mut synth, RATE as usize);
    let peak = peak(&out);
    println!("peak {:.3} dBFS", amplitude_to_db(f64::from(peak)));
    assert!(peak > 0.8 && f64::from(peak) <= CEILING, "{peak}");
}

/// Sum of two sounds, sample by sample, against a third, dB of full scale.
fn difference(a: &[f32], b: &[f32], whole: &[f32]) -> f64 {
    amplitude_to_db(f64::from(a.iter().zip(b).zip(whole).fold(0.0f32, |m, ((a, b), w)| m.max((a + b - w).abs()))))
}

#[test]
fn hits_add_up_in_the_body_that_rings() {
    // Two hits together are each by itself: f32 sums, what is forgotten at −100 dBFS, no voice stolen.
    const DIFFERENCE_DB: f64 = -90.0;
    let first = strike(100, 5e-4);
    let second = Strike { position: [-0.5, 0.6], speed: 0.05, ..strike(9_601, 4e-4) };
    let play = |strikes: &[Strike]| {
        let mut synth = synth(&[InstrumentSpec { max_voices: 1, ..spec("bell") }]);
        synth.set_dry(true);
        strikes.iter().for_each(|s| synth.command(SoundCommand::Strike(*s)));
        render(&mut synth, RATE as usize)
    };
    let found = difference(&play(&[first]), &play(&[second]), &play(&[first, second]));
    assert!(found < DIFFERENCE_DB, "{found} dBFS");
}

#[test]
fn a_storm_of_hits_is_heard_without_a_click() {
    // Soft hits, each below −40 dBFS, on one plate: its sound against what the same hits give when nothing is forgotten
    // and every one has its own synth. The clicks of hits are noise with a voice each, left out here.
    const CLICK_DB: f64 = -80.0;
    let bare = timbre::source("plate").expect("shipped").replace("in = [\"body\", \"click\"]", "in = [\"body\"]");
    let preset = Preset::parse("plate", &bare).expect("valid");
    let one = || {
        let mut synth = Synth::with_preset(RATE, &preset, &spec("plate"), 1).expect("compiles");
        synth.set_dry(true);
        synth
    };
    for (per_minute, count) in [(10_000, 40), (100_000, 60)] {
        let mut random = Random::new(per_minute);
        let every = 60.0 * f64::from(RATE) / per_minute as f64;
        let strikes: Vec<Strike> = (0..count)
            .map(|i| Strike {
                position: [random.signed() as f32, random.signed() as f32],
                speed: random.range(0.02, 1.0) as f32,
                ..strike((f64::from(i) * every) as u64 + random.word() % 20, random.range(1e-6, 2e-5) as f32)
            })
            .collect();
        let frames = 24_000;
        let mut together = one();
        strikes.iter().for_each(|s| together.command(SoundCommand::Strike(*s)));
        let together = render(&mut together, frames);
        let mut apart = vec![0.0f32; together.len()];
        for s in &strikes {
            let mut synth = one();
            synth.command(SoundCommand::Strike(*s));
            apart.iter_mut().zip(render(&mut synth, frames)).for_each(|(sum, x)| *sum += x);
        }
        let found = difference(&apart, &vec![0.0; apart.len()], &together);
        println!(
            "{per_minute} hits a minute: {found:.1} dBFS, peak {:.1} dBFS",
            amplitude_to_db(f64::from(peak(&together)))
        );
        assert!(found < CLICK_DB, "seed {per_minute}: {found} dBFS");
    }
}

#[test]
fn more_hits_than_can_be_told_apart_become_one() {
    // A thousand hits in one grid interval: work is bounded, and no impulse is lost.
    let play = |count: u64| {
        let mut synth = synth(&[spec("bell")]);
        synth.set_dry(true);
        (0..count).for_each(|_| synth.command(SoundCommand::Strike(strike(1, 1e-3 / count as f32))));
        rms(&render(&mut synth, RATE as usize))
    };
    let db = amplitude_to_db(play(1000) / play(1));
    assert!(db.abs() < 0.1, "{db} dB");
}

#[test]
fn a_hand_on_a_bell_stills_it() {
    let level = |resistance: f32| {
        let mut synth = synth(&[spec("bell")]);
        synth.set_dry(true);
        synth.command(SoundCommand::Strike(strike(0, 1e-3)));
        synth.command(SoundCommand::Damp(Damp { sample: 24_000, instrument: 0, position: [0.0; 2], resistance }));
        let out = render(&mut synth, 36_000);
        rms(&out[60_000..])
    };
    // R = 2 N s/m adds c = R/2m to each decay; root mean square between 0.125 s and 0.25 s after the touch.
    let c = 2.0 / (2.0 * spec("bell").body.mass);
    let (from, to) = (0.125, 0.25);
    let left = (soffio_math::exp(-2.0 * c * from) - soffio_math::exp(-2.0 * c * to)) / (2.0 * c * (to - from));
    let expected = amplitude_to_db(left.sqrt());
    let found = amplitude_to_db(level(2.0) / level(0.0));
    // The bell's own decays differ, so it is not the same mixture of partials in both.
    assert!((found - expected).abs() < 1.0, "{found} dB, not {expected} dB");
}

/// A hiss after each hit that drives one partial.
fn driven() -> Preset {
    let text = "timbre = 1\nname = \"driven\"\ndescription = \"\"\n[node.hiss]\ntype = \"noise\"\n\
                [node.force]\ntype = \"env\"\nin = \"hiss\"\ndecay = 0.05\ngain = 0.01\n\
                [node.out]\ntype = \"modal\"\nin = \"force\"\nfrom = \"table\"\nfundamental = 700\n\
                contact_radius = 0.003\ntable = [{ ratio = 1.0, gain = 1.0, t60 = 1.5 }]\ngain = 3000\n";
    Preset::parse("driven", text).expect("valid")
}

#[test]
fn a_force_of_the_timbres_own_drives_the_body_in_any_blocks() {
    let play = |block: usize| {
        let mut synth = Synth::with_preset(RATE, &driven(), &spec("plate"), 1).expect("compiles");
        synth.set_dry(true);
        // No impulse: the sound is that of the force.
        synth.command(SoundCommand::Strike(strike(77, 0.0)));
        synth.command(SoundCommand::Strike(strike(3_333, 0.0)));
        let mut out = Vec::new();
        while out.len() < RATE as usize {
            let frames = block.min((RATE as usize - out.len()) / 2);
            out.extend(render(&mut synth, frames));
        }
        assert_eq!(synth.faults(), 0);
        out
    };
    let whole = play(RATE as usize);
    for block in [1, 17, 64, 480, 1024] {
        assert!(play(block) == whole, "block of {block}");
    }
    let mono: Vec<f64> = whole.chunks(2).map(|f| f64::from(f[0])).collect();
    let (own, other) = (amplitude(&mono[6000..], 700.0), amplitude(&mono[6000..], 900.0));
    assert!(own > 1e-3 && own > 100.0 * other, "{own} at its own frequency, {other} beside");
}

#[test]
fn fewer_partials_ring_when_fewer_may() {
    let specs: Vec<_> = (0..6).map(|_| spec("plate")).collect();
    let mut synth = synth(&specs);
    synth.set_most_partials(100);
    (0..6).for_each(|i| synth.command(SoundCommand::Strike(Strike { instrument: i, ..strike(0, 1e-3) })));
    render(&mut synth, 640);
    assert!((80..=100).contains(&synth.partials()), "{}", synth.partials());
}

#[test]
fn voices_end_and_are_bounded() {
    let mut synth = synth(&[InstrumentSpec { max_voices: 1000, ..spec("plate") }]);
    for i in 0..500 {
        synth.command(SoundCommand::Strike(strike(i * 20, 1e-3)));
    }
    render(&mut synth, 10_300);
    // The body, and its last hits.
    let sounding = synth.sounding();
    assert!((2..=1 + MAX_VOICES + FADING_VOICES).contains(&sounding), "{sounding}");
    assert!((48..=60).contains(&synth.partials()), "{}", synth.partials());
    render(&mut synth, 20 * RATE as usize);
    assert_eq!((synth.sounding(), synth.partials()), (0, 0));
    assert_eq!(synth.faults(), 0);
}

#[test]
fn bad_numbers_never_reach_the_output() {
    let mut synth = synth(&[spec("plate"), spec("wind-room")]);
    let good = strike(0, 1e-3);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for broken in [
            Strike { impulse: bad, ..good },
            Strike { speed: bad, ..good },
            Strike { mass: bad, ..good },
            Strike { position: [bad, 0.0], ..good },
            Strike { pan: bad, ..good },
            Strike { distance: bad, ..good },
        ] {
            synth.command(SoundCommand::Strike(broken));
        }
        synth.command(SoundCommand::Wind(WindSound { speed: bad, ..WindSound::default() }));
    }
    synth.command(SoundCommand::Strike(Strike { instrument: 7, ..good }));
    synth.command(SoundCommand::Strike(Strike { impulse: f32::MAX, mass: 0.0, distance: 0.0, ..good }));
    synth.command(SoundCommand::Strike(strike(600, 1e-3)));
    let out = render(&mut synth, 4800);
    assert!(out.iter().all(|s| s.is_finite() && f64::from(s.abs()) <= CEILING));
    // The good hit afterwards is heard; the bad ones were counted: 21, one without instrument, one too loud to be true.
    assert!(peak(&out[1400..]) > 0.01);
    assert_eq!(synth.faults(), 23);
}

/// Sound of steady wind, after it settled.
fn wind(speed: f32, seconds: usize) -> Vec<f32> {
    let mut synth = synth(&[spec("wind-room")]);
    synth.command(SoundCommand::Wind(WindSound { sample: 0, speed, ..WindSound::default() }));
    render(&mut synth, RATE as usize / 2);
    render(&mut synth, seconds * RATE as usize)
}

#[test]
fn wind_leaves_the_band_of_breath_alone() {
    let out: Vec<f64> = wind(4.0, 4).chunks(2).map(|f| f64::from(f[0])).collect();
    // Power below 120 Hz, in steps of a window's resolution, against all of it.
    let n = 9600;
    let (mut low, mut all) = (0.0, 0.0);
    for part in out.chunks_exact(n) {
        for bin in 1..200 {
            let frequency = f64::from(bin) * 10.0;
            let power = amplitude(part, frequency) * amplitude(part, frequency);
            all += power;
            if frequency <= 100.0 {
                low += power;
            }
        }
    }
    let db = 10.0 * soffio_math::log10(low / all);
    println!("power below 100 Hz: {db:.1} dB");
    assert!(db < -20.0, "{db} dB");
}

#[test]
fn wind_falls_exactly_silent_and_never_jumps() {
    let mut synth = synth(&[spec("wind-room")]);
    synth.set_dry(true);
    for step in 0..240 {
        let speed = if step % 40 < 20 { 3.0 } else { 0.0 };
        synth.command(SoundCommand::Wind(WindSound { sample: step * 200, speed, gust: 0.5, ..WindSound::default() }));
    }
    let out: Vec<f32> = render(&mut synth, RATE as usize).chunks(2).map(|f| f[0]).collect();
    let second: Vec<f32> = out.windows(3).map(|w| w[0] - 2.0 * w[1] + w[2]).collect();
    // Noise below 2 kHz is smooth; a step in level would stand out of its second difference.
    assert!(peak(&second) < 12.0 * rms(&second) as f32);
    synth.command(SoundCommand::Wind(WindSound { sample: 48_000, ..WindSound::default() }));
    render(&mut synth, RATE as usize);
    assert_eq!(peak(&render(&mut synth, RATE as usize)), 0.0);
    assert_eq!(synth.sounding(), 0);
}

#[test]
fn silence_fades_everything() {
    let mut synth = synth(&[spec("bell"), spec("wind-room")]);
    synth.command(SoundCommand::Strike(strike(0, 1e-3)));
    synth.command(SoundCommand::Wind(WindSound { sample: 0, instrument: 1, speed: 3.0, ..WindSound::default() }));
    synth.command(SoundCommand::Silence { sample: 24_000 });
    let before = render(&mut synth, 24_000);
    assert!(peak(&before[40_000..]) > 1e-2);
    render(&mut synth, 48_000);
    assert_eq!(peak(&render(&mut synth, 4800)), 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10))]

    /// Whatever plates there are, their modes are positive, in order, and ring without fault.
    #[test]
    fn any_plate_rings(a in 0.01f64..0.6, ratio in 0.05f64..1.0, fill in 0.4f64..1.0, h in 2e-4f64..3e-3, x in -1.0f32..1.0, y in -1.0f32..1.0) {
        let b = a * ratio;
        let area = 4.0 * a * b * fill;
        let body = SoundBody { half_extents: [a, b], thickness: h, area, mass: area * h * 7850.0 };
        let modes = free_plate_modes(&body, &steel());
        prop_assert!(modes.len() >= 40);
        prop_assert!(modes[0].frequency > 0.0);
        prop_assert!(modes.windows(2).all(|m| m[0].frequency <= m[1].frequency));
        let mut synth = synth(&[InstrumentSpec { body, ..spec("plate") }]);
        synth.command(SoundCommand::Strike(Strike { position: [x, y], ..strike(3, 1e-3) }));
        let out = render(&mut synth, 2000);
        prop_assert!(out.iter().all(|s| s.is_finite()));
        // Also for hits beside the outline, whose place is only known by its bounds.
        prop_assert_eq!(synth.faults(), 0);
    }
}
