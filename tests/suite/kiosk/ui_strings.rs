//! UI strings: every language is complete, plural forms, a museum's own files, and what is wrong with those.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use soffio_kiosk::pages::ui_strings::{
    FOLDER, SHIPPED, TextFile, TextId, TextProblem, Translations, Variable, check, variables,
};

use super::pages::texts;

/// A configuration folder with files of texts; its configuration file.
fn folder(files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir(folder.path().join(FOLDER)).expect("a folder");
    for (name, text) in files {
        std::fs::write(folder.path().join(FOLDER).join(name), text).expect("it is written");
    }
    let configuration = folder.path().join("kiosk.toml");
    (folder, configuration)
}

/// The problems of a file with this name and text.
fn problems(name: &str, text: &str) -> Vec<TextProblem> {
    let (_folder, configuration) = folder(&[(name, text)]);
    check(&configuration.with_file_name(FOLDER).join(name))
}

fn breaths(texts: &Translations, language: &str, count: u64) -> String {
    texts.get(language).format(TextId::StaffFoamBreaths, &[("count", count.into())]).to_string()
}

#[test]
fn every_shipped_language_has_every_key_with_the_variables_of_english() {
    let english = variables(SHIPPED[0].1);
    let keys: BTreeSet<&str> = TextId::ALL.iter().map(|id| id.key()).collect();
    assert_eq!(keys, english.keys().map(String::as_str).collect(), "the keys in the program are those of en.ftl");
    for (code, text) in SHIPPED {
        let (_folder, configuration) = folder(&[(&format!("{code}.ftl"), text)]);
        let found = check(&configuration.with_file_name(FOLDER).join(format!("{code}.ftl")));
        assert_eq!(found, [], "{code}.ftl");
        assert_eq!(variables(text), english, "{code}.ftl");
    }
}

#[test]
fn no_shipped_text_is_empty_or_left_in_english() {
    for strings in texts().languages() {
        let all: Vec<String> = strings.all().collect();
        for (id, text) in TextId::ALL.iter().zip(&all) {
            assert!(!(text.trim().is_empty() || id.is_staff() && text == id.key()), "{}: {}", strings.code(), id.key());
            assert!(
                !text.contains(['\u{2068}', '\u{2069}']),
                "{}: {} has marks of isolation",
                strings.code(),
                id.key()
            );
        }
        // Units, abbreviations, and words that both languages share.
        if strings.code() != "en" {
            let same = all.iter().zip(texts().get("en").all()).filter(|(own, english)| **own == *english).count();
            assert!(same < all.len() / 8, "{}: {same} texts are the same as in English", strings.code());
        }
    }
}

#[test]
fn plural_forms_are_those_of_the_language() {
    for (language, expected) in [
        ("en", ["0 breaths", "1 breath", "2 breaths", "5 breaths"]),
        ("de", ["0 Atemstöße", "1 Atemstoß", "2 Atemstöße", "5 Atemstöße"]),
        // French counts none like one.
        ("fr", ["0 souffle", "1 souffle", "2 souffles", "5 souffles"]),
        ("ja", ["息 0 回", "息 1 回", "息 2 回", "息 5 回"]),
    ] {
        assert_eq!([0, 1, 2, 5].map(|count| breaths(texts(), language, count)), expected, "{language}");
    }
    // Polish has three forms for whole numbers.
    let polish = "staff-foam-breaths = { $count ->\n    [one] { $count } wydech\n    [few] { $count } wydechy\n   *[many] \
                  { $count } wydechów\n}\n";
    let (_folder, configuration) = folder(&[("pl.ftl", polish)]);
    let texts = Translations::load(Some(&configuration));
    let expected = ["0 wydechów", "1 wydech", "2 wydechy", "5 wydechów", "22 wydechy"];
    assert_eq!([0, 1, 2, 5, 22].map(|count| breaths(&texts, "pl", count)), expected);
}

#[test]
fn a_museum_overrides_single_texts_and_adds_a_language() {
    let (_folder, configuration) = folder(&[
        ("de.ftl", "invite = Puste ganz sacht\n"),
        ("nl.ftl", "language-name = Nederlands\ninvite = Blaas zachtjes\n"),
        ("notes.txt", "invite = nothing\n"),
    ]);
    let texts = Translations::load(Some(&configuration));
    assert_eq!(texts.get("de").get(TextId::Invite), "Puste ganz sacht");
    assert_eq!(texts.get("de").get(TextId::More), "Mehr", "the other texts stay");
    assert_eq!(texts.get("nl").get(TextId::Invite), "Blaas zachtjes");
    assert_eq!((texts.get("nl").code(), texts.language_name("nl")), ("nl", "Nederlands"));
    assert_eq!(texts.get("en").get(TextId::Invite), "Blow gently");
    assert_eq!(texts.languages().count(), SHIPPED.len() + 1);
    let without = Translations::load(Some(Path::new("no-such-folder/kiosk.toml")));
    assert_eq!(without.languages().count(), SHIPPED.len(), "without a folder the shipped texts stand");
}

#[test]
fn a_missing_text_comes_from_the_language_without_its_region_and_then_from_english() {
    let (_folder, configuration) = folder(&[
        ("pt-BR.ftl", "invite = Sopre de leve\n"),
        ("pt.ftl", "invite = Sopre devagar\nmore = Mais\n"),
        ("de-AT.ftl", "more = Mehr davon\n"),
        ("en.ftl", "back = Return to the work\n"),
    ]);
    let texts = Translations::load(Some(&configuration));
    let of =
        |language: &str| [TextId::Invite, TextId::More, TextId::Back].map(|id| texts.get(language).get(id).to_owned());
    assert_eq!(of("pt-BR"), ["Sopre de leve", "Mais", "Return to the work"], "English as the museum has it");
    assert_eq!(of("pt_br"), of("pt-BR"), "spelt in another way");
    assert_eq!(of("pt"), ["Sopre devagar", "Mais", "Return to the work"]);
    assert_eq!(of("pt-AO"), of("pt"), "a region without a file");
    assert_eq!(of("de-AT"), ["Sanft pusten", "Mehr davon", "Zurück zum Werk"]);
    assert_eq!(of("xx"), of("en"));
    assert_eq!(breaths(&texts, "pt-BR", 2), "2 breaths", "with variables too");
    // Names of languages.
    for (code, name) in
        [("ko-KR", "한국어"), ("pt-BR", "Português"), ("he", "עברית"), ("de-AT", "Deutsch"), ("xx", "xx")]
    {
        assert_eq!(texts.language_name(code), name);
    }
}

#[test]
fn a_broken_file_leaves_the_shipped_texts_and_each_problem_has_its_place_and_remedy() {
    let text = "invite = Sanft\nmoer = Mehr\nback\nstaff-foam-breaths = { $cuont } Mal\nprivacy = { -firma } misst\n\
                aim = { aim }\ninvite = Ganz sanft\nhold = { NUMBER(1) }\n";
    let found = problems("de.ftl", text);
    let place = |part: &str| {
        let problem = found.iter().find(|problem| problem.message.contains(part));
        let problem = problem.unwrap_or_else(|| panic!("{part}: {found:#?}"));
        assert!(!problem.is_warning && !problem.help.is_empty(), "{problem}");
        ((problem.line, problem.column), problem.help.as_str())
    };
    assert_eq!(place("unknown key `moer`"), ((2, 1), "did you mean `more`?"));
    assert_eq!(place("syntax error").0.0, 3);
    assert_eq!(place("unknown variable `$cuont`"), ((4, 25), "`staff-foam-breaths` has { $count }"));
    assert_eq!(place("`privacy` cannot be shown").0, (5, 1));
    assert_eq!(place("`aim` cannot be shown").0, (6, 1));
    assert_eq!(place("`invite` stands twice").0, (7, 1));
    assert_eq!(place("`hold` cannot be shown").0, (8, 1));
    assert_eq!(found.len(), 7, "{found:#?}");
    let (_folder, configuration) = folder(&[("de.ftl", text)]);
    let texts = Translations::load(Some(&configuration));
    let german = texts.get("de");
    assert_eq!(german.get(TextId::Invite), "Ganz sanft", "what is good is used");
    for id in [TextId::More, TextId::Back, TextId::Privacy, TextId::Aim, TextId::Hold] {
        assert_eq!(german.get(id), super::pages::texts().get("de").get(id), "{}", id.key());
    }
    assert_eq!(breaths(&texts, "de", 1), "1 Atemstoß");
}

#[test]
fn a_new_language_is_told_which_texts_it_lacks_and_an_override_is_not() {
    assert_eq!(problems("fr.ftl", "invite = Soufflez\n"), []);
    assert_eq!(problems("fr-CA.ftl", "invite = Soufflez\n"), []);
    let found = problems("nl.ftl", "invite = Blaas zachtjes\nmore = Meer\n");
    let [visitors, staff] = found.as_slice() else { panic!("{found:#?}") };
    assert!(visitors.is_warning && visitors.message.contains("texts for visitors are missing: language-name, hold"));
    assert!(staff.is_warning && staff.message.contains("staff-no-pin") && !staff.message.contains(" hold"));
    let count = |staff: bool| TextId::ALL.iter().filter(|id| id.is_staff() == staff).count();
    assert!(visitors.message.starts_with(&format!("{} texts", count(false) - 2)), "{visitors}");
    assert!(staff.message.starts_with(&format!("{} texts", count(true))), "{staff}");
    let left_out = problems("de.ftl", "staff-saved-in = Gespeichert.\n");
    assert!(left_out.len() == 1 && left_out[0].is_warning && left_out[0].message.contains("leaves out $file"));
}

#[test]
fn whatever_a_file_holds_it_is_reported_and_never_stops_the_kiosk() {
    let deep = format!("invite = {}x{}", "{".repeat(5000), "}".repeat(5000));
    let long = format!("staff-foam-breaths = {{ {} ->\n [1.{}] a\n *[other] b\n}}\n", "9".repeat(40), "0".repeat(40));
    let many = format!("invite = {}", "{ -a }".repeat(300));
    for (name, text) in [
        ("de.ftl", deep.as_str()),
        ("de.ftl", &long),
        ("de.ftl", &many),
        ("de.ftl", "\u{feff}moer = x\n"),
        ("de.ftl", "= = {{}} [ ] *\n -x\n\u{0}\n"),
        ("no-code-at-all.ftl", "invite = x\n"),
        ("_.ftl", ""),
    ] {
        let found = problems(name, text);
        assert!(!found.is_empty(), "{name}: {text:.80}");
        let (_folder, configuration) = folder(&[(name, text)]);
        let texts = Translations::load(Some(&configuration));
        assert_eq!(texts.get("de").get(TextId::Invite), "Sanft pusten", "{name}: {text:.80}");
        assert_eq!(breaths(&texts, "de", 5), "5 Atemstöße", "{name}: {text:.80}");
    }
    let (_folder, configuration) = folder(&[]);
    let path = configuration.with_file_name(FOLDER).join("de.ftl");
    std::fs::write(&path, [0xff, 0xfe, 0x00]).expect("it is written");
    let (file, found) = TextFile::read(&path);
    assert!(file.is_none() && found[0].message.contains("cannot be read"), "{found:?}");
}

#[test]
fn a_text_is_formatted_again_only_where_a_variable_differs() {
    let strings = texts().get("it");
    let format = |count: u64, limit: &'static str| {
        strings
            .format(TextId::StaffStepTime, &[("ms", Variable::Text(count.to_string().into())), ("limit", limit.into())])
    };
    let first = format(7, "4.167");
    assert_eq!(&*first, "7 ms di 4.167 ms");
    assert!(std::sync::Arc::ptr_eq(&first, &format(7, "4.167")), "it is the same text");
    let other = format(8, "4.167");
    assert_eq!(&*other, "8 ms di 4.167 ms");
    assert!(std::sync::Arc::ptr_eq(&first, &format(7, "4.167")), "two places with the same key are both remembered");
}
