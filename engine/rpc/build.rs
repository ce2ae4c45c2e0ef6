//! Makes messages of the protocol's description, without an installed protoc.

use protox::Compiler;
use std::path::Path;
use std::{env, error, fs};

const PROTO: &str = "paracosm/driver/v1/driver.proto";

fn main() -> Result<(), Box<dyn error::Error>> {
    println!("cargo:rerun-if-changed=proto");
    let mut compiler = Compiler::new(["proto"])?;
    compiler.open_file(PROTO)?;
    // What programs need that make messages at run time, as the Python package does.
    let descriptor = compiler.encode_file_descriptor_set();
    fs::write(Path::new(&env::var("OUT_DIR")?).join("driver.binpb"), descriptor)?;
    let with_comments = compiler.include_source_info(true).file_descriptor_set();
    tonic_prost_build::configure().bytes(".").compile_fds(with_comments)?;
    Ok(())
}
