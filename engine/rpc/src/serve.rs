//! A server for drivers that are written in Rust.

use crate::PROTOCOL;
use crate::wire::{self, answer, request};
use paracosm_engine::driver::{Driver, Fault};
use paracosm_engine::sensor::{Cameras, Image, Rig};
use paracosm_engine::{Briefing, Control, Observation, panic_message};
use std::collections::BTreeMap;
use std::io;
use std::net::TcpListener;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio_stream::wrappers::{TcpListenerStream, UnboundedReceiverStream};
use tonic::transport::Server;
use tonic::{Response, Status, Streaming};
use wire::driver_server::{Driver as Service, DriverServer};

/// The number of bytes that may be on their way before they are read: an image or two.
const WINDOW: u32 = 1 << 24;

/// The seed and the settings that a client asks for at the beginning of a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SessionOptions {
    /// The seed of all randomness of the driver.
    pub seed: u64,
    /// The driver's settings by their names.
    pub settings: BTreeMap<String, f64>,
}

/// A function that makes a driver for each session.
type Make = dyn Fn(&SessionOptions) -> Result<Box<dyn Driver>, Fault> + Send + Sync;

/// Serves drivers to every client, one driver for each session, until the process ends.
///
/// The drivers get the true states of the other bodies, and may have cameras. A driver with a rig is refused when its
/// session begins, because the readings of a rig stay in the process that simulates.
///
/// ```no_run
/// use paracosm_engine::driver::{Fault, find};
///
/// let listener = std::net::TcpListener::bind("127.0.0.1:50051")?;
/// paracosm_rpc::serve(listener, "my brakes", |_| {
///     find("aeb").and_then(|kind| kind.build(&[])).map_err(|error| Fault::new(error.to_string()))
/// })?;
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// The listener cannot be used, or the server fails.
pub fn serve(
    listener: TcpListener,
    name: &str,
    make: impl Fn(&SessionOptions) -> Result<Box<dyn Driver>, Fault> + Send + Sync + 'static,
) -> io::Result<()> {
    listener.set_nonblocking(true)?;
    let drivers = DriverService { name: name.into(), make: Arc::new(make) };
    tokio::runtime::Builder::new_multi_thread().enable_all().build()?.block_on(async {
        let incoming = TcpListenerStream::new(tokio::net::TcpListener::from_std(listener)?);
        let service = DriverServer::new(drivers).max_decoding_message_size(usize::MAX);
        let server = Server::builder().tcp_nodelay(true);
        let mut server = server.initial_stream_window_size(WINDOW).initial_connection_window_size(WINDOW);
        server.add_service(service).serve_with_incoming(incoming).await.map_err(io::Error::other)
    })
}

/// The gRPC service: it makes a driver for every session.
struct DriverService {
    name: Arc<str>,
    make: Arc<Make>,
}

#[tonic::async_trait]
impl Service for DriverService {
    type DriveStream = UnboundedReceiverStream<Result<wire::Answer, Status>>;

    async fn drive(
        &self,
        requests: tonic::Request<Streaming<wire::Request>>,
    ) -> Result<Response<Self::DriveStream>, Status> {
        let (answers, stream) = unbounded_channel();
        let (name, make) = (self.name.clone(), self.make.clone());
        tokio::spawn(attend(requests.into_inner(), answers, name, make));
        Ok(Response::new(UnboundedReceiverStream::new(stream)))
    }
}

/// Answers the requests of a session until the session ends.
async fn attend(
    mut requests: Streaming<wire::Request>,
    answers: UnboundedSender<Result<wire::Answer, Status>>,
    name: Arc<str>,
    make: Arc<Make>,
) {
    let mut state = None;
    while let Ok(Some(request)) = requests.message().await {
        let answer = tokio::task::block_in_place(|| {
            catch_unwind(AssertUnwindSafe(|| answer(&mut state, request.kind, &name, &*make)))
                .unwrap_or_else(|panic| Err(Fault::new(format!("the driver panicked: {}", panic_message(&*panic)))))
        });
        let gave_up = answer.is_err();
        let kind = answer.unwrap_or_else(|Fault { message, .. }| answer::Kind::Fault(wire::Fault { message }));
        if answers.send(Ok(wire::Answer { kind: Some(kind) })).is_err() || gave_up {
            return;
        }
    }
}

/// The driver of a session, with its cameras and its latest observation.
struct SessionState {
    driver: Box<dyn Driver>,
    cameras: Cameras,
    observation: Observation,
}

fn answer(
    state: &mut Option<SessionState>,
    request: Option<request::Kind>,
    name: &str,
    make: &Make,
) -> Result<answer::Kind, Fault> {
    match (request, state) {
        (Some(request::Kind::Hello(hello)), state @ None) => {
            let mut driver =
                make(&SessionOptions { seed: hello.seed, settings: hello.settings.into_iter().collect() })?;
            let equipment = driver.equipment();
            if !equipment.rig.is_empty() {
                return Err(Fault::new(
                    "the driver has sensors other than cameras, which cannot be served over gRPC; expected a driver with cameras only",
                ));
            }
            let cameras = equipment.cameras;
            let welcome = wire::Welcome {
                protocol: PROTOCOL,
                name: name.to_owned(),
                period: driver.period(),
                others: true,
                cameras: cameras.all.iter().map(wire::Camera::from).collect(),
                look: cameras.look.name().to_owned(),
                ..wire::Welcome::default()
            };
            *state = Some(SessionState { driver, cameras, observation: Observation::default() });
            Ok(answer::Kind::Welcome(welcome))
        }
        (Some(request::Kind::Reset(reset)), Some(state)) => {
            state.driver.reset(&Briefing::from(&reset))?;
            Ok(answer::Kind::Ready(wire::Ready {}))
        }
        (Some(request::Kind::Step(step)), Some(state)) => {
            let Control { throttle, steering } = state.step(step)?;
            Ok(answer::Kind::Control(wire::Control { throttle, steering }))
        }
        _ => Err(Fault::new("the client sent a request out of order; expected one hello, then resets and steps")),
    }
}

impl SessionState {
    fn step(&mut self, step: wire::Step) -> Result<Control, Fault> {
        wire::read(&step, &mut self.observation);
        let names: Vec<&String> = self.cameras.all.keys().collect();
        let image = |image: wire::Image| {
            let camera = names.iter().position(|name| **name == image.camera)?;
            let wire::Image { number, time, width, height, rgb, .. } = image;
            Some(Image { camera, number, time, width, height, rgb: rgb.into() })
        };
        let images: Vec<Image> = step.images.into_iter().filter_map(image).collect();
        self.driver.perceive(&Rig::default(), &images)?;
        self.driver.step(&self.observation)
    }
}
