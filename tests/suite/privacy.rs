//! What the kiosk says that it keeps, and that it says it of the configuration it is asked about.

use serde_json::Value;
use soffio::commands::privacy::report;
use soffio_config::Config;

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
    assert!(usual.kept.iter().any(|kept| kept.place.contains("--record")), "the engineers' recording option is listed");
    assert!(!usual.kept.iter().any(|kept| kept.place.contains(".prom")));
    let bad = desk.soffio(&["privacy", "--config", "nowhere.toml"]);
    assert!(bad.code == Some(1) && bad.err.contains("nowhere.toml"), "{:?} {}", bad.code, bad.err);
}

#[cfg(feature = "kiosk")]
#[test]
fn what_is_counted_and_what_a_broker_is_told_is_named() {
    let text = "[staff]\nmetrics = \"/srv/soffio.prom\"\nstate = \"/srv/state\"\n[mqtt]\nbroker = \"broker.museum\"\n";
    let config = Config::parse(text, std::path::Path::new("kiosk.toml")).expect("a good configuration");
    let report = report(&config);
    for place in ["/srv/soffio.prom", "/srv/state"] {
        let kept = report.kept.iter().find(|kept| kept.place == place).expect("it is kept");
        assert!(kept.what.contains("breaths by their source"), "{}", kept.what);
    }
    assert!(matches!(&report.sent[..], [entry] if entry.contains("broker.museum")), "{:?}", report.sent);
}
