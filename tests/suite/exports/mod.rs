//! What goes out to other programs: glTF read back, a MuJoCo model's numbers, RenderMan scenes, frames and videos.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use soffio_exhibit::model::{self, Model};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::{DQuat, DVec3, PI, Pose};
use soffio_offline::export::key_frames::AnimationBake;
use soffio_offline::export::mjcf;
use soffio_offline::feed::WavFeed;
use soffio_offline::play::{self, Play};
use soffio_offline::wav;
use soffio_simulation::Snapshot;

#[cfg(feature = "kiosk")]
mod films;

/// What key frames that were left out may cost, and the single precision of what is written, m.
const PLACE: f64 = 1e-5 + 1e-6;
/// Single precision of numbers near 1.
const SINGLE: f64 = 1e-6;

fn shipped(id: &str) -> Arc<Exhibit> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    Arc::new(exhibit::load(&folder).expect("a shipped exhibit"))
}

/// The poses of each frame of a run that answers a strong breath.
fn frames(exhibit: &Arc<Exhibit>, seconds: f64, fps: u32, mut each: impl FnMut(&Snapshot)) -> Vec<Vec<Pose>> {
    let breath = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish/breaths/strong.wav");
    let recording = wav::read(breath).expect("shipped");
    let play = Play { breath: Some(WavFeed::from(&recording)), seconds, fps, aspect: 16.0 / 9.0, ..Play::default() };
    let mut all = Vec::new();
    let mut on_frame = |_: u64, now: &Snapshot| {
        each(now);
        all.push(now.poses.clone());
        Ok(())
    };
    play::run(exhibit, play, &AtomicBool::new(false), |_| (), Some(&mut on_frame)).expect("a run");
    all
}

/// Writes bytes as a `.glb` and reads them with the loader of all models.
fn read(bytes: &[u8]) -> Model {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("model.glb");
    std::fs::write(&path, bytes).expect("writable");
    model::load(&path).unwrap_or_else(|report| panic!("{report}"))
}

#[test]
fn key_frames_read_back_are_where_the_run_was_in_every_step() {
    let exhibit = shipped("steel-fish");
    let mut bake = AnimationBake::new(&exhibit, 240);
    let all = frames(&exhibit, 2.0, 240, |now| bake.push(&now.poses));
    let model = read(&bake.bytes(&exhibit));
    let [animation] = model.animations.as_slice() else { panic!("one animation") };
    let mut moved: f64 = 0.0;
    for (index, body) in exhibit.bodies.iter().enumerate() {
        let node = model.nodes.iter().position(|node| node.name == body.name).expect("a node a body");
        assert!(model.nodes[node].parent.is_none(), "{} is a root", body.name);
        // Where its wires bend, and its origin.
        let wires = exhibit.wires.iter().filter(|wire| wire.body == Some(index));
        let points: Vec<DVec3> = wires.flat_map(|wire| wire.points.iter().copied()).chain([DVec3::ZERO]).collect();
        for (k, poses) in all.iter().enumerate() {
            let (_, rotation, position) =
                animation.world(&model, node, k as f64 / 240.0).to_scale_rotation_translation();
            let shown = Pose { rotation, position };
            for &point in &points {
                let apart = shown.point(point).distance(poses[index].point(point));
                assert!(apart < PLACE, "{} at step {k}: {apart} m", body.name);
            }
            moved = moved.max(poses[index].position.distance(all[0][index].position));
        }
    }
    assert!(moved > 0.01, "a run in which nothing moves shows nothing: {moved} m");
    let keys: usize = animation.channels.iter().map(|channel| channel.times.len()).sum();
    assert!(keys < all.len() * 2 * exhibit.bodies.len(), "some key frames are left out: {keys}");
    let wires = exhibit.wires.iter().filter(|wire| model.nodes.iter().any(|node| node.name == wire.name)).count();
    assert_eq!(wires, exhibit.wires.len(), "wires are meshes");
}

#[test]
fn textures_lights_and_layers_read_back_as_they_were() {
    use model::{
        Appearance, Image, Levels, Light, LightKind, Mesh, Node, Primitive, Sampler, ScaledTexture, TextureUse, Wrap,
    };
    let (s, c) = (0.6_f32, 0.8_f32);
    let texture = TextureUse {
        image: 0,
        set: 1,
        transform: [[c * 2.0, s * 3.0, 0.25], [-s * 2.0, c * 3.0, -0.5]],
        sampler: Sampler {
            wrap: [Wrap::Mirror, Wrap::Clamp],
            smooth_near: false,
            smooth_far: true,
            levels: Levels::None,
        },
    };
    let plain = TextureUse { set: 1, ..TextureUse::of(0) };
    let look = Appearance {
        name: "all".into(),
        base_color_texture: Some(texture),
        normal_texture: Some(ScaledTexture { texture: TextureUse::of(0), scale: 0.5 }),
        emissive: [4.0, 2.0, 0.0],
        alpha: model::AlphaMode::Mask(0.25),
        double_sided: true,
        ior: 1.45,
        transmission: 0.5,
        thickness: 0.01,
        attenuation_distance: 0.2,
        attenuation_color: [0.5, 0.75, 1.0],
        coat: 0.5,
        sheen: [0.25, 0.5, 0.75],
        specular: 0.5,
        details: model::Details {
            transmission: Some(plain),
            thickness: Some(plain),
            specular: Some(plain),
            specular_color: Some(plain),
            coat: Some(plain),
            coat_roughness: Some(plain),
            coat_normal: Some(ScaledTexture { texture: plain, scale: 0.5 }),
            sheen: Some(plain),
            sheen_roughness: Some(plain),
        },
        ..Appearance::default()
    };
    let corner = |x: f32, y: f32| [x, y, 0.0];
    let primitive = Primitive {
        positions: vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        tangents: vec![[1.0, 0.0, 0.0, -1.0]; 3],
        uvs: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        second_uvs: vec![[0.5, 0.0], [1.0, 0.5], [0.0, 1.0]],
        colors: vec![[0.25, 0.5, 0.75, 1.0]; 3],
        indices: vec![0, 1, 2],
        material: Some(0),
        ..Primitive::default()
    };
    let local = soffio_math::DMat4::from_scale_rotation_translation(
        DVec3::new(2.0, 0.5, 1.0),
        DQuat::from_rotation_y(0.3),
        DVec3::new(0.1, 0.2, 0.3),
    );
    let node = Node {
        name: "one".into(),
        parent: None,
        children: Vec::new(),
        local,
        world: local,
        mesh: Some(0),
        camera: None,
        light: Some(0),
    };
    let light = Light { kind: LightKind::Spot(0.25, 0.5), color: DVec3::ONE, intensity: 2.0, range: 3.0 };
    let before = Model {
        nodes: vec![node],
        roots: vec![0],
        meshes: vec![Mesh { name: "one".into(), primitives: vec![primitive] }],
        materials: vec![look],
        images: vec![Arc::new(Image { width: 2, height: 1, rgba: vec![1, 2, 3, 4, 5, 6, 7, 8] })],
        lights: vec![light],
        ..Model::default()
    };
    let after = read(&soffio_authoring::model_writer::write(&before, ""));
    let (mut was, mut is) = (before.materials[0].clone(), after.materials[0].clone());
    let turned = is.base_color_texture.take().expect("a texture");
    was.base_color_texture = None;
    assert_eq!(format!("{was:?}"), format!("{is:?}"));
    assert_eq!((turned.set, turned.sampler), (texture.set, texture.sampler));
    for (row, wanted) in turned.transform.iter().flatten().zip(texture.transform.iter().flatten()) {
        assert!((row - wanted).abs() < 1e-6, "{:?}", turned.transform);
    }
    assert_eq!(after.images[0].rgba, before.images[0].rgba);
    let (part, again) = (&before.meshes[0].primitives[0], &after.meshes[0].primitives[0]);
    assert_eq!(format!("{part:?}"), format!("{again:?}"));
    assert_eq!(after.lights, before.lights);
    assert!(after.nodes[0].local.abs_diff_eq(local, SINGLE), "{:?}", after.nodes[0].local);
}

/// Numbers of an attribute of the first element that begins with `head`.
fn attribute(text: &str, head: &str, key: &str) -> Vec<f64> {
    let element = text.split('<').find(|element| element.starts_with(head)).unwrap_or_else(|| panic!("no {head}"));
    let rest = element.split(&format!(" {key}=\"")).nth(1).unwrap_or_else(|| panic!("{head} has no {key}"));
    let numbers = rest.split('"').next().expect("a closing quote").split(' ');
    numbers.map(|x| x.parse().unwrap_or_else(|_| panic!("{key}: {x}"))).collect()
}

#[test]
fn the_pendulums_numbers_in_mujocos_words_beat_6720_times_an_hour() {
    let text = mjcf::export(&shipped("pendulum")).text;
    let (mass, center) = (attribute(&text, "inertial", "mass")[0], attribute(&text, "inertial", "pos"));
    let (inertia, hinge) = (attribute(&text, "inertial", "fullinertia"), attribute(&text, "joint", "pos"));
    let axis = attribute(&text, "joint", "axis");
    let gravity = -attribute(&text, "option", "gravity")[1];
    assert!((axis[2].abs() - 1.0).abs() < SINGLE, "{axis:?}");
    let arm = (center[0] - hinge[0]).hypot(center[1] - hinge[1]);
    // Small swings: T = 2π √(I/(m g d)), I about the hinge.
    let period = 2.0 * PI * ((inertia[2] + mass * arm * arm) / (mass * gravity * arm)).sqrt();
    let beats = 2.0 * 3600.0 / period;
    // The forge places the bob to a fraction of a beat an hour.
    assert!((beats - 6720.0).abs() < 1.0, "{beats}");
}

#[cfg(feature = "kiosk")]
#[test]
fn a_scene_a_frame_holds_the_poses_of_both_ends_of_its_shutter() {
    use soffio_offline::export::rib::RibWriter;
    let exhibit = shipped("steel-fish");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut writer = RibWriter::create(&exhibit, folder.path(), (320, 180), 24).expect("writable");
    let mut number = 0;
    let poses = frames(&exhibit, 1.5, writer.samples_per_second(), |now| {
        writer.push(number, &now.poses).expect("writable");
        number += 1;
    });
    // 1.5 s of 24 frames, and the shutter that opens at the end never closes.
    assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 36 + 1);
    let frame = 30;
    let text = std::fs::read_to_string(folder.path().join(format!("frame.{frame:06}.rib"))).expect("written");
    for word in ["Frame", "World", "Attribute", "Motion"] {
        let count = |end: &str| text.lines().filter(|line| line.trim().starts_with(&format!("{word}{end}"))).count();
        assert!(count("Begin") == count("End") && count("Begin") > 0, "{word}");
    }
    for archive in text.split("ReadArchive \"").skip(1) {
        let name = archive.split('"').next().expect("a closing quote");
        assert!(folder.path().join(name).is_file(), "{name}");
    }
    let matrices: Vec<Vec<f64>> = text
        .split("MotionBegin")
        .skip(1)
        .flat_map(|block| block.split("ConcatTransform [").skip(1).take(2))
        .map(|matrix| {
            matrix.split(']').next().expect("a bracket").split(' ').map(|x| x.parse().expect("a number")).collect()
        })
        .collect();
    // The fish hangs on the boom, the first body, whose parts come first.
    for (matrix, moment) in matrices.iter().zip([2 * frame, 2 * frame + 1]) {
        let wanted = exhibit.bodies.iter().enumerate().map(|(body, _)| poses[moment][body].matrix().to_cols_array());
        let apart = wanted.map(|w| w.iter().zip(matrix).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
        // Nine decimals are written.
        assert!(apart.fold(f64::INFINITY, f64::min) < 1e-8, "moment {moment}: {matrix:?}");
    }
    assert_ne!(matrices[0], matrices[1], "it moves while the shutter is open");
}
