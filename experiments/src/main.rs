//! The studies of the paper and ours, each by name.
//!
//! A study writes its figures as SVG and PNG and every number behind them as CSV, and prints what it found.

mod fig9;
mod recovery;

use clap::Parser;
use paracosm::coverage::nearest;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

type Done = Result<(), Box<dyn Error + Send + Sync>>;

/// A study that can be run.
struct Study {
    name: &'static str,
    about: &'static str,
    /// On a machine with two cores.
    time: &'static str,
    run: fn(&Path) -> Done,
}

const STUDIES: [Study; 1] = [Study {
    name: "fig9",
    about: "the paper's Figure 9: random against Halton sampling of the pedestrian study, at 25, 100 and 500 tests",
    time: "15 s",
    run: fig9::run,
}];

/// Runs a study of the paper or of ours.
#[derive(Debug, Parser)]
#[command(
    name = "paracosm-experiments",
    after_help = "Example:\n  cargo run --release -p paracosm-experiments -- fig9"
)]
struct Arguments {
    /// The study, or `list`
    name: String,
    /// Where to write [default: experiments/out/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Done {
    if arguments.name == "list" {
        for Study { name, about, time, .. } in &STUDIES {
            println!("{name:<10}{time:<8}{about}");
        }
        return Ok(());
    }
    let Some(study) = STUDIES.iter().find(|study| study.name == arguments.name) else {
        let names = STUDIES.iter().map(|study| study.name);
        let hint = nearest(&arguments.name, names).map(|name| format!(" (did you mean `{name}`?)"));
        let hint = hint.unwrap_or_default();
        return Err(format!("no study is called `{}`{hint}; `list` shows them all", arguments.name).into());
    };
    let default = || Path::new("experiments/out").join(study.name);
    let out = arguments.out.clone().unwrap_or_else(default);
    fs::create_dir_all(&out).map_err(|error| format!("cannot create {}: {error}", out.display()))?;
    (study.run)(&out)?;
    eprintln!("written to {}", out.display());
    Ok(())
}
