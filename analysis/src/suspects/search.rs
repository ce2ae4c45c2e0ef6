//! Searches for the guilty combinations of failing tests, one after the other, and remembers all tests.

use super::Evidence;
use super::location::{Conclusion, Location, TestOfLocation};
use paracosm_campaign::Error;
use paracosm_coverage::suspects::{JudgedTest, Located as Combination, Locator, Standing};
use paracosm_oracles::Verdict;
use paracosm_space::rules::{Clause, Literal, Rules};
use paracosm_space::{Point, Values};
use std::collections::HashMap;

/// The greatest number of passing tests that are tried as the start.
const MOST_STARTS: usize = 3;

/// The greatest number of times that a search begins again after tests have refuted the located values.
const MOST_RESTARTS: usize = 5;

/// The number of passing tests into which located values are put if they do not explain all failures.
const CONFIRMATIONS: usize = 2;

/// A list of (parameter, level) pairs.
pub(super) type Pairs = Vec<(usize, usize)>;

/// A reason why a search ends early.
enum Stop {
    /// A test of the search could not be run.
    Failed(Error),
    /// The search ended with a conclusion.
    Ended(Conclusion),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// The continuous values of a test, bit by bit, and its levels.
type Key = (Vec<u64>, Vec<usize>);

fn key(point: &Point) -> Key {
    (point.continuous.iter().map(|x| x.to_bits()).collect(), point.discrete.clone())
}

/// All searches of a campaign, with the tests that are known so far.
pub(super) struct LocationSearch<'e, R> {
    evidence: &'e Evidence<'e>,
    /// The rules for further tests: the constraints, and that the tests have no combination that was found guilty.
    rules: Rules,
    /// The tests that failed or passed: first those of the campaign, then further ones.
    known: Vec<JudgedTest>,
    verdicts: HashMap<Key, Verdict>,
    run: R,
    limit: usize,
    ran: usize,
}

/// A search, with its tests and the tests of earlier searches for the same failing test.
struct Attempt {
    failing: usize,
    is_first: bool,
    tests: Vec<TestOfLocation>,
    starting: usize,
    confirming: usize,
    restarts: usize,
}

impl<'e, R> LocationSearch<'e, R> {
    pub fn new(evidence: &'e Evidence<'e>, limit: usize, run: R) -> Self {
        let mut verdicts = HashMap::new();
        for (test, point) in evidence.tests.iter().zip(&evidence.points) {
            verdicts.entry(key(point)).or_insert(if test.failed { Verdict::Fail } else { Verdict::Pass });
        }
        let (rules, known) = (evidence.rules.clone(), evidence.tests.clone());
        Self { evidence, rules, known, verdicts, run, limit, ran: 0 }
    }

    /// Returns the number of further tests that were run.
    pub fn ran(&self) -> usize {
        self.ran
    }

    /// Forbids further tests to have guilty combinations, which no passing test has.
    pub fn forbid<'p>(&mut self, guilty: impl Iterator<Item = &'p Pairs>) {
        let levels = self.evidence.rules.levels();
        let literal = |&(parameter, level): &(usize, usize)| {
            let levels = (0..levels[parameter]).filter(|&other| other != level).collect();
            Literal { parameter, levels }
        };
        let clause = |values: &Pairs| vec![Clause { literals: values.iter().map(literal).collect() }];
        let mut constraints = self.evidence.space.clauses();
        constraints.extend(guilty.map(clause));
        self.rules = Rules::new(levels, &constraints).expect("passing tests keep all of them");
    }

    /// Returns the conclusion that passing tests refute the given values; `None` if no passing test has the values.
    pub fn refuted(&self, values: &[(usize, usize)]) -> Option<Conclusion> {
        let passed: Vec<usize> = self.having(values, false).collect();
        let trials = self.trials(&passed);
        (!passed.is_empty()).then(|| Conclusion::Refuted { further: passed.len() - trials.len(), trials })
    }

    /// Returns the known tests that have these values and failed (or passed, if `failed` is `false`).
    fn having(&self, values: &[(usize, usize)], failed: bool) -> impl Iterator<Item = usize> {
        let fits = move |test: &JudgedTest| test.failed == failed && test.contains(values);
        self.known.iter().enumerate().filter(move |(_, test)| fits(test)).map(|(position, _)| position)
    }

    /// Returns the indices of those known tests that are trials of the campaign.
    fn trials(&self, known: &[usize]) -> Vec<usize> {
        known.iter().filter_map(|&test| self.evidence.indices.get(test).copied()).collect()
    }

    /// Returns the passing tests that have these values, each choice of levels once, the tests least like `test`
    /// first.
    fn unlike(&self, test: &[usize], values: &[(usize, usize)]) -> Vec<usize> {
        let shared = |other: usize| test.iter().zip(&self.known[other].levels).filter(|(a, b)| a == b).count();
        let mut found: Vec<usize> =
            self.having(values, false).filter(|&other| self.known[other].levels != test).collect();
        found.sort_by_key(|&other| (shared(other), &self.known[other].levels, other));
        found.dedup_by_key(|other| &self.known[*other].levels);
        found
    }
}

impl<R: FnMut(&Values) -> Result<Verdict, Error>> LocationSearch<'_, R> {
    /// Searches for a guilty combination in a failing test that has no forbidden combination. `known` is the result
    /// of an earlier search. Returns the location, and the located values or, without a result, all values.
    ///
    /// # Errors
    /// The error of running a test.
    pub fn location(&mut self, failing: usize, known: Option<Location>) -> Result<(Location, Pairs), Error> {
        let is_first = known.is_none();
        let (tests, starting, confirming, restarts) =
            known.map(|known| (known.tests, known.starting, known.confirming, known.restarts)).unwrap_or_default();
        let mut attempt = Attempt { failing, is_first, tests, starting, confirming, restarts };
        let (conclusion, located) = match self.conclude(&mut attempt) {
            Ok(concluded) => concluded,
            Err(Stop::Ended(conclusion)) => (conclusion, None),
            Err(Stop::Failed(error)) => return Err(error),
        };
        let evidence = self.evidence;
        let all = || evidence.tests[failing].levels.iter().copied().enumerate().collect();
        let (values, undivided, bound) =
            located.map(|located| (located.values, located.undivided, located.bound)).unwrap_or_default();
        let explains: Vec<usize> =
            if conclusion == Conclusion::Guilty { self.having(&values, true).collect() } else { Vec::new() };
        let location = Location {
            failing: evidence.indices[failing],
            conclusion,
            values: evidence.named(&values),
            undivided: evidence.named(&undivided),
            explains: self.trials(&explains),
            starting: attempt.starting,
            confirming: attempt.confirming,
            restarts: attempt.restarts,
            bound: bound.filter(|_| attempt.is_first && attempt.restarts == 0),
            tests: attempt.tests,
        };
        Ok((location, if values.is_empty() { all() } else { values }))
    }

    fn conclude(&mut self, attempt: &mut Attempt) -> Result<(Conclusion, Option<Combination>), Stop> {
        let mut start = self.start(attempt, &[])?;
        for restarts in 0.. {
            let located = self.between(attempt, &start, restarts > 0)?;
            if let Standing::OneOfSeveral(_) = located.standing(&self.known) {
                self.confirm(attempt, &located)?;
            }
            let Some(refuted) = self.refuted(&located.values) else {
                return Ok((Conclusion::Guilty, Some(located)));
            };
            if restarts == MOST_RESTARTS {
                return Ok((refuted, Some(located)));
            }
            // A passing test that has the values is a new start, from which the search must find more than these
            // values.
            match self.start(attempt, &located.values) {
                Ok(next) => start = next,
                Err(Stop::Ended(_)) => return Ok((refuted, Some(located))),
                Err(failed) => return Err(failed),
            }
            attempt.restarts += 1;
        }
        unreachable!("it ends with the last restart")
    }

    /// Returns the levels of the first passing test with these values that also passes with the continuous values of
    /// the failing test.
    fn start(&mut self, attempt: &mut Attempt, values: &[(usize, usize)]) -> Result<Vec<usize>, Stop> {
        let mut starts = self.unlike(&self.evidence.tests[attempt.failing].levels, values);
        starts.truncate(MOST_STARTS);
        let before = attempt.tests.len();
        let passing = self.first_passing(attempt, &starts);
        attempt.starting += attempt.tests.len() - before;
        let none =
            || if starts.is_empty() { Conclusion::NoPassingTest } else { Conclusion::NoStart(self.trials(&starts)) };
        passing?.ok_or_else(|| Stop::Ended(none()))
    }

    fn first_passing(&mut self, attempt: &mut Attempt, starts: &[usize]) -> Result<Option<Vec<usize>>, Stop> {
        for &start in starts {
            let levels = self.known[start].levels.clone();
            if !self.fails(attempt, levels.clone())? {
                return Ok(Some(levels));
            }
        }
        Ok(None)
    }

    /// Locates the combination between the failing test and a start. If `cautiously`, values are changed only to
    /// levels with which a test has passed.
    fn between(&mut self, attempt: &mut Attempt, start: &[usize], cautiously: bool) -> Result<Combination, Stop> {
        let failing = &self.evidence.tests[attempt.failing].levels;
        let passes = |parameter, level| self.having(&[(parameter, level)], false).next().is_some();
        let is_safe = |parameter, level| !cautiously || passes(parameter, level);
        let rules = self.rules.clone();
        let mut locator = Locator::cautious(&rules, failing, start, is_safe).expect("valid tests that differ");
        while let Some(levels) = locator.question().map(<[usize]>::to_vec) {
            locator.tell(self.fails(attempt, levels)?);
        }
        Ok(locator.located().expect("there are no more questions"))
    }

    /// Puts located values into some passing tests, until such a test still passes.
    fn confirm(&mut self, attempt: &mut Attempt, located: &Combination) -> Result<(), Stop> {
        let before = attempt.tests.len();
        for other in self.unlike(&self.evidence.tests[attempt.failing].levels, &[]).into_iter().take(10 * CONFIRMATIONS)
        {
            let levels = located.put_into(&self.rules, &self.known[other].levels);
            match self.fails(attempt, levels) {
                Ok(true) | Err(Stop::Ended(Conclusion::Undecided(_))) => (),
                Ok(false) | Err(Stop::Ended(_)) => break,
                Err(failed) => return Err(failed),
            }
            if attempt.tests.len() - before == CONFIRMATIONS {
                break;
            }
        }
        attempt.confirming += attempt.tests.len() - before;
        Ok(())
    }

    /// Checks whether the test with these levels and the continuous values of the failing test fails.
    fn fails(&mut self, attempt: &mut Attempt, levels: Vec<usize>) -> Result<bool, Stop> {
        let continuous = self.evidence.points[attempt.failing].continuous.clone();
        let point = Point { continuous, discrete: levels };
        let verdict = match self.verdicts.get(&key(&point)) {
            Some(verdict) => *verdict,
            None if self.ran == self.limit => return Err(Stop::Ended(Conclusion::LimitReached)),
            None => {
                let test = self.evidence.space.decode(&point);
                let verdict = (self.run)(&test)?;
                self.ran += 1;
                attempt.tests.push(TestOfLocation { test, verdict });
                self.verdicts.insert(key(&point), verdict);
                if let Verdict::Fail | Verdict::Pass = verdict {
                    self.known.push(JudgedTest { levels: point.discrete, failed: verdict == Verdict::Fail });
                }
                verdict
            }
        };
        match verdict {
            Verdict::Fail => Ok(true),
            Verdict::Pass => Ok(false),
            other => Err(Stop::Ended(Conclusion::Undecided(other))),
        }
    }
}
