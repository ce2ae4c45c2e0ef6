//! The time that gRPC adds to a step: a question with an image, there and back over the loopback, to a driver that does
//! nothing. The server is ours; with `PARACOSM_ADDRESS=HOST:PORT` it is whatever listens there, with a camera `front`
//! of its own.

use divan::Bencher;
use paracosm_engine::driver::{Driver, Equipment, Fault};
use paracosm_engine::sensor::{CameraSpec, Cameras, Image, Rig};
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{Briefing, Control, Observation};
use paracosm_rpc::{Address, Session, Terms, serve};
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;

fn main() {
    divan::main();
}

/// A driver with a camera, which sits still.
struct Still;

impl Driver for Still {
    fn period(&self) -> f64 {
        0.1
    }

    fn equipment(&mut self) -> Equipment {
        let front = CameraSpec {
            resolution: [200, 66],
            focal_mm: 24.0,
            sensor_mm: 36.0,
            position: [0.3, 0.0, 1.35],
            rate: 10.0,
            ..CameraSpec::default()
        };
        Equipment {
            cameras: Cameras { all: [("front".into(), front)].into(), ..Cameras::default() },
            ..Equipment::default()
        }
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        Ok(())
    }

    fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
        Ok(Control::default())
    }
}

fn session() -> Session {
    let address: SocketAddr = match std::env::var("PARACOSM_ADDRESS") {
        Ok(address) => address.parse().expect("an address"),
        Err(_) => {
            let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
            let address = listener.local_addr().expect("it is bound");
            std::thread::spawn(|| serve(listener, "still", |_| Ok(Box::new(Still))));
            address
        }
    };
    let terms = Terms { seed: 0, settings: Vec::new(), timeout: Duration::from_secs(10) };
    let mut session = Session::open(&Address::from(address), &terms, Arc::default()).expect("a driver");
    session.reset(&Briefing { cruise_speed: 10.0, vehicle: Vehicle::BMW_320I, navigation: None }).expect("it is ready");
    session
}

fn image(width: u32, height: u32) -> Image {
    let rgb = (0..width * height * 3).map(|byte| byte as u8).collect();
    Image { camera: 0, number: 0, time: 0.0, width, height, rgb }
}

fn steps(bencher: Bencher, images: &[Image]) {
    let mut session = session();
    let (rig, observation) = (Rig::default(), Observation::default());
    bencher.bench_local(|| {
        session.perceive(&rig, images).expect("there is a camera");
        session.step(&observation).expect("it answers")
    });
}

#[divan::bench(sample_count = 2000, sample_size = 1)]
fn without_image(bencher: Bencher) {
    steps(bencher, &[]);
}

#[divan::bench(sample_count = 2000, sample_size = 1)]
fn with_200_x_66(bencher: Bencher) {
    steps(bencher, &[image(200, 66)]);
}

#[divan::bench(sample_count = 200, sample_size = 1)]
fn with_1280_x_720(bencher: Bencher) {
    steps(bencher, &[image(1280, 720)]);
}
