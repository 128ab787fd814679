// Light on a surface: metallic–roughness BRDF under image, lamps, rectangle and punctual lights.
//
// GGX distribution and height-correlated Smith visibility (Heitz 2014), Schlick Fresnel, Lambert below it. The loss of
// single scattering is compensated by the factor 1 + F0 (1/E − 1) (Turquin 2019), with E from the table of the split
// sum (Karis 2013). Sphere and rectangle lights are represented by their point nearest the mirror ray (Karis).

@group(1) @binding(0) var environment: texture_cube<f32>;
@group(1) @binding(1) var dfg: texture_2d<f32>;
@group(1) @binding(2) var smooth_sampler: sampler;
@group(1) @binding(3) var blocker_map: texture_2d<f32>;      // the shadow map's depths: three bytes, the highest first
@group(1) @binding(4) var wall_shadow: texture_2d<f32>;
@group(1) @binding(5) var floor_shadow: texture_2d<f32>;
@group(1) @binding(6) var lightmap: texture_2d_array<f32>;
@group(1) @binding(7) var ambient: texture_2d_array<f32>;   // irradiance of static parts on each plane, and visibility

override AREA_LIGHT: bool = false;
// The environment is that of the gallery's box: reflections are corrected to where the mirror ray hits its walls.
override GALLERY: bool = false;
// Pipeline constant: a material has a clear coat or a sheen.
override LAYERS: bool = false;

struct Surface {
    position: vec3f,
    normal: vec3f,     // shading
    facing: vec3f,     // geometric, towards the camera
    view: vec3f,       // unit, to the camera
    albedo: vec3f,
    metallic: f32,
    roughness: f32,    // perceptual
    occlusion: f32,
    bounce: vec3f,     // irradiance from other surfaces
    fill: f32,         // visible fraction of the fill lamp
    f0: vec3f,         // of what is not metal
    f90: f32,
    transmission: f32, // transmitted fraction of the refracted light
    sheen: vec3f,
    sheen_roughness: f32,
    coat: f32,
    coat_roughness: f32,
    coat_normal: vec3f,
}

// A surface of plain paint or metal.
fn plain_surface() -> Surface {
    var s: Surface;
    s.occlusion = 1.0;
    s.fill = 1.0;
    s.f0 = vec3f(0.04);
    s.f90 = 1.0;
    return s;
}

struct Reflector {
    diffuse: vec3f,
    f0: vec3f,
    f90: f32,
    energy: vec3f,
    ab: vec2f,
    nv: f32,
    sheen_albedo: f32,
    specular_albedo: vec3f,
}

fn reflector(s: Surface) -> Reflector {
    var r: Reflector;
    r.nv = clamp(dot(s.normal, s.view), 1e-3, 1.0);
    r.f0 = mix(s.f0, s.albedo, s.metallic);
    r.f90 = mix(s.f90, 1.0, s.metallic);
    r.ab = textureSampleLevel(dfg, smooth_sampler, vec2f(r.nv, s.roughness), 0.0).xy;
    r.energy = 1.0 + r.f0 * (1.0 / max(r.ab.x + r.ab.y, 1e-3) - 1.0);
    r.specular_albedo = (r.f0 * r.ab.x + r.f90 * r.ab.y) * r.energy;
    // What the gloss reflects does not reach the colour below it.
    r.diffuse = s.albedo * ((1.0 - s.metallic) * (1.0 - s.transmission)) * max(1.0 - r.specular_albedo, vec3f(0.0));
    if LAYERS {
        r.sheen_albedo = textureSampleLevel(dfg, smooth_sampler, vec2f(r.nv, s.sheen_roughness), 0.0).z;
    }
    return r;
}

// Specular BRDF times the cosine to the light; `widened` is the GGX alpha spread by the size of the light.
fn specular(s: Surface, r: Reflector, l: vec3f, alpha: f32, widened: f32) -> vec3f {
    let nl = clamp(dot(s.normal, l), 0.0, 1.0);
    let h = normalize(s.view + l + s.normal * 1e-5);
    let nh = clamp(dot(s.normal, h), 0.0, 1.0);
    let a2 = alpha * alpha;
    let t = (nh * a2 - nh) * nh + 1.0;
    // The widened lobe keeps the energy of the narrow one (Karis 2013, eq. 14).
    let norm = alpha / widened;
    let w2 = widened * widened;
    let tw = (nh * w2 - nh) * nh + 1.0;
    let d = w2 / (PI * tw * tw) * norm * norm;
    let v = 0.5 / max(nl * sqrt(r.nv * r.nv * (1.0 - a2) + a2) + r.nv * sqrt(nl * nl * (1.0 - a2) + a2), 1e-5);
    let f = r.f0 + (r.f90 - r.f0) * pow(1.0 - clamp(dot(s.view, h), 0.0, 1.0), 5.0);
    return d * v * nl * f * r.energy;
}

fn sh_irradiance(n: vec3f) -> vec3f {
    let c = globals.irradiance;
    let e = c[0].rgb + c[1].rgb * n.y + c[2].rgb * n.z + c[3].rgb * n.x
        + c[4].rgb * (n.x * n.y) + c[5].rgb * (n.y * n.z) + c[6].rgb * (3.0 * n.z * n.z - 1.0)
        + c[7].rgb * (n.x * n.z) + c[8].rgb * (n.x * n.x - n.y * n.y);
    return max(e, vec3f(0.0));
}

// Where the ray from p hits the gallery's box, as a direction from the cube's origin (parallax correction, Lagarde
// 2012).
fn box_projected(p: vec3f, d: vec3f) -> vec3f {
    if !GALLERY {
        return d;
    }
    let axes = mat3x3f(globals.gallery_x, vec3f(0.0, 1.0, 0.0), globals.gallery_z);
    let start = (p - globals.gallery_center) * axes;
    let local_direction = d * axes;
    let safe = select(local_direction, vec3f(1e-6), abs(local_direction) < vec3f(1e-6));
    let t = (sign(safe) * globals.gallery_half - start) / safe;
    return p + d * max(min(t.x, min(t.y, t.z)), 0.0) - globals.environment_origin;
}

fn image_light(s: Surface, r: Reflector) -> vec3f {
    let mirror = reflect(-s.view, s.normal);
    let lod = s.roughness * globals.env_lods;
    let seen = box_projected(s.position, mirror);
    let prefiltered = textureSampleLevel(environment, smooth_sampler, seen, lod).rgb;
    let around = globals.env_intensity * s.occlusion * sh_irradiance(s.normal);
    let diffuse = r.diffuse * (around + s.bounce) / PI;
    // Specular occlusion from the diffuse one (Lagarde and de Rousiers 2014).
    let so = clamp(pow(r.nv + s.occlusion, exp2(-16.0 * s.roughness - 1.0)) - 1.0 + s.occlusion, 0.0, 1.0);
    // Where a part blocks the mirror ray, its mean radiance is seen instead.
    let nearby = s.bounce / (PI * max(1.0 - s.occlusion, 0.05));
    let reflected = globals.env_intensity * prefiltered * so + nearby * (1.0 - so);
    return diffuse + reflected * r.specular_albedo;
}

// Texture coordinates, depth, and distance along the light's axis of a world point in the shadow map.
fn in_map(p: vec3f) -> vec4f {
    let q = globals.shadow_from_world * vec4f(p, 1.0);
    return vec4f(q.xyz / q.w * vec3f(0.5, -0.5, 1.0) + vec3f(0.5, 0.5, 0.0), q.w);
}

// Gradient of the depth of the plane through p over the shadow map, per unit of texture coordinates. A projection maps
// planes to planes, so two more points of the plane determine it exactly.
fn depth_slope(p: vec3f, normal: vec3f, at: vec4f, reach: f32) -> vec2f {
    let frame = frame_of(normal);
    let x = in_map(p + frame[0] * reach).xyz - at.xyz;
    let y = in_map(p + frame[1] * reach).xyz - at.xyz;
    let area = x.x * y.y - x.y * y.x;
    // Edge-on from the light the gradient is undefined.
    return select(vec2f(x.z * y.y - y.z * x.y, y.z * x.x - x.z * y.x) / area, vec2f(0.0), abs(area) < 1e-12);
}

// Depth in the encoding of `map_fragment`.
fn blocker_depth(at: vec2f, size: vec2f) -> f32 {
    let bytes = textureLoad(blocker_map, clamp(vec2i(at * size), vec2i(0), vec2i(size) - 1), 0).xyz;
    return dot(bytes, vec3f(16711680.0, 65280.0, 255.0)) / 16777215.0;
}

// Is a blocker beside the receiver, at distance b, between the receiver and the light? With a margin of two texels.
fn in_cone(off: vec2f, at: vec4f, b: f32, spread: f32, size: vec2f) -> bool {
    let inside = all(abs(at.xy + off - 0.5) < vec2f(0.5));
    return inside && length(off) <= 1.25 * spread * max(at.w - b, 0.0) / b + 2.0 / size.x;
}

// Percentage-closer soft shadows: the fraction of the shadow-casting light that reaches p. Blocker search, then a
// filter as wide as the penumbra (Fernando 2005), both with fixed taps so that nothing shimmers. Each tap is compared
// with the depth of the receiver's own plane there, so that a wide filter does not shade a wall by itself. A blocker
// must be in the cone from the receiver to the light.
fn shadow(p: vec3f, facing: vec3f, towards: vec3f) -> f32 {
    let distance = length(towards);
    let slope = sqrt(clamp(1.0 - pow(dot(facing, towards) / distance, 2.0), 0.0, 1.0));
    // An offset of one and a half texels along the normal keeps a lit surface from shading itself.
    let texel = globals.shadow_texel * distance;
    let side = select(-1.0, 1.0, dot(facing, towards) > 0.0);
    let above = p + facing * side * texel * (1.0 + 2.0 * slope);
    let near = globals.shadow_near;
    let far = globals.shadow_far;
    let at = in_map(above);
    if at.w <= 0.0 {
        return 1.0;
    }
    let size = vec2f(textureDimensions(blocker_map));
    // Size of the light in texture coordinates as seen from a receiver at depth w, per unit of (w − b) / b.
    let spread = globals.shadow_radius / (globals.shadow_texel * size.x * at.w);
    // No blocker is nearer to the light than the near plane.
    let search = max(spread * (at.w - near) / near, 1.5 / size.x);
    if any(at.xy < vec2f(-search)) || any(at.xy > vec2f(1.0 + search)) {
        return 1.0;
    }
    let tilt = depth_slope(above, facing, at, 8.0 * texel);
    var blockers = 0.0;
    var depth = 0.0;
    // The number of taps is a uniform so that drivers do not unroll the loops, which made shaders slow to build.
    let taps = globals.shadow_taps;
    for (var i = 0.0; i < taps; i += 1.0) {
        let off = search * vogel(i, taps);
        let z = blocker_depth(at.xy + off, size);
        let b = near * far / (z * (far - near) + near);
        if z > at.z + dot(tilt, off) + 1e-6 && in_cone(off, at, b, spread, size) {
            blockers += 1.0;
            depth += b;
        }
    }
    if blockers == 0.0 {
        return 1.0;
    }
    let blocker = depth / blockers;
    // Narrower than a few texels, the edge would show the map's steps.
    let narrowest = 2.5 / size.x;
    let width = clamp(spread * (at.w - blocker) / blocker, narrowest, max(search, narrowest));
    // In the penumbra each tap is one step of shade; few pixels are in one.
    let steps = 3.0 * taps;
    var lit = 0.0;
    for (var i = 0.0; i < steps; i += 1.0) {
        let off = width * vogel(i, steps);
        let z = blocker_depth(at.xy + off, size);
        let b = near * far / (z * (far - near) + near);
        lit += select(1.0, 0.0, z > at.z + dot(tilt, off) + 1e-6 && in_cone(off, at, b, spread, size));
    }
    return lit / steps;
}

// Unit irradiance vector of a rectangle: Lambert's sum over its edges (Lambert 1760; Arvo 1995).
fn rectangle_vector(p: vec3f) -> vec3f {
    let x = globals.area_x;
    let y = globals.area_y;
    let c = globals.area_center - p;
    var corners = array<vec3f, 4>(normalize(c - x - y), normalize(c + x - y), normalize(c + x + y), normalize(c - x + y));
    var sum = vec3f(0.0);
    for (var i = 0; i < 4; i++) {
        let a = corners[i];
        let b = corners[(i + 1) & 3];
        let n = cross(a, b);
        let s = length(n);
        sum += n / max(s, 1e-6) * atan2(s, dot(a, b));
    }
    return 0.5 * sum;
}

fn area_light(s: Surface, r: Reflector, alpha: f32) -> vec3f {
    let facing = normalize(cross(globals.area_x, globals.area_y));
    if dot(s.position - globals.area_center, facing) <= 0.0 {
        return vec3f(0.0);
    }
    let f = rectangle_vector(s.position);
    let size = max(length(f), 1e-6);
    let towards = -f / size * sign(dot(f, s.position - globals.area_center));
    // A rectangle partly below the horizon is replaced by a sphere of the same form factor (Hill and Heitz 2016).
    let c = dot(s.normal, towards);
    let diffuse = size * max((c + size / PI) / (1.0 + size / PI), 0.0);
    // Point of the rectangle nearest the mirror ray.
    let mirror = reflect(-s.view, s.normal);
    let to_center = globals.area_center - s.position;
    let along = dot(to_center, facing) / min(dot(mirror, facing), -1e-3);
    let hit = mirror * max(along, 0.0) - to_center;
    let lx = dot(globals.area_x, globals.area_x);
    let ly = dot(globals.area_y, globals.area_y);
    let near = to_center + globals.area_x * clamp(dot(hit, globals.area_x) / lx, -1.0, 1.0)
        + globals.area_y * clamp(dot(hit, globals.area_y) / ly, -1.0, 1.0);
    let widened = clamp(alpha + globals.shadow_radius / (2.0 * length(near)), 0.0, 1.0);
    let l = normalize(near);
    let gloss = specular(s, r, l, alpha, widened) * size;
    return globals.area_radiance * (r.diffuse / PI * diffuse + gloss);
}

fn punctual_light(s: Surface, r: Reflector, alpha: f32, i: u32) -> vec3f {
    let light = globals.punctual[i];
    var l = -light.axis;
    var strength = 1.0;
    if light.kind > 0.5 {
        let away = light.position - s.position;
        let d2 = max(dot(away, away), 1e-8);
        l = away * inverseSqrt(d2);
        strength = 1.0 / d2;
        if light.range > 0.0 {
            // Window function of KHR_lights_punctual: the light ends at its range.
            strength *= clamp(1.0 - d2 * d2 / pow(light.range, 4.0), 0.0, 1.0);
        }
        if light.kind > 1.5 {
            let a = clamp((dot(-l, light.axis) - light.cone.y) / max(light.cone.x - light.cone.y, 1e-4), 0.0, 1.0);
            strength *= a * a;
        }
    }
    let nl = max(dot(s.normal, l), 0.0);
    return light.color * strength * (r.diffuse / PI * nl + specular(s, r, l, alpha, alpha));
}

fn lamp_light(s: Surface, r: Reflector, alpha: f32, i: u32) -> vec3f {
    let lamp = globals.lamps[i];
    let towards = lamp.position - s.position;
    // Nearest point of the luminous sphere to the mirror ray.
    let mirror = reflect(-s.view, s.normal);
    let off = dot(towards, mirror) * mirror - towards;
    let near = towards + off * clamp(lamp.radius * inverseSqrt(max(dot(off, off), 1e-8)), 0.0, 1.0);
    let distance = length(towards);
    let widened = clamp(alpha + lamp.radius / (2.0 * distance), 0.0, 1.0);
    let nl = max(dot(s.normal, towards) / distance, 0.0);
    return lamp_beam(i, s.position) * (r.diffuse / PI * nl + specular(s, r, normalize(near), alpha, widened));
}

// Visible fraction of the shadow-casting light at a surface.
fn key_light_at(s: Surface) -> f32 {
    let light = select(globals.lamps[0].position, globals.area_center, AREA_LIGHT);
    return shadow(s.position, s.facing, light - s.position);
}

// Charlie's distribution with Neubelt's visibility, times the cosine to the light (Estevez and Kulla 2017).
fn sheen(s: Surface, r: Reflector, l: vec3f) -> vec3f {
    let nl = clamp(dot(s.normal, l), 0.0, 1.0);
    let h = normalize(s.view + l + s.normal * 1e-5);
    let nh = clamp(dot(s.normal, h), 0.0, 1.0);
    let inverse = 1.0 / max(s.sheen_roughness * s.sheen_roughness, 0.005);
    let d = (2.0 + inverse) * pow(max(1.0 - nh * nh, 1e-4), 0.5 * inverse) / (2.0 * PI);
    return s.sheen * (d * nl / (4.0 * max(nl + r.nv - nl * r.nv, 1e-3)));
}

// Radiance towards the camera; `lit` is the visible fraction of the shadow-casting light.
fn shade(s: Surface, lit: f32) -> vec3f {
    if !LAYERS {
        return shade_layer(s, lit);
    }
    let r = reflector(s);
    // Sheen and coat reduce the light that reaches the layers below.
    var sum = shade_layer(s, lit) * (1.0 - max(s.sheen.r, max(s.sheen.g, s.sheen.b)) * r.sheen_albedo);
    sum += globals.env_intensity * s.sheen * (r.sheen_albedo * s.occlusion / PI) * sh_irradiance(s.normal);
    for (var i = 0u; i < globals.lamp_count; i++) {
        let l = normalize(globals.lamps[i].position - s.position);
        sum += lamp_beam(i, s.position) * sheen(s, r, l) * select(s.fill, lit, i == 0u);
    }
    var coat = s;
    coat.f0 = vec3f(0.04);
    coat.f90 = 1.0;
    coat.albedo = vec3f(0.0);
    coat.metallic = 0.0;
    coat.roughness = s.coat_roughness;
    coat.normal = s.coat_normal;
    let above = reflector(coat);
    return sum * (1.0 - s.coat * (0.04 * above.ab.x + above.ab.y)) + s.coat * shade_layer(coat, lit);
}

// One layer of glass.
fn shade_layer(s: Surface, lit: f32) -> vec3f {
    let r = reflector(s);
    let alpha = max(s.roughness * s.roughness, 0.002);
    var sum = image_light(s, r);
    for (var i = 0u; i < globals.lamp_count; i++) {
        sum += lamp_light(s, r, alpha, i) * select(s.fill, lit, i == 0u);
    }
    if AREA_LIGHT {
        sum += area_light(s, r, alpha) * lit;
    }
    for (var i = 0u; i < globals.punctual_count; i++) {
        sum += punctual_light(s, r, alpha, i);
    }
    return sum;
}
