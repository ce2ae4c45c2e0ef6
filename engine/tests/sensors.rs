//! Sensors that a run carries along.

use paracosm_engine::sensor::{
    Delivery, GroundTruth, GroundTruthSettings, Imu, ImuSettings, Inaccuracy, Inertia, Lidar, LidarSettings, Rig,
    Sample, Scan, TrueBody,
};
use paracosm_engine::{
    AutonomousVehicle, Environment, Fixture, Outcome, Program, RoadSegment, Run, Scenario, Setup, driver,
};

const FOG: f64 = 0.4;

/// A car that comes upon a car that stands in its way, in fog.
fn blocked(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(300.0));
    s.place(Environment::new().fog(FOG));
    s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(12.0));
    s.place(Fixture::parked_car(road.on_lane(1, 60.0)));
    s.duration(5.0);
}

/// All that the sensors of a run have said.
#[derive(Debug, PartialEq, Default)]
struct Heard {
    felt: Vec<Sample<Inertia>>,
    scans: Vec<Sample<Scan>>,
    truths: Vec<Sample<Vec<TrueBody>>>,
}

fn drive(equipped: bool) -> (Heard, Outcome) {
    let program = Program::new("blocked", "a car in the way", blocked);
    let test = program.declare().unwrap().nominal();
    let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
    let mut run = Run::new(&program, &test, Setup::asking_every(driver.period())).unwrap();
    let mut rig = Rig::new(4);
    let exact = ImuSettings { acceleration: Inaccuracy::NONE, yaw_rate: Inaccuracy::NONE, ..ImuSettings::default() };
    let imu = rig.attach("imu", Imu::new(exact).unwrap(), Delivery::default()).unwrap();
    let settings = LidarSettings { columns: 90, ..LidarSettings::default() };
    let lidar = rig.attach("lidar", Lidar::new(settings).unwrap(), Delivery::after(0.1)).unwrap();
    let truth = GroundTruth::new(GroundTruthSettings::default()).unwrap();
    let truth = rig.attach("truth", truth, Delivery::default()).unwrap();
    if equipped {
        run.equip(rig);
    }
    let mut heard = Heard::default();
    let outcome = run.watch(driver.as_mut(), |run| {
        heard.felt.extend_from_slice(run.rig().arrived(&imu));
        heard.scans.extend_from_slice(run.rig().arrived(&lidar));
        heard.truths.extend_from_slice(run.rig().arrived(&truth));
    });
    (heard, outcome)
}

#[test]
fn the_sensors_of_a_run_see_every_tick_and_change_nothing() {
    let (heard, outcome) = drive(true);
    let trace = outcome.trace.unwrap();
    let acceleration = trace.signals().iter().position(|signal| signal == "car.acceleration").unwrap();
    let recorded: Vec<f64> = trace.rows().map(|row| row[acceleration]).collect();
    let felt: Vec<f64> = heard.felt.iter().map(|sample| sample.reading.acceleration.x).collect();
    assert_eq!(felt, recorded);
    assert!(felt.iter().any(|a| *a < -6.0), "the car brakes");
    let (nothing, bare) = drive(false);
    assert_eq!(nothing, Heard::default());
    assert_eq!(bare.trace.unwrap().hash(), trace.hash());
}

#[test]
fn scans_of_a_run_are_repeatable_late_and_faded_by_its_fog() {
    let (heard, _) = drive(true);
    assert_eq!(drive(true).0, heard);
    // Those of 0.0 to 4.9 s have arrived by 5 s.
    assert_eq!(heard.scans.iter().map(|scan| scan.number).collect::<Vec<_>>(), (0..50).collect::<Vec<_>>());
    // One sees 673 m.
    let fading = 0.004 + 2.0 * 3.912 * (libm::pow(1000.0, FOG) - 1.0) / 9990.0;
    let points = heard.scans.iter().flat_map(|scan| &scan.reading.points);
    for point in points.clone() {
        let distance = f64::from(point.position.norm());
        // The intensity is that of the distance without its noise, of which there is a decimetre at the very most.
        assert!((f64::from(point.intensity) - libm::exp(-fading * distance)).abs() < 0.1 * fading + 1e-4);
    }
    let car = points.filter(|point| point.id == 2).count();
    assert!(car > 50, "the car in the way is hit {car} times");
}

#[test]
fn the_truth_comes_closer_as_the_clearance_says() {
    let (heard, outcome) = drive(true);
    let trace = outcome.trace.unwrap();
    let clearance = trace.signals().iter().position(|signal| signal == "car.clearance").unwrap();
    let recorded: Vec<f64> = trace.rows().map(|row| row[clearance]).step_by(10).collect();
    let distances: Vec<f64> = heard.truths.iter().map(|truth| truth.reading[0].distance).collect();
    assert_eq!(distances, recorded);
}
