//! The exhibits in the tree load without a warning.

use soffio::exhibit;

#[test]
fn every_shipped_exhibit_is_good() {
    for id in exhibit::ids() {
        let folder = exhibit::resolve(&id).expect("an id that was listed");
        let loaded = exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}:\n{}", report.render(false)));
        assert!(loaded.warnings.is_empty(), "{id}: {:#?}", loaded.warnings);
        assert_eq!(loaded.id, id);
    }
}

#[test]
fn an_unknown_id_names_what_was_looked_for() {
    let report = exhibit::resolve("no-such-thing").expect_err("unknown");
    assert!(report.has(exhibit::codes::NO_EXHIBIT));
    assert!(report.to_string().contains("no-such-thing"));
}
