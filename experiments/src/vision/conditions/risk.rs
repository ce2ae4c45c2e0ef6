//! The probability to miss a vehicle within 40 m, and the smallest change that hides a vehicle.

use super::world::{COLOURS, TRAFFIC};
use super::{Failure, Findings, Named, RATE, columns, counted, fields, numbers, study, words};
use paracosm::analysis::statistics::clopper_pearson;
use paracosm::analysis::{Perceived, Sameness, Shrunk};
use paracosm::generators::Strategy;
use paracosm::space::Domain;
use paracosm::{Campaign, Trial};
use rayon::prelude::*;

/// The number of tests, and their seed.
const BUDGET: usize = 100;
const SEED: u64 = 5;
/// The number of failing tests that are shrunk, and the most runs for each of them.
const CANDIDATES: usize = 4;
const RUNS: usize = 40;

/// Runs random tests, counts missed encounters, and shrinks failing tests.
pub fn of(detector: &Named, threshold: f64) -> Result<Findings, Failure> {
    let within = |lo: f64, hi: f64| Domain::Interval { lo, hi };
    let open = [
        ("gap", within(8.0, 30.0)),
        ("light", within(0.2, 1.0)),
        ("fog", within(0.0, 0.2)),
        ("rain", within(0.0, 1.0)),
        ("sun_elevation", within(5.0, 60.0)),
        ("traffic", numbers(&TRAFFIC)),
        ("colour", words(&COLOURS)),
    ];
    let study = study(detector, threshold, &open, within(24.0, 50.0), RATE)?;
    let study = study.strategy(Strategy::RANDOM).budget(BUDGET).seed(SEED).build()?;
    let log = Campaign::new(&study)?.into_log()?;
    let name = detector.name;
    let row = |trial: &Trial| {
        let [all, missed] = ["encounters", "missed_encounters"].map(|name| counted(trial, name));
        let values = fields(study.space().parameters(), &trial.test);
        format!("{name},{},{values},{},{all},{missed}", trial.index, trial.verdict)
    };
    let failing: Vec<&Trial> = log.trials().iter().filter(|trial| trial.is_failure()).collect();
    let [low, high] = clopper_pearson(failing.len(), log.trials().len(), 0.95);
    let mut text = format!(
        "  risk: {} of {} tests fail [{low:.3}, {high:.3}]; encounters: {}\n",
        failing.len(),
        log.trials().len(),
        Perceived::of(&log)
            .and_then(|perceived| perceived.detection)
            .map_or(String::new(), |one| one.encounters_in_words()),
    );
    let shrunk = failing[..failing.len().min(CANDIDATES)]
        .par_iter()
        .map(|trial| Shrunk::of(&log, trial, Sameness::Requirements, RUNS))
        .collect::<Result<Vec<Shrunk>, _>>()?;
    let changes = |shrunk: &Shrunk| shrunk.parameters.iter().filter(|change| !change.nominal).count();
    let smallest = shrunk.iter().min_by_key(|shrunk| (changes(shrunk), shrunk.index));
    let mut changed = Vec::new();
    if let Some(shrunk) = smallest {
        text += &format!("    {}\n", shrunk.sentence());
        for change in &shrunk.parameters {
            if !change.nominal {
                text += &format!("      {}: {} -> {}\n", change.name, change.before, change.after);
            }
            changed.push(format!(
                "{name},{},{},{},{},{}",
                shrunk.index, change.name, change.before, change.after, change.nominal
            ));
        }
    }
    let columns = format!("detector,test,{},verdict,encounters,missed", columns(study.space().parameters()));
    let tests = ("conditions-risk.csv", columns, log.trials().iter().map(row).collect());
    Ok(Findings {
        parts: vec![
            tests,
            ("conditions-shrunk.csv", "detector,test,parameter,before,after,nominal".to_owned(), changed),
        ],
        text,
    })
}
