// Analytic soft shadows of flat plates on wall and floor: the fraction of a lamp's disc that a plate covers.
//
// From a receiver the plate's rim is projected onto the lamp's plane, where the lamp is the unit disc. By Green's
// theorem the common area of a closed line and the disc is a sum over its edges. Twice the area of the triangle of an
// edge and the disc's centre within the disc is the cross product of the edge's part inside plus the angle of its parts
// outside. Both angles of an edge have one sign and are together below π, so one arctangent of a product of complex
// numbers gives them.
//
// Plates are blended as 1 − (1 − a)(1 − b); `plate_shadows.rs` explains the approximation.

// Points along rims, world; w is 1 at the first point of a line.
@group(1) @binding(0) var rims: texture_2d<f32>;

const RIM_ROW: u32 = 256u;

struct Shaded {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) rim: vec4u,   // first point, points, lamp
}

@vertex
fn plate_shadow_vertex(@builtin(vertex_index) index: u32, @location(0) bounds: vec4f, @location(1) rim: vec4u) -> Shaded {
    let plane = globals.planes[PLANE];
    var corners = array<vec2f, 6>(vec2f(0.0, 0.0), vec2f(1.0, 0.0), vec2f(1.0, 1.0), vec2f(0.0, 0.0), vec2f(1.0, 1.0), vec2f(0.0, 1.0));
    let at = mix(bounds.xy, bounds.zw, corners[index]);
    var out: Shaded;
    out.position = plane.origin + plane.u * (at.x * plane.width) + plane.v * (at.y * plane.height);
    out.clip = vec4f(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0);
    out.rim = rim;
    return out;
}

fn complex_product(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

// The second vector relative to the first: its argument is the angle between them.
fn turn_between(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(dot(a, b), a.x * b.y - a.y * b.x);
}

// Twice the signed area of the triangle of the unit disc's centre, a and b within the disc.
fn disc_wedge(a: vec2f, b: vec2f) -> f32 {
    let edge = b - a;
    let squared = max(dot(edge, edge), 1e-20);
    let turn = a.x * edge.y - a.y * edge.x;
    // Where the edge enters and leaves the disc; equal where it misses.
    let half = sqrt(max(squared - turn * turn, 0.0)) / squared;
    let nearest = -dot(a, edge) / squared;
    let enters = clamp(nearest - half, 0.0, 1.0);
    let leaves = clamp(nearest + half, 0.0, 1.0);
    let before = select(vec2f(1.0, 0.0), turn_between(a, a + enters * edge), enters > 0.0);
    let after = select(vec2f(1.0, 0.0), turn_between(a + leaves * edge, b), leaves < 1.0);
    let outside = complex_product(before, after);
    return (leaves - enters) * turn + atan2(outside.y, outside.x);
}

@fragment
fn plate_shadow_fragment(v: Shaded) -> @location(0) vec4f {
    let lamp = globals.lamps[v.rim.z];
    let frame = frame_of(lamp.axis);
    let to_lamp = lamp.position - v.position;
    // Both relative to the axis: points behind the lamp receive no light.
    let depth = min(dot(to_lamp, lamp.axis), -1e-6);
    let middle = vec2f(dot(to_lamp, frame[0]), dot(to_lamp, frame[1]));
    var before = vec2f(0.0);
    var sum = 0.0;
    for (var i = v.rim.x; i < v.rim.x + v.rim.y; i++) {
        let point = textureLoad(rims, vec2u(i % RIM_ROW, i / RIM_ROW), 0);
        let off = point.xyz - v.position;
        // Points behind the receiver are projected far outside.
        let part = max(dot(off, lamp.axis) / depth, 1e-3);
        let at = (vec2f(dot(off, frame[0]), dot(off, frame[1])) / part - middle) / lamp.radius;
        sum += select(disc_wedge(before, at), 0.0, point.w > 0.5);
        before = at;
    }
    let share = min(abs(sum) / (2.0 * PI), 1.0);
    return vec4f(lamp_channel(v.rim.z) * share, 0.0, 1.0);
}
