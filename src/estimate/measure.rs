//! What can be measured, by name.

use paracosm_coverage::{did_you_mean, nearest};
use std::str::FromStr;

/// A number that says how well tests cover a space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// The volume of the largest box without a test.
    Dispersion,
    /// The star discrepancy.
    Star,
    /// The extreme discrepancy.
    Extreme,
    /// The radius of the largest empty ball with its centre in the cube.
    Fill,
    /// The L2-star discrepancy.
    L2Star,
    /// The centered discrepancy, squared.
    Centered,
    /// The wraparound discrepancy, squared.
    Wraparound,
    /// The mixture discrepancy, squared.
    Mixture,
    /// The share of combinations of k discrete parameters that are covered, and for which epsilon the tests are
    /// (k, epsilon)-covering.
    KWise,
    /// The largest dispersion that any k parameters show.
    KWiseDispersion,
}

impl Measure {
    /// Every measure.
    pub const ALL: [Self; 10] = [
        Self::Dispersion,
        Self::Star,
        Self::Extreme,
        Self::Fill,
        Self::L2Star,
        Self::Centered,
        Self::Wraparound,
        Self::Mixture,
        Self::KWise,
        Self::KWiseDispersion,
    ];

    /// Those of the continuous parameters alone, in the order in which they are measured.
    pub(super) const CONTINUOUS: [Self; 8] = [
        Self::L2Star,
        Self::Centered,
        Self::Wraparound,
        Self::Mixture,
        Self::Dispersion,
        Self::Fill,
        Self::Star,
        Self::Extreme,
    ];

    /// The name by which it is asked for.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dispersion => "dispersion",
            Self::Star => "star",
            Self::Extreme => "extreme",
            Self::Fill => "fill",
            Self::L2Star => "l2_star",
            Self::Centered => "centered",
            Self::Wraparound => "wraparound",
            Self::Mixture => "mixture",
            Self::KWise => "k-wise",
            Self::KWiseDispersion => "k-wise-dispersion",
        }
    }
}

impl FromStr for Measure {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|measure| measure.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            let hint = did_you_mean(&nearest(name, names));
            format!("no measure is called `{name}`{hint}; there are {}", names.join(", "))
        })
    }
}
