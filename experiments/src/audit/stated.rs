//! The grids that UN R157 and Euro NCAP state, on trial: the largest hole, the witness, the mutation score, and a better suite.

use super::{SCREEN, files, known_rows, name_of, study, write_rows};
use crate::{Done, print};
use indicatif::ProgressBar;
use paracosm::Study;
use paracosm::analysis::audit::{Audit, Audited, Runs, Screen, Suite};
use paracosm::space::Value;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::time::Duration;

/// The number of mutants. Every second mutant says when a better suite is large enough, and the others grade it.
const MUTANTS: usize = 128;
/// The time for the coverage and the holes of a suite, and the search for a better suite.
const LIMIT: Duration = Duration::from_secs(600);

/// A stated suite with the results of its audit, and the better suite.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Row {
    scenario: String,
    /// The numbers of continuous parameters, and of rows of discrete values.
    continuous: usize,
    rows: usize,
    tests: usize,
    hole_lower: f64,
    hole_upper: f64,
    witness_failing: usize,
    witness_tried: usize,
    witness_volume: Option<f64>,
    witness_probability: Option<f64>,
    witness_box: String,
    mutants: usize,
    score: Option<f64>,
    better_tests: Option<usize>,
    better_hole_upper: Option<f64>,
    /// The scores of both suites for mutants that had no part in the better suite.
    other_mutants: usize,
    other_score: Option<f64>,
    better_other_score: Option<f64>,
}

/// The scores of a stated suite by kind of defect.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct KindRow {
    scenario: String,
    kind: String,
    mutants: usize,
    killed: usize,
}

/// Runs the study and writes `audit.csv` and `audit-kinds.csv`.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let files = files();
    if files.is_empty() {
        return Err("found no logical scenario of UN R157 or Euro NCAP beside the repository".into());
    }
    bar.inc_length(files.len() as u64);
    let tables = ["audit.csv", "audit-kinds.csv"].map(|table| out.join(table));
    let mut rows: Vec<Row> = known_rows(&tables[0])?;
    let mut kinds: Vec<KindRow> = known_rows(&tables[1])?;
    kinds.retain(|kind| rows.iter().any(|row| row.scenario == kind.scenario));
    for file in files {
        let name = name_of(&file);
        if rows.iter().any(|row| row.scenario == name) {
            bar.inc(1);
            continue;
        }
        let (study, suite) = Suite::of_listed(&study(&file.to_string_lossy())?)?;
        let runs = Runs::default();
        let [known, other] = halves(Screen::of(&study, MUTANTS, SCREEN, 0, &runs)?);
        let audit = Audit::of(&study, vec![suite.clone()])?.mutants(known).runs(runs.clone()).time_limit(LIMIT);
        let first = audit.run(&mut Vec::new(), |_| Ok(()))?.suites.remove(0);
        let mut graded = vec![suite.clone()];
        if let Some(better) = &first.better {
            let points = better.suite.iter().map(|test| study.space().encode(test)).collect::<Result<Vec<_>, _>>()?;
            graded.push(Suite::new("better".to_owned(), points, &study)?);
        }
        let scores: Vec<Option<f64>> = other
            .scores(&study, &graded, &runs)?
            .into_iter()
            .map(|score| score.all.mutation_score.map(|score| score.value))
            .collect();
        let row = row(&name, &study, &first, other.mutants.len(), &scores);
        print(&format!("{row:?}\n"))?;
        rows.push(row);
        let of_kinds = first.mutants.iter().flat_map(|score| &score.by_kind);
        kinds.extend(of_kinds.map(|of| KindRow {
            scenario: name.clone(),
            kind: of.kind.to_owned(),
            mutants: of.all.counted,
            killed: of.all.killed,
        }));
        write_rows(&tables[1], &kinds)?;
        write_rows(&tables[0], &rows)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(())
}

/// Returns two screens with every second mutant each.
fn halves(screen: Screen) -> [Screen; 2] {
    [0, 1].map(|first| {
        let mutants = screen.mutants.iter().skip(first).step_by(2).cloned().collect();
        Screen { mutants, ..screen.clone() }
    })
}

fn row(name: &str, study: &Study, of: &Audited, other_mutants: usize, scores: &[Option<f64>]) -> Row {
    let Audited { tests, holes, witness, mutants, better, .. } = of;
    let place = witness.as_ref().map_or(String::new(), |witness| {
        let sides = witness.sides.iter().map(|(name, [lo, hi])| format!("{name} {lo:.4}..{hi:.4}"));
        let row = witness.row.iter().map(|(name, value): (&str, &Value)| format!("{name} {value}"));
        sides.chain(row).collect::<Vec<_>>().join("; ")
    });
    Row {
        scenario: name.to_owned(),
        continuous: study.space().dims(),
        rows: holes.rows.len(),
        tests: *tests,
        hole_lower: holes.largest().lower,
        hole_upper: holes.largest().upper,
        witness_failing: witness.as_ref().map_or(0, |witness| witness.failing),
        witness_tried: witness.as_ref().map_or(0, |witness| witness.tried),
        witness_volume: witness.as_ref().map(|witness| witness.volume),
        witness_probability: witness.as_ref().map(|witness| witness.probability.value),
        witness_box: place,
        mutants: mutants.as_ref().map_or(0, |score| score.all.counted),
        score: mutants.as_ref().and_then(|score| score.all.mutation_score).map(|score| score.value),
        better_tests: better.as_ref().map(|better| better.tests),
        better_hole_upper: better.as_ref().map(|better| better.hole.upper),
        other_mutants,
        other_score: scores.first().copied().flatten(),
        better_other_score: scores.get(1).copied().flatten(),
    }
}
