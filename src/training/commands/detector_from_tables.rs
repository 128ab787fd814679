//! The detector of a command line, from its `--table` options.

use std::path::PathBuf;

use soffio_detector::BlowSettings;

use super::failure::Failure;
use crate::descent::{DUAL_MIC, SINGLE_MIC};
use crate::{pipeline, tables};

/// The shipped detector, or one with the weights of these tables; several of a kind are averaged.
pub(super) fn detector(tables: &[PathBuf]) -> Result<BlowSettings, Failure> {
    let mut settings = BlowSettings::default();
    let (mut single, mut dual) = (Vec::new(), Vec::new());
    for path in tables {
        let fail = |why: &dyn std::fmt::Display| Failure::input(format!("{}: {why}", path.display()));
        let source = std::fs::read_to_string(path).map_err(|error| fail(&error))?;
        match (tables::read(&SINGLE_MIC, &source), tables::read(&DUAL_MIC, &source)) {
            (Ok(network), _) => single.push(network),
            (_, Ok(network)) => dual.push(network),
            (Err(one), Err(two)) => return Err(fail(&format!("{one}; {two}"))),
        }
    }
    if let Some(mean) = pipeline::mean(&single) {
        (SINGLE_MIC.set)(&mut settings, mean);
    }
    if let Some(mean) = pipeline::mean(&dual) {
        (DUAL_MIC.set)(&mut settings, mean);
    }
    Ok(settings)
}
