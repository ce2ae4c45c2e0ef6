//! The covering array behind generated tests, with its size and the least size that any covering array can have.

use super::{spinner, strength, time_limit};
use crate::cli::interrupt::Interruptible;
use crate::cli::output::plural;
use crate::cli::{Strict, Verbosity, complain};
use crate::coverage::Deadline;
use crate::generators::covering::{CoveringArray, CoveringRequest, covering_array, optimise};
use crate::generators::{GeneratorError, Request};
use crate::space::constraint::Constraint;
use crate::space::demand::Demand;
use crate::space::rules::Rules;
use crate::space::{Coordinate, Space};
use paracosm_analysis::estimate::named_level;
use paracosm_campaign::{Error, PartialRow};
use std::collections::BTreeMap;
use std::time::Duration;

/// The options for making a covering array.
pub(super) struct ArrayOptions {
    pub strict: Strict,
    pub k: Option<usize>,
    pub seed: Option<u64>,
    /// The time in seconds for making the covering array smaller.
    pub optimise: Option<f64>,
}

impl ArrayOptions {
    /// Returns the rows of a covering array that completes the rows of existing tests, which may leave
    /// some levels open. Each existing test comes with its place in its file.
    pub fn rows(
        &self,
        space: &Space,
        demand: &Demand,
        existing: Vec<(String, PartialRow)>,
        verbosity: Verbosity,
    ) -> Result<Vec<Vec<usize>>, Error> {
        let limit = self.optimise.map(|seconds| time_limit("--optimise", seconds)).transpose()?;
        let (rules, kinds) = (space.rules()?, demand.kinds(space)?);
        let k = Request { k: self.k, ..Request::new(space, 1) }.discrete_strength()?;
        strength::note_pointless(k, &demand.groups, space, self.strict, verbosity)?;
        let mut places: BTreeMap<PartialRow, String> = BTreeMap::new();
        for (place, row) in existing {
            places.entry(row).or_insert(place);
        }
        let (existing, places): (Vec<PartialRow>, Vec<String>) = places.into_iter().unzip();
        let request = CoveringRequest {
            kinds: &kinds,
            groups: &demand.groups,
            existing: &existing,
            seed: self.seed.unwrap_or(0),
            ..CoveringRequest::new(&rules, k)
        };
        let bar = spinner(format!("a {k}-wise covering array is being made"), verbosity);
        let made = covering_array(&request);
        bar.finish_and_clear();
        let mut array = made.map_err(GeneratorError::from)?;
        if let Some(limit) = limit.filter(|_| array.rows.len() as u64 > array.lower_bound) {
            array = smaller(&request, array, limit, verbosity);
        }
        let CoveringArray { rows, kept, invalid, lower_bound } = array;
        if !invalid.is_empty() {
            let are = if invalid.len() == 1 { "violates a constraint and does" } else { "violate a constraint and do" };
            verbosity.note(format_args!("{} {are} not count", plural(invalid.len(), "different existing row")));
            let mut refused: Vec<(&str, &PartialRow)> =
                invalid.iter().map(|&index| (&places[index][..], &existing[index])).collect();
            // As they stand in the file: `line 9` comes before `line 10`.
            refused.sort_unstable_by_key(|(place, _)| (place.len(), *place));
            for (place, row) in refused.iter().take(MOST_REFUSED) {
                verbosity.note(format_args!("{place}: {}", why_refused(space, &rules, row)));
            }
            if refused.len() > MOST_REFUSED {
                verbosity.note(format_args!("and {} more", refused.len() - MOST_REFUSED));
            }
        }
        let is_begun = |index: &usize| existing[*index].contains(&None) && !invalid.contains(index);
        let kept = match (kept, (0..existing.len()).filter(is_begun).count()) {
            (0, _) => String::new(),
            (_, 0) => format!(" ({kept} of them existing)"),
            (_, begun) => format!(" ({kept} of them existing, {begun} completed)"),
        };
        let bound = match rows.len() as u64 == lower_bound {
            true => "proved to be the fewest".to_owned(),
            false => format!("at least {lower_bound} are needed: proved"),
        };
        let groups = strength::beside(k, &demand.groups, space);
        verbosity
            .note(format_args!("a {k}-wise covering array{groups} of {}{kept}; {bound}", plural(rows.len(), "row")));
        let has_negative =
            |row: &&Vec<usize>| demand.negatives.iter().any(|&(parameter, level)| row[parameter] == level);
        let negative = rows.iter().filter(has_negative).count();
        if negative > 0 {
            let verb = if negative == 1 { "row has" } else { "rows have" };
            let message = "a negative value (`~`), and cover only combinations with it";
            verbosity.note(format_args!("{negative} of the {verb} {message}"));
        }
        Ok(rows)
    }
}

/// So many tests that do not count are listed, each with the reason.
const MOST_REFUSED: usize = 10;

/// Returns the word for combinations of `k` parameters.
pub(super) fn combinations(k: usize) -> String {
    match k {
        1 => "values".to_owned(),
        2 => "pairs".to_owned(),
        3 => "triples".to_owned(),
        _ => format!("combinations of {k}"),
    }
}

/// Says which values of a test are excluded together, and which constraint excludes them, if a single constraint does.
fn why_refused(space: &Space, rules: &Rules, row: &PartialRow) -> String {
    let fixed: Vec<(usize, usize)> = row.iter().enumerate().filter_map(|(i, level)| Some((i, (*level)?))).collect();
    let discrete: Vec<Coordinate> = space.discrete().collect();
    let word = |&(parameter, level): &(usize, usize)| {
        let (name, value) = named_level(&discrete, parameter, level);
        format!("{name} {value}")
    };
    let values = fixed.iter().map(word).collect::<Vec<_>>().join(", ");
    let excludes = |constraint: &&Constraint| {
        Rules::new(&space.levels(), &[constraint.clauses().to_vec()]).is_ok_and(|alone| !alone.is_valid(&fixed))
    };
    match space.constraints().iter().find(excludes) {
        Some(constraint) => format!("{values}: excluded by `{}`", constraint.text()),
        None if rules.is_valid(&fixed) => format!("{values}: a test has one negative value (`~`) at most"),
        None => format!("{values}: excluded by several constraints together"),
    }
}

fn smaller(request: &CoveringRequest, array: CoveringArray, limit: Duration, verbosity: Verbosity) -> CoveringArray {
    let (rows, bound) = (array.rows.len(), array.lower_bound);
    let search = Interruptible::new(Deadline::after(limit));
    let seconds = limit.as_secs_f64();
    verbosity.note(format_args!(
        "{} so far; searching {seconds} s for a smaller array, Ctrl-C keeps the smallest so far",
        plural(rows, "row")
    ));
    let bar = spinner(plural(rows, "row"), verbosity);
    let watch = |rows: usize| bar.set_message(format!("{}, at least {bound} needed", plural(rows, "row")));
    let array = optimise(request, array, search.deadline, &watch);
    bar.finish_and_clear();
    if search.end() {
        // The printed array is complete, but more time may have made it smaller: the user has to know.
        complain(&"interrupted: this is the smallest array so far");
    }
    array
}
