//! Chooses the level of H.264, which says how much a player has to be capable of.

/// The levels: number, macroblocks a second that a player can decode, and macroblocks that a picture may have (ITU-T
/// H.264, table A-1). Lower levels allow too little data a second for pictures with noise.
const LEVELS: [(u8, f64, u32); 8] = [
    (40, 245_760.0, 8_192),
    (42, 522_240.0, 8_704),
    (50, 589_824.0, 22_080),
    (51, 983_040.0, 36_864),
    (52, 2_073_600.0, 36_864),
    (60, 4_177_920.0, 139_264),
    (61, 8_355_840.0, 139_264),
    (62, 16_711_680.0, 139_264),
];

/// Returns the lowest level that allows pictures of this size at this rate. If the rate is too high for every level,
/// the result is the highest level. `None` if the pictures are too large for all levels.
pub(super) fn level([width, height]: [u32; 2], rate: f64) -> Option<u8> {
    let [across, down] = [width, height].map(|pixels| pixels.div_ceil(16));
    let fits = |most: u32| across * down <= most && across.max(down).pow(2) <= 8 * most;
    let mut large_enough = LEVELS.iter().filter(|(_, _, most)| fits(*most));
    let fast_enough = large_enough.clone().find(|(_, speed, _)| f64::from(across * down) * rate <= *speed);
    fast_enough.or(large_enough.next_back()).map(|(number, ..)| *number)
}
