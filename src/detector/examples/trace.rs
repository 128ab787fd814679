use soffio_detector::{frontend::Frontend, network::Network};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let network = Network::read(&std::fs::read(std::env::var("MODEL").unwrap()).unwrap()).unwrap();
    let mut r = hound::WavReader::open(&a[1]).unwrap(); let spec = r.spec(); let ch = spec.channels as usize;
    let k = 1.0 / (1u64 << (spec.bits_per_sample - 1)) as f32;
    let all: Vec<f32> = r.samples::<i32>().filter_map(Result::ok).map(|x| x as f32 * k).collect();
    let x: Vec<f32> = all.chunks(ch).map(|f| f.iter().sum::<f32>() / ch as f32).collect();
    let (from, to): (f64, f64) = (a[2].parse().unwrap(), a[3].parse().unwrap());
    let mut f = Frontend::new(spec.sample_rate); let mut st = [0.0; soffio_detector::network::CELLS]; let mut n = 0; let lead: f32 = std::env::var("NOISE").map_or(0.0, |x| x.parse().unwrap()); let learn_s: f64 = std::env::var("LEARN").map_or(1e9, |x| x.parse().unwrap()); let mut sd = 7u64; let mut white = || { sd = sd.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (sd >> 40) as f32 / 8388608.0 - 1.0 }; let x: Vec<f32> = (0..5 * spec.sample_rate).map(|_| 0.0).chain(x).map(|v| v + lead * white()).collect();
    for (i, s) in x.iter().enumerate() {
        let t = i as f64 / spec.sample_rate as f64 - 5.0;
        if let Some(fr) = f.push(*s, None, 0.0, t < learn_s) { if let Some(m) = fr.measured {
            let o = network.push(&mut st, &m.inputs, &m.levels); n += 1;
            if t > from && t < to && n % 4 == 0 { print!("{t:.2} odds {:5.1} v {:4.2} per {:.2} |", o.log_odds, o.log_speed.exp(), m.periodicity);
                for b in 0..13 { print!(" {:3.0}", m.inputs[b] * 10.0); } print!(" | lev"); for b in 0..13 { print!(" {:3.0}", m.levels[b]); }
                print!(" z"); for b in 0..13 { print!(" {:.1}", m.inputs[26+b]); } println!(); }
        } }
    }
}
