use soffio_detector::{BlowDetector, BlowSettings};
fn main() {
    let mut settings = BlowSettings::default();
    if let Ok(path) = std::env::var("MODEL") { settings.network = std::sync::Arc::new(soffio_detector::network::Network::read(&std::fs::read(path).unwrap()).unwrap()); }
    if let Ok(rules) = std::env::var("RULES") { let r: Vec<f64> = rules.split(',').map(|x| x.parse().unwrap()).collect();
        settings.rules = soffio_detector::Rules { log_odds_limits: (r[0], r[1]), drift: r[2], on: r[3], full: r[4] }; }
    let lead: f64 = std::env::var("LEAD").map_or(1.0, |x| x.parse().unwrap());
    for path in std::env::args().skip(1) {
        let Ok(mut r) = hound::WavReader::open(&path) else { eprintln!("bad {path}"); continue };
        let spec = r.spec(); let ch = spec.channels as usize;
        let all: Vec<f32> = match spec.sample_format { hound::SampleFormat::Int => { let k = 1.0 / (1u64 << (spec.bits_per_sample - 1)) as f32; r.samples::<i32>().filter_map(Result::ok).map(|x| x as f32 * k).collect() }, _ => r.samples::<f32>().filter_map(Result::ok).collect() };
        let x: Vec<f32> = all.chunks(ch).map(|f| f.iter().sum::<f32>() / ch as f32).collect();
        let rate = spec.sample_rate;
        if rate < 8000 { continue }
        let mut d = BlowDetector::with_settings(rate, settings.clone());
        // quiet lead so that the floor settles: low noise like the file's quietest 0.2 s
        let n = (rate as usize / 5).min(x.len().max(1));
        let quiet = x.chunks(n).filter(|c| c.len() == n).map(|c| (c.iter().map(|v| v * v).sum::<f32>() / n as f32).sqrt()).fold(f32::MAX, f32::min).clamp(1e-5, 0.1);
        let mut s = 7u64; let mut white = || { s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (s >> 40) as f32 / 8388608.0 - 1.0 };
        let mut low = 0.0f32;
        for _ in 0..(lead * rate as f64) as usize { low += 0.1 * (white() - low); d.push(&[quiet * (2.0 * low + white())], &[]); }
        let step = (rate / 240).max(1) as usize; let mut on = false; let mut out = String::new();
        for (i, b) in x.chunks(step).enumerate() { d.push(b, &[]); let now = d.estimate().speed > 0.0; if now != on { use std::fmt::Write; let _ = write!(out, "{}{:.3}", if now { " " } else { "-" }, ((i + 1) * step) as f64 / rate as f64); on = now; } }
        println!("{path},{:.2},{}", x.len() as f64 / rate as f64, out.trim());
    }
}
