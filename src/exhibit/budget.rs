//! What one exhibit may cost: memory and processor time, summed over all its files.
//!
//! Readers charge what a header says before they read or decode the data behind it: buffers, decoded images, thumbnails, meshes,
//! hulls, wind surfaces and recordings. So a short file that claims gigabytes is refused with a located message, and takes no
//! memory. Limits of a single file or image lie with their readers.

use std::cell::Cell;
use std::fmt;
use std::time::Duration;

use super::codes;
use super::diagnostic::Diagnostic;

/// Most memory of an exhibit, bytes. The largest shipped exhibit takes 40 MB, and the smallest kiosk computer has 4 GB, of which
/// the old exhibit, the new one and the picture of each need their share.
pub const MAX_MEMORY: u64 = 512 << 20;
/// Most processor time of loading an exhibit. The slowest shipped exhibit takes 1 s.
pub const MAX_TIME: Duration = Duration::from_secs(10);
/// Bytes of a megabyte in messages.
const MEGABYTE: u64 = 1 << 20;

/// What an exhibit has cost so far.
#[derive(Debug)]
pub struct Budget {
    used: Cell<u64>,
    /// Processor time of this thread. The core reads no clock, so a caller brings it.
    clock: fn() -> Duration,
    began: Duration,
}

/// An exhibit costs too much.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excess {
    /// Bytes that it would need in all.
    Memory(u64),
    /// Processor time that it has taken.
    Time(Duration),
}

impl Default for Budget {
    /// A budget of memory alone.
    fn default() -> Self {
        Self::timed(|| Duration::ZERO)
    }
}

impl Budget {
    /// A budget of memory and of the processor time that `clock` returns.
    pub fn timed(clock: fn() -> Duration) -> Self {
        Self { used: Cell::new(0), clock, began: clock() }
    }

    /// Adds memory that is about to be taken, bytes.
    ///
    /// # Errors
    /// Memory or time is exceeded; the memory does not count then.
    pub fn charge(&self, bytes: u64) -> Result<(), Excess> {
        self.check_time()?;
        let all = self.used.get().saturating_add(bytes);
        if all > MAX_MEMORY {
            return Err(Excess::Memory(all));
        }
        self.used.set(all);
        Ok(())
    }

    /// Charges memory that is needed for a moment only: it must be there, and does not count afterwards.
    ///
    /// # Errors
    /// As of [`Self::charge`].
    pub fn charge_briefly(&self, bytes: u64) -> Result<(), Excess> {
        self.charge(bytes)?;
        self.used.set(self.used.get() - bytes);
        Ok(())
    }

    /// Has loading taken too long?
    ///
    /// # Errors
    /// It has.
    pub fn check_time(&self) -> Result<(), Excess> {
        let spent = (self.clock)().saturating_sub(self.began);
        if spent > MAX_TIME { Err(Excess::Time(spent)) } else { Ok(()) }
    }

    /// Memory charged so far, bytes.
    pub fn used(&self) -> u64 {
        self.used.get()
    }
}

impl Excess {
    /// What to do.
    pub fn help(self) -> &'static str {
        match self {
            Self::Memory(_) => {
                "make images smaller (gltf-transform resize --width 2048 --height 2048 in.glb out.glb), simplify meshes, \
                 shorten recordings"
            }
            Self::Time(_) => "simplify the meshes (gltf-transform simplify in.glb out.glb), or split the exhibit",
        }
    }

    /// As a diagnostic of `what`, such as a file.
    pub fn diagnostic(self, what: impl fmt::Display) -> Diagnostic {
        Diagnostic::new(codes::BUDGET, format!("{what}: {self}")).help(self.help())
    }
}

impl fmt::Display for Excess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory(bytes) => {
                let (needed, most) = (bytes.div_ceil(MEGABYTE), MAX_MEMORY / MEGABYTE);
                write!(f, "with it the exhibit needs {needed} MB of memory; the limit is {most} MB")
            }
            Self::Time(spent) => {
                let (spent, most) = (spent.as_secs_f64(), MAX_TIME.as_secs());
                write!(f, "loading has taken {spent:.1} s of processor time; the limit is {most} s")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_adds_up_and_what_is_refused_does_not_count() {
        let budget = Budget::default();
        budget.charge(MAX_MEMORY - 10).expect("within");
        assert_eq!(budget.charge(11), Err(Excess::Memory(MAX_MEMORY + 1)));
        budget.charge_briefly(10).expect("within");
        budget.charge(10).expect("within, as the last one was for a moment");
        assert_eq!(budget.charge(u64::MAX), Err(Excess::Memory(u64::MAX)));
        assert_eq!(budget.used(), MAX_MEMORY);
    }

    #[test]
    fn time_counts_from_the_beginning() {
        thread_local!(static NOW: Cell<u64> = const { Cell::new(100) });
        let budget = Budget::timed(|| Duration::from_secs(NOW.get()));
        NOW.set(110);
        budget.charge(1).expect("10 s");
        NOW.set(111);
        assert_eq!(budget.charge(1), Err(Excess::Time(Duration::from_secs(11))));
    }
}
