//! Snapshot to pixels: a museum photograph of the exhibit, live or headless by the same code.
//!
//! One forward renderer. The tone map runs at the end of each fragment shader, so there is no HDR target; the picture
//! is antialiased by four samples, wires by exact coverage. Order of a frame:
//!
//! ```text
//! plane shadows (wall, floor) → shadow map → opaque meshes → room → edges of plates → glass → wires → blended → motes → resolve → stretch
//! ```
//!
//! | file | holds | shader |
//! |---|---|---|
//! | `gpu` | adapter and device | |
//! | `gallery` | the built-in room: its measure, lamps and luminous fields | `room.wgsl` |
//! | `radiosity` | the light in it: form factors, what walls send one another, light map | |
//! | `environment` | image-based light: prefiltered cube, harmonics, split-sum table | `lighting.wgsl` |
//! | `scene` | the exhibit as one vertex buffer in body frames | `forward.wgsl` |
//! | `occlusion` | ambient visibility of corners and planes, by rays at load | |
//! | `bounce`, `refine` | what surfaces of a still scene send one another, baked into its corners, which are made finer | |
//! | `casters` | what the shadow map of a still scene is drawn around | |
//! | `textures`, `details` | materials and mip maps; textures of extensions, packed | |
//! | `globals` | the frame's uniforms | `common.wgsl` |
//! | `shadows` | soft shadows on the planes and the shadow map | `shadows.wgsl` |
//! | `sheets` | shadows of flat plates on the planes, in closed form | `sheets.wgsl` |
//! | `wires` | capsule segments | `wires.wgsl` |
//! | `skins` | meshes that follow joints, or key frames of their shape | |
//! | `outlines` | silhouettes of plates, and the ribbons along them | `outline.wgsl` |
//! | `passes` | the list of passes: attachments, draws, bytes | |
//! | `resources` | textures and bind groups of the light | |
//! | `shaders` | their sources, built in or from a folder, checked | |
//! | `pipelines` | what state each pass is drawn with | |
//! | `fixtures` | what the device keeps while works come and go | |
//! | `work` | [`Work`]: what is drawn of one exhibit | |
//! | `forward` | [`Renderer`]: the order of the passes | `motes.wgsl`, `resolve.wgsl`, `stretch.wgsl` |
//! | `picture` | [`ImageRenderer`]: headless, read back, for files drawn larger and made smaller | |
//! | `scenario` | scenario files of `soffio render` | |
//!
//! Invariants: a frame allocates no GPU memory unless its size changed, none of ours before the device is asked, and
//! depends on nothing but the exhibit, the options and the [`Frame`]. A change of work makes no pipeline that was there.
//!
//! It never moves anything, reads no clock, and opens no window: the kiosk owns the window, and files are drawn without one.
//! A picture needs a Vulkan driver; software is enough. Where there is none, [`RenderError::NoAdapter`] says what to install.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use soffio_render::{Frame, ImageRenderer};
//!
//! let exhibit = soffio_exhibit::load(Path::new("exhibits/pendulum")).expect("a shipped exhibit");
//! let mut renderer = ImageRenderer::new(&exhibit, |_| {}).expect("a Vulkan driver");
//! let poses: Vec<_> = exhibit.bodies.iter().map(|body| body.pose).collect();
//! let size = (1280, 720);
//! let view = exhibit.view(f64::from(size.0) / f64::from(size.1));
//! let frame = Frame { poses: &poses, motes: &[], view, size, exposure: 1.0, time: 0.0 };
//! renderer.draw(&frame).expect("a picture").save("pendulum.png").expect("a writable folder");
//! ```

use std::sync::Arc;

use glam::Vec3;

use soffio_exhibit::View;
use soffio_math::Pose;
use soffio_simulation::DustParticle;

mod bounce;
mod casters;
mod details;
pub mod environment;
mod fixtures;
mod forward;
mod frames;
pub mod gallery;
mod globals;
mod gpu;
mod light;
mod materials;
mod occlusion;
mod outlines;
pub mod passes;
mod picture;
mod pipelines;
mod punctual;
mod radiosity;
mod refine;
mod resources;
pub mod scenario;
mod scene;
pub mod shaders;
mod shadows;
mod sheets;
mod skins;
mod textures;
mod vertex;
mod wires;
mod work;

pub use forward::Renderer;
pub use gpu::Gpu;
pub use picture::ImageRenderer;
pub use shaders::Shaders;
pub use work::Work;

/// What the renderer can fail on.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// No Vulkan driver.
    #[error(
        "no graphics adapter: {0}\n  A picture needs a Vulkan driver; software is enough.\n  \
         Debian or Ubuntu: apt-get install libvulkan1 mesa-vulkan-drivers"
    )]
    NoAdapter(String),
    /// The driver is there and refuses.
    #[error("the graphics driver gave no device: {0}\n  Update the driver, or install mesa-vulkan-drivers")]
    NoDevice(String),
    /// More bodies than the uniform buffer of frames holds.
    #[error("{count} moving bodies are more than the {limit} the renderer can place; split the exhibit")]
    TooManyBodies {
        /// Bodies of the exhibit.
        count: usize,
        /// Most there may be.
        limit: usize,
    },
    /// A picture larger than the adapter's textures, or without pixels.
    #[error("a picture of {width}x{height} pixels cannot be drawn; each side must be 1 to {limit} here")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// Largest side.
        limit: u32,
    },
    /// The picture did not come back from the device.
    #[error("the picture could not be read back from the graphics device: {0}")]
    ReadBack(String),
}

/// Curve from linear light to the display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
pub enum Tonemap {
    /// Khronos PBR Neutral: paint keeps its colour.
    #[default]
    #[serde(rename = "khronos_pbr_neutral")]
    Neutral,
    /// ACES, Hill's fit.
    #[serde(rename = "aces")]
    Aces,
    /// AgX, base look.
    #[serde(rename = "agx")]
    Agx,
    /// Clamp.
    #[serde(rename = "none")]
    Clamp,
}

/// How finely shadows are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// For software Vulkan.
    Light,
    /// For a graphics card.
    Full,
}

/// A one-sided luminous rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// World, m.
    pub center: Vec3,
    /// Half-size vectors of its sides, m; it shines along x × y.
    pub half: (Vec3, Vec3),
    /// Radiance, relative to exposure 1.
    pub radiance: Vec3,
}

/// Light and backdrop of a picture.
#[derive(Clone, Debug)]
pub struct Look {
    /// Curve to the display.
    pub tonemap: Tonemap,
    /// Light from all around; `None` is the gallery's.
    pub environment: Option<Arc<environment::Environment>>,
    /// Multiplies it.
    pub env_intensity: f32,
    /// Linear colour behind the work instead of the gallery's room and lamps.
    pub background: Option<Vec3>,
    /// A rectangle of light beside the rest.
    pub area_light: Option<AreaLight>,
}

impl Default for Look {
    fn default() -> Self {
        Self { tonemap: Tonemap::Neutral, environment: None, env_intensity: 1.0, background: None, area_light: None }
    }
}

/// What is constant over the life of a renderer.
#[derive(Clone, Debug)]
pub struct Options {
    /// Samples per pixel: 1 or 4, which every adapter has.
    pub msaa: u32,
    /// Format of the views drawn into; must encode sRGB.
    pub format: wgpu::TextureFormat,
    /// How finely shadows are drawn.
    pub quality: Quality,
    /// Average the samples in a shader instead of by the fixed function (faster in software).
    pub shader_resolve: bool,
    /// Light and backdrop.
    pub look: Look,
    /// Sources of the shaders.
    pub shaders: Arc<Shaders>,
}

impl Options {
    /// What suits the adapter, for targets of this format.
    pub fn for_gpu(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let software = gpu.is_software();
        let quality = if software { Quality::Light } else { Quality::Full };
        let shader_resolve = software && gpu.reads_samples();
        Self { msaa: 4, format, quality, shader_resolve, look: Look::default(), shaders: Arc::default() }
    }
}

/// How many pixels and samples a picture is made of, where a machine is too slow for all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// Pixels drawn along a side for each of the target's, at most 1; fewer are stretched over it.
    pub scale: f32,
    /// Samples per pixel: 1 or 4.
    pub msaa: u32,
}

/// One moment to draw.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// World pose of each body's node, in the order of the exhibit's bodies. Bodies left out stay where they began.
    pub poses: &'a [Pose],
    /// Dust.
    pub motes: &'a [DustParticle],
    /// Camera.
    pub view: View,
    /// Pixels of the target.
    pub size: (u32, u32),
    /// Linear multiplier.
    pub exposure: f32,
    /// Since the reset, s: when the model's key frames of shapes are seen.
    pub time: f64,
}
