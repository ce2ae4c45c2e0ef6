// What is seen where there is nothing: from the air's colour at the horizon to the sky's at the zenith.

// The fog lies this many metres high.
const FOG_HEIGHT: f32 = 120.0;

@vertex
fn sky_corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

struct Sky {
    @location(0) rgb: vec4f,
    @location(4) linear: vec4f,
}

@fragment
fn sky(@builtin(position) at: vec4f) -> Sky {
    let direction = normalize(ray(at.xy));
    let height = max(dot(direction, view.up.xyz), 0.0);
    var light = mix(view.air.xyz, view.zenith.xyz, sqrt(height));
    if FOG {
        // The way out of the fog is longer the flatter one looks, and endless at the horizon.
        let through = exp(-view.up.w * FOG_HEIGHT / max(height, 1e-6));
        light = mix(view.air.xyz, light, through);
    }
    return Sky(vec4f(light, 1.0), vec4f(light, 1.0));
}
