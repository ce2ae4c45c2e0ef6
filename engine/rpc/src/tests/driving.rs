//! Whole runs, over gRPC as in process.

use super::open;
use super::programs::{BEHIND, CROSSING, TURNING};
use super::scripted::{Act, ready, scripted, welcome};
use crate::wire::{self, answer};
use crate::{Address, Answers, Partner, serve};
use paracosm_engine::driver::{Driver, Equipment, Fault, find};
use paracosm_engine::sensor::{CameraSpec, Cameras, Image, Look, Rig};
use paracosm_engine::vehicle::{Vehicle, VehicleModel};
use paracosm_engine::{Briefing, Control, Observation, Run, Setup, Step, simulate};
use paracosm_oracles::Verdict;
use std::net::TcpListener;
use std::sync::{Arc, Mutex};

/// Serves what `make` makes until the tests end.
fn served(make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static) -> Address {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().into();
    std::thread::spawn(|| serve(listener, "test", move |_| Ok(make())).unwrap());
    address
}

fn built_in(name: &str) -> Box<dyn Driver> {
    find(name).unwrap().build(&[]).unwrap()
}

#[test]
fn the_same_driver_gives_the_same_trace_in_process_and_over_grpc() {
    for (program, name) in [(&CROSSING, "aeb"), (&BEHIND, "cc"), (&TURNING, "cruise")] {
        let test = program.declare().unwrap().nominal();
        let address = served(move || built_in(name));
        let mut far = open(&address).unwrap();
        let near = simulate(program, &test, VehicleModel::SingleTrack, built_in(name).as_mut());
        assert_eq!(near.ending.message(), None);
        for _ in 0..2 {
            let over = simulate(program, &test, VehicleModel::SingleTrack, &mut far);
            assert_eq!(over, near, "{name} in {}", program.name());
        }
        let hash = |outcome: &paracosm_engine::Outcome| outcome.trace.as_ref().unwrap().hash();
        assert_eq!(
            hash(&simulate(program, &test, VehicleModel::SingleTrack, &mut open(&address).unwrap())),
            hash(&near)
        );
    }
}

/// Answers the messages as a server does that asks a driver of this process.
struct Here {
    driver: Box<dyn Driver>,
    observation: Observation,
}

impl Answers for Here {
    fn reset(&mut self, reset: &wire::Reset) -> Result<(), Fault> {
        self.driver.reset(&reset.into())
    }

    fn step(&mut self, step: wire::Step) -> Result<Control, Fault> {
        wire::read(&step, &mut self.observation);
        self.driver.step(&self.observation)
    }
}

#[test]
fn a_partner_in_this_process_drives_as_the_driver_that_it_asks() {
    for (program, name) in [(&CROSSING, "aeb"), (&BEHIND, "cc"), (&TURNING, "cruise")] {
        let test = program.declare().unwrap().nominal();
        let asked = Here { driver: built_in(name), observation: Observation::default() };
        let welcome = wire::Welcome { period: asked.driver.period(), others: true, ..welcome() };
        let mut partner = Partner::new(welcome, 0, asked).unwrap();
        let own = simulate(program, &test, VehicleModel::SingleTrack, built_in(name).as_mut());
        for _ in 0..2 {
            let over = simulate(program, &test, VehicleModel::SingleTrack, &mut partner);
            assert_eq!(over, own, "{name} in {}", program.name());
        }
    }
    let asked = Here { driver: built_in("aeb"), observation: Observation::default() };
    let wrong = Partner::new(wire::Welcome { period: 0.0, ..welcome() }, 0, asked).err().unwrap();
    assert!(wrong.to_string().contains("period is 0 s"), "{wrong}");
}

#[test]
fn sessions_of_one_server_do_not_disturb_each_other() {
    let address = served(|| built_in("aeb"));
    let test = CROSSING.declare().unwrap().nominal();
    let expected = simulate(&CROSSING, &test, VehicleModel::SingleTrack, built_in("aeb").as_mut());
    let mut sessions: Vec<_> = (0..8).map(|_| open(&address).unwrap()).collect();
    let mut runs: Vec<Run> =
        sessions.iter().map(|one| Run::new(&CROSSING, &test, Setup::asking_every(one.period())).unwrap()).collect();
    for (run, session) in runs.iter().zip(&mut sessions) {
        session.reset(&run.briefing()).unwrap();
    }
    // In lockstep: each is asked before any is asked again.
    loop {
        for (run, session) in runs.iter_mut().zip(&mut sessions) {
            let control = match run.advance() {
                Step::Need(observation) => session.step(observation).unwrap(),
                Step::Done(outcome) => {
                    assert_eq!(*outcome, expected);
                    return;
                }
            };
            run.supply(control);
        }
    }
}

/// Remembers what it has been shown.
struct Watcher(Arc<Mutex<Vec<Image>>>);

fn cameras() -> Cameras {
    let lens = [
        ("motion", 1.0),
        ("motion_angle", 45.0),
        ("defocus", 2.0),
        ("blur", 0.5),
        ("vignetting", 0.3),
        ("exposure", -1.0),
        ("full_well", 5000.0),
        ("read_noise", 3.0),
        // The protocol has no fields for these.
        ("a setting of another lens", 0.0),
        ("another one", 4.0),
    ];
    let spec = |width| CameraSpec {
        resolution: [width, 2],
        focal_mm: 4.0,
        sensor_mm: 6.0,
        position: [1.0, 0.0, 1.2],
        yaw_pitch_roll: [1.0, 2.0, 3.0],
        rate: 10.0,
        latency: 0.05,
        dropped: 0.1,
        lens: lens.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
    };
    let all = [("front", spec(3)), ("back", spec(2))].map(|(name, camera)| (name.to_owned(), camera));
    Cameras { look: Look::Textured, all: all.into(), ..Cameras::default() }
}

impl Driver for Watcher {
    fn period(&self) -> f64 {
        0.1
    }

    fn equipment(&mut self) -> Equipment {
        Equipment { cameras: cameras(), ..Equipment::default() }
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        Ok(())
    }

    fn perceive(&mut self, _: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.0.lock().unwrap().extend_from_slice(images);
        Ok(())
    }

    fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
        Ok(Control::default())
    }
}

#[test]
fn cameras_and_images_arrive_as_they_are() {
    let seen = Arc::default();
    let kept = Arc::clone(&seen);
    let mut session = open(&served(move || Box::new(Watcher(Arc::clone(&kept))))).unwrap();
    assert_eq!(session.equipment().cameras, cameras());
    session.reset(&Briefing { cruise_speed: 1.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    let image = |camera, number| Image {
        camera,
        number,
        time: 0.1 + 0.2,
        width: 3,
        height: 2,
        rgb: (0..18).map(|byte| byte * 14 + camera as u8).collect(),
    };
    let images = [image(0, 3), image(1, 3), image(1, 4)];
    for shown in [&images[..2], &images[2..], &[]] {
        session.perceive(&Rig::default(), shown).unwrap();
        session.step(&Observation::default()).unwrap();
    }
    assert_eq!(*seen.lock().unwrap(), images);
}

#[test]
fn readings_of_sensors_arrive_when_they_are_there() {
    let asks = wire::Welcome {
        lidars: vec![wire::Lidar { name: "roof".into(), columns: Some(90), ..Default::default() }],
        gnss: vec![wire::Gnss { name: "gps".into(), ..Default::default() }],
        imus: vec![wire::Imu {
            name: "imu".into(),
            delivery: Some(wire::Delivery { latency: 0.02, loss: 0.0 }),
            ..Default::default()
        }],
        ..welcome()
    };
    let steps = Arc::new(Mutex::new(Vec::new()));
    let kept = Arc::clone(&steps);
    let address = scripted(ready(asks, move |step| {
        kept.lock().unwrap().push(step.clone());
        Act::Say(answer::Kind::Control(wire::Control { throttle: 0.1, steering: 0.0 }))
    }));
    let mut session = open(&address).unwrap();
    let test = BEHIND.declare().unwrap().nominal();
    let mut run = Run::new(&BEHIND, &test, Setup::asking_every(session.period())).unwrap();
    run.equip(session.equipment().rig);
    let outcome = run.drive(&mut session);
    assert_eq!(outcome.ending.message(), None);
    let steps = steps.lock().unwrap();
    let times = |inertia: &[wire::Inertia]| inertia.iter().map(|one| (one.time * 100.0).round()).collect::<Vec<_>>();
    assert_eq!(times(&steps[0].inertia), []);
    assert_eq!(times(&steps[1].inertia), (0..9).map(f64::from).collect::<Vec<_>>());
    assert_eq!(times(&steps[2].inertia), (9..19).map(f64::from).collect::<Vec<_>>());
    for (k, step) in steps.iter().enumerate() {
        let ([scan], [fix]) = (&step.scans[..], &step.fixes[..]) else { panic!("{step:?}") };
        assert_eq!(
            (scan.sensor.as_str(), scan.number, fix.sensor.as_str(), fix.valid),
            ("roof", k as u64, "gps", true)
        );
        assert!(!scan.points.is_empty() && scan.points.len().is_multiple_of(16));
        assert!(step.others.is_empty(), "it did not ask for the truth");
    }
}

#[test]
fn a_control_that_cannot_be_ends_the_test() {
    for (throttle, says) in [(f64::NAN, "the driver's throttle is NaN"), (1.5, "the driver's throttle is 1.5")] {
        let control = wire::Control { throttle, steering: 0.0 };
        let address = scripted(ready(welcome(), move |_| Act::Say(answer::Kind::Control(control))));
        let test = CROSSING.declare().unwrap().nominal();
        let outcome = simulate(&CROSSING, &test, VehicleModel::SingleTrack, &mut open(&address).unwrap());
        assert_eq!(outcome.verdict(), Verdict::Error);
        let message = outcome.ending.message().unwrap();
        assert!(message.contains(says) && message.contains("expected -1 to 1 at 0.000 s"), "{message}");
    }
}

#[test]
fn a_driver_with_a_rig_and_one_that_panics_are_no_loss_to_others() {
    struct Bad(bool);
    impl Driver for Bad {
        fn period(&self) -> f64 {
            0.1
        }
        fn equipment(&mut self) -> Equipment {
            let mut equipment = Equipment::default();
            if self.0 {
                let gnss = paracosm_engine::sensor::Gnss::new(Default::default()).unwrap();
                equipment.rig.attach("gps", gnss, Default::default()).unwrap();
            }
            equipment
        }
        fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
            panic!("no brakes");
        }
        fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
            unreachable!()
        }
    }
    let message = open(&served(|| Box::new(Bad(true)))).map(drop).unwrap_err().to_string();
    assert!(message.contains("expected a driver with cameras only"), "{message}");
    let address = served(|| Box::new(Bad(false)));
    for _ in 0..2 {
        let mut session = open(&address).unwrap();
        let fault =
            session.reset(&Briefing { cruise_speed: 1.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap_err();
        assert_eq!(fault.message, "the driver panicked: no brakes");
    }
}
