//! The pictures of the manual: each screen that a visitor meets, in each language of the works, made from the code that draws
//! them. `SOFFIO_PICTURES=kiosk-config/pictures cargo test --test suite screens -- --ignored` makes them again.

use std::path::PathBuf;

use image::{RgbaImage, imageops};
use soffio_config::Config;
use soffio_exhibit::thumbnail::THUMBNAIL;
use soffio_kiosk::pages::languages::{languages_without_glyphs, offered};
use soffio_kiosk::venue::catalog::{CatalogEntry, id};
use soffio_kiosk::visitor::accessibility::AccessibilitySettings;
use soffio_kiosk::visitor::accessibility::TextSettings;
use soffio_offline::pictures::{Pictures, write_png};
use soffio_simulation::{Command, StepInput};

use super::captions::folders;
use super::glass::Glass;
use super::pages::{Before, load, texts};

/// One screen on a sheet, pixels.
const SIZE: (u32, u32) = (1280, 720);
const SHRUNK: (u32, u32) = (800, 450);

/// A screen: its name, and how a visitor has come there.
type Screen = (&'static str, fn(&mut Before));

/// Of a visitor who needs much.
const MANY: AccessibilitySettings = AccessibilitySettings {
    text: TextSettings { large: true, contrast: true },
    press_once: true,
    dwell: true,
    reduced_motion: true,
    look_around: false,
};

const SCREENS: [Screen; 5] = [
    ("front-languages", |_| ()),
    ("hold-languages", |visitor| visitor.hears = false),
    ("more-languages", |visitor| visitor.menu.open = true),
    ("front-large", |visitor| visitor.accessibility = MANY),
    ("more-large", |visitor| {
        visitor.menu.open = true;
        visitor.accessibility = MANY;
    }),
];

/// The shipped works, with labels and pictures.
fn shelf() -> Vec<CatalogEntry> {
    let work = |folder: PathBuf| CatalogEntry {
        id: id(&folder),
        labels: load(&id(&folder)).labels.clone(),
        thumbnail: image::open(folder.join(THUMBNAIL))
            .ok()
            .map(|picture| picture.resize_to_fill(480, 270, imageops::FilterType::Triangle).to_rgba8()),
        folder,
    };
    folders().into_iter().map(work).collect()
}

#[test]
#[ignore = "writes the manual's pictures into the folder SOFFIO_PICTURES"]
fn the_manuals_pictures_are_made() {
    let Some(folder) = std::env::var_os("SOFFIO_PICTURES").map(PathBuf::from) else { return };
    let Some(mut glass) = Glass::new() else { return };
    let exhibit = load("steel-fish");
    let mut visitor = Before::new(&exhibit, [SIZE.0 as f32, SIZE.1 as f32]);
    visitor.shelf = shelf();
    // A breath, two seconds after it began.
    let mut simulation = soffio_simulation::Simulation::new(exhibit.clone(), soffio_simulation::Settings::default());
    for step in 0..480 {
        let blow = (step == 0).then_some(Command::Blow(Some(6.0)));
        simulation.step(&StepInput { commands: blow.as_slice(), ..StepInput::default() });
    }
    visitor.moment = simulation.snapshot();
    visitor.captions = exhibit.sounds.iter().filter_map(|sound| sound.caption.clone()).take(1).collect();
    let mut pictures = Pictures::new(&exhibit, SIZE).expect("a driver that made a device draws");
    let picture = pictures.draw(&visitor.moment).expect("it draws");
    // There are fonts from the first picture on.
    glass.learn(&mut visitor.lay_out());
    visitor.languages =
        offered(&visitor.context, &exhibit.labels, &Config::default(), texts(), &languages_without_glyphs(texts()));
    let languages = visitor.languages.clone();
    for (name, come) in SCREENS {
        let mut sheet = RgbaImage::new(SHRUNK.0, SHRUNK.1 * languages.len() as u32);
        for (place, language) in languages.iter().enumerate() {
            (visitor.language, visitor.accessibility, visitor.hears, visitor.menu.open) =
                (language.clone(), AccessibilitySettings::default(), true, false);
            come(&mut visitor);
            let mut laid_out = visitor.lay_out();
            for _ in 0..60 {
                glass.learn(&mut laid_out);
                visitor.time += 0.25;
                visitor.activity += 1;
                laid_out = visitor.lay_out();
            }
            glass.learn(&mut laid_out);
            let shapes = std::mem::take(&mut laid_out.shapes);
            let whole = glass.draw(&visitor.context.clone(), &picture, shapes);
            let small = imageops::resize(&whole, SHRUNK.0, SHRUNK.1, imageops::FilterType::Lanczos3);
            imageops::replace(&mut sheet, &small, 0, i64::from(SHRUNK.1) * place as i64);
        }
        write_png(&sheet, &folder.join(format!("{name}.png"))).expect("a folder that can be written");
    }
}
