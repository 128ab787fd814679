//! The partials of one body, y(t) = Σ a e^(−c t) sin(ω t): struck, driven, touched, and forgotten when they are over.
//!
//! Time goes in blocks of [`BLOCK`] samples on the synth's own grid. A hit falls anywhere between two blocks' borders:
//! what it adds to the block that is being played, and to those ahead while the contact lasts, is written into the
//! caller's samples; what rings on goes into the phasors.
//!
//! Partials die away in groups of [`GROUP`]; whoever makes a bank sorts them by decay, so that those of one group end
//! together. A group below the threshold fades over one last block: no step, and a silent group costs nothing.
//!
//! Real-time: after [`Bank::new`] nothing allocates, and work is bounded by the number of partials.

use fearless_simd::{Level, Simd, dispatch};

use super::kernel::{BLOCK, FRAME, GROUP, Group, Phasors, Sums, respond, ring, ring_beside, ring_driven, times};
use super::pulse::{MOST_DECAYS, Pulse};
use soffio_math::{PI, exp, sincos};

/// Largest amplitude that a single hit may give all partials together; beyond is nonsense, not loud.
const LOUDEST: f64 = 1000.0;
/// Blocks between two looks for groups that are over.
const LOOK: u32 = 8;
/// Partials above this part of the sample rate are left out.
const HIGHEST: f64 = 0.49;
/// Fastest decay, 1/s: a T60 of 1 ms. Whatever decays faster is a click, not a partial.
const FASTEST: f64 = 7000.0;

/// Shorter contacts are an impulse, s.
const SHORTEST: f64 = 1e-12;

/// A partial of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Partial {
    /// Hz.
    pub frequency: f64,
    /// c, 1/s; T60 = 6.908/c.
    pub decay: f64,
}

impl Partial {
    /// Whether a bank at this rate can play it.
    pub fn is_playable(&self, sample_rate: f64) -> bool {
        let fine = self.frequency > 0.0 && self.decay >= 0.0 && self.decay.is_finite();
        fine && self.frequency < HIGHEST * sample_rate
    }
}

/// cos and sin of an angle.
fn turn(angle: f64) -> [f64; 2] {
    let (s, c) = sincos(angle);
    [c, s]
}

/// Whether a group is heard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Life {
    Silent,
    Ringing,
    /// Fades over the next block.
    Leaving,
}

/// A body's partials and how they ring now.
pub struct Bank {
    level: Level,
    sample_rate: f64,
    partials: Vec<Partial>,
    /// cos and sin of the turn per sample.
    turns: Vec<[f64; 2]>,
    /// Decay beyond the partial's own, 1/s.
    touch: Vec<f64>,
    fastest: f64,
    groups: Vec<Group>,
    lives: Vec<Life>,
    /// Σ |z|² of each group when last looked at.
    energies: Vec<f64>,
    /// K and G of the hit in hand, group by group.
    hit: Vec<[Phasors<f64>; 2]>,
    /// First samples of the response to a force: now, and at the end of the next block.
    response: [[f32; FRAME]; 2],
    /// Whether those two differ.
    moves: bool,
    /// Σ |z|² below which a group is over.
    threshold: f64,
    blocks: u32,
}

impl Bank {
    /// A silent bank. All partials must be playable; those that are not stay silent.
    pub fn new(partials: &[Partial], sample_rate: f64, level: Level) -> Self {
        let count = partials.len().div_ceil(GROUP);
        let mut bank = Self {
            level,
            sample_rate,
            partials: partials.to_vec(),
            turns: partials.iter().map(|p| turn(2.0 * PI * p.frequency / sample_rate)).collect(),
            touch: vec![0.0; partials.len()],
            fastest: 0.0,
            groups: vec![Group::empty(); count],
            lives: vec![Life::Silent; count],
            energies: vec![0.0; count],
            hit: vec![[[[0.0; GROUP]; 2]; 2]; count],
            response: [[0.0; FRAME]; 2],
            moves: false,
            threshold: 0.0,
            blocks: 0,
        };
        for (i, partial) in partials.iter().enumerate().filter(|(_, p)| p.is_playable(sample_rate)) {
            bank.groups[i / GROUP].count = i % GROUP + 1;
            bank.tune(i);
            bank.fastest = bank.fastest.max(partial.decay.min(FASTEST));
        }
        bank
    }

    /// The partials, in the order in which they were given.
    pub fn partials(&self) -> &[Partial] {
        &self.partials
    }

    /// Samples by which a contact can reach into what is ahead, at most: room that a caller of [`Self::strike`] keeps,
    /// for contacts of up to `longest` s.
    pub fn reach(longest: f64, sample_rate: f64) -> usize {
        (longest * sample_rate).ceil() as usize + 2 * BLOCK
    }

    /// A group is over when its amplitude, the root of its Σ |z|², falls below this.
    pub fn set_threshold(&mut self, amplitude: f64) {
        self.threshold = amplitude * amplitude;
    }

    /// Partials that ring now, group by group.
    pub fn ringing(&self) -> usize {
        self.groups.iter().zip(&self.lives).filter(|(_, life)| **life != Life::Silent).map(|(g, _)| g.count).sum()
    }

    /// The quietest group that rings: its number and its amplitude when last looked at.
    pub fn quietest(&self) -> Option<(usize, f64)> {
        let ringing = (0..self.groups.len()).filter(|&g| self.lives[g] == Life::Ringing);
        ringing.map(|g| (g, self.energies[g].sqrt())).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Lets a group fade over the next block; partials that fall silent by it.
    pub fn leave(&mut self, group: usize) -> usize {
        if self.lives[group] != Life::Ringing {
            return 0;
        }
        self.lives[group] = Life::Leaving;
        self.groups[group].count
    }

    /// Silent at once.
    pub fn clear(&mut self) {
        for (group, life) in self.groups.iter_mut().zip(&mut self.lives) {
            group.state = [[0.0; GROUP]; 2];
            *life = Life::Silent;
        }
    }

    /// Raises the decay of each partial by so much, 1/s: something rests on the body. Phasors stay, so nothing clicks.
    pub fn damp(&mut self, more: impl Fn(usize) -> f64) {
        for i in 0..self.partials.len() {
            let more = more(i);
            let more = if more > 0.0 { more.min(FASTEST) } else { 0.0 };
            if more != self.touch[i] {
                self.touch[i] = more;
                self.tune(i);
            }
        }
        let decays = (0..self.partials.len()).map(|i| self.decay(i));
        self.fastest = decays.fold(0.0, f64::max);
    }

    /// c of a partial now, 1/s.
    fn decay(&self, i: usize) -> f64 {
        (self.partials[i].decay + self.touch[i]).min(FASTEST)
    }

    fn tune(&mut self, i: usize) {
        let shrink = exp(-self.decay(i) / self.sample_rate);
        let [c, s] = self.turns[i];
        self.groups[i / GROUP].tune(i % GROUP, [shrink * c, shrink * s]);
    }

    /// A hit of `duration` s gives partial i the amplitude `amplitude(i)`, times the spectrum of its pulse.
    ///
    /// It falls `since` samples after the start of the block that was rendered last, 0 < since ≤ [`BLOCK`]. What is
    /// heard of it in that block and, during the contact, in those after it is added to `ahead`, which begins with that
    /// block. The answer is the sample of `ahead` behind the last that was changed; `None` when the numbers are not
    /// finite or absurdly large, and then nothing was changed.
    pub fn strike(
        &mut self,
        amplitude: impl Fn(usize) -> f64,
        duration: f64,
        since: usize,
        ahead: &mut [f32],
    ) -> Option<usize> {
        let pulse = Pulse::new(duration.min(MOST_DECAYS / self.fastest.max(1.0)).max(SHORTEST));
        let rest = BLOCK - since.clamp(1, BLOCK);
        let mut shared = [0.0; 2];
        let mut loudness = 0.0;
        for (g, hit) in self.hit.iter_mut().enumerate() {
            *hit = [[[0.0; GROUP]; 2]; 2];
            let (mut energy, mut common) = (0.0, [0.0; 2]);
            for i in 0..self.groups[g].count {
                let n = g * GROUP + i;
                let a = amplitude(n);
                if a == 0.0 || !self.partials[n].is_playable(self.sample_rate) {
                    continue;
                }
                let decay = (self.partials[n].decay + self.touch[n]).min(FASTEST);
                let omega = 2.0 * PI * self.partials[n].frequency;
                let (k, ring) = pulse.ringing(decay, omega);
                let (k, ring) = (k.map(|x| a * x), ring.map(|x| a * x));
                let sinusoid = pulse.shared(decay, omega, k);
                (hit[0][0][i], hit[0][1][i]) = (k[0], k[1]);
                (hit[1][0][i], hit[1][1][i]) = (ring[0], ring[1]);
                common = [common[0] + sinusoid[0], common[1] + sinusoid[1]];
                energy += ring[0] * ring[0] + ring[1] * ring[1];
                loudness += a.abs();
            }
            // What nobody hears is not begun.
            if self.lives[g] == Life::Silent && energy < self.threshold {
                *hit = [[[0.0; GROUP]; 2]; 2];
                continue;
            }
            shared = [shared[0] + common[0], shared[1] + common[1]];
        }
        if loudness.is_nan() || loudness >= LOUDEST {
            return None;
        }
        self.ring_on(rest);
        let contact = pulse.samples(self.sample_rate);
        let end = contact.max(rest).min(ahead.len().saturating_sub(BLOCK - rest));
        let heard = &mut ahead[BLOCK - rest..][..end];
        dispatch!(self.level, simd => self.hear(simd, contact, rest, heard));
        for (j, y) in heard.iter_mut().enumerate().take(contact) {
            let [c, s] = pulse.sinusoid(j as f64 / self.sample_rate);
            *y += (shared[0] * c + shared[1] * s) as f32;
        }
        Some(BLOCK - rest + end)
    }

    /// What the hit in hand leaves, `rest` samples before the next block: into the phasors.
    fn ring_on(&mut self, rest: usize) {
        for (g, [_, hit]) in self.hit.iter().enumerate() {
            let mut changed = false;
            for i in 0..self.groups[g].count {
                let z = [hit[0][i], hit[1][i]];
                if z != [0.0; 2] {
                    let z = times(z, self.groups[g].power(i, rest));
                    self.groups[g].state[0][i] += z[0];
                    self.groups[g].state[1][i] += z[1];
                    changed = true;
                }
            }
            if changed {
                self.lives[g] = Life::Ringing;
                self.energies[g] = self.groups[g].energy();
            }
        }
    }

    /// The samples of the hit in hand: K rings during the contact, G after it; from sample `rest` on the phasors ring by
    /// themselves as if there had been G from the beginning.
    #[inline(always)]
    fn hear<S: Simd>(&mut self, simd: S, contact: usize, rest: usize, heard: &mut [f32]) {
        for (block, heard) in heard.chunks_mut(BLOCK).enumerate() {
            let start = block * BLOCK;
            let (mut touching, mut free) = (Sums::silent(simd), Sums::silent(simd));
            for (group, [k, g]) in self.groups.iter().zip(&mut self.hit) {
                if group.count > 0 && g.iter().flatten().any(|x| *x != 0.0) {
                    if start < contact {
                        ring_beside(simd, group, k, &mut touching);
                    }
                    ring_beside(simd, group, g, &mut free);
                }
            }
            let (touching, free) = (touching.samples(), free.samples());
            for (j, y) in heard.iter_mut().enumerate() {
                let at = start + j;
                if at < contact {
                    *y += touching[j];
                }
                if (at < contact) != (at < rest) {
                    *y += if at < rest { free[j] } else { -free[j] };
                }
            }
        }
    }

    /// Where a force acts from now on: partial i answers an impulse of the force by `gain(i)`.
    pub fn push_at(&mut self, gain: impl Fn(usize) -> f64) {
        self.push_towards(gain);
        self.arrive();
    }

    /// Where a force acts that moves on: from where it is now, over the next block that is rendered, to there.
    pub fn push_towards(&mut self, gain: impl Fn(usize) -> f64) {
        self.moves = true;
        self.response[1] = [0.0; FRAME];
        for (i, partial) in self.partials.iter().enumerate() {
            let b = if partial.is_playable(self.sample_rate) { gain(i) as f32 } else { 0.0 };
            let group = &mut self.groups[i / GROUP];
            group.push[1][i % GROUP] = b;
            for (h, im) in self.response[1].iter_mut().zip(&group.rows[i % GROUP][1]) {
                *h += b * im;
            }
        }
    }

    /// A force that moved is where it was going.
    fn arrive(&mut self) {
        if std::mem::take(&mut self.moves) {
            self.groups.iter_mut().for_each(|group| group.push[0] = group.push[1]);
            self.response[0] = self.response[1];
        }
    }

    /// Adds the next block to `out`; with a force at each of its samples, what that adds too, now and from now on.
    pub fn render(&mut self, force: Option<&[f32; BLOCK]>, out: &mut [f32; BLOCK]) {
        let look = self.blocks.is_multiple_of(LOOK);
        self.blocks = self.blocks.wrapping_add(1);
        dispatch!(self.level, simd => self.render_in(simd, force, look, out));
        if let Some(force) = force {
            respond(force, &self.response, out);
        }
        self.arrive();
    }

    #[inline(always)]
    fn render_in<S: Simd>(&mut self, simd: S, force: Option<&[f32; BLOCK]>, look: bool, out: &mut [f32; BLOCK]) {
        let (mut sums, mut leaving) = (Sums::silent(simd), Sums::silent(simd));
        let mut fades = false;
        for ((group, life), energy) in self.groups.iter_mut().zip(&mut self.lives).zip(&mut self.energies) {
            if let Some(force) = force {
                *life = Life::Ringing;
                ring_driven(simd, group, force, &mut sums);
                continue;
            }
            if *life == Life::Silent {
                continue;
            }
            if look {
                *energy = group.energy();
                if *energy < self.threshold {
                    *life = Life::Leaving;
                }
            }
            if *life == Life::Ringing {
                ring(simd, group, &mut sums);
                continue;
            }
            ring(simd, group, &mut leaving);
            group.state = [[0.0; GROUP]; 2];
            (*life, *energy) = (Life::Silent, 0.0);
            fades = true;
        }
        for (y, sum) in out.iter_mut().zip(sums.samples()) {
            *y += sum;
        }
        if fades {
            for (j, (y, last)) in out.iter_mut().zip(leaving.samples()).enumerate() {
                *y += last * (1.0 - (j + 1) as f32 / BLOCK as f32);
            }
        }
    }
}
