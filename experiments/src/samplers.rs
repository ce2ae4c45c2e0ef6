//! Compares how evenly ten strategies cover a space, in two, three and five dimensions, with 32 to 512 points and 30
//! seeds, against the paper's choice, Halton. `paracosm-cover compare` makes the same comparison for any other choice.

use crate::{Done, print};
use indicatif::ProgressBar;
use paracosm::analysis::compare::SamplerComparison;
use paracosm::generators::Strategy;
use paracosm::report;
use std::num::NonZeroUsize;
use std::path::Path;
use std::thread::available_parallelism;

/// The strategies: all except `lhs-centred`, which is nearly the same as `lhs`.
const STRATEGIES: [Strategy; 10] = [
    Strategy::RANDOM,
    Strategy::LHS,
    Strategy::HALTON,
    Strategy::HALTON_SCRAMBLED,
    Strategy::SOBOL,
    Strategy::SOBOL_OWEN,
    Strategy::KRONECKER,
    Strategy::HAMMERSLEY,
    Strategy::FIBONACCI,
    Strategy::GREEDY,
];

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let comparison = SamplerComparison { budgets: vec![32, 64, 128, 256, 512], ..SamplerComparison::of(&STRATEGIES)? };
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
