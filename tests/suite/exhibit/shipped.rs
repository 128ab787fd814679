//! The exhibits in the tree load without a warning.

use soffio_exhibit as exhibit;

#[test]
fn an_unknown_id_names_what_was_looked_for() {
    let report = exhibit::resolve("no-such-thing").expect_err("unknown");
    assert!(report.has(exhibit::codes::NO_EXHIBIT));
    assert!(report.to_string().contains("no-such-thing"));
}
