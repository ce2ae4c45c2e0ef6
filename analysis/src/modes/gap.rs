//! Divides failing tests into groups at empty gaps, one figure at a time, and only at gaps that chance would hardly
//! leave.

/// The greatest probability of a gap, among figures that are spread evenly by chance, at which the gap counts.
const CHANCE: f64 = 0.01;
/// The least number of things that are divided: if two of three things share a value, that is not a gap but the
/// effect of ticks.
const FEWEST: usize = 6;
/// The least share of a group's range that a gap has, however many figures there are.
const LEAST_SHARE: f64 = 0.25;

/// A numerical property of failing tests, by which the tests are divided.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figure<'a> {
    /// The value of the figure for each failing test.
    pub values: &'a [f64],
    /// The difference up to which two values of the figure count as equal.
    pub resolution: f64,
}

/// A group of failing tests, with the indices of the figures that separated the group from other tests.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Group {
    pub members: Vec<usize>,
    pub set_apart_by: Vec<usize>,
}

/// Divides things at the widest gap of any of their figures, and then each part again, as long as there is a gap.
///
/// A gap is the empty space between neighbouring values of a figure. If `n` values are spread evenly by chance
/// between the least and the greatest, one of the `n - 1` gaps takes a share of `g` of the range or more with a
/// probability of at most `(n - 1) (1 - g)^(n - 2)` (the union bound on uniform spacings; Pyke, "Spacings", Journal
/// of the Royal Statistical Society B 27(3), 1965). The things are divided if this bound is at most [`CHANCE`], the
/// gap is at least a quarter of the range and wider than the figure's resolution, and there are at least [`FEWEST`]
/// things.
pub(super) fn groups(count: usize, figures: &[Figure]) -> Vec<Group> {
    let mut found = Vec::new();
    let mut open = vec![Group { members: (0..count).collect(), set_apart_by: Vec::new() }];
    while let Some(Group { members, set_apart_by }) = open.pop() {
        let gaps = figures.iter().enumerate().filter_map(|(index, figure)| Some((index, gap(&members, figure)?)));
        let widest = gaps.reduce(|widest, next| if next.1.share > widest.1.share { next } else { widest });
        let Some((index, gap)) = widest else {
            found.push(Group { members, set_apart_by });
            continue;
        };
        let mut by = set_apart_by;
        if !by.contains(&index) {
            by.push(index);
        }
        let (above, below): (Vec<usize>, Vec<usize>) =
            members.into_iter().partition(|member| figures[index].values[*member] > gap.below);
        open.extend([above, below].map(|members| Group { members, set_apart_by: by.clone() }));
    }
    found
}

struct Gap {
    /// The last value before the gap.
    below: f64,
    /// The width of the gap as a share of the range.
    share: f64,
}

/// Returns the widest gap in a figure, if it is wide and improbable enough to count.
fn gap(members: &[usize], figure: &Figure) -> Option<Gap> {
    if members.len() < FEWEST {
        return None;
    }
    let mut values: Vec<f64> = members.iter().map(|member| figure.values[*member]).collect();
    values.sort_by(f64::total_cmp);
    let range = values.last()? - values.first()?;
    let gaps = values.windows(2).map(|pair| (pair[1] - pair[0], pair[0]));
    let (width, below) = gaps.reduce(|widest, next| if next.0 > widest.0 { next } else { widest })?;
    let share = width / range;
    let is_gap = width > figure.resolution && share >= LEAST_SHARE && probability(values.len(), share) <= CHANCE;
    is_gap.then_some(Gap { below, share })
}

/// Returns an upper bound of the probability that chance leaves this share of the range empty.
fn probability(count: usize, share: f64) -> f64 {
    (count - 1) as f64 * libm::pow(1.0 - share, (count - 2) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;

    fn members(values: &[f64]) -> Vec<Vec<usize>> {
        let figure = Figure { values, resolution: 0.5 };
        groups(values.len(), &[figure]).into_iter().map(|group| group.members).collect()
    }

    #[test]
    fn things_on_both_sides_of_a_gap_are_two_groups() {
        let values = [1.0, 9.0, 1.5, 9.2, 2.0, 9.4, 1.2, 8.8, 1.7, 9.1, 1.1, 9.9];
        assert_eq!(members(&values), [vec![0, 2, 4, 6, 8, 10], vec![1, 3, 5, 7, 9, 11]]);
    }

    #[test]
    fn a_gap_that_is_narrower_than_the_resolution_is_none() {
        let values: Vec<f64> = [1.0, 9.0, 1.5, 9.2, 2.0, 9.4, 1.2, 8.8, 1.7, 9.1].iter().map(|v| 0.05 * v).collect();
        assert_eq!(members(&values).len(), 1);
    }

    #[test]
    fn few_things_are_not_divided_and_none_are_no_matter() {
        assert_eq!(members(&[1.0, 2.0, 9.0]), [vec![0, 1, 2]]);
        assert_eq!(members(&[1.0, 1.0, 9.0, 9.0, 9.0]).len(), 1);
        assert_eq!(members(&[1.0, 9.0]), [vec![0, 1]]);
        assert_eq!(members(&[]), [Vec::<usize>::new()]);
        assert_eq!(members(&[3.0; 20]).len(), 1);
    }

    #[test]
    fn chance_alone_seldom_leaves_a_gap() {
        let mut random = Pcg64::seed_from_u64(1);
        for count in [5, 20, 100] {
            let divided = (0..2000).filter(|_| {
                let values: Vec<f64> = (0..count).map(|_| random.random_range(0.0..100.0)).collect();
                members(&values).len() > 1
            });
            let share = divided.count() as f64 / 2000.0;
            assert!(share <= 0.015, "{count} values: {share}");
        }
    }
}
