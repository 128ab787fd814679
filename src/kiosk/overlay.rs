//! What the visitor reads over the picture: the wall label, one invitation, the aim ring with the breath in it.
//!
//! It is set like a label on a museum wall: dark type on the light wall, few words, no frames. The ring is a circle
//! of the air itself, as wide as the jet is where it meets the sculpture, drawn in perspective; the arc along it is
//! the breath meter. Type meets a contrast of 4.5 : 1 on wall and floor and graphics 3 : 1; a pale halo keeps both over
//! dark parts of the picture.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2};

use crate::exhibit::{Exhibit, Label, View};
use crate::math::{PI, tangents};
use crate::simulation::{BreathView, Snapshot};

use super::input::Request;
use super::words::{language_name, words};

/// Quiet time after which the invitation comes back, s.
const INVITE_AGAIN: f64 = 8.0;
/// Time in which the invitation fades, s.
const FADE: f64 = 0.5;
/// Side of a button on the glass, mm (NHM London, multimedia access guidelines).
const BUTTON_MM: f32 = 15.0;

/// Longest line of type, of the page's width: label and invitation stand beside the work, not before it. On a tall
/// page they stand below it, and may meet in the middle.
const LINE_SHARE: f32 = 0.32;
const TALL_LINE_SHARE: f32 = 0.46;

/// Smallest type, em: 2.9 mm on a 1280 x 720 picture of the usual screen.
const SMALL: f32 = 0.72;

const INK: Color32 = Color32::from_rgb(38, 36, 34);
/// On the floor too, the darkest ground that type stands on (luminance 0.34), 4.5 : 1.
const SOFT_INK: Color32 = Color32::from_rgb(52, 50, 48);
const VERMILION: Color32 = Color32::from_rgb(190, 44, 22);
const HALO: Color32 = Color32::from_rgba_premultiplied(170, 170, 168, 170);

/// What the overlay is drawn from.
pub struct Scene<'a> {
    /// What is shown.
    pub exhibit: &'a Exhibit,
    /// The moment shown.
    pub moment: &'a Snapshot,
    /// The camera of the picture.
    pub view: View,
    /// Text key that attract mode shows.
    pub attract_text: Option<&'a str>,
    /// Does anything listen to the visitor's breath?
    pub hears: bool,
    /// Languages offered.
    pub languages: &'a [String],
    /// Code of the language shown.
    pub language: &'a str,
    /// May a visitor change the volume?
    pub volume: bool,
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
}

impl Default for Overlay {
    fn default() -> Self {
        Self { invitation: 0.0, last_breath: f64::NEG_INFINITY, time: 0.0 }
    }
}

impl Overlay {
    /// Draws over the whole of `picture`; returns where a press means something else than a breath.
    pub fn paint(&mut self, painter: &Painter, picture: Rect, scene: &Scene) -> Vec<(Rect, Request)> {
        self.advance(scene);
        let code = scene.language;
        let Some(label) = scene.exhibit.labels.get(code) else { return Vec::new() };
        // Sizes are shares of the picture's height, so that type keeps its place in the composition.
        let em = picture.height().min(picture.width() * 0.75) / 45.0;
        let page = Page { painter, picture: picture.shrink(2.0 * em), em };

        page.ring(picture, &scene.view, &scene.moment.breath);
        let privacy = scene.hears.then_some(words(code).privacy);
        page.wall_label(label, scene.exhibit.credit.notice.trim(), privacy);
        page.invitation(&invitation(label, code, scene), self.invitation as f32);
        let mut buttons = Vec::new();
        let left = page.languages(scene, &mut buttons);
        page.volume(scene, left, &mut buttons);
        buttons
    }

    /// The invitation fades when somebody blows and returns when nobody has for a while.
    fn advance(&mut self, scene: &Scene) {
        let dt = (scene.time - self.time).clamp(0.0, 0.25);
        self.time = scene.time;
        let attracts = scene.attract_text.is_some();
        if scene.moment.breath.speed > 0.0 && !attracts {
            self.last_breath = scene.time;
        }
        let shown = attracts || scene.time - self.last_breath > INVITE_AGAIN;
        let target = if shown { 1.0 } else { 0.0 };
        self.invitation += (target - self.invitation) * (1.0 - (-dt / FADE).exp());
    }

    /// How far the invitation is shown, 0…1.
    pub fn invitation(&self) -> f64 {
        self.invitation
    }
}

/// The words that invite: what attract mode shows, else the label's own, else the kiosk's.
fn invitation(label: &Label, code: &str, scene: &Scene) -> String {
    let find = |key: &str| label.text.iter().find(|(k, _)| k == key).map(|(_, text)| text.clone());
    let own = words(code);
    let shown = scene.attract_text.and_then(find);
    let (key, fallback) = if scene.hears { ("invite", own.invite) } else { ("hold", own.hold) };
    shown.or_else(|| find(key)).unwrap_or_else(|| fallback.into())
}

/// A place to set type on.
struct Page<'a> {
    painter: &'a Painter,
    picture: Rect,
    em: f32,
}

impl Page<'_> {
    /// Title, maker, rights and what becomes of the sound, bottom left like a label beside a work.
    fn wall_label(&self, label: &Label, notice: &str, privacy: Option<&str>) {
        let mut at = self.picture.left_bottom();
        let mut line = |text: &str, size: f32, color: Color32, space: f32| {
            if !text.is_empty() {
                at.y -= self.text(at, Align2::LEFT_BOTTOM, text, size, color).height() + space * self.em;
            }
        };
        line(notice, SMALL, SOFT_INK, 0.2);
        line(privacy.unwrap_or_default(), SMALL, SOFT_INK, 0.6);
        line(&label.maker, 0.85, SOFT_INK, 0.1);
        line(&label.title, 1.4, INK, 0.0);
    }

    /// Low on the right, above the languages.
    fn invitation(&self, text: &str, opacity: f32) {
        if opacity > 0.01 {
            let at = pos2(self.picture.right(), self.picture.bottom() - 4.5 * self.em);
            self.text(at, Align2::RIGHT_BOTTOM, text, 1.35, INK.gamma_multiply(opacity));
        }
    }

    /// One button per language, each with its own name, bottom right; none where there is no choice.
    /// Where they begin.
    fn languages(&self, scene: &Scene, buttons: &mut Vec<(Rect, Request)>) -> f32 {
        let mut right = self.picture.right();
        if scene.languages.len() < 2 {
            return right;
        }
        let side = BUTTON_MM * scene.points_per_mm;
        for (i, code) in scene.languages.iter().enumerate().rev() {
            let shown = code == scene.language;
            let font = FontId::proportional(0.85 * self.em);
            let color = if shown { INK } else { SOFT_INK };
            let galley = self.painter.layout_no_wrap(language_name(code).into(), font, color);
            let size = vec2((galley.size().x + self.em).max(side), (2.0 * self.em).max(side));
            let rect = Rect::from_min_size(pos2(right - size.x, self.picture.bottom() - size.y), size);
            let text = rect.center() - 0.5 * galley.size();
            if shown {
                let y = text.y + galley.size().y + 0.15 * self.em;
                self.painter.hline(text.x..=text.x + galley.size().x, y, Stroke::new(0.08 * self.em, VERMILION));
            }
            self.painter.galley(text, galley, color);
            buttons.push((rect, Request::Language(i)));
            right -= size.x;
        }
        right
    }

    /// Softer and louder, left of the languages: two signs that need no words.
    fn volume(&self, scene: &Scene, mut right: f32, buttons: &mut Vec<(Rect, Request)>) {
        if !scene.volume {
            return;
        }
        let side = (2.0 * self.em).max(BUTTON_MM * scene.points_per_mm);
        for (sign, by) in [("+", 1), ("\u{2212}", -1)] {
            let rect = Rect::from_min_size(pos2(right - side, self.picture.bottom() - side), vec2(side, side));
            let galley = self.painter.layout_no_wrap(sign.into(), FontId::proportional(1.2 * self.em), SOFT_INK);
            self.painter.circle_stroke(rect.center(), 0.75 * self.em, Stroke::new(0.07 * self.em, SOFT_INK));
            self.painter.galley(rect.center() - 0.5 * galley.size(), galley, SOFT_INK);
            buttons.push((rect, Request::Louder(by)));
            right -= side;
        }
    }

    /// The aim ring where the jet meets the sculpture, and the breath as an arc along it.
    fn ring(&self, picture: Rect, view: &View, breath: &BreathView) {
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
        self.line(circle(ring.radius, 1.0), 0.07, INK.gamma_multiply(0.75));
        if breath.meter > 0.0 {
            self.line(circle(1.12 * ring.radius, breath.meter), 0.22, VERMILION);
        }
        if let Some([x, y]) = view.project(ring.center, aspect) {
            let at = picture.lerp_inside(vec2(x as f32, y as f32));
            self.painter.circle_filled(at, 0.16 * self.em, HALO);
            self.painter.circle_filled(at, 0.09 * self.em, INK);
        }
    }

    /// A line `width` em wide in a pale halo.
    fn line(&self, points: Vec<Pos2>, width: f32, color: Color32) {
        self.painter.line(points.clone(), Stroke::new((width + 0.14) * self.em, HALO.gamma_multiply(0.6)));
        self.painter.line(points, Stroke::new((width * self.em).max(1.0), color));
    }

    /// Type `size` em high, in lines no longer than its share of the page.
    fn text(&self, at: Pos2, anchor: Align2, text: &str, size: f32, color: Color32) -> Rect {
        let font = FontId::proportional(size * self.em);
        let tall = self.picture.height() > self.picture.width();
        let line = self.picture.width() * if tall { TALL_LINE_SHARE } else { LINE_SHARE };
        let galley = self.painter.layout(text.into(), font, color, line);
        let rect = anchor.anchor_size(at, galley.size());
        let halo = HALO.gamma_multiply(0.5 * f32::from(color.a()) / 255.0);
        let blur = 0.05 * self.em;
        for (dx, dy) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            self.painter.galley_with_override_text_color(rect.min + blur * vec2(dx, dy), galley.clone(), halo);
        }
        self.painter.galley(rect.min, galley, color);
        rect
    }
}
