//! What the visitor reads over the picture: the wall label, one invitation, captions, the aim ring with the breath in it.
//!
//! It is set like a label on a museum wall: dark type on the light wall, few words, no frames. The ring is a circle
//! of the air itself, as wide as the jet is where it meets the sculpture, drawn in perspective; the arc along it is
//! the breath meter. All else is behind one word, "More" (`menu`).

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2};

use soffio_config::Group;
use soffio_exhibit::{Exhibit, Label, View};
use soffio_math::{PI, tangents};
use soffio_simulation::{BreathView, Snapshot};

use crate::pages::bidi::is_right_to_left;
use crate::pages::menu::{Menu, Tile};
use crate::pages::canvas::{HALO, INK, PAPER, Canvas, SMALL_TEXT_EM, SOFT_INK, VERMILION};
use crate::pages::words::words;
use crate::venue::house::House;
use crate::visitor::given;
use crate::visitor::input::Request;
use crate::visitor::needs::Needs;

/// Quiet time after which the invitation comes back, s.
const INVITE_AGAIN: f64 = 8.0;
/// Time in which the invitation fades, s.
const FADE: f64 = 0.5;
/// What is left of a fade that nobody sees: half a level of 255.
const FADE_END: f64 = 0.002;
/// Hard blowing after which a rest is proposed, s within about a minute, and until it has worn off to this: whoever blows
/// on and on becomes light-headed.
const REST_PROPOSED_S: f64 = 12.0;
const REST_OVER_S: f64 = 8.0;
const RECOVERY_S: f64 = 60.0;
/// What counts as hard, of the meter.
const HARD_BREATH: f64 = 0.6;
/// Longest line of type, of the page's width: label and invitation stand beside the work, not before it. On a tall
/// page they stand below it, and may meet in the middle.
const LINE_SHARE: f32 = 0.32;
const TALL_LINE_SHARE: f32 = 0.46;

/// What becomes of a visitor's breath.
#[derive(Clone, Copy, Debug, Default)]
pub struct BreathInput {
    /// Does anything listen to it?
    pub is_active: bool,
    /// Does the site want visitors to blow?
    pub is_allowed: bool,
    /// Is there a microphone that a visitor can switch?
    pub has_microphone: bool,
    /// Is it on?
    pub microphone_on: bool,
}

/// What is heard of the work.
#[derive(Clone, Copy, Debug, Default)]
pub struct SoundState<'a> {
    /// Keys of the captions of what can be heard.
    pub captions: &'a [String],
    /// Is the sound off?
    pub is_muted: bool,
    /// Is something being read aloud? `None` where nothing can read the language shown.
    pub reads_aloud: Option<bool>,
    /// May a visitor change the volume?
    pub has_volume_control: bool,
}

/// What the overlay is drawn from.
pub struct Scene<'a> {
    /// What is shown.
    pub exhibit: &'a Exhibit,
    /// The moment shown.
    pub snapshot: &'a Snapshot,
    /// The camera of the picture.
    pub view: View,
    /// Text key that attract mode shows.
    pub attract_text: Option<&'a str>,
    /// Language of the invitation: nobody has chosen one while attract mode plays.
    pub invitation_language: &'a str,
    /// Closed, or cleaned: all is covered.
    pub venue: &'a House,
    /// What becomes of a visitor's breath.
    pub breath_input: BreathInput,
    /// What is heard of the work.
    pub sound: SoundState<'a>,
    /// Seconds blown at it in this visit and today.
    pub seconds_blown: [f64; 2],
    /// What is left of the time after which the kiosk takes it that nobody is there, s, where that is near.
    pub attract_in: Option<f64>,
    /// What the visitor needs otherwise.
    pub accessibility: Needs,
    /// Where a pointer rests that presses by resting (picture coordinates), and how much of that time is over.
    pub dwell: Option<([f64; 2], f64)>,
    /// The works to choose from.
    pub tiles: &'a [Tile],
    /// How they are grouped.
    pub groups: &'a [Group],
    /// Languages offered.
    pub languages: &'a [String],
    /// Code of the language shown.
    pub language: &'a str,
    /// Seconds, for fading.
    pub time: f64,
    /// Points per millimetre of glass.
    pub points_per_mm: f32,
}

/// What the overlay remembers from picture to picture.
#[derive(Debug)]
pub struct Overlay {
    invitation: f64,
    last_breath: f64,
    time: f64,
    /// Hard blowing lately, s, and whether it was too much.
    hard_blowing: f64,
    proposes_rest: bool,
    /// Is something on its way: a fade, an arc?
    is_animating: bool,
}

impl Default for Overlay {
    fn default() -> Self {
        Self { invitation: 0.0, last_breath: f64::NEG_INFINITY, time: 0.0, hard_blowing: 0.0, proposes_rest: false, is_animating: false }
    }
}

impl Overlay {
    /// Draws over the whole of `picture`; returns where a press means something else than a breath.
    pub fn paint(&mut self, painter: &Painter, picture: Rect, menu: &mut Menu, scene: &Scene) -> Vec<(Rect, Request)> {
        self.update(scene);
        if cover(painter, scene) {
            return Vec::new();
        }
        let code = scene.language;
        let Some(label) = scene.exhibit.labels.get(code) else { return Vec::new() };
        let page = Canvas::new(painter, picture, scene.points_per_mm, scene.accessibility.reading);
        let mut buttons = Vec::new();
        self.is_animating |= scene.attract_in.is_some() || scene.dwell.is_some() || menu.shows_countdown(scene.time);
        if menu.open {
            menu.paint(&page, scene, &mut buttons);
            dwell_ring(&page, picture, scene);
            return buttons;
        }
        aim_ring(&page, picture, &scene.view, &scene.snapshot.breath);
        wall_label(&page, label, scene);
        captions(&page, label, scene);
        if let Some(said) = given::said(label, scene.seconds_blown) {
            page.text(page.picture.left_top(), Align2::LEFT_TOP, &said, 1.1, INK, longest_line(&page));
        }
        let own = words(code);
        let (said, opacity) = match (self.proposes_rest, scene.accessibility.round) {
            (true, _) => (own.rest.to_owned(), 1.0),
            (false, true) => (own.how_round(scene.accessibility).to_owned(), 1.0),
            (false, false) => (invitation_text(scene), self.invitation as f32),
        };
        paint_invitation(&page, &said, opacity);
        let more = page.label_button(page.picture.right_bottom(), own.more, false);
        let mut last = more;
        if scene.accessibility.round {
            last = page.label_button(pos2(more.left() - 0.5 * page.em, more.bottom()), own.round, true);
            buttons.push((last, Request::Round));
        }
        if let Some(left) = scene.attract_in {
            attract_countdown(&page, left, last, if scene.breath_input.is_active { own.stay } else { own.stay_touch });
        }
        buttons.push((more, Request::Menu));
        dwell_ring(&page, picture, scene);
        buttons
    }

    /// The invitation fades when somebody blows and returns when nobody has for a while.
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

    /// Did something on the last page fade, fill or close?
    pub fn is_animating(&self) -> bool {
        self.is_animating
    }

    /// Is a rest proposed?
    pub fn proposes_rest(&self) -> bool {
        self.proposes_rest
    }

    /// How far the invitation is shown, 0…1.
    pub fn invitation_opacity(&self) -> f64 {
        self.invitation
    }
}

/// Covers the picture while the house is closed or the glass is cleaned; says whether it did.
fn cover(painter: &Painter, scene: &Scene) -> bool {
    let all = painter.clip_rect();
    if let Some(left) = scene.venue.cleans(scene.time) {
        painter.rect_filled(all, 0.0, PAPER);
        let page = Canvas::new(painter, all, scene.points_per_mm, scene.accessibility.reading);
        page.text(all.center(), Align2::CENTER_BOTTOM, words(scene.language).cleaning, 1.8, INK, page.picture.width());
        let count = FontId::proportional(4.0 * page.em);
        painter.text(all.center() + vec2(0.0, page.em), Align2::CENTER_TOP, format!("{:.0}", left.ceil()), count, INK);
        return true;
    }
    let closed = !scene.venue.is_open();
    if closed {
        painter.rect_filled(all, 0.0, Color32::BLACK);
    }
    closed
}

/// The words that invite: what attract mode shows, else the label's own, else the kiosk's.
fn invitation_text(scene: &Scene) -> String {
    let own = words(scene.invitation_language);
    let label = scene.exhibit.labels.get(scene.invitation_language);
    let find = |key: &str| label?.text.iter().find(|(k, _)| k == key).map(|(_, text)| text.clone());
    // Whoever need not hold is not told to.
    if scene.accessibility.once() && !(scene.breath_input.is_active && scene.breath_input.is_allowed) {
        return own.how(scene.accessibility).into();
    }
    if !scene.breath_input.is_allowed {
        return own.no_breath.into();
    }
    // Nobody is invited to blow where nothing hears it.
    let shown = scene.attract_text.filter(|key| scene.breath_input.is_active || *key != "invite").and_then(find);
    let (key, fallback) = if scene.breath_input.is_active { ("invite", own.invite) } else { ("hold", own.hold) };
    shown.or_else(|| find(key)).unwrap_or_else(|| fallback.into())
}

/// The ring about a pointer that rests, filled by as much as it has rested.
fn dwell_ring(page: &Canvas, picture: Rect, scene: &Scene) {
    let Some(([x, y], share)) = scene.dwell else { return };
    let (center, radius) = (picture.lerp_inside(vec2(x as f32, y as f32)), 0.3 * page.button);
    page.painter.circle_stroke(center, radius, Stroke::new(0.45 * page.em, PAPER));
    page.painter.circle_stroke(center, radius, Stroke::new(0.1 * page.em, SOFT_INK));
    page.arc(center, radius, share as f32, VERMILION);
}

/// Longest line beside the work.
fn longest_line(page: &Canvas) -> f32 {
    page.picture.width() * if page.is_tall() { TALL_LINE_SHARE } else { LINE_SHARE }
}

/// Title, maker, rights and what becomes of the sound, bottom left like a label beside a work.
fn wall_label(page: &Canvas, label: &Label, scene: &Scene) {
    let own = words(scene.language);
    let mut at = page.picture.left_bottom();
    let ear = match (scene.breath_input.is_active, scene.breath_input.has_microphone && !scene.breath_input.microphone_on) {
        (true, _) => own.privacy,
        (false, true) => own.ear_off,
        (false, false) => "",
    };
    let sound = match (scene.exhibit.sounds.is_empty(), scene.sound.is_muted) {
        (true, _) => own.no_sound,
        (false, true) => own.silent,
        (false, false) => "",
    };
    let parts = [
        (scene.exhibit.credit.notice.trim(), SMALL_TEXT_EM, SOFT_INK, 0.2),
        (ear, SMALL_TEXT_EM, SOFT_INK, 0.3),
        (sound, SMALL_TEXT_EM, SOFT_INK, 0.6),
        (label.maker.as_str(), 0.85, SOFT_INK, 0.1),
        (label.title.as_str(), 1.4, INK, 0.0),
    ];
    let set = |&(text, size, color, space): &(&str, f32, Color32, f32)| {
        (!text.is_empty()).then(|| (page.layout(text, size, color, longest_line(page)), color, space * page.em))
    };
    let set: Vec<_> = parts.iter().filter_map(set).collect();
    // A label that is read from the right has one edge on the right.
    let anchor = match is_right_to_left(&label.title) {
        true => {
            at.x += set.iter().map(|(galley, ..)| galley.size().x).fold(0.0, f32::max);
            Align2::RIGHT_BOTTOM
        }
        false => Align2::LEFT_BOTTOM,
    };
    for (galley, color, space) in set {
        at.y -= page.place(galley, at, anchor, color).height() + space;
    }
}

/// What is heard, in the middle of the lower edge.
fn captions(page: &Canvas, label: &Label, scene: &Scene) {
    let said = |key: &String| label.caption.iter().find(|(k, _)| k == key).map(|(_, text)| text.as_str());
    let all: Vec<&str> = scene.sound.captions.iter().filter_map(said).collect();
    if !all.is_empty() && !scene.sound.is_muted {
        let at = page.picture.center_bottom();
        page.text(at, Align2::CENTER_BOTTOM, &all.join("  "), 0.85, INK, 0.9 * longest_line(page));
    }
}

/// Low on the right, above the button.
fn paint_invitation(page: &Canvas, text: &str, opacity: f32) {
    if opacity > 0.01 {
        let at = page.picture.right_bottom() - vec2(0.0, page.button + 1.5 * page.em);
        page.text(at, Align2::RIGHT_BOTTOM, text, 1.35, INK.gamma_multiply(opacity), longest_line(page));
    }
}

/// The last seconds before attract mode: an arc that closes, and how to stay.
fn attract_countdown(page: &Canvas, left: f64, more: Rect, stay: &str) {
    let radius = 0.7 * page.em;
    let center = pos2(more.left() - 2.0 * radius, more.center().y);
    page.arc(center, radius, (left / crate::attract::script::COUNTDOWN_S).clamp(0.0, 1.0) as f32, VERMILION);
    let at = pos2(center.x - 2.0 * radius, center.y);
    page.text(at, Align2::RIGHT_CENTER, stay, 0.85, INK, longest_line(page));
}

/// The aim ring where the jet meets the sculpture, and the breath as an arc along it.
fn aim_ring(page: &Canvas, picture: Rect, view: &View, breath: &BreathView) {
    let ring = &breath.ring;
    if ring.radius <= 0.0 {
        return;
    }
    let aspect = f64::from(picture.width() / picture.height());
    let (across, along) = tangents(ring.axis);
    let upright = view.up - ring.axis * view.up.dot(ring.axis);
    let along = upright.try_normalize().unwrap_or(along);
    // Clockwise for whoever looks along the breath.
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
    page.line(circle(ring.radius, 1.0), 0.07, INK.gamma_multiply(0.75));
    if breath.meter > 0.0 {
        page.line(circle(1.12 * ring.radius, breath.meter), 0.22, VERMILION);
    }
    if let Some([x, y]) = view.project(ring.center, aspect) {
        let at = picture.lerp_inside(vec2(x as f32, y as f32));
        page.painter.circle_filled(at, 0.16 * page.em, HALO);
        page.painter.circle_filled(at, 0.09 * page.em, INK);
    }
}
