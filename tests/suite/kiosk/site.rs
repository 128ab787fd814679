//! The configuration that changes while the kiosk runs.

use std::time::Duration;

use soffio_config::Config;
use soffio_exhibit as exhibit;
use soffio_kiosk::staff::edit::{Changes, with_key};
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::venue::catalog::{Catalog, CatalogEntry, ExhibitSource};
use soffio_kiosk::venue::site::{ConfigEvent, ConfigWatcher, Overrides, Site, waits_for_restart};
use soffio_simulation::{Profile, Settings};

/// Far longer than the debounce time: only a watcher that misses the change takes so long.
const LONG: Duration = Duration::from_secs(20);

#[test]
fn a_good_file_is_taken_over_and_a_broken_one_refused_with_its_diagnostics() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("kiosk.toml");
    std::fs::write(&file, "").expect("writable");
    let site = ConfigWatcher::watch(&file, None);
    std::fs::write(&file, "[visit]\nbreath = false\n[opening]\nhours = [\"Tue-Sun 10:00-18:00\"]\n").expect("writable");
    let Some(ConfigEvent::Loaded(loaded)) = site.wait(LONG) else { panic!("a good change is noticed") };
    assert!(!loaded.config.visit.breath && loaded.config.opening.hours.len() == 1);

    std::fs::write(&file, "[visit]\nbreth = false\n[audio]\nvolume_db = 20\n").expect("writable");
    let Some(ConfigEvent::Rejected(report)) = site.wait(LONG) else { panic!("a broken change is noticed") };
    for word in ["kiosk.toml:2:1", "did you mean `breath`?", "kiosk.toml:4:13", "-60 to 0 dB"] {
        assert!(report.contains(word), "{word} is not in {report}");
    }

    // As editors do it: another file comes in the old one's place. A neighbour changes nothing.
    std::fs::write(folder.path().join("notes.txt"), "breathe").expect("writable");
    let new = folder.path().join("kiosk.toml~");
    std::fs::write(&new, "[breath]\ngain = 2.0\n").expect("writable");
    std::fs::rename(&new, &file).expect("movable");
    let Some(ConfigEvent::Loaded(loaded)) = site.wait(LONG) else { panic!("a new file is noticed") };
    assert_eq!(loaded.config.breath.gain, 2.0);
    assert!(loaded.config.visit.breath, "what is not said any more is the default again");
}

#[test]
fn settings_of_staff_are_taken_over_from_their_own_file_and_the_configuration_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, state) = (folder.path().join("kiosk.toml"), folder.path().join("state"));
    std::fs::create_dir(&state).expect("writable");
    std::fs::write(&file, "[breath]\ngain = 2.0\n").expect("writable");
    let site = ConfigWatcher::watch(&file, Some(&state));
    assert_eq!(site.saved_in(), state.join("overrides.toml"));
    let mut changes = Changes::default();
    let sensitivity = |text: &str| with_key(text, "breath", "sensitivity_db", -3.0);
    changes.make_or_create(site.saved_in(), sensitivity).expect("writable");
    let Some(ConfigEvent::Loaded(loaded)) = site.wait(LONG) else { panic!("a setting of staff is noticed") };
    assert_eq!((loaded.config.breath.gain, loaded.config.breath.sensitivity_db), (2.0, -3.0));
    assert!(loaded.staff.is_some_and(|staff| staff.summary().contains("breath.sensitivity_db")));
    assert_eq!(std::fs::read_to_string(&file).expect("there"), "[breath]\ngain = 2.0\n");
    changes.undo().expect("nobody else has changed it");
    let Some(ConfigEvent::Loaded(loaded)) = site.wait(LONG) else { panic!("undone") };
    assert_eq!((loaded.config.breath.sensitivity_db, loaded.staff), (0.0, None));
}

#[test]
fn what_cannot_change_while_running_is_named_and_nothing_else() {
    let old = Config::default();
    let mut new = old.clone();
    new.breath.gain = 2.0;
    new.audio.microphone = "other".into();
    new.visit.breath = false;
    new.screen.mm_per_px = 0.5;
    assert_eq!(waits_for_restart(&old, &new), [""; 0]);
    new.screen.fullscreen = false;
    new.exhibits.folder = "elsewhere".into();
    assert_eq!(waits_for_restart(&old, &new), ["screen.fullscreen", "exhibits.folder"]);
    let desk = Overrides { windowed: true, no_attract: true, safe: false }.apply(old);
    assert!(!desk.screen.fullscreen && !desk.attract.enabled);
    assert_eq!(Site::new(&desk, 1).idle_s, None, "what the command line says stays over a changed file");
}

#[test]
fn changed_breath_settings_restart_the_work_and_others_leave_it_alone() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/pendulum");
    let pendulum = std::sync::Arc::new(exhibit::load(&folder).expect("the shipped exhibit is valid"));
    let mut stage = Stage::new(pendulum, Settings::default(), None, None);
    let controls = Default::default();
    (0..100).for_each(|_| stage.step(&controls, None));
    stage.reconfigure(Settings::default(), Some(30.0));
    assert_eq!((stage.steps(), stage.snapshot().step), (100, 100));
    stage.reconfigure(Settings { profile: Profile::Physical, ..Settings::default() }, Some(30.0));
    assert_eq!((stage.steps(), stage.snapshot().step), (100, 0));
}

#[test]
fn works_are_offered_in_the_new_order_at_once() {
    let work =
        |id: &str| CatalogEntry { id: id.into(), folder: id.into(), labels: Default::default(), thumbnail: None };
    let show = |ids: &[&str]| ids.iter().map(|id| (*id).to_owned()).collect::<Vec<_>>();
    let mut offer = Catalog::new(&ExhibitSource::All { folder: "x".into(), show: show(&["a", "*"]) });
    ["c", "a", "b"].into_iter().for_each(|id| offer.insert(work(id)));
    let ids = |offer: &Catalog| offer.entries().iter().map(|work| work.id.clone()).collect::<Vec<_>>();
    assert_eq!(ids(&offer), ["a", "b", "c"]);
    offer.reorder(&show(&["c", "a"]));
    assert_eq!(ids(&offer), ["c", "a"]);
    offer.insert(work("b"));
    assert_eq!(ids(&offer), ["c", "a"], "what is not listed is not offered");
}
