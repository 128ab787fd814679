//! Expressions of signals and formulas: how signs bind, what has no value, and how mistakes are named.

use soffio_math::expression::{BOUND, Expression};

fn value(text: &str) -> f64 {
    let expression = Expression::parse(text, &|name| ["low", "high", "t"].iter().position(|known| *known == name));
    expression.unwrap_or_else(|error| panic!("{text}: {error:?}")).evaluate(&[3.0, 5.0, 0.5])
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
        ("low * high - t", 14.5),
        ("clamp(high, 0, 4) + step(1, low) + min(low, high)", 8.0),
        ("max(-1, -2) + abs(-1.5e0)", 0.5),
        ("sin(pi / 2) + tanh(0) + ln(exp(2)) + sqrt(9) + floor(-0.5) + atan2(0, 1)", 5.0),
        ("rise(0.5) + rise(2) + rise(-1)", 1.5),
        ("1.5e-2 * 1E2", 1.5),
    ] {
        assert!((value(text) - expected).abs() < 1e-12, "{text}: {} instead of {expected}", value(text));
    }
}

#[test]
fn a_missing_value_counts_as_nothing() {
    for text in ["1 / 0", "sqrt(-1)", "ln(0)", "exp(1e6)", "0 / 0 + 0", "5 % 0", "(-8) ^ 0.5"] {
        assert_eq!(value(text), 0.0, "{text}");
    }
    assert_eq!(value("1e12 * 1e12"), BOUND);
}

#[test]
fn mistakes_are_named_at_their_place() {
    let long = vec!["1"; 40].join("+");
    let deep = "(".repeat(25) + "1" + &")".repeat(25);
    for (text, at, word) in [
        ("", 0, "missing here"),
        ("1 +", 3, "missing here"),
        ("(1", 2, "\")\" is missing"),
        ("1)", 1, "an operator or the end"),
        ("2 $ 3", 2, "an operator or the end"),
        ("1 + lwo", 4, "\"lwo\" is not known"),
        ("sni(1)", 0, "no function"),
        ("2 * sin(1, 2)", 4, "takes 1 numbers, not 2"),
        ("1.2.3", 0, "no number"),
        ("1e15", 0, "beyond"),
        (&long, 0, "longer than"),
        (&deep, 24, "nested"),
        ("−1", 0, "missing here"),
    ] {
        let error = Expression::parse(text, &|_| None).expect_err(text);
        assert!(error.message.contains(word) && error.at == at, "{text}: {error:?}");
    }
}
