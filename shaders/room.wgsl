// The gallery around the work: six inner faces of a box. Static light comes from a baked map, lamps are evaluated
// here, and their shadows on the wall behind the work and on the floor are read from the textures of shadows.wgsl.

// Which shadow the faces drawn receive: 0 the wall's, 1 the floor's, 2 none.
override RECEIVER: u32 = 2u;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) local: vec3f,                      // −1 … 1 in the box
    @location(2) @interpolate(flat) face: u32,      // 0 wall, 1 floor, 2 ceiling, 3 left, 4 right, 5 behind the eye
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
    let p = local * globals.room_half;
    var out: Varying;
    out.local = local;
    out.face = face;
    out.position = globals.room_center + globals.room_x * p.x + vec3f(0.0, p.y, 0.0) + globals.room_z * p.z;
    out.clip = globals.clip_from_world * vec4f(out.position, 1.0);
    return out;
}

// Cubic B-spline through four bilinear taps (Sigg and Hadwiger 2005): a shadow without the squares of its texels.
fn bicubic(t: texture_2d<f32>, at: vec2f) -> vec2f {
    let size = vec2f(textureDimensions(t));
    let x = at * size - 0.5;
    let f = fract(x);
    let i = floor(x);
    let w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0;
    let w1 = (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0;
    let w3 = f * f * f / 6.0;
    let w2 = 1.0 - w0 - w1 - w3;
    let g0 = w0 + w1;
    let g1 = w2 + w3;
    let a = (i - 0.5 + w1 / g0) / size;
    let b = (i + 1.5 + w3 / g1) / size;
    let top = g0.x * textureSampleLevel(t, smooth_sampler, vec2f(a.x, a.y), 0.0).xy + g1.x * textureSampleLevel(t, smooth_sampler, vec2f(b.x, a.y), 0.0).xy;
    let low = g0.x * textureSampleLevel(t, smooth_sampler, vec2f(a.x, b.y), 0.0).xy + g1.x * textureSampleLevel(t, smooth_sampler, vec2f(b.x, b.y), 0.0).xy;
    return g0.y * top + g1.y * low;
}

fn blocked(p: vec3f) -> vec2f {
    if RECEIVER > 1u {
        return vec2f(0.0);
    }
    let q = globals.planes[RECEIVER & 1u];
    let at = vec2f(dot(p - q.origin, q.u) / q.width, dot(p - q.origin, q.v) / q.height);
    var hidden: vec2f;
    if RECEIVER == 0u {
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
        case 0u: { normal = globals.room_z; uv = v.local.xy; }
        case 1u: { normal = vec3f(0.0, 1.0, 0.0); uv = v.local.xz; }
        case 2u: { normal = vec3f(0.0, -1.0, 0.0); uv = v.local.xz; }
        case 3u: { normal = globals.room_x; uv = v.local.yz; }
        case 4u: { normal = -globals.room_x; uv = v.local.yz; }
        default: { normal = -globals.room_z; uv = v.local.xy; }
    }
    let map = textureSampleLevel(lightmap, smooth_sampler, uv * 0.5 + 0.5, i32(v.face), 0.0);
    // The map's fourth channel is the radiance of a luminous field.
    let albedo = select(globals.wall_albedo, globals.floor_albedo, v.face == 1u);
    let hidden = blocked(v.position);
    var irradiance = map.rgb;
    for (var i = 0u; i < globals.lamp_count; i++) {
        let towards = normalize(globals.lamps[i].position - v.position);
        irradiance += lamp_beam(i, v.position) * max(dot(normal, towards), 0.0) * (1.0 - hidden[i]);
    }
    let radiance = albedo / PI * irradiance + vec3f(map.a);
    return vec4f(display(radiance, v.clip.xy), 1.0);
}

// Where the scenario wants no room: one colour behind everything, at the far end of the depth range.
@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn backdrop_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(display(globals.background, position.xy), 1.0);
}
