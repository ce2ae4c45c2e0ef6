//! Runs the studies of the paper and our own, each by its name.
//!
//! A study writes its numbers as CSV and prints its findings. The study `figures` draws the charts of the pages from these files. Systems of
//! a benchmark can be tested from the command line.

mod alks;
mod audit;
mod boundary;
#[cfg(feature = "neural")]
mod braked;
#[cfg(feature = "neural")]
mod cloning;
#[cfg(feature = "neural")]
mod crossing;
mod drivers;
#[cfg(feature = "neural")]
mod fig10a;
#[cfg(feature = "neural")]
mod fig10b;
#[cfg(feature = "neural")]
mod fig10c;
mod fig9;
#[cfg(feature = "neural")]
mod fig9_cnn;
mod fig9_sides;
mod figures;
mod propositions;
mod reasons;
mod recalls;
mod recovery;
#[cfg(feature = "neural")]
mod saliency;
mod samplers;
mod sampling;
mod searches;
mod systems;
#[cfg(feature = "neural")]
mod vision;

use clap::Parser;
use indicatif::ProgressBar;
use paracosm::campaign::Learned;
use paracosm::space::{did_you_mean, nearest};
use paracosm::{Campaign, Log, StudyBuilder, Trial};
use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

type Done = Result<(), Box<dyn Error + Send + Sync>>;

/// Begins a study of a scenario that comes with the software.
fn scenario(name: &str) -> Result<StudyBuilder, paracosm::Error> {
    Ok(paracosm::Study::of(paracosm::catalogue().find(name)?))
}

/// Runs the tests of a study. The bar advances by one for each test.
fn logged(study: &paracosm::Study, bar: &ProgressBar) -> Result<Log, paracosm::Error> {
    let mut trials = Vec::new();
    let mut note = |trial: &Trial| {
        bar.inc(1);
        trials.push(trial.clone());
    };
    Campaign::new(study)?.run(&mut [&mut note])?;
    Ok(Log::new(study.clone(), Learned::new(), None, trials))
}

/// A study that can be run.
struct Study {
    name: &'static str,
    about: &'static str,
    /// The time that the study takes on a machine with two cores.
    time: &'static str,
    run: fn(&Path, &ProgressBar) -> Done,
}

const STUDIES: &[Study] = &[
    Study {
        name: "alks",
        about: "drivers in all combinations of the parameters of UN R157, whose scenarios have to lie beside the repository",
        time: "20 min",
        run: alks::run,
    },
    Study {
        name: "audit",
        about: "what the grids of UN R157 and Euro NCAP cannot see: holes, witnesses, mutants, and better suites",
        time: "hours",
        run: audit::run_stated,
    },
    Study {
        name: "audit-strategies",
        about: "whether suites of even strategies kill more mutants than random suites, in all scenarios",
        time: "1 h",
        run: audit::run_strategies,
    },
    Study {
        name: "boundary",
        about: "how much of the pedestrian study's map is known after 25 to 400 tests, by boundary and by sampling",
        time: "2 min",
        run: boundary::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "conditions",
        about: "what hides a vehicle from detectors: pairs of conditions, a small change, the risk, and paired renders",
        time: "30 min",
        run: vision::conditions::run,
    },
    Study {
        name: "drivers",
        about: "every driver that comes with the software in 200 Halton tests of every scenario",
        time: "6 min",
        run: drivers::run,
    },
    Study {
        name: "drivers-reasons",
        about: "drivers again with other settings, and single tests, for the reasons of the page on drivers",
        time: "15 s",
        run: reasons::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig6",
        about: "the paper's Figures 5 and 6: networks that mark the road, at focal lengths of 10 to 50 mm",
        time: "2 min",
        run: vision::fig6::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig8",
        about: "the paper's Figures 7 and 8: detectors of vehicles in traffic, with a white truck that crosses",
        time: "2 min",
        run: vision::fig8::run,
    },
    Study {
        name: "fig9",
        about: "the paper's Figure 9: random against Halton sampling of the pedestrian study, at 25, 100 and 500 tests",
        time: "15 s",
        run: fig9::run,
    },
    Study {
        name: "fig9-sides",
        about: "the pedestrian study of Figure 9 from both sides, with an acceleration, and with other noise of the sensor",
        time: "30 s",
        run: fig9_sides::run,
    },
    Study {
        name: "fig9-recalls",
        about: "how much 200 sets of each of five strategies tell about the failures of both maps of Figure 9",
        time: "20 s",
        run: recalls::run,
    },
    Study {
        name: "figures",
        about: "the figures of the pages, drawn for one column of a paper from the CSV files of this repository",
        time: "2 s",
        run: figures::run,
    },
    Study {
        name: "propositions",
        about: "the paper's propositions on tests: random families that cover, and the dispersion of Halton's sequence",
        time: "3 s",
        run: propositions::run,
    },
    Study {
        name: "strategies",
        about: "which strategy finds failures, and whether a low dispersion helps, on problems that no choice was made on",
        time: "1 h",
        run: searches::run,
    },
    Study {
        name: "samplers",
        about: "which strategy covers a space most evenly: sixteen strategies by eight measures in 2 to 10 dimensions",
        time: "1 h",
        run: samplers::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "recall",
        about: "how many of the near cars each detector finds by day, with a frozen threshold",
        time: "10 min",
        run: vision::recall::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "train-road",
        about: "teaches the networks that mark the road, for Figure 6",
        time: "1 h",
        run: vision::road::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "train-vehicles",
        about: "teaches the detectors of vehicles, for Figure 8",
        time: "30 min",
        run: vision::vehicles::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "train-follow",
        about: "teaches the five networks that follow a leader, for Figures 10a and 10c",
        time: "25 min",
        run: |out, bar| cloning::run(&cloning::FOLLOW, out, bar),
    },
    #[cfg(feature = "neural")]
    Study {
        name: "train-stop",
        about: "teaches the five networks that stop for pedestrians who walk at 1 m/s, for Figure 9",
        time: "> 50 min",
        run: |out, bar| cloning::run(&cloning::STOP, out, bar),
    },
    #[cfg(feature = "neural")]
    Study {
        name: "train-loop",
        about: "teaches the five networks that turn right at T-intersections, for Figure 10b",
        time: "35 min",
        run: |out, bar| cloning::run(&cloning::LOOP, out, bar),
    },
    #[cfg(feature = "neural")]
    Study {
        name: "exams",
        about: "each network in 100 tests of its training conditions, compared with the expert who taught it and a driver that never brakes",
        time: "> 12 min",
        run: cloning::exam::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig9-cnn",
        about: "the paper's Figure 9: random against Halton sampling of the pedestrian study, with a cloned driver",
        time: "6 min",
        run: fig9_cnn::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig9-cnn-reference",
        about: "the reference map of fig9-cnn: 2,500 tests on a grid",
        time: "6 min",
        run: fig9_cnn::reference,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig9-cnn-braked",
        about: "the failures of fig9-cnn that a driver who never brakes would not have had, one by one",
        time: "20 s",
        run: braked::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig10a",
        about: "the paper's Figure 10a: five cloned drivers behind a slow leader, over fog and light",
        time: "17 min",
        run: fig10a::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig10b",
        about: "the paper's Figure 10b: round a loop of T-intersections in fog, by a cloned driver",
        time: "2 min",
        run: fig10b::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "fig10c",
        about: "the paper's Figure 10c: what five cloned drivers follow behind a red leader, with an oncoming red car, and behind a white leader",
        time: "80 s",
        run: fig10c::run,
    },
    #[cfg(feature = "neural")]
    Study {
        name: "saliency",
        about: "which pixels decide what a cloned driver does: the effect of covering each pixel, and whether red pixels make it brake",
        time: "1 min",
        run: saliency::run,
    },
];

/// Runs a study of the paper or of ours.
#[derive(Debug, Parser)]
#[command(
    name = "paracosm-experiments",
    after_help = "Example:\n  cargo run --release -p paracosm-experiments -- fig9"
)]
struct Arguments {
    /// The name of the study; `list` lists all; `system` answers tests from standard input, as a system under test
    name: String,
    /// The system that `system` runs, such as `chasing-cars`
    system: Option<String>,
    /// Let the system answer with the robustness of a formula, and not with a trace
    #[arg(long, value_name = "FORMULA", requires = "system")]
    spec: Option<String>,
    /// The folder to write to [default: experiments/out/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        // The reader closed the pipe that we print to, as `head` does. This is not an error.
        Err(error) if error.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe) => {
            ExitCode::SUCCESS
        }
        Err(error) => {
            let _ = writeln!(io::stderr(), "error: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Done {
    match (arguments.name.as_str(), arguments.system.as_deref()) {
        ("system", Some(name)) => return systems::serve::serve(name, arguments.spec.as_deref()),
        ("system", None) => {
            return Err(format!("`system` needs the name of a system: {}", systems::serve::listed()).into());
        }
        (_, Some(more)) => {
            return Err(
                format!("found the argument `{more}` after the name of the study, expected no more arguments").into()
            );
        }
        (_, None) => {}
    }
    if arguments.name == "list" {
        let line = |Study { name, about, time, .. }: &Study| format!("{name:<24}{time:<10}{about}\n");
        return print(&STUDIES.iter().map(line).collect::<String>());
    }
    let Some(study) = STUDIES.iter().find(|study| study.name == arguments.name) else {
        let names = STUDIES.iter().map(|study| study.name);
        let hint = did_you_mean(&nearest(&arguments.name, names));
        let without = if cfg!(feature = "neural") {
            ""
        } else {
            ", and this program was built without the studies of networks (feature `neural`)"
        };
        return Err(format!("no study is called `{}`{hint}; `list` shows all studies{without}", arguments.name).into());
    };
    let default = || Path::new("experiments/out").join(study.name);
    let out = arguments.out.clone().unwrap_or_else(default);
    fs::create_dir_all(&out).map_err(|error| format!("cannot create {}: {error}", out.display()))?;
    let bar = if arguments.quiet { ProgressBar::hidden() } else { ProgressBar::no_length() };
    (study.run)(&out, &bar)?;
    if !arguments.quiet {
        let _ = writeln!(io::stderr(), "written to {}", out.display());
    }
    Ok(())
}

/// Prints a result.
fn print(text: &str) -> Done {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    Ok(stdout.flush()?)
}

/// Writes a file of a study.
fn write(path: &Path, contents: impl AsRef<[u8]>) -> Done {
    fs::write(path, contents).map_err(|error| format!("cannot write {}: {error}", path.display()).into())
}
