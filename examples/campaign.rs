//! The README's first campaign in Rust: `cargo run --release --example campaign`. Its folder has exactly the same bytes
//! as the folder that the program `paracosm-fuzz --out runs/example` writes.

use paracosm::{Error, Report, Study, Trial, catalogue, run_into};
use std::path::Path;

/// Runs the campaign, writes it to a folder, and prints each failure when it is found.
pub fn campaign(folder: &Path) -> Result<Report, Error> {
    let study = Study::of(catalogue().find("pedestrian-crossing")?).driver("aeb").budget(500).build()?;
    let mut show = |trial: &Trial| {
        if trial.is_failure() {
            println!("test {} fails", trial.index);
        }
    };
    run_into(&study, folder, &mut [&mut show])
}

/// Runs the campaign, and prints how many tests fail.
pub fn main() -> Result<(), Error> {
    let report = campaign(Path::new("runs/example"))?;
    println!("{} of {} tests fail", report.modes.failures, report.log.trials().len());
    Ok(())
}
