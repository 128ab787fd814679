//! Formulas of `function` nodes: an expression of nodes, inputs and the time since the voice began.

use soffio_math::expression::Expression;

use super::number::{INPUTS, Input};
use super::read::hint;

/// Most inputs that one formula follows.
pub(crate) const MOST_INPUTS: usize = 4;
/// Most nodes that one formula takes.
pub(crate) const MOST_NODES: usize = 8;
/// Its named numbers: the time, the inputs, and the nodes.
const NAMED: usize = 1 + MOST_INPUTS + MOST_NODES;

/// A compiled formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Formula {
    expression: Expression,
    /// The inputs that it follows.
    pub inputs: Vec<Input>,
    nodes: usize,
}

impl Formula {
    /// Compiles a text that may name these nodes.
    ///
    /// # Errors
    /// What is wrong with the text, and what would be right.
    pub fn parse(text: &str, nodes: &[String]) -> Result<Self, String> {
        if nodes.len() > MOST_NODES {
            return Err(format!("takes more than {MOST_NODES} nodes; divide it among several"));
        }
        let input = |name: &str| INPUTS.iter().find(|(known, _)| *known == name).map(|(_, input)| *input);
        let is_node = |name: &str| nodes.iter().any(|node| node == name);
        let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).filter(|word| !is_node(word));
        let mut inputs: Vec<Input> = Vec::new();
        for followed in words.filter_map(input) {
            if !inputs.contains(&followed) {
                inputs.push(followed);
            }
        }
        if inputs.len() > MOST_INPUTS {
            return Err(format!("follows more than {MOST_INPUTS} inputs; divide it among several nodes"));
        }
        let named = |name: &str| {
            let node = nodes.iter().position(|node| node == name).map(|node| 1 + MOST_INPUTS + node);
            let slot = || Some(1 + inputs.iter().position(|known| Some(*known) == input(name))?);
            node.or_else(slot).or((name == "t").then_some(0))
        };
        let expression = Expression::parse(text, &named).map_err(|error| {
            let known = nodes.iter().map(String::as_str).chain(["t", "pi"]);
            let known = known.chain(INPUTS.iter().map(|(name, _)| *name));
            let name = error.message.strip_suffix(" is not known").map(|quoted| quoted.trim_matches('"'));
            let hint = name.map(|name| hint(name, known)).unwrap_or_default();
            format!("at character {} of \"{text}\": {}{hint}", error.at + 1, error.message)
        })?;
        Ok(Self { expression, inputs, nodes: nodes.len() })
    }

    /// Its value for the samples of the nodes, the values of [`Self::inputs`], and the time since the voice began, s.
    pub fn at(&self, node: impl Fn(usize) -> f64, inputs: &[f64; MOST_INPUTS], time: f64) -> f64 {
        let mut named = [0.0; NAMED];
        named[0] = time;
        named[1..=MOST_INPUTS].copy_from_slice(inputs);
        (0..self.nodes).for_each(|k| named[1 + MOST_INPUTS + k] = node(k));
        self.expression.evaluate(&named)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_inputs_and_time_have_their_values() {
        let nodes = ["low".to_string(), "speed".to_string()];
        let formula =
            Formula::parse("low + 10 * speed + 100 * t + 1000 * body_spin + 10000 * gust", &nodes).expect("valid");
        // A node goes before an input of its name.
        assert_eq!(formula.inputs, [Input::BodySpin, Input::Gust]);
        assert_eq!(formula.at(|k| [1.0, 2.0][k], &[4.0, 5.0, 0.0, 0.0], 3.0), 54_321.0);
    }

    #[test]
    fn mistakes_say_what_would_be_right() {
        for (text, words) in [
            ("lowe + 1", "at character 1 of \"lowe + 1\": \"lowe\" is not known; did you mean \"low\"?"),
            (
                "1 + body_spni",
                "at character 5 of \"1 + body_spni\": \"body_spni\" is not known; did you mean \"body_spin\"?",
            ),
            ("impulse + speed + mass + gust + tension", "more than 4 inputs"),
        ] {
            let problem = Formula::parse(text, &["low".into()]).expect_err(text);
            assert!(problem.contains(words), "{text}: {problem}");
        }
    }
}
