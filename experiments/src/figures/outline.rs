//! Finds the border of a set of cells of a grid.

/// Returns the sides between cells inside and outside a set; sides in a row are one piece. `corner` places the corners of the cells.
/// The rim of the grid is no border.
pub fn outline(
    [columns, rows]: [usize; 2],
    is_inside: impl Fn(usize, usize) -> bool,
    corner: impl Fn(usize, usize) -> (f64, f64),
) -> Vec<Vec<(f64, f64)>> {
    let mut pieces = Vec::new();
    // Of sides that run across, and then of sides that run up.
    for (fixed_cells, along_cells, is_across) in [(rows, columns, true), (columns, rows, false)] {
        let at = |along: usize, fixed: usize| if is_across { (along, fixed) } else { (fixed, along) };
        for fixed in 1..fixed_cells {
            let is_side = |along: usize| {
                let [a, b] = [at(along, fixed - 1), at(along, fixed)];
                is_inside(a.0, a.1) != is_inside(b.0, b.1)
            };
            let mut along = 0;
            while along < along_cells {
                let end = (along..along_cells).find(|place| !is_side(*place)).unwrap_or(along_cells);
                if end > along {
                    pieces.push([along, end].map(|place| at(place, fixed)).map(|(i, j)| corner(i, j)).to_vec());
                }
                along = end + 1;
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_of_cells_has_four_sides_and_a_block_at_the_rim_has_three() {
        let inside = |i: usize, j: usize| (2..4).contains(&i) && (1..3).contains(&j);
        let corner = |i: usize, j: usize| (i as f64, j as f64);
        let sides = outline([6, 5], inside, corner);
        assert_eq!(sides.len(), 4);
        assert!(
            sides.contains(&vec![(2.0, 1.0), (4.0, 1.0)]) && sides.contains(&vec![(4.0, 1.0), (4.0, 3.0)]),
            "{sides:?}"
        );
        assert_eq!(outline([4, 5], inside, corner).len(), 3);
    }
}
