use soffio_training::{generator, parallel::parallel};
fn main() {
    let parts = parallel(40, |i| { let s = generator::scene(1, 2_000_000 + i as u64); let mut c = [0u32; 6];
        for (a, o) in s.air.iter().zip(&s.over_db) { c[0] += 1; let k = if *a >= 0.35 { if *o >= 3.0 { 1 } else { 2 } } else if *a > 0.0 { 3 } else if *o > 0.0 { 4 } else if *o > -20.0 { 5 } else { continue }; c[k] += 1; } c });
    let mut t = [0u32; 6]; for p in parts { for k in 0..6 { t[k] += p[k]; } } println!("all, pos, fast but quiet, slow air, no air but over>0, over>-20: {t:?}");
}
