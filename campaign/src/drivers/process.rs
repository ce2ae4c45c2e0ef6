//! Drivers in an external process, which is started when it is needed and again after it has ended.

use super::{DriverAway, Late, NoDriver};
use crate::process::Process;
use crate::{Problem, ProblemKind, Supervision};
use paracosm_engine::driver::{Driver, Equipment, Fault, FaultKind};
use paracosm_engine::sensor::{Image, Rig};
use paracosm_engine::{Briefing, Control, Observation};
use paracosm_rpc::{Address, OpenError, Session, Terms};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The environment variable that tells a process the address to listen at.
const ADDRESS: &str = "PARACOSM_ADDRESS";

/// The ports that processes are told to listen at.
const PORTS: Range<u16> = 20_000..32_000;

/// The time that a process may take to start, as a multiple of the time-out of an answer. Starting takes longer,
/// because an interpreter loads its packages or its network, the more so on a loaded machine.
const STARTING: u32 = 10;

/// The role of the process.
const ROLE: &str = "driver";

/// The time between two checks that a process listens.
const PATIENCE: Duration = Duration::from_millis(10);

/// A command, and the process that it has started.
pub(super) struct Launcher {
    words: Vec<String>,
    terms: Terms,
    latency: f64,
    supervision: Supervision,
    running: Option<Running>,
}

/// A process with the address that it listens at. All drivers of the process share it.
#[derive(Clone)]
struct Running {
    process: Arc<Mutex<Process>>,
    address: SocketAddr,
}

impl Launcher {
    pub fn new(words: Vec<String>, terms: Terms, latency: f64, supervision: Supervision) -> Self {
        Self { words, terms, latency, supervision, running: None }
    }

    /// Lets the process end as soon as no driver uses it.
    pub fn leave(&mut self) {
        self.running = None;
    }

    /// Returns a driver in the external process, and starts the process if necessary.
    ///
    /// # Errors
    /// The process cannot be started, ends, does not listen, or does not offer a driver.
    pub fn driver(&mut self) -> Result<Box<dyn Driver>, NoDriver> {
        let wrong = |problem: Problem| DriverAway::Command { command: shell_words::join(&self.words), problem };
        let running = match self.running.take().filter(Running::is_alive) {
            Some(running) => running,
            None => Running::start(&self.words, &self.supervision).map_err(wrong)?,
        };
        // If no session can be opened, the process is ended.
        let session = running.session(&self.terms, &self.supervision.stop).map_err(wrong)?;
        self.running = Some(running.clone());
        Ok(Box::new(Late { driver: Box::new(ProcessDriver { session, running }), latency: self.latency }))
    }
}

impl Running {
    fn start(words: &[String], supervision: &Supervision) -> Result<Self, Problem> {
        let gone = |message: String| Problem::new(ProblemKind::Process, message);
        let address = free_address().map_err(|error| gone(format!("found no free port for the driver: {error}")))?;
        let started = Process::start(words, &[(ADDRESS, address.to_string())], supervision, ROLE);
        let mut process = started.map_err(|error| gone(format!("cannot start `{}`: {error}", words[0])))?;
        if let Some(stdout) = process.stdout() {
            process.keep_last_of(stdout);
        }
        Ok(Self { process: Arc::new(Mutex::new(process)), address })
    }

    fn with<T>(&self, act: impl FnOnce(&mut Process) -> T) -> T {
        act(&mut self.process.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn is_alive(&self) -> bool {
        self.with(|process| process.status().is_none())
    }

    /// Opens a session as soon as the process listens.
    fn session(&self, terms: &Terms, stop: &Arc<AtomicBool>) -> Result<Session, Problem> {
        let (begun, limit) = (Instant::now(), terms.timeout.saturating_mul(STARTING));
        loop {
            match Session::open(&Address::from(self.address), terms, stop.clone()) {
                Ok(session) => return Ok(session),
                Err(OpenError::Unreachable) if !self.is_alive() => {
                    let how = self.post_mortem("before it listened at PARACOSM_ADDRESS", "");
                    let how = match self.with(Process::status).is_some_and(|status| status.success()) {
                        true => format!(
                            "{how}; a driver listens until it is ended: in Python, its last line is `MyDriver().serve()`"
                        ),
                        false => how,
                    };
                    return Err(Problem::new(ProblemKind::Process, how));
                }
                Err(OpenError::Unreachable) if stop.load(Ordering::Relaxed) => {
                    return Err(Problem::new(ProblemKind::Interrupted, "interrupted"));
                }
                Err(OpenError::Unreachable) if begun.elapsed() < limit => thread::sleep(PATIENCE),
                Err(OpenError::Unreachable) => {
                    let within = limit.as_secs_f64();
                    let how = self.post_mortem("", &format!("it does not listen at {ADDRESS} within {within} s"));
                    return Err(Problem::new(ProblemKind::TimedOut, how));
                }
                Err(error) => return Err(Problem::unopened(&error)),
            }
        }
    }

    /// Ends the process and says what happened to it. The text is `when` it ended, or `otherwise` if it had not ended
    /// by itself.
    fn post_mortem(&self, when: &str, otherwise: &str) -> String {
        self.with(|process| {
            let how = match process.ended() {
                Some(status) => format!("the process ended {when} ({status})"),
                None => otherwise.to_owned(),
            };
            process.post_mortem(how)
        })
    }
}

/// Returns the address of a port of this machine at which nobody listens.
///
/// The port lies below 32768, where the ports begin that the operating system gives to connecting clients: a client
/// that connects to such a port before anybody listens there may connect to itself. Processes begin the search at
/// different ports, so that they seldom choose the same port.
fn free_address() -> io::Result<SocketAddr> {
    static TAKEN: AtomicU32 = AtomicU32::new(0);
    let mut found = Err(io::ErrorKind::AddrInUse.into());
    for _ in 0..PORTS.len() {
        let place = std::process::id().wrapping_mul(61).wrapping_add(TAKEN.fetch_add(1, Ordering::Relaxed));
        let port = PORTS.start + (place % PORTS.len() as u32) as u16;
        found = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).and_then(|listener| listener.local_addr());
        if found.is_ok() {
            break;
        }
    }
    found
}

/// A driver in a process that was started for it.
struct ProcessDriver {
    session: Session,
    running: Running,
}

impl ProcessDriver {
    /// Asks the driver. If there is no answer because the process is gone, the fault says what happened to the process.
    /// A process whose connection is lost is ended.
    fn ask<T>(&mut self, question: impl FnOnce(&mut Session) -> Result<T, Fault>) -> Result<T, Fault> {
        question(&mut self.session).map_err(|fault| match self.session.is_lost() {
            true => Fault::of(FaultKind::Lost, self.running.post_mortem("without an answer", &fault.message)),
            false => fault,
        })
    }
}

impl Driver for ProcessDriver {
    fn period(&self) -> f64 {
        self.session.period()
    }

    fn equipment(&mut self) -> Equipment {
        self.session.equipment()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.ask(|session| session.reset(briefing))
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.session.perceive(rig, images)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        self.ask(|session| session.step(observation))
    }
}
