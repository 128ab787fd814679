//! Sound field and air at the two capsules: the buses that every source of a scene adds to.
//!
//! Pressures are in Pa. A source that gives the level L at 1 m in the open gives the direct sound 1/r, and the room a
//! diffuse sound that equals it at the critical distance r_c (Kuttruff, Room Acoustics, 2009, section 5.5). The diffuse
//! sound is a noise that decays by 60 dB in the time T₆₀, faster at high frequencies. Its coherence between the
//! capsules is sin(k s)/(k s) (Cook and others, J. Acoust. Soc. Am. 27, 1955), at the spacing s.

use soffio_math::noise::Random;
use soffio_math::{PI, exp, pow, sin};

use super::filter::Biquad;
use super::noise::{Draw, RATE, Shape, Workshop};
use super::turbulence::Port;

/// Speed of sound, m/s.
const SOUND: f64 = 343.0;
/// ln 10⁶ / 2: amplitudes fall by 60 dB in T₆₀.
const SIXTY_DB: f64 = 6.907_755;
/// Root mean square pressure of 0 dB, Pa.
pub(super) const REFERENCE: f64 = 2e-5;

/// Root mean square pressure, Pa, of a level in dB.
pub(super) fn pascal(db: f64) -> f64 {
    REFERENCE * pow(10.0, db / 20.0)
}

/// A room.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Reverberation time, s.
    pub(super) t60: f64,
    /// Critical distance, m.
    pub(super) critical: f64,
    /// Delay of the first reflection (table, wall), s, and its share.
    pub(super) reflection: (f64, f64),
}

/// The buses of one scene.
pub(super) struct Stage {
    /// Samples of the scene.
    pub(super) length: usize,
    /// Everything but breaths' air, Pa.
    pub(super) other: [Vec<f32>; 2],
    /// Pressure of breaths' air on the ports, Pa.
    pub(super) breath: [Vec<f32>; 2],
    /// What the room is given, Pa at 1 m.
    send: Vec<f32>,
    /// Mean speed of breaths' air at the first capsule, m/s, every ms.
    pub(super) air: Vec<f32>,
    /// Draws the directions of sounds.
    places: Random,
    /// The room.
    pub(super) room: Room,
    /// Ports of the capsules.
    pub(super) port: Port,
    /// Transforms.
    pub(super) workshop: Workshop,
}

impl Stage {
    /// A silent stage.
    pub(super) fn new(seconds: f64, seed: u64, room: Room, port: Port) -> Self {
        let length = (seconds * RATE) as usize;
        let silence = || vec![0.0; length];
        Self {
            length,
            other: [silence(), silence()],
            breath: [silence(), silence()],
            send: silence(),
            air: vec![0.0; (seconds * 1000.0) as usize],
            places: Random::new(seed),
            room,
            port,
            workshop: Workshop::default(),
        }
    }

    /// Noise of `seconds` s, root mean square 1.
    pub(super) fn noise(&mut self, random: &mut Random, seconds: f64, shape: &Shape) -> Vec<f32> {
        self.workshop.noise(random, (seconds * RATE).max(1.0) as usize, shape)
    }

    /// Adds a sound of `db` at 1 m (for a wave of root mean square 1), from `at` s on, at the distance of `metres`.
    /// Its direction is drawn.
    pub(super) fn sound(&mut self, at: f64, wave: &[f32], db: f64, metres: f64) {
        let toward = self.places.signed();
        let s = self.port.spacing;
        let second = (metres * metres + s * s - 2.0 * metres * s * toward).max(1e-4).sqrt();
        let gain = pascal(db);
        let delay = (second - metres) / SOUND * RATE;
        let from = at * RATE;
        let (near, far) = (gain / metres.max(0.02), gain / second.max(0.02));
        // The earlier capsule hears it at `at`.
        let (first_at, second_at) = (from + (-delay).max(0.0), from + delay.max(0.0));
        add(&mut self.other[0], first_at, wave, near);
        add(&mut self.other[1], second_at, wave, far);
        let (late, share) = self.room.reflection;
        let share = share * metres / (metres + late * SOUND);
        let bounce = delay * self.places.signed();
        add(&mut self.other[0], from + late * RATE + (-bounce).max(0.0), wave, near * share);
        add(&mut self.other[1], from + late * RATE + bounce.max(0.0), wave, near * share);
        add(&mut self.send, from, wave, gain);
    }

    /// Adds a sound that fills the room: `db` at the microphone, diffuse.
    pub(super) fn diffuse(&mut self, at: f64, wave: &[f32], db: f64) {
        add(&mut self.send, at * RATE, wave, pascal(db) * self.room.critical);
    }

    /// Adds what reaches the capsules through their mount, as the pressure that would sound as loud: `db` at the first,
    /// `balance` times that at the second.
    pub(super) fn contact(&mut self, at: f64, wave: &[f32], db: f64, balance: f64) {
        add(&mut self.other[0], at * RATE, wave, pascal(db));
        add(&mut self.other[1], at * RATE, wave, pascal(db) * balance);
    }

    /// Adds pressures at each capsule, Pa.
    pub(super) fn pressure(&mut self, at: f64, waves: &[Vec<f32>; 2], of_breath: bool) {
        let buses = if of_breath { &mut self.breath } else { &mut self.other };
        for (bus, wave) in buses.iter_mut().zip(waves) {
            add(bus, at * RATE, wave, 1.0);
        }
    }

    /// Adds the room's answer to all that was sent.
    pub(super) fn reverberate(&mut self, random: &mut Random) {
        let [left, right] = self.tails(random);
        let wet = self.workshop.convolve(&self.send, [&left, &right]);
        for (bus, wet) in self.other.iter_mut().zip(&wet) {
            bus.iter_mut().zip(wet).for_each(|(x, y)| *x += y);
        }
    }

    /// Impulse responses of the diffuse sound at both capsules, for a source's pressure at 1 m.
    fn tails(&mut self, random: &mut Random) -> [Vec<f32>; 2] {
        let taps = ((self.room.t60 * RATE) as usize).clamp(1600, 48_000);
        let n = taps.next_power_of_two();
        let flat = Shape::new(RATE, |f| 1.0 / (1.0 + (30.0 / f) * (30.0 / f)));
        let s = self.port.spacing;
        let coherence = Shape::new(RATE, |f| {
            let x = 2.0 * PI * f * s / SOUND;
            if x < 1e-6 { 1.0 } else { sin(x) / x }
        });
        let dull = self.workshop.pair(random, n, &flat, &coherence);
        // Air and walls absorb high frequencies: above 2 kHz it decays twice as fast.
        let gap = (random.range(0.001, 0.015) * RATE) as usize;
        dull.map(|noise| {
            let mut low = noise.clone();
            Biquad::first_lowpass(2000.0).run(&mut low);
            let (slow, fast) = (exp(-SIXTY_DB / (self.room.t60 * RATE)), exp(-2.0 * SIXTY_DB / (self.room.t60 * RATE)));
            let (mut a, mut b, mut energy) = (1.0, 1.0, 0.0);
            let mut tail = vec![0.0_f32; gap];
            for i in 0..taps - gap {
                let x = a * f64::from(low[i]) + b * f64::from(noise[i] - low[i]);
                energy += x * x;
                tail.push(x as f32);
                a *= slow;
                b *= fast;
            }
            let gain = 1.0 / (energy.sqrt() * self.room.critical);
            tail.iter_mut().for_each(|x| *x = (f64::from(*x) * gain) as f32);
            tail
        })
    }
}

/// Adds a wave to a bus, from a fractional sample on, in linear interpolation; samples outside are left out.
pub(super) fn add(bus: &mut [f32], from: f64, wave: &[f32], gain: f64) {
    if gain == 0.0 || wave.is_empty() {
        return;
    }
    let whole = from.floor();
    let t = (from - whole) as f32;
    let gain = gain as f32;
    let (now, before) = ((1.0 - t) * gain, t * gain);
    let skip = if whole < 0.0 { (-whole) as usize } else { 0 };
    let start = whole.max(0.0) as usize;
    if start >= bus.len() || skip >= wave.len() {
        return;
    }
    let mut last = if skip > 0 { wave[skip - 1] } else { 0.0 };
    for (y, x) in bus[start..].iter_mut().zip(&wave[skip..]) {
        *y += now * x + before * last;
        last = *x;
    }
}

/// Draws a room: a cabinet, a gallery or a hall.
pub(super) fn draw_room(random: &mut Random) -> Room {
    let t60 = random.log_range(0.2, 3.0);
    // Kuttruff's r_c = 0.057 √(V/T), for a volume that grows with T.
    let volume = random.log_range(30.0, 400.0) * (1.0 + 4.0 * t60 * t60);
    Room {
        t60,
        critical: 0.057 * (volume / t60).sqrt(),
        reflection: (random.range(0.0006, 0.008), random.range(0.2, 0.8)),
    }
}
