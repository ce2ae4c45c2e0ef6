//! A campaign in a few numbers: how many tests ended how, and which was the worst.

use crate::{Study, Trial};
use paracosm_oracles::Verdict;

/// Counts of verdicts and the worst trial so far.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    counts: [usize; 5],
    worst: Option<Worst>,
}

/// The trial that violates a requirement most, or comes nearest to it.
#[derive(Debug, Clone)]
pub struct Worst {
    /// The trial's index.
    pub index: usize,
    /// The requirement.
    pub requirement: String,
    /// Its robustness in multiples of its scale.
    normalised: f64,
}

impl Summary {
    /// Takes a trial into account.
    pub fn add(&mut self, study: &Study, trial: &Trial) {
        self.counts[trial.verdict as usize] += 1;
        if let Some((requirement, normalised)) = study.worst(trial)
            && self.worst.as_ref().is_none_or(|worst| normalised < worst.normalised)
        {
            self.worst = Some(Worst { index: trial.index, requirement: requirement.to_owned(), normalised });
        }
    }

    /// How many tests ended so.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.counts[verdict as usize]
    }

    /// How many tests there are.
    pub fn tests(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The worst trial: the first among equals.
    pub fn worst(&self) -> Option<&Worst> {
        self.worst.as_ref()
    }
}
