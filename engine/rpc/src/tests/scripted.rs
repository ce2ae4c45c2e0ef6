//! A server that answers as a test says.

use crate::Address;
use crate::wire::{self, answer, request};
use std::net::TcpListener;
use std::sync::Arc;
use tokio::sync::mpsc::unbounded_channel;
use tokio_stream::wrappers::{TcpListenerStream, UnboundedReceiverStream};
use tonic::transport::Server;
use tonic::{Response, Status, Streaming};
use wire::driver_server::{Driver, DriverServer};

/// What a scripted driver does when it is asked.
pub enum Act {
    Say(answer::Kind),
    /// Waits for ever.
    Nothing,
    /// Ends the session.
    Leave,
    /// Ends it with this status.
    Fail(Status),
}

type Script = dyn Fn(&request::Kind) -> Act + Send + Sync;

struct Scripted(Arc<Script>);

/// Serves a script until the tests end.
pub fn scripted(script: impl Fn(&request::Kind) -> Act + Send + Sync + 'static) -> Address {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    listener.set_nonblocking(true).unwrap();
    let address = listener.local_addr().unwrap().into();
    let service = DriverServer::new(Scripted(Arc::new(script)));
    std::thread::spawn(|| {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let incoming = TcpListenerStream::new(tokio::net::TcpListener::from_std(listener).unwrap());
            Server::builder().add_service(service).serve_with_incoming(incoming).await
        })
    });
    address
}

/// A welcome that asks for nothing.
pub fn welcome() -> wire::Welcome {
    wire::Welcome { protocol: 1, name: "scripted".into(), period: 0.1, ..Default::default() }
}

/// Says that, and is ready for everything.
pub fn ready(welcome: wire::Welcome, step: impl Fn(&wire::Step) -> Act) -> impl Fn(&request::Kind) -> Act {
    move |kind| match kind {
        request::Kind::Hello(_) => Act::Say(answer::Kind::Welcome(welcome.clone())),
        request::Kind::Reset(_) => Act::Say(answer::Kind::Ready(wire::Ready {})),
        request::Kind::Step(asked) => step(asked),
    }
}

#[tonic::async_trait]
impl Driver for Scripted {
    type DriveStream = UnboundedReceiverStream<Result<wire::Answer, Status>>;

    async fn drive(
        &self,
        requests: tonic::Request<Streaming<wire::Request>>,
    ) -> Result<Response<Self::DriveStream>, Status> {
        let (answers, stream) = unbounded_channel();
        let (mut requests, script) = (requests.into_inner(), self.0.clone());
        tokio::spawn(async move {
            while let Ok(Some(request)) = requests.message().await {
                let answer = match script(&request.kind.unwrap()) {
                    Act::Say(kind) => Ok(wire::Answer { kind: Some(kind) }),
                    Act::Nothing => continue,
                    Act::Leave => return,
                    Act::Fail(status) => Err(status),
                };
                let _ = answers.send(answer);
            }
        });
        Ok(Response::new(UnboundedReceiverStream::new(stream)))
    }
}
