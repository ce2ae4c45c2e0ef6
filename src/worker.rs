//! Whoever runs tests: a scenario with a driver, or a process of a system that others wrote.
//!
//! The one place where a test becomes a trial, whatever it is run on.

use crate::black_box::{Answer, Connection};
use crate::study::{Simulation, Specs, Subject};
use crate::{Error, Study, Trial};
use paracosm_coverage::Values;
use paracosm_engine::driver::Driver;
use paracosm_engine::{Outcome, Program, Run, Test, watch};
use paracosm_oracles::{Trace, Verdict};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Runs the tests of a study, one at a time.
pub struct Worker<'a> {
    study: &'a Study,
    specs: Specs,
    bench: Bench<'a>,
}

/// What the tests are run on.
enum Bench<'a> {
    Simulator { simulation: &'a Simulation, program: Program, driver: Box<dyn Driver> },
    System(Connection),
}

impl<'a> Worker<'a> {
    /// A worker for the tests of a study.
    ///
    /// # Errors
    /// The study was read from a file, and its scenario, driver, command or a formula does not exist or is none.
    pub fn new(study: &'a Study) -> Result<Self, Error> {
        Self::until(study, Arc::default())
    }

    /// A worker that does not wait for a system any more once `stop` is set.
    pub(crate) fn until(study: &'a Study, stop: Arc<AtomicBool>) -> Result<Self, Error> {
        let bench = match &study.subject {
            Subject::Scenario(simulation) => {
                Bench::Simulator { simulation, program: simulation.program()?, driver: simulation.driver.build()? }
            }
            Subject::System(system) => Bench::System(Connection::new(system, stop)?),
        };
        Ok(Self { study, specs: Specs::of(study)?, bench })
    }

    /// Starts what has to be started before the first test; without it, that is done when it is needed.
    ///
    /// # Errors
    /// The system cannot be started.
    pub fn start(&mut self) -> Result<(), Error> {
        match &mut self.bench {
            Bench::Simulator { .. } => Ok(()),
            Bench::System(connection) => connection.start(),
        }
    }

    /// Runs a test: what a campaign does with each, and a replay with one.
    pub fn run(&mut self, index: usize, test: &Values) -> (Trial, Option<Trace>) {
        self.watch(index, test, |_| ())
    }

    /// [`run`](Self::run), with a look at the run of a scenario whenever the driver is asked, and at the end.
    pub fn watch(&mut self, index: usize, test: &Values, see: impl FnMut(&Run)) -> (Trial, Option<Trace>) {
        let mut outcome = match &mut self.bench {
            Bench::Simulator { simulation, program, driver } => {
                let values = self.study.complete(test);
                let test = Test::new(&values, &self.study.space);
                let outcome = simulated(program, test, simulation, driver.as_mut(), see);
                if outcome.verdict == Verdict::Error {
                    // What broke may have left the driver in any state.
                    *driver = simulation.driver.build().expect("it was built before");
                }
                outcome
            }
            Bench::System(connection) => match connection.ask(index, test) {
                Ok(answer) => answered(answer, !self.specs.is_empty()),
                Err(message) => Outcome::broken(Verdict::Error, message),
            },
        };
        self.specs.judge(&mut outcome);
        let trace = outcome.trace.take();
        (Trial::new(index, test.clone(), outcome, trace.as_ref()), trace)
    }
}

fn simulated(
    program: &Program,
    test: Test,
    simulation: &Simulation,
    driver: &mut dyn Driver,
    see: impl FnMut(&Run),
) -> Outcome {
    let run = AssertUnwindSafe(|| watch(program, test, simulation.vehicle, driver, see));
    catch_unwind(run).unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str);
        let message = message.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Outcome::broken(Verdict::Error, format!("the run panicked: {message}"))
    })
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
