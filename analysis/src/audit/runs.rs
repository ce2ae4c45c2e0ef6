//! Runs the tests of an audit, with the driver of the study or with a driver that has a defect.

use super::AuditFlaw;
use super::kept::{Kept, Key};
use paracosm_campaign::darkroom::Darkroom;
use paracosm_campaign::executor::{in_order, pool};
use paracosm_campaign::{Error, Study, Subject, Supervision, Trial, Worker};
use paracosm_mutants::Defect;
use paracosm_oracles::Verdict;
use paracosm_space::Values;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::available_parallelism;

/// The means by which the tests of an audit are run.
#[derive(Debug, Clone)]
pub struct Runs {
    /// The number of tests that run at a time. Results do not depend on it.
    pub jobs: NonZeroUsize,
    /// The flag that, once set, ends the audit with [`Error::Interrupted`].
    pub stop: Arc<AtomicBool>,
    /// The results that are kept; `None` if each run is made.
    pub kept: Option<Arc<Kept>>,
}

impl Default for Runs {
    /// Uses all cores, and keeps nothing.
    fn default() -> Self {
        Self { jobs: available_parallelism().unwrap_or(NonZeroUsize::MIN), stop: Arc::default(), kept: None }
    }
}

impl Runs {
    /// Runs tests of a study. Returns a trial for each test.
    pub(super) fn of(&self, study: &Study, tests: &[Values]) -> Result<Vec<Trial>, Error> {
        let seats = Seats::of(study)?;
        let run = |worker: &mut Worker, index: usize| worker.run(index, &tests[index]).0;
        self.each(tests.len(), || seats.worker(study), run)
    }

    /// Runs tests of a study, unless their trials are kept. Returns a trial for each test.
    pub(super) fn given(&self, study: &Study, tests: &[Values]) -> Result<Vec<Trial>, Error> {
        let Some(kept) = &self.kept else { return self.of(study, tests) };
        let (seats, key) = (Seats::of(study)?, Key::new("given", study));
        let run = |worker: &mut Worker, index: usize| {
            let mut trial: Trial = kept.or(
                &key,
                &tests[index],
                // A graphics adapter that failed may work at the next try.
                |trial: &Trial| trial.verdict != Verdict::Error,
                || Ok(worker.run(index, &tests[index]).0),
            )?;
            // The test may have stood elsewhere when it ran.
            trial.index = index;
            Ok(trial)
        };
        self.each(tests.len(), || seats.worker(study), run)?.into_iter().collect()
    }

    /// Does a piece of work for every index, and returns the results in order. Each thread has a worker of its own.
    pub(super) fn each<W, T: Send>(
        &self,
        count: usize,
        hire: impl Fn() -> W + Sync,
        work: impl Fn(&mut W, usize) -> T + Sync,
    ) -> Result<Vec<T>, Error> {
        let mut done = Vec::new();
        self.each_into(0..count, hire, work, |result| {
            done.push(result);
            Ok(())
        })?;
        Ok(done)
    }

    /// Does a piece of work for every index of a range, and hands over the results in order.
    pub(super) fn each_into<W, T: Send>(
        &self,
        range: std::ops::Range<usize>,
        hire: impl Fn() -> W + Sync,
        work: impl Fn(&mut W, usize) -> T + Sync,
        mut sink: impl FnMut(T) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let expected = range.len();
        let mut done = 0;
        let unless_stopped = |worker: &mut W, index| {
            let result = (!self.is_stopped()).then(|| work(worker, index));
            // Work that was cut short has no result.
            result.filter(|_| !self.is_stopped())
        };
        in_order(&pool(self.jobs.get().min(expected).max(1))?, range, hire, unless_stopped, |result| {
            done += 1;
            sink(result)
        })?;
        self.kept.as_ref().map_or(Ok(()), |kept| kept.check())?;
        if done < expected { Err(Error::Interrupted) } else { Ok(()) }
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// The darkroom that the workers of a study share, if its driver uses images.
pub(super) struct Seats(Option<Arc<Darkroom>>);

impl Seats {
    /// Checks that tests of a study can be run.
    pub fn of(study: &Study) -> Result<Self, Error> {
        Ok(Self(Worker::new(study)?.darkroom().cloned()))
    }

    /// Returns a worker for the study, or for the same study with a driver that has a defect.
    pub fn worker<'s>(&self, study: &'s Study) -> Worker<'s> {
        Worker::beside(study, Supervision::default(), self.0.clone()).expect("one like it was made before")
    }
}

/// Checks that a study tests a driver that can have a defect.
pub(super) fn check(study: &Study) -> Result<(), AuditFlaw> {
    let simulation = match study.subject() {
        Subject::System(system) => return Err(AuditFlaw::System { command: system.command.clone() }),
        Subject::Scenario(simulation) => simulation,
    };
    if let Some(perceiver) = study.perceiver() {
        return Err(AuditFlaw::Perceiver { name: perceiver.name().to_owned() });
    }
    if simulation.driver().is_external() {
        return Err(AuditFlaw::External { driver: simulation.driver().name().to_owned() });
    }
    Ok(())
}

/// Returns a study whose driver has a defect.
///
/// # Errors
/// The study does not test a driver in this process.
pub(super) fn mutated(study: &Study, defect: Defect) -> Result<Study, Error> {
    let choice = study.subject().scenario()?.driver().clone();
    let name = format!("{} with {defect}", choice.name());
    study.driven_by_own(&name, move || defect.in_driver(choice.build().expect("one like it was built before")))
}

/// Returns the first requirement that a trial violates and that the driver of the study keeps in the same test; `None` if there is
/// none.
pub(super) fn gives_away<'t>(given: &Trial, trial: &'t Trial) -> Option<&'t str> {
    if !given.covers() || !trial.covers() {
        return None;
    }
    trial.violated().find(|id| !given.violates(id))
}
