//! A crew runs tests elsewhere: in other processes, or on other machines.
//!
//! A campaign asks the strategy, and shows the trials to its observers in the order of their indices; the crew only runs tests. So the results do not
//! depend on the crew.

use crate::supervision::Supervision;
use crate::{Error, Reason, Trial};
use paracosm_space::Values;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::atomic::Ordering;
use thiserror::Error;

/// Something that runs the tests of a study in place of the threads of a campaign.
pub trait Crew: fmt::Debug + Send + Sync {
    /// Runs tests. The first test has the index `first`. Calls `take` with the trial of each test, in any order, and adds the errors that did not
    /// repeat to the doubts of the supervision. Once its `stop` is set, the crew returns soon, and the remaining tests have no trial.
    ///
    /// # Errors
    /// The tests cannot be run.
    fn run(
        &self,
        first: usize,
        tests: &[Values],
        supervision: &Supervision,
        take: &mut dyn FnMut(Trial),
    ) -> Result<(), Error>;
}

/// The error that a crew returned other trials than it was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CrewFlaw {
    /// The trial is no trial of a test that the crew should run.
    #[error("the executor returned a trial of test {index} that does not belong to the campaign")]
    Foreign {
        /// The index of the trial.
        index: usize,
    },
    /// The crew ended without the trial of a test.
    #[error("the executor returned no trial of test {index}")]
    Missing {
        /// The index of the test.
        index: usize,
    },
}

impl Reason for CrewFlaw {}

/// Lets a crew run tests, and calls `sink` with the trials in the order of their indices. An error of `sink` stops the crew.
pub(crate) fn in_order_by(
    crew: &dyn Crew,
    first: usize,
    tests: &[Values],
    supervision: &Supervision,
    mut sink: impl FnMut(Trial) -> Result<(), Option<Error>>,
) -> Result<(), Option<Error>> {
    let mut waiting = BTreeMap::new();
    let mut due = 0;
    let mut end = Ok(());
    let mut take = |trial: Trial| {
        if end.is_err() {
            return;
        }
        let index = trial.index;
        let at = index.checked_sub(first).filter(|at| *at >= due && !waiting.contains_key(at));
        match at.filter(|at| tests.get(*at) == Some(&trial.test)) {
            Some(at) => drop(waiting.insert(at, trial)),
            None => end = Err(Some(CrewFlaw::Foreign { index }.into())),
        }
        while end.is_ok()
            && let Some(trial) = waiting.remove(&due)
        {
            due += 1;
            end = sink(trial);
        }
        if end.is_err() {
            supervision.stop.store(true, Ordering::Relaxed);
        }
    };
    let ran = crew.run(first, tests, supervision, &mut take);
    end?;
    ran.map_err(Some)?;
    if due < tests.len() && !supervision.stop.load(Ordering::Relaxed) {
        return Err(Some(CrewFlaw::Missing { index: first + due }.into()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Campaign, Catalogue, Log, Study};
    use std::sync::{Arc, Mutex};

    /// A crew that answers with recorded trials, changed and in another order.
    struct Recorded {
        log: Vec<Trial>,
        change: fn(Vec<Trial>) -> Vec<Trial>,
        asked: Mutex<Vec<usize>>,
    }

    impl fmt::Debug for Recorded {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("Recorded")
        }
    }

    impl Crew for Recorded {
        fn run(
            &self,
            first: usize,
            tests: &[Values],
            supervision: &Supervision,
            take: &mut dyn FnMut(Trial),
        ) -> Result<(), Error> {
            self.asked.lock().unwrap().push(tests.len());
            for trial in (self.change)(self.log[first..first + tests.len()].to_vec()) {
                if supervision.stop.load(Ordering::Relaxed) {
                    break;
                }
                // As it travels from another machine.
                take(Trial::of_line(&trial.as_line()).unwrap());
            }
            Ok(())
        }
    }

    fn study() -> Study {
        let catalogue = Catalogue::of(paracosm_scenarios::ALL);
        Study::of(catalogue.find("pedestrian-crossing").unwrap())
            .strategy("cmaes".parse().unwrap())
            .budget(40)
            .build()
            .unwrap()
    }

    fn with(study: &Study, change: fn(Vec<Trial>) -> Vec<Trial>) -> (Result<Log, Error>, Arc<Recorded>) {
        let log = Campaign::new(study).unwrap().into_log().unwrap().trials().to_vec();
        let crew = Arc::new(Recorded { log, change, asked: Mutex::default() });
        (Campaign::new(study).unwrap().with_crew(crew.clone()).into_log(), crew)
    }

    #[test]
    fn the_trials_of_a_crew_count_in_the_order_of_their_indices() {
        let study = study();
        let (log, crew) = with(&study, |trials| trials.into_iter().rev().collect());
        assert!(log.unwrap().trials() == crew.log);
        assert!(crew.asked.lock().unwrap().len() > 1, "the strategy is adaptive");
    }

    #[test]
    fn a_trial_that_nobody_asked_for_ends_the_campaign() {
        let study = study();
        let twice = |trials: Vec<Trial>| vec![trials[0].clone(), trials[0].clone()];
        let other = |mut trials: Vec<Trial>| {
            trials[0].test = trials[1].test.clone();
            trials
        };
        for change in [twice, other] {
            let error = with(&study, change).0.unwrap_err().to_string();
            assert_eq!(error, "the executor returned a trial of test 0 that does not belong to the campaign");
        }
        let error = with(&study, |trials| trials[1..].to_vec()).0.unwrap_err().to_string();
        assert_eq!(error, "the executor returned no trial of test 0");
    }
}
