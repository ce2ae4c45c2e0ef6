//! Judges whether failures could have been prevented: runs every failing test again with reference drivers.
//!
//! A driver *prevents* a failure if its run of the same test satisfies every requirement that was violated, and
//! violates no requirement that the driver under test had satisfied. So a driver that stands still for ever does not
//! prevent a collision that happens after the car has reached a required place. A requirement that was undecided,
//! because a contact had ended the run, counts against no driver. A run that broke, or whose world could not be
//! built, tells nothing: if no other driver prevents the failure, the failure is not judged.
//!
//! A failure that no reference driver prevents is *unpreventable by these drivers*, and no more than that is claimed.
//! The reference drivers brake and do nothing else: they do not steer around road users, and do not drive slower
//! where somebody might come. `ideal` has a proof of what braking can achieve, for a single other road user whose
//! future is known ([`engine::driver::reference`](paracosm_engine::driver::reference)). In a simulated car `ideal`
//! knows the ground truth but not the future, and sees no more than can be seen.

mod inquiry;

pub use inquiry::{Inquiry, InquiryFlaw};

use paracosm_campaign::{JsonArtefact, Number, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{Record, Values};
use serde::{Serialize, Serializer};
use std::fmt;

/// The default reference drivers that judge failures.
pub const REFERENCES: [&str; 5] = ["ideal", "cc", "rss", "fsm", "cruise"];

/// The name of the driver that never brakes for others. A failure that this driver prevents was caused by braking.
const NEVER_BRAKES: &str = "cruise";

/// The preventability of a failure, judged by runs of the same test with reference drivers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Preventability {
    /// No reference driver prevents the failure.
    Unpreventable,
    /// A reference driver that brakes prevents the failure.
    Preventable,
    /// The driver `cruise`, which never brakes, prevents the failure. Without braking it would not have happened.
    Induced,
    /// The preventability of the failure is not known. No reference driver is known to prevent the failure, and a run
    /// of a reference driver broke or was not built.
    Unknown,
}

impl Preventability {
    /// All possible judgements of a failure's preventability.
    pub const ALL: [Self; 4] = [Self::Unpreventable, Self::Preventable, Self::Induced, Self::Unknown];
}

impl fmt::Display for Preventability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Unpreventable => "unpreventable",
            Self::Preventable => "preventable",
            Self::Induced => "induced",
            Self::Unknown => "unknown",
        })
    }
}

/// The failing tests of a campaign, each with a judgement of its preventability.
#[derive(Debug, Clone, PartialEq)]
pub struct Blame {
    /// The names of the reference drivers that judge the failures.
    pub references: Vec<String>,
    /// The number of all tests of the campaign.
    pub tests: usize,
    /// The failing tests of the campaign, in the order of their indices.
    pub failures: Vec<Blamed>,
}

/// A failing test with a judgement of its preventability.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Blamed {
    /// The index of the test in its campaign.
    pub index: usize,
    /// The parameter values of the test.
    pub test: Values,
    /// The ids of the requirements that the test violates.
    pub violates: Vec<String>,
    /// The judgement of the failure's preventability.
    pub fault: Preventability,
    /// The names of the reference drivers that prevent the failure.
    pub prevented_by: Vec<String>,
    /// The result of the test with each reference driver, by the driver's name.
    pub runs: Record<Rerun>,
}

/// The result of running a failing test again with a reference driver.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rerun {
    /// The verdict of the run with the reference driver.
    pub verdict: Verdict,
    /// `Some(true)` if the reference driver prevents the failure; `None` if the run broke or its world could not be
    /// built.
    pub prevents: Option<bool>,
    robustness: Record<Number>,
    /// The reason why the verdict of the run is `invalid` or `error`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl Rerun {
    /// Compares a failing trial with the trial of the same test with a reference driver.
    fn new(failing: &Trial, trial: &Trial) -> Self {
        let robustness = trial.requirements().map(|id| (id.to_owned(), Number(trial.robustness(id))));
        Self {
            verdict: trial.verdict,
            prevents: trial.prevents(failing),
            robustness: robustness.collect(),
            error: trial.error().map(str::to_owned),
        }
    }

    /// Returns the robustness of a requirement in the requirement's unit; `None` if the requirement was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.robustness.get(requirement).and_then(|number| number.0)
    }
}

impl Blamed {
    /// Judges a failing trial from the trials of the same test with each of the reference drivers.
    fn new(failing: &Trial, trials: impl Iterator<Item = (String, Trial)>) -> Self {
        let runs: Record<Rerun> = trials.map(|(name, trial)| (name, Rerun::new(failing, &trial))).collect();
        let prevented_by: Vec<String> =
            runs.iter().filter(|(_, run)| run.prevents == Some(true)).map(|(name, _)| name.to_owned()).collect();
        let fault = match &prevented_by {
            nobody if nobody.is_empty() && runs.iter().any(|(_, run)| run.prevents.is_none()) => {
                Preventability::Unknown
            }
            nobody if nobody.is_empty() => Preventability::Unpreventable,
            them if them.iter().any(|name| name == NEVER_BRAKES) => Preventability::Induced,
            _ => Preventability::Preventable,
        };
        let violates = failing.violated().map(str::to_owned).collect();
        Self { index: failing.index, test: failing.test.clone(), violates, fault, prevented_by, runs }
    }

    /// Returns a sentence that says which reference drivers prevent the failure.
    pub fn sentence(&self) -> String {
        let (them, verb) =
            (self.prevented_by.join(", "), if self.prevented_by.len() == 1 { "prevents" } else { "prevent" });
        let all = || self.runs.iter().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
        match self.fault {
            Preventability::Unpreventable => format!("unpreventable: none of {} prevents this failure", all()),
            Preventability::Preventable => format!("preventable: {them} {verb} this failure by braking"),
            Preventability::Induced => {
                format!(
                    "induced: {them} {verb} this failure, and {NEVER_BRAKES} never brakes for others: braking has caused it"
                )
            }
            Preventability::Unknown => format!(
                "unknown: none of {} is known to prevent this failure, and a run with one of them broke or could not be built",
                all()
            ),
        }
    }
}

/// In JSON, the number of failures of each kind and the number that each driver prevents come first.
impl Serialize for Blame {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Written<'a> {
            faults: Record<usize>,
            prevents: Record<usize>,
            references: &'a [String],
            tests: usize,
            failures: &'a [Blamed],
        }
        let Self { references, tests, failures } = self;
        let faults = Preventability::ALL.map(|fault| (fault.to_string(), self.count(fault))).into_iter().collect();
        let prevents = references.iter().map(|name| (name.clone(), self.prevented_by(name))).collect();
        Written { faults, prevents, references, tests: *tests, failures }.serialize(serializer)
    }
}

impl JsonArtefact for Blame {
    const FILE: &'static str = "blame.json";
}

impl Blame {
    /// Returns the failing test with the given index; `None` if no failing test has the index.
    pub fn of(&self, index: usize) -> Option<&Blamed> {
        let position = self.failures.binary_search_by_key(&index, |failure| failure.index).ok()?;
        Some(&self.failures[position])
    }

    /// Returns the number of failures with this judgement.
    pub fn count(&self, fault: Preventability) -> usize {
        self.failures.iter().filter(|failure| failure.fault == fault).count()
    }

    /// Returns the number of failures that a reference driver prevents.
    pub fn prevented_by(&self, reference: &str) -> usize {
        self.failures.iter().filter(|failure| failure.prevented_by.iter().any(|name| name == reference)).count()
    }
}

#[cfg(test)]
mod tests;
