//! Runs the tests of a scenario: one by one, or many in lockstep if drivers use cameras.
//!
//! Tests in lockstep continue until their drivers wait for images. The images of all their cameras are then drawn
//! together. When a test is over, the next one takes its place, so that as many images as possible are drawn at once.
//! The tests do not influence each other; their number changes only the speed.

mod ride;
#[cfg(all(test, feature = "camera"))]
pub mod tests;

use crate::darkroom::{Darkroom, NoImage};
use crate::drivers::{Drivers, NoDriver};
use crate::executor::Desk;
use crate::study::{Appearances, Simulation};
use crate::{Error, Problem, ProblemKind, Supervision};
use paracosm_engine::road::RoadNetwork;
use paracosm_engine::sensor::{Cameras, Shutters};
use paracosm_engine::vehicle::VehicleSetup;
use paracosm_engine::{Motion, Outcome, Program, Run, Test};
use paracosm_space::{Space, Values};
use ride::{Ride, error_of};
use std::slice;
use std::sync::Arc;

/// A simulator of a scenario, with drivers and with a darkroom that draws the camera images for the drivers.
pub struct Simulator<'a> {
    program: Program,
    vehicle: VehicleSetup,
    drivers: Drivers<'a>,
    appearances: Appearances,
    darkroom: Option<Arc<Darkroom>>,
}

/// A recorded run: where everything was at every tick, and on which roads.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The motion of all bodies.
    pub motion: Motion,
    /// The roads.
    pub network: Arc<RoadNetwork>,
}

impl<'a> Simulator<'a> {
    /// Makes a simulator of a scenario. Its drivers get the images of `darkroom`, if there is one. Once the campaign is
    /// stopped, the simulator no longer waits for drivers.
    ///
    /// # Errors
    /// The scenario or the driver does not exist.
    pub fn new(
        simulation: &'a Simulation,
        supervision: Supervision,
        darkroom: Option<Arc<Darkroom>>,
    ) -> Result<Self, Error> {
        let drivers = Drivers::new(simulation.driver(), supervision)?;
        let simulator = Self::with(simulation.program()?.clone(), simulation.vehicle(), drivers, darkroom);
        Ok(Self { appearances: simulation.appearances().clone(), ..simulator })
    }

    /// Makes a simulator of a program, in which these drivers drive a car that moves by this setup.
    fn with(program: Program, vehicle: VehicleSetup, drivers: Drivers<'a>, darkroom: Option<Arc<Darkroom>>) -> Self {
        Self { program, vehicle, drivers, appearances: Appearances::default(), darkroom }
    }

    /// Begins a test.
    fn begin(&mut self, place: usize, test: Test<'_>) -> Ride {
        let stop = self.drivers.stop().clone();
        let mut ride = Ride::begin(place, (&self.program, test, self.vehicle), self.drivers.hire(), stop);
        ride.furnish(|run| {
            let darkroom = self.open(run.eyes().cameras()).map_err(|error| NoImage::Closed(Arc::new(error)))?;
            darkroom.set(run)
        });
        ride
    }

    /// Prepares a driver, and opens a darkroom if the driver uses cameras.
    ///
    /// # Errors
    /// No driver can be made, or the driver uses cameras and there is no way to draw images.
    pub fn start(&mut self) -> Result<(), Error> {
        let cameras = self.eyes()?;
        if cameras.all.is_empty() { Ok(()) } else { self.open(&cameras).map(drop) }
    }

    /// Returns the cameras of the drivers; the result is empty if the drivers use no cameras.
    ///
    /// # Errors
    /// No driver can be made.
    pub fn eyes(&mut self) -> Result<Cameras, NoDriver> {
        let mut driver = self.drivers.hire()?;
        let cameras = driver.equipment().cameras;
        self.drivers.dismiss(Some(driver));
        Ok(cameras)
    }

    /// Returns the darkroom that draws the camera images for the drivers; `None` if no darkroom is open.
    pub fn darkroom(&self) -> Option<&Arc<Darkroom>> {
        self.darkroom.as_ref()
    }

    /// Runs the test with an index, and returns the outcome.
    pub fn run(&mut self, index: usize, test: Test<'_>) -> Result<Outcome, Problem> {
        let has_past = self.drivers.any_idle();
        let outcome = self.ride(test, |_| (), |_| ());
        if has_past { self.checked(index, test, outcome) } else { outcome }
    }

    /// Returns the outcome of a test, which runs once more if it broke with a driver that other tests may have influenced.
    fn checked(&mut self, index: usize, test: Test<'_>, outcome: Result<Outcome, Problem>) -> Result<Outcome, Problem> {
        let Some(error) = error_of(&outcome).filter(|_| self.drivers.gives_another_chance()) else { return outcome };
        self.drivers.leave();
        let again = self.watch(test, None, |_| ());
        if error_of(&again).is_none() {
            self.drivers.doubts().recover(index, &error);
        }
        again
    }

    /// Runs a test while the given cameras film the run. `see` gets the run whenever the driver is asked, and at the
    /// end.
    pub fn watch(&mut self, test: Test<'_>, film: Option<Shutters>, see: impl FnMut(&Run)) -> Result<Outcome, Problem> {
        // If the test had to be run again, `see` would get it twice.
        self.drivers.renew();
        self.ride(test, |run| film.into_iter().for_each(|film| run.film(film)), see)
    }

    /// Runs a test, and returns the outcome with the motion of all bodies and the roads.
    pub fn record(&mut self, test: Test<'_>) -> Result<(Outcome, Recording), Problem> {
        self.drivers.renew();
        let mut recording = None;
        let outcome = self.ride(test, Run::record_motion, |run| {
            if run.is_over() {
                let motion = run.motion().cloned();
                recording = motion.map(|motion| Recording { motion, network: Arc::clone(run.network()) });
            }
        })?;
        let missing = || Problem::new(ProblemKind::World, outcome.ending.message().unwrap_or_default());
        let recording = recording.ok_or_else(missing)?;
        Ok((outcome, recording))
    }

    fn ride(
        &mut self,
        test: Test<'_>,
        prepare: impl FnOnce(&mut Run),
        mut see: impl FnMut(&Run),
    ) -> Result<Outcome, Problem> {
        let mut ride = self.begin(0, test);
        ride.prepare(prepare);
        loop {
            ride.go_on(&mut see);
            if ride.is_over() {
                return self.dismiss(ride).1;
            }
            self.draw(slice::from_mut(&mut ride));
        }
    }

    /// Runs the tests that `desk` gives out, at most `at_once` tests at a time, until `stopped` returns `true`. `tests`
    /// returns the test with an index, and `judged` makes a result of its outcome.
    pub fn run_in_lockstep<T>(
        &mut self,
        desk: &Desk<T>,
        at_once: usize,
        (tests, space): (&dyn Fn(usize) -> Values, &Space),
        stopped: impl Fn() -> bool,
        mut judged: impl FnMut(usize, Result<Outcome, Problem>) -> T,
    ) {
        let mut rides: Vec<Ride> = Vec::new();
        loop {
            while rides.len() < at_once.max(1)
                && let Some(index) = desk.next()
            {
                rides.push(self.begin(index, Test::new(&tests(index), space)));
            }
            rides.iter_mut().for_each(|ride| ride.go_on(|_| ()));
            // A test that broke because the campaign was stopped has no result.
            if rides.is_empty() || desk.is_closed() || stopped() {
                return;
            }
            for over in rides.extract_if(.., |ride| ride.is_over()) {
                let (index, outcome) = self.dismiss(over);
                let outcome = self.checked(index, Test::new(&tests(index), space), outcome);
                if stopped() {
                    return;
                }
                desk.hand_in(index, Some(judged(index, outcome)));
            }
            self.draw(&mut rides);
        }
    }

    /// Returns the result of a test with its index, and makes its driver free for another test.
    fn dismiss(&mut self, ride: Ride) -> (usize, Result<Outcome, Problem>) {
        let (ended, driver) = ride.end();
        self.drivers.dismiss(driver);
        ended
    }

    /// Draws the images that the drivers of these tests wait for.
    fn draw(&mut self, rides: &mut [Ride]) {
        rides.iter_mut().for_each(Ride::miss);
        let Some(darkroom) = &self.darkroom else { return };
        let images = darkroom.develop(&rides.iter().filter_map(Ride::seen).collect::<Vec<_>>());
        let waiting = rides.iter_mut().filter(|ride| ride.seen().is_some());
        waiting.zip(images).for_each(|(ride, images)| ride.show(images));
    }

    /// Returns the 3D models that replace actors in images.
    #[cfg(feature = "camera")]
    pub fn appearances(&self) -> &Appearances {
        &self.appearances
    }

    /// Returns the darkroom of the drivers and of the perceiver, and opens it if necessary.
    pub fn open(&mut self, cameras: &Cameras) -> Result<&Darkroom, Error> {
        match &mut self.darkroom {
            Some(darkroom) => Ok(darkroom),
            none => Ok(none.insert(Arc::new(Darkroom::open(cameras, &self.appearances)?))),
        }
    }
}
