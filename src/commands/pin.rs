//! `soffio pin`.

use std::io::{BufRead, IsTerminal};

use super::failure::{Failure, Outcome};
use soffio_config::{DIGITS, Pin};

/// Reads a PIN for staff and prints the line for the configuration: its hash, never its digits.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Example: soffio pin
         echo 271828 | soffio pin

Put the printed line into [staff] of kiosk-config/kiosk.toml; a running kiosk takes it over at once.")]
pub struct Args {}

/// Runs the command.
pub fn run(Args {}: Args) -> Outcome {
    let terminal = console::Term::stderr();
    let digits = if std::io::stdin().is_terminal() {
        let ask = |question: &str| {
            let answer = terminal.write_str(question).and_then(|()| terminal.read_secure_line());
            answer.map_err(|error| Failure::input(format!("the terminal cannot be read: {error}")))
        };
        let digits = ask(&format!("PIN, {} to {} digits: ", DIGITS.start(), DIGITS.end()))?;
        if digits != ask("The same again: ")? {
            return Err(Failure::input("the two PINs differ; nothing is set"));
        }
        digits
    } else {
        let mut line = String::new();
        std::io::stdin().lock().read_line(&mut line).map_err(|error| Failure::input(format!("no PIN: {error}")))?;
        line.trim().to_owned()
    };
    let mut salt = [0; 16];
    getrandom::fill(&mut salt)
        .map_err(|error| Failure::device(format!("the system provides no random bytes: {error}")))?;
    let pin = Pin::new(&digits, &salt).map_err(Failure::input)?;
    println!("pin = \"{}\"", String::from(pin));
    Ok(())
}
