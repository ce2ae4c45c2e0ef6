//! Observers watch a campaign: a log, a progress bar, an early stop.

use crate::scales::Learned;
use crate::{Error, Trial};
use std::ops::ControlFlow;

/// An observer of a campaign, which sees every trial and can end the campaign. An observer sees every trial in the
/// order of the indices, whatever the number of threads. It may end the campaign, but changes nothing about its tests.
///
/// A closure that takes a `&Trial` is an observer that sees new trials.
pub trait Observer {
    /// Is called when the campaign begins.
    ///
    /// # Errors
    /// An error of the observer ends the campaign.
    fn begun(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// Is called with each new trial, in the order of the indices.
    ///
    /// # Errors
    /// An error of the observer ends the campaign.
    fn trial(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error>;

    /// Is called with each trial that was run before the campaign was resumed. These trials come before the new ones.
    ///
    /// # Errors
    /// An error of the observer ends the campaign.
    fn known(&mut self, _trial: &Trial) -> Result<ControlFlow<()>, Error> {
        Ok(ControlFlow::Continue(()))
    }

    /// Is called when the campaign has run its last test. The results that are derived from the trials come next.
    ///
    /// # Errors
    /// An error of the observer ends the work.
    fn ended(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// Is called with all learned scales each time the campaign has learned the scale of a requirement that states no
    /// scale.
    ///
    /// # Errors
    /// An error of the observer ends the campaign.
    fn learned(&mut self, _scales: &Learned) -> Result<(), Error> {
        Ok(())
    }
}

impl<F: FnMut(&Trial)> Observer for F {
    fn trial(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error> {
        self(trial);
        Ok(ControlFlow::Continue(()))
    }
}

/// Ends a campaign with the first test that violates a requirement.
pub(crate) struct FirstFailure;

impl Observer for FirstFailure {
    fn trial(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error> {
        Ok(if trial.is_failure() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    fn known(&mut self, trial: &Trial) -> Result<ControlFlow<()>, Error> {
        self.trial(trial)
    }
}
