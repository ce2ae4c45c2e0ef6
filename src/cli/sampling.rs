//! The options that choose tests. `paracosm-fuzz run` and `paracosm-cover generate` share them.

use super::arguments::CHOSEN;
use crate::generators::{Aim, DiscreteFamily, GeneratorError, Strategy};
use clap::Args;

/// The options of a strategy.
#[derive(Debug, Args)]
pub(super) struct Sampling {
    /// The seed of all random choices
    ///
    /// Without a seed, a sequence is plain. With a seed, it is randomly shifted.
    #[arg(long, value_name = "N", help_heading = CHOSEN)]
    pub seed: Option<u64>,
    /// The first index of a sequence
    ///
    /// [default: 1 for halton, 0 for the others]
    #[arg(long, value_name = "N", help_heading = CHOSEN, hide_short_help = true)]
    pub skip: Option<u64>,
    /// The rows of discrete values
    ///
    /// The family of rows: ipog (a covering array), random (Proposition 3.2) or cross (all combinations) [default: ipog].
    #[arg(long, value_name = "FAMILY", help_heading = CHOSEN, hide_short_help = true)]
    pub discrete: Option<String>,
    /// The chance that random rows miss a combination
    ///
    /// This is the probability with which random rows may miss some combination [default: 0.05].
    #[arg(long, value_name = "D", help_heading = CHOSEN, hide_short_help = true)]
    pub delta: Option<f64>,
    /// Cover all combinations of K values [default: 2]
    ///
    /// If fewer parameters are discrete, all their combinations are covered.
    #[arg(long, value_name = "K", help_heading = CHOSEN)]
    pub k: Option<usize>,
    /// Leave no empty box above this volume
    ///
    /// Tests are added until no row of discrete values has an empty box above this volume, with as few tests as possible.
    /// If --budget is too small, the largest box is made as small as possible.
    #[arg(long, value_name = "E", help_heading = CHOSEN)]
    pub epsilon: Option<f64>,
    /// The measure that greedy makes small
    ///
    /// dispersion or k-wise-dispersion [default: dispersion in continuous spaces and for each row of --discrete, else
    /// k-wise-dispersion].
    #[arg(long, value_name = "MEASURE", help_heading = CHOSEN, hide_short_help = true)]
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
