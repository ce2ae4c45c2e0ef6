//! A campaign in a few numbers: how many tests ended how, what became of each requirement, and which test was the worst.

use paracosm_campaign::{Scales, Trial};
use paracosm_oracles::Verdict;

/// Counts of verdicts and the worst trial so far.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    counts: [usize; 5],
    requirements: Vec<Judged>,
}

/// The trial that violates a requirement most, or comes nearest to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// The trial's index.
    pub index: usize,
    /// The requirement.
    pub requirement: String,
}

/// What became of a requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The requirement.
    pub id: String,
    /// How many trials violate it.
    pub violated: usize,
    /// In how many trials nothing broke, but it was left undecided.
    pub undecided: usize,
    /// The least robustness, in its unit, with the index of the first trial that has it.
    pub worst: Option<(f64, usize)>,
}

impl Summary {
    /// Takes a trial into account.
    pub fn add(&mut self, trial: &Trial) {
        self.counts[trial.verdict as usize] += 1;
        for id in trial.requirements().filter(|_| trial.covers()) {
            self.judged(id).add(trial);
        }
    }

    fn judged(&mut self, id: &str) -> &mut Judged {
        let known = self.requirements.iter().position(|judged| judged.id == id);
        let position = known.unwrap_or_else(|| {
            self.requirements.push(Judged { id: id.to_owned(), violated: 0, undecided: 0, worst: None });
            self.requirements.len() - 1
        });
        &mut self.requirements[position]
    }

    /// How many tests ended so.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.counts[verdict as usize]
    }

    /// How many tests there are.
    pub fn tests(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The worst trial by these scales: the first among equals.
    pub fn worst(&self, scales: &Scales) -> Option<Worst> {
        let worst = self.requirements.iter().filter_map(|judged| {
            let (robustness, index) = judged.worst?;
            Some((scales.normalised(&judged.id, robustness), index, judged))
        });
        let (_, index, judged) = worst.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        Some(Worst { index, requirement: judged.id.clone() })
    }

    /// What became of each requirement, in the order in which they were first judged.
    pub fn requirements(&self) -> &[Judged] {
        &self.requirements
    }
}

impl Judged {
    fn add(&mut self, trial: &Trial) {
        self.violated += usize::from(trial.violates(&self.id));
        match trial.robustness(&self.id) {
            None => self.undecided += 1,
            Some(robustness) if self.worst.is_none_or(|(worst, _)| robustness < worst) => {
                self.worst = Some((robustness, trial.index));
            }
            Some(_) => {}
        }
    }
}
