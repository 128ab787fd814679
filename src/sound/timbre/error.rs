//! What is wrong with a timbre, and where.

/// What is wrong with a timbre, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct TimbreError {
    /// The preset's file.
    pub file: String,
    /// Its line, from 1, where there is one.
    pub line: Option<usize>,
    /// Path of the key, `node.body.partials`.
    pub key: String,
    /// What is wrong and what would be right.
    pub problem: String,
}

impl std::error::Error for TimbreError {}

impl std::fmt::Display for TimbreError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}: {}", self.key, self.problem)
    }
}

impl TimbreError {
    pub(crate) fn new(name: &str, key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { file: format!("audio/timbres/{name}.toml"), line: None, key: key.into(), problem: problem.into() }
    }
}
