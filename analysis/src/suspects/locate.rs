//! The guilty combinations of a campaign's failing tests, by a few more tests.
//!
//! A failing test of the campaign is changed towards a passing one, discrete value by discrete value; the continuous
//! values stay those of the failing test. Where there are any, a passing test from which to start is therefore first
//! made of the discrete values of a passing test and the continuous values of the failing one.
//!
//! Where several combinations are guilty, a test on the way may fail for another reason than the first, and values be
//! located that are not the cause. Unless they explain all failures, they are therefore put into passing tests. One that
//! still passes refutes them, and is a start from which they cannot be all that is found. What was found guilty is kept
//! out of all later tests, as if a constraint forbade it. So it goes on from failure to failure, until each has a guilty
//! combination or none can be found for it. No test is run twice, those of the campaign included.

use super::Evidence;
use super::location::{Conclusion, Location};
use super::search::{LocationSearch, Pairs};
use paracosm_campaign::{Error, JsonArtefact, Log};
use paracosm_oracles::Verdict;
use paracosm_space::Values;
use serde::Serialize;
use std::collections::BTreeSet;

/// A failure without a guilty combination.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Unexplained {
    /// The index of the failing trial.
    pub failing: usize,
    /// Why it has none.
    pub why: Conclusion,
}

/// The guilty combinations of a campaign, as far as they were found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LocatedReport {
    /// How many further tests there could be at most.
    pub limit: usize,
    /// How many were run.
    pub ran: usize,
    /// One search after the other, each with a failing trial that had none of the values found guilty before.
    pub locations: Vec<Location>,
    /// The failing trials that have no guilty combination.
    pub unexplained: Vec<Unexplained>,
}

impl JsonArtefact for LocatedReport {
    const FILE: &'static str = "located.json";
}

impl LocatedReport {
    /// Locates what is behind the failing trials; `run` runs a test, at most `limit` in all. `None` where there is
    /// nothing to tell apart: no discrete parameter, no failing test or no passing one.
    ///
    /// # Errors
    /// A trial is none of the study's space, its constraints cannot be kept, or that of `run`.
    pub fn of(
        log: &Log,
        limit: usize,
        run: impl FnMut(&Values) -> Result<Verdict, Error>,
    ) -> Result<Option<Self>, Error> {
        let evidence = Evidence::of(log)?;
        evidence.tells_apart().then(|| Self::by(&evidence, limit, run)).transpose()
    }

    /// Locates what is behind the failures of tests of which some failed and some passed.
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

/// The locations so far, each with the values to which it came: the located ones or, without a result, all of its test.
struct Findings<'e> {
    evidence: &'e Evidence<'e>,
    /// The failing tests that were looked into since a combination was found guilty.
    tried: BTreeSet<usize>,
    locations: Vec<(Location, Pairs)>,
}

impl Findings<'_> {
    fn guilty(&self) -> impl Iterator<Item = &Pairs> {
        let guilty = self.locations.iter().filter(|(location, _)| location.conclusion == Conclusion::Guilty);
        guilty.map(|(_, values)| values)
    }

    /// Failing tests without a guilty combination.
    fn left(&self) -> impl Iterator<Item = usize> {
        let tests = &self.evidence.tests;
        let explained = move |test: usize| self.guilty().any(|values| tests[test].contains(values));
        (0..tests.len()).filter(move |&test| tests[test].failed && !explained(test))
    }

    /// The failing test to look into next: one that has no values that led nowhere, if there is one.
    fn next(&self) -> Option<usize> {
        let in_vain = || self.locations.iter().filter(|(location, _)| location.conclusion != Conclusion::Guilty);
        let is_alike = |test: usize| in_vain().any(|(_, values)| self.evidence.tests[test].contains(values));
        let left: Vec<usize> = self.left().filter(|test| !self.tried.contains(test)).collect();
        left.iter().find(|&&test| !is_alike(test)).or(left.first()).copied()
    }

    /// Takes out what was found about a failing test before.
    fn take(&mut self, failing: usize) -> Option<Location> {
        let index = self.evidence.indices[failing];
        let position = self.locations.iter().position(|(location, _)| location.failing == index);
        position.map(|position| self.locations.remove(position).0)
    }

    fn add(&mut self, failing: usize, location: (Location, Pairs)) {
        if location.0.conclusion == Conclusion::Guilty {
            // With one combination less to lead it astray, another search may find more.
            self.tried.clear();
        }
        self.tried.insert(failing);
        self.locations.push(location);
    }

    fn unexplained(&self) -> Vec<Unexplained> {
        let why = |failing: usize| {
            let of_it = self.locations.iter().find(|(location, _)| location.failing == failing);
            // Only the limit keeps a failing test from being looked into.
            of_it.map_or(Conclusion::LimitReached, |(location, _)| location.conclusion.clone())
        };
        let left = self.left().map(|test| self.evidence.indices[test]);
        left.map(|failing| Unexplained { failing, why: why(failing) }).collect()
    }
}
