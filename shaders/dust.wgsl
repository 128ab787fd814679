// Dust particles: round soft sprites, blended additively.

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) at: vec2f,
    @location(1) @interpolate(flat) brightness: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @location(0) particle: vec4f) -> Varying {
    var corners = array<vec2f, 6>(vec2f(-1.0, -1.0), vec2f(1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, 1.0));
    let c = corners[index];
    let distance = length(particle.xyz - globals.eye);
    // At least a pixel and a half: a sub-pixel particle would flicker. Larger area is compensated by lower brightness.
    let radius = max(globals.dust_radius, 1.5 * globals.pixel_angle * distance);
    let share = globals.dust_radius / radius;
    var out: Varying;
    out.at = c;
    out.brightness = particle.w * share * share;
    out.clip = globals.clip_from_world * vec4f(particle.xyz + (globals.right * c.x + globals.up * c.y) * radius, 1.0);
    return out;
}

@fragment
fn fragment(v: Varying) -> @location(0) vec4f {
    let fall = max(1.0 - dot(v.at, v.at), 0.0);
    return vec4f(vec3f(1.0, 0.97, 0.9) * (v.brightness * fall * fall), 0.0);
}
