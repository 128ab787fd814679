//! The page behind "More": the label's text, how to play, the other exhibits, languages and settings.
//!
//! It closes by a button, by a breath, and after half a minute without a touch; a closing arc shows the last ten seconds.
//! Everything on it can be reached by finger, by pointer, and by Tab, arrows and Enter.

use std::path::Path;

use egui::{Align2, Color32, Rect, Stroke, StrokeKind, TextureId, pos2, vec2};

use crate::pages::bidi::is_right_to_left;
use crate::pages::canvas::{Canvas, INK, PAPER, SMALL_TEXT_EM, SOFT_INK, VERMILION};
use crate::pages::groups::{Row, heading, paginate, rows};
use crate::pages::overlay::Scene;
use crate::pages::ui_strings::TextId;
use crate::venue::catalog::CatalogEntry;
use crate::visitor::input::Request;
use soffio_config::PAGE_CLOSES_S;

/// Time of the countdown before it closes, s.
const COUNTDOWN: f64 = 10.0;
/// Columns of tiles on a wide page and on a tall one.
const COLUMNS: (usize, usize) = (3, 2);
/// Height of a thumbnail over its width.
const THUMBNAIL_ASPECT: f32 = 9.0 / 16.0;
/// Height of a group's heading, em.
const HEADING_EM: f32 = 2.2;
/// The label's share of a wide page's width, and of a tall page's height.
const LABEL_SHARE: f32 = 0.36;

/// An exhibit to choose.
pub struct Tile {
    /// Name of its folder.
    pub id: String,
    /// Its title in the current language.
    pub title: String,
    /// Its picture.
    pub picture: Option<TextureId>,
    /// Is it the one on show?
    pub shown: bool,
}

/// State of the page.
#[derive(Clone, Debug)]
pub struct Menu {
    /// Is it open?
    pub open: bool,
    /// Time without a touch after which it closes, s.
    pub closes_s: f64,
    page_index: usize,
    page_count: usize,
    focus: Option<usize>,
    /// Count of inputs, and the time of the last one, s.
    activity: u64,
    last_input: f64,
}

impl Default for Menu {
    fn default() -> Self {
        Self {
            open: false,
            closes_s: PAGE_CLOSES_S,
            page_index: 0,
            page_count: 0,
            focus: None,
            activity: 0,
            last_input: 0.0,
        }
    }
}

impl Menu {
    /// Opens it, or closes it.
    pub fn toggle(&mut self) {
        let (open, closes_s) = (!self.open, self.closes_s);
        *self = Self { open, closes_s, last_input: f64::NEG_INFINITY, ..Self::default() };
    }

    /// Closes it, and forgets the page of exhibits and the focus.
    pub fn close(&mut self) {
        *self = Self { closes_s: self.closes_s, ..Self::default() };
    }

    /// Turns to another page of exhibits.
    pub fn turn_page(&mut self, by: i32) {
        let leaves = self.page_count.max(1) as i32;
        self.page_index = (self.page_index as i32 + by).rem_euclid(leaves) as usize;
        self.focus = None;
    }

    /// Closes it at a breath, or after its time without an input. `activity` counts inputs.
    pub fn update(&mut self, time: f64, activity: u64, blown: bool) {
        if self.last_input == f64::NEG_INFINITY || activity != self.activity {
            (self.last_input, self.activity) = (time, activity);
        }
        if self.open && (blown || time - self.last_input > self.closes_s) {
            self.toggle();
        }
    }

    /// Does it show its countdown?
    pub fn shows_countdown(&self, time: f64) -> bool {
        self.open && time - self.last_input > self.closes_s - COUNTDOWN
    }

    /// Moves the keyboard focus to the next button in a direction (right and down). The first key shows the focus.
    pub fn move_focus(&mut self, way: [i32; 2], buttons: &[(Rect, Request)]) {
        let pressable = |i: &usize| buttons[*i].1 != Request::Nothing;
        let all: Vec<usize> = (0..buttons.len()).filter(pressable).collect();
        let Some(from) = self.focus.and_then(|focus| buttons.get(focus)).map(|(rect, _)| rect.center()) else {
            self.focus = all.first().copied();
            return;
        };
        let way = vec2(way[0] as f32, way[1] as f32);
        // Distance aside counts three times, so that the focus stays in its row or column.
        let cost = |to: egui::Vec2| {
            let ahead = to.dot(way);
            (ahead > 1.0).then_some(ahead + 3.0 * (to - ahead * way).length())
        };
        let costs = all.into_iter().filter_map(|i| Some((cost(buttons[i].0.center() - from)?, i)));
        if let Some((_, next)) = costs.min_by(|a, b| a.0.total_cmp(&b.0)) {
            self.focus = Some(next);
        }
    }

    /// The request of the focused button.
    pub fn focused(&self, buttons: &[(Rect, Request)]) -> Option<Request> {
        self.focus.and_then(|focus| buttons.get(focus)).map(|(_, request)| *request)
    }

    /// Draws it, and adds its buttons to `buttons`.
    pub fn paint(&mut self, canvas: &Canvas, scene: &Scene, buttons: &mut Vec<(Rect, Request)>) {
        let everything = canvas.painter.clip_rect();
        let paper = if canvas.reading.contrast { Color32::WHITE } else { PAPER.gamma_multiply(0.97) };
        canvas.painter.rect_filled(everything, 0.0, paper);
        let back = self.back_button(canvas, scene, buttons);
        let bar = settings_bar(canvas, scene, buttons);
        let area = canvas.picture.with_min_y(back.bottom() + 0.5 * canvas.em).with_max_y(bar - canvas.em);
        let (label, tiles) = if canvas.is_tall() {
            let y = area.top() + (1.0 - LABEL_SHARE) * area.height();
            (area.with_min_y(y + canvas.em), area.with_max_y(y))
        } else {
            let x = area.left() + LABEL_SHARE * area.width();
            (area.with_max_x(x - 2.0 * canvas.em), area.with_min_x(x))
        };
        wall_text(canvas, scene, label);
        self.exhibit_tiles(canvas, scene, tiles, buttons);
        if let Some((rect, _)) = self.focus.and_then(|focus| buttons.get(focus)) {
            canvas.focus_ring(*rect);
        }
        buttons.push((everything, Request::Nothing));
    }

    /// The button that closes the page, top right, with the countdown's arc.
    fn back_button(&self, canvas: &Canvas, scene: &Scene, buttons: &mut Vec<(Rect, Request)>) -> Rect {
        let corner = canvas.picture.right_top() + vec2(0.0, canvas.button);
        let icon = canvas.icon_button(corner, "\u{00d7}");
        let left = (self.closes_s - (scene.time - self.last_input)) / COUNTDOWN;
        if left < 1.0 {
            canvas.arc(icon.center(), 0.42 * canvas.button, left.clamp(0.0, 1.0) as f32, VERMILION);
        }
        let said = scene.texts().get(TextId::Back);
        let at = pos2(icon.left() - 0.4 * canvas.em, icon.center().y);
        let text = canvas.text(at, Align2::RIGHT_CENTER, said, 0.85, INK, f32::INFINITY);
        let whole = icon.union(text);
        buttons.push((whole, Request::Menu));
        whole
    }

    /// The exhibits as tiles under the headings of their groups.
    fn exhibit_tiles(&mut self, canvas: &Canvas, scene: &Scene, area: Rect, buttons: &mut Vec<(Rect, Request)>) {
        let columns = if canvas.is_tall() { COLUMNS.1 } else { COLUMNS.0 };
        let gap = canvas.em;
        let width = (area.width() - gap * (columns - 1) as f32) / columns as f32;
        let size = vec2(width, THUMBNAIL_ASPECT * width + 2.2 * canvas.em);
        let turn_buttons = canvas.button + gap;
        let ids: Vec<&str> = scene.tiles.iter().map(|tile| tile.id.as_str()).collect();
        let paginated = |height: f32| {
            paginate(rows(&ids, scene.groups, columns), height + gap, HEADING_EM * canvas.em, size.y + gap)
        };
        // If all exhibits fit on one page, it needs no buttons to turn.
        let whole = Some(paginated(area.height())).filter(|pages| pages.len() == 1);
        let all = whole.unwrap_or_else(|| paginated(area.height() - turn_buttons));
        self.page_count = all.len();
        self.page_index = self.page_index.min(self.page_count.saturating_sub(1));
        let mut y = area.top();
        for row in all.get(self.page_index).into_iter().flatten() {
            match row {
                Row::Heading(group) => {
                    let text = heading(&scene.groups[*group], scene.language);
                    let at = pos2(area.left(), y + (HEADING_EM - 0.5) * canvas.em);
                    canvas.text(at, Align2::LEFT_BOTTOM, text, 1.0, INK, area.width());
                    y += HEADING_EM * canvas.em;
                }
                Row::Exhibits(exhibits) => {
                    for (column, &index) in exhibits.iter().enumerate() {
                        let at = pos2(area.left() + column as f32 * (size.x + gap), y);
                        tile(canvas, &scene.tiles[index], Rect::from_min_size(at, size));
                        buttons.push((Rect::from_min_size(at, size), Request::Exhibit(index)));
                    }
                    y += size.y + gap;
                }
            }
        }
        if self.page_count > 1 {
            let corner = pos2(area.right(), area.bottom());
            let next = canvas.icon_button(corner, "\u{203a}");
            buttons.push((next, Request::Page(1)));
            let said = format!("{} / {}", self.page_index + 1, self.page_count);
            let at = pos2(next.left() - 0.5 * gap, next.center().y);
            let count = canvas.text(at, Align2::RIGHT_CENTER, &said, 0.85, SOFT_INK, f32::INFINITY);
            let before = canvas.icon_button(pos2(count.left() - 0.5 * gap, corner.y), "\u{2039}");
            buttons.push((before, Request::Page(-1)));
        }
    }
}

/// An exhibit's thumbnail and, below it, its title; the one on show has a frame.
fn tile(canvas: &Canvas, tile: &Tile, area: Rect) {
    let picture = area.with_max_y(area.top() + THUMBNAIL_ASPECT * area.width());
    match tile.picture {
        Some(texture) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            canvas.painter.image(texture, picture, whole, Color32::WHITE);
        }
        None => {
            canvas.painter.rect_filled(picture, 0.0, SOFT_INK.gamma_multiply(0.15));
        }
    }
    if tile.shown {
        canvas.painter.rect_stroke(picture, 0.0, Stroke::new(0.2 * canvas.em, VERMILION), StrokeKind::Outside);
    }
    let title = canvas.layout(&tile.title, 0.85, INK, area.width());
    let x = if is_right_to_left(&tile.title) { picture.right() - title.size().x } else { picture.left() };
    canvas.painter.galley(pos2(x, picture.bottom() + 0.3 * canvas.em), title, INK);
}

/// Title, maker, the wall text, and how to play, as large as the area allows.
fn wall_text(canvas: &Canvas, scene: &Scene, area: Rect) {
    let texts = scene.texts();
    let Some(label) = scene.exhibit.labels.get(scene.language) else { return };
    let invite = if scene.breath_input.is_active { texts.get(TextId::Invite) } else { "" };
    let hold = texts.get(scene.how_to_blow());
    let play = [invite, texts.get(TextId::Aim), hold, scene.how_to_take()];
    let parts: Vec<(&str, f32, f32)> = [(label.title.as_str(), 1.5, 0.2), (label.maker.as_str(), 0.8, 1.0)]
        .into_iter()
        .chain([(label.body.trim(), 0.95, 1.2)])
        .chain(play.into_iter().map(|line| (line, 0.9, 0.35)))
        .chain([
            (if scene.breath_input.is_active { texts.get(TextId::Privacy) } else { "" }, SMALL_TEXT_EM, 0.6),
            (scene.exhibit.credit.notice.trim(), SMALL_TEXT_EM, 0.0),
        ])
        .filter(|(text, ..)| !text.is_empty())
        .collect();
    let set = |scale: f32| -> Vec<_> {
        let one = |(text, size, space): &(&str, f32, f32)| {
            (
                canvas.layout(text, (scale * size).max(SMALL_TEXT_EM * scale.min(1.0)), INK, area.width()),
                space * scale * canvas.em,
            )
        };
        parts.iter().map(one).collect()
    };
    let mut scale = 1.0;
    let mut lines = set(scale);
    let height = |lines: &Vec<(std::sync::Arc<egui::Galley>, f32)>| -> f32 {
        lines.iter().map(|(galley, space)| galley.size().y + space).sum()
    };
    while height(&lines) > area.height() && scale > 0.5 {
        scale *= 0.94;
        lines = set(scale);
    }
    let from_right = is_right_to_left(&label.body);
    let mut y = area.top();
    for (galley, space) in lines {
        let next = y + galley.size().y + space;
        // Right-to-left text begins at the column's right edge.
        let x = if from_right { area.right() - galley.size().x } else { area.left() };
        canvas.painter.galley(pos2(x, y), galley, INK);
        y = next;
    }
}

/// A button of the settings bar.
enum Item<'a> {
    /// A text, underlined if it is switched on.
    Label(&'a str, bool),
    Icon(&'a str),
}

/// Settings and languages along the lower edge, in as many rows as they need. Returns their top.
fn settings_bar(canvas: &Canvas, scene: &Scene, buttons: &mut Vec<(Rect, Request)>) -> f32 {
    let (texts, settings) = (scene.texts(), scene.accessibility);
    let name = |id| texts.get(id);
    let mut items: Vec<(Item, Request)> = Vec::new();
    if let Some(reads_aloud) = scene.sound.reads_aloud {
        items.push((Item::Label(name(TextId::ReadAloud), reads_aloud), Request::ReadAloud));
    }
    if scene.breath_input.has_microphone {
        items
            .push((Item::Label(name(TextId::Microphone), scene.breath_input.microphone_on), Request::ToggleMicrophone));
    }
    items.push((Item::Label(name(TextId::LargeText), settings.text.large), Request::Large));
    items.push((Item::Label(name(TextId::HighContrast), settings.text.contrast), Request::Contrast));
    items.push((Item::Label(name(TextId::PressOnce), settings.press_once), Request::PressOnce));
    items.push((Item::Label(name(TextId::Dwell), settings.dwell), Request::Dwell));
    items.push((Item::Label(name(TextId::LessMotion), settings.reduced_motion), Request::ReducedMotion));
    items.push((Item::Label(name(TextId::LookRound), settings.look_around), Request::LookAround));
    if scene.sound.has_volume_control {
        items.push((Item::Icon("\u{2212}"), Request::Louder(-1)));
        items.push((Item::Icon("+"), Request::Louder(1)));
    }
    if scene.languages.len() > 1 {
        for (i, code) in scene.languages.iter().enumerate() {
            let name = scene.translations.language_name(code);
            items.push((Item::Label(name, code == scene.language), Request::Language(i)));
        }
    }
    let mut corner = canvas.picture.right_bottom();
    for (item, request) in items.into_iter().rev() {
        let width = match item {
            Item::Label(text, _) => canvas.label_size(text).x,
            Item::Icon(_) => canvas.button,
        };
        if corner.x - width < canvas.picture.left() && corner.x < canvas.picture.right() {
            corner = pos2(canvas.picture.right(), corner.y - canvas.button - 0.3 * canvas.em);
        }
        let rect = match item {
            Item::Label(text, on) => canvas.label_button(corner, text, on),
            Item::Icon(sign) => canvas.icon_button(corner, sign),
        };
        corner.x = rect.left();
        buttons.push((rect, request));
    }
    corner.y - canvas.button
}

/// The exhibits as tiles. Each thumbnail is loaded into a texture once.
pub fn tiles(
    context: &egui::Context,
    exhibits: &[CatalogEntry],
    pictures: &mut Vec<(String, egui::TextureHandle)>,
    on_show: &Path,
    language: &str,
) -> Vec<Tile> {
    let tile = |exhibit: &CatalogEntry| {
        let known = pictures.iter().find(|(id, _)| *id == exhibit.id).map(|(_, texture)| texture.id());
        let picture = known.or_else(|| {
            let pixels = exhibit.thumbnail.as_ref()?;
            let size = [pixels.width() as usize, pixels.height() as usize];
            let image = egui::ColorImage::from_rgba_unmultiplied(size, pixels);
            let texture = context.load_texture(&exhibit.id, image, egui::TextureOptions::LINEAR);
            pictures.push((exhibit.id.clone(), texture));
            pictures.last().map(|(_, texture)| texture.id())
        });
        let title = exhibit.labels.get(language).map_or_else(|| exhibit.id.clone(), |label| label.title.clone());
        Tile { id: exhibit.id.clone(), title, picture, shown: exhibit.folder == on_show }
    };
    exhibits.iter().map(tile).collect()
}
