//! Models made here: kinds of valid files that load, kinds of faults with their messages, and many damaged files.

#[cfg(test)]
use std::collections::BTreeSet;
use std::time::Duration;

use cpu_time::ThreadTime;
use serde_json::{Value, json};

use super::check::tables::GREATEST_FOV;
use super::fault::Cause;
use super::import::tests::read;
use super::{Imported, Model, size};
use crate::codes::Code;
use crate::{Report, codes};

/// A GLB of these parts (glTF 2.0, chapter 4).
fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut body = Vec::new();
    for (kind, bytes) in [(b"JSON", json.as_slice()), (b"BIN\0", binary)] {
        body.extend((bytes.len() as u32).to_le_bytes());
        body.extend(kind);
        body.extend(bytes);
    }
    [b"glTF", &2_u32.to_le_bytes()[..], &(12 + body.len() as u32).to_le_bytes(), &body].concat()
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// A PNG of one pixel.
fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::DynamicImage::new_rgb8(1, 1).write_to(&mut bytes, image::ImageFormat::Png).expect("memory");
    bytes.into_inner()
}

/// Triangle, texture, camera, light, skin, morph target and animation: its document and its binary chunk.
fn whole() -> (Value, Vec<u8>) {
    let mut binary = Vec::new();
    let mut views = Vec::new();
    let mut view = |mut bytes: Vec<u8>| {
        views.push(json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() }));
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        binary.extend(bytes);
    };
    view(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    view(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    view(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    view(vec![0, 0, 1, 0, 2, 0]);
    view(vec![0; 12]);
    view(floats(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]));
    view(floats(&[0.0, 1.0]));
    view(floats(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    view(png());
    let accessor = |view: usize, code: u32, count: usize, kind: &str| json!({ "bufferView": view, "componentType": code, "count": count, "type": kind });
    let mut accessors = vec![
        accessor(0, 5126, 3, "VEC3"),
        accessor(1, 5126, 3, "VEC3"),
        accessor(2, 5126, 3, "VEC2"),
        accessor(3, 5123, 3, "SCALAR"),
        accessor(4, 5121, 3, "VEC4"),
        accessor(5, 5126, 3, "VEC4"),
        accessor(6, 5126, 2, "SCALAR"),
        accessor(7, 5126, 2, "VEC3"),
        json!({ "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0] }),
    ];
    for (index, low, high) in [(0, json!([0, 0, 0]), json!([1, 1, 0])), (6, json!([0]), json!([1]))] {
        accessors[index]["min"] = low;
        accessors[index]["max"] = high;
    }
    let lights =
        json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": { "outerConeAngle": 0.5 } }] } });
    let document = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": lights,
        "scene": 0,
        "scenes": [{ "nodes": [0, 1, 2] }],
        "nodes": [
            { "name": "Body", "mesh": 0, "skin": 0, "weights": [0.5] },
            { "name": "Bone", "translation": [0, 1, 0], "children": [3] },
            { "name": "Eye", "camera": 0 },
            { "name": "Lamp", "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        ],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "JOINTS_0": 4, "WEIGHTS_0": 5 },
            "indices": 3, "material": 0, "targets": [{ "POSITION": 8 }],
        }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "samplers": [{ "magFilter": 9728 }],
        "images": [{ "bufferView": 8, "mimeType": "image/png" }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }],
        "skins": [{ "joints": [1] }],
        "animations": [{
            "samplers": [{ "input": 6, "output": 7 }],
            "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }],
        }],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": binary.len() }],
    });
    (document, binary)
}

/// The whole model with values put in at JSON pointers; null removes.
fn changed(changes: &[(&str, Value)]) -> Result<Imported, Report> {
    let (mut document, binary) = whole();
    for (pointer, value) in changes {
        let (above, key) = pointer.rsplit_once('/').expect("a pointer");
        match document.pointer_mut(above).expect("a place") {
            Value::Object(map) if value.is_null() => drop(map.remove(key)),
            Value::Object(map) => drop(map.insert(key.to_owned(), value.clone())),
            Value::Array(list) => list[key.parse::<usize>().expect("an index")] = value.clone(),
            _ => panic!("{pointer} leads nowhere"),
        }
    }
    read(&glb(&document, &binary))
}

fn loaded(changes: &[(&str, Value)]) -> Model {
    changed(changes).unwrap_or_else(|report| panic!("{changes:?}: {}", report.to_text())).model
}

#[test]
fn the_model_of_these_tests_loads_without_a_warning() {
    let imported = changed(&[]).expect("a valid file");
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    assert_eq!(imported.model.skins.len(), 1);
    assert_eq!(imported.model.animations[0].channels[0].times, [0.0, 1.0]);
    assert_eq!((imported.model.images[0].width, imported.model.lights.len()), (1, 1));
}

#[test]
fn accessors_without_a_view_are_zeros_and_sparse_ones_replace_them() {
    let model = loaded(&[("/accessors/0/bufferView", Value::Null)]);
    assert!(model.skins[0].bound[0].positions.iter().all(|p| *p == [0.0; 3]));
    // One entry of the third view (a float 0, 0, 1 …) and the index 0 of the fifth (bytes 0).
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": 4, "componentType": 5121 },
        "values": { "bufferView": 2, "byteOffset": 0 },
    });
    let model = loaded(&[("/accessors/0/bufferView", Value::Null), ("/accessors/0/sparse", sparse)]);
    assert_eq!(model.skins[0].bound[0].positions[0], [0.0, 0.0, 1.0]);
    assert_eq!(model.skins[0].bound[0].positions[1], [0.0; 3]);
}

#[test]
fn whole_numbers_may_be_written_with_a_point() {
    let same = [
        ("/scene", json!(0.0)),
        ("/nodes/0/mesh", json!(0.0)),
        ("/accessors/0/count", json!(3.0)),
        ("/accessors/0/componentType", json!(5126.0)),
        ("/bufferViews/1/byteOffset", json!(36.0)),
        ("/textures/0/source", json!(0.0)),
    ];
    assert_eq!(format!("{:?}", loaded(&same)), format!("{:?}", loaded(&[])));
    let report = changed(&[("/nodes/0/mesh", json!(0.5))]).expect_err("half a mesh");
    assert!(report.to_text().contains("nodes[0].mesh"), "{report}");
}

#[test]
fn versions_that_a_reader_of_2_0_may_read_are_read() {
    loaded(&[("/asset/version", json!("2.1"))]);
    loaded(&[("/asset/version", json!("2.1")), ("/asset/minVersion", json!("2.0"))]);
    for (field, version) in [("version", "1.0"), ("version", "3.0"), ("version", "2.0-dev"), ("minVersion", "2.1")] {
        let report = changed(&[(&format!("/asset/{field}"), json!(version))]).expect_err("another version");
        assert!(report.has(codes::NOT_GLTF), "{report}");
        let text = &report.diagnostics[0].message;
        assert!(text.contains(&format!("asset.{field}")) && text.contains(version), "{text}");
    }
}

#[test]
fn other_kinds_of_valid_files_load() {
    let pointer = json!({ "sampler": 0, "target": { "path": "pointer" } });
    let other = json!({ "uri": "data:image/ktx2;base64,AAAA" });
    let kinds: &[(&str, &[(&str, Value)])] = &[
        ("a texture without an image", &[("/textures/0/source", Value::Null)]),
        ("a scene without nodes", &[("/scenes/0/nodes", Value::Null)]),
        ("a channel of an extension", &[("/animations/0/channels/0", pointer)]),
        (
            "a primitive without positions",
            &[
                ("/meshes/0/primitives/0/attributes", json!({ "NORMAL": 1 })),
                ("/meshes/0/primitives/0/targets", Value::Null),
                ("/nodes/0/weights", Value::Null),
            ],
        ),
        ("a light of a later kind", &[("/extensions/KHR_lights_punctual/lights/0/type", json!("area"))]),
        ("a camera that sees all round", &[("/cameras/0/perspective/yfov", json!(3.2))]),
        ("an image that nothing uses", &[("/images/0", other), ("/textures/0/source", Value::Null)]),
        ("a later filter", &[("/samplers/0/magFilter", json!(9999))]),
        ("a buffer that is given later", &[("/buffers", json!([{ "byteLength": 312 }, { "byteLength": 8 }]))]),
    ];
    for (kind, changes) in kinds {
        let mut changes = changes.to_vec();
        if changes[0].0 == "/buffers" {
            changes[0].1[0]["byteLength"] = json!(whole().1.len());
        }
        let imported = changed(&changes).unwrap_or_else(|report| panic!("{kind}: {}", report.to_text()));
        let skipped = |w: &crate::Diagnostic| w.code == codes::SKIPPED.name || w.code == codes::MODEL_FORM.name;
        assert!(imported.warnings.iter().any(skipped) || kind.contains("scene"), "{kind}: {:?}", imported.warnings);
    }
    assert_eq!(loaded(&[("/cameras/0/perspective/yfov", json!(3.2))]).cameras[0].fovy, GREATEST_FOV);
}

#[test]
fn bytes_after_a_glb_are_ignored_and_a_shorter_file_is_said_to_be_cut_short() {
    let (document, binary) = whole();
    let file = glb(&document, &binary);
    let longer = [&file[..], b"trailing"].concat();
    assert_eq!(read(&longer).expect("trailing bytes are legal").warnings[0].code, codes::MODEL_FORM.name);
    for length in [0, 2, 6, 11, 12, 19, 30, file.len() / 2, file.len() - 1] {
        let report = read(&file[..length]).expect_err("not whole");
        assert!(report.has(codes::TRUNCATED), "{length}: {report}");
        assert!(report.diagnostics[0].help.as_deref().is_some_and(|help| help.contains("cut short")), "{report}");
    }
    let text = document.to_string();
    let report = read(&text.as_bytes()[..text.len() - 20]).expect_err("not whole");
    assert!(report.has(codes::TRUNCATED), "{report}");
}

/// A fault put into the model: changes, the cause, and the field that the message names.
type Case = (Vec<(&'static str, Value)>, Cause, &'static str);

fn cases() -> Vec<Case> {
    let one = |pointer, value: Value, cause, field| (vec![(pointer, value)], cause, field);
    let tree = vec![("/nodes/3/children", json!([1])), ("/scenes/0/nodes", json!([0, 2]))];
    let image = json!({ "uri": "data:image/png;base64,AAAA" });
    let near = json!({ "yfov": 0, "znear": 0.1 });
    vec![
        one("/accessors/0/count", Value::Null, Cause::Missing, "accessors[0].count"),
        one("/nodes/3/name", json!(5), Cause::WrongType, "nodes[3].name"),
        one("/cameras/0/perspective", near, Cause::Range, "cameras[0].perspective.yfov"),
        one("/materials/0/pbrMetallicRoughness/metallicFactor", json!(2), Cause::Range, "metallicFactor"),
        one("/accessors/3/bufferView", json!(99), Cause::Index, "accessors[3].bufferView"),
        one("/animations/0/channels/0/sampler", json!(7), Cause::Index, "animations[0].channels[0].sampler"),
        one("/buffers/0/byteLength", json!(99_999), Cause::ShortBuffer, "buffers[0].byteLength"),
        one("/bufferViews/8/byteLength", json!(99_999), Cause::Outside, "bufferViews[8].byteLength"),
        one("/accessors/0/count", json!(900), Cause::Outside, "accessors[0].bufferView"),
        one("/accessors/3/byteOffset", json!(1), Cause::Misaligned, "accessors[3].byteOffset"),
        one("/nodes/1/translation", json!([0, 1e300, 0]), Cause::NotFinite, "nodes[1].translation[1]"),
        one("/meshes/0/primitives/0/attributes/POSITION", json!(2), Cause::Format, "attributes.POSITION"),
        one("/meshes/0/primitives/0/indices", json!(0), Cause::Format, "primitives[0].indices"),
        one("/nodes/0/weights", json!([0, 0]), Cause::Count, "nodes[0].weights"),
        one("/nodes/1/scale", json!([1, 1]), Cause::Count, "nodes[1].scale"),
        (tree, Cause::Tree, "nodes[1]"),
        one("/nodes/0/children", json!([3]), Cause::Tree, "nodes[1].children[0]"),
        one(
            "/nodes/1/matrix",
            json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
            Cause::Conflict,
            "nodes[1].matrix",
        ),
        one("/extensionsRequired", json!(["EXT_unheard"]), Cause::Extension, "EXT_unheard"),
        one("/images/0", image, Cause::Image, "images[0]"),
        one("/images/0", json!({ "uri": "data:" }), Cause::Uri, "images[0].uri"),
        one("/nodes/0/translation", json!([0, 2000, 0]), Cause::Size, "\"Body\""),
        one("/accessors/8/count", json!(20_000_000), Cause::Count, "targets[0].POSITION"),
        one("/meshes/0/primitives/0/mode", json!(9), Cause::Range, "primitives[0].mode"),
    ]
}

#[test]
fn each_fault_is_named_with_its_field_and_the_remedy_of_its_cause() {
    let mut remedies = BTreeSet::new();
    for (changes, cause, field) in cases() {
        let report = changed(&changes).map(|_| ()).expect_err(field);
        let first = &report.diagnostics[0];
        let Code { name, .. } = cause.code();
        assert_eq!(first.code, name, "{field}: {report}");
        assert!(first.message.contains(field), "{field}: {report}");
        let help = first.help.clone().expect("a remedy");
        assert!(help == cause.help() || cause == Cause::Extension, "{field}: {report}");
        assert!(!help.contains("cut short"), "{field}: {report}");
        remedies.insert(help);
    }
    // One for each of the causes above.
    assert_eq!(remedies.len(), 16, "{remedies:#?}");
}

#[test]
fn data_is_checked_too() {
    let (document, mut binary) = whole();
    let put = |binary: &mut Vec<u8>, at: usize, bytes: &[u8]| binary[at..at + bytes.len()].copy_from_slice(bytes);
    let views = document["bufferViews"].as_array().expect("views").clone();
    let start = |view: usize| views[view]["byteOffset"].as_u64().expect("an offset") as usize;
    let good = binary.clone();
    let wrong: &[(usize, &[u8], Code, &str)] = &[
        (start(0), &f32::NAN.to_le_bytes(), codes::BROKEN_MODEL, "accessors[0]"),
        (start(3), &9_u16.to_le_bytes(), codes::BROKEN_MODEL, "vertex 9"),
        (start(3), &u16::MAX.to_le_bytes(), codes::BROKEN_MODEL, "restarting"),
        (start(4), &[7], codes::BROKEN_MODEL, "joint"),
        (start(6) + 4, &0_f32.to_le_bytes(), codes::BROKEN_MODEL, "order of time"),
        (start(6), &(-1_f32).to_le_bytes(), codes::BROKEN_MODEL, "before the start"),
        (start(6) + 4, &1e30_f32.to_le_bytes(), codes::MODEL_SIZE, "animations go to"),
        (start(7), &1e30_f32.to_le_bytes(), codes::MODEL_SIZE, "translations go to"),
        (start(0), &1e30_f32.to_le_bytes(), codes::MODEL_SIZE, "vertex 0"),
    ];
    for (at, bytes, code, text) in wrong {
        put(&mut binary, *at, bytes);
        let report = read(&glb(&document, &binary)).expect_err(text);
        assert!(report.has(*code) && report.diagnostics[0].message.contains(text), "{text}: {report}");
        binary.clone_from(&good);
    }
    for (at, bytes, text) in
        [(start(1), 3_f32, "NORMAL"), (start(5), 0.5, "WEIGHTS_0"), (start(0) + 12, 0.5, "accessors[0].max")]
    {
        put(&mut binary, at, &bytes.to_le_bytes());
        let warnings = read(&glb(&document, &binary)).expect("normalised when it is used").warnings;
        assert!(
            warnings.iter().any(|w| w.code == codes::MODEL_FORM.name && w.message.contains(text)),
            "{text}: {warnings:?}"
        );
        binary.clone_from(&good);
    }
}

#[test]
fn places_and_scales_that_a_museum_cannot_hold_are_refused_with_the_node_s_name() {
    let just = size::MAX_DISTANCE - 2.0;
    loaded(&[("/nodes/2/translation", json!([just, 0, 0]))]);
    loaded(&[("/nodes/2/scale", json!([0, 0, 0]))]);
    for value in [1e38, -1e38, 1e-38, 1e12, 1e-12] {
        let report = changed(&[("/nodes/2/scale", json!([value, 1, 1]))]).expect_err("no such scale");
        assert!(report.has(codes::MODEL_SIZE) && report.to_text().contains("\"Eye\""), "{value}: {report}");
    }
    let report = changed(&[("/nodes/2/translation", json!([1.1 * size::MAX_DISTANCE, 0, 0]))]).expect_err("too far");
    assert!(report.has(codes::MODEL_SIZE), "{report}");
    let glaring = ("/extensions/KHR_lights_punctual/lights/0/intensity", json!(1e38));
    let report = changed(&[glaring]).expect_err("too bright");
    assert!(report.has(codes::MODEL_SIZE) && report.diagnostics[0].message.contains("lights[0].intensity"), "{report}");
    let enlarged = [("/nodes/0/skin", Value::Null), ("/nodes/0/scale", json!([1500, 1, 1]))];
    assert!(changed(&enlarged).expect_err("a mesh of 1.5 km").to_text().contains("the mesh of node"));
}

#[test]
fn deep_and_wide_trees_are_read_in_linear_time_or_refused() {
    /// A chain of the whole 60 000 nodes took minutes when every node was followed to its root.
    const LIMIT: Duration = Duration::from_secs(2);
    let chain = |length: usize, chains: usize| {
        let nodes: Vec<Value> = (0..length * chains)
            .map(|i| if (i + 1) % length == 0 { json!({}) } else { json!({ "children": [i + 1] }) })
            .collect();
        json!({ "asset": { "version": "2.0" }, "nodes": nodes }).to_string()
    };
    for (length, chains, fits) in [(60_000, 1, false), (1000, 60, true), (1, 60_000, true)] {
        let start = ThreadTime::now();
        let result = read(chain(length, chains).as_bytes());
        assert!(start.elapsed() < LIMIT, "{length} × {chains}: {:?}", start.elapsed());
        assert_eq!(result.is_ok(), fits, "{length} × {chains}");
        if let Err(report) = result {
            assert!(
                report.has(codes::MODEL_LIMIT) && report.diagnostics[0].message.contains("nodes below its root"),
                "{report}"
            );
        }
    }
}

/// SplitMix64 (Steele et al. 2014).
struct Chance(u64);

impl Chance {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % n as u64) as usize
    }
}

/// Every pointer of a document.
fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
    let below: Vec<(String, &Value)> = match value {
        Value::Object(map) => map.iter().map(|(key, held)| (format!("{at}/{key}"), held)).collect(),
        Value::Array(list) => list.iter().enumerate().map(|(i, held)| (format!("{at}/{i}"), held)).collect(),
        _ => Vec::new(),
    };
    for (pointer, held) in below {
        pointers(held, &pointer, found);
        found.push(pointer);
    }
}

#[test]
fn damaged_models_neither_panic_nor_take_long() {
    const SEED: u64 = 20_261_201;
    const TRIES: usize = 4000;
    /// Longest time of one file.
    const LIMIT: Duration = Duration::from_secs(2);
    let values = [
        json!(0),
        json!(1),
        json!(-1),
        json!(2.0),
        json!(0.5),
        json!(1e38),
        json!(-1e300),
        json!(1e-38),
        json!(255),
        json!(16_000_000),
        json!(u32::MAX),
        json!(u64::MAX),
        json!(true),
        json!(null),
        json!(""),
        json!("MAT4"),
        json!([]),
        json!([0]),
        json!({}),
        json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
        json!(5126),
        json!(5120),
    ];
    let (document, binary) = whole();
    let mut places = Vec::new();
    pointers(&document, "", &mut places);
    let mut chance = Chance(SEED);
    let (mut refused, mut loaded) = (0, 0);
    for attempt in 0..TRIES {
        let (mut document, mut binary) = (document.clone(), binary.clone());
        for _ in 0..=chance.below(3) {
            let value = values[chance.below(values.len())].clone();
            if let Some(place) = document.pointer_mut(&places[chance.below(places.len())]) {
                *place = value;
            }
        }
        if chance.below(4) == 0 {
            let at = chance.below(binary.len());
            binary[at] = chance.below(256) as u8;
        }
        let mut file = glb(&document, &binary);
        if chance.below(8) == 0 {
            let at = chance.below(file.len());
            file[at] ^= 1 << chance.below(8);
        }
        let start = ThreadTime::now();
        match read(&file) {
            Ok(_) => loaded += 1,
            Err(report) => {
                assert!(!report.diagnostics.is_empty(), "seed {SEED}, {attempt}: an error without a message");
                refused += 1;
            }
        }
        assert!(start.elapsed() < LIMIT, "seed {SEED}, {attempt} took {:?}", start.elapsed());
    }
    // Names and unused numbers may change; most other changes make the model invalid.
    assert!(refused > TRIES / 2 && loaded > TRIES / 50, "{refused} refused, {loaded} loaded");
}
