// Common to every pass: the uniforms of a frame, the body frames, and the tone curve.
//
// Frames: `world` is metres, +Y up. Vertices are stored in the frame of the body that carries them (`body`), static
// ones in the world; `world_from_body` holds the rigid motion of each, entry 0 the identity.

struct Lamp {
    position: vec3f,
    radius: f32,      // radius of the luminous disc, m
    color: vec3f,     // radiant intensity on the axis, W/sr per channel
    cos_outer: f32,
    axis: vec3f,      // unit, direction of the light
    cos_inner: f32,
}

struct Punctual {
    position: vec3f,
    kind: f32,        // 0 directional, 1 point, 2 spot
    color: vec3f,
    range: f32,       // m, 0 unlimited
    axis: vec3f,
    spare: f32,
    cone: vec4f,      // cos inner, cos outer
}

// A receiving plane: `origin` is a corner, texture coordinates run along `u` and `v` (unit) over `size` metres.
struct Plane {
    origin: vec3f,
    width: f32,
    u: vec3f,
    height: f32,
    v: vec3f,
    spare: f32,
    normal: vec3f,
    spare2: f32,
}

// A rectangle of another reflectance on a face of the gallery, in the face's coordinates −1 … 1.
struct Panel {
    center: vec2f,
    half: vec2f,
    albedo: vec3f,
    face: f32,
}

struct Globals {
    clip_from_world: mat4x4f,
    shadow_from_world: mat4x4f,
    eye: vec3f,
    exposure: f32,
    right: vec3f,
    pixel_angle: f32,       // size of a pixel at distance 1
    up: vec3f,
    shadow_taps: f32,
    gallery_center: vec3f,
    dither: f32,            // height of the dither, LSB
    gallery_half: vec3f,
    dust_radius: f32,       // m
    gallery_x: vec3f,
    env_intensity: f32,
    gallery_z: vec3f,
    env_lods: f32,
    wall_albedo: vec3f,
    lamp_count: u32,
    floor_albedo: vec3f,
    punctual_count: u32,
    area_center: vec3f,
    shadow_radius: f32,     // of the light that casts the shadow map, m
    area_x: vec3f,          // half width along the rectangle, m
    shadow_texel: f32,      // size of a shadow-map texel at distance 1
    area_y: vec3f,
    shadow_samples: f32,
    area_radiance: vec3f,
    shadow_near: f32,
    background: vec3f,
    shadow_far: f32,
    environment_origin: vec3f,       // centre of the exhibit, m
    spare: f32,
    irradiance: array<vec4f, 9>,
    lamps: array<Lamp, 2>,
    planes: array<Plane, 2>,
    panels: array<Panel, 9>,
    punctual: array<Punctual, 8>,
}

@group(0) @binding(0) var<uniform> globals: Globals;
@group(0) @binding(1) var<uniform> world_from_body: array<mat3x4f, 1024>;

// A constant of the pipeline, not a uniform: software Vulkan runs every branch that it cannot rule out beforehand.
override TONEMAP: u32 = 0u;   // 0 Neutral, 1 ACES, 2 AgX, 3 clamp

const PI: f32 = 3.14159265;

fn to_world(position: vec3f, body: u32) -> vec3f {
    return vec4f(position, 1.0) * world_from_body[body];
}

// A vertex's tag: the frame that carries it in the low half, then its ambient visibility and its opacity to lamps.
fn frame_of_tag(tag: u32) -> u32 {
    return tag & 0xffffu;
}

fn visibility_of_tag(tag: u32) -> f32 {
    return f32((tag >> 16u) & 0xffu) / 255.0;
}

fn opacity_of_tag(tag: u32) -> f32 {
    return f32(tag >> 24u) / 255.0;
}

fn turn_to_world(direction: vec3f, body: u32) -> vec3f {
    return vec4f(direction, 0.0) * world_from_body[body];
}

// Point i of n of Vogel's spiral, which divides the unit disc evenly.
fn vogel(i: f32, n: f32) -> vec2f {
    let angle = i * 2.39996323;
    return sqrt((i + 0.5) / n) * vec2f(cos(angle), sin(angle));
}

// Two unit vectors that complete n to an orthonormal basis (Duff et al., JCGT 2017).
fn frame_of(n: vec3f) -> mat3x3f {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return mat3x3f(vec3f(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3f(b, s + n.y * n.y * a, -n.y), n);
}

// Khronos PBR Neutral (specification of 2024): the identity below 0.76, so that paint keeps its hue.
fn neutral(c: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let x = min(c.r, min(c.g, c.b));
    let offset = select(0.04, x - 6.25 * x * x, x < 0.08);
    let color = c - offset;
    let peak = max(color.r, max(color.g, color.b));
    if peak < start {
        return color;
    }
    let d = 1.0 - start;
    let new_peak = 1.0 - d * d / (peak + d - start);
    let g = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
    return mix(color * (new_peak / peak), vec3f(new_peak), g);
}

// ACES reference and output transform, fitted by Hill.
fn aces(c: vec3f) -> vec3f {
    let v = mat3x3f(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777) * c;
    let f = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    let m = mat3x3f(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    return clamp(m * f, vec3f(0.0), vec3f(1.0));
}

// AgX (Sobotka), basic contrast, with Wrensch's sixth-order fit of its contrast curve.
fn agx(c: vec3f) -> vec3f {
    let inset = mat3x3f(0.842479, 0.042328, 0.042376, 0.078434, 0.878469, 0.078434, 0.079224, 0.079166, 0.879143);
    let lowest = -12.47393;
    let highest = 4.026069;
    let v = log2(max(inset * c, vec3f(1e-10)));
    let x = clamp((v - lowest) / (highest - lowest), vec3f(0.0), vec3f(1.0));
    let x2 = x * x;
    let x4 = x2 * x2;
    let y = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    let outset = mat3x3f(1.196879, -0.052897, -0.052972, -0.098021, 1.151903, -0.098043, -0.099030, -0.098961, 1.151074);
    return pow(max(outset * y, vec3f(0.0)), vec3f(2.2));
}

// 32 random bits from a number (PCG, Jarzynski 2020).
fn hashed(seed: u32) -> u32 {
    let h = ((seed >> ((seed >> 28u) + 4u)) ^ seed) * 277803737u;
    return (h >> 22u) ^ h;
}

// From the pixel alone: the same in every frame, so it does not shimmer.
fn pixel_seed(pixel: vec2f) -> u32 {
    return u32(pixel.x) * 1664525u + u32(pixel.y) * 1013904223u + 12345u;
}

// Uniform noise in −½ … ½.
fn pixel_noise(pixel: vec2f) -> f32 {
    return f32(hashed(pixel_seed(pixel)) >> 8u) / 16777216.0 - 0.5;
}

// Noise in −1 … 1 of triangular density, one value a channel: the difference of two uniform ones. A dither of it leaves
// neither bands nor noise that depends on the colour (Lipshitz et al. 1992).
fn triangular_noise(pixel: vec2f) -> vec3f {
    let a = hashed(pixel_seed(pixel));
    let b = hashed(a + 2654435769u);
    let first = vec3f(vec3u(a, a >> 11u, a >> 22u) & vec3u(1023u));
    let second = vec3f(vec3u(b, b >> 11u, b >> 22u) & vec3u(1023u));
    return (first - second) / 1024.0;
}

// Tone curve: linear radiance to a linear display value, which the target encodes as sRGB.
fn tone_mapped(radiance: vec3f, pixel: vec2f) -> vec3f {
    let c = max(radiance * globals.exposure, vec3f(0.0));
    var out: vec3f;
    switch TONEMAP {
        case 1u: { out = aces(c); }
        case 2u: { out = agx(c); }
        case 3u: { out = min(c, vec3f(1.0)); }
        default: { out = neutral(c); }
    }
    // One step of an 8-bit sRGB code is about 2.1 √c / 255 in linear light, 1 / (12.92 · 255) near black.
    let step = max(2.1 * sqrt(max(out, vec3f(0.0))), vec3f(1.0 / 12.92)) / 255.0;
    return clamp(out + globals.dither * triangular_noise(pixel) * step, vec3f(0.0), vec3f(1.0));
}

// Irradiance at `p` from lamp `i` per unit cosine, without its shadow.
fn lamp_beam(i: u32, p: vec3f) -> vec3f {
    let lamp = globals.lamps[i];
    let away = p - lamp.position;
    let d2 = dot(away, away);
    let c = dot(away, lamp.axis) * inverseSqrt(d2);
    return lamp.color * smoothstep(lamp.cos_outer, lamp.cos_inner, c) / d2;
}
