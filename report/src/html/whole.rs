//! Numbers of runs as whole numbers, each as the difference from the number before, so that they take few bytes.

/// Numbers in the order x, y, x, y, each the difference from the same number one step before.
pub(super) type Points = Vec<i32>;

/// Returns points in whole centimetres, each as the difference from the point before.
pub(super) fn centimetres(points: impl Iterator<Item = [f64; 2]>) -> Points {
    differences(points.map(|point| point.map(|number| (100.0 * number).round() as i32)))
}

/// Returns the numbers of tuples, each as the difference from the same number of the tuple before.
pub(super) fn differences<const N: usize>(tuples: impl IntoIterator<Item = [i32; N]>) -> Vec<i32> {
    let mut before = [0; N];
    let mut numbers = Vec::new();
    for tuple in tuples {
        numbers.extend(tuple.iter().zip(before).map(|(number, before)| number.wrapping_sub(before)));
        before = tuple;
    }
    numbers
}
