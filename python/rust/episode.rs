//! `Episode`: a test whose driver is asked from outside, a step at a time. The test runs in a thread of its own as in a campaign, so the car, the
//! sensors and the trace are the same.

use crate::busy;
use crate::detached::LOOK;
use crate::driver::{control_of, observation};
use crate::ending::{self, Work};
use crate::error::raised;
use crate::outcome::{outcome_of, test_of, worst_of};
use crate::sensors::welcome;
use crate::study::Study;
use crate::threads::STACK;
use paracosm::Trial;
use paracosm::campaign::{Problem, ProblemKind, StatedRequirement, Supervision, Worker};
use paracosm::engine::driver::{Driver, Fault};
use paracosm::engine::{Control, Run};
use paracosm::oracles::{Monitor, Semantics};
use paracosm::rpc::message;
use paracosm::rpc::{Answers, Partner};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// The news from the thread of a test.
enum News {
    /// The driver is asked for a control.
    Asked(Box<message::Step>),
    /// The test is over.
    Over(Box<(Trial, Option<f64>)>),
}

/// A driver that passes each question on, and waits for the answer.
#[derive(Clone)]
struct Agent {
    news: Sender<News>,
    controls: Arc<Mutex<Receiver<Control>>>,
}

impl Answers for Agent {
    fn reset(&mut self, _: &message::Reset) -> Result<(), Fault> {
        Ok(())
    }

    fn step(&mut self, step: message::Step) -> Result<Control, Fault> {
        let given_up = || Fault::new("the episode was given up");
        self.news.send(News::Asked(Box::new(step))).map_err(|_| given_up())?;
        let controls = self.controls.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            match controls.recv_timeout(LOOK) {
                Ok(control) => return Ok(control),
                Err(RecvTimeoutError::Timeout) if !ending::has_begun() => {}
                Err(_) => return Err(given_up()),
            }
        }
    }
}

/// The robustness of a run so far: certified bounds of its worst requirement, in multiples of the requirement's scale.
struct Watch {
    study: paracosm::Study,
    /// The monitors with the scales of their requirements, once the run has begun.
    monitors: Vec<(Monitor, f64)>,
    seen: usize,
    potential: Arc<Mutex<f64>>,
}

impl Watch {
    /// Takes the rows that the run has recorded since the last look.
    fn see(&mut self, run: &Run) {
        let trace = run.trace();
        if self.monitors.is_empty() {
            self.monitors = self.begun(run);
        }
        for row in trace.rows().skip(self.seen) {
            self.seen += 1;
            // A number that is NaN ends the run with an error, which the trial has.
            self.monitors.iter_mut().for_each(|(monitor, _)| drop(monitor.step(row)));
        }
        if self.seen > 0 {
            let bounds = self.monitors.iter().map(|(monitor, scale)| {
                let (lower, upper) = monitor.bounds();
                (lower / scale, upper / scale)
            });
            let worst = bounds.reduce(|a, b| (a.0.min(b.0), a.1.min(b.1)));
            self.set(worst);
        }
    }

    /// Returns the monitors of the requirements of the scenario, whose formulas may depend on the test, and of the formulas that the study was given. A
    /// formula over dense time is judged at the end only.
    fn begun(&self, run: &Run) -> Vec<(Monitor, f64)> {
        let own = run.requirements();
        let is_given =
            |one: &&StatedRequirement| one.time == Semantics::Sampled && !own.iter().any(|own| own.id == one.id);
        let given = self.study.requirements().iter().filter(is_given);
        let given = given.filter_map(|one| Some((one.formula.as_ref()?, one.scale.unwrap_or(1.0))));
        let all = own.iter().map(|one| (&one.formula, one.scale)).chain(given);
        let (signals, dt) = (run.trace().signals(), run.trace().dt());
        all.filter_map(|(formula, scale)| Some((Monitor::new(formula, signals, dt).ok()?, scale))).collect()
    }

    fn set(&self, worst: Option<(f64, f64)>) {
        if let Some((lower, upper)) = worst {
            let middle = 0.5 * (lower.clamp(-1.0, 1.0) + upper.clamp(-1.0, 1.0));
            *self.potential.lock().unwrap_or_else(PoisonError::into_inner) = middle;
        }
    }
}

/// A test whose driver is asked from outside, a step at a time.
#[pyclass(frozen, module = "paracosm._core")]
pub struct Episode {
    news: Mutex<Receiver<News>>,
    controls: Sender<Control>,
    images: Py<PyDict>,
    potential: Arc<Mutex<f64>>,
    trial: Mutex<Option<(Trial, Option<f64>)>>,
    /// Ends the test at the next question.
    stop: Arc<AtomicBool>,
    is_asked: AtomicBool,
    /// The ticks of a run that nothing ends early.
    ticks: usize,
}

impl Episode {
    /// Ends the test, also if a function of Python keeps it busy.
    fn end(&self, py: Python) {
        self.stop.store(true, Ordering::Relaxed);
        let _ = busy::interrupt(py);
    }
}

impl Drop for Episode {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

#[pymethods]
impl Episode {
    /// Begins a test of a study. The sensors and the period are those of `driver`, which is not asked.
    #[new]
    fn new(py: Python, study: &Study, test: &Bound<PyDict>, driver: &Bound<PyAny>, seed: u64) -> PyResult<Self> {
        let described = py.import("paracosm._drivers")?.call_method1("described", (driver,))?;
        let welcome = welcome(described.cast::<PyDict>()?)?;
        let (news, told) = channel();
        let (controls, asked) = channel();
        let agent = Agent { news: news.clone(), controls: Arc::new(Mutex::new(asked)) };
        // The description is checked here, so that a mistake is an error at once.
        Partner::new(welcome.clone(), seed, agent.clone()).map_err(raised)?;
        let make = move || -> Box<dyn Driver> {
            Box::new(Partner::new(welcome.clone(), seed, agent.clone()).expect("it was checked"))
        };
        let study = study.library().driven_by_own("agent", make).map_err(raised)?;
        let test = test_of(&study, test)?;
        let ticks = study.subject().scenario().map_err(raised)?.ticks();
        let potential = Arc::new(Mutex::new(0.0));
        let mut watch =
            Watch { study: study.clone(), monitors: Vec::new(), seen: 0, potential: Arc::clone(&potential) };
        let supervision = Supervision::default();
        let stop = Arc::clone(&supervision.stop);
        let work = Work::of_thread();
        thread::Builder::new().stack_size(STACK).spawn(move || {
            let _work = work;
            let trial = match Worker::until(&study, supervision) {
                Ok(mut worker) => worker.watch(0, &test, |run| watch.see(run)).0,
                Err(error) => Trial::broken(0, test, Problem::new(ProblemKind::Driver, error.to_string())),
            };
            let worst = worst_of(&study, &trial);
            watch.set(worst.map(|worst| (worst, worst)));
            let _ = news.send(News::Over(Box::new((trial, worst))));
        })?;
        let (images, trial) = (PyDict::new(py).unbind(), Mutex::default());
        let is_asked = AtomicBool::new(false);
        Ok(Self { news: Mutex::new(told), controls, images, potential, trial, stop, is_asked, ticks })
    }

    /// Answers a question with a control. The test goes on in its thread.
    fn answer(&self, py: Python, control: &Bound<PyAny>) -> PyResult<()> {
        let control = control_of(py, control)?;
        if !self.is_asked.swap(false, Ordering::SeqCst) {
            return Err(raised("the test asks for no control: call `asked` first"));
        }
        // If the test is over, nobody needs the control.
        let _ = self.controls.send(control);
        Ok(())
    }

    /// Waits for the next question, and returns it; `None` if the test is over.
    fn asked<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        if self.trial.lock().unwrap_or_else(PoisonError::into_inner).is_some() {
            return Ok(None);
        }
        loop {
            let news = py.detach(|| self.news.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK));
            match news {
                Ok(News::Asked(step)) => {
                    self.is_asked.store(true, Ordering::SeqCst);
                    return observation(py, *step, self.images.bind(py)).map(Some);
                }
                Ok(News::Over(trial)) => {
                    *self.trial.lock().unwrap_or_else(PoisonError::into_inner) = Some(*trial);
                    return Ok(None);
                }
                Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| self.end(py))?,
                Err(RecvTimeoutError::Disconnected) => return Err(raised("the thread of the test has ended")),
            }
        }
    }

    /// The number of ticks of a run that nothing ends early.
    #[getter]
    fn ticks(&self) -> usize {
        self.ticks
    }

    /// The middle of the bounds of the worst robustness, in multiples of its scale and clipped to [-1, 1]: 0 at the beginning, and the robustness at
    /// the end.
    #[getter]
    fn potential(&self) -> f64 {
        *self.potential.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The result of the test; `None` before it is over.
    #[getter]
    fn outcome<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let trial = self.trial.lock().unwrap_or_else(PoisonError::into_inner);
        trial.as_ref().map(|(trial, worst)| outcome_of(py, trial, *worst)).transpose()
    }
}
