//! Contrast of type as it stands on the glass: measured on rendered pictures, between the pixels of letters and those beside
//! them, never on constants.
//!
//! Each picture is drawn twice, with its letters and without (halos, paper and the work stay). Where the two differ most
//! there is ink; beside it is ground. WCAG 2.2, 1.4.3: (L_ground + 0.05) / (L_ink + 0.05) ≥ 4.5.

use std::path::Path;

use image::RgbaImage;
use soffio_config::Config;
use soffio_kiosk::egui::{self, Rect};
use soffio_kiosk::pages::languages::{languages_without_glyphs, offered};
use soffio_kiosk::pages::ui_strings::TextId;
use soffio_kiosk::staff::Page;
use soffio_kiosk::venue::state::VenueState;
use soffio_kiosk::visitor::accessibility::TextSettings;
use soffio_offline::pictures::Pictures;

use super::glass::{Glass, luminance};
use super::pages::{Before, load, texts};

/// WCAG 2.2, 1.4.3, for type of any size.
const LEAST: f64 = 4.5;
/// Ink is where the difference is at least this share of the greatest in a letter's width: elsewhere pixels are part ground.
const INK: f64 = 0.85;
/// Ground is looked for so far beside ink, pixels.
const BESIDE: i64 = 3;
/// Difference of luminance below which a pixel is no part of a letter.
const NOTHING: f64 = 0.004;

/// A few letters on the glass: their text, and where they are.
struct Letters {
    text: String,
    place: Rect,
}

/// Contrast of a few letters: between their darkest pixels and those beside them; 1 where nothing of them is seen.
fn contrast(with: &RgbaImage, without: &RgbaImage, place: Rect) -> f64 {
    let (width, height) = (i64::from(with.width()), i64::from(with.height()));
    let (x0, x1) = (place.left().floor() as i64, place.right().ceil() as i64);
    let (y0, y1) = (place.top().floor() as i64, place.bottom().ceil() as i64);
    let inside = |x: i64, y: i64| (0..width).contains(&x) && (0..height).contains(&y);
    let at = |picture: &RgbaImage, x: i64, y: i64| luminance(picture.get_pixel(x as u32, y as u32));
    let difference = |x: i64, y: i64| (at(without, x, y) - at(with, x, y)).abs();
    let all = (x0..x1).flat_map(|x| (y0..y1).map(move |y| (x, y))).filter(|(x, y)| inside(*x, *y));
    let all: Vec<(i64, i64, f64)> = all.map(|(x, y)| (x, y, difference(x, y))).collect();
    let most = all.iter().map(|pixel| pixel.2).fold(0.0, f64::max);
    if most < NOTHING {
        return 1.0;
    }
    let ink = all.iter().filter(|pixel| pixel.2 >= INK * most);
    let mut ratios: Vec<f64> = ink
        .filter_map(|&(x, y, _)| {
            let around = (-BESIDE..=BESIDE).flat_map(|dx| (-BESIDE..=BESIDE).map(move |dy| (x + dx, y + dy)));
            let ground: Vec<f64> = around
                .filter(|&(x, y)| inside(x, y) && difference(x, y) < NOTHING)
                .map(|(x, y)| at(with, x, y))
                .collect();
            let ground = (!ground.is_empty()).then(|| ground.iter().sum::<f64>() / ground.len() as f64)?;
            let (a, b) = (ground + 0.05, at(with, x, y) + 0.05);
            Some(a.max(b) / a.min(b))
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
}

/// Letters that a visitor finds, and the picture with and without them.
fn seen(visitor: &mut Before, glass: &mut Glass, picture: &RgbaImage) -> (Vec<Letters>, RgbaImage, RgbaImage) {
    let mut laid_out = visitor.lay_out();
    // The invitation fades in.
    for _ in 0..30 {
        glass.learn(&mut laid_out);
        visitor.time += 0.2;
        visitor.activity += 1;
        laid_out = visitor.lay_out();
    }
    glass.learn(&mut laid_out);
    apart(&visitor.context.clone(), glass, picture, std::mem::take(&mut laid_out.shapes))
}

/// What is laid out over a picture: its letters, a few at a time, and the picture with and without them.
fn apart(
    context: &egui::Context,
    glass: &mut Glass,
    picture: &RgbaImage,
    shapes: Vec<egui::epaint::ClippedShape>,
) -> (Vec<Letters>, RgbaImage, RgbaImage) {
    let letters = |shape: &egui::Shape| match shape {
        // A halo is type too, in a colour of its own.
        egui::Shape::Text(text) => text.override_text_color.is_none(),
        _ => false,
    };
    let mut lines = Vec::new();
    for clipped in &shapes {
        if let egui::Shape::Text(text) = &clipped.shape
            && letters(&clipped.shape)
        {
            for row in &text.galley.rows {
                let origin = text.pos.to_vec2() + row.pos.to_vec2();
                // A full stop says nothing of a line, and a thin letter alone is half ground. What a ligature has taken
                // in has no width of its own.
                let glyphs: Vec<_> = row.glyphs.iter().filter(|glyph| glyph_is_seen(glyph)).collect();
                let groups = (glyphs.len() / 3).max(1);
                for i in 0..groups {
                    let few = if i + 1 == groups { &glyphs[3 * i..] } else { &glyphs[3 * i..3 * i + 3] };
                    let place = few.iter().map(|glyph| glyph.logical_rect()).reduce(Rect::union);
                    let place = place.map(|place| place.translate(origin));
                    let text = few.iter().map(|glyph| glyph.chr).collect();
                    // What an edge cuts off is not to be read.
                    let whole = place.filter(|place| clipped.clip_rect.contains_rect(*place));
                    lines.extend(whole.map(|place| Letters { text, place }));
                }
            }
        }
    }
    let without = shapes.iter().filter(|clipped| !letters(&clipped.shape)).cloned().collect();
    let with = glass.draw(context, picture, shapes);
    let without = glass.draw(context, picture, without);
    (lines, with, without)
}

fn glyph_is_seen(glyph: &egui::epaint::text::Glyph) -> bool {
    glyph.chr.is_alphanumeric() && glyph.logical_rect().width() > 0.0
}

/// Looks at every page over a work, in these languages; returns what is hard to read, and how much was measured.
fn look(glass: &mut Glass, id: &str, languages: &[&str]) -> (Vec<String>, usize) {
    const SIZE: (u32, u32) = (1280, 720);
    let exhibit = load(id);
    let mut visitor = Before::new(&exhibit, [SIZE.0 as f32, SIZE.1 as f32]);
    let mut pictures = Pictures::new(&exhibit, SIZE).expect("a driver that made a device draws");
    let picture = pictures.draw(&visitor.moment).expect("it draws");
    let (mut bad, mut measured) = (Vec::new(), 0);
    // There are fonts from the first picture on.
    glass.learn(&mut visitor.lay_out());
    let offered =
        offered(&visitor.context, &exhibit.labels, &Config::default(), texts(), &languages_without_glyphs(texts()));
    visitor.captions = exhibit.sounds.iter().filter_map(|sound| sound.caption.clone()).take(2).collect();
    // Where the system has no East Asian font those languages are not offered.
    for language in languages.iter().filter(|code| offered.iter().any(|other| other == **code)) {
        for reading in [TextSettings::default(), TextSettings { large: true, contrast: true }] {
            for open in [false, true] {
                visitor.language = (*language).to_owned();
                (visitor.accessibility.text, visitor.menu.open) = (reading, open);
                let (lines, with, without) = seen(&mut visitor, glass, &picture);
                for line in &lines {
                    let ratio = contrast(&with, &without, line.place);
                    measured += 1;
                    if ratio < LEAST {
                        bad.push(format!(
                            "{id}, {language}, {reading:?}, page open: {open}: {ratio:.2} : 1 for {:?} at {:?}",
                            line.text, line.place
                        ));
                    }
                }
                if let Some(folder) = std::env::var_os("SOFFIO_PICTURES") {
                    let large = if reading.large { "-large" } else { "" };
                    let page = if open { "more" } else { "front" };
                    let name = format!("{id}-{language}-{page}{large}.png");
                    with.save(Path::new(&folder).join(name)).expect("a folder that can be written");
                }
            }
        }
    }
    (bad, measured)
}

/// Text on the cleaning screen, and on a kiosk that reports missing devices.
#[test]
fn type_on_the_screen_that_is_cleaned_and_on_a_deaf_mute_kiosk_has_this_contrast() {
    const SIZE: (u32, u32) = (1280, 720);
    let Some(mut glass) = Glass::new() else { return };
    let exhibit = load("steel-fish");
    let mut visitor = Before::new(&exhibit, [SIZE.0 as f32, SIZE.1 as f32]);
    let mut pictures = Pictures::new(&exhibit, SIZE).expect("a driver that made a device draws");
    let picture = pictures.draw(&visitor.moment).expect("it draws");
    glass.learn(&mut visitor.lay_out());
    let offered =
        offered(&visitor.context, &exhibit.labels, &Config::default(), texts(), &languages_without_glyphs(texts()));
    let on_the_glass = visitor.picture();
    let (mut bad, mut measured) = (Vec::new(), 0);
    for language in offered {
        for reading in [TextSettings::default(), TextSettings { large: true, contrast: true }] {
            for cleaned in [false, true] {
                (visitor.language, visitor.accessibility.text) = (language.clone(), reading);
                (visitor.hears, visitor.silent, visitor.leaves_in) = (false, true, Some(3.0));
                visitor.house = VenueState::default();
                if cleaned {
                    visitor.house.start_cleaning(visitor.time, soffio_config::CLEANING_S);
                }
                let (lines, with, without) = seen(&mut visitor, &mut glass, &picture);
                let wanted: &[TextId] = match cleaned {
                    true => &[TextId::Cleaning],
                    false => &[TextId::SoundOff, TextId::MicrophoneOff, TextId::StayTouch],
                };
                for said in wanted.iter().map(|id| texts().get(&language).get(*id)) {
                    assert!(visitor.said.iter().any(|line| line == said), "{language}: {said:?} in {:?}", visitor.said);
                }
                for line in &lines {
                    let ratio = contrast(&with, &without, line.place);
                    measured += 1;
                    if ratio < LEAST || !on_the_glass.contains_rect(line.place) {
                        bad.push(format!(
                            "{language}, {reading:?}, cleaned: {cleaned}: {ratio:.2} : 1 for {:?} at {:?}",
                            line.text, line.place
                        ));
                    }
                }
                if let Some(folder) = std::env::var_os("SOFFIO_PICTURES") {
                    let name = format!("cleaned-{cleaned}-{language}-{}.png", reading.large);
                    with.save(Path::new(&folder).join(name)).expect("a folder that can be written");
                }
            }
        }
    }
    assert!(measured > 200, "{measured} pieces");
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

#[test]
#[ignore = "two works, each page: minutes on a slow machine; ./check --long runs it"]
fn type_on_the_glass_has_a_contrast_of_four_and_a_half_over_light_and_dark_works() {
    let Some(mut glass) = Glass::new() else { return };
    for id in ["steel-fish", "terry-clock"] {
        let (bad, measured) = look(&mut glass, id, &["en", "it"]);
        assert!(measured > 500, "{id}: {measured} pieces");
        assert!(bad.is_empty(), "{}", bad.join("\n"));
    }
}

#[test]
#[ignore = "every work and language: minutes; ./check --long runs it"]
fn type_has_this_contrast_over_every_shipped_work_in_every_language() {
    let Some(mut glass) = Glass::new() else { return };
    let mut all = Vec::new();
    for folder in super::captions::folders() {
        let id = folder.file_name().unwrap_or_default().to_string_lossy();
        all.extend(look(&mut glass, &id, &["en", "ko", "it"]).0);
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

#[test]
fn type_on_every_staff_page_has_this_contrast() {
    const SIZE: (u32, u32) = (1280, 720);
    /// Grey of the wall behind the panel.
    const WALL: u8 = 200;
    /// Where more of a page is below, its last row fades, points.
    const FOOT: f32 = 20.0;
    let Some(mut glass) = Glass::new() else { return };
    let picture = RgbaImage::from_pixel(SIZE.0, SIZE.1, image::Rgba([WALL, WALL, WALL, 255]));
    let mut staff = super::staff::Before::new("steel-fish");
    let (mut bad, mut measured) = (Vec::new(), 0);
    for page in Page::ALL {
        staff.staff.turn_to(page);
        // A panel knows its size from its second picture on.
        let mut shapes = Vec::new();
        for _ in 0..3 {
            let (_, mut laid_out) = staff.lay_out(Vec::new());
            glass.learn(&mut laid_out);
            shapes = laid_out.shapes;
        }
        let (lines, with, without) = apart(&staff.context, &mut glass, &picture, shapes);
        for line in lines.iter().filter(|line| line.place.bottom() < SIZE.1 as f32 - FOOT) {
            let ratio = contrast(&with, &without, line.place);
            measured += 1;
            if ratio < LEAST {
                bad.push(format!("{page:?}: {ratio:.2} : 1 for {:?} at {:?}", line.text, line.place));
            }
        }
        if let Some(folder) = std::env::var_os("SOFFIO_PICTURES") {
            with.save(Path::new(&folder).join(format!("staff-{page:?}.png"))).expect("a folder that can be written");
        }
    }
    assert!(measured > 500, "{measured} pieces");
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

#[test]
fn the_measure_knows_black_on_white_from_grey_on_white_and_what_is_not_seen() {
    use image::Rgba;
    /// Rounding of eight bits.
    const TOLERANCE: f64 = 0.05;
    // Bars two pixels wide stand for letters; from the middle on the ground is darker.
    let picture = |ink: u8, ground: [u8; 2], letters: bool| {
        RgbaImage::from_fn(80, 20, |x, y| {
            let bar = letters && x % 8 < 2 && (4..16).contains(&y);
            let value = if bar { ink } else { ground[usize::from(x >= 40)] };
            Rgba([value, value, value, 255])
        })
    };
    let measure = |ink: u8, ground: [u8; 2], from: f32| {
        let place = Rect::from_min_max(egui::pos2(from, 0.0), egui::pos2(from + 32.0, 20.0));
        contrast(&picture(ink, ground, true), &picture(ink, ground, false), place)
    };
    let black = measure(0, [255, 255], 0.0);
    assert!((black - 21.0).abs() < TOLERANCE, "{black}");
    // #767676 on white is 4.54 : 1, the standard's own example.
    let grey = measure(0x76, [255, 255], 0.0);
    assert!((grey - 4.54).abs() < TOLERANCE, "{grey}");
    let (light, dark) = (measure(0x76, [255, 200], 0.0), measure(0x76, [255, 200], 44.0));
    assert!((light - 4.54).abs() < TOLERANCE && dark < 3.0, "{light} and {dark}");
    assert_eq!(measure(255, [255, 255], 0.0), 1.0, "white on white is not seen");
}
