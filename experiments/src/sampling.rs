//! Compares random sampling with the Halton sequence on a study of two parameters, as the paper's Figure 9 does.
//!
//! The study measures the dispersion and the star discrepancy of each sample. A reference map, which is independent of
//! both samplers, shows how much a sample tells: the share of the map that is right if every place is given the verdict
//! of the nearest test. Random sampling has many seeds; the seed in the picture is a typical one.

use crate::recovery::{Mark, Recovery, failing, nearest_neighbour, recovery, straight_line};
use crate::{Done, logged, print, write};
use indicatif::ProgressBar;
use paracosm::analysis::statistics::quantile;
use paracosm::analysis::{Coverage, Limit};
use paracosm::coverage::Measure;
use paracosm::generators::Strategy;
use paracosm::space::{Point, Values};
use paracosm::{Campaign, Error, Log, Sampling, Study, Trial};
use std::path::Path;

/// The strategies in the comparison, in the order of the picture's rows.
const STRATEGIES: [Strategy; 2] = [Strategy::RANDOM, Strategy::HALTON];

/// A sample of a strategy, with its measures.
struct Panel {
    strategy: Strategy,
    seed: Option<u64>,
    log: Log,
    dispersion: f64,
    star: f64,
    recovery: Recovery,
}

/// A comparison of both strategies at several sizes.
pub struct Comparison<'a> {
    /// The study that is sampled. It has two continuous parameters, and the first one is a speed.
    pub study: &'a Study,
    /// The numbers of tests in a sample, in ascending order.
    pub sizes: &'a [usize],
    /// The number of random samples.
    pub seeds: u64,
    /// The reference map, in the unit square.
    pub map: &'a [Mark],
}

impl Comparison<'_> {
    /// Returns the number of tests in the whole comparison.
    pub fn tests(&self) -> usize {
        self.most() * (self.seeds as usize + 1)
    }

    fn most(&self) -> usize {
        *self.sizes.last().expect("there is a size")
    }

    /// Runs the comparison, writes all numbers to files that begin with the name, and prints the summary.
    pub fn run(&self, out: &Path, name: &str, bar: &ProgressBar) -> Done {
        let panels = self.panels(bar)?;
        bar.finish_and_clear();
        let typical = self.typical_seed(&panels);
        let shown = |panel: &&Panel| panel.seed.is_none_or(|seed| Some(seed) == typical);
        let rows = STRATEGIES.into_iter();
        let figure: Vec<&Panel> =
            rows.flat_map(|strategy| panels.iter().filter(shown).filter(move |p| p.strategy == strategy)).collect();
        write_panels(&out.join(format!("{name}-panels.csv")), &panels)?;
        write_tests(&out.join(format!("{name}-tests.csv")), self.study, &figure)?;
        let summary = self.summary(&panels);
        let halton = panels.iter().find(|panel| panel.seed.is_none() && panel.log.trials().len() == self.most());
        let halton = halton.expect("Halton has a panel of every size");
        write_csv(&out.join(format!("{name}-shape.csv")), &shape(self.map, &marks(self.study, halton.log.trials())?))?;
        print(&self.table(&summary))
    }

    fn panels(&self, bar: &ProgressBar) -> Result<Vec<Panel>, Error> {
        let mut panels = Vec::new();
        for seed in [None].into_iter().chain((1..=self.seeds).map(Some)) {
            let strategy = if seed.is_none() { Strategy::HALTON } else { Strategy::RANDOM };
            let sampling = Sampling { strategy, seed, budget: self.most(), ..self.study.sampling().clone() };
            let log = logged(&self.study.sampled(sampling)?, bar)?;
            // Both strategies are sequences, so that the smaller samples are the beginnings of the largest.
            for &size in self.sizes {
                let sample = log.with_trials(log.trials()[..size].to_vec());
                panels.push(panel(sample, strategy, seed, self.map)?);
            }
        }
        Ok(panels)
    }

    /// Returns the seed of the random samples in the figure: the seed whose smallest sample has the median dispersion; of two medians, the upper one.
    fn typical_seed(&self, panels: &[Panel]) -> Option<u64> {
        let smallest = panels.iter().filter(|panel| panel.seed.is_some() && panel.log.trials().len() == self.sizes[0]);
        let mut smallest: Vec<&Panel> = smallest.collect();
        smallest.sort_by(|a, b| a.dispersion.total_cmp(&b.dispersion));
        smallest[smallest.len() / 2].seed
    }

    /// Returns the medians and quartiles over the seeds, in one row for each strategy at each size.
    fn summary(&self, panels: &[Panel]) -> Vec<Vec<String>> {
        let of = |name: &str| [name.to_owned(), format!("{name}_lower_quartile"), format!("{name}_upper_quartile")];
        let measures = MEASURED.iter().flat_map(|(name, _)| of(name));
        let mut rows = vec![["strategy", "tests", "seeds"].map(str::to_owned).into_iter().chain(measures).collect()];
        for strategy in STRATEGIES {
            for &size in self.sizes {
                let samples =
                    panels.iter().filter(|panel| panel.strategy == strategy && panel.log.trials().len() == size);
                let what = [strategy.to_string(), size.to_string(), samples.clone().count().to_string()];
                let numbers = MEASURED.iter().flat_map(|(_, measure)| {
                    let mut values: Vec<f64> = samples.clone().map(measure).collect();
                    values.sort_by(f64::total_cmp);
                    [0.5, 0.25, 0.75].map(|q| format!("{:.4}", quantile(&values, q)))
                });
                rows.push(what.into_iter().chain(numbers).collect());
            }
        }
        rows
    }

    /// Returns the summary as plain text for people: measure by measure, with random beside Halton.
    fn table(&self, rows: &[Vec<String>]) -> String {
        let mut text =
            format!("{:<18}{:>6}{:>16}{:>20}{:>10}\n", "measure", "tests", "random, median", "quartiles", "halton");
        let (random, halton) = rows[1..].split_at(self.sizes.len());
        for (measure, (name, _)) in MEASURED.iter().enumerate() {
            for (random, halton) in random.iter().zip(halton) {
                let number = |row: &[String], i: usize| row[3 + 3 * measure + i].clone();
                let quartiles = format!("{}..{}", number(random, 1), number(random, 2));
                let (tests, median, halton) = (&random[1], number(random, 0), number(halton, 0));
                text += &format!("{name:<18}{tests:>6}{median:>16}{quartiles:>20}{halton:>10}\n");
            }
        }
        text
    }
}

/// Runs the tests in the middle of every cell of a grid with `side` cells on each side, row by row.
pub fn grid(study: &Study, side: usize, bar: &ProgressBar) -> Result<Vec<Trial>, Error> {
    let middle = |i: usize| (i as f64 + 0.5) / side as f64;
    let cells = (0..side * side).map(|i| vec![middle(i % side), middle(i / side)]);
    let tests: Vec<Values> =
        cells.map(|continuous| study.space().decode(&Point { continuous, discrete: Vec::new() })).collect();
    let mut trials = Vec::with_capacity(tests.len());
    Campaign::new(study)?.run_tests(&tests, 0, |trial| {
        bar.inc(1);
        trials.push(trial.clone());
        Ok(())
    })?;
    Ok(trials)
}

/// Runs the tests of a grid, and writes them to a table whose name begins with the name of the study.
pub fn reference_map(
    study: &Study,
    side: usize,
    out: &Path,
    name: &str,
    bar: &ProgressBar,
) -> Result<Vec<Trial>, Failure> {
    let trials = grid(study, side, bar)?;
    write_trials(&out.join(format!("{name}-reference.csv")), study, &trials)?;
    Ok(trials)
}

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Returns the place of each test in the unit square, and whether the test fails.
pub fn marks(study: &Study, trials: &[Trial]) -> Result<Vec<Mark>, Error> {
    let mark = |trial: &Trial| {
        let point = study.space().encode(&trial.test)?.continuous;
        Ok(([point[0], point[1]], trial.is_failure()))
    };
    trials.iter().map(mark).collect()
}

fn panel(log: Log, strategy: Strategy, seed: Option<u64>, map: &[Mark]) -> Result<Panel, Error> {
    let coverage = Coverage::of(&log.test_set()?, &[Measure::DISPERSION, Measure::STAR], None, Limit::None)?;
    let measured = coverage.continuous.expect("the study has two continuous parameters");
    Ok(Panel {
        strategy,
        seed,
        dispersion: measured.bracket(Measure::DISPERSION).expect("it was asked for").lower,
        star: measured.bracket(Measure::STAR).expect("it was asked for").lower,
        recovery: recovery(&marks(log.study(), log.trials())?, map),
        log,
    })
}

impl Panel {
    fn failures(&self) -> usize {
        self.log.trials().iter().filter(|trial| trial.is_failure()).count()
    }
}

/// Writes a table, whose first row is the header.
pub fn write_csv(path: &Path, rows: &[Vec<String>]) -> Done {
    let mut csv = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| csv.write_record(row))?;
    write(path, csv.into_inner()?)
}

type Measured = fn(&Panel) -> f64;

/// The measures of a sample, with their names. The precision is NaN if no test of the map is predicted to fail.
const MEASURED: [(&str, Measured); 6] = [
    ("failures", |panel| panel.failures() as f64),
    ("dispersion", |panel| panel.dispersion),
    ("star_discrepancy", |panel| panel.star),
    ("map_accuracy", |panel| panel.recovery.accuracy),
    ("map_recall", |panel| panel.recovery.recall),
    ("map_precision", |panel| panel.recovery.precision),
];

/// Writes a table with one row for each sample.
fn write_panels(path: &Path, panels: &[Panel]) -> Done {
    let header = ["strategy", "seed", "tests"].into_iter().chain(MEASURED.map(|(name, _)| name));
    let row = |panel: &Panel| {
        let seed = panel.seed.map_or(String::new(), |seed| seed.to_string());
        let what = [panel.strategy.to_string(), seed, panel.log.trials().len().to_string()];
        what.into_iter().chain(MEASURED.map(|(_, measure)| measure(panel).to_string())).collect()
    };
    let rows: Vec<_> = [header.map(str::to_owned).collect()].into_iter().chain(panels.iter().map(row)).collect();
    write_csv(path, &rows)
}

/// Returns measures of the shape of the failing region, for the reference map and the Halton tests: the share of
/// failing tests in each quarter of the walking speeds, and how much a straight line or the nearest neighbour explains.
fn shape(map: &[Mark], halton: &[Mark]) -> Vec<Vec<String>> {
    let quarter = |marks: &[Mark], i: usize| {
        let within = marks.iter().filter(|mark| (mark.0[0] * 4.0).floor() as usize == i);
        within.clone().filter(|mark| mark.1).count() as f64 / within.count() as f64
    };
    let mut rows = vec![["of", "measure", "share"].map(str::to_owned).to_vec()];
    let of_halton = format!("halton, {} tests", halton.len());
    for (of, marks) in [("reference map", map), (&of_halton, halton)] {
        let mut row = |measure: String, share: f64| rows.push(vec![of.to_owned(), measure, format!("{share:.4}")]);
        row("failing".into(), failing(marks));
        (0..4).for_each(|i| row(format!("failing in quarter {} of the speeds", i + 1), quarter(marks, i)));
        row("explained by all passing".into(), 1.0 - failing(marks));
        row("explained by best straight line".into(), straight_line(marks));
        row("explained by nearest neighbour".into(), nearest_neighbour(marks));
    }
    rows
}

/// Writes a table of all marks of the figure.
fn write_tests(path: &Path, study: &Study, figure: &[&Panel]) -> Done {
    let header = ["strategy", "tests", "index"].map(str::to_owned).into_iter().chain(header(study));
    let mut rows: Vec<Vec<String>> = vec![header.collect()];
    for panel in figure {
        for trial in panel.log.trials() {
            let what = [panel.strategy.to_string(), panel.log.trials().len().to_string(), trial.index.to_string()];
            rows.push(what.into_iter().chain(row(trial)).collect());
        }
    }
    write_csv(path, &rows)
}

/// Writes a table of tests with their verdicts.
fn write_trials(path: &Path, study: &Study, trials: &[Trial]) -> Done {
    let rows: Vec<Vec<String>> =
        [header(study).collect()].into_iter().chain(trials.iter().map(|trial| row(trial).collect())).collect();
    write_csv(path, &rows)
}

fn header(study: &Study) -> impl Iterator<Item = String> {
    let names = study.space().parameters().iter().map(|parameter| parameter.name.clone());
    names.chain(["verdict", "violated"].map(str::to_owned))
}

fn row(trial: &Trial) -> impl Iterator<Item = String> {
    let violated: Vec<&str> = trial.violated().collect();
    let values = trial.test.iter().map(|(_, value)| value.to_string());
    values.chain([trial.verdict.to_string(), violated.join(" ")])
}
