//! What must hold for every exhibit: one case per exhibit and property, found by the exhibit's folder. A folder that a
//! curator adds is tested without a change here.
//!
//!     cargo test --no-default-features --test exhibits steel-fish         all properties of one exhibit
//!     cargo test --no-default-features --test exhibits gathers_itself     one property of all exhibits
//!     cargo test --no-default-features --test exhibits -- --nocapture     with what each case measures

use std::collections::BTreeMap;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use assert_no_alloc::AllocDisabler;
use libtest_mimic::{Arguments, Trial};
use soffio_exhibit::{self as exhibit, Exhibit};

mod assembly;
mod expected;
mod files;
mod loads;
mod motion;
mod pointer_grabs;
mod repeatable;
mod robust;
mod tally;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// Whether cases print what they measure.
static NOTES: AtomicBool = AtomicBool::new(false);

/// Prints like `println!` where `--nocapture` is given.
macro_rules! note {
    ($($word:tt)*) => {
        if $crate::NOTES.load(std::sync::atomic::Ordering::Relaxed) {
            println!($($word)*);
        }
    };
}
pub(crate) use note;

/// A property: its name, whether it runs only with `--ignored`, and the function that panics where it does not hold.
type Property = (&'static str, bool, fn(&str));

macro_rules! properties {
    ($($module:ident::$name:ident $(($ignored:ident))?),* $(,)?) => {
        [$((stringify!($name), properties!(@ $($ignored)?), $module::$name)),*]
    };
    (@) => { false };
    (@ ignored) => { true };
}

const PROPERTIES: [Property; 20] = properties![
    files::loads_without_a_warning,
    files::has_its_picture_in_the_readme,
    files::its_model_reads_back_as_it_was_written,
    files::its_constraints_are_in_its_mujoco_model_or_named_as_omitted,
    files::its_table_of_labels_reads_back,
    expected::is_as_its_folder_says,
    // Writes the file that the case above compares with.
    expected::write_what_is_expected(ignored),
    repeatable::a_run_repeats_itself_within_a_process,
    repeatable::a_reset_gives_the_first_run_again,
    repeatable::a_step_asks_for_no_memory_once_it_is_warm,
    assembly::assembles_in_a_few_seconds,
    motion::a_change_of_motion_moves_nothing_by_itself,
    motion::a_change_of_motion_is_not_heard_as_a_click,
    motion::the_mode_is_an_input_so_a_replay_repeats_it,
    motion::position_based_motion_does_not_fault_and_asks_for_no_memory,
    robust::a_nan_is_found_and_the_mechanism_restored,
    robust::a_hundred_times_the_gravity_is_borne,
    pointer_grabs::the_first_body_on_a_view_ray_is_found_as_by_testing_every_triangle,
    pointer_grabs::grabs_cause_no_fault,
    loads::no_step_does_more_work_than_the_bound,
];

/// Parts `hands` and `places` of tests/check.sh --long.
const LONG: [Property; 2] = properties![
    pointer_grabs::grabs_cause_no_fault_in_twenty_seconds(ignored),
    motion::position_based_motion_of_twenty_seconds_does_not_fault(ignored),
];

/// An exhibit, read once for all its cases: nothing changes it.
fn load(id: &str) -> Arc<Exhibit> {
    static READ: Mutex<BTreeMap<String, Arc<Exhibit>>> = Mutex::new(BTreeMap::new());
    let read = || READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(exhibit) = read().get(id) {
        return exhibit.clone();
    }
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    let exhibit = Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text())));
    read().insert(id.to_owned(), exhibit.clone());
    exhibit
}

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    NOTES.store(arguments.nocapture, Ordering::Relaxed);
    let ids = exhibit::ids();
    let cases = ids.iter().flat_map(|id| {
        PROPERTIES.iter().chain(&LONG).map(move |&(name, ignored, holds)| {
            let own = id.clone();
            let case = move || {
                holds(&own);
                Ok(())
            };
            Trial::test(format!("{id}::{name}"), case).with_ignored_flag(ignored)
        })
    });
    let conclusion = libtest_mimic::run(&arguments, cases.collect());
    let tallies = [&motion::QUIET_CHANGES, &motion::HEARD_CHANGES, &pointer_grabs::RAYS];
    let enough = tallies.map(|tally| tally.is_enough(ids.len())) == [true; 3];
    if enough { conclusion.exit_code() } else { ExitCode::FAILURE }
}
