//! Protection of microphone samples in memory: no core dump holds them, and the system writes no ring of them to swap.
//!
//! A core dump is a file with all memory of a process. [`forbid_core_dumps`] stops it twice: the process is not dumpable, which
//! also keeps other programs of the same user from reading its memory, and the largest core file has 0 bytes. [`LockedMemory`]
//! locks the whole pages of a buffer in memory and leaves them out of dumps.
//!
//! Samples are overwritten with zeros where they were used (`zeroize`, whose writes no compiler removes): in the ring of the
//! microphone, in [`MicrophoneSamples`](crate::audio::MicrophoneSamples), and in the detector. The buffers of the sound
//! system's own library are outside this program; it overwrites them with each block.

// Calls of the system that take a range of addresses are unsafe. The ranges here are within a borrowed slice.
#![allow(unsafe_code)]

use std::mem::MaybeUninit;

/// Forbids core dumps of this process, for good. It opens no file and waits for nothing, so every program that opens a
/// microphone calls it first.
///
/// # Errors
/// The system refuses; the message says what it means for staff.
pub fn forbid_core_dumps() -> Result<(), String> {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{DumpableBehavior, Resource, Rlimit, set_dumpable_behavior, setrlimit};
        let none = Rlimit { current: Some(0), maximum: Some(0) };
        setrlimit(Resource::Core, none)
            .and_then(|()| set_dumpable_behavior(DumpableBehavior::NotDumpable))
            .map_err(|error| {
                format!(
                    "core dumps cannot be forbidden ({error}): after a crash a file may hold sound of the last seconds; set \
                     LimitCORE=0 in the service"
                )
            })?;
    }
    Ok(())
}

/// Pages that are locked in memory and left out of core dumps, for as long as this lives.
///
/// Invariant: it is dropped before the memory is freed. The owner of the memory keeps it in a field before the memory's own.
#[derive(Debug)]
pub struct LockedMemory {
    /// Address of the first page; exposed, since no value is accessed through it.
    start: usize,
    bytes: usize,
}

impl LockedMemory {
    /// Locks the whole pages of `memory`. `None` where there is none, or where the system allows no more locked memory
    /// (`ulimit -l`).
    pub fn lock<T>(memory: &mut [MaybeUninit<T>]) -> Option<Self> {
        let page = page_size();
        let address = memory.as_mut_ptr().expose_provenance();
        let (start, end) = (address.next_multiple_of(page), (address + size_of_val(memory)) / page * page);
        let locked = Self { start, bytes: end.checked_sub(start).filter(|bytes| *bytes > 0)? };
        locked.set(true).then_some(locked)
    }

    /// Number of bytes, a multiple of the page size.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    #[cfg(target_os = "linux")]
    fn set(&self, protect: bool) -> bool {
        use rustix::mm::{Advice, madvise, mlock, munlock};
        let start = std::ptr::with_exposed_provenance_mut(self.start);
        // SAFETY: the range is inside memory that lives (the invariant above). Neither call changes its contents or unmaps it.
        unsafe {
            match protect {
                true => madvise(start, self.bytes, Advice::LinuxDontDump).is_ok() && mlock(start, self.bytes).is_ok(),
                false => munlock(start, self.bytes).is_ok() && madvise(start, self.bytes, Advice::LinuxDoDump).is_ok(),
            }
        }
    }

    #[cfg(not(target_os = "linux"))]
    fn set(&self, _: bool) -> bool {
        false
    }
}

impl Drop for LockedMemory {
    fn drop(&mut self) {
        self.set(false);
    }
}

/// Size of a page, bytes.
fn page_size() -> usize {
    #[cfg(target_os = "linux")]
    return rustix::param::page_size();
    #[cfg(not(target_os = "linux"))]
    return 4096;
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_process_without_core_dumps_is_not_dumpable_and_may_write_no_byte_of_core() {
        use rustix::process::{DumpableBehavior, Resource, dumpable_behavior, getrlimit};
        forbid_core_dumps().expect("Linux allows it to every process");
        assert_eq!(dumpable_behavior().expect("a state"), DumpableBehavior::NotDumpable);
        let limit = getrlimit(Resource::Core);
        assert_eq!((limit.current, limit.maximum), (Some(0), Some(0)));
    }

    /// Value of a key of the mapping that holds an address, from /proc/self/smaps.
    fn mapping(address: usize, key: &str) -> String {
        let maps = std::fs::read_to_string("/proc/self/smaps").expect("readable by the process itself");
        let mut inside = false;
        for line in maps.lines() {
            let range = line.split(' ').next().and_then(|range| range.split_once('-'));
            let numbers = range.and_then(|(from, to)| {
                Some((usize::from_str_radix(from, 16).ok()?, usize::from_str_radix(to, 16).ok()?))
            });
            match numbers {
                Some((from, to)) => inside = (from..to).contains(&address),
                None if inside && line.starts_with(key) => return line.to_owned(),
                None => {}
            }
        }
        panic!("{address:x} is in no mapping");
    }

    #[test]
    fn locked_pages_are_left_out_of_dumps_until_they_are_unlocked() {
        let mut memory: Box<[MaybeUninit<u8>]> = Box::new_uninit_slice(3 * page_size());
        let address = (memory.as_ptr() as usize).next_multiple_of(page_size());
        // `dd`: not in a dump; `lo`: locked.
        let has = |flag: &str| mapping(address, "VmFlags:").split(' ').any(|word| word == flag);
        let locked = LockedMemory::lock(&mut memory).expect("a few pages are within every limit");
        assert!(locked.bytes() >= 2 * page_size() && locked.bytes().is_multiple_of(page_size()));
        assert!(has("dd") && has("lo"));
        drop(locked);
        assert!(!has("dd") && !has("lo"));
        assert!(LockedMemory::lock(&mut memory[..1]).is_none(), "it has no whole page");
    }
}
