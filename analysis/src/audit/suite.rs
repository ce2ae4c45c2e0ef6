//! A test suite on trial: a set of tests of a study's space, from any source.

use crate::combinations::combinations;
use paracosm_campaign::reasons::ParameterMisuse;
use paracosm_campaign::{Catalogue, Error, Reason, Sampling, Study, StudyBuilder, TestSet};
use paracosm_generators::Strategy;
use paracosm_space::pict::Aliases;
use paracosm_space::{Point, SpaceError, Values, plural};
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use thiserror::Error;

/// The greatest number of tests of a grid.
const MOST_TESTS: u64 = 1_000_000;
/// The name of the source that is a grid.
const GRID: &str = "grid";
/// The files of a folder that make it the folder of a campaign.
const CAMPAIGN: &str = "campaign.json";
const TRIALS: &str = "trials.csv";

/// The source of a suite of tests.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// The first tests of a strategy.
    Strategy(Strategy, usize),
    /// An even grid with so many values of each continuous parameter, in the order of the parameters. The values include both ends
    /// of the parameter's interval. The grid has all values of each discrete parameter.
    Grid(Vec<usize>),
    /// A CSV file of tests, the folder of a campaign, or a folder of concrete scenarios.
    Path(PathBuf),
}

/// A suite of tests, as points of the space of a study. All tests keep the constraints of the space.
#[derive(Debug, Clone, PartialEq)]
pub struct Suite {
    /// The name of the suite, such as the text of its source.
    pub name: String,
    /// The tests of the suite.
    pub points: Vec<Point>,
    /// The number of tests of the source that break a constraint and are left out.
    pub left_out: usize,
}

/// The reason why a suite cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SuiteFlaw {
    /// The number of tests of a strategy is not a whole number above 0.
    #[error("found `{found}` after `{strategy}:`, expected a number of tests such as {strategy}:40")]
    Number {
        /// The name of the strategy.
        strategy: String,
        /// The text in place of the number.
        found: String,
    },
    /// The sizes of a grid cannot be read.
    #[error(
        "found `grid:{found}`, expected the number of values of each continuous parameter, at least 2, such as grid:5x4x2"
    )]
    Sizes {
        /// The text in place of the sizes.
        found: String,
    },
    /// A grid has another number of sizes than the space has continuous parameters.
    #[error("the grid has {}, expected {expected}: one for each continuous parameter ({})", plural(*found, "size"), names.join(", "))]
    Axes {
        /// The number of sizes.
        found: usize,
        /// The number of continuous parameters.
        expected: usize,
        /// The names of the continuous parameters.
        names: Vec<String>,
    },
    /// A grid has too many tests.
    #[error("the grid has {tests} tests, at most {MOST_TESTS} are allowed")]
    TooLarge {
        /// The number of tests of the grid.
        tests: u64,
    },
    /// The strategy needs the outcomes of tests.
    #[error(
        "the strategy `{strategy}` chooses tests by the outcomes of earlier tests, so its tests are no suite; audit the folder of a campaign"
    )]
    Adaptive {
        /// The name of the strategy.
        strategy: String,
    },
    /// The suite is the name of a strategy without a number of tests.
    #[error(
        "found the strategy `{strategy}` without a number of tests, expected for example `{strategy}:100`, or a file"
    )]
    NoNumber {
        /// The name of the strategy.
        strategy: String,
    },
    /// The suite has no test that keeps the constraints.
    #[error("the suite `{name}` has no test that keeps the constraints of the scenario ({} left out)", plural(*left_out, "test"))]
    NoTest {
        /// The name of the suite.
        name: String,
        /// The number of tests that break a constraint.
        left_out: usize,
    },
    /// The scenario has no grid of its own.
    #[error(
        "the scenario has no list of values of its own that would be its suite; name a suite: --tests FILE.csv, the folder of \
         a campaign or of concrete scenarios, STRATEGY:N or grid:AxB"
    )]
    NoGrid,
}

impl Reason for SuiteFlaw {}

impl FromStr for Source {
    type Err = SuiteFlaw;

    /// Reads `STRATEGY:N`, `grid:AxBxC`, or a path. The name of a strategy alone is a path if such a file exists.
    fn from_str(text: &str) -> Result<Self, SuiteFlaw> {
        let Some((name, rest)) = text.split_once(':') else {
            let is_strategy = text.parse::<Strategy>().is_ok() && !Path::new(text).exists();
            return if is_strategy {
                Err(SuiteFlaw::NoNumber { strategy: text.to_owned() })
            } else {
                Ok(Self::Path(text.into()))
            };
        };
        if name == GRID {
            let sizes = rest.split('x').map(|size| size.parse().ok().filter(|size| *size >= 2));
            let sizes = sizes.collect::<Option<_>>().ok_or_else(|| SuiteFlaw::Sizes { found: rest.to_owned() })?;
            return Ok(Self::Grid(sizes));
        }
        let Ok(strategy) = name.parse::<Strategy>() else { return Ok(Self::Path(text.into())) };
        if strategy.is_adaptive() {
            return Err(SuiteFlaw::Adaptive { strategy: name.to_owned() });
        }
        let number = rest.parse().ok().filter(|number| *number > 0);
        let wrong = || SuiteFlaw::Number { strategy: name.to_owned(), found: rest.to_owned() };
        Ok(Self::Strategy(strategy, number.ok_or_else(wrong)?))
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Strategy(strategy, tests) => write!(f, "{strategy}:{tests}"),
            Self::Grid(sizes) => {
                let sizes: Vec<String> = sizes.iter().map(usize::to_string).collect();
                write!(f, "{GRID}:{}", sizes.join("x"))
            }
            Self::Path(path) => path.display().fmt(f),
        }
    }
}

impl Suite {
    /// Makes the suite of a source for a study. Tests that break a constraint are left out. `catalogue` reads concrete scenarios.
    ///
    /// # Errors
    /// A file cannot be read or has no tests of the study, the strategy cannot propose tests, a grid does not fit the space, or no
    /// test keeps the constraints.
    pub fn of(source: &Source, study: &Study, catalogue: &Catalogue) -> Result<Self, Error> {
        let space = study.space();
        let points = match source {
            Source::Strategy(strategy, tests) => return Self::of_strategy(study, *strategy, *tests, None),
            Source::Grid(sizes) => even_grid(study, sizes)?,
            Source::Path(path) if path.is_dir() && !is_campaign(path) => {
                TestSet::of_folder(path, study, catalogue)?.points
            }
            Source::Path(path) => TestSet::read(&tests_of(path), Some(space.clone()), &Aliases::default())?.points,
        };
        Self::new(source.to_string(), points, study)
    }

    /// Makes the suite that a scenario of a file states by itself: all valid combinations of the values that `listed` has, as tests
    /// of the space of `study`. `listed` is the same study with the listed values of parameters in place of their intervals.
    ///
    /// # Errors
    /// `listed` has a continuous parameter, so that it lists no values; there are too many combinations; or none is valid.
    pub fn stated(listed: &Study, study: &Study) -> Result<Self, Error> {
        if listed.space().dims() > 0 {
            return Err(SuiteFlaw::NoGrid.into());
        }
        let points = cross(&[], &listed.space().levels())?;
        let valid = |point: &Point| listed.space().allows(point);
        let (kept, left): (Vec<_>, Vec<_>) = points.into_iter().partition(valid);
        let encoded = |point: &Point| study.space().encode(&listed.space().decode(point));
        let points = kept.iter().map(encoded).collect::<Result<_, SpaceError>>()?;
        let suite = Self::new("the values of the scenario".to_owned(), points, study)?;
        Ok(Self { left_out: suite.left_out + left.len(), ..suite })
    }

    /// Makes the study of a scenario that lists values of its parameters, with the intervals of these values open, and the suite of all
    /// valid combinations of the listed values.
    ///
    /// # Errors
    /// A parameter has no listed values, the study cannot be made, there are too many combinations, or none is valid.
    pub fn of_listed(builder: &StudyBuilder) -> Result<(Study, Self), Error> {
        let listed = builder.clone().build()?;
        if listed.space().dims() > 0 {
            return Err(SuiteFlaw::NoGrid.into());
        }
        let study = match builder.clone().continuous().build() {
            // Without an interval to open, the listed values are the whole space.
            Err(error) if matches!(error.reason(), Some(ParameterMisuse::NoRange { .. })) => listed.clone(),
            study => study?,
        };
        let suite = Self::stated(&listed, &study)?;
        Ok((study, suite))
    }

    /// Makes the suite of the first tests of a strategy; `None` is the seed that the strategy has by default.
    ///
    /// # Errors
    /// The strategy cannot propose tests, or no test keeps the constraints.
    pub fn of_strategy(study: &Study, strategy: Strategy, tests: usize, seed: Option<u64>) -> Result<Self, Error> {
        let sampling = Sampling { strategy, seed, budget: tests, ..Sampling::default() };
        let points = study.sampled(sampling)?.generator(&[])?.ask(tests);
        Self::new(Source::Strategy(strategy, tests).to_string(), points, study)
    }

    /// Makes suites of as many tests as this suite has, one by each strategy that does not learn from outcomes, and leaves out the `known`
    /// sources. Also returns why strategies refuse the space or the number of tests.
    pub fn rivals(&self, study: &Study, known: &[Source]) -> (Vec<Self>, Vec<Error>) {
        let is_known = |strategy: &Strategy| known.contains(&Source::Strategy(*strategy, self.points.len()));
        let strategies = Strategy::all().filter(|strategy| !strategy.is_adaptive() && !is_known(strategy));
        let of = |strategy| Self::of_strategy(study, strategy, self.points.len(), None);
        let (mut suites, mut refusals) = (Vec::new(), Vec::new());
        for suite in strategies.map(of) {
            match suite {
                Ok(suite) => suites.push(suite),
                Err(refusal) => refusals.push(refusal),
            }
        }
        (suites, refusals)
    }

    /// Makes a suite of points of the space of a study. Points that break a constraint are left out.
    ///
    /// # Errors
    /// No point keeps the constraints.
    pub fn new(name: String, points: Vec<Point>, study: &Study) -> Result<Self, Error> {
        let all = points.len();
        let points: Vec<Point> = points.into_iter().filter(|point| study.space().allows(point)).collect();
        let left_out = all - points.len();
        if points.is_empty() {
            return Err(SuiteFlaw::NoTest { name, left_out }.into());
        }
        Ok(Self { name, points, left_out })
    }

    /// Returns the values of the parameters of each test.
    pub fn values(&self, study: &Study) -> Vec<Values> {
        self.points.iter().map(|point| study.space().decode(point)).collect()
    }
}

/// Returns the file of the tests at a path: the path itself, or the table of trials in the folder of a campaign.
fn tests_of(path: &Path) -> PathBuf {
    if is_campaign(path) { path.join(TRIALS) } else { path.to_owned() }
}

fn is_campaign(path: &Path) -> bool {
    path.join(CAMPAIGN).exists()
}

fn even_grid(study: &Study, sizes: &[usize]) -> Result<Vec<Point>, Error> {
    let names: Vec<String> = study.space().continuous().map(|axis| axis.name()).collect();
    if names.len() != sizes.len() {
        return Err(SuiteFlaw::Axes { found: sizes.len(), expected: names.len(), names }.into());
    }
    Ok(cross(sizes, &study.space().levels())?)
}

/// Returns all combinations of `sizes` even coordinates and of levels. The last discrete parameter changes fastest.
fn cross(sizes: &[usize], levels: &[usize]) -> Result<Vec<Point>, SuiteFlaw> {
    let counts: Vec<usize> = sizes.iter().chain(levels).copied().collect();
    let tests = counts.iter().fold(1u64, |product, count| product.saturating_mul(*count as u64));
    if tests > MOST_TESTS {
        return Err(SuiteFlaw::TooLarge { tests });
    }
    let point = |places: Vec<usize>| {
        let even = |(place, size): (&usize, &usize)| *place as f64 / (*size - 1) as f64;
        Point { continuous: places.iter().zip(sizes).map(even).collect(), discrete: places[sizes.len()..].to_vec() }
    };
    Ok(combinations(&counts).map(point).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_of_a_source_is_read_and_written() {
        for text in ["halton:40", "grid:5x4x2", "tests.csv", "paracosm-out"] {
            assert_eq!(text.parse::<Source>().unwrap().to_string(), text);
        }
        for (text, says) in [
            ("halton:0", "expected a number of tests such as halton:40"),
            ("grid:5x1", "such as grid:5x4x2"),
            ("halton", "expected for example `halton:100`"),
            ("cmaes:40", "audit the folder of a campaign"),
        ] {
            let message = text.parse::<Source>().unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
    }

    #[test]
    fn a_grid_has_all_combinations_with_both_ends() {
        let points = cross(&[3, 2], &[2]).unwrap();
        assert_eq!(points.len(), 12);
        assert_eq!(points[0], Point { continuous: vec![0.0, 0.0], discrete: vec![0] });
        assert_eq!(points[5], Point { continuous: vec![0.5, 0.0], discrete: vec![1] });
        assert_eq!(points[11], Point { continuous: vec![1.0, 1.0], discrete: vec![1] });
        assert_eq!(cross(&[1001, 1001], &[]), Err(SuiteFlaw::TooLarge { tests: 1_002_001 }));
    }
}
