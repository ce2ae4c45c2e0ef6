//! Workers: they run tests on a scenario with a driver, or on an external process.
//!
//! This is the only place where a test becomes a trial, in a simulator as in an external system.

use crate::black_box::{Answer, Connection};
use crate::darkroom::Darkroom;
use crate::executor::Desk;
use crate::expected::Expected;
use crate::judge::judge;
use crate::jury::Jury;
#[cfg(feature = "camera")]
use crate::perception::{Exam, Film, Notes};
use crate::simulator::{Recording, Simulator};
use crate::study::Subject;
#[cfg(not(feature = "camera"))]
use crate::study::WithoutCameras;
use crate::{Error, Log, Problem, ProblemKind, Reason, Study, Supervision, Trial};
#[cfg(feature = "camera")]
use paracosm_engine::sensor::Cameras;
use paracosm_engine::sensor::Shutters;
use paracosm_engine::{Judgement, Run, Test};
use paracosm_oracles::{Trace, Verdict};
use paracosm_space::Values;
use std::path::Path;
use std::sync::Arc;

/// A worker that runs tests of a study, one test at a time or many tests in lockstep.
pub struct Worker<'a> {
    study: &'a Study,
    bench: Bench<'a>,
    jury: Jury<'a>,
    #[cfg(feature = "camera")]
    exam: Option<Exam>,
}

/// The error that a test has another trace than in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "test {index} has another trace than in the log, because the driver, a file of the scenario or the software has changed since"
)]
pub struct OtherTrace {
    /// The index of the test.
    pub index: usize,
}

impl Reason for OtherTrace {}

/// The simulator or the external system that runs the tests.
enum Bench<'a> {
    Simulator(Box<Simulator<'a>>),
    System(Box<Connection>),
}

impl<'a> Worker<'a> {
    /// Makes a worker for the tests of a study.
    ///
    /// # Errors
    /// The study was read from a file, and its scenario, driver, command or a formula does not exist or is invalid; or
    /// its driver cannot be started, or uses cameras and the machine has nothing to draw with.
    pub fn new(study: &'a Study) -> Result<Self, Error> {
        Self::until(study, Supervision::default())
    }

    /// Makes a worker that stops waiting for a system or a driver once the flag of `supervision` is set, and that gives the output of programs to
    /// the place of `supervision`.
    pub fn until(study: &'a Study, supervision: impl Into<Supervision>) -> Result<Self, Error> {
        let mut worker = Self::beside(study, supervision, None)?;
        if let Bench::Simulator(simulator) = &mut worker.bench {
            simulator.start()?;
            #[cfg(feature = "camera")]
            if let Some(exam) = &worker.exam {
                simulator.open(exam.film().cameras().nominal())?;
            }
        }
        Ok(worker)
    }

    /// Makes a further worker, which shares the given darkroom with other workers. If no driver can be made, the first
    /// test reports the error.
    pub fn beside(
        study: &'a Study,
        supervision: impl Into<Supervision>,
        darkroom: Option<Arc<Darkroom>>,
    ) -> Result<Self, Error> {
        let folder = study.trust().folder().map(Path::to_owned);
        let supervision = Supervision { folder, ..supervision.into() };
        study.check_trust()?;
        #[cfg(feature = "camera")]
        let exam = study.perceiver().map(|choice| Exam::new(choice, study.space(), supervision.clone())).transpose()?;
        let bench = match study.subject() {
            Subject::Scenario(simulation) => {
                Bench::Simulator(Box::new(Simulator::new(simulation, supervision.clone(), darkroom)?))
            }
            Subject::System(system) => Bench::System(Box::new(Connection::new(system, supervision.clone())?)),
        };
        #[cfg(not(feature = "camera"))]
        if study.perceiver().is_some() {
            return Err(Error::unavailable(WithoutCameras));
        }
        Ok(Self {
            study,
            bench,
            jury: Jury::of(study, &supervision)?,
            #[cfg(feature = "camera")]
            exam,
        })
    }

    /// Returns the study whose tests the worker runs.
    pub fn study(&self) -> &'a Study {
        self.study
    }

    /// Starts the external system of the study, and does nothing for a scenario. Without this call, the first test
    /// starts the system.
    ///
    /// # Errors
    /// The system cannot be started.
    pub fn start(&mut self) -> Result<(), Error> {
        match &mut self.bench {
            Bench::Simulator(_) => Ok(()),
            Bench::System(connection) => connection.start(),
        }
    }

    /// Runs a test, and returns the trial and the trace; the trace is `None` if the test has no trace.
    pub fn run(&mut self, index: usize, test: &Values) -> (Trial, Option<Trace>) {
        #[cfg(feature = "camera")]
        if self.exam.is_some() {
            return self.examine(index, test, |_| ());
        }
        let Self { study, bench, jury, .. } = self;
        match bench {
            Bench::Simulator(simulator) => {
                let outcome = simulator.run(index, Test::new(&study.complete(test), study.space()));
                jury.judged(study, index, test, outcome)
            }
            Bench::System(connection) => asked(connection, study, index, test),
        }
    }

    /// Runs a test, and calls `see` with the run of a scenario whenever the driver is asked, and at the end. Otherwise
    /// it works like [`run`](Self::run).
    pub fn watch(&mut self, index: usize, test: &Values, see: impl FnMut(&Run)) -> (Trial, Option<Trace>) {
        #[cfg(feature = "camera")]
        if self.exam.is_some() {
            return self.examine(index, test, see);
        }
        self.film(index, test, None, see)
    }

    /// Runs a test as [`watch`](Self::watch) does, while the given cameras film the simulated run.
    pub fn film(
        &mut self,
        index: usize,
        test: &Values,
        cameras: Option<Shutters>,
        see: impl FnMut(&Run),
    ) -> (Trial, Option<Trace>) {
        let Self { study, bench, jury, .. } = self;
        match bench {
            Bench::Simulator(simulator) => {
                let outcome = simulator.watch(Test::new(&study.complete(test), study.space()), cameras, see);
                jury.judged(study, index, test, outcome)
            }
            Bench::System(connection) => asked(connection, study, index, test),
        }
    }

    /// Runs a logged test again, and records the motion of everything in it.
    ///
    /// # Errors
    /// The world of the test cannot be built, the run broke, or the trace differs from the logged trace.
    pub fn record(&mut self, logged: &Trial) -> Result<Recording, Error> {
        let study = self.study;
        let Bench::Simulator(simulator) = &mut self.bench else {
            return Err(study.subject().scenario().map(|_| ()).expect_err("the subject is a system").into());
        };
        let complete = study.complete(&logged.test);
        let (outcome, recording) = simulator.record(Test::new(&complete, study.space()))?;
        match outcome.trace.map(|trace| trace.hash()) {
            None => Err(Problem::new(ProblemKind::World, outcome.ending.message().unwrap_or_default()).into()),
            // A perceiver adds signals to the logged trace.
            Some(hash) if study.perceiver().is_none() && logged.trace_hash.as_ref() != Some(&hash) => {
                Err(OtherTrace { index: logged.index }.into())
            }
            Some(_) => Ok(recording),
        }
    }

    /// Opens the darkroom of the drivers for further cameras.
    #[cfg(feature = "camera")]
    pub(crate) fn open_darkroom(&mut self, cameras: &Cameras) -> Result<(), Error> {
        match &mut self.bench {
            Bench::Simulator(simulator) => simulator.open(cameras).map(|_| ()),
            Bench::System(_) => Ok(self.study.subject().scenario().map(|_| ())?),
        }
    }

    /// Runs a test while a camera films.
    #[cfg(feature = "camera")]
    pub(crate) fn film_with(&mut self, film: &Film, test: &Values, notes: &mut Notes) -> Result<(), Problem> {
        // The darkroom of a system has not been opened, so nothing films it.
        let Bench::Simulator(simulator) = &mut self.bench else { return Ok(()) };
        let (shutters, appearances) = (film.shutters(test)?, simulator.appearances().clone());
        let complete = self.study.complete(test);
        simulator.watch(Test::new(&complete, self.study.space()), Some(shutters), |run| {
            film.note(notes, run, &appearances);
        })?;
        Ok(())
    }

    /// Runs a test while the camera of the perceiver films, and judges the answers of the perceiver.
    #[cfg(feature = "camera")]
    fn examine(&mut self, index: usize, test: &Values, mut see: impl FnMut(&Run)) -> (Trial, Option<Trace>) {
        let Self { study, bench: Bench::Simulator(simulator), exam: Some(exam), .. } = self else {
            return self.film(index, test, None, see);
        };
        let broken = |problem| (Trial::broken(index, test.clone(), problem), None);
        let shutters = match exam.film().shutters(test) {
            Ok(shutters) => shutters,
            Err(problem) => return broken(problem),
        };
        let mut notes = Notes::default();
        let appearances = simulator.appearances().clone();
        let outcome = simulator.watch(Test::new(&study.complete(test), study.space()), Some(shutters), |run| {
            exam.film().note(&mut notes, run, &appearances);
            see(run);
        });
        let outcome = match outcome {
            Ok(outcome) => outcome,
            Err(problem) => return broken(problem),
        };
        let (mut trial, trace) = Trial::simulated(index, test.clone(), outcome);
        let (Some(trace), None) = (trace, &trial.problem) else { return (trial, None) };
        let darkroom = match simulator.open(exam.film().cameras().nominal()) {
            Ok(darkroom) => darkroom,
            Err(error) => return broken(Problem::new(ProblemKind::Camera, error.to_string())),
        };
        // The requirements of the scenario judge the driver, who is not on trial.
        (trial.verdict, trial.judgements) = (Verdict::Pass, Vec::new());
        match exam.judge(notes, test, darkroom, &trace) {
            Ok((trace, metrics)) => {
                judge(&mut trial, study.given(), &trace);
                (trial.with_metrics(metrics), Some(trace))
            }
            Err(problem) => broken(problem),
        }
    }

    /// Runs a test of a log again, and returns the new trial and the new trace. `see` gets the run of a scenario
    /// whenever the driver is asked, and at the end. The trial is the same as the campaign would have made.
    pub fn replay(&mut self, log: &Log, logged: &Trial, see: impl FnMut(&Run)) -> (Trial, Option<Trace>) {
        let (trial, trace) = self.watch(logged.index, &logged.test, see);
        (Expected::of(self.study, &log.trials()[..logged.index]).check(trial), trace)
    }

    /// Checks that a test of a log repeats: that the test has the trace of the log.
    ///
    /// # Errors
    /// The test has another trace.
    pub fn check_repeats(&mut self, log: &Log, logged: &Trial) -> Result<(), Error> {
        match self.replay(log, logged, |_| ()).0.trace_hash == logged.trace_hash {
            true => Ok(()),
            false => Err(OtherTrace { index: logged.index }.into()),
        }
    }

    /// Returns the cameras of the driver; the result is empty if the driver uses no cameras.
    ///
    /// # Errors
    /// No driver can be made.
    #[cfg(feature = "camera")]
    pub fn eyes(&mut self) -> Result<Cameras, Error> {
        match &mut self.bench {
            Bench::Simulator(simulator) => Ok(simulator.eyes()?),
            Bench::System(_) => Ok(Cameras::default()),
        }
    }

    /// Returns the darkroom that draws the camera images for the drivers; `None` if no darkroom is open.
    pub fn darkroom(&self) -> Option<&Arc<Darkroom>> {
        match &self.bench {
            Bench::Simulator(simulator) => simulator.darkroom(),
            Bench::System(_) => None,
        }
    }

    /// Runs the tests of a scenario that `desk` gives out, `at_once` tests at a time, until `stopped` returns `true`.
    /// The first test has the index `first`.
    pub fn run_in_lockstep(
        &mut self,
        (desk, at_once): (&Desk<Trial>, usize),
        (first, tests): (usize, &[Values]),
        stopped: impl Fn() -> bool,
    ) {
        let Self { study, bench: Bench::Simulator(simulator), jury, .. } = self else { return };
        let test = |index: usize| study.complete(&tests[index - first]);
        let trial = |index: usize, outcome| jury.judged(study, index, &tests[index - first], outcome).0;
        simulator.run_in_lockstep(desk, at_once, (&test, study.space()), stopped, trial);
    }
}

/// Returns the trial of a test that a system was asked to do.
fn asked(connection: &mut Connection, study: &Study, index: usize, test: &Values) -> (Trial, Option<Trace>) {
    let has_specs = study.given().next().is_some();
    let wrong = |message: &str| Err(Problem::new(ProblemKind::Answer, message));
    let answered = connection.ask(index, test).and_then(|answer| match answer {
        Answer::NotDone { why } => Err(Problem::new(ProblemKind::System, why)),
        Answer::Trace(trace) if has_specs => {
            let mut trial = Trial::judged(index, test.clone(), Verdict::Pass, Vec::new()).traced(&trace);
            judge(&mut trial, study.given(), &trace);
            Ok((trial, Some(trace)))
        }
        Answer::Trace(_) => wrong("the system answers with a trace, but no formula judges it: add a --spec"),
        Answer::Robustness(_) if has_specs => {
            wrong("the system answers with robustness, expected a trace for the --spec to judge")
        }
        Answer::Robustness(worths) => {
            let is_violated = worths.iter().any(|(_, worth)| *worth < 0.0);
            let verdict = if is_violated { Verdict::Fail } else { Verdict::Pass };
            let judgements = worths.into_iter().map(|(id, worth)| Judgement::new(id, Some(worth)));
            Ok((Trial::judged(index, test.clone(), verdict, judgements.collect()), None))
        }
    });
    answered.unwrap_or_else(|problem| (Trial::broken(index, test.clone(), problem), None))
}
