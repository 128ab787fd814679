//! `soffio pin`.

use std::io::{BufRead, IsTerminal};

use super::failure::{Failure, Outcome};
use soffio_config::{DIGITS, Pin};

/// Asks for the staff's PIN and prints the line that the configuration takes: its hash, never its digits.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Example: soffio pin
         echo 271828 | soffio pin

Put the line it prints into [staff] of kiosk-config/kiosk.toml; a running kiosk takes it over at once.")]
pub struct Args {}

/// Runs the command.
pub fn run(Args {}: Args) -> Outcome {
    let terminal = console::Term::stderr();
    let digits = if std::io::stdin().is_terminal() {
        let ask = |question: &str| {
            let asked = terminal.write_str(question).and_then(|()| terminal.read_secure_line());
            asked.map_err(|error| Failure::input(format!("the terminal cannot be read: {error}")))
        };
        let digits = ask(&format!("PIN, {} to {} digits: ", DIGITS.start(), DIGITS.end()))?;
        if digits != ask("The same again: ")? {
            return Err(Failure::input("these are two different PINs; nothing is set"));
        }
        digits
    } else {
        let mut line = String::new();
        std::io::stdin().lock().read_line(&mut line).map_err(|error| Failure::input(format!("no PIN: {error}")))?;
        line.trim().to_owned()
    };
    let mut salt = [0; 16];
    getrandom::fill(&mut salt)
        .map_err(|error| Failure::device(format!("the system gives no random bytes: {error}")))?;
    let pin = Pin::new(&digits, &salt).map_err(Failure::input)?;
    println!("pin = \"{}\"", String::from(pin));
    Ok(())
}
