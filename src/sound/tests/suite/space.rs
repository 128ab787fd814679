//! The room: it decays as asked, densely, without ringing, and the same for any block.

use soffio_fourier::{Complex, real_forward, real_inverse};
use soffio_math::noise::Random;
use soffio_math::{amplitude_to_db, db_to_amplitude, ln};
use soffio_sound::{BANDS, Reverb, ReverbSpec};

const RATE: u32 = 48_000;

/// The room's answer to an impulse on both sides (1 and 0 where only the left one is asked for).
fn response(spec: &ReverbSpec, impulse: [f32; 2], seconds: f64) -> [Vec<f64>; 2] {
    let mut reverb = Reverb::new(spec, f64::from(RATE)).expect("it decays");
    let mut frames = vec![[0.0; 2]; (seconds * f64::from(RATE)) as usize];
    frames[0] = impulse;
    reverb.process(&mut frames);
    [0, 1].map(|side| frames.iter().map(|frame| f64::from(frame[side])).collect())
}

fn spectrum(samples: &[f64]) -> Vec<Complex<f64>> {
    let mut input = samples.to_vec();
    let fft = real_forward(input.len());
    let mut out = fft.make_output_vec();
    fft.process(&mut input, &mut out).expect("lengths fit");
    out
}

/// One octave of a signal, by its spectrum: edges fall over a sixth of an octave.
fn octave(samples: &[f64], centre: f64) -> Vec<f64> {
    // Silence behind, so that nothing wraps around.
    let mut padded = samples.to_vec();
    padded.resize(2 * samples.len(), 0.0);
    let mut bins = spectrum(&padded);
    for (i, bin) in bins.iter_mut().enumerate() {
        let frequency = i as f64 * f64::from(RATE) / padded.len() as f64;
        let off = (amplitude_to_db(frequency.max(1e-9) / centre) / amplitude_to_db(2.0)).abs();
        *bin *= ((0.583 - off) * 6.0).clamp(0.0, 1.0);
    }
    let (first, last) = (0, bins.len() - 1);
    (bins[first].im, bins[last].im) = (0.0, 0.0);
    let fft = real_inverse(padded.len());
    fft.process(&mut bins, &mut padded).expect("lengths fit");
    let scale = 1.0 / padded.len() as f64;
    padded.iter_mut().for_each(|x| *x *= scale);
    padded.truncate(samples.len());
    padded
}

/// Decay by 60 dB, s: the line through Schroeder's backward integral between −5 and −35 dB (ISO 3382: T30).
fn t60(samples: &[f64]) -> f64 {
    let mut left: Vec<f64> = samples.iter().map(|x| x * x).collect();
    for i in (0..left.len() - 1).rev() {
        left[i] += left[i + 1];
    }
    let level = |i: usize| 0.5 * amplitude_to_db(left[i] / left[0]);
    let (from, to) = ((0..left.len()).find(|&i| level(i) < -5.0), (0..left.len()).find(|&i| level(i) < -35.0));
    let (from, to) = (from.expect("it decays"), to.expect("it decays by 35 dB"));
    // Least squares over every tenth of a millisecond.
    let points: Vec<(f64, f64)> = (from..to).step_by(5).map(|i| (i as f64 / f64::from(RATE), level(i))).collect();
    let n = points.len() as f64;
    let (sx, sy) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0, y + p.1));
    let (mx, my) = (sx / n, sy / n);
    let (sxy, sxx) =
        points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - mx) * (p.1 - my), xx + (p.0 - mx) * (p.0 - mx)));
    -60.0 * sxx / sxy
}

/// Rooms as different as the configuration allows, and random ones.
fn rooms() -> Vec<(String, ReverbSpec)> {
    let mut rooms = vec![
        ("gallery".to_owned(), ReverbSpec::GALLERY),
        ("even".to_owned(), ReverbSpec { level_db: 0.0, t60: [1.0; 7] }),
        ("stone".to_owned(), ReverbSpec { level_db: 0.0, t60: [4.5, 4.6, 4.4, 4.0, 3.2, 2.3, 1.5] }),
        ("cabinet".to_owned(), ReverbSpec { level_db: 0.0, t60: [0.45, 0.4, 0.35, 0.35, 0.3, 0.3, 0.28] }),
        ("glass".to_owned(), ReverbSpec { level_db: 0.0, t60: [0.9, 1.1, 1.3, 1.5, 1.6, 1.4, 1.15] }),
    ];
    let mut random = Random::new(17);
    for i in 0..3 {
        let mut t = random.range(0.4, 3.0);
        let t60 = std::array::from_fn(|_| {
            t = (t * random.range(1.0 / 1.2, 1.2)).clamp(0.3, 4.5);
            t
        });
        rooms.push((format!("seed 17, {i}"), ReverbSpec { level_db: 0.0, t60 }));
    }
    rooms
}

#[test]
fn every_octave_decays_in_the_time_asked_for() {
    // The ear notices a change of some 5 %. The filters are exact at the centre of the octave; what lives longer at one end
    // of it is heard longer than the rest, and the tail of an octave of few modes spreads by some per cent.
    const TOLERANCE: f64 = 0.1;
    for (name, spec) in rooms() {
        let longest = spec.t60.iter().fold(0.0f64, |a, &b| a.max(b));
        let [left, right] = response(&spec, [1.0, 1.0], 1.3 * longest + 0.3);
        for (band, wanted) in BANDS.iter().zip(spec.t60) {
            for side in [&left, &right] {
                let measured = t60(&octave(side, *band));
                println!(
                    "{name}, {band} Hz: {measured:.3} s for {wanted:.3} s ({:+.1} %)",
                    100.0 * (measured / wanted - 1.0)
                );
                assert!((measured / wanted - 1.0).abs() < TOLERANCE, "{name}, {band} Hz: {measured} s, not {wanted} s");
            }
            let designed = spec.decay(*band, RATE);
            assert!(
                (designed / wanted - 1.0).abs() < 1e-6,
                "{name}, {band} Hz: built for {designed} s, not {wanted} s"
            );
        }
    }
}

#[test]
fn its_level_is_what_was_asked_for() {
    // Both sides of one tail, against the sound that went in, in the octave of 1 kHz: within what two tails differ by.
    const TOLERANCE_DB: f64 = 1.0;
    for (level_db, impulse) in [(-8.0, [1.0, 1.0]), (0.0, [1.0, 0.0]), (-20.0, [0.0, 1.0])] {
        let spec = ReverbSpec { level_db, ..ReverbSpec::GALLERY };
        let energy = |x: &[f64]| octave(x, 1000.0).iter().map(|x| x * x).sum::<f64>();
        let direct = energy(&{
            let mut click = vec![0.0; RATE as usize];
            click[100] = 1.0;
            click
        });
        let went_in = impulse.iter().map(|x| f64::from(x * x)).sum::<f64>();
        for side in response(&spec, impulse, 2.0) {
            let db = 0.5 * amplitude_to_db(energy(&side) / (direct * went_in));
            assert!((db - level_db).abs() < TOLERANCE_DB, "{db} dB, not {level_db} dB, for {impulse:?}");
        }
    }
}

/// Echoes as dense as noise are 1: how many samples of 20 ms lie beyond their standard deviation, over what of normal
/// noise does (Abel and Huang, 121st AES Convention, 2006).
fn echo_density(samples: &[f64], at: f64) -> f64 {
    const BEYOND: f64 = 0.317_310_5;
    let from = (at * f64::from(RATE)) as usize;
    let window = &samples[from - 480..from + 480];
    let deviation = (window.iter().map(|x| x * x).sum::<f64>() / window.len() as f64).sqrt();
    window.iter().filter(|x| x.abs() > deviation).count() as f64 / window.len() as f64 / BEYOND
}

#[test]
fn echoes_are_soon_as_dense_as_noise() {
    // Rooms mix in 50 to 150 ms; 20 ms of noise that is dull like the tail vary by ± 0.1.
    const DENSE: f64 = 0.85;
    let [left, right] = response(&ReverbSpec::GALLERY, [1.0, 1.0], 1.0);
    for side in [&left, &right] {
        let level_history: Vec<String> =
            (1..12).map(|i| format!("{:.2}", echo_density(side, 0.02 * f64::from(i) + 0.01))).collect();
        println!("echo density every 20 ms from 30 ms on: {}", level_history.join(" "));
        for i in 0..20 {
            let at = 0.12 + 0.02 * f64::from(i);
            assert!(echo_density(side, at) > DENSE, "at {at} s: {}", echo_density(side, at));
        }
    }
}

/// Geometric over arithmetic mean of a power spectrum, each tenth of an octave by itself so that its slope does not count:
/// e^−γ = 0.561 for noise, less for sound at single frequencies. Between 300 Hz and 10 kHz.
fn flatness(samples: &[f64]) -> f64 {
    let bins = spectrum(samples);
    let bin = |frequency: f64| (frequency * samples.len() as f64 / f64::from(RATE)) as usize;
    let (mut edge, mut sum, mut count) = (300.0, 0.0, 0.0);
    while edge < 10_000.0 {
        let next = edge * db_to_amplitude(amplitude_to_db(2.0) / 10.0);
        let power: Vec<f64> = bins[bin(edge)..bin(next)].iter().map(Complex::norm_sqr).collect();
        let n = power.len() as f64;
        let geometric = power.iter().map(|p| ln(p.max(1e-30))).sum::<f64>() / n;
        sum += n * (geometric - ln(power.iter().sum::<f64>() / n));
        count += n;
        edge = next;
    }
    soffio_math::exp(sum / count)
}

#[test]
fn the_tail_does_not_ring_at_single_frequencies() {
    // Noise of this length gives 0.56 ± 0.01; a comb, what a bad network sounds like, falls far below. In a room of many
    // seconds a mode is narrower than the 0.7 modes a hertz lie apart, which is heard as the size of the room.
    const NOISY: f64 = 0.47;
    const NOISY_FOR_SECONDS: f64 = 0.42;
    for (name, spec) in rooms() {
        let [left, right] = response(&spec, [1.0, 1.0], 1.2);
        for side in [&left, &right] {
            // Half a second from 0.15 s on, levelled against its own decay so that all of it counts alike.
            let part: Vec<f64> = side[7200..31_200].to_vec();
            let flat = flatness(&part);
            println!("{name}: flatness {flat:.3}");
            let least = if spec.t60[3] < 2.0 { NOISY } else { NOISY_FOR_SECONDS };
            assert!(flat > least, "{name}: {flat}");
        }
    }
    let comb: Vec<f64> =
        (0..24_000).map(|n| if n % 97 == 0 { soffio_math::exp(-f64::from(n) / 9000.0) } else { 0.0 }).collect();
    assert!(flatness(&comb) < 0.3, "a comb: {}", flatness(&comb));
}

#[test]
fn the_two_sides_are_not_alike() {
    // Correlation of diffuse sound at two far places is 0; of 1 s of it, within about 0.05.
    const ALIKE: f64 = 0.15;
    let [left, right] = response(&ReverbSpec::GALLERY, [1.0, 1.0], 1.0);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let correlation = dot(&left, &right) / (dot(&left, &left) * dot(&right, &right)).sqrt();
    assert!(correlation.abs() < ALIKE, "{correlation}");
}

#[test]
fn it_stays_finite_forgets_and_sleeps() {
    let spec = ReverbSpec { level_db: 0.0, t60: [2.0; 7] };
    let mut reverb = Reverb::new(&spec, f64::from(RATE)).expect("it decays");
    let mut random = Random::new(3);
    // Far beyond full scale, and what a broken voice might say.
    let said = |n: u32| match n % 1000 {
        0 => f32::NAN,
        1 => f32::INFINITY,
        2 => f32::MAX,
        _ => 10.0 * random.signed() as f32,
    };
    let mut frames: Vec<[f32; 2]> = (0..RATE).map(said).map(|x| [x, -x]).collect();
    reverb.process(&mut frames);
    assert!(frames.as_flattened().iter().all(|y| y.is_finite()));
    assert!(frames.as_flattened().iter().any(|y| y.abs() > 1.0));
    // 240 dB and more: then exactly nothing, at once again when nothing comes, and as new when something does.
    let mut silence = vec![[0.0; 2]; RATE as usize * 15];
    reverb.process(&mut silence);
    let silent = silence.iter().filter(|frame| **frame == [0.0; 2]).count();
    assert!(silent > 3 * RATE as usize, "it never became silent");
    let mut new = Reverb::new(&spec, f64::from(RATE)).expect("it decays");
    let energy = [&mut reverb, &mut new].map(|reverb| {
        let mut frames = vec![[0.0; 2]; RATE as usize];
        frames[0] = [1.0, 0.0];
        reverb.process(&mut frames);
        frames.as_flattened().iter().map(|y| f64::from(y * y)).sum::<f64>()
    });
    assert!(energy[0] == energy[1] && energy[0] > 0.0, "{energy:?}");
}

#[test]
fn its_energy_falls_from_window_to_window() {
    let [left, right] = response(&ReverbSpec::GALLERY, [1.0, 0.0], 2.0);
    // From 0.1 s on in windows of 50 ms, −1.9 dB each at 1.6 s; none may be louder than the one before by more than a dB.
    let levels: Vec<f64> = (2..38)
        .map(|i| {
            let window = |side: &[f64]| side[i * 2400..(i + 1) * 2400].iter().map(|x| x * x).sum::<f64>();
            0.5 * amplitude_to_db(window(&left) + window(&right))
        })
        .collect();
    assert!(levels.windows(2).all(|w| w[1] < w[0] + 1.0), "{levels:?}");
    assert!(levels[levels.len() - 1] < levels[0] - 50.0, "{levels:?}");
}

#[test]
fn rooms_that_cannot_be_are_refused_by_their_octave() {
    let with = |band: usize, t: f64| {
        let mut spec = ReverbSpec::GALLERY;
        spec.t60[band] = t;
        (spec.problem(), Reverb::new(&spec, f64::from(RATE)).is_some())
    };
    assert_eq!(ReverbSpec::GALLERY.problem(), None);
    for (band, t, says) in
        [(0, 0.0, "125 Hz"), (3, 9.0, "1000 Hz"), (6, f64::NAN, "8000 Hz"), (4, 0.5, "from 1000 to 2000 Hz")]
    {
        let (problem, built) = with(band, t);
        assert!(!built && problem.as_ref().is_some_and(|p| p.contains(says)), "{band}: {t}: {problem:?}");
    }
    // Every rate a device may have.
    for rate in [8_000, 22_050, 44_100, 48_000, 96_000, 192_000] {
        assert!(Reverb::new(&ReverbSpec::GALLERY, f64::from(rate)).is_some(), "{rate} Hz");
    }
}

#[test]
fn it_does_not_matter_how_frames_are_cut() {
    // Every chunk of the inner loop, sleep and waking, whole seconds beside single frames.
    let spec = ReverbSpec { level_db: 0.0, t60: [0.2; 7] };
    let mut random = Random::new(11);
    let mut frames = vec![[0.0f32; 2]; 4 * RATE as usize];
    for (n, frame) in frames.iter_mut().enumerate() {
        // A clap of 10 ms each second but one: at −1200 dB/s it is silent between them.
        if n % (2 * RATE as usize) < 480 {
            *frame = [random.signed() as f32, random.signed() as f32];
        }
    }
    for rate in [48_000.0, 8_000.0] {
        let [mut whole, mut cut] = [frames.clone(), frames.clone()];
        Reverb::new(&spec, rate).expect("it decays").process(&mut whole);
        let mut reverb = Reverb::new(&spec, rate).expect("it decays");
        let mut rest = &mut cut[..];
        while !rest.is_empty() {
            let n = (1 + (random.unit() * 40.0) as usize).min(rest.len());
            let (now, later) = rest.split_at_mut(n);
            reverb.process(now);
            rest = later;
        }
        let bits = |frames: &[[f32; 2]]| frames.as_flattened().iter().map(|y| y.to_bits()).collect::<Vec<_>>();
        assert!(bits(&whole) == bits(&cut), "at {rate} Hz");
        assert!(whole.iter().filter(|frame| **frame == [0.0; 2]).count() > RATE as usize / 10, "it never slept");
    }
}
