//! A scenario of one's own with all commands of `paracosm-fuzz`:
//!
//!     cargo run --release -- jogger --budget 100
//!     cargo run --release -- blame paracosm-out

mod jogger;

fn main() -> std::process::ExitCode {
    let jogger = paracosm::engine::Program::new("jogger", "a jogger crosses the road", jogger::jogger);
    paracosm::cli::fuzz(&paracosm::catalogue().with(jogger))
}
