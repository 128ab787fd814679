//! The page behind "More": what the work is, how it is played, the other works, and how to read and hear them.
//!
//! It is one step away from the work and leads back to it by a button, by half a minute without a touch (a closing arc
//! shows the last ten seconds) and by a breath: whoever blows wants the sculpture. Everything on it can be reached by
//! finger, pointer, or by Tab, arrows and Enter.

use std::path::Path;

use egui::{Align2, Color32, Rect, Stroke, StrokeKind, TextureId, pos2, vec2};

use crate::pages::bidi::is_right_to_left;
use crate::pages::groups::{Row, heading, paginate, rows};
use crate::pages::overlay::Scene;
use crate::pages::canvas::{INK, PAPER, Canvas, SMALL_TEXT_EM, SOFT_INK, VERMILION};
use crate::pages::words::{language_name, words};
use crate::venue::shelf::Work;
use crate::visitor::input::Request;
use soffio_config::PAGE_CLOSES_S;

/// So long before it closes it shows that, s.
const COUNTDOWN: f64 = 10.0;
/// Columns of tiles on a wide page and on a tall one.
const COLUMNS: (usize, usize) = (3, 2);
/// Height of a tile's picture over its width.
const THUMBNAIL_ASPECT: f32 = 9.0 / 16.0;
/// Height of a group's heading, em.
const HEADING_EM: f32 = 2.2;
/// The label's part of a wide page, of its width, and of a tall one, of its height.
const LABEL_SHARE: f32 = 0.36;

/// A work to choose.
pub struct Tile {
    /// Name of its folder.
    pub id: String,
    /// Its title in the language shown.
    pub title: String,
    /// Its picture.
    pub picture: Option<TextureId>,
    /// Is it the one on show?
    pub shown: bool,
}

/// What the page remembers.
#[derive(Clone, Debug)]
pub struct Menu {
    /// Is it open?
    pub open: bool,
    /// Time without a touch after which it closes, s.
    pub closes_s: f64,
    page_index: usize,
    page_count: usize,
    focus: Option<usize>,
    /// Inputs that were seen, and when the last one came, s.
    activity: u64,
    last_input: f64,
}

impl Default for Menu {
    fn default() -> Self {
        Self { open: false, closes_s: PAGE_CLOSES_S, page_index: 0, page_count: 0, focus: None, activity: 0, last_input: 0.0 }
    }
}

impl Menu {
    /// Opens it, or closes it.
    pub fn toggle(&mut self) {
        let (open, closes_s) = (!self.open, self.closes_s);
        *self = Self { open, closes_s, last_input: f64::NEG_INFINITY, ..Self::default() };
    }

    /// Closes it, and forgets where it was opened.
    pub fn close(&mut self) {
        *self = Self { closes_s: self.closes_s, ..Self::default() };
    }

    /// Turns to another leaf of works.
    pub fn turn_page(&mut self, by: i32) {
        let leaves = self.page_count.max(1) as i32;
        self.page_index = (self.page_index as i32 + by).rem_euclid(leaves) as usize;
        self.focus = None;
    }

    /// Closes where nobody has touched it for long, or somebody blows; `activity` counts inputs.
    pub fn update(&mut self, time: f64, activity: u64, blown: bool) {
        if self.last_input == f64::NEG_INFINITY || activity != self.activity {
            (self.last_input, self.activity) = (time, activity);
        }
        if self.open && (blown || time - self.last_input > self.closes_s) {
            self.toggle();
        }
    }

    /// Does its arc close?
    pub fn shows_countdown(&self, time: f64) -> bool {
        self.open && time - self.last_input > self.closes_s - COUNTDOWN
    }

    /// Moves the mark of the keys to the next button that way (right and down); the first key shows it.
    pub fn move_focus(&mut self, way: [i32; 2], buttons: &[(Rect, Request)]) {
        let pressable = |i: &usize| buttons[*i].1 != Request::Nothing;
        let all: Vec<usize> = (0..buttons.len()).filter(pressable).collect();
        let Some(from) = self.focus.and_then(|focus| buttons.get(focus)).map(|(rect, _)| rect.center()) else {
            self.focus = all.first().copied();
            return;
        };
        let way = vec2(way[0] as f32, way[1] as f32);
        // Ahead counts once, aside thrice: rows and columns are kept.
        let cost = |to: egui::Vec2| {
            let ahead = to.dot(way);
            (ahead > 1.0).then_some(ahead + 3.0 * (to - ahead * way).length())
        };
        let costs = all.into_iter().filter_map(|i| Some((cost(buttons[i].0.center() - from)?, i)));
        if let Some((_, next)) = costs.min_by(|a, b| a.0.total_cmp(&b.0)) {
            self.focus = Some(next);
        }
    }

    /// What the marked button asks for.
    pub fn focused(&self, buttons: &[(Rect, Request)]) -> Option<Request> {
        self.focus.and_then(|focus| buttons.get(focus)).map(|(_, request)| *request)
    }

    /// Draws it; `buttons` are what can be pressed.
    pub fn paint(&mut self, page: &Canvas, scene: &Scene, buttons: &mut Vec<(Rect, Request)>) {
        let everything = page.painter.clip_rect();
        let paper = if page.reading.contrast { Color32::WHITE } else { PAPER.gamma_multiply(0.97) };
        page.painter.rect_filled(everything, 0.0, paper);
        let back = self.back_button(page, scene, buttons);
        let bar = settings_bar(page, scene, buttons);
        let room = page.picture.with_min_y(back.bottom() + 0.5 * page.em).with_max_y(bar - page.em);
        let (label, tiles) = if page.is_tall() {
            let y = room.top() + (1.0 - LABEL_SHARE) * room.height();
            (room.with_min_y(y + page.em), room.with_max_y(y))
        } else {
            let x = room.left() + LABEL_SHARE * room.width();
            (room.with_max_x(x - 2.0 * page.em), room.with_min_x(x))
        };
        wall_text(page, scene, label);
        self.exhibit_tiles(page, scene, tiles, buttons);
        if let Some((rect, _)) = self.focus.and_then(|focus| buttons.get(focus)) {
            page.focus_ring(*rect);
        }
        buttons.push((everything, Request::Nothing));
    }

    /// The way back, top right, with the arc of the countdown.
    fn back_button(&self, page: &Canvas, scene: &Scene, buttons: &mut Vec<(Rect, Request)>) -> Rect {
        let corner = page.picture.right_top() + vec2(0.0, page.button);
        let sign = page.icon_button(corner, "\u{00d7}");
        let left = (self.closes_s - (scene.time - self.last_input)) / COUNTDOWN;
        if left < 1.0 {
            page.arc(sign.center(), 0.42 * page.button, left.clamp(0.0, 1.0) as f32, VERMILION);
        }
        let said = words(scene.language).back;
        let at = pos2(sign.left() - 0.4 * page.em, sign.center().y);
        let text = page.text(at, Align2::RIGHT_CENTER, said, 0.85, INK, f32::INFINITY);
        let whole = sign.union(text);
        buttons.push((whole, Request::Menu));
        whole
    }

    /// The works, in tiles under the headings of their groups.
    fn exhibit_tiles(&mut self, page: &Canvas, scene: &Scene, room: Rect, buttons: &mut Vec<(Rect, Request)>) {
        let columns = if page.is_tall() { COLUMNS.1 } else { COLUMNS.0 };
        let gap = page.em;
        let width = (room.width() - gap * (columns - 1) as f32) / columns as f32;
        let size = vec2(width, THUMBNAIL_ASPECT * width + 2.2 * page.em);
        let turning = page.button + gap;
        let ids: Vec<&str> = scene.tiles.iter().map(|tile| tile.id.as_str()).collect();
        let within =
            |height: f32| paginate(rows(&ids, scene.groups, columns), height + gap, HEADING_EM * page.em, size.y + gap);
        // Where all works have room on one leaf there is nothing to turn.
        let whole = Some(within(room.height())).filter(|leaves| leaves.len() == 1);
        let all = whole.unwrap_or_else(|| within(room.height() - turning));
        self.page_count = all.len();
        self.page_index = self.page_index.min(self.page_count.saturating_sub(1));
        let mut y = room.top();
        for row in all.get(self.page_index).into_iter().flatten() {
            match row {
                Row::Heading(group) => {
                    let text = heading(&scene.groups[*group], scene.language);
                    let at = pos2(room.left(), y + (HEADING_EM - 0.5) * page.em);
                    page.text(at, Align2::LEFT_BOTTOM, text, 1.0, INK, room.width());
                    y += HEADING_EM * page.em;
                }
                Row::Exhibits(works) => {
                    for (column, &index) in works.iter().enumerate() {
                        let at = pos2(room.left() + column as f32 * (size.x + gap), y);
                        tile(page, &scene.tiles[index], Rect::from_min_size(at, size));
                        buttons.push((Rect::from_min_size(at, size), Request::Work(index)));
                    }
                    y += size.y + gap;
                }
            }
        }
        if self.page_count > 1 {
            let corner = pos2(room.right(), room.bottom());
            let next = page.icon_button(corner, "\u{203a}");
            buttons.push((next, Request::Leaf(1)));
            let said = format!("{} / {}", self.page_index + 1, self.page_count);
            let at = pos2(next.left() - 0.5 * gap, next.center().y);
            let count = page.text(at, Align2::RIGHT_CENTER, &said, 0.85, SOFT_INK, f32::INFINITY);
            let before = page.icon_button(pos2(count.left() - 0.5 * gap, corner.y), "\u{2039}");
            buttons.push((before, Request::Leaf(-1)));
        }
    }
}

/// A work's picture and, below it, its title; the one on show is framed.
fn tile(page: &Canvas, tile: &Tile, room: Rect) {
    let picture = room.with_max_y(room.top() + THUMBNAIL_ASPECT * room.width());
    match tile.picture {
        Some(texture) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            page.painter.image(texture, picture, whole, Color32::WHITE);
        }
        None => {
            page.painter.rect_filled(picture, 0.0, SOFT_INK.gamma_multiply(0.15));
        }
    }
    if tile.shown {
        page.painter.rect_stroke(picture, 0.0, Stroke::new(0.2 * page.em, VERMILION), StrokeKind::Outside);
    }
    let title = page.layout(&tile.title, 0.85, INK, room.width());
    let x = if is_right_to_left(&tile.title) { picture.right() - title.size().x } else { picture.left() };
    page.painter.galley(pos2(x, picture.bottom() + 0.3 * page.em), title, INK);
}

/// Title, maker, the wall text, and how the work is played: as large as there is room for.
fn wall_text(page: &Canvas, scene: &Scene, room: Rect) {
    let own = words(scene.language);
    let Some(label) = scene.exhibit.labels.get(scene.language) else { return };
    let invite = if scene.breath_input.is_active { own.invite } else { "" };
    let hold = own.how(scene.accessibility);
    let play = [invite, own.aim, hold, own.take];
    let parts: Vec<(&str, f32, f32)> = [(label.title.as_str(), 1.5, 0.2), (label.maker.as_str(), 0.8, 1.0)]
        .into_iter()
        .chain([(label.body.trim(), 0.95, 1.2)])
        .chain(play.into_iter().map(|line| (line, 0.9, 0.35)))
        .chain([
            (if scene.breath_input.is_active { own.privacy } else { "" }, SMALL_TEXT_EM, 0.6),
            (scene.exhibit.credit.notice.trim(), SMALL_TEXT_EM, 0.0),
        ])
        .filter(|(text, ..)| !text.is_empty())
        .collect();
    let set = |scale: f32| -> Vec<_> {
        let one = |(text, size, space): &(&str, f32, f32)| {
            (page.layout(text, (scale * size).max(SMALL_TEXT_EM * scale.min(1.0)), INK, room.width()), space * scale * page.em)
        };
        parts.iter().map(one).collect()
    };
    let mut scale = 1.0;
    let mut lines = set(scale);
    let height = |lines: &Vec<(std::sync::Arc<egui::Galley>, f32)>| -> f32 {
        lines.iter().map(|(galley, space)| galley.size().y + space).sum()
    };
    while height(&lines) > room.height() && scale > 0.5 {
        scale *= 0.94;
        lines = set(scale);
    }
    let from_right = is_right_to_left(&label.body);
    let mut y = room.top();
    for (galley, space) in lines {
        let next = y + galley.size().y + space;
        // What is read from the right begins at the column's right edge.
        let x = if from_right { room.right() - galley.size().x } else { room.left() };
        page.painter.galley(pos2(x, y), galley, INK);
        y = next;
    }
}

/// Something to press on the lower edge.
enum Item<'a> {
    Label(&'a str, bool),
    Icon(&'a str),
}

/// Languages, volume, type and microphone along the lower edge, in as many rows as they need; returns their top.
fn settings_bar(page: &Canvas, scene: &Scene, buttons: &mut Vec<(Rect, Request)>) -> f32 {
    let own = words(scene.language);
    let mut items: Vec<(Item, Request)> = Vec::new();
    if let Some(speaks) = scene.sound.reads_aloud {
        items.push((Item::Label(own.speak, speaks), Request::Speak));
    }
    if scene.breath_input.has_microphone {
        items.push((Item::Label(own.ear, scene.breath_input.microphone_on), Request::Listen));
    }
    items.push((Item::Label(own.large, scene.accessibility.reading.large), Request::Large));
    items.push((Item::Label(own.contrast, scene.accessibility.reading.contrast), Request::Contrast));
    items.push((Item::Label(own.press_once, scene.accessibility.press_once), Request::PressOnce));
    items.push((Item::Label(own.dwell, scene.accessibility.dwell), Request::Dwell));
    items.push((Item::Label(own.calm, scene.accessibility.calm), Request::Calm));
    items.push((Item::Label(own.round, scene.accessibility.round), Request::Round));
    if scene.sound.has_volume_control {
        items.push((Item::Icon("\u{2212}"), Request::Louder(-1)));
        items.push((Item::Icon("+"), Request::Louder(1)));
    }
    if scene.languages.len() > 1 {
        let languages = scene.languages.iter().enumerate();
        items.extend(
            languages.map(|(i, code)| (Item::Label(language_name(code), code == scene.language), Request::Language(i))),
        );
    }
    let mut corner = page.picture.right_bottom();
    for (item, request) in items.into_iter().rev() {
        let width = match item {
            Item::Label(text, _) => page.label_size(text).x,
            Item::Icon(_) => page.button,
        };
        if corner.x - width < page.picture.left() && corner.x < page.picture.right() {
            corner = pos2(page.picture.right(), corner.y - page.button - 0.3 * page.em);
        }
        let rect = match item {
            Item::Label(text, on) => page.label_button(corner, text, on),
            Item::Icon(sign) => page.icon_button(corner, sign),
        };
        corner.x = rect.left();
        buttons.push((rect, request));
    }
    corner.y - page.button
}

/// The works as tiles, their pictures taken over by the panel library once.
pub fn tiles(
    context: &egui::Context,
    works: &[Work],
    pictures: &mut Vec<(String, egui::TextureHandle)>,
    shown: &Path,
    language: &str,
) -> Vec<Tile> {
    let tile = |work: &Work| {
        let known = pictures.iter().find(|(id, _)| *id == work.id).map(|(_, texture)| texture.id());
        let picture = known.or_else(|| {
            let pixels = work.thumbnail.as_ref()?;
            let size = [pixels.width() as usize, pixels.height() as usize];
            let image = egui::ColorImage::from_rgba_unmultiplied(size, pixels);
            let texture = context.load_texture(&work.id, image, egui::TextureOptions::LINEAR);
            pictures.push((work.id.clone(), texture));
            pictures.last().map(|(_, texture)| texture.id())
        });
        let title = work.labels.get(language).map_or_else(|| work.id.clone(), |label| label.title.clone());
        Tile { id: work.id.clone(), title, picture, shown: work.folder == shown }
    };
    works.iter().map(tile).collect()
}
