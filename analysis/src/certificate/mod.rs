//! Makes certificates: the sizes of the largest holes that `paracosm-cover estimate` reports, in a form that others
//! can check without trusting this software.
//!
//! A certificate stands alone. It holds the coordinates of the tests. For each claim it holds an empty box, which
//! shows that the volume is not smaller, and proofs that the volume is not larger, in the form that
//! [`paracosm_coverage::proof`] describes. If constraints depend on continuous parameters, it also holds the valid parts of the
//! projections as trees of cells. `tests/check_certificate.py`, which shares no code with this software, checks certificates,
//! with each cell of a valid part.

mod draft;

pub(crate) use draft::{Draft, Measured};

use crate::estimate::{KwiseWorst, keeping, measure_holes};
use crate::{Coverage, Limit, Watch};
use paracosm_campaign::files::write_whole;
use paracosm_campaign::{Error, Reason, TestSet};
use paracosm_coverage::proof::{Budget, Proof};
use paracosm_coverage::valid::WrittenPart;
use paracosm_coverage::{Deadline, Measure};
use paracosm_space::Value;
use serde::{Deserialize, Serialize};
use std::path::Path;
use thiserror::Error;

/// The greatest number of pivots in the proofs of one claim, which take some 30 MB.
pub(crate) const MOST_PIVOTS: usize = 5_000_000;

/// The share of the limit for the measures. The search for proofs has the rest.
const MEASURING: f64 = 0.5;

/// A proof of the volumes of the largest holes (boxes without a test) in a set of tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// The version of the format in which the certificate is written.
    pub format: u32,
    /// The version of the software that made the certificate.
    pub version: String,
    /// The continuous parameters of the space of the tests.
    pub continuous: Vec<ParameterInterval>,
    /// The discrete parameters of the space of the tests.
    pub discrete: Vec<Choice>,
    /// The coordinates of each test, with a number in `[0,1]` for each continuous parameter.
    pub coordinates: Vec<Vec<f64>>,
    /// The levels of each test, with the position of the test's value for each discrete parameter.
    pub levels: Vec<Vec<usize>>,
    /// The constraints. The certificate holds only tests that satisfy the constraints.
    pub constraints: Vec<String>,
    /// The valid parts of projections, if constraints depend on continuous parameters.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<WrittenPart>,
    /// The holes that the certificate leaves out, in words; `None` if it leaves out none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The claims about the largest holes that the certificate proves.
    pub claims: Vec<Claim>,
}

/// A continuous parameter in a certificate, with its interval of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterInterval {
    /// The name of the continuous parameter.
    pub name: String,
    /// The parameter's values at the coordinates 0 and 1.
    pub interval: [f64; 2],
}

/// A discrete parameter in a certificate, with its values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// The name of the discrete parameter.
    pub name: String,
    /// The values of the discrete parameter, in the order of its levels.
    pub values: Vec<Value>,
}

/// A claim of a certificate, which gives a lower and an upper bound for the volume of the largest hole. A witness shows
/// the lower bound, and proofs show the upper bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    /// The name of the measure: `dispersion` (over all continuous parameters), `k-wise-dispersion` (over any k parameters) or
    /// `hole-of-row` (over all continuous parameters, in one row of discrete values).
    pub measure: String,
    /// The number of parameters in each combination of the k-wise dispersion; `None` for other measures.
    pub k: Option<usize>,
    /// The level of each discrete parameter of the row; `None` for other measures than `hole-of-row`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub row: Option<Vec<usize>>,
    /// The lower bound of the volume, which is the volume of the witness, or 0 if there is no witness.
    pub lower: f64,
    /// The largest hole that was found; `None` if no hole was found.
    pub witness: Option<Witness>,
    /// The combinations of values of discrete parameters that constraints exclude, as pairs of a parameter's position
    /// and a level. Nothing is claimed about these combinations.
    pub excluded: Vec<Vec<(usize, usize)>>,
    /// The proved upper bound of the volume of the largest hole.
    pub upper: f64,
    /// The reason why the proved upper bound is larger than the measured bound, if it is larger.
    pub note: Option<String>,
    /// The proofs of the upper bound, one proof for each projection; empty if the upper bound is 1.
    pub proofs: Vec<Proof>,
    /// The position of an earlier claim with the same points and the same valid part. Its proof is also the proof of this claim.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub like: Option<usize>,
}

/// A hole that shows the lower bound of a claim.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Witness {
    /// The discrete values of the hole, as pairs of a parameter's position among the discrete parameters and a level.
    pub fixed: Vec<(usize, usize)>,
    /// The continuous parameters over which the hole's box extends, as positions among the continuous parameters.
    pub axes: Vec<usize>,
    /// The lower corner of the hole's box, in coordinates.
    pub lower: Vec<f64>,
    /// The upper corner of the hole's box, in coordinates.
    pub upper: Vec<f64>,
    /// The valid part within which the box counts, as a position among the parts; `None` if the box counts for its volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<usize>,
    /// The place of the hole as parameter values.
    pub values: KwiseWorst,
}

/// A reason why no certificate can be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CertificateFlaw {
    /// A parameter has values marked `~`, which the system should reject and which a certificate does not support.
    #[error("a certificate does not support negative values (`~`): it counts every combination in a test as covered")]
    Negatives,
    /// Neither `dispersion` nor `k-wise-dispersion` was measured.
    #[error(
        "a certificate proves the measures `dispersion`, which needs a continuous parameter, and `k-wise-dispersion`; \
         neither of the two was measured: add one of them"
    )]
    NoMeasure,
}

impl Reason for CertificateFlaw {}

impl Certificate {
    /// Returns the certificate as JSON.
    pub fn to_json(&self) -> Vec<u8> {
        let mut text = serde_json::to_vec(self).expect("a certificate is always JSON");
        text.push(b'\n');
        text
    }

    /// Writes the certificate to a file, completely or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        write_whole(path, &self.to_json())
    }
}

/// Measures coverage as [`Coverage::of`] does, and makes a certificate of the measured dispersion and k-wise
/// dispersion. Both steps together keep the limit.
///
/// # Errors
/// Returns an error if there are not `k` parameters or too many combinations of them to count, if neither of the two
/// measures is taken, or if a parameter has negative values.
pub fn certify(
    tests: &TestSet,
    measures: &[Measure],
    k: Option<usize>,
    limit: Limit,
    watch: &mut Watch,
) -> Result<(Coverage, Certificate), Error> {
    limit.within(|deadline| certify_until(tests, measures, k, deadline, watch))?
}

fn certify_until(
    tests: &TestSet,
    measures: &[Measure],
    k: Option<usize>,
    end: Deadline,
    watch: &mut Watch,
) -> Result<(Coverage, Certificate), Error> {
    if !tests.demand.negatives.is_empty() {
        return Err(CertificateFlaw::Negatives.into());
    }
    let rules = tests.space.rules()?;
    let kept = keeping(tests, &tests.demand.kinds(&tests.space)?);
    if kept.points.len() < tests.points.len() {
        let (coverage, certificate) = certify_until(&kept, measures, k, end, watch)?;
        let violating = tests.points.len() - kept.points.len();
        return Ok((Coverage { tests: tests.points.len(), violating, ..coverage }, certificate));
    }
    let (coverage, holes) = measure_holes(tests, measures, k, end.part(MEASURING), watch)?;
    let mut draft = Draft::new(tests);
    let measured = draft.measured(&rules, holes, end)?;
    if measured.is_empty() {
        return Err(CertificateFlaw::NoMeasure.into());
    }
    let waiting = measured.len() as u32;
    for (measured, waiting) in measured.into_iter().zip((1..=waiting).rev()) {
        draft.prove(measured, Budget { pivots: MOST_PIVOTS, deadline: end.part(1.0 / f64::from(waiting)) });
    }
    Ok((coverage, draft.finish(None)))
}
