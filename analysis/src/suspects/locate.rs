//! Locates the guilty combinations of a campaign's failing tests by a few further tests.
//!
//! The search changes a failing test of the campaign towards a passing test, one discrete value after the other. The
//! continuous values stay those of the failing test. So if there are continuous parameters, the search first looks
//! for a passing start: a test with the discrete values of a passing test and the continuous values of the failing
//! test.
//!
//! If several combinations are guilty, a test on the way may fail for another reason than the first test, and the
//! located values may not be the cause. Therefore the search puts located values into passing tests, unless they
//! explain all failures. If such a test still passes, it refutes the values. It is then a new start, from which the
//! search must find more than these values. Later tests avoid all values found guilty, as if a constraint forbade them.
//! So the search continues from failure to failure, until each failure has a guilty combination or no combination can
//! be found for the failure. It runs no test twice, and no test that the campaign ran.

use super::Evidence;
use super::location::{Conclusion, Location};
use super::search::{LocationSearch, Pairs};
use paracosm_campaign::{Error, JsonArtefact, Log};
use paracosm_oracles::Verdict;
use paracosm_space::Values;
use serde::Serialize;
use std::collections::BTreeSet;

/// A failure for which no guilty combination was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Unexplained {
    /// The index of the failing trial.
    pub failing: usize,
    /// The reason why no guilty combination was found.
    pub why: Conclusion,
}

/// The combinations of discrete values that further tests found guilty of the failures of a campaign.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LocatedReport {
    /// The greatest number of further tests that the search was allowed to run.
    pub limit: usize,
    /// The number of further tests that were run.
    pub ran: usize,
    /// The searches for guilty combinations, in the order in which the searches ended. Each search began with a failing
    /// trial without any values that were found guilty before.
    pub locations: Vec<Location>,
    /// The failing trials for which no guilty combination was found.
    pub unexplained: Vec<Unexplained>,
}

impl JsonArtefact for LocatedReport {
    const FILE: &'static str = "located.json";
}

impl LocatedReport {
    /// Locates the guilty combinations of discrete values in the failing trials of a campaign, by further tests. `run`
    /// runs a test; it is called at most `limit` times. The result is `None` if there are no discrete parameters, no
    /// failing tests or no passing tests.
    ///
    /// # Errors
    /// A trial does not fit into the study's space, its constraints cannot be satisfied, or `run` returned an error.
    pub fn of(
        log: &Log,
        limit: usize,
        run: impl FnMut(&Values) -> Result<Verdict, Error>,
    ) -> Result<Option<Self>, Error> {
        let evidence = Evidence::of(log)?;
        evidence.tells_apart().then(|| Self::by(&evidence, limit, run)).transpose()
    }

    /// Locates the guilty combinations of tests, some of which failed and some of which passed.
    pub(super) fn by(
        evidence: &Evidence,
        limit: usize,
        run: impl FnMut(&Values) -> Result<Verdict, Error>,
    ) -> Result<Self, Error> {
        let mut search = LocationSearch::new(evidence, limit, run);
        let mut findings = Findings { evidence, tried: BTreeSet::new(), locations: Vec::new() };
        while let Some(failing) = findings.next() {
            let known = findings.take(failing);
            let location = search.location(failing, known)?;
            let conclusion = location.0.conclusion.clone();
            findings.add(failing, location);
            match conclusion {
                Conclusion::Guilty => search.forbid(findings.guilty()),
                Conclusion::LimitReached => break,
                _ => (),
            }
        }
        let unexplained = findings.unexplained();
        let locations = findings.locations.into_iter().map(|(location, _)| location).collect();
        Ok(Self { limit, ran: search.ran(), locations, unexplained })
    }
}

/// The locations so far, each with its values: the located values or, without a result, all values of its test.
struct Findings<'e> {
    evidence: &'e Evidence<'e>,
    /// The failing tests that were searched since the last combination was found guilty.
    tried: BTreeSet<usize>,
    locations: Vec<(Location, Pairs)>,
}

impl Findings<'_> {
    fn guilty(&self) -> impl Iterator<Item = &Pairs> {
        let guilty = self.locations.iter().filter(|(location, _)| location.conclusion == Conclusion::Guilty);
        guilty.map(|(_, values)| values)
    }

    /// Returns the failing tests without a guilty combination.
    fn left(&self) -> impl Iterator<Item = usize> {
        let tests = &self.evidence.tests;
        let explained = move |test: usize| self.guilty().any(|values| tests[test].contains(values));
        (0..tests.len()).filter(move |&test| tests[test].failed && !explained(test))
    }

    /// Returns the failing test to search next: if possible, a test without the values of an unsuccessful search.
    fn next(&self) -> Option<usize> {
        let in_vain = || self.locations.iter().filter(|(location, _)| location.conclusion != Conclusion::Guilty);
        let is_alike = |test: usize| in_vain().any(|(_, values)| self.evidence.tests[test].contains(values));
        let left: Vec<usize> = self.left().filter(|test| !self.tried.contains(test)).collect();
        left.iter().find(|&&test| !is_alike(test)).or(left.first()).copied()
    }

    /// Removes and returns the earlier location of a failing test, if there is one.
    fn take(&mut self, failing: usize) -> Option<Location> {
        let index = self.evidence.indices[failing];
        let position = self.locations.iter().position(|(location, _)| location.failing == index);
        position.map(|position| self.locations.remove(position).0)
    }

    fn add(&mut self, failing: usize, location: (Location, Pairs)) {
        if location.0.conclusion == Conclusion::Guilty {
            // With one combination fewer to mislead it, another search may find more.
            self.tried.clear();
        }
        self.tried.insert(failing);
        self.locations.push(location);
    }

    fn unexplained(&self) -> Vec<Unexplained> {
        let why = |failing: usize| {
            let of_it = self.locations.iter().find(|(location, _)| location.failing == failing);
            // Only the limit can prevent the search of a failing test.
            of_it.map_or(Conclusion::LimitReached, |(location, _)| location.conclusion.clone())
        };
        let left = self.left().map(|test| self.evidence.indices[test]);
        left.map(|failing| Unexplained { failing, why: why(failing) }).collect()
    }
}
