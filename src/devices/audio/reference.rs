//! Reference signal of the detector: the output of the same time as the microphone's samples.
//!
//! The two devices deliver in blocks of their own length and at their own rate. The tap reads as much of the
//! output's ring as fits the microphone's samples, interpolating linearly between rates, so that both are aligned
//! by time of arrival to within a few blocks. What was played is heard later than it arrives here, by the latency of both
//! devices; a backlog in the ring would hide that order.
//!
//! Two crystals drift apart by up to some hundred millionths, 0.4 s in an hour. The tap reads faster by as much as the
//! mean backlog b is too long:
//!
//! ```text
//! step = ring rate / rate · (1 + (b − target) / PULL)
//! ```
//!
//! so a drift δ ends in a constant shift of δ · PULL (3 ms at 300 millionths), and never in a jump.

use rtrb::Consumer;

/// Backlog that is tolerated at once, s: the loudspeaker's blocks come in bursts.
const BACKLOG: f64 = 0.1;
/// Mean backlog that is kept, s: half a long block.
const TARGET: f64 = 0.01;
/// A backlog that is too long is read away within this time, s.
const PULL: f64 = 10.0;
/// The mean is taken over this time, s.
const MEAN: f64 = 2.0;
/// Crystals are never farther apart than this; the rest is a burst.
const MOST_DRIFT: f64 = 2e-3;

/// Reads the reference at the microphone's pace.
#[derive(Clone, Debug)]
pub struct ReferenceTap {
    /// The two samples between which the output lies, and where.
    between: [f32; 2],
    phase: f64,
    /// Mean backlog, s; `None` before the first read.
    backlog: Option<f64>,
    /// The one that is kept, s.
    target: f64,
}

impl Default for ReferenceTap {
    fn default() -> Self {
        Self { between: [0.0; 2], phase: 0.0, backlog: None, target: TARGET }
    }
}

impl ReferenceTap {
    /// One that keeps so much in the ring, s, and finds it there.
    pub fn keeping(target: f64) -> Self {
        Self { backlog: Some(target), target, ..Self::default() }
    }

    /// Appends `count` samples at `rate` from a ring at `ring_rate`, Hz. Where the ring has run dry, silence.
    pub fn read(&mut self, ring: &mut Consumer<f32>, ring_rate: u32, rate: u32, count: usize, into: &mut Vec<f32>) {
        let (nominal, seconds) = (f64::from(ring_rate) / f64::from(rate.max(1)), count as f64 / f64::from(rate.max(1)));
        // What came before the microphone listened is left out, and so is a backlog beyond the usual.
        let due = (count as f64 * nominal).ceil() as usize;
        let surplus = ring.slots().saturating_sub(due);
        let mut left = surplus as f64 / f64::from(ring_rate);
        if (self.backlog.is_none() || left > BACKLOG + self.target - TARGET)
            && let Ok(chunk) = ring.read_chunk(surplus)
        {
            chunk.commit_all();
            left = 0.0;
        }
        let mean = self.backlog.get_or_insert(self.target);
        *mean += (seconds / MEAN).min(1.0) * (left - *mean);
        let step = nominal * (1.0 + ((*mean - self.target) / PULL).clamp(-MOST_DRIFT, MOST_DRIFT));
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
        // f32 rounding of values up to 500, and the pull on a backlog that is shorter than wanted.
        const TOLERANCE: f32 = 2e-3;
        let (mut to, mut from) = rtrb::RingBuffer::new(1000);
        (0..400).for_each(|i| to.push(i as f32).expect("room"));
        let mut tap = ReferenceTap { backlog: Some(TARGET), ..ReferenceTap::default() };
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
    fn what_came_before_and_a_burst_are_left_out() {
        let (mut to, mut from) = rtrb::RingBuffer::new(20_000);
        let mut send = |n: usize| (0..n).for_each(|i| to.push(i as f32).expect("room"));
        let mut tap = ReferenceTap::default();
        let mut out = Vec::new();
        send(1000);
        tap.read(&mut from, 48_000, 48_000, 480, &mut out);
        // The newest 480 of them, behind the two between which the interpolation lies.
        assert!(out.len() == 480 && from.slots() < 3, "{}", from.slots());
        assert!((out[479] - 997.0).abs() < 0.5, "{}", out[479]);
        send(1440);
        tap.read(&mut from, 48_000, 48_000, 480, &mut out);
        assert!(from.slots().abs_diff(961) < 3, "{}: an ordinary burst waits", from.slots());
        send(9000);
        tap.read(&mut from, 48_000, 48_000, 480, &mut out);
        assert!(from.slots() < 3, "{}: a standstill is skipped", from.slots());
    }

    #[test]
    fn crystals_that_drift_apart_do_not_shift_what_was_played() {
        /// One block: what blocks of two lengths beat by.
        const BLOCK_S: f64 = 0.01;
        // As much in ten minutes as 100 millionths are in an hour.
        for drift in [6e-4, -6e-4] {
            let (mut to, mut from) = rtrb::RingBuffer::new(48_000);
            let mut tap = ReferenceTap::default();
            let (mut out, mut played, mut lags) = (Vec::new(), 0_u64, Vec::new());
            for block in 1..=60_000_u64 {
                // Blocks of 10 ms from a loudspeaker whose second is a little shorter or longer.
                let due = (block as f64 * 480.0 * (1.0 + drift)) as u64;
                while played < due {
                    to.push((played % 96_000) as f32).expect("room");
                    played += 1;
                }
                out.clear();
                tap.read(&mut from, 48_000, 48_000, 480, &mut out);
                // Frames that the newest sample here lies behind the newest that was played.
                let behind = (played as f64 - 1.0 - f64::from(out[479])).rem_euclid(96_000.0);
                lags.push(behind / 48_000.0);
            }
            let settled = &lags[6_000..];
            let (low, high) = settled.iter().fold((1.0_f64, 0.0_f64), |(l, h), &x| (l.min(x), h.max(x)));
            assert!(high - low < BLOCK_S && high < 2.0 * BLOCK_S, "drift {drift}: {low} to {high} s");
        }
    }
}
