//! What the loudspeaker played while the microphone listened: the detector's reference.
//!
//! The two devices deliver in blocks of their own length and at their own rate. The tap reads as much of the
//! loudspeaker's ring as fits the microphone's samples, interpolating linearly between rates, and keeps
//! the ring's backlog small, so that both are aligned by time of arrival to within a few blocks. What was played is
//! heard later than it arrives here, by the latency of both devices; a backlog would hide that order.

use rtrb::Consumer;

/// Backlog that is tolerated, s: the loudspeaker's blocks come in bursts.
const BACKLOG: f64 = 0.04;

/// Reads the reference at the microphone's pace.
#[derive(Clone, Debug, Default)]
pub struct ReferenceTap {
    /// The two samples between which the output lies, and where.
    between: [f32; 2],
    phase: f64,
    /// Whether it has read before.
    begun: bool,
}

impl ReferenceTap {
    /// Appends `count` samples at `rate` from a ring at `ring_rate`, Hz. Where the ring has run dry, silence.
    pub fn read(&mut self, ring: &mut Consumer<f32>, ring_rate: u32, rate: u32, count: usize, into: &mut Vec<f32>) {
        let step = f64::from(ring_rate) / f64::from(rate.max(1));
        // What came before the microphone listened is left out, and so is a backlog beyond the usual.
        let due = (count as f64 * step).ceil() as usize;
        let surplus = ring.slots().saturating_sub(due);
        if (!self.begun || surplus > (BACKLOG * f64::from(ring_rate)) as usize)
            && let Ok(chunk) = ring.read_chunk(surplus)
        {
            chunk.commit_all();
        }
        self.begun = true;
        for _ in 0..count {
            while self.phase >= 1.0 {
                self.between = [self.between[1], ring.pop().unwrap_or(0.0)];
                self.phase -= 1.0;
            }
            into.push(self.between[0] + (self.between[1] - self.between[0]) * self.phase as f32);
            self.phase += step;
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
        tap.begun = true;
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
    fn what_came_before_and_a_backlog_are_left_out() {
        let (mut to, mut from) = rtrb::RingBuffer::new(20_000);
        let mut send = |n: usize| (0..n).for_each(|i| to.push(i as f32).expect("room"));
        let mut tap = ReferenceTap::default();
        let mut out = Vec::new();
        send(1000);
        tap.read(&mut from, 48_000, 48_000, 480, &mut out);
        // The newest 480 of them, behind the two between which the interpolation lies.
        assert_eq!((out.len(), out[479], from.slots()), (480, 997.0, 1));
        send(1440);
        tap.read(&mut from, 48_000, 48_000, 480, &mut out);
        assert_eq!(from.slots(), 961);
        send(5000);
        tap.read(&mut from, 48_000, 48_000, 480, &mut out);
        assert_eq!((out.len(), from.slots()), (1440, 0));
    }
}
