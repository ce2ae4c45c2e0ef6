//! Errors in defects.

use paracosm_space::did_you_mean;
use thiserror::Error;

/// An error in the kind or the size of a defect.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DefectError {
    /// No kind of defect has the given name.
    #[error("no kind of defect is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The name that no kind has.
        name: String,
        /// A known name that the user perhaps meant.
        nearest: Option<&'static str>,
    },
    /// The given size is not in the range of the kind.
    #[error("the size of the defect `{kind}` is {size}, expected a number from {} to {} ({unit})", range.0, range.1)]
    OutOfRange {
        /// The name of the kind.
        kind: &'static str,
        /// The size that the user gave.
        size: f64,
        /// The least and the greatest size of the kind.
        range: (f64, f64),
        /// The unit of the size.
        unit: &'static str,
    },
}
