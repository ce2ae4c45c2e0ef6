//! Chooses the marks that are drawn if a map has more marks than a picture can show.
//!
//! The marks of a million tests would make a very large file, and most marks would hide others. The choice is
//! pseudo-random. A choice of every hundredth test would be biased: in a Halton or Sobol sequence, these tests lie in
//! one part of the space.

/// The number of marks of a kind up to which all marks are drawn.
pub(super) const MOST_MARKS: usize = 10_000;

/// Returns `true` if the mark with this index is drawn, among `count` marks of its kind. Of many marks, about
/// [`MOST_MARKS`] are drawn.
pub(super) fn is_drawn(index: usize, count: usize) -> bool {
    count <= MOST_MARKS || scattered(index as u64) % (count as u64) < MOST_MARKS as u64
}

/// Mixes the bits of a number (SplitMix64; Steele, Lea and Flood, Fast splittable pseudorandom number generators, 2014).
fn scattered(number: u64) -> u64 {
    let mixed = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_few_marks_are_drawn_and_about_ten_thousand_of_many() {
        assert!((0..MOST_MARKS).all(|index| is_drawn(index, MOST_MARKS)));
        for count in [20_000, 1 << 20] {
            let drawn = (0..count).filter(|index| is_drawn(*index, count)).count();
            assert!((9_600..=10_400).contains(&drawn), "{drawn} of {count}");
        }
    }

    #[test]
    fn the_drawn_marks_of_a_sequence_in_base_two_fill_both_halves() {
        let count = 1 << 20;
        let drawn = || (0..count).filter(|index| is_drawn(*index, count));
        // The first digit of the sequence of van der Corput is the last bit of the index.
        let (all, odd) = (drawn().count(), drawn().filter(|index| index % 2 == 1).count());
        assert!((0.47..=0.53).contains(&(odd as f64 / all as f64)), "{odd} of {all}");
    }
}
