//! When a run may end before its time: as soon as nothing that is asked of it can turn out otherwise any more.

use paracosm_oracles::{Formula, Monitor, Truth};

/// What has to be decided before a run may end.
pub(super) struct Early(Vec<Monitor>);

impl Early {
    /// These formulas over rows of these signals, `dt` seconds apart; `None` where one of them does not fit such a trace, so
    /// that it is never decided.
    pub fn new<'a>(formulas: impl Iterator<Item = &'a Formula>, signals: &[String], dt: f64) -> Option<Self> {
        formulas.map(|formula| Monitor::new(formula, signals, dt)).collect::<Result<_, _>>().ok().map(Self)
    }

    /// Learns the samples of the next tick; whether all is decided by now.
    pub fn step(&mut self, row: &[f64]) -> bool {
        // Each is told of every tick.
        self.0.iter_mut().fold(true, |all, monitor| {
            let decided = matches!(monitor.step(row), Ok(Truth::Holds | Truth::Violated));
            all && decided
        })
    }
}
