//! Surface profiles: a sliding contact reads a line of the surface as a gramophone's needle does, F(t) = f(s(t)), ds = v dt.
//!
//! The faster it is read, the higher its spectrum; what would come out above half the sample rate must be gone before.
//! So the line is kept as a pyramid, as textures are in graphics: each level is the one below, low-passed and thinned
//! out by two. At speed v a step is v/(fs Δ) points; where it is 2^λ, levels ⌊λ⌋ and ⌊λ⌋ + 1 are read and blended.
//!
//! Each level holds nothing above ¼ of its own rate, half of its bandwidth. Read at up to two of its points a sample, it stays
//! below fs/2. Its images begin at ¾, so a short kernel removes them.
//!
//! **No repetition**: a procedural line is 0.3 m long, and its repetition would be audible. So it is read in pieces from random
//! positions, cross-faded with equal power, about a hand's width each. A picture is read in its own order.
//!
//! **Solid textures** (Perlin, SIGGRAPH 1985): the line is a circle through the solid, so it closes without a seam. Wood:
//! rings about an axis beside it, pores at the start of each; marble: a sine of the way, disturbed by turbulence; rough:
//! octaves of noise, amplitude 2^(−iH), hence a spectrum of slope −1 − 2H.

use super::state::OperatorState;
use crate::SurfaceLine;
use crate::timbre::{Texture, TextureKind};
use soffio_math::noise::{Random, hash_words, perlin3};
use soffio_math::{DVec3, PI, ln, sin, sincos};

/// Points of a procedural line: 9 µm each over 0.3 m.
const POINTS: usize = 1 << 15;
/// Fewest points of a level of the pyramid: the reading kernel must fit in.
const FEWEST: usize = 32;
/// Most points of a picture's line: a bound on memory, 1 MiB.
const MOST: usize = 1 << 18;
/// Shortest and longest piece of a line that is read at once, as parts of the line: 75 to 150 mm, about a hand's width.
const PIECE: (f64, f64) = (0.25, 0.5);
/// Part of a line over which a piece fades into the next: 5 mm.
const FADE: f64 = 1.0 / 64.0;
/// Taps of the reading kernel.
const TAPS: usize = 12;
/// Phases of the reading kernel between two points.
const PHASES: usize = 128;
/// Half the taps of the low-pass between levels.
const REACH: usize = 110;
/// Shape β of the low-pass's Kaiser window: −80 dB in the stop band (Kaiser, 1974: β = 0.1102 (A − 8.7)).
const WINDOW: f64 = 7.9;

/// A closed line of a surface at all scales.
pub(crate) struct Pyramid {
    /// Finest first, each half as long; mean 0, mean square about 1 before anything was filtered away. As many points of
    /// the other end stand before and behind as the kernel reaches, so that every reading is of one piece.
    levels: Vec<Vec<f32>>,
    /// Distance between points of the finest, m.
    spacing: f64,
    kernel: Vec<[f32; TAPS]>,
    /// Whether it is read in pieces.
    endless: bool,
}

impl Pyramid {
    /// The line of a procedural texture.
    pub fn of_texture(texture: &Texture) -> Self {
        let radius = POINTS as f64 * texture.resolution / (2.0 * PI) / texture.grain;
        let line: Vec<f64> = (0..POINTS)
            .map(|i| {
                let (s, c) = sincos(2.0 * PI * i as f64 / POINTS as f64);
                solid(texture, DVec3::new(radius * c, radius * s, 0.37))
            })
            .collect();
        Self { endless: true, ..Self::new(&line, texture.resolution) }
    }

    /// The line of a picture.
    ///
    /// # Errors
    /// The line has fewer than [`FEWEST`] or more than [`MOST`] points, or a number that is not finite.
    pub fn of_picture(line: &SurfaceLine) -> Result<Self, String> {
        let fine = line.spacing.is_finite() && line.spacing > 0.0 && line.values.iter().all(|v| v.is_finite());
        if !(fine && (FEWEST..=MOST).contains(&line.values.len())) {
            let problem = format!("a surface's line needs {FEWEST} to {MOST} points a distance above 0 apart");
            return Err(problem);
        }
        // To a power of two, so that every level closes: straight lines between points.
        let points = line.values.len().next_power_of_two();
        let stretch = line.values.len() as f64 / points as f64;
        let values: Vec<f64> = (0..points)
            .map(|i| {
                let x = i as f64 * stretch;
                let (a, t) = (x as usize, x - (x as usize) as f64);
                let at = |i: usize| f64::from(line.values[i % line.values.len()]);
                at(a) + t * (at(a + 1) - at(a))
            })
            .collect();
        Ok(Self::new(&values, line.spacing * stretch))
    }

    fn new(line: &[f64], spacing: f64) -> Self {
        let n = line.len() as f64;
        let mean = line.iter().sum::<f64>() / n;
        let power = line.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
        let scale = if power > 1e-18 { 1.0 / power.sqrt() } else { 0.0 };
        let normal: Vec<f32> = line.iter().map(|v| ((v - mean) * scale) as f32).collect();
        // The first level keeps every point and what is below ¼; the others every second one of what is below ⅛.
        let mut levels = vec![low_passed(&normal, 0.25, 1)];
        while levels[levels.len() - 1].len() >= 2 * FEWEST {
            levels.push(low_passed(&levels[levels.len() - 1], 0.125, 2));
        }
        for level in &mut levels {
            let n = level.len();
            *level = (0..n + TAPS - 1).map(|i| level[(i + n + 1 - TAPS / 2) % n]).collect();
        }
        Self { levels, spacing, kernel: reading_kernel(), endless: false }
    }

    /// Points of the finest level.
    pub fn points(&self) -> usize {
        self.levels[0].len() + 1 - TAPS
    }

    /// Points of the finest level per sample at a speed in m/s.
    pub fn step(&self, speed: f64, sample_rate: f64) -> f64 {
        (speed.abs() / (sample_rate * self.spacing)).min(self.points() as f64)
    }

    /// λ of a step.
    pub fn level(&self, step: f64) -> f64 {
        (ln(step.max(1.0)) / ln(2.0)).min(self.levels.len() as f64 - 1.0)
    }

    /// Length of the next piece, in points.
    pub fn piece(&self, random: &mut Random) -> f64 {
        if self.endless { self.points() as f64 * random.range(PIECE.0, PIECE.1) } else { f64::INFINITY }
    }

    /// Renders a block of the line as it is read at the state's speed.
    pub fn render(&self, state: &mut OperatorState, out: &mut [f32]) {
        let points = self.points() as f64;
        let on = |place: f64, way: f64| if place + way >= points { place + way - points } else { place + way };
        let fade = FADE * points;
        for y in out {
            let level = state.level[0].clamp(0.0, self.levels.len() as f64 - 1.0);
            *y = self.read(level, state.place);
            state.place = on(state.place, state.value);
            state.left -= state.value;
            if state.left < fade {
                let next = state.next.unwrap_or_else(|| points * state.random.unit());
                // Equal power, and no corner where it begins and ends: t² (3 − 2t).
                let t = (1.0 - state.left / fade).min(1.0);
                let power = t * t * (3.0 - 2.0 * t);
                *y = *y * (1.0 - power).sqrt() as f32 + self.read(level, next) * power.sqrt() as f32;
                state.next = Some(on(next, state.value));
                if state.left <= 0.0 {
                    state.place = state.next.take().unwrap_or_default();
                    state.left += self.piece(&mut state.random);
                }
            }
            state.value = (state.value + state.change).max(0.0);
            state.level[0] += state.level[1];
        }
    }

    /// The value between two levels at a place of the finest.
    fn read(&self, level: f64, place: f64) -> f32 {
        let (fine, blend) = (level as usize, (level - (level as usize) as f64) as f32);
        let below = self.read_level(fine, place);
        if blend > 0.0 { below + blend * (self.read_level(fine + 1, place) - below) } else { below }
    }

    /// The value of a level at a place of the finest.
    fn read_level(&self, level: usize, place: f64) -> f32 {
        let line = &self.levels[level];
        let x = place / (1u64 << level) as f64;
        let cell = x as usize;
        let phase = (x - cell as f64) * PHASES as f64;
        let (p, t) = (phase as usize, (phase - (phase as usize) as f64) as f32);
        let (a, b) = (&self.kernel[p], &self.kernel[p + 1]);
        let Some(points) = line.get(cell..).and_then(|rest| rest.first_chunk::<TAPS>()) else { return 0.0 };
        let taps: [f32; TAPS] = std::array::from_fn(|k| (a[k] + t * (b[k] - a[k])) * points[k]);
        taps.iter().sum()
    }
}

/// The texture at a place, in grains.
fn solid(texture: &Texture, p: DVec3) -> f64 {
    let detail = |p: DVec3, first: u32| {
        let falling = libm::exp2(-texture.roughness);
        let (mut sum, mut weight, mut rate) = (0.0, 1.0, 1.0);
        for octave in 0..texture.octaves {
            // Detail finer than two points would be noise of the grid.
            if rate * texture.resolution > 0.5 * texture.grain {
                break;
            }
            sum += weight * perlin3(p * rate, hash_words(&[texture.seed, u64::from(first + octave)]));
            weight *= falling;
            rate *= 2.0;
        }
        sum
    };
    match texture.kind {
        TextureKind::Wood => {
            // Years' rings lie about an axis outside of the path, a little bent; the early wood of each is full of pores.
            let axis = DVec3::new(7.3, 41.0, 0.0);
            let way = (p - axis).length() + 0.3 * perlin3(p * 0.25, texture.seed);
            let year = way - way.floor();
            let late = year * year * year;
            let pores = detail(p * 4.0, 20);
            0.8 * late + (1.0 - 0.7 * late) * pores
        }
        TextureKind::Marble => sin(2.0 * PI * (p.x + 0.35 * detail(p, 40))) + 0.4 * detail(p * 3.0, 60),
        TextureKind::Rough | TextureKind::Image => detail(p, 80),
    }
}

/// A closed line without what is above `edge` (cycles per point, −80 dB there), every `keep`-th point.
fn low_passed(line: &[f32], edge: f64, keep: usize) -> Vec<f32> {
    // A Kaiser window of this length falls from pass to stop within 5 / 2·REACH.
    let corner = edge - 2.6 / (2.0 * REACH as f64);
    let taps: Vec<f64> = (0..=2 * REACH)
        .map(|i| {
            let x = i as f64 - REACH as f64;
            2.0 * corner * sinc(2.0 * corner * x) * kaiser(x / REACH as f64)
        })
        .collect();
    let sum: f64 = taps.iter().sum();
    let taps: Vec<f32> = taps.iter().map(|t| (t / sum) as f32).collect();
    let n = line.len();
    // The line, closed: as far before its start and behind its end as the filter reaches.
    let closed: Vec<f32> = (0..n + 2 * REACH).map(|i| line[(i + n * (REACH / n + 1) - REACH) % n]).collect();
    let dot = |i: usize| taps.iter().zip(&closed[i * keep..]).map(|(t, x)| t * x).sum();
    (0..n / keep).map(dot).collect()
}

/// Kernels between two points: a sinc of cut-off ½ that has fallen by 80 dB at ¾.
fn reading_kernel() -> Vec<[f32; TAPS]> {
    (0..=PHASES)
        .map(|p| {
            let offset = p as f64 / PHASES as f64 + TAPS as f64 / 2.0 - 1.0;
            let taps: [f64; TAPS] = std::array::from_fn(|k| {
                let x = k as f64 - offset;
                sinc(x) * kaiser(x / (TAPS as f64 / 2.0))
            });
            let sum: f64 = taps.iter().sum();
            taps.map(|t| (t / sum) as f32)
        })
        .collect()
}

fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-9 { 1.0 } else { sin(PI * x) / (PI * x) }
}

/// Kaiser's window at −1…1.
fn kaiser(x: f64) -> f64 {
    bessel_i0(WINDOW * (1.0 - (x * x).min(1.0)).sqrt()) / bessel_i0(WINDOW)
}

/// I₀ by its power series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let (mut term, mut sum, mut k) = (1.0, 1.0, 1.0);
    while term > 1e-12 * sum {
        term *= quarter / (k * k);
        sum += term;
        k += 1.0;
    }
    sum
}
