//! Whose fault a failure is: every failing test once more, with drivers at the wheel whose behaviour is known.
//!
//! A driver *prevents* a failure if in its run of the same test every requirement that was violated holds, and none that
//! the driver under test had kept is violated instead: to stand still for ever prevents no collision behind the place that
//! the car was to reach. What was undecided, as a contact had ended the run, is held against nobody. Of a run that broke, or
//! that could not be built, nothing is known: a failure that nobody else prevents is then not judged.
//!
//! A failure that no reference prevents is *unpreventable by these drivers*, and no more is said. They brake and do
//! nothing else: none of them steers around anybody, or drives slower where somebody might come. For what can be done by
//! braking `ideal` has a proof, of one other road user whose future is known
//! ([`engine::driver::reference`](paracosm_engine::driver::reference)). In a simulated car it is told the truth but not the
//! future, and sees no more than can be seen.

mod inquiry;

pub use inquiry::{Inquiry, InquiryFlaw};

use paracosm_campaign::{JsonArtefact, Number, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{Record, Values};
use serde::{Serialize, Serializer};
use std::fmt;

/// Who failures are judged by where nothing else is said.
pub const REFERENCES: [&str; 5] = ["ideal", "cc", "rss", "fsm", "cruise"];

/// The driver that never brakes for others: what it prevents was braking's doing.
const NEVER_BRAKES: &str = "cruise";

/// Whose fault a failure is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Preventability {
    /// No reference prevents it.
    Unpreventable,
    /// A reference that brakes prevents it.
    Preventable,
    /// `cruise` prevents it, who never brakes: it would not have happened without braking.
    Induced,
    /// No reference is known to prevent it, and a run with one of them broke or could not be built: not judged.
    Unknown,
}

impl Preventability {
    /// All there are.
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

/// The failing tests of a campaign with whose fault they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Blame {
    /// The names of the drivers that they are judged by.
    pub references: Vec<String>,
    /// How many tests there are, failing or not.
    pub tests: usize,
    /// The failing ones, in the order of their indices.
    pub failures: Vec<Blamed>,
}

/// A failing test with whose fault it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Blamed {
    /// The index of the test in its campaign.
    pub index: usize,
    /// Its values.
    pub test: Values,
    /// What it violates.
    pub violates: Vec<String>,
    /// Whose fault that is.
    pub fault: Preventability,
    /// The references that prevent it.
    pub prevented_by: Vec<String>,
    /// What became of the test with each of the references.
    pub runs: Record<Rerun>,
}

/// What became of a failing test with another driver.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rerun {
    /// How it ended.
    pub verdict: Verdict,
    /// Whether the failure was prevented; `None` where the run broke or could not be built.
    pub prevents: Option<bool>,
    robustness: Record<Number>,
    /// Why the verdict is `invalid` or `error`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl Rerun {
    /// A failing trial beside the one of the same test with another driver.
    fn new(failing: &Trial, trial: &Trial) -> Self {
        let robustness = trial.requirements().map(|id| (id.to_owned(), Number(trial.robustness(id))));
        Self {
            verdict: trial.verdict,
            prevents: prevents(failing, trial),
            robustness: robustness.collect(),
            error: trial.error().map(str::to_owned),
        }
    }

    /// The robustness of a requirement in its unit; `None` where it was not decided.
    pub fn robustness(&self, requirement: &str) -> Option<f64> {
        self.robustness.get(requirement).and_then(|number| number.0)
    }
}

/// Whether a failure is prevented by the driver that ended so; `None` where its run judged nothing.
fn prevents(failing: &Trial, trial: &Trial) -> Option<bool> {
    let decided = |trial: &Trial, id: &str| trial.robustness(id).is_some();
    let holds = |trial: &Trial, id: &str| decided(trial, id) && !trial.violates(id);
    trial
        .covers()
        .then(|| failing.violated().all(|id| holds(trial, id)) && !trial.violated().any(|id| holds(failing, id)))
}

impl Blamed {
    /// A failing trial with what became of it with each of the references.
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
}

/// How many failures are whose fault, and how many each of the drivers prevents, go before the rest.
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
    /// The failing test of that index.
    pub fn of(&self, index: usize) -> Option<&Blamed> {
        let position = self.failures.binary_search_by_key(&index, |failure| failure.index).ok()?;
        Some(&self.failures[position])
    }

    /// How many failures are of this kind.
    pub fn count(&self, fault: Preventability) -> usize {
        self.failures.iter().filter(|failure| failure.fault == fault).count()
    }

    /// How many failures a reference prevents.
    pub fn prevented_by(&self, reference: &str) -> usize {
        self.failures.iter().filter(|failure| failure.prevented_by.iter().any(|name| name == reference)).count()
    }
}

#[cfg(test)]
mod tests;
