//! Makes certificates: the sizes of the largest holes that `paracosm-cover estimate` reports, in a form that others
//! can check without trusting this software.
//!
//! A certificate stands alone. It holds the coordinates of the tests. For each claim it holds an empty box, which
//! shows that the volume is not smaller, and proofs that the volume is not larger, in the form that
//! [`paracosm_coverage::proof`] describes. `tests/check_certificate.py`, which shares no code with this software,
//! checks certificates.

use crate::estimate::{Holes, KwiseWorst, keeping, measure_holes, place};
use crate::{Coverage, Watch};
use paracosm_campaign::files::write_whole;
use paracosm_campaign::{Error, Reason, TestSet};
use paracosm_coverage::Measure;
use paracosm_coverage::dispersion::LargestEmptyBox;
use paracosm_coverage::kwise_dispersion::projections;
use paracosm_coverage::proof::{Budget, Proof, Proved, Scope, prove};
use paracosm_coverage::{Bracket, Deadline};
use paracosm_space::rules::Rules;
use paracosm_space::{Coordinate, Parameter, Value};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};
use thiserror::Error;

/// The version of the format of certificates.
const FORMAT: u32 = 1;

/// The greatest number of pivots in the proofs of one claim, which take some 30 MB.
const MOST_PIVOTS: usize = 5_000_000;

/// The relative difference up to which a proved bound counts as equal to the measured bound.
const ROUNDING: f64 = 1e-9;

/// The share of the time limit for the measures. The search for proofs has the rest.
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
    /// The constraints on the discrete parameters. The certificate holds only tests that satisfy the constraints.
    pub constraints: Vec<String>,
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
    /// The name of the measure, `dispersion` (over all continuous parameters) or `k-wise-dispersion` (over any k
    /// parameters).
    pub measure: String,
    /// The number of parameters in each combination of the k-wise dispersion; `None` for `dispersion`.
    pub k: Option<usize>,
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
    /// The place of the hole as parameter values.
    pub values: KwiseWorst,
}

/// A reason why no certificate can be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CertificateFlaw {
    /// A parameter has values marked `~`, which the system should reject and which a certificate does not support.
    #[error("a certificate does not support negative values (`~`): it counts every combination in a test as covered")]
    Negatives,
    /// A constraint depends on continuous parameters, which a certificate does not support.
    #[error(
        "a certificate does not support constraints on continuous parameters: it proves bounds on boxes of the whole space; \
         leave the certificate out, and `estimate` gives the bracket of the dispersion within the valid part"
    )]
    ValidPart,
    /// Neither `dispersion` nor `k-wise-dispersion` was measured.
    #[error(
        "a certificate proves the measures `dispersion`, which needs a continuous parameter, and `k-wise-dispersion`; \
         neither of the two was measured: add one of them"
    )]
    NoMeasure,
}

impl Reason for CertificateFlaw {}

/// A measured hole from which a claim is made.
struct Measured {
    scope: Scope,
    volume: Bracket,
    fixed: Vec<(usize, usize)>,
    axes: Vec<usize>,
    witness: Option<LargestEmptyBox>,
}

impl Certificate {
    /// Writes the certificate to a file, completely or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let mut text = serde_json::to_vec(self).expect("a certificate is always JSON");
        text.push(b'\n');
        write_whole(path, &text)
    }
}

/// Measures coverage as [`Coverage::of`] does, and makes a certificate of the measured dispersion and k-wise
/// dispersion. Both steps together keep the time limit.
///
/// # Errors
/// Returns an error if there are not `k` parameters or too many combinations of them to count, if neither of the two
/// measures is taken, or if a parameter has negative values.
pub fn certify(
    tests: &TestSet,
    measures: &[Measure],
    k: Option<usize>,
    limit: Option<Duration>,
    watch: &mut Watch,
) -> Result<(Coverage, Certificate), Error> {
    if !tests.demand.negatives.is_empty() {
        return Err(CertificateFlaw::Negatives.into());
    }
    if tests.space.checks_each_test() {
        return Err(CertificateFlaw::ValidPart.into());
    }
    let rules = tests.space.rules()?;
    let kept = keeping(tests, &tests.demand.kinds(&tests.space)?);
    if kept.points.len() < tests.points.len() {
        let (coverage, certificate) = certify(&kept, measures, k, limit, watch)?;
        let violating = tests.points.len() - kept.points.len();
        return Ok((Coverage { tests: tests.points.len(), violating, ..coverage }, certificate));
    }
    let end = limit.and_then(|limit| Instant::now().checked_add(limit));
    let (coverage, holes) = measure_holes(tests, measures, k, limit.map(|limit| limit.mul_f64(MEASURING)), watch)?;
    let measured = measured(tests, holes);
    if measured.is_empty() {
        return Err(CertificateFlaw::NoMeasure.into());
    }
    let waiting = measured.len() as u32;
    let claims = measured.into_iter().zip((1..=waiting).rev()).map(|(measured, waiting)| {
        let left = end.map(|end| end.saturating_duration_since(Instant::now()));
        let deadline = left.map_or_else(Deadline::never, |left| Deadline::after(left / waiting));
        claim(tests, measured, &rules, deadline)
    });
    let claims = claims.collect::<Result<_, _>>()?;
    let ends = |parameter: &Parameter| [0.0, 1.0].map(|u| parameter.value_at(u));
    let interval = |c: Coordinate| ParameterInterval { name: c.name(), interval: ends(c.parameter) };
    let values = |parameter: &Parameter| parameter.levels().unwrap_or_default().to_vec();
    let choice = |c: Coordinate| Choice { name: c.name(), values: values(c.parameter) };
    let certificate = Certificate {
        format: FORMAT,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        continuous: tests.space.continuous().map(interval).collect(),
        discrete: tests.space.discrete().map(choice).collect(),
        coordinates: tests.points.iter().map(|point| point.continuous.clone()).collect(),
        levels: tests.points.iter().map(|point| point.discrete.clone()).collect(),
        constraints: tests.space.constraints().iter().map(|constraint| constraint.text().to_owned()).collect(),
        claims,
    };
    Ok((coverage, certificate))
}

/// Returns the measured holes whose bounds are to be proved. The harder one is last: it has all the time that is
/// left.
fn measured(tests: &TestSet, holes: Holes) -> Vec<Measured> {
    let whole = holes.dispersion.map(|found| Measured {
        scope: Scope::Continuous,
        volume: found.volume,
        fixed: Vec::new(),
        axes: (0..tests.space.dims()).collect(),
        witness: Some(found.witness),
    });
    let k_wise = holes.k_wise.map(|(k, found)| Measured {
        scope: Scope::Every(k),
        volume: found.volume,
        fixed: found.fixed,
        axes: found.axes,
        witness: found.witness,
    });
    k_wise.into_iter().chain(whole).collect()
}

fn claim(tests: &TestSet, measured: Measured, rules: &Rules, deadline: Deadline) -> Result<Claim, Error> {
    let Measured { scope, volume, fixed, axes, witness } = measured;
    let budget = Budget { pivots: MOST_PIVOTS, deadline };
    let proved = prove(tests.space.dims(), rules, &tests.points, scope, volume, budget)?;
    let weaker = proved.upper > volume.upper * (1.0 + ROUNDING) || (proved.upper >= 1.0 && volume.lower < 1.0);
    let note = weaker.then(|| {
        format!(
            "the volume was found to be at most {}; no proof of this bound was found within {MOST_PIVOTS} boxes and the time \
             limit",
            volume.upper
        )
    });
    let witness = (volume.lower > 0.0).then(|| {
        let values = place(tests, &fixed, &axes, witness.as_ref());
        let corners = witness.map(|found| (found.lower, found.upper));
        let (lower, upper) = corners.unwrap_or_default();
        Witness { fixed, axes, lower, upper, values }
    });
    let (measure, k, excluded) = match scope {
        Scope::Continuous => (Measure::DISPERSION, None, Vec::new()),
        Scope::Every(k) => (Measure::K_WISE_DISPERSION, Some(k), excluded(tests, rules, k)?),
    };
    let Proved { upper, proofs } = proved;
    Ok(Claim { measure: measure.name().to_owned(), k, lower: volume.lower, witness, excluded, upper, note, proofs })
}

/// Returns the combinations of values of at most k discrete parameters that constraints exclude.
fn excluded(tests: &TestSet, rules: &Rules, k: usize) -> Result<Vec<Vec<(usize, usize)>>, Error> {
    if tests.space.constraints().is_empty() {
        return Ok(Vec::new());
    }
    let free = Rules::free(rules.levels());
    let every = projections(tests.space.dims(), &free, k)?;
    let excluded: BTreeSet<_> =
        every.map(|projection| projection.fixed).filter(|fixed| !rules.is_valid(fixed)).collect();
    Ok(excluded.into_iter().collect())
}
