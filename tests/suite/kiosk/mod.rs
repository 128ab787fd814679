//! The kiosk without its window: configuration, pace, visitor, attract mode, reloading, words.

use std::path::Path;

use soffio_config::{Chord, Config, FILE, LIMITS};
use soffio_offline::feed::WavFeed;

/// The file that is shipped.
fn shipped() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(FILE);
    std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// What is wrong with a configuration text, as `line:column message`.
fn problems(text: &str) -> Vec<String> {
    match Config::parse(text, Path::new("kiosk.toml")) {
        Ok(_) => Vec::new(),
        Err(error) => {
            error.problems.iter().map(|p| format!("{}:{} {} {}", p.line, p.column, p.message, p.help)).collect()
        }
    }
}

#[test]
fn the_shipped_configuration_is_the_default() {
    assert_eq!(Config::parse(&shipped(), Path::new(FILE)), Ok(Config::default()));
    assert_eq!(Config::parse("", Path::new(FILE)), Ok(Config::default()), "an empty file is the default");
}

#[test]
fn the_shipped_configuration_states_every_key_and_every_range() {
    let text = shipped();
    let stated: toml::Table = toml::from_str(&text).expect("it parses");
    assert_eq!(stated, toml::Table::try_from(Config::default()).expect("it serialises"), "every key is there");
    for limit in LIMITS {
        let key = limit.key.rsplit('.').next().expect("a key");
        let line = text.lines().find(|line| line.starts_with(&format!("{key} ="))).expect(key);
        let range = format!("{} to {}", limit.low, limit.high);
        assert!(line.contains(&range), "{key} does not say \"{range}\": {line}");
        let unit = if limit.unit == "1" { "" } else { limit.unit };
        assert!(line.contains(unit), "{key} does not say {unit}: {line}");
    }
}

#[test]
fn every_number_of_the_configuration_has_a_range_that_holds_its_default() {
    fn numbers(table: &toml::Table, prefix: &str, found: &mut Vec<(String, f64)>) {
        for (name, value) in table {
            let key = format!("{prefix}{name}");
            match value {
                toml::Value::Table(table) => numbers(table, &format!("{key}."), found),
                toml::Value::Integer(value) => found.push((key, *value as f64)),
                toml::Value::Float(value) => found.push((key, *value)),
                _ => {}
            }
        }
    }
    let mut found = Vec::new();
    numbers(&toml::Table::try_from(Config::default()).expect("it serialises"), "", &mut found);
    assert_eq!(found.len(), LIMITS.len(), "{found:?}");
    for (key, value) in found {
        let limit = LIMITS.iter().find(|limit| limit.key == key).unwrap_or_else(|| panic!("{key} has no range"));
        assert!((limit.low..=limit.high).contains(&value), "{key} = {value}");
    }
}

#[test]
fn two_microphones_are_two_channels() {
    assert_eq!(problems("[audio]\nmicrophone_channel = 1\nsecond_microphone_channel = 2"), [""; 0]);
    for (first, message) in [(0, "a second microphone beside a mix"), (2, "both microphones are channel 2")] {
        let text = format!("[audio]\nmicrophone_channel = {first}\nsecond_microphone_channel = 2");
        let found = problems(&text);
        assert!(found.len() == 1 && found[0].starts_with(&format!("3:29 {message}")), "{found:?}");
    }
}

#[test]
fn a_work_is_in_one_group_and_a_group_has_a_heading() {
    let group = |heading: &str, ids: &str| format!("[[exhibits.groups]]\nheading = {heading}\nexhibits = {ids}\n");
    let mobiles = group("{ en = \"Mobiles\" }", "[\"steel-fish\"]");
    assert_eq!(problems(&format!("{mobiles}{}", group("{ it = \"Altre\" }", "[\"*\"]"))), [""; 0]);
    for (text, message) in [
        (group("{ en = \"All\" }", "[\"*\", \"steel-fish\"]"), "\"steel-fish\" is twice"),
        (group("{}", "[]"), "has no heading"),
        (group("{ en = 3 }", "[]"), "expected a string"),
        (group("{ en = \"A\" }", "[]\nwork = []"), "unknown field `work`"),
    ] {
        let found = problems(&format!("{mobiles}{text}"));
        assert!(found.len() == 1 && found[0].contains(message) && !found[0].starts_with('0'), "{text}: {found:?}");
    }
}

#[test]
fn everything_wrong_with_a_configuration_is_said_at_once_and_located() {
    let found = problems("[breath]\ngian = 2\ndistance_m = 30.0\n\n[screens]\n");
    assert_eq!(
        found,
        [
            "2:1 unknown key `breath.gian` did you mean `gain`?",
            "3:14 `breath.distance_m` is 30 m, outside 0.1 to 2 m choose a number in between; the default is 0.5 m",
            "5:2 unknown key `screens` did you mean `screen`?",
        ]
    );
}

#[test]
fn wrong_types_words_and_grammar_are_located() {
    for (text, place) in [
        ("[audio]\nvolume_db = \"loud\"\n", "2:13"),
        ("[breath]\nprofile = \"gale\"\n", "2:11"),
        ("[staff]\nchord = \"Ctrl+S\"\n", "2:9"),
        ("breath = 3\n", "1:1"),
        ("[audio\n", "1:7"),
        ("[attract]\nidle_s = nan\n", "2:10"),
    ] {
        let found = problems(text);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert!(found[0].starts_with(&format!("{place} ")), "{text}: {found:?}");
    }
    let found = problems("[attract]\nidle_s = \"a minute\"\n");
    assert!(found[0].ends_with("write it as the default is written: idle_s = 60.0"), "{found:?}");
}

#[test]
fn a_file_stands_over_the_defaults_key_by_key() {
    let config = Config::parse("[breath]\nprofile = \"true\"\ngain = 2\n", Path::new(FILE)).expect("it is valid");
    let settings = config.simulation_settings(7);
    assert_eq!(settings.profile, soffio_simulation::Profile::Physical);
    assert_eq!((settings.breath_gain, settings.seed), (2.0, 7));
    assert_eq!(settings.distance, Config::default().breath.distance_m, "what is not said stays");
}

#[test]
fn a_missing_configuration_says_which_and_what_to_do() {
    let error = Config::load(Some(Path::new("no/such.toml"))).expect_err("there is no such file").to_string();
    assert!(error.contains("no/such.toml") && error.contains("--config"), "{error}");
}

#[test]
fn a_chord_needs_two_modifiers_and_one_key() {
    let chord: Chord = "alt + CTRL+s".parse().expect("a chord");
    assert_eq!(chord.to_string(), "Ctrl+Alt+S");
    assert!(chord.matches(true, true, false, "S"));
    assert!(!chord.matches(true, true, true, "S") && !chord.matches(true, false, false, "S"));
    for bad in ["S", "Ctrl+S", "Ctrl+Alt", "Ctrl+Alt+S+T", "Ctrl+Alt+F13", "Ctrl+Alt+é", ""] {
        assert!(bad.parse::<Chord>().is_err(), "{bad:?} is no chord");
    }
}

#[test]
fn a_recording_is_heard_whole_in_order_and_without_a_gap_at_any_rate() {
    for rate in [8_000, 11_025, 22_050, 44_100, 48_000, 192_000] {
        let samples: Vec<f32> = (0..rate).map(|i| i as f32).collect();
        let mut feed = WavFeed::new(samples.clone(), rate);
        let mut heard = Vec::new();
        for step in 0..240_u64 {
            assert!(!feed.is_over(), "{rate} Hz, step {step}");
            let part = feed.microphone().samples;
            assert_eq!(part.len() as u64, (step + 1) * u64::from(rate) / 240 - step * u64::from(rate) / 240);
            heard.extend_from_slice(part);
        }
        assert_eq!(heard, samples, "{rate} Hz");
        assert!(feed.is_over() && feed.microphone().samples.is_empty());
    }
}

#[cfg(feature = "kiosk")]
mod live {
    use std::path::Path;
    use std::sync::{Arc, LazyLock};
    use std::time::Duration;

    use soffio_config::Chord;
    use soffio_exhibit::{Attract as Script, AttractAction, AttractStep};
    use soffio_kiosk::attract::script::AttractMode;
    use soffio_kiosk::live::step_scheduler::{MOST_BEHIND, StepScheduler};
    use soffio_kiosk::venue::catalog::{Catalog, CatalogEvent, CatalogLoader, ExhibitSource, folders, id};
    use soffio_kiosk::visitor::input::{Key, Keys, Phase, Request, Signal, Visitor};
    use soffio_simulation::Command;
    use soffio_soundscape::breath::Breath;

    #[test]
    fn an_hour_of_uneven_waking_is_exactly_240_steps_a_second() {
        let mut pacer = StepScheduler::default();
        let mut random = soffio_math::noise::Random::new(11);
        let (mut now, mut steps) = (Duration::ZERO, 0);
        while now < Duration::from_secs(3600) {
            now = (now + Duration::from_nanos(random.range(1e3, 2e7) as u64)).min(Duration::from_secs(3600));
            steps += pacer.due(now);
            assert!(pacer.present() <= now && now < pacer.next(), "the present is the last step due");
        }
        assert_eq!((steps, pacer.dropped()), (3600 * 240, 0));
    }

    #[test]
    fn a_short_delay_is_made_up_and_a_long_one_is_dropped() {
        let mut pacer = StepScheduler::default();
        assert_eq!(pacer.due(Duration::from_millis(250)), MOST_BEHIND, "a quarter of a second is made up");
        assert_eq!(pacer.due(Duration::from_millis(1250)), 1, "a second is not: the motion goes on where it was");
        assert_eq!(pacer.dropped(), 239);
        assert_eq!(pacer.due(Duration::from_millis(1250)), 0);
        assert_eq!(pacer.due(Duration::from_millis(1300)), 12, "and keeps its pace");
    }

    fn chord() -> Chord {
        "Ctrl+Alt+S".parse().expect("a chord")
    }

    fn key(name: &str, pressed: bool) -> Signal {
        Signal::Key(Key { name: name.into(), pressed, ..Key::default() })
    }

    /// The keys of a site, with a staff chord and a key to blow of its own.
    fn keys<'a>(staff: &'a Chord, blow: &'a str) -> Keys<'a> {
        static OTHERS: LazyLock<[Chord; 3]> =
            LazyLock::new(|| ["M", "N", "O"].map(|key| Chord::new(true, true, false, key)));
        Keys { staff, mute: &OTHERS[0], night: &OTHERS[1], open: &OTHERS[2], blow, read: "R", menu: false }
    }

    fn send(visitor: &mut Visitor, signal: Signal) -> Option<Request> {
        visitor.signal(&signal, keys(&chord(), "Space"), false)
    }

    /// Is anything held that may blow?
    fn holds(visitor: &Visitor) -> bool {
        visitor.holds_key() || visitor.presses().next().is_some()
    }

    #[test]
    fn plus_and_minus_turn_the_volume_and_two_chords_are_the_staffs() {
        let mut visitor = Visitor::default();
        for (name, requested) in [
            ("Equal", Some(Request::Louder(1))),
            ("NumpadAdd", Some(Request::Louder(1))),
            ("AudioVolumeUp", Some(Request::Louder(1))),
            ("Minus", Some(Request::Louder(-1))),
            ("NumpadSubtract", Some(Request::Louder(-1))),
            ("M", None),
            ("N", None),
        ] {
            assert_eq!(send(&mut visitor, key(name, true)), requested, "{name}");
            assert_eq!(send(&mut visitor, key(name, false)), None, "{name}");
        }
        for (name, requested) in
            [("M", Request::Mute), ("N", Request::Night), ("O", Request::Open), ("S", Request::ToggleStaff)]
        {
            let key = Key { name: name.into(), pressed: true, ctrl: true, alt: true, ..Key::default() };
            assert_eq!(send(&mut visitor, Signal::Key(key)), Some(requested), "{name}");
        }
        assert!(!holds(&visitor));
    }

    #[test]
    fn a_pointer_aims_once_it_has_moved() {
        let mut visitor = Visitor::default();
        send(&mut visitor, Signal::Pointer([0.5, 0.5]));
        send(&mut visitor, Signal::Pointer([0.505, 0.5]));
        assert_eq!((visitor.aim(), visitor.activity()), (None, 0), "a pointer that lies there is nobody");
        send(&mut visitor, Signal::Pointer([0.6, 0.4]));
        assert_eq!((visitor.aim(), visitor.activity()), (Some([0.6, 0.4]), 1));
        send(&mut visitor, Signal::Pointer([1.4, -0.1]));
        assert_eq!(visitor.aim(), Some([1.0, 0.0]), "it aims inside the picture");
        visitor.leave();
        send(&mut visitor, Signal::Pointer([1.4, -0.1]));
        assert_eq!(visitor.aim(), None, "the next visitor starts from the centre");
    }

    #[test]
    fn button_finger_and_space_bar_blow_while_they_are_held() {
        let finger = |phase| Signal::Touch { finger: 3, at: [0.2, 0.7], phase };
        for (down, up) in [
            (Signal::Button(true), Signal::Button(false)),
            (finger(Phase::Down), finger(Phase::Up)),
            (key("Space", true), key("Space", false)),
        ] {
            let mut visitor = Visitor::default();
            send(&mut visitor, down.clone());
            assert!(holds(&visitor), "{down:?}");
            send(&mut visitor, up);
            assert!(!holds(&visitor), "{down:?}");
            send(&mut visitor, down);
            send(&mut visitor, Signal::FocusLost);
            assert!(!holds(&visitor), "a window that loses the focus hears no release");
        }
    }

    #[test]
    fn a_switch_of_the_sites_choice_blows_and_arrows_aim() {
        let mut visitor = Visitor::default();
        let chord = chord();
        let mut press = |name: &str, down: bool| {
            visitor.signal(&key(name, down), keys(&chord, "F9"), false);
            (holds(&visitor), visitor.stick())
        };
        assert_eq!(press("Space", true), (false, [0.0, 0.0]));
        assert_eq!(press("F9", true), (true, [0.0, 0.0]));
        assert_eq!(press("ArrowUp", true), (true, [0.0, -1.0]));
        assert_eq!(press("ArrowRight", true), (true, [1.0, -1.0]));
        assert_eq!(press("ArrowLeft", true), (true, [0.0, -1.0]), "left and right at once is neither");
        press("ArrowRight", false);
        assert_eq!(press("F9", false), (false, [-1.0, -1.0]));
        send(&mut visitor, Signal::FocusLost);
        assert_eq!(visitor.stick(), [0.0, 0.0], "a window that loses the focus hears no release");
    }

    #[test]
    fn the_first_finger_aims_and_a_second_changes_nothing() {
        let mut visitor = Visitor::default();
        let touch = |finger, x, phase| Signal::Touch { finger, at: [x, 0.5], phase };
        send(&mut visitor, touch(1, 0.9, Phase::Move));
        assert!(!holds(&visitor), "a finger that pressed a button and slides off it does not blow");
        send(&mut visitor, touch(1, 0.2, Phase::Down));
        send(&mut visitor, touch(2, 0.8, Phase::Down));
        send(&mut visitor, touch(2, 0.9, Phase::Up));
        assert!(holds(&visitor));
        assert_eq!(visitor.aim(), Some([0.2, 0.5]));
        send(&mut visitor, touch(1, 0.3, Phase::Move));
        send(&mut visitor, touch(1, 0.3, Phase::Up));
        assert!(!holds(&visitor));
        assert_eq!(visitor.aim(), Some([0.3, 0.5]), "the aim stays where the finger left it");
    }

    #[test]
    fn no_key_of_a_visitor_closes_the_kiosk() {
        let mut visitor = Visitor::default();
        let names = ["Escape", "F4", "Q", "W", "Tab", "Delete", "C", "F11", "Enter", "S"];
        for name in names {
            for held in 0..7 {
                let (ctrl, alt, shift) = (held & 1 > 0, held & 2 > 0, held & 4 > 0);
                let key = Key { name: name.into(), pressed: true, repeat: false, ctrl, alt, shift };
                let requested = send(&mut visitor, Signal::Key(key));
                let staff = name == "S" && ctrl && alt && !shift;
                let page = name == "Tab" && !ctrl && !alt;
                let may = if staff { Some(Request::ToggleStaff) } else { page.then_some(Request::Menu) };
                assert_eq!(requested, may, "{name} {held:03b}");
            }
        }
        assert_eq!(
            visitor.signal(&key("Escape", true), keys(&chord(), "Space"), true),
            Some(Request::Close),
            "on a desk it may"
        );
    }

    #[test]
    fn on_the_page_keys_choose_and_nothing_blows() {
        let chord = chord();
        let keys = Keys { menu: true, ..keys(&chord, "Space") };
        let mut visitor = Visitor::default();
        for (name, requested) in [
            ("ArrowLeft", Request::MoveFocus([-1, 0])),
            ("ArrowDown", Request::MoveFocus([0, 1])),
            ("Enter", Request::PressFocused),
            ("Space", Request::PressFocused),
            ("Tab", Request::Menu),
            ("PageDown", Request::Page(1)),
        ] {
            assert_eq!(visitor.signal(&key(name, true), keys, false), Some(requested), "{name}");
            assert!(!holds(&visitor) && visitor.stick() == [0.0; 2], "{name}");
        }
    }

    #[test]
    fn the_language_key_asks_once_and_all_keys_count_as_input() {
        let mut visitor = Visitor::default();
        assert_eq!(send(&mut visitor, key("L", true)), Some(Request::NextLanguage));
        let repeat = Signal::Key(Key { name: "L".into(), pressed: true, repeat: true, ..Key::default() });
        assert_eq!(send(&mut visitor, repeat), None);
        assert_eq!(send(&mut visitor, key("B", true)), None);
        assert_eq!(visitor.activity(), 3);
    }

    /// A script of one second: a text, then half a second of a breath that nobody could take for one.
    fn script() -> Script {
        let samples: Arc<[f32]> = vec![0.0; 24_000].into();
        let blow = AttractAction::Blow { samples, sample_rate: 48_000, aim: Some([0.25, 0.75]) };
        Script {
            steps: vec![
                AttractStep { at: 0.0, action: AttractAction::Show("invite".into()) },
                AttractStep { at: 0.25, action: blow },
                AttractStep { at: 0.9, action: AttractAction::Reset },
            ],
            duration: 1.0,
        }
    }

    #[test]
    fn attract_mode_begins_after_the_idle_time_and_ends_at_the_first_input() {
        let mut attract = AttractMode::new(script(), 2.0);
        for step in 1..480 {
            assert!(!attract.step(false, 0.0).active, "step {step}");
        }
        assert!(attract.step(false, 0.0).active, "two seconds are 480 steps");
        assert_eq!(attract.text(), Some("invite"));
        let cue = attract.step(true, 0.0);
        assert!(!cue.active && !attract.is_active());
        assert_eq!(
            cue.commands,
            [Command::Blow(None), Command::Settle],
            "the breath is the visitor's again, and the work"
        );
        assert_eq!(attract.text(), None);
        assert!(attract.step(true, 0.0).commands.is_empty());
        for step in 1..480 {
            assert!(!attract.step(false, 0.0).active, "the idle time starts anew, step {step}");
        }
        assert!(attract.step(false, 0.0).active);
    }

    #[test]
    fn the_attract_script_runs_in_time_and_repeats() {
        let mut attract = AttractMode::new(script(), 1.0 / 240.0);
        for round in 0..2 {
            for step in 0..240 {
                let cue = attract.step(false, 0.0);
                let place = format!("round {round}, step {step}");
                assert!(cue.active, "{place}");
                assert_eq!(cue.aim, (step >= 60).then_some([0.25, 0.75]), "{place}");
                assert_eq!(cue.commands.contains(&Command::Reset), step == 216, "{place}");
                // 24 000 samples at 48 kHz are 120 steps; the step after them ends the breath.
                let blows = cue.commands.iter().any(|command| matches!(command, Command::Blow(Some(_))));
                assert_eq!(blows, step == 0 || (60..=180).contains(&step), "{place}");
            }
        }
    }

    #[test]
    fn what_the_attract_script_has_set_swinging_is_calmed_a_second_later() {
        let mut attract = AttractMode::new(Script { duration: 4.0, ..script() }, 1.0 / 240.0);
        let calmed = (0..960).filter(|_| attract.step(false, 0.0).commands.contains(&Command::Settle)).count();
        assert_eq!(calmed, 1);
        // The breath ends at step 180 of each round.
        let calmed: Vec<u64> =
            (0..960).filter(|_| attract.step(false, 0.0).commands.contains(&Command::Settle)).collect();
        assert_eq!(calmed, [420]);
    }

    #[test]
    fn the_attract_scripts_breath_grows_softer_the_faster_the_work_moves_than_before_it() {
        const ROUNDING: f64 = 1e-9;
        // The fastest breath of a round, of a work that moves so fast (m/s) before and during it.
        let samples: Arc<[f32]> = Breath::default().recorded(48_000, 7).into();
        let blow = AttractAction::Blow { samples, sample_rate: 48_000, aim: None };
        let script = Script { steps: vec![AttractStep { at: 0.25, action: blow }], duration: 8.0 };
        let fastest = |before: f64, during: f64| {
            let mut attract = AttractMode::new(script.clone(), 1.0 / 240.0);
            let cues =
                (0..1440).flat_map(|step| attract.step(false, if step <= 60 { before } else { during }).commands);
            let speeds = cues.filter_map(|command| if let Command::Blow(speed) = command { speed } else { None });
            speeds.fold(0.0_f64, f64::max)
        };
        let [calm, swings, swung_before] = [fastest(0.0, 0.0), fastest(0.0, 0.09), fastest(0.09, 0.09)];
        assert!(calm > 0.0 && (4.0 * swings / calm - 1.0).abs() < ROUNDING, "{calm} and {swings} m/s");
        assert!((swung_before / calm - 1.0).abs() < ROUNDING, "a clock swings anyhow: {swung_before} m/s");
    }

    #[test]
    fn an_empty_script_still_waits_for_visitors() {
        let mut attract = AttractMode::new(Script::default(), 0.0);
        assert!(attract.step(false, 0.0).active && attract.step(false, 0.0).active);
        assert!(!attract.step(true, 0.0).active);
    }

    #[test]
    fn a_saved_file_loads_the_exhibit_and_a_bad_one_is_reported() {
        /// Far longer than the debounce time and a load: only a watcher that misses the change takes so long.
        const LONG: Duration = Duration::from_secs(20);
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish");
        let folder = tempfile::tempdir().expect("a folder");
        let copy = folder.path().join("steel-fish");
        copy_folder(&shipped, &copy);
        let shelf = CatalogLoader::new(&ExhibitSource::One(copy.clone()), &copy, true);
        assert!(
            matches!(shelf.wait(LONG), Some(CatalogEvent::Listed(work)) if work.id == "steel-fish" && work.thumbnail.is_some())
        );
        let sidecar = copy.join("exhibit.toml");
        let text = std::fs::read_to_string(&sidecar).expect("a sidecar");

        std::fs::write(&sidecar, &text).expect("writable");
        let Some(CatalogEvent::Show(loaded)) = shelf.wait(LONG) else {
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
        let shelf = CatalogLoader::new(&places, &site.path().join("steel-fish"), true);
        let mut offer = Catalog::new(&places);
        let mut said = Vec::new();
        let mut until = |offer: &mut Catalog, wanted: &[&str]| {
            while offer.entries().iter().map(|work| work.id.as_str()).ne(wanted.iter().copied()) {
                match shelf.wait(LONG).unwrap_or_else(|| panic!("{wanted:?} never stood there: {:?}", offer.entries()))
                {
                    CatalogEvent::Listed(work) => offer.insert(*work),
                    CatalogEvent::Removed(id) => offer.remove(&id),
                    CatalogEvent::Rejected(id, report) => {
                        offer.remove(&id);
                        said.push(report);
                    }
                    CatalogEvent::Show(_) | CatalogEvent::Failed(_) => {}
                }
            }
        };
        until(&mut offer, &["steel-fish", "pendulum"]);
        // Dropped while the kiosk runs: between the two that are named, as the star says.
        copy_folder(&shipped.join("chains"), &site.path().join("chains"));
        until(&mut offer, &["steel-fish", "chains", "pendulum"]);
        assert_eq!(offer.neighbour("pendulum", 1).map(|work| work.id.as_str()), Some("steel-fish"), "round and round");
        assert_eq!(offer.neighbour("steel-fish", -1).map(|work| work.id.as_str()), Some("pendulum"));
        std::fs::remove_dir_all(site.path().join("chains")).expect("removable");
        until(&mut offer, &["steel-fish", "pendulum"]);
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
}

#[cfg(feature = "kiosk")]
mod accessibility;
#[cfg(feature = "kiosk")]
mod aloud;
#[cfg(feature = "kiosk")]
mod bidi;
#[cfg(feature = "kiosk")]
mod camera_sway;
mod captions;
#[cfg(feature = "kiosk")]
mod contrast;
#[cfg(feature = "kiosk")]
mod dwell;
#[cfg(feature = "kiosk")]
mod edit;
#[cfg(feature = "kiosk")]
mod flashes;
#[cfg(feature = "kiosk")]
mod fleet;
#[cfg(feature = "kiosk")]
mod frame_pacing;
#[cfg(feature = "kiosk")]
mod glass;
#[cfg(feature = "kiosk")]
mod hearing_loop;
#[cfg(feature = "kiosk")]
mod idle_rendering;
#[cfg(feature = "kiosk")]
mod instruments;
mod modules;
mod opening;
#[cfg(feature = "kiosk")]
mod orbit;
#[cfg(feature = "kiosk")]
mod pages;
mod pin;
#[cfg(feature = "kiosk")]
mod quality_tiers;
#[cfg(feature = "kiosk")]
mod record;
#[cfg(feature = "kiosk")]
mod screens;
#[cfg(feature = "kiosk")]
mod self_test;
#[cfg(feature = "kiosk")]
mod site;
#[cfg(feature = "kiosk")]
mod staff;
#[cfg(feature = "kiosk")]
mod stage;
#[cfg(feature = "kiosk")]
mod ui_strings;
#[cfg(feature = "kiosk")]
mod venue_state;

mod doctor {
    use soffio::commands::doctor::{Health, judge_blow, judge_room};
    use soffio_detector::{BlowDetector, BlowEstimate, BlowSettings};
    use soffio_soundscape::breath::Breath;

    const RATE: u32 = 48_000;

    /// A second of white noise, full scale 1, through a gain over time (0…1 s).
    fn noise(gain: impl Fn(f64) -> f64) -> Vec<f32> {
        let mut random = soffio_math::noise::Random::new(5);
        (0..RATE).map(|i| (random.signed() * gain(f64::from(i) / f64::from(RATE))).clamp(-1.0, 1.0) as f32).collect()
    }

    #[test]
    fn a_quiet_room_is_well_and_every_fault_has_its_remedy() {
        for (what, samples, health, word) in [
            ("quiet", noise(|_| 0.002), Health::Ok, ""),
            ("muted", vec![0.0; RATE as usize], Health::Bad, "muted"),
            ("clipping", noise(|_| 3.0), Health::Warn, "clips"),
            ("loud", noise(|_| 0.3), Health::Warn, "loud"),
            ("gain control", noise(|t| 0.0005 * (1.0 + 9.0 * t)), Health::Warn, "gain control"),
            ("stuttering", noise(|_| 0.002)[..10_000].to_vec(), Health::Bad, "too few samples"),
            ("nothing", Vec::new(), Health::Bad, "too few samples"),
        ] {
            let finding = judge_room(&samples, RATE);
            assert_eq!(finding.health, health, "{what}: {finding:?}");
            assert!(finding.remedy.contains(word), "{what}: {finding:?}");
        }
    }

    /// What the detector says every 20 ms of a normal breath whose samples were so many dB louder.
    fn blown(gain_db: f64, sensitivity_db: f64) -> Vec<BlowEstimate> {
        let gain = soffio_math::db_to_amplitude(gain_db) as f32;
        let breath = Breath::default().recorded(RATE, 7);
        let settings = BlowSettings { sensitivity_db, ..BlowSettings::default() };
        let mut detector = BlowDetector::with_settings(RATE, settings);
        let hear = |block: &[f32]| {
            let samples: Vec<f32> = block.iter().map(|x| (gain * x).clamp(-1.0, 1.0)).collect();
            detector.push(&samples, &[]);
            detector.estimate()
        };
        breath.chunks(RATE as usize / 50).map(hear).collect()
    }

    #[test]
    fn the_doctor_proposes_a_sensitivity_that_makes_a_normal_breath_normal() {
        for gain_db in [-24.0, -12.0] {
            let finding = judge_blow(&blown(gain_db, 0.0), 0.0);
            assert_eq!(finding.health, Health::Warn, "{finding:?}");
            let proposed = finding.remedy.split("sensitivity_db = ").nth(1).and_then(|rest| rest.split(' ').next());
            let proposed: f64 = proposed.and_then(|number| number.parse().ok()).expect("a number in the remedy");
            let again = judge_blow(&blown(gain_db, proposed), proposed);
            assert_eq!(again.health, Health::Ok, "{gain_db} dB, {proposed} dB proposed: {again:?}");
        }
        assert_eq!(judge_blow(&[], 0.0).health, Health::Bad);
        let railed = judge_blow(&blown(40.0, 0.0), 0.0);
        assert!(railed.health != Health::Ok && railed.remedy.contains("gain down"), "{railed:?}");
        let mut turned = blown(-12.0, 0.0);
        turned.iter_mut().for_each(|step| step.gain_control = true);
        let turned = judge_blow(&turned, 0.0);
        assert!(turned.health == Health::Warn && turned.remedy.contains("switch off automatic gain"), "{turned:?}");
    }
}
