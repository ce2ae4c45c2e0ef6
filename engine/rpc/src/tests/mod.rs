//! Both ends, held against each other and against servers that misbehave.

mod driving;
mod faults;
mod programs;
mod scripted;

use crate::{Address, OpenError, Session, Terms};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

fn terms() -> Terms {
    Terms { seed: 0, settings: Vec::new(), timeout: Duration::from_secs(20) }
}

fn open(address: &Address) -> Result<Session, OpenError> {
    Session::open(address, &terms(), Arc::default())
}

#[test]
fn addresses_are_read_as_they_are_written() {
    for text in ["grpc://127.0.0.1:50051", "grpc://[::1]:1", "grpc://driver.example-1.org:65535"] {
        assert_eq!(text.parse::<Address>().unwrap().to_string(), text);
    }
}

#[test]
fn what_is_no_address_is_refused_with_the_reason() {
    for (text, why) in [
        ("http://localhost:1", "does not begin with grpc://"),
        ("grpc://localhost", "no port"),
        ("grpc://localhost:0", "the port is no number"),
        ("grpc://localhost:65536", "the port is no number"),
        ("grpc://localhost:50051/", "the port is no number"),
        ("grpc://:50051", "the host is neither a name"),
        ("grpc://a b:50051", "the host is neither a name"),
        ("grpc://[::x]:50051", "the host is neither a name"),
    ] {
        let message = text.parse::<Address>().unwrap_err().to_string();
        assert!(message.contains(why) && message.contains("grpc://127.0.0.1:50051"), "{message}");
    }
}

/// Compares a file of the repository with what is made of `driver.proto`; with `UPDATE_GOLDEN=1` writes it instead.
fn is_of_the_protocol(path: &str, made: &[u8]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, made).unwrap();
    }
    let kept = std::fs::read(&path).unwrap_or_default();
    assert!(kept == made, "{} is of another driver.proto; UPDATE_GOLDEN=1 writes it anew", path.display());
}

/// The description of the protocol, without an installed protoc.
fn compiler() -> protox::Compiler {
    let mut compiler = protox::Compiler::new([concat!(env!("CARGO_MANIFEST_DIR"), "/proto")]).unwrap();
    compiler.open_file("paracosm/driver/v1/driver.proto").unwrap();
    compiler
}

#[test]
fn the_python_package_has_the_protocol_as_it_is_described() {
    is_of_the_protocol("../../python/src/paracosm/driver.binpb", &compiler().encode_file_descriptor_set());
}

#[test]
fn the_messages_are_generated_from_the_protocol_as_it_is_described() {
    let folder = tempfile::tempdir().unwrap();
    let with_comments = compiler().include_source_info(true).file_descriptor_set();
    let generator =
        tonic_prost_build::configure().bytes(".").btree_map(".paracosm.driver.v1.Camera").out_dir(folder.path());
    let generator = generator.server_mod_attribute(".", "#[cfg(feature = \"serve\")]");
    generator.compile_fds(with_comments).unwrap();
    let made = std::fs::read_to_string(folder.path().join("paracosm.driver.v1.rs")).unwrap();
    let why = "//! The messages of `driver.proto`, made from it by a test, so that a build needs no compiler of protocols.\n\n";
    is_of_the_protocol("src/wire/generated.rs", format!("{why}{made}").as_bytes());
}
