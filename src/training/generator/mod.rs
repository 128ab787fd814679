//! Stub.
pub struct Scene { pub rate: u32, pub capsules: Vec<Vec<f32>>, pub played: Vec<f32>, pub air: Vec<f32>, pub over_db: Vec<f32> }
pub fn scene(seed: u64, index: u64) -> Scene {
    use soffio_math::noise::Random;
    let mut r = Random::new(soffio_math::noise::hash_words(&[seed,index]));
    let n = 16000*20; let mut air = vec![0.0; 20000]; let mut over = vec![-100.0; 20000];
    let mut a = vec![0.0f32; n]; let mut b = a.clone(); let (mut la, mut lb) = (0.0f64, 0.0f64);
    let start = (r.unit()*10.0+2.0)*1000.0; 
    for ms in 0..20000 { if (ms as f64) > start && (ms as f64) < start+2000.0 { air[ms]=1.0; over[ms]=20.0; } }
    for i in 0..n { let on = air[i/16]; la += 0.04*(r.signed()-la); lb += 0.04*(r.signed()-lb); a[i] = (0.3*la as f32)*on + 0.002*r.signed() as f32; b[i] = (0.3*lb as f32)*on + 0.002*r.signed() as f32; }
    Scene { rate: 16000, capsules: vec![a,b], played: vec![], air, over_db: over }
}
