//! Weight tables as Rust source, and back, so that a table can be scored before it replaces the shipped one.

use std::borrow::Cow;
use std::fmt::Write as _;

use super::descent::NetworkSpec;
use soffio_detector::model::Network;

/// Source of a network's table.
pub fn written<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    network: &Network<IN, FIRST, SECOND>,
) -> String {
    let NetworkSpec { title, module, type_name, .. } = spec;
    let mut out = format!(
        "//! Trained weights of the network of {title}. Written by `soffio-training train`, not by hand.\n\n\
         use std::borrow::Cow;\n\nuse super::{module}::{type_name};\n\n/// Trained weights.\n#[rustfmt::skip]\n\
         #[allow(clippy::approx_constant)] // trained values may resemble constants by chance\n\
         pub static TRAINED: {type_name} = {type_name} {{\n    scale: [\n"
    );
    for (i, [mean, deviation]) in network.scale.iter().enumerate() {
        let _ = writeln!(out, "        [{mean:.4}, {deviation:.4}], // {}", (spec.input)(i));
    }
    out.push_str("    ],\n    weights: Cow::Borrowed(&[\n");
    for row in network.weights.chunks(11) {
        let cells: Vec<String> = row.iter().map(|w| format!("{w:.4}")).collect();
        let _ = writeln!(out, "        {},", cells.join(", "));
    }
    out.push_str("    ]),\n};\n");
    out
}

/// The network of a table that [`written`] has made, or the reason why the source is not such a table.
pub fn read<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    source: &str,
) -> Result<Network<IN, FIRST, SECOND>, String> {
    let NetworkSpec { title, type_name, .. } = spec;
    let (_, numbers) = source
        .split_once(&format!("TRAINED: {type_name} = {type_name} {{"))
        .ok_or_else(|| format!("no table of {title}, such as `soffio-training train --out` writes"))?;
    let lines = numbers.lines().map(|line| line.split("//").next().unwrap_or_default());
    let words = lines.flat_map(|line| line.split([' ', ',', '[', ']', '(', ')', '&', '{', '}', ';']));
    let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
    let expected = 2 * IN + Network::<IN, FIRST, SECOND>::PARAMETERS;
    if numbers.len() != expected || numbers.iter().any(|x| !x.is_finite()) {
        return Err(format!("a table of {title} has {expected} finite numbers, this one {}", numbers.len()));
    }
    let (scale, weights) = numbers.split_at(2 * IN);
    Ok(Network {
        scale: std::array::from_fn(|i| [scale[2 * i], scale[2 * i + 1]]),
        weights: Cow::Owned(weights.to_vec()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::descent::DUAL_MIC;
    use soffio_detector::BlowSettings;

    #[test]
    fn a_table_reads_back_as_the_trained_weights() {
        let trained = (DUAL_MIC.get)(&BlowSettings::default()).clone();
        let source = written(&DUAL_MIC, &trained);
        assert!(read(&DUAL_MIC, &source) == Ok(trained), "shipped weights have four decimal places");
        let cut = &source[..source.len() - 100];
        assert!(read(&DUAL_MIC, cut).is_err_and(|why| why.contains("finite numbers, this one")));
        assert!(read(&crate::descent::SINGLE_MIC, &source).is_err_and(|why| why.contains("no table of one spectrum")));
    }
}
