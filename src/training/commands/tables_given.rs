//! The detector that a command line gives by its tables.

use std::path::PathBuf;

use soffio_detector::BlowSettings;

use super::failure::Failure;
use crate::descent::{ONE, TWO};
use crate::{course, tables};

/// The shipped detector, or one with the weights of these tables; of more than one of a kind, their mean.
pub(super) fn detector(tables: &[PathBuf]) -> Result<BlowSettings, Failure> {
    let mut settings = BlowSettings::default();
    let (mut ones, mut twos) = (Vec::new(), Vec::new());
    for path in tables {
        let fail = |why: &dyn std::fmt::Display| Failure::input(format!("{}: {why}", path.display()));
        let source = std::fs::read_to_string(path).map_err(|error| fail(&error))?;
        match (tables::read(&ONE, &source), tables::read(&TWO, &source)) {
            (Ok(one), _) => ones.push(one),
            (_, Ok(two)) => twos.push(two),
            (Err(one), Err(two)) => return Err(fail(&format!("{one}; {two}"))),
        }
    }
    if let Some(mean) = course::mean(&ones) {
        (ONE.give)(&mut settings, mean);
    }
    if let Some(mean) = course::mean(&twos) {
        (TWO.give)(&mut settings, mean);
    }
    Ok(settings)
}
