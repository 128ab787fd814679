//! Expressions: arithmetic on named numbers, written as text and evaluated without allocation.
//!
//! ```text
//! expression = term { ("+" | "-") term }
//! term       = factor { ("*" | "/") factor }
//! factor     = "-" factor | number | name | function "(" expression { "," expression } ")" | "(" expression ")"
//! ```
//!
//! Functions: sin, cos, atan2(y, x), abs, min, max, `rise`(x) = 10 x³ − 15 x⁴ + 6 x⁵ between 0 and 1 (0 below, 1 above), and
//! `noise`(x, seed), Perlin's noise on the line. Angles are in radians. x/0 is 0, so that a stored value stays finite.

use crate::noise::perlin1;
use crate::{atan2, cos, sin};

/// Deepest nesting of an expression.
const DEPTH: usize = 24;

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
    Call(FunctionName),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum FunctionName {
    Sin,
    Cos,
    Atan2,
    Abs,
    Min,
    Max,
    Rise,
    Noise,
}

/// Names and numbers of arguments of the functions.
const FUNCTIONS: [(&str, FunctionName, usize); 8] = [
    ("sin", FunctionName::Sin, 1),
    ("cos", FunctionName::Cos, 1),
    ("atan2", FunctionName::Atan2, 2),
    ("abs", FunctionName::Abs, 1),
    ("min", FunctionName::Min, 2),
    ("max", FunctionName::Max, 2),
    ("rise", FunctionName::Rise, 1),
    ("noise", FunctionName::Noise, 2),
];

impl Expression {
    /// Reads an expression of numbers that `name` finds by their names.
    ///
    /// # Errors
    /// The text is no expression, it is nested too deeply, or a name is unknown.
    pub fn parse(text: &str, name: &dyn Fn(&str) -> Option<usize>) -> Result<Self, ExpressionError> {
        let mut parser = Parser { text: text.chars().collect(), at: 0, name, operations: Vec::new(), depth: 0 };
        parser.expression()?;
        parser.skip_spaces();
        if parser.at < parser.text.len() {
            return Err(parser.wrong("an operator or the end is missing here"));
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
        let mut stack = [0.0; DEPTH];
        let mut height = 0;
        for operation in &self.operations {
            height = height + 1 - operation.arguments();
            let [x, y] = [stack[height - 1], stack[height.min(DEPTH - 1)]];
            stack[height - 1] = match operation {
                Operation::Number(value) => *value,
                Operation::Named(index) => named.get(*index).copied().unwrap_or(0.0),
                Operation::Negate => -x,
                Operation::Add => x + y,
                Operation::Subtract => x - y,
                Operation::Multiply => x * y,
                Operation::Divide => {
                    if y == 0.0 {
                        0.0
                    } else {
                        x / y
                    }
                }
                Operation::Call(function) => function.value(x, y),
            };
        }
        stack[0]
    }
}

impl Operation {
    fn arguments(self) -> usize {
        match self {
            Self::Number(_) | Self::Named(_) => 0,
            Self::Negate => 1,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide => 2,
            Self::Call(function) => FUNCTIONS.iter().find(|(_, own, _)| *own == function).map_or(1, |f| f.2),
        }
    }
}

impl FunctionName {
    fn value(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Sin => sin(x),
            Self::Cos => cos(x),
            Self::Atan2 => atan2(x, y),
            Self::Abs => x.abs(),
            Self::Min => x.min(y),
            Self::Max => x.max(y),
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
        while let Some(sign) = self.take(&['*', '/']) {
            self.factor()?;
            self.operations.push(if sign == '*' { Operation::Multiply } else { Operation::Divide });
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
        } else if self.take(&['(']).is_some() {
            self.expression()?;
            self.expect(')')?;
        } else {
            self.skip_spaces();
            match self.text.get(self.at) {
                Some(c) if c.is_ascii_digit() || *c == '.' => self.number()?,
                Some(c) if c.is_ascii_lowercase() => self.named()?,
                _ => return Err(self.wrong("a number, a name or \"(\" is missing here")),
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn number(&mut self) -> Result<(), ExpressionError> {
        let from = self.at;
        let is_digit = |c: &char| c.is_ascii_digit() || *c == '.';
        while self.text.get(self.at).is_some_and(is_digit) {
            self.at += 1;
        }
        let digits: String = self.text[from..self.at].iter().collect();
        let value =
            digits.parse().map_err(|_| ExpressionError { at: from, message: format!("{digits} is no number") })?;
        self.operations.push(Operation::Number(value));
        Ok(())
    }

    fn named(&mut self) -> Result<(), ExpressionError> {
        let from = self.at;
        while self.text.get(self.at).is_some_and(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || *c == '_') {
            self.at += 1;
        }
        let word: String = self.text[from..self.at].iter().collect();
        if self.take(&['(']).is_none() {
            let index = (self.name)(&word);
            let index =
                index.ok_or_else(|| ExpressionError { at: from, message: format!("\"{word}\" is not known") })?;
            self.operations.push(Operation::Named(index));
            return Ok(());
        }
        let Some(&(_, function, arguments)) = FUNCTIONS.iter().find(|(name, ..)| *name == word) else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|(name, ..)| *name).collect();
            let message = format!("\"{word}\" is no function; there are {}", known.join(", "));
            return Err(ExpressionError { at: from, message });
        };
        for k in 0..arguments {
            if k > 0 {
                self.expect(',')?;
            }
            self.expression()?;
        }
        self.expect(')')?;
        self.operations.push(Operation::Call(function));
        Ok(())
    }
}
