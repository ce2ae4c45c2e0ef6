//! A system under test in this process: a function answers each test.

use super::{Answer, AnswerFlaw};
use crate::{Problem, ProblemKind, Reason};
use paracosm_engine::panic_message;
use paracosm_space::Values;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use thiserror::Error;

/// The function of a system, which gets the index and the test.
type AnswerTest = dyn Fn(usize, &Values) -> Result<Answer, AnswerFlaw> + Send + Sync;

/// A system in this process. It has no function if the study was read from a file.
#[derive(Clone, Default)]
pub(super) struct Here(Option<Arc<AnswerTest>>);

/// The error that a study names a system in the process of another program.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the system `{system}` was a function of the program that ran the campaign: its tests can only be run by a program that has this function"
)]
pub struct NotHere {
    /// The name of the system.
    pub system: String,
}

impl Reason for NotHere {}

impl Here {
    pub fn new(answer: impl Fn(usize, &Values) -> Result<Answer, AnswerFlaw> + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(answer)))
    }

    /// Checks that the function of the system is there.
    pub fn check(&self, system: &str) -> Result<(), NotHere> {
        if self.0.is_some() { Ok(()) } else { Err(NotHere { system: system.to_owned() }) }
    }

    /// Asks the function. A panic is a problem of the test.
    pub fn ask(&self, system: &str, index: usize, test: &Values) -> Result<Answer, Problem> {
        let answer = self
            .0
            .as_ref()
            .ok_or_else(|| Problem::new(ProblemKind::System, NotHere { system: system.to_owned() }.to_string()))?;
        match catch_unwind(AssertUnwindSafe(|| answer(index, test))) {
            Ok(answered) => answered.map_err(|flaw| Problem::new(ProblemKind::Answer, flaw.to_string())),
            Err(panic) => {
                let message = format!("the system `{system}` panicked: {}", panic_message(&*panic));
                Err(Problem::new(ProblemKind::Panic, message))
            }
        }
    }
}

impl fmt::Debug for Here {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "a function of this process" } else { "a function of another process" })
    }
}

impl PartialEq for Here {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            (own, other) => own.is_none() && other.is_none(),
        }
    }
}
