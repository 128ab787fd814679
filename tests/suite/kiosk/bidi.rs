//! Text that is read from the right, alone and among words from the left.

use std::sync::Arc;

use soffio_exhibit::Label;
use soffio_kiosk::egui;
use soffio_kiosk::pages::bidi::{has_right_to_left, is_right_to_left, lines};
use soffio_kiosk::pages::canvas::{Canvas, INK};
use soffio_kiosk::pages::fonts::{self, Script};
use soffio_kiosk::visitor::accessibility::TextSettings;

use super::glass::Glass;
use super::pages::{Before, load};

/// All on one line, its pieces parted by bars.
fn set(text: &str) -> String {
    let lines = lines(text, f32::INFINITY, |piece| piece.chars().count() as f32);
    assert_eq!(lines.len(), 1, "{lines:?}");
    lines[0].join("|")
}

#[test]
fn words_from_the_right_stand_in_reverse_and_are_whole() {
    assert_eq!(set("שלום עולם"), "עולם| |שלום");
    // A mark belongs to its letter, a joined word stays one piece.
    assert_eq!(set("שָׁלוֹם עולם"), "עולם| |שָׁלוֹם");
    assert_eq!(set("الهواء يحرّكها"), "يحرّكها| |الهواء");
}

#[test]
fn numbers_and_latin_names_among_them_are_read_from_the_left() {
    // Of 1941, the mobile hangs: the number is where a reader from the right expects it, its digits in order.
    assert_eq!(set("משנת 1941 המובייל"), "המובייל| |1941| |משנת");
    assert_eq!(set("מאת Alexander Calder נתלה"), "נתלה| |Alexander Calder| |מאת");
    // A Latin name first does not turn the sentence about: this is UAX 9 with the paragraph's level given.
    assert_eq!(set("Calder בנה מובייל תלוי"), "תלוי| |מובייל| |בנה| |Calder");
    // Arabic-Indic digits are given the shaper reversed, which it turns about.
    assert_eq!(set("عام ١٩٤١ م"), "م| |١٤٩١| |عام");
    // A word from the right within English stays one word within it.
    assert_eq!(set("the word שלום means peace"), "the word |שלום| means peace");
}

#[test]
fn brackets_are_mirrored_and_enclose_what_they_enclosed() {
    assert_eq!(set("מובייל (פלדה) תלוי"), "תלוי| (|פלדה|) |מובייל");
    assert_eq!(set("מובייל (steel) תלוי"), "תלוי| (|steel|) |מובייל");
    assert_eq!(set("גובה 2 × 3 מ׳"), "׳מ".chars().rev().collect::<String>() + "| |3| × |2| |גובה");
    assert_eq!(set("«الهواء»"), "«|الهواء|»");
}

#[test]
fn lines_break_in_the_order_of_reading() {
    let measure = |piece: &str| piece.chars().count() as f32;
    let set = lines("אבג דהו זחט\nיכל", 7.0, measure);
    assert_eq!(set.iter().map(|line| line.join("")).collect::<Vec<_>>(), ["דהו אבג", "זחט", "יכל"]);
    // A word that is longer than the line stands alone.
    assert_eq!(lines("אבגדהוזחטי כל", 4.0, measure).len(), 2);
    // A run from the left that is broken goes on from the left on the next line.
    let set = lines("של Alexander Calder כאן", 12.0, measure);
    assert_eq!(set.iter().map(|line| line.join("")).collect::<Vec<_>>(), ["Alexander של", "כאן Calder"]);
}

#[test]
fn what_is_read_from_the_left_is_left_alone() {
    assert!(!has_right_to_left("Ein Mobile (1941), 모빌, モビール"));
    assert!(has_right_to_left("Ein מובייל"));
    assert!(
        is_right_to_left("אחרי Christiaan Huygens")
            && !is_right_to_left("The word שלום means peace")
            && is_right_to_left("Calder בנה מובייל תלוי")
    );
    assert!(!is_right_to_left("1941"));
}

/// Whether this system has fonts for the scripts that are read from the right.
fn from_the_right() -> Option<()> {
    let missing = [Script::Hebrew, Script::Arabic].into_iter().find(|script| fonts::find(*script).is_none());
    let found = missing.map_or(Ok(()), |script| Err(format!("none has {script:?}")));
    crate::require::require("font for Hebrew and Arabic", found)
}

/// Type as the kiosk sets it on a page, with this system's fonts; nothing where it has none for these scripts.
fn with_page<T>(then: impl FnOnce(&Canvas) -> T) -> Option<T> {
    from_the_right()?;
    let context = egui::Context::default();
    context.set_fonts(fonts::definitions());
    let (mut then, mut made) = (Some(then), None);
    let picture = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1280.0, 720.0));
    let input = egui::RawInput { screen_rect: Some(picture), ..egui::RawInput::default() };
    let mut laid_out = context.run_ui(input, |ui| {
        let painter = ui.ctx().layer_painter(egui::LayerId::background());
        let page = Canvas::new(&painter, picture, 2.0, TextSettings::default());
        made = then.take().map(|then| then(&page));
    });
    laid_out.textures_delta.clear();
    made
}

/// The letters of each row as they stand on the glass, from left to right, and where the row ends, points.
fn on_the_glass(galley: &egui::Galley) -> Vec<(String, f32)> {
    let row = |row: &egui::epaint::text::PlacedRow| {
        let mut glyphs: Vec<(f32, char)> =
            row.glyphs.iter().filter(|glyph| glyph.advance_width > 0.0).map(|glyph| (glyph.pos.x, glyph.chr)).collect();
        glyphs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let end = row.glyphs.iter().map(|glyph| glyph.pos.x + glyph.advance_width).fold(0.0, f32::max);
        (glyphs.into_iter().map(|(_, c)| c).collect::<String>(), row.pos.x + end)
    };
    galley.rows.iter().map(row).collect()
}

#[test]
fn letters_stand_on_the_glass_as_a_reader_from_the_right_expects_them() {
    with_page(|page| {
        let set = |text: &str| on_the_glass(&page.layout(text, 1.0, INK, 600.0))[0].0.clone();
        // Reversed letter by letter, but for the number and the name.
        assert_eq!(set("שלום עולם"), "םלוע םולש");
        assert_eq!(set("משנת 1941 המובייל"), "לייבומה 1941 תנשמ");
        assert_eq!(set("מאת Alexander Calder נתלה"), "הלתנ Alexander Calder תאמ");
        assert!(set("عام ١٦٥٦").starts_with("١٦٥٦"), "{}", set("عام ١٦٥٦"));
        // Arabic's letters are joined: three together are narrower than three alone.
        let width = |text: &str| page.layout(text, 1.0, INK, 600.0).size().x;
        assert!(width("ببب") < 0.8 * 3.0 * width("ب"), "{} {}", width("ببب"), width("ب"));
        // Signs of Arabic come out of the font of its letters: they stand after their word all the same.
        assert_eq!(set("كتب، قلم"), "ملق ،بتك");
        assert_eq!(set("كيف؟ نعم"), "معن ؟فيك");
        // Left-to-right text is unchanged.
        assert_eq!(set("By 1941 (steel)"), "By 1941 (steel)");
    });
}

#[test]
fn lines_from_the_right_end_at_one_edge_and_keep_their_length() {
    /// Of a point: positions on the glass are rounded to pixels.
    const PIXEL: f32 = 1.5;
    with_page(|page| {
        let text = "המובייל של Alexander Calder (1941) תלוי באוויר, וכל נשיפה מזיזה אותו אט אט סביב צירו";
        let galley = page.layout(text, 1.0, INK, 220.0);
        let rows = on_the_glass(&galley);
        assert!(rows.len() >= 3, "{rows:?}");
        assert!(galley.size().x <= 220.0 + PIXEL, "{}", galley.size().x);
        assert!(rows.iter().all(|(_, end)| (end - rows[0].1).abs() < PIXEL), "{rows:?}");
        assert!(rows[0].0.ends_with("לייבומה"), "the first word is on the right of the first line: {rows:?}");
    });
}

#[test]
fn a_label_in_hebrew_or_arabic_is_offered_and_drawn() {
    let Some(mut glass) = Glass::new() else { return };
    let Some(()) = from_the_right() else { return };
    let mut exhibit = load("pendulum");
    let label = |title: &str, maker: &str, body: &str| Label {
        title: title.into(),
        maker: maker.into(),
        body: body.into(),
        alt: String::new(),
        text: vec![("invite".into(), body.split('.').next().unwrap_or_default().into())],
        caption: Vec::new(),
    };
    let labels = &mut Arc::make_mut(&mut exhibit).labels;
    labels.languages.push((
        "he".into(),
        label("מטוטלת (1656)", "אחרי Christiaan Huygens", "נשפו בעדינות. מטוטלת באורך 0.994 מ׳ מתנדנדת פעם בשנייה."),
    ));
    labels.languages.push((
        "ar".into(),
        label("البندول (١٦٥٦)", "بعد Christiaan Huygens", "انفخوا برفق. البندول بطول 0.994 م يتأرجح مرة كل ثانية."),
    ));
    let mut visitor = Before::new(&exhibit, [1280.0, 720.0]);
    glass.learn(&mut visitor.lay_out());
    for language in ["he", "ar"] {
        for open in [false, true] {
            (visitor.language, visitor.menu.open) = (language.into(), open);
            let mut laid_out = visitor.lay_out();
            for _ in 0..30 {
                glass.learn(&mut laid_out);
                (visitor.time, visitor.activity) = (visitor.time + 0.25, visitor.activity + 1);
                laid_out = visitor.lay_out();
            }
            glass.learn(&mut laid_out);
            let wall = image::RgbaImage::from_pixel(1280, 720, image::Rgba([225, 222, 216, 255]));
            let picture = glass.draw(&visitor.context.clone(), &wall, std::mem::take(&mut laid_out.shapes));
            let inked = picture.pixels().filter(|pixel| pixel.0[0] < 120).count();
            assert!(inked > 300, "{language}: {inked} dark pixels");
            if let Some(folder) = std::env::var_os("SOFFIO_PICTURES") {
                let name = format!("{language}-{}.png", if open { "more" } else { "front" });
                picture.save(std::path::Path::new(&folder).join(name)).expect("a folder that can be written");
            }
        }
    }
}
