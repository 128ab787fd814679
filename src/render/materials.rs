//! Material uniforms, textures and samplers.

use std::collections::BTreeMap;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt;

use super::shared::SharedResources;
use super::textures::ColorSpace::{self, Linear, Srgb};
use super::textures::upload;
use super::{Gpu, details};
use soffio_exhibit::model::{AlphaMode, Appearance, Image, Levels, Model, Sampler, TextureUse, Wrap};

/// `Material` of `forward.wgsl`. It has 21 fields, because it is the layout of the shader's uniform block.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct MaterialUniform {
    pub base_color: [f32; 4],
    pub emissive: [f32; 3],
    pub metallic: f32,
    pub roughness: f32,
    pub normal_scale: f32,
    occlusion: f32,
    pub cutoff: f32,
    pub f0: [f32; 3],
    pub f90: f32,
    pub absorption: [f32; 3],
    pub thickness: f32,
    pub sheen: [f32; 3],
    pub sheen_roughness: f32,
    pub transmission: f32,
    pub ior: f32,
    pub coat: f32,
    pub coat_roughness: f32,
    pub unlit: f32,
    pub coat_normal_scale: f32,
    spare: [f32; 2],
    uv: [[f32; 4]; 2 * PLACES],
}

/// Number of textures with a transform of their own: five of the core material and nine of its extensions.
const PLACES: usize = 5 + 9;

/// Bind groups of all materials of a model, and last of the default one.
pub(super) fn materials(gpu: &Gpu, model: &Model, shared: &mut SharedResources) -> Vec<wgpu::BindGroup> {
    let SharedResources { layouts, white, no_details, samplers, .. } = shared;
    let mut textures = Textures { gpu, images: &model.images, made: BTreeMap::new(), samplers };
    let default = default_appearance();
    model
        .materials
        .iter()
        .chain([&default])
        .map(|appearance| {
            let uses = uses(appearance);
            let spaces = [Srgb, Linear, Linear, Linear, Srgb];
            let views: Vec<_> =
                uses.iter().zip(spaces).map(|(t, space)| textures.view(t.map(|t| t.image), space, white)).collect();
            let samplers: Vec<_> =
                uses.iter().map(|t| textures.sampler(t.map_or(Sampler::default(), |t| t.sampler))).collect();
            let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&appearance.name),
                contents: bytemuck::bytes_of(&uniform(appearance)),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let detail_views = details::views(gpu, &model.images, &appearance.details, no_details);
            let first = appearance.details.all().into_iter().flatten().next();
            let detail_sampler = textures.sampler(first.map_or(Sampler::default(), |texture| texture.sampler));
            let entries: Vec<_> = std::iter::once(uniform.as_entire_binding())
                .chain(views.iter().map(wgpu::BindingResource::TextureView))
                .chain(samplers.iter().map(wgpu::BindingResource::Sampler))
                .chain(detail_views.iter().map(wgpu::BindingResource::TextureView))
                .chain([wgpu::BindingResource::Sampler(&detail_sampler)])
                .zip(0..)
                .map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&appearance.name),
                layout: &layouts.material,
                entries: &entries,
            })
        })
        .collect()
}

/// Appearance of primitives without a material: grey paint.
pub(super) fn default_appearance() -> Appearance {
    Appearance { metallic: 0.0, roughness: 0.6, ..Appearance::default() }
}

/// The textures of an appearance in the order of the bindings.
pub(super) fn uses(appearance: &Appearance) -> [Option<TextureUse>; 5] {
    [
        appearance.base_color_texture,
        appearance.metallic_roughness_texture,
        appearance.normal_texture.map(|map| map.texture),
        appearance.occlusion_texture.map(|map| map.texture),
        appearance.emissive_texture,
    ]
}

/// The material's numbers as the shaders read them.
pub(super) fn uniform(appearance: &Appearance) -> MaterialUniform {
    let mut base_color = appearance.base_color;
    if appearance.alpha == AlphaMode::Opaque {
        // Only the other alpha modes use alpha.
        base_color[3] = 1.0;
    }
    // Schlick's F0 of a boundary to air, and KHR_materials_specular's tint of it.
    let mirror = (appearance.ior - 1.0) / (appearance.ior + 1.0);
    let f0 = appearance.specular_color.map(|c| (mirror * mirror * c).min(1.0) * appearance.specular);
    let absorption = appearance.attenuation_color.map(|c| -c.clamp(1e-4, 1.0).ln() / appearance.attenuation_distance);
    let mut uv = [[0.0; 4]; 2 * PLACES];
    for (i, texture) in uses(appearance).iter().chain(&appearance.details.all()).enumerate() {
        let TextureUse { transform: [u, v], set, .. } = texture.unwrap_or(TextureUse::of(0));
        uv[2 * i] = [u[0], u[1], u[2], set as f32];
        uv[2 * i + 1] = [v[0], v[1], v[2], 0.0];
    }
    MaterialUniform {
        base_color,
        emissive: appearance.emissive,
        metallic: appearance.metallic,
        roughness: appearance.roughness,
        normal_scale: appearance.normal_texture.map_or(0.0, |map| map.scale),
        occlusion: appearance.occlusion_texture.map_or(0.0, |map| map.scale),
        cutoff: if let AlphaMode::Mask(cutoff) = appearance.alpha { cutoff.max(1e-6) } else { 0.0 },
        f0,
        f90: appearance.specular,
        absorption,
        thickness: appearance.thickness,
        sheen: appearance.sheen,
        sheen_roughness: appearance.sheen_roughness,
        transmission: appearance.transmission,
        ior: appearance.ior,
        coat: appearance.coat,
        coat_roughness: appearance.coat_roughness,
        unlit: if appearance.unlit { 1.0 } else { 0.0 },
        coat_normal_scale: appearance.details.coat_normal.map_or(0.0, |map| map.scale),
        spare: [0.0; 2],
        uv,
    }
}

/// Uploads each image once for each use.
struct Textures<'a> {
    gpu: &'a Gpu,
    images: &'a [Arc<Image>],
    made: BTreeMap<(usize, ColorSpace), wgpu::TextureView>,
    samplers: &'a mut BTreeMap<Sampler, wgpu::Sampler>,
}

impl Textures<'_> {
    fn sampler(&mut self, sampler: Sampler) -> wgpu::Sampler {
        let wrap = |mode| match mode {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
        };
        let filter = |smooth| if smooth { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
        let smooth = sampler.smooth_near && sampler.smooth_far && sampler.levels == Levels::Blended;
        let make = || {
            self.gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("material"),
                address_mode_u: wrap(sampler.wrap[0]),
                address_mode_v: wrap(sampler.wrap[1]),
                mag_filter: filter(sampler.smooth_near),
                min_filter: filter(sampler.smooth_far),
                mipmap_filter: match sampler.levels {
                    Levels::Blended => wgpu::MipmapFilterMode::Linear,
                    Levels::Nearest | Levels::None => wgpu::MipmapFilterMode::Nearest,
                },
                lod_max_clamp: if sampler.levels == Levels::None { 0.0 } else { 32.0 },
                // Painted sheet metal is often seen edge on.
                anisotropy_clamp: if smooth && !self.gpu.is_software() { 8 } else { 1 },
                ..Default::default()
            })
        };
        self.samplers.entry(sampler).or_insert_with(make).clone()
    }

    fn view(&mut self, image: Option<usize>, space: ColorSpace, white: &wgpu::TextureView) -> wgpu::TextureView {
        let Some((index, image)) = image.and_then(|i| Some((i, self.images.get(i)?))) else { return white.clone() };
        // An image that exceeds the adapter's limit is shown as white rather than not at all.
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        if image.width == 0 || image.height == 0 || image.width.max(image.height) > limit {
            tracing::warn!("image {index} is {}x{}, beyond 1 to {limit}: left white", image.width, image.height);
            return white.clone();
        }
        if let Some(view) = self.made.get(&(index, space)) {
            return view.clone();
        }
        let view = upload(self.gpu, image, space);
        self.made.insert((index, space), view.clone());
        view
    }
}
