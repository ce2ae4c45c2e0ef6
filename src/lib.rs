//! PARACOSM: coverage-driven testing and falsification of autonomous driving systems.
//!
//! A [`Study`] says what is tested how: a scenario, a driver, the open parameters, a strategy and a budget. A
//! [`Campaign`] runs it, test by test on all cores, and writes every [`Trial`] down; [`Coverage`] says how well
//! the tests cover the space, and a [`FailureMap`] shows where they fail. The crates below each do one thing:
//! [`coverage`] measures, [`generators`] propose, [`engine`] simulates, [`oracles`] judge, [`scenarios`] are
//! the worlds.
//!
//! ```
//! use paracosm::{Campaign, Study};
//!
//! let study = Study::of("pedestrian-crossing")?.driver("aeb", &[])?.strategy("halton")?.budget(20)?;
//! let mut failures = 0;
//! Campaign::new(&study)?.run(|trial| {
//!     failures += usize::from(trial.is_failure());
//!     Ok(())
//! })?;
//! assert!(failures > 0);
//! # Ok::<(), paracosm::Error>(())
//! ```

pub mod bench;
mod black_box;
pub mod blame;
mod campaign;
pub mod certificate;
pub mod compare;
#[cfg(feature = "camera")]
mod darkroom;
#[cfg(not(feature = "camera"))]
#[path = "darkroom/none.rs"]
mod darkroom;
mod drivers;
mod error;
mod estimate;
mod executor;
mod expected;
mod explanation;
mod extension;
mod failure_estimate;
mod folder;
mod json;
pub mod junit;
pub mod likelihood;
mod live;
mod modes;
mod older;
mod plan;
mod plot;
mod process;
mod promise;
#[cfg(feature = "camera")]
pub mod record;
mod regression;
mod scales;
mod shrink;
mod simulator;
pub mod statistics;
mod steering;
mod study;
mod summary;
mod suspects;
mod tests_file;
mod trace_file;
mod traceability;
mod trial;
mod worker;
mod write_up;

#[cfg(feature = "cli")]
pub mod cli;

pub use black_box::BlackBox;
pub use campaign::Campaign;
pub use error::Error;
pub use estimate::{
    Ball, Continuous, Coverage, Discrete, Hole, KEpsilon, KwiseHole, KwiseWorst, Measure, Strength, Tests, Watch,
};
pub use explanation::{Accuracy, Explanation, Rule};
pub use extension::Extension;
pub use failure_estimate::FailureEstimate;
pub use folder::Folder;
pub use live::LiveCoverage;
pub use modes::{Extent, Mode, Modes, Touch};
pub use plan::{Guarantee, Need, Plan};
pub use plot::{Axis, FailureMap, HeatMap, Lines, Mark, Picture, Tints, drawing_png, film_gif};
pub use promise::Promise;
pub use regression::{Expectation, Regression, Replayed};
pub use shrink::{Change, Sameness, Shrunk};
pub use study::{Attribute, DriverChoice, Odd, RequirementText, Simulation, Study, Subject};
pub use summary::{Judged, Summary, Worst};
pub use suspects::{Conclusion, Located, Location, Suspect, Suspects, TestOfLocation, Unexplained};
pub use trace_file::{read_trace, write_trace};
pub use traceability::{Became, Gap, Traceability, Traced, Tried};
pub use trial::Trial;
pub use worker::Worker;

pub use paracosm_coverage as coverage;
pub use paracosm_engine as engine;
pub use paracosm_generators as generators;
pub use paracosm_oracles as oracles;
#[cfg(feature = "camera")]
pub use paracosm_render as render;
pub use paracosm_rpc as rpc;
pub use paracosm_scenarios as scenarios;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
