//! PARACOSM: coverage-driven testing and falsification of autonomous driving systems.
//!
//! A [`Study`] describes a campaign: a scenario, a driver, the open parameters, a strategy and a budget. [`run_into`]
//! runs the study on all cores. It writes a folder with every [`Trial`], the coverage of the space, the failure map and
//! the failure modes. Each crate below does one thing: [`space`] has parameters and constraints, [`coverage`] measures
//! sets of tests, [`generators`] propose tests, [`engine`] simulates a test, [`oracles`] judge a trace, [`scenarios`]
//! has the worlds, [`campaign`] runs a study, [`analysis`] reads its log, [`report`] draws figures and writes tables.
//!
//! ```
//! use paracosm::{Campaign, Study, Trial, catalogue};
//!
//! let study = Study::of(catalogue().find("pedestrian-crossing")?).driver("aeb").budget(20).build()?;
//! let mut failures = 0;
//! Campaign::new(&study)?.run(&mut [&mut |trial: &Trial| failures += usize::from(trial.is_failure())])?;
//! assert!(failures > 0);
//! # Ok::<(), paracosm::Error>(())
//! ```

#[cfg(feature = "cli")]
pub mod cli;
mod findings;
mod lists;
mod notes;
mod page;
mod runner;

pub use lists::Lists;
pub use notes::{capped_strength, notes_before};
pub use page::{Beside, OtherAudit};
pub use paracosm_campaign::{
    Campaign, Catalogue, Error, Finish, Folder, Log, Observer, Sampling, Study, StudyBuilder, Trial,
};
use paracosm_campaign::{ConcreteValue, Holds, Reader, Reason};
pub use runner::{NothingToLocate, Report, Runner, run_into};

pub use paracosm_analysis as analysis;
pub use paracosm_campaign as campaign;
pub use paracosm_coverage as coverage;
pub use paracosm_engine as engine;
pub use paracosm_generators as generators;
pub use paracosm_oracles as oracles;
pub use paracosm_perception as perception;
#[cfg(feature = "camera")]
pub use paracosm_render as render;
pub use paracosm_report as report;
pub use paracosm_rpc as rpc;
pub use paracosm_scenarios as scenarios;
pub use paracosm_space as space;
pub use paracosm_standards as standards;

use std::path::PathBuf;

/// Returns the catalogue of all scenarios that come with the software, which also reads files of OpenSCENARIO.
pub fn catalogue() -> Catalogue {
    Catalogue::of(scenarios::ALL).with(standards::map_traffic()).reading(PYTHON).reading(Reader {
        ending: "xosc",
        about: "scenarios and distributions of parameters of ASAM OpenSCENARIO XML",
        holds: Holds::Description,
        read: |file, _| {
            let scenario = standards::openscenario::Xosc::read(file);
            scenario.map(standards::openscenario::Xosc::program).map_err(|error| UnreadableScenario(error).into())
        },
        tests: Some(|scenario, files| {
            let scenario = standards::openscenario::Xosc::read(scenario).map_err(UnreadableScenario)?;
            let value = |(name, value, line)| ConcreteValue { name, value, line: line as usize };
            let test = |file: &PathBuf| {
                let values = scenario.test_in(file).map_err(UnreadableScenario)?;
                Ok(values.into_iter().map(value).collect())
            };
            files.iter().map(test).collect()
        }),
    })
}

/// The reader of scenarios in Python, which only says what to do: the Python package has another one in its place.
const PYTHON: Reader = Reader {
    ending: "py",
    about: "scenarios of Python, which need the Python package",
    holds: Holds::Programs,
    read: |file, _| Err(NeedsPython { file: file.to_owned() }.into()),
    tests: None,
};

/// The error that a scenario of Python was named in a program without Python.
#[derive(Debug, thiserror::Error)]
#[error("{} has scenarios of Python, which this program cannot read; the same program from the Python package can: pip install ./python", file.display())]
pub struct NeedsPython {
    file: PathBuf,
}

impl Reason for NeedsPython {}

/// The error that a file of a scenario cannot be read.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct UnreadableScenario(standards::ReadError);

impl Reason for UnreadableScenario {}

/// Runs the examples of the README as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Runs the examples of the page on extending the software as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/extending.md")]
struct Extending;
