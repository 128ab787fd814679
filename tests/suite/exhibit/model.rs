//! glTF files, good and broken: valid content is read correctly, and invalid content is refused without a panic.

use serde_json::json;
use soffio_exhibit::{codes, model};

use super::glb::{Folder, Scene, cuboid, sheet};

/// SplitMix64 (Steele et al. 2014): enough chance for a test, the same on every run.
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

fn good() -> Vec<u8> {
    let mut scene = Scene::default();
    let inner = scene.node("Inner", [0.0, 1.0, 0.0], Some(&cuboid([1.0, 2.0, 3.0])), &[]);
    scene.node("Outer", [1.0, 0.0, 0.0], Some(&sheet(1.0, 1.0)), &[inner]);
    scene.glb()
}

fn import(bytes: &[u8]) -> Result<model::Imported, soffio_exhibit::Report> {
    let folder = Folder::exhibit(bytes, "");
    model::import(&folder.file("model.glb"))
}

#[test]
fn nodes_meshes_and_flat_normals_are_read() {
    let model = import(&good()).expect("a good file").model;
    assert_eq!(model.roots, [1]);
    assert_eq!(model.nodes[0].parent, Some(1));
    assert_eq!(model.nodes[0].world.w_axis.truncate().to_array(), [1.0, 1.0, 0.0]);
    let outer = &model.meshes[model.nodes[1].mesh.expect("a mesh")].primitives[0];
    assert_eq!(outer.indices.len(), 6);
    assert!(outer.normals.iter().all(|n| *n == [0.0, 0.0, 1.0]), "{:?}", outer.normals);
}

#[test]
fn strips_and_fans_become_triangles_wound_alike_and_lines_are_left_out_with_a_warning() {
    let square = sheet(1.0, 1.0).0;
    let strip = (vec![square[0], square[1], square[3], square[2]], vec![0, 1, 2, 3]);
    let fan = (square.clone(), vec![0, 1, 2, 3]);
    let mut scene = Scene::default();
    for (name, shape, mode) in [("Strip", &strip, 5), ("Fan", &fan, 6), ("Line", &fan, 3)] {
        let mesh = scene.mesh(shape, mode);
        let node = scene.node(name, [0.0; 3], None, &[]);
        scene.set(node, "mesh", json!(mesh));
    }
    let imported = import(&scene.glb()).expect("a good file");
    for mesh in &imported.model.meshes[..2] {
        assert_eq!(mesh.primitives[0].indices.len(), 6);
        assert!(mesh.primitives[0].normals.iter().all(|n| *n == [0.0, 0.0, 1.0]));
    }
    assert!(imported.model.meshes[2].primitives.is_empty());
    assert_eq!(imported.warnings.len(), 1);
    assert_eq!(imported.warnings[0].code, codes::SKIPPED.name);
}

#[test]
fn a_required_extension_that_is_handled_passes_and_another_is_refused_with_a_remedy() {
    let with = |name: &str| {
        let mut scene = Scene::default();
        scene.node("Box", [0.0; 3], Some(&cuboid([1.0; 3])), &[]);
        scene.extra = vec![("extensionsUsed", json!([name])), ("extensionsRequired", json!([name]))];
        import(&scene.glb())
    };
    // The gltf crate refuses both of these on its own.
    assert!(with("KHR_materials_specular").is_ok());
    assert!(with("KHR_mesh_quantization").is_ok());
    let report = with("KHR_draco_mesh_compression").expect_err("not supported");
    assert!(report.has(codes::EXTENSION));
    assert!(report.to_string().contains("gltf-transform"), "{report}");
}

#[test]
fn a_ring_of_nodes_and_a_path_out_of_the_folder_are_refused() {
    let mut scene = Scene::default();
    let a = scene.node("A", [0.0; 3], None, &[1]);
    scene.node("B", [0.0; 3], None, &[a]);
    assert!(import(&scene.glb()).expect_err("a ring").has(codes::CYCLE));
    let mut scene = Scene::default();
    scene.node("Box", [0.0; 3], Some(&cuboid([1.0; 3])), &[]);
    scene.extra = vec![("buffers", json!([{ "byteLength": 1000, "uri": "../../etc/passwd" }]))];
    assert!(import(&scene.glb()).expect_err("outside").has(codes::OUTSIDE));
}

#[test]
fn a_file_cut_short_anywhere_gives_one_message() {
    const SEED: u64 = 20_250_711;
    let whole = good();
    let mut chance = Chance(SEED);
    let folder = Folder::exhibit(&whole, "");
    for _ in 0..200 {
        let length = chance.below(whole.len());
        folder.write("model.glb", &whole[..length]);
        let report = model::import(&folder.file("model.glb")).expect_err("cut short");
        assert_eq!(report.diagnostics.len(), 1, "seed {SEED}, cut at {length}: {report}");
    }
}

#[test]
fn flipped_bytes_never_panic() {
    const SEED: u64 = 20_250_712;
    let whole = good();
    let mut chance = Chance(SEED);
    let folder = Folder::exhibit(&whole, "");
    let mut refused = 0;
    for _ in 0..400 {
        let mut bytes = whole.clone();
        for _ in 0..=chance.below(4) {
            let at = chance.below(bytes.len());
            bytes[at] ^= 1 << chance.below(8);
        }
        folder.write("model.glb", &bytes);
        refused += usize::from(model::import(&folder.file("model.glb")).is_err());
    }
    // A flip inside a coordinate makes another good file; one in the JSON mostly does not.
    assert!((40..400).contains(&refused), "seed {SEED}: {refused} of 400 refused");
}
