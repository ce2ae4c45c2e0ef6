//! Random sampling held against the Halton sequence on a study of two parameters: what the paper's Figure 9 shows.
//!
//! Each sample has its dispersion and star discrepancy, and a reference map, which neither sampler has a part in, tells what
//! it lets one know: how much of the map is right if one believes the nearest test. Random has many seeds, and the one that
//! is drawn is neither a lucky nor an unlucky one.

use crate::recovery::{Mark, Recovery, failing, nearest_neighbour, recovery, straight_line};
use crate::{Done, logged, print, write};
use indicatif::ProgressBar;
use paracosm::analysis::Coverage;
use paracosm::analysis::statistics::quantile;
use paracosm::campaign::Learned;
use paracosm::coverage::Measure;
use paracosm::generators::Strategy;
use paracosm::report::{FailureMap, Picture};
use paracosm::space::{Point, Values};
use paracosm::{Campaign, Error, Log, Sampling, Study, Trial};
use std::path::Path;

/// The strategies that are compared, in the order of the rows.
const STRATEGIES: [Strategy; 2] = [Strategy::RANDOM, Strategy::HALTON];

/// One sample of one strategy.
struct Panel {
    strategy: Strategy,
    seed: Option<u64>,
    log: Log,
    dispersion: f64,
    star: f64,
    recovery: Recovery,
}

/// Both strategies at some sizes.
pub struct Comparison<'a> {
    /// What is sampled: a study of two continuous parameters, the first of which is a speed.
    pub study: &'a Study,
    /// Tests in a sample, in rising order.
    pub sizes: &'a [usize],
    /// How many random samples.
    pub seeds: u64,
    /// The reference map.
    pub map: &'a [Mark],
}

impl Comparison<'_> {
    /// How many tests it takes.
    pub fn tests(&self) -> usize {
        self.most() * (self.seeds as usize + 1)
    }

    fn most(&self) -> usize {
        *self.sizes.last().expect("there is a size")
    }

    /// Runs it, draws the picture of this name, writes all numbers to the folder and prints the summary.
    pub fn run(&self, out: &Path, name: &str, bar: &ProgressBar) -> Done {
        let panels = self.panels(bar)?;
        bar.finish_and_clear();
        let typical = self.typical_seed(&panels);
        let shown = |panel: &&Panel| panel.seed.is_none_or(|seed| Some(seed) == typical);
        let rows = STRATEGIES.into_iter();
        let figure: Vec<&Panel> =
            rows.flat_map(|strategy| panels.iter().filter(shown).filter(move |p| p.strategy == strategy)).collect();
        let maps = figure.iter().map(|panel| panel.draw()).collect();
        draw(out, name, &Picture::grid(self.sizes.len(), maps))?;

        write_panels(&out.join("panels.csv"), &panels)?;
        write_tests(&out.join("tests.csv"), self.study, &figure)?;
        let summary = self.summary(&panels);
        write_csv(&out.join("summary.csv"), &summary)?;
        let halton = panels.iter().find(|panel| panel.seed.is_none() && panel.log.trials().len() == self.most());
        let halton = halton.expect("Halton has a panel of every size");
        write_csv(&out.join("shape.csv"), &shape(self.map, &marks(self.study, halton.log.trials())?))?;
        print(&self.table(&summary))
    }

    fn panels(&self, bar: &ProgressBar) -> Result<Vec<Panel>, Error> {
        let mut panels = Vec::new();
        for seed in [None].into_iter().chain((1..=self.seeds).map(Some)) {
            let strategy = if seed.is_none() { Strategy::HALTON } else { Strategy::RANDOM };
            let sampling = Sampling { strategy, seed, budget: self.most(), ..self.study.sampling().clone() };
            let log = logged(&self.study.sampled(sampling)?, bar)?;
            // Both are sequences: the smaller samples are the beginning of the largest.
            for &size in self.sizes {
                let sample = log.with_trials(log.trials()[..size].to_vec());
                panels.push(panel(sample, strategy, seed, self.map)?);
            }
        }
        Ok(panels)
    }

    /// The seed whose smallest sample has the median dispersion, the upper one of two.
    fn typical_seed(&self, panels: &[Panel]) -> Option<u64> {
        let smallest = panels.iter().filter(|panel| panel.seed.is_some() && panel.log.trials().len() == self.sizes[0]);
        let mut smallest: Vec<&Panel> = smallest.collect();
        smallest.sort_by(|a, b| a.dispersion.total_cmp(&b.dispersion));
        smallest[smallest.len() / 2].seed
    }

    /// Median and quartiles over the seeds: one row for each strategy at each size.
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

    /// The summary for people: measure by measure, random beside Halton.
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

/// Runs the tests in the middle of every cell of a grid with so many on each side, in rows of equal distance.
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

/// Runs the tests of a grid, draws them and writes them as `reference-map`.
pub fn reference_map(study: &Study, side: usize, out: &Path, bar: &ProgressBar) -> Result<Vec<Trial>, Failure> {
    let trials = grid(study, side, bar)?;
    let mut map = failure_map(&Log::new(study.clone(), Learned::new(), None, trials.clone()));
    map.title = format!("Reference map: {side} x {side} tests");
    map.note = "the middle of every cell of a grid".into();
    draw(out, "reference-map", &Picture::of(map))?;
    write_trials(&out.join("reference-map.csv"), study, &trials)?;
    Ok(trials)
}

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Where the tests are in the unit square, and whether they fail.
pub fn marks(study: &Study, trials: &[Trial]) -> Result<Vec<Mark>, Error> {
    let mark = |trial: &Trial| {
        let point = study.space().encode(&trial.test)?.continuous;
        Ok(([point[0], point[1]], trial.is_failure()))
    };
    trials.iter().map(mark).collect()
}

fn panel(log: Log, strategy: Strategy, seed: Option<u64>, map: &[Mark]) -> Result<Panel, Error> {
    let coverage = Coverage::of(&log.test_set()?, &[Measure::DISPERSION, Measure::STAR], None, None)?;
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

    fn draw(&self) -> FailureMap {
        let mut map = failure_map(&self.log);
        let seed = self.seed.map_or(String::new(), |seed| format!(" (seed {seed})"));
        map.title = format!("{}{seed}, {} tests", self.strategy, self.log.trials().len());
        map.note = format!(
            "dispersion {:.4}, star discrepancy {:.4}, map accuracy {:.1} %",
            self.dispersion,
            self.star,
            100.0 * self.recovery.accuracy
        );
        map
    }
}

fn failure_map(log: &Log) -> FailureMap {
    FailureMap::of(log).expect("the study has two continuous parameters")
}

fn draw(out: &Path, name: &str, picture: &Picture) -> Done {
    write(&out.join(format!("{name}.svg")), picture.svg()?)?;
    write(&out.join(format!("{name}.png")), picture.png()?)
}

/// Writes a table, of which the first row is the header.
pub fn write_csv(path: &Path, rows: &[Vec<String>]) -> Done {
    let mut csv = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| csv.write_record(row))?;
    write(path, csv.into_inner()?)
}

type Measured = fn(&Panel) -> f64;

/// What is measured of each sample, with its name. A sample without failures has no precision: NaN.
const MEASURED: [(&str, Measured); 6] = [
    ("failures", |panel| panel.failures() as f64),
    ("dispersion", |panel| panel.dispersion),
    ("star_discrepancy", |panel| panel.star),
    ("map_accuracy", |panel| panel.recovery.accuracy),
    ("map_recall", |panel| panel.recovery.recall),
    ("map_precision", |panel| panel.recovery.precision),
];

/// One row a sample.
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

/// What can be said of the shape of the failing region: how often tests fail in each quarter of the walking
/// speeds, and how much a straight line or the nearest neighbour explains. Of the dense map and of the Halton tests.
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
    }
    let explained = [
        ("all passing", 1.0 - failing(halton)),
        ("best straight line", straight_line(halton)),
        ("nearest neighbour", nearest_neighbour(halton)),
    ];
    rows.extend(
        explained.map(|(by, share)| vec![of_halton.clone(), format!("explained by {by}"), format!("{share:.4}")]),
    );
    rows
}

/// Every mark of the figure.
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

/// Tests with what became of them.
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
