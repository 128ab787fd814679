//! Expressions: arithmetic on named numbers, written as text and evaluated without allocation.
//!
//! ```text
//! expression = term { ("+" | "-") term }                term = factor { ("*" | "/" | "%") factor }
//! factor     = "-" factor | atom [ "^" factor ]
//! atom       = number | name | function "(" expression { "," expression } ")" | "(" expression ")"
//! ```
//!
//! Functions: sin, cos, atan2(y, x), exp, ln, sqrt, tanh, abs, floor, min, max, clamp(x, low, high). step(edge, x) is 1 from the edge
//! on. `rise`(x) = 10 x³ − 15 x⁴ + 6 x⁵ between 0 and 1 (0 below, 1 above), and `noise`(x, seed), Perlin's noise on the line. `pi`
//! is π; angles are in radians. a % b is a remainder with the sign of b.
//!
//! Every result is finite: what has no value, as 1/0 or √−1, counts as 0, and nothing exceeds ±[`BOUND`].

use crate::noise::perlin1;
use crate::{PI, atan2, cos, exp, ln, pow, sin, sqrt, tanh};

/// Greatest magnitude of a result.
pub const BOUND: f64 = 1e12;
/// Deepest nesting of an expression, and most numbers that are pending at once.
const DEPTH: usize = 24;
/// Most numbers, names, signs and functions: far beyond a formula of one line. It bounds the work of an evaluation.
const LONGEST: usize = 64;

/// An expression, in postfix order.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    operations: Vec<Operation>,
}

/// Why a text is no expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Where, in characters from the beginning of the text.
    pub at: usize,
    /// What is wrong.
    pub message: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Number(f64),
    /// Index among the names.
    Named(usize),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
    Call(FunctionName),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum FunctionName {
    Sin,
    Cos,
    Atan2,
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
    Rise,
    Noise,
}

/// Names and numbers of arguments of the functions.
const FUNCTIONS: [(&str, FunctionName, usize); 15] = [
    ("sin", FunctionName::Sin, 1),
    ("cos", FunctionName::Cos, 1),
    ("atan2", FunctionName::Atan2, 2),
    ("exp", FunctionName::Exp, 1),
    ("ln", FunctionName::Ln, 1),
    ("sqrt", FunctionName::Sqrt, 1),
    ("tanh", FunctionName::Tanh, 1),
    ("abs", FunctionName::Abs, 1),
    ("floor", FunctionName::Floor, 1),
    ("min", FunctionName::Min, 2),
    ("max", FunctionName::Max, 2),
    ("clamp", FunctionName::Clamp, 3),
    ("step", FunctionName::Step, 2),
    ("rise", FunctionName::Rise, 1),
    ("noise", FunctionName::Noise, 2),
];

impl Expression {
    /// Reads an expression of numbers that `name` finds by their names.
    ///
    /// # Errors
    /// The text is no expression, it is nested too deeply or too long, or a name is unknown.
    pub fn parse(text: &str, name: &dyn Fn(&str) -> Option<usize>) -> Result<Self, ExpressionError> {
        let mut parser = Parser { text: text.chars().collect(), at: 0, name, operations: Vec::new(), depth: 0 };
        parser.expression()?;
        parser.skip_spaces();
        if parser.at < parser.text.len() {
            return Err(parser.wrong("an operator or the end is missing here"));
        }
        if parser.operations.len() > LONGEST {
            let message = format!("longer than {LONGEST} numbers, names and signs");
            return Err(ExpressionError { at: 0, message });
        }
        let (mut height, mut highest) = (0_usize, 0);
        for operation in &parser.operations {
            height = height + 1 - operation.arguments();
            highest = highest.max(height);
        }
        if highest > DEPTH {
            return Err(ExpressionError { at: 0, message: format!("more than {DEPTH} numbers are pending at once") });
        }
        Ok(Self { operations: parser.operations })
    }

    /// Its value for these named numbers.
    pub fn evaluate(&self, named: &[f64]) -> f64 {
        // Two places more, so that functions of one argument may look at three.
        let mut stack = [0.0; DEPTH + 2];
        let mut height = 0;
        for operation in &self.operations {
            height = height + 1 - operation.arguments();
            let [x, y, z] = [0, 1, 2].map(|k| stack[height - 1 + k]);
            let value = match operation {
                Operation::Number(value) => *value,
                Operation::Named(index) => named.get(*index).copied().unwrap_or(0.0),
                Operation::Negate => -x,
                Operation::Add => x + y,
                Operation::Subtract => x - y,
                Operation::Multiply => x * y,
                Operation::Divide => x / y,
                Operation::Remainder => x - y * (x / y).floor(),
                Operation::Power => pow(x, y),
                Operation::Call(function) => function.value(x, y, z),
            };
            stack[height - 1] = if value.is_finite() { value.clamp(-BOUND, BOUND) } else { 0.0 };
        }
        stack[0]
    }
}

impl Operation {
    fn arguments(self) -> usize {
        match self {
            Self::Number(_) | Self::Named(_) => 0,
            Self::Negate => 1,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide | Self::Remainder | Self::Power => 2,
            Self::Call(function) => FUNCTIONS.iter().find(|(_, own, _)| *own == function).map_or(1, |f| f.2),
        }
    }
}

impl FunctionName {
    fn value(self, x: f64, y: f64, z: f64) -> f64 {
        match self {
            Self::Sin => sin(x),
            Self::Cos => cos(x),
            Self::Atan2 => atan2(x, y),
            Self::Exp => exp(x),
            Self::Ln => ln(x),
            Self::Sqrt => sqrt(x),
            Self::Tanh => tanh(x),
            Self::Abs => x.abs(),
            Self::Floor => x.floor(),
            Self::Min => x.min(y),
            Self::Max => x.max(y),
            Self::Clamp => x.max(y).min(z),
            Self::Step => f64::from(u8::from(y >= x)),
            Self::Rise => {
                let s = x.clamp(0.0, 1.0);
                s * s * s * (10.0 - s * (15.0 - 6.0 * s))
            }
            Self::Noise => perlin1(x, y.abs() as u64),
        }
    }
}

struct Parser<'a> {
    text: Vec<char>,
    at: usize,
    name: &'a dyn Fn(&str) -> Option<usize>,
    operations: Vec<Operation>,
    depth: usize,
}

impl Parser<'_> {
    fn wrong(&self, message: &str) -> ExpressionError {
        ExpressionError { at: self.at, message: message.to_owned() }
    }

    fn skip_spaces(&mut self) {
        while self.text.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
    }

    /// Takes the next character if it is one of these.
    fn take(&mut self, any: &[char]) -> Option<char> {
        self.skip_spaces();
        let found = self.text.get(self.at).copied().filter(|c| any.contains(c))?;
        self.at += 1;
        Some(found)
    }

    fn expect(&mut self, wanted: char) -> Result<(), ExpressionError> {
        self.take(&[wanted]).map(|_| ()).ok_or_else(|| self.wrong(&format!("\"{wanted}\" is missing here")))
    }

    fn expression(&mut self) -> Result<(), ExpressionError> {
        self.term()?;
        while let Some(sign) = self.take(&['+', '-']) {
            self.term()?;
            self.operations.push(if sign == '+' { Operation::Add } else { Operation::Subtract });
        }
        Ok(())
    }

    fn term(&mut self) -> Result<(), ExpressionError> {
        self.factor()?;
        while let Some(sign) = self.take(&['*', '/', '%']) {
            self.factor()?;
            self.operations.push(match sign {
                '*' => Operation::Multiply,
                '/' => Operation::Divide,
                _ => Operation::Remainder,
            });
        }
        Ok(())
    }

    fn factor(&mut self) -> Result<(), ExpressionError> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.wrong("this is nested too deeply"));
        }
        if self.take(&['-']).is_some() {
            self.factor()?;
            self.operations.push(Operation::Negate);
        } else {
            self.atom()?;
            if self.take(&['^']).is_some() {
                self.factor()?;
                self.operations.push(Operation::Power);
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn atom(&mut self) -> Result<(), ExpressionError> {
        if self.take(&['(']).is_some() {
            self.expression()?;
            return self.expect(')');
        }
        self.skip_spaces();
        match self.text.get(self.at) {
            Some(c) if c.is_ascii_digit() || *c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() => self.named(),
            _ => Err(self.wrong("a number, a name or \"(\" is missing here")),
        }
    }

    fn number(&mut self) -> Result<(), ExpressionError> {
        let from = self.at;
        while let Some(c) = self.text.get(self.at) {
            // An exponent may have a sign.
            let after_e = self.at > from && matches!(self.text[self.at - 1], 'e' | 'E');
            let fits = c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E') || (after_e && matches!(c, '+' | '-'));
            if !fits {
                break;
            }
            self.at += 1;
        }
        let digits: String = self.text[from..self.at].iter().collect();
        let value: f64 =
            digits.parse().map_err(|_| ExpressionError { at: from, message: format!("{digits} is no number") })?;
        if value > BOUND {
            return Err(ExpressionError { at: from, message: format!("{digits} is beyond {BOUND:e}") });
        }
        self.operations.push(Operation::Number(value));
        Ok(())
    }

    fn named(&mut self) -> Result<(), ExpressionError> {
        let from = self.at;
        while self.text.get(self.at).is_some_and(|c| c.is_ascii_alphanumeric() || *c == '_') {
            self.at += 1;
        }
        let word: String = self.text[from..self.at].iter().collect();
        if self.take(&['(']).is_none() {
            let operation = match (self.name)(&word) {
                Some(index) => Operation::Named(index),
                None if word == "pi" => Operation::Number(PI),
                None => return Err(ExpressionError { at: from, message: format!("\"{word}\" is not known") }),
            };
            self.operations.push(operation);
            return Ok(());
        }
        let Some(&(_, function, arguments)) = FUNCTIONS.iter().find(|(name, ..)| *name == word) else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|(name, ..)| *name).collect();
            let message = format!("\"{word}\" is no function; there are {}", known.join(", "));
            return Err(ExpressionError { at: from, message });
        };
        let mut given = 0;
        while given == 0 || self.take(&[',']).is_some() {
            self.expression()?;
            given += 1;
        }
        if given != arguments {
            let message = format!("{word} takes {arguments} numbers, not {given}");
            return Err(ExpressionError { at: from, message });
        }
        self.expect(')')?;
        self.operations.push(Operation::Call(function));
        Ok(())
    }
}
