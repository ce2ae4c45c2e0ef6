//! A driver that answers from another process.

use crate::wire::{self, Described, answer, request};
use crate::{Address, OpenError, PROTOCOL, Terms};
use paracosm_engine::driver::{Driver, Equipment, Fault, FaultKind};
use paracosm_engine::sensor::{Image, Rig};
use paracosm_engine::{Briefing, Control, Observation};
use std::error::Error as _;
use std::future::Future;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tokio::runtime::{Builder, Runtime};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio_stream::wrappers::UnboundedReceiverStream;
use tonic::transport::Endpoint;
use tonic::{Code, Status, Streaming};
use wire::driver_client::DriverClient;

/// The time between two looks at the flag that stops the waiting.
const PATIENCE: Duration = Duration::from_millis(20);

/// The longest answer in bytes. A driver's answers are short, except for its message when it gives up.
const LONGEST_ANSWER: usize = 1 << 24;

/// A driver in another process, which answers as long as the connection lasts.
///
/// Dropping the session ends it.
pub struct Session {
    // These two stand before the runtime, because they must be dropped before it.
    requests: UnboundedSender<wire::Request>,
    answers: Streaming<wire::Answer>,
    runtime: Runtime,
    watch: Watch,
    described: Described,
    lost: bool,
    next: wire::Step,
}

/// The limits of waiting for an answer: the timeout and the flag that stops it.
struct Watch {
    timeout: Duration,
    stop: Arc<AtomicBool>,
}

impl Session {
    /// Begins a session with the driver at the given address. The session stops waiting once `stop` is set.
    ///
    /// # Errors
    /// No process listens at the address, the process is no driver, or the driver refuses the terms.
    pub fn open(address: &Address, terms: &Terms, stop: Arc<AtomicBool>) -> Result<Self, OpenError> {
        let runtime = Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|error| {
            Fault::of(FaultKind::Lost, format!("cannot start the runtime that waits for the driver: {error}"))
        })?;
        let watch = Watch { timeout: terms.timeout, stop };
        if !address.is_known() {
            return Err(OpenError::UnknownHost);
        }
        let endpoint = Endpoint::from_shared(format!("http://{}", address.authority()));
        let endpoint = endpoint.map_err(|_| OpenError::UnknownHost)?;
        let channel = watch.wait(&runtime, endpoint.connect())?;
        let channel = channel.map_err(|_| OpenError::Unreachable)?;
        let (requests, stream) = unbounded_channel();
        let hello = request::Kind::Hello(wire::hello(terms));
        requests.send(wire::Request { kind: Some(hello) }).expect("the stream is at hand");
        let mut client = DriverClient::new(channel).max_decoding_message_size(LONGEST_ANSWER);
        let answers = watch.wait(&runtime, client.drive(UnboundedReceiverStream::new(stream)))?;
        let mut answers = answers.map_err(|status| refusal(&status))?.into_inner();
        let answer = watch.wait(&runtime, answers.message())?.map_err(|status| refusal(&status))?;
        let welcome = match answer.and_then(|answer| answer.kind) {
            Some(answer::Kind::Welcome(welcome)) => welcome,
            Some(answer::Kind::Fault(fault)) => return Err(Fault::new(fault.message).into()),
            other => return Err(unexpected("a welcome", other.as_ref()).into()),
        };
        if welcome.protocol != PROTOCOL {
            return Err(OpenError::Protocol { found: welcome.protocol });
        }
        let described = Described::new(welcome, terms.seed)?;
        Ok(Self { requests, answers, runtime, watch, described, lost: false, next: wire::Step::default() })
    }

    /// Returns the name that the driver gives itself.
    pub fn name(&self) -> &str {
        &self.described.name
    }

    /// Returns `true` if the driver's server is gone or does not answer. A driver that has reported a fault is not
    /// lost.
    pub fn is_lost(&self) -> bool {
        self.lost
    }

    fn ask(&mut self, kind: request::Kind) -> Result<Option<answer::Kind>, Fault> {
        // If the server is gone, the wait below reports it.
        let _ = self.requests.send(wire::Request { kind: Some(kind) });
        let answer = self.watch.wait(&self.runtime, self.answers.message());
        let answer = answer.and_then(|answer| answer.map_err(|status| Fault::of(FaultKind::Lost, end(&status))));
        self.lost = !matches!(answer, Ok(Some(_)));
        match answer?.and_then(|answer| answer.kind) {
            Some(answer::Kind::Fault(fault)) => Err(Fault::new(fault.message)),
            other => Ok(other),
        }
    }
}

impl Driver for Session {
    fn period(&self) -> f64 {
        self.described.period
    }

    fn equipment(&mut self) -> Equipment {
        self.described.equipment()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.next = wire::Step::default();
        match self.ask(request::Kind::Reset(briefing.into()))? {
            Some(answer::Kind::Ready(_)) => Ok(()),
            other => Err(unexpected("the message that the driver is ready", other.as_ref())),
        }
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.described.write(rig, images, &mut self.next);
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let mut step = std::mem::take(&mut self.next);
        wire::write(observation, self.described.others, &mut step);
        match self.ask(request::Kind::Step(step))? {
            Some(answer::Kind::Control(wire::Control { throttle, steering })) => Ok(Control { throttle, steering }),
            other => Err(unexpected("a control", other.as_ref())),
        }
    }
}

impl Watch {
    fn wait<F: Future>(&self, runtime: &Runtime, future: F) -> Result<F::Output, Fault> {
        let begun = Instant::now();
        runtime.block_on(async {
            let mut future = pin!(future);
            loop {
                let left = self.timeout.saturating_sub(begun.elapsed());
                if let Ok(output) = tokio::time::timeout(left.min(PATIENCE), &mut future).await {
                    return Ok(output);
                }
                if self.stop.load(Ordering::Relaxed) {
                    return Err(Fault::of(FaultKind::Interrupted, "interrupted"));
                }
                if begun.elapsed() >= self.timeout {
                    return Err(Fault::of(
                        FaultKind::TimedOut,
                        format!("the driver did not answer within {} s", self.timeout.as_secs_f64()),
                    ));
                }
            }
        })
    }
}

/// Makes the fault for an answer of the wrong kind.
fn unexpected(expected: &str, found: Option<&answer::Kind>) -> Fault {
    let found = match found {
        None => "the driver ended the session".to_owned(),
        Some(answer::Kind::Welcome(_)) => "found a welcome".to_owned(),
        Some(answer::Kind::Ready(_)) => "found the message that the driver is ready".to_owned(),
        Some(answer::Kind::Control(_)) => "found a control".to_owned(),
        Some(answer::Kind::Fault(fault)) => fault.message.clone(),
    };
    Fault::of(FaultKind::Answer, format!("{found}, expected {expected}"))
}

/// Returns the message about how a session ended. The network's own text depends on timing, so it is left out.
fn end(status: &Status) -> String {
    let by_network = status.source().is_some() || matches!(status.code(), Code::Unavailable | Code::Cancelled);
    match status.message() {
        _ if by_network => "the driver closed the connection without an answer".to_owned(),
        "" => format!("the driver ended the session: {}", status.code()),
        message => format!("the driver ended the session: {message}"),
    }
}

/// Returns the error for a session that could not begin.
fn refusal(status: &Status) -> OpenError {
    match status.code() {
        Code::Unimplemented => OpenError::Foreign,
        _ if status.source().is_some() => OpenError::Foreign,
        _ => OpenError::Unusable(Fault::of(FaultKind::Lost, end(status))),
    }
}
