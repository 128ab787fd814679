//! What a test needs of the machine, and what becomes of the test where it is missing.

/// What was found; `None`, with a word on stderr, where it is missing, so that the test ends there.
///
/// # Panics
///
/// Where it is missing and the environment variable `SOFFIO_REQUIRE_ALL` is set, as `./check` sets it: nothing is skipped
/// there in silence.
#[track_caller]
pub fn require<T>(what: &str, found: Result<T, impl std::fmt::Display>) -> Option<T> {
    match found {
        Ok(found) => Some(found),
        Err(reason) if std::env::var_os("SOFFIO_REQUIRE_ALL").is_some() => {
            panic!("this test needs {what}, and SOFFIO_REQUIRE_ALL allows no test to be skipped: {reason}")
        }
        Err(reason) => {
            eprintln!("skipped, as this machine has no {what}: {reason}");
            None
        }
    }
}
