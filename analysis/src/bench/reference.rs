//! Makes reference maps, which show by the verdicts of very many random tests where the tests of a target fail.
//!
//! A run of a few hundred tests predicts for every place the outcome of the nearest of its tests (Cover and Hart,
//! Nearest neighbor pattern classification, IEEE Trans. Inf. Theory 13, 1967). The comparison of these predictions
//! with the map gives
//!
//! - *recall*: the share of the failing tests of the map that the run predicts to fail;
//! - *precision*: the share of the tests predicted to fail that do fail (van Rijsbergen, Information Retrieval, 1979,
//!   chapter 7).
//!
//! As the map's tests are uniform, these are shares of volume. Distances are those of the unit cube. A discrete
//! parameter contributes 0 to 1 by its steps if its values are ordered, and 0 or 1 if its values are words (HEOM;
//! Wilson and Martinez, Improved heterogeneous distance functions, JAIR 6, 1997). Tests with the verdict `error` or
//! `invalid` tell nothing about any place.
//!
//! The file of a map holds the study that made the map, from which the tests follow, and a letter for each verdict.

use paracosm_campaign::files::{read_text, write_whole};
use paracosm_campaign::{
    Campaign, Error, Finish, Learned, Observer, Reason, Sampling, Study, StudyFile, Trial, differing_key,
};
use paracosm_generators::{DiscreteFamily, Strategy};
use paracosm_oracles::Verdict;
use paracosm_space::{Point, Space, Value};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// The seed of the tests of a map, far from the seeds of runs.
const SEED: u64 = 1_000_000;
/// The version of the format of map files.
const FORMAT: u32 = 1;
/// The number of verdicts in a line of a map file.
const LINE: usize = 100;

/// The letters that stand for the verdicts in a map file.
const LETTERS: [(Verdict, char); 6] = [
    (Verdict::Pass, '.'),
    (Verdict::Fail, 'F'),
    (Verdict::Unpreventable, 'u'),
    (Verdict::Inconclusive, 'i'),
    (Verdict::Invalid, 'x'),
    (Verdict::Error, 'e'),
];

/// A map of the failing tests of a target, made of many random tests with their verdicts.
#[derive(Debug, Clone)]
pub struct ReferenceMap {
    study: Study,
    verdicts: Vec<Verdict>,
    axes: Vec<Axis>,
    /// The places of the tests that are neither `error` nor `invalid`, each with an entry in `fails`.
    places: Vec<f64>,
    fails: Vec<bool>,
}

/// The recall and the precision of a run as a map of the failing tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Judged {
    pub recall: Option<f64>,
    pub precision: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
enum Axis {
    Continuous,
    /// A discrete parameter with the given number of levels, which are ordered (`Ordered`) or words (`Words`).
    Ordered(usize),
    Words(usize),
}

/// The content of a map file.
#[derive(Serialize, Deserialize)]
struct Written {
    format: u32,
    /// The command that made the map.
    command: String,
    study: StudyFile,
    verdicts: Vec<String>,
}

/// A flaw in the file of a reference map.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MapFlaw {
    /// The file has a version of the format that this software does not read.
    #[error("found format {found} of the reference map, expected {FORMAT}: make the map again")]
    Format {
        /// The version of the format that the file has.
        found: u32,
    },
    /// The file holds the reference map of a different study.
    #[error("the map is of another study: the entry `{key}` of its study differs; make a new map elsewhere")]
    Other {
        /// The entry in which the study of the file differs from the given study.
        key: String,
    },
    /// The file has more verdicts than its study has tests.
    #[error("found {found} as the number of verdicts, expected at most {expected}, the number of tests of the map")]
    TooMany {
        /// The number of verdicts in the file.
        found: usize,
        /// The number of tests of the file's study.
        expected: usize,
    },
    /// A letter in the file does not stand for a verdict.
    #[error("found a letter that is no verdict, expected `.`, `F`, `i`, `x` or `e`")]
    Letter,
}

impl Reason for MapFlaw {}

/// An observer that ends a campaign once the flag is set.
struct Stop<'a>(&'a AtomicBool);

impl Observer for Stop<'_> {
    fn trial(&mut self, _: &Trial) -> Result<ControlFlow<()>, Error> {
        Ok(if self.0.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}

impl ReferenceMap {
    /// Returns the study of a map of a study's subject, with uniformly random tests in all rows of discrete values.
    fn study_of(study: &Study, tests: usize) -> Result<Study, Error> {
        let has_rows = !study.space().levels().is_empty();
        let discrete = if has_rows { DiscreteFamily::Cross } else { DiscreteFamily::Ipog };
        let sampling = study.sampling().clone();
        let strategy = Strategy::RANDOM;
        Ok(study.sampled(Sampling { strategy, discrete, budget: tests, seed: Some(SEED), batch: None, ..sampling })?)
    }

    /// Makes a reference map by running the given number of random tests of a study's scenario or system. `watch`
    /// receives the number of tests so far.
    ///
    /// # Errors
    /// The study cannot be run, or `stop` was set.
    pub fn make(
        study: &Study,
        tests: usize,
        jobs: NonZeroUsize,
        stop: &AtomicBool,
        mut watch: impl FnMut(usize),
    ) -> Result<Self, Error> {
        let study = Self::study_of(study, tests)?;
        let mut verdicts = Vec::with_capacity(tests);
        let mut note = |trial: &Trial| {
            verdicts.push(trial.verdict);
            watch(verdicts.len());
        };
        let finish = Campaign::new(&study)?.jobs(jobs).run(&mut [&mut note, &mut Stop(stop)])?;
        match finish {
            Finish::Stopped => Err(Error::Interrupted),
            Finish::Budget | Finish::Exhausted => Self::of(study, verdicts),
        }
    }

    fn of(study: Study, verdicts: Vec<Verdict>) -> Result<Self, Error> {
        let points = study.generator(&[])?.ask(verdicts.len());
        let axes = axes(study.space());
        let (mut places, mut fails) = (Vec::new(), Vec::new());
        for (point, verdict) in points.iter().zip(&verdicts) {
            if !matches!(verdict, Verdict::Error | Verdict::Invalid) {
                places.extend(place(&axes, point));
                fails.push(*verdict == Verdict::Fail);
            }
        }
        Ok(Self { study, verdicts, axes, places, fails })
    }

    /// Reads the reference map of a study from a file that [`ReferenceMap::write`] has written.
    ///
    /// # Errors
    /// The file cannot be read, is broken, or holds the map of another study.
    pub fn read(path: &Path, study: &Study) -> Result<Self, Error> {
        let text = read_text(path)?;
        let written: Written =
            serde_json::from_str(&text).map_err(|error| Error::in_file(path, error.line(), error))?;
        let wrong = |flaw| Err(Error::in_file(path, None, flaw));
        if written.format != FORMAT {
            return wrong(MapFlaw::Format { found: written.format });
        }
        let there = written.study.study.with_program_of(&study.catalogue());
        let here = Self::study_of(study, there.sampling().budget)?;
        if let Some(key) = differing_key(&comparable(&there), &comparable(&here)) {
            return wrong(MapFlaw::Other { key: key.to_owned() });
        }
        let verdict = |letter: char| LETTERS.iter().find(|(_, known)| *known == letter).map(|(verdict, _)| *verdict);
        let verdicts: Option<Vec<Verdict>> =
            written.verdicts.iter().flat_map(|line| line.chars()).map(verdict).collect();
        match verdicts {
            Some(verdicts) if verdicts.len() <= here.sampling().budget => Self::of(there, verdicts),
            Some(verdicts) => wrong(MapFlaw::TooMany { found: verdicts.len(), expected: here.sampling().budget }),
            None => wrong(MapFlaw::Letter),
        }
    }

    /// Writes the map to a file, with the command that made the map.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path, command: &str) -> Result<(), Error> {
        let letter = |verdict: &Verdict| LETTERS.iter().find(|(known, _)| known == verdict).expect("all are there").1;
        let verdicts = self.verdicts.chunks(LINE).map(|line| line.iter().map(letter).collect()).collect();
        let written = Written { format: FORMAT, command: command.to_owned(), study: file(&self.study), verdicts };
        let mut text = serde_json::to_string_pretty(&written).expect("a map is always JSON");
        text.push('\n');
        write_whole(path, text.as_bytes())
    }

    /// Returns the number of all tests of the map, and the number of failing tests.
    pub fn counts(&self) -> (usize, usize) {
        (self.verdicts.len(), self.fails.iter().filter(|fails| **fails).count())
    }

    /// Computes the recall and the precision with which tests with known outcomes (`Some(true)`: failed) predict the
    /// failing tests of the map.
    pub(super) fn judge(&self, tests: &[(Point, Option<bool>)]) -> Judged {
        let axes = self.places.len() / self.fails.len().max(1);
        let known: Vec<(Vec<f64>, bool)> =
            tests.iter().filter_map(|(point, fails)| Some((place(&self.axes, point), (*fails)?))).collect();
        // Without tests nothing is predicted to fail. Without coordinates all tests are at the same place.
        let told = |at: &[f64]| {
            let distance = |place: &[f64]| place.iter().zip(at).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            let nearest = known.iter().map(|(place, fails)| (distance(place), *fails));
            // Among equally near tests the first counts.
            nearest.reduce(|best, next| if next.0 < best.0 { next } else { best }).is_some_and(|(_, fails)| fails)
        };
        let [mut both, mut told_to_fail, mut failing] = [0_usize; 3];
        for (at, &fails) in self.places.chunks(axes.max(1)).zip(&self.fails) {
            let told = told(at);
            both += usize::from(told && fails);
            told_to_fail += usize::from(told);
            failing += usize::from(fails);
        }
        let share = |of: usize| (of > 0).then(|| both as f64 / of as f64);
        Judged { recall: share(failing), precision: share(told_to_fail) }
    }
}

fn file(study: &Study) -> StudyFile {
    StudyFile::new(study, &Learned::new(), None)
}

/// Returns a study as JSON without the entries that another version of the software may change.
fn comparable(study: &Study) -> serde_json::Value {
    let mut value = file(study).identity();
    if let Some(entries) = value.as_object_mut() {
        entries.remove("version");
        entries.remove("target");
    }
    value
}

fn axes(space: &Space) -> Vec<Axis> {
    let discrete = space.discrete().filter_map(|coordinate| coordinate.parameter.levels()).map(|levels| {
        let numbers: Option<Vec<f64>> = levels.iter().map(Value::number).collect();
        let ordered = levels.len() <= 2 || numbers.is_some_and(|numbers| numbers.is_sorted());
        if ordered { Axis::Ordered(levels.len()) } else { Axis::Words(levels.len()) }
    });
    std::iter::repeat_n(Axis::Continuous, space.dims()).chain(discrete).collect()
}

/// Returns the place of a test, for which squared distances are distances of the heterogeneous metric (HEOM).
fn place(axes: &[Axis], point: &Point) -> Vec<f64> {
    let mut place = point.continuous.clone();
    for (&level, axis) in point.discrete.iter().zip(&axes[point.continuous.len()..]) {
        match *axis {
            Axis::Continuous => unreachable!("discrete axes come last"),
            Axis::Ordered(levels) => place.push(level as f64 / (levels - 1).max(1) as f64),
            // Two different words are at distance 1.
            Axis::Words(levels) => {
                place.extend((0..levels).map(|word| if word == level { std::f64::consts::FRAC_1_SQRT_2 } else { 0.0 }));
            }
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_campaign::BlackBox;
    use paracosm_generators::{Request, Strategy};
    use proptest::prelude::*;

    /// A map over two numbers and a word, in which tests fail below a diagonal with the second word.
    fn map(tests: usize) -> ReferenceMap {
        let text = "parameter = [{ name = \"x\", interval = [0, 1] }, { name = \"y\", interval = [0, 1] },
            { name = \"word\", choice = [\"a\", \"b\", \"c\"] }, { name = \"number\", choice = [1, 2, 5] }]";
        let system = BlackBox::new("none", None).unwrap();
        let study = Study::of_system(system, Space::from_toml(text).unwrap()).build().unwrap();
        let study = ReferenceMap::study_of(&study, tests).unwrap();
        let verdict = |point: &Point| if fails(point) { Verdict::Fail } else { Verdict::Pass };
        let verdicts = study.generator(&[]).unwrap().ask(tests).iter().map(verdict).collect();
        ReferenceMap::of(study, verdicts).unwrap()
    }

    fn fails(point: &Point) -> bool {
        point.discrete[0] == 1 && point.continuous[0] + point.continuous[1] < 0.8
    }

    fn judged(map: &ReferenceMap, tests: usize, seed: u64) -> (Judged, Vec<(Point, Option<bool>)>) {
        let request = Request { seed: Some(seed), ..Request::new(map.study.space(), tests) };
        let points = Strategy::RANDOM.build(&request).unwrap().ask(tests);
        let outcome = |point: Point| {
            let broken = point.continuous[0] > 0.9;
            (point.clone(), (!broken).then(|| fails(&point)))
        };
        let tests: Vec<_> = points.into_iter().map(outcome).collect();
        (map.judge(&tests), tests)
    }

    /// The same by the definitions, each distance worked out from levels.
    fn naive(map: &ReferenceMap, tests: &[(Point, Option<bool>)]) -> Judged {
        let square = |a: &Point, b: &Point| {
            let continuous: f64 = a.continuous.iter().zip(&b.continuous).map(|(a, b)| (a - b) * (a - b)).sum();
            let steps = (a.discrete[1] as f64 - b.discrete[1] as f64) / 2.0;
            continuous + f64::from(u8::from(a.discrete[0] != b.discrete[0])) + steps * steps
        };
        let points = map.study.generator(&[]).unwrap().ask(map.verdicts.len());
        let told = |at: &Point| {
            let known: Vec<_> = tests.iter().filter_map(|(test, fails)| Some((square(test, at), (*fails)?))).collect();
            known.iter().min_by(|a, b| a.0.total_cmp(&b.0)).is_some_and(|nearest| nearest.1)
        };
        let count = |which: &dyn Fn(&Point) -> bool| points.iter().filter(|point| which(point)).count() as f64;
        let both = count(&|point| told(point) && fails(point));
        let (told, failing) = (count(&told), count(&fails));
        Judged { recall: (failing > 0.0).then(|| both / failing), precision: (told > 0.0).then(|| both / told) }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn recall_and_precision_are_those_of_the_nearest_tests(size in 1_usize..40, seed in 0_u64..1000) {
            let map = map(300);
            let (judged, tests) = judged(&map, size, seed);
            let naive = naive(&map, &tests);
            let close = |a: Option<f64>, b: Option<f64>| match (a, b) {
                (Some(a), Some(b)) => (a - b).abs() < 1e-9,
                (a, b) => a.is_none() && b.is_none(),
            };
            prop_assert!(close(judged.recall, naive.recall) && close(judged.precision, naive.precision));
        }
    }

    #[test]
    fn many_tests_know_nearly_all_and_none_know_nothing() {
        let map = map(2000);
        let (judged, _) = judged(&map, 3000, 5);
        assert!(judged.recall.unwrap() > 0.9 && judged.precision.unwrap() > 0.9, "{judged:?}");
        assert_eq!(map.judge(&[]), Judged { recall: Some(0.0), precision: None });
    }

    #[test]
    fn a_map_that_was_written_is_read_again_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.json");
        let map = map(250);
        map.write(&path, "how").unwrap();
        let again = ReferenceMap::read(&path, &map.study).unwrap();
        assert_eq!((again.verdicts, again.places, again.fails), (map.verdicts, map.places, map.fails));
        let other = BlackBox::new("other", None).unwrap();
        let other = Study::of_system(other, map.study.space().clone()).build().unwrap();
        let message = ReferenceMap::read(&path, &other).unwrap_err().to_string();
        assert!(message.contains("another study") && message.contains("`system`"), "{message}");
    }
}
