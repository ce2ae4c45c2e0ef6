//! The server of a viewer: it answers browsers on this machine that have the secret of its address, and nobody else.
//!
//! A page of somebody else could send requests to this machine from the browser of the user. So the server listens at 127.0.0.1 alone, its
//! addresses begin with a secret, and a request with a foreign `Host` or `Origin` is refused, whatever its address is.

use super::{Answer, Desks, Question};
use axum::Router;
use axum::body::{Body, to_bytes};
use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_TYPE, HOST, ORIGIN, REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS, X_FRAME_OPTIONS,
};
use axum::http::{HeaderMap, HeaderName, Method, Response, StatusCode};
use paracosm_campaign::Reason;
use std::fmt;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use thiserror::Error;

/// The number of bytes of the secret.
const SECRET: usize = 16;

/// The longest question of a page in bytes.
const LONGEST: usize = 1 << 16;

/// The time between two looks at the flag that ends the server.
const PATIENCE: Duration = Duration::from_millis(50);

/// The error that the server cannot listen.
#[derive(Debug, Error)]
#[error("the viewer cannot listen at 127.0.0.1: {0}")]
pub struct NoServer(#[from] io::Error);

impl Reason for NoServer {}

/// A place at which browsers on this machine reach a viewer.
pub struct Doorway {
    listener: TcpListener,
    address: SocketAddr,
    secret: String,
}

/// The parts of a server that its answers need.
struct Desk {
    secret: String,
    /// The hosts by which a browser on this machine calls the server.
    hosts: [String; 2],
    desks: Desks,
}

impl Doorway {
    /// Makes a doorway at a port of 127.0.0.1, with a new secret. The port 0 stands for any free port.
    ///
    /// # Errors
    /// The port is not free, or the machine has no random numbers.
    pub fn at(port: u16) -> Result<Self, NoServer> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let mut bytes = [0; SECRET];
        getrandom::fill(&mut bytes).map_err(io::Error::other)?;
        let secret = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { address: listener.local_addr()?, listener, secret })
    }

    /// Passes questions to the desks until the flag is set.
    pub(super) fn open(self, desks: Desks, stop: &AtomicBool) -> Result<(), NoServer> {
        let port = self.address.port();
        let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        let desk = Arc::new(Desk { secret: self.secret, hosts, desks });
        let router = Router::new().fallback(answer).with_state(desk);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let ended = async {
                while !stop.load(Ordering::Relaxed) {
                    tokio::time::sleep(PATIENCE).await;
                }
            };
            // Nobody waits for connections that a browser keeps open.
            tokio::select! {
                served = async { axum::serve(listener, router).await } => served?,
                () = ended => {}
            }
            Ok(())
        })
    }
}

/// Writes the address of the page.
impl fmt::Display for Doorway {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "http://{}/{}/", self.address, self.secret)
    }
}

impl Desk {
    /// Returns the part of the path after the secret.
    fn admitted<'p>(&self, method: &Method, path: &'p str, headers: &HeaderMap) -> Result<&'p str, StatusCode> {
        let one = |name: HeaderName| {
            let mut all = headers.get_all(name).iter();
            (all.next().map(|value| value.to_str().unwrap_or("\0")), all.next().is_none())
        };
        let is_ours = |host: &str| self.hosts.iter().any(|ours| ours == host);
        let (host, is_one_host) = one(HOST);
        let (origin, is_one_origin) = one(ORIGIN);
        let has_our_origin =
            origin.is_none_or(|origin| origin.strip_prefix("http://").is_some_and(is_ours)) && is_one_origin;
        if !(host.is_some_and(is_ours) && is_one_host && has_our_origin) {
            return Err(StatusCode::FORBIDDEN);
        }
        let (secret, rest) = path.strip_prefix('/').and_then(|path| path.split_once('/')).unwrap_or_default();
        if !is_same(secret, &self.secret) {
            return Err(StatusCode::FORBIDDEN);
        }
        if ![Method::GET, Method::POST].contains(method) {
            return Err(StatusCode::METHOD_NOT_ALLOWED);
        }
        Ok(rest)
    }
}

/// Compares two texts in a time that does not tell where they differ.
fn is_same(found: &str, expected: &str) -> bool {
    let differs = found.bytes().zip(expected.bytes()).fold(0, |differs, (one, other)| differs | (one ^ other));
    found.len() == expected.len() && differs == 0
}

/// The kinds of answers.
const HTML: &str = "text/html; charset=utf-8";
const JSON: &str = "application/json";
const MP4: &str = "video/mp4";
const TEXT: &str = "text/plain; charset=utf-8";

async fn answer(State(desk): State<Arc<Desk>>, request: Request) -> Response<Body> {
    let (parts, body) = request.into_parts();
    let rest = match desk.admitted(&parts.method, parts.uri.path(), &parts.headers) {
        Ok(rest) => rest,
        Err(status) => return reply(status, TEXT, refusal(status).into()),
    };
    let question = match (&parts.method, rest) {
        (&Method::GET, "") => Question::Page,
        (&Method::POST, "ask") => {
            let Ok(bytes) = to_bytes(body, LONGEST).await else {
                let why = format!("the question has more than {LONGEST} bytes");
                return reply(StatusCode::PAYLOAD_TOO_LARGE, TEXT, why.into());
            };
            match Question::read(&bytes) {
                Ok(question) => question,
                Err(flaw) => return reply(StatusCode::BAD_REQUEST, TEXT, flaw.to_string().into()),
            }
        }
        _ => return reply(StatusCode::NOT_FOUND, TEXT, refusal(StatusCode::NOT_FOUND).into()),
    };
    match desk.desks.ask(question).await {
        Answer::Page(text) => reply(StatusCode::OK, HTML, text.into_bytes()),
        Answer::Json(text) => reply(StatusCode::OK, JSON, text.into_bytes()),
        Answer::Film(bytes) => reply(StatusCode::OK, MP4, bytes),
        Answer::Refused(why) => reply(StatusCode::UNPROCESSABLE_ENTITY, TEXT, why.into_bytes()),
    }
}

/// Says why a request is refused.
fn refusal(status: StatusCode) -> &'static str {
    match status {
        StatusCode::FORBIDDEN => "this is not the address of a page: open the address that `paracosm-fuzz view` prints",
        StatusCode::METHOD_NOT_ALLOWED => "expected the method GET for the page, or POST for a question at `ask`",
        _ => {
            "nothing is here: the page is at the address that `paracosm-fuzz view` prints, and takes questions at `ask`"
        }
    }
}

fn reply(status: StatusCode, kind: &'static str, bytes: Vec<u8>) -> Response<Body> {
    let headers = [
        (CONTENT_TYPE, kind),
        (CACHE_CONTROL, "no-store"),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        (REFERRER_POLICY, "no-referrer"),
        (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
        (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    ];
    let response =
        headers.into_iter().fold(Response::builder().status(status), |made, (name, value)| made.header(name, value));
    response.body(Body::from(bytes)).expect("the headers are valid")
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;
    use std::sync::mpsc::channel;

    #[test]
    fn only_a_browser_of_this_machine_that_knows_the_secret_is_admitted() {
        let (asked, _questions) = channel();
        let desks = Desks { pages: asked.clone(), runs: asked.clone(), errands: asked };
        let hosts = ["127.0.0.1:4000", "localhost:4000"].map(str::to_owned);
        let desk = Desk { secret: "5ec".to_owned(), hosts, desks };
        let admitted = |path: &str, host: &[&str], origin: &[&str]| {
            let mut headers = HeaderMap::new();
            for value in host {
                headers.append(HOST, HeaderValue::from_str(value).unwrap());
            }
            for value in origin {
                headers.append(ORIGIN, HeaderValue::from_str(value).unwrap());
            }
            desk.admitted(&Method::GET, path, &headers).ok().map(str::to_owned)
        };
        let own = ["127.0.0.1:4000"];
        assert_eq!(admitted("/5ec/run/3", &own, &[]).as_deref(), Some("run/3"));
        assert_eq!(admitted("/5ec/", &["localhost:4000"], &["http://localhost:4000"]).as_deref(), Some(""));
        for path in ["/", "", "/5ec", "/5e/run/3", "/5ecc/run/3", "//5ec/run/3", "/run/3", "/../5ec/"] {
            assert_eq!(admitted(path, &own, &[]), None, "{path}");
        }
        for host in
            [&[][..], &["evil.example:4000"], &["127.0.0.1:4001"], &["127.0.0.1"], &["127.0.0.1:4000", "evil.example"]]
        {
            assert_eq!(admitted("/5ec/", host, &[]), None, "{host:?}");
        }
        for origin in [
            &["null"][..],
            &["http://evil.example"],
            &["https://127.0.0.1:4000"],
            &["http://127.0.0.1:4000.evil.example"],
            &["http://127.0.0.1:4000", "null"],
        ] {
            assert_eq!(admitted("/5ec/", &own, origin), None, "{origin:?}");
        }
        assert_eq!(desk.admitted(&Method::DELETE, "/5ec/", &HeaderMap::new()), Err(StatusCode::FORBIDDEN));
    }

    #[test]
    fn each_doorway_has_a_secret_and_a_port_of_its_own() {
        let doorways = [Doorway::at(0).unwrap(), Doorway::at(0).unwrap()];
        let [one, other] = doorways.each_ref().map(ToString::to_string);
        assert!(one.starts_with("http://127.0.0.1:") && one.len() > 2 * SECRET + 20, "{one}");
        assert_ne!(one, other);
        assert_ne!(doorways[0].secret, doorways[1].secret);
    }
}
