//! Modal bank: the partials of one body, y(t) = Σ a e^(−c t) sin(ω t), with impacts, a driving force and damping.
//!
//! Time advances in blocks of [`BLOCK`] samples on the synth's grid. An impact may fall anywhere within a block. Its
//! contribution to the block that is playing, and to later ones while the contact lasts, is added to the caller's look-ahead
//! samples; the free decay is added to the phasors.
//!
//! Partials end in groups of [`GROUP`]. They should be sorted by decay, so that those of one group end together. A group below
//! the threshold fades over one last block; a silent group costs nothing.
//!
//! Real-time: after [`Bank::new`] nothing allocates, and work is bounded by the number of partials.

use crate::bounds::FAULT_LEVEL;
use fearless_simd::{Level, Simd, dispatch};

use super::kernel::{BLOCK, FRAME, GROUP, Group, Phasors, Sums, add_response, ring, ring_beside, ring_driven, times};
use super::pulse::{MOST_DECAYS, Pulse};
use soffio_math::{PI, exp, sincos};

/// Largest amplitude of an impact, all partials together, of full scale; greater ones are invalid.
const MAX_LOUDNESS: f64 = FAULT_LEVEL as f64;
/// Blocks between two measurements of the groups' energies: 11 ms at 48 kHz, so that the measuring costs little.
const ENERGY_INTERVAL: u32 = 8;
/// Partials above this part of the sample rate are left out: a little below half of it, where they would alias.
const MAX_FREQUENCY: f64 = 0.49;
/// Fastest decay, 1/s: a T60 of 1 ms. Faster decays are clicks, not partials.
const MAX_DECAY: f64 = 7000.0;

/// Contacts shorter than this are an impulse, s: far below a sample.
const MIN_CONTACT: f64 = 1e-12;

/// A partial of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Partial {
    /// Frequency, Hz.
    pub frequency: f64,
    /// c, 1/s; T60 = 6.908/c.
    pub decay: f64,
}

impl Partial {
    /// Whether a bank at this rate can play it.
    pub fn is_playable(&self, sample_rate: f64) -> bool {
        let valid = self.frequency > 0.0 && self.decay >= 0.0 && self.decay.is_finite();
        valid && self.frequency < MAX_FREQUENCY * sample_rate
    }
}

/// cos and sin of an angle.
fn rotator(angle: f64) -> [f64; 2] {
    let (s, c) = sincos(angle);
    [c, s]
}

/// State of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GroupState {
    Silent,
    Ringing,
    /// Fading over the next block.
    Releasing,
}

/// The partials of a body and their phasors.
pub struct Bank {
    level: Level,
    sample_rate: f64,
    partials: Vec<Partial>,
    /// e^(iω/fs) of each partial: cos and sin.
    rotators: Vec<[f64; 2]>,
    /// Decay by contacts beyond the partial's own, 1/s.
    damping: Vec<f64>,
    max_decay: f64,
    groups: Vec<Group>,
    states: Vec<GroupState>,
    /// Σ |z|² of each group when last measured.
    energies: Vec<f64>,
    /// K and G of the current impact, group by group.
    contact: Vec<[Phasors<f64>; 2]>,
    /// First samples of the response to a force: now, and at the end of the next block.
    response: [[f32; FRAME]; 2],
    /// Whether the drive point is moving.
    gliding: bool,
    /// Σ |z|² below which a group ends.
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
            rotators: partials.iter().map(|p| rotator(2.0 * PI * p.frequency / sample_rate)).collect(),
            damping: vec![0.0; partials.len()],
            max_decay: 0.0,
            groups: vec![Group::empty(); count],
            states: vec![GroupState::Silent; count],
            energies: vec![0.0; count],
            contact: vec![[[[0.0; GROUP]; 2]; 2]; count],
            response: [[0.0; FRAME]; 2],
            gliding: false,
            threshold: 0.0,
            blocks: 0,
        };
        for (i, partial) in partials.iter().enumerate().filter(|(_, p)| p.is_playable(sample_rate)) {
            bank.groups[i / GROUP].count = i % GROUP + 1;
            bank.tune(i);
            bank.max_decay = bank.max_decay.max(partial.decay.min(MAX_DECAY));
        }
        bank
    }

    /// The partials, in the order in which they were given.
    pub fn partials(&self) -> &[Partial] {
        &self.partials
    }

    /// Length of the look-ahead samples that [`Self::strike`] needs for contacts of up to `longest` s.
    pub fn look_ahead_len(longest: f64, sample_rate: f64) -> usize {
        (longest * sample_rate).ceil() as usize + 2 * BLOCK
    }

    /// A group ends when its amplitude, the root of its Σ |z|², falls below this.
    pub fn set_threshold(&mut self, amplitude: f64) {
        self.threshold = amplitude * amplitude;
    }

    /// Partials that ring now, group by group.
    pub fn ringing(&self) -> usize {
        self.groups
            .iter()
            .zip(&self.states)
            .filter(|(_, state)| **state != GroupState::Silent)
            .map(|(g, _)| g.count)
            .sum()
    }

    /// The quietest ringing group: its index and its amplitude when last measured.
    pub fn quietest(&self) -> Option<(usize, f64)> {
        let ringing = (0..self.groups.len()).filter(|&g| self.states[g] == GroupState::Ringing);
        ringing.map(|g| (g, self.energies[g].sqrt())).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Releases a group over the next block. Returns its number of partials.
    pub fn release(&mut self, group: usize) -> usize {
        if self.states[group] != GroupState::Ringing {
            return 0;
        }
        self.states[group] = GroupState::Releasing;
        self.groups[group].count
    }

    /// Silent at once.
    pub fn clear(&mut self) {
        for (group, state) in self.groups.iter_mut().zip(&mut self.states) {
            group.state = [[0.0; GROUP]; 2];
            *state = GroupState::Silent;
        }
    }

    /// Sets the additional decay of each partial by contacts, 1/s. Phasors are kept, so nothing clicks.
    pub fn damp(&mut self, more: impl Fn(usize) -> f64) {
        for i in 0..self.partials.len() {
            let more = more(i);
            let more = if more > 0.0 { more.min(MAX_DECAY) } else { 0.0 };
            if more != self.damping[i] {
                self.damping[i] = more;
                self.tune(i);
            }
        }
        let decays = (0..self.partials.len()).map(|i| self.decay(i));
        self.max_decay = decays.fold(0.0, f64::max);
    }

    /// c of a partial now, 1/s.
    fn decay(&self, i: usize) -> f64 {
        (self.partials[i].decay + self.damping[i]).min(MAX_DECAY)
    }

    fn tune(&mut self, i: usize) {
        let shrink = exp(-self.decay(i) / self.sample_rate);
        let [c, s] = self.rotators[i];
        self.groups[i / GROUP].tune(i % GROUP, [shrink * c, shrink * s]);
    }

    /// An impact of `duration` s: partial i gets the amplitude `amplitude(i)`, times the spectrum of the pulse.
    ///
    /// It begins `since` samples after the start of the last rendered block, 0 < since ≤ [`BLOCK`]. `look_ahead` begins with that
    /// block and receives the contribution to it and, during the contact, to later blocks. Returns the end of the changed
    /// samples, or `None` without any change if the numbers are not finite or too large.
    pub fn strike(
        &mut self,
        amplitude: impl Fn(usize) -> f64,
        duration: f64,
        since: usize,
        look_ahead: &mut [f32],
    ) -> Option<usize> {
        let pulse = Pulse::new(duration.min(MOST_DECAYS / self.max_decay.max(1.0)).max(MIN_CONTACT));
        let rest = BLOCK - since.clamp(1, BLOCK);
        let mut shared = [0.0; 2];
        let mut loudness = 0.0;
        for (g, contact) in self.contact.iter_mut().enumerate() {
            *contact = [[[0.0; GROUP]; 2]; 2];
            let (mut energy, mut common) = (0.0, [0.0; 2]);
            for i in 0..self.groups[g].count {
                let n = g * GROUP + i;
                let a = amplitude(n);
                if a == 0.0 || !self.partials[n].is_playable(self.sample_rate) {
                    continue;
                }
                let decay = (self.partials[n].decay + self.damping[n]).min(MAX_DECAY);
                let omega = 2.0 * PI * self.partials[n].frequency;
                let response = pulse.response(decay, omega);
                let (k, ring) = (response.during.map(|x| a * x), response.after.map(|x| a * x));
                let sinusoid = pulse.shared(decay, omega, k);
                (contact[0][0][i], contact[0][1][i]) = (k[0], k[1]);
                (contact[1][0][i], contact[1][1][i]) = (ring[0], ring[1]);
                common = [common[0] + sinusoid[0], common[1] + sinusoid[1]];
                energy += ring[0] * ring[0] + ring[1] * ring[1];
                loudness += a.abs();
            }
            // Inaudible groups do not start.
            if self.states[g] == GroupState::Silent && energy < self.threshold {
                *contact = [[[0.0; GROUP]; 2]; 2];
                continue;
            }
            shared = [shared[0] + common[0], shared[1] + common[1]];
        }
        if loudness.is_nan() || loudness >= MAX_LOUDNESS {
            return None;
        }
        self.excite(rest);
        let contact_samples = pulse.samples(self.sample_rate);
        let end = contact_samples.max(rest).min(look_ahead.len().saturating_sub(BLOCK - rest));
        let out = &mut look_ahead[BLOCK - rest..][..end];
        dispatch!(self.level, simd => self.render_contact(simd, contact_samples, rest, out));
        for (j, y) in out.iter_mut().enumerate().take(contact_samples) {
            let [c, s] = pulse.sinusoid(j as f64 / self.sample_rate);
            *y += (shared[0] * c + shared[1] * s) as f32;
        }
        Some(BLOCK - rest + end)
    }

    /// Adds the free decay of the current impact to the phasors; it begins `rest` samples before the next block.
    fn excite(&mut self, rest: usize) {
        for (g, [_, contact]) in self.contact.iter().enumerate() {
            let mut changed = false;
            for i in 0..self.groups[g].count {
                let z = [contact[0][i], contact[1][i]];
                if z != [0.0; 2] {
                    let z = times(z, self.groups[g].power(i, rest));
                    self.groups[g].state[0][i] += z[0];
                    self.groups[g].state[1][i] += z[1];
                    changed = true;
                }
            }
            if changed {
                self.states[g] = GroupState::Ringing;
                self.energies[g] = self.groups[g].energy();
            }
        }
    }

    /// Renders the current impact: K rings during the contact, G after it. From sample `rest` on the phasors already ring as if
    /// G had been there from the start.
    #[inline(always)]
    fn render_contact<S: Simd>(&mut self, simd: S, contact_samples: usize, rest: usize, out: &mut [f32]) {
        for (block, out) in out.chunks_mut(BLOCK).enumerate() {
            let start = block * BLOCK;
            let (mut during, mut after) = (Sums::silent(simd), Sums::silent(simd));
            for (group, [k, g]) in self.groups.iter().zip(&mut self.contact) {
                if group.count > 0 && g.iter().flatten().any(|x| *x != 0.0) {
                    if start < contact_samples {
                        ring_beside(simd, group, k, &mut during);
                    }
                    ring_beside(simd, group, g, &mut after);
                }
            }
            let (during, after) = (during.samples(), after.samples());
            for (j, y) in out.iter_mut().enumerate() {
                let at = start + j;
                if at < contact_samples {
                    *y += during[j];
                }
                if (at < contact_samples) != (at < rest) {
                    *y += if at < rest { after[j] } else { -after[j] };
                }
            }
        }
    }

    /// Sets the point where a force acts: `gain(i)` is the response of partial i to a unit impulse.
    pub fn set_drive_point(&mut self, gain: impl Fn(usize) -> f64) {
        self.glide_drive_point(gain);
        self.finish_glide();
    }

    /// Moves the point where a force acts over the next rendered block; `gain` as in [`Self::set_drive_point`].
    pub fn glide_drive_point(&mut self, gain: impl Fn(usize) -> f64) {
        self.gliding = true;
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

    /// Ends the move of the drive point.
    fn finish_glide(&mut self) {
        if std::mem::take(&mut self.gliding) {
            self.groups.iter_mut().for_each(|group| group.push[0] = group.push[1]);
            self.response[0] = self.response[1];
        }
    }

    /// Adds the next block to `out`, driven by a force at each of its samples, if any.
    pub fn render(&mut self, force: Option<&[f32; BLOCK]>, out: &mut [f32; BLOCK]) {
        let measure_energy = self.blocks.is_multiple_of(ENERGY_INTERVAL);
        self.blocks = self.blocks.wrapping_add(1);
        dispatch!(self.level, simd => self.render_in(simd, force, measure_energy, out));
        if let Some(force) = force {
            add_response(force, &self.response, out);
        }
        self.finish_glide();
    }

    #[inline(always)]
    fn render_in<S: Simd>(
        &mut self,
        simd: S,
        force: Option<&[f32; BLOCK]>,
        measure_energy: bool,
        out: &mut [f32; BLOCK],
    ) {
        let (mut sums, mut releasing) = (Sums::silent(simd), Sums::silent(simd));
        let mut fades = false;
        for ((group, state), energy) in self.groups.iter_mut().zip(&mut self.states).zip(&mut self.energies) {
            if let Some(force) = force {
                *state = GroupState::Ringing;
                ring_driven(simd, group, force, &mut sums);
                continue;
            }
            if *state == GroupState::Silent {
                continue;
            }
            if measure_energy {
                *energy = group.energy();
                if *energy < self.threshold {
                    *state = GroupState::Releasing;
                }
            }
            if *state == GroupState::Ringing {
                ring(simd, group, &mut sums);
                continue;
            }
            ring(simd, group, &mut releasing);
            group.state = [[0.0; GROUP]; 2];
            (*state, *energy) = (GroupState::Silent, 0.0);
            fades = true;
        }
        for (y, sum) in out.iter_mut().zip(sums.samples()) {
            *y += sum;
        }
        if fades {
            for (j, (y, last)) in out.iter_mut().zip(releasing.samples()).enumerate() {
                *y += last * (1.0 - (j + 1) as f32 / BLOCK as f32);
            }
        }
    }
}
