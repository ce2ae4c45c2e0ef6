//! Lower bounds on the number of rows of every covering array, from theorems about parameters without constraints.
//!
//! A covering array of strength t contains a covering array of any subset of its parameters. If levels are joined, it
//! becomes a covering array over fewer levels. A bound for parameters with equally many levels therefore gives a
//! bound for any parameters.

/// Returns a lower bound on the number of rows of every covering array of the given strength for parameters with the
/// given numbers of levels. The order of the parameters does not matter. A number beyond `u128` saturates.
///
/// The bound is the largest of these:
/// - the product of the `strength` largest numbers of levels: each of these combinations needs a row of its own;
/// - for a parameter of `v` levels, `v` times the bound of strength `strength - 1` for the other parameters: the rows
///   with one of the `v` levels are a covering array of the other parameters;
/// - for each `v`, the known bounds for the parameters with at least `v` levels, joined to `v`, at strength 2
///   (Kleitman, Spencer, Families of k-independent sets, Discrete Mathematics 6, 1973, and Katona, Two applications
///   of Sperner type theorems, Periodica Mathematica Hungarica 3, 1973, which is exact for `v = 2`; Poljak, Tuza, On
///   the maximum number of qualitatively independent partitions, Journal of Combinatorial Theory A 51, 1989; Stevens,
///   Moura, Mendelsohn, Lower bounds for transversal covers, Designs, Codes and Cryptography 15, 1998; Tarry, Le
///   problème des 36 officiers, 1900) and at strength 3 (Bush, Orthogonal arrays of index unity, Annals of
///   Mathematical Statistics 23, 1952).
///
/// # Panics
/// `strength` is not in 1 to the number of parameters.
pub fn fewest_rows(levels: &[usize], strength: usize) -> u128 {
    assert!((1..=levels.len()).contains(&strength), "the strength is {strength}, expected 1 to {}", levels.len());
    let mut levels: Vec<usize> = levels.to_vec();
    levels.sort_unstable_by(|a, b| b.cmp(a));
    sorted(&levels, strength)
}

/// As [`fewest_rows`], but `levels` must be in descending order.
fn sorted(levels: &[usize], strength: usize) -> u128 {
    let product = levels[..strength].iter().fold(1u128, |product, &v| product.saturating_mul(v as u128));
    if strength == 1 {
        return product;
    }
    let derived = (levels[0] as u128).saturating_mul(sorted(&levels[1..], strength - 1));
    // If the next parameter has fewer levels, `end` parameters have at least as many levels as the last of them.
    let ends = (strength..=levels.len()).filter(|&end| levels.get(end) != Some(&levels[end - 1]));
    let alike = ends.map(|parameters| uniform(parameters, levels[parameters - 1], strength));
    alike.fold(product.max(derived), u128::max)
}

/// The bound for `parameters` parameters of `v` levels each.
fn uniform(parameters: usize, v: usize, strength: usize) -> u128 {
    match strength {
        _ if v < 2 => 1,
        2 => of_pairs(parameters, v),
        _ => {
            let derived = (v as u128).saturating_mul(uniform(parameters - 1, v, strength - 1));
            // With v^3 rows each triple of levels stands in exactly one row. An odd v allows at most v + 1 such
            // columns (Bush).
            let odd = strength == 3 && v >= 3 && v % 2 == 1 && parameters - 2 >= v;
            derived.max(if odd { cube(v).saturating_add(1) } else { 0 })
        }
    }
}

/// The bound of `uniform` at strength 2.
fn of_pairs(parameters: usize, v: usize) -> u128 {
    let square = (v as u128).saturating_mul(v as u128);
    if v == 2 {
        // Each column is a subset of the rows. Two columns divide the rows into four parts, of which none may be
        // empty: only this many subsets allow that.
        return (4..).find(|&rows| choose(rows - 1, rows.div_ceil(2)) >= parameters as u128).expect("it grows");
    }
    // In each column, the two smallest classes of rows have at most 2N/v rows together. They are disjoint, and each
    // of them meets those of any other column. The same holds with the two classes exchanged. By the theorem of
    // Bollobás on pairs of sets, twice as many pairs as there are columns need (2N/v choose N/v).
    let classes = (2u128..).find(|&m| choose(m, m / 2) >= 2 * parameters as u128).expect("it grows");
    let partitions = (classes.saturating_mul(v as u128)).div_ceil(2);
    let beyond_orthogonal = match parameters {
        // More than v + 1 columns cannot show each pair exactly once. One more row than v^2 is not enough either: in
        // each column one level then stands in v + 1 rows and the others in v rows, and some row has at most two
        // entries of the former kind. Each entry of this row occurs in v - 1 or v other rows. These rows are all
        // different, except for one that the two entries of the former kind may share: together they are more than
        // the v^2 other rows.
        _ if parameters - 2 >= v => 2,
        // No two Latin squares of order 6 are orthogonal.
        _ if v == 6 && parameters >= 4 => 1,
        _ => 0,
    };
    square.saturating_add(beyond_orthogonal).max(partitions)
}

fn cube(v: usize) -> u128 {
    (v as u128).saturating_pow(3)
}

/// The binomial coefficient; a value beyond `u128` on the way saturates.
fn choose(n: u128, k: u128) -> u128 {
    (0..k).try_fold(1u128, |product, i| Some(product.checked_mul(n - i)? / (i + 1))).unwrap_or(u128::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Covering array numbers that are known exactly: parameters, levels of each, strength, rows (Colbourn's tables).
    const KNOWN: [(usize, usize, usize, u128); 21] = [
        (3, 2, 2, 4),
        (4, 2, 2, 5),
        (10, 2, 2, 6),
        (15, 2, 2, 7),
        (35, 2, 2, 8),
        (56, 2, 2, 9),
        (126, 2, 2, 10),
        (4, 3, 2, 9),
        (5, 3, 2, 11),
        (7, 3, 2, 12),
        (9, 3, 2, 13),
        (5, 4, 2, 16),
        (6, 4, 2, 19),
        (6, 5, 2, 25),
        (4, 6, 2, 37),
        (4, 2, 3, 8),
        (5, 2, 3, 10),
        (11, 2, 3, 12),
        (4, 3, 3, 27),
        (6, 4, 3, 64),
        (6, 2, 4, 21),
    ];

    #[test]
    fn no_bound_exceeds_what_is_known_and_those_of_binary_pairs_are_exact() {
        for (parameters, v, strength, rows) in KNOWN {
            let bound = fewest_rows(&vec![v; parameters], strength);
            assert!(bound <= rows, "{parameters} of {v} at strength {strength}: {bound} > {rows}");
            let exact = (v, strength) == (2, 2) || (parameters, strength) == (4, 2) && v == 6;
            assert!(!exact || bound == rows, "{parameters} of {v} at strength {strength}: {bound} < {rows}");
        }
    }

    #[test]
    fn each_bound_says_more_than_the_product_somewhere() {
        assert_eq!(fewest_rows(&[2; 11], 2), 7);
        assert_eq!(fewest_rows(&[2; 11], 3), 12, "twice what ten ask for");
        assert_eq!(fewest_rows(&[3; 5], 2), 11);
        assert_eq!(fewest_rows(&[3; 6], 3), 33);
        assert_eq!(fewest_rows(&[3; 5], 3), 28, "no orthogonal array has five columns");
        assert_eq!(fewest_rows(&[6; 4], 2), 37);
        assert_eq!(fewest_rows(&[3; 1000], 2), 21, "(14 choose 7) is the first of at least 2,000");
        assert_eq!(fewest_rows(&[5, 4, 2, 2, 2], 2), 20);
        assert_eq!(fewest_rows(&[2, 4, 2, 2, 2], 3), 20, "four times five");
        assert_eq!(fewest_rows(&[2, 3, 1, 2], 3), 12);
        assert_eq!(fewest_rows(&[usize::MAX; 9], 9), u128::MAX);
        assert_eq!(fewest_rows(&[usize::MAX; 2], 2), (usize::MAX as u128).pow(2));
    }
}
