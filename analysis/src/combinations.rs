//! All combinations of values, for small numbers of values.

/// Iterates over all combinations of positions below the given counts. The last position changes fastest.
///
/// # Panics
/// The number of combinations exceeds `usize`.
pub(crate) fn combinations(counts: &[usize]) -> impl Iterator<Item = Vec<usize>> {
    let all: usize = counts.iter().product();
    (0..all).map(move |mut index| {
        let mut places = vec![0; counts.len()];
        for (place, count) in places.iter_mut().zip(counts).rev() {
            (*place, index) = (index % count, index / count);
        }
        places
    })
}
