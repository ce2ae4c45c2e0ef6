// What the look `textured` makes of surfaces: 2 shade colour + tint, and over it a second, larger texture.

@group(2) @binding(0) var textures: texture_2d_array<f32>;
@group(2) @binding(1) var texture_sampler: sampler;

// How often the second texture repeats for one repetition of the first, and as what turn it lies: lattices that meet nowhere.
const OVER: mat2x2f = mat2x2f(0.171, 0.064, -0.064, 0.171);

const ASPHALT: u32 = 4u;
const GLOWS: u32 = 16u;
// The layers of the second textures: of asphalt, and of everything else.
const MENDED: u32 = 0u;
const STAINED: u32 = 1u;

// The row of trees and houses around.
const HEDGE: f32 = 0.22;

fn laid(uv: vec2f, kind: u32) -> vec2f {
    return uv * REPEATS[kind];
}

fn grained(colour: vec3f, seen: Seen, pixel: f32) -> vec3f {
    // A wall or a leaf is seen less flatly than the ground, so that one texel is enough, and is too small for a second texture.
    if UPRIGHT {
        let texel = textureSample(textures, texture_sampler, seen.uv, (seen.kind >> 4u) & 15u);
        return 2.0 * texel.w * colour + texel.xyz;
    }
    let texel = long_texel(seen.uv, (seen.kind >> 4u) & 15u);
    let over = textureSample(textures, texture_sampler, OVER * seen.uv, select(STAINED, MENDED, (seen.kind & 15u) == ASPHALT));
    return (2.0 * texel.w * colour + texel.xyz) * (2.0 * over.w);
}

// The mean of a texture over a pixel. A pixel of the ground is much longer than wide, so the means of two pieces one behind
// the other are less blurred than the mean of a square, and cost less than the anisotropic filter of a software adapter.
fn long_texel(uv: vec2f, layer: u32) -> vec4f {
    let across = dpdx(uv);
    let down = dpdy(uv);
    let is_across = dot(across, across) > dot(down, down);
    let long = 0.5 * select(down, across, is_across);
    let short = select(across, down, is_across);
    var sum = textureSampleGrad(textures, texture_sampler, uv - 0.5 * long, layer, long, short);
    sum += textureSampleGrad(textures, texture_sampler, uv + 0.5 * long, layer, long, short);
    return 0.5 * sum;
}

// Whether a dull surface is a lamp that glows.
fn glows(kind: u32) -> bool {
    return (kind & 255u) == GLOWS;
}

// The picture of a user's model.
fn pictured(uv: vec2f, layer: u32) -> vec3f {
    return long_texel(uv, layer).xyz;
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
