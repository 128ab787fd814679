//! A delay with feedback.

use crate::bounds::INAUDIBLE;
/// The line, how much of it is in use, and the sample that comes out next.
#[derive(Clone, Default)]
pub(super) struct DelayLine {
    line: Vec<f32>,
    used: usize,
    at: usize,
    /// Samples until what is on the line has come out.
    tail: usize,
}

impl DelayLine {
    /// Room for a delay of so many samples. Allocates.
    pub fn allocate(&mut self, longest: usize) {
        if self.line.len() < longest {
            self.line.resize(longest, 0.0);
        }
    }

    /// The same room, with nothing in use. Real-time.
    pub fn into_empty(self) -> Self {
        Self { line: self.line, ..Self::default() }
    }

    /// A silent delay of so many samples, or as many as there is room for.
    pub fn begin(&mut self, samples: usize) {
        self.used = samples.min(self.line.len());
        self.line[..self.used].fill(0.0);
    }

    /// Whether something is still to come out that went in.
    pub fn holds(&self) -> bool {
        self.tail > 0
    }

    /// The next samples: what went in before, of which `feedback` goes in again.
    pub fn render(&mut self, feedback: f32, input: &[f32], out: &mut [f32]) {
        if self.used == 0 {
            out.copy_from_slice(input);
            return;
        }
        for (y, x) in out.iter_mut().zip(input) {
            *y = self.line[self.at];
            let again = x + feedback * *y;
            // Denormal numbers are slow and not heard.
            self.line[self.at] = if again.abs() < 1e-20 { 0.0 } else { again };
            // What is not heard on the line is not waited for.
            self.tail = if again.abs() > INAUDIBLE as f32 { self.used } else { self.tail.saturating_sub(1) };
            self.at = if self.at + 1 == self.used { 0 } else { self.at + 1 };
        }
    }
}
