//! Measures how well tests cover their space. `paracosm-cover estimate` prints the result.

mod report;

pub use report::{Ball, Continuous, Coverage, Discrete, Hole, KEpsilon, KwiseHole, KwiseWorst, Measured, Strength};

use crate::Limit;
use paracosm_campaign::{Error, Reason, TestSet};
use paracosm_coverage::dispersion::{Dispersion, LargestEmptyBox};
use paracosm_coverage::kwise::{KwiseCoverage, coverage_of_kinds};
use paracosm_coverage::kwise_dispersion::{KwiseDispersion, kwise_dispersion, row_dispersion};
use paracosm_coverage::measure::Finding;
use paracosm_coverage::valid::Validity;
use paracosm_coverage::{Bracket, Deadline, Measure, PointSet};
use paracosm_space::demand::TestKind;
use paracosm_space::{Coordinate, Point, Record, Value};
use std::sync::atomic::AtomicBool;
use thiserror::Error;

/// A function that observes the progress of measurements. It receives the measure that is at work and its bracket so
/// far, if any.
pub type Watch<'a> = dyn FnMut(Measure, Option<Bracket>) + Send + 'a;

/// The error that `k` is not between 1 and the number of parameters of the space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("k is {k}, expected 1 to {parameters}, the number of parameters")]
pub struct StrengthFlaw {
    /// The given number `k` of parameters in each combination.
    pub k: usize,
    /// The number of parameters of the space.
    pub parameters: usize,
}

impl Reason for StrengthFlaw {}

/// The largest holes that a coverage report found, as boxes in coordinates.
#[derive(Debug, Default)]
pub struct Holes {
    /// The largest empty box of the continuous coordinates.
    pub dispersion: Option<Dispersion>,
    /// The number k, and the largest hole over any k parameters.
    pub k_wise: Option<(usize, KwiseDispersion)>,
}

impl Coverage {
    /// Measures the coverage of a space by tests. The measures that use `k` consider `k` parameters together; the
    /// default is the strength for which the tests were made, or else 2, or the number of parameters if that is
    /// smaller. `limit` is the limit of all slow measures together.
    ///
    /// # Errors
    /// `k` is 0 or above the number of parameters, or there are too many combinations of parameters to count, or the system
    /// cannot start a thread.
    pub fn of(tests: &TestSet, measures: &[Measure], k: Option<usize>, limit: Limit) -> Result<Self, Error> {
        Self::watched(tests, measures, k, limit, &mut |_, _| ())
    }

    /// Measures the coverage of a space by tests, as [`Coverage::of`] does, and reports the progress. `watch` receives
    /// the measure that is at work, and its bracket so far.
    ///
    /// # Errors
    /// The same as of [`Coverage::of`].
    pub fn watched(
        tests: &TestSet,
        measures: &[Measure],
        k: Option<usize>,
        limit: Limit,
        watch: &mut Watch,
    ) -> Result<Self, Error> {
        Ok(limit.within(|deadline| measure_holes(tests, measures, k, deadline, watch))??.0)
    }

    /// Measures the coverage of a space by tests, as [`Coverage::of`] does. Measures that are not finished when `stop` is set give brackets.
    ///
    /// # Errors
    /// The same as of [`Coverage::of`].
    pub fn stoppable(
        tests: &TestSet,
        measures: &[Measure],
        k: Option<usize>,
        limit: Limit,
        stop: &'static AtomicBool,
    ) -> Result<Self, Error> {
        let measured = |deadline: Deadline| measure_holes(tests, measures, k, deadline.or_when(stop), &mut |_, _| ());
        Ok(limit.within(measured)??.0)
    }
}

/// Measures the coverage of a space by tests, as [`Coverage::watched`] does, and returns also the holes in coordinates.
/// The measures share the time or the work until the deadline.
pub fn measure_holes(
    tests: &TestSet,
    measures: &[Measure],
    k: Option<usize>,
    deadline: Deadline,
    watch: &mut Watch,
) -> Result<(Coverage, Holes), Error> {
    let parameters = tests.space.coordinates().count();
    if parameters == 0 && k.is_none() {
        return Ok((Coverage::of_one_test(tests.points.len()), Holes::default()));
    }
    let k = k.or(tests.k).unwrap_or(parameters.min(2));
    if !(1..=parameters).contains(&k) {
        return Err(StrengthFlaw { k, parameters }.into());
    }
    let rules = tests.space.rules()?;
    let validity = Validity::of(&tests.space, &rules);
    let kinds = tests.demand.kinds(&tests.space)?;
    let keeping = keeping(tests, &kinds);
    let violating = tests.points.len() - keeping.points.len();
    if violating > 0 {
        let (coverage, holes) = measure_holes(&keeping, measures, Some(k), deadline, watch)?;
        return Ok((Coverage { tests: tests.points.len(), violating, ..coverage }, holes));
    }
    let levels = tests.space.levels();
    let is_mixed = !levels.is_empty() && tests.space.dims() > 0;
    // In a mixed space, k-wise coverage also computes (k, epsilon)-covering, which takes time.
    let takes_time = |measure: &&Measure| **measure != Measure::K_WISE || is_mixed;
    let mut clock = Clock::new(deadline, measures.iter().filter(takes_time).count());
    let mut holes = Holes::default();
    let continuous = match tests.space.dims() {
        0 => None,
        _ => Some(continuous(tests, validity.as_ref(), measures, &mut clock, &mut holes, watch)?),
    };
    let discrete = match levels.len() {
        0 => Some(None),
        _ if !measures.contains(&Measure::K_WISE) => None,
        parameters => {
            watch(Measure::K_WISE, None);
            Some(Some(discrete(tests, k.min(parameters), &kinds)?))
        }
    };
    let combinations = discrete.as_ref().and_then(Option::as_ref);
    let dims = tests.space.dims();
    let k_epsilon = combinations.map(|discrete| {
        let complete = discrete.covered == discrete.valid;
        // Without continuous parameters a row has no hole.
        let Bracket { lower, upper } = match dims {
            0 => Bracket::exact(0.0),
            _ => row_dispersion(dims, validity.as_ref(), &tests.points, clock.next()),
        };
        KEpsilon {
            k: discrete.k,
            complete,
            epsilon: complete.then_some(upper),
            epsilon_over_covered_rows: upper,
            epsilon_at_least: lower,
        }
    });
    let k_wise_dispersion = if measures.contains(&Measure::K_WISE_DISPERSION) {
        watch(Measure::K_WISE_DISPERSION, None);
        let found = match tests.space.dims() {
            // With negative values, the kind of a test decides which combinations the test covers.
            0 if !tests.demand.negatives.is_empty() => {
                let all: Vec<usize> = (0..levels.len()).collect();
                KwiseDispersion::of_coverage(counted(tests, &all, k, &kinds)?)
            }
            dims => kwise_dispersion(dims, &rules, validity.as_ref(), &tests.points, k, clock.next())?,
        };
        let worst = place(tests, &found.fixed, &found.axes, found.witness.as_ref());
        let volume = found.volume;
        holes.k_wise = Some((k, found));
        Some(KwiseHole { k, volume, worst })
    } else {
        None
    };
    Ok((Coverage { tests: tests.points.len(), continuous, violating, discrete, k_epsilon, k_wise_dispersion }, holes))
}

/// Returns the set of the tests that satisfy the constraints.
pub fn keeping(tests: &TestSet, kinds: &[TestKind]) -> TestSet {
    let checked = || tests.space.constraints().iter().filter(|constraint| constraint.checks_each_test());
    let keeps = |point: &&Point| {
        kinds.iter().any(|kind| kind.rules().allows(&point.discrete))
            && checked().all(|constraint| constraint.allows(point))
    };
    let points = tests.points.iter().filter(keeps).cloned().collect();
    TestSet { space: tests.space.clone(), points, k: tests.k, demand: tests.demand.clone() }
}

/// Returns the place of a hole as values of the parameters.
pub fn place(
    tests: &TestSet,
    fixed: &[(usize, usize)],
    axes: &[usize],
    witness: Option<&LargestEmptyBox>,
) -> KwiseWorst {
    let discrete: Vec<Coordinate> = tests.space.discrete().collect();
    let continuous: Vec<Coordinate> = tests.space.continuous().collect();
    let fixed = fixed.iter().map(|&(parameter, level)| named_level(&discrete, parameter, level)).collect();
    let axes = axes.iter().map(|&axis| continuous[axis]);
    KwiseWorst { fixed, empty_box: witness.map(|witness| sides(axes, witness)).unwrap_or_default() }
}

fn continuous(
    tests: &TestSet,
    validity: Option<&Validity>,
    measures: &[Measure],
    clock: &mut Clock,
    holes: &mut Holes,
    watch: &mut Watch,
) -> Result<Continuous, Error> {
    let points = PointSet::new(tests.space.dims(), tests.points.iter().map(|point| &point.continuous))?;
    let parameters: Vec<Coordinate> = tests.space.continuous().collect();
    let valid = validity.map(Validity::whole);
    // From the fastest to the slowest measure: a measure leaves its unused time to the measures after it.
    let mut order: Vec<Measure> = measures.iter().copied().filter(|measure| measure.is_of_points()).collect();
    order.sort_by_key(|measure| measure.descriptor().pace);
    let mut taken = Vec::new();
    for measure in order {
        watch(measure, None);
        let found = measure.take(&points, valid.as_deref(), clock.next(), &mut |bracket| watch(measure, Some(bracket)));
        let found = found.expect("the measure is one of points");
        if let Finding::Hole(hole) = &found
            && measure == Measure::DISPERSION
        {
            holes.dispersion = Some(hole.clone());
        }
        taken.push((measure, in_values(found, &parameters)));
    }
    let place = |measure: Measure| Measure::all().position(|other| other == measure);
    taken.sort_by_key(|(measure, _)| (place(*measure).is_none(), place(*measure)));
    let parameters = parameters.iter().map(Coordinate::name).collect();
    Ok(Continuous { parameters, valid_share: valid.map(|valid| valid.share()), measured: taken })
}

/// Returns the finding of a measure in values of the parameters instead of coordinates.
fn in_values(found: Finding, parameters: &[Coordinate]) -> Measured {
    match found {
        Finding::Number(number) => Measured::Number(number),
        Finding::Bracket(bracket) => Measured::Bracket(bracket),
        Finding::Hole(found) => {
            let largest_empty_box = sides(parameters.iter().copied(), &found.witness);
            Measured::Hole(Hole { volume: found.volume, largest_empty_box })
        }
        Finding::Ball(found) => Measured::Ball(found.map(|found| {
            let places = parameters.iter().zip(&found.centre);
            let centre = places.map(|(p, &u)| (p.name(), p.parameter.value_at(u))).collect();
            Ball { radius: found.radius, centre }
        })),
    }
}

fn discrete(tests: &TestSet, k: usize, kinds: &[TestKind]) -> Result<Discrete, Error> {
    let parameters: Vec<Coordinate> = tests.space.discrete().collect();
    let named = |tuples: &[Vec<(usize, usize)>]| {
        let name = |&(parameter, level): &(usize, usize)| named_level(&parameters, parameter, level);
        tuples.iter().map(|tuple| tuple.iter().map(name).collect()).collect()
    };
    let of_group = |(members, k): &(Vec<usize>, usize)| {
        let counted = counted(tests, members, *k, kinds)?;
        Ok(Strength {
            parameters: members.iter().map(|&member| parameters[member].name()).collect(),
            k: *k,
            valid: counted.valid,
            covered: counted.covered,
            ratio: counted.ratio(),
            missing: named(&counted.missing),
        })
    };
    let all: Vec<usize> = (0..parameters.len()).collect();
    let counted = counted(tests, &all, k, kinds)?;
    Ok(Discrete {
        k,
        valid: counted.valid,
        covered: counted.covered,
        ratio: counted.ratio(),
        missing: named(&counted.missing),
        combinations: counted.combinations,
        strengths: tests.demand.groups.iter().map(of_group).collect::<Result<_, Error>>()?,
    })
}

/// Counts the combinations of values of `k` of these discrete parameters that the tests cover.
fn counted(tests: &TestSet, parameters: &[usize], k: usize, kinds: &[TestKind]) -> Result<KwiseCoverage, Error> {
    Ok(coverage_of_kinds(kinds, parameters, k, tests.points.iter().map(|point| point.discrete.as_slice()))?)
}

/// Returns the name of a discrete coordinate, and the value of the coordinate at a level.
pub fn named_level(coordinates: &[Coordinate], coordinate: usize, level: usize) -> (String, Value) {
    let coordinate = coordinates[coordinate];
    let levels = coordinate.parameter.levels().expect("it is a discrete parameter");
    (coordinate.name(), levels[level].clone())
}

/// Returns the sides of a box over some continuous coordinates, as values.
fn sides<'a>(coordinates: impl Iterator<Item = Coordinate<'a>>, witness: &LargestEmptyBox) -> Record<[f64; 2]> {
    let ends = witness.lower.iter().zip(&witness.upper);
    coordinates.zip(ends).map(|(c, (&lo, &hi))| (c.name(), [lo, hi].map(|u| c.parameter.value_at(u)))).collect()
}

/// A limit for several measures. The time or the work that a measure does not use is left to the measures after it.
struct Clock {
    end: Deadline,
    /// The number of measures that are still to come.
    waiting: u32,
}

impl Clock {
    fn new(end: Deadline, waiting: usize) -> Self {
        Self { end, waiting: waiting as u32 }
    }

    /// Returns the deadline of the next measure, which has its share of what is left.
    fn next(&mut self) -> Deadline {
        let waiting = self.waiting.max(1);
        self.waiting = waiting - 1;
        self.end.part(1.0 / f64::from(waiting))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_coverage::measure::{Compare, Computation, Descriptor};
    use paracosm_generators::{Request, Strategy};
    use paracosm_space::Space;

    #[test]
    fn scaling_a_space_changes_nothing() {
        let unit = Space::unit_cube(3);
        let scaled = "parameter = [{ name = \"x\", interval = [-4, 12] }, { name = \"y\", interval = [0, 0.25] },
            { name = \"z\", interval = [1024, 1088] }]";
        let scaled = Space::from_toml(scaled).unwrap();
        let points = Strategy::SOBOL.build(&Request::new(&unit, 60)).unwrap().ask(60);
        // By way of values, as tests in a file would come: widths are powers of two, so that nothing is rounded.
        let values = points.iter().map(|point| scaled.encode(&scaled.decode(point)).unwrap()).collect();
        let measure = |space, points| {
            let coverage =
                Coverage::of(&TestSet::new(space, points), &Measure::all().collect::<Vec<_>>(), None, Limit::None)
                    .unwrap();
            let numbers: Vec<_> = coverage.continuous.unwrap().measured.iter().map(|(_, m)| m.bracket()).collect();
            (numbers, coverage.k_wise_dispersion.unwrap().volume)
        };
        assert_eq!(measure(unit, points), measure(scaled, values));
    }

    #[test]
    fn a_box_of_another_measure_is_not_taken_for_that_of_the_dispersion() {
        static CORNER: Descriptor = Descriptor {
            name: "corner",
            key: "corner",
            label: "corner",
            title: "corner",
            about: "a box in the corner, whatever the points are",
            pace: u8::MAX,
            compare: Compare::Never,
            method: Computation::Hole(|points, _, _, _| {
                let witness = LargestEmptyBox { lower: vec![0.0; points.dims()], upper: vec![0.1; points.dims()] };
                Dispersion { volume: Bracket::exact(witness.volume()), witness }
            }),
        };
        let space = Space::unit_cube(2);
        let points = Strategy::HALTON.build(&Request::new(&space, 20)).unwrap().ask(20);
        let tests = TestSet::new(space, points);
        let measured =
            |measures: &[Measure]| measure_holes(&tests, measures, None, Deadline::never(), &mut |_, _| ()).unwrap().1;
        let alone = measured(&[Measure::DISPERSION]).dispersion;
        assert_eq!(measured(&[Measure::DISPERSION, Measure::of(&CORNER)]).dispersion, alone);
    }
}
