//! Random numbers of a path: Owen-scrambled Sobol points.
//!
//! Each pixel, and each vertex of a path, has its own set of four dimensions, which are the first four of Sobol's
//! sequence (Joe and Kuo 2008) in an order and a scrambling of their own (padding; Burley 2020). With i the sample and s
//! the set's seed, the point is `scramble(sobol(scramble(i, s)), s′)`. Owen's nested scrambling of a base-2 number flips
//! each bit by a hash of the bits above it, so it keeps the stratification of the points. Laine and Karras (2011) found a hash
//! with that property, here with Vegdahl's constants (2021).
//!
//! Everything follows from the pixel and the index of the sample by integer arithmetic. So a picture has the same bits
//! for any number of threads.

/// Dimensions of one set.
const DIMENSIONS: usize = 4;
/// Degree, inner coefficients and first direction numbers of the primitive polynomials of dimensions 2 to 4 (Joe and Kuo 2008).
const POLYNOMIALS: [(usize, u32, [u32; 3]); DIMENSIONS - 1] = [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];

/// The first points of Sobol's sequence.
pub(super) struct Sobol {
    /// Points with their bits in reverse order, in which scrambling needs them.
    reversed: Vec<[u32; DIMENSIONS]>,
}

impl Sobol {
    /// At least `count` points.
    pub fn new(count: u32) -> Self {
        let directions = directions();
        let points = (0..count.max(1).next_power_of_two()).map(|index| {
            directions
                .map(|of| (0..32).filter(|bit| index >> bit & 1 == 1).fold(0, |x, bit| x ^ of[bit]).reverse_bits())
        });
        Self { reversed: points.collect() }
    }

    /// The numbers of sample `sample` at a pixel.
    pub fn sequence(&self, pixel: (u32, u32), sample: u32) -> Sequence<'_> {
        Sequence { sobol: self, sample, seed: hash(pixel.0 ^ hash(pixel.1)), set: 0 }
    }
}

/// Direction numbers of each dimension, the highest bit first.
fn directions() -> [[u32; 32]; DIMENSIONS] {
    let mut all = [[0; 32]; DIMENSIONS];
    all[0] = std::array::from_fn(|bit| 1 << (31 - bit));
    for (out, (degree, inner, first)) in all[1..].iter_mut().zip(POLYNOMIALS) {
        for bit in 0..32 {
            out[bit] = if bit < degree {
                first[bit] << (31 - bit)
            } else {
                let middle = (1..degree).filter(|k| inner >> (degree - 1 - k) & 1 == 1).map(|k| out[bit - k]);
                middle.fold(out[bit - degree] ^ (out[bit - degree] >> degree), |x, v| x ^ v)
            };
        }
    }
    all
}

/// The random numbers of one path.
pub(super) struct Sequence<'a> {
    sobol: &'a Sobol,
    sample: u32,
    seed: u32,
    set: u32,
}

impl Sequence<'_> {
    /// The next four numbers, 0 ≤ x < 1.
    pub fn next(&mut self) -> [f32; DIMENSIONS] {
        self.set += 1;
        let seed = hash(self.seed ^ hash(self.set));
        let mask = self.sobol.reversed.len() as u32 - 1;
        let index = scrambled(self.sample.reverse_bits(), seed).reverse_bits() & mask;
        let point = self.sobol.reversed[index as usize];
        std::array::from_fn(|k| {
            let own = seed ^ (k as u32 + 1).wrapping_mul(0x9e37_79b9);
            // 24 bits, so that 1 is never reached in single precision.
            (scrambled(point[k], own).reverse_bits() >> 8) as f32 / 16_777_216.0
        })
    }
}

/// Laine and Karras' hash of a number whose bits are in reverse order: a bit depends on those below it alone.
fn scrambled(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Mixes the bits of a number (Wellons' low-bias hash, 2018).
fn hash(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x21f0_aaad);
    x = (x ^ (x >> 15)).wrapping_mul(0xd35a_2d97);
    x ^ (x >> 15)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_points_fall_one_into_each_stratum_of_every_scrambling() {
        let sobol = Sobol::new(16);
        for pixel in [(0, 0), (7, 3), (1919, 1079)] {
            for set in 1..5 {
                let points: Vec<[f32; 4]> = (0..16)
                    .map(|sample| {
                        let mut sequence = sobol.sequence(pixel, sample);
                        (1..set).for_each(|_| _ = sequence.next());
                        sequence.next()
                    })
                    .collect();
                let once = |stratum: &dyn Fn(&[f32; 4]) -> usize, what: &str| {
                    let mut found: Vec<usize> = points.iter().map(stratum).collect();
                    found.sort_unstable();
                    assert_eq!(found, (0..16).collect::<Vec<_>>(), "{what} at {pixel:?}, set {set}");
                };
                for k in 0..4 {
                    once(&|p| (p[k] * 16.0) as usize, "sixteenths of a dimension");
                }
                // The first two dimensions are a (0, 2) sequence: every elementary interval holds one point.
                for (columns, rows) in [(2.0, 8.0), (4.0, 4.0), (8.0, 2.0)] {
                    once(&|p| (p[0] * columns) as usize * rows as usize + (p[1] * rows) as usize, "intervals");
                }
            }
        }
    }

    #[test]
    fn direction_numbers_are_those_of_the_table() {
        // Joe and Kuo's m for dimension 4: 1, 3, 1, then m₄ = 4 m₂ ⊕ 8 m₁ ⊕ m₁ = 12 ⊕ 8 ⊕ 1 = 5.
        let m: Vec<u32> = (0..4).map(|bit| directions()[3][bit] >> (31 - bit)).collect();
        assert_eq!(m, [1, 3, 1, 5]);
        // Dimension 3: m₃ = 2 m₂ ⊕ 4 m₁ ⊕ m₁ = 6 ⊕ 4 ⊕ 1 = 3.
        assert_eq!(directions()[2][2] >> 29, 3);
    }
}
