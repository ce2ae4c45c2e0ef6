//! The guilty combination of a campaign's failing test, by a few more tests.
//!
//! A failing test of the campaign is changed towards a passing one, discrete value by discrete value; the continuous
//! values stay those of the failing test. Where there are any, a passing test from which to start is therefore first
//! made of the discrete values of a passing test and the continuous values of the failing one.

use super::Evidence;
use crate::{Error, Study, Trial};
use paracosm_coverage::suspects::{Located as Combination, Locator, Standing};
use paracosm_coverage::{Point, Values};
use paracosm_oracles::Verdict;
use serde::Serialize;

/// How many guilty combinations are looked for.
const MOST_LOCATED: usize = 10;

/// How many passing tests are tried as the start.
const MOST_STARTS: usize = 3;

/// How often a search begins anew after known tests have refuted what it located.
const MOST_RESTARTS: usize = 3;

/// A further test and how it ended.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TestOfLocation {
    /// The values of the open parameters.
    pub test: Values,
    /// How it ended.
    pub verdict: Verdict,
}

/// What further tests say about a failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Conclusion {
    /// The located values are the cause: no test that has them passed.
    Guilty,
    /// The trials of these indices have the located values too and passed: those are not the cause by themselves.
    Refuted(Vec<usize>),
    /// The test fails with the discrete values of passing trials as well, those of these indices; their discrete values
    /// are not what saved them.
    NoStart(Vec<usize>),
    /// All passing trials have the discrete values of the failing test.
    NoPassingTest,
    /// A test ended neither in a failure nor in a pass.
    Undecided(Verdict),
}

/// The search that began with one failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Location {
    /// The index of the failing trial.
    pub failing: usize,
    /// What the search ended with.
    pub conclusion: Conclusion,
    /// The located values; none where there is no conclusion about values.
    pub values: Values,
    /// Those of them that constraints tie to others of them, so that no test could tell which are needed.
    pub undivided: Values,
    /// How many of the tests were needed to begin: none where there are no continuous parameters.
    pub starting: usize,
    /// How often the search began anew because trials refuted what it had located: several combinations are guilty.
    pub restarts: usize,
    /// How many tests besides those to begin are enough for one guilty combination, k (ceil(log2 N) + 1) for k of N
    /// values; `None` where constraints kept the search from halving, where several combinations misled it, or where
    /// nothing was located.
    pub bound: Option<usize>,
    /// The tests that were run, in order.
    pub tests: Vec<TestOfLocation>,
}

/// The guilty combinations of a campaign, as far as they were found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Located {
    /// One search after the other, each with the first failing test that has none of the values located before. The
    /// first that locates none is the last, and there are 10 at most.
    pub locations: Vec<Location>,
    /// The indices of the failing trials that have no located combination.
    pub unexplained: Vec<usize>,
}

impl Located {
    /// Locates what is behind the failing trials; `run` runs a test. `None` where there is nothing to tell apart: no
    /// discrete parameter, no failing test or no passing one.
    ///
    /// # Errors
    /// A trial is none of the study's space, its constraints cannot be kept, or that of `run`.
    pub fn of(
        study: &Study,
        trials: &[Trial],
        mut run: impl FnMut(&Values) -> Result<Verdict, Error>,
    ) -> Result<Option<Self>, Error> {
        let evidence = Evidence::of(study, trials)?;
        if !evidence.tells_apart() {
            return Ok(None);
        }
        let mut left: Vec<usize> = (0..evidence.tests.len()).filter(|&test| evidence.tests[test].failed).collect();
        let mut locations = Vec::new();
        while locations.len() < MOST_LOCATED
            && let Some(&failing) = left.first()
        {
            let mut search = Search { evidence: &evidence, failing, run: &mut run, tests: Vec::new() };
            let (location, values) = search.location()?;
            let goes_on = location.conclusion == Conclusion::Guilty;
            locations.push(location);
            if !goes_on {
                break;
            }
            left.retain(|&test| !evidence.tests[test].contains(&values));
        }
        let unexplained = left.into_iter().map(|test| evidence.indices[test]).collect();
        Ok(Some(Self { locations, unexplained }))
    }
}

/// (parameter, level) pairs.
type Pairs = Vec<(usize, usize)>;

struct Search<'a, R> {
    evidence: &'a Evidence<'a>,
    failing: usize,
    run: &'a mut R,
    tests: Vec<TestOfLocation>,
}

impl<R: FnMut(&Values) -> Result<Verdict, Error>> Search<'_, R> {
    fn location(&mut self) -> Result<(Location, Pairs), Error> {
        let evidence = self.evidence;
        let starts = self.starts(&[]);
        let mut start = if starts.is_empty() { Err(Conclusion::NoPassingTest) } else { self.first_passing(starts)? };
        let mut starting = self.tests.len();
        let mut restarts = 0;
        let (conclusion, located) = loop {
            let located = match start {
                Err(conclusion) => break (conclusion, None),
                Ok(start) => match self.search(start)? {
                    Err(verdict) => break (Conclusion::Undecided(verdict), None),
                    Ok(located) => located,
                },
            };
            let Standing::Refuted(passed) = located.standing(&evidence.tests) else {
                break (Conclusion::Guilty, Some(located));
            };
            // A passing test that has the values is a start from which they cannot be all that is found.
            let before = self.tests.len();
            let next =
                if restarts < MOST_RESTARTS { self.first_passing(self.starts(&located.values))?.ok() } else { None };
            starting += self.tests.len() - before;
            let Some(next) = next else { break (Conclusion::Refuted(self.indices(passed)), Some(located)) };
            restarts += 1;
            start = Ok(next);
        };
        let (values, undivided, bound) =
            located.map(|located| (located.values, located.undivided, located.bound)).unwrap_or_default();
        let location = Location {
            failing: evidence.indices[self.failing],
            conclusion,
            values: evidence.named(&values),
            undivided: evidence.named(&undivided),
            starting,
            restarts,
            bound: bound.filter(|_| restarts == 0),
            tests: std::mem::take(&mut self.tests),
        };
        Ok((location, values))
    }

    /// Locates from a start; the verdict of a test that neither failed nor passed ends it.
    fn search(&mut self, start: usize) -> Result<Result<Combination, Verdict>, Error> {
        let evidence = self.evidence;
        let [failing, passing] = [self.failing, start].map(|test| &evidence.tests[test].levels);
        let mut locator = Locator::new(&evidence.rules, failing, passing).expect("valid tests that differ");
        while let Some(levels) = locator.question().map(<[usize]>::to_vec) {
            match self.verdict(levels)? {
                Verdict::Fail => locator.tell(true),
                Verdict::Pass => locator.tell(false),
                other => return Ok(Err(other)),
            }
        }
        Ok(Ok(locator.located().expect("there are no more questions")))
    }

    /// Passing tests that have these values and others than the failing one: those that share least with it come first,
    /// each choice of discrete values once.
    fn starts(&self, values: &[(usize, usize)]) -> Vec<usize> {
        let tests = &self.evidence.tests;
        let failing = &tests[self.failing].levels;
        let shared = |test: usize| failing.iter().zip(&tests[test].levels).filter(|(a, b)| a == b).count();
        let fits = |test: &usize| {
            let test = &tests[*test];
            !test.failed && test.levels != *failing && test.contains(values)
        };
        let mut starts: Vec<usize> = (0..tests.len()).filter(fits).collect();
        starts.sort_by_key(|&test| (shared(test), &tests[test].levels, test));
        starts.dedup_by_key(|test| &tests[*test].levels);
        starts.truncate(MOST_STARTS);
        starts
    }

    /// The first of these that passes with the continuous values of the failing test, too.
    fn first_passing(&mut self, starts: Vec<usize>) -> Result<Result<usize, Conclusion>, Error> {
        let evidence = self.evidence;
        for &start in &starts {
            if evidence.space.dims() == 0 {
                return Ok(Ok(start));
            }
            match self.verdict(evidence.tests[start].levels.clone())? {
                Verdict::Fail => (),
                Verdict::Pass => return Ok(Ok(start)),
                other => return Ok(Err(Conclusion::Undecided(other))),
            }
        }
        Ok(Err(Conclusion::NoStart(self.indices(starts))))
    }

    /// Runs the test with these levels and the continuous values of the failing one.
    fn verdict(&mut self, levels: Vec<usize>) -> Result<Verdict, Error> {
        let continuous = self.evidence.points[self.failing].continuous.clone();
        let test = self.evidence.space.decode(&Point { continuous, discrete: levels });
        let verdict = (self.run)(&test)?;
        self.tests.push(TestOfLocation { test, verdict });
        Ok(verdict)
    }

    fn indices(&self, tests: Vec<usize>) -> Vec<usize> {
        tests.into_iter().map(|test| self.evidence.indices[test]).collect()
    }
}
