//! The staff panel: its gate, and every page drawn without a window.

use std::path::Path;
use std::sync::Arc;

use soffio_config::{Config, Pin};
use soffio_exhibit as exhibit;
use soffio_kiosk::egui::{self, Event, FontId, Key, Modifiers, PointerButton, Pos2, Rect, Shape, pos2};
use soffio_kiosk::fleet::persisted::PersistedState;
use soffio_kiosk::live::LiveState;
use soffio_kiosk::pages::fonts;
use soffio_kiosk::pages::languages::{languages_without_glyphs, staff_texts};
use soffio_kiosk::staff::gate::{Gate, LONGEST_S};
use soffio_kiosk::staff::log::{CAPACITY, LONGEST, Log, LogLine};
use soffio_kiosk::staff::{Page, PanelInput, StaffAction, StaffPanel, WindowStats};
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::venue::state::VenueState;
use soffio_kiosk::visitor::input::{Phase, Request, Signal};
use soffio_simulation::{InspectionScope, Settings};

use super::pages::texts;

const GLASS: [f32; 2] = [1280.0, 720.0];
/// Points a millimetre of a 32-inch glass with that picture.
const POINTS_PER_MM: f32 = 1.8;

fn pin(digits: &str) -> Pin {
    Pin::new(digits, b"salt of sixteen.").expect("digits")
}

/// Waits for the hash.
fn answered(gate: &mut Gate, time: f64) {
    while gate.checks() {
        gate.poll(time);
        std::thread::yield_now();
    }
}

fn enter(gate: &mut Gate, digits: &str, time: f64) {
    digits.chars().for_each(|digit| gate.digit(digit));
    gate.enter(time);
    answered(gate, time);
}

#[test]
fn the_right_pin_opens_a_wrong_one_waits_ever_longer_and_closing_changes_nothing_of_that() {
    let mut gate = Gate::default();
    gate.set(&pin("271828"));
    let mut time = 0.0;
    for wrong in 1..=12 {
        enter(&mut gate, "1234", time);
        let pause = f64::from(1 << wrong).min(LONGEST_S);
        assert!(!gate.is_open() && gate.wrong() == wrong, "try {wrong}");
        assert_eq!(gate.pause(time), Some(pause), "try {wrong}");
        // Closing and opening the panel, or reading the same configuration again, shortens nothing.
        gate.shut();
        gate.set(&pin("271828"));
        enter(&mut gate, "271828", time + pause - 0.001);
        assert!(!gate.is_open() && gate.wrong() == wrong, "nothing is tried during the pause");
        gate.shut();
        time += pause;
        assert_eq!(gate.pause(time), None);
    }
    enter(&mut gate, "271828", time);
    assert!(gate.is_open() && gate.wrong() == 0);
    gate.shut();
    assert!(!gate.is_open(), "the next one is asked again");
    enter(&mut gate, "1234", time);
    assert_eq!(gate.pause(time), Some(2.0), "a right PIN restarted the count");
    let other = {
        enter(&mut gate, "271828", time + 2.0);
        assert!(gate.is_open());
        pin("314159")
    };
    gate.set(&other);
    assert!(!gate.is_open(), "another PIN in the configuration shuts it");
}

#[test]
fn nothing_opens_a_gate_without_a_pin_and_digits_are_digits() {
    let mut gate = Gate::default();
    enter(&mut gate, "", 0.0);
    enter(&mut gate, "0000", 0.0);
    assert!(!gate.is_open() && !gate.has_pin() && gate.wrong() == 0);
    gate.shut();
    "12x4567890123456".chars().for_each(|c| gate.digit(c));
    assert_eq!(gate.entered(), 12);
    gate.back();
    assert_eq!(gate.entered(), 11);
}

/// A member of the staff before the glass.
pub struct Before {
    pub context: egui::Context,
    stage: Stage,
    pub staff: StaffPanel,
    site: Config,
    house: VenueState,
    persisted: PersistedState,
    log: Log,
    file: Option<std::path::PathBuf>,
    folder: Option<std::path::PathBuf>,
    time: f64,
    activity: u64,
    on_desk: bool,
    exhibit_problem: Option<String>,
    /// What is written, where, and in which font.
    words: Vec<(String, Rect, FontId)>,
}

impl Before {
    pub fn new(id: &str) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
        let exhibit = Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}")));
        let context = egui::Context::default();
        context.set_fonts(fonts::definitions());
        context.set_theme(egui::Theme::Light);
        let mut stage = Stage::new(exhibit, Settings::default(), None, None);
        let controls = Controls { aspect: 16.0 / 9.0, hold: true, ..Controls::default() };
        (0..60).for_each(|_| stage.step(&controls, None));
        let mut site = Config::default();
        site.exhibits.folder = folder.parent().expect("a parent").into();
        let mut staff = StaffPanel::default();
        staff.toggle();
        Self {
            context,
            stage,
            staff,
            site,
            house: VenueState::default(),
            persisted: PersistedState::default(),
            log: Log::default(),
            file: None,
            folder: None,
            time: 1.0,
            activity: 0,
            on_desk: true,
            exhibit_problem: None,
            words: Vec::new(),
        }
    }

    /// One picture with these events; what is asked for.
    fn look(&mut self, events: Vec<Event>) -> Vec<StaffAction> {
        let (wishes, mut laid_out) = self.lay_out(events);
        laid_out.textures_delta.clear();
        self.words.clear();
        laid_out.shapes.iter().for_each(|clipped| collect(&clipped.shape, &mut self.words));
        wishes
    }

    /// The same, and what is to be drawn.
    pub fn lay_out(&mut self, events: Vec<Event>) -> (Vec<StaffAction>, egui::FullOutput) {
        let look = self.staff.inspection(&self.site);
        let mut exhibit = self.stage.exhibit().clone();
        if let Some(folder) = &self.folder {
            Arc::make_mut(&mut exhibit).folder.clone_from(folder);
        }
        let inspection = (look != InspectionScope::Nothing).then(|| Arc::new(self.stage.inspect(look)));
        let frame = LiveState { exhibit: exhibit.clone(), hears: true, inspection, ..LiveState::new(&self.stage) };
        let vitals =
            WindowStats { adapter: "none", frame_s: 0.02, size: [1280, 720], time: self.time, onset_latency_s: 0.0 };
        let sight = PanelInput {
            frame: &frame,
            view: exhibit.view(16.0 / 9.0),
            vitals,
            site: &self.site,
            config_problems: &[],
            exhibit_problem: self.exhibit_problem.as_deref(),
            file: self.file.as_deref(),
            exhibit_ids: &["steel-fish", "wind-chimes"],
            venue: &self.house,
            persisted: &self.persisted,
            log: &self.log,
            activity: self.activity,
            texts: staff_texts(texts(), &self.site, &[]),
            on_desk: self.on_desk,
            points_per_mm: POINTS_PER_MM,
        };
        let screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), GLASS.into()));
        let input = egui::RawInput { screen_rect, events, time: Some(self.time), ..egui::RawInput::default() };
        let mut wishes = Vec::new();
        let (context, staff) = (self.context.clone(), &mut self.staff);
        let laid_out = context.run_ui(input, |ui| wishes.extend(staff.show(ui, &sight)));
        self.time += 0.02;
        (wishes, laid_out)
    }

    /// Where these words stand.
    fn find(&self, words: &str) -> Pos2 {
        let found = self.words.iter().find(|(text, ..)| text == words);
        found.unwrap_or_else(|| panic!("\"{words}\" is not among {:?}", self.said())).1.center()
    }

    fn said(&self) -> Vec<&str> {
        self.words.iter().map(|(text, ..)| text.as_str()).collect()
    }

    fn says(&self, part: &str) -> bool {
        self.words.iter().any(|(text, ..)| text.contains(part))
    }

    /// Presses words with the pointer; what that asks for.
    fn press(&mut self, words: &str) -> Vec<StaffAction> {
        self.look(Vec::new());
        let at = self.find(words);
        self.activity += 1;
        let button = |pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let mut wishes = self.look(vec![Event::PointerMoved(at)]);
        wishes.extend(self.look(vec![button(true)]));
        wishes.extend(self.look(vec![button(false)]));
        wishes.extend(self.look(Vec::new()));
        wishes
    }
}

/// All texts of a shape with their places.
fn collect(shape: &Shape, out: &mut Vec<(String, Rect, FontId)>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, out)),
        Shape::Text(text) => {
            let font = text.galley.job.sections.first().map(|section| section.format.font_id.clone());
            out.push((text.galley.text().to_owned(), text.visual_bounding_rect(), font.unwrap_or_default()));
        }
        _ => {}
    }
}

#[test]
fn every_page_is_drawn_for_every_kind_of_work_and_says_what_it_is_for() {
    let expected = [
        (Page::Status, "joint error"),
        (Page::Exhibits, "Save the order"),
        (Page::Bodies, "largest joint error"),
        (Page::Wind, "fastest, m/s"),
        (Page::Sound, "chime-brass"),
        (Page::Parameters, "Drag a number"),
        (Page::Microphone, "noise floor"),
        (Page::Test, "Loudspeakers"),
        (Page::Log, "no lines"),
    ];
    assert_eq!(expected.map(|(page, _)| page), Page::ALL);
    for id in ["steel-fish", "terry-clock", "wind-chimes", "marionette", "chain-heavy"] {
        let mut staff = Before::new(id);
        for (page, words) in expected {
            staff.staff.turn_to(page);
            (0..3).for_each(|_| drop(staff.look(Vec::new())));
            assert!(staff.says(words), "{id}, {page:?}: {:?}", staff.said());
            for (text, _, font) in &staff.words {
                let can = staff.context.fonts_mut(|fonts| fonts.has_glyphs(font, text));
                assert!(can, "{id}, {page:?}: {font:?} has not all of \"{text}\"");
            }
        }
    }
}

#[test]
fn the_panel_speaks_the_language_of_the_staff_and_writes_all_of_it() {
    let cannot = languages_without_glyphs(texts());
    for (code, tab) in
        [("de", "Exponate"), ("fr", "Œuvres"), ("it", "Opere"), ("es", "Obras"), ("ko", "작품"), ("ja", "作品")]
    {
        let mut staff = Before::new("steel-fish");
        staff.site.languages.first = "en".into();
        staff.site.staff.language = code.into();
        let usual = staff_texts(texts(), &staff.site, &cannot).code();
        assert_eq!(usual, if cannot.iter().any(|cannot| cannot == code) { "en" } else { code });
        if usual == "en" {
            continue;
        }
        for page in Page::ALL {
            staff.staff.turn_to(page);
            (0..3).for_each(|_| drop(staff.look(Vec::new())));
            assert!(staff.says(tab), "{code}, {page:?}: {:?}", staff.said());
            for (text, _, font) in &staff.words {
                let can = staff.context.fonts_mut(|fonts| fonts.has_glyphs(font, text));
                assert!(can, "{code}, {page:?}: {font:?} has not all of \"{text}\"");
            }
        }
        staff.site.staff.language.clear();
        staff.look(Vec::new());
        assert!(staff.says("Exhibits"), "without a language of its own it has that of the visitors");
    }
    assert_eq!(staff_texts(texts(), &Config::default(), &cannot).code(), "en", "where nothing is configured");
}

#[test]
fn the_bodies_page_shows_each_joint_with_its_error_and_nothing_is_looked_at_elsewhere() {
    let mut staff = Before::new("steel-fish");
    assert_eq!(staff.staff.inspection(&staff.site), InspectionScope::Nothing);
    staff.staff.turn_to(Page::Bodies);
    assert_eq!(staff.staff.inspection(&staff.site), InspectionScope::Bodies);
    staff.look(Vec::new());
    staff.look(Vec::new());
    let exhibit = staff.stage.exhibit().clone();
    for name in exhibit.constraints.iter().map(|c| &c.name).chain(exhibit.bodies.iter().map(|b| &b.name)) {
        assert!(staff.said().contains(&name.as_str()), "{name}: {:?}", staff.said());
    }
    let seen = staff.stage.inspect(InspectionScope::Bodies);
    let worst = seen.joints.iter().filter(|j| !j.angle).fold(0.0, |worst: f64, j| worst.max(j.error));
    assert_eq!(worst, staff.stage.snapshot().diagnostics.joint_error, "the worst joint is the largest error");
    // The cup carries all that hangs on it, but for what its motion takes: within a tenth of the weight.
    let weight: f64 = exhibit.bodies.iter().map(|body| 9.81 * body.properties.mass).sum();
    let cup = exhibit.constraints.iter().position(|c| c.name == "cup-on-point").expect("a cup");
    let load = seen.joints[cup].load.expect("a joint of lengths");
    assert!((load - weight).abs() < 0.1 * weight, "{load} N of {weight} N");
    staff.staff.toggle();
    assert_eq!(staff.staff.inspection(&staff.site), InspectionScope::Nothing, "nobody looks at a closed panel");
}

#[test]
fn wind_samples_say_where_the_cone_hits_and_looking_changes_nothing_of_the_run() {
    let mut staff = Before::new("steel-fish");
    let mut other = Before::new("steel-fish");
    // Where the fish hangs.
    let at = staff.stage.exhibit().view(16.0 / 9.0);
    let fish = staff.stage.snapshot().poses[0].position;
    let aim = at.project(fish, 16.0 / 9.0);
    let controls = Controls { aspect: 16.0 / 9.0, hold: true, aim, ..Controls::default() };
    for step in 0..120 {
        staff.stage.step(&controls, None);
        other.stage.step(&controls, None);
        let seen = staff.stage.inspect(if step % 2 == 0 { InspectionScope::Wind } else { InspectionScope::Bodies });
        assert_eq!(seen.wind.is_empty(), step % 2 == 1);
    }
    assert_eq!(staff.stage.state_hash(), other.stage.state_hash());
    let seen = staff.stage.inspect(InspectionScope::Wind);
    let hit: Vec<_> = seen.wind.iter().filter(|sample| sample.in_breath).collect();
    assert!(!hit.is_empty() && hit.len() < seen.wind.len(), "{} of {} patches", hit.len(), seen.wind.len());
    let fastest = hit.iter().fold(0.0, |most: f64, sample| most.max(sample.speed));
    // A held breath of 9 m/s, half a metre away: the jet's centre has decayed to a fraction of that.
    assert!(fastest > 0.3 && fastest < 9.0, "{fastest} m/s");
}

#[test]
fn with_a_pin_the_panel_asks_for_it_and_opens_by_keyboard_and_by_finger() {
    for by_finger in [false, true] {
        let mut staff = Before::new("pendulum");
        staff.on_desk = false;
        staff.site.staff.pin = pin("271828");
        staff.look(Vec::new());
        assert!(!staff.says("joint error") && staff.says("PIN"), "{:?}", staff.said());
        assert_eq!(staff.staff.inspection(&staff.site), InspectionScope::Nothing);
        if by_finger {
            for digit in ["2", "7", "1", "8", "2", "8", "OK"] {
                staff.press(digit);
            }
        } else {
            let digits = "271828".chars().map(|digit| Event::Text(digit.into())).collect();
            staff.look(digits);
            let key = Key::Enter;
            let modifiers = Modifiers::NONE;
            staff.look(vec![Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }]);
        }
        let time = staff.time;
        answered(staff.staff.gate(), time);
        staff.look(Vec::new());
        staff.look(Vec::new());
        assert!(staff.says("joint error"), "by finger: {by_finger}: {:?}", staff.said());
        assert_eq!(staff.press("Clean the glass"), [StaffAction::Clean]);
        staff.staff.toggle();
        staff.staff.toggle();
        staff.look(Vec::new());
        assert!(!staff.says("joint error"), "it is asked again");
    }
}

#[test]
fn digits_are_as_large_as_a_thumb() {
    let mut staff = Before::new("pendulum");
    staff.site.staff.pin = pin("271828");
    staff.look(Vec::new());
    staff.look(Vec::new());
    let centres = ["1", "2", "4"].map(|digit| staff.find(digit));
    let across = (centres[1].x - centres[0].x) / POINTS_PER_MM;
    let down = (centres[2].y - centres[0].y) / POINTS_PER_MM;
    // 18 mm and a gap; never less than a visitor's button.
    assert!(across > 18.0 && down > 18.0, "{across} mm by {down} mm");
}

#[test]
fn without_a_pin_the_gallery_panel_shows_and_changes_nothing() {
    let mut staff = Before::new("steel-fish");
    staff.on_desk = false;
    assert_eq!(staff.press("End the kiosk"), []);
    assert_eq!(staff.press("Mute"), []);
    assert!(staff.says("No PIN is set"), "{:?}", staff.said());
    staff.on_desk = true;
    assert_eq!(staff.press("End the kiosk"), [StaffAction::Close]);
    staff.staff.turn_to(Page::Test);
    staff.on_desk = false;
    assert_eq!(staff.press("Left"), []);
}

#[test]
fn nobody_at_the_panel_for_its_time_closes_it() {
    let mut staff = Before::new("pendulum");
    staff.look(Vec::new());
    staff.time += staff.site.staff.closes_s - 1.0;
    staff.look(Vec::new());
    assert!(staff.staff.is_open());
    staff.activity += 1;
    staff.look(Vec::new());
    staff.time += staff.site.staff.closes_s - 1.0;
    staff.look(Vec::new());
    assert!(staff.staff.is_open(), "a touch restarts the time");
    staff.time += 2.0;
    staff.look(Vec::new());
    assert!(!staff.staff.is_open());
}

#[test]
fn the_order_is_changed_by_buttons_and_saved_with_its_comments() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("kiosk.toml");
    let text = "[exhibits]\nshow = [\"steel-fish\", \"wind-chimes\"] # two will do\n";
    std::fs::write(&file, text).expect("writable");
    let mut staff = Before::new("steel-fish");
    staff.site.exhibits.show = vec!["steel-fish".into(), "wind-chimes".into()];
    staff.file = Some(file.clone());
    staff.staff.turn_to(Page::Exhibits);
    assert_eq!(staff.press("wind-chimes"), [StaffAction::Show("wind-chimes".into())]);
    staff.press("+ pendulum");
    staff.press("\u{2193}");
    staff.press("Save the order");
    assert!(staff.says("Saved in"), "{:?}", staff.said());
    let saved = std::fs::read_to_string(&file).expect("readable");
    assert_eq!(saved, "[exhibits]\nshow = [\"wind-chimes\", \"steel-fish\", \"pendulum\"] # two will do\n");
}

#[test]
fn a_number_that_is_dragged_is_saved_when_it_is_let_go_and_taken_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("exhibit.toml");
    let text = "# a work\n[wind.ambient]\nspeed = \"0.3 m/s\" # a draught\n";
    std::fs::write(&file, text).expect("writable");
    let mut staff = Before::new("steel-fish");
    staff.folder = Some(folder.path().into());
    staff.staff.turn_to(Page::Parameters);
    staff.press("wind.ambient");
    // The group opens slowly.
    (0..60).for_each(|_| drop(staff.look(Vec::new())));
    let at = staff.find("0.3");
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    staff.look(vec![Event::PointerMoved(at)]);
    staff.look(vec![button(at, true)]);
    for step in 1..=10 {
        staff.look(vec![Event::PointerMoved(at + egui::vec2(10.0 * step as f32, 0.0))]);
        assert_eq!(std::fs::read_to_string(&file).expect("readable"), text, "nothing is written while it is dragged");
    }
    staff.look(vec![button(at + egui::vec2(100.0, 0.0), false)]);
    let saved = std::fs::read_to_string(&file).expect("readable");
    assert!(
        saved.starts_with("# a work\n[wind.ambient]\nspeed = \"0.") && saved.ends_with(" m/s\" # a draught\n"),
        "{saved}"
    );
    assert_ne!(saved, text);
    staff.exhibit_problem = Some("exhibit.toml:3:9: no such speed".into());
    staff.look(Vec::new());
    assert!(staff.says("no such speed") && staff.says("the last good version is on show"), "{:?}", staff.said());
    staff.press("Undo (1)");
    assert_eq!(std::fs::read_to_string(&file).expect("readable"), text);
}

#[test]
fn sounds_are_tried_and_a_finger_is_shown_where_it_is() {
    let mut staff = Before::new("steel-fish");
    staff.staff.turn_to(Page::Sound);
    let wishes = staff.press("bell");
    assert!(matches!(wishes.as_slice(), [StaffAction::PlaySound(audition)] if audition.pan == 0.0), "{wishes:?}");
    staff.staff.turn_to(Page::Test);
    let wishes = staff.press("Right");
    assert!(matches!(wishes.as_slice(), [StaffAction::PlaySound(audition)] if audition.pan == 1.0), "{wishes:?}");
    for (finger, x) in [(3, 0.1), (4, 0.3)] {
        staff.staff.handle_signal(&Signal::Touch { finger, at: [x, 0.5], phase: Phase::Down });
        staff.staff.handle_signal(&Signal::Touch { finger, at: [x + 0.05, 0.5], phase: Phase::Move });
    }
    staff.look(Vec::new());
    assert!(staff.says("1: 0.150, 0.500") && staff.says("2: 0.350, 0.500"), "{:?}", staff.said());
    assert!(
        staff.staff.handle_signal(&Signal::Touch { finger: 3, at: [0.15, 0.5], phase: Phase::Up }),
        "no press on the work"
    );
    staff.look(Vec::new());
    assert!(!staff.says("1: 0.150, 0.500") && staff.says("2: 0.350, 0.500"), "{:?}", staff.said());
    // Pictures of the display lie over everything, and each press turns to the next: grey, edges, five colours.
    staff.press("Show test pictures");
    for picture in 0..7 {
        staff.look(Vec::new());
        assert!(!staff.says("Loudspeakers"), "picture {picture}: {:?}", staff.said());
        staff.staff.handle_signal(&Signal::Button(true));
        staff.staff.handle_signal(&Signal::Button(false));
    }
    staff.look(Vec::new());
    assert!(staff.says("Loudspeakers"), "{:?}", staff.said());
}

#[test]
fn the_log_keeps_its_last_lines_and_no_more() {
    let log = Log::default();
    let line = |text: String| LogLine { time: jiff::civil::time(12, 0, 0, 0), level: tracing::Level::INFO, text };
    (0..CAPACITY + 10).for_each(|i| log.push(line(format!("line {i}"))));
    assert_eq!(log.lines().len(), CAPACITY);
    assert_eq!(log.lines().front().map(|line| line.text.as_str()), Some("line 10"));
    log.push(line("é".repeat(3 * LONGEST)));
    assert_eq!(log.lines().back().map(|line| line.text.chars().count()), Some(LONGEST));
    let mut staff = Before::new("pendulum");
    log.push(LogLine { level: tracing::Level::WARN, ..line("the microphone is lost".into()) });
    staff.log = log;
    staff.staff.turn_to(Page::Log);
    (0..3).for_each(|_| drop(staff.look(Vec::new())));
    assert!(staff.says("the microphone is lost"), "{:?}", staff.said());
    staff.press("only warnings and errors");
    assert!(staff.says("the microphone is lost") && !staff.says("line 11"), "{:?}", staff.said());
}

#[test]
fn a_press_on_the_panel_is_the_panels_and_one_beside_it_the_works() {
    let mut staff = Before::new("steel-fish");
    staff.look(Vec::new());
    let press = |staff: &mut StaffPanel, x| {
        staff.handle_signal(&Signal::Pointer([x, 0.5]));
        staff.handle_signal(&Signal::Button(true))
    };
    // The panel is 500 of 1280 points wide.
    for (x, taken) in [(0.1, false), (0.6, false), (0.62, true), (0.99, true)] {
        assert_eq!(press(&mut staff.staff, x), taken, "{x}");
        assert_eq!(
            staff.staff.handle_signal(&Signal::Touch { finger: 1, at: [x, 0.5], phase: Phase::Down }),
            taken,
            "{x}"
        );
    }
    staff.staff.toggle();
    assert!(!press(&mut staff.staff, 0.9), "a closed panel takes nothing");
}

#[test]
fn with_a_pin_a_chord_of_staff_waits_for_it_and_only_mute_can_be_freed() {
    let mut staff = Before::new("pendulum");
    staff.on_desk = false;
    let chords =
        [(Request::Mute, StaffAction::Mute), (Request::Night, StaffAction::Night), (Request::Open, StaffAction::Open)];
    for (request, _) in &chords {
        assert_eq!(staff.staff.admit(*request, &staff.site.staff), Some(*request), "no PIN is set");
    }
    staff.site.staff.pin = pin("271828");
    for (request, action) in chords {
        assert_eq!(staff.staff.admit(request, &staff.site.staff), None, "{request:?}");
        assert!(staff.staff.is_open(), "it asks for the PIN");
        assert_eq!(staff.look(Vec::new()), [], "{request:?} before the PIN");
        let time = staff.time;
        enter(staff.staff.gate(), "271828", time);
        assert_eq!(staff.look(Vec::new()), [action], "{request:?} after it");
        assert_eq!(staff.look(Vec::new()), [], "once");
        assert_eq!(staff.staff.admit(request, &staff.site.staff), Some(request), "the gate is open");
        staff.staff.toggle();
    }
    // Somebody who leaves the panel leaves the chord too.
    assert_eq!(staff.staff.admit(Request::Open, &staff.site.staff), None);
    staff.staff.toggle();
    staff.staff.toggle();
    let time = staff.time;
    enter(staff.staff.gate(), "271828", time);
    assert_eq!(staff.look(Vec::new()), []);
    staff.staff.toggle();

    staff.site.staff.mute_without_pin = true;
    for (request, passes) in [(Request::Mute, true), (Request::Night, false), (Request::Open, false)] {
        assert_eq!(staff.staff.admit(request, &staff.site.staff).is_some(), passes, "{request:?}");
    }
    // What visitors and the panel's own chord ask for always passes.
    for request in [Request::ToggleStaff, Request::Louder(1), Request::Menu, Request::ToggleMicrophone, Request::Close]
    {
        assert_eq!(staff.staff.admit(request, &staff.site.staff), Some(request));
    }
}
