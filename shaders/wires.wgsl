// Wires as analytic capsules: a quad that faces the camera, and for each pixel the exact distance of the view ray from
// the axis.
//
// Below a pixel the radius is clamped to half a pixel and the opacity lowered in proportion (phone-wire antialiasing,
// Persson 2012), so a wire of any width is an unbroken line of the right mean darkness. Segments of one wire are cut by
// the bisecting planes of their joints, so that no pixel of a bend is blended twice.

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) a: vec4f,        // end, radius
    @location(2) @interpolate(flat) b: vec4f,        // end, metallic
    @location(3) @interpolate(flat) color: vec4f,    // linear, roughness
    @location(4) @interpolate(flat) cut_a: vec4f,    // plane through a, 1 where the wire ends there
    @location(5) @interpolate(flat) cut_b: vec4f,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) a: vec4f,
    @location(1) b: vec4f,
    @location(2) color: vec4f,
    @location(3) cut_a: vec4f,
    @location(4) cut_b: vec4f,
) -> Varying {
    var corners = array<vec2f, 6>(vec2f(0.0, -1.0), vec2f(1.0, -1.0), vec2f(1.0, 1.0), vec2f(0.0, -1.0), vec2f(1.0, 1.0), vec2f(0.0, 1.0));
    let c = corners[index];
    let end = select(a.xyz, b.xyz, c.x > 0.5);
    let axis = b.xyz - a.xyz;
    let unit = axis * inverseSqrt(max(dot(axis, axis), 1e-20));
    let ray = end - globals.eye;
    let sideways = cross(unit, ray);
    let side = sideways * inverseSqrt(max(dot(sideways, sideways), 1e-20));
    // The quad covers the wire and one more pixel on each side, and overlaps a joint as far as a bend may need, in
    // picture space, so that a wire that points at the camera has space too.
    let reach = a.w + 1.5 * globals.pixel_angle * length(ray);
    let beyond = cross(ray, side);
    let ahead = beyond * (sign(dot(beyond, unit)) * inverseSqrt(max(dot(beyond, beyond), 1e-20)));
    let p = end + side * c.y * reach + ahead * (2.0 * c.x - 1.0) * reach;
    var out: Varying;
    out.position = p;
    out.a = a;
    out.b = b;
    out.color = color;
    out.cut_a = cut_a;
    out.cut_b = cut_b;
    out.clip = globals.clip_from_world * vec4f(p, 1.0);
    // The depth is that of the capsule's front, not of its axis: a rod that is half inside a plate is fully visible.
    let front = globals.clip_from_world * vec4f(p - normalize(p - globals.eye) * a.w, 1.0);
    out.clip.z = front.z / front.w * out.clip.w;
    return out;
}

@fragment
fn fragment(v: Varying) -> @location(0) vec4f {
    let axis = v.b.xyz - v.a.xyz;
    let unit = axis * inverseSqrt(max(dot(axis, axis), 1e-20));
    let ray = normalize(v.position - globals.eye);
    // Common perpendicular of view ray and axis, and its position along the axis.
    let across = cross(unit, ray);
    let sine2 = max(dot(across, across), 1e-8);
    let side = across * inverseSqrt(sine2);
    let from_a = globals.eye - v.a.xyz;
    let offset = dot(from_a, side);
    let cosine = dot(unit, ray);
    let on_axis = v.a.xyz + unit * ((dot(from_a, unit) - cosine * dot(from_a, ray)) / sine2);
    // Offset from one pixel to the next, m; exact outside the picture's centre too.
    let pixel = max(length(vec2f(dpdx(offset), dpdy(offset))), 1e-9);
    let r = v.a.w / pixel;
    let wide = max(r, 0.5);
    var alpha = clamp(wide + 0.5 - abs(offset) / pixel, 0.0, 1.0) * r / wide;
    // Where the view ray enters the capsule, before its point nearest to the axis. A joint is cut there, so that both
    // segments decide by the same point; an end is visible where any of the path through the capsule is within it.
    let back = sqrt(max(v.a.w * v.a.w - offset * offset, 0.0) / sine2);
    let nearest = (cosine * dot(from_a, unit) - dot(from_a, ray)) / sine2;
    let enters = globals.eye + ray * (nearest - back);
    let along = dot(on_axis - v.a.xyz, unit);
    let through = abs(cosine) * back;
    let inside_a = select(dot(enters - v.a.xyz, v.cut_a.xyz), along + through, v.cut_a.w > 0.5) / pixel;
    let inside_b = select(dot(v.b.xyz - enters, v.cut_b.xyz), dot(axis, unit) - along + through, v.cut_b.w > 0.5) / pixel;
    alpha *= select(step(0.0, inside_a), clamp(inside_a + 0.5, 0.0, 1.0), v.cut_a.w > 0.5);
    alpha *= select(step(1e-6, inside_b), clamp(inside_b + 0.5, 0.0, 1.0), v.cut_b.w > 0.5);
    if alpha <= 0.0 {
        discard;
    }
    let towards = normalize(cross(across, unit));
    let front = select(-towards, towards, dot(towards, ray) < 0.0);
    var s = plain_surface();
    s.position = on_axis + front * v.a.w;
    s.view = -ray;
    s.facing = front;
    s.albedo = v.color.rgb;
    s.metallic = v.b.w;
    s.roughness = max(v.color.w, 0.15);
    // Across the capsule: one normal where the pixel is small relative to the wire, the mean of three where it is not.
    let lit = key_light_at(s);
    let normals = select(3.0, 1.0, r > 1.5);
    let first = select(-0.66, clamp(offset / v.a.w, -0.98, 0.98), r > 1.5);
    var radiance = vec3f(0.0);
    for (var i = 0.0; i < normals; i += 1.0) {
        let m = first + 0.66 * i;
        s.normal = side * m + front * sqrt(1.0 - m * m);
        radiance += shade(s, lit) / normals;
    }
    return vec4f(tone_mapped(radiance, v.clip.xy), alpha);
}
