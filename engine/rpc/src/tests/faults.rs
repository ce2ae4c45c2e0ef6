//! Servers that are none, and drivers that give up.

use super::scripted::{Act, ready, scripted, welcome};
use super::{open, terms};
use crate::wire::{self, answer, request};
use crate::{Address, OpenError, Session, Terms};
use paracosm_engine::driver::Driver;
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{Briefing, Observation};
use std::io::{Read, Write};
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use tonic::Status;

const BRIEFING: Briefing = Briefing { cruise_speed: 10.0, vehicle: Vehicle::BMW_320I, navigation: None };

#[track_caller]
fn refuses(session: Result<Session, OpenError>, says: &str) {
    let message = session.map(drop).unwrap_err().to_string();
    assert!(message.contains(says), "{message}");
}

#[track_caller]
fn gives_up(session: &mut Session, says: &str) {
    let message = session.step(&Observation::default()).unwrap_err().to_string();
    assert!(message.contains(says), "{message}");
}

#[test]
fn where_nobody_listens_there_is_no_session() {
    let unused = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let address = Address::from(unused);
    assert_eq!(open(&address).map(drop), Err(OpenError::Unreachable));
    refuses(
        open(&"grpc://no-such-host.invalid:1".parse().unwrap()),
        "the name of the host is not known; check the address",
    );
}

#[test]
fn another_server_is_told_from_a_driver() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().into();
    std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let _ = stream.read(&mut [0; 100]);
        let _ = stream.write_all(b"HTTP/1.1 400 Bad Request\r\n\r\n");
    });
    refuses(open(&address), "is no driver for PARACOSM");
    let other = scripted(|_| Act::Fail(Status::unimplemented("no such method")));
    refuses(open(&other), "is no driver for PARACOSM");
}

#[test]
fn a_welcome_that_cannot_be_is_refused() {
    let says = |welcome: wire::Welcome| scripted(ready(welcome, |_| Act::Leave));
    let lidar = |name: &str| wire::Lidar { name: name.into(), ..Default::default() };
    let camera = wire::Camera { name: "front".into(), ..Default::default() };
    for (wrong, why) in [
        (wire::Welcome { protocol: 2, ..welcome() }, "version 2 of the protocol, expected version 1"),
        (wire::Welcome { period: 0.0, ..welcome() }, "period is 0 s"),
        (wire::Welcome { period: f64::NAN, ..welcome() }, "period is NaN s"),
        (
            wire::Welcome { lidars: vec![lidar("a"), lidar("a")], ..welcome() },
            "two sensors are called `a`; give each sensor its own name",
        ),
        (
            wire::Welcome { lidars: vec![wire::Lidar { channels: Some(0), ..lidar("a") }], ..welcome() },
            "`channels` is 0",
        ),
        (wire::Welcome { cameras: vec![camera.clone(), camera], ..welcome() }, "cameras are called `front`"),
        (
            wire::Welcome { look: "texture".into(), ..welcome() },
            "no look is called `texture` (did you mean `textured`?)",
        ),
    ] {
        refuses(open(&says(wrong)), why);
    }
    refuses(open(&scripted(|_| Act::Say(answer::Kind::Ready(wire::Ready {})))), "expected a welcome");
    refuses(open(&scripted(|_| Act::Leave)), "ended the session, expected a welcome");
    let fault = || answer::Kind::Fault(wire::Fault { message: "no setting `gian`".into() });
    refuses(open(&scripted(move |_| Act::Say(fault()))), "no setting `gian`");
}

#[test]
fn what_a_driver_says_when_it_gives_up_is_passed_on() {
    let fault = |_: &wire::Step| Act::Say(answer::Kind::Fault(wire::Fault { message: "out of fuel".into() }));
    for (address, says, lost) in [
        (scripted(ready(welcome(), fault)), "out of fuel", false),
        (scripted(ready(welcome(), |_| Act::Leave)), "ended the session, expected a control", true),
        (scripted(ready(welcome(), |_| Act::Fail(Status::unknown("it broke")))), "ended the session: it broke", true),
        (
            scripted(ready(welcome(), |_| Act::Say(answer::Kind::Ready(wire::Ready {})))),
            "found the message that the driver is ready, expected a control",
            false,
        ),
    ] {
        let mut session = open(&address).unwrap();
        session.reset(&BRIEFING).unwrap();
        gives_up(&mut session, says);
        assert_eq!(session.is_lost(), lost, "{says}");
        assert!(session.step(&Observation::default()).is_err(), "it is over");
    }
}

#[test]
fn nobody_waits_for_a_silent_driver_beyond_the_time_out_or_a_stop() {
    let silent = |_: &wire::Step| Act::Nothing;
    let address = scripted(ready(welcome(), silent));
    let short = Terms { timeout: Duration::from_millis(100), ..terms() };
    let mut session = Session::open(&address, &short, Arc::default()).unwrap();
    session.reset(&BRIEFING).unwrap();
    gives_up(&mut session, "the driver did not answer within 0.1 s");
    assert!(session.is_lost());
    refuses(
        Session::open(&scripted(|_| Act::Nothing), &short, Arc::default()),
        "the driver did not answer within 0.1 s",
    );
    let long = Terms { timeout: Duration::from_secs(10_000), ..terms() };
    let stop = Arc::new(AtomicBool::new(false));
    let mut session = Session::open(&address, &long, stop.clone()).unwrap();
    stop.store(true, std::sync::atomic::Ordering::Relaxed);
    gives_up(&mut session, "interrupted");
}

#[test]
fn a_driver_hears_its_seed_and_settings() {
    let heard = |kind: &request::Kind| match kind {
        request::Kind::Hello(hello) if hello.seed == 7 && hello.settings["gain"] == 0.5 && hello.protocol == 1 => {
            Act::Say(answer::Kind::Welcome(welcome()))
        }
        other => panic!("{other:?}"),
    };
    let told = Terms { seed: 7, settings: vec![("gain".into(), 0.5)], ..terms() };
    let session = Session::open(&scripted(heard), &told, Arc::default()).unwrap();
    assert_eq!((session.name(), session.period()), ("scripted", 0.1));
}
