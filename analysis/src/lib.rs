//! A log to knowledge.

pub mod asked;
pub mod bench;
pub mod blame;
pub mod certificate;
pub mod compare;
pub mod estimate;
pub mod explanation;
pub mod failure_estimate;
pub mod likelihood;
pub mod live;
pub mod modes;
pub mod plan;
pub mod promise;
pub mod shrink;
pub mod statistics;
pub mod summary;
pub mod suspects;
pub mod traceability;

pub use estimate::{
    Ball, Continuous, Coverage, Discrete, Hole, KEpsilon, KwiseHole, KwiseWorst, Measured, Strength, Watch,
};
pub use explanation::{Accuracy, Explanation, Rule};
pub use failure_estimate::FailureEstimate;
pub use live::LiveCoverage;
pub use modes::{CriticalFigure, Mode, Modes, Touch, ValueRange};
pub use plan::{Guarantee, Need, Plan};
pub use promise::Promise;
pub use shrink::{Change, Sameness, Shrunk};
pub use summary::{Judged, Summary, Worst};
pub use suspects::{Conclusion, LocatedReport, Location, NamedSuspect, SuspectReport, TestOfLocation, Unexplained};
pub use traceability::{Became, Gap, Traceability, Traced, Tried};
