//! Computes the guarantee of a random family of rows: the paper's Proposition 3.2, in the form of the union bound
//! behind it.
//!
//! A promise is theory, made before any test is run: this number of rows has all combinations of values with at least
//! this probability. The measured coverage of the tests is shown beside the promise, never instead of it.

use paracosm_campaign::{Error, Log};
use paracosm_coverage::theory::rows::RandomRows;
use paracosm_generators::{DiscreteFamily, GeneratorError, Request, Strategy};
use paracosm_space::plural;
use serde::Serialize;

/// The guaranteed probability with which random rows of discrete values have all valid combinations of k values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Promise {
    /// The number of discrete parameters in each covered combination.
    pub k: usize,
    /// The greatest allowed probability that a valid combination of values is missing.
    pub delta: f64,
    /// The number of random rows with which the probability of a missing combination is at most delta.
    pub rows_for_delta: u64,
    /// The number of rows that were drawn, repeated rows included. It is `rows_for_delta`, or the number of tests if
    /// that is smaller.
    pub rows: u64,
    /// The least probability that the rows have all valid combinations; 0 if nothing is guaranteed.
    pub guaranteed_probability: f64,
}

impl Promise {
    /// Returns the coverage guarantee of the random rows of a campaign's tests; `None` if the rows are not random.
    ///
    /// # Errors
    /// The errors of [`Promise::of`], or the tests that the campaign extends cannot be read.
    pub fn of_campaign(log: &Log) -> Result<Option<Self>, Error> {
        let (existing, sampling) = (log.existing()?, log.study().sampling());
        Self::of(sampling.strategy, &sampling.request(log.study().space(), &existing), sampling.budget as u64)
    }

    /// Returns the coverage guarantee of a strategy's first `tests` tests for a request; `None` if they have no random
    /// rows.
    ///
    /// # Errors
    /// There are fewer than `k` discrete parameters, the constraints cannot be satisfied, or the constraints make the
    /// probability of a combination impossible to compute.
    pub fn of(strategy: Strategy, request: &Request, tests: u64) -> Result<Option<Self>, Error> {
        let parameters = request.space.levels().len();
        let DiscreteFamily::Random { delta } = request.discrete else { return Ok(None) };
        if parameters == 0 || !strategy.has_rows(request) {
            return Ok(None);
        }
        let k = request.discrete_strength()?;
        let random = RandomRows::new(&request.space.rules()?, k).ok_or(GeneratorError::RandomUnderConstraints)?;
        let rows_for_delta = random.family_size(delta);
        let rows = rows_for_delta.min(tests);
        // However many rows there are, a combination may still be missing: the probability never reaches 1.
        let guaranteed_probability = (1.0 - random.missed(rows)).clamp(0.0, 1.0_f64.next_down());
        Ok(Some(Self { k, delta, rows_for_delta, rows, guaranteed_probability }))
    }

    /// Returns the guarantee of the random rows in words. If there are fewer rows than `delta` needs, the words state
    /// the number of rows that `delta` needs.
    pub fn words(&self) -> String {
        let Self { k, delta, rows_for_delta, rows, guaranteed_probability } = self;
        let promise = match rounded_down(*guaranteed_probability) {
            Some(probability) => format!("all {k}-wise combinations with probability at least {probability}"),
            None => "nothing".to_owned(),
        };
        match rows < rows_for_delta {
            true => format!("{promise} (delta {delta} asks for {})", plural(*rows_for_delta as usize, "row")),
            false => promise,
        }
    }
}

/// Rounds a probability down to a decimal number, with as many digits as distinguish it from 1; `None` if it is next
/// to 0.
fn rounded_down(probability: f64) -> Option<String> {
    let rounded = |digits: usize| {
        let unit = 10_u64.pow(digits as u32);
        (digits, unit, (probability * unit as f64).floor() as u64)
    };
    // The number may state at most twice the true probability that a combination is missing.
    let tells = |&(_, unit, kept): &(usize, u64, u64)| (unit - kept) as f64 <= 2.0 * (1.0 - probability) * unit as f64;
    let (digits, _, kept) = (4..=15).map(rounded).find(tells).unwrap_or_else(|| rounded(15));
    (kept > 0).then(|| format!("0.{kept:0digits$}").trim_end_matches('0').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_space::Space;

    #[test]
    fn a_probability_is_never_rounded_up_and_never_to_1() {
        let cases = [
            (0.0, None),
            (0.000_05, None),
            (0.95, Some("0.95")),
            (0.953_19, Some("0.9531")),
            (0.999_97, Some("0.99997")),
            (1.0 - 2.5e-9, Some("0.999999997")),
            (1.0_f64.next_down(), Some("0.999999999999999")),
        ];
        for (probability, words) in cases {
            assert_eq!(rounded_down(probability).as_deref(), words, "{probability}");
        }
    }

    #[test]
    fn fewer_tests_than_delta_asks_for_promise_less_and_say_so() {
        let space = Space::from_toml(
            "parameter = [{ name = \"a\", choice = [1, 2] }, { name = \"b\", choice = [1, 2] },
            { name = \"x\", interval = [0, 1] }]",
        )
        .unwrap();
        let request = Request { discrete: DiscreteFamily::Random { delta: 0.05 }, ..Request::new(&space, 1) };
        let promise = |strategy, tests| Promise::of(strategy, &request, tests).unwrap();
        // 4 (3/4)^n: 0.0422.. for 16 rows, 0.95.. for 5; the paper's formula asks for 18.
        let enough = promise(Strategy::HALTON, 500).unwrap();
        assert_eq!((enough.rows, enough.rows_for_delta), (18, 18));
        assert_eq!(enough.words(), "all 2-wise combinations with probability at least 0.9774");
        let fewer = promise(Strategy::HALTON, 5).unwrap();
        let words = "all 2-wise combinations with probability at least 0.0507 (delta 0.05 asks for 18 rows)";
        assert_eq!(fewer.words(), words);
        assert_eq!(promise(Strategy::HALTON, 4).unwrap().words(), "nothing (delta 0.05 asks for 18 rows)");
        // Greedy looks at all parameters together, without rows.
        assert_eq!(promise(Strategy::GREEDY, 500), None);
    }
}
