//! Textures of what glTF's extensions add: a texel that halves a factor looks as half the factor does.

use std::sync::Arc;

use glam::{DMat4, DVec3};
use soffio_exhibit::model::{
    self, Appearance, Details, Image, Levels, Mesh, Model, Node, Primitive, Sampler, ScaledTexture, TextureUse, Wrap,
};
use soffio_exhibit::{Exhibit, View};
use soffio_render::FrameInput;

use crate::pictures::renderer;

const SIZE: (u32, u32) = (240, 160);
/// Codes of the texels of the left and of the right half.
const CODES: [u8; 2] = [64, 200];

/// A panel of 0.6 m by 0.4 m that leans back, its picture once over all of it.
fn panel() -> Primitive {
    let corners = [[-0.3_f32, -0.2], [0.3, -0.2], [0.3, 0.2], [-0.3, 0.2]];
    Primitive {
        positions: corners.map(|[x, y]| [x, y, 0.3 * y]).to_vec(),
        normals: vec![glam::Vec3::new(0.0, -0.3, 1.0).normalize().to_array(); 4],
        uvs: corners.map(|[x, y]| [x / 0.6 + 0.5, 0.5 - y / 0.4]).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
        material: Some(0),
        ..Primitive::default()
    }
}

/// An image whose left half has the one colour and whose right half has the other.
fn halves(left: [u8; 4], right: [u8; 4]) -> Image {
    Image { width: 2, height: 1, rgba: [left, right].concat() }
}

/// How the images are read: texel by texel.
fn sampler() -> Sampler {
    Sampler { wrap: [Wrap::Clamp; 2], smooth_near: false, smooth_far: false, levels: Levels::None }
}

fn texture(image: usize) -> TextureUse {
    TextureUse { sampler: sampler(), ..TextureUse::of(image) }
}

/// The panel as a GLB, read back, and its picture; `None` where nothing draws.
fn picture(look: Appearance, images: Vec<Image>) -> Option<image::RgbaImage> {
    picture_of(panel(), look, images)
}

/// The same of another primitive.
fn picture_of(primitive: Primitive, look: Appearance, images: Vec<Image>) -> Option<image::RgbaImage> {
    let node = Node {
        name: "panel".into(),
        parent: None,
        children: Vec::new(),
        local: DMat4::IDENTITY,
        world: DMat4::IDENTITY,
        mesh: Some(0),
        camera: None,
        light: None,
    };
    let made = Model {
        nodes: vec![node],
        roots: vec![0],
        meshes: vec![Mesh { name: "panel".into(), primitives: vec![primitive] }],
        materials: vec![look],
        images: images.into_iter().map(Arc::new).collect(),
        ..Model::default()
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("panel.glb");
    std::fs::write(&path, soffio_authoring::model_writer::write(&made, "")).expect("writable");
    let imported = model::import(&path).unwrap_or_else(|report| panic!("{report}"));
    // Tangents of a coat's normal map are computed here; the standard asks for them in the file.
    let other = |w: &soffio_exhibit::Diagnostic| !w.message.contains("needs tangents");
    assert!(!imported.warnings.iter().any(other), "{:?}", imported.warnings);
    let exhibit = Exhibit::from_model(imported.model);
    let view = View { eye: DVec3::new(0.15, 0.1, 1.1), target: DVec3::ZERO, up: DVec3::Y, fovy: 0.45 };
    let frame = FrameInput { poses: &[], dust: &[], curves: &[], view, size: SIZE, exposure: 1.0, time: 0.0 };
    // Before one even colour: no shadow of glass on a wall behind it, which is as dark as the factor alone says.
    let grey = |options: &mut soffio_render::Options| options.lighting.background = Some(glam::Vec3::splat(0.4));
    Some(renderer(&exhibit, grey)?.draw(&frame).expect("a picture"))
}

fn linear(code: u8) -> f32 {
    let c = f32::from(code) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// A texture: its name, what it is tried on, how it is put there, and the factor that is in its place.
type Case = (&'static str, fn() -> Appearance, fn(&mut Details), fn(&mut Appearance, f32));

/// Glass, varnish and cloth in which each factor is seen.
fn glass() -> Appearance {
    Appearance {
        metallic: 0.0,
        roughness: 0.2,
        base_color: [0.9, 0.9, 0.9, 1.0],
        transmission: 1.0,
        thickness: 0.05,
        attenuation_distance: 0.03,
        attenuation_color: [0.3, 0.6, 0.9],
        ..Appearance::default()
    }
}

fn varnish() -> Appearance {
    Appearance {
        metallic: 0.0,
        roughness: 0.25,
        base_color: [0.05, 0.06, 0.08, 1.0],
        coat: 1.0,
        coat_roughness: 0.5,
        ior: 2.0,
        ..Appearance::default()
    }
}

fn paint() -> Appearance {
    Appearance { coat: 0.0, ..varnish() }
}

fn cloth() -> Appearance {
    let sheen = [0.9, 0.8, 0.7];
    Appearance { roughness: 0.9, sheen, sheen_roughness: 0.6, ..paint() }
}

/// All but the normals of a coat.
const CASES: [Case; 8] = [
    ("transmission", glass, |d| d.transmission = Some(texture(0)), |look, x| look.transmission *= x),
    ("thickness", glass, |d| d.thickness = Some(texture(0)), |look, x| look.thickness *= x),
    ("specular", paint, |d| d.specular = Some(texture(0)), |look, x| look.specular *= x),
    (
        "specular colour",
        paint,
        |d| d.specular_color = Some(texture(0)),
        |look, x| look.specular_color = look.specular_color.map(|c| c * x),
    ),
    ("coat", varnish, |d| d.coat = Some(texture(0)), |look, x| look.coat *= x),
    ("roughness of the coat", varnish, |d| d.coat_roughness = Some(texture(0)), |look, x| look.coat_roughness *= x),
    ("sheen", cloth, |d| d.sheen = Some(texture(0)), |look, x| look.sheen = look.sheen.map(|c| c * x)),
    ("roughness of the sheen", cloth, |d| d.sheen_roughness = Some(texture(0)), |look, x| look.sheen_roughness *= x),
];

#[test]
fn a_texel_is_seen_as_the_factor_that_it_makes() {
    /// Levels of 255: eight bits of a texel, the dither, and products in another order.
    const TOLERANCE: i32 = 2;
    for (name, look, put, factor) in CASES {
        // What the extension reads has the code; all other channels are another, so that none is taken for it.
        let channels: &[usize] = match name {
            "transmission" | "coat" => &[0],
            "thickness" | "roughness of the coat" => &[1],
            "specular" | "roughness of the sheen" => &[3],
            _ => &[0, 1, 2],
        };
        let texel = |code: u8| std::array::from_fn(|i| if channels.contains(&i) { code } else { 128 });
        let mut details = Details::default();
        put(&mut details);
        let textured = Appearance { details, ..look() };
        let image = halves(texel(CODES[0]), texel(CODES[1]));
        let Some(found) = picture(textured, vec![image]) else { return };
        let wanted = CODES.map(|code| {
            let share = if channels.len() == 3 { linear(code) } else { f32::from(code) / 255.0 };
            let mut plain = look();
            factor(&mut plain, share);
            picture(plain, Vec::new()).expect("there is a driver")
        });
        if let Ok(folder) = std::env::var("SOFFIO_PICTURES") {
            let file = format!("detail-{}.png", name.replace(' ', "-"));
            found.save(std::path::Path::new(&folder).join(file)).expect("a writable folder");
        }
        let (mut off, mut apart) = ([0; 2], 0);
        for (x, y, pixel) in found.enumerate_pixels() {
            // Well inside each half of the panel, which fills most of the picture.
            let across = f64::from(x) / f64::from(SIZE.0);
            let half = match across {
                0.2..0.45 => 0,
                0.55..0.75 => 1,
                _ => continue,
            };
            if !(0.3..0.7).contains(&(f64::from(y) / f64::from(SIZE.1))) {
                continue;
            }
            let [a, b] = [0, 1].map(|i| wanted[i].get_pixel(x, y).0.map(i32::from));
            for channel in 0..3 {
                let found = i32::from(pixel.0[channel]);
                off[half] = off[half].max((found - [a, b][half][channel]).abs());
                apart = apart.max((a[channel] - b[channel]).abs());
            }
        }
        println!("{name}: {off:?} levels off, the halves {apart} apart");
        assert!(off.iter().all(|off| *off <= TOLERANCE), "{name}: {off:?} levels off");
        // Some layers are seen little in an even room; each half must still be nearer to its own factor than to the other.
        assert!(off.iter().all(|off| *off < apart), "{name} is not seen: {apart} levels");
    }
}

#[test]
fn a_normal_map_is_the_same_with_tangents_in_the_file_and_without() {
    /// Levels of 255: derivatives of single precision, and the tangents' own rounding.
    const ROUNDING: i32 = 3;
    // Along u, and the bitangent up, against v.
    let along = Primitive { tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4], ..panel() };
    for leaning in [[230, 128, 200, 255], [26, 128, 200, 255], [128, 230, 200, 255], [128, 26, 200, 255]] {
        let map = ScaledTexture { texture: texture(0), scale: 1.0 };
        let look = || Appearance { normal_texture: Some(map), roughness: 0.25, ..varnish() };
        let image = || vec![halves(leaning, leaning)];
        let (Some(with), Some(without)) =
            (picture_of(along.clone(), look(), image()), picture_of(panel(), look(), image()))
        else {
            return;
        };
        let pairs = with.pixels().zip(without.pixels());
        let off = pairs.map(|(a, b)| (0..3).map(|i| (i32::from(a.0[i]) - i32::from(b.0[i])).abs()).max().unwrap_or(0));
        let off = off.max().unwrap_or(0);
        assert!(off <= ROUNDING, "{leaning:?}: {off} levels apart");
    }
}

#[test]
fn the_coats_normals_bend_its_mirror_alone() {
    // It leans upwards, to the luminous fields of the ceiling.
    let (flat, leaning) = ([128, 128, 255, 255], [128, 230, 200, 255]);
    let coated = |coat: f32, texel: [u8; 4]| {
        let details =
            Details { coat_normal: Some(ScaledTexture { texture: texture(0), scale: 1.0 }), ..Details::default() };
        picture(Appearance { coat, coat_roughness: 0.1, details, ..varnish() }, vec![halves(texel, texel)])
    };
    let (Some(plain), Some(flat_one), Some(bent)) =
        (picture(Appearance { coat_roughness: 0.1, ..varnish() }, Vec::new()), coated(1.0, flat), coated(1.0, leaning))
    else {
        return;
    };
    let apart = |a: &image::RgbaImage, b: &image::RgbaImage| {
        let pairs = a.pixels().zip(b.pixels());
        pairs.map(|(a, b)| (0..3).map(|i| (i32::from(a.0[i]) - i32::from(b.0[i])).abs()).max().unwrap_or(0)).max()
    };
    /// Levels of 255: 128 is not quite the middle of the codes, half a degree.
    const FLAT: i32 = 6;
    const BENT: i32 = 10;
    println!("flat {:?}, bent {:?}", apart(&plain, &flat_one), apart(&plain, &bent));
    assert!(apart(&plain, &flat_one) <= Some(FLAT), "a flat map changes nothing");
    assert!(apart(&plain, &bent) >= Some(BENT), "the mirror looks elsewhere");
    let [without, with] = [coated(0.0, flat), coated(0.0, leaning)].map(|picture| picture.expect("there is a driver"));
    assert_eq!(without, with, "where there is no coat nothing is bent");
}
