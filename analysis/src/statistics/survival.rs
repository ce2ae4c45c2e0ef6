//! Analyses times to an event, some of which are censored: the run ended before the event happened.
//!
//! A run with more tests might find a failure that a shorter run did not find: the time of the shorter run is
//! *censored*. If such runs were left out, or if their ends counted as times of the event, the estimate would be too
//! small. The estimator of Kaplan and Meier uses what is known about them (Nonparametric estimation from incomplete
//! observations, JASA 53, 1958).

/// The time to an event, or a censored time, after which the case was no longer observed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lifetime {
    /// The time to the event, or the time after which the case was no longer observed.
    pub time: f64,
    /// `true` if the event happened at this time; `false` if the event would have happened later, or never.
    pub happened: bool,
}

/// A survival curve, which is the share of cases in which the event has not happened, over time. It is a step
/// function that begins at 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Survival {
    /// The times at which the curve falls, in ascending order, each with the value of the curve from this time on.
    pub steps: Vec<(f64, f64)>,
}

impl Survival {
    /// Estimates the survival curve from the times of cases with and without an event. If an event and a censoring have
    /// the same time, the event comes first.
    pub fn of(lifetimes: &[Lifetime]) -> Self {
        let mut sorted = lifetimes.to_vec();
        sorted.sort_by(|a, b| a.time.total_cmp(&b.time));
        let (mut at_risk, mut share, mut steps) = (sorted.len(), 1.0, Vec::new());
        for same in sorted.chunk_by(|a, b| a.time == b.time) {
            let happened = same.iter().filter(|lifetime| lifetime.happened).count();
            if happened > 0 {
                share *= (at_risk - happened) as f64 / at_risk as f64;
                steps.push((same[0].time, share));
            }
            at_risk -= same.len();
        }
        Self { steps }
    }

    /// Returns the share of cases in which the event has not happened up to and including this time.
    pub fn at(&self, time: f64) -> f64 {
        self.steps.iter().take_while(|step| step.0 <= time).last().map_or(1.0, |step| step.1)
    }

    /// Returns the time at which the event has happened in half of the cases; `None` if this time is not known.
    pub fn median(&self) -> Option<f64> {
        self.steps.iter().find(|step| step.1 <= 0.5).map(|step| step.0)
    }

    /// Returns the restricted mean, which is the mean waiting time if nobody waits longer than `horizon`. It is the
    /// area under the curve up to `horizon` (Royston and Parmar, Restricted mean survival time, BMC Med. Res.
    /// Methodol. 13, 2013).
    pub fn restricted_mean(&self, horizon: f64) -> f64 {
        let (mut area, mut from, mut share) = (0.0, 0.0, 1.0);
        for &(time, next) in self.steps.iter().take_while(|step| step.0 < horizon) {
            area += share * (time - from);
            (from, share) = (time, next);
        }
        area + share * (horizon - from)
    }
}

/// Reads lifetimes as tables of patients write them: `6+` is a time censored at 6.
#[cfg(test)]
pub(super) fn lifetimes(text: &str) -> Vec<Lifetime> {
    let of =
        |word: &str| Lifetime { time: word.trim_end_matches('+').parse().unwrap(), happened: !word.ends_with('+') };
    text.split(' ').map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_leukaemia_patients_of_freireich_have_their_published_curve() {
        // 6-MP, weeks in remission (Freireich et al. 1963; Kalbfleisch and Prentice, The Statistical Analysis of
        // Failure Time Data, table 1.1 and figure 1.1).
        let patients = "6 6 6 6+ 7 9+ 10 10+ 11+ 13 16 17+ 19+ 20+ 22 23 25+ 32+ 32+ 34+ 35+";
        let survival = Survival::of(&lifetimes(patients));
        let published =
            [(6.0, 0.857), (7.0, 0.807), (10.0, 0.753), (13.0, 0.690), (16.0, 0.627), (22.0, 0.538), (23.0, 0.448)];
        assert_eq!(survival.steps.len(), published.len());
        for (step, expected) in survival.steps.iter().zip(published) {
            assert!(step.0 == expected.0 && (step.1 - expected.1).abs() < 5e-4, "{step:?}");
        }
        assert_eq!(survival.median(), Some(23.0));
    }

    /// By the definition: a product over the times at which something happened, each looked up in the whole list.
    fn naive(lifetimes: &[Lifetime], time: f64) -> f64 {
        let mut times: Vec<f64> = lifetimes.iter().filter(|l| l.happened && l.time <= time).map(|l| l.time).collect();
        times.dedup();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let factor = |&at: &f64| {
            let at_risk = lifetimes.iter().filter(|l| l.time >= at).count() as f64;
            let happened = lifetimes.iter().filter(|l| l.happened && l.time == at).count() as f64;
            1.0 - happened / at_risk
        };
        times.iter().map(factor).product()
    }

    proptest! {
        #[test]
        fn the_curve_is_the_product_over_what_happened(times in prop::collection::vec((1_u8..20, any::<bool>()), 1..40)) {
            let lifetimes: Vec<Lifetime> =
                times.iter().map(|&(time, happened)| Lifetime { time: f64::from(time), happened }).collect();
            let survival = Survival::of(&lifetimes);
            for time in 0..22 {
                let time = f64::from(time);
                prop_assert!((survival.at(time) - naive(&lifetimes, time)).abs() < 1e-12);
            }
            // The area, in steps in which nothing changes.
            let area: f64 = (0..15).map(|week| naive(&lifetimes, f64::from(week))).sum();
            prop_assert!((survival.restricted_mean(15.0) - area).abs() < 1e-9);
        }

        #[test]
        fn with_one_horizon_for_all_the_restricted_mean_is_the_mean_of_what_was_waited(
            times in prop::collection::vec(1_u8..60, 1..40)
        ) {
            let horizon = 30.0;
            let waited = |time: &u8| f64::from(*time).min(horizon);
            let lifetimes: Vec<Lifetime> =
                times.iter().map(|time| Lifetime { time: waited(time), happened: f64::from(*time) <= horizon }).collect();
            let mean = times.iter().map(waited).sum::<f64>() / times.len() as f64;
            prop_assert!((Survival::of(&lifetimes).restricted_mean(horizon) - mean).abs() < 1e-9);
        }
    }

    #[test]
    fn nothing_that_happens_leaves_the_curve_at_one() {
        let survival = Survival::of(&lifetimes("5+ 5+"));
        assert_eq!((survival.at(9.0), survival.median(), survival.restricted_mean(5.0)), (1.0, None, 5.0));
    }
}
