//! One simulated run, as a state machine that alternates with the system under test.
//!
//! A run knows no driver, thread or socket: it says what it needs and is supplied. At each tick
//!
//! 1. every stream is evaluated on the world as it stands, and the trace records it;
//! 2. the run ends if the car touches something or the time is up;
//! 3. the driver is asked, if its period has passed, and otherwise keeps its control;
//! 4. the inputs of the objects are read and everything moves on by `dt`.

use crate::driver::Driver;
use crate::observation::{Briefing, Control, Observation, Other};
use crate::outcome::{Metric, Outcome};
use crate::program::{Program, ProgramError, Test};
use crate::road::wrapped;
use crate::scenario::{CarSetup, Pose, WalkerSetup};
use crate::stream::{Clock, Graph, Sample, Slot, Source};
use crate::vehicle::{GRAVITY, Motion};
use crate::world::{Contact, WALKER_RADIUS, World};
use nalgebra::Vector2;
use paracosm_oracles::{Requirement, Trace, Truth, Verdict};

/// The tick in seconds where nothing else is asked for.
pub const DEFAULT_DT: f64 = 0.01;

/// The least that a contact is worth, in metres of missing braking distance.
const LEAST_MISSING: f64 = 0.001;

/// What a run wants next.
#[derive(Debug)]
pub enum Step<'a> {
    /// A control for what is to be seen here: [`Run::supply`] it and advance again.
    Need(&'a Observation),
    /// Nothing: it is over.
    Done(Box<Outcome>),
}

/// A pedestrian in motion.
struct WalkerState {
    pose: Pose,
    target: Option<Vector2<f64>>,
    /// Metres per second over the last tick.
    velocity: Vector2<f64>,
    input: Option<Slot>,
}

impl WalkerState {
    fn remaining(&self) -> f64 {
        self.target.map_or(0.0, |target| (target - self.pose.position).norm())
    }

    /// Walks for a tick, no further than to the target, which it then reaches exactly.
    fn walk(&mut self, speed: f64, dt: f64) {
        let before = self.pose.position;
        if let Some(target) = self.target {
            let way = target - before;
            let step = speed * dt;
            self.pose.position = if step >= way.norm() { target } else { before + way * (step / way.norm()) };
        }
        self.velocity = (self.pose.position - before) / dt;
    }
}

/// A column of the trace.
enum Column {
    Output(Source),
    Stream(Slot),
}

/// One test in progress.
pub struct Run {
    dt: f64,
    ticks: usize,
    tick: usize,
    /// Ticks between two questions to the driver.
    period: usize,
    supplied: bool,
    graph: Graph,
    world: World,
    setup: CarSetup,
    motion: Motion,
    control: Control,
    contact: Option<Contact>,
    /// What `car.clearance` shows at this tick.
    clearance: f64,
    friction: Slot,
    walkers: Vec<WalkerState>,
    premise: Option<Slot>,
    triggered: bool,
    requirements: Vec<Requirement>,
    columns: Vec<Column>,
    row: Vec<f64>,
    trace: Trace,
    observation: Observation,
    overlapping: bool,
}

impl Run {
    /// The run of a program on a test, for a driver that is asked every `period` seconds. Period and duration are
    /// rounded to whole ticks of `dt` seconds.
    ///
    /// # Errors
    /// The program cannot build its world with these values.
    ///
    /// # Panics
    /// `dt` or `period` is no positive number of seconds.
    pub fn new<'a>(program: &Program, test: impl Into<Test<'a>>, dt: f64, period: f64) -> Result<Self, ProgramError> {
        assert!(dt > 0.0 && dt.is_finite() && period > 0.0, "a tick and a period are positive numbers of seconds");
        let mut scenario = program.built(Some(test.into()))?;
        let setup = scenario.cars[0];
        let graph = std::mem::take(&mut scenario.graph);
        let friction = graph.slot(&scenario.roads[0].friction.node);
        let walkers: Vec<_> = scenario.walkers.iter().map(|walker| WalkerState::new(walker, &graph)).collect();
        let premise = scenario.premise.as_ref().map(|event| graph.slot(&event.node));
        let (mut names, mut columns) = standard_columns(&scenario.walkers);
        let mut requirements = Vec::new();
        for stated in scenario.requirements.take() {
            let name = stated.signal.to_string();
            if !names.contains(&name) {
                columns.push(Column::Stream(graph.slot(&stated.signal)));
                names.push(name);
            }
            requirements.push(stated.requirement);
        }
        let ticks = ticks(scenario.duration, dt);
        let mut world = World::new(&setup.vehicle, setup.start, walkers.iter().map(|walker| walker.pose));
        let overlapping = world.contact().is_some();
        let mut trace = Trace::new(dt, names);
        trace.reserve(ticks + 1);
        Ok(Self {
            dt,
            ticks,
            tick: 0,
            period: ((period / dt).round() as usize).max(1),
            supplied: false,
            graph,
            clearance: world.clearance(),
            world,
            setup,
            motion: Motion { speed: setup.speed, ..Motion::default() },
            control: Control::default(),
            contact: None,
            friction,
            walkers,
            premise,
            triggered: false,
            requirements,
            row: vec![0.0; columns.len()],
            columns,
            trace,
            observation: Observation::default(),
            overlapping,
        })
    }

    /// What a driver of this run has to know beforehand.
    pub fn briefing(&self) -> Briefing {
        Briefing { cruise_speed: self.setup.speed, vehicle: self.setup.vehicle }
    }

    /// Goes on until the driver is needed or the run is over.
    ///
    /// # Panics
    /// It was over already.
    pub fn advance(&mut self) -> Step<'_> {
        assert!(self.tick <= self.ticks, "the run is over");
        if self.overlapping {
            return self.end(Outcome::broken(Verdict::Invalid, "bodies overlap at the start"));
        }
        loop {
            if !self.supplied {
                if let Err(message) = self.look() {
                    let message = format!("{message} at {:.3} s", self.time());
                    return self.end(Outcome::broken(Verdict::Error, message));
                }
                if self.contact.is_some() || self.tick == self.ticks {
                    let outcome = self.judged();
                    return self.end(outcome);
                }
                if self.tick.is_multiple_of(self.period) {
                    self.observe();
                    return Step::Need(&self.observation);
                }
            }
            self.supplied = false;
            if let Err(message) = self.step() {
                let message = format!("{message} at {:.3} s", self.time());
                return self.end(Outcome::broken(Verdict::Error, message));
            }
        }
    }

    /// Answers what [`Run::advance`] needed.
    pub fn supply(&mut self, control: Control) {
        self.control = control;
        self.supplied = true;
    }

    /// Goes to the end with this driver, which is told that a new run begins.
    pub fn drive(&mut self, driver: &mut dyn Driver) -> Outcome {
        driver.reset(&self.briefing());
        loop {
            let control = match self.advance() {
                Step::Need(observation) => driver.step(observation),
                Step::Done(outcome) => return *outcome,
            };
            self.supply(control);
        }
    }

    fn time(&self) -> f64 {
        self.tick as f64 * self.dt
    }

    fn end(&mut self, outcome: Outcome) -> Step<'static> {
        self.tick = self.ticks + 1;
        Step::Done(Box::new(outcome))
    }

    /// Evaluates the streams and records the tick.
    ///
    /// No comparison with NaN holds, so that a signal without a value would satisfy every `never`.
    fn look(&mut self) -> Result<(), String> {
        let mut graph = std::mem::take(&mut self.graph);
        graph.tick(Clock { tick: self.tick, ticks: self.ticks }, |source| self.output(source));
        self.graph = graph;
        self.triggered |= self.premise.is_some_and(|slot| self.graph.value(slot) == Some(true));
        for (index, column) in self.columns.iter().enumerate() {
            let sample = match column {
                Column::Output(source) => self.output(*source),
                Column::Stream(slot) => self.graph.sample(*slot),
            };
            self.row[index] = as_number(sample);
            if self.row[index].is_nan() {
                return Err(format!("the signal `{}` has no value", self.trace.signals()[index]));
            }
        }
        self.trace.record(&self.row);
        Ok(())
    }

    fn output(&self, source: Source) -> Sample {
        match source {
            Source::CarPosition => self.car_pose().position.into(),
            Source::CarX => self.car_pose().position.x.into(),
            Source::CarY => self.car_pose().position.y.into(),
            Source::CarSpeed => self.motion.speed.into(),
            Source::CarAcceleration => self.motion.acceleration.into(),
            Source::CarTravelled => self.motion.travelled.into(),
            Source::CarClearance => self.clearance.into(),
            Source::CarThrottle => self.control.throttle.into(),
            Source::WalkerPosition(i) => self.walkers[i].pose.position.into(),
            Source::WalkerX(i) => self.walkers[i].pose.position.x.into(),
            Source::WalkerY(i) => self.walkers[i].pose.position.y.into(),
            Source::WalkerSpeed(i) => self.walkers[i].velocity.norm().into(),
            Source::WalkerRemaining(i) => self.walkers[i].remaining().into(),
        }
    }

    fn car_pose(&self) -> Pose {
        let start = self.setup.start;
        Pose { position: start.position + start.forward() * self.motion.travelled, ..start }
    }

    fn observe(&mut self) {
        let pose = self.car_pose();
        let ahead = pose.forward();
        let others = self.walkers.iter().map(|walker| Other {
            position: pose.to_local(walker.pose.position),
            velocity: Vector2::new(ahead.dot(&walker.velocity), ahead.perp(&walker.velocity)),
            heading: wrapped(walker.pose.heading - pose.heading),
            length: 2.0 * WALKER_RADIUS,
            width: 2.0 * WALKER_RADIUS,
            radius: WALKER_RADIUS,
        });
        self.observation.others.clear();
        self.observation.others.extend(others);
        self.observation.time = self.time();
        self.observation.speed = self.motion.speed;
        self.observation.travelled = self.motion.travelled;
    }

    /// Moves everything on by one tick.
    ///
    /// Inputs are checked here, where they enter: minima and maxima would swallow a NaN, and a road whose friction
    /// is no number would pass for one that limits nothing.
    fn step(&mut self) -> Result<(), String> {
        let throttle = self.control.throttle;
        if !(-1.0..=1.0).contains(&throttle) {
            return Err(format!("the driver's throttle is {throttle}, expected -1 to 1"));
        }
        let friction: f64 = self.graph.value(self.friction).unwrap_or(f64::NAN);
        if !(0.0..f64::INFINITY).contains(&friction) {
            return Err(format!("the friction of the road is {friction}, expected a number from 0 on"));
        }
        let demand = self.setup.vehicle.acceleration(throttle, self.motion.speed, friction);
        self.motion = self.motion.after(demand, self.dt);
        for walker in &mut self.walkers {
            let speed = walker.input.and_then(|slot| self.graph.value(slot)).unwrap_or(0.0);
            if !(0.0..f64::INFINITY).contains(&speed) {
                return Err(format!("the speed of a walker is {speed}, expected a number from 0 on"));
            }
            walker.walk(speed, self.dt);
        }
        self.world.advance(self.car_pose(), self.walkers.iter().map(|walker| walker.pose));
        self.contact = self.world.contact();
        self.clearance = match self.contact {
            None => self.world.clearance(),
            Some(contact) => -self.missing_distance(contact, friction),
        };
        self.tick += 1;
        Ok(())
    }

    /// The braking distance that was missing at a contact.
    fn missing_distance(&self, contact: Contact, friction: f64) -> f64 {
        let car = self.setup.start.forward() * self.motion.speed;
        let closing = (car - self.walkers[contact.walker].velocity).norm_squared();
        (closing / (2.0 * friction * GRAVITY)).max(LEAST_MISSING)
    }

    fn judged(&mut self) -> Outcome {
        if self.contact.is_none() {
            self.trace.finish();
        }
        let mut robustness = Vec::new();
        let mut violated = false;
        for requirement in &self.requirements {
            let evaluation = requirement.judge(&self.trace).expect("its signal has a column");
            violated |= evaluation.truth == Truth::Violated;
            let decided = evaluation.truth != Truth::Undecided;
            robustness.push((requirement.id.clone(), decided.then_some(evaluation.robustness)));
        }
        let verdict = if violated {
            Verdict::Fail
        } else if self.premise.is_some() && !self.triggered {
            Verdict::Inconclusive
        } else {
            Verdict::Pass
        };
        let impact_speed = if self.contact.is_some() { self.motion.speed } else { 0.0 };
        let metrics = [
            ("travelled", Metric::Number(self.motion.travelled)),
            ("impact_speed", Metric::Number(impact_speed)),
            ("contact_face", Metric::Word(self.contact.map(|contact| contact.face.to_string()))),
            ("triggered", Metric::Flag(self.triggered)),
        ];
        let metrics = metrics.map(|(name, metric)| (name.to_owned(), metric)).into();
        let trace = std::mem::replace(&mut self.trace, Trace::new(self.dt, vec![String::new()]));
        Outcome { verdict, robustness, metrics, trace: Some(trace), error: None }
    }
}

impl WalkerState {
    fn new(setup: &WalkerSetup, graph: &Graph) -> Self {
        Self {
            pose: setup.start,
            target: setup.task.borrow().target,
            velocity: Vector2::zeros(),
            input: setup.speed().map(|speed| graph.slot(&speed.node)),
        }
    }
}

/// The names of the outputs that every trace shows.
pub(crate) fn standard_signals(walkers: &[WalkerSetup]) -> Vec<String> {
    standard_columns(walkers).0
}

/// The outputs that every trace shows.
fn standard_columns(walkers: &[WalkerSetup]) -> (Vec<String>, Vec<Column>) {
    let car = [
        ("car.x", Source::CarX),
        ("car.y", Source::CarY),
        ("car.speed", Source::CarSpeed),
        ("car.acceleration", Source::CarAcceleration),
        ("car.throttle", Source::CarThrottle),
        ("car.travelled", Source::CarTravelled),
        ("car.clearance", Source::CarClearance),
    ];
    let car = car.map(|(name, source)| (name.to_owned(), Column::Output(source)));
    let walkers = walkers.iter().enumerate().flat_map(|(i, walker)| {
        let outputs = [("x", Source::WalkerX(i)), ("y", Source::WalkerY(i)), ("speed", Source::WalkerSpeed(i))];
        outputs.map(|(output, source)| (format!("{}.{output}", walker.name), Column::Output(source)))
    });
    car.into_iter().chain(walkers).unzip()
}

/// A sample as a trace records it: truths as 1 and 0, what is absent as NaN.
fn as_number(sample: Sample) -> f64 {
    match sample {
        Sample::Number(number) => number,
        Sample::Truth(truth) => f64::from(u8::from(truth)),
        Sample::Absent | Sample::Event | Sample::Vector(_) | Sample::Word(_) => f64::NAN,
    }
}

/// How many ticks of `dt` seconds a duration takes, rounded.
pub(crate) fn ticks(duration: f64, dt: f64) -> usize {
    (duration / dt).round() as usize
}

/// Runs a test to its end with a driver; a world that cannot be built is an outcome too.
pub fn simulate<'a>(program: &Program, test: impl Into<Test<'a>>, driver: &mut dyn Driver) -> Outcome {
    let mut run = match Run::new(program, test, DEFAULT_DT, driver.period()) {
        Ok(run) => run,
        Err(error @ ProgramError::World { .. }) => return Outcome::broken(Verdict::Invalid, error.to_string()),
        Err(error) => return Outcome::broken(Verdict::Error, error.to_string()),
    };
    run.drive(driver)
}
