//! `compare`: compares strategies by their points, ours and those of other packages.

use crate::arrays::{points_of, rows};
use crate::detached::{STOP, watched};
use crate::error::raised;
use crate::measures::duration;
use crate::progress::Progress;
use crate::space::test_at;
use crate::table::Table;
use crate::threads::with_threads;
use crate::whole::{at_once, maybe_whole, whole, wholes};
use paracosm::analysis::Limit;
use paracosm::analysis::asked::new_folder;
use paracosm::analysis::compare::{Compared, SamplerComparison};
use paracosm::campaign::{Error as LibraryError, TestSet};
use paracosm::coverage::Measure;
use paracosm::generators::{Look, PointSets, Strategy};
use paracosm::report::compare as files;
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::available_parallelism;

/// A comparison of strategies by the evenness of their points.
///
/// `comparison.summary` has a row for each measure, number of dimensions, number of points and strategy: the median and the quartiles over the
/// seeds, and against the baseline the median ratio with its 95 % bootstrap interval, A12, and the p-value of Wilcoxon's signed-rank test before and after Holm's
/// correction. `print` shows it.
#[pyclass(frozen, module = "paracosm")]
pub struct Comparison {
    inner: Compared,
}

/// Compares strategies over dimensions, numbers of points and seeds, by measures of their points in the unit cube. All measures are better the
/// lower they are.
///
/// strategies: the names of strategies, or samplers of other packages: an engine of `scipy.stats.qmc`, a sampler of Optuna, an object with `ask(n)`
/// and `tell(X, y)`, or a function that gets the number of dimensions, and a seed as `rng` or `seed`, and makes one. A dictionary gives them names.
/// dims, budgets: the numbers of dimensions ([2, 3, 5]) and of points ([50, 100, 500]).
/// seeds: the number of seeds (30). seed: the first one, which is 1 if a sampler of another package takes part.
/// measures: the names of measures; without them, all but the fill distance.
/// k: the number of coordinates that the k-wise dispersion combines.
/// baseline: the name of the strategy to compare with; without it, halton if it is among the strategies, and otherwise the first.
/// time_limit: the limit in seconds for a measure of a set.
/// executor: the number of sets that are measured at the same time; without it, all cores work.
/// progress: a function that is called with the numbers of sets that are done and of all sets; `False` for none. Without it, a terminal or a notebook
/// shows the progress.
///
/// Raises `Error` if a strategy needs the results of tests, or makes other points than it should.
#[pyfunction]
#[pyo3(signature = (
    strategies, *, dims = vec![2, 3, 5], budgets = vec![50, 100, 500], seeds = None, seed = 1, measures = None, k = 2, baseline = None,
    time_limit = None, executor = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub fn compare(
    py: Python,
    strategies: &Bound<PyAny>,
    #[pyo3(from_py_with = wholes)] dims: Vec<usize>,
    #[pyo3(from_py_with = wholes)] budgets: Vec<usize>,
    #[pyo3(from_py_with = maybe_whole)] seeds: Option<usize>,
    #[pyo3(from_py_with = whole)] seed: u64,
    measures: Option<Vec<String>>,
    #[pyo3(from_py_with = whole)] k: usize,
    baseline: Option<String>,
    time_limit: Option<f64>,
    #[pyo3(from_py_with = at_once)] executor: Option<NonZeroUsize>,
    progress: Option<&Bound<PyAny>>,
) -> PyResult<Comparison> {
    let most = |numbers: &[usize]| numbers.iter().copied().max().unwrap_or_default();
    TestSet::check_size(most(&budgets), most(&dims)).map_err(raised)?;
    let measures = measures.map(|names| names.iter().map(|name| name.parse::<Measure>().map_err(raised)).collect());
    let limit = time_limit.map(duration).transpose()?.map_or(Limit::LONG, Limit::Time);
    let wanted = Wanted { dims: &dims, budgets: &budgets, seeds: seeds.unwrap_or(SEEDS), seed };
    let strategies = wanted.strategies(strategies)?;
    let defaults = SamplerComparison::of(&strategies).map_err(raised)?;
    let named = |name: String| {
        let known = strategies.iter().copied().find(|strategy| strategy.name() == name);
        known.map_or_else(|| ours(&name), Ok)
    };
    let baseline = baseline.map(named).transpose()?.unwrap_or(defaults.baseline);
    let (seeds, first_seed) = (seeds.unwrap_or(defaults.seeds), seed);
    let measures = measures.transpose()?;
    let comparison = SamplerComparison { dims, budgets, seeds, first_seed, measures, k, baseline, limit, ..defaults };
    let plan = comparison.plan().map_err(raised)?;
    let jobs = executor.or(available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN);
    let (done, sets) = (AtomicUsize::new(0), plan.sets());
    let mut progress = Progress::of(py, progress)?;
    let mut tell = |py: Python| progress.tell(py, done.load(Ordering::Relaxed), sets);
    let compared = watched(py, &STOP, &mut tell, || {
        plan.run(jobs, |_| {
            done.fetch_add(1, Ordering::Relaxed);
            if STOP.load(Ordering::Relaxed) { Err(LibraryError::Interrupted) } else { Ok(()) }
        })
    })?;
    tell(py)?;
    Ok(Comparison { inner: compared.map_err(raised)? })
}

/// The number of seeds of a comparison.
const SEEDS: usize = 30;

/// The sets of points that a comparison wants of each strategy.
struct Wanted<'a> {
    dims: &'a [usize],
    budgets: &'a [usize],
    seeds: usize,
    seed: u64,
}

impl Wanted<'_> {
    /// Reads strategies. The strategies of other packages make all their sets here.
    fn strategies(&self, found: &Bound<PyAny>) -> PyResult<Vec<Strategy>> {
        let named = found.py().import("paracosm._strategies")?.call_method1("named", (found,))?;
        let named: Vec<(String, Option<Bound<PyAny>>)> = named.extract()?;
        let mut looks = Look::OTHERS.into_iter().cycle();
        let mut strategies = Vec::with_capacity(named.len());
        for (name, given) in named {
            strategies.push(match given {
                None => ours(&name)?,
                Some(given) => Strategy::of_sets(&name, looks.next().expect("they go on"), self.sets(&name, &given)?),
            });
        }
        Ok(strategies)
    }

    /// Lets a strategy of another package make a set of points of each size for each seed.
    fn sets(&self, name: &str, given: &Bound<PyAny>) -> PyResult<PointSets> {
        if self.seed != 1 {
            let seed = self.seed;
            return Err(raised(format!(
                "seed is {seed}, expected 1 with a strategy of another package, here `{name}`"
            )));
        }
        let strategies = given.py().import("paracosm._strategies")?;
        let mut sets = PointSets::default();
        for &dims in self.dims {
            for &points in self.budgets {
                for seed in 1..=self.seeds {
                    let set = strategies.call_method1("set_of", (name, given, dims, points, seed))?;
                    let set = points_of(&set, "the points")?;
                    sets.add(rows(&set).iter().map(|point| test_at(&vec![0; dims], point)).collect());
                }
            }
        }
        Ok(sets)
    }
}

/// Returns a strategy of the library that needs no results.
fn ours(name: &str) -> PyResult<Strategy> {
    match name.parse::<Strategy>().map_err(raised)? {
        strategy if strategy.is_adaptive() => Err(raised(format!(
            "`{strategy}` learns from the results of tests, so its points cannot be compared without them"
        ))),
        strategy => Ok(strategy),
    }
}

#[pymethods]
impl Comparison {
    /// The statistics of each strategy: a table with the columns of `summary.csv`.
    #[getter]
    fn summary(&self) -> Table {
        Table::of_texts(files::summary_rows(&self.inner))
    }

    /// The sets of points with their measures: a table with the columns of `sets.csv`.
    #[getter]
    fn sets(&self) -> Table {
        Table::of_texts(files::set_rows(&self.inner))
    }

    /// The exponents with which measures fall with the number of points: a table with the columns of `slopes.csv`.
    #[getter]
    fn slopes(&self) -> Table {
        Table::of_texts(files::slope_rows(&self.inner))
    }

    /// Remarks on sets and measures that are left out or cut short, and on few seeds.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.inner.notes.clone()
    }

    /// Writes the comparison into a new folder, as `paracosm-cover compare` does: `sets.csv`, `summary.csv`, `slopes.csv`, `table.tex` for a
    /// paper, and for each measure and number of dimensions a figure as SVG and PNG.
    fn write(&self, py: Python, folder: PathBuf) -> PyResult<()> {
        py.detach(|| with_threads(|| new_folder(&folder).and_then(|()| files::write(&self.inner, &folder))))
            .map_err(raised)
    }

    /// The results as `paracosm-cover compare` prints them.
    fn __str__(&self) -> String {
        files::table(&self.inner)
    }

    fn __repr__(&self) -> String {
        let (sets, strategies) = (self.inner.sets.len(), &self.inner.comparison.strategies);
        let names: Vec<&str> = strategies.iter().map(|strategy| strategy.name()).collect();
        format!("Comparison({}: {sets} sets)", names.join(", "))
    }
}
