//! The options that say how tests are chosen, which `paracosm-fuzz run` and `paracosm-cover generate` share.

use crate::generators::{Aim, DiscreteFamily, GeneratorError, Strategy};
use clap::Args;

/// How a strategy chooses tests.
#[derive(Debug, Args)]
pub(super) struct Sampling {
    /// The source of all chance; sequences without it are plain, with it randomly shifted
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// The index of a sequence's first point [default: 1 for halton, 0 for the others]
    #[arg(long, value_name = "N")]
    pub skip: Option<u64>,
    /// How discrete parameters are covered: ipog (a covering array), random (Proposition 3.2) or cross (all combinations)
    /// [default: ipog]
    #[arg(long, value_name = "FAMILY")]
    pub discrete: Option<String>,
    /// The probability with which random rows may miss a combination [default: 0.05]
    #[arg(long, value_name = "D")]
    pub delta: Option<f64>,
    /// How many parameters are covered together; where fewer are discrete, all combinations of these [default: 2]
    #[arg(long, value_name = "K")]
    pub k: Option<usize>,
    /// Go on until no row of discrete values has an empty box above this volume, with as few tests as that takes; where
    /// --budget is too small, the largest is made as small as can be
    #[arg(long, value_name = "E")]
    pub epsilon: Option<f64>,
    /// What greedy makes small: dispersion or k-wise-dispersion [default: dispersion of continuous spaces and for each
    /// row of --discrete, k-wise-dispersion of others]
    #[arg(long, value_name = "MEASURE")]
    measure: Option<String>,
}

impl Sampling {
    /// The family of rows that is asked for.
    pub fn family(&self) -> Result<DiscreteFamily, GeneratorError> {
        let family: Option<DiscreteFamily> = self.discrete.as_deref().map(str::parse).transpose()?;
        family.unwrap_or_default().with_delta(self.delta)
    }

    /// Whether anything is said that only strategies can do that cover the space.
    pub fn says_how_to_cover(&self) -> bool {
        let named = self.discrete.is_some() || self.measure.is_some();
        named || self.skip.or(self.k.map(|k| k as u64)).is_some() || self.delta.or(self.epsilon).is_some()
    }

    /// The measure that the strategy is to make small, if that is said or follows: who names a family wants its rows.
    pub fn aim(&self, strategy: Strategy) -> Result<Option<Aim>, GeneratorError> {
        let said = self.measure.as_deref().map(str::parse).transpose()?;
        let wants_rows = self.discrete.is_some() && strategy == Strategy::GREEDY;
        Ok(said.or(wants_rows.then_some(Aim::Dispersion)))
    }
}
