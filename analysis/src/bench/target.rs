//! Defines the targets on which strategies are tried: the subject of a study, or a function whose failures are known.

use super::Bench;
use paracosm_campaign::{Error, Learned, Sampling, Study, StudyFile};
use paracosm_generators::functions::Function;
use paracosm_generators::{Generator, Request, Strategy};
use paracosm_space::Space;
use serde_json::{Value, json};

/// A target on which strategies are tried, which is the scenario or system of a study, or a function with known
/// failures.
#[derive(Debug, Clone)]
pub struct Target {
    name: String,
    pub(super) kind: TargetKind,
}

#[derive(Debug, Clone)]
pub(super) enum TargetKind {
    /// The study, whose strategy is replaced by the strategy of the run.
    Study(Box<Study>),
    Function(Function),
}

impl Target {
    /// Makes a target with the given name from the scenario or system of a study.
    pub fn study(name: impl Into<String>, study: Study) -> Self {
        Self { name: name.into(), kind: TargetKind::Study(Box::new(study)) }
    }

    /// Makes a target from a function whose failures are known. Each seed puts the failure of the function at another
    /// place.
    pub fn function(function: Function) -> Self {
        Self { name: function.name.to_string(), kind: TargetKind::Function(function) }
    }

    /// Returns the name of the target.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the name of the target in a form that can be part of a file name. The name may be a command with any
    /// characters; all but ASCII letters, digits and `+-_.:=` become `_`.
    pub fn file_name(&self) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || "+-_.:=".contains(c) { c } else { '_' };
        self.name.chars().map(plain).collect()
    }

    /// Returns the study of the target; `None` if the target is a function. A function has no reference map either.
    pub fn as_study(&self) -> Option<&Study> {
        match &self.kind {
            TargetKind::Study(study) => Some(study),
            TargetKind::Function(_) => None,
        }
    }

    /// Returns the space of the target's tests.
    pub fn space(&self) -> Space {
        match &self.kind {
            TargetKind::Study(study) => study.space().clone(),
            TargetKind::Function(function) => function.space(),
        }
    }

    /// Returns a description that identifies the target.
    pub(super) fn description(&self) -> Value {
        match &self.kind {
            TargetKind::Study(study) => {
                json!({"name": self.name, "study": StudyFile::new(study, &Learned::new(), None)})
            }
            TargetKind::Function(function) => json!({"name": self.name, "function": function.about}),
        }
    }

    /// Checks that a strategy can make tests of the target, with every seed of the bench if the strategy consists of given sets.
    pub(super) fn check(&self, strategy: Strategy, bench: &Bench) -> Result<(), Error> {
        let seeds = if strategy.given().is_some() { bench.seeds as u64 } else { 1 };
        (0..seeds).map(|i| bench.first_seed + i).try_for_each(|seed| match &self.kind {
            TargetKind::Study(study) => {
                let study = study_of(study, strategy, seed, bench)?;
                Ok(study.independent_generator().map(drop)?)
            }
            TargetKind::Function(function) => generator_of(function, strategy, seed, bench).map(drop),
        })
    }
}

/// Returns a copy of the study whose tests a strategy chooses.
pub(super) fn study_of(study: &Study, strategy: Strategy, seed: u64, bench: &Bench) -> Result<Study, Error> {
    let &Bench { budget, batch, .. } = bench;
    let sampling = study.sampling().clone();
    Ok(study.sampled(Sampling { strategy, budget, seed: Some(seed), batch: Some(batch), ..sampling })?)
}

/// Makes a generator of tests of a function.
pub(super) fn generator_of(
    function: &Function,
    strategy: Strategy,
    seed: u64,
    bench: &Bench,
) -> Result<Box<dyn Generator>, Error> {
    let space = function.space();
    Ok(strategy.build_independent(&Request { seed: Some(seed), ..Request::new(&space, bench.budget) })?)
}
