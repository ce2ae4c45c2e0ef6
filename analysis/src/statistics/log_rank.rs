//! Implements the log-rank test, which tests whether an event happens sooner in one group than in another.
//!
//! The source is Mantel (Evaluation of survival data and two new rank order statistics arising in its consideration,
//! Cancer Chemotherapy Reports 50, 1966), after Mantel and Haenszel. At every time at which events happen, the test
//! compares the number of events in the first group with the number expected if chance alone had chosen among all
//! that were still waiting. A censored time counts up to its end, so that runs without a failure do not count as slow
//! runs.

use super::Lifetime;

/// Returns the two-sided p-value of the hypothesis that the event is at any time equally likely in both groups, by
/// the normal approximation; 1 if the data allow no conclusion. The test ignores pairs.
pub fn log_rank_p(first: &[Lifetime], second: &[Lifetime]) -> f64 {
    let mut all: Vec<(Lifetime, bool)> = first.iter().map(|lifetime| (*lifetime, true)).collect();
    all.extend(second.iter().map(|lifetime| (*lifetime, false)));
    all.sort_by(|a, b| a.0.time.total_cmp(&b.0.time));
    let (mut waiting, mut waiting_first) = (all.len() as f64, first.len() as f64);
    let (mut excess, mut variance) = (0.0, 0.0);
    for same in all.chunk_by(|a, b| a.0.time == b.0.time) {
        let happened = same.iter().filter(|(lifetime, _)| lifetime.happened).count() as f64;
        let in_first = same.iter().filter(|(lifetime, is_first)| lifetime.happened && *is_first).count() as f64;
        let share = waiting_first / waiting;
        excess += in_first - happened * share;
        // The variance of the hypergeometric distribution. A last single lifetime adds nothing.
        if waiting > 1.0 {
            variance += happened * share * (1.0 - share) * (waiting - happened) / (waiting - 1.0);
        }
        waiting -= same.len() as f64;
        waiting_first -= same.iter().filter(|(_, is_first)| *is_first).count() as f64;
    }
    if variance > 0.0 { libm::erfc(excess.abs() / (2.0 * variance).sqrt()) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::super::survival::lifetimes;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_leukaemia_patients_of_freireich_have_their_published_statistic() {
        // 6-MP against placebo (Freireich et al. 1963). Kleinbaum and Klein, Survival Analysis, chapter 2: chi-square
        // 16.793.
        let treated = lifetimes("6 6 6 6+ 7 9+ 10 10+ 11+ 13 16 17+ 19+ 20+ 22 23 25+ 32+ 32+ 34+ 35+");
        let placebo = lifetimes("1 1 2 2 3 4 4 5 5 8 8 8 8 11 11 12 12 15 17 22 23");
        let published = libm::erfc((16.793_f64 / 2.0).sqrt());
        let p = log_rank_p(&treated, &placebo);
        assert!((p / published - 1.0).abs() < 1e-3, "{p} {published}");
        assert!((log_rank_p(&placebo, &treated) - p).abs() < 1e-15);
    }

    #[test]
    fn a_small_table_is_as_by_hand() {
        // At 1 one of three waits in the first group, at 2 one of two: O - E = 1 - 1/3 + 0 - 0, V = 2/9.
        let p = log_rank_p(&lifetimes("1"), &lifetimes("2 3+"));
        assert!((p - libm::erfc((2.0 / 3.0) / (4.0_f64 / 9.0).sqrt())).abs() < 1e-15, "{p}");
    }

    #[test]
    fn where_nothing_happens_or_nobody_else_waits_nothing_is_said() {
        assert_eq!(log_rank_p(&lifetimes("5+ 5+"), &lifetimes("5+")), 1.0);
        assert_eq!(log_rank_p(&lifetimes("5 6"), &[]), 1.0);
        assert_eq!(log_rank_p(&[], &[]), 1.0);
    }

    /// Time by time, each looked up in both lists: the tables of Mantel and Haenszel.
    fn naive(first: &[Lifetime], second: &[Lifetime]) -> f64 {
        let (mut observed, mut expected, mut variance) = (0.0, 0.0, 0.0);
        for week in 0..30 {
            let at_risk = |group: &[Lifetime]| group.iter().filter(|l| l.time >= f64::from(week)).count() as f64;
            let events =
                |group: &[Lifetime]| group.iter().filter(|l| l.happened && l.time == f64::from(week)).count() as f64;
            let (n1, n2, d1, d2) = (at_risk(first), at_risk(second), events(first), events(second));
            let (n, d) = (n1 + n2, d1 + d2);
            if d > 0.0 {
                observed += d1;
                expected += d * n1 / n;
                if n > 1.0 {
                    variance += n1 * n2 * d * (n - d) / (n * n * (n - 1.0));
                }
            }
        }
        let chi_squared = (observed - expected) * (observed - expected) / variance;
        if variance > 0.0 { libm::erfc((chi_squared / 2.0).sqrt()) } else { 1.0 }
    }

    proptest! {
        #[test]
        fn it_is_the_sum_over_the_tables(
            first in prop::collection::vec((1_u8..25, any::<bool>()), 0..20),
            second in prop::collection::vec((1_u8..25, any::<bool>()), 0..20),
        ) {
            let of = |times: Vec<(u8, bool)>| -> Vec<Lifetime> {
                times.into_iter().map(|(time, happened)| Lifetime { time: f64::from(time), happened }).collect()
            };
            let (first, second) = (of(first), of(second));
            prop_assert!((log_rank_p(&first, &second) - naive(&first, &second)).abs() < 1e-9);
        }
    }
}
