// Soft shadows on the wall and the floor, as textures of the covered fraction of each lamp (red: lamp 0, green: 1).
//
// Flat plates: analytic, in plate_shadows.wgsl.
//
// Other meshes: every triangle is projected onto the plane from N points of each lamp's disc, each of which adds 1/N.
// For one point a texel must count once, however many triangles cover it. So each point draws at its own depth, nearer
// than the points before it: its first triangle passes `less` and its others fail.
//
// Wires: analytic. From a receiver x the wire is a strip across the lamp's disc of radius R. With its axis at offset c
// from the disc's centre and half-width w (both magnified onto the lamp), it blocks F((c+w)/R) − F((c−w)/R), where F(t)
// = ½ + (t √(1−t²) + asin t)/π is the part of a unit disc left of t. The ends are treated likewise along the axis.
// Wires add up; collinear segments meet without a seam.

override PLANE: u32 = 0u;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) value: vec2f,
}

fn lamp_channel(lamp: u32) -> vec2f {
    return select(vec2f(0.0, 1.0), vec2f(1.0, 0.0), lamp == 0u);
}

@vertex
fn mesh_vertex(@location(0) position: vec3f, @location(5) tag: u32, @builtin(instance_index) instance: u32) -> Varying {
    let n = u32(globals.shadow_samples);
    let lamp = globals.lamps[instance / n];
    let plane = globals.planes[PLANE];
    let disc = lamp.radius * vogel(f32(instance % n), f32(n));
    let frame = frame_of(lamp.axis);
    let light = lamp.position + frame[0] * disc.x + frame[1] * disc.y - plane.origin;
    let p = to_world(position, frame_of_tag(tag)) - plane.origin;
    // Height of the light and of the point over the plane; points behind the plane cast their shadow at their own foot.
    let d = dot(light, plane.normal);
    let h = max(dot(p, plane.normal), 0.0);
    let size = vec2f(plane.width, plane.height);
    let p2 = vec2f(dot(p, plane.u), dot(p, plane.v)) / size;
    let l2 = vec2f(dot(light, plane.u), dot(light, plane.v)) / size;
    let w = d - h;
    let at = p2 * d - l2 * h;
    var out: Varying;
    let depth = 1.0 - f32(instance + 1u) / f32(n * globals.lamp_count + 1u);
    out.clip = vec4f(at.x * 2.0 - w, w - at.y * 2.0, depth * w, w);
    out.value = lamp_channel(instance / n) * (opacity_of_tag(tag) / f32(n));
    return out;
}

@fragment
fn mesh_fragment(v: Varying) -> @location(0) vec4f {
    return vec4f(v.value, 0.0, 1.0);
}

struct Strip {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) a: vec3f,
    @location(2) @interpolate(flat) b: vec3f,
    @location(3) @interpolate(flat) radius: f32,
    @location(4) @interpolate(flat) lamp: u32,
}

@vertex
fn wire_vertex(@builtin(vertex_index) index: u32, @location(0) a: vec4f, @location(1) b: vec4f) -> Strip {
    let lamp = globals.lamps[index / 6u];
    let plane = globals.planes[PLANE];
    let d = dot(lamp.position - plane.origin, plane.normal);
    let ha = clamp(dot(a.xyz - plane.origin, plane.normal), 0.0, 0.95 * d);
    let hb = clamp(dot(b.xyz - plane.origin, plane.normal), 0.0, 0.95 * d);
    let foot_a = lamp.position + (a.xyz - lamp.position) * (d / (d - ha)) - plane.origin;
    let foot_b = lamp.position + (b.xyz - lamp.position) * (d / (d - hb)) - plane.origin;
    let a2 = vec2f(dot(foot_a, plane.u), dot(foot_a, plane.v));
    let b2 = vec2f(dot(foot_b, plane.u), dot(foot_b, plane.v));
    let h = max(ha, hb);
    let slant = length(foot_a + plane.origin - lamp.position) / d;
    let reach = (lamp.radius * h + a.w * d) / (d - h) * slant;
    let along = b2 - a2;
    let e = select(vec2f(1.0, 0.0), along / max(length(along), 1e-6), length(along) > 1e-6);
    let side = vec2f(-e.y, e.x);
    var corners = array<vec2f, 6>(vec2f(0.0, -1.0), vec2f(1.0, -1.0), vec2f(1.0, 1.0), vec2f(0.0, -1.0), vec2f(1.0, 1.0), vec2f(0.0, 1.0));
    let c = corners[index % 6u];
    let at = select(a2 - e * reach, b2 + e * reach, c.x > 0.5) + side * c.y * reach;
    var out: Strip;
    out.position = plane.origin + plane.u * at.x + plane.v * at.y;
    out.a = a.xyz;
    out.b = b.xyz;
    out.radius = a.w;
    out.lamp = index / 6u;
    let ndc = at / vec2f(plane.width, plane.height);
    out.clip = vec4f(ndc.x * 2.0 - 1.0, 1.0 - ndc.y * 2.0, 0.0, 1.0);
    return out;
}

// Part of the unit disc left of t.
fn disc_part(t: f32) -> f32 {
    let x = clamp(t, -1.0, 1.0);
    return 0.5 + (x * sqrt(max(1.0 - x * x, 0.0)) + asin(x)) / PI;
}

// Extent of a unit disc with this axis along a direction.
fn seen_part(direction: vec3f, axis: vec3f) -> f32 {
    let off = dot(direction, axis);
    return sqrt(max(1.0 - off * off, 0.05));
}

@fragment
fn wire_fragment(v: Strip) -> @location(0) vec4f {
    let lamp = globals.lamps[v.lamp];
    let to_lamp = lamp.position - v.position;
    let distance = length(to_lamp);
    let d = to_lamp / distance;
    let axis = v.b - v.a;
    let n = cross(d, axis);
    let n_length = length(n);
    if n_length < 1e-7 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let side = n / n_length;
    let along = cross(side, d);
    // Both ends as seen from the receiver, magnified onto the lamp's disc.
    let ta = dot(v.a - v.position, d) / distance;
    let tb = dot(v.b - v.position, d) / distance;
    let t = max(0.5 * (ta + tb), 1e-4);
    let ea = dot(v.a - v.position, along) / max(ta, 1e-4);
    let eb = dot(v.b - v.position, along) / max(tb, 1e-4);
    // Where the axis crosses the view ray, its distance along it determines the magnification.
    let s = clamp(-ea / select(eb - ea, 1e-6, abs(eb - ea) < 1e-6), 0.0, 1.0);
    let t_cross = max(mix(ta, tb, s), 1e-4);
    let c = dot(v.a - v.position, side) / t_cross;
    let w = v.radius / t_cross;
    // The disc is seen as an ellipse; a strip divides it like a disc of the ellipse's extent across the strip.
    let across_disc = lamp.radius * seen_part(side, lamp.axis);
    let along_disc = lamp.radius * seen_part(along, lamp.axis);
    let across = disc_part((c + w) / across_disc) - disc_part((c - w) / across_disc);
    let ends = abs(disc_part(eb / along_disc) - disc_part(ea / along_disc));
    return vec4f(lamp_channel(v.lamp) * across * ends, 0.0, 1.0);
}

// The shadow map of the light that shades the exhibit itself.
@vertex
fn map_vertex(@location(0) position: vec3f, @location(5) tag: u32) -> @builtin(position) vec4f {
    return globals.shadow_from_world * vec4f(to_world(position, frame_of_tag(tag)), 1.0);
}

// The depth as three bytes of a colour: not every driver lets a shader read a depth texture.
@fragment
fn map_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let whole = floor(position.z * 16777215.0);
    let high = floor(whole / 65536.0);
    let middle = floor(whole / 256.0) - 256.0 * high;
    return vec4f(high, middle, whole - 65536.0 * high - 256.0 * middle, 255.0) / 255.0;
}
