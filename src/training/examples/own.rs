use soffio_training::{generator, parallel::parallel};
use soffio_detector::{BlowDetector, BlowSettings, network::Network};
use std::collections::BTreeMap;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (from, n): (u64, u64) = (a[1].parse().unwrap(), a[2].parse().unwrap());
    let mut settings = BlowSettings::default();
    settings.network = std::sync::Arc::new(Network::read(&std::fs::read(std::env::var("MODEL").unwrap()).unwrap()).unwrap());
    let stereo = std::env::var("STEREO").is_ok();
    let parts = parallel(n as usize, |i| {
        let s = generator::scene(1, from + i as u64);
        let mut d = BlowDetector::with_settings(s.rate, settings.clone());
        let mut on = vec![false; s.air.len()];
        let mut odds = vec![0.0; s.air.len()];
        for (ms, o) in on.iter_mut().enumerate() { let r = ms * 16..((ms + 1) * 16).min(s.capsules[0].len()); if r.start >= s.capsules[0].len() { break }
            let p: &[f32] = if s.played.is_empty() { &[] } else { &s.played[r.clone()] };
            if stereo { d.push_stereo(&s.capsules[0][r.clone()], &s.capsules[1][r], p) } else { d.push(&s.capsules[0][r], p) }; *o = d.estimate().speed > 0.0; odds[ms] = d.output().log_odds; }
        let mut rows: Vec<(String, bool)> = Vec::new();
        for b in &s.breaths { let (x, y) = ((b.capsule.0 * 1000.0) as usize, (b.capsule.1 * 1000.0) as usize); if y <= x || y + 300 >= on.len() { continue }
            let over = s.over_db[x..y].iter().copied().fold(-100.0f32, f32::max);
            if b.peak_air < 1.0 || over < 10.0 { continue }
            let hit = on[x..y + 300].iter().any(|o| *o);
            let m = odds[x + (y - x) / 3..y - (y - x) / 4].iter().sum::<f64>() / ((y - (y - x) / 4) - (x + (y - x) / 3)).max(1) as f64;
            if std::env::var("MISS").is_ok() && !hit && over > 40.0 { eprintln!("scene {} {} {} air {:.1} dist {:.2} angle {:.0} {:.2}-{:.2} over {over:.0} odds {m:.1}", from + i as u64, s.kind, b.manner, b.peak_air, b.distance, b.angle_deg, b.capsule.0, b.capsule.1); } rows.push((b.manner.to_string(), hit)); rows.push(("all".into(), hit)); rows.push((s.kind.to_string(), hit));
            rows.push((format!("over {}", (over / 10.0) as i32 * 10), hit)); rows.push((format!("odds>0 over {}", (over / 10.0) as i32 * 10), m > 0.0)); }
        let mut fp = 0; for ms in 1..on.len() { if on[ms] && !on[ms - 1] && s.air[ms.saturating_sub(1500)..ms].iter().all(|a| *a == 0.0) { fp += 1; } }
        (rows, fp, s.air.len() as f64 / 3.6e6, s.kind)
    });
    let mut t: BTreeMap<String, (u32, u32)> = BTreeMap::new(); let (mut fp, mut h) = (0, 0.0); let mut fk: BTreeMap<&str, (u32, f64)> = BTreeMap::new();
    for (rows, f, hours, kind) in parts { for (k, hit) in rows { let e = t.entry(k).or_default(); e.1 += 1; e.0 += hit as u32; } fp += f; h += hours; let e = fk.entry(kind).or_default(); e.0 += f; e.1 += hours; }
    for (k, (a, b)) in t { println!("{k:22} {a:4}/{b:4} {:.0} %", 100.0 * a as f64 / b as f64); }
    println!("false {fp} in {h:.2} h"); for (k, (f, h)) in fk { println!("   {k:12} {f} in {h:.2} h"); }
}
