//! Scenario files of `soffio render`: camera, lighting and tone curve of one picture, as JSON.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec3, Vec3};
use serde::Deserialize;

use super::environment::Environment;
use super::{AreaLight, Lighting, Tonemap};
use soffio_exhibit::View;

/// A scenario file. Missing keys take the defaults of a picture without a scenario.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// glTF or GLB, relative to the file; used when the command names none.
    pub model: Option<PathBuf>,
    /// Position of the camera, world, m.
    pub eye: Option<[f64; 3]>,
    /// Point looked at, world, m.
    pub target: Option<[f64; 3]>,
    /// Vertical field of view, degrees.
    pub fovy_deg: Option<f64>,
    /// Width of the picture, pixels.
    pub width: Option<u32>,
    /// Height of the picture, pixels.
    pub height: Option<u32>,
    /// Equirectangular Radiance image (.hdr) that lights the scene; a path relative to the file.
    pub env: Option<PathBuf>,
    /// Factor of the image's radiance, 1 for the image as it is.
    pub env_intensity: Option<f32>,
    /// Background colour, linear RGB.
    pub background_linear: Option<[f32; 3]>,
    /// A rectangular area light; `None`: without one.
    pub area_light: Option<Rectangle>,
    /// Tone curve from linear radiance to the display.
    pub tonemap: Option<Tonemap>,
    /// Factor of all radiances before the tone curve, above 0.
    pub exposure: Option<f32>,
}

/// A one-sided rectangular area light.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// Centre, world, m.
    pub center: [f32; 3],
    /// Point it faces, m.
    pub target: [f32; 3],
    /// Width, m.
    pub width: f32,
    /// Height, m.
    pub height: f32,
    /// Emitted power, W for each colour channel.
    pub power_w: f32,
}

/// Errors of scenario files.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// A file could not be read.
    #[error("{path}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// The file is not the JSON of a scenario.
    #[error(
        "{path}: {source}\n  The keys are model, eye, target, fovy_deg, width, height, env, env_intensity, background_linear, area_light, tonemap, exposure"
    )]
    Shape {
        /// The file.
        path: PathBuf,
        /// Position and cause.
        source: serde_json::Error,
    },
    /// A number out of range.
    #[error("{path}: `{key}` {problem}")]
    Value {
        /// The file.
        path: PathBuf,
        /// The key.
        key: &'static str,
        /// What is wrong and what is allowed.
        problem: &'static str,
    },
    /// The environment image could not be decoded.
    #[error("{path}: {source}\n  `env` must be an equirectangular Radiance .hdr image")]
    Environment {
        /// The image.
        path: PathBuf,
        /// The cause.
        source: image::ImageError,
    },
}

impl Scenario {
    /// Reads and checks a scenario; its paths are returned relative to the working directory.
    ///
    /// # Errors
    /// Where the file cannot be read, is not a scenario, or has a number out of range.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        let text = std::fs::read_to_string(path).map_err(|source| ScenarioError::Read { path: path.into(), source })?;
        let mut scenario: Self =
            serde_json::from_str(&text).map_err(|source| ScenarioError::Shape { path: path.into(), source })?;
        if let Some((key, problem)) = scenario.problem() {
            return Err(ScenarioError::Value { path: path.into(), key, problem });
        }
        let folder = path.parent().unwrap_or(Path::new("."));
        for file in [&mut scenario.model, &mut scenario.env].into_iter().flatten() {
            *file = folder.join(&*file);
        }
        Ok(scenario)
    }

    /// The first number out of range, and what is allowed.
    fn problem(&self) -> Option<(&'static str, &'static str)> {
        let positive = |x: f32| x.is_finite() && x > 0.0;
        if self.fovy_deg.is_some_and(|f| !(f > 0.0 && f < 180.0)) {
            return Some(("fovy_deg", "must lie between 0 and 180"));
        }
        if self.width == Some(0) || self.height == Some(0) {
            return Some(("width and height", "must be at least 1"));
        }
        if let (Some(eye), Some(target)) = (self.eye, self.target)
            && eye == target
        {
            return Some(("target", "must differ from `eye`, or there is no direction to look in"));
        }
        if self.exposure.is_some_and(|e| !positive(e)) {
            return Some(("exposure", "must be above 0"));
        }
        if self.env_intensity.is_some_and(|e| !(e.is_finite() && e >= 0.0)) {
            return Some(("env_intensity", "must not be negative"));
        }
        let rectangle = self.area_light?;
        if !(positive(rectangle.width) && positive(rectangle.height)) || rectangle.center == rectangle.target {
            return Some(("area_light", "must have a width and height above 0 and a target apart from its center"));
        }
        None
    }

    /// The lighting of the scenario. A scenario with lighting or a background of its own has no gallery.
    ///
    /// # Errors
    /// Where the environment image cannot be read.
    pub fn lighting(&self) -> Result<Lighting, ScenarioError> {
        let environment = self.env.as_deref().map(environment).transpose()?;
        let own = self.env.is_some() || self.background_linear.is_some() || self.area_light.is_some();
        Ok(Lighting {
            tonemap: self.tonemap.unwrap_or_default(),
            environment: environment.map(Arc::new),
            env_intensity: self.env_intensity.unwrap_or(1.0),
            background: own.then(|| Vec3::from_array(self.background_linear.unwrap_or_default())),
            area_light: self.area_light.map(|rectangle| rectangle.light()),
        })
    }

    /// `view` with the values that the scenario sets.
    pub fn view(&self, view: View) -> View {
        View {
            eye: self.eye.map_or(view.eye, DVec3::from_array),
            target: self.target.map_or(view.target, DVec3::from_array),
            up: if self.eye.is_some() || self.target.is_some() { DVec3::Y } else { view.up },
            fovy: self.fovy_deg.map_or(view.fovy, f64::to_radians),
        }
    }
}

impl Rectangle {
    /// As upright as its direction allows; radiance L = P / (π w h).
    fn light(&self) -> AreaLight {
        let center = Vec3::from_array(self.center);
        let forward = (Vec3::from_array(self.target) - center).normalize();
        let up = if forward.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
        let x = up.cross(forward).normalize();
        let y = forward.cross(x);
        let radiance = self.power_w / (std::f32::consts::PI * self.width * self.height);
        AreaLight {
            center,
            half_width: x * 0.5 * self.width,
            half_height: y * 0.5 * self.height,
            radiance: Vec3::splat(radiance),
        }
    }
}

fn environment(path: &Path) -> Result<Environment, ScenarioError> {
    let bytes = std::fs::read(path).map_err(|source| ScenarioError::Read { path: path.into(), source })?;
    let image = image::load_from_memory_with_format(&bytes, image::ImageFormat::Hdr)
        .map_err(|source| ScenarioError::Environment { path: path.into(), source })?;
    Ok(Environment::from_equirectangular(&image.into_rgb32f()))
}
