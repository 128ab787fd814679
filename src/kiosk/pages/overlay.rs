//! Overlay: the wall label, one invitation, captions, and the aim ring with the breath meter.
//!
//! It looks like a label on a museum wall: dark type on a light ground, few words, no frames. The ring is drawn in
//! perspective and is as wide as the jet where it meets the sculpture. The arc along the ring is the breath meter.
//! Everything else is on the page behind "More" ([`menu`](super::menu)).

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2};

use soffio_config::ExhibitGroup;
use soffio_exhibit::{Exhibit, Label, View};
use soffio_math::{PI, tangents};
use soffio_simulation::{BreathView, Snapshot};

use crate::pages::bidi::is_right_to_left;
use crate::pages::canvas::{Canvas, HALO, INK, PAPER, SMALL_TEXT_EM, SOFT_INK, VERMILION};
use crate::pages::menu::{Menu, Tile};
use crate::pages::ui_strings::{TextId, Translations, UiStrings};
use crate::venue::state::VenueState;
use crate::visitor::accessibility::AccessibilitySettings;
use crate::visitor::breath_time;
use crate::visitor::input::Request;

/// Time without a breath after which the invitation returns, s.
const INVITE_AGAIN: f64 = 8.0;
/// Time in which the invitation fades, s.
const FADE: f64 = 0.5;
/// Remainder at which a fade is over: half of one level in 255.
const FADE_END: f64 = 0.002;
/// Hard blowing within about a minute after which a rest is proposed, s: long hard blowing makes light-headed. The
/// proposal ends when the count has decayed to `REST_OVER_S`, with the time constant `RECOVERY_S`.
const REST_PROPOSED_S: f64 = 12.0;
const REST_OVER_S: f64 = 8.0;
const RECOVERY_S: f64 = 60.0;
/// Meter reading from which a breath is hard, 0 to 1.
const HARD_BREATH: f64 = 0.6;
/// Longest line of type, share of the picture's width. Label and invitation stand beside the exhibit, not in front of it.
/// In a tall picture they stand below the exhibit and may meet in the middle.
const LINE_SHARE: f32 = 0.32;
const TALL_LINE_SHARE: f32 = 0.46;

/// State of the breath input.
#[derive(Clone, Copy, Debug, Default)]
pub struct BreathInput {
    /// Is the detector running on a signal?
    pub is_active: bool,
    /// Does the configuration let visitors blow?
    pub is_allowed: bool,
    /// Is there a microphone for visitors to switch on and off?
    pub has_microphone: bool,
    /// Is that switch on?
    pub microphone_on: bool,
}

/// State of the sound.
#[derive(Clone, Copy, Debug, Default)]
pub struct SoundState<'a> {
    /// Keys of the captions of the sounds that are audible now.
    pub captions: &'a [String],
    /// Is the sound off?
    pub is_muted: bool,
    /// Is a text being read aloud? `None` if no voice reads the current language.
    pub reads_aloud: Option<bool>,
    /// Can visitors change the volume?
    pub has_volume_control: bool,
}

/// Input of the overlay and of the page behind "More".
pub struct Scene<'a> {
    /// The exhibit on show.
    pub exhibit: &'a Exhibit,
    /// The simulation's state in this picture.
    pub snapshot: &'a Snapshot,
    /// The camera of the picture.
    pub view: View,
    /// Key of the label text that attract mode shows.
    pub attract_text: Option<&'a str>,
    /// Language of the invitation: attract mode goes through all languages.
    pub invitation_language: &'a str,
    /// Opening hours and cleaning: a closed kiosk is covered.
    pub venue: &'a VenueState,
    /// State of the breath input.
    pub breath_input: BreathInput,
    /// State of the sound.
    pub sound: SoundState<'a>,
    /// Time blown at the exhibit in this visit and today, s.
    pub seconds_blown: [f64; 2],
    /// Time until attract mode, s, in its last seconds.
    pub attract_in: Option<f64>,
    /// The visitor's accessibility settings.
    pub accessibility: AccessibilitySettings,
    /// A pointer that presses by resting: its place (picture coordinates) and the share of the dwell time that is over.
    pub dwell: Option<([f64; 2], f64)>,
    /// The exhibits to choose from.
    pub tiles: &'a [Tile],
    /// Their groups.
    pub groups: &'a [ExhibitGroup],
    /// Codes of the languages offered.
    pub languages: &'a [String],
    /// Code of the current language.
    pub language: &'a str,
    /// The kiosk's own texts.
    pub translations: &'a Translations,
    /// Seconds, for fading.
    pub time: f64,
    /// Points per millimetre of glass.
    pub points_per_mm: f32,
}

impl Scene<'_> {
    /// The kiosk's own texts in the current language.
    pub fn texts(&self) -> &UiStrings {
        self.translations.get(self.language)
    }

    /// The text that explains blowing without a microphone.
    pub fn how_to_blow(&self) -> TextId {
        match (self.accessibility.dwell, self.accessibility.press_once) {
            (true, _) => TextId::DwellTwice,
            (false, true) => TextId::PressTwice,
            (false, false) => TextId::Hold,
        }
    }

    /// The text that explains taking hold of the exhibit, its own or the general one; empty where touch is not permitted.
    pub fn how_to_take(&self) -> &str {
        if !self.exhibit.touch.permitted {
            return "";
        }
        self.exhibit.hand_invitation(self.language).unwrap_or(self.texts().get(TextId::Take))
    }

    /// The text that explains looking round the exhibit.
    pub fn how_to_look_round(&self) -> TextId {
        if self.accessibility.presses_once() { TextId::LookRoundPress } else { TextId::LookRoundDrag }
    }
}

/// State of the overlay from picture to picture.
#[derive(Debug)]
pub struct Overlay {
    invitation: f64,
    last_breath: f64,
    time: f64,
    /// Recent hard blowing, s.
    hard_blowing: f64,
    proposes_rest: bool,
    /// Does a fade or an arc still change?
    is_animating: bool,
}

impl Default for Overlay {
    fn default() -> Self {
        Self {
            invitation: 0.0,
            last_breath: f64::NEG_INFINITY,
            time: 0.0,
            hard_blowing: 0.0,
            proposes_rest: false,
            is_animating: false,
        }
    }
}

impl Overlay {
    /// Draws over all of `picture`. Returns the buttons: places where a press is not a breath.
    pub fn paint(&mut self, painter: &Painter, picture: Rect, menu: &mut Menu, scene: &Scene) -> Vec<(Rect, Request)> {
        self.update(scene);
        if cover(painter, scene) {
            return Vec::new();
        }
        let code = scene.language;
        let Some(label) = scene.exhibit.labels.get(code) else { return Vec::new() };
        let canvas = Canvas::new(painter, picture, scene.points_per_mm, scene.accessibility.text);
        let mut buttons = Vec::new();
        self.is_animating |= scene.attract_in.is_some() || scene.dwell.is_some() || menu.shows_countdown(scene.time);
        if menu.open {
            menu.paint(&canvas, scene, &mut buttons);
            dwell_ring(&canvas, picture, scene);
            return buttons;
        }
        aim_ring(&canvas, picture, &scene.view, &scene.snapshot.breath);
        wall_label(&canvas, label, scene);
        captions(&canvas, label, scene);
        if let Some(said) = breath_time::label_text(label, scene.seconds_blown) {
            canvas.text(canvas.picture.left_top(), Align2::LEFT_TOP, &said, 1.1, INK, longest_line(&canvas));
        }
        let texts = scene.texts();
        let (said, opacity) = match (self.proposes_rest, scene.accessibility.look_around) {
            (true, _) => (texts.get(TextId::TakeARest).to_owned(), 1.0),
            (false, true) => (texts.get(scene.how_to_look_round()).to_owned(), 1.0),
            (false, false) => (invitation_text(scene), self.invitation as f32),
        };
        paint_invitation(&canvas, &said, opacity);
        let more = canvas.label_button(canvas.picture.right_bottom(), texts.get(TextId::More), false);
        let mut last = more;
        if scene.accessibility.look_around {
            last = canvas.label_button(
                pos2(more.left() - 0.5 * canvas.em, more.bottom()),
                texts.get(TextId::LookRound),
                true,
            );
            buttons.push((last, Request::LookAround));
        }
        if let Some(left) = scene.attract_in {
            attract_countdown(
                &canvas,
                left,
                last,
                if scene.breath_input.is_active { texts.get(TextId::Stay) } else { texts.get(TextId::StayTouch) },
            );
        }
        buttons.push((more, Request::Menu));
        dwell_ring(&canvas, picture, scene);
        buttons
    }

    /// Advances the invitation's fade and the count of hard blowing.
    fn update(&mut self, scene: &Scene) {
        let dt = (scene.time - self.time).clamp(0.0, 0.25);
        self.time = scene.time;
        let attracts = scene.attract_text.is_some();
        if scene.snapshot.breath.speed > 0.0 && !attracts {
            self.last_breath = scene.time;
        }
        let shown = attracts || scene.time - self.last_breath > INVITE_AGAIN;
        let target = if shown { 1.0 } else { 0.0 };
        self.invitation += (target - self.invitation) * (1.0 - (-dt / FADE).exp());
        self.is_animating = (target - self.invitation).abs() > FADE_END;
        let hard = scene.breath_input.is_active && !attracts && scene.snapshot.breath.meter > HARD_BREATH;
        self.hard_blowing += if hard { dt } else { -self.hard_blowing * dt / RECOVERY_S };
        self.proposes_rest = self.hard_blowing > if self.proposes_rest { REST_OVER_S } else { REST_PROPOSED_S };
    }

    /// Did a fade or an arc change in the last picture?
    pub fn is_animating(&self) -> bool {
        self.is_animating
    }

    /// Is a rest proposed?
    pub fn proposes_rest(&self) -> bool {
        self.proposes_rest
    }

    /// Opacity of the invitation, 0 to 1.
    pub fn invitation_opacity(&self) -> f64 {
        self.invitation
    }
}

/// Covers the picture while the museum is closed or the glass is cleaned. Returns whether it did.
fn cover(painter: &Painter, scene: &Scene) -> bool {
    let all = painter.clip_rect();
    if let Some(left) = scene.venue.cleaning_left(scene.time) {
        painter.rect_filled(all, 0.0, PAPER);
        let canvas = Canvas::new(painter, all, scene.points_per_mm, scene.accessibility.text);
        canvas.text(
            all.center(),
            Align2::CENTER_BOTTOM,
            scene.texts().get(TextId::Cleaning),
            1.8,
            INK,
            canvas.picture.width(),
        );
        let count = FontId::proportional(4.0 * canvas.em);
        painter.text(
            all.center() + vec2(0.0, canvas.em),
            Align2::CENTER_TOP,
            format!("{:.0}", left.ceil()),
            count,
            INK,
        );
        return true;
    }
    let closed = !scene.venue.is_open();
    if closed {
        painter.rect_filled(all, 0.0, Color32::BLACK);
    }
    closed
}

/// The invitation to the hand, where the exhibit has one, and below it that to blow.
fn invitation_text(scene: &Scene) -> String {
    let blow = breath_invitation(scene);
    let hand = scene.exhibit.hand_invitation(scene.invitation_language);
    hand.map_or(blow.clone(), |hand| format!("{hand}\n{blow}"))
}

/// The invitation to blow: the text of attract mode, else the label's own, else the kiosk's.
fn breath_invitation(scene: &Scene) -> String {
    let texts = scene.translations.get(scene.invitation_language);
    let label = scene.exhibit.labels.get(scene.invitation_language);
    let find = |key: &str| Some(label?.text(key)?.to_owned());
    // Visitors who do not hold a key are not asked to.
    if scene.accessibility.presses_once() && !(scene.breath_input.is_active && scene.breath_input.is_allowed) {
        return texts.get(scene.how_to_blow()).into();
    }
    if !scene.breath_input.is_allowed {
        return texts.get(TextId::NoBreath).into();
    }
    // Without a microphone the invitation to blow is left out.
    let shown = scene.attract_text.filter(|key| scene.breath_input.is_active || *key != "invite").and_then(find);
    let (key, fallback) = if scene.breath_input.is_active {
        ("invite", texts.get(TextId::Invite))
    } else {
        ("hold", texts.get(TextId::Hold))
    };
    shown.or_else(|| find(key)).unwrap_or_else(|| fallback.into())
}

/// Ring about a resting pointer, filled by the share of the dwell time.
fn dwell_ring(canvas: &Canvas, picture: Rect, scene: &Scene) {
    let Some(([x, y], share)) = scene.dwell else { return };
    let (center, radius) = (picture.lerp_inside(vec2(x as f32, y as f32)), 0.3 * canvas.button);
    canvas.painter.circle_stroke(center, radius, Stroke::new(0.45 * canvas.em, PAPER));
    canvas.painter.circle_stroke(center, radius, Stroke::new(0.1 * canvas.em, SOFT_INK));
    canvas.arc(center, radius, share as f32, VERMILION);
}

/// Longest line beside the exhibit, points.
fn longest_line(canvas: &Canvas) -> f32 {
    canvas.picture.width() * if canvas.is_tall() { TALL_LINE_SHARE } else { LINE_SHARE }
}

/// Title, maker, rights, and notes on microphone and sound, bottom left like a label on a wall.
fn wall_label(canvas: &Canvas, label: &Label, scene: &Scene) {
    let texts = scene.texts();
    let mut at = canvas.picture.left_bottom();
    let microphone =
        match (scene.breath_input.is_active, scene.breath_input.has_microphone && !scene.breath_input.microphone_on) {
            (true, _) => texts.get(TextId::Privacy),
            (false, true) => texts.get(TextId::MicrophoneOff),
            (false, false) => "",
        };
    let sound = match (scene.exhibit.sounds.is_empty(), scene.sound.is_muted) {
        (true, _) => texts.get(TextId::NoSound),
        (false, true) => texts.get(TextId::SoundOff),
        (false, false) => "",
    };
    let parts = [
        (scene.exhibit.credit.notice.trim(), SMALL_TEXT_EM, SOFT_INK, 0.2),
        (microphone, SMALL_TEXT_EM, SOFT_INK, 0.3),
        (sound, SMALL_TEXT_EM, SOFT_INK, 0.6),
        (label.maker.as_str(), 0.85, SOFT_INK, 0.1),
        (label.title.as_str(), 1.4, INK, 0.0),
    ];
    let set = |&(text, size, color, space): &(&str, f32, Color32, f32)| {
        (!text.is_empty()).then(|| (canvas.layout(text, size, color, longest_line(canvas)), color, space * canvas.em))
    };
    let set: Vec<_> = parts.iter().filter_map(set).collect();
    // A label in a right-to-left script is aligned at its right edge.
    let anchor = match is_right_to_left(&label.title) {
        true => {
            at.x += set.iter().map(|(galley, ..)| galley.size().x).fold(0.0, f32::max);
            Align2::RIGHT_BOTTOM
        }
        false => Align2::LEFT_BOTTOM,
    };
    for (galley, color, space) in set {
        at.y -= canvas.place(galley, at, anchor, color).height() + space;
    }
}

/// Captions of the audible sounds, in the middle of the lower edge.
fn captions(canvas: &Canvas, label: &Label, scene: &Scene) {
    let said = |key: &String| label.caption.iter().find(|(k, _)| k == key).map(|(_, text)| text.as_str());
    let all: Vec<&str> = scene.sound.captions.iter().filter_map(said).collect();
    if !all.is_empty() && !scene.sound.is_muted {
        let at = canvas.picture.center_bottom();
        canvas.text(at, Align2::CENTER_BOTTOM, &all.join("  "), 0.85, INK, 0.9 * longest_line(canvas));
    }
}

/// The invitation, low on the right, above the button.
fn paint_invitation(canvas: &Canvas, text: &str, opacity: f32) {
    if opacity > 0.01 {
        let at = canvas.picture.right_bottom() - vec2(0.0, canvas.button + 1.5 * canvas.em);
        canvas.text(at, Align2::RIGHT_BOTTOM, text, 1.35, INK.gamma_multiply(opacity), longest_line(canvas));
    }
}

/// Countdown to attract mode: an arc that closes, and how to stay.
fn attract_countdown(canvas: &Canvas, left: f64, more: Rect, stay: &str) {
    let radius = 0.7 * canvas.em;
    let center = pos2(more.left() - 2.0 * radius, more.center().y);
    canvas.arc(center, radius, (left / crate::attract::script::COUNTDOWN_S).clamp(0.0, 1.0) as f32, VERMILION);
    let at = pos2(center.x - 2.0 * radius, center.y);
    canvas.text(at, Align2::RIGHT_CENTER, stay, 0.85, INK, longest_line(canvas));
}

/// The aim ring where the jet meets the sculpture, and the breath meter as an arc along it.
fn aim_ring(canvas: &Canvas, picture: Rect, view: &View, breath: &BreathView) {
    let ring = &breath.ring;
    if ring.radius <= 0.0 {
        return;
    }
    let aspect = f64::from(picture.width() / picture.height());
    let (across, along) = tangents(ring.axis);
    let upright = view.up - ring.axis * view.up.dot(ring.axis);
    let along = upright.try_normalize().unwrap_or(along);
    // Clockwise as seen along the breath.
    let across = if upright.length() > 0.0 { ring.axis.cross(along) } else { across };
    let circle = |radius: f64, share: f64| -> Vec<Pos2> {
        let corners = (96.0 * share).ceil().max(2.0);
        let at = |i: f64| {
            let (s, c) = (2.0 * PI * share * i / corners).sin_cos();
            let world = ring.center + radius * (along * c + across * s);
            let [x, y] = view.project(world, aspect)?;
            Some(picture.lerp_inside(vec2(x as f32, y as f32)))
        };
        (0..=corners as u32).filter_map(|i| at(f64::from(i))).collect()
    };
    canvas.line(circle(ring.radius, 1.0), 0.07, INK.gamma_multiply(0.75));
    if breath.meter > 0.0 {
        canvas.line(circle(1.12 * ring.radius, breath.meter), 0.22, VERMILION);
    }
    if let Some([x, y]) = view.project(ring.center, aspect) {
        let at = picture.lerp_inside(vec2(x as f32, y as f32));
        canvas.painter.circle_filled(at, 0.16 * canvas.em, HALO);
        canvas.painter.circle_filled(at, 0.09 * canvas.em, INK);
    }
}
