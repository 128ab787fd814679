//! Renders snapshots of a simulation: a museum photograph of the exhibit, live or headless by the same code.
//!
//! A forward renderer. The tone map runs at the end of each fragment shader, so there is no HDR target. The picture is
//! antialiased by four samples, wires by exact coverage. Order of a frame:
//!
//! ```text
//! plane shadows (wall, floor) → shadow map → opaque meshes → gallery → plate edges → glass → wires → blended → dust →
//! resolve → upscale
//! ```
//!
//! | file | holds | shader |
//! |---|---|---|
//! | `gpu` | adapter and device | |
//! | `gallery` | the built-in gallery: size, lamps and luminous fields | `gallery.wgsl` |
//! | `radiosity` | the gallery's light: form factors, reflections between walls, light map | |
//! | `environment` | image-based light: prefiltered cube, harmonics, split-sum table | `lighting.wgsl` |
//! | `scene` | the exhibit as one vertex buffer in body frames | `forward.wgsl` |
//! | `occlusion` | ray casting at load; ambient occlusion of the planes | |
//! | `baked` | [`Baked`]: what is computed of an exhibit before its first frame, without a device | |
//! | `bounce`, `refine` | indirect light, baked into refined triangles | |
//! | `casters` | shadow casters of a static scene | |
//! | `textures`, `details` | materials and mip maps; textures of extensions, packed | |
//! | `globals` | the frame's uniforms | `common.wgsl` |
//! | `shadows` | soft shadows on the planes and the shadow map | `shadows.wgsl` |
//! | `plate_shadows` | analytic shadows of flat plates on the planes | `plate_shadows.wgsl` |
//! | `wires` | capsule segments | `wires.wgsl` |
//! | `skins` | skinned meshes and animated shapes | |
//! | `outlines` | silhouettes of plates, and the ribbons along them | `outline.wgsl` |
//! | `passes` | the list of passes: attachments, draws, bytes | |
//! | `resources` | textures and bind groups of the light | |
//! | `shaders` | shader sources, built in or from a folder, validated | |
//! | `pipelines` | render pipelines of all passes | |
//! | `shared` | device resources that all exhibits share | |
//! | `gpu_exhibit` | [`GpuExhibit`]: GPU resources of one exhibit | |
//! | `forward` | [`Renderer`]: the order of the passes | `dust.wgsl`, `resolve.wgsl`, `upscale.wgsl` |
//! | `picture` | [`ImageRenderer`]: headless, with read-back and supersampling | |
//! | `scenario` | scenario files of `soffio render` | |
//! | `reference` | [`Reference`]: a path tracer of the same scene | |
//! | `tone` | tone curves, for pictures without a graphics device | |
//! | `flip` | difference between two pictures as a viewer sees it | |
//!
//! Invariants: a frame allocates no GPU memory unless its size changed, and no memory of ours before the device is
//! called. It depends only on the exhibit, the options and the [`FrameInput`]. A change of exhibit creates no pipeline
//! twice.
//!
//! The crate moves nothing, reads no clock, and opens no window: the kiosk owns the window, and files are drawn without
//! one. It needs a Vulkan driver; software is enough. Without one, [`RenderError::NoAdapter`] says what to install.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use soffio_render::{FrameInput, ImageRenderer};
//!
//! let exhibit = soffio_exhibit::load(Path::new("exhibits/pendulum")).expect("a shipped exhibit");
//! let mut renderer = ImageRenderer::new(&exhibit, |_| {}).expect("a Vulkan driver");
//! let poses: Vec<_> = exhibit.bodies.iter().map(|body| body.pose).collect();
//! let size = (1280, 720);
//! let view = exhibit.view(f64::from(size.0) / f64::from(size.1));
//! let frame = FrameInput { poses: &poses, dust: &[], curves: &[], view, size, exposure: 1.0, time: 0.0 };
//! renderer.draw(&frame).expect("a picture").save("pendulum.png").expect("a writable folder");
//! ```

use std::sync::Arc;

use glam::Vec3;

use soffio_exhibit::View;
use soffio_math::Pose;
use soffio_simulation::{CurveView, DustParticle};

mod baked;
mod bounce;
mod casters;
mod details;
pub mod environment;
pub mod flip;
mod forward;
mod frames;
pub mod gallery;
mod globals;
mod gpu;
mod gpu_exhibit;
mod light;
mod materials;
mod occlusion;
mod outlines;
pub mod passes;
mod picture;
mod pipelines;
mod plate_shadows;
mod punctual;
mod radiosity;
pub mod reference;
mod refine;
mod resources;
pub mod scenario;
mod scene;
pub mod shaders;
mod shadows;
mod shared;
mod skins;
mod textures;
mod tone;
mod vertex;
mod wires;

pub use baked::Baked;
pub use forward::Renderer;
pub use gpu::Gpu;
pub use gpu_exhibit::GpuExhibit;
pub use picture::ImageRenderer;
pub use reference::Reference;
pub use shaders::Shaders;

/// Errors of the renderer.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// There is no Vulkan driver.
    #[error(
        "no graphics adapter: {0}\n  A picture needs a Vulkan driver; software is enough.\n  \
         Debian or Ubuntu: apt-get install libvulkan1 mesa-vulkan-drivers"
    )]
    NoAdapter(String),
    /// The driver gives no device.
    #[error("the graphics driver gave no device: {0}\n  Update the driver, or install mesa-vulkan-drivers")]
    NoDevice(String),
    /// More bodies than the uniform buffer has frames.
    #[error("{count} moving bodies are more than the {limit} the renderer can place; split the exhibit")]
    TooManyBodies {
        /// Number of bodies of the exhibit.
        count: usize,
        /// Largest number.
        limit: usize,
    },
    /// A picture larger than the adapter's textures, or without pixels.
    #[error("a picture of {width}x{height} pixels cannot be drawn; each side must be 1 to {limit} here")]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Largest side in pixels.
        limit: u32,
    },
    /// The picture could not be read back from the device.
    #[error("the picture could not be read back from the graphics device: {0}")]
    ReadBack(String),
}

/// Tone curve from linear light to the display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
pub enum Tonemap {
    /// Khronos PBR Neutral, which keeps the colour of paint.
    #[default]
    #[serde(rename = "khronos_pbr_neutral")]
    Neutral,
    /// ACES, in Hill's fit.
    #[serde(rename = "aces")]
    Aces,
    /// AgX, basic contrast.
    #[serde(rename = "agx")]
    Agx,
    /// No curve; values are clamped.
    #[serde(rename = "none")]
    Clamp,
}

/// Quality of shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowQuality {
    /// For software Vulkan.
    Light,
    /// For graphics cards.
    Full,
}

/// A one-sided rectangular area light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// Centre, world, m.
    pub center: Vec3,
    /// Half of one side, m; its light goes along `half_width` × `half_height`.
    pub half_width: Vec3,
    /// Half of the other side, m.
    pub half_height: Vec3,
    /// Radiance, relative to exposure 1.
    pub radiance: Vec3,
}

/// Lighting and backdrop of a picture.
#[derive(Clone, Debug)]
pub struct Lighting {
    /// Tone curve.
    pub tonemap: Tonemap,
    /// Environment light; `None` takes the gallery's.
    pub environment: Option<Arc<environment::Environment>>,
    /// Multiplies the environment light.
    pub env_intensity: f32,
    /// Linear colour behind the exhibit, in place of the gallery and its lamps.
    pub background: Option<Vec3>,
    /// An additional area light.
    pub area_light: Option<AreaLight>,
}

impl Default for Lighting {
    fn default() -> Self {
        Self { tonemap: Tonemap::Neutral, environment: None, env_intensity: 1.0, background: None, area_light: None }
    }
}

/// Options that are constant over the life of a renderer.
#[derive(Clone, Debug)]
pub struct Options {
    /// Samples per pixel: 1 or 4, which every adapter has.
    pub msaa: u32,
    /// Format of the views drawn into; must encode sRGB.
    pub format: wgpu::TextureFormat,
    /// Quality of shadows.
    pub shadow_quality: ShadowQuality,
    /// Resolve the samples in a shader instead of by the fixed function (faster in software)?
    pub shader_resolve: bool,
    /// Lighting and backdrop.
    pub lighting: Lighting,
    /// Sources of the shaders.
    pub shaders: Arc<Shaders>,
}

impl Options {
    /// The options that suit the adapter, for targets of this format.
    pub fn for_gpu(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let software = gpu.is_software();
        let shadow_quality = if software { ShadowQuality::Light } else { ShadowQuality::Full };
        let shader_resolve = software && gpu.reads_samples();
        Self { msaa: 4, format, shadow_quality, shader_resolve, lighting: Lighting::default(), shaders: Arc::default() }
    }
}

/// Resolution and sample count of a picture, reduced where a machine is too slow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Pixels drawn along a side for each of the target's, at most 1; fewer are upscaled.
    pub scale: f32,
    /// Samples per pixel: 1 or 4.
    pub msaa: u32,
}

/// Input of one frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameInput<'a> {
    /// World pose of each body's node, in the order of the exhibit's bodies. Bodies left out keep their start pose.
    pub poses: &'a [Pose],
    /// Dust particles.
    pub dust: &'a [DustParticle],
    /// Curves of the exhibit's charts.
    pub curves: &'a [CurveView],
    /// Camera.
    pub view: View,
    /// Size of the target, pixels.
    pub size: (u32, u32),
    /// Linear exposure multiplier.
    pub exposure: f32,
    /// Time since the reset, s, for animated shapes.
    pub time: f64,
}
