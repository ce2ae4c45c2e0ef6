// What the look `flat` makes of surfaces.

const GROWN: u32 = 5u;

fn laid(uv: vec2f, kind: u32) -> vec2f {
    return uv;
}

fn grained(colour: vec3f, seen: Seen, pixel: f32) -> vec3f {
    return colour * grain(seen.uv, pixel, seen.kind & 15u);
}

// Whether a dull surface is a lamp that glows: no lamp does.
fn glows(kind: u32) -> bool {
    return false;
}

fn pictured(uv: vec2f, layer: u32) -> vec3f {
    return vec3f(1.0);
}

// How much of the sky is seen from where the sun is hidden.
fn sky_in_shadow(lit: f32) -> f32 {
    return 1.0;
}

// What a mirror shows that reflects rays from this height.
fn surroundings(height: f32) -> vec3f {
    let sky = mix(view.air.xyz, view.zenith.xyz, sqrt(max(height, 0.0)));
    return mix(view.ground_light.xyz, sky, smoothstep(-0.1, 0.1, height));
}

// Stones and leaves: cells of chance brightness, faded where they become smaller than pixels.
fn grain(uv: vec2f, pixel: f32, kind: u32) -> f32 {
    let grown = kind == GROWN;
    let stone = select(0.025, 0.07, grown);
    let stain = select(2.1, 1.3, grown);
    let stones = (hash(vec2i(floor(uv / stone))) - 0.5) * select(0.22, 0.5, grown) * finer(stone, pixel);
    let stains = (smooth_hash(uv / stain) - 0.5) * select(0.16, 0.5, grown) * finer(stain, pixel);
    return 1.0 + stones + stains;
}

fn finer(cell: f32, pixel: f32) -> f32 {
    return clamp(cell / pixel - 0.5, 0.0, 1.0);
}

fn smooth_hash(at: vec2f) -> f32 {
    let corner = vec2i(floor(at));
    let part = smoothstep(vec2f(0.0), vec2f(1.0), fract(at));
    let low = mix(hash(corner), hash(corner + vec2i(1, 0)), part.x);
    let high = mix(hash(corner + vec2i(0, 1)), hash(corner + vec2i(1, 1)), part.x);
    return mix(low, high, part.y);
}

fn hash(cell: vec2i) -> f32 {
    var mixed = (u32(cell.x) * 0x8da6b343u) ^ (u32(cell.y) * 0xd8163841u);
    mixed = (mixed ^ (mixed >> 15u)) * 0x2c1b3c6du;
    mixed ^= mixed >> 13u;
    return f32(mixed & 0xffffu) / 65535.0;
}
