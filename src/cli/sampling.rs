//! The options that choose tests. `paracosm-fuzz run` and `paracosm-cover generate` share them.

use crate::generators::{Aim, DiscreteFamily, GeneratorError, Strategy};
use clap::Args;

/// The options of a strategy.
#[derive(Debug, Args)]
pub(super) struct Sampling {
    /// The seed of all random choices; a sequence is plain without a seed, and randomly shifted with a seed
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// The index of the first point of a sequence [default: 1 for halton, 0 for the others]
    #[arg(long, value_name = "N")]
    pub skip: Option<u64>,
    /// The family of rows that covers discrete parameters: ipog (a covering array), random (Proposition 3.2) or cross
    /// (all combinations) [default: ipog]
    #[arg(long, value_name = "FAMILY")]
    pub discrete: Option<String>,
    /// The probability with which random rows may miss a combination [default: 0.05]
    #[arg(long, value_name = "D")]
    pub delta: Option<f64>,
    /// The number of parameters that are covered together; if fewer are discrete, all their combinations [default: 2]
    #[arg(long, value_name = "K")]
    pub k: Option<usize>,
    /// Add tests until no row of discrete values has an empty box above this volume, with as few tests as possible; if
    /// --budget is too small, the largest box is made as small as possible
    #[arg(long, value_name = "E")]
    pub epsilon: Option<f64>,
    /// The measure that greedy makes small: dispersion or k-wise-dispersion [default: dispersion in continuous spaces
    /// and for each row of --discrete, else k-wise-dispersion]
    #[arg(long, value_name = "MEASURE")]
    measure: Option<String>,
}

impl Sampling {
    /// Returns the family of rows that the user chose.
    pub fn family(&self) -> Result<DiscreteFamily, GeneratorError> {
        let family: Option<DiscreteFamily> = self.discrete.as_deref().map(str::parse).transpose()?;
        family.unwrap_or_default().with_delta(self.delta)
    }

    /// Returns `true` if the user gave an option that only covering strategies have.
    pub fn says_how_to_cover(&self) -> bool {
        let named = self.discrete.is_some() || self.measure.is_some();
        named || self.skip.or(self.k.map(|k| k as u64)).is_some() || self.delta.or(self.epsilon).is_some()
    }

    /// Returns the measure that the strategy makes small, if the user gave the measure or a family of rows determines
    /// the measure.
    pub fn aim(&self, strategy: Strategy) -> Result<Option<Aim>, GeneratorError> {
        let said = self.measure.as_deref().map(str::parse).transpose()?;
        let wants_rows = self.discrete.is_some() && strategy.fills_holes();
        Ok(said.or(wants_rows.then_some(Aim::Dispersion)))
    }
}
