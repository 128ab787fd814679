//! Shaders, bind group layouts and pipelines: the fixed state of every pass.

use super::scene::Vertex;
use super::shadows::PLANE_FORMAT;
use super::wires::Segment;
use super::{Gpu, Options, Tonemap};

pub(super) const FORWARD: &str = concat!(
    include_str!("../../shaders/common.wgsl"),
    include_str!("../../shaders/lighting.wgsl"),
    include_str!("../../shaders/forward.wgsl")
);
pub(super) const ROOM: &str = concat!(
    include_str!("../../shaders/common.wgsl"),
    include_str!("../../shaders/lighting.wgsl"),
    include_str!("../../shaders/room.wgsl")
);
pub(super) const SHADOWS: &str =
    concat!(include_str!("../../shaders/common.wgsl"), include_str!("../../shaders/shadows.wgsl"));
pub(super) const WIRES: &str = concat!(
    include_str!("../../shaders/common.wgsl"),
    include_str!("../../shaders/lighting.wgsl"),
    include_str!("../../shaders/wires.wgsl")
);
pub(super) const MOTES: &str =
    concat!(include_str!("../../shaders/common.wgsl"), include_str!("../../shaders/motes.wgsl"));
pub(super) const RESOLVE: &str = include_str!("../../shaders/resolve.wgsl");

/// Depth of the picture and of the shadow map: reversed, so floating.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Order of the lamp samples in the plane shadows; 16 bits tell 65 thousand apart.
pub(super) const ORDER_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;

/// Layouts of the three bind groups: frame, light, material.
pub(super) struct Layouts {
    pub frame: wgpu::BindGroupLayout,
    pub light: wgpu::BindGroupLayout,
    pub material: wgpu::BindGroupLayout,
    pub resolve: wgpu::BindGroupLayout,
}

/// Pipelines of all passes.
pub(super) struct Pipelines {
    /// Opaque or blended (first index), single- or double-sided (second).
    pub forward: [[wgpu::RenderPipeline; 2]; 2],
    /// Wall, floor, and the four faces that receive no shadow.
    pub room: [wgpu::RenderPipeline; 3],
    pub backdrop: wgpu::RenderPipeline,
    pub wires: wgpu::RenderPipeline,
    pub motes: wgpu::RenderPipeline,
    /// For the wall and the floor.
    pub plane_meshes: [wgpu::RenderPipeline; 2],
    pub plane_wires: [wgpu::RenderPipeline; 2],
    pub shadow_map: wgpu::RenderPipeline,
    pub resolve: wgpu::RenderPipeline,
}

const VERTEX: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x4, 5 => Uint32
    ],
};
const SEGMENT: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Segment>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4
    ],
};
const MOTE: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: 16,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4],
};

impl Layouts {
    pub fn new(device: &wgpu::Device) -> Self {
        use wgpu::{
            BindingType, BufferBindingType, SamplerBindingType, ShaderStages, TextureSampleType, TextureViewDimension,
        };
        let group = |label, types: &[(ShaderStages, BindingType)]| {
            let entries: Vec<_> = (0..)
                .zip(types)
                .map(|(binding, &(visibility, ty))| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None })
                .collect();
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
        };
        let uniform =
            BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
        let texture = |sample_type, view_dimension, multisampled| BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled,
        };
        let smooth = TextureSampleType::Float { filterable: true };
        let image = (ShaderStages::FRAGMENT, texture(smooth, TextureViewDimension::D2, false));
        let fragment = ShaderStages::FRAGMENT;
        Self {
            frame: group("frame", &[(ShaderStages::VERTEX_FRAGMENT, uniform), (ShaderStages::VERTEX, uniform)]),
            light: group(
                "light",
                &[
                    (fragment, texture(smooth, TextureViewDimension::Cube, false)),
                    image,
                    (fragment, BindingType::Sampler(SamplerBindingType::Filtering)),
                    (fragment, texture(TextureSampleType::Depth, TextureViewDimension::D2, false)),
                    (fragment, BindingType::Sampler(SamplerBindingType::Comparison)),
                    image,
                    image,
                    (fragment, texture(smooth, TextureViewDimension::D2Array, false)),
                ],
            ),
            material: group(
                "material",
                &[
                    (fragment, uniform),
                    (fragment, BindingType::Sampler(SamplerBindingType::Filtering)),
                    image,
                    image,
                    image,
                    image,
                    image,
                ],
            ),
            resolve: group(
                "resolve",
                &[(fragment, texture(TextureSampleType::Float { filterable: false }, TextureViewDimension::D2, true))],
            ),
        }
    }
}

/// What differs between the pipelines.
struct State<'a> {
    label: &'a str,
    module: &'a wgpu::ShaderModule,
    layout: &'a wgpu::PipelineLayout,
    entries: (&'a str, Option<&'a str>),
    buffer: Option<wgpu::VertexBufferLayout<'a>>,
    constants: &'a [(&'a str, f64)],
    cull: bool,
    depth: Option<(wgpu::TextureFormat, bool, wgpu::CompareFunction)>,
    color: Option<(wgpu::TextureFormat, Option<wgpu::BlendState>)>,
    samples: u32,
}

fn pipeline(device: &wgpu::Device, state: State) -> wgpu::RenderPipeline {
    let compilation = wgpu::PipelineCompilationOptions { constants: state.constants, ..Default::default() };
    let target = state.color.map(|(format, blend)| wgpu::ColorTargetState {
        format,
        blend,
        // Alpha stays as cleared: the picture is opaque whatever was blended into it.
        write_mask: wgpu::ColorWrites::COLOR,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(state.label),
        layout: Some(state.layout),
        vertex: wgpu::VertexState {
            module: state.module,
            entry_point: Some(state.entries.0),
            compilation_options: compilation.clone(),
            buffers: &[state.buffer],
        },
        primitive: wgpu::PrimitiveState { cull_mode: state.cull.then_some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: state.depth.map(|(format, write, compare)| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(write),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: state.samples, ..Default::default() },
        fragment: state.entries.1.map(|entry| wgpu::FragmentState {
            module: state.module,
            entry_point: Some(entry),
            compilation_options: compilation,
            targets: std::slice::from_ref(&target),
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl Pipelines {
    pub fn new(gpu: &Gpu, layouts: &Layouts, options: &Options) -> Self {
        let device = &gpu.device;
        let module = |label, source: &'static str| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            })
        };
        let layout = |label, groups: &[&wgpu::BindGroupLayout]| {
            let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &groups,
                immediate_size: 0,
            })
        };
        let shadow_layout = layout("shadow", &[&layouts.frame]);
        let light_layout = layout("light", &[&layouts.frame, &layouts.light]);
        let material_layout = layout("material", &[&layouts.frame, &layouts.light, &layouts.material]);
        let resolve_layout = layout("resolve", &[&layouts.resolve]);
        let (forward, room) = (module("forward", FORWARD), module("room", ROOM));
        let (shadows, wires) = (module("shadows", SHADOWS), module("wires", WIRES));
        let (motes, resolve) = (module("motes", MOTES), module("resolve", RESOLVE));

        let nearer = wgpu::CompareFunction::Greater;
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let adding = Some(wgpu::BlendState { color: add, alpha: add });
        let blending = Some(wgpu::BlendState::ALPHA_BLENDING);
        let tonemap = match options.look.tonemap {
            Tonemap::Neutral => 0.0,
            Tonemap::Aces => 1.0,
            Tonemap::Agx => 2.0,
            Tonemap::Clamp => 3.0,
        };
        let area_light = if options.look.area_light.is_some() { 1.0 } else { 0.0 };
        let constants = [("TONEMAP", tonemap), ("AREA_LIGHT", area_light)];
        // A pass into the picture itself.
        let base = || State {
            label: "room",
            module: &room,
            layout: &light_layout,
            entries: ("vertex", Some("fragment")),
            buffer: None,
            constants: &constants,
            cull: false,
            depth: Some((DEPTH_FORMAT, true, nearer)),
            color: Some((options.format, None)),
            samples: options.msaa,
        };
        let meshes = |blend: bool, double_sided: bool| {
            pipeline(
                device,
                State {
                    label: "forward",
                    module: &forward,
                    layout: &material_layout,
                    buffer: Some(VERTEX),
                    cull: !double_sided,
                    depth: Some((DEPTH_FORMAT, !blend, nearer)),
                    color: Some((options.format, if blend { blending } else { None })),
                    ..base()
                },
            )
        };
        let overlay = |label, module, buffer, constants, blend| {
            let depth = Some((DEPTH_FORMAT, false, nearer));
            let color = Some((options.format, blend));
            pipeline(device, State { label, module, buffer: Some(buffer), constants, depth, color, ..base() })
        };
        let plane = |label, entries, buffer, plane: usize, compare, write| {
            pipeline(
                device,
                State {
                    label,
                    module: &shadows,
                    layout: &shadow_layout,
                    entries,
                    buffer: Some(buffer),
                    constants: &[("PLANE", plane as f64)],
                    cull: false,
                    depth: Some((ORDER_FORMAT, write, compare)),
                    color: Some((PLANE_FORMAT, adding)),
                    samples: 1,
                },
            )
        };
        let plane_meshes = |p| {
            let entries = ("mesh_vertex", Some("mesh_fragment"));
            plane("plane meshes", entries, VERTEX, p, wgpu::CompareFunction::Less, true)
        };
        let plane_wires = |p| {
            let entries = ("wire_vertex", Some("wire_fragment"));
            plane("plane wires", entries, SEGMENT, p, wgpu::CompareFunction::Always, false)
        };
        Self {
            forward: [false, true].map(|blend| [false, true].map(|double_sided| meshes(blend, double_sided))),
            room: [0.0, 1.0, 2.0].map(|receiver| {
                let constants = [constants[0], constants[1], ("RECEIVER", receiver)];
                pipeline(device, State { constants: &constants, ..base() })
            }),
            backdrop: pipeline(
                device,
                State {
                    label: "backdrop",
                    entries: ("backdrop_vertex", Some("backdrop_fragment")),
                    depth: Some((DEPTH_FORMAT, false, wgpu::CompareFunction::GreaterEqual)),
                    ..base()
                },
            ),
            wires: overlay("wires", &wires, SEGMENT, &constants, blending),
            motes: overlay("motes", &motes, MOTE, &[], adding),
            plane_meshes: [plane_meshes(0), plane_meshes(1)],
            plane_wires: [plane_wires(0), plane_wires(1)],
            shadow_map: pipeline(
                device,
                State {
                    label: "shadow map",
                    module: &shadows,
                    layout: &shadow_layout,
                    entries: ("map_vertex", None),
                    buffer: Some(VERTEX),
                    constants: &[],
                    color: None,
                    samples: 1,
                    ..base()
                },
            ),
            resolve: pipeline(
                device,
                State {
                    label: "resolve",
                    module: &resolve,
                    layout: &resolve_layout,
                    constants: &[],
                    depth: None,
                    samples: 1,
                    ..base()
                },
            ),
        }
    }
}
