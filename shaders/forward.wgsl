// The exhibit's meshes. One vertex buffer holds them all, each vertex with the index of the body that carries it.
//
// Glass is drawn in two kinds of passes over the background: its transmission multiplies the background
// (`tint_fragment`; the order of panes does not matter), its reflection is added (`gloss_fragment`).

// Indices of the textures in `Material::uv`.
const BASE: u32 = 0u;
const ROUGH: u32 = 1u;
const NORMAL: u32 = 2u;
const OCCLUSION: u32 = 3u;
const GLOW: u32 = 4u;
const TRANSMISSION: u32 = 5u;
const THICKNESS: u32 = 6u;
const SPECULAR: u32 = 7u;
const SPECULAR_COLOR: u32 = 8u;
const COAT: u32 = 9u;
const COAT_ROUGHNESS: u32 = 10u;
const COAT_NORMAL: u32 = 11u;
const SHEEN: u32 = 12u;
const SHEEN_ROUGHNESS: u32 = 13u;

struct Material {
    base_color: vec4f,
    emissive: vec3f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,   // 0 without a normal map
    occlusion: f32,
    cutoff: f32,         // 0 keeps every fragment
    f0: vec3f,           // of what is not metal
    f90: f32,
    absorption: vec3f,   // 1/m
    thickness: f32,      // m
    sheen: vec3f,
    sheen_roughness: f32,
    transmission: f32,
    ior: f32,
    coat: f32,
    coat_roughness: f32,
    unlit: f32,
    coat_normal_scale: f32, // 0 without a normal map of the coat
    spare: vec2f,
    uv: array<vec4f, 28>, // two rows of each texture's transform; w of the first: which set of coordinates
}

@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var base_color_texture: texture_2d<f32>;
@group(2) @binding(2) var metallic_roughness_texture: texture_2d<f32>;
@group(2) @binding(3) var normal_texture: texture_2d<f32>;
@group(2) @binding(4) var occlusion_texture: texture_2d<f32>;
@group(2) @binding(5) var emissive_texture: texture_2d<f32>;
@group(2) @binding(6) var base_color_sampler: sampler;
@group(2) @binding(7) var metallic_roughness_sampler: sampler;
@group(2) @binding(8) var normal_sampler: sampler;
@group(2) @binding(9) var occlusion_sampler: sampler;
@group(2) @binding(10) var emissive_sampler: sampler;
// Textures of material extensions, packed as in `details.rs`.
@group(2) @binding(11) var detail_colors: texture_2d_array<f32>;
@group(2) @binding(12) var detail_data: texture_2d_array<f32>;
@group(2) @binding(13) var detail_sampler: sampler;

// A pipeline constant: few materials have any of them.
override DETAILS: bool = false;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec4f,      // two sets
    @location(4) color: vec4f,
    @location(5) tag: u32,
    @location(6) bounce: vec4f,  // irradiance from other surfaces, and the visible fraction of the fill lamp
    @location(7) outline: u32,
}

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec4f,
    @location(4) color: vec4f,
    @location(5) visibility: f32,
    @location(6) bounce: vec4f,
    @location(7) @interpolate(flat) outline: u32,
}

// Partly covered pixels are drawn by ribbons: quads along the silhouette of a plate, wide enough for every pixel that
// it crosses. Where ribbons overlap, the one of the nearest edge draws the pixel.
override OUTLINED: bool = false;
override RIBBON: bool = false;

@vertex
fn vertex(v: Vertex) -> Varying {
    let frame = frame_of_tag(v.tag);
    var out: Varying;
    out.position = to_world(v.position, frame);
    out.clip = globals.clip_from_world * vec4f(out.position, 1.0);
    out.normal = turn_to_world(v.normal, frame);
    out.tangent = vec4f(turn_to_world(v.tangent.xyz, frame), v.tangent.w);
    out.uv = v.uv;
    out.color = v.color;
    out.visibility = visibility_of_tag(v.tag);
    out.bounce = v.bounce;
    out.outline = v.outline;
    return out;
}

// Half width of a ribbon, pixels: all samples of a pixel that the edge crosses are within it.
const RIBBON_REACH: f32 = 1.6;

struct Ribbon {
    @location(0) a: vec3f,
    @location(1) b: vec3f,
    @location(2) normal: vec3f,
    @location(3) uv_a: vec4f,
    @location(4) uv_b: vec4f,
    @location(5) color: vec4f,
    @location(6) tag: u32,
    @location(7) outline: u32,   // the plate, and the edge in its silhouette
    @location(8) bounce: vec4f,
}

@vertex
fn ribbon_vertex(@builtin(vertex_index) index: u32, r: Ribbon) -> Varying {
    var corners = array<vec2f, 6>(vec2f(0.0, -1.0), vec2f(1.0, -1.0), vec2f(1.0, 1.0), vec2f(0.0, -1.0), vec2f(1.0, 1.0), vec2f(0.0, 1.0));
    let c = corners[index];
    let end = select(r.a, r.b, c.x > 0.5);
    let ray = end - globals.eye;
    let forward = cross(globals.up, globals.right);
    let reach = RIBBON_REACH * globals.pixel_angle * dot(ray, forward);
    // Along and across the edge in the picture.
    let a = globals.clip_from_world * vec4f(r.a, 1.0);
    let b = globals.clip_from_world * vec4f(r.b, 1.0);
    let screen_edge = b.xy / b.w - a.xy / a.w;
    let aspect = globals.clip_from_world * vec4f(globals.right, 0.0);
    let scale = vec2f(length(globals.clip_from_world * vec4f(globals.up, 0.0)) / length(aspect), 1.0);
    let flat = screen_edge * scale;
    let along = select(vec2f(1.0, 0.0), flat * inverseSqrt(max(dot(flat, flat), 1e-30)), dot(flat, flat) > 1e-20);
    let offset = (along * (2.0 * c.x - 1.0) + vec2f(-along.y, along.x) * c.y) * reach;
    var out: Varying;
    out.position = end;
    out.clip = globals.clip_from_world * vec4f(end + globals.right * offset.x + globals.up * offset.y, 1.0);
    out.normal = r.normal;
    out.tangent = vec4f(0.0);
    out.uv = select(r.uv_a, r.uv_b, c.x > 0.5);
    out.color = r.color;
    out.visibility = visibility_of_tag(r.tag);
    out.bounce = r.bounce;
    out.outline = r.outline;
    return out;
}

fn place(v: Varying, texture: u32) -> vec2f {
    let first = material.uv[2u * texture];
    let at = vec3f(select(v.uv.xy, v.uv.zw, first.w > 0.5), 1.0);
    return vec2f(dot(first.xyz, at), dot(material.uv[2u * texture + 1u].xyz, at));
}

// A surface, and its properties beyond the BRDF.
struct Seen {
    surface: Surface,
    base: vec4f,
    glow: vec3f,
    thickness: f32,
}

fn detail_color(v: Varying, texture: u32, layer: u32) -> vec4f {
    return textureSample(detail_colors, detail_sampler, place(v, texture), layer);
}

fn detail_of(v: Varying, texture: u32, layer: u32) -> vec4f {
    return textureSample(detail_data, detail_sampler, place(v, texture), layer);
}

// A normal n perturbed by a normal map with the transform `at`. Without tangents in the file the frame comes from the
// derivatives of position and texture coordinates (Schüler 2006).
fn bent(v: Varying, n: vec3f, bump: vec3f, scale: f32, dp_x: vec3f, dp_y: vec3f, at_x: vec2f, at_y: vec2f) -> vec3f {
    var t = v.tangent.xyz;
    var b = cross(n, t) * v.tangent.w;
    if v.tangent.w == 0.0 {
        let px = cross(n, dp_x);
        let py = cross(dp_y, n);
        // Derivatives along y are taken downwards, which turns both signs; and the map's second axis points up, against v.
        t = -(py * at_x.x + px * at_y.x);
        b = py * at_x.y + px * at_y.y;
        // Of unit length each, as in a file: slopes do not depend on how far the map is stretched.
        t *= inverseSqrt(max(dot(t, t), 1e-30));
        b *= inverseSqrt(max(dot(b, b), 1e-30));
    }
    return normalize(t * bump.x * scale + b * bump.y * scale + n * bump.z);
}

fn seen(v: Varying) -> Seen {
    let dp_x = dpdx(v.position);
    let dp_y = dpdy(v.position);
    let bump_at = place(v, NORMAL);
    let duv_x = dpdx(bump_at);
    let duv_y = dpdy(bump_at);
    let mr = textureSample(metallic_roughness_texture, metallic_roughness_sampler, place(v, ROUGH));
    let bump = textureSample(normal_texture, normal_sampler, bump_at).xyz * 2.0 - 1.0;
    let ao = textureSample(occlusion_texture, occlusion_sampler, place(v, OCCLUSION)).r;
    let glow = textureSample(emissive_texture, emissive_sampler, place(v, GLOW)).rgb;
    var out: Seen;
    out.base = material.base_color * v.color * textureSample(base_color_texture, base_color_sampler, place(v, BASE));
    out.glow = material.emissive * glow;

    var s: Surface;
    s.position = v.position;
    s.view = normalize(globals.eye - v.position);
    var facing = cross(dp_x, dp_y);
    facing = facing * inverseSqrt(max(dot(facing, facing), 1e-30));
    if RIBBON {
        facing = v.normal;
    }
    facing = select(-facing, facing, dot(facing, s.view) > 0.0);
    var n = normalize(v.normal + facing * 1e-6);
    n = select(-n, n, dot(n, facing) >= 0.0);
    // Rate of change of the normal from pixel to pixel, before the normal map adds its detail.
    let dn_x = dpdx(n);
    let dn_y = dpdy(n);
    let smooth_normal = n;
    if material.normal_scale != 0.0 {
        n = bent(v, n, bump, material.normal_scale, dp_x, dp_y, duv_x, duv_y);
    }
    s.normal = n;
    s.facing = facing;
    s.albedo = out.base.rgb;
    s.metallic = clamp(material.metallic * mr.b, 0.0, 1.0);
    // Curved thin metal would sparkle: widen the lobe by the variation of the normal in the pixel (Tokuyoshi, Kaplanyan
    // 2021).
    let turn = min(0.5 * (dot(dn_x, dn_x) + dot(dn_y, dn_y)), 0.18);
    let rough = clamp(material.roughness * mr.g, 0.045, 1.0);
    s.roughness = sqrt(sqrt(min(rough * rough * rough * rough + turn, 1.0)));
    let creases = 1.0 + material.occlusion * (ao - 1.0);
    s.occlusion = creases * v.visibility;
    s.bounce = creases * v.bounce.rgb;
    s.fill = v.bounce.w;
    s.f0 = material.f0;
    s.f90 = material.f90;
    s.transmission = material.transmission;
    s.sheen = material.sheen;
    s.sheen_roughness = material.sheen_roughness;
    s.coat = material.coat;
    s.coat_normal = n;
    var coat_roughness = material.coat_roughness;
    out.thickness = material.thickness;
    if DETAILS {
        let strength = detail_color(v, SPECULAR, 0u).a;
        s.f0 *= detail_color(v, SPECULAR_COLOR, 0u).rgb * strength;
        s.f90 *= strength;
        s.sheen *= detail_color(v, SHEEN, 1u).rgb;
        s.sheen_roughness *= detail_color(v, SHEEN_ROUGHNESS, 1u).a;
        s.transmission *= detail_of(v, TRANSMISSION, 0u).r;
        out.thickness *= detail_of(v, THICKNESS, 0u).g;
        s.coat *= detail_of(v, COAT, 0u).b;
        coat_roughness *= detail_of(v, COAT_ROUGHNESS, 0u).a;
        let at = place(v, COAT_NORMAL);
        let coat_bump = detail_of(v, COAT_NORMAL, 1u).xyz * 2.0 - 1.0;
        let at_x = dpdx(at);
        let at_y = dpdy(at);
        if material.coat_normal_scale != 0.0 {
            s.coat_normal = bent(v, smooth_normal, coat_bump, material.coat_normal_scale, dp_x, dp_y, at_x, at_y);
        }
    }
    s.coat_roughness = sqrt(sqrt(min(pow(max(coat_roughness, 0.045), 4.0) + turn, 1.0)));
    out.surface = s;
    return out;
}

@fragment
fn fragment(v: Varying) -> @location(0) vec4f {
    let it = seen(v);
    if it.base.a < material.cutoff {
        discard;
    }
    if OUTLINED && cover(v.clip.xy, v.outline).part < WHOLE {
        discard;
    }
    if material.unlit > 0.5 {
        return vec4f(tone_mapped(it.base.rgb, v.clip.xy), it.base.a);
    }
    let radiance = shade(it.surface, key_light_at(it.surface)) + it.glow;
    return vec4f(tone_mapped(radiance, v.clip.xy), it.base.a);
}

// A pixel that the plate covers partly.
@fragment
fn ribbon_fragment(v: Varying) -> @location(0) vec4f {
    let it = seen(v);
    let part = cover(v.clip.xy, v.outline & 0xffffu);
    if part.part >= WHOLE_OF_RIBBON || part.part <= 0.0 || part.nearest != v.outline >> 16u {
        discard;
    }
    if material.unlit > 0.5 {
        return vec4f(tone_mapped(it.base.rgb, v.clip.xy), part.part);
    }
    let radiance = shade(it.surface, key_light_at(it.surface)) + it.glow;
    return vec4f(tone_mapped(radiance, v.clip.xy), part.part);
}

// Transmitted fraction of the background in one crossing of the surface, per channel.
@fragment
fn tint_fragment(v: Varying) -> @location(0) vec4f {
    let it = seen(v);
    let s = it.surface;
    let nv = clamp(dot(s.normal, s.view), 0.0, 1.0);
    let x = 1.0 - nv;
    let fresnel = s.f0 + (s.f90 - s.f0) * (x * x * x * x * x);
    // Path length through the wall by Snell's law, limited where a curved wall is seen along itself.
    let refracted = sqrt(max(1.0 - (1.0 - nv * nv) / (material.ior * material.ior), 0.05));
    let path_length = (1.0 / refracted) + 4.0 * x * x * x;
    // The base colour is that of a whole pane, two crossings.
    let color = pow(max(it.base.rgb, vec3f(1e-3)), vec3f(0.5 * path_length)) * exp(-material.absorption * it.thickness * path_length);
    let through = s.transmission * (1.0 - s.metallic) * (1.0 - fresnel) * color;
    return vec4f(through, 1.0);
}

// Radiance of the surface itself towards the camera.
@fragment
fn gloss_fragment(v: Varying) -> @location(0) vec4f {
    let it = seen(v);
    let radiance = shade(it.surface, key_light_at(it.surface)) + it.glow;
    return vec4f(min(radiance * globals.exposure, vec3f(1.0)), 1.0);
}
