use super::{ALL, LEVELS, TEXELS, levels};

#[test]
fn textures_are_the_same_on_every_machine() {
    // FNV-1a over all texels: a change of one texel changes the look, and the look is pinned.
    let bytes = levels().iter().flatten().flatten();
    let hash = bytes
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3));
    assert_eq!(hash, 0xf2ac_2ffd_b982_83f4, "{hash:#x}");
}

#[test]
fn a_texture_hardly_changes_the_mean_colour_of_its_surface() {
    for (texture, levels) in ALL.iter().zip(levels()) {
        let last = levels.last().expect("it has levels");
        let shade = f32::from(last[3]) / 127.5;
        let tint = last[..3].iter().map(|part| f32::from(*part)).sum::<f32>() / 765.0;
        assert!((0.75..1.2).contains(&(shade + 2.0 * tint)), "{:?}: {shade}, {tint}", texture.surface);
    }
}

#[test]
fn a_texture_has_no_seam() {
    let size = TEXELS as usize;
    for (texture, levels) in ALL.iter().zip(levels()) {
        let shade = |x: usize, y: usize| i32::from(levels[0][4 * (size * y + x) + 3]);
        let apart = |from: usize, to: usize| {
            let columns = (0..size).map(|y| (shade(from, y) - shade(to, y)).abs()).sum::<i32>();
            let rows = (0..size).map(|x| (shade(x, from) - shade(x, to)).abs()).sum::<i32>();
            [columns, rows]
        };
        let seam = apart(size - 1, 0);
        // Joints of slabs and bricks lie at some of the borders between texels, and not at others.
        let usual = (0..size - 1).map(|at| apart(at, at + 1)).reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let usual = usual.expect("there are borders");
        assert!(seam[0] <= usual[0] && seam[1] <= usual[1], "{:?}: {seam:?} {usual:?}", texture.surface);
    }
}

#[test]
fn every_level_has_half_the_texels_of_the_one_before() {
    for levels in levels() {
        assert_eq!(levels.len(), LEVELS as usize);
        for (level, texels) in levels.iter().enumerate() {
            let size = TEXELS as usize >> level;
            assert_eq!(texels.len(), 4 * size * size);
        }
    }
}
