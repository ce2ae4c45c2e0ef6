//! Certificates: what `paracosm-cover estimate` says of the largest holes, in a form that others can check without
//! trusting this software.
//!
//! A certificate stands alone. It has the tests' coordinates; for each claim an empty box that shows that the number is
//! not smaller, and proofs that it is not larger, in the form that [`paracosm_coverage::proof`] describes.
//! `tests/check_certificate.py`, which shares nothing with this software, checks it.

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

/// The version of the form of certificates.
const FORMAT: u32 = 1;

/// How many pivots the proofs of one claim may have: some 30 MB of them.
const MOST_PIVOTS: usize = 5_000_000;

/// By how much, as a share, a bound may be above what was measured without being called another one.
const ROUNDING: f64 = 1e-9;

/// The share of a time limit that the measures have before proofs are looked for.
const MEASURING: f64 = 0.5;

/// How large the largest holes of a set of tests are, with proof.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// The version of this form.
    pub format: u32,
    /// The version of the software.
    pub version: String,
    /// The continuous parameters.
    pub continuous: Vec<ParameterInterval>,
    /// The discrete parameters.
    pub discrete: Vec<Choice>,
    /// Of each test a number in `[0,1]` for each continuous parameter.
    pub coordinates: Vec<Vec<f64>>,
    /// Of each test the position of its value for each discrete parameter.
    pub levels: Vec<Vec<usize>>,
    /// The constraints on the discrete parameters. The tests are those that keep them.
    pub constraints: Vec<String>,
    /// What is claimed.
    pub claims: Vec<Claim>,
}

/// A continuous parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterInterval {
    /// Its name.
    pub name: String,
    /// Its values at the coordinates 0 and 1.
    pub interval: [f64; 2],
}

/// A discrete parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// Its values.
    pub values: Vec<Value>,
}

/// The volume of the largest hole: at least that of a witness, at most what is proved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    /// `dispersion`, of all continuous parameters together, or `k-wise-dispersion`, of any k parameters.
    pub measure: String,
    /// How many parameters are looked at together; `None` of `dispersion`.
    pub k: Option<usize>,
    /// The volume of the witness, 0 where there is none.
    pub lower: f64,
    /// The largest hole that was found.
    pub witness: Option<Witness>,
    /// Combinations of values of discrete parameters that constraints exclude, as positions and levels: nothing is
    /// claimed of them.
    pub excluded: Vec<Vec<(usize, usize)>>,
    /// No hole is larger.
    pub upper: f64,
    /// Why the upper bound is larger than the one that was measured, if it is.
    pub note: Option<String>,
    /// The proofs of the upper bound, one for each projection; none where it is 1.
    pub proofs: Vec<Proof>,
}

/// A hole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Witness {
    /// The discrete parameters that it has values of: positions among the discrete ones, and levels.
    pub fixed: Vec<(usize, usize)>,
    /// The continuous parameters that it is a box of, by their positions among the continuous ones.
    pub axes: Vec<usize>,
    /// The lower corner of the box, in coordinates.
    pub lower: Vec<f64>,
    /// The upper corner of the box, in coordinates.
    pub upper: Vec<f64>,
    /// The same as values.
    pub values: KwiseWorst,
}

/// What nothing can be certified of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CertificateFlaw {
    /// Some values are negative.
    #[error("a certificate knows no negative values (`~`): it counts every test for all it contains")]
    Negatives,
    /// No measure that can be certified was measured.
    #[error(
        "a certificate is of the measures `dispersion`, which needs a continuous parameter, and `k-wise-dispersion`; \
         neither was measured"
    )]
    NoMeasure,
}

impl Reason for CertificateFlaw {}

/// A measured hole, on its way to a claim.
struct Measured {
    scope: Scope,
    volume: Bracket,
    fixed: Vec<(usize, usize)>,
    axes: Vec<usize>,
    witness: Option<LargestEmptyBox>,
}

impl Certificate {
    /// Writes it to a file, whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let mut text = serde_json::to_vec(self).expect("a certificate is always JSON");
        text.push(b'\n');
        write_whole(path, &text)
    }
}

/// [`Coverage::of`], with a certificate of the dispersion and the k-wise dispersion among the measures. Both are
/// done within the time limit.
///
/// # Errors
/// There are not `k` parameters, or too many combinations of them to count; or neither of the two is among the
/// measures; or values are negative.
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

/// What there is to prove, the harder part last, which has all the time that is left.
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
            "the volume was found to be at most {}; no proof of that was found within {MOST_PIVOTS} boxes and the time \
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

/// The combinations of discrete values, of at most k parameters, that constraints exclude.
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
