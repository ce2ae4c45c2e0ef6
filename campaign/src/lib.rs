//! Runs campaigns: it turns a study into a log of tests and their results.
//!
//! A [`Study`] describes what is tested. [`Campaign::run`] runs the tests of a study and shows every [`Trial`] to its
//! [observers](Observer). A [`Folder`] stores the trials, and a [`Log`] holds the trials that were read from a folder
//! or kept in memory. A campaign gets its scenarios from a [`Catalogue`]; it knows none by itself.
//!
//! ```
//! use paracosm_campaign::{Campaign, Catalogue, Study};
//!
//! let catalogue = Catalogue::of(paracosm_scenarios::ALL);
//! let study = Study::of(catalogue.find("pedestrian-crossing")?).budget(4).build()?;
//! let log = Campaign::new(&study)?.into_log()?;
//! assert_eq!(log.trials().len(), 4);
//! # Ok::<(), paracosm_campaign::Error>(())
//! ```

mod artefact;
mod black_box;
#[cfg(feature = "camera")]
pub mod cameras;
mod campaign;
mod catalogue;
mod concrete;
mod conversation;
mod crew;
#[cfg(feature = "camera")]
pub mod darkroom;
#[cfg(not(feature = "camera"))]
#[path = "darkroom/none.rs"]
pub mod darkroom;
mod doubts;
mod drivers;
mod error;
pub mod executor;
mod expected;
mod extension;
pub mod files;
mod folder;
#[cfg(feature = "camera")]
pub mod gallery;
mod json;
mod json_text;
mod judge;
mod jury;
mod lock;
mod log;
mod merge;
mod observer;
pub mod perception;
mod process;
mod proposal;
mod regression;
mod run_in;
mod samples;
mod scales;
#[cfg(feature = "camera")]
pub mod seeing;
mod setting_names;
mod shard;
mod simulator;
mod space_file;
mod steering;
pub mod study;
mod study_file;
mod supervision;
mod test_set;
mod threads;
mod trace_file;
mod trial;
mod trials_file;
mod trust;
mod worker;

pub use artefact::{Artefact, JsonArtefact};
pub use black_box::{Answer, BlackBox};
pub use campaign::{Campaign, Finish};
pub use catalogue::{Catalogue, ConcreteValue, Holds, Reader, TestsOf};
pub use crew::Crew;
pub use doubts::{Doubts, Recovered};
pub use error::{BadFile, Error, Failure, Reason};
pub use expected::Expected;
pub use extension::{Extension, ExtensionRecord};
pub use folder::{DERIVED, Folder};
pub use json::{Number, differing_key};
pub use log::{Log, read_tests, read_tests_from};
pub use merge::merge;
pub use observer::Observer;
pub use process::end_all_processes;
pub use regression::{Expectation, Regression, Replayed};
pub use samples::trace_of;
pub use scales::{Learned, Scales};
pub use shard::Shard;
pub use simulator::Recording;
pub use space_file::{SpaceFile, is_model};
pub use steering::Steering;
pub use study::{NamedCommand, Sampling, StatedRequirement, Study, StudyBuilder, Subject};
pub use study_file::StudyFile;
pub use supervision::{Output, Supervision};
pub use test_set::{PartialRow, TestSet, tests_as_csv};
pub use threads::Threads;
pub use trace_file::{Skipped, read_trace, write_trace};
pub use trial::{Metric, Problem, ProblemKind, Trial};
pub use trust::Trust;
pub use worker::Worker;

/// The error types that [`Error::Use`] and [`BadFile`] hold as reasons.
pub mod reasons {
    pub use crate::black_box::{AnswerFlaw, NoSystem, NotHere, TimeoutFlaw};
    #[cfg(feature = "camera")]
    pub use crate::cameras::CameraFileFlaw;
    pub use crate::campaign::{ForeignTrial, OtherResult};
    pub use crate::catalogue::{AmbiguousScenario, NoScenarioFile, UnknownScenario, UntrustedScenario};
    pub use crate::concrete::{NoConcrete, NoFileOfScenario};
    pub use crate::conversation::NotStarted;
    pub use crate::crew::CrewFlaw;
    pub use crate::darkroom::Blind;
    pub use crate::drivers::{DriverAway, NoDriver};
    pub use crate::error::CsvFlaw;
    pub use crate::extension::OtherTests;
    pub use crate::files::{Exists, IsLink};
    pub use crate::folder::{FolderFlaw, NotYours};
    pub use crate::json_text::JsonFlaw;
    pub use crate::lock::InUse;
    pub use crate::log::HasSpace;
    pub use crate::process::CommandFlaw;
    pub use crate::proposal::{ForeignPoint, PointFlaw};
    pub use crate::regression::{NoRegressionName, RegressionFlaw};
    pub use crate::samples::TraceFlaw;
    pub use crate::shard::ShardFlaw;
    pub use crate::space_file::SpaceFileFlaw;
    pub use crate::study::{
        AppearanceFlaw, DriverFlaw, EntryFlaw, FormulaFlaw, MissingScenario, ModelFlaw, NetworkFlaw, NoScenario,
        NoSuchCommand, OddFlaw, ParameterMisuse, PerceiverFlaw, RateFlaw, RequirementFlaw, SamplingFlaw, SpecFlaw,
        TomlFlaw, Untrusted, UntrustedAddress, WithoutCameras,
    };
    pub use crate::study_file::FormatFlaw;
    pub use crate::test_set::{CellFlaw, HeaderFlaw, IsFolder, TooManyTests, WrongCell};
    pub use crate::trials_file::LogFlaw;
    pub use crate::worker::OtherTrace;
}

/// The target triple for which this software was built.
pub const TARGET: &str = env!("PARACOSM_TARGET");
