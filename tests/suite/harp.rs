//! The aeolian harp: fingers and wind play its strings at the pitches of their length, pull and weight.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_fourier::real_forward;
use soffio_math::{DVec3, PI, cos};
use soffio_simulation::{Command, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput};
use soffio_sound::{BodyMotion, MotionSound, SoundCommand, Strike, Synth, WindSound};

const RATE: u32 = 48_000;
/// Pull of every string, N, as its timbres have it.
const PULL: f64 = 93.0;
/// Strouhal's number of a wire.
const STROUHAL: f64 = 0.2;
const STRINGS: usize = 7;
/// Width of the picture over its height.
const ASPECT: f64 = 16.0 / 9.0;
/// Speed at the lips of a child's 0.3 L/s through 10 mm, m/s.
const CHILD: f64 = 3.82;

fn harp() -> Arc<Exhibit> {
    let folder = exhibit::resolve("harp").unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text())))
}

fn steps(seconds: f64) -> usize {
    (seconds * STEPS_PER_SECOND as f64).round() as usize
}

fn instrument(exhibit: &Exhibit, sound: &str, k: usize) -> u16 {
    let name = format!("{sound}-{}", k + 1);
    exhibit.sounds.iter().find(|sound| sound.name == name).unwrap_or_else(|| panic!("no {name}")).instrument as u16
}

/// Diameter of the k-th string as it is drawn, m, and its pitch (1/2L) √(T/μ), Hz.
fn string(exhibit: &Exhibit, k: usize) -> (f64, f64) {
    let wire = exhibit.wires.iter().find(|wire| wire.name == format!("string-{}", k + 1)).expect("a string");
    let length: f64 = wire.points.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
    let line_density = exhibit.materials[wire.material].density * PI * wire.radius * wire.radius;
    (2.0 * wire.radius, (PULL / line_density).sqrt() / (2.0 * length))
}

/// The left side of some commands' sound, dry.
fn rendered(exhibit: &Exhibit, commands: &[SoundCommand], seconds: f64) -> Vec<f64> {
    let mut synth = Synth::new(RATE, &exhibit.instruments, 1).expect("checked timbres");
    synth.set_dry(true);
    commands.iter().for_each(|command| synth.command(*command));
    let mut out = vec![0.0; 2 * (seconds * f64::from(RATE)) as usize];
    synth.render(&mut out);
    assert_eq!(synth.faults(), 0);
    out.chunks(2).map(|frame| f64::from(frame[0] + frame[1])).collect()
}

/// Power spectrum of the last n samples through Hann's window; bins of RATE/n.
fn spectrum(samples: &[f64], n: usize) -> Vec<f64> {
    let transform = real_forward(n);
    let window = |i: usize| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / n as f64);
    let mut part: Vec<f64> = samples[samples.len() - n..].iter().enumerate().map(|(i, x)| x * window(i)).collect();
    let mut bins = transform.make_output_vec();
    transform.process(&mut part, &mut bins).expect("lengths agree");
    bins.iter().map(|bin| bin.norm_sqr()).collect()
}

/// The strongest frequency from `low` to `high`, Hz.
fn strongest(power: &[f64], n: usize, [low, high]: [f64; 2]) -> f64 {
    let bin = f64::from(RATE) / n as f64;
    let range = (low / bin).ceil() as usize..=(high / bin) as usize;
    range.max_by(|a, b| power[*a].total_cmp(&power[*b])).expect("bins") as f64 * bin
}

/// The strikes that follow where a hand lifts the k-th feather forwards within 0.6 s and lets go after a second.
fn plucked(exhibit: &Arc<Exhibit>, k: usize) -> Vec<Strike> {
    let mut simulation = Simulation::new(exhibit.clone(), Settings { wind: false, ..Settings::default() });
    let name = format!("Plectrum{}", k + 1);
    let body = exhibit.bodies.iter().position(|body| body.name == name).expect("a plectrum");
    let start = simulation.view(ASPECT).project(simulation.bodies()[body].position, ASPECT).expect("before the eye");
    let mut struck = Vec::new();
    for step in 0..steps(3.0) {
        let lift = (step as f64 / steps(0.6) as f64).min(1.0);
        // To the left in the picture is forwards: the harp is seen from its right side.
        let at = [start[0] - 0.02 * lift, start[1] - 0.03 * lift];
        let grabs = [PointerGrab { id: 1, at, body: Some(body) }];
        let holds = step < steps(1.0);
        simulation.step(&StepInput { pointer_grabs: if holds { &grabs } else { &[] }, ..StepInput::default() });
        for command in simulation.sounds() {
            if let SoundCommand::Strike(strike) = command {
                assert!(!holds, "{name} strikes in the hand");
                struck.push(*strike);
            }
        }
    }
    struck
}

#[test]
fn a_plucked_string_has_the_pitch_of_its_length_pull_and_weight() {
    /// Of the pitch: the bar.
    const TUNED: f64 = 0.01;
    let exhibit = harp();
    for k in 0..STRINGS {
        let strike = plucked(&exhibit, k)[0];
        let (_, pitch) = string(&exhibit, k);
        let sound = rendered(&exhibit, &[SoundCommand::Strike(Strike { sample: 64, ..strike })], 1.4);
        // Bins of 0.73 Hz; a fifth below and above, so that no other partial is near.
        let n = 65_536;
        let found = strongest(&spectrum(&sound, n), n, [pitch / 1.5, 1.5 * pitch]);
        println!("string {}: {found:.1} Hz, formula {pitch:.1} Hz", k + 1);
        assert!((found / pitch - 1.0).abs() < TUNED, "string {k}: {found} Hz, not {pitch} Hz");
        // And it is the strongest of the first octave below its second partial: the string's own note.
        let lowest = strongest(&spectrum(&sound, n), n, [40.0, 1.5 * pitch]);
        assert!((lowest / pitch - 1.0).abs() < TUNED, "string {k}: {lowest} Hz is stronger");
    }
}

/// The partial in which a string sings in an even wind, Hz.
fn sung(exhibit: &Exhibit, k: usize, speed: f64) -> f64 {
    let sing = instrument(exhibit, "sing", k);
    let (d, pitch) = string(exhibit, k);
    let motion = BodyMotion { parameter: (STROUHAL / d) as f32, ..BodyMotion::default() };
    let commands = [
        SoundCommand::Motion(MotionSound { sample: 0, instrument: sing, motion, pan: 0.0, distance: 1.0 }),
        SoundCommand::Wind(WindSound { instrument: sing, speed: speed as f32, ..WindSound::default() }),
    ];
    let n = 65_536;
    let sound = rendered(exhibit, &commands, 2.0);
    strongest(&spectrum(&sound, n), n, [0.5 * pitch, 20.0 * pitch])
}

#[test]
fn a_growing_wind_takes_one_harmonic_after_the_other() {
    /// Of a partial's frequency: its stiffness, and the width of a decaying partial.
    const TUNED: f64 = 0.01;
    let exhibit = harp();
    for k in 0..STRINGS {
        let (d, pitch) = string(&exhibit, k);
        for harmonic in 1..=5 {
            let target = f64::from(harmonic) * pitch;
            let found = sung(&exhibit, k, target * d / STROUHAL);
            assert!((found / target - 1.0).abs() < TUNED, "string {}: {found} Hz, not {target} Hz", k + 1);
        }
    }
    // Between two harmonics it is one of the two, whatever the wind.
    let (d, pitch) = string(&exhibit, 2);
    let mut last = 0.0;
    for quarter in 4..20 {
        let shed = 0.25 * f64::from(quarter) * pitch;
        let found = sung(&exhibit, 2, shed * d / STROUHAL);
        let number = (found / pitch).round();
        println!("vortices at {shed:.0} Hz: sings at {found:.0} Hz, harmonic {number}");
        assert!((found / (number * pitch) - 1.0).abs() < TUNED, "{found} Hz is no harmonic of {pitch} Hz");
        assert!((found - shed).abs() < pitch, "{found} Hz, vortices {shed} Hz");
        assert!(number >= last, "harmonic {number} after {last}");
        last = number;
    }
    assert!(last >= 4.0, "it climbed to harmonic {last}");
}

#[test]
fn a_childs_breath_makes_it_sing_at_once_and_moves_its_feathers() {
    /// From the breath's arrival at the lips, s.
    const AT_ONCE: f64 = 0.5;
    /// Level of the loudest 50 ms, of full scale: 20 dB above what a quiet room hides.
    const AUDIBLE: f64 = 1e-3;
    /// Way of the most moved feather's centre, m: the gap before its string is 8 mm at the bead.
    const SEEN: f64 = 4e-3;
    let exhibit = harp();
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let mut synth = Synth::new(RATE, &exhibit.instruments, 1).expect("checked timbres");
    let feathers: Vec<usize> =
        (0..exhibit.bodies.len()).filter(|&i| exhibit.bodies[i].name.starts_with("Plectrum")).collect();
    let [mut before, mut after] = [0.0_f64; 2];
    let mut block = vec![0.0; 400];
    let mut moved: f64 = 0.0;
    let mut from: Vec<DVec3> = Vec::new();
    for step in 0..steps(2.0 + AT_ONCE) {
        let blows = step >= steps(2.0);
        let commands = [Command::Blow(blows.then_some(CHILD))];
        let pointer = Some([0.5, 0.45]);
        simulation.step(&StepInput { commands: &commands, pointer, ..StepInput::default() });
        simulation.sounds().iter().for_each(|command| synth.command(*command));
        synth.render(&mut block);
        let level = (block.iter().map(|x| f64::from(x * x)).sum::<f64>() / 400.0).sqrt();
        let most = if blows { &mut after } else { &mut before };
        *most = most.max(level);
        let places = feathers.iter().map(|&i| simulation.bodies()[i].position);
        if blows {
            moved = places.zip(&from).map(|(now, before)| now.distance(*before)).fold(moved, f64::max);
        } else {
            from = places.collect();
        }
    }
    println!("before {before:.1e}, after {after:.1e} of full scale; a feather moves {:.1} mm", 1e3 * moved);
    assert!(moved > SEEN, "{moved} m");
    assert!(after > AUDIBLE && after > 10.0 * before, "{before} before the breath, {after} in it");
}

#[test]
fn a_hand_that_lifts_a_feather_and_lets_go_plucks_its_string() {
    let exhibit = harp();
    for k in 0..STRINGS {
        let struck = plucked(&exhibit, k);
        println!("string {}: {} strikes", k + 1, struck.len());
        assert!(!struck.is_empty(), "string {} is mute", k + 1);
        let own = instrument(&exhibit, "pluck", k);
        assert!(struck.iter().all(|strike| strike.instrument == own), "string {}: {struck:?}, not {own} alone", k + 1);
    }
}
