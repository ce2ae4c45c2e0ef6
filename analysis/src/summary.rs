//! Summarises a campaign in a few numbers: the counts of verdicts, the results of each requirement, and the worst
//! test.

use paracosm_campaign::{Scales, Trial};
use paracosm_oracles::Verdict;

/// A summary of the trials so far, with the counts of verdicts and the results of each requirement.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    counts: [usize; Verdict::ALL.len()],
    requirements: Vec<Judged>,
}

/// The worst trial, which violates a requirement most or is nearest to a violation.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// The index of the worst trial.
    pub index: usize,
    /// The id of the requirement that the worst trial violates most or is nearest to violating.
    pub requirement: String,
}

/// The results of a requirement over the trials so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The id of the requirement to which the results belong.
    pub id: String,
    /// The number of trials that violate the requirement.
    pub violated: usize,
    /// The number of trials that did not break but left the requirement undecided.
    pub undecided: usize,
    /// The least robustness, in the requirement's unit, with the index of the first trial that has it.
    pub worst: Option<(f64, usize)>,
}

impl Summary {
    /// Adds a trial to the summary.
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

    /// Returns the number of tests with the given verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.counts[verdict as usize]
    }

    /// Returns the number of all tests in the summary.
    pub fn tests(&self) -> usize {
        self.counts.iter().sum()
    }

    /// Returns the worst trial by the given scales of robustness; among equally bad trials the first trial.
    pub fn worst(&self, scales: &Scales) -> Option<Worst> {
        let worst = self.requirements.iter().filter_map(|judged| {
            let (robustness, index) = judged.worst?;
            Some((scales.normalised(&judged.id, robustness), index, judged))
        });
        let (_, index, judged) = worst.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        Some(Worst { index, requirement: judged.id.clone() })
    }

    /// Returns the results of each requirement, in the order in which the requirements were first judged.
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
