//! Prints figures of the synthetic breaths beside measured ones: band levels, crest, periodicity, travel, fall with distance, speed.
use soffio_math::noise::Random;
use soffio_soundscape::breath::{Breath, Manner, Person};
use soffio_soundscape::draught::Draught;
use soffio_soundscape::filters::{high_passed, low_passed, power};
use soffio_soundscape::level::band_powers;
use soffio_soundscape::microphone::Microphone;
use soffio_soundscape::statistics::quantile;
use std::time::Instant;
const R: u32 = 16_000;
fn db(x: f64) -> f64 {
    10.0 * soffio_math::log10(x.max(1e-30))
}
const BANDS: [f64; 8] = [31.0, 94.0, 203.0, 406.0, 812.0, 1625.0, 3400.0, 7000.0];
fn main() {
    for (name, dist, mic, manner) in [
        ("phone 8-20cm", (0.06, 0.2), Some((150.0, 2)), Manner::Plain),
        ("nose/near 3-6 ", (0.03, 0.06), Some((60.0, 2)), Manner::Plain),
        ("console 5-12", (0.04, 0.12), Some((60.0, 2)), Manner::Plain),
        ("kiosk 10-35", (0.1, 0.35), None, Manner::Plain),
    ] {
        let mut rows = vec![Vec::new(); 7];
        let (mut falls, mut peaks, mut clip) = (Vec::new(), Vec::new(), Vec::new());
        let mut random = Random::new(5);
        for seed in 0..40 {
            let person = [Person::Adult, Person::Child, Person::Weak][seed as usize % 3];
            let mut b = Breath::random(manner, person, dist, &mut random);
            b.angle_deg = b.angle_deg.min(5.0);
            let mut m = Microphone::random(&mut random);
            if let Some((f, o)) = mic {
                m.high_pass_hz = f;
                m.order = o;
            }
            m.offset = 0.0;
            b.microphone = m;
            let x: Vec<f64> = b.recorded(R, seed).iter().map(|x| f64::from(*x)).collect();
            let l = b.label(0.0, &b.speeds(seed));
            let part = &x[(l.arrival * 16000.0) as usize
                ..((l.end * 16000.0) as usize).max((l.arrival * 16000.0) as usize + 4000).min(x.len())];
            let p = band_powers(part, 16000.0, &BANDS);
            let low = p[0] + p[1];
            if seed < 3 {
                println!(
                    "   {:.2} {:.1} m/s {:.0} {:?}",
                    l.peak_speed,
                    b.speed,
                    db(low),
                    p.iter().map(|x| db(x / low).round()).collect::<Vec<_>>()
                );
            }
            (0..7).for_each(|i| rows[i].push(db(p[i] / low)));
            clip.push(part.iter().filter(|x| x.abs() > 0.99).count() as f64 / part.len() as f64);
            let band = low_passed(high_passed(part.to_vec(), 16000.0, 20.0, 2), 16000.0, 200.0, 2);
            let env: Vec<f64> = band.chunks(320).map(|c| db(power(c))).collect();
            for i in 12..env.len() {
                falls.push(env[i - 12..=i].iter().copied().fold(-300.0, f64::max) - env[i]);
            }
            // autocorrelation
            for f in part.chunks(1600).filter(|f| f.len() == 1600) {
                let e = power(f) * f.len() as f64;
                let best = (40..200)
                    .map(|lag| {
                        f[lag..].iter().zip(f).map(|(a, b)| a * b).sum::<f64>() / e * 1600.0 / (1600.0 - lag as f64)
                    })
                    .fold(0.0, f64::max);
                peaks.push(best);
            }
        }
        let med: Vec<String> = rows.iter().map(|r| format!("{:.0}", quantile(r, 0.5))).collect();
        println!(
            "{name}: bands {}  fall med {:.1} p90 {:.1}  autocorr med {:.2} p90 {:.2} clip {:.3}/{:.3}",
            med.join(","),
            quantile(&falls, 0.5),
            quantile(&falls, 0.9),
            quantile(&peaks, 0.5),
            quantile(&peaks, 0.9),
            quantile(&clip, 0.5),
            quantile(&clip, 0.9)
        );
    }
    for d in [0.05, 0.1, 0.2, 0.36, 0.5] {
        let b = Breath {
            distance: d,
            hold: 4.0,
            hiss_db: -60.0,
            grille_db: -60.0,
            wander_deg: 0.0,
            port: soffio_soundscape::eddies::Port { size: 0.002, steepness: 1.0 },
            ..Breath::default()
        };
        let t0 = Instant::now();
        let air = b.air(R, 3);
        let took = t0.elapsed().as_secs_f64();
        let l = b.label(0.0, &air.speeds);
        let part = &air.pressure[0][(2.3 * 16000.0) as usize..5 * 16000];
        let mean = part.iter().sum::<f64>() / part.len() as f64;
        let ac: Vec<f64> = part.iter().map(|x| x - mean).collect();
        let limits: Vec<f64> = (0..64).map(|i| 4.0 * soffio_math::pow(2.0, i as f64 / 6.0)).collect();
        let p = band_powers(&ac, 16000.0, &limits);
        let total: f64 = p.iter().sum();
        let mut s = 0.0;
        let mut median = 0.0;
        for (i, x) in p.iter().enumerate() {
            s += x;
            if s > 0.5 * total {
                median = limits[i];
                break;
            }
        }
        let below60: f64 =
            limits.windows(2).zip(&p).filter(|(l, _)| l[1] <= 60.0).map(|(_, x)| *x).sum::<f64>() / total;
        println!(
            "d {d}: peak {:.2} m/s  travel {:.2} s end {:.2}  level {:.1} dB  median f {median:.0} Hz below60 {below60:.2} kurt {:.2} speed {:.0}x",
            l.peak_speed,
            l.arrival - l.lips,
            l.end - (1.0 + 0.12 + 4.0 + 0.3),
            db(power(&ac) / 4e-10),
            ac.iter().map(|x| x * x * x * x).sum::<f64>() / ac.len() as f64 / power(&ac) / power(&ac),
            b.duration() / took
        );
    }
    let t0 = Instant::now();
    let d = Draught::random(0.4, 0.1, 0.05, &mut Random::new(3));
    let p = d.pressure(60.0, R, 3);
    println!(
        "draught {:.1} dB, {:.0}x",
        db(power(&high_passed(p[0].clone(), 16000.0, 20.0, 2)) / 4e-10),
        60.0 / t0.elapsed().as_secs_f64()
    );
}
