//! Compares how evenly the strategies and the shipped sets cover a space, in two to ten dimensions, with 20 to 1,000 points, against the
//! paper's choice, Halton. `paracosm-cover compare` makes the same comparison for any other choice.

use crate::{Done, print};
use indicatif::ProgressBar;
use paracosm::analysis::Limit;
use paracosm::analysis::compare::SamplerComparison;
use paracosm::coverage::{Measure, records};
use paracosm::generators::{Look, MarkShape, PointSets, Strategy};
use paracosm::report;
use paracosm::space::Point;
use std::num::NonZeroUsize;
use std::path::Path;
use std::thread::available_parallelism;

/// The strategies: all that spread tests, except `lhs-centred`, which is nearly the same as `lhs`.
const STRATEGIES: [Strategy; 15] = [
    Strategy::RANDOM,
    Strategy::LHS,
    Strategy::LHS_MAXIMIN,
    Strategy::LHS_DISCREPANCY,
    Strategy::HALTON,
    Strategy::HALTON_SCRAMBLED,
    Strategy::SOBOL,
    Strategy::SOBOL_OWEN,
    Strategy::KRONECKER,
    Strategy::HAMMERSLEY,
    Strategy::FIBONACCI,
    Strategy::LATTICE,
    Strategy::GREEDY,
    Strategy::GREEDY_PERIODIC,
    Strategy::BEST,
];

/// Some sizes have a shipped set with a low star discrepancy.
const BUDGETS: [usize; 6] = [20, 60, 100, 240, 500, 1000];

const SEEDS: usize = 10;

/// The work after which a measure of a set gives a bracket, a second or two. Work, unlike time, gives the same brackets everywhere.
const LIMIT: Limit = Limit::Work(1_000_000_000);

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let strategies = [&STRATEGIES[..], &[shipped_star_sets()]].concat();
    let comparison = SamplerComparison {
        dims: vec![2, 3, 5, 7, 10],
        budgets: BUDGETS.to_vec(),
        seeds: SEEDS,
        limit: LIMIT,
        ..SamplerComparison::of(&strategies)?
    };
    let plan = comparison.plan()?;
    bar.set_length(plan.sets() as u64);
    let compared = plan.run(available_parallelism().unwrap_or(NonZeroUsize::MIN), |_| {
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    report::compare::write(&compared, out)?;
    let notes: String = compared.notes.iter().map(|note| format!("{note}\n")).collect();
    print(&(report::compare::table(&compared) + &notes))
}

/// Returns the shipped sets with a low star discrepancy as a strategy, which has one set of a few sizes.
fn shipped_star_sets() -> Strategy {
    let mut sets = PointSets::default();
    for record in records::RECORDS.iter().filter(|record| record.measure == Measure::STAR) {
        let point = |point: &[f64]| Point { continuous: point.to_vec(), discrete: Vec::new() };
        sets.add(record.set().iter().map(point).collect());
    }
    Strategy::of_sets("star-set", Look::filled(0x77_3399, MarkShape::Diamond), sets)
}
