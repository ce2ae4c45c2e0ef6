//! Surfaces of plants: grass, leaves, bark.

use super::Texel;
use super::noise::{cloud, rise, scattered, share, smooth};

/// Grass: blades and tufts, some of them dry.
pub(super) fn grass(at: [f32; 2]) -> Texel {
    let blade = scattered([at[0] + 0.01 * smooth(at, [40; 2], 91), at[1]], [180, 110], 92);
    let blades = 0.45 + 0.95 * share(blade.hash) - 0.45 * rise(0.2, 0.8, blade.distance);
    let tufts = 0.60 + 0.80 * cloud(at, [12; 2], 5, 93);
    let dry = rise(0.50, 0.75, cloud(at, [4; 2], 5, 94)) * (0.4 + 0.6 * share(blade.hash.rotate_left(11)));
    Texel { shade: 1.25 * blades * tufts * (1.0 - 0.35 * dry), tint: [0.060 * dry, 0.046 * dry, 0.008 * dry] }
}

/// Leaves: bright ones before dark gaps.
pub(super) fn leaves(at: [f32; 2]) -> Texel {
    let bent = [at[0] + 0.05 * smooth(at, [18; 2], 104), at[1] + 0.05 * smooth(at, [18; 2], 105)];
    let leaf = scattered(bent, [58, 44], 101);
    let behind = scattered(bent, [20; 2], 102);
    let front = 1.0 - rise(0.25, 0.75, leaf.distance);
    let depth = 0.35 + 0.45 * share(behind.hash);
    let shade = depth + front * (0.20 + 0.85 * share(leaf.hash.rotate_left(5)));
    let boughs = 0.62 + 0.76 * cloud(at, [5; 2], 4, 103);
    let light = 0.016 * front * share(leaf.hash.rotate_left(17));
    Texel { shade: 1.12 * shade * boughs, tint: [light, 1.1 * light, 0.1 * light] }
}

/// Bark: ridges that run up the trunk.
pub(super) fn bark(at: [f32; 2]) -> Texel {
    let bent = [at[0] + 0.03 * smooth(at, [6, 12], 111), at[1]];
    let ridge = scattered(bent, [14, 9], 112);
    let ridges = 0.35 + 0.85 * rise(0.0, 0.22, ridge.border);
    let moss = rise(0.55, 0.75, cloud(at, [4; 2], 4, 113));
    let shade = ridges * (0.75 + 0.5 * cloud(at, [40, 20], 3, 114));
    Texel { shade: 1.05 * shade * (1.0 - 0.3 * moss), tint: [0.012 * moss, 0.022 * moss, 0.006 * moss] }
}
