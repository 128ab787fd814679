//! Pictures that show what is wrong with a display.

use egui::{Align2, Color32, FontId, Painter, Rect, Stroke, StrokeKind, pos2, vec2};

use crate::pages::ui_strings::{TextId, UiStrings};

/// Steps of grey.
const STEPS: usize = 17;
/// Levels near black and near white that a well adjusted display distinguishes.
const NEAR: [u8; 5] = [2, 4, 8, 12, 16];

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// From black to white, with squares near both ends.
    Grey,
    /// The outermost pixels, the middle, circles that must be round.
    Edges,
    /// One colour all over: a dead pixel stands out.
    Colour(usize),
}

/// Colours for dead pixels.
const COLOURS: [Color32; 5] = [Color32::BLACK, Color32::WHITE, Color32::RED, Color32::GREEN, Color32::BLUE];

impl Pattern {
    /// Where it begins.
    pub const FIRST: Self = Self::Grey;

    /// The one after it; none after the last.
    pub fn next(self) -> Option<Self> {
        match self {
            Self::Grey => Some(Self::Edges),
            Self::Edges => Some(Self::Colour(0)),
            Self::Colour(index) => Some(Self::Colour(index + 1)).filter(|_| index + 1 < COLOURS.len()),
        }
    }

    /// Draws it over all of `picture`.
    pub fn paint(self, painter: &Painter, picture: Rect, texts: &UiStrings) {
        match self {
            Self::Grey => grey(painter, picture, texts.get(TextId::StaffGreySteps)),
            Self::Edges => edges(painter, picture, texts.get(TextId::StaffEdges)),
            Self::Colour(index) => {
                painter.rect_filled(picture, 0.0, COLOURS[index]);
            }
        }
    }
}

fn grey(painter: &Painter, picture: Rect, caption: &str) {
    let part = |low: f32, high: f32| {
        let x = |share: f32| picture.left() + share * picture.width();
        picture.with_min_x(x(low)).with_max_x(x(high))
    };
    for step in 0..STEPS {
        let level = (255 * step / (STEPS - 1)) as u8;
        let (low, high) = (step as f32 / STEPS as f32, (step + 1) as f32 / STEPS as f32);
        painter.rect_filled(part(low, high), 0.0, Color32::from_gray(level));
    }
    let side = 0.6 * picture.width() / STEPS as f32;
    for (row, near) in NEAR.into_iter().enumerate() {
        let y = picture.top() + (row as f32 + 1.0) * picture.height() / (NEAR.len() as f32 + 1.0);
        for (share, level) in [(0.5 / STEPS as f32, near), (1.0 - 0.5 / STEPS as f32, 255 - near)] {
            let at = pos2(picture.left() + share * picture.width(), y);
            painter.rect_filled(Rect::from_center_size(at, vec2(side, side)), 0.0, Color32::from_gray(level));
        }
    }
    painter.text(
        picture.center_bottom() - vec2(0.0, 24.0),
        Align2::CENTER_BOTTOM,
        caption,
        FontId::proportional(18.0),
        Color32::BLACK,
    );
}

fn edges(painter: &Painter, picture: Rect, caption: &str) {
    painter.rect_filled(picture, 0.0, Color32::from_gray(40));
    let pixel = 1.0 / painter.ctx().pixels_per_point();
    let line = Stroke::new(pixel, Color32::WHITE);
    painter.rect_stroke(picture, 0.0, line, StrokeKind::Inside);
    painter.hline(picture.x_range(), picture.center().y, line);
    painter.vline(picture.center().x, picture.y_range(), line);
    let radius = 0.12 * picture.height();
    let inner = picture.shrink(1.2 * radius);
    let corners = [inner.left_top(), inner.right_top(), inner.left_bottom(), inner.right_bottom(), inner.center()];
    for center in corners {
        painter.circle_stroke(center, radius, Stroke::new(2.0, Color32::WHITE));
    }
    painter.text(
        inner.center() + vec2(0.0, 1.4 * radius),
        Align2::CENTER_TOP,
        caption,
        FontId::proportional(18.0),
        Color32::WHITE,
    );
}
