// Which pixels each thing would have if it were alone: a bit for each thing in the words of a pixel.

@group(1) @binding(0) var<storage, read_write> masks: array<atomic<u32>>;

struct Alone {
    @builtin(position) at: vec4f,
    @location(0) @interpolate(flat) bit: u32,
}

@vertex
fn alone_corner(corner: Corner) -> Alone {
    return Alone(clip(before_camera(corner)), corner.id >> 16u);
}

@fragment
fn alone(thing: Alone) {
    let pixel = u32(thing.at.y) * view.counts.z + u32(thing.at.x) - view.counts.w;
    let word = view.counts.x + pixel * view.counts.y + (thing.bit >> 5u);
    atomicOr(&masks[word], 1u << (thing.bit & 31u));
}
