//! Finds the line along which a field on a grid has a given value, by marching squares (Lorensen and Cline 1987, in the
//! plane).

/// A place in grid coordinates: `(i, j)` is the node in column i and row j.
pub(super) type Place = (f64, f64);

/// Returns the pieces of the line `field == level`, joined where they meet; `field` is evaluated at `columns` times
/// `rows` nodes.
///
/// A cell with a corner where the field is NaN has no line. If two pieces of line cross a cell, the mean of its corners
/// decides which crossing points are joined.
pub(super) fn contour(columns: usize, rows: usize, level: f64, field: impl Fn(usize, usize) -> f64) -> Vec<Vec<Place>> {
    let above = |i: usize, j: usize| field(i, j) > level;
    // The place where the line crosses the edge between two neighbouring nodes on different sides of it.
    let crossing = |a: (usize, usize), b: (usize, usize)| {
        let (at, to) = (field(a.0, a.1), field(b.0, b.1));
        let t = ((level - at) / (to - at)).clamp(0.0, 1.0);
        let between = |a: usize, b: usize| a as f64 + t * (b as f64 - a as f64);
        (between(a.0, b.0), between(a.1, b.1))
    };
    let mut pieces = Vec::new();
    for j in 0..rows.saturating_sub(1) {
        for i in 0..columns.saturating_sub(1) {
            // The corners in order around the cell; edge k goes from corner k to the next.
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            if corners.iter().any(|&(i, j)| field(i, j).is_nan()) {
                continue;
            }
            let is_above = corners.map(|(i, j)| above(i, j));
            let next = |k: usize| (k + 1) % 4;
            let crossed: Vec<usize> = (0..4).filter(|&k| is_above[k] != is_above[next(k)]).collect();
            // Both cells of an edge compute its crossing in the same direction, so that pieces meet to the last bit.
            let at = |k: usize| crossing(corners[k].min(corners[next(k)]), corners[k].max(corners[next(k)]));
            match crossed[..] {
                [a, b] => pieces.push([at(a), at(b)]),
                [a, b, c, d] => {
                    let middle = corners.iter().map(|&(i, j)| field(i, j)).sum::<f64>() / 4.0 > level;
                    // The two corners that differ from the middle are cut off.
                    let pairs = if is_above[0] == middle { [[a, b], [c, d]] } else { [[d, a], [b, c]] };
                    pieces.extend(pairs.map(|pair| pair.map(at)));
                }
                _ => {}
            }
        }
    }
    joined(pieces)
}

/// Joins line segments into lines that are as long as possible.
fn joined(mut pieces: Vec<[Place; 2]>) -> Vec<Vec<Place>> {
    let mut lines = Vec::new();
    while let Some([a, b]) = pieces.pop() {
        let mut line = std::collections::VecDeque::from([a, b]);
        loop {
            let (first, last) = (line[0], line[line.len() - 1]);
            let meets = |piece: &[Place; 2]| piece.iter().any(|end| *end == first || *end == last);
            let Some(found) = pieces.iter().position(meets) else { break };
            match pieces.swap_remove(found) {
                [a, b] if a == last => line.push_back(b),
                [a, b] if b == last => line.push_back(a),
                [a, b] if a == first => line.push_front(b),
                [a, _] => line.push_front(a),
            }
        }
        lines.push(line.into());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_one_closed_line_around_its_middle() {
        let field = |i: usize, j: usize| libm::hypot(i as f64 - 10.2, j as f64 - 9.7);
        let lines = contour(21, 20, 6.5, field);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        assert!(lines[0].iter().all(|(x, y)| (libm::hypot(x - 10.2, y - 9.7) - 6.5).abs() < 0.03));
        // The line goes round once: the angles sum up to a full turn.
        let turn = |pair: &[Place]| {
            let (a, b) = ((pair[0].0 - 10.2, pair[0].1 - 9.7), (pair[1].0 - 10.2, pair[1].1 - 9.7));
            libm::atan2(a.0 * b.1 - a.1 * b.0, a.0 * b.0 + a.1 * b.1)
        };
        assert!((lines[0].windows(2).map(turn).sum::<f64>().abs() - std::f64::consts::TAU).abs() < 1e-9);
    }

    #[test]
    fn a_line_through_the_grid_ends_at_its_rim_and_a_level_that_is_nowhere_has_none() {
        let lines = contour(8, 5, 2.25, |i, _| i as f64);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].len(), 5);
        assert!(lines[0].iter().all(|(x, _)| *x == 2.25));
        assert!(contour(8, 5, 9.0, |i, _| i as f64).is_empty());
        assert!(contour(1, 1, 0.0, |_, _| 0.0).is_empty());
    }

    #[test]
    fn in_a_saddle_the_mean_of_the_corners_says_who_belongs_together() {
        // High at two opposite corners; the middle is high, so that the low corners are cut off.
        let corners = |middle: f64| move |i: usize, j: usize| if i == j { 1.0 } else { middle };
        for (low, nearest) in [(-0.5, [(1.0, 0.0), (0.0, 1.0)]), (-1.5, [(0.0, 0.0), (1.0, 1.0)])] {
            let lines = contour(2, 2, 0.0, corners(low));
            assert_eq!(lines.len(), 2);
            for line in lines {
                let cuts = |corner: &(f64, f64)| {
                    line.iter().all(|end| (end.0 - corner.0).abs() < 1e-12 || (end.1 - corner.1).abs() < 1e-12)
                };
                assert_eq!(nearest.iter().filter(|corner| cuts(corner)).count(), 1, "{low} {line:?}");
            }
        }
    }
}
