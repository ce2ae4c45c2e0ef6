//! Surfaces of roads: asphalt with cracks and patches, slabs, concrete, worn paint.

use super::Texel;
use super::noise::{cloud, hash, rise, scattered, share, smooth};

/// Asphalt: stones of all shades, a few of them light, and fine cracks in some places.
pub(super) fn asphalt(at: [f32; 2]) -> Texel {
    let stone = scattered(at, [224; 2], 1);
    let light = if stone.hash.is_multiple_of(19) { 0.55 } else { 0.0 };
    let stones = 0.62 + 0.55 * share(stone.hash.rotate_left(7)) + light - 0.35 * rise(0.3, 0.8, stone.distance);
    let wear = 0.82 + 0.36 * cloud(at, [6; 2], 4, 2);
    let bent = [at[0] + 0.02 * smooth(at, [24; 2], 3), at[1] + 0.02 * smooth(at, [24; 2], 4)];
    let open = rise(0.53, 0.65, cloud(at, [3; 2], 3, 5));
    let crack = (1.0 - rise(0.003, 0.018, scattered(bent, [7; 2], 6).border)) * open;
    Texel::shade(1.06 * stones * wear * (1.0 - 0.62 * crack))
}

/// The large features of asphalt: mended patches with dark seams, sealed cracks, stains of oil and water.
pub(super) fn mended(at: [f32; 2]) -> Texel {
    let mut shade = 0.80 + 0.40 * cloud(at, [5; 2], 5, 11);
    // One patch at most in each cell of a lattice.
    const CELLS: u32 = 5;
    let (x, y) = (at[0] * CELLS as f32, at[1] * CELLS as f32);
    let cell = hash(x as u32 % CELLS, y as u32 % CELLS, 12);
    if cell.is_multiple_of(3) {
        let of = |turn: u32| share(cell.rotate_left(turn));
        let half = [0.07 + 0.22 * of(5), 0.06 + 0.16 * of(10)];
        let half = if cell.is_multiple_of(2) { half } else { [half[1], half[0]] };
        let middle = [0.32 + 0.36 * of(15), 0.32 + 0.36 * of(20)];
        let inside = (half[0] - (x.fract() - middle[0]).abs()).min(half[1] - (y.fract() - middle[1]).abs());
        let tone = if cell.is_multiple_of(4) { 1.28 } else { 0.66 + 0.14 * of(25) };
        shade *= 1.0 + (tone - 1.0) * rise(-0.004, 0.004, inside);
        shade *= 1.0 - 0.45 * (1.0 - rise(0.006, 0.016, inside.abs()));
    }
    let bent = [at[0] + 0.035 * smooth(at, [14; 2], 13), at[1] + 0.035 * smooth(at, [14; 2], 14)];
    let sealed =
        (1.0 - rise(0.004, 0.014, scattered(bent, [5; 2], 15).border)) * rise(0.52, 0.60, smooth(at, [4; 2], 16));
    let oil = scattered(at, [11; 2], 17);
    let drop = if oil.hash.is_multiple_of(5) { 1.0 - rise(0.05, 0.28, oil.distance) } else { 0.0 };
    Texel::shade(shade * (1.0 - 0.5 * sealed) * (1.0 - 0.35 * drop))
}

/// The large features of everything else: it is lighter here and darker there.
pub(super) fn stained(at: [f32; 2]) -> Texel {
    Texel::shade(0.72 + 0.56 * cloud(at, [4; 2], 6, 21))
}

/// Paving slabs in a bond, with dark joints.
pub(super) fn slabs(at: [f32; 2]) -> Texel {
    const ROWS: u32 = 8;
    let y = at[1] * ROWS as f32;
    let row = y as u32 % ROWS;
    let x = at[0] * ROWS as f32 + 0.5 * (row % 2) as f32;
    let slab = share(hash(x as u32 % ROWS, row, 31));
    let edge = |at: f32| at.fract().min(1.0 - at.fract());
    let joint = 1.0 - rise(0.008, 0.03, edge(x).min(edge(y)));
    let grain = 0.86 + 0.28 * share(scattered(at, [200; 2], 32).hash);
    let gum = scattered(at, [13; 2], 33);
    let spot = if gum.hash.is_multiple_of(4) { 1.0 - rise(0.05, 0.10, gum.distance) } else { 0.0 };
    let worn = 0.88 + 0.24 * cloud(at, [9; 2], 4, 34);
    Texel::shade((0.84 + 0.32 * slab) * grain * worn * (1.0 - 0.62 * joint) * (1.0 - 0.3 * spot))
}

/// Concrete: clouds, pores, and traces of water.
pub(super) fn concrete(at: [f32; 2]) -> Texel {
    let pore = scattered(at, [60; 2], 41);
    let hole = if pore.hash.is_multiple_of(3) { 1.0 - rise(0.08, 0.22, pore.distance) } else { 0.0 };
    let grain = 0.94 + 0.12 * share(hash((at[0] * 512.0) as u32, (at[1] * 512.0) as u32, 42));
    Texel::shade((0.80 + 0.40 * cloud(at, [5; 2], 6, 43)) * grain * (1.0 - 0.35 * hole))
}

/// Paint on a road, of which traffic has worn off parts; the asphalt below is dark.
pub(super) fn marking(at: [f32; 2]) -> Texel {
    let worn = rise(0.60, 0.70, 0.6 * cloud(at, [10; 2], 4, 51) + 0.4 * share(scattered(at, [150; 2], 52).hash));
    let dirt = 0.80 + 0.34 * cloud(at, [7; 2], 5, 53);
    Texel { shade: dirt * (1.0 - worn), tint: [0.085 * worn; 3] }
}
