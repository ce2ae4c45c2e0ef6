//! `paracosm-cover plan`: shows how many tests each guarantee needs.

use super::{strength, time_limit};
use crate::cli::output::{Format, FormatOption, Table, column, json, plural};
use crate::cli::{Failure, Strict, Verbosity, print};
use crate::generators::Request;
use crate::notes::capped_strength;
use crate::space::Space;
use clap::{ArgGroup, Args};
use paracosm_analysis::{Guarantee, Need, Plan};
use paracosm_campaign::{Catalogue, Error, SpaceFile, TestSet};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover plan --space SPACE.toml --k 2 --epsilon 0.1 --delta 0.05
  paracosm-cover plan --dims 5 --epsilon 0.1

A set is (k, epsilon)-covering if it contains all combinations of the values of any k discrete parameters, and \
    if for each of these rows the continuous points leave no empty box of volume above epsilon.";

/// The options of `plan`.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES, group = ArgGroup::new("of").required(true))]
pub(super) struct Options {
    /// The space of the tests
    ///
    /// SPACE is a SPACE.toml, a PICT model, a scenario file, or the folder of a campaign, whose open parameters are the
    /// space.
    #[arg(long, value_name = "SPACE", group = "of")]
    space: Option<PathBuf>,
    #[command(flatten)]
    strict: Strict,
    /// The number of dimensions, if the space is a unit cube
    #[arg(long, value_name = "D", group = "of")]
    dims: Option<usize>,
    /// Cover all combinations of K values [default: 2]
    ///
    /// If fewer parameters are discrete, all their combinations are covered.
    #[arg(long, value_name = "K")]
    k: Option<usize>,
    /// Cover combinations of K in a group
    ///
    /// A group of discrete parameters whose combinations of K are covered, too. K is more than --k.
    #[arg(long, value_name = "NAME,..=K")]
    strength: Vec<String>,
    /// The largest volume of an empty box
    ///
    /// The volume is a share of the space of the continuous parameters.
    #[arg(long, value_name = "E", default_value_t = 0.1)]
    epsilon: f64,
    /// The chance that a random set misses it
    ///
    /// This is the probability that a random set may miss the guarantee.
    #[arg(long, value_name = "D", default_value_t = 0.05)]
    delta: f64,
    /// Limit the seconds of all work
    ///
    /// The limit is for making and measuring a covering array, together.
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    time_limit: f64,
    #[command(flatten)]
    form: FormatOption,
}

impl Options {
    pub fn execute(&self, catalogue: &Catalogue, verbosity: Verbosity) -> Result<(), Failure> {
        let SpaceFile { space, mut demand, .. } = match (&self.space, self.dims.unwrap_or(0)) {
            (Some(path), _) => self.strict.read(path, catalogue, verbosity)?,
            (None, dims) => {
                TestSet::check_size(1, dims)?;
                SpaceFile::from(Space::unit_cube(dims))
            }
        };
        demand.groups.extend(strength::groups(&self.strength, &space)?);
        let limit = time_limit("--time-limit", self.time_limit)?;
        if !space.levels().is_empty() {
            let k = Request { k: self.k, ..Request::new(&space, 1) }.discrete_strength().map_err(Error::from)?;
            strength::note_pointless(k, &demand.groups, &space, self.strict, verbosity)?;
        }
        let note =
            format!("making a covering array and measuring points, at most {} s (--time-limit)", limit.as_secs_f64());
        let plan =
            verbosity.noting_if_slow(&note, || Plan::of(&space, self.k, &demand, self.epsilon, self.delta, limit))?;
        capped_strength(self.k, &space).into_iter().for_each(|note| verbosity.note(note));
        if space.dims() > 3 {
            verbosity.note("above three dimensions the a-priori bounds are useless: rely on the measured numbers");
        }
        print(&match self.form.format {
            Format::Json => json(&plan),
            Format::Table => {
                let groups = plan.k.map(|k| strength::beside(k, &demand.groups, &space));
                table(&plan, groups.as_deref().unwrap_or_default(), space.dims())
            }
        })
    }
}

/// The plan for people, with the groups of parameters in words.
fn table(plan: &Plan, groups: &str, dims: usize) -> String {
    let mut table = Table::default();
    let Plan { k, epsilon, delta, rows, points, tests } = plan;
    if let (Some(rows), Some(k)) = (rows, k) {
        table.heading(&format!("rows that cover the discrete parameters {k}-wise{groups}, delta {delta}"));
        needs(&mut table, rows);
    }
    if let Some(points) = points {
        table.heading(&format!(
            "points in {} with a dispersion of at most {epsilon}, delta {delta}",
            plural(dims, "dimension")
        ));
        needs(&mut table, points);
    }
    if let Some(tests) = tests {
        table.heading("tests that do both: every row has its own points");
        needs(&mut table, tests);
    }
    table.finish()
}

fn needs(table: &mut Table, needs: &[Need]) {
    let width = column(needs.iter().map(|need| need.of.len()).max().unwrap_or(0));
    for Need { of, tests, over, guarantee, .. } in needs {
        let tests = match (tests, over) {
            (Some(tests), _) => tests.to_string(),
            (None, Some(over)) => format!("over {over}"),
            (None, None) => "over 10^19".to_owned(),
        };
        let guarantee = match (over, guarantee) {
            (Some(_), Guarantee::Measured) => "measured until the --time-limit, or as far as memory allows",
            (Some(_), _) => "not made: it takes too long",
            (None, _) => guarantee.words(),
        };
        table.line(&format!("{of:<width$}  {tests:>20}  {guarantee}"));
    }
}
