//! Runs a study: it asks for tests, runs them on all cores, shows each trial in order, and reports the results to the
//! strategy.
//!
//! A campaign itself writes and prints nothing: the log, the progress bar and the summary are [observers](Observer). If
//! a test panics, its trial has the verdict `error`, and the campaign goes on.

use crate::crew::{Crew, in_order_by};
use crate::darkroom::Darkroom;
use crate::executor::{Desk, from_desk, in_order, pool_of};
use crate::expected::Expected;
use crate::observer::{FirstFailure, Observer};
use crate::scales::Learned;
use crate::steering::Steering;
use crate::{Error, Extension, Log, Reason, Shard, Study, Supervision, Trial, Worker, proposal};
use paracosm_oracles::Verdict;
use paracosm_space::{Point, Values};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::available_parallelism;
use thiserror::Error;

/// The number of tests that are asked for at a time if the strategy has no preference: enough to keep many cores busy,
/// and few enough to keep in memory.
const BATCH: usize = 4096;

/// The number of tests that run in lockstep if their drivers use cameras: enough to make good use of a graphics card,
/// and few enough that their worlds and drivers fit in memory.
const AT_ONCE: NonZeroUsize = NonZeroUsize::new(32).expect("it is more than 0");

/// A campaign, which runs the tests of a study.
pub struct Campaign<'a> {
    study: &'a Study,
    jobs: NonZeroUsize,
    at_once: NonZeroUsize,
    /// The darkroom that draws for the drivers, if they use cameras.
    darkroom: Option<Arc<Darkroom>>,
    /// The existing tests that the campaign counts as done, with the points of these tests in the space.
    extension: Option<(Extension, Vec<Point>)>,
    /// The tests of a file that the campaign runs, as the file has them; empty if a strategy makes the tests.
    given: Vec<Values>,
    known: Vec<Trial>,
    supervision: Supervision,
    /// The crew that runs the tests; `None` if threads of this process do.
    crew: Option<Arc<dyn Crew>>,
    /// Idle workers, which keep the processes that they started from one batch of tests to the next.
    idle: Mutex<Vec<Worker<'a>>>,
}

/// The reason why a campaign ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finish {
    /// The campaign has run as many tests as the budget allows.
    Budget,
    /// The strategy proposes no more tests.
    Exhausted,
    /// An observer ended the campaign, or a test failed in a study that stops at the first failure.
    Stopped,
}

/// The error that a trial of the log does not belong to the campaign that should be resumed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the test of trial {index} of the log differs from the test that this study proposes; {}", remedy(.own.as_deref()))]
pub struct ForeignTrial {
    /// The index of the trial that does not belong to the campaign.
    pub index: usize,
    /// The name of the program's own strategy; `None` for a strategy of the library.
    pub own: Option<String>,
}

fn remedy(own: Option<&str>) -> String {
    match own {
        Some(own) => format!(
            "give the strategy `{own}` as before: the same object, or a function that uses the seed of the study"
        ),
        None => "was the log edited?".to_owned(),
    }
}

/// The error that a known test ends otherwise than in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "test {index} ends otherwise than in the log, so the scenario or the driver has changed since: \
     begin a new campaign in another folder"
)]
pub struct OtherResult {
    /// The index of the test.
    pub index: usize,
}

impl Reason for ForeignTrial {}
impl Reason for OtherResult {}

impl<'a> Campaign<'a> {
    /// Makes a campaign that runs the tests of a study on all cores.
    ///
    /// # Errors
    /// The scenario, the driver or the system of the study cannot do what is asked; or the driver uses cameras, and the
    /// machine has nothing to draw with. [`Campaign::check`] checks the strategy.
    pub fn new(study: &'a Study) -> Result<Self, Error> {
        Self::until(study, Supervision::default())
    }

    /// Makes a campaign that ends with [`Error::Interrupted`] once the flag of `supervision` is set, even while a test waits for an
    /// answer, and that gives the output of programs to the place of `supervision`.
    ///
    /// # Errors
    /// The same errors as [`Campaign::new`].
    pub fn until(study: &'a Study, supervision: impl Into<Supervision>) -> Result<Self, Error> {
        let supervision = supervision.into();
        let jobs = available_parallelism().unwrap_or(NonZeroUsize::MIN);
        let mut worker = Worker::until(study, supervision.clone())?;
        worker.start()?;
        let (darkroom, idle) = (worker.darkroom().cloned(), Mutex::new(vec![worker]));
        Ok(Self {
            study,
            jobs,
            at_once: AT_ONCE,
            darkroom,
            extension: None,
            given: Vec::new(),
            known: Vec::new(),
            supervision,
            crew: None,
            idle,
        })
    }

    /// Counts the tests of an extension as done, so that the strategy proposes tests in addition to the tests of the
    /// extension.
    ///
    /// # Errors
    /// The tests cannot be read.
    pub fn extending(mut self, extension: &Extension) -> Result<Self, Error> {
        let space = self.study.space();
        let points = if self.study.runs_given_tests() {
            self.given = extension.valid(space)?;
            self.given.iter().map(|test| Ok(space.encode(test)?)).collect::<Result<_, Error>>()?
        } else {
            extension.points(space)?
        };
        self.extension = Some((extension.clone(), points));
        Ok(self)
    }

    /// Sets the number of threads that run tests. The number of threads does not change the results.
    pub fn jobs(mut self, jobs: NonZeroUsize) -> Self {
        self.jobs = jobs;
        self
    }

    /// Lets a crew run the tests. The crew does not change the results.
    pub fn with_crew(mut self, crew: Arc<dyn Crew>) -> Self {
        self.crew = Some(crew);
        self
    }

    /// Sets the number of tests that run in lockstep if their drivers use cameras; the default is 32. The images of
    /// these tests are drawn together. The number does not change the results.
    pub fn at_once(mut self, tests: NonZeroUsize) -> Self {
        self.at_once = tests;
        self
    }

    /// Sets the trials of an earlier, interrupted run of the campaign, whose tests do not run again.
    pub fn resume(mut self, known: Vec<Trial>) -> Self {
        self.known = known;
        self
    }

    /// Returns the flag that ends the campaign with [`Error::Interrupted`] when the flag is set.
    pub fn stop(&self) -> Arc<AtomicBool> {
        self.supervision.stop.clone()
    }

    /// Checks that the strategy accepts the study's space and options and the tests that the campaign extends.
    ///
    /// # Errors
    /// The strategy cannot do what the study asks.
    pub fn check(&self) -> Result<(), Error> {
        let existing = self.extension.as_ref().map_or(&[][..], |(_, points)| points);
        Ok(self.study.generator(existing).map(drop)?)
    }

    /// Runs the campaign, and skips the tests whose trials were set by [`resume`](Self::resume). Every observer sees
    /// every trial in order.
    ///
    /// # Errors
    /// An observer returns an error, the strategy cannot do what the study asks, a known trial does not belong to this
    /// campaign, a known test ends otherwise now, or a system gave no result for any of its first tests.
    pub fn run(mut self, observers: &mut [&mut dyn Observer]) -> Result<Finish, Error> {
        let study = self.study;
        let budget = study.sampling().budget;
        let mut first_failure = FirstFailure;
        let mut observers: Vec<&mut dyn Observer> =
            observers.iter_mut().map(|observer| &mut **observer as &mut dyn Observer).collect();
        if study.sampling().stop_at_first {
            observers.push(&mut first_failure);
        }
        self.check_known()?;
        let mut steering = Steering::new(study, self.extension.take().map(|(_, points)| points).unwrap_or_default())?;
        observers.iter_mut().try_for_each(|observer| observer.begun())?;
        let mut expected = Expected::of(study, &self.known);
        // Known trials are handed over batch by batch. The observers copy the trials that they need.
        let mut known = std::mem::take(&mut self.known).into_iter();
        let mut done = 0;
        let mut finish = Finish::Budget;
        while done < budget {
            expected.go_on()?;
            let points = propose(&mut steering, study, done)?;
            if points.is_empty() {
                finish = Finish::Exhausted;
                break;
            }
            // Points may be a rounding error away from the numbers of a file.
            let tests: Vec<Values> = match self.given.get(done..done + points.len()) {
                Some(given) => given.to_vec(),
                None => points.iter().map(|point| study.space().decode(point)).collect(),
            };
            let mut trials: Vec<Trial> = known.by_ref().take(tests.len()).collect();
            if let Some((trial, _)) = trials.iter().zip(&tests).find(|(trial, test)| trial.test != **test) {
                return Err(foreign(study, trial));
            }
            for (at, trial) in trials.iter().enumerate() {
                if all(&mut observers, |observer| observer.known(trial))?.is_break() {
                    if let Some(trial) = trials.get(at + 1).or(known.as_slice().first()) {
                        return Err(foreign(study, trial));
                    }
                    observers.iter_mut().try_for_each(|observer| observer.ended())?;
                    return Ok(Finish::Stopped);
                }
            }
            let begun = trials.len();
            let went_on = self.run_batch(&tests[begun..], done + begun, &mut expected, |trial| {
                trials.push(trial.clone());
                all(&mut observers, |observer| observer.trial(trial))
            })?;
            if went_on.is_break() {
                observers.iter_mut().try_for_each(|observer| observer.ended())?;
                return Ok(Finish::Stopped);
            }
            let before = steering.scales().learned().len();
            let told = steering.tell(&points, &trials);
            let learned = steering.scales().learned();
            if learned.len() > before {
                observers.iter_mut().try_for_each(|observer| observer.learned(learned))?;
            }
            done += points.len();
            // A search that breaks when nothing more is asked of it has proposed all of its tests.
            if done < budget {
                told?;
            }
        }
        if let Some(trial) = known.next() {
            return Err(foreign(study, &trial));
        }
        observers.iter_mut().try_for_each(|observer| observer.ended())?;
        Ok(finish)
    }

    /// Runs a shard of the campaign, and skips the tests whose trials were set by [`resume`](Self::resume). Every observer sees every trial of the
    /// shard in order. Returns the number of tests of the shard.
    ///
    /// # Errors
    /// The tests of the study depend on outcomes; an observer ends the shard; or the errors of [`Campaign::run`].
    pub fn run_shard(mut self, shard: Shard, observers: &mut [&mut dyn Observer]) -> Result<usize, Error> {
        Shard::check(self.study)?;
        self.check_known()?;
        let known = std::mem::take(&mut self.known);
        let range = shard.range(self.study.sampling().budget);
        let all_tests = self.proposals()?;
        let tests = &all_tests[range.start.min(all_tests.len())..range.end.min(all_tests.len())];
        let differs = |(at, trial): &(usize, &Trial)| tests.get(*at) != Some(&trial.test);
        if let Some((_, trial)) = known.iter().enumerate().find(differs) {
            return Err(foreign(self.study, trial));
        }
        observers.iter_mut().try_for_each(|observer| observer.begun())?;
        for trial in &known {
            if all(observers, |observer| observer.known(trial))?.is_break() {
                return Err(Error::Interrupted);
            }
        }
        let mut expected = Expected::of(self.study, &known);
        let rest = &tests[known.len()..];
        let show = |trial: &Trial| all(observers, |observer| observer.trial(trial));
        if self.run_batch(rest, range.start + known.len(), &mut expected, show)?.is_break() {
            return Err(Error::Interrupted);
        }
        observers.iter_mut().try_for_each(|observer| observer.ended())?;
        Ok(tests.len())
    }

    /// Returns all tests of the campaign of an open-loop strategy.
    fn proposals(&mut self) -> Result<Vec<Values>, Error> {
        let study = self.study;
        if study.runs_given_tests() {
            return Ok(self.given.clone());
        }
        let existing = self.extension.take().map(|(_, points)| points).unwrap_or_default();
        let mut steering = Steering::new(study, existing)?;
        let mut tests = Vec::new();
        while tests.len() < study.sampling().budget {
            let points = propose(&mut steering, study, tests.len())?;
            if points.is_empty() {
                break;
            }
            tests.extend(points.iter().map(|point| study.space().decode(point)));
        }
        Ok(tests)
    }

    /// Checks that known tests still end as they did: code that has changed shows in nothing else. A driver in this process that needs no images is
    /// sure to repeat a test, so the last test of each verdict has to end as before. Of other programs the last test is run, and if it ends
    /// otherwise, the campaign goes on with a doubt.
    fn check_known(&self) -> Result<(), Error> {
        let is_sure = self.study.repeats_in_process() && self.darkroom.is_none();
        let counts = |trial: &&Trial| trial.verdict != Verdict::Error;
        let mut last: Vec<&Trial> = Vec::new();
        for trial in self.known.iter().rev().filter(counts) {
            if last.iter().all(|other| is_sure && other.verdict != trial.verdict) {
                last.push(trial);
            }
        }
        if last.is_empty() {
            return Ok(());
        }
        let mut worker = self.worker()?;
        for trial in last {
            let ends_as_before = worker.run(trial.index, &trial.test).0.repeats(trial) || self.is_stopped();
            match (ends_as_before, is_sure) {
                (true, _) => {}
                (false, true) => return Err(OtherResult { index: trial.index }.into()),
                (false, false) => self.supervision.doubts.differ(trial.index),
            }
        }
        self.dismiss(worker);
        Ok(())
    }

    /// Runs the campaign without writing files, and returns the log with all trials.
    ///
    /// # Errors
    /// The same errors as [`Campaign::run`].
    pub fn into_log(self) -> Result<Log, Error> {
        let (study, mut trials) = (self.study.clone(), self.known.clone());
        let extension = self.extension.as_ref().map(|(extension, _)| extension.clone());
        self.run(&mut [&mut |trial: &Trial| trials.push(trial.clone())])?;
        Ok(Log::new(study, Learned::new(), extension, trials))
    }

    /// Runs a test that the strategy did not propose. Its trial gets this index.
    ///
    /// # Errors
    /// The campaign was stopped, or a system gave no result.
    pub fn run_test(&self, test: &Values, index: usize) -> Result<Trial, Error> {
        let mut ran = None;
        self.run_tests(std::slice::from_ref(test), index, |trial| {
            ran = Some(trial.clone());
            Ok(())
        })?;
        Ok(ran.expect("a test that is run is shown"))
    }

    /// Runs the given tests instead of the tests that the strategy proposes. The first test gets the index `first`.
    ///
    /// # Errors
    /// `watch` returns an error.
    pub fn run_tests(
        &self,
        tests: &[Values],
        first: usize,
        mut watch: impl FnMut(&Trial) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut expected = Expected::of(self.study, &self.known);
        let watch = |trial: &Trial| watch(trial).map(ControlFlow::Continue);
        self.run_batch(tests, first, &mut expected, watch).map(drop)
    }

    fn run_batch(
        &self,
        tests: &[Values],
        first: usize,
        expected: &mut Expected,
        mut watch: impl FnMut(&Trial) -> Result<ControlFlow<()>, Error>,
    ) -> Result<ControlFlow<()>, Error> {
        let hire = || Hired { campaign: self, worker: Some(self.worker().expect("one like it was made before")) };
        let mut shown = 0;
        let mut show = |trial| {
            let went_on = watch(&expected.check(trial))?;
            expected.go_on()?;
            Ok(went_on)
        };
        // The workers stop at an error. Nothing waits for a system when its results are no longer wanted.
        let sink = |trial| {
            let end = match show(trial) {
                Ok(ControlFlow::Continue(())) => {
                    shown += 1;
                    return Ok(());
                }
                Ok(ControlFlow::Break(())) => None,
                Err(error) => Some(error),
            };
            self.supervision.stop.store(true, Ordering::Relaxed);
            Err(end)
        };
        let pool = || pool_of(self.jobs.get().min(tests.len()).max(1), &self.supervision.threads);
        let result = if let Some(crew) = &self.crew {
            in_order_by(&**crew, first, tests, &self.supervision, sink)
        } else if self.darkroom.is_some() && self.study.perceiver().is_none() {
            let pool = pool()?;
            let at_once = self.at_once.get().div_ceil(pool.current_num_threads());
            let work = |desk: &Desk<Trial>| hire().run_in_lockstep((desk, at_once), (first, tests));
            from_desk(&pool, first..first + tests.len(), work, sink)
        } else {
            let work = |hired: &mut Hired, i: usize| hired.run(first + i, &tests[i]);
            in_order(&pool()?, 0..tests.len(), hire, work, sink)
        };
        match result {
            Err(end) => {
                self.supervision.stop.store(false, Ordering::Relaxed);
                end.map_or(Ok(ControlFlow::Break(())), Err)
            }
            Ok(()) if shown < tests.len() => Err(Error::Interrupted),
            Ok(()) => Ok(ControlFlow::Continue(())),
        }
    }

    /// Returns the darkroom that draws the camera images for the drivers.
    #[cfg(all(test, feature = "camera"))]
    pub fn darkroom(&self) -> Option<&Arc<Darkroom>> {
        self.darkroom.as_ref()
    }

    /// Returns an idle worker, or a new one.
    fn worker(&self) -> Result<Worker<'a>, Error> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        idle.map_or_else(|| Worker::beside(self.study, self.supervision.clone(), self.darkroom.clone()), Ok)
    }

    fn is_stopped(&self) -> bool {
        self.supervision.stop.load(Ordering::Relaxed)
    }

    fn dismiss(&self, worker: Worker<'a>) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
    }
}

/// A worker at work, which returns to its campaign when it is dropped.
struct Hired<'c, 'a> {
    campaign: &'c Campaign<'a>,
    worker: Option<Worker<'a>>,
}

impl<'a> Hired<'_, 'a> {
    fn worker(&mut self) -> &mut Worker<'a> {
        self.worker.as_mut().expect("it is at work")
    }

    /// Runs a test and returns its trial, unless the campaign was told to stop before the test had ended.
    fn run(&mut self, index: usize, test: &Values) -> Option<Trial> {
        let campaign = self.campaign;
        if campaign.is_stopped() {
            return None;
        }
        let (trial, _) = self.worker().run(index, test);
        let cut_off = trial.verdict == Verdict::Error && campaign.is_stopped();
        (!cut_off).then_some(trial)
    }

    /// Runs the tests that the desk gives out, until the campaign is told to stop.
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

fn foreign(study: &Study, trial: &Trial) -> Error {
    let own = study.sampling().own.as_ref().map(|own| own.name().to_owned());
    ForeignTrial { index: trial.index, own }.into()
}

/// Returns the next tests of a campaign that has proposed some tests already; no tests if the strategy is exhausted.
fn propose(steering: &mut Steering<'_>, study: &Study, proposed: usize) -> Result<Vec<Point>, Error> {
    let sampling = study.sampling();
    let batch = sampling.batch_size().unwrap_or(BATCH);
    let points = steering.ask(batch.min(sampling.budget - proposed))?;
    proposal::check(study.space(), sampling.strategy_name(), &points)?;
    Ok(points)
}

/// Shows something to every observer, and returns a break if an observer wants to end the campaign.
fn all(
    observers: &mut [&mut dyn Observer],
    mut show: impl FnMut(&mut dyn Observer) -> Result<ControlFlow<()>, Error>,
) -> Result<ControlFlow<()>, Error> {
    let mut went_on = ControlFlow::Continue(());
    for observer in observers {
        if show(&mut **observer)?.is_break() {
            went_on = ControlFlow::Break(());
        }
    }
    Ok(went_on)
}
