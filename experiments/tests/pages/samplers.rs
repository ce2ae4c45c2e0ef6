//! Computes the numbers of the page on samplers.

use crate::page::Page;
use crate::rows::{numbers_of, range, rows};
use flate2::read::GzDecoder;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::io::Read;
use std::path::Path;

const DIMS: [u32; 5] = [2, 3, 5, 7, 10];

/// The values of a measure over the seeds, as brackets, by dimension, number of points and strategy.
type Values = BTreeMap<(u32, u32, String), Vec<[f64; 2]>>;

/// The sets of the study, one row for each set.
struct Study {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
    /// The strategies in the order of the rows.
    strategies: Vec<String>,
}

impl Study {
    fn read() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/samplers-sets.csv.gz");
        let mut text = String::new();
        GzDecoder::new(fs::File::open(path).unwrap()).read_to_string(&mut text).unwrap();
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let names = lines.next().unwrap();
        let rows: Vec<Vec<String>> = lines.collect();
        let mut strategies: Vec<String> = Vec::new();
        for row in &rows {
            if !strategies.contains(&row[0]) {
                strategies.push(row[0].clone());
            }
        }
        Self { names, rows, strategies }
    }

    fn column(&self, name: &str) -> usize {
        self.names.iter().position(|other| other == name).unwrap()
    }

    fn values(&self, measure: &str) -> Values {
        let ends = [format!("{measure}_lower"), format!("{measure}_upper")].map(|name| self.column(&name));
        let mut values = Values::new();
        for row in self.rows.iter().filter(|row| !row[3].is_empty()) {
            let bracket = ends.map(|end| row[end].parse::<f64>());
            if let [Ok(lower), Ok(upper)] = bracket {
                let key = (row[1].parse().unwrap(), row[2].parse().unwrap(), row[0].clone());
                values.entry(key).or_default().push([lower, upper]);
            }
        }
        values
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    f64::midpoint(values[(n - 1) / 2], values[n / 2])
}

/// The bracket around the median of values that are known as brackets.
fn middle(values: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|end| median(values.iter().map(|bracket| bracket[end]).collect()))
}

/// Three digits that count.
fn three(value: f64) -> String {
    if value < 1e-3 {
        return format!("{value:.2e}");
    }
    let digits = 2 - libm::log10(value).floor() as i32;
    format!("{value:.*}", digits.clamp(0, 12) as usize)
}

/// Both ends of a bracket, or one number if they are the same in three digits.
fn written([lower, upper]: [f64; 2]) -> String {
    let [low, high] = [lower, upper].map(three);
    if low == high { low } else { format!("{low} to {high}") }
}

/// The table of the medians of a measure, with a column for each dimension. The lowest median is bold if it is certain.
fn medians(study: &Study, measure: &str, points: u32) -> String {
    let values = study.values(measure);
    let dims: Vec<u32> =
        DIMS.into_iter().filter(|dims| values.keys().any(|key| (key.0, key.1) == (*dims, points))).collect();
    let mut text = String::from("| strategy |");
    dims.iter().for_each(|dims| write!(text, " d = {dims} |").unwrap());
    text += "\n| --- |";
    text += &" --- |".repeat(dims.len());
    text.push('\n');
    for strategy in &study.strategies {
        let at =
            |dims: u32, strategy: &String| values.get(&(dims, points, strategy.clone())).map(|values| middle(values));
        let cells = dims.iter().map(|&dims| {
            let Some(own) = at(dims, strategy) else { return String::new() };
            let others = study.strategies.iter().filter(|other| *other != strategy).filter_map(|other| at(dims, other));
            let is_least = others.fold(f64::INFINITY, |least, other| least.min(other[0])) >= own[1];
            if is_least { format!("**{}**", written(own)) } else { written(own) }
        });
        let cells: Vec<String> = cells.collect();
        if cells.iter().any(|cell| !cell.is_empty()) {
            writeln!(text, "| `{strategy}` | {} |", cells.join(" | ")).unwrap();
        }
    }
    text
}

/// The table of the median ratios of a measure to the value of Halton's set with the same seed, at two numbers of points. A ratio stands only where
/// all values are exact.
fn ratios(study: &Study, measure: &str, points: [u32; 2]) -> String {
    let values = study.values(measure);
    let exact = |values: &[[f64; 2]]| values.iter().all(|bracket| bracket[1] - bracket[0] <= 1e-9 * bracket[1]);
    let ratio = |dims: u32, points: u32, strategy: &str| {
        let of = |strategy: &str| values.get(&(dims, points, strategy.to_owned()));
        let (own, halton) = (of(strategy)?, of("halton")?);
        let are_pairs = own.len() == halton.len() && exact(own) && exact(halton);
        are_pairs.then(|| median(own.iter().zip(halton).map(|(own, halton)| own[0] / halton[0]).collect()))
    };
    let columns: Vec<(u32, u32)> = DIMS.into_iter().flat_map(|dims| points.map(|points| (dims, points))).collect();
    let columns: Vec<_> = columns.into_iter().filter(|(d, n)| ratio(*d, *n, "random").is_some()).collect();
    let mut text = String::from("| strategy |");
    columns.iter().for_each(|(dims, points)| write!(text, " d = {dims}, n = {points} |").unwrap());
    text += "\n| --- |";
    text += &" --- |".repeat(columns.len());
    text.push('\n');
    for strategy in study.strategies.iter().filter(|strategy| *strategy != "halton" && *strategy != "star-set") {
        let cell =
            |(dims, points): &(u32, u32)| ratio(*dims, *points, strategy).map_or(String::new(), |r| format!("{r:.2}"));
        writeln!(text, "| `{strategy}` | {} |", columns.iter().map(cell).collect::<Vec<_>>().join(" | ")).unwrap();
    }
    text
}

/// The share of values that are exact and the widest bracket, for each measure.
fn exactness(study: &Study) -> String {
    let mut text =
        String::from("| measure | values | exact | widest bracket, upper to lower end |\n| --- | --- | --- | --- |\n");
    for name in study.names.iter().filter_map(|name| name.strip_suffix("_lower")) {
        let ends = ["lower", "upper"].map(|end| study.column(&format!("{name}_{end}")));
        let brackets: Vec<[f64; 2]> = study
            .rows
            .iter()
            .filter(|row| !row[ends[0]].is_empty())
            .map(|row| ends.map(|end| row[end].parse().unwrap()))
            .collect();
        if brackets.is_empty() {
            continue;
        }
        let exact = brackets.iter().filter(|bracket| bracket[0] == bracket[1]).count();
        let widest = brackets.iter().map(|bracket| bracket[1] / bracket[0]).fold(1.0, f64::max);
        let widest = if exact == brackets.len() { "–".to_owned() } else { format!("{widest:.2}") };
        writeln!(text, "| {name} | {} | {exact} | {widest} |", brackets.len()).unwrap();
    }
    text
}

#[test]
fn the_numbers_of_the_page_follow_from_its_sets() {
    let study = Study::read();
    let tables = [
        ("dispersion-100", medians(&study, "dispersion", 100)),
        ("dispersion-1000", medians(&study, "dispersion", 1000)),
        ("dispersion-ratios", ratios(&study, "dispersion", [100, 1000])),
        ("star-100", medians(&study, "star", 100)),
        ("star-1000", medians(&study, "star", 1000)),
        ("star-60", medians(&study, "star", 60)),
        ("centered-1000", medians(&study, "centered", 1000)),
        ("k-wise-1000", medians(&study, "k-wise-dispersion", 1000)),
        ("exactness", exactness(&study)),
    ];
    let mut page = Page::open("samplers.md");
    tables.iter().for_each(|(name, table)| page.table(name, table));
    let sets = study.rows.len();
    page.says(format!("are {},{:03} sets", sets / 1000, sets % 1000));
    let summary = rows(include_bytes!("../../data/samplers-summary.csv.gz"));
    let [least, _] = range(numbers_of(&summary, "holm_p", |row| !row["holm_p"].is_empty()));
    page.says(format!(
        "no p-value that is corrected for all comparisons of a measure (Holm) falls below {:.2}",
        (100.0 * least).floor() / 100.0
    ));
    let ratios = &tables.iter().find(|(name, _)| *name == "dispersion-ratios").unwrap().1;
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let (head, random) = (
        cells(ratios.lines().next().unwrap()),
        cells(ratios.lines().find(|line| line.starts_with("| `random`")).unwrap()),
    );
    let ratio = |column: &str| random[head.iter().position(|title| title == column).unwrap()].clone();
    page.says(format!(
        "the dispersion of 100 random points is {} times Halton's dispersion in two dimensions, {} times in five, and {} times in ten",
        ratio("d = 2, n = 100"),
        ratio("d = 5, n = 100"),
        ratio("d = 10, n = 100")
    ));
    page.given(&[
        "In five dimensions, 100 points of",
        "With 1,000 points in five dimensions",
        "With 100 points, yes",
        "with 100 points in three",
        "With 1,000 points in seven",
        "Rank-1 lattices suit",
        "up to 100 points, yes",
    ]);
    page.given(&[
        "with 100 points in seven and ten",
        "With 1,000 points, `sobol-owen`",
        "dimensions with 100 points, yes",
        "With 1,000 points, it lowers",
    ]);
    page.given(&[
        "With 100 points, `best` leaves",
        "With 1,000 points in three and in five dimensions",
        "With 1,000 points, `lattice` has",
    ]);
    page.given(&[
        "of 20, 60, 100, 240, 500 and 1,000 points in 2, 3, 5, 7 and 10 dimensions, each with 10 seeds",
        "2-wise dispersion, star and extreme",
        "more than 10⁹ numbers",
        "at 240 points and more in three dimensions, at 60 and more in five",
    ]);
    page.given(&[
        "Medians for 100 points:",
        "For 1,000 points:",
        "Medians for 60 points",
        "For 100 points:",
        "Medians of its square for 1,000 points",
        "The 2-wise dispersion is",
        "Medians for 1,000 points:",
    ]);
    page.given(&[
        "`best` searches up to 1,000 points in two dimensions, 380 in three, 190 in four and 90 in five",
        "(100 points in five dimensions)",
        "In ten dimensions with 1,000 points",
    ]);
    page.close();
}

#[test]
fn every_value_is_exact_or_a_bracket_and_every_strategy_has_ten_seeds() {
    let study = Study::read();
    for name in study.names.iter().filter_map(|name| name.strip_suffix("_lower")) {
        for ((dims, points, strategy), brackets) in study.values(name) {
            assert!(brackets.iter().all(|[lower, upper]| 0.0 < *lower && lower <= upper && upper.is_finite()));
            let sets = if strategy == "star-set" { 1 } else { 10 };
            assert_eq!(brackets.len(), sets, "{name} of {points} points of {strategy} in {dims} dimensions");
        }
    }
}
