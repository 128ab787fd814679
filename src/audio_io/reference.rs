//! What the loudspeaker played while the microphone listened: the detector's reference.
//!
//! The two devices deliver in blocks of their own length and at their own rate. The tap reads as much of the
//! loudspeaker's ring as fits the microphone's samples, interpolating linearly between rates, and keeps
//! the ring's backlog small, so that both are aligned by time of arrival to within a block.

use rtrb::Consumer;

/// Backlog that is tolerated, and what it is cut down to, s.
const BACKLOG: (f64, f64) = (0.1, 0.02);

/// Reads the reference at the microphone's pace.
#[derive(Clone, Debug, Default)]
pub struct ReferenceTap {
    /// The two samples between which the output lies, and where.
    between: [f32; 2],
    phase: f64,
}

impl ReferenceTap {
    /// Appends `count` samples at `rate` from a ring at `ring_rate`, Hz. Where the ring has run dry, silence.
    pub fn read(&mut self, ring: &mut Consumer<f32>, ring_rate: u32, rate: u32, count: usize, into: &mut Vec<f32>) {
        let step = f64::from(ring_rate) / f64::from(rate.max(1));
        for _ in 0..count {
            while self.phase >= 1.0 {
                self.between = [self.between[1], ring.pop().unwrap_or(0.0)];
                self.phase -= 1.0;
            }
            into.push(self.between[0] + (self.between[1] - self.between[0]) * self.phase as f32);
            self.phase += step;
        }
        let backlog = |seconds: f64| (seconds * f64::from(ring_rate)) as usize;
        if ring.slots() > backlog(BACKLOG.0) {
            let surplus = ring.slots() - backlog(BACKLOG.1);
            if let Ok(chunk) = ring.read_chunk(surplus) {
                chunk.commit_all();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_stays_a_ramp_at_another_rate() {
        // f32 rounding of values up to 500.
        const TOLERANCE: f32 = 1e-3;
        let (mut to, mut from) = rtrb::RingBuffer::new(1000);
        (0..400).for_each(|i| to.push(i as f32).expect("room"));
        let mut tap = ReferenceTap::default();
        let mut out = Vec::new();
        for count in [1, 60, 7, 132] {
            tap.read(&mut from, 48_000, 44_100, count, &mut out);
        }
        assert_eq!(out.len(), 200);
        // After the first two samples, which come from silence.
        let step = 48_000.0 / 44_100.0;
        assert!(out[3..].windows(2).all(|w| (w[1] - w[0] - step).abs() < TOLERANCE), "{out:?}");
        tap.read(&mut from, 48_000, 48_000, 1000, &mut out);
        assert_eq!(out[1199], 0.0);
    }

    #[test]
    fn a_backlog_is_cut() {
        let (mut to, mut from) = rtrb::RingBuffer::new(20_000);
        (0..10_000).for_each(|_| to.push(1.0).expect("room"));
        ReferenceTap::default().read(&mut from, 48_000, 48_000, 480, &mut Vec::new());
        assert_eq!(from.slots(), 960);
    }
}
