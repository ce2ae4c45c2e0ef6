//! The loop: ask for tests, run them on all cores, show each trial in order, tell how it went.
//!
//! The campaign itself writes and prints nothing: the log, the progress bar and the summary watch it. A test
//! that panics is a trial with the verdict `error`; the campaign goes on.

use crate::executor::{in_order, pool};
use crate::{Error, Study, Trial};
use paracosm_coverage::Values;
use paracosm_engine::driver::Driver;
use paracosm_engine::{Outcome, Program, Run, Test, watch};
use paracosm_oracles::{Trace, Verdict};
use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::available_parallelism;

/// How many tests are asked for at a time, where it does not matter to the strategy: enough to keep many cores busy, few enough to keep in memory.
const BATCH: usize = 4096;

/// A study being run.
pub struct Campaign<'a> {
    study: &'a Study,
    program: Program,
    jobs: NonZeroUsize,
    known: Vec<Trial>,
}

impl<'a> Campaign<'a> {
    /// A campaign on all cores.
    ///
    /// # Errors
    /// The study cannot be run: its scenario, driver or strategy does not exist or cannot do what is asked.
    pub fn new(study: &'a Study) -> Result<Self, Error> {
        study.generator()?;
        study.driver.build()?;
        let jobs = available_parallelism().unwrap_or(NonZeroUsize::MIN);
        Ok(Self { study, program: study.program()?, jobs, known: Vec::new() })
    }

    /// Runs this many tests at a time. Results do not depend on it.
    pub fn jobs(mut self, jobs: NonZeroUsize) -> Self {
        self.jobs = jobs;
        self
    }

    /// Takes the first trials as known rather than running them.
    pub fn resume(mut self, known: Vec<Trial>) -> Self {
        self.known = known;
        self
    }

    /// Runs what is not known yet; `watch` sees every new trial in order, and its first error ends the campaign.
    ///
    /// # Errors
    /// That of `watch`, or a known trial that is not of this campaign.
    pub fn run(self, mut watch: impl FnMut(&Trial) -> Result<(), Error>) -> Result<(), Error> {
        let study = self.study;
        let mut generator = study.generator()?;
        let mut done = 0;
        while done < study.budget {
            let points = generator.ask(study.batch_size().unwrap_or(BATCH).min(study.budget - done));
            if points.is_empty() {
                break;
            }
            let tests: Vec<Values> = points.iter().map(|point| study.space.decode(point)).collect();
            let known = self.known.get(done..).unwrap_or_default();
            if let Some((trial, _)) = known.iter().zip(&tests).find(|(trial, test)| trial.test != **test) {
                return Err(foreign(trial));
            }
            let mut robustness: Vec<_> = known.iter().take(tests.len()).map(|trial| study.objective(trial)).collect();
            let begun = robustness.len();
            self.run_tests(&tests[begun..], done + begun, |trial| {
                robustness.push(study.objective(trial));
                watch(trial)
            })?;
            generator.tell(&points, &robustness);
            done += points.len();
        }
        self.known.get(done).map_or(Ok(()), |trial| Err(foreign(trial)))
    }

    /// Runs these tests instead of those that the strategy proposes; the first one gets the index `first`.
    ///
    /// # Errors
    /// That of `watch`.
    pub fn run_tests(
        &self,
        tests: &[Values],
        first: usize,
        mut watch: impl FnMut(&Trial) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let new_driver = || self.study.driver.build().expect("it was built before");
        let work = |driver: &mut Box<dyn Driver>, i: usize| {
            let (trial, _) = simulate_trial(&self.program, self.study, driver.as_mut(), first + i, &tests[i]);
            if trial.verdict == Verdict::Error {
                // What broke may have left the driver in any state.
                *driver = new_driver();
            }
            trial
        };
        let pool = pool(self.jobs.get().min(tests.len()).max(1))?;
        in_order(&pool, 0..tests.len(), new_driver, work, |trial| watch(&trial))
    }
}

fn foreign(trial: &Trial) -> Error {
    Error::Usage(format!(
        "trial {} of the log is not the test that this study proposes there; was the log edited?",
        trial.index
    ))
}

/// Runs one test of a study: what a campaign does with each, and a replay with one.
pub fn simulate_trial(
    program: &Program,
    study: &Study,
    driver: &mut dyn Driver,
    index: usize,
    test: &Values,
) -> (Trial, Option<Trace>) {
    watch_trial(program, study, driver, index, test, |_| ())
}

/// [`simulate_trial`], with a look at the run whenever the driver is asked, and at the end.
pub fn watch_trial(
    program: &Program,
    study: &Study,
    driver: &mut dyn Driver,
    index: usize,
    test: &Values,
    see: impl FnMut(&Run),
) -> (Trial, Option<Trace>) {
    let values = study.complete(test);
    let run = AssertUnwindSafe(|| watch(program, Test::new(&values, &study.space), study.vehicle, driver, see));
    let mut outcome = catch_unwind(run).unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str);
        let message = message.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Outcome::broken(Verdict::Error, format!("the run panicked: {message}"))
    });
    let trace = outcome.trace.take();
    (Trial::new(index, test.clone(), outcome, trace.as_ref()), trace)
}
