//! Drawing surface of the pages: type, lines, buttons and arcs, sized by the picture's height.
//!
//! Type stands on a pale ground and has a contrast of at least 4.5 : 1 over any picture. Lines have a pale halo and at least
//! 3 : 1. With high contrast, type is nearly black on white.

use std::sync::Arc;

use egui::text::{ByteIndex, LayoutJob, LayoutSection, TextFormat, TextWrapping};
use egui::{Align2, Color32, FontId, Galley, Painter, Pos2, Rect, Stroke, StrokeKind, Vec2, pos2, vec2};

use crate::pages::bidi;
use crate::visitor::accessibility::TextSettings;

/// Side of a button on the glass, mm (NHM London, multimedia access guidelines).
pub const BUTTON_MM: f32 = 15.0;
/// Smallest type, em: 2.9 mm on a 1280 x 720 picture of the usual screen.
pub const SMALL_TEXT_EM: f32 = 0.72;
/// Size of large type over the usual: 18 points for 14 (WCAG 2.2, large text).
const LARGE_TEXT_FACTOR: f32 = 1.3;

/// Colour of type.
pub const INK: Color32 = Color32::from_rgb(38, 36, 34);
/// Colour of secondary type: 4.5 : 1 on the floor too, the darkest ground (luminance 0.34).
pub const SOFT_INK: Color32 = Color32::from_rgb(52, 50, 48);
/// The accent colour.
pub const VERMILION: Color32 = Color32::from_rgb(190, 44, 22);
/// Halo around lines.
pub const HALO: Color32 = Color32::from_rgba_premultiplied(170, 170, 168, 170);
/// Opacity of the ground under type: over black it leaves 9 : 1.
const PAPER_OPACITY: f32 = 0.85;
/// Ground under type.
pub const PAPER: Color32 = Color32::from_rgb(246, 244, 241);

/// Drawing surface of a page.
pub struct Canvas<'a> {
    /// Painter of the panel library.
    pub painter: &'a Painter,
    /// The picture, without its margin.
    pub picture: Rect,
    /// Height of type, points.
    pub em: f32,
    /// Least side of a button, points.
    pub button: f32,
    /// The visitor's reading settings.
    pub reading: TextSettings,
}

impl<'a> Canvas<'a> {
    /// A canvas over all of `picture`, on glass with `points_per_mm`.
    pub fn new(painter: &'a Painter, picture: Rect, points_per_mm: f32, reading: TextSettings) -> Self {
        let em = picture.height().min(picture.width() * 0.75) / 45.0;
        let scaled = if reading.large { LARGE_TEXT_FACTOR * em } else { em };
        let button = (2.0 * em).max(BUTTON_MM * points_per_mm);
        Self { painter, picture: picture.shrink(2.0 * em), em: scaled, button, reading }
    }

    /// Is the picture taller than wide?
    pub fn is_tall(&self) -> bool {
        self.picture.height() > self.picture.width()
    }

    /// Lays out type `size` em high in lines of at most `longest` points.
    pub fn layout(&self, text: &str, size: f32, color: Color32, longest: f32) -> Arc<Galley> {
        let color =
            if self.reading.contrast { Color32::BLACK.gamma_multiply(f32::from(color.a()) / 255.0) } else { color };
        let font = FontId::proportional(size * self.em);
        match bidi::has_right_to_left(text) {
            false => self.painter.layout(text.into(), font, color, longest),
            true => self.layout_bidi(text, font, color, longest),
        }
    }

    /// The same for text with right-to-left parts. Lines are aligned at the side where the text begins.
    fn layout_bidi(&self, text: &str, font: FontId, color: Color32, longest: f32) -> Arc<Galley> {
        let format = TextFormat::simple(font.clone(), color);
        let width = |piece: &str| self.painter.layout_no_wrap(piece.into(), font.clone(), color).size().x;
        let lines = bidi::lines(text, longest, width);
        let lengths: Vec<f32> = lines.iter().map(|line| line.iter().map(|piece| width(piece)).sum()).collect();
        let longest = lengths.iter().copied().fold(0.0, f32::max);
        let from_right = bidi::is_right_to_left(text);
        let mut job = LayoutJob { wrap: TextWrapping::no_max_width(), ..LayoutJob::default() };
        for (i, (line, length)) in lines.iter().zip(&lengths).enumerate() {
            if i > 0 {
                job.append("\n", 0.0, format.clone());
            }
            let mut space = if from_right { longest - length } else { 0.0 };
            // Each piece is a section of its own; `append` would join it with the one before. A section is shaped in one
            // direction, and a comma in it would move to the wrong side of its word.
            for piece in line {
                let start = job.text.len();
                job.text.push_str(piece);
                let byte_range = ByteIndex(start)..ByteIndex(job.text.len());
                job.sections.push(LayoutSection { leading_space: space, byte_range, format: format.clone() });
                space = 0.0;
            }
        }
        self.painter.layout_job(job)
    }

    /// Draws type at its anchor, on a ground that keeps it readable over a picture.
    pub fn place(&self, galley: Arc<Galley>, at: Pos2, anchor: Align2, color: Color32) -> Rect {
        let rect = anchor.anchor_size(at, galley.size());
        let opacity = f32::from(color.a()) / 255.0;
        // No higher than the gap to the next line: the ground must not cover earlier type.
        let paper = rect.expand2(vec2(0.3, 0.05) * self.em);
        let sheet = if self.reading.contrast { Color32::WHITE } else { PAPER.gamma_multiply(PAPER_OPACITY) };
        self.painter.rect_filled(paper, 0.2 * self.em, sheet.gamma_multiply(opacity));
        self.painter.galley(rect.min, galley, color);
        rect
    }

    /// Lays out type and draws it at its anchor.
    pub fn text(&self, at: Pos2, anchor: Align2, text: &str, size: f32, color: Color32, longest: f32) -> Rect {
        self.place(self.layout(text, size, color, longest), at, anchor, color)
    }

    /// Draws a line `width` em wide with a pale halo.
    pub fn line(&self, points: Vec<Pos2>, width: f32, color: Color32) {
        self.painter.line(points.clone(), Stroke::new((width + 0.14) * self.em, HALO.gamma_multiply(0.6)));
        self.painter.line(points, Stroke::new((width * self.em).max(1.0), color));
    }

    /// Size of a button with this text, points: at least as large as a fingertip.
    pub fn label_size(&self, text: &str) -> Vec2 {
        let size = self.layout(text, 0.85, INK, f32::INFINITY).size();
        vec2((size.x + self.em).max(self.button), self.button.max(size.y + 0.6 * self.em))
    }

    /// Draws a button with a text, given its lower right corner; `on` underlines the text.
    pub fn label_button(&self, right_bottom: Pos2, text: &str, on: bool) -> Rect {
        let color = if on { INK } else { SOFT_INK };
        let galley = self.layout(text, 0.85, color, f32::INFINITY);
        let size = self.label_size(text);
        let rect = Rect::from_min_size(right_bottom - size, size);
        let set = self.place(galley, rect.center(), Align2::CENTER_CENTER, color);
        if on {
            let y = set.bottom() + 0.15 * self.em;
            self.painter.hline(set.left()..=set.right(), y, Stroke::new(0.1 * self.em, VERMILION));
        }
        rect
    }

    /// Draws a button with a sign in a circle, given its lower right corner.
    pub fn icon_button(&self, right_bottom: Pos2, sign: &str) -> Rect {
        let size = vec2(self.button, self.button);
        let rect = Rect::from_min_size(right_bottom - size, size);
        let ink = if self.reading.contrast { Color32::BLACK } else { SOFT_INK };
        self.painter.circle(
            rect.center(),
            0.42 * self.button,
            PAPER.gamma_multiply(0.6),
            Stroke::new(0.08 * self.em, ink),
        );
        let galley = self.layout(sign, 1.1, ink, f32::INFINITY);
        self.painter.galley(rect.center() - 0.5 * galley.size(), galley, ink);
        rect
    }

    /// Draws the frame of the focused button.
    pub fn focus_ring(&self, rect: Rect) {
        self.painter.rect_stroke(
            rect.expand(0.1 * self.em),
            0.3 * self.em,
            Stroke::new(0.22 * self.em, VERMILION),
            StrokeKind::Outside,
        );
    }

    /// Draws an arc clockwise from the top; `share` of the whole circle.
    pub fn arc(&self, center: Pos2, radius: f32, share: f32, color: Color32) {
        let corners = (64.0 * share).ceil().max(2.0);
        let at = |i: f32| {
            let (s, c) = (std::f32::consts::TAU * share * i / corners).sin_cos();
            pos2(center.x + radius * s, center.y - radius * c)
        };
        self.painter.line((0..=corners as u32).map(|i| at(i as f32)).collect(), Stroke::new(0.2 * self.em, color));
    }
}
