//! What was learnt as a source file, and back: a table can be marked before it takes the present one's place.

use std::borrow::Cow;
use std::fmt::Write as _;

use super::descent::Subject;
use soffio_detector::model::Network;

/// A network as the source of its table.
pub fn written<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    network: &Network<IN, FIRST, SECOND>,
) -> String {
    let [what, module, kind] = subject.name;
    let mut out = format!(
        "//! What the network of {what} has learnt: written by `soffio-training train`, not by hand.\n\n\
         use std::borrow::Cow;\n\nuse super::{module}::{kind};\n\n/// What was learnt.\n#[rustfmt::skip]\n\
         #[allow(clippy::approx_constant)] // what was learnt, whatever it resembles\n\
         pub static TRAINED: {kind} = {kind} {{\n    scale: [\n"
    );
    for (i, [mean, deviation]) in network.scale.iter().enumerate() {
        let _ = writeln!(out, "        [{mean:.4}, {deviation:.4}], // {}", (subject.input)(i));
    }
    out.push_str("    ],\n    weights: Cow::Borrowed(&[\n");
    for row in network.weights.chunks(11) {
        let cells: Vec<String> = row.iter().map(|w| format!("{w:.4}")).collect();
        let _ = writeln!(out, "        {},", cells.join(", "));
    }
    out.push_str("    ]),\n};\n");
    out
}

/// The network of a table that [`written`] wrote, or why it is none.
pub fn read<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    source: &str,
) -> Result<Network<IN, FIRST, SECOND>, String> {
    let [what, _, kind] = subject.name;
    let (_, numbers) = source
        .split_once(&format!("TRAINED: {kind} = {kind} {{"))
        .ok_or_else(|| format!("no table of {what}, such as `soffio-training train --out` writes"))?;
    let lines = numbers.lines().map(|line| line.split("//").next().unwrap_or_default());
    let words = lines.flat_map(|line| line.split([' ', ',', '[', ']', '(', ')', '&', '{', '}', ';']));
    let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
    let expected = 2 * IN + Network::<IN, FIRST, SECOND>::PARAMETERS;
    if numbers.len() != expected || numbers.iter().any(|x| !x.is_finite()) {
        return Err(format!("a table of {what} has {expected} finite numbers, this one {}", numbers.len()));
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
    use crate::descent::TWO;
    use soffio_detector::BlowSettings;

    #[test]
    fn a_table_reads_back_as_what_was_learnt() {
        let learnt = (TWO.of)(&BlowSettings::default()).clone();
        let source = written(&TWO, &learnt);
        assert!(read(&TWO, &source) == Ok(learnt), "four places of it are all that a table has");
        let cut = &source[..source.len() - 100];
        assert!(read(&TWO, cut).is_err_and(|why| why.contains("finite numbers, this one")));
        assert!(read(&crate::descent::ONE, &source).is_err_and(|why| why.contains("no table of one spectrum")));
    }
}
