//! Says how well a set of tests covers its space.

fn main() -> std::process::ExitCode {
    paracosm::cli::cover(&paracosm::catalogue())
}
