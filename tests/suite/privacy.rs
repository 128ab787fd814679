//! What the kiosk says that it keeps, and that it says it of the configuration it is asked about.

use serde_json::Value;
use soffio::commands::privacy::report;
use soffio::config::Config;

use crate::cli::Desk;

#[test]
fn the_report_names_what_is_kept_where_and_until_when_and_what_is_not() {
    let desk = Desk::new();
    let run = desk.soffio(&["privacy"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    for word in ["Kept:", "Not kept", "Over the network:\n  nothing", "microphone", "memory", "until:"] {
        assert!(run.out.contains(word), "{word}: {}", run.out);
    }
    let run = desk.soffio(&["privacy", "--json"]);
    let said: Value = serde_json::from_str(&run.out).expect("one JSON object");
    let kept = said["kept"].as_array().expect("a list");
    assert!(
        kept.iter()
            .all(|kept| ["what", "place", "until"].iter().all(|key| kept[key].as_str().is_some_and(|s| !s.is_empty())))
    );
    assert!(said["not_kept"].as_array().is_some_and(|list| list.len() >= 5));
    assert_eq!(said["sent"], Value::Array(Vec::new()));
}

#[test]
fn it_follows_the_configuration() {
    let desk = Desk::new();
    desk.write("site.toml", "[visit]\nbreath = false\n[staff]\nmetrics = \"/srv/soffio.prom\"\n");
    let run = desk.soffio(&["privacy", "--config", "site.toml", "--json"]);
    let said: Value = serde_json::from_str(&run.out).expect("one JSON object");
    let text = said["kept"].to_string();
    assert!(!text.contains("microphone samples"), "nobody blows there: {text}");
    assert!(text.contains("/srv/soffio.prom"), "{text}");
    let usual = report(&Config::default());
    assert!(usual.kept.iter().any(|kept| kept.what.contains("microphone samples")));
    assert!(!usual.kept.iter().any(|kept| kept.place.contains(".prom")));
    let bad = desk.soffio(&["privacy", "--config", "nowhere.toml"]);
    assert!(bad.code == Some(1) && bad.err.contains("nowhere.toml"), "{:?} {}", bad.code, bad.err);
}

#[cfg(feature = "kiosk")]
#[test]
fn every_number_of_the_kiosk_is_named_and_none_is_about_a_visitor() {
    let config = Config::parse("[staff]\nmetrics = \"/srv/soffio.prom\"\n", std::path::Path::new("kiosk.toml"));
    let report = report(&config.expect("a good configuration"));
    let kept = report.kept.iter().find(|kept| kept.place == "/srv/soffio.prom").expect("it is kept");
    let text = soffio::kiosk::metrics::text(&soffio::kiosk::live::Load::default());
    let names: Vec<&str> =
        text.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split(' ').next()).collect();
    assert!(names.len() > 5 && names.iter().all(|name| kept.what.contains(name)), "{} of {names:?}", kept.what);
}
