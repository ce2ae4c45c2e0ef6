//! A certificate that is being made: claims are added one by one, and share the valid parts of their projections.

use super::{Certificate, Choice, Claim, MOST_PIVOTS, ParameterInterval, Witness};
use crate::estimate::{Holes, place};
use paracosm_campaign::{Error, TestSet};
use paracosm_coverage::dispersion::LargestEmptyBox;
use paracosm_coverage::proof::{Budget, Proof, Proved, Scope, Target, prove};
use paracosm_coverage::valid::{Effort, ValidPart, Validity};
use paracosm_coverage::{Bracket, Deadline, Measure, Projection};
use paracosm_space::rules::Rules;
use paracosm_space::{Coordinate, Parameter};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The version of the format of certificates without valid parts and rows.
const FORMAT: u32 = 1;
/// The version of the format of certificates with valid parts or rows.
const FORMAT_OF_PARTS: u32 = 2;

/// The relative difference up to which a proved bound counts as equal to the measured bound.
const ROUNDING: f64 = 1e-9;

/// A measured hole from which a claim is made.
pub(crate) struct Measured {
    pub measure: &'static str,
    pub k: Option<usize>,
    pub row: Option<Vec<usize>>,
    pub excluded: Vec<Vec<(usize, usize)>>,
    /// The projections for which the bound is to be proved; empty if there was no time to find their valid parts.
    pub targets: Vec<Target>,
    pub volume: Bracket,
    /// The projection of the witness.
    pub place: Target,
    pub witness: Option<LargestEmptyBox>,
}

/// A certificate that is being made.
pub(crate) struct Draft<'a> {
    tests: &'a TestSet,
    parts: Vec<Arc<ValidPart>>,
    claims: Vec<Claim>,
}

impl<'a> Draft<'a> {
    /// Begins a certificate about tests that keep the constraints of their space.
    pub fn new(tests: &'a TestSet) -> Self {
        Self { tests, parts: Vec::new(), claims: Vec::new() }
    }

    /// Returns a projection for a claim, with its valid part as a part of the certificate. A projection without a continuous
    /// parameter has no valid part.
    pub fn target(&mut self, projection: Projection, part: Option<Arc<ValidPart>>) -> Target {
        let part = part.filter(|_| !projection.axes.is_empty()).map(|part| {
            self.parts.iter().position(|known| Arc::ptr_eq(known, &part)).unwrap_or_else(|| {
                self.parts.push(part);
                self.parts.len() - 1
            })
        });
        Target { projection, part }
    }

    /// Returns the measured holes whose bounds are to be proved. The harder one is last: it has all the time that is
    /// left.
    pub fn measured(&mut self, rules: &Rules, holes: Holes, deadline: Deadline) -> Result<Vec<Measured>, Error> {
        let tests = self.tests;
        let dims = tests.space.dims();
        let validity = Validity::of(&tests.space, rules);
        let mut all = Vec::new();
        if let Some((k, found)) = holes.k_wise {
            let mut target = |projection: Projection| {
                let of_axes = validity.as_ref().filter(|_| !projection.axes.is_empty());
                // The measure takes the same effort.
                let part = of_axes.map(|validity| validity.part(&projection, Effort::Quick));
                self.target(projection, part)
            };
            let place = target(Projection { fixed: found.fixed, axes: found.axes });
            let projections = Scope::Every(k).projections(dims, rules, MOST_PIVOTS + 1)?;
            let mut targets = Vec::new();
            for projection in projections {
                if deadline.passed() {
                    targets.clear();
                    break;
                }
                targets.push(target(projection));
            }
            let (measure, excluded) = (Measure::K_WISE_DISPERSION.name(), excluded(tests, rules, k)?);
            let (k, volume, witness) = (Some(k), found.volume, found.witness);
            all.push(Measured { measure, k, row: None, excluded, targets, volume, place, witness });
        }
        if let Some(found) = holes.dispersion {
            let whole = Projection { fixed: Vec::new(), axes: (0..dims).collect() };
            let place = self.target(whole, validity.as_ref().map(Validity::whole));
            let (measure, targets) = (Measure::DISPERSION.name(), vec![place.clone()]);
            let (volume, witness) = (found.volume, Some(found.witness));
            all.push(Measured { measure, k: None, row: None, excluded: Vec::new(), targets, volume, place, witness });
        }
        Ok(all)
    }

    /// Adds the claim about a measured hole, with proofs if they are found within the budget. Returns the number of their pivots.
    pub fn prove(&mut self, measured: Measured, budget: Budget) -> usize {
        let volume = measured.volume;
        let Proved { upper, proofs } = prove(&measured.targets, &self.parts, &self.tests.points, volume, budget);
        let weaker = upper > volume.upper * (1.0 + ROUNDING) || (upper >= 1.0 && volume.lower < 1.0);
        let note = weaker.then(|| {
            format!(
                "the volume was found to be at most {}; no proof of this bound was found within {} boxes and the time \
                 limit",
                volume.upper, budget.pivots
            )
        });
        let pivots = proofs.iter().map(|proof| proof.pivots.len()).sum();
        self.add(measured, upper, note, proofs, None);
        pivots
    }

    /// Adds the claim about a measured hole with the same points and the same valid part as in an earlier claim.
    pub fn repeat(&mut self, measured: Measured, like: usize) {
        let Claim { upper, note, .. } = &self.claims[like];
        let (upper, note) = (*upper, note.clone());
        self.add(measured, upper, note, Vec::new(), Some(like));
    }

    fn add(&mut self, measured: Measured, upper: f64, note: Option<String>, proofs: Vec<Proof>, like: Option<usize>) {
        let Measured { measure, k, row, excluded, volume, place: Target { projection, part }, witness, .. } = measured;
        let Projection { fixed, axes } = projection;
        let witness = (volume.lower > 0.0).then(|| {
            let values = place(self.tests, &fixed, &axes, witness.as_ref());
            let corners = witness.map(|found| (found.lower, found.upper));
            let (lower, upper) = corners.unwrap_or_default();
            Witness { fixed, axes, lower, upper, part, values }
        });
        let (measure, lower) = (measure.to_owned(), volume.lower);
        self.claims.push(Claim { measure, k, row, lower, witness, excluded, upper, note, proofs, like });
    }

    /// Returns the certificate.
    pub fn finish(self, note: Option<String>) -> Certificate {
        let Self { tests, parts, claims } = self;
        let ends = |parameter: &Parameter| [0.0, 1.0].map(|u| parameter.value_at(u));
        let interval = |c: Coordinate| ParameterInterval { name: c.name(), interval: ends(c.parameter) };
        let values = |parameter: &Parameter| parameter.levels().unwrap_or_default().to_vec();
        let choice = |c: Coordinate| Choice { name: c.name(), values: values(c.parameter) };
        let is_plain = parts.is_empty() && claims.iter().all(|claim| claim.row.is_none());
        Certificate {
            format: if is_plain { FORMAT } else { FORMAT_OF_PARTS },
            version: env!("CARGO_PKG_VERSION").to_owned(),
            continuous: tests.space.continuous().map(interval).collect(),
            discrete: tests.space.discrete().map(choice).collect(),
            coordinates: tests.points.iter().map(|point| point.continuous.clone()).collect(),
            levels: tests.points.iter().map(|point| point.discrete.clone()).collect(),
            constraints: tests.space.constraints().iter().map(|constraint| constraint.text().to_owned()).collect(),
            parts: parts.iter().map(|part| (&**part).into()).collect(),
            note,
            claims,
        }
    }
}

/// Returns the combinations of values of at most k discrete parameters that constraints exclude.
fn excluded(tests: &TestSet, rules: &Rules, k: usize) -> Result<Vec<Vec<(usize, usize)>>, Error> {
    if tests.space.constraints().is_empty() {
        return Ok(Vec::new());
    }
    let free = Rules::free(rules.levels());
    let every = Scope::Every(k).projections(tests.space.dims(), &free, usize::MAX)?;
    let excluded: BTreeSet<_> =
        every.into_iter().map(|projection| projection.fixed).filter(|fixed| !rules.is_valid(fixed)).collect();
    Ok(excluded.into_iter().collect())
}
