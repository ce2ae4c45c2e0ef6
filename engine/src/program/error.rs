//! The reasons why a program cannot be run.

use crate::flaw::WorldFlaw;
use paracosm_space::SpaceError;
use thiserror::Error;

/// The reason why a program cannot be run.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum ProgramError {
    /// The program's parameters form no valid space, for example because two parameters have the same name.
    #[error("scenario `{program}`: {source}")]
    Parameters {
        /// The name of the scenario.
        program: String,
        /// The error in the parameters.
        source: SpaceError,
    },
    /// The program's world cannot be built.
    #[error("scenario `{program}`: {}", joined(.flaws))]
    World {
        /// The name of the scenario.
        program: String,
        /// The flaws of the world.
        flaws: Vec<WorldFlaw>,
    },
    /// The parameters that the program asks for differ from the parameters of the test.
    #[error("scenario `{program}` asked for other parameters than the test has; these are on one side only: {}", names.join(", "))]
    OtherParameters {
        /// The name of the scenario.
        program: String,
        /// The parameters that only the program or only the test has.
        names: Vec<String>,
    },
    /// The requirements of a test differ from the requirements that the program declared.
    #[error(
        "scenario `{program}` stated other requirements for this test than before; these are on one side only: {}; every test states the same \
         requirements",
        names.join(", ")
    )]
    OtherRequirements {
        /// The name of the scenario.
        program: String,
        /// The requirements that only the test or only the declaration has.
        names: Vec<String>,
    },
    /// The tick of a test, or its premise, differs from the declaration of the program.
    #[error("scenario `{program}` has {found} in this test, expected {expected} as before")]
    Other {
        /// The name of the scenario.
        program: String,
        /// The tick or the premise of the test, in words.
        found: String,
        /// The tick or the premise of the declaration, in words.
        expected: String,
    },
    /// The program failed before its world was complete.
    #[error("scenario `{program}` failed: {why}")]
    Failed {
        /// The name of the scenario.
        program: String,
        /// The reason that the program gave.
        why: String,
    },
    /// The program panicked when it built its world with nominal values.
    #[error("scenario `{program}` panicked with nominal values: {message}")]
    Panicked {
        /// The name of the scenario.
        program: String,
        /// The message of the panic.
        message: String,
    },
    /// The program panicked when it built its world for a test.
    #[error("scenario `{program}` panicked with the values of a test: {message}")]
    TestPanicked {
        /// The name of the scenario.
        program: String,
        /// The message of the panic.
        message: String,
    },
}

fn joined(flaws: &[WorldFlaw]) -> String {
    flaws.iter().map(WorldFlaw::to_string).collect::<Vec<_>>().join("; ")
}
