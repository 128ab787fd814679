//! Expressions of `function` nodes: arithmetic and functions of nodes, inputs and time, as a flat postfix program.
//!
//! ```text
//! sum = product {("+" | "−") product}       product = power {("*" | "/" | "%") power}
//! power = ["-"] atom ["^" power]            atom = number | name | name "(" sum {"," sum} ")" | "(" sum ")"
//! ```
//!
//! Every result is finite: what has no value, as 1/0 or √−1, counts as 0, and nothing exceeds ±10¹². A program has at most
//! [`MOST_STEPS`] steps and follows at most [`MOST_INPUTS`] inputs, which bounds its work per sample.

use soffio_math::{PI, cos, exp, ln, pow, sin, sqrt, tanh};

use super::number::{BOUND, INPUTS, Input};
use super::read::hint;

/// Most steps of a program: far beyond a formula of one line.
pub(crate) const MOST_STEPS: usize = 64;
/// Most inputs that one expression follows.
pub(crate) const MOST_INPUTS: usize = 4;
/// Deepest nesting of brackets.
const DEEPEST: usize = 16;

/// One step of a program; it takes its arguments from the stack and leaves its result there.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Number(f64),
    /// Sample of a node, by its place among those that the function takes.
    Node(usize),
    /// Value of an input, by its place in [`Expression::inputs`].
    Input(usize),
    /// Since the voice began, s.
    Time,
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
    Call(Function),
}

/// A function by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Function {
    Sin,
    Cos,
    Exp,
    Ln,
    Sqrt,
    Tanh,
    Abs,
    Floor,
    Min,
    Max,
    Clamp,
    Step,
}

/// Functions by name, with the number of their arguments. `step(edge, x)` is 1 from the edge on, else 0.
const FUNCTIONS: [(&str, Function, usize); 12] = [
    ("sin", Function::Sin, 1),
    ("cos", Function::Cos, 1),
    ("exp", Function::Exp, 1),
    ("ln", Function::Ln, 1),
    ("sqrt", Function::Sqrt, 1),
    ("tanh", Function::Tanh, 1),
    ("abs", Function::Abs, 1),
    ("floor", Function::Floor, 1),
    ("min", Function::Min, 2),
    ("max", Function::Max, 2),
    ("clamp", Function::Clamp, 3),
    ("step", Function::Step, 2),
];

/// A compiled expression.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expression {
    steps: Vec<Step>,
    /// The inputs that it follows.
    pub inputs: Vec<Input>,
}

impl Expression {
    /// Compiles a text that may name these nodes.
    ///
    /// # Errors
    /// What is wrong with the text, and what would be right.
    pub fn parse(text: &str, nodes: &[String]) -> Result<Self, String> {
        let mut parser =
            Parser { rest: text, nodes, compiled: Self { steps: Vec::new(), inputs: Vec::new() }, depth: 0 };
        parser.sum()?;
        match parser.peek() {
            None => Ok(parser.compiled),
            Some(found) => Err(format!("\"{found}\" is out of place in \"{text}\"")),
        }
    }

    /// Its value for the samples of the nodes, the values of [`Self::inputs`], and the time since the voice began, s.
    pub fn at(&self, node: impl Fn(usize) -> f64, inputs: &[f64; MOST_INPUTS], time: f64) -> f64 {
        let (mut stack, mut n) = ([0.0f64; MOST_STEPS + 2], 0);
        for step in &self.steps {
            let [a, b, c] = [3, 2, 1].map(|from_top| stack[n.max(from_top) - from_top]);
            let (taken, value) = match *step {
                Step::Number(value) => (0, value),
                Step::Node(index) => (0, node(index)),
                Step::Input(slot) => (0, inputs[slot]),
                Step::Time => (0, time),
                Step::Negate => (1, -c),
                Step::Add => (2, b + c),
                Step::Subtract => (2, b - c),
                Step::Multiply => (2, b * c),
                Step::Divide => (2, b / c),
                Step::Remainder => (2, b - c * (b / c).floor()),
                Step::Power => (2, pow(b, c)),
                Step::Call(function) => function.call(a, b, c),
            };
            n -= taken;
            stack[n] = if value.is_nan() || value.is_infinite() { 0.0 } else { value.clamp(-BOUND, BOUND) };
            n += 1;
        }
        stack[0]
    }
}

impl Function {
    /// Number of arguments taken, and the value; `c` is the last argument.
    fn call(self, a: f64, b: f64, c: f64) -> (usize, f64) {
        match self {
            Self::Sin => (1, sin(c)),
            Self::Cos => (1, cos(c)),
            Self::Exp => (1, exp(c)),
            Self::Ln => (1, ln(c)),
            Self::Sqrt => (1, sqrt(c)),
            Self::Tanh => (1, tanh(c)),
            Self::Abs => (1, c.abs()),
            Self::Floor => (1, c.floor()),
            Self::Min => (2, b.min(c)),
            Self::Max => (2, b.max(c)),
            Self::Clamp => (3, a.max(b).min(c)),
            Self::Step => (2, if c >= b { 1.0 } else { 0.0 }),
        }
    }
}

/// The rest of the text, and the program so far.
struct Parser<'a> {
    rest: &'a str,
    nodes: &'a [String],
    compiled: Expression,
    depth: usize,
}

impl Parser<'_> {
    fn peek(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    /// Takes this character if it is next.
    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.rest = &self.rest[wanted.len_utf8()..];
        }
        found
    }

    fn push(&mut self, step: Step) -> Result<(), String> {
        if self.compiled.steps.len() == MOST_STEPS {
            return Err(format!("longer than {MOST_STEPS} numbers, names and signs; divide it among several nodes"));
        }
        self.compiled.steps.push(step);
        Ok(())
    }

    fn sum(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("brackets more than {DEEPEST} deep; divide it among several nodes"));
        }
        self.product()?;
        loop {
            let step = match self.peek() {
                Some('+') => Step::Add,
                Some('-') => Step::Subtract,
                _ => break,
            };
            self.rest = &self.rest[1..];
            self.product()?;
            self.push(step)?;
        }
        self.depth -= 1;
        Ok(())
    }

    fn product(&mut self) -> Result<(), String> {
        self.power()?;
        loop {
            let step = match self.peek() {
                Some('*') => Step::Multiply,
                Some('/') => Step::Divide,
                Some('%') => Step::Remainder,
                _ => return Ok(()),
            };
            self.rest = &self.rest[1..];
            self.power()?;
            self.push(step)?;
        }
    }

    fn power(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("signs more than {DEEPEST} deep; divide it among several nodes"));
        }
        if self.take('-') {
            self.power()?;
            self.push(Step::Negate)?;
        } else {
            self.atom()?;
            if self.take('^') {
                self.power()?;
                self.push(Step::Power)?;
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn atom(&mut self) -> Result<(), String> {
        let Some(first) = self.peek() else { return Err("ends where a number or a name should follow".into()) };
        if self.take('(') {
            self.sum()?;
            return self.close();
        }
        if first.is_ascii_digit() || first == '.' {
            return self.number();
        }
        if !first.is_ascii_alphabetic() {
            return Err(format!("\"{first}\" is out of place: a number, a name or a bracket is wanted"));
        }
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let (name, rest) = self.rest.split_at(self.rest.find(|c| !word(c)).unwrap_or(self.rest.len()));
        self.rest = rest;
        if self.take('(') { self.call(name) } else { self.name(name) }
    }

    fn close(&mut self) -> Result<(), String> {
        if self.take(')') { Ok(()) } else { Err("a bracket is open: \")\" is missing".into()) }
    }

    fn number(&mut self) -> Result<(), String> {
        let part = |s: &str, i: usize, c: char| {
            c.is_ascii_digit()
                || c == '.'
                || ((c == 'e' || c == 'E') && i > 0)
                || ((c == '-' || c == '+') && s[..i].ends_with(['e', 'E']))
        };
        let end = self.rest.char_indices().find(|&(i, c)| !part(self.rest, i, c)).map_or(self.rest.len(), |(i, _)| i);
        let (text, rest) = self.rest.split_at(end);
        let value: f64 = text.parse().map_err(|_| format!("\"{text}\" is not a number"))?;
        if value > BOUND {
            return Err(format!("{text} is beyond {BOUND:e}"));
        }
        self.rest = rest;
        self.push(Step::Number(value))
    }

    fn call(&mut self, name: &str) -> Result<(), String> {
        let Some(&(_, function, wanted)) = FUNCTIONS.iter().find(|(known, ..)| *known == name) else {
            let hint = hint(name, FUNCTIONS.iter().map(|(name, ..)| *name));
            return Err(format!("no function \"{name}\"{hint}"));
        };
        let mut given = 0;
        while given == 0 || self.take(',') {
            self.sum()?;
            given += 1;
        }
        if given != wanted {
            return Err(format!("{name} takes {wanted} numbers, not {given}"));
        }
        self.close()?;
        self.push(Step::Call(function))
    }

    fn name(&mut self, name: &str) -> Result<(), String> {
        if let Some(node) = self.nodes.iter().position(|node| node == name) {
            return self.push(Step::Node(node));
        }
        match name {
            "t" => return self.push(Step::Time),
            "pi" => return self.push(Step::Number(PI)),
            _ => {}
        }
        let Some(&(_, input)) = INPUTS.iter().find(|(known, _)| *known == name) else {
            let known = self.nodes.iter().map(String::as_str).chain(["t", "pi"]);
            let hint = hint(name, known.chain(INPUTS.iter().map(|(name, _)| *name)));
            return Err(format!("no node of `in` and no input is \"{name}\"{hint}"));
        };
        let inputs = &mut self.compiled.inputs;
        let slot = inputs.iter().position(|known| *known == input).unwrap_or(inputs.len());
        if slot == MOST_INPUTS {
            return Err(format!("follows more than {MOST_INPUTS} inputs; divide it among several nodes"));
        }
        if slot == inputs.len() {
            inputs.push(input);
        }
        self.push(Step::Input(slot))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let nodes = ["low".to_string(), "high".to_string()];
        let expression = Expression::parse(text, &nodes).expect(text);
        expression.at(|i| [3.0, 5.0][i], &[0.25, 2.0, 0.0, 0.0], 0.5)
    }

    #[test]
    fn signs_bind_as_in_mathematics() {
        for (text, expected) in [
            ("1 + 2 * 3 ^ 2", 19.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("2 ^ -1", 0.5),
            ("10 - 4 - 3", 3.0),
            ("(10 - (4 - 3)) / 3", 3.0),
            ("-7 % 3", 2.0),
            ("(0 - 7) % 3", 2.0),
            ("low * high - t", 14.5),
            ("body_spin + wind_speed * body_spin", 0.75),
            ("clamp(high, 0, 4) + step(1, low) + min(low, high)", 8.0),
            ("max(-1, -2) + abs(-1.5e0)", 0.5),
            ("sin(pi / 2) + tanh(0)", 1.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-12, "{text}: {} instead of {expected}", value(text));
        }
    }

    #[test]
    fn what_has_no_value_counts_as_nothing() {
        for text in ["1 / 0", "sqrt(-1)", "ln(0)", "exp(1e6)", "0 / 0 + 0", "5 % 0", "(-8) ^ 0.5"] {
            assert_eq!(value(text), 0.0, "{text}");
        }
        assert_eq!(value("1e12 * 1e12"), BOUND);
    }

    #[test]
    fn mistakes_are_named() {
        let long = vec!["1"; 40].join("+");
        let deep = "(".repeat(17) + "1" + &")".repeat(17);
        for (text, word) in [
            ("", "ends"),
            ("1 +", "ends"),
            ("(1", "missing"),
            ("1)", "out of place"),
            ("2 $ 3", "out of place"),
            ("lowe", "did you mean \"low\""),
            ("sinn(1)", "did you mean \"sin\""),
            ("sin(1, 2)", "takes 1 numbers, not 2"),
            ("1.2.3", "not a number"),
            ("1e15", "beyond"),
            ("impulse + speed + mass + gust + tension", "more than 4 inputs"),
            (&long, "longer than"),
            (&deep, "deep"),
            ("−1", "out of place"),
        ] {
            let problem = Expression::parse(text, &["low".into()]).expect_err(text);
            assert!(problem.contains(word), "{text}: {problem}");
        }
    }
}
