//! Shows results: figures, tables, CSV, JUnit, LaTeX, films, and recorded data sets.
//!
//! Other crates run tests and analyse their results. This crate turns the results into files that people and other
//! programs can read.
//!
//! ```
//! use paracosm_campaign::{Campaign, Catalogue, Study};
//! use paracosm_report::{FailureMap, Picture};
//!
//! let catalogue = Catalogue::of(paracosm_scenarios::ALL);
//! let study = Study::of(catalogue.find("pedestrian-crossing")?).budget(10).build()?;
//! let log = Campaign::new(&study)?.into_log()?;
//! let map = FailureMap::of(&log).expect("the study has two continuous parameters");
//! assert_eq!(map.marks.len(), 10);
//! let svg = Picture::of(map).svg()?;
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
//! ```

pub mod bench;
pub mod birds_eye;
pub mod blame;
pub mod compare;
pub mod hole;
pub mod html;
pub mod junit;
mod margin;
#[cfg(feature = "mcap")]
pub mod mcap;
pub mod plot;
#[cfg(feature = "camera")]
pub mod record;
mod step_summary;
pub mod traceability;
mod trials;
#[cfg(feature = "viewer")]
pub mod viewer;
mod with_units;
pub mod write_up;
mod xml;

pub use blame::BlameTable;
pub use junit::{Junit, command_option, shell_word};
pub use plot::{
    Axis, Entry, FailureMap, HeatMap, Mark, Picture, PlotFrame, Series, Shares, Tints, drawing_png, film_gif,
};
pub use step_summary::StepSummary;
pub use trials::TrialTable;
