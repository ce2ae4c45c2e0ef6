//! A test as its cameras have it: the moments at which they open their shutters, not drawn yet.

use crate::{Error, Study, Trial};
use paracosm_coverage::Values;
use paracosm_engine::driver::{Driver, Equipment, Fault};
use paracosm_engine::object::Class;
use paracosm_engine::sensor::{Cameras, Chance, Delivery, Handle, Image, Moment, Mounted, Rig, Sample, Shutter};
use paracosm_engine::{Briefing, Control, Observation, Run, Setup, Test};
use paracosm_render::{Stage, Stages};
use std::sync::Arc;

/// An image that is to be drawn.
#[derive(Debug, Clone)]
pub struct Shot {
    /// Which of the camera's images it is.
    pub number: u64,
    /// When it was taken, in seconds since the run began.
    pub time: f64,
    /// What there was to see.
    pub moment: Moment,
    /// What the driver had answered last when the image was there.
    pub control: Control,
}

/// What the cameras of a test have taken.
#[derive(Debug, Clone)]
pub struct Film {
    /// The roads.
    pub stage: Arc<Stage>,
    /// The shots of each camera, in the order of the cameras' names.
    pub shots: Vec<Vec<Shot>>,
}

/// A driver whose answers are noted, each with the time at which it was asked.
struct Overheard {
    driver: Box<dyn Driver>,
    answers: Vec<(f64, Control)>,
}

impl Driver for Overheard {
    fn period(&self) -> f64 {
        self.driver.period()
    }

    fn equipment(&mut self) -> Equipment {
        self.driver.equipment()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.answers.clear();
        self.driver.reset(briefing)
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.driver.perceive(rig, images)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let control = self.driver.step(observation)?;
        self.answers.push((observation.time, control));
        Ok(control)
    }
}

/// A whisker of time in seconds, because times are sums of ticks.
const WHISKER: f64 = 1e-9;

impl Overheard {
    /// The last answer at a time.
    fn answer_at(&self, time: f64) -> Control {
        let before = self.answers.partition_point(|(asked, _)| *asked <= time + WHISKER);
        before.checked_sub(1).map_or(Control::default(), |last| self.answers[last].1)
    }
}

impl Film {
    /// Runs a test of a campaign again and films it.
    ///
    /// # Errors
    /// The study is of no scenario, the test ended as invalid or in an error, or the run is not the one that was logged.
    pub fn of(study: &Study, trial: &Trial, cameras: &Cameras, stages: &Stages) -> Result<Self, Error> {
        let simulation = study.subject.scenario()?;
        if !trial.covers() {
            let message = format!("test {} ended as {}, so that there is nothing to see", trial.index, trial.verdict);
            return Err(Error::Usage(message));
        }
        let values: Values = study.complete(&trial.test);
        let mut driver = Overheard { driver: simulation.driver.build()?, answers: Vec::new() };
        let setup = Setup { model: simulation.vehicle, ..Setup::asking_every(driver.period()) };
        let mut run = Run::new(&simulation.program()?, Test::new(&values, &study.space), setup)?;
        let stage = stages.of(run.network());
        let mut rig = Rig::new(cameras.seed);
        let handles = cameras.all.iter().map(|(name, camera)| attach(&mut rig, name, camera));
        let handles: Vec<_> = handles.collect::<Result<_, _>>()?;
        run.equip(rig);
        let mut taken: Vec<Vec<Sample<Moment>>> = vec![Vec::new(); handles.len()];
        let outcome = run.watch(&mut driver, |run| {
            for (taken, handle) in taken.iter_mut().zip(&handles) {
                taken.extend_from_slice(run.rig().arrived(handle));
            }
        });
        let hash = outcome.trace.as_ref().map(paracosm_oracles::Trace::hash);
        if hash != trial.trace_hash {
            let message = format!("test {} is not the one that was logged: its trace has another hash", trial.index);
            return Err(Error::Usage(message));
        }
        let shots = taken.into_iter().zip(cameras.all.values()).map(|(taken, camera)| {
            let developed = |Sample { number, time, reading: moment }| Shot {
                number,
                time,
                moment,
                control: driver.answer_at(time + camera.latency),
            };
            taken.into_iter().map(developed).collect()
        });
        Ok(Self { stage, shots: shots.collect() })
    }

    /// Paints all that has an owner, but for the car under test, in colours drawn from this seed for this test: what should
    /// not matter to whoever drives.
    pub fn repaint(&mut self, seed: u64, trial: usize) {
        let painted = |class| matches!(class, Class::Car | Class::Truck | Class::Bicycle | Class::Pedestrian);
        for shot in self.shots.iter_mut().flatten() {
            for (index, state) in shot.moment.bodies.iter_mut().enumerate().skip(1) {
                if painted(state.body.class) {
                    let mut chance = Chance::of(seed, &format!("colour of body {index}"), trial as u64);
                    state.body.colour = [0; 3].map(|_: u8| chance.between(0.0, 256.0) as u8);
                }
            }
        }
    }
}

fn attach(rig: &mut Rig, name: &str, camera: &Mounted) -> Result<Handle<Shutter>, Error> {
    let delivery = Delivery { latency: camera.latency, loss: camera.dropped };
    let attached = rig.attach(name, Shutter { period: 1.0 / camera.rate }, delivery);
    attached.map_err(|error| Error::Usage(format!("camera `{name}`: {error}")))
}
