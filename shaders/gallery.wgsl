// The gallery around the exhibit: six inner faces of a box. Static light comes from a baked map. Lamps are evaluated
// here, and their shadows on the wall and the floor are read from the textures of shadows.wgsl.

// The only two faces that receive shadows.
const WALL: u32 = 0u;
const FLOOR: u32 = 1u;

// Perceptual roughness of worn oiled boards.
const FLOOR_ROUGHNESS: f32 = 0.42;
// Width of a board and of the groove between two, m.
const BOARD: f32 = 0.14;
const GROOVE: f32 = 0.002;
// Contrast of the grain of each size.
const GRAIN: f32 = 0.16;
// Height of the shadow gap at the foot of the wall, in half heights of the gallery.
const GAP: f32 = 0.004;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) local: vec3f,                      // −1 … 1 in the box
    @location(2) @interpolate(flat) face: u32,      // 0 wall, 1 floor, 2 ceiling, 3 left, 4 right, 5 behind the camera
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let face = index / 6u;
    var corners = array<vec2f, 6>(vec2f(-1.0, -1.0), vec2f(1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, 1.0));
    let c = corners[index % 6u];
    var local: vec3f;
    switch face {
        case 0u: { local = vec3f(c.x, c.y, -1.0); }
        case 1u: { local = vec3f(c.x, -1.0, c.y); }
        case 2u: { local = vec3f(c.x, 1.0, c.y); }
        case 3u: { local = vec3f(-1.0, c.x, c.y); }
        case 4u: { local = vec3f(1.0, c.x, c.y); }
        default: { local = vec3f(c.x, c.y, 1.0); }
    }
    let p = local * globals.gallery_half;
    var out: Varying;
    out.local = local;
    out.face = face;
    out.position = globals.gallery_center + globals.gallery_x * p.x + vec3f(0.0, p.y, 0.0) + globals.gallery_z * p.z;
    out.clip = globals.clip_from_world * vec4f(out.position, 1.0);
    return out;
}

// Cubic B-spline filter by four bilinear taps (Sigg and Hadwiger 2005), which hides the texels of a shadow.
// Positions of the four taps, and their weights along both axes.
struct Taps {
    near: vec2f,
    far: vec2f,
    g0: vec2f,
    g1: vec2f,
}

fn bicubic_taps(size: vec2f, at: vec2f) -> Taps {
    let x = at * size - 0.5;
    let f = fract(x);
    let i = floor(x);
    let w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0;
    let w1 = (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0;
    let w3 = f * f * f / 6.0;
    let w2 = 1.0 - w0 - w1 - w3;
    return Taps((i - 0.5 + w1 / (w0 + w1)) / size, (i + 1.5 + w3 / (w2 + w3)) / size, w0 + w1, w2 + w3);
}

fn bicubic(t: texture_2d<f32>, at: vec2f) -> vec2f {
    let k = bicubic_taps(vec2f(textureDimensions(t)), at);
    let top = k.g0.x * textureSampleLevel(t, smooth_sampler, k.near, 0.0).xy
        + k.g1.x * textureSampleLevel(t, smooth_sampler, vec2f(k.far.x, k.near.y), 0.0).xy;
    let low = k.g0.x * textureSampleLevel(t, smooth_sampler, vec2f(k.near.x, k.far.y), 0.0).xy
        + k.g1.x * textureSampleLevel(t, smooth_sampler, k.far, 0.0).xy;
    return k.g0.y * top + k.g1.y * low;
}

fn bicubic_layer(t: texture_2d_array<f32>, at: vec2f, layer: i32) -> vec4f {
    let k = bicubic_taps(vec2f(textureDimensions(t)), at);
    let top = k.g0.x * textureSampleLevel(t, smooth_sampler, k.near, layer, 0.0)
        + k.g1.x * textureSampleLevel(t, smooth_sampler, vec2f(k.far.x, k.near.y), layer, 0.0);
    let low = k.g0.x * textureSampleLevel(t, smooth_sampler, vec2f(k.near.x, k.far.y), layer, 0.0)
        + k.g1.x * textureSampleLevel(t, smooth_sampler, k.far, layer, 0.0);
    return k.g0.y * top + k.g1.y * low;
}

// Texture coordinates on a receiving plane.
fn plane_place(p: vec3f, face: u32) -> vec2f {
    let q = globals.planes[face];
    return vec2f(dot(p - q.origin, q.u) / q.width, dot(p - q.origin, q.v) / q.height);
}

// Irradiance that static parts send, and the visible fraction of the gallery's own light beside them.
fn beside_parts(p: vec3f, face: u32) -> vec4f {
    let alone = vec4f(0.0, 0.0, 0.0, 1.0);
    if face > FLOOR {
        return alone;
    }
    let at = plane_place(p, face);
    let beside = bicubic_layer(ambient, at, i32(face));
    return select(alone, beside, all(at >= vec2f(0.0)) && all(at <= vec2f(1.0)));
}

// Shade of the floor's boards, 1 on average: each slightly lighter or darker, with a groove between, antialiased by
// coverage. They run from the wall to the visitor, so a pixel is narrow across them at any slant.
fn boards(across: f32, pixel: f32) -> f32 {
    let x = across / BOARD;
    let w = clamp(pixel / BOARD, 1e-4, 1.0);
    let nearest = round(x);
    let side = clamp((x - nearest) / w + 0.5, 0.0, 1.0);
    let tone = mix(board_tone(nearest - 1.0), board_tone(nearest), side);
    let groove = GROOVE / BOARD;
    let covered = clamp((0.5 * (groove + w) - abs(x - nearest)) / min(groove, w), 0.0, 1.0) * min(groove / w, 1.0);
    return tone * (1.0 - 0.28 * covered);
}

// Grain of the boards, 1 on average: smooth noise of cells long along the board and narrow across, in two sizes; each fades
// where a pixel is as wide as its cells. Every board has its own.
fn grain(across: f32, along: f32, pixel: f32) -> f32 {
    let board = floor(across / BOARD);
    var sum = 1.0;
    // A loop, so that software Vulkan skips it on the other faces.
    for (var k = 0u; k < 2u; k++) {
        let cell = select(vec2f(0.0031, 0.17), vec2f(0.0113, 0.43), k == 1u);
        let at = vec2f(across, along + 3.7 * board) / cell + 65536.0;
        let low = floor(at);
        let f = at - low;
        let s = f * f * (3.0 - 2.0 * f);
        let near = mix(pixel_noise(low), pixel_noise(low + vec2f(1.0, 0.0)), s.x);
        let far = mix(pixel_noise(low + vec2f(0.0, 1.0)), pixel_noise(low + vec2f(1.0, 1.0)), s.x);
        sum += GRAIN * mix(near, far, s.y) * clamp(2.0 - 2.0 * pixel / cell.x, 0.0, 1.0);
    }
    return sum;
}

fn board_tone(board: f32) -> f32 {
    return 1.0 + 0.07 * pixel_noise(vec2f(board + 4096.0, 77.0));
}

// Reflection of the gallery in the floor's varnish; its fourth component is the fraction of light that passes the varnish.
fn floor_gloss(p: vec3f, normal: vec3f) -> vec4f {
    let view = normalize(globals.eye - p);
    let nv = clamp(dot(normal, view), 1e-3, 1.0);
    let ab = textureSampleLevel(dfg, smooth_sampler, vec2f(nv, FLOOR_ROUGHNESS), 0.0).xy;
    let seen = box_projected(p, reflect(-view, normal));
    let reflected = 0.04 * ab.x + ab.y;
    let mirrored = textureSampleLevel(environment, smooth_sampler, seen, FLOOR_ROUGHNESS * globals.env_lods).rgb;
    return vec4f(mirrored * reflected, 1.0 - reflected);
}

fn blocked(p: vec3f, face: u32) -> vec2f {
    if face > FLOOR {
        return vec2f(0.0);
    }
    let at = plane_place(p, face);
    var hidden: vec2f;
    if face == WALL {
        hidden = bicubic(wall_shadow, at);
    } else {
        hidden = bicubic(floor_shadow, at);
    }
    return select(vec2f(0.0), min(hidden, vec2f(1.0)), all(at >= vec2f(0.0)) && all(at <= vec2f(1.0)));
}

@fragment
fn fragment(v: Varying) -> @location(0) vec4f {
    var normal: vec3f;
    var uv: vec2f;
    switch v.face {
        case 0u: { normal = globals.gallery_z; uv = v.local.xy; }
        case 1u: { normal = vec3f(0.0, 1.0, 0.0); uv = v.local.xz; }
        case 2u: { normal = vec3f(0.0, -1.0, 0.0); uv = v.local.xz; }
        case 3u: { normal = globals.gallery_x; uv = v.local.yz; }
        case 4u: { normal = -globals.gallery_x; uv = v.local.yz; }
        default: { normal = -globals.gallery_z; uv = v.local.xy; }
    }
    let map = textureSampleLevel(lightmap, smooth_sampler, uv * 0.5 + 0.5, i32(v.face), 0.0);
    // The map's fourth channel is the radiance of a luminous field.
    var albedo = select(globals.wall_albedo, globals.floor_albedo, v.face == FLOOR);
    // No panel hangs behind the exhibit or on the floor.
    let panels = select(0u, 9u, v.face > FLOOR);
    for (var i = 0u; i < panels; i++) {
        let panel = globals.panels[i];
        let on = u32(panel.face) == v.face && all(abs(uv - panel.center) < panel.half);
        albedo = select(albedo, panel.albedo, on);
    }
    let hidden = blocked(v.position, v.face);
    let beside = beside_parts(v.position, v.face);
    let open = beside.w;
    var irradiance = map.rgb * open + beside.rgb;
    for (var i = 0u; i < globals.lamp_count; i++) {
        let towards = normalize(globals.lamps[i].position - v.position);
        irradiance += lamp_beam(i, v.position) * max(dot(normal, towards), 0.0) * (1.0 - hidden[i]);
    }
    var radiance = albedo / PI * irradiance + vec3f(map.a);
    if v.face == FLOOR {
        let pixel = globals.pixel_angle * length(globals.eye - v.position);
        let gloss = floor_gloss(v.position, normal);
        let across = v.local.x * globals.gallery_half.x;
        radiance *= boards(across, pixel) * grain(across, v.local.z * globals.gallery_half.z, pixel) * gloss.a;
        radiance += gloss.rgb * open;
    }
    if v.face != FLOOR {
        // The walls end slightly above the floor: a dark gap, antialiased by coverage.
        let away = globals.eye - v.position;
        let pixel = globals.pixel_angle * length(away) / globals.gallery_half.y;
        let above = select(v.local.y + 1.0, 1.0, v.face == 2u);
        radiance *= 1.0 - 0.72 * clamp((GAP - above) / pixel + 0.5, 0.0, 1.0) * min(GAP / pixel, 1.0);
    }
    return vec4f(tone_mapped(radiance, v.clip.xy), 1.0);
}

// Scenarios without a gallery: one colour as background, at the far end of the depth range.
@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn backdrop_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(tone_mapped(globals.background, position.xy), 1.0);
}
