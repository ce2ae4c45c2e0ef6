//! Runs failing tests with the reference drivers. All pairs of a test and a driver share the cores.

use super::{Blame, Blamed};
use paracosm_campaign::darkroom::Darkroom;
use paracosm_campaign::executor::{in_order, pool};
use paracosm_campaign::{Error, Log, Reason, Study, Subject, Supervision, Trial, Worker};
use paracosm_oracles::Verdict;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::available_parallelism;
use thiserror::Error;

/// The reference drivers that judge the failures of a study, with the settings for their runs.
pub struct Inquiry {
    references: Vec<Reference>,
    jobs: NonZeroUsize,
    stop: Arc<AtomicBool>,
}

/// A driver that judges failures.
struct Reference {
    name: String,
    /// The study with the reference driver in place of the study's own driver.
    study: Study,
    /// The renderer of the driver's images, shared by all threads, if the driver uses images.
    darkroom: Option<Arc<Darkroom>>,
}

/// A reason why the failures of a study cannot be judged.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum InquiryFlaw {
    /// The campaign tests a system, which a reference driver cannot replace.
    #[error(
        "the campaign tests the system `{command}`, which a reference driver cannot replace: blame is judged for \
         failures in scenarios only"
    )]
    System {
        /// The command that starts the system under test.
        command: String,
    },
    /// A perceiver is on trial, which a reference driver cannot replace.
    #[error(
        "the campaign tests the perceiver `{name}`, which a reference driver cannot replace: blame is judged for \
         failures of drivers only"
    )]
    Perceiver {
        /// The name of the perceiver.
        name: String,
    },
    /// No reference driver is named.
    #[error("no reference driver is named, expected at least one")]
    NoDriver,
    /// A reference driver is named twice.
    #[error("driver `{name}` is named twice, expected once")]
    Twice {
        /// The name of the driver that is named twice.
        name: String,
    },
    /// The test did not fail.
    #[error("test {index} has the verdict `{verdict}`, expected a failing test: there is nothing to prevent")]
    NoFailure {
        /// The index of the test in its campaign.
        index: usize,
        /// The verdict of the test.
        verdict: Verdict,
    },
}

impl Reason for InquiryFlaw {}

impl Reference {
    fn new(study: &Study, name: &str) -> Result<Self, Error> {
        let study = study.driven_by(name, &[])?;
        let darkroom = Worker::new(&study)?.darkroom().cloned();
        Ok(Self { name: name.to_owned(), study, darkroom })
    }

    fn worker(&self) -> Worker<'_> {
        let worker = Worker::beside(&self.study, Supervision::default(), self.darkroom.clone());
        worker.expect("one like it was made before")
    }
}

impl Inquiry {
    /// Makes an inquiry that uses all cores, with these reference drivers in their standard settings.
    ///
    /// # Errors
    /// The study tests a system or a perceiver, which has no driver to replace; or the scenario or a driver does not exist; or no
    /// driver is named, or a driver is named twice.
    pub fn new(study: &Study, references: &[&str]) -> Result<Self, Error> {
        if let Subject::System(system) = study.subject() {
            return Err(InquiryFlaw::System { command: system.command.clone() }.into());
        }
        if let Some(perceiver) = study.perceiver() {
            return Err(InquiryFlaw::Perceiver { name: perceiver.name().to_owned() }.into());
        }
        if references.is_empty() {
            return Err(InquiryFlaw::NoDriver.into());
        }
        if let Some((_, name)) = references.iter().enumerate().find(|(i, name)| references[..*i].contains(name)) {
            return Err(InquiryFlaw::Twice { name: (*name).to_owned() }.into());
        }
        let references = references.iter().map(|name| Reference::new(study, name)).collect::<Result<_, _>>()?;
        let jobs = available_parallelism().unwrap_or(NonZeroUsize::MIN);
        Ok(Self { references, jobs, stop: Arc::default() })
    }

    /// Sets the number of tests that run at the same time. Results do not depend on it.
    pub fn jobs(mut self, jobs: NonZeroUsize) -> Self {
        self.jobs = jobs;
        self
    }

    /// Sets a flag that, once it is set, ends the inquiry with [`Error::Interrupted`].
    pub fn until(mut self, stop: Arc<AtomicBool>) -> Self {
        self.stop = stop;
        self
    }

    /// Runs every failing test of a campaign with each of the reference drivers. `watch` receives the results in
    /// order.
    ///
    /// # Errors
    /// The inquiry was stopped. Or the first failing test has another trace than in the log, so that the reference drivers would drive in
    /// another world; this is not asked of a driver in a process of its own, or of a log of another version of the software.
    pub fn run(&self, log: &Log, mut watch: impl FnMut(&Blamed)) -> Result<Blame, Error> {
        let failing: Vec<&Trial> = log.trials().iter().filter(|trial| trial.is_failure()).collect();
        let study = log.study();
        let is_sure = study.repeats_in_process() && study.is_of_this_software();
        if let Some(first) = failing.first().filter(|_| is_sure) {
            Worker::new(study)?.check_repeats(log, first)?;
        }
        let failures = self.judge(&failing, &mut watch)?;
        let references = self.references.iter().map(|reference| reference.name.clone()).collect();
        Ok(Blame { references, tests: log.trials().len(), failures })
    }

    /// Runs one failing test with each of the reference drivers.
    ///
    /// # Errors
    /// The test did not fail, or the inquiry was stopped.
    pub fn judge_one(&self, failing: &Trial) -> Result<Blamed, Error> {
        if !failing.is_failure() {
            return Err(InquiryFlaw::NoFailure { index: failing.index, verdict: failing.verdict }.into());
        }
        Ok(self.judge(&[failing], &mut |_| ())?.remove(0))
    }

    /// Runs failing tests with each of the reference drivers. `watch` receives the results in order.
    fn judge(&self, failing: &[&Trial], watch: &mut impl FnMut(&Blamed)) -> Result<Vec<Blamed>, Error> {
        let names = || self.references.iter().map(|reference| reference.name.clone());
        let hire = || -> Vec<Worker> { self.references.iter().map(Reference::worker).collect() };
        let drivers = self.references.len();
        let work = |workers: &mut Vec<Worker>, i: usize| {
            let failing = failing[i / drivers];
            let stopped = self.stop.load(Ordering::Relaxed);
            (!stopped).then(|| workers[i % drivers].run(failing.index, &failing.test).0)
        };
        let mut failures = Vec::new();
        let mut ran = Vec::new();
        let pairs = failing.len() * drivers;
        in_order(&pool(self.jobs.get().min(pairs).max(1))?, 0..pairs, hire, work, |trial| {
            ran.push(trial);
            if ran.len() == drivers {
                let blamed = Blamed::new(failing[failures.len()], names().zip(ran.drain(..)));
                watch(&blamed);
                failures.push(blamed);
            }
            Ok::<(), Error>(())
        })?;
        if failures.len() < failing.len() {
            return Err(Error::Interrupted);
        }
        Ok(failures)
    }
}
