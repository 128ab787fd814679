//! The staff's PIN in the configuration: a hash and nothing else.

use std::path::Path;

use soffio_config::{Config, Pin};

/// Some salt: what matters here is that it is fixed.
const SALT: [u8; 16] = *b"salt of sixteen.";

#[test]
fn a_pin_is_kept_as_a_hash_that_only_its_digits_match() {
    let pin = Pin::new("271828", &SALT).expect("six digits");
    let text = String::from(pin.clone());
    assert!(text.starts_with("$argon2id$v=19$m=19456,t=2,p=1$") && !text.contains("271828"), "{text}");
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
    for bad in ["123", "1234567890123", "12a4", "12 34", ""] {
        assert!(Pin::new(bad, &SALT).is_err_and(|error| error.contains("4 to 12 digits")), "{bad:?}");
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
