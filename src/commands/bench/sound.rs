//! Cost of partials: one bank at each instruction set, compared with the processor's limit of multiply-adds, and the heaviest
//! scene through the whole synthesizer.

use std::hint::black_box;

use cpu_time::ThreadTime;
use fearless_simd::{Level, Simd};
use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use soffio_math::noise::Random;
use soffio_math::{PI, exp, ln, sin};
use soffio_simulation::{SAMPLE_RATE, SAMPLES_PER_STEP};
use soffio_sound::modal::{BLOCK, Bank, Partial, fuses};
use soffio_sound::{
    InstrumentSpec, Preset, Reverb, ReverbSpec, Slide, SoundBody, SoundCommand, SoundMaterial, Strike, Synth, WindSound,
};

/// Rounds of each measurement; the best is reported, as other load on the machine can only add.
const ROUNDS: usize = 5;
/// Partials of the banks.
const COUNTS: [usize; 3] = [64, 600, 6328];
/// Samples of a block of the scene.
const SCENE_BLOCK: usize = 512;
/// Seconds of the scene, and hits in each of them.
const SCENE_SECONDS: usize = 4;
const SCENE_HITS: u64 = 40;
/// The heaviest scene: name, bodies, partials of each, band in Hz.
const SCENE: [(&str, usize, usize, (f64, f64)); 5] = [
    ("chime", 24, 12, (500.0, 15_000.0)),
    ("wood", 8, 600, (80.0, 9_000.0)),
    ("drum", 4, 250, (60.0, 4_000.0)),
    ("metal", 8, 25, (300.0, 14_000.0)),
    ("bell", 4, 10, (250.0, 8_000.0)),
];

/// Continuous sounds of the scene: ambient wind, wind on wires, sliding surfaces.
const SCENE_AIR: [&str; 5] = ["wind-room", "wind-wire", "wind-wire", "wind-wire", "wind-wire"];
const SCENE_SCRAPES: [&str; 3] = ["scrape-wood", "scrape-metal", "scrape-stone"];
/// Updates of wind and slides a second, as in the simulation.
const SCENE_UPDATES: u64 = 240;

/// One bank at one level.
#[derive(Serialize)]
struct Row {
    level: String,
    partials: usize,
    /// Partials that one core plays in real time.
    partials_real_time: f64,
    /// Whether the level rounds a multiply-add once, which decides the bits.
    fused: bool,
    /// Share of the processor's multiply-adds that reach the sound: two a partial and sample.
    share_of_ceiling: f64,
}

/// The heaviest scene.
#[derive(Serialize)]
struct Scene {
    bodies: usize,
    /// Sounding partials at the end: all of them.
    partials: usize,
    /// % of one core, including hits, wind, scraping, reverberation and limiter.
    core_percent: f64,
    /// The longest block's own time, % of what it lasts.
    worst_block_percent: f64,
}

/// Cost of the reverberation.
#[derive(Serialize)]
struct RoomCost {
    /// % of one core.
    room_percent: f64,
}

/// Measures and prints.
pub fn run(json: bool) -> Outcome {
    if !json {
        println!("{:<8} {:<6} {:>9} {:>18} {:>18}", "level", "fused", "partials", "x real time", "share of ceiling");
    }
    for level in levels() {
        let ceiling = (0..ROUNDS).map(|_| multiply_adds(level)).fold(0.0, f64::max);
        for partials in COUNTS {
            let rate = (0..ROUNDS).map(|_| bank(level, partials)).fold(0.0, f64::max);
            let share_of_ceiling = 2.0 * rate * f64::from(SAMPLE_RATE) / ceiling;
            let fused = fuses(level);
            let row = Row { level: name(level), fused, partials, partials_real_time: rate, share_of_ceiling };
            if json {
                println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
            } else {
                let fused = if fused { "yes" } else { "no" };
                println!("{:<8} {fused:<6} {partials:>9} {rate:>18.0} {:>16.0} %", row.level, 100.0 * share_of_ceiling);
            }
        }
    }
    let room_percent = (0..ROUNDS).map(|_| reverb_cost()).fold(f64::INFINITY, f64::min);
    if json {
        println!("{}", serde_json::to_string(&RoomCost { room_percent }).map_err(Failure::input)?);
    } else {
        println!("reverberation: {room_percent:.2} % of a core");
    }
    let scene = scene()?;
    if json {
        println!("{}", serde_json::to_string(&scene).map_err(Failure::input)?);
    } else {
        println!(
            "heaviest scene: {} bodies, {} partials, wind, wires and scraping with reverberation: {:.2} % of a core, worst block {:.1} % of its time",
            scene.bodies, scene.partials, scene.core_percent, scene.worst_block_percent
        );
    }
    Ok(())
}

/// Instruction sets of this processor, the best first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        let mut levels = vec![best];
        let below =
            [best.as_avx2().map(Simd::level), best.as_sse4_2().map(Simd::level), best.as_sse2().map(Simd::level)];
        levels.extend(below.into_iter().flatten().filter(|level| name(*level) != name(best)));
        levels
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    vec![best]
}

/// The name of its instructions.
fn name(level: Level) -> String {
    let text = format!("{level:?}");
    text.split('(').next().unwrap_or(&text).to_lowercase()
}

/// Multiply-adds of numbers per second of thread time with nothing to read or write.
fn multiply_adds(level: Level) -> f64 {
    const ROUNDS: usize = 400_000;
    let start = ThreadTime::now();
    let (count, sum) = soffio_sound::modal::multiply_adds(level, black_box(ROUNDS));
    black_box(sum);
    count as f64 / start.elapsed().as_secs_f64()
}

fn table(count: usize, (low, high): (f64, f64), seed: u64) -> Vec<Partial> {
    let mut random = Random::new(seed);
    // So slow that all of them ring until the end.
    let mut partials: Vec<Partial> = (0..count)
        .map(|_| Partial { frequency: low * exp(random.unit() * ln(high / low)), decay: 0.2 + random.unit() })
        .collect();
    partials.sort_by(|a, b| a.decay.total_cmp(&b.decay));
    partials
}

fn bank(level: Level, count: usize) -> f64 {
    let rate = f64::from(SAMPLE_RATE);
    let mut bank = Bank::new(&table(count, (40.0, 16_000.0), 1), rate, level);
    let mut ahead = vec![0.0; Bank::look_ahead_len(1e-3, rate)];
    bank.strike(|_| 1e-3, 1e-3, BLOCK, &mut ahead);
    let blocks = 4_000_000 / (count * BLOCK) + 1;
    let mut out = [0.0; BLOCK];
    let start = ThreadTime::now();
    for _ in 0..blocks {
        bank.render(None, &mut out);
        black_box(&mut out);
    }
    (count * blocks * BLOCK) as f64 / rate / start.elapsed().as_secs_f64()
}

/// A timbre of so many partials.
fn preset(partials: &[Partial]) -> Result<Preset, Failure> {
    let mut text = String::from(
        "timbre = 1\nname = \"heavy\"\ndescription = \"\"\n[node.out]\ntype = \"modal\"\nfrom = \"table\"\n\
         fundamental = 1\ncontact_radius = 0.01\ntable = [\n",
    );
    for p in partials {
        text += &format!("{{ ratio = {:.3}, gain = 1.0, t60 = {:.3} }},\n", p.frequency, ln(1000.0) / p.decay);
    }
    Preset::parse("heavy", &(text + "]\n")).map_err(Failure::input)
}

/// Cost of the gallery reverberation, % of one core.
fn reverb_cost() -> f64 {
    let rate = f64::from(SAMPLE_RATE);
    let Some(mut reverb) = Reverb::new(&ReverbSpec::GALLERY, rate) else { return f64::NAN };
    let mut random = Random::new(1);
    let noise: Vec<f32> = (0..SAMPLE_RATE).map(|_| random.signed() as f32).collect();
    let start = ThreadTime::now();
    let mut frames: Vec<[f32; 2]> = noise.iter().map(|x| [*x, -*x]).collect();
    for step in frames.chunks_mut(SAMPLES_PER_STEP as usize) {
        reverb.process(black_box(step));
    }
    100.0 * start.elapsed().as_secs_f64() * rate / noise.len() as f64
}

/// A breath that swells and fades, and something that is drawn to and fro over each surface.
fn going_on(
    sample: u64,
    airs: std::ops::Range<usize>,
    slides: std::ops::Range<usize>,
) -> impl Iterator<Item = SoundCommand> {
    let swell = move |seconds: f64| sin(2.0 * PI * sample as f64 / f64::from(SAMPLE_RATE) / seconds) as f32;
    let (speed, gust) = (3.0 + 2.0 * swell(1.7), 0.3 * swell(0.3));
    let wind = move |instrument: usize| {
        let instrument = instrument as u16;
        SoundCommand::Wind(WindSound { sample, instrument, speed, gust, pan: 0.1, ..WindSound::default() })
    };
    let slide = move |instrument: usize| {
        SoundCommand::Slide(Slide {
            sample,
            instrument: instrument as u16,
            speed: 0.4 + 0.3 * swell(0.9),
            force: 2.0,
            position: [0.5 * swell(0.9), 0.2],
            pan: 0.0,
            distance: 1.0,
        })
    };
    airs.map(wind).chain(slides.map(slide))
}

fn scene() -> Result<Scene, Failure> {
    let material = SoundMaterial { youngs_modulus: 1e10, poisson: 0.3, density: 600.0, loss_factor: 1e-2 };
    let body = SoundBody { half_extents: [0.1, 0.05], thickness: 0.01, area: 0.02, mass: 0.12 };
    let spec =
        InstrumentSpec { timbre: "heavy".into(), own: None, body, material, surface: None, gain: 1.0, max_voices: 4 };
    let mut presets = Vec::new();
    for (_, bodies, count, band) in SCENE {
        for _ in 0..bodies {
            presets.push(preset(&table(count, band, presets.len() as u64))?);
        }
    }
    let bodies = presets.len();
    for name in SCENE_AIR.iter().chain(&SCENE_SCRAPES) {
        presets.push(Preset::shipped(name).map_err(Failure::input)?);
    }
    let airs = bodies..bodies + SCENE_AIR.len();
    let slides = airs.end..presets.len();
    let instruments: Vec<_> = presets.iter().map(|preset| (preset, &spec)).collect();
    let mut best = Scene { bodies, partials: 0, core_percent: f64::INFINITY, worst_block_percent: 0.0 };
    let lasts = SCENE_BLOCK as f64 / f64::from(SAMPLE_RATE);
    for _ in 0..ROUNDS {
        let mut synth = Synth::with_presets(SAMPLE_RATE, &instruments, 1).map_err(Failure::input)?;
        synth.set_reverb(Some(&ReverbSpec::GALLERY));
        let mut random = Random::new(1);
        let mut strike = |sample: u64, instrument: usize| {
            SoundCommand::Strike(Strike {
                sample,
                instrument: instrument as u16,
                impulse: 1e-3,
                speed: random.range(0.1, 1.0) as f32,
                mass: 0.02,
                position: [random.signed() as f32, random.signed() as f32],
                pan: random.signed() as f32,
                distance: 1.0,
            })
        };
        (0..bodies).for_each(|i| synth.command(strike(0, i)));
        let mut out = vec![0.0; 2 * SCENE_BLOCK];
        // The first blow on everything at once is not what is measured.
        synth.render(&mut out);
        let (mut all, mut worst) = (0.0, 0.0f64);
        let blocks = SCENE_SECONDS * SAMPLE_RATE as usize / SCENE_BLOCK;
        let every = u64::from(SAMPLE_RATE) / SCENE_HITS;
        for block in 0..blocks as u64 {
            let start = ThreadTime::now();
            let from = (block + 1) * SCENE_BLOCK as u64;
            for sample in from..from + SCENE_BLOCK as u64 {
                if sample % every == 0 {
                    synth.command(strike(sample, (sample / every) as usize * 7 % bodies));
                }
                if sample % (u64::from(SAMPLE_RATE) / SCENE_UPDATES) == 0 {
                    going_on(sample, airs.clone(), slides.clone()).for_each(|command| synth.command(command));
                }
            }
            synth.render(&mut out);
            let seconds = start.elapsed().as_secs_f64();
            all += seconds;
            worst = worst.max(seconds);
        }
        black_box(&out);
        let core_percent = 100.0 * all / blocks as f64 / lasts;
        if core_percent < best.core_percent {
            best.core_percent = core_percent;
            best.worst_block_percent = 100.0 * worst / lasts;
        }
        best.partials = synth.partials();
    }
    Ok(best)
}
