use super::*;
use crate::sensor::{
    Chance, Delivery, Gnss, GnssSettings, Handle, Imu, ImuSettings, Lidar, LidarSettings, Rig, Sample, Sensor,
};

/// A user's own: it reads the clock, and one random number.
struct Clock {
    period: f64,
    readings: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Tick {
    time: f64,
    luck: f64,
    /// How many readings there have been since the run began.
    count: usize,
}

impl Sensor for Clock {
    type Reading = Tick;

    fn period(&self) -> f64 {
        self.period
    }

    fn reset(&mut self) {
        self.readings = 0;
    }

    fn sense(&mut self, view: &SensorView<'_>, chance: &mut Chance, reading: &mut Tick) {
        self.readings += 1;
        *reading = Tick { time: view.time, luck: chance.unit(), count: self.readings };
    }
}

fn clock(period: f64) -> Clock {
    Clock { period, readings: 0 }
}

/// What arrives at each of these moments.
fn arrivals<S: Sensor>(
    rig: &mut Rig,
    sensor: &Handle<S>,
    times: impl Iterator<Item = f64>,
) -> Vec<Vec<Sample<S::Reading>>>
where
    S::Reading: Clone,
{
    let world = World::of(pose(0.0, 0.0, 0.0));
    let arrived = times.map(|time| {
        rig.clear();
        rig.see(&world.view(time));
        rig.arrived(sensor).to_vec()
    });
    arrived.collect()
}

fn ticks(count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(|tick| f64::from(tick) * 0.01)
}

#[test]
fn a_sensor_measures_once_in_its_period_and_is_heard_after_its_latency() {
    let mut rig = Rig::new(1);
    let sensor = rig.attach("clock", clock(0.1), Delivery::after(0.03)).unwrap();
    let arrived = arrivals(&mut rig, &sensor, ticks(101));
    for (tick, samples) in arrived.iter().enumerate() {
        let due = tick % 10 == 3;
        assert_eq!(samples.len(), usize::from(due), "tick {tick}");
        if let [sample] = samples[..] {
            assert_eq!(sample.number, tick as u64 / 10);
            assert_eq!(sample.time, sample.reading.time);
            assert!((sample.time - (tick - 3) as f64 * 0.01).abs() < 1e-12);
        }
    }
    assert_eq!(rig.latest(&sensor).unwrap().number, 9, "the last is kept though nothing new has arrived");
}

#[test]
fn what_is_due_between_two_moments_is_left_out_and_noise_goes_by_the_number() {
    let lucks = |step: u32| {
        let mut rig = Rig::new(1);
        let sensor = rig.attach("clock", clock(0.02), Delivery::default()).unwrap();
        let times = ticks(100).step_by(step as usize);
        arrivals(&mut rig, &sensor, times).concat().iter().map(|s| (s.number, s.reading.luck)).collect::<Vec<_>>()
    };
    let (often, seldom) = (lucks(1), lucks(10));
    assert_eq!((often.len(), seldom.len()), (50, 10));
    assert!(seldom.iter().all(|sample| often.contains(sample)));
}

#[test]
fn readings_gather_until_the_rig_is_cleared() {
    let mut rig = Rig::new(1);
    let sensor = rig.attach("clock", clock(0.01), Delivery::default()).unwrap();
    let world = World::of(pose(0.0, 0.0, 0.0));
    ticks(5).for_each(|time| rig.see(&world.view(time)));
    assert_eq!(rig.arrived(&sensor).iter().map(|sample| sample.number).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
    rig.clear();
    assert!(rig.arrived(&sensor).is_empty());
    assert_eq!(rig.latest(&sensor).unwrap().number, 4);
}

#[test]
fn as_many_readings_are_lost_as_it_says_and_the_others_stay_the_same() {
    let readings = |loss| {
        let mut rig = Rig::new(8);
        let sensor = rig.attach("clock", clock(0.01), Delivery { loss, latency: 0.0 }).unwrap();
        arrivals(&mut rig, &sensor, ticks(20_000)).concat()
    };
    let (all, some) = (readings(0.0), readings(0.3));
    let lost = (all.len() - some.len()) as f64 / all.len() as f64;
    assert!((lost - 0.3).abs() < 5.0 * (0.3 * 0.7 / 20_000_f64).sqrt(), "{lost}");
    let mut others = all.iter();
    assert!(some.iter().all(|sample| others.any(|other| other == sample)));
    assert!(readings(1.0).is_empty());
}

#[test]
fn the_noise_of_a_sensor_depends_on_no_other() {
    let alone = || {
        let mut rig = Rig::new(3);
        let gnss = rig.attach("gnss", Gnss::new(GnssSettings::default()).unwrap(), Delivery::default()).unwrap();
        arrivals(&mut rig, &gnss, ticks(200))
    };
    let mut rig = Rig::new(3);
    rig.attach("roof", Lidar::new(LidarSettings::default()).unwrap(), Delivery::after(0.1)).unwrap();
    let gnss = rig.attach("gnss", Gnss::new(GnssSettings::default()).unwrap(), Delivery::default()).unwrap();
    rig.attach("imu", Imu::new(ImuSettings::default()).unwrap(), Delivery { latency: 0.0, loss: 0.5 }).unwrap();
    let first = arrivals(&mut rig, &gnss, ticks(200));
    assert_eq!(first, alone());
    rig.reset();
    assert_eq!(arrivals(&mut rig, &gnss, ticks(200)), first, "after a reset it is as before");

    let mut other = Rig::new(3);
    let renamed = other.attach("spare", Gnss::new(GnssSettings::default()).unwrap(), Delivery::default()).unwrap();
    assert_ne!(arrivals(&mut other, &renamed, ticks(200)), first);
}

#[test]
fn after_a_reset_nothing_is_left_of_the_last_run() {
    let mut rig = Rig::new(3);
    let sensor = rig.attach("clock", clock(0.1), Delivery::after(0.05)).unwrap();
    arrivals(&mut rig, &sensor, ticks(33));
    rig.reset();
    assert!(rig.latest(&sensor).is_none() && rig.arrived(&sensor).is_empty());
    let again = arrivals(&mut rig, &sensor, ticks(12)).concat();
    assert_eq!(again.iter().map(|sample| (sample.number, sample.reading.count)).collect::<Vec<_>>(), [(0, 1)]);
}

#[test]
fn a_rig_at_work_allocates_nothing() {
    let world = World::of(pose(0.0, 0.0, 0.0)).with(Body::car(), pose(20.0, 0.0, 0.0), Vector2::zeros());
    let mut rig = Rig::new(3);
    rig.attach(
        "roof",
        Lidar::new(LidarSettings { loss: 0.5, ..LidarSettings::default() }).unwrap(),
        Delivery::after(0.25),
    )
    .unwrap();
    rig.attach("imu", Imu::new(ImuSettings::default()).unwrap(), Delivery::after(0.02)).unwrap();
    let mut go = |from: u32, until: u32| {
        for tick in from..until {
            rig.see(&world.view(f64::from(tick) * 0.01));
            rig.clear();
        }
    };
    go(0, 100);
    let after = allocation_counter::measure(|| go(100, 200));
    assert_eq!(after.count_total, 0);
}

#[test]
fn a_sensor_that_cannot_be_attached_says_why() {
    let mut rig = Rig::new(0);
    let sensor = rig.attach("clock", clock(0.1), Delivery::default()).unwrap();
    let mut attach = |name, period, latency, loss| refusal(rig.attach(name, clock(period), Delivery { latency, loss }));
    assert_eq!(attach("clock", 0.1, 0.0, 0.0), "two sensors are called `clock`; give each sensor its own name");
    assert_eq!(attach("slow", f64::NAN, 0.0, 0.0), "slow: `period` is NaN s, expected 0.0001 to 10000 s");
    assert_eq!(attach("late", 0.1, -0.1, 0.0), "late: `latency` is -0.1 s, expected 0 to 100 s");
    assert_eq!(attach("lossy", 0.1, 0.0, 1.5), "lossy: `loss` is 1.5, expected 0 to 1");
    assert!(Rig::new(0).latest(&sensor).is_none(), "another rig knows nothing of it");
}
