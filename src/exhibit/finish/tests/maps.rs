//! The maps of all finishes.

use super::super::maps::{Structure, to_linear};
use super::super::noise::{Field, SIDE};
use super::super::*;
use crate::model::Image;

/// All maps with a name: those of faces and of end grain.
fn all() -> impl Iterator<Item = (String, &'static Maps)> {
    FINISHES.iter().flat_map(|finish| {
        let end = finish.end.as_ref().map(|end| (format!("{} end", finish.name), end.maps()));
        [(finish.name.to_owned(), finish.maps())].into_iter().chain(end)
    })
}

/// Mean difference of neighbouring columns or rows: at the seam, and the largest one inside.
fn steps(image: &Image, rows: bool) -> (f64, f64) {
    let texel = |along: usize, across: usize, channel: usize| {
        let index = if rows { along * SIDE + across } else { across * SIDE + along };
        f64::from(image.rgba[4 * index + channel])
    };
    let step = |from: usize| {
        let to = (from + 1) % SIDE;
        let change = |across: usize| (0..3).map(|c| (texel(to, across, c) - texel(from, across, c)).abs()).sum::<f64>();
        (0..SIDE).map(change).sum::<f64>() / SIDE as f64
    };
    (step(SIDE - 1), (0..SIDE - 1).map(step).fold(0.0, f64::max))
}

#[test]
fn the_edges_of_each_map_meet() {
    for (name, maps) in all() {
        for (map, image) in [("colour", &maps.color), ("roughness", &maps.roughness), ("normals", &maps.normal)] {
            for rows in [false, true] {
                let (seam, inside) = steps(image, rows);
                // A step at the seam is one of many: it is not larger than all the others.
                assert!(seam <= inside, "{name}: {map} steps by {seam} over its edge and {inside} inside");
            }
        }
    }
}

#[test]
fn factors_and_maps_have_the_colour_and_the_roughness_as_their_mean() {
    for (name, maps) in all() {
        let count = (SIDE * SIDE) as f64;
        for channel in 0..3 {
            let codes = maps.color.rgba.iter().skip(channel).step_by(4);
            let mean = codes.map(|code| to_linear(f64::from(*code) / 255.0)).sum::<f64>() / count;
            assert!((mean - f64::from(maps.color_mean[channel])).abs() < 1e-6, "{name}: {mean}");
            assert!(mean > 0.5, "{name}: the factor {} is beyond what a file can say", 1.0 / mean);
        }
        let codes = maps.roughness.rgba.iter().skip(1).step_by(4);
        let mean = codes.map(|code| f64::from(*code) / 255.0).sum::<f64>() / count;
        assert!((mean - f64::from(maps.roughness_mean)).abs() < 1e-6, "{name}: {mean}");
    }
}

/// Standard deviation of the luma of a map, codes.
fn deviation(image: &Image) -> f64 {
    let luma = |p: &[u8; 4]| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
    let lumas: Vec<f64> = image.rgba.as_chunks::<4>().0.iter().map(luma).collect();
    let mean = lumas.iter().sum::<f64>() / lumas.len() as f64;
    (lumas.iter().map(|l| (l - mean) * (l - mean)).sum::<f64>() / lumas.len() as f64).sqrt()
}

#[test]
fn every_material_has_structure_and_none_is_loud() {
    for (name, maps) in all() {
        let deviation = deviation(&maps.color);
        // Codes: below one nothing is seen; walnut, the strongest, has about twenty.
        assert!((1.0..25.0).contains(&deviation), "{name}: {deviation}");
        assert!(maps.normal_scale > 0.0 && maps.normal_scale < 2.0, "{name}: {}", maps.normal_scale);
    }
}

#[test]
fn a_normal_map_gives_the_slopes_of_its_heights_back() {
    use soffio_math::{PI, cos, sin};
    const HEIGHT: f64 = 20e-6;
    let tile = [0.2, 0.1];
    let [k, l] = [3.0, 5.0].map(|waves| 2.0 * PI * waves);
    let height = Field::of(|u, v| (HEIGHT * sin(k * f64::from(u) + l * f64::from(v))) as f32);
    let flat = || Field::constant(0.0);
    let structure = Structure { brightness: flat(), tint: [1.0; 3], roughness: flat(), height };
    let maps = Maps::of(&structure, tile);
    let decoded = |code: u8| f64::from(code) / 127.5 - 1.0;
    for (index, p) in maps.normal.rgba.as_chunks::<4>().0.iter().enumerate().step_by(97) {
        let [u, v] = [index % SIDE, index / SIDE].map(|i| (i as f64 + 0.5) / SIDE as f64);
        let wave = HEIGHT * cos(k * u + l * v);
        // −∂h/∂u, and +∂h/∂v because green points up in the image.
        let expected = [-k * wave / tile[0], l * wave / tile[1]];
        let scale = f64::from(maps.normal_scale);
        let read = [p[0], p[1]].map(|code| scale * decoded(code) / decoded(p[2]));
        // Half a code of 1/127.5, and one for the differences between texels.
        let tolerance = 1.5 * scale / 127.5 / 0.8;
        for (read, expected) in read.iter().zip(expected) {
            assert!((read - expected).abs() < tolerance, "{read} for {expected} at {u}, {v}");
        }
    }
}

/// FNV-1a of the bytes of the three maps, on every machine and at every optimisation level.
#[rustfmt::skip]
const HASHES: [(&str, u64); 25] = [
    ("oak", 0xfe2d65917e48531c),
    ("oak end", 0x9f8947decc7fa487),
    ("beech", 0xcd8a98a1c8677b2d),
    ("beech end", 0xb93032c6c209422c),
    ("walnut", 0x4e93bb790df1b116),
    ("walnut end", 0xaf7106d47095551c),
    ("pine", 0x03d81a1ebedc0be4),
    ("pine end", 0x71eb0b2f1e0d0d6a),
    ("brass-brushed", 0x1414d8fbccd147c9),
    ("brass-cast", 0x6489cfaea49fa55f),
    ("brass-polished", 0xda302a8e85c5e24c),
    ("steel-brushed", 0x973f923cfdd4a16c),
    ("steel-polished", 0x98d98547082ea5d6),
    ("iron-cast", 0xc7aa0ac8596f38d9),
    ("copper", 0x2ebdb7261e0c5fe9),
    ("aluminium-brushed", 0xcceff2f0accbd2ca),
    ("lead", 0x6c5c0c9dfdf3247b),
    ("paint", 0x7809826be69851e2),
    ("paint-matt", 0x2a72e3456d7593bf),
    ("paper", 0xaae7e9a569d4a5ae),
    ("felt", 0x44aaf741e13e5954),
    ("leather", 0x09ffe20b22b59aa8),
    ("cord", 0xc0d5008ecb11424c),
    ("stone", 0x0fd1cbd26e1c62d6),
    ("bamboo", 0x8b310a6a5c5f8244),
];

#[test]
fn the_maps_are_the_same_everywhere() {
    let mut changed = String::new();
    for ((name, maps), (known, expected)) in all().zip(HASHES) {
        let bytes = [&maps.color, &maps.roughness, &maps.normal].into_iter().flat_map(|image| &image.rgba);
        let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        if (name.as_str(), hash) != (known, expected) {
            changed += &format!("    (\"{name}\", 0x{hash:016x}),\n");
        }
    }
    assert!(changed.is_empty() && all().count() == HASHES.len(), "{changed}");
}
