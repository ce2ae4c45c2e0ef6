//! Tests a driver over the open parameters of a scenario.

fn main() -> std::process::ExitCode {
    paracosm::cli::fuzz(&paracosm::catalogue())
}
