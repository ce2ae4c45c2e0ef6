//! The loop: ask for tests, run them on all cores, show each trial in order, tell how it went.
//!
//! The campaign itself writes and prints nothing: the log, the progress bar and the summary watch it. A test
//! that panics is a trial with the verdict `error`; the campaign goes on.

use crate::darkroom::Darkroom;
use crate::executor::{Desk, from_desk, in_order, pool};
use crate::expected::Expected;
use crate::steering::Steering;
use crate::{Error, Study, Trial, Worker};
use paracosm_coverage::Values;
use paracosm_oracles::Verdict;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::available_parallelism;

/// How many tests are asked for at a time, where it does not matter to the strategy: enough to keep many cores busy, few enough to keep in memory.
const BATCH: usize = 4096;

/// How many tests run in lockstep, where their drivers see: enough for a graphics card to be worth its while, and so few
/// that their worlds and drivers fit in memory.
const AT_ONCE: NonZeroUsize = NonZeroUsize::new(32).expect("it is more than 0");

/// A study being run.
pub struct Campaign<'a> {
    study: &'a Study,
    jobs: NonZeroUsize,
    at_once: NonZeroUsize,
    /// What draws for the drivers, if they see.
    darkroom: Option<Arc<Darkroom>>,
    known: Vec<Trial>,
    stop: Arc<AtomicBool>,
    /// Workers keep what they have started from one batch of tests to the next.
    idle: Mutex<Vec<Worker<'a>>>,
}

impl<'a> Campaign<'a> {
    /// A campaign on all cores.
    ///
    /// # Errors
    /// The study cannot be run: its scenario, driver, system or strategy does not exist or cannot do what is asked; or its
    /// driver sees through cameras, and there is nothing to draw with.
    pub fn new(study: &'a Study) -> Result<Self, Error> {
        study.generator()?;
        let jobs = available_parallelism().unwrap_or(NonZeroUsize::MIN);
        let stop = Arc::default();
        let mut worker = Worker::until(study, Arc::clone(&stop))?;
        worker.start()?;
        let (darkroom, idle) = (worker.darkroom().cloned(), Mutex::new(vec![worker]));
        Ok(Self { study, jobs, at_once: AT_ONCE, darkroom, known: Vec::new(), stop, idle })
    }

    /// Runs tests on this many threads. Results do not depend on it.
    pub fn jobs(mut self, jobs: NonZeroUsize) -> Self {
        self.jobs = jobs;
        self
    }

    /// Runs this many tests in lockstep where their drivers see through cameras, so that all that they see is drawn at once;
    /// without it, 32. Results do not depend on it.
    pub fn at_once(mut self, tests: NonZeroUsize) -> Self {
        self.at_once = tests;
        self
    }

    /// Takes the first trials as known rather than running them.
    pub fn resume(mut self, known: Vec<Trial>) -> Self {
        self.known = known;
        self
    }

    /// What ends the campaign with [`Error::Interrupted`] once it is set, whatever a test is waiting for.
    pub fn stop(&self) -> Arc<AtomicBool> {
        self.stop.clone()
    }

    /// Runs what is not known yet; `watch` sees every new trial in order, and its first error ends the campaign. So does
    /// the first failing trial, if the study [stops](Study::stop_at_first) there.
    ///
    /// # Errors
    /// That of `watch`, a known trial that is not of this campaign, or a system that did none of its first tests.
    pub fn run(self, watch: impl FnMut(&Trial) -> Result<(), Error>) -> Result<(), Error> {
        self.run_learning(watch, |_| Ok(()))
    }

    /// The same; `learned` sees the scales of requirements that state none as soon as the search has learned them.
    ///
    /// # Errors
    /// As [`Campaign::run`], and that of `learned`.
    pub fn run_learning(
        self,
        mut watch: impl FnMut(&Trial) -> Result<(), Error>,
        mut learned: impl FnMut(&BTreeMap<String, f64>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let study = self.study;
        let mut steering = Steering::new(study)?;
        let mut expected = Expected::of(self.study, &self.known);
        let mut done = 0;
        while done < study.budget {
            expected.go_on()?;
            let points = steering.ask(study.batch_size().unwrap_or(BATCH).min(study.budget - done));
            if points.is_empty() {
                break;
            }
            let tests: Vec<Values> = points.iter().map(|point| study.space.decode(point)).collect();
            let known = self.known.get(done..).unwrap_or_default();
            if let Some((trial, _)) = known.iter().zip(&tests).find(|(trial, test)| trial.test != **test) {
                return Err(foreign(trial));
            }
            let mut trials: Vec<Trial> = known.iter().take(tests.len()).cloned().collect();
            let begun = trials.len();
            let ends = |trial: &Trial| study.stops_at_first() && trial.is_failure();
            if let Some(last) = trials.iter().position(ends) {
                return known.get(last + 1).map_or(Ok(()), |trial| Err(foreign(trial)));
            }
            let mut ended = false;
            let ran = self.run_batch(&tests[begun..], done + begun, &mut expected, |trial| {
                trials.push(trial.clone());
                watch(trial)?;
                ended = ends(trial);
                // The workers stop at an error.
                if ended { Err(Error::Interrupted) } else { Ok(()) }
            });
            if ended {
                return Ok(());
            }
            ran?;
            let before = steering.scales().learned().len();
            steering.tell(&points, &trials)?;
            if steering.scales().learned().len() > before {
                learned(steering.scales().learned())?;
            }
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
        watch: impl FnMut(&Trial) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.run_batch(tests, first, &mut Expected::of(self.study, &self.known), watch)
    }

    fn run_batch(
        &self,
        tests: &[Values],
        first: usize,
        expected: &mut Expected,
        mut watch: impl FnMut(&Trial) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let hire = || Hired { campaign: self, worker: Some(self.worker().expect("one like it was made before")) };
        let pool = pool(self.jobs.get().min(tests.len()).max(1))?;
        let mut shown = 0;
        let sink = |trial| {
            watch(&expected.check(trial))
                .and_then(|()| expected.go_on())
                .inspect(|()| shown += 1)
                // Nobody has to wait for a system when the results are not wanted any more.
                .inspect_err(|_| self.stop.store(true, Ordering::Relaxed))
        };
        let result = if self.darkroom.is_some() {
            let at_once = self.at_once.get().div_ceil(pool.current_num_threads());
            let work = |desk: &Desk<Trial>| hire().run_in_lockstep((desk, at_once), (first, tests));
            from_desk(&pool, 0..tests.len(), work, sink)
        } else {
            let work = |hired: &mut Hired, i: usize| hired.run(first + i, &tests[i]);
            in_order(&pool, 0..tests.len(), hire, work, sink)
        };
        match result {
            Err(error) => {
                self.stop.store(false, Ordering::Relaxed);
                Err(error)
            }
            Ok(()) if shown < tests.len() => Err(Error::Interrupted),
            Ok(()) => Ok(()),
        }
    }

    /// What draws for the drivers.
    #[cfg(all(test, feature = "camera"))]
    pub(crate) fn darkroom(&self) -> Option<&Arc<Darkroom>> {
        self.darkroom.as_ref()
    }

    /// A worker that has nothing to do, or a new one.
    fn worker(&self) -> Result<Worker<'a>, Error> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        idle.map_or_else(|| Worker::beside(self.study, self.stop.clone(), self.darkroom.clone()), Ok)
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn dismiss(&self, worker: Worker<'a>) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
    }
}

/// A worker at work, which comes back to its campaign.
struct Hired<'c, 'a> {
    campaign: &'c Campaign<'a>,
    worker: Option<Worker<'a>>,
}

impl<'a> Hired<'_, 'a> {
    fn worker(&mut self) -> &mut Worker<'a> {
        self.worker.as_mut().expect("it is at work")
    }

    /// A trial, unless the campaign was told to stop before it had ended.
    fn run(&mut self, index: usize, test: &Values) -> Option<Trial> {
        let campaign = self.campaign;
        if campaign.is_stopped() {
            return None;
        }
        let (trial, _) = self.worker().run(index, test);
        let cut_off = trial.verdict == Verdict::Error && campaign.is_stopped();
        (!cut_off).then_some(trial)
    }

    /// The trials of those of these tests that the desk gives out, until the campaign is told to stop.
    fn run_in_lockstep(&mut self, desk: (&Desk<Trial>, usize), tests: (usize, &[Values])) {
        let campaign = self.campaign;
        self.worker().run_in_lockstep(desk, tests, || campaign.is_stopped());
    }
}

impl Drop for Hired<'_, '_> {
    fn drop(&mut self) {
        if let Some(worker) = self.worker.take() {
            self.campaign.dismiss(worker);
        }
    }
}

fn foreign(trial: &Trial) -> Error {
    Error::Usage(format!(
        "trial {} of the log is not the test that this study proposes there; was the log edited?",
        trial.index
    ))
}
