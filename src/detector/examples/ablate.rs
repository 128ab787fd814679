use soffio_detector::{frontend::Frontend, network::*, features::COUNT};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let network = Network::read(&std::fs::read(std::env::var("MODEL").unwrap()).unwrap()).unwrap();
    // segments: file onset offset lines on stdin
    let lead: f32 = std::env::var("NOISE").map_or(0.0005, |x| x.parse().unwrap());
    let groups: Vec<(String, Vec<usize>)> = { let mut g = vec![("none".to_string(), vec![])];
        for (n, r) in [("rise", 0..13), ("shape", 13..26), ("z", 26..39), ("per", 39..40)] { g.push((n.into(), r.collect())); }
        g.push(("rise+z".into(), (0..13).chain(26..39).collect())); g.push(("hi bands".into(), (7..13).chain(20..26).chain(33..39).collect())); g.push(("lo bands".into(), (0..4).chain(13..17).chain(26..30).collect())); g };
    let mut acc = vec![Vec::new(); groups.len()]; let mut means = vec![0.0f64; COUNT]; let mut n = 0.0;
    for line in std::io::stdin().lines() { let line = line.unwrap(); let p: Vec<&str> = line.split(',').collect(); let (on, off): (f64, f64) = (p[1].parse().unwrap(), p[2].parse().unwrap());
        let mut r = hound::WavReader::open(p[0]).unwrap(); let spec = r.spec(); let ch = spec.channels as usize; let k = 1.0 / (1u64 << (spec.bits_per_sample - 1)) as f32;
        let all: Vec<f32> = r.samples::<i32>().filter_map(Result::ok).map(|x| x as f32 * k).collect();
        let mut sd = 7u64; let mut white = || { sd = sd.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (sd >> 40) as f32 / 8388608.0 - 1.0 };
        let rate = spec.sample_rate as f64; let from = ((on - 0.3).max(0.0) * rate) as usize; let to = (off * rate) as usize;
        let x: Vec<f32> = (0..(4.0 * rate) as usize).map(|_| 0.0).chain(all.chunks(ch).map(|f| f.iter().sum::<f32>() / ch as f32).skip(from).take(to - from)).map(|v| v + lead * white()).collect();
        let mut f = Frontend::new(spec.sample_rate); let mut states = vec![[0.0; CELLS]; groups.len()]; let mut sums = vec![0.0; groups.len()]; let mut cnt = 0.0;
        for (i, s) in x.iter().enumerate() { let t = i as f64 / rate - 4.0; if let Some(fr) = f.push(*s, None, 0.0, t < 0.0) { if let Some(m) = fr.measured {
            for (gi, g) in groups.iter().enumerate() { let mut inp = m.inputs; if t > 0.0 { for &j in &g.1 { inp[j] = network.scale[j][0]; } } let o = network.push(&mut states[gi], &inp, &m.levels); if t > 0.5 { sums[gi] += o.log_odds; if gi == 0 { cnt += 1.0; } } }
            if t > 0.5 { for j in 0..COUNT { means[j] += ((m.inputs[j] - network.scale[j][0]) / network.scale[j][1]) as f64; } n += 1.0; } } } }
        if cnt > 0.0 { for (gi, s) in sums.iter().enumerate() { acc[gi].push(s / cnt); } }
    }
    for (g, v) in groups.iter().zip(&mut acc) { v.sort_by(f64::total_cmp); println!("{:10} median {:.2} p10 {:.2} p90 {:.2} n {}", g.0, v[v.len() / 2], v[v.len() / 10], v[v.len() * 9 / 10], v.len()); }
    if a.len() > 1 { for j in 0..42 { println!("input {j}: mean std {:.2}", means[j] / n); } }
}
