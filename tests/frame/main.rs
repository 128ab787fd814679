//! What drawing costs beside time, counted: memory asked for in a frame, and what a change of work makes and keeps.
//!
//! A binary of its own, because its allocator counts: every request of every thread.

use std::sync::{Mutex, MutexGuard, PoisonError};

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

use soffio_exhibit::Exhibit;
use soffio_kiosk::step::frame_interpolation::SnapshotHistory;
use soffio_math::{DQuat, Pose};
use soffio_render::{Baked, FrameInput, Gpu, Options, RenderError, Renderer};
use soffio_simulation::{DustParticle, Settings, Simulation, Snapshot, StepInput};

#[path = "../suite/require.rs"]
mod require;

use require::require;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<std::alloc::System> = &INSTRUMENTED_SYSTEM;

/// Held by each test: what others allocate meanwhile would be counted too.
static ALONE: Mutex<()> = Mutex::new(());

/// Format of the targets.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Pixels.
const SIZE: (u32, u32) = (240, 135);

fn shipped(id: &str) -> Exhibit {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    soffio_exhibit::load(&folder).expect("shipped")
}

/// A device and a target; `None` where there is no driver at all.
fn device() -> Option<(Gpu, wgpu::TextureView)> {
    let gpu = match Gpu::headless() {
        Err(error) if !matches!(error, RenderError::NoAdapter(_)) => panic!("{error}"),
        found => require("Vulkan driver", found)?,
    };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    Some((gpu, view))
}

/// Nobody else counts while this is held.
fn alone() -> MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Every body turned about the vertical by an angle, rad.
fn turned(exhibit: &Exhibit, angle: f64) -> Vec<Pose> {
    let turn = DQuat::from_rotation_y(angle);
    let pose = |pose: &Pose| Pose { position: turn * pose.position, rotation: turn * pose.rotation };
    exhibit.bodies.iter().map(|body| pose(&body.pose)).collect()
}

fn frame<'a>(exhibit: &Exhibit, poses: &'a [Pose], dust_particles: &'a [DustParticle]) -> FrameInput<'a> {
    let view = exhibit.view(f64::from(SIZE.0) / f64::from(SIZE.1));
    FrameInput { poses, dust: dust_particles, curves: &[], view, size: SIZE, exposure: 1.0, time: 0.0 }
}

#[test]
fn a_frame_asks_for_no_memory_before_it_turns_to_the_device() {
    /// Frames until everything has grown as large as it gets.
    const WARM: usize = 4;
    const FRAMES: usize = 8;
    let _alone = alone();
    let Some((gpu, target)) = device() else { return };
    let motes: Vec<DustParticle> = (0..600)
        .map(|i| DustParticle {
            position: [0.01 * (i % 20) as f32, 0.01 * (i / 20) as f32, 0.0],
            brightness: 0.5,
            ..DustParticle::default()
        })
        .collect();
    for id in ["steel-fish", "terry-clock", "wind-chimes-glass"] {
        let exhibit = shipped(id);
        let options = Options::for_gpu(&gpu, FORMAT);
        let mut renderer = Renderer::new(&gpu, &exhibit, options).expect("an exhibit that can be drawn");
        let poses: Vec<_> = (0..WARM + FRAMES).map(|i| turned(&exhibit, 0.02 * i as f64)).collect();
        let (mut ours, mut all) = (0, 0);
        for (i, poses) in poses.iter().enumerate() {
            let frame = frame(&exhibit, poses, &motes);
            let region = Region::new(ALLOCATOR);
            renderer.place(&frame);
            let placed = region.change();
            let region = Region::new(ALLOCATOR);
            renderer.draw(&gpu, &target, &frame);
            if i >= WARM {
                ours += placed.allocations + placed.reallocations;
                all += region.change().allocations;
            }
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device");
        }
        // Allocations of the graphics library and the driver are beyond our control: they are printed, not limited.
        println!("{id}: {ours} allocations of ours, {:.0} a frame with the library's", all as f64 / FRAMES as f64);
        assert_eq!(ours, 0, "{id}");
    }
}

#[test]
fn the_moment_that_a_picture_shows_is_found_in_memory_that_is_there() {
    let _alone = alone();
    let exhibit = std::sync::Arc::new(shipped("steel-fish"));
    let mut simulation = Simulation::new(exhibit, Settings::default());
    let mut history = SnapshotHistory::new(&simulation.snapshot());
    let mut moment = Snapshot::default();
    for step in 0..120 {
        simulation.step(&StepInput::default());
        history.push(&simulation.snapshot());
        let region = Region::new(ALLOCATOR);
        history.interpolate(1.3, &mut moment);
        let requested = region.change();
        assert!(step == 0 || requested.allocations + requested.reallocations == 0, "step {step}: {requested:?}");
    }
}

#[test]
fn a_change_of_work_makes_no_pipeline_and_leaves_nothing_on_the_heap() {
    /// Changes after which every kind of surface has been seen, and changes that are counted.
    const FIRST: usize = 4;
    const CHANGES: usize = 12;
    /// Most bytes a change may leave behind on the heap, as a mean: lists of the graphics library that still settle.
    const KEPT: isize = 4096;
    let _alone = alone();
    let Some((gpu, target)) = device() else { return };
    let works = ["steel-fish", "terry-clock"].map(shipped);
    let poses = works.each_ref().map(|work| turned(work, 0.0));
    let options = Options::for_gpu(&gpu, FORMAT);
    let mut renderer = Renderer::new(&gpu, &works[1], options.clone()).expect("an exhibit that can be drawn");
    let change = |renderer: &mut Renderer, which: usize| {
        let baked = Baked::new(&works[which], &options.lighting).expect("an exhibit that can be drawn");
        let work = renderer.prepare(&gpu, &works[which], baked);
        renderer.show(work);
        renderer.draw(&gpu, &target, &frame(&works[which], &poses[which], &[]));
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device");
    };
    for i in 0..FIRST {
        change(&mut renderer, i % 2);
    }
    let (pipelines, resident, began) = (renderer.pipelines(), resident_kb(), std::time::Instant::now());
    let region = Region::new(ALLOCATOR);
    for i in 0..CHANGES {
        change(&mut renderer, i % 2);
    }
    let change = region.change();
    let kept = (change.bytes_allocated as isize - change.bytes_deallocated as isize) / CHANGES as isize;
    // Memory that the driver keeps is printed, not limited.
    println!(
        "{pipelines} pipelines, {} more after {CHANGES} changes; a change keeps {kept} bytes of the heap, {:.0} kB resident, \
         and takes {:.0} ms with its first picture",
        renderer.pipelines() - pipelines,
        (resident_kb() - resident) / CHANGES as f64,
        1e3 * began.elapsed().as_secs_f64() / CHANGES as f64
    );
    assert_eq!(renderer.pipelines(), pipelines);
    assert!(kept < KEPT, "{kept} bytes a change");
}

/// Memory that this process has, kB; 0 where the system does not say.
fn resident_kb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0.0)
}
