//! One simulated run, as a state machine that alternates with the system under test.
//!
//! A run knows no driver, thread or socket: it asks its caller for each control. At each tick
//!
//! 1. every stream is evaluated on the world as it stands, and the trace records it;
//! 2. the run ends if the car touches something or the time is up;
//! 3. the driver is asked, if its period has passed, and otherwise keeps its control;
//! 4. the inputs of the objects are read and everything moves on by `dt`.

mod driving;
mod metrics;
mod motion;
mod scene;
mod sensing;

pub use driving::{simulate, watch};
pub use motion::{Motion, Track};

use crate::object::BodyState;
use crate::observation::{Briefing, Control, Observation, Other};
use crate::outcome::{Breakdown, Ending, Judgement, Outcome, Violation};
use crate::program::{Program, ProgramError};
use crate::road::{Path, RoadNetwork};
use crate::scenario::ticks;
use crate::stream::{Clock, Graph, Slot};
use crate::test::Test;
use crate::upset::Upset;
use crate::vehicle::VehicleSetup;
use crate::weather::Weather;
use paracosm_oracles::{Requirement, Semantics, Trace, Truth};
use paracosm_road::wrapped;
use scene::Scene;
use sensing::Sensing;
use std::collections::VecDeque;
use std::sync::Arc;

/// The settings of a run that the program does not decide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// The seconds between two questions to the driver.
    pub period: f64,
    /// The duration of a tick in seconds; `None` for the tick of the program.
    pub dt: Option<f64>,
    /// The model that moves the ego vehicle, and the resistances against the motion.
    pub vehicle: VehicleSetup,
    /// `true` if the driver gets the car when a scenario that leads the car hands it over. If it is `false`, the scenario leads
    /// the car throughout, and no contact ends the run.
    pub takes_over: bool,
}

/// The state of a paused run, which either needs a control or is over.
#[derive(Debug)]
pub enum Step<'a> {
    /// The run needs a control for an observation. Call [`Run::supply`] or [`Run::answer`], and advance again.
    Need(&'a Observation),
    /// The run is over and has the given outcome.
    Done(Box<Outcome>),
}

impl Step<'_> {
    /// Returns the outcome of the test if the run is over.
    pub fn outcome(self) -> Option<Outcome> {
        match self {
            Self::Need(_) => None,
            Self::Done(outcome) => Some(*outcome),
        }
    }
}

/// The simulation of one test.
pub struct Run {
    dt: f64,
    ticks: usize,
    tick: usize,
    over: bool,
    /// The ticks between two questions to the driver.
    period: usize,
    supplied: bool,
    /// The ticks until an answer takes effect, and the answers that have not taken effect yet, each with its tick.
    latency: usize,
    answers: VecDeque<(usize, Control)>,
    told: Control,
    graph: Graph,
    scene: Scene,
    premise: Option<Slot>,
    end: Option<Slot>,
    /// `true` if a contact ends the run.
    ends_at_contact: bool,
    triggered: bool,
    requirements: Vec<Requirement>,
    /// The slot of each column of the trace.
    columns: Vec<Slot>,
    row: Vec<f64>,
    trace: Trace,
    observation: Observation,
    sensing: Sensing,
    /// The key of the scenery.
    scenery: u64,
    /// The outcome of a run that cannot begin.
    unable: Option<Outcome>,
    motion: Option<Box<Motion>>,
}

impl Run {
    /// Makes the run of a program on a test. The driver's period and the duration are rounded to whole ticks.
    ///
    /// # Errors
    /// The program cannot build its world with these values.
    ///
    /// # Panics
    /// The tick or the period is no positive number of seconds.
    pub fn new<'a>(program: &Program, test: impl Into<Test<'a>>, setup: Setup) -> Result<Self, ProgramError> {
        let test = test.into();
        let mut scenario = program.built(Some(test))?;
        let (dt, period) = (setup.dt.unwrap_or(scenario.dt), setup.period);
        assert!(
            dt > 0.0 && dt.is_finite() && period > 0.0,
            "the tick and the driver's period must be positive numbers of seconds"
        );
        let graph = std::mem::take(&mut scenario.graph);
        let [premise, end] =
            [&scenario.premise, &scenario.end].map(|event| event.as_ref().map(|event| graph.slot(&event.node)));
        let signals = std::mem::take(&mut scenario.signals);
        let (mut names, mut columns): (Vec<String>, Vec<Slot>) =
            signals.into_iter().map(|(name, source)| (name, Graph::output(source))).unzip();
        let mut requirements = Vec::new();
        for stated in scenario.requirements.take() {
            for signal in stated.signals {
                let name = signal.to_string();
                if !names.contains(&name) {
                    columns.push(graph.slot(&signal));
                    names.push(name);
                }
            }
            requirements.push(stated.requirement);
        }
        let ticks = ticks(scenario.duration, dt);
        let (key, scenery) = (scenario.keys.test.get(), scenario.keys.scenery.get());
        let beginning = scenario.beginning();
        let mut scene = Scene::new(scenario, &graph, setup);
        let begun = scene.begin(beginning, Clock { tick: 0, ticks, dt });
        // Where the scenario leads the car throughout, bodies are where the scenario puts them.
        let overlap = if setup.takes_over { scene.overlapping().map(Outcome::broken) } else { None };
        let upset = begun.err().map(|cause| Outcome::broken(Breakdown::World { cause, time: 0.0 }));
        let mut trace = Trace::new(dt, names);
        trace.reserve(ticks + 1);
        Ok(Self {
            dt,
            ticks,
            tick: 0,
            over: false,
            period: ((period / dt).round() as usize).max(1),
            supplied: false,
            latency: 0,
            answers: VecDeque::with_capacity(4),
            told: Control::default(),
            graph,
            premise,
            end,
            ends_at_contact: setup.takes_over,
            triggered: false,
            requirements,
            row: vec![0.0; columns.len()],
            columns,
            trace,
            observation: Observation::default(),
            sensing: Sensing::in_test(key),
            scenery,
            unable: overlap.or(upset),
            motion: None,
            scene,
        })
    }

    /// Returns the facts that the driver gets before the run begins.
    pub fn briefing(&self) -> Briefing {
        self.scene.ego.briefing(&self.scene.network)
    }

    /// Returns the names of the signals in the trace.
    pub fn signals(&self) -> &[String] {
        self.trace.signals()
    }

    /// Returns the trace so far. It is empty once the run is over, because the outcome has it then.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Returns the requirements of the scenario on the run.
    pub fn requirements(&self) -> &[Requirement] {
        &self.requirements
    }

    /// Simulates until the run needs a control or is over.
    ///
    /// # Panics
    /// The run was over already.
    pub fn advance(&mut self) -> Step<'_> {
        assert!(!self.over, "the run is over");
        if let Some(outcome) = self.unable.take() {
            return self.end(outcome);
        }
        loop {
            if !self.supplied {
                if let Err(cause) = self.look() {
                    return self.end(Outcome::broken(Breakdown::World { cause, time: self.time() }));
                }
                self.sense();
                if self.is_at_end() {
                    let outcome = self.judged();
                    return self.end(outcome);
                }
                if self.tick.is_multiple_of(self.period) {
                    self.observe();
                    return Step::Need(&self.observation);
                }
            }
            self.supplied = false;
            while let Some((_, control)) = self.answers.pop_front_if(|(due, _)| *due <= self.tick) {
                self.scene.ego.control = control;
            }
            if let Err(cause) = self.scene.step(&self.graph, self.dt) {
                return self.end(Outcome::broken(Breakdown::World { cause, time: self.time() }));
            }
            self.tick += 1;
        }
    }

    /// Supplies the control that [`Run::advance`] needs.
    pub fn supply(&mut self, control: Control) {
        self.told = control;
        self.answers.push_back((self.tick + self.latency, control));
        self.supplied = true;
        self.sensing.clear();
    }

    /// Returns the last supplied control, which may not have taken effect yet.
    pub fn control(&self) -> Control {
        self.told
    }

    /// Returns the present states of all bodies. The ego vehicle is the first body, then come the other bodies in the
    /// order of placement, and last the bodies on the [`Roadside`](crate::Roadside).
    pub fn bodies(&self) -> &[BodyState] {
        &self.scene.bodies
    }

    /// Returns the planned ways of objects from their present places, each with the index of the object's body.
    pub fn plans(&self) -> Vec<(usize, Path)> {
        self.scene.plans()
    }

    /// Returns the index of the body that the ego vehicle touches; `None` without a contact.
    pub fn touched(&self) -> Option<usize> {
        self.scene.contact
    }

    /// Returns the road network of the world.
    pub fn network(&self) -> &Arc<RoadNetwork> {
        &self.scene.network
    }

    /// Returns the key of the test, which follows from the values of the test.
    pub fn key(&self) -> u64 {
        self.sensing.test()
    }

    /// Returns the key of the scenery in pictures: the key of the same test with nominal light, fog, rain and sun.
    pub fn scenery(&self) -> u64 {
        self.scenery
    }

    /// Returns the weather at the present tick.
    pub fn weather(&self) -> Weather {
        self.scene.weather(&self.graph)
    }

    /// Returns the name of the object that a body belongs to, by the body's index; the ego vehicle is `car`.
    pub fn name_of(&self, body: usize) -> &str {
        self.scene.name(body)
    }

    /// Returns the seconds since the run began.
    pub fn time(&self) -> f64 {
        self.tick as f64 * self.dt
    }

    /// Returns `true` if the run is over.
    pub fn is_over(&self) -> bool {
        self.over
    }

    fn is_at_end(&self) -> bool {
        let ended = self.end.is_some_and(|event| self.graph.value(event) == Some(true));
        self.touches() || ended || self.tick == self.ticks
    }

    /// Returns `true` if a contact ends the run.
    fn touches(&self) -> bool {
        self.ends_at_contact && self.scene.contact.is_some()
    }

    fn end(&mut self, outcome: Outcome) -> Step<'static> {
        self.over = true;
        Step::Done(Box::new(outcome))
    }

    /// Evaluates the streams and records the tick.
    fn look(&mut self) -> Result<(), Upset> {
        self.scene.show(self.graph.outputs());
        self.graph.tick(Clock { tick: self.tick, ticks: self.ticks, dt: self.dt });
        self.triggered |= self.premise.is_some_and(|slot| self.graph.value(slot) == Some(true));
        self.graph.read(&self.columns, &mut self.row);
        if let Some(index) = self.row.iter().position(|number| number.is_nan()) {
            return Err(Upset::NoValue { signal: self.trace.signals()[index].clone() });
        }
        self.trace.record(&self.row);
        if self.motion.is_some() {
            self.note_motion();
        }
        Ok(())
    }

    fn observe(&mut self) {
        let (car, others) = self.scene.told().split_first().expect("the car is the first body");
        let frame = car.pose.frame();
        let present = others.iter().enumerate().filter(|(_, other)| other.present);
        let others = present.map(|(id, other)| Other {
            id,
            class: other.body.class,
            position: frame.to_local(other.pose.position),
            velocity: frame.turn_to_local(other.velocity),
            heading: wrapped(other.pose.heading - car.pose.heading),
            outline: other.body.outline,
        });
        self.observation.others.clear();
        self.observation.others.extend(others);
        self.observation.time = self.time();
        self.observation.speed = self.scene.ego.dynamics().state().speed();
        self.observation.travelled = self.scene.ego.travelled();
        self.observation.odometry = self.scene.ego.odometry();
        self.observation.way = self.scene.ego.way();
    }

    fn judged(&mut self) -> Outcome {
        if !self.touches() {
            self.trace.finish();
        }
        let mut judgements = Vec::with_capacity(self.requirements.len());
        let (mut violated, mut open) = (false, false);
        for requirement in &self.requirements {
            let evaluation = requirement.judge(&self.trace).expect("its signal has a column");
            let is_violated = evaluation.truth == Truth::Violated;
            let decided = evaluation.truth != Truth::Undecided;
            violated |= is_violated;
            open |= !decided;
            let cause = || Violation::of(&requirement.formula, Semantics::Sampled, &self.trace);
            judgements.push(Judgement {
                requirement: requirement.id.as_str().into(),
                robustness: decided.then_some(evaluation.robustness),
                violation: is_violated.then(cause).flatten().map(Box::new),
            });
        }
        let ending = if violated {
            Ending::Fail
        } else if open || self.premise.is_some() && !self.triggered {
            Ending::Inconclusive
        } else {
            Ending::Pass
        };
        let measured = metrics::measured(&self.scene, self.triggered);
        let trace = std::mem::replace(&mut self.trace, Trace::new(self.dt, vec![String::new()]));
        Outcome { ending, judgements, measured: Some(measured), trace: Some(trace) }
    }
}

impl Setup {
    /// Makes a setup with a question every `period` seconds, the program's tick, the vehicle model `single-track` and no
    /// resistances.
    pub fn asking_every(period: f64) -> Self {
        Self { period, dt: None, vehicle: VehicleSetup::default(), takes_over: true }
    }
}
