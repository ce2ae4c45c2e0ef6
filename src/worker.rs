//! Whoever runs tests: a scenario with a driver, or a process of a system that others wrote.
//!
//! The one place where a test becomes a trial, whatever it is run on.

use crate::black_box::{Answer, Connection};
use crate::darkroom::Darkroom;
use crate::executor::Desk;
use crate::simulator::Simulator;
use crate::study::{Specs, Subject};
use crate::{Error, Study, Trial};
use paracosm_coverage::Values;
#[cfg(feature = "camera")]
use paracosm_engine::sensor::Cameras;
use paracosm_engine::sensor::Shutters;
use paracosm_engine::{Outcome, Run, Test};
use paracosm_oracles::{Trace, Verdict};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Runs the tests of a study, one at a time; or many in lockstep.
pub struct Worker<'a> {
    study: &'a Study,
    specs: Specs,
    bench: Bench<'a>,
}

/// What the tests are run on.
enum Bench<'a> {
    Simulator(Box<Simulator<'a>>),
    System(Connection),
}

impl<'a> Worker<'a> {
    /// A worker for the tests of a study.
    ///
    /// # Errors
    /// The study was read from a file, and its scenario, driver, command or a formula does not exist or is none; or its
    /// driver cannot be started, or sees through cameras and there is nothing to draw with.
    pub fn new(study: &'a Study) -> Result<Self, Error> {
        Self::until(study, Arc::default())
    }

    /// A worker that does not wait for a system or a driver any more once `stop` is set.
    pub(crate) fn until(study: &'a Study, stop: Arc<AtomicBool>) -> Result<Self, Error> {
        let mut worker = Self::beside(study, stop, None)?;
        if let Bench::Simulator(simulator) = &mut worker.bench {
            simulator.start()?;
        }
        Ok(worker)
    }

    /// A worker like one that there is, with what draws for the drivers of that one. What a driver of its own lacks, its
    /// tests will say.
    pub(crate) fn beside(
        study: &'a Study,
        stop: Arc<AtomicBool>,
        darkroom: Option<Arc<Darkroom>>,
    ) -> Result<Self, Error> {
        let specs = Specs::of(study)?;
        let bench = match &study.subject {
            Subject::Scenario(simulation) => {
                let mut simulator = Simulator::new(simulation, stop, darkroom)?;
                if let Some(formulas) = specs.online().filter(|_| simulation.stop_runs_early) {
                    simulator.end_when_decided(formulas);
                }
                Bench::Simulator(Box::new(simulator))
            }
            Subject::System(system) => Bench::System(Connection::new(system, stop)?),
        };
        Ok(Self { study, specs, bench })
    }

    /// What it runs tests of.
    pub fn study(&self) -> &'a Study {
        self.study
    }

    /// Starts the system, if it tests one; without it, that is done when it is needed.
    ///
    /// # Errors
    /// The system cannot be started.
    pub fn start(&mut self) -> Result<(), Error> {
        match &mut self.bench {
            Bench::Simulator(_) => Ok(()),
            Bench::System(connection) => connection.start(),
        }
    }

    /// Runs a test: what a campaign does with each, and a replay with one.
    pub fn run(&mut self, index: usize, test: &Values) -> (Trial, Option<Trace>) {
        let outcome = match &mut self.bench {
            Bench::Simulator(simulator) => {
                let values = self.study.complete(test);
                simulator.run(Test::new(&values, &self.study.space))
            }
            Bench::System(connection) => asked(connection, &self.specs, index, test),
        };
        judged(&self.specs, index, test, outcome)
    }

    /// [`run`](Self::run), with a look at the run of a scenario whenever the driver is asked, and at the end.
    pub fn watch(&mut self, index: usize, test: &Values, see: impl FnMut(&Run)) -> (Trial, Option<Trace>) {
        self.film(index, test, None, see)
    }

    /// [`watch`](Self::watch), while these cameras film the run of a scenario.
    pub(crate) fn film(
        &mut self,
        index: usize,
        test: &Values,
        cameras: Option<Shutters>,
        see: impl FnMut(&Run),
    ) -> (Trial, Option<Trace>) {
        let outcome = match &mut self.bench {
            Bench::Simulator(simulator) => {
                let values = self.study.complete(test);
                simulator.watch(Test::new(&values, &self.study.space), cameras, see)
            }
            Bench::System(connection) => asked(connection, &self.specs, index, test),
        };
        judged(&self.specs, index, test, outcome)
    }

    /// The cameras that its driver sees through: none where it sees nothing.
    ///
    /// # Errors
    /// There is no driver to be had.
    #[cfg(feature = "camera")]
    pub fn eyes(&mut self) -> Result<Cameras, Error> {
        match &mut self.bench {
            Bench::Simulator(simulator) => simulator.eyes(),
            Bench::System(_) => Ok(Cameras::default()),
        }
    }

    /// What draws for its drivers, if they see.
    pub(crate) fn darkroom(&self) -> Option<&Arc<Darkroom>> {
        match &self.bench {
            Bench::Simulator(simulator) => simulator.darkroom(),
            Bench::System(_) => None,
        }
    }

    /// Runs those of these tests of a scenario that the desk gives out, so many at a time, until `stopped`. The first has
    /// the index `first`.
    pub(crate) fn run_in_lockstep(
        &mut self,
        (desk, at_once): (&Desk<Trial>, usize),
        (first, tests): (usize, &[Values]),
        stopped: impl Fn() -> bool,
    ) {
        let Self { study, specs, bench: Bench::Simulator(simulator) } = self else { return };
        let test = |place: usize| study.complete(&tests[place]);
        let trial = |place: usize, outcome| judged(specs, first + place, &tests[place], outcome).0;
        simulator.run_in_lockstep(desk, at_once, (&test, &study.space), stopped, trial);
    }
}

/// The trial of a test that ended so, by the formulas of the study as well.
fn judged(specs: &Specs, index: usize, test: &Values, mut outcome: Outcome) -> (Trial, Option<Trace>) {
    specs.judge(&mut outcome);
    let trace = outcome.trace.take();
    (Trial::new(index, test.clone(), outcome, trace.as_ref()), trace)
}

/// What becomes of a test of a system before formulas are asked of its trace.
fn asked(connection: &mut Connection, specs: &Specs, index: usize, test: &Values) -> Outcome {
    match connection.ask(index, test) {
        Ok(answer) => answered(answer, !specs.is_empty()),
        Err(message) => Outcome::broken(Verdict::Error, message),
    }
}

/// What an answer comes to before formulas are asked of its trace.
fn answered(answer: Answer, has_specs: bool) -> Outcome {
    let nothing = Outcome { verdict: Verdict::Pass, robustness: vec![], metrics: vec![], trace: None, error: None };
    let broken = |message: &str| Outcome::broken(Verdict::Error, message);
    match answer {
        Answer::Error(message) => broken(&message),
        Answer::Trace(trace) if has_specs => Outcome { trace: Some(trace), ..nothing },
        Answer::Trace(_) => broken("the system answers with a trace, which says nothing without a --spec to ask of it"),
        Answer::Robustness(_) if has_specs => {
            broken("the system answers with robustness, expected a trace of which to ask the --spec")
        }
        Answer::Robustness(worths) => {
            let verdict = if worths.iter().any(|(_, worth)| *worth < 0.0) { Verdict::Fail } else { Verdict::Pass };
            let robustness = worths.into_iter().map(|(id, worth)| (id, Some(worth))).collect();
            Outcome { verdict, robustness, ..nothing }
        }
    }
}
