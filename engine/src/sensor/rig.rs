//! The sensors of a car: the times at which sensors measure, and at which their readings arrive.

use super::error::{Checks, SensorError};
use super::{Chance, Sensor, SensorView};
use std::any::Any;
use std::collections::VecDeque;
use std::fmt;
use std::marker::PhantomData;

/// A tolerance in seconds, because times are sums of ticks.
const WHISKER: f64 = 1e-9;

/// The delay and the loss of readings on their way from a sensor to the driver.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Delivery {
    /// The seconds between a measurement and its arrival.
    pub latency: f64,
    /// The probability that a reading is lost on the way, independently for each reading.
    pub loss: f64,
}

impl Delivery {
    /// Makes a delivery that takes `latency` seconds and loses no reading.
    pub fn after(latency: f64) -> Self {
        Self { latency, loss: 0.0 }
    }
}

/// A reading of a sensor, with its number and time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample<R> {
    /// The number k of the reading, which is due after k periods of the sensor.
    pub number: u64,
    /// The time of the measurement, in seconds since the run began.
    pub time: f64,
    /// The values that the sensor has measured.
    pub reading: R,
}

/// A handle to a sensor in a rig, which gives access to the sensor's readings.
#[derive(Debug)]
pub struct Handle<S> {
    index: usize,
    sensor: PhantomData<fn() -> S>,
}

/// The sensors that a car carries.
///
/// [`Rig::see`] shows the rig the run at one moment after the other: at every tick, if a run is
/// [equipped](crate::Run::equip) with the rig. A sensor measures at the first moment at which a reading is due. If
/// moments are further apart than the sensor's period, the readings due in between are left out.
#[derive(Default)]
pub struct Rig {
    seed: u64,
    sensors: Vec<Box<dyn Attached>>,
}

impl Rig {
    /// Makes a rig without sensors. `seed` is the seed of all noise.
    pub fn new(seed: u64) -> Self {
        Self { seed, sensors: Vec::new() }
    }

    /// Attaches a sensor to the rig. The noise depends on the sensor's name, and on no other sensor.
    ///
    /// # Errors
    /// Another sensor has that name, the latency is no number from 0 to 100 s, the loss is no probability, or the
    /// sensor's period is no number from 0.0001 to 10,000 s.
    pub fn attach<S: Sensor>(&mut self, name: &str, sensor: S, delivery: Delivery) -> Result<Handle<S>, SensorError> {
        let checks = Checks(name);
        checks.period(sensor.period())?;
        checks.within("latency", delivery.latency, (0.0, 100.0), "s")?;
        checks.within("loss", delivery.loss, (0.0, 1.0), "")?;
        if self.sensors.iter().any(|other| other.name() == name) {
            return Err(SensorError::NameTaken { name: name.to_owned() });
        }
        self.sensors.push(Box::new(Port::new(name, sensor, delivery)));
        Ok(Handle { index: self.sensors.len() - 1, sensor: PhantomData })
    }

    /// Changes the seed of all noise.
    pub(super) fn reseed(&mut self, seed: u64) {
        self.seed = seed;
    }

    /// Returns `true` if the rig has no sensor.
    pub fn is_empty(&self) -> bool {
        self.sensors.is_empty()
    }

    /// Resets all sensors and drops all readings, because a new run begins.
    pub fn reset(&mut self) {
        self.sensors.iter_mut().for_each(|sensor| sensor.reset());
    }

    /// Shows all sensors the world at the next moment. Due sensors measure, and readings arrive after their latency.
    pub fn see(&mut self, view: &SensorView<'_>) {
        for sensor in &mut self.sensors {
            sensor.see(self.seed, view);
        }
    }

    /// Drops the arrived readings, except for the last reading of every sensor, so that only later arrivals are new. A
    /// run calls this whenever its driver has answered.
    pub fn clear(&mut self) {
        self.sensors.iter_mut().for_each(|sensor| sensor.clear());
    }

    /// Returns the readings that have arrived from a sensor since the rig was last [cleared](Rig::clear), the earliest
    /// first. The handle must be from this rig.
    pub fn arrived<S: Sensor>(&self, sensor: &Handle<S>) -> &[Sample<S::Reading>] {
        self.port(sensor).map_or(&[], |port| &port.arrived)
    }

    /// Returns the last reading that has arrived from a sensor; `None` if no reading has arrived yet.
    pub fn latest<S: Sensor>(&self, sensor: &Handle<S>) -> Option<&Sample<S::Reading>> {
        let port = self.port(sensor)?;
        port.arrived.last().or(port.known.as_ref())
    }

    fn port<S: Sensor>(&self, sensor: &Handle<S>) -> Option<&Port<S>> {
        let port: &dyn Any = &**self.sensors.get(sensor.index)?;
        port.downcast_ref()
    }
}

impl fmt::Debug for Rig {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = self.sensors.iter().map(|sensor| sensor.name()).collect();
        f.debug_struct("Rig").field("seed", &self.seed).field("sensors", &names).finish()
    }
}

/// A port of any sensor.
trait Attached: Any + Send {
    fn name(&self) -> &str;
    fn reset(&mut self);
    fn clear(&mut self);
    fn see(&mut self, seed: u64, view: &SensorView<'_>);
}

/// A sensor with its readings. Samples are reused, so that readings need no allocations.
struct Port<S: Sensor> {
    name: String,
    sensor: S,
    period: f64,
    delivery: Delivery,
    /// The number of the sensor's last reading.
    last: Option<u64>,
    /// The readings on their way, the earliest first.
    flying: VecDeque<Sample<S::Reading>>,
    /// The new readings that have arrived, and the last reading that arrived before them.
    arrived: Vec<Sample<S::Reading>>,
    known: Option<Sample<S::Reading>>,
    spare: Vec<Sample<S::Reading>>,
}

impl<S: Sensor> Port<S> {
    fn new(name: &str, sensor: S, delivery: Delivery) -> Self {
        Self {
            name: name.to_owned(),
            period: sensor.period(),
            sensor,
            delivery,
            last: None,
            flying: VecDeque::new(),
            arrived: Vec::new(),
            known: None,
            spare: Vec::new(),
        }
    }

    /// Takes a reading, if one is due.
    fn measure(&mut self, seed: u64, view: &SensorView<'_>) {
        let number = ((view.time + WHISKER) / self.period).floor() as u64;
        if self.last.is_some_and(|last| number <= last) {
            return;
        }
        self.last = Some(number);
        let mut chance = Chance::of(seed, &self.name, number);
        let lost = chance.happens(self.delivery.loss);
        let mut sample = self.spare.pop().unwrap_or_default();
        (sample.number, sample.time) = (number, view.time);
        self.sensor.sense(view, &mut chance, &mut sample.reading);
        if lost {
            self.spare.push(sample);
        } else {
            self.flying.push_back(sample);
        }
    }
}

impl<S: Sensor> Attached for Port<S> {
    fn name(&self) -> &str {
        &self.name
    }

    fn reset(&mut self) {
        self.last = None;
        self.spare.extend(self.flying.drain(..).chain(self.arrived.drain(..)).chain(self.known.take()));
        self.sensor.reset();
    }

    fn clear(&mut self) {
        if let Some(newest) = self.arrived.pop() {
            self.spare.extend(self.known.replace(newest));
            self.spare.append(&mut self.arrived);
        }
    }

    fn see(&mut self, seed: u64, view: &SensorView<'_>) {
        self.measure(seed, view);
        let known = view.time - self.delivery.latency + WHISKER;
        while let Some(sample) = self.flying.pop_front_if(|sample| sample.time <= known) {
            self.arrived.push(sample);
        }
    }
}
