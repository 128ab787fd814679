//! The exhibits in the tree load without a warning.

use soffio_exhibit as exhibit;

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
fn the_readme_shows_every_exhibit() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).expect("a README");
    for id in exhibit::ids() {
        let picture = format!("exhibits/{id}/thumbnail.png");
        assert!(readme.contains(&picture), "{id} has no picture in the README");
        assert!(root.join(&picture).is_file(), "{picture} is missing");
    }
}

#[test]
fn an_unknown_id_names_what_was_looked_for() {
    let report = exhibit::resolve("no-such-thing").expect_err("unknown");
    assert!(report.has(exhibit::codes::NO_EXHIBIT));
    assert!(report.to_string().contains("no-such-thing"));
}
