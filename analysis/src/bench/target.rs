//! What strategies are tried on: a study's subject, or a function whose failures are known.

use super::Bench;
use paracosm_campaign::{Error, Learned, Sampling, Study, StudyFile};
use paracosm_generators::functions::Function;
use paracosm_generators::{Generator, Request, Strategy};
use paracosm_space::Space;
use serde_json::{Value, json};

/// What strategies are tried on.
#[derive(Debug, Clone)]
pub struct Target {
    name: String,
    pub(super) kind: TargetKind,
}

#[derive(Debug, Clone)]
pub(super) enum TargetKind {
    /// All but how tests are chosen is taken from it.
    Study(Box<Study>),
    Function(Function),
}

impl Target {
    /// The subject of a study, under a name.
    pub fn study(name: impl Into<String>, study: Study) -> Self {
        Self { name: name.into(), kind: TargetKind::Study(Box::new(study)) }
    }

    /// A function, each seed of which puts the failure elsewhere.
    pub fn function(function: Function) -> Self {
        Self { name: function.name.to_owned(), kind: TargetKind::Function(function) }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its name as part of that of a file: a command may have anything in it.
    pub fn file_name(&self) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || "+-_.:=".contains(c) { c } else { '_' };
        self.name.chars().map(plain).collect()
    }

    /// Its study; a function has none, and so no reference map either.
    pub fn as_study(&self) -> Option<&Study> {
        match &self.kind {
            TargetKind::Study(study) => Some(study),
            TargetKind::Function(_) => None,
        }
    }

    /// The space of its tests.
    pub(super) fn space(&self) -> Space {
        match &self.kind {
            TargetKind::Study(study) => study.space().clone(),
            TargetKind::Function(function) => function.space(),
        }
    }

    /// What says which target it is.
    pub(super) fn description(&self) -> Value {
        match &self.kind {
            TargetKind::Study(study) => {
                json!({"name": self.name, "study": StudyFile::new(study, &Learned::new(), None)})
            }
            TargetKind::Function(function) => json!({"name": self.name, "function": function.about}),
        }
    }

    /// Checks that a strategy can make its tests.
    pub(super) fn check(&self, strategy: Strategy, bench: &Bench) -> Result<(), Error> {
        match &self.kind {
            TargetKind::Study(study) => {
                let study = study_of(study, strategy, bench.first_seed, bench)?;
                Ok(study.independent_generator().map(drop)?)
            }
            TargetKind::Function(function) => generator_of(*function, strategy, bench.first_seed, bench).map(drop),
        }
    }
}

/// A study whose tests a strategy chooses.
pub(super) fn study_of(study: &Study, strategy: Strategy, seed: u64, bench: &Bench) -> Result<Study, Error> {
    let &Bench { budget, batch, .. } = bench;
    let sampling = study.sampling().clone();
    Ok(study.sampled(Sampling { strategy, budget, seed: Some(seed), batch: Some(batch), ..sampling })?)
}

/// A generator of tests of a function.
pub(super) fn generator_of(
    function: Function,
    strategy: Strategy,
    seed: u64,
    bench: &Bench,
) -> Result<Box<dyn Generator>, Error> {
    let space = function.space();
    Ok(strategy.build_independent(&Request { seed: Some(seed), ..Request::new(&space, bench.budget) })?)
}
