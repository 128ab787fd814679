//! Cost of a frame: processor time of the whole program, including the threads of a software driver. The frames show an exhibit
//! in a hard breath; each is finished before the next begins.

use std::sync::Arc;
use std::time::Instant;

use cpu_time::ProcessTime;
use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use crate::commands::setup::open;
use soffio_exhibit::Exhibit;
use soffio_render::{FrameInput, Gpu, Options, Renderer, ShadowQuality};
use soffio_simulation::{Command, STEPS_PER_SECOND, Settings, Simulation, Snapshot, StepInput};

/// A hard breath, m/s at the lips.
const HARD: f64 = 17.0;
/// Pictures a second.
const FPS: u64 = 60;
/// Frames before the measurement: the first ones compile the pipelines.
const WARM: usize = 10;
/// Texture format of a window.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Bgra8UnormSrgb;

/// Cost of an exhibit's frames.
#[derive(Serialize)]
struct Row {
    exhibit: String,
    driver: String,
    width: u32,
    height: u32,
    /// Samples a pixel.
    msaa: u32,
    pictures: usize,
    /// With shadows as a kiosk on a software driver draws them: processor ms a picture, and ms by the clock.
    light_cpu_ms: f64,
    light_ms: f64,
    /// With shadows as on a graphics card.
    full_cpu_ms: f64,
    full_ms: f64,
}

/// Measures the named exhibits, or all that are shipped.
pub fn run(names: &[String], size: (u32, u32), seconds: f64, json: bool) -> Outcome {
    let names = if names.is_empty() { soffio_exhibit::ids() } else { names.to_vec() };
    if names.is_empty() {
        return Err(Failure::input("there is no exhibit here; run this where the folder `exhibits` is, or name one"));
    }
    let gpu = Gpu::headless().map_err(Failure::of_picture)?;
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if size.0.max(size.1) > limit {
        return Err(Failure::of_picture(soffio_render::RenderError::Size { width: size.0, height: size.1, limit }));
    }
    if !json {
        println!("{}, {}x{}, 4 samples a pixel", gpu.name(), size.0, size.1);
        println!(
            "{:<20} {:>8} {:>12} {:>12} {:>12} {:>12}",
            "exhibit", "pictures", "light: CPU", "clock", "full: CPU", "clock"
        );
    }
    for name in names {
        let row = measure(&gpu, &open(&name)?, size, seconds)?;
        if json {
            println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
        } else {
            println!(
                "{:<20} {:>8} {:>9.1} ms {:>9.1} ms {:>9.1} ms {:>9.1} ms",
                row.exhibit, row.pictures, row.light_cpu_ms, row.light_ms, row.full_cpu_ms, row.full_ms
            );
        }
    }
    Ok(())
}

fn measure(gpu: &Gpu, exhibit: &Arc<Exhibit>, size: (u32, u32), seconds: f64) -> Result<Row, Failure> {
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let pictures = (seconds * FPS as f64).ceil() as usize;
    let mut moments = Vec::with_capacity(WARM + pictures);
    for step in 0..(WARM + pictures) as u64 * STEPS_PER_SECOND / FPS {
        let blow = [Command::Blow(Some(HARD))];
        simulation.step(&StepInput { commands: if step == 0 { &blow } else { &[] }, ..StepInput::default() });
        if step.is_multiple_of(STEPS_PER_SECOND / FPS) {
            moments.push(simulation.snapshot());
        }
    }
    let [light, full] = [ShadowQuality::Light, ShadowQuality::Full]
        .map(|quality| draw(gpu, exhibit, size, quality, &moments).map_err(Failure::of_picture));
    let ((light_cpu_ms, light_ms), (full_cpu_ms, full_ms)) = (light?, full?);
    Ok(Row {
        exhibit: exhibit.id.clone(),
        driver: gpu.name(),
        width: size.0,
        height: size.1,
        msaa: Options::for_gpu(gpu, FORMAT).msaa,
        pictures,
        light_cpu_ms,
        light_ms,
        full_cpu_ms,
        full_ms,
    })
}

/// ms a picture: of the processor, and by the clock.
fn draw(
    gpu: &Gpu,
    exhibit: &Exhibit,
    size: (u32, u32),
    quality: ShadowQuality,
    moments: &[Snapshot],
) -> Result<(f64, f64), soffio_render::RenderError> {
    let mut renderer =
        Renderer::new(gpu, exhibit, Options { shadow_quality: quality, ..Options::for_gpu(gpu, FORMAT) })?;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("measured picture"),
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let target = texture.create_view(&Default::default());
    let view = exhibit.view(f64::from(size.0) / f64::from(size.1));
    let mut began = (ProcessTime::now(), Instant::now());
    for (i, moment) in moments.iter().enumerate() {
        if i == WARM {
            began = (ProcessTime::now(), Instant::now());
        }
        let frame = FrameInput {
            poses: &moment.poses,
            dust: &moment.dust_particles,
            curves: &moment.curves,
            view,
            size,
            exposure: 1.0,
            time: moment.time,
        };
        renderer.draw(gpu, &target, &frame);
        let finished = gpu.device.poll(wgpu::PollType::wait_indefinitely());
        finished.map_err(|error| soffio_render::RenderError::NoDevice(error.to_string()))?;
    }
    let each = |seconds: f64| 1e3 * seconds / (moments.len() - WARM) as f64;
    Ok((each(began.0.elapsed().as_secs_f64()), each(began.1.elapsed().as_secs_f64())))
}
