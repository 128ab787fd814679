//! Limits for an input: an allocator that ends the process at [`MOST_BYTES`], and a folder for inputs that are read as files.
//! libFuzzer itself finds panics and endless loops.

use std::alloc::System;
use std::path::Path;
use std::sync::OnceLock;
use std::time::Duration;

use cap::Cap;
use cpu_time::ThreadTime;
use tempfile::TempDir;

// The tests use all of it.
#[allow(dead_code)]
#[path = "../../suite/exhibit/glb.rs"]
mod glb;
pub mod inputs;
pub mod messages;

/// Processor time that one input may take: the clock on the wall says little on a busy machine.
const MOST_TIME: Duration = Duration::from_secs(2);
/// Memory that one input may take beyond what was in use before it.
const MOST_BYTES: usize = 256 << 20;

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Does `what` with these bytes, within bounds, in a folder that holds the small figure of the tests as `model.glb`.
pub fn bounded(what: fn(&Path, &[u8]), bytes: &[u8]) {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("model.glb"), glb::boom_and_plate()).expect("a writable folder");
        folder
    });
    ALLOCATOR.set_limit(ALLOCATOR.allocated() + MOST_BYTES).expect("more than is in use");
    let began = ThreadTime::now();
    what(folder.path(), bytes);
    assert!(began.elapsed() < MOST_TIME, "{:?} of processor time", began.elapsed());
    ALLOCATOR.set_limit(usize::MAX).expect("no limit");
}
