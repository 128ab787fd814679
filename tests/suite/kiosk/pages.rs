//! The pages over the picture: their targets and the size of these. Every page is reached and left by finger and by keys, in each
//! language, on each shape of screen.

use std::path::Path;
use std::sync::{Arc, LazyLock};

use soffio_config::{Config, ExhibitGroup};
use soffio_exhibit::{self as exhibit, Exhibit, Label};
use soffio_kiosk::egui::{self, Rect, pos2};
use soffio_kiosk::pages::canvas::BUTTON_MM;
use soffio_kiosk::pages::fonts;
use soffio_kiosk::pages::languages::{languages_without_glyphs, offered};
use soffio_kiosk::pages::menu::{Menu, Tile, tiles};
use soffio_kiosk::pages::overlay::{BreathInput, Overlay, Scene, SoundState};
use soffio_kiosk::pages::ui_strings::{TextId, Translations};
use soffio_kiosk::step::captions::Captions;
use soffio_kiosk::venue::catalog::CatalogEntry;
use soffio_kiosk::venue::state::VenueState;
use soffio_kiosk::visitor::accessibility::AccessibilitySettings;
use soffio_kiosk::visitor::accessibility::TextSettings;
use soffio_kiosk::visitor::input::Request;
use soffio_simulation::{Command, Settings, Simulation, Snapshot, StepInput};
use soffio_sound::SoundCommand;

/// Points a millimetre of a 43-inch glass with a picture of full HD.
const POINTS_PER_MM: f32 = 2.0;
/// Shapes of glass, points.
pub const GLASSES: [[f32; 2]; 4] = [[1920.0, 1080.0], [1280.0, 720.0], [1080.0, 1920.0], [2560.0, 1080.0]];
const READINGS: [TextSettings; 3] = [
    TextSettings { large: false, contrast: false },
    TextSettings { large: true, contrast: false },
    TextSettings { large: true, contrast: true },
];

/// The shipped texts.
pub fn texts() -> &'static Translations {
    static TEXTS: LazyLock<Translations> = LazyLock::new(Translations::default);
    &TEXTS
}

pub fn load(id: &str) -> Arc<Exhibit> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}")))
}

/// A visitor before the glass.
pub struct Before {
    pub context: egui::Context,
    pub exhibit: Arc<Exhibit>,
    pub moment: Snapshot,
    pub glass: [f32; 2],
    pub languages: Vec<String>,
    pub language: String,
    pub accessibility: AccessibilitySettings,
    pub rests: Option<([f64; 2], f64)>,
    pub speech: Option<bool>,
    pub overlay: Overlay,
    pub menu: Menu,
    pub time: f64,
    pub activity: u64,
    pub exhibits: usize,
    pub groups: Vec<ExhibitGroup>,
    /// Real works with their pictures, where there are any.
    pub shelf: Vec<CatalogEntry>,
    pub thumbnails: Vec<(String, egui::TextureHandle)>,
    pub hears: bool,
    pub breath: bool,
    pub attract: Option<&'static str>,
    pub captions: Vec<String>,
    pub silent: bool,
    pub leaves_in: Option<f64>,
    pub house: VenueState,
    /// What is written on the glass.
    pub said: Vec<String>,
}

impl Before {
    pub fn new(exhibit: &Arc<Exhibit>, glass: [f32; 2]) -> Self {
        let context = egui::Context::default();
        context.set_fonts(fonts::definitions());
        let languages: Vec<String> = exhibit.labels.languages.iter().map(|(code, _)| code.clone()).collect();
        Self {
            context,
            exhibit: exhibit.clone(),
            moment: Simulation::new(exhibit.clone(), Settings::default()).snapshot(),
            glass,
            language: languages[0].clone(),
            languages,
            accessibility: AccessibilitySettings::default(),
            rests: None,
            speech: Some(false),
            overlay: Overlay::default(),
            menu: Menu::default(),
            time: 1.0,
            activity: 0,
            exhibits: 21,
            groups: ExhibitGroup::shipped(),
            shelf: Vec::new(),
            thumbnails: Vec::new(),
            hears: true,
            breath: true,
            attract: None,
            captions: Vec::new(),
            silent: false,
            leaves_in: None,
            house: VenueState::default(),
            said: Vec::new(),
        }
    }

    pub fn picture(&self) -> Rect {
        Rect::from_min_size(pos2(0.0, 0.0), self.glass.into())
    }

    /// Looks: what can be pressed.
    pub fn look(&mut self) -> Vec<(Rect, Request)> {
        self.look_with(|_| ())
    }

    /// Looks, and does something with what the picture is made from.
    pub fn look_with(&mut self, with: impl FnOnce(&Scene)) -> Vec<(Rect, Request)> {
        let (buttons, mut laid_out) = self.lay_out_with(with);
        laid_out.textures_delta.clear();
        buttons
    }

    /// All that is drawn over the picture.
    pub fn lay_out(&mut self) -> egui::FullOutput {
        self.lay_out_with(|_| ()).1
    }

    fn lay_out_with(&mut self, with: impl FnOnce(&Scene)) -> (Vec<(Rect, Request)>, egui::FullOutput) {
        let picture = self.picture();
        let input = egui::RawInput { screen_rect: Some(picture), ..egui::RawInput::default() };
        self.menu.update(self.time, self.activity, self.moment.breath.estimate.speed > 0.0);
        let tiles: Vec<Tile> = match self.shelf.is_empty() {
            true => (0..self.exhibits)
                .map(|i| Tile { id: format!("work-{i}"), title: format!("Work {i}"), picture: None, shown: i == 0 })
                .collect(),
            false => tiles(&self.context, &self.shelf, &mut self.thumbnails, &self.exhibit.folder, &self.language),
        };
        let mut buttons = Vec::new();
        let (context, overlay, menu) = (self.context.clone(), &mut self.overlay, &mut self.menu);
        let scene = Scene {
            exhibit: &self.exhibit,
            snapshot: &self.moment,
            view: self.exhibit.view(f64::from(self.glass[0] / self.glass[1])),
            attract_text: self.attract,
            invitation_language: &self.language,
            venue: &self.house,
            breath_input: BreathInput {
                is_active: self.hears,
                is_allowed: self.breath,
                has_microphone: true,
                microphone_on: self.hears,
            },
            sound: SoundState {
                captions: &self.captions,
                is_muted: self.silent,
                has_volume_control: true,
                reads_aloud: self.speech,
            },
            seconds_blown: [20.0, 400.0],
            attract_in: self.leaves_in,
            languages: &self.languages,
            language: &self.language,
            translations: texts(),
            time: self.time,
            accessibility: self.accessibility,
            dwell: self.rests,
            tiles: &tiles,
            groups: &self.groups,
            points_per_mm: POINTS_PER_MM,
        };
        with(&scene);
        let laid_out = context.run_ui(input, |ui| {
            let painter = ui.ctx().layer_painter(egui::LayerId::background());
            buttons = overlay.paint(&painter, picture, menu, &scene);
        });
        let text = |clipped: &egui::epaint::ClippedShape| match &clipped.shape {
            egui::Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        };
        self.said = laid_out.shapes.iter().filter_map(text).collect();
        (buttons, laid_out)
    }

    /// Presses a point; what that asks for.
    pub fn press(&mut self, at: egui::Pos2) -> Option<Request> {
        self.activity += 1;
        let request = self.look().into_iter().find(|(rect, _)| rect.contains(at)).map(|(_, request)| request);
        match request {
            Some(Request::Menu) => self.menu.toggle(),
            Some(Request::Page(by)) => self.menu.turn_page(by),
            Some(Request::Language(i)) => self.language = self.languages[i].clone(),
            _ => {}
        }
        request
    }
}

fn overlap(a: Rect, b: Rect) -> bool {
    let both = a.intersect(b);
    both.width() > 0.5 && both.height() > 0.5
}

#[test]
fn at_first_there_is_only_the_work_and_one_word() {
    for glass in GLASSES {
        let mut visitor = Before::new(&load("steel-fish"), glass);
        let buttons = visitor.look();
        assert_eq!(buttons.len(), 1, "{glass:?}: {buttons:?}");
        assert_eq!(buttons[0].1, Request::Menu);
        // The middle of the picture is the sculpture's: a press there blows.
        assert_eq!(visitor.press(visitor.picture().center()), None);
    }
}

#[test]
fn every_button_is_large_enough_apart_and_on_the_glass_in_every_language() {
    let mut seen = 0;
    for id in ["steel-fish", "terry-clock", "wind-chimes"] {
        let exhibit = load(id);
        for glass in GLASSES {
            for reading in READINGS {
                let mut visitor = Before::new(&exhibit, glass);
                visitor.accessibility.text = reading;
                visitor.accessibility.look_around = reading.contrast;
                for language in visitor.languages.clone() {
                    visitor.language = language.clone();
                    for open in [false, true] {
                        visitor.menu.open = open;
                        let what = format!("{id}, {glass:?}, {reading:?}, {language}, page open: {open}");
                        let all = visitor.look();
                        let buttons: Vec<_> = all.iter().filter(|(_, request)| *request != Request::Nothing).collect();
                        for (i, (rect, request)) in buttons.iter().enumerate() {
                            let side = rect.width().min(rect.height()) / POINTS_PER_MM;
                            assert!(side >= BUTTON_MM - 0.01, "{what}: {request:?} is {side} mm");
                            assert!(visitor.picture().contains_rect(*rect), "{what}: {request:?} at {rect:?}");
                            for (other, beside) in &buttons[i + 1..] {
                                assert!(!overlap(*rect, *other), "{what}: {request:?} lies on {beside:?}");
                            }
                            seen += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(seen > 1000, "{seen} buttons");
}

#[test]
fn the_page_is_reached_and_left_by_finger_and_everything_on_it_is_found() {
    for glass in GLASSES {
        let mut visitor = Before::new(&load("wind-chimes"), glass);
        let more = visitor.look()[0].0.center();
        assert_eq!(visitor.press(more), Some(Request::Menu));
        assert!(visitor.menu.open);
        let mut found: Vec<Request> = Vec::new();
        for _ in 0..visitor.exhibits {
            let buttons = visitor.look();
            found.extend(buttons.iter().map(|(_, request)| *request));
            let next = buttons.iter().find(|(_, request)| *request == Request::Page(1));
            let Some((rect, _)) = next else { break };
            let at = rect.center();
            assert_eq!(visitor.press(at), Some(Request::Page(1)), "{glass:?}");
        }
        let languages = (0..visitor.languages.len()).map(Request::Language);
        let rest =
            [Request::Louder(1), Request::Louder(-1), Request::Large, Request::Contrast, Request::ToggleMicrophone];
        let rest = rest.into_iter().chain([
            Request::PressOnce,
            Request::ReducedMotion,
            Request::LookAround,
            Request::ReadAloud,
        ]);
        for wanted in (0..visitor.exhibits).map(Request::Exhibit).chain(languages).chain(rest).chain([Request::Menu]) {
            assert!(found.contains(&wanted), "{glass:?}: {wanted:?} is nowhere");
        }
        // Beside all buttons a press is nothing: neither a breath nor a way out.
        let buttons = visitor.look();
        let free = (0..100)
            .map(|i| pos2(glass[0] * 0.01 * i as f32, glass[1] * 0.9))
            .find(|at| !buttons.iter().any(|(rect, request)| *request != Request::Nothing && rect.contains(*at)));
        assert_eq!(visitor.press(free.expect("a free place")), Some(Request::Nothing));
        let back = visitor.look().into_iter().find(|(_, request)| *request == Request::Menu).expect("a way back");
        assert_eq!(visitor.press(back.0.center()), Some(Request::Menu));
        assert!(!visitor.menu.open);
    }
}

#[test]
fn keys_alone_reach_every_button_and_come_back() {
    let mut visitor = Before::new(&load("steel-fish"), GLASSES[0]);
    visitor.menu.toggle();
    let buttons = visitor.look();
    // From where the first key leads, by all ways from everywhere that was reached.
    let mut first = visitor.menu.clone();
    first.move_focus([1, 0], &buttons);
    let (mut marked, mut open) = (Vec::new(), vec![first]);
    while let Some(menu) = open.pop() {
        let now = menu.focused(&buttons).expect("something is marked");
        assert_ne!(now, Request::Nothing);
        if marked.contains(&now) {
            continue;
        }
        marked.push(now);
        for way in [[1, 0], [0, 1], [-1, 0], [0, -1]] {
            let mut next = menu.clone();
            next.move_focus(way, &buttons);
            open.push(next);
        }
    }
    let all = visitor.look();
    for (_, request) in all.iter().filter(|(_, request)| *request != Request::Nothing) {
        assert!(marked.contains(request), "no key reaches {request:?}; reached {marked:?}");
    }
}

#[test]
fn the_page_closes_by_itself_after_half_a_minute_and_at_a_breath() {
    let mut visitor = Before::new(&load("steel-fish"), GLASSES[1]);
    visitor.menu.toggle();
    for second in 0..29 {
        visitor.time = 1.0 + f64::from(second);
        visitor.look();
        assert!(visitor.menu.open, "closed after {second} s");
    }
    visitor.activity += 1;
    visitor.look();
    visitor.time += 29.0;
    visitor.look();
    assert!(visitor.menu.open, "a touch restarts the time");
    visitor.time += 2.0;
    visitor.look();
    assert!(!visitor.menu.open);
    visitor.menu.toggle();
    visitor.look();
    visitor.moment.breath.estimate.speed = 3.0;
    visitor.look();
    assert!(!visitor.menu.open, "whoever blows wants the sculpture");
}

#[test]
fn after_much_hard_blowing_a_rest_is_proposed_and_forgotten() {
    let mut visitor = Before::new(&load("steel-fish"), GLASSES[1]);
    let blow = |visitor: &mut Before, meter: f64, seconds: f64| {
        visitor.moment.breath.meter = meter;
        visitor.moment.breath.speed = 10.0 * meter;
        for _ in 0..(seconds * 10.0) as usize {
            visitor.time += 0.1;
            visitor.look();
        }
    };
    blow(&mut visitor, 0.4, 60.0);
    assert!(!visitor.overlay.proposes_rest(), "gentle blowing is as it should be");
    blow(&mut visitor, 0.9, 5.0);
    assert!(!visitor.overlay.proposes_rest());
    blow(&mut visitor, 0.9, 10.0);
    assert!(visitor.overlay.proposes_rest());
    blow(&mut visitor, 0.0, 60.0);
    assert!(!visitor.overlay.proposes_rest());
}

#[test]
fn a_hand_is_invited_in_every_language_where_it_may_take_hold() {
    let inviting = |id: &String| load(id).hand_invitation("en").is_some();
    let ids: Vec<String> = exhibit::ids().into_iter().filter(inviting).collect();
    for id in ["marionette", "chains", "scratch-board", "strikers", "hang-it"] {
        assert!(ids.iter().any(|inviting| inviting == id), "{id} invites no hand");
    }
    for id in ids {
        let exhibit = load(&id);
        let mut closed = (*exhibit).clone();
        closed.touch.permitted = false;
        let closed = Arc::new(closed);
        for (code, label) in &exhibit.labels.languages {
            let take = label.text("take").unwrap_or_else(|| panic!("{id} invites no hand in {code}"));
            // A hand needs no microphone; and nobody is invited to what is not permitted.
            for (exhibit, hears, expected) in [(&exhibit, true, true), (&exhibit, false, true), (&closed, true, false)]
            {
                let mut visitor = Before::new(exhibit, GLASSES[0]);
                (visitor.language, visitor.attract, visitor.hears) = (code.clone(), Some("invite"), hears);
                (0..20).for_each(|_| {
                    visitor.time += 0.2;
                    visitor.look();
                });
                let invited = visitor.said.iter().any(|text| text.starts_with(take));
                assert_eq!(invited, expected, "{id}, {code}, hears {hears}: {:?}", visitor.said);
            }
        }
    }
}

#[test]
fn where_nobody_blows_nobody_is_invited_to_in_any_language() {
    let exhibit = load("steel-fish");
    for own in texts().languages() {
        let mut visitor = Before::new(&exhibit, GLASSES[0]);
        visitor.language = own.code().into();
        visitor.attract = Some("invite");
        let invited = |visitor: &mut Before| {
            (0..20).for_each(|_| {
                visitor.time += 0.2;
                visitor.look();
            });
            visitor.said.clone()
        };
        let label = exhibit.labels.get(own.code()).expect("a label");
        let (_, invite) = label.text.iter().find(|(key, _)| key == "invite").expect("its invitation");
        assert!(invited(&mut visitor).contains(invite), "{}: {:?}", own.code(), visitor.said);
        visitor.hears = false;
        let said = invited(&mut visitor);
        assert!(
            said.iter().any(|text| text == own.get(TextId::Hold)) && !said.contains(invite),
            "{}: {said:?}",
            own.code()
        );
        visitor.breath = false;
        let said = invited(&mut visitor);
        assert!(
            said.iter().any(|text| text == own.get(TextId::NoBreath)) && !said.contains(invite),
            "{}: {said:?}",
            own.code()
        );
    }
}

#[test]
fn works_that_have_room_on_one_leaf_are_not_parted() {
    /// Of a point: what is nearer to its bound may fall to either side.
    const ROUNDING: f32 = 0.5;
    const COLUMNS: usize = 3;
    let exhibit = load("steel-fish");
    let (mut parted, mut whole) = (0, 0);
    for (height, works) in (480..=1080).step_by(40).flat_map(|height| (2..9).map(move |works| (height, works))) {
        let height = height as f32;
        let mut visitor = Before::new(&exhibit, [16.0 / 9.0 * height, height]);
        visitor.menu.toggle();
        visitor.exhibits = works;
        visitor.groups[0].exhibits = vec!["work-0".into()];
        let buttons = visitor.look();
        let of_the_page = |request: &Request| {
            matches!(request, Request::Exhibit(_) | Request::Page(_) | Request::Menu | Request::Nothing)
        };
        let bar = buttons.iter().filter(|(_, request)| !of_the_page(request)).map(|(rect, _)| rect.top());
        let bar = bar.reduce(f32::min).expect("switches in the bar");
        let first = buttons.iter().find(|(_, request)| *request == Request::Exhibit(0)).expect("the first work").0;
        // A tile is 9/16 as high as wide and 2.2 em more, each of the two headings 2.2 em; an em lies below every row.
        let em = (first.height() - 9.0 / 16.0 * first.width()) / 2.2;
        let rows = 1 + (works - 1).div_ceil(COLUMNS);
        let all = 2.0 * 2.2 * em + rows as f32 * (first.height() + em);
        let space = bar - (first.top() - 2.2 * em);
        if (all - space).abs() > ROUNDING {
            let turns = buttons.iter().any(|(_, request)| *request == Request::Page(1));
            assert_eq!(turns, all > space, "{works} works on {height} points: {all} of {space}");
            *(if turns { &mut parted } else { &mut whole }) += 1;
        }
    }
    assert!(parted > 5 && whole > 5, "{parted} parted, {whole} whole");
}

#[test]
fn works_stand_under_the_headings_of_their_groups_in_every_language() {
    let exhibit = load("steel-fish");
    for glass in GLASSES {
        for own in texts().languages() {
            let mut visitor = Before::new(&exhibit, glass);
            visitor.language = own.code().into();
            visitor.menu.toggle();
            visitor.groups = ExhibitGroup::shipped();
            visitor.groups[0].exhibits = (0..21).step_by(2).map(|i| format!("work-{i}")).collect();
            let (mut found, mut said) = (Vec::new(), Vec::new());
            for _ in 0..visitor.exhibits {
                let buttons = visitor.look();
                said.extend(visitor.said.clone());
                found.extend(buttons.iter().filter_map(|(_, request)| match request {
                    Request::Exhibit(index) => Some(*index),
                    _ => None,
                }));
                let Some((rect, _)) = buttons.iter().find(|(_, request)| *request == Request::Page(1)) else { break };
                if found.len() >= visitor.exhibits {
                    break;
                }
                let at = rect.center();
                visitor.press(at);
            }
            // Those of the first group, in their order, then the rest.
            let expected: Vec<usize> = (0..21).step_by(2).chain((1..21).step_by(2)).collect();
            assert_eq!(found, expected, "{glass:?}");
            for (group, there) in [(0, true), (1, false), (2, false), (3, true)] {
                let heading = &visitor.groups[group].heading[own.code()];
                assert_eq!(said.contains(heading), there, "{}, {glass:?}: {heading}", own.code());
            }
        }
    }
}

#[test]
fn whoever_need_not_hold_is_not_told_to_in_any_language() {
    let exhibit = load("steel-fish");
    for own in texts().languages() {
        let mut visitor = Before::new(&exhibit, GLASSES[0]);
        visitor.language = own.code().into();
        visitor.accessibility.press_once = true;
        for (hears, breath, open) in [(false, true, false), (false, false, false), (true, true, true)] {
            (visitor.hears, visitor.breath, visitor.menu.open) = (hears, breath, open);
            (0..20).for_each(|_| {
                visitor.time += 0.2;
                visitor.look();
            });
            let said = &visitor.said;
            assert!(said.iter().any(|text| text == own.get(TextId::PressTwice)), "{}: {said:?}", own.code());
            assert!(
                !said.iter().any(|text| text == own.get(TextId::Hold) || text == own.get(TextId::NoBreath)),
                "{}: {said:?}",
                own.code()
            );
        }
    }
}

#[test]
fn a_language_is_offered_where_the_fonts_can_write_all_its_words_and_the_kiosks_own() {
    // Those of the fonts that come with the kiosk are offered everywhere; Korean and Japanese where the system has them.
    let cannot = languages_without_glyphs(texts());
    assert!(cannot.iter().all(|code| ["ko", "ja"].contains(&code.as_str())), "{cannot:?}");
    let mut exhibit = load("pendulum");
    let labels = &mut Arc::make_mut(&mut exhibit).labels;
    let (_, english) = labels.languages[0].clone();
    labels.languages.retain(|(code, _)| code == "en");
    // Kana alone: a font for Korean has them, and lacks letters of what the kiosk itself says in Japanese.
    for (code, title) in [("ja", "ふりこ"), ("ko", "진자"), ("it", "Pendolo"), ("tlh", "\u{f8d0}")] {
        labels.languages.push((code.into(), Label { title: title.into(), ..english.clone() }));
    }
    let mut visitor = Before::new(&exhibit, GLASSES[0]);
    visitor.look();
    let languages = offered(&visitor.context, &exhibit.labels, &Config::default(), texts(), &cannot);
    let expected: Vec<&str> =
        ["en", "ja", "ko", "it"].into_iter().filter(|code| !cannot.iter().any(|cannot| cannot == code)).collect();
    assert_eq!(languages, expected);
    assert_eq!(texts().get("pt").code(), "en");
}

#[test]
fn what_is_heard_is_written_and_what_is_over_is_not() {
    let exhibit = load("wind-chimes");
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let mut captions = Captions::default();
    let mut struck = None;
    for step in 0..2400 {
        let blow = match step {
            100 => Some(Command::Blow(Some(8.0))),
            500 => Some(Command::Blow(None)),
            _ => None,
        };
        simulation.step(&StepInput { commands: blow.as_slice(), ..StepInput::default() });
        let sounds = simulation.sounds();
        if struck.is_none() && sounds.iter().any(|sound| matches!(sound, SoundCommand::Strike(_))) {
            struck = Some(step);
        }
        captions.update(&exhibit, sounds, step);
        if step == 99 {
            assert_eq!(captions.shown(&exhibit, step), [""; 0], "nothing is heard yet");
        }
    }
    let struck = struck.expect("a chime rings");
    // Replayed up to there, both are written.
    let mut again = Simulation::new(exhibit.clone(), Settings::default());
    let mut captions = Captions::default();
    for step in 0..=struck + 1 {
        let blow = (step == 100).then_some(Command::Blow(Some(8.0)));
        again.step(&StepInput { commands: blow.as_slice(), ..StepInput::default() });
        captions.update(&exhibit, again.sounds(), step);
    }
    let shown = captions.shown(&exhibit, struck + 1);
    assert!(shown.len() == 2, "chime and wind: {shown:?}");
    for key in &shown {
        for (code, label) in &exhibit.labels.languages {
            assert!(label.caption.iter().any(|(known, _)| known == key), "{code} has no caption {key}");
        }
    }
    assert_eq!(captions.shown(&exhibit, struck + 600), [""; 0], "two seconds later it is over");
    let mut visitor = Before::new(&exhibit, GLASSES[0]);
    visitor.captions = shown;
    assert_eq!(visitor.look().len(), 1, "captions are no buttons");
}
