// The exhibit's meshes. One vertex buffer holds them all, each vertex with the index of the body that carries it.

struct Material {
    base_color: vec4f,
    emissive: vec3f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,   // 0 without a normal map
    occlusion: f32,
    cutoff: f32,         // 0 keeps every fragment
    spare: vec4f,
}

@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var material_sampler: sampler;
@group(2) @binding(2) var base_color_texture: texture_2d<f32>;
@group(2) @binding(3) var metallic_roughness_texture: texture_2d<f32>;
@group(2) @binding(4) var normal_texture: texture_2d<f32>;
@group(2) @binding(5) var occlusion_texture: texture_2d<f32>;
@group(2) @binding(6) var emissive_texture: texture_2d<f32>;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) color: vec4f,
    @location(5) body: u32,
}

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) color: vec4f,
}

@vertex
fn vertex(v: Vertex) -> Varying {
    var out: Varying;
    out.position = to_world(v.position, v.body);
    out.clip = globals.clip_from_world * vec4f(out.position, 1.0);
    out.normal = turn_to_world(v.normal, v.body);
    out.tangent = vec4f(turn_to_world(v.tangent.xyz, v.body), v.tangent.w);
    out.uv = v.uv;
    out.color = v.color;
    return out;
}

@fragment
fn fragment(v: Varying) -> @location(0) vec4f {
    let dp_x = dpdx(v.position);
    let dp_y = dpdy(v.position);
    let duv_x = dpdx(v.uv);
    let duv_y = dpdy(v.uv);
    let base = material.base_color * v.color * textureSample(base_color_texture, material_sampler, v.uv);
    let mr = textureSample(metallic_roughness_texture, material_sampler, v.uv);
    let bump = textureSample(normal_texture, material_sampler, v.uv).xyz * 2.0 - 1.0;
    let ao = textureSample(occlusion_texture, material_sampler, v.uv).r;
    let glow = textureSample(emissive_texture, material_sampler, v.uv).rgb;

    var s: Surface;
    s.position = v.position;
    s.view = normalize(globals.eye - v.position);
    var facing = cross(dp_x, dp_y);
    facing = facing * inverseSqrt(max(dot(facing, facing), 1e-30));
    facing = select(-facing, facing, dot(facing, s.view) > 0.0);
    var n = normalize(v.normal + facing * 1e-6);
    n = select(-n, n, dot(n, facing) >= 0.0);
    // How fast the normal turns from pixel to pixel, before the normal map adds its own grain.
    let dn_x = dpdx(n);
    let dn_y = dpdy(n);
    if material.normal_scale != 0.0 {
        var t = v.tangent.xyz;
        var b = cross(n, t) * v.tangent.w;
        if v.tangent.w == 0.0 {
            // No tangents in the file: the frame from the derivatives of position and texture (Schüler 2006).
            let px = cross(n, dp_x);
            let py = cross(dp_y, n);
            t = py * duv_x.x + px * duv_y.x;
            b = py * duv_x.y + px * duv_y.y;
            let scale = inverseSqrt(max(max(dot(t, t), dot(b, b)), 1e-30));
            t *= scale;
            b *= scale;
        }
        n = normalize(t * bump.x * material.normal_scale + b * bump.y * material.normal_scale + n * bump.z);
    }
    s.normal = n;
    s.facing = facing;
    s.albedo = base.rgb;
    s.metallic = clamp(material.metallic * mr.b, 0.0, 1.0);
    // Curved thin metal would sparkle: widen the lobe by the turn of the normal in the pixel (Tokuyoshi, Kaplanyan 2021).
    let turn = min(0.5 * (dot(dn_x, dn_x) + dot(dn_y, dn_y)), 0.18);
    let rough = clamp(material.roughness * mr.g, 0.045, 1.0);
    s.roughness = sqrt(sqrt(min(rough * rough * rough * rough + turn, 1.0)));
    s.occlusion = 1.0 + material.occlusion * (ao - 1.0);
    if base.a < material.cutoff {
        discard;
    }
    let radiance = shade(s, key_light_at(s)) + material.emissive * glow;
    return vec4f(display(radiance, v.clip.xy), base.a);
}
