use std::io::Write;
use soffio_detector::frontend::Frontend;
use soffio_training::{examples, generator, parallel::parallel};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut out = std::io::BufWriter::new(std::fs::File::create(&a[1]).unwrap());
    if a[2] == "scenes" {
        let (from, n): (u64, usize) = (a[3].parse().unwrap(), a[4].parse().unwrap());
        for (i, sc) in parallel(n, |i| examples::of_scene(&generator::scene(1, from + i as u64), examples::Channels::One)).iter().enumerate() {
            for e in sc { for x in e.inputs[..41].iter().chain(&[e.target, e.weight, i as f32]) { out.write_all(&x.to_le_bytes()).unwrap(); } }
        }
    } else {
        // lines: path,onset,offset on stdin: one second of faint noise, then from 0.3 s before the onset to the offset
        for (i, line) in std::io::stdin().lines().enumerate() { let line = line.unwrap(); let p: Vec<&str> = line.split(',').collect(); let (on, off): (f64, f64) = (p[1].parse().unwrap(), p[2].parse().unwrap());
            let mut r = hound::WavReader::open(p[0]).unwrap(); let spec = r.spec(); let ch = spec.channels as usize; let k = 1.0 / (1u64 << (spec.bits_per_sample - 1)) as f32;
            let all: Vec<f32> = r.samples::<i32>().filter_map(Result::ok).map(|x| x as f32 * k).collect();
            let mut sd = 7u64; let mut white = || { sd = sd.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (sd >> 40) as f32 / 8388608.0 - 1.0 };
            let rate = spec.sample_rate as f64; let from = ((on - 0.3).max(0.0) * rate) as usize; let to = ((off * rate) as usize).min(all.len() / ch);
            let x: Vec<f32> = (0..(4.0 * rate) as usize).map(|_| 0.0).chain(all.chunks(ch).map(|f| f.iter().sum::<f32>() / ch as f32).skip(from).take(to.saturating_sub(from))).map(|v| v + 0.0005 * white()).collect();
            let mut f = Frontend::new(spec.sample_rate);
            for (j, s) in x.iter().enumerate() { if let Some(fr) = f.push(*s, None, 0.0, true) { if let Some(m) = fr.measured { let t = j as f64 / rate - 4.0; for x in m.inputs[..41].iter().chain(&[f32::from(u8::from(t > 0.4)), 1.0, i as f32]) { out.write_all(&x.to_le_bytes()).unwrap(); } } } }
        }
    }
}
