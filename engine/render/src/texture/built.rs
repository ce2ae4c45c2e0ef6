//! Surfaces of buildings: brick, plaster, roof tiles.

use super::Texel;
use super::noise::{cloud, hash, rise, scattered, share, smooth};

/// Bricks in a running bond. The mortar has its own colour.
pub(super) fn brick(at: [f32; 2]) -> Texel {
    const BRICKS: [u32; 2] = [16, 48];
    const MORTAR: [f32; 3] = [0.34, 0.32, 0.29];
    let y = at[1] * BRICKS[1] as f32;
    let row = y as u32 % BRICKS[1];
    let x = at[0] * BRICKS[0] as f32 + 0.5 * (row % 2) as f32;
    let brick = hash(x as u32 % BRICKS[0], row, 61);
    // Joints are equally wide in both directions; a brick is three times as long as high.
    let edge = |at: f32| at.fract().min(1.0 - at.fract());
    let joint = 1.0 - rise(0.05, 0.11, (3.0 * edge(x)).min(edge(y)));
    let burnt = if brick.is_multiple_of(9) { 0.62 } else { 0.82 + 0.40 * share(brick) };
    let grain = 0.82 + 0.36 * cloud(at, [64; 2], 3, 62);
    let dirt = 0.85 + 0.30 * cloud(at, [4; 2], 4, 63);
    let warm = 0.05 * (share(brick.rotate_left(9)) - 0.3).max(0.0);
    let own = (1.0 - joint) * dirt;
    Texel {
        shade: burnt * grain * own,
        tint: std::array::from_fn(|i| MORTAR[i] * grain * dirt * joint + [warm, 0.4 * warm, 0.0][i] * own),
    }
}

/// Plaster: a rough grain, traces of rain that run down, a crack here and there.
pub(super) fn plaster(at: [f32; 2]) -> Texel {
    let grain = 0.93 + 0.14 * share(scattered(at, [190; 2], 71).hash);
    let streaks = 1.0 - 0.22 * rise(0.52, 0.80, smooth(at, [40, 3], 72)) * smooth(at, [5; 2], 73);
    let bent = [at[0] + 0.03 * smooth(at, [16; 2], 74), at[1] + 0.03 * smooth(at, [16; 2], 75)];
    let crack =
        (1.0 - rise(0.002, 0.010, scattered(bent, [3; 2], 76).border)) * rise(0.55, 0.65, smooth(at, [3; 2], 77));
    Texel::shade(1.02 * (0.88 + 0.24 * cloud(at, [4; 2], 5, 78)) * grain * streaks * (1.0 - 0.4 * crack))
}

/// Roof tiles: rounded columns in rows that shade each other.
pub(super) fn tiles(at: [f32; 2]) -> Texel {
    const TILES: [u32; 2] = [18, 12];
    let (x, y) = (at[0] * TILES[0] as f32, at[1] * TILES[1] as f32);
    let tile = hash(x as u32 % TILES[0], y as u32 % TILES[1], 81);
    let across = 2.0 * x.fract() - 1.0;
    let round = 1.12 - 0.62 * across * across * across * across;
    let under = rise(0.0, 0.22, y.fract()) * 0.55 + 0.45;
    let moss = rise(0.60, 0.75, cloud(at, [5; 2], 5, 82));
    let shade = round * under * (0.78 + 0.50 * share(tile)) * (0.88 + 0.24 * cloud(at, [24; 2], 3, 83));
    Texel { shade: 1.12 * shade * (1.0 - 0.35 * moss), tint: [0.020 * moss, 0.030 * moss, 0.010 * moss] }
}
