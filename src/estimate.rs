//! How well tests cover their space: what `paracosm-cover estimate` prints.

use crate::Error;
use paracosm_coverage::dispersion::{Dispersion, LargestEmptyBox, dispersion_watched};
use paracosm_coverage::extreme::extreme_discrepancy;
use paracosm_coverage::fill::fill;
use paracosm_coverage::kwise::kwise_coverage;
use paracosm_coverage::kwise_dispersion::{KwiseDispersion, kwise_dispersion};
use paracosm_coverage::rules::Rules;
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Bracket, Deadline, Parameter, Point, PointSet, Record, Space, Value};
use paracosm_coverage::{did_you_mean, l2, nearest};
use serde::{Deserialize, Serialize};
use std::str::FromStr;
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
}

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
    /// The share of combinations of k discrete parameters that are covered.
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
    const CONTINUOUS: [Self; 8] = [
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

/// What is told who watches a measurement: the measure at work, and its bracket by now.
pub type Watch<'a> = dyn FnMut(Measure, Option<Bracket>) + 'a;

/// How well a set of tests covers its space. Measures that were not asked for are absent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// How many tests there are.
    pub tests: usize,
    /// The continuous half; `None` where the space has none.
    pub continuous: Option<Continuous>,
    /// The discrete half; `None` where the space has none.
    pub discrete: Option<Discrete>,
    /// Both halves together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_wise_dispersion: Option<KwiseHole>,
}

/// How well tests cover the continuous parameters, each scaled to `[0,1]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Continuous {
    /// The parameters.
    pub parameters: Vec<String>,
    /// The largest empty box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dispersion: Option<Hole>,
    /// The star discrepancy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub star_discrepancy: Option<Bracket>,
    /// The extreme discrepancy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extreme_discrepancy: Option<Bracket>,
    /// The radius of the largest empty ball with its centre in the cube; null without tests.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fill: Option<Option<Ball>>,
    /// The L2-star discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub l2_star: Option<Option<f64>>,
    /// The squared centered discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centered: Option<Option<f64>>,
    /// The squared wraparound discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wraparound: Option<Option<f64>>,
    /// The squared mixture discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixture: Option<Option<f64>>,
}

impl Continuous {
    /// Nothing measured yet.
    fn of(parameters: Vec<String>) -> Self {
        Self {
            parameters,
            dispersion: None,
            star_discrepancy: None,
            extreme_discrepancy: None,
            fill: None,
            l2_star: None,
            centered: None,
            wraparound: None,
            mixture: None,
        }
    }
}

/// The largest box that no test has entered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hole {
    /// Its volume as a share of the space.
    #[serde(flatten)]
    pub volume: Bracket,
    /// A box of the lower volume: from and to of each parameter, as values.
    pub largest_empty_box: Record<[f64; 2]>,
}

/// The largest ball that holds no test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ball {
    /// Its radius, each parameter scaled to `[0,1]`.
    #[serde(flatten)]
    pub radius: Bracket,
    /// The centre of a ball of the lower radius, as values.
    pub centre: Record<f64>,
}

/// How well tests cover the discrete parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Discrete {
    /// How many parameters are looked at together.
    pub k: usize,
    /// All combinations of values of k parameters.
    pub valid: u64,
    /// Those that some test contains.
    pub covered: u64,
    /// covered / valid.
    pub ratio: f64,
    /// Some that no test contains, 20 at most.
    pub missing: Vec<Record<Value>>,
    /// The share of the combinations of all parameters that are tested.
    pub combinations: f64,
}

/// The largest hole that any k parameters show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KwiseHole {
    /// How many parameters are looked at together.
    pub k: usize,
    /// Its volume as a share of the values of those parameters.
    #[serde(flatten)]
    pub volume: Bracket,
    /// Where it is.
    pub worst: KwiseWorst,
}

/// The place of a hole: values of some discrete parameters, and a box over some continuous ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KwiseWorst {
    /// The discrete parameters among the k, with their values.
    pub fixed: Record<Value>,
    /// From and to of the continuous ones, as values.
    pub empty_box: Record<[f64; 2]>,
}

/// The holes behind a report, in coordinates.
#[derive(Debug, Default)]
pub(crate) struct Holes {
    pub dispersion: Option<Dispersion>,
    /// With how many parameters were looked at together.
    pub k_wise: Option<(usize, KwiseDispersion)>,
}

impl Tests {
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
        let parameters = self.space.parameters().len();
        let k = k.or(self.k).unwrap_or(parameters.min(2));
        if !(1..=parameters).contains(&k) {
            return Err(Error::Usage(format!("k is {k}, expected 1 to {parameters}, the number of parameters")));
        }
        let mut clock = Clock::new(limit, measures);
        let mut holes = Holes::default();
        let continuous = match self.space.dims() {
            0 => None,
            _ => Some(self.continuous(measures, &mut clock, &mut holes, watch)?),
        };
        let levels = self.space.levels();
        let discrete = if levels.is_empty() || !measures.contains(&Measure::KWise) {
            None
        } else {
            watch(Measure::KWise, None);
            Some(self.discrete(k.min(levels.len()), &levels)?)
        };
        let k_wise_dispersion = if measures.contains(&Measure::KWiseDispersion) {
            watch(Measure::KWiseDispersion, None);
            let found = kwise_dispersion(self.space.dims(), &levels, &self.points, k, clock.next())?;
            let worst = self.place(&found.fixed, &found.axes, found.witness.as_ref());
            let volume = found.volume;
            holes.k_wise = Some((k, found));
            Some(KwiseHole { k, volume, worst })
        } else {
            None
        };
        Ok((Coverage { tests: self.points.len(), continuous, discrete, k_wise_dispersion }, holes))
    }

    /// The place of a hole, as values.
    pub(crate) fn place(
        &self,
        fixed: &[(usize, usize)],
        axes: &[usize],
        witness: Option<&LargestEmptyBox>,
    ) -> KwiseWorst {
        let discrete: Vec<&Parameter> = self.space.discrete().collect();
        let continuous: Vec<&Parameter> = self.space.continuous().collect();
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
        let parameters: Vec<&Parameter> = self.space.continuous().collect();
        let mut coverage = Continuous::of(parameters.iter().map(|parameter| parameter.name.clone()).collect());
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
                        let centre = places.map(|(p, &u)| (p.name.clone(), p.value_at(u))).collect();
                        Ball { radius: found.radius, centre }
                    }));
                }
                Measure::KWise | Measure::KWiseDispersion => unreachable!("measures of both halves"),
            }
        }
        Ok(coverage)
    }

    fn discrete(&self, k: usize, levels: &[usize]) -> Result<Discrete, Error> {
        let parameters: Vec<&Parameter> = self.space.discrete().collect();
        let rules = Rules::free(levels);
        let counted = kwise_coverage(&rules, k, self.points.iter().map(|point| point.discrete.as_slice()))?;
        let name = |&(parameter, level): &(usize, usize)| named_level(&parameters, parameter, level);
        Ok(Discrete {
            k,
            valid: counted.valid,
            covered: counted.covered,
            ratio: counted.ratio(),
            missing: counted.missing.iter().map(|tuple| tuple.iter().map(name).collect()).collect(),
            combinations: counted.combinations.expect("free parameters can be counted"),
        })
    }
}

/// A discrete parameter with one of its values.
pub(crate) fn named_level(parameters: &[&Parameter], parameter: usize, level: usize) -> (String, Value) {
    let parameter = parameters[parameter];
    (parameter.name.clone(), parameter.levels().expect("it is a discrete parameter")[level].clone())
}

/// A box over some continuous parameters, as values.
fn sides<'a>(parameters: impl Iterator<Item = &'a Parameter>, witness: &LargestEmptyBox) -> Record<[f64; 2]> {
    let ends = witness.lower.iter().zip(&witness.upper);
    parameters.zip(ends).map(|(p, (&lo, &hi))| (p.name.clone(), [lo, hi].map(|u| p.value_at(u)))).collect()
}

/// A time limit for several measures: what one leaves of the time is for those after it.
struct Clock {
    end: Option<Instant>,
    /// How many measures are still to come.
    waiting: u32,
}

impl Clock {
    fn new(limit: Option<Duration>, measures: &[Measure]) -> Self {
        let waiting = measures.iter().filter(|measure| **measure != Measure::KWise).count() as u32;
        Self { end: limit.and_then(|limit| Instant::now().checked_add(limit)), waiting }
    }

    /// The deadline of the next measure: its share of the time that is left.
    fn next(&mut self) -> Deadline {
        let waiting = self.waiting.max(1);
        self.waiting = waiting - 1;
        let left = self.end.map(|end| end.saturating_duration_since(Instant::now()));
        left.map_or_else(Deadline::never, |left| Deadline::after(left / waiting))
    }
}
