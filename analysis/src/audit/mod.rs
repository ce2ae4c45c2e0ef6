//! An audit: a test suite on trial.
//!
//! An audit asks what a suite of tests would have missed. It measures how well the suite covers the space of a study, with the largest
//! hole of each row of discrete values. It shows what a hole means by a *witness*: a driver with a defect that passes the suite as the
//! driver of the study does, and fails in the hole. It counts how many *mutants* (drivers with defects of many kinds and sizes) the suite
//! notices.

mod additions;
mod better;
mod bout;
mod certified;
mod cover;
mod folder;
mod holes;
mod kept;
mod near_misses;
mod runs;
mod score;
mod screen;
mod suite;
mod witness;

pub use additions::Additions;
pub use better::Better;
pub use bout::{Found, Kill, Noticed, Tried};
pub use folder::{AuditFolder, AuditFolderFlaw};
pub use holes::{Holes, RowHole};
pub use kept::{ForeignLine, Kept};
pub use runs::Runs;
pub use score::{Estimate, KindScore, Score, Share, SizeScore};
pub use screen::Screen;
pub use suite::{Source, Suite, SuiteFlaw};
pub use witness::Witness;

use crate::Coverage;
use crate::certificate::Certificate;
use crate::estimate::Discrete;
use bout::Bout;
use paracosm_campaign::{Error, JsonArtefact, Reason, Study, TestSet};
use paracosm_coverage::{Deadline, Measure};
use serde::{Serialize, Serializer};
use std::time::Duration;
use thiserror::Error;

/// The reason why a study cannot be audited.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum AuditFlaw {
    /// The study tests a system, in which no defect can be made.
    #[error(
        "the study tests the system `{command}`: an audit makes defects in a driver, so it needs a scenario with a driver"
    )]
    System {
        /// The command that starts the system.
        command: String,
    },
    /// A perceiver is on trial.
    #[error("the study tests the perceiver `{name}`: an audit makes defects in a driver")]
    Perceiver {
        /// The name of the perceiver.
        name: String,
    },
    /// The driver runs in another process.
    #[error("driver `{driver}` runs in a process of its own: an audit makes defects in drivers of this process")]
    External {
        /// The address or the command of the driver.
        driver: String,
    },
    /// A parameter varies while a test runs.
    #[error(
        "parameter `{name}` is a signal, which varies while a test runs: an audit needs parameters with one value in each test"
    )]
    Signal {
        /// The name of the parameter.
        name: String,
    },
}

impl Reason for AuditFlaw {}

/// An audit of suites of tests.
#[derive(Debug)]
pub struct Audit<'a> {
    study: &'a Study,
    suites: Vec<Suite>,
    screen: Option<Screen>,
    limit: Option<Duration>,
    runs: Runs,
}

/// A suite with the results of its audit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Audited {
    /// The name of the suite.
    pub suite: String,
    /// The number of tests of the suite.
    pub tests: usize,
    /// The number of tests of the source that break a constraint and are left out.
    pub left_out: usize,
    /// The largest hole of the suite, and the largest hole of each row of discrete values.
    #[serde(flatten)]
    pub holes: Holes,
    /// The k-wise coverage of the discrete parameters; `None` if there are none.
    pub k_wise: Option<Discrete>,
    /// The coverage of the space by the suite, apart from the k-wise coverage.
    pub coverage: Coverage,
    /// A proof of the largest hole of each row that other programs can check.
    #[serde(skip)]
    pub certificate: Certificate,
    /// The witness; `None` if it failed in no test that was tried.
    pub witness: Option<Witness>,
    /// The mutation score; `None` without mutants.
    pub mutants: Option<Score>,
    /// Tests that kill the mutants which the suite misses; `None` without mutants.
    pub additions: Option<Additions>,
    /// A suite with fewer tests and smaller holes that kills as many mutants; `None` if none was found. Only the first suite has one.
    pub better: Option<Better>,
}

/// The results of an audit.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The description of the study.
    pub title: String,
    /// The screen of the defects; `None` without mutants.
    pub screen: Option<Screen>,
    /// The suites, in the order in which they were named.
    pub suites: Vec<Audited>,
}

impl Serialize for Report {
    /// Writes the results of the first suite beside the title, and the other suites under `others`.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Form<'a> {
            title: &'a str,
            #[serde(flatten)]
            first: Option<&'a Audited>,
            screen: &'a Option<Screen>,
            others: &'a [Audited],
        }
        let Self { title, screen, suites } = self;
        let first = suites.first();
        Form { title, first, screen, others: suites.get(1..).unwrap_or_default() }.serialize(serializer)
    }
}

impl JsonArtefact for Report {
    const FILE: &'static str = "audit.json";
}

impl<'a> Audit<'a> {
    /// Makes an audit of suites for the driver of a study, without mutants.
    ///
    /// # Errors
    /// The study tests a system, a perceiver or a driver in another process; or a parameter is a signal.
    pub fn of(study: &'a Study, suites: Vec<Suite>) -> Result<Self, AuditFlaw> {
        runs::check(study)?;
        if let Some(signal) = study.space().parameters().iter().find(|parameter| parameter.signal.is_some()) {
            return Err(AuditFlaw::Signal { name: signal.name.clone() });
        }
        Ok(Self { study, suites, screen: None, limit: None, runs: Runs::default() })
    }

    /// Returns the suites, in the order of the report.
    pub fn suites(&self) -> &[Suite] {
        &self.suites
    }

    /// Puts the mutants of a screen on trial.
    pub fn mutants(self, screen: Screen) -> Self {
        Self { screen: Some(screen), ..self }
    }

    /// Limits the time for each suite. The coverage, the holes and the certificate have a quarter each. The search for a better suite
    /// also has a quarter.
    /// Without a limit, the measures are exact.
    pub fn time_limit(self, limit: Duration) -> Self {
        Self { limit: Some(limit), ..self }
    }

    /// Sets the means by which tests are run.
    pub fn runs(self, runs: Runs) -> Self {
        Self { runs, ..self }
    }

    /// Runs the audit. `tried` has the mutants that were tried before, and gets the others. `sink` gets each mutant as soon as those
    /// before it are done.
    ///
    /// # Errors
    /// A suite cannot be measured, the audit was stopped, or `sink` fails.
    pub fn run(
        &self,
        tried: &mut Vec<Tried>,
        mut sink: impl FnMut(&Tried) -> Result<(), Error>,
    ) -> Result<Report, Error> {
        let measured = self.suites.iter().map(|suite| self.measured(suite));
        let mut suites = measured.collect::<Result<Vec<_>, Error>>()?;
        let Self { study, suites: all, runs, .. } = self;
        let mutants = self.tried_mutants();
        let bout = Bout { study, suites: all, mutants, runs };
        bout.run(tried.len(), |one| {
            sink(&one)?;
            tried.push(one);
            Ok(())
        })?;
        if let Some(screen) = self.screen.as_ref().filter(|_| !mutants.is_empty()) {
            for (position, suite) in suites.iter_mut().enumerate() {
                suite.mutants = Some(Score::of(screen.equivalent_so_far, tried, position));
                let witness = suite.witness.as_ref();
                suite.additions = Some(Additions::of(screen, tried, position, witness));
            }
        }
        if let (Some(suite), Some(first)) = (all.first(), suites.first_mut()) {
            let killed = first.mutants.as_ref().map_or(0, |score| score.all.killed);
            let screen = self.screen.as_ref().filter(|_| !mutants.is_empty()).map(|screen| (screen, killed));
            let holes = &first.holes;
            let search = better::Search { study, suite, holes, screen, runs, deadline: self.deadline() };
            first.better = search.run()?;
        }
        Ok(Report { title: study.title(), screen: self.screen.clone(), suites })
    }

    fn tried_mutants(&self) -> &[Noticed] {
        self.screen.as_ref().map_or(&[], |screen| &screen.mutants)
    }

    /// Returns the time for a piece of work.
    fn part(&self) -> Option<Duration> {
        self.limit.map(|limit| limit / 4)
    }

    fn deadline(&self) -> Deadline {
        self.part().map_or_else(Deadline::never, Deadline::after)
    }

    /// Measures a suite, and finds its witness.
    fn measured(&self, suite: &Suite) -> Result<Audited, Error> {
        let tests = TestSet::new(self.study.space().clone(), suite.points.clone());
        let mut coverage = Coverage::of(&tests, &[Measure::K_WISE, Measure::DISPERSION], None, self.part().into())?;
        let holes = Holes::of(suite, self.study, self.deadline())?;
        let certificate = certified::certificate(&tests, &holes, self.deadline());
        let search = witness::Search { study: self.study, suite, holes: &holes, runs: &self.runs };
        let witness = search.run()?;
        let k_wise = coverage.discrete.take().flatten();
        Ok(Audited {
            suite: suite.name.clone(),
            tests: suite.points.len(),
            left_out: suite.left_out,
            holes,
            k_wise,
            coverage,
            certificate,
            witness,
            mutants: None,
            additions: None,
            better: None,
        })
    }
}

#[cfg(test)]
mod tests;
