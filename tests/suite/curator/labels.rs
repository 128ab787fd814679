//! Label texts as a table and back: nothing is lost, nothing else is touched, and what is missing or unknown is said.

use soffio_exhibit::Report;
use soffio_exhibit::labels::{MergedTexts, from_csv, to_csv};

const SIDECAR: &str = r#"schema = "exhibit/1"
model = "m.glb"   # the model

[label]
default_language = "en"

# English first.
[label.en]
title = "A \"test\", with commas"   # the curator's own
maker = "Somebody"
body = """
Two paragraphs.

The second, on \
one line; and a tab:	."""
alt = "A rod."
text = { invite = "Blow" } # short
caption = { ring = "[rings]" }

[label.ko]
title = "종이 달린 시계"
alt = "막대 하나."
text.invite = "부드럽게 불어 보세요."

[label.ar]
title = "جرس الرياح"
maker = '''شخص ما'''
text = { invite = "انفخ برفق" }
"#;

fn taken(table: &str) -> MergedTexts {
    from_csv("exhibit.toml", SIDECAR, "words.csv", table).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

fn refused(table: &str) -> Report {
    from_csv("exhibit.toml", SIDECAR, "words.csv", table).expect_err(table)
}

fn table() -> String {
    to_csv("exhibit.toml", SIDECAR).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

#[test]
fn a_table_has_a_row_a_text_and_a_column_a_language() {
    let table = table();
    let text = table.strip_prefix('\u{feff}').expect("a byte order mark, for spreadsheets");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let head: Vec<String> = reader.headers().expect("a head").iter().map(str::to_owned).collect();
    assert_eq!(head, ["key", "en", "ko", "ar"]);
    let rows: Vec<Vec<String>> =
        reader.records().map(|row| row.expect("a row").iter().map(str::to_owned).collect()).collect();
    let keys: Vec<&str> = rows.iter().map(|row| row[0].as_str()).collect();
    assert_eq!(keys, ["title", "maker", "body", "alt", "text.invite", "caption.ring"]);
    assert_eq!(rows[0][1..], ["A \"test\", with commas", "종이 달린 시계", "جرس الرياح"]);
    assert_eq!(rows[2][1], "Two paragraphs.\n\nThe second, on one line; and a tab:\t.");
    assert_eq!(rows[4][1..], ["Blow", "부드럽게 불어 보세요.", "انفخ برفق"]);
    assert_eq!(rows[5][1..], ["[rings]", "", ""]);
}

#[test]
fn a_table_read_back_leaves_the_file_as_it_was() {
    let back = taken(&table());
    assert_eq!((back.sidecar.as_str(), back.changed), (SIDECAR, 0));
    // What was missing is said.
    assert_eq!(back.remarks.len(), 6, "{:?}", back.remarks);
    assert!(back.remarks.iter().any(|r| r.contains("caption.ring") && r.contains("\"ko\"")), "{:?}", back.remarks);
}

#[test]
fn changes_reach_their_places_and_comments_stay() {
    let table = "key,en,ko,it\n\
                 title,\"New, \"\"title\"\"\",새 제목,Nuovo titolo\n\
                 caption.ring,[rings],[울리는 소리],[risuona]\n\
                 body,\"One\nTwo\",,Uno\n";
    let back = taken(table);
    assert_eq!(back.changed, 7, "{}", back.sidecar);
    let value: toml::Table = back.sidecar.parse().expect("TOML");
    let of = |language: &str, key: &str| value["label"][language].get(key).and_then(|v| v.as_str()).map(str::to_owned);
    assert_eq!(of("en", "title").as_deref(), Some("New, \"title\""));
    assert_eq!(of("en", "body").as_deref(), Some("One\nTwo"));
    assert_eq!(of("it", "title").as_deref(), Some("Nuovo titolo"));
    assert_eq!(value["label"]["ko"]["caption"]["ring"].as_str(), Some("[울리는 소리]"));
    assert_eq!(value["label"]["it"]["caption"]["ring"].as_str(), Some("[risuona]"));
    for kept in
        ["# the model", "# English first.", "# the curator's own", "# short", "'''شخص ما'''", "maker = \"Somebody\""]
    {
        assert!(back.sidecar.contains(kept), "{kept} is gone:\n{}", back.sidecar);
    }
    for said in ["\"ar\" has no column", "\"alt\" has no row", "\"text.invite\" has no row"] {
        assert!(back.remarks.iter().any(|r| r.contains(said)), "{said}: {:?}", back.remarks);
    }
    // Once more: nothing is left to do.
    let again = from_csv("exhibit.toml", &back.sidecar, "words.csv", table).expect("good");
    assert_eq!((again.changed, again.sidecar == back.sidecar), (0, true));
}

#[test]
fn unusable_rows_are_all_refused_at_once_with_their_lines() {
    let table = "key,en,deutsch,en\ntitle,a,b,c\ncaption.rng,a,b,c\ntitle,d,e,f\nalt,a\n\nmaker,\"a\nb\",c\n";
    let report = refused(table);
    let found: Vec<(usize, &str)> =
        report.diagnostics.iter().map(|d| (d.location.as_ref().map_or(0, |l| l.line), d.message.as_str())).collect();
    for (line, words) in [
        (1, "\"deutsch\" is not a language"),
        (1, "\"en\" has two columns"),
        (3, "no text \"caption.rng\""),
        (4, "\"title\" has two rows"),
        (5, "2 cells"),
        (7, "3 cells"),
    ] {
        assert!(found.iter().any(|(l, m)| *l == line && m.contains(words)), "{line}: {words} not in {found:?}");
    }
    assert_eq!(found.len(), 6, "{found:?}");
    assert!(report.diagnostics.iter().all(|d| d.help.as_ref().is_some_and(|help| !help.is_empty())));
    assert!(report.to_text().contains("\"caption.ring\""), "a near key");
    for table in ["", "title,en\n", "\u{feff}", "key\0,en"] {
        assert!(!refused(table).diagnostics.is_empty(), "{table:?}");
    }
    let bare = "schema = \"exhibit/1\"\nmodel = \"m.glb\"\n";
    assert!(to_csv("exhibit.toml", bare).expect_err("no label").to_text().contains("no label"));
    assert!(to_csv("exhibit.toml", "not toml").expect_err("broken").to_text().contains("exhibit.toml:1"));
}
