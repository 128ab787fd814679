//! Old names of options, and of words that they take: still read, with a warning that names the new one.

use std::ffi::OsString;

/// An option, or a word that it takes, with another name than before.
struct OldOption {
    /// The command.
    command: &'static str,
    /// The option, dashes included: the old name, or the present one where its word has changed.
    option: &'static str,
    /// What has changed.
    change: Change,
}

enum Change {
    /// The option has this new name.
    Option(&'static str),
    /// Its word `old` is now `new`.
    Word { old: &'static str, new: &'static str },
}

/// All old names of options and words.
const OLD_OPTIONS: &[OldOption] = &[
    OldOption { command: "doctor", option: "--chirp", change: Change::Option("--audio-self-test") },
    OldOption { command: "play", option: "--profile", change: Change::Word { old: "true", new: "physical" } },
];

/// The arguments with new names in the place of old ones, and a warning for each.
pub(super) fn update(arguments: impl Iterator<Item = OsString>) -> (Vec<OsString>, Vec<String>) {
    let mut arguments: Vec<OsString> = arguments.collect();
    let mut warnings = Vec::new();
    let command = arguments.get(1).and_then(|command| command.to_str()).unwrap_or_default().to_owned();
    let end = arguments.iter().position(|argument| argument == "--").unwrap_or(arguments.len());
    for index in 2..end {
        let Some(text) = arguments[index].to_str().map(str::to_owned) else { continue };
        let (option, value) = text.split_at(text.find('=').unwrap_or(text.len()));
        let Some(known) = OLD_OPTIONS.iter().find(|known| known.command == command && known.option == option) else {
            continue;
        };
        match known.change {
            Change::Option(new) => {
                warnings.push(format!("warning: `soffio {command} {option}` is now called `soffio {command} {new}`"));
                arguments[index] = format!("{new}{value}").into();
            }
            Change::Word { old, new } => {
                let next = arguments.get(index + 1).is_some_and(|word| word == old);
                match value.strip_prefix('=') {
                    Some(word) if word == old => arguments[index] = format!("{option}={new}").into(),
                    None if next => arguments[index + 1] = new.into(),
                    _ => continue,
                }
                warnings.push(format!("warning: `{option} {old}` is now called `{option} {new}`"));
            }
        }
    }
    (arguments, warnings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_options_become_new_ones_and_nothing_else_changes() {
        let run = |line: &str| {
            let (arguments, warnings) = update(line.split(' ').map(OsString::from));
            let line: Vec<String> = arguments.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            (line.join(" "), warnings.len())
        };
        let old = "soffio doctor --blow --chirp --json";
        assert_eq!(run(old), ("soffio doctor --blow --audio-self-test --json".into(), 1));
        for same in ["soffio", "soffio doctor", "soffio play --chirp", "soffio doctor -- --chirp", "soffio play true"] {
            assert_eq!(run(same), (same.into(), 0));
        }
        for OldOption { command, option, change } in OLD_OPTIONS {
            match change {
                Change::Option(new) => {
                    assert_eq!(run(&format!("soffio {command} {option}")), (format!("soffio {command} {new}"), 1));
                }
                Change::Word { old, new } => {
                    for between in [" ", "="] {
                        let line = |word: &str| format!("soffio {command} {option}{between}{word} --json");
                        assert_eq!(run(&line(old)), (line(new), 1));
                        assert_eq!(run(&line("gallery")), (line("gallery"), 0));
                    }
                }
            }
        }
    }
}
