//! Draughts, wind and fans: air at the capsules that is no breath.
//!
//! Indoors the mean speed is 0.1 to 0.6 m/s and its turbulence 10 to 60 % (Melikov, ASHRAE Transactions 94, 1988; ISO
//! 7730), with eddies from a few centimetres (a ventilator's wake) to the room's size. Outdoors it is some metres per
//! second, with slow gusts. Speeds of more than ten eddies' time change with the gusts; smaller eddies are those of
//! [`super::turbulence`]. The two capsules lie in one stream, or one of them is sheltered.

use soffio_math::noise::Random;
use soffio_math::{PI, sin};

use super::jet::STEP;
use super::noise::{Draw, Drift, Shape};
use super::stage::Stage;
use super::turbulence::{Air, pressure};

/// A stream of air over the capsules.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draught {
    /// Mean speed, m/s.
    pub(super) speed: f64,
    /// Fluctuation over mean.
    pub(super) intensity: f64,
    /// Integral scale, m.
    pub(super) scale: f64,
    /// Share of the speed that reaches each capsule.
    pub(super) share: [f64; 2],
}

/// Draws a draught of a room.
pub(super) fn draw(random: &mut Random) -> Draught {
    let sheltered = random.chance(0.2);
    let share = [1.0, if sheltered { random.range(0.05, 0.5) } else { random.range(0.8, 1.2) }];
    Draught {
        speed: random.log_range(0.1, 0.7),
        intensity: random.range(0.1, 0.6),
        scale: random.log_range(0.02, 2.0),
        share: if random.chance(0.5) { share } else { [share[1], share[0]] },
    }
}

/// Adds a draught from `at` s on: `envelope` is its strength, 0 … 1, every [`STEP`].
pub(super) fn blow(stage: &mut Stage, random: &mut Random, at: f64, draught: &Draught, envelope: &[f64]) {
    let Draught { speed, intensity, scale, share } = *draught;
    let seconds = envelope.len() as f64 * STEP;
    // Gusts of more than the eddies' time, at most a few a second.
    let rate = (0.3 * speed / scale).clamp(0.02, 2.0);
    let gust = Drift::new(random, seconds * 4.0 * rate);
    let slow = Drift::new(random, seconds);
    let now = |i: usize, c: f64| {
        let t = i as f64 * STEP;
        let gusts = 1.0 + 0.6 * intensity * gust.at(t * 4.0 * rate) + 0.2 * slow.at(0.3 * t);
        speed * c * gusts.max(0.05)
    };
    let base: Vec<f64> = envelope.iter().enumerate().map(|(i, c)| now(i, *c)).collect();
    let times = |share: f64| base.iter().map(|u| u * share).collect::<Vec<f64>>();
    let air = Air {
        speed: share.map(times),
        eddies: share.map(|share| times(share * 0.8 * intensity)),
        carrier: base.iter().map(|u| u.max(0.02)).collect(),
        scale,
        lag: stage.port.spacing * random.signed(),
    };
    let waves = pressure(&mut stage.workshop, random, &air, &stage.port);
    stage.pressure(at, &waves, false);
}

/// Envelope of a draught of `seconds` s: steady, of a door that opens at times, or of a ventilator that swings past.
pub(super) fn envelope(random: &mut Random, seconds: f64) -> Vec<f64> {
    let steps = (seconds / STEP) as usize;
    match random.whole(0, 3) {
        0 | 1 => vec![1.0; steps],
        2 => switched(random, seconds, (2.0, 15.0), (3.0, 25.0)),
        _ => {
            let (period, phase, sharp) = (random.range(4.0, 14.0), random.unit(), random.range(0.0, 0.7));
            let swing = |i: usize| sin(2.0 * PI * (phase + i as f64 * STEP / period));
            (0..steps).map(|i| ((swing(i) - sharp) / (1.0 - sharp)).max(0.0)).collect()
        }
    }
}

/// On and off in turn, with a rise and a fall of 0.2 to 2 s.
pub(super) fn switched(random: &mut Random, seconds: f64, on: (f64, f64), off: (f64, f64)) -> Vec<f64> {
    let steps = (seconds / STEP) as usize;
    let share = STEP / random.log_range(0.2, 2.0);
    let (mut open, mut left, mut state) = (random.chance(0.5), 0.0, 0.0);
    (0..steps)
        .map(|_| {
            if left <= 0.0 {
                open = !open;
                let (low, high) = if open { on } else { off };
                left = random.range(low, high);
            }
            left -= STEP;
            state += share * (f64::from(u8::from(open)) - state);
            state
        })
        .collect()
}

/// Outdoor wind of a whole scene, 0.5 to 6 m/s.
pub(super) fn wind(stage: &mut Stage, random: &mut Random, seconds: f64) {
    let draught = Draught {
        speed: random.log_range(0.5, 6.0),
        intensity: random.range(0.2, 0.5),
        scale: random.log_range(0.05, 1.0),
        share: [1.0, random.range(0.7, 1.2)],
    };
    let gust = Drift::new(random, seconds);
    let envelope: Vec<f64> = (0..(seconds / STEP) as usize)
        .map(|i| (0.55 + 0.35 * gust.at(0.4 * i as f64 * STEP)).clamp(0.05, 1.5))
        .collect();
    blow(stage, random, 0.0, &draught, &envelope);
}

/// A fan or a hand dryer near the capsule, on and off: its air, its broad sound and the tones of its blades.
pub(super) fn fan(stage: &mut Stage, random: &mut Random, seconds: f64) {
    let envelope = switched(random, seconds, (4.0, 25.0), (3.0, 20.0));
    let draught = Draught {
        speed: random.log_range(0.2, 2.5),
        intensity: random.range(0.15, 0.5),
        scale: random.log_range(0.02, 0.15),
        share: [1.0, random.range(0.6, 1.2)],
    };
    blow(stage, random, 0.0, &draught, &envelope);
    let shape = Shape::corners(&[(40.0, -8.0), (200.0, 0.0), (1000.0, -6.0), (7000.0, -26.0)]);
    let mut wave = stage.noise(random, seconds, &shape);
    super::breath::modulate(&mut wave, &envelope);
    stage.sound(0.0, &wave, random.range(30.0, 52.0), random.range(0.3, 2.0));
}
