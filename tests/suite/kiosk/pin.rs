//! The staff's PIN in the configuration: a hash and nothing else.

use std::path::Path;

use soffio_config::{Config, Pin};

/// Some salt: what matters here is that it is fixed.
const SALT: [u8; 16] = *b"salt of sixteen.";

#[test]
fn a_pin_is_kept_as_a_hash_that_only_its_digits_match() {
    let pin = Pin::new("271828", &SALT).expect("six digits");
    let text = String::from(pin.clone());
    assert!(text.starts_with("$argon2id$v=19$m=65536,t=3,p=1$") && !text.contains("271828"), "{text}");
    assert!(pin.is_set() && pin.matches("271828"));
    for other in ["271829", "27182", "2718280", ""] {
        assert!(!pin.matches(other), "{other:?}");
    }
    assert_ne!(pin, Pin::new("271828", b"other of sixteen").expect("six digits"), "the salt is in it");
    assert!(!Pin::default().is_set() && !Pin::default().matches(""), "without a PIN nothing matches");
}

#[test]
fn a_hash_from_another_program_is_known() {
    // `echo -n 4711 | argon2 somesalt1 -id -t 2 -k 65536 -p 4 -e` of the reference implementation's command line has this
    // form; the hash itself is checked by making it with the same parameters.
    let made = {
        use argon2::password_hash::{PasswordHasher, SaltString};
        let params = argon2::Params::new(8192, 3, 2, None).expect("good parameters");
        let hasher = argon2::Argon2::new(argon2::Algorithm::Argon2id, argon2::Version::V0x13, params);
        let salt = SaltString::encode_b64(b"somesalt1").expect("a salt");
        hasher.hash_password(b"4711", &salt).expect("a hash").to_string()
    };
    let pin = Pin::try_from(made).expect("Argon2id with parameters of its own");
    assert!(pin.matches("4711") && !pin.matches("4712"));
}

#[test]
fn what_is_no_pin_is_refused_with_what_to_do() {
    for bad in ["2718", "27182", "2718281828459", "27a828", "27 828", ""] {
        assert!(Pin::new(bad, &SALT).is_err_and(|error| error.contains("6 to 12 digits")), "{bad:?}");
    }
    let argon2i = "$argon2i$v=19$m=4096,t=3,p=1$c29tZXNhbHQ$iWh06vD8Fy27wf9npn6FXWiCX4K6pW6Ue1Bnzz07Z8A";
    let greedy = "$argon2id$v=19$m=4194304,t=3,p=1$c29tZXNhbHQ$iWh06vD8Fy27wf9npn6FXWiCX4K6pW6Ue1Bnzz07Z8A";
    let cut = "$argon2id$v=19$m=4096,t=3,p=1$c29tZXNhbHQ";
    for bad in ["271828", argon2i, greedy, cut] {
        let text = format!("[staff]\npin = \"{bad}\"\n");
        let error = Config::parse(&text, Path::new("kiosk.toml")).expect_err(bad);
        let problem = &error.problems[0];
        assert_eq!((problem.line, problem.column), (2, 7), "{problem:?}");
        assert!(problem.message.contains("soffio pin"), "{problem:?}");
    }
}

#[test]
fn a_pin_that_is_tried_first_is_refused_with_the_reason() {
    for (weak, why) in [
        ("777777", "different"),
        ("272727", "different"),
        ("271271", "repeats"),
        ("27182718", "repeats"),
        ("2712712", "repeats"),
        ("123456", "counts"),
        ("987654", "counts"),
        ("890123", "counts"),
        ("123471", "counts"),
        ("714321", "counts"),
        ("311285", "date"),
        ("123185", "date"),
        ("851231", "date"),
        ("19851224", "date"),
        ("24121985", "date"),
    ] {
        let refused = Pin::new(weak, &SALT).expect_err(weak);
        assert!(refused.contains(why), "{weak}: {refused}");
    }
    for good in ["271828", "314159", "909192", "58209741"] {
        assert!(Pin::new(good, &SALT).is_ok(), "{good}");
    }
}

#[test]
fn a_hash_of_four_digits_from_an_earlier_version_still_opens() {
    // Made with the parameters of that version: 19 MiB, two passes.
    let old = {
        use argon2::password_hash::{PasswordHasher, SaltString};
        let salt = SaltString::encode_b64(&SALT).expect("a salt");
        argon2::Argon2::default().hash_password(b"2718", &salt).expect("a hash").to_string()
    };
    assert!(old.contains("m=19456,t=2,p=1"), "{old}");
    assert!(Pin::try_from(old).expect("a hash").matches("2718"));
}
