//! Turns the log of a campaign into knowledge, such as coverage, failure modes, explanations, probabilities of failure
//! and blame. The crate also shrinks failing tests, plans numbers of tests and compares strategies.
//!
//! ```
//! use paracosm_analysis::{Coverage, Limit};
//! use paracosm_campaign::TestSet;
//! use paracosm_coverage::Measure;
//! use paracosm_generators::{Request, Strategy};
//! use paracosm_space::Space;
//!
//! let space = Space::unit_cube(2);
//! let points = Strategy::HALTON.build(&Request::new(&space, 100))?.ask(100);
//! let coverage = Coverage::of(&TestSet::new(space, points), &[Measure::DISPERSION], None, Limit::None)?;
//! let dispersion = coverage.continuous.and_then(|continuous| continuous.bracket(Measure::DISPERSION));
//! assert!(dispersion.is_some_and(|volume| volume.upper < 0.2));
//! # Ok::<(), paracosm_campaign::Error>(())
//! ```

pub mod asked;
pub mod audit;
pub mod bench;
pub mod blame;
pub mod certificate;
mod combinations;
pub mod compare;
pub mod difference;
pub mod effects;
pub mod estimate;
pub mod explanation;
pub mod failure_estimate;
mod growth;
mod impacts;
pub mod likelihood;
mod limit;
pub mod live;
pub mod modes;
pub mod perceived;
pub mod plan;
mod plausible;
pub mod points;
pub mod promise;
pub mod repetition;
pub mod sensitivity;
pub mod shrink;
pub mod statistics;
pub mod summary;
pub mod suspects;
pub mod traceability;

pub use difference::Difference;
pub use effects::{Effect, Effects, ParameterEffect};
pub use estimate::{
    Ball, Continuous, Coverage, Discrete, Hole, KEpsilon, KwiseHole, KwiseWorst, Measured, Strength, Watch,
};
pub use explanation::{Accuracy, Explanation, Inconclusive, Place, Rule};
pub use failure_estimate::FailureEstimate;
pub use growth::Growth;
pub use impacts::Impacts;
pub use limit::Limit;
pub use live::LiveCoverage;
pub use modes::{CriticalFigure, Mode, Modes, Touch, ValueRange};
pub use perceived::{Detected, Perceived, RangeRecall, Risk, Segmented};
pub use plan::{Guarantee, Need, Plan};
pub use plausible::Plausible;
pub use points::Points;
pub use promise::Promise;
pub use repetition::Repetition;
pub use shrink::{Change, Sameness, Shrunk};
pub use summary::{Judged, Summary, Worst};
pub use suspects::{Conclusion, LocatedReport, Location, NamedSuspect, SuspectReport, TestOfLocation, Unexplained};
pub use traceability::{Became, Gap, Traceability, Traced, Tried};
