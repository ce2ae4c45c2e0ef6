//! How many rows every covering array has at least, by what is proved of parameters without constraints.
//!
//! An array of strength t over parameters with given numbers of levels contains one over fewer of the parameters, and by
//! joining levels one over fewer levels. So whatever is known of equally many levels says something of any parameters.

/// No covering array of strength `strength` over parameters with so many levels, in any order, has fewer rows. What
/// exceeds `u128` saturates.
///
/// It is the largest of
/// - the product of the `strength` largest numbers of levels: that many combinations stand in as many rows;
/// - `v` times what strength `strength - 1` asks of the other parameters, for a parameter of `v` levels: the rows with one
///   of its levels are an array of the others;
/// - for each `v`, over the parameters with at least `v` levels, joined to `v`: what is known of strength 2
///   (Kleitman, Spencer, Families of k-independent sets, Discrete Mathematics 6, 1973, and Katona, Two applications of
///   Sperner type theorems, Periodica Mathematica Hungarica 3, 1973, which is exact for `v = 2`; Poljak, Tuza, On the
///   maximum number of qualitatively independent partitions, Journal of Combinatorial Theory A 51, 1989; Stevens, Moura,
///   Mendelsohn, Lower bounds for transversal covers, Designs, Codes and Cryptography 15, 1998; Tarry, Le problème des 36
///   officiers, 1900) and 3 (Bush, Orthogonal arrays of index unity, Annals of Mathematical Statistics 23, 1952).
///
/// # Panics
/// `strength` is not in 1 to the number of parameters.
pub fn fewest_rows(levels: &[usize], strength: usize) -> u128 {
    assert!((1..=levels.len()).contains(&strength), "the strength is {strength}, expected 1 to {}", levels.len());
    let mut levels: Vec<usize> = levels.to_vec();
    levels.sort_unstable_by(|a, b| b.cmp(a));
    sorted(&levels, strength)
}

/// As [`fewest_rows`], of the most levels first.
fn sorted(levels: &[usize], strength: usize) -> u128 {
    let product = levels[..strength].iter().fold(1u128, |product, &v| product.saturating_mul(v as u128));
    if strength == 1 {
        return product;
    }
    let derived = (levels[0] as u128).saturating_mul(sorted(&levels[1..], strength - 1));
    // Where the next has fewer levels, as many as this parameter has can be had up to here.
    let ends = (strength..=levels.len()).filter(|&end| levels.get(end) != Some(&levels[end - 1]));
    let alike = ends.map(|parameters| uniform(parameters, levels[parameters - 1], strength));
    alike.fold(product.max(derived), u128::max)
}

/// What so many parameters of `v` levels each ask for.
fn uniform(parameters: usize, v: usize, strength: usize) -> u128 {
    match strength {
        _ if v < 2 => 1,
        2 => of_pairs(parameters, v),
        _ => {
            let derived = (v as u128).saturating_mul(uniform(parameters - 1, v, strength - 1));
            // With v^3 rows each triple stands in one; odd v allows v + 1 such columns (Bush).
            let odd = strength == 3 && v >= 3 && v % 2 == 1 && parameters - 2 >= v;
            derived.max(if odd { cube(v).saturating_add(1) } else { 0 })
        }
    }
}

/// The same at strength 2.
fn of_pairs(parameters: usize, v: usize) -> u128 {
    let square = (v as u128).saturating_mul(v as u128);
    if v == 2 {
        // The columns are subsets of the rows of which all four parts are inhabited, and only so many are.
        return (4..).find(|&rows| choose(rows - 1, rows.div_ceil(2)) >= parameters as u128).expect("it grows");
    }
    // The two smallest classes of each column have at most 2N/v rows together. They are disjoint and meet those of any
    // other column, and so do they with their roles exchanged: by the theorem of Bollobás on pairs of sets, twice as many
    // pairs as there are columns ask for (2N/v choose N/v).
    let classes = (2u128..).find(|&m| choose(m, m / 2) >= 2 * parameters as u128).expect("it grows");
    let partitions = (classes.saturating_mul(v as u128)).div_ceil(2);
    let beyond_orthogonal = match parameters {
        // More columns than v + 1 cannot show each pair once. They do not with one row more either: in each column one
        // level stands in v + 1 rows, the others in v, and some row has at most two entries of the former kind. Each of
        // its entries shares its row with v - 1 others, or v, which are all different but for one that those two have in
        // common: more than the v^2 other rows that there are.
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

/// The binomial coefficient; what exceeds `u128` on the way saturates.
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
