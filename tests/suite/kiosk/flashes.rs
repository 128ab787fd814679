//! No flashes: frames of attract mode against the definition of a general flash.
//!
//! WCAG 2.2: a flash is a pair of opposing changes in relative luminance of at least a tenth of the maximum, where the darker picture is
//! below 0.80. It counts if a quarter of any 10 degrees of the visual field changes at once. On the standard's picture of 1024 × 768
//! pixels at arm's length, 10 degrees are a block of 341 × 256 pixels, a third of each side. The limit is three flashes a second; here it
//! is two (NHM London, multimedia access guidelines).

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;

use image::RgbaImage;
use soffio_exhibit as exhibit;
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_offline::pictures::Pictures;
use soffio_simulation::Settings;

use super::glass::{Glass, luminance};

/// Most flashes a second.
const MOST: usize = 2;
/// Change of relative luminance that counts, and the luminance below which the darker picture must be.
const CHANGE: f64 = 0.1;
const DARK: f64 = 0.8;
/// Blocks of the field, a side, how finely they lie, and how much of one must flash.
const BLOCKS: u32 = 3;
const PLACES: u32 = 6;
const SHARE: f64 = 0.25;

/// One pixel over time.
#[derive(Clone)]
struct Pixel {
    /// The greatest or least luminance since its last change, and which.
    extreme: f64,
    rising: Option<bool>,
    /// Frames in which a pair of opposing changes was complete, within the last second.
    flashes: VecDeque<u32>,
}

impl Pixel {
    fn new(luminance: f64) -> Self {
        Self { extreme: luminance, rising: None, flashes: VecDeque::new() }
    }

    fn see(&mut self, luminance: f64, frame: u32, fps: u32) {
        let change = luminance - self.extreme;
        let counts = change.abs() >= CHANGE && luminance.min(self.extreme) < DARK;
        let up = change > 0.0;
        match self.rising {
            // On in the same direction: the extreme moves along.
            Some(rising) if rising == up => self.extreme = luminance,
            Some(_) if counts => {
                (self.extreme, self.rising) = (luminance, Some(up));
                self.flashes.push_back(frame);
            }
            None if counts => (self.extreme, self.rising) = (luminance, Some(up)),
            _ => {}
        }
        while self.flashes.front().is_some_and(|&old| frame - old >= fps) {
            self.flashes.pop_front();
        }
    }

    /// Pairs of opposing changes in the last second: each change after the first completes one with the change before it,
    /// so that two changes are one flash and three are one and a half.
    fn pairs(&self) -> usize {
        self.flashes.len().div_ceil(2)
    }
}

/// The most flashes in a second that a quarter of any block shows.
fn worst(frames: impl Iterator<Item = RgbaImage>, fps: u32) -> usize {
    let (mut pixels, mut size, mut worst) = (Vec::<Pixel>::new(), (0, 0), 0);
    for (number, frame) in frames.enumerate() {
        size = frame.dimensions();
        if pixels.is_empty() {
            pixels = frame.pixels().map(|pixel| Pixel::new(luminance(pixel))).collect();
            continue;
        }
        for (pixel, seen) in pixels.iter_mut().zip(frame.pixels()) {
            pixel.see(luminance(seen), number as u32, fps);
        }
        let (width, height) = (size.0 / BLOCKS, size.1 / BLOCKS);
        for place in 0..(PLACES + 1).pow(2) {
            let x0 = (size.0 - width) * (place % (PLACES + 1)) / PLACES;
            let y0 = (size.1 - height) * (place / (PLACES + 1)) / PLACES;
            let inside = (y0..y0 + height).flat_map(|y| (x0..x0 + width).map(move |x| (y * size.0 + x) as usize));
            let mut counts: Vec<usize> = inside.map(|index| pixels[index].pairs()).collect();
            // What a quarter of the block reaches.
            let at = counts.len() - (SHARE * counts.len() as f64).ceil() as usize;
            worst = worst.max(*counts.select_nth_unstable(at).1);
        }
    }
    assert!(size.0 > 0, "no frames");
    worst
}

/// Attract mode of an exhibit from its first second on, so many frames a second, small: flashes are large.
fn attract(id: &str, seconds: f64, fps: u32) -> impl Iterator<Item = RgbaImage> {
    const SIZE: (u32, u32) = (240, 135);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    let exhibit = Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}")));
    let mut pictures = Pictures::new(&exhibit, SIZE).expect("a driver that made a device draws");
    let mut stage = Stage::new(exhibit, Settings::default(), None, Some(0.01));
    let controls = Controls { aspect: 16.0 / 9.0, ..Controls::default() };
    (0..(seconds * f64::from(fps)) as u32).map(move |_| {
        (0..240 / fps).for_each(|_| stage.step(&controls, None));
        assert!(stage.attracts());
        pictures.draw(stage.snapshot()).expect("it draws")
    })
}

#[test]
fn attract_mode_never_flashes() {
    if Glass::new().is_none() {
        return;
    }
    for id in ["steel-fish", "noise-mobile"] {
        let flashes = worst(attract(id, 4.0, 12), 12);
        assert!(flashes <= MOST, "{id}: {flashes} flashes in a second");
    }
}

#[test]
#[ignore = "every work's whole attract script: minutes; ./check --long runs it"]
fn no_shipped_work_ever_flashes_in_attract_mode() {
    if Glass::new().is_none() {
        return;
    }
    let mut bad = Vec::new();
    for folder in super::captions::folders() {
        let id = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        // A single exhibit, for debugging.
        if std::env::var("SOFFIO_WORK").is_ok_and(|only| only != id) {
            continue;
        }
        let seconds = exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}")).attract.duration;
        let flashes = worst(attract(&id, seconds.clamp(5.0, 40.0), 15), 15);
        println!("{id}: {flashes}");
        if flashes > MOST {
            bad.push(format!("{id}: {flashes} flashes in a second"));
        }
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

#[test]
fn the_measure_counts_flashes_by_the_standards_definition() {
    const FPS: u32 = 30;
    let count = |hz: f64, [low, high]: [u8; 2], part: f64| {
        let frames = (0..3 * FPS).map(move |i| {
            let bright = (2.0 * hz * f64::from(i) / f64::from(FPS)) as u32 % 2 == 1;
            RgbaImage::from_fn(96, 72, move |x, y| {
                let value = if bright && f64::from(x) < part * 96.0 && y < 36 { high } else { low };
                image::Rgba([value, value, value, 255])
            })
        });
        worst(frames, FPS)
    };
    // Half of the picture, black and white, two and five times a second.
    assert_eq!(count(2.0, [0, 255], 1.0), 2);
    assert_eq!(count(5.0, [0, 255], 1.0), 5);
    // Less than a tenth of luminance, or both bright: no flash.
    assert_eq!(count(5.0, [100, 120], 1.0), 0);
    assert_eq!(count(5.0, [235, 255], 1.0), 0, "0.83 and 1.0");
    // A small part of the field: a block of 32 × 24 pixels, of which 5 × 24 are 16 %.
    assert_eq!(count(5.0, [0, 255], 5.0 / 96.0), 0);
    assert_eq!(count(5.0, [0, 255], 10.0 / 96.0), 5, "31 %");
    // A slow swell that goes on and back in many small changes is one flash.
    let swell = (0..2 * FPS).map(|i| {
        let value = (255.0 * (std::f64::consts::PI * f64::from(i) / f64::from(2 * FPS)).sin()) as u8;
        RgbaImage::from_pixel(48, 36, image::Rgba([value, value, value, 255]))
    });
    assert_eq!(worst(swell, FPS), 1);
}
