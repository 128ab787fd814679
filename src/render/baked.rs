//! What is computed once for an exhibit before its first frame, without a device: its meshes with the light that falls on
//! them, the gallery, and the environment that it mirrors.
//!
//! It takes a second or so, mostly for rays, so the kiosk has it made by the thread that loads exhibits.

use std::sync::Arc;

use glam::{Vec3, Vec4};

use super::bounce::{self, BakedLight};
use super::casters::casters;
use super::environment::Environment;
use super::gallery::Gallery;
use super::scene::Scene;
use super::shadows::{ReceivingPlane, ShadowMapCamera};
use super::{Lighting, RenderError, ShadowQuality, occlusion};
use soffio_exhibit::Exhibit;

/// An exhibit with its light, ready for a device.
pub struct Baked {
    pub(super) scene: Scene,
    pub(super) gallery: Gallery,
    pub(super) environment: Arc<Environment>,
    /// What static parts do to the light of wall and floor: the irradiance that they send, and the visible fraction of the rest.
    pub(super) ambient: Vec<Vec4>,
    /// Vertices of the shadow casters, where the shadow map is fitted to them.
    pub(super) casters: Vec<Vec3>,
}

impl Baked {
    /// Bakes the light of an exhibit in its start pose.
    ///
    /// # Errors
    /// The exhibit has more than the shaders can hold, such as bodies; the error says what.
    pub fn new(exhibit: &Exhibit, lighting: &Lighting) -> Result<Self, RenderError> {
        let mut scene = Scene::new(exhibit)?;
        let gallery = Gallery::around(exhibit);
        let environment = match &lighting.environment {
            Some(environment) => environment.clone(),
            None => Environment::new(|direction| gallery.radiance(direction)).into(),
        };
        let light = BakedLight {
            environment: &environment,
            env_intensity: lighting.env_intensity,
            area: lighting.area_light,
            gallery: lighting.background.is_none().then_some(&gallery),
        };
        let radiosity = bounce::corners(&mut scene, exhibit, gallery.radius, &light);
        let planes = ReceivingPlane::of_gallery(&gallery, exhibit, ShadowQuality::Full);
        let ambient = occlusion::planes(&scene, exhibit, &planes, gallery.radius, &radiosity);
        let is_static = exhibit.bodies.is_empty() && exhibit.shapes.is_empty() && lighting.background.is_some();
        let casters = if is_static && lighting.area_light.is_some() {
            let (positions, _) = occlusion::start_geometry(&scene, exhibit);
            casters(&scene, &positions, gallery.radius, ShadowMapCamera::light(&gallery, lighting).0)
        } else {
            Vec::new()
        };
        Ok(Self { scene, gallery, environment, ambient, casters })
    }
}
