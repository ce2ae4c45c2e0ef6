//! How well tests cover their space: what `paracosm-cover estimate` prints.

mod measure;
mod report;

pub use measure::Measure;
pub use report::{Ball, Continuous, Coverage, Discrete, Hole, KEpsilon, KwiseHole, KwiseWorst, Strength};

use crate::Error;
use paracosm_coverage::demand::{Demand, Kind};
use paracosm_coverage::dispersion::{Dispersion, LargestEmptyBox, dispersion_watched};
use paracosm_coverage::extreme::extreme_discrepancy;
use paracosm_coverage::fill::fill;
use paracosm_coverage::kwise::{KwiseCoverage, coverage_of_kinds};
use paracosm_coverage::kwise_dispersion::{KwiseDispersion, kwise_dispersion, row_dispersion};
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Bracket, Coordinate, Deadline, Point, PointSet, Record, Space, Value, l2};
use std::time::{Duration, Instant};

/// Tests with the space that they are points of.
#[derive(Debug, Clone, PartialEq)]
pub struct Tests {
    /// Their space.
    pub space: Space,
    /// Their coordinates.
    pub points: Vec<Point>,
    /// How many discrete parameters at a time they were made to cover, if that was said.
    pub k: Option<usize>,
    /// What is asked of them beside all combinations of k values. Which values are negative matters to the combinations
    /// of discrete values; to the continuous parameters all tests count.
    pub demand: Demand,
}

/// What is told who watches a measurement: the measure at work, and its bracket by now.
pub type Watch<'a> = dyn FnMut(Measure, Option<Bracket>) + 'a;

/// The holes behind a report, in coordinates.
#[derive(Debug, Default)]
pub(crate) struct Holes {
    pub dispersion: Option<Dispersion>,
    /// With how many parameters were looked at together.
    pub k_wise: Option<(usize, KwiseDispersion)>,
}

impl Tests {
    /// Tests of which nothing more is known.
    pub fn new(space: Space, points: Vec<Point>) -> Self {
        Self { space, points, k: None, demand: Demand::default() }
    }

    /// Measures how well the tests cover their space: `k` parameters at a time, where that matters (where nothing is
    /// said, as the tests were made to; else 2, or as many as there are), and all that takes long within a time limit.
    ///
    /// # Errors
    /// There are not `k` parameters, or too many combinations of them to count.
    pub fn measure(&self, measures: &[Measure], k: Option<usize>, limit: Option<Duration>) -> Result<Coverage, Error> {
        self.measure_watched(measures, k, limit, &mut |_, _| ())
    }

    /// [`Tests::measure`], while `watch` is told which measure is at work, and within which bracket it knows the number
    /// by now.
    ///
    /// # Errors
    /// As `measure`.
    pub fn measure_watched(
        &self,
        measures: &[Measure],
        k: Option<usize>,
        limit: Option<Duration>,
        watch: &mut Watch,
    ) -> Result<Coverage, Error> {
        Ok(self.measure_holes(measures, k, limit, watch)?.0)
    }

    /// [`Tests::measure_watched`], with the holes as they were found.
    pub(crate) fn measure_holes(
        &self,
        measures: &[Measure],
        k: Option<usize>,
        limit: Option<Duration>,
        watch: &mut Watch,
    ) -> Result<(Coverage, Holes), Error> {
        let parameters = self.space.coordinates().count();
        let k = k.or(self.k).unwrap_or(parameters.min(2));
        if !(1..=parameters).contains(&k) {
            return Err(Error::Usage(format!("k is {k}, expected 1 to {parameters}, the number of parameters")));
        }
        let rules = self.space.rules()?;
        let kinds = self.demand.kinds(&self.space)?;
        let keeping = self.keeping(&kinds);
        let violating = self.points.len() - keeping.points.len();
        if violating > 0 {
            let (coverage, holes) = keeping.measure_holes(measures, Some(k), limit, watch)?;
            return Ok((Coverage { tests: self.points.len(), violating, ..coverage }, holes));
        }
        let levels = self.space.levels();
        let is_mixed = !levels.is_empty() && self.space.dims() > 0;
        // In a mixed space k-wise coverage brings (k, epsilon)-covering with it, which takes time.
        let takes_time = |measure: &&Measure| **measure != Measure::KWise || is_mixed;
        let mut clock = Clock::new(limit, measures.iter().filter(takes_time).count());
        let mut holes = Holes::default();
        let continuous = match self.space.dims() {
            0 => None,
            _ => Some(self.continuous(measures, &mut clock, &mut holes, watch)?),
        };
        let discrete = match levels.len() {
            0 => Some(None),
            _ if !measures.contains(&Measure::KWise) => None,
            parameters => {
                watch(Measure::KWise, None);
                Some(Some(self.discrete(k.min(parameters), &kinds)?))
            }
        };
        let counted = discrete.as_ref().and_then(Option::as_ref);
        let dims = self.space.dims();
        let k_epsilon = counted.map(|discrete| {
            let complete = discrete.covered == discrete.valid;
            // Without continuous parameters a row has no hole to leave.
            let Bracket { lower, upper } =
                if dims == 0 { Bracket::exact(0.0) } else { row_dispersion(dims, &self.points, clock.next()) };
            KEpsilon {
                k: discrete.k,
                complete,
                epsilon: complete.then_some(upper),
                epsilon_over_covered_rows: upper,
                epsilon_at_least: lower,
            }
        });
        let k_wise_dispersion = if measures.contains(&Measure::KWiseDispersion) {
            watch(Measure::KWiseDispersion, None);
            let found = match self.space.dims() {
                // Which tests count for a combination is for their kinds to say.
                0 if !self.demand.negatives.is_empty() => {
                    let all: Vec<usize> = (0..levels.len()).collect();
                    KwiseDispersion::of_coverage(self.counted(&all, k, &kinds)?)
                }
                dims => kwise_dispersion(dims, &rules, &self.points, k, clock.next())?,
            };
            let worst = self.place(&found.fixed, &found.axes, found.witness.as_ref());
            let volume = found.volume;
            holes.k_wise = Some((k, found));
            Some(KwiseHole { k, volume, worst })
        } else {
            None
        };
        Ok((
            Coverage { tests: self.points.len(), continuous, violating, discrete, k_epsilon, k_wise_dispersion },
            holes,
        ))
    }

    /// The tests that keep the constraints.
    pub(crate) fn keeping(&self, kinds: &[Kind]) -> Self {
        let keeps = |point: &&Point| kinds.iter().any(|kind| kind.rules().allows(&point.discrete));
        let points = self.points.iter().filter(keeps).cloned().collect();
        Self { space: self.space.clone(), points, k: self.k, demand: self.demand.clone() }
    }

    /// The place of a hole, as values.
    pub(crate) fn place(
        &self,
        fixed: &[(usize, usize)],
        axes: &[usize],
        witness: Option<&LargestEmptyBox>,
    ) -> KwiseWorst {
        let discrete: Vec<Coordinate> = self.space.discrete().collect();
        let continuous: Vec<Coordinate> = self.space.continuous().collect();
        let fixed = fixed.iter().map(|&(parameter, level)| named_level(&discrete, parameter, level)).collect();
        let axes = axes.iter().map(|&axis| continuous[axis]);
        KwiseWorst { fixed, empty_box: witness.map(|witness| sides(axes, witness)).unwrap_or_default() }
    }

    fn continuous(
        &self,
        measures: &[Measure],
        clock: &mut Clock,
        holes: &mut Holes,
        watch: &mut Watch,
    ) -> Result<Continuous, Error> {
        let points = PointSet::new(self.space.dims(), self.points.iter().map(|point| &point.continuous))?;
        let parameters: Vec<Coordinate> = self.space.continuous().collect();
        let mut coverage = Continuous::of(parameters.iter().map(Coordinate::name).collect());
        // From the fastest to the slowest: what one leaves of the time is for those after it.
        for measure in Measure::CONTINUOUS.into_iter().filter(|measure| measures.contains(measure)) {
            watch(measure, None);
            let deadline = clock.next();
            match measure {
                Measure::L2Star => coverage.l2_star = Some(l2::l2_star(&points, deadline)),
                Measure::Centered => coverage.centered = Some(l2::centered(&points, deadline)),
                Measure::Wraparound => coverage.wraparound = Some(l2::wraparound(&points, deadline)),
                Measure::Mixture => coverage.mixture = Some(l2::mixture(&points, deadline)),
                Measure::Dispersion => {
                    let mut closing = |bracket| watch(measure, Some(bracket));
                    let found = dispersion_watched(&points, deadline, &mut closing);
                    let largest_empty_box = sides(parameters.iter().copied(), &found.witness);
                    coverage.dispersion = Some(Hole { volume: found.volume, largest_empty_box });
                    holes.dispersion = Some(found);
                }
                Measure::Star => coverage.star_discrepancy = Some(star_discrepancy(&points, deadline)),
                Measure::Extreme => coverage.extreme_discrepancy = Some(extreme_discrepancy(&points, deadline)),
                Measure::Fill => {
                    coverage.fill = Some(fill(&points, deadline).map(|found| {
                        let places = parameters.iter().zip(&found.centre);
                        let centre = places.map(|(p, &u)| (p.name(), p.parameter.value_at(u))).collect();
                        Ball { radius: found.radius, centre }
                    }));
                }
                Measure::KWise | Measure::KWiseDispersion => unreachable!("measures of both halves"),
            }
        }
        Ok(coverage)
    }

    fn discrete(&self, k: usize, kinds: &[Kind]) -> Result<Discrete, Error> {
        let parameters: Vec<Coordinate> = self.space.discrete().collect();
        let named = |tuples: &[Vec<(usize, usize)>]| {
            let name = |&(parameter, level): &(usize, usize)| named_level(&parameters, parameter, level);
            tuples.iter().map(|tuple| tuple.iter().map(name).collect()).collect()
        };
        let of_group = |(members, k): &(Vec<usize>, usize)| {
            let counted = self.counted(members, *k, kinds)?;
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
        let counted = self.counted(&all, k, kinds)?;
        Ok(Discrete {
            k,
            valid: counted.valid,
            covered: counted.covered,
            ratio: counted.ratio(),
            missing: named(&counted.missing),
            combinations: counted.combinations,
            strengths: self.demand.groups.iter().map(of_group).collect::<Result<_, Error>>()?,
        })
    }

    /// What the tests cover of some discrete parameters.
    fn counted(&self, parameters: &[usize], k: usize, kinds: &[Kind]) -> Result<KwiseCoverage, Error> {
        Ok(coverage_of_kinds(kinds, parameters, k, self.points.iter().map(|point| point.discrete.as_slice()))?)
    }
}

/// A discrete coordinate with one of its values.
pub(crate) fn named_level(coordinates: &[Coordinate], coordinate: usize, level: usize) -> (String, Value) {
    let coordinate = coordinates[coordinate];
    let levels = coordinate.parameter.levels().expect("it is a discrete parameter");
    (coordinate.name(), levels[level].clone())
}

/// A box over some continuous coordinates, as values.
fn sides<'a>(coordinates: impl Iterator<Item = Coordinate<'a>>, witness: &LargestEmptyBox) -> Record<[f64; 2]> {
    let ends = witness.lower.iter().zip(&witness.upper);
    coordinates.zip(ends).map(|(c, (&lo, &hi))| (c.name(), [lo, hi].map(|u| c.parameter.value_at(u)))).collect()
}

/// A time limit for several measures: what one leaves of the time is for those after it.
struct Clock {
    end: Option<Instant>,
    /// How many measures are still to come.
    waiting: u32,
}

impl Clock {
    fn new(limit: Option<Duration>, waiting: usize) -> Self {
        Self { end: limit.and_then(|limit| Instant::now().checked_add(limit)), waiting: waiting as u32 }
    }

    /// The deadline of the next measure: its share of the time that is left.
    fn next(&mut self) -> Deadline {
        let waiting = self.waiting.max(1);
        self.waiting = waiting - 1;
        let left = self.end.map(|end| end.saturating_duration_since(Instant::now()));
        left.map_or_else(Deadline::never, |left| Deadline::after(left / waiting))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_generators::{Request, Strategy};

    #[test]
    fn scaling_a_space_changes_nothing() {
        let unit = Space::unit_cube(3);
        let scaled = "parameter = [{ name = \"x\", interval = [-4, 12] }, { name = \"y\", interval = [0, 0.25] },
            { name = \"z\", interval = [1024, 1088] }]";
        let scaled = Space::from_toml(scaled).unwrap();
        let points = Strategy::Sobol.build(&Request::new(&unit, 60)).unwrap().ask(60);
        // By way of values, as tests in a file would come: widths are powers of two, so that nothing is rounded.
        let values = points.iter().map(|point| scaled.encode(&scaled.decode(point)).unwrap()).collect();
        let measure = |space, points| {
            let coverage = Tests::new(space, points).measure(&Measure::ALL, None, None).unwrap();
            let continuous = coverage.continuous.unwrap();
            let dispersion = continuous.dispersion.unwrap().volume;
            let hole = coverage.k_wise_dispersion.unwrap().volume;
            let discrepancies = [continuous.star_discrepancy, continuous.extreme_discrepancy].map(Option::unwrap);
            let ball = continuous.fill.unwrap().unwrap().radius;
            let means = [continuous.l2_star, continuous.centered, continuous.wraparound, continuous.mixture];
            (dispersion, hole, discrepancies, ball, means)
        };
        assert_eq!(measure(unit, points), measure(scaled, values));
    }
}
