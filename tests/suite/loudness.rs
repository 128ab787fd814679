//! How loud the kiosk is and may be: true peaks, onsets, the night, repetition, the A-weighted level, the visitor's steps.

use std::path::Path;

use ebur128::{EbuR128, Mode};
use fearless_simd::Level;
use soffio_config::{Config, Hours, TimeOfDay};
use soffio_math::noise::Random;
use soffio_math::{PI, StateHash, amplitude_to_db, db_to_amplitude, sin};
use soffio_sound::modal::fuses;
use soffio_sound::{
    AWeighting, CEILING, Exposure, InstrumentSpec, LoudnessMeter, ONSET_CEILING, PROGRAMME, Preset, ReverbSpec,
    SoundBody, SoundCommand, SoundMaterial, Strike, Synth, Volume, VolumeSettings, weighted_level,
};

const RATE: u32 = 48_000;

/// One partial of so many Hz that lasts so long, s; a hit of 1 mN s at 1 m is about full scale with a gain of 1,000.
fn synth(frequency: f64, t60: f64, gain: f64) -> Synth {
    let text = format!(
        "timbre = 1\nname = \"one\"\ndescription = \"\"\n[node.out]\ntype = \"modal\"\nfrom = \"table\"\n\
         fundamental = {frequency}\ncontact_radius = 0.003\ntable = [{{ ratio = 1.0, gain = 1.0, t60 = {t60} }}]\ngain = 1000\n"
    );
    let preset = Preset::parse("one", &text).expect("a valid preset");
    let material = SoundMaterial { youngs_modulus: 2e11, poisson: 0.3, density: 7850.0, loss_factor: 6e-4 };
    let body = SoundBody { half_extents: [0.06; 2], thickness: 5e-4, area: 0.0113, mass: 0.044 };
    let spec = InstrumentSpec { timbre: "one".into(), own: None, body, material, surface: None, gain, max_voices: 8 };
    Synth::with_preset(RATE, &preset, &spec, 1).expect("compiles")
}

fn strike(sample: u64, impulse: f32) -> SoundCommand {
    let position = [0.5, 0.1];
    SoundCommand::Strike(Strike {
        sample,
        instrument: 0,
        impulse,
        speed: 1.0,
        mass: 0.002,
        position,
        pan: 0.0,
        distance: 1.0,
    })
}

fn render(synth: &mut Synth, frames: usize) -> Vec<f32> {
    let mut out = vec![0.0; 2 * frames];
    synth.render(&mut out);
    out
}

fn peak(samples: &[f32]) -> f64 {
    f64::from(samples.iter().fold(0.0f32, |m, s| m.max(s.abs())))
}

/// As another meter measures it, the one of EBU R 128.
fn true_peak(samples: &[f32]) -> f64 {
    let mut meter = EbuR128::new(2, RATE, Mode::TRUE_PEAK).expect("a meter");
    meter.add_frames_f32(samples).expect("stereo");
    (0..2).map(|side| meter.true_peak(side).expect("a peak")).fold(0.0, f64::max)
}

#[test]
fn no_true_peak_passes_minus_one_decibel() {
    // A quarter of the rate, between whose samples the wave is 3 dB higher than they are, and others.
    for frequency in [997.0, 5_000.0, 11_999.0, 12_000.0, 15_500.0] {
        let mut synth = synth(frequency, 5.0, 1.0);
        for i in 0..8 {
            synth.command(strike(i * 4_801, 0.05));
        }
        let out = render(&mut synth, RATE as usize);
        let (samples, wave) = (amplitude_to_db(peak(&out)), amplitude_to_db(true_peak(&out)));
        println!("{frequency} Hz: samples {samples:.2} dBFS, wave {wave:.2} dBTP");
        assert!(wave <= -1.0 && wave > -2.5, "{frequency} Hz: {wave} dBTP");
    }
    // Noise of bursts, through wind-like crackle: hits of every strength at once.
    let mut random = Random::new(8);
    let mut synth = synth(3_000.0, 0.05, 1.0);
    for _ in 0..900 {
        synth.command(strike(random.range(0.0, 96_000.0) as u64, random.range(0.001, 0.3) as f32));
    }
    let out = render(&mut synth, 2 * RATE as usize);
    assert!(true_peak(&out) <= CEILING, "{} dBTP", amplitude_to_db(true_peak(&out)));
}

#[test]
fn nothing_breaks_a_silence_at_full_loudness() {
    // A bang 40 dB above full scale after 0.3 s of silence. What may come at once is ONSET_CEILING; from there 80 dB/s.
    const RATE_DB: f64 = 80.0;
    // The envelope is read in windows of 1 ms, and the look-ahead is 1.6 ms.
    const SLACK_DB: f64 = 0.3;
    let mut synth = synth(700.0, 8.0, 100.0);
    synth.command(strike(14_400, 0.02));
    let out = render(&mut synth, 2 * RATE as usize);
    let onset = out.iter().position(|s| s.abs() > 1e-3).expect("a bang") / 2;
    let loudest = |ms: usize| amplitude_to_db(peak(&out[2 * (onset + 48 * ms)..2 * (onset + 48 * (ms + 1))]));
    for ms in 0..200 {
        let most = (amplitude_to_db(ONSET_CEILING) + RATE_DB * (ms as f64 + 3.0) / 1000.0).min(-1.0) + SLACK_DB;
        assert!(loudest(ms) < most, "{ms} ms after the onset: {} dB, at most {most}", loudest(ms));
    }
    let (at_once, later) =
        (amplitude_to_db(peak(&out[2 * onset..2 * (onset + 576)])), amplitude_to_db(peak(&out[2 * (onset + 7200)..])));
    println!("a bang: {at_once:.1} dBFS in its first 12 ms, {later:.1} dBFS later");
    assert!(later > -2.5, "it gets there in the end: {later}");
    // What is not loud comes as it is.
    let mut soft = self::synth(700.0, 8.0, 1.0);
    let mut dry = self::synth(700.0, 8.0, 1.0);
    dry.set_dry(true);
    for synth in [&mut soft, &mut dry] {
        synth.command(strike(100, 1e-4));
    }
    let latency = soft.latency();
    let (soft, dry) = (render(&mut soft, 4_800), render(&mut dry, 4_800));
    assert!(peak(&dry) > 0.03 && peak(&dry) < 0.5 * ONSET_CEILING, "{}", peak(&dry));
    assert_eq!(soft[2 * latency..], dry[..dry.len() - 2 * latency]);
}

#[test]
fn the_night_is_lower_closer_together_and_softer_at_the_top() {
    let level = |frequency: f64, impulse: f32, night: bool| {
        let mut synth = synth(frequency, 60.0, 1.0);
        synth.set_night(night);
        synth.command(strike(0, impulse));
        let out = render(&mut synth, RATE as usize);
        let tail = &out[RATE as usize..];
        0.5 * amplitude_to_db(tail.iter().map(|s| f64::from(s * s)).sum::<f64>() / tail.len() as f64)
    };
    let change = |frequency: f64, impulse: f32| level(frequency, impulse, true) - level(frequency, impulse, false);
    // Soft and low: the level alone, −8 dB, and a little of the shelf's foot.
    let soft = change(300.0, 2e-5);
    assert!((soft + 8.0).abs() < 0.5, "{soft} dB");
    // Three times as much by day is a third of the step, in dB, above the threshold by night.
    let by_day = level(300.0, 1.5e-4, false) - level(300.0, 5e-5, false);
    let by_night = level(300.0, 1.5e-4, true) - level(300.0, 5e-5, true);
    assert!((by_day - amplitude_to_db(3.0)).abs() < 0.1, "by day nothing is compressed: {by_day} dB");
    println!("night: soft {soft:.2} dB; three times as much is {by_day:.2} dB by day and {by_night:.2} dB by night");
    assert!((by_night / by_day - 1.0 / 3.0).abs() < 0.05, "{by_day} dB by day, {by_night} dB by night");
    // The shelf, −9 dB, as far as 10 kHz lies above its corner of 2.5 kHz.
    let bright = change(10_000.0, 2e-5) - soft;
    assert!((-9.5..-7.0).contains(&bright), "{bright} dB");
}

#[test]
fn day_becomes_night_and_day_again_without_a_step() {
    let mut synth = synth(440.0, 60.0, 1.0);
    synth.command(strike(0, 2e-4));
    let mut out = render(&mut synth, RATE as usize);
    synth.set_night(true);
    out.extend(render(&mut synth, 4 * RATE as usize));
    synth.set_night(false);
    out.extend(render(&mut synth, 4 * RATE as usize));
    // Loudest of each 10 ms: neighbours differ by the glide of some 10 dB in 2 s and the decay, never by a step.
    let peaks: Vec<f64> = out[4_800..].chunks(960).map(peak).collect();
    let step = peaks.windows(2).map(|w| amplitude_to_db(w[1] / w[0]).abs()).fold(0.0, f64::max);
    assert!(step < 0.3, "a step of {step} dB");
    let (day, night) = (peaks[50], peaks[450]);
    assert!(amplitude_to_db(night / day) < -8.0, "{} dB", amplitude_to_db(night / day));
}

#[test]
fn a_tick_eases_down_with_repetition() {
    let mut synth = synth(2_000.0, 0.05, 1.0);
    let mut loudest = Vec::new();
    for second in 0..300u64 {
        for half in 0..2 {
            synth.command(strike(second * 48_000 + half * 24_000 + 100, 1e-4));
        }
        loudest.push(peak(&render(&mut synth, RATE as usize)));
    }
    let eased = amplitude_to_db(loudest[299] / loudest[0]);
    println!("ticks of half a second after 5 minutes: {eased:.1} dB");
    assert_eq!(loudest[20], loudest[0], "the first ones are as they are");
    // After 5 minutes the count is 240 (1 − e^(−2.5)) = 220: −5.6 dB.
    assert!((eased + 5.6).abs() < 0.3, "{eased} dB");
}

/// A second of hits in a room.
fn in_a_room(block: usize) -> Vec<f32> {
    let mut synth = synth(900.0, 0.5, 1.0);
    synth.set_reverb(Some(&ReverbSpec::GALLERY));
    synth.set_night(true);
    let mut random = Random::new(12);
    for _ in 0..30 {
        synth.command(strike(random.range(0.0, 40_000.0) as u64, random.range(1e-4, 3e-2) as f32));
    }
    let mut out = Vec::new();
    while out.len() < 2 * RATE as usize {
        let frames = block.min(RATE as usize - out.len() / 2);
        out.extend(render(&mut synth, frames));
    }
    out
}

#[test]
fn room_and_night_do_not_depend_on_blocks() {
    let whole = in_a_room(RATE as usize);
    assert!(peak(&whole) > 0.05);
    for block in [1, 17, 64, 480, 1024] {
        assert!(in_a_room(block) == whole, "block of {block}");
    }
}

#[test]
fn a_room_has_the_same_bits_in_every_build() {
    let mut hash = StateHash::default();
    in_a_room(512).iter().for_each(|s| hash.add(f64::from(*s)));
    println!("hash {:#x}", hash.0);
    let golden = if fuses(Level::new()) { FUSED } else { ROUNDED_TWICE };
    assert_eq!(hash.0, golden, "the sound of a room changed: listen, then store the new hash");
}

/// Hash of the second of hits, equal in debug and release: where the processor fuses multiply-adds, and where not.
const FUSED: u64 = 0x6c7d_6861_8ba2_6a59;
const ROUNDED_TWICE: u64 = 0xa50b_3936_31b8_cdcc;

#[test]
fn a_room_adds_its_tail_and_keeps_the_sound_itself() {
    let mut with = synth(900.0, 0.05, 1.0);
    with.set_reverb(Some(&ReverbSpec::GALLERY));
    let mut without = synth(900.0, 0.05, 1.0);
    for synth in [&mut with, &mut without] {
        synth.command(strike(0, 2e-4));
    }
    let (with, without) = (render(&mut with, RATE as usize), render(&mut without, RATE as usize));
    // The first line is 21 ms long: until then there is no room.
    assert_eq!(with[..2 * 1_000], without[..2 * 1_000]);
    let late = 2 * 24_000;
    assert!(amplitude_to_db(peak(&with[late..]) / peak(&without[..late])) > -60.0, "no tail");
    assert!(peak(&without[late..]) == 0.0, "the body alone is over by then");
}

#[test]
fn the_a_weighting_is_the_standards() {
    // IEC 61672-1:2013, table 3: frequency, weighting, class 1 limits (dB).
    let table = [
        (31.5, -39.4, 1.5, 1.5),
        (63.0, -26.2, 1.0, 1.0),
        (125.0, -16.1, 1.0, 1.0),
        (250.0, -8.6, 1.0, 1.0),
        (500.0, -3.2, 1.0, 1.0),
        (1000.0, 0.0, 0.7, 0.7),
        (2000.0, 1.2, 1.0, 1.0),
        (4000.0, 1.0, 1.0, 1.0),
        (8000.0, -1.1, 1.5, 2.5),
        (16_000.0, -6.6, 2.5, 16.0),
    ];
    for rate in [44_100.0, 48_000.0, 96_000.0] {
        for (frequency, wanted, above, below) in table {
            let mut weighting = AWeighting::new(rate);
            let by_formula = amplitude_to_db(weighting.magnitude(frequency, rate));
            let frames = rate as usize;
            let mut power = 0.0;
            for n in 0..2 * frames {
                let x = sin(2.0 * PI * frequency * n as f64 / rate) as f32;
                let p = weighting.power([x, x]);
                power += if n >= frames { p } else { 0.0 };
            }
            let measured = weighted_level(power / frames as f64);
            assert!((measured - by_formula).abs() < 0.05, "{frequency} Hz at {rate}: {measured} and {by_formula} dB");
            let error = measured - wanted;
            assert!((-below..=above).contains(&error), "{frequency} Hz at {rate}: {measured} dB, {wanted} dB wanted");
        }
    }
}

#[test]
fn the_mean_of_a_day_is_a_mean_of_energies_and_ends_at_midnight() {
    let mut exposure = Exposure::default();
    let power = |db: f64| 0.5 * db_to_amplitude(2.0 * db);
    // An hour at −20 dB and three of silence: a quarter of the energy, −26.02 dB.
    for _ in 0..3600 {
        exposure.note(power(-20.0), 1.0, 7);
    }
    assert!((exposure.minute() + 20.0).abs() < 1e-6 && (exposure.day() + 20.0).abs() < 1e-6);
    for _ in 0..3 * 3600 {
        exposure.note(0.0, 1.0, 7);
    }
    assert!((exposure.day() + 26.0206).abs() < 1e-3, "{}", exposure.day());
    assert!(exposure.minute() < -200.0, "the minute forgets");
    exposure.note(f64::NAN, 1.0, 7);
    exposure.note(power(-30.0), 1.0, 8);
    assert!((exposure.day() + 30.0).abs() < 1e-6, "a new day: {}", exposure.day());
}

fn settings() -> VolumeSettings {
    VolumeSettings { default_db: -6.0, step_db: 3.0, steps: 3, full_scale_db_spl: None, max_laeq_db: 70.0 }
}

#[test]
fn a_visitor_has_steps_and_the_next_one_finds_the_default() {
    let mut volume = Volume::new(settings());
    assert_eq!(volume.db(), -6.0);
    volume.step(-1);
    assert_eq!(volume.db(), -9.0);
    volume.step(-9);
    assert_eq!((volume.steps(), volume.db()), (-3, -15.0));
    volume.step(i32::MAX);
    volume.step(1);
    // Three steps up would be +3 dB; full scale is the end, and a step down is heard at once.
    assert!(volume.db() <= 0.0, "{}", volume.db());
    let loudest = volume.db();
    volume.step(-1);
    assert!(volume.db() < loudest);
    volume.toggle_mute();
    volume.reset();
    assert_eq!((volume.steps(), volume.db(), volume.is_muted()), (0, -6.0, true), "a mute is the staff's");
}

#[test]
fn a_calibrated_kiosk_keeps_its_cap() {
    // 100 dB(A) at full scale: an exhibit at −23 LUFS is 77 dB(A), 7 dB too loud at a volume of 0 dB.
    let calibrated = VolumeSettings { full_scale_db_spl: Some(100.0), ..settings() };
    let mut volume = Volume::new(calibrated);
    assert!((volume.cap_db() - (70.0 - 100.0 - PROGRAMME)).abs() < 1e-12);
    for _ in 0..9 {
        volume.step(1);
    }
    assert_eq!(volume.db(), volume.cap_db());
    assert_eq!(volume.spl(PROGRAMME + volume.db()), Some(70.0));
    volume.step(-1);
    assert!(volume.db() < volume.cap_db(), "a step down is heard at once");
    // A minute at 76 dB(A): 6 dB too much are gone after 12 s, and come back slowly.
    (0..12).for_each(|_| volume.apply_exposure_limit(-24.0, 1.0));
    assert_eq!(volume.attenuation_db(), 6.0);
    (0..60).for_each(|_| volume.apply_exposure_limit(-40.0, 1.0));
    assert!((volume.attenuation_db() - 3.0).abs() < 1e-9, "{}", volume.attenuation_db());
    // Without a calibration nobody knows what is too loud.
    let mut unknown = Volume::new(settings());
    unknown.apply_exposure_limit(0.0, 100.0);
    assert_eq!((unknown.attenuation_db(), unknown.cap_db(), unknown.spl(-20.0)), (0.0, 0.0, None));
}

#[test]
fn a_source_is_placed_with_equal_power_and_falls_with_distance() {
    let sides = |pan: f32, distance: f32| {
        let mut synth = synth(900.0, 0.5, 1.0);
        synth.set_dry(true);
        let SoundCommand::Strike(hit) = strike(0, 1e-4) else { unreachable!() };
        synth.command(SoundCommand::Strike(Strike { pan, distance, ..hit }));
        let out = render(&mut synth, 9_600);
        [0, 1].map(|side| out.iter().skip(side).step_by(2).map(|s| f64::from(s * s)).sum::<f64>())
    };
    let [left, right] = sides(0.0, 1.0);
    let power = left + right;
    // Rounding of f32 gains.
    const TOLERANCE: f64 = 1e-5;
    for pan in [-1.0, -0.4, 0.0, 0.7, 1.0] {
        let [l, r] = sides(pan, 1.0);
        assert!(((l + r) / power - 1.0).abs() < TOLERANCE, "pan {pan}: {l} + {r}, not {power}");
        let angle = (f64::from(pan) + 1.0) * PI / 4.0;
        assert!((r / (l + r) - sin(angle) * sin(angle)).abs() < TOLERANCE, "pan {pan}: {l}, {r}");
    }
    let far = sides(0.0, 2.0).iter().sum::<f64>();
    assert!((power / far - 4.0).abs() < 4.0 * TOLERANCE, "1/r: {power} and {far}");
}

fn problems(text: &str) -> Vec<String> {
    match Config::parse(text, Path::new("kiosk.toml")) {
        Ok(_) => Vec::new(),
        Err(error) => error.problems.iter().map(|p| format!("{}:{} {}", p.line, p.column, p.message)).collect(),
    }
}

#[test]
fn what_is_wrong_with_rooms_nights_and_chords_is_located() {
    for (text, found) in [
        ("[reverb]\nt60_s = [1, 1, 1]\n", "2:9 3 times for 7 octaves"),
        ("[reverb]\nt60_s = [1, 1, 1, 9, 1, 1, 1]\n", "2:9 9 s at 1000 Hz is outside 0.2 to 5 s"),
        ("[reverb]\nt60_s = [1, 1, 1, 2, 1, 1, 1]\n", "2:9 from 500 to 1000 Hz it changes by a factor of 2.00"),
        ("[reverb]\nname = \"cave\"\n", "2:8 unknown variant"),
        ("[night]\nfrom = \"25:00\"\n", "2:8 \"25:00\" is no time of day"),
        ("[night]\nto = \"7:00\"\n", "2:6 a night with one end"),
        ("[staff]\nchord = \"Ctrl+Alt+M\"\n", "2:9 Ctrl+Alt+M has two meanings"),
        ("[volume]\nsteps = 11\n", "2:9 `volume.steps` is 11, outside 0 to 10"),
    ] {
        let all = problems(text);
        assert!(all.len() == 1 && all[0].starts_with(found), "{text}: {all:?}");
    }
    let text =
        "[reverb]\nt60_s = [1, 1, 1.1, 1, 1, 0.9, 0.8]\nlevel_db = -12\n[night]\nfrom = \"22:00\"\nto = \"07:30\"\n";
    let config = Config::parse(text, Path::new("kiosk.toml")).expect("it is right");
    let spec = config.reverb.spec().expect("a room");
    assert_eq!((spec.level_db, spec.t60[2]), (-12.0, 1.1));
    let off = Config::parse("[reverb]\nname = \"off\"\n", Path::new("kiosk.toml")).expect("it is right");
    assert_eq!(off.reverb.spec(), None);
}

#[test]
fn a_night_goes_over_midnight() {
    let hours = |from: &str, to: &str| Hours { from: from.parse().ok(), to: to.parse().ok() };
    let at = |minutes: u16| TimeOfDay::from_minutes(minutes);
    let night = hours("22:00", "7:30");
    for (minutes, inside) in
        [(21 * 60 + 59, false), (22 * 60, true), (0, true), (449, true), (450, false), (720, false)]
    {
        assert_eq!(night.contain(at(minutes)), inside, "{}", at(minutes));
    }
    let noon = hours("12:00", "13:00");
    assert!(noon.contain(at(750)) && !noon.contain(at(780)) && !noon.contain(at(0)));
    assert!(!hours("", "").contain(at(0)) && !hours("9:00", "9:00").contain(at(540)));
    assert_eq!("7:05".parse::<TimeOfDay>().map(|t| t.to_string()), Ok("07:05".into()));
    for bad in ["", "7", "24:00", "7:60", "+7:00", "7:5x"] {
        assert!(bad.parse::<TimeOfDay>().is_err(), "{bad:?}");
    }
}

#[test]
fn a_meter_of_ebu_r128_shows_what_the_standard_says_and_the_level_is_written_in_its_place() {
    use soffio_offline::loudness::{correction, measure, write};
    // EBU Tech 3341, case 1: a sine of 1 kHz at −23 dBFS on both sides is −23.0 ± 0.1 LUFS.
    let sine: Vec<f32> = (0..20 * RATE)
        .flat_map(|n| [(db_to_amplitude(-23.0) * sin(2.0 * PI * 1000.0 * f64::from(n) / f64::from(RATE))) as f32; 2])
        .collect();
    let measured = measure(&sine, 2, RATE).expect("a meter");
    let near = |x: Option<f64>, wanted: f64| x.is_some_and(|x| (x - wanted).abs() < 0.1);
    assert!(near(measured.lufs, -23.0) && near(measured.short_term_lufs, -23.0), "{measured:?}");
    assert!(near(measured.true_peak_dbtp, -23.0), "{measured:?}");
    assert!(correction(&measured).abs() < 0.1);
    assert_eq!(correction(&measure(&[0.0; 9_600], 2, RATE).expect("a meter")), 0.0, "silence stays as it is");

    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("exhibit.toml");
    for (before, after) in [
        (
            "[scene]\nlevel = \"1 dB\" # as measured\n[credit]\n",
            "[scene]\nlevel = \"-4.5 dB\" # as measured\n[credit]\n",
        ),
        ("# a work\n[scene]\ncamera = \"c\"\n", "# a work\n[scene]\ncamera = \"c\"\nlevel = \"-4.5 dB\"\n"),
        ("schema = \"exhibit/1\"\n", "schema = \"exhibit/1\"\n\n[scene]\nlevel = \"-4.5 dB\"\n"),
    ] {
        std::fs::write(&file, before).expect("written");
        write(folder.path(), -4.5).expect("written");
        assert_eq!(std::fs::read_to_string(&file).expect("readable"), after);
    }
}

#[test]
fn a_runs_loudness_is_that_of_another_meter() {
    /// LU: both are f64; the recommendation's coefficients have thirteen digits, the other's are derived.
    const SAME: f64 = 1e-6;
    let mut random = Random::new(5);
    // Noise of many levels, silence between, cut anywhere.
    let samples: Vec<f32> = (0..12)
        .flat_map(|part| {
            let level = [0.3, 0.0, 0.02, 1e-5][part % 4];
            (0..2 * 40_001).map(|_| (level * random.signed()) as f32).collect::<Vec<f32>>()
        })
        .collect();
    let mut meter = EbuR128::new(2, RATE, Mode::I).expect("a meter");
    meter.add_frames_f32(&samples).expect("stereo");
    let expected = meter.loudness_global().expect("a loudness");
    for piece in [1, 7, 200, 4_800, 9_999] {
        let mut meter = LoudnessMeter::new();
        samples.as_chunks().0.chunks(piece).for_each(|frames| meter.push(frames));
        let own = meter.loudness();
        assert!((own - expected).abs() < SAME, "{own} LUFS in pieces of {piece}, {expected} by the other meter");
    }
    assert_eq!(LoudnessMeter::new().loudness(), f64::NEG_INFINITY);
    let mut silent = LoudnessMeter::new();
    silent.push(&[[0.0; 2]; 48_000]);
    assert_eq!(silent.loudness(), f64::NEG_INFINITY);
}
