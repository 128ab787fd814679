//! Finishes: a word in the sidecar gives a plain model a material's structure, and changes nothing that moves.

use soffio_exhibit::{self as exhibit, Exhibit, codes};

use crate::exhibit::glb::{Folder, Scene, cuboid};

/// A block of 0.4 m × 0.3 m × 0.1 m without a texture, as one body.
fn block(words: &str) -> Folder {
    let mut scene = Scene::default();
    scene.node("Block", [0.0, 0.5, 0.0], Some(&cuboid([0.4, 0.3, 0.1])), &[]);
    Folder::exhibit(&scene.glb(), &format!("[[body]]\nnode = \"Block\"\nmaterial = \"oak\"\n{words}\n"))
}

fn loaded(words: &str) -> Exhibit {
    exhibit::load(block(words).path()).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

#[test]
fn a_finish_changes_what_is_drawn_and_no_bit_of_what_moves() {
    let (plain, oak) = (loaded(""), loaded("finish = \"oak\""));
    assert!(plain.model.images.is_empty() && oak.model.images.len() == 6, "maps of faces and of end grain");
    assert!(oak.warnings.is_empty(), "{:?}", oak.warnings);
    let [before, after] = [&plain, &oak].map(|exhibit| exhibit.bodies[0].properties);
    assert_eq!(before.mass.to_bits(), after.mass.to_bits());
    assert_eq!(before.inertia, after.inertia);
    assert_eq!(before.center, after.center);
    let [before, after] = [&plain, &oak].map(|exhibit| exhibit.bounds());
    assert_eq!(format!("{before:?}"), format!("{after:?}"));
}

#[test]
fn the_sidecar_names_a_finish_for_a_material_a_body_or_a_part() {
    let of_material = loaded("[material.oak]\nfinish = \"oak\"");
    assert_eq!(of_material.model.images.len(), 6);
    let red = loaded("finish = \"paint\"\ncolor = \"#c8201a\"");
    let worn = red.model.meshes[0].primitives[0].material.expect("a material");
    let look = &red.model.materials[worn];
    let paint = exhibit::finish::named("paint").expect("paint").maps();
    // IEC 61966-2-1: code 200 is 0.5776 of linear light.
    assert!((look.base_color[0] * paint.color_mean[0] - 0.5776).abs() < 1e-3, "{:?}", look.base_color);
    assert!(look.metallic == 0.0);
}

#[test]
fn a_word_that_is_no_finish_is_refused_with_near_ones() {
    for (words, parts) in [
        ("finish = \"oack\"", &["\"oack\"", "did you mean \"oak\"", "\"walnut\"", "exhibit.toml:6"][..]),
        ("finish = \"zzz\"", &["\"zzz\"", "there are \"oak\""][..]),
        ("[material.oak]\nfinish = \"brass\"", &["\"brass\"", "\"brass-cast\"", "exhibit.toml:7"][..]),
    ] {
        let report = exhibit::load(block(words).path()).expect_err("no such finish");
        assert!(report.has(codes::UNKNOWN_FINISH), "{}", report.to_text());
        for part in parts {
            assert!(report.to_text().contains(part), "{part}: {}", report.to_text());
        }
    }
    let report = exhibit::load(block("color = \"crimson\"").path()).expect_err("no colour");
    assert!(report.to_text().contains("body[0].color is \"crimson\""), "{}", report.to_text());
    assert!(report.to_text().contains("exhibit.toml:6"), "{}", report.to_text());
}

#[test]
fn a_finish_without_a_mesh_warns() {
    let mut scene = Scene::default();
    scene.node("Point", [0.0; 3], None, &[]);
    scene.node("Block", [0.0, 0.5, 0.0], Some(&cuboid([0.4, 0.3, 0.1])), &[]);
    let words = "[[body]]\nnode = \"Point\"\nmass = 1\ninertia = { diagonal = [1, 1, 1] }\nfinish = \"oak\"\n";
    let folder = Folder::exhibit(&scene.glb(), words);
    let exhibit = exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()));
    assert!(exhibit.warning_report().has(codes::UNUSED), "{:?}", exhibit.warnings);
}

#[test]
fn shipped_models_name_finishes_that_there_are() {
    // A name that is not known is a warning of the model.
    for id in exhibit::ids() {
        let folder = exhibit::resolve(&id).expect("a shipped exhibit");
        let exhibit = exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()));
        assert!(exhibit.warnings.iter().all(|w| !w.message.contains("finish")), "{id}: {:?}", exhibit.warnings);
    }
}

/// Standard deviation of the luma in the middle of a picture of a block, codes; `None` where nothing draws.
#[cfg(feature = "kiosk")]
fn deviation(words: &str) -> Option<f64> {
    const SIZE: (u32, u32) = (320, 240);
    let exhibit = loaded(words);
    let mut renderer = crate::pictures::renderer(&exhibit, |_| ())?;
    let view = exhibit::View {
        eye: glam::DVec3::new(0.0, 0.5, 0.75),
        target: glam::DVec3::new(0.0, 0.5, 0.0),
        up: glam::DVec3::Y,
        fovy: 0.3,
    };
    let frame =
        soffio_render::FrameInput { poses: &[], dust: &[], curves: &[], view, size: SIZE, exposure: 1.0, time: 0.0 };
    let picture = renderer.draw(&frame).expect("a picture");
    let luma =
        |p: &image::Rgba<u8>| 0.2126 * f64::from(p.0[0]) + 0.7152 * f64::from(p.0[1]) + 0.0722 * f64::from(p.0[2]);
    let lumas: Vec<f64> = picture.pixels().map(luma).collect();
    let mean = lumas.iter().sum::<f64>() / lumas.len() as f64;
    Some((lumas.iter().map(|l| (l - mean) * (l - mean)).sum::<f64>() / lumas.len() as f64).sqrt())
}

#[cfg(feature = "kiosk")]
#[test]
fn wood_and_paint_are_seen_in_a_picture() {
    let Some(plain) = deviation("") else { return };
    // The slope of the light over the block is in both; the grain of oak and the dust on paint come on top.
    for (words, least) in [("finish = \"oak\"", 3.0), ("finish = \"paint\"\ncolor = \"#c8201a\"", 0.8)] {
        let dressed = deviation(words).expect("a driver, as before");
        let added = (dressed * dressed - plain * plain).max(0.0).sqrt();
        assert!(added > least, "{words}: {dressed} codes instead of {plain}");
    }
}
