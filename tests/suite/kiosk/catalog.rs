//! Catalog of exhibits: folders that are saved, dropped and taken away.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use soffio_kiosk::venue::catalog::{Catalog, CatalogEvent, CatalogLoader, ExhibitSource, folders, id};
use soffio_kiosk::venue::quarantine::{LoadMarker, Quarantine};

use crate::sound::own_timbres::{self, WHIRR};
use crate::sound::{RATE, spectrum};

#[test]
fn a_saved_file_loads_the_exhibit_and_a_bad_one_is_reported() {
    /// Far longer than the debounce time and a load: only a watcher that misses the change takes so long.
    const LONG: Duration = Duration::from_secs(20);
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish");
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("steel-fish");
    copy_folder(&shipped, &copy);
    let mut shelf = CatalogLoader::new(
        &ExhibitSource::One(copy.clone()),
        &copy,
        true,
        &Quarantine::default(),
        LoadMarker::default(),
    );
    shelf.list();
    assert!(
        matches!(shelf.wait(LONG), Some(CatalogEvent::Listed(work)) if work.id == "steel-fish" && work.thumbnail.is_some())
    );
    let sidecar = copy.join("exhibit.toml");
    let text = std::fs::read_to_string(&sidecar).expect("a sidecar");

    std::fs::write(&sidecar, &text).expect("writable");
    let Some(CatalogEvent::Show(loaded, _)) = shelf.wait(LONG) else {
        panic!("the change is noticed, the exhibit valid")
    };
    assert_eq!(loaded.id, "steel-fish");
    assert!(matches!(shelf.wait(LONG), Some(CatalogEvent::Listed(_))));

    std::fs::write(&sidecar, format!("{text}\n[no-such-table]\n")).expect("writable");
    let Some(CatalogEvent::Rejected(id, report)) = shelf.wait(LONG) else {
        panic!("the change is noticed, nothing shown")
    };
    assert!(id == "steel-fish" && report.contains("no-such-table"), "{report}");
}

#[test]
fn a_saved_timbre_is_loaded_again_and_a_broken_one_leaves_the_exhibit_on_show() {
    /// Far longer than the debounce time and a load: only a watcher that misses the change takes so long.
    const LONG: Duration = Duration::from_secs(20);
    // Folders whose names begin with a dot are not offered, and temporary ones do.
    let folder = own_timbres::folder("whirr", "", &[("whirr.toml", WHIRR)]);
    let path = folder.path().join("wheel");
    std::fs::create_dir_all(path.join("timbres")).expect("writable");
    for file in ["model.glb", "exhibit.toml", "timbres/whirr.toml"] {
        std::fs::copy(folder.path().join(file), path.join(file)).expect("a copy");
    }
    let mut shelf = CatalogLoader::new(
        &ExhibitSource::One(path.clone()),
        &path,
        true,
        &Quarantine::default(),
        LoadMarker::default(),
    );
    shelf.list();
    let first = shelf.wait(LONG);
    assert!(matches!(first, Some(CatalogEvent::Listed(_))), "it is listed first");
    folder.write("wheel/timbres/whirr.toml", WHIRR.replace("scale = 40", "scale = 80").as_bytes());
    let Some(CatalogEvent::Show(loaded, _)) = shelf.wait(LONG) else {
        panic!("the change is noticed, the exhibit valid")
    };
    let power = spectrum(&own_timbres::heard(Arc::unwrap_or_clone(loaded), 2)[RATE as usize..], 4800);
    assert!(power[80] > 1e3 * power[90], "an octave higher");
    let listed = shelf.wait(LONG);
    assert!(matches!(listed, Some(CatalogEvent::Listed(_))), "it is listed again");
    folder.write("wheel/timbres/whirr.toml", WHIRR.replace("type = \"fm\"", "type = \"fmm\"").as_bytes());
    let Some(CatalogEvent::Rejected(_, report)) = shelf.wait(LONG) else {
        panic!("the change is noticed, nothing shown")
    };
    assert!(report.contains("did you mean \"fm\"") && report.contains("whirr.toml"), "{report}");
}

#[test]
fn folders_that_are_dropped_are_offered_in_the_sites_order_and_go_when_they_are_taken_away() {
    const LONG: Duration = Duration::from_secs(20);
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits");
    let site = tempfile::tempdir().expect("a folder");
    for id in ["pendulum", "steel-fish"] {
        copy_folder(&shipped.join(id), &site.path().join(id));
    }
    let show = ["steel-fish", "*", "pendulum"].map(str::to_owned).to_vec();
    let places = ExhibitSource::All { folder: site.path().to_path_buf(), show };
    let named: Vec<String> = folders(&places).iter().map(|folder| id(folder)).collect();
    assert_eq!(named, ["steel-fish", "pendulum"]);
    let mut shelf = CatalogLoader::new(
        &places,
        &site.path().join("steel-fish"),
        true,
        &Quarantine::default(),
        LoadMarker::default(),
    );
    shelf.list();
    let mut offer = Catalog::new(&places);
    // Before anything is loaded a visitor can leaf already.
    offer.expect(folders(&places));
    assert_eq!(offer.neighbour("steel-fish", 1).map(id).as_deref(), Some("pendulum"));
    assert!(offer.entries().is_empty() && offer.folder("pendulum").is_some() && offer.folder("chains").is_none());
    let mut said = Vec::new();
    let mut until = |offer: &mut Catalog, wanted: &[&str]| {
        while offer.entries().iter().map(|work| work.id.as_str()).ne(wanted.iter().copied()) {
            match shelf.wait(LONG).unwrap_or_else(|| panic!("{wanted:?} never stood there: {:?}", offer.entries())) {
                CatalogEvent::Listed(work) => offer.insert(*work),
                CatalogEvent::Removed(id) => offer.remove(&id),
                CatalogEvent::Rejected(id, report) => {
                    offer.remove(&id);
                    said.push(report);
                }
                CatalogEvent::Show(..) | CatalogEvent::Failed(_) => {}
            }
        }
    };
    until(&mut offer, &["steel-fish", "pendulum"]);
    // Dropped while the kiosk runs: between the two that are named, as the star says.
    copy_folder(&shipped.join("chains"), &site.path().join("chains"));
    until(&mut offer, &["steel-fish", "chains", "pendulum"]);
    assert_eq!(offer.neighbour("pendulum", 1).map(id).as_deref(), Some("steel-fish"), "round and round");
    assert_eq!(offer.neighbour("steel-fish", -1).map(id).as_deref(), Some("pendulum"));
    std::fs::remove_dir_all(site.path().join("chains")).expect("removable");
    until(&mut offer, &["steel-fish", "pendulum"]);
}

#[test]
fn an_exhibit_that_is_set_aside_is_loaded_only_when_its_files_change() {
    const LONG: Duration = Duration::from_secs(20);
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits");
    let site = tempfile::tempdir().expect("a folder");
    for id in ["pendulum", "chains"] {
        copy_folder(&shipped.join(id), &site.path().join(id));
    }
    let mut aside = Quarantine::default();
    (0..3).for_each(|now| {
        aside.record("chains", now);
    });
    let places = ExhibitSource::All { folder: site.path().to_path_buf(), show: vec!["*".into()] };
    let marker = LoadMarker::new(Some(site.path()));
    let mut shelf = CatalogLoader::new(&places, &site.path().join("pendulum"), true, &aside, marker.clone());
    shelf.list();
    let listed = |longest| match shelf.wait(longest) {
        Some(CatalogEvent::Listed(entry)) => Some(entry.id),
        Some(_) => panic!("another event"),
        None => None,
    };
    assert_eq!((listed(LONG).as_deref(), listed(Duration::from_secs(2))), (Some("pendulum"), None));
    let sidecar = site.path().join("chains/exhibit.toml");
    let text = std::fs::read_to_string(&sidecar).expect("readable");
    std::fs::write(&sidecar, text + "\n# mended\n").expect("writable");
    assert_eq!(listed(LONG).as_deref(), Some("chains"));
    assert_eq!(marker.take(), None, "every loading has ended");
}

fn copy_folder(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).unwrap_or_else(|error| panic!("{}: {error}", from.display())) {
        let path = entry.expect("readable").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy_folder(&path, &target);
        } else {
            std::fs::copy(&path, &target).expect("a copy");
        }
    }
}
