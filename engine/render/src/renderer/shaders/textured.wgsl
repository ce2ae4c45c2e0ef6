// What the look `textured` makes of surfaces: 2 shade colour + tint, and over it a second, larger texture.

@group(2) @binding(0) var textures: texture_2d_array<f32>;
@group(2) @binding(1) var texture_sampler: sampler;

// How often the second texture repeats for one repetition of the first, and as what turn it lies: lattices that meet nowhere.
const OVER: mat2x2f = mat2x2f(0.171, 0.064, -0.064, 0.171);

// The row of trees and houses around.
const HEDGE: f32 = 0.22;

fn laid(uv: vec2f, kind: u32) -> vec2f {
    return uv * LAYERS[kind].x;
}

fn grained(colour: vec3f, uv: vec2f, pixel: f32, kind: u32) -> vec3f {
    let layer = LAYERS[kind];
    let texel = textureSample(textures, texture_sampler, uv, u32(layer.y));
    let over = textureSample(textures, texture_sampler, OVER * uv, u32(layer.z));
    return (2.0 * texel.w * colour + texel.xyz) * (2.0 * over.w);
}

// How much of the sky is seen from where the sun is hidden: what hides the sun hides some of the sky.
fn sky_in_shadow(lit: f32) -> f32 {
    return 0.62 + 0.38 * lit;
}

// What a mirror shows that reflects rays from this height: ground, a dark row of trees and houses, and the sky.
fn surroundings(height: f32) -> vec3f {
    let sky = mix(view.air.xyz, view.zenith.xyz, sqrt(max(height, 0.0)));
    let hedge = HEDGE * view.ground_light.xyz;
    let below = mix(view.ground_light.xyz, hedge, smoothstep(-0.12, 0.0, height));
    return mix(below, sky, smoothstep(0.05, 0.16, height));
}
