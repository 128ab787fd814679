//! Models from elsewhere: what glTF 2.0 allows is taken as it is meant, and no broken or hostile file does harm.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use soffio_exhibit::model::{self, Imported, Levels, Wrap};

/// Rounding of single-precision numbers near 1, and of quantised ones.
const ROUNDING: f32 = 2e-4;

/// A GLB of JSON and a binary chunk.
fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let mut out = b"glTF".to_vec();
    out.extend(word(2));
    out.extend(word(12 + 8 + text.len() + 8 + bin.len()));
    out.extend(word(text.len()));
    out.extend(b"JSON");
    out.extend(text);
    out.extend(word(bin.len()));
    out.extend(b"BIN\0");
    out.extend(bin);
    out
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// Three corners, three normals, three indices, one image of one pixel's size in JSON only: 78 bytes and 2 spare.
fn triangle() -> (Value, Vec<u8>) {
    let mut bin = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    bin.extend(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    bin.extend([0u8, 0, 1, 0, 2, 0, 0, 0]);
    let json = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "a", "mesh": 0, "children": [1]}, {"name": "b"}],
        "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": 80}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 36},
            {"buffer": 0, "byteOffset": 72, "byteLength": 6}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"}
        ]
    });
    (json, bin)
}

/// Sets the value at a JSON pointer; a missing last key is added.
fn set(json: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    let parent = json.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer} leads nowhere"));
    match parent {
        Value::Array(list) => list[key.parse::<usize>().expect("an index")] = value,
        other => other[key] = value,
    }
}

fn import(json: &Value, bin: &[u8]) -> Result<Imported, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.glb");
    std::fs::write(&path, glb(json, bin)).expect("written");
    model::import(&path).map_err(|report| report.to_text())
}

#[test]
fn sparse_and_quantised_positions_are_what_they_stand_for() {
    let (mut json, mut bin) = triangle();
    // Corner 1 is replaced by (2, 0, 0) in three floats at byte 80, index 1 at byte 92.
    bin.extend(floats(&[2.0, 0.0, 0.0]));
    bin.extend([1u8, 0, 0, 0]);
    set(&mut json, "/buffers/0/byteLength", json!(96));
    let views = json["bufferViews"].as_array_mut().expect("a list");
    views.push(json!({"buffer": 0, "byteOffset": 80, "byteLength": 12}));
    views.push(json!({"buffer": 0, "byteOffset": 92, "byteLength": 1}));
    set(
        &mut json,
        "/accessors/0/sparse",
        json!({"count": 1, "indices": {"bufferView": 4, "componentType": 5121}, "values": {"bufferView": 3}}),
    );
    let sparse = import(&json, &bin).expect("sparse accessors are core");
    assert_eq!(sparse.model.meshes[0].primitives[0].positions[1], [2.0, 0.0, 0.0]);

    let (mut json, _) = triangle();
    // Normalised 16-bit positions at a stride of 8 bytes, normals in signed bytes at a stride of 4.
    let mut bin = Vec::new();
    for corner in [[0i16, 0, 0], [32767, 0, 0], [0, -32767, 0]] {
        bin.extend(corner.iter().flat_map(|c| c.to_le_bytes()));
        bin.extend([0, 0]);
    }
    bin.extend([0u8, 0, 127, 0].repeat(3));
    bin.extend([0u8, 0, 1, 0, 2, 0]);
    json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    json["buffers"] = json!([{"byteLength": bin.len()}]);
    json["bufferViews"] = json!([
        {"buffer": 0, "byteOffset": 0, "byteLength": 24, "byteStride": 8},
        {"buffer": 0, "byteOffset": 24, "byteLength": 12, "byteStride": 4},
        {"buffer": 0, "byteOffset": 36, "byteLength": 6}
    ]);
    json["accessors"] = json!([
        {"bufferView": 0, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3", "min": [0, -32767, 0], "max": [32767, 0, 0]},
        {"bufferView": 1, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
        {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"}
    ]);
    let quantised = import(&json, &bin).expect("KHR_mesh_quantization is handled");
    let part = &quantised.model.meshes[0].primitives[0];
    assert!((part.positions[2][1] + 1.0).abs() < ROUNDING && (part.normals[0][2] - 1.0).abs() < ROUNDING, "{part:?}");
}

#[test]
fn a_morph_stands_at_its_weights_and_a_skin_at_its_joints() {
    let (mut json, mut bin) = triangle();
    bin.extend(floats(&[0.0, 0.0, 4.0, 0.0, 0.0, 4.0, 0.0, 0.0, 4.0]));
    set(&mut json, "/buffers/0/byteLength", json!(116));
    json["bufferViews"].as_array_mut().expect("a list").push(json!({"buffer": 0, "byteOffset": 80, "byteLength": 36}));
    json["accessors"].as_array_mut().expect("a list").push(
        json!({"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 4], "max": [0, 0, 4]}),
    );
    set(&mut json, "/meshes/0/primitives/0/targets", json!([{"POSITION": 3}]));
    set(&mut json, "/meshes/0/weights", json!([0.5]));
    set(&mut json, "/nodes/0/weights", json!([0.25]));
    let morphed = import(&json, &bin).expect("morph targets are core");
    let mesh = morphed.model.nodes[0].mesh.expect("a mesh");
    assert_eq!(morphed.model.meshes[mesh].primitives[0].positions[0], [0.0, 0.0, 1.0], "the node's weight wins");

    let (mut json, mut bin) = triangle();
    // All corners on joint 1 (the second of the skin), which stands at (0, 0, 3); no inverse bind matrices.
    bin.extend([1u8, 0, 0, 0].repeat(3));
    bin.extend(floats(&[1.0, 0.0, 0.0, 0.0].repeat(3)));
    set(&mut json, "/buffers/0/byteLength", json!(140));
    let views = json["bufferViews"].as_array_mut().expect("a list");
    views.push(json!({"buffer": 0, "byteOffset": 80, "byteLength": 12}));
    views.push(json!({"buffer": 0, "byteOffset": 92, "byteLength": 48}));
    let accessors = json["accessors"].as_array_mut().expect("a list");
    accessors.push(json!({"bufferView": 3, "componentType": 5121, "count": 3, "type": "VEC4"}));
    accessors.push(json!({"bufferView": 4, "componentType": 5126, "count": 3, "type": "VEC4"}));
    set(&mut json, "/meshes/0/primitives/0/attributes/JOINTS_0", json!(3));
    set(&mut json, "/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(4));
    json["nodes"] = json!([
        {"mesh": 0, "skin": 0, "translation": [9.0, 0.0, 0.0]}, {}, {"translation": [0.0, 0.0, 3.0]}
    ]);
    json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    json["skins"] = json!([{"joints": [1, 2]}]);
    let skinned = import(&json, &bin).expect("skins are core");
    let node = &skinned.model.nodes[0];
    let local = skinned.model.meshes[node.mesh.expect("a mesh")].primitives[0].positions[1];
    // The node's own place does not matter: what counts is where the joints are.
    let world = node.world.as_mat4().transform_point3(local.into());
    assert!((world - glam::Vec3::new(1.0, 0.0, 3.0)).length() < ROUNDING, "{world}");
}

#[test]
fn textures_are_moved_wrapped_and_taken_from_the_second_set() {
    let (mut json, mut bin) = triangle();
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(2, 2, image::Rgba([9, 8, 7, 255]))
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("a picture");
    let png = png.into_inner();
    bin.extend(&png);
    set(&mut json, "/buffers/0/byteLength", json!(80 + png.len()));
    json["bufferViews"]
        .as_array_mut()
        .expect("a list")
        .push(json!({"buffer": 0, "byteOffset": 80, "byteLength": png.len()}));
    json["images"] = json!([{"bufferView": 3, "mimeType": "image/png"}]);
    json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648, "minFilter": 9728, "magFilter": 9728}]);
    json["textures"] = json!([{"source": 0, "sampler": 0}]);
    json["extensionsRequired"] = json!(["KHR_texture_transform"]);
    let quarter = std::f64::consts::FRAC_PI_2;
    json["materials"] = json!([{
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {
            "offset": [0.5, 0.25], "rotation": quarter, "scale": [2.0, 3.0], "texCoord": 1
        }}}},
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_ior": {"ior": 1.4},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.5}, "KHR_materials_unlit": {}
        }
    }]);
    let model = import(&json, &bin).expect("all of it is handled").model;
    let look = &model.materials[0];
    let texture = look.base_color_texture.expect("a texture");
    assert_eq!((texture.set, texture.sampler.wrap), (1, [Wrap::Clamp, Wrap::Mirror]));
    assert!(!texture.sampler.smooth_near && texture.sampler.levels == Levels::None);
    // Khronos' example matrix: translation · rotation · scale; a quarter turn takes (1, 0) · 2 to (0, −2).
    let at = |u: f32, v: f32| texture.transform.map(|[a, b, c]| a * u + b * v + c);
    let near = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).abs() < ROUNDING && (a[1] - b[1]).abs() < ROUNDING;
    assert!(near(at(1.0, 0.0), [0.5, -1.75]) && near(at(0.0, 1.0), [3.5, 0.25]), "{:?}", texture.transform);
    assert_eq!((look.transmission, look.ior, look.coat, look.unlit), (0.9, 1.4, 0.5, true));
}

#[test]
fn strips_and_fans_are_wound_alike_and_hidden_nodes_are_known() {
    let square = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    for (mode, order) in [(5, [0, 1, 2, 3]), (6, [0, 1, 3, 2])] {
        let mut bin = square.clone();
        bin.extend(order.map(|i: u8| i));
        let json = json!({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "children": [1], "extensions": {"KHR_node_visibility": {"visible": false}}}, {"mesh": 0}],
            "extensionsUsed": ["KHR_node_visibility"], "extensionsRequired": ["KHR_node_visibility"],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": mode}]}],
            "buffers": [{"byteLength": 52}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 4}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"}
            ]
        });
        let model = import(&json, &bin).expect("strips and fans are core").model;
        let part = &model.meshes[0].primitives[0];
        assert_eq!(part.indices.len(), 6, "mode {mode}");
        assert!(part.normals.iter().all(|n| *n == [0.0, 0.0, 1.0]), "mode {mode}: {:?}", part.normals);
        assert_eq!(model.hidden, [0, 1], "what hangs below a hidden node is hidden too");
    }
}

#[test]
fn a_required_unsupported_extension_is_refused_with_the_remedy() {
    let expected = [
        ("KHR_draco_mesh_compression", "gltf-transform"),
        ("EXT_meshopt_compression", "gltf-transform"),
        ("KHR_texture_basisu", "gltf-transform png"),
        ("VENDOR_undetected_of", "export the model again without it"),
    ];
    for (extension, remedy) in expected {
        let (mut json, bin) = triangle();
        json["extensionsRequired"] = json!([extension]);
        let error = import(&json, &bin).expect_err("not supported");
        assert!(error.contains(extension) && error.contains(remedy), "{error}");
    }
}

/// A broken or hostile file and a word that its message must have.
struct Bad {
    name: String,
    bytes: Vec<u8>,
    word: &'static str,
}

/// A hundred of them and a few, each from the same good triangle.
fn bad_files() -> Vec<Bad> {
    let mut list = Vec::new();
    let (good_json, good_bin) = triangle();
    let good = glb(&good_json, &good_bin);
    let mut bytes = |name: String, bytes: Vec<u8>, word| list.push(Bad { name, bytes, word });
    // Cut short: anywhere in the header, the JSON, and the binary chunk.
    for i in 0..20 {
        bytes(format!("cut at {i}/20"), good[..good.len() * i / 20].to_vec(), "model.glb");
    }
    for (at, name) in [(4, "version"), (8, "length"), (12, "JSON length"), (16, "JSON kind"), (20, "JSON text")] {
        let mut broken = good.clone();
        broken[at..at + 4].copy_from_slice(&[0xff; 4]);
        bytes(format!("{name} overwritten"), broken, "model.glb");
    }
    bytes("an empty GLB".into(), glb(&json!({}), &[]), "asset");
    bytes("JSON of a thousand brackets".into(), vec![b'['; 100_000], "JSON");
    let mut changed = |pointer: &str, value: Value, word| {
        let mut json = good_json.clone();
        set(&mut json, pointer, value.clone());
        let shown: String = value.to_string().chars().take(24).collect();
        list.push(Bad { name: format!("{pointer} = {shown}"), bytes: glb(&json, &good_bin), word });
    };
    let huge = 4_000_000_000u64;
    for (accessor, count) in [(0, huge), (1, huge), (2, huge), (0, 1 << 40), (2, 15_999_999), (0, 4), (2, 4)] {
        changed(&format!("/accessors/{accessor}/count"), json!(count), "accessor");
    }
    for accessor in 0..3 {
        changed(&format!("/accessors/{accessor}/byteOffset"), json!(huge), "accessor");
        changed(&format!("/accessors/{accessor}/bufferView"), json!(99), "accessors");
        changed(&format!("/accessors/{accessor}/componentType"), json!(7), "accessors");
        changed(&format!("/accessors/{accessor}/type"), json!("VEC9"), "accessors");
        changed(&format!("/bufferViews/{accessor}/buffer"), json!(5), "bufferViews");
        changed(&format!("/bufferViews/{accessor}/byteLength"), json!(1), "accessor");
        changed(&format!("/bufferViews/{accessor}/byteOffset"), json!(huge), "bufferViews");
        changed(&format!("/accessors/{accessor}/count"), json!(-1), "accessors");
    }
    changed("/accessors/1/count", json!(2), "attributes.NORMAL");
    changed("/accessors/0/type", json!("SCALAR"), "accessors[0]");
    changed("/accessors/1/type", json!("VEC2"), "accessors[1]");
    changed("/accessors/2/componentType", json!(5126), "accessors[2]");
    changed("/accessors/2/type", json!("VEC3"), "accessors[2]");
    changed("/bufferViews/0/byteStride", json!(255), "byteStride");
    changed("/meshes/0/primitives/0/attributes/POSITION", json!(77), "attributes.POSITION");
    changed("/meshes/0/primitives/0/attributes/NORMAL", json!(77), "meshes");
    changed("/meshes/0/primitives/0/indices", json!(77), "meshes");
    changed("/meshes/0/primitives/0/indices", json!(0), "accessors[0]");
    changed("/meshes/0/primitives/0/material", json!(3), "primitives[0].material");
    changed("/meshes/0/primitives/0/mode", json!(9), "mode");
    changed("/meshes/0/primitives/0/attributes", json!({"POSITION": "0"}), "POSITION");
    changed("/meshes/0/primitives", json!(7), "meshes[0].primitives");
    changed("/nodes/0/children", json!([0]), "its own child");
    changed("/nodes/1/children", json!([0]), "its own ancestor");
    changed("/nodes/0/children", json!([1, 1]), "parents");
    changed("/nodes/0/children", json!([55]), "nodes");
    changed("/nodes/0/mesh", json!(4), "nodes");
    changed("/nodes/0/camera", json!(4), "nodes");
    changed("/nodes/0/skin", json!(4), "nodes");
    changed("/nodes/0/matrix", json!([1, 0, 0]), "nodes[0].matrix");
    changed("/nodes/0/matrix", json!(vec![1e39; 16]), "infinite");
    changed("/nodes/0/rotation", json!([0, 0, 0, 0]), "nodes[0].rotation");
    changed("/nodes/0/scale", json!([1e39, 1, 1]), "infinite");
    changed("/nodes/0/translation", json!("far"), "nodes[0].translation");
    changed("/scenes/0/nodes", json!([12]), "scenes");
    changed("/scene", json!(3), "scene");
    changed("/asset/version", json!("1.0"), "version");
    changed("/asset/minVersion", json!("2.1"), "asset.minVersion");
    changed("/asset", json!({}), "version");
    changed("/buffers/0/byteLength", json!(huge), "buffers[0]");
    changed("/buffers/0/uri", json!("/etc/passwd"), "/etc/passwd");
    changed("/buffers/0/uri", json!("../../../../etc/passwd"), "leaves");
    changed("/buffers/0/uri", json!("..%2f..%2f..%2fetc%2fpasswd"), "leaves");
    changed("/buffers/0/uri", json!("http://example.org/a.bin"), "inside the exhibit folder");
    changed("/buffers/0/uri", json!("file:///etc/passwd"), "inside the exhibit folder");
    changed("/buffers/0/uri", json!("C:\\windows\\win.ini"), "inside the exhibit folder");
    changed("/buffers/0/uri", json!("missing.bin"), "missing.bin");
    changed("/buffers/0/uri", json!("data:application/octet-stream;base64,!!!!"), "data URI");
    changed("/buffers/0/uri", json!("data:application/octet-stream;base64,AAAA"), "buffers[0]");
    changed("/buffers/0/uri", json!("data:"), "buffers[0]");
    changed("/images", json!([{"uri": "/etc/passwd"}]), "/etc/passwd");
    changed("/images", json!([{"uri": "../secret.png"}]), "leaves");
    changed("/images", json!([{"uri": "https://example.org/a.png"}]), "inside the exhibit folder");
    changed("/images", json!([{"uri": "data:image/png;base64,AAAA"}]), "images[0]");
    changed("/images", json!([{"bufferView": 9, "mimeType": "image/png"}]), "images");
    changed("/images", json!([{"bufferView": 0, "mimeType": "image/png"}]), "images[0]");
    changed("/images", json!([{}]), "images[0]");
    changed("/textures", json!([{"source": 3}]), "textures");
    changed("/skins", json!([{"joints": [90]}]), "skins");
    changed(
        "/animations",
        json!([{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": []}]),
        "animations",
    );
    changed(
        "/animations",
        json!([{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 0, "output": 0}]}]),
        "animation",
    );
    changed("/extensionsRequired", json!(["EXT_unknown"]), "EXT_unknown");
    // Numbers that are not finite, and a vertex that does not exist.
    let mut poison = |name: &str, at: usize, bytes: [u8; 4], word| {
        let mut bin = good_bin.clone();
        bin[at..at + 4].copy_from_slice(&bytes);
        list.push(Bad { name: name.into(), bytes: glb(&good_json, &bin), word });
    };
    poison("a position is NaN", 4, f32::NAN.to_le_bytes(), "accessors[0]");
    poison("a position is infinite", 8, f32::INFINITY.to_le_bytes(), "accessors[0]");
    poison("a normal is NaN", 40, f32::NAN.to_le_bytes(), "accessors[1]");
    poison("an index is out of range", 72, [255, 255, 0, 0], "accessors[2]");
    // A picture that claims to be 60,000 pixels wide.
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xea\x60\0\0\xea\x60\x08\x06\0\0\0".to_vec();
    png.extend([0; 16]);
    let mut json = good_json.clone();
    json["images"] = json!([{"bufferView": 3, "mimeType": "image/png"}]);
    json["buffers"] = json!([{"byteLength": 80 + png.len()}]);
    json["bufferViews"]
        .as_array_mut()
        .expect("a list")
        .push(json!({"buffer": 0, "byteOffset": 80, "byteLength": png.len()}));
    list.push(Bad {
        name: "a vast picture".into(),
        bytes: glb(&json, &[good_bin.clone(), png].concat()),
        word: "images[0]",
    });
    // A chain of a hundred thousand nodes.
    let mut json = good_json;
    json["nodes"] = (0..100_000).map(|i| if i < 99_999 { json!({"children": [i + 1]}) } else { json!({}) }).collect();
    list.push(Bad { name: "a chain of 100,000 nodes".into(), bytes: glb(&json, &good_bin), word: "nodes" });
    list
}

#[test]
fn a_hundred_bad_files_do_no_harm_and_say_what_is_wrong() {
    /// Address space of the program, KiB: what it needs for a good file, and 256 MiB more.
    const SPACE: u64 = (256 + 160) << 10;
    /// Processor time and time of each file, the start of the program included; a busy machine stretches the second.
    const SECONDS: u64 = 2;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.glb");
    let run = |path: &Path| {
        let limits = format!("ulimit -v {SPACE}; ulimit -t {SECONDS}; exec \"$0\" check \"$1\"");
        let begin = Instant::now();
        let output =
            Command::new("sh").args(["-c", &limits, env!("CARGO_BIN_EXE_soffio")]).arg(path).output().expect("sh");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned(), begin.elapsed())
    };
    let (json, bin) = triangle();
    std::fs::write(&path, glb(&json, &bin)).expect("written");
    assert_eq!(run(&path).0, Some(0), "the good file is good within the limits: {}", run(&path).1);
    let files = bad_files();
    assert!(files.len() >= 100, "{}", files.len());
    let mut failures = Vec::new();
    for Bad { name, bytes, word } in files {
        std::fs::write(&path, bytes).expect("written");
        let (code, said, took) = run(&path);
        if code != Some(1)
            || !said.contains(word)
            || !said.contains("help: ")
            || said.contains("panicked")
            || took > Duration::from_secs(5 * SECONDS)
        {
            failures.push(format!("{name}: exit {code:?} after {took:?}, wanted \"{word}\" and a remedy in\n{said}"));
        }
    }
    assert!(failures.is_empty(), "{} of them:\n{}", failures.len(), failures.join("\n"));
}
