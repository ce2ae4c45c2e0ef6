//! Noise that repeats: every function has the period 1 in both directions, so that a texture has no seams.
//!
//! Only integers and the exact operations of floating-point numbers are used, so that a texture is the same on every
//! machine.

/// Returns a pseudorandom number for a point of a lattice.
pub(super) fn hash(x: u32, y: u32, seed: u32) -> u32 {
    let mut mixed =
        x.wrapping_mul(0x8da6_b343) ^ y.wrapping_mul(0xd816_3841) ^ seed.wrapping_mul(0xcb1a_b31f) ^ 0x9e37_79b9;
    mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x2c1b_3c6d);
    mixed = (mixed ^ (mixed >> 12)).wrapping_mul(0x297a_2d39);
    mixed ^ (mixed >> 15)
}

/// Converts a pseudorandom number to a share from 0 to 1.
pub(super) fn share(hash: u32) -> f32 {
    (hash >> 8) as f32 / 16_777_216.0
}

/// Returns 0 below `low`, 1 above `high`, and a smooth rise between them.
pub(super) fn rise(low: f32, high: f32, at: f32) -> f32 {
    let part = ((at - low) / (high - low)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

/// Returns the greatest whole number that is not greater than a number within 32 bits. `f32::floor` is the call of a
/// function on processors that lack an instruction for it.
fn floor(at: f32) -> f32 {
    let cut = at as i32 as f32;
    if cut > at { cut - 1.0 } else { cut }
}

/// Returns the number of a cell in a row of `cells` cells that repeats.
fn wrapped(cell: i32, cells: u32) -> u32 {
    // Nearly all cells are in the first repetition, and a division is slow.
    if (0..cells as i32).contains(&cell) { cell as u32 } else { cell.rem_euclid(cells as i32) as u32 }
}

/// Returns smooth noise from 0 to 1 on a lattice of `cells` cells in each direction.
pub(super) fn smooth([u, v]: [f32; 2], cells: [u32; 2], seed: u32) -> f32 {
    let (x, y) = (u * cells[0] as f32, v * cells[1] as f32);
    let (left, low) = (floor(x), floor(y));
    let (along, up) = (rise(0.0, 1.0, x - left), rise(0.0, 1.0, y - low));
    let pair = |at: f32, cells: u32| [0, 1].map(|more| wrapped(at as i32 + more, cells));
    let (columns, rows) = (pair(left, cells[0]), pair(low, cells[1]));
    let row = |upper: usize| {
        let [from, to] = columns.map(|column| share(hash(column, rows[upper], seed)));
        from + (to - from) * along
    };
    row(0) + (row(1) - row(0)) * up
}

/// Returns the weighted mean of several octaves of smooth noise, each twice as fine and half as strong as the one
/// before; 0.5 on average.
pub(super) fn cloud(at: [f32; 2], cells: [u32; 2], octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut all) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += weight * smooth(at, cells.map(|cells| cells << octave), seed.wrapping_add(octave));
        all += weight;
        weight *= 0.5;
    }
    sum / all
}

/// The nearest of the points that are scattered over a plane, one in each cell of a lattice.
pub(super) struct Nearest {
    /// The distance to the nearest point, in cells.
    pub distance: f32,
    /// The distance from the border between the nearest and the second nearest point, in cells (a little more far from
    /// the middle between the two).
    pub border: f32,
    /// A pseudorandom number of the nearest point.
    pub hash: u32,
}

/// Returns the nearest scattered point (Worley, A cellular texture basis function, SIGGRAPH 1996).
pub(super) fn scattered([u, v]: [f32; 2], cells: [u32; 2], seed: u32) -> Nearest {
    let (x, y) = (u * cells[0] as f32, v * cells[1] as f32);
    let (left, low) = (floor(x), floor(y));
    let (mut first, mut second, mut of) = (f32::INFINITY, f32::INFINITY, 0);
    for (right, up) in (-1..=1).flat_map(|right| (-1..=1).map(move |up| (right, up))) {
        let (column, row) = (wrapped(left as i32 + right, cells[0]), wrapped(low as i32 + up, cells[1]));
        let hash = hash(column, row, seed);
        let off = [left + right as f32 + share(hash) - x, low + up as f32 + share(hash.rotate_left(13)) - y];
        let distance = (off[0] * off[0] + off[1] * off[1]).sqrt();
        if distance < first {
            (second, first, of) = (first, distance, hash);
        } else if distance < second {
            second = distance;
        }
    }
    Nearest { distance: first, border: 0.5 * (second - first), hash: of }
}
