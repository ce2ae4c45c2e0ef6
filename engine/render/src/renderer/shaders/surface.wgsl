// What a pixel of a thing looks like, how far away it is, and what it is.

// Square metres: two lamps side by side, and the dipped beam, leave the road just before the car darker than one point would.
const HEAD_LAMPS_APART: f32 = 60.0;

override RGB: bool = true;
override SHADOWS: bool = false;
// Whether lamps shine.
override LAMPS: bool = false;
// Which kinds of surfaces are drawn.
override GLOSSY: bool = false;
override GRAINED: bool = false;
override UPRIGHT: bool = false;
override PICTURED: bool = false;

@group(1) @binding(0) var sun_depth: texture_depth_2d;
@group(1) @binding(1) var sun_sampler: sampler_comparison;

// How much brighter than white paper in the sun a lamp is that glows.
const GLOW: f32 = 1.6;

const PAINT: u32 = 1u;
const CLOTH: u32 = 2u;
const GLASS: u32 = 3u;
const WHITE_LAMP: u32 = 6u;
const RED_LAMP: u32 = 7u;
const BRICK: u32 = 12u;
const PLASTER: u32 = 13u;

struct Seen {
    @builtin(position) at: vec4f,
    @location(0) normal: vec3f,
    @location(1) colour: vec3f,
    @location(2) uv: vec2f,
    // The plane of the triangle: those p with dot(plane.xyz, p) = plane.w.
    @location(3) @interpolate(flat) plane: vec4f,
    // Surface in 4 bits, layer of its texture or picture in 4 bits, class, and id in the upper half. A lamp that glows is a
    // plain surface with layer 1.
    @location(4) @interpolate(flat) kind: u32,
}

@vertex
fn corner(corner: Corner) -> Seen {
    var seen: Seen;
    seen.at = clip(before_camera(corner));
    seen.normal = turned(corner, corner.normal.xyz);
    seen.uv = laid(corner.uv, corner.kind.x);
    seen.colour = corner.colour.xyz;
    let kind = corner.kind.x;
    if kind == PAINT || kind == CLOTH || kind == BRICK || kind == PLASTER {
        seen.colour = corner.paint;
    }
    // In the mesh's coordinates, where a level face has a level normal and nothing cancels.
    seen.plane = vec4f(turned(corner, corner.face), dot(corner.face, corner.position - corner.eye));
    seen.kind = corner.kind.x | (corner.kind.z << 4u) | (corner.kind.y << 8u) | (corner.id << 16u);
    return seen;
}

struct Pixel {
    @location(0) rgb: vec4f,
    @location(1) depth: f32,
    @location(2) semantic: u32,
    @location(3) instance: u32,
    @location(4) linear: vec4f,
}

@fragment
fn surface(seen: Seen) -> Pixel {
    let through = ray(seen.at.xy);
    // A rasteriser moves corners to a grid of 1/256 of a pixel, which near the horizon is metres. The ray through the
    // pixel meets the triangle's plane where it really is. Where they differ much, a thing is seen edge-on, and the
    // middle of the pixel beside it.
    let coarse = 1.0 / seen.at.w;
    var forward = seen.plane.w / dot(seen.plane.xyz, through);
    if !(abs(forward - coarse) <= 0.1 * coarse) {
        forward = coarse;
    }
    let distance = forward * length(through);
    var pixel: Pixel;
    pixel.depth = distance;
    pixel.semantic = (seen.kind >> 8u) & 255u;
    pixel.instance = seen.kind >> 16u;
    if RGB {
        let light = vec4f(fogged(appearance(seen, through * forward, distance), distance), 1.0);
        pixel.rgb = light;
        pixel.linear = light;
    }
    return pixel;
}

// Koschmieder: what is there fades with the distance, and the air's own light takes its place.
fn fogged(light: vec3f, distance: f32) -> vec3f {
    if !FOG {
        return light;
    }
    return mix(view.air.xyz, light, exp(-view.up.w * distance));
}

fn appearance(seen: Seen, place: vec3f, distance: f32) -> vec3f {
    let kind = seen.kind & 15u;
    let towards_eye = place / -distance;
    let normal = normalize(seen.normal);
    if LAMPS && !GLOSSY && !GRAINED && kind == WHITE_LAMP {
        return mix(seen.colour, vec3f(1.0, 0.93, 0.78), view.sun.w);
    }
    if LAMPS && !GLOSSY && !GRAINED && kind == RED_LAMP {
        return mix(seen.colour, vec3f(0.9, 0.02, 0.01), view.sun.w);
    }
    if !GLOSSY && !GRAINED && !PICTURED && glows(seen.kind) {
        return GLOW * seen.colour;
    }
    var colour = seen.colour;
    if GRAINED {
        let slant = max(abs(dot(normal, towards_eye)), 0.02);
        colour = grained(colour, seen, distance * view.image.z / slant);
    }
    if PICTURED {
        colour *= pictured(seen.uv, (seen.kind >> 4u) & 15u);
    }
    let facing = dot(normal, view.sun.xyz);
    var sun = view.sun_light.xyz * max(facing, 0.0);
    var open = 1.0;
    if SHADOWS {
        let lit = sunlit(place + normal * 0.04);
        sun *= lit;
        open = sky_in_shadow(lit);
    }
    let sky = open * mix(view.ground_light.xyz, view.sky_light.xyz, 0.5 + 0.5 * dot(normal, view.up.xyz));
    var light = colour * (sun + sky);
    if LAMPS {
        light += colour * lamps(place, normal);
    }
    if GLOSSY || (PICTURED && (kind == PAINT || kind == GLASS)) {
        light += gloss(normal, towards_eye, sun, kind);
    }
    return light;
}

// The sky in a glossy surface, more of it the flatter one looks (Schlick), and the sun.
fn gloss(normal: vec3f, towards_eye: vec3f, sun: vec3f, kind: u32) -> vec3f {
    let across = 1.0 - max(dot(normal, towards_eye), 0.0);
    let fresnel = 0.04 + 0.96 * across * across * across * across * across;
    let mirrored = 2.0 * dot(normal, towards_eye) * normal - towards_eye;
    let height = dot(mirrored, view.up.xyz);
    let seen = surroundings(height);
    let middle = max(dot(normal, normalize(towards_eye + view.sun.xyz)), 0.0);
    let tight = middle * middle * middle * middle;
    let tighter = tight * tight * tight * tight;
    let strength = select(0.6, 1.0, kind == GLASS);
    return strength * (fresnel * seen + 0.5 * sun * tighter * tighter);
}

fn sunlit(place: vec3f) -> f32 {
    let position = vec4f(place, 1.0);
    let on_map = vec2f(dot(view.shadow[0], position), dot(view.shadow[1], position));
    let depth = dot(view.shadow[2], position);
    let lit = textureSampleCompareLevel(sun_depth, sun_sampler, on_map, depth);
    // Shadows fade out where the map ends.
    let off = 2.0 * abs(on_map - 0.5);
    return mix(lit, 1.0, smoothstep(0.85, 1.0, max(off.x, off.y)));
}

fn lamps(place: vec3f, normal: vec3f) -> vec3f {
    let way = view.head_lamps.xyz - place;
    let squared = dot(way, way);
    let towards = way * inverseSqrt(squared);
    let cone = smoothstep(0.72, 0.985, -dot(towards, view.head_beam.xyz));
    // A rough surface sends some light back however flat it falls in.
    let caught = 0.12 + 0.88 * max(dot(normal, towards), 0.0);
    var light = vec3f(1.0, 0.95, 0.85) * (view.head_lamps.w * cone * caught / (squared + HEAD_LAMPS_APART));
    for (var index = 0; index < 8; index++) {
        let lamp = view.street_lamps[index];
        let way = lamp.xyz - place;
        let squared = dot(way, way);
        let caught = max(dot(normal, way * inverseSqrt(squared)), 0.0);
        light += vec3f(1.0, 0.86, 0.62) * (lamp.w * caught / (squared + 1.0));
    }
    return light;
}
