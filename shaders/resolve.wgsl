// Multisample resolve: the mean of four samples. Software Vulkan is five times as fast this way as by its fixed
// function.

@group(0) @binding(0) var samples: texture_multisampled_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = vec2i(position.xy);
    return 0.25 * (textureLoad(samples, at, 0) + textureLoad(samples, at, 1)
        + textureLoad(samples, at, 2) + textureLoad(samples, at, 3));
}
