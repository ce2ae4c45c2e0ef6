//! The covering array behind generated tests, with what one wants to know of it: how large it is, and how small one can
//! be at all.

use super::time_limit;
use crate::Error;
use crate::cli::Verbosity;
use crate::coverage::{Deadline, Space};
use crate::generators::GeneratorError;
use crate::generators::covering::{CoveringArray, CoveringRequest, covering_array, optimise};
use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// The options that a covering array is made by.
pub(super) struct ArrayOptions<'a> {
    pub k: Option<usize>,
    pub seed: Option<u64>,
    /// Groups of more than k parameters: NAME,NAME,..=K.
    pub strengths: &'a [String],
    /// Seconds for making it smaller.
    pub optimise: Option<f64>,
}

impl ArrayOptions<'_> {
    /// The rows of a covering array of a space with discrete parameters, after those of existing tests, which may leave
    /// some levels open.
    pub fn rows(
        &self,
        space: &Space,
        mut groups: Vec<(Vec<usize>, usize)>,
        mut existing: Vec<Vec<Option<usize>>>,
        verbosity: Verbosity,
    ) -> Result<Vec<Vec<usize>>, Error> {
        for text in self.strengths {
            groups.push(group(text, space)?);
        }
        let rules = space.rules()?;
        let k = self.k.unwrap_or(space.levels().len().min(2));
        existing.sort_unstable();
        existing.dedup();
        let request = CoveringRequest {
            groups: &groups,
            existing: &existing,
            seed: self.seed.unwrap_or(0),
            ..CoveringRequest::new(&rules, k)
        };
        let mut array = covering_array(&request).map_err(GeneratorError::from)?;
        if let Some(seconds) = self.optimise {
            let limit = time_limit("--optimise", seconds)?;
            array = smaller(&request, array, limit, verbosity);
        }
        let CoveringArray { rows, kept, invalid, lower_bound } = array;
        if !invalid.is_empty() {
            let of = if invalid.len() == 1 {
                "row violates a constraint and does"
            } else {
                "rows violate a constraint and do"
            };
            verbosity.note(format_args!("{} different existing {of} not count", invalid.len()));
        }
        let kept = if kept == 0 { String::new() } else { format!(" ({kept} of them existing)") };
        let bound = match rows.len() as u64 == lower_bound {
            true => "proved to be the fewest".to_owned(),
            false => format!("at least {lower_bound} are needed: proved"),
        };
        verbosity.note(format_args!("a {k}-wise covering array of {} rows{kept}; {bound}", rows.len()));
        Ok(rows)
    }
}

fn smaller(request: &CoveringRequest, array: CoveringArray, limit: Duration, verbosity: Verbosity) -> CoveringArray {
    let bar = if verbosity.quiet { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
    bar.enable_steady_tick(Duration::from_millis(100));
    let style = ProgressStyle::with_template("{spinner} {elapsed}  {msg}").expect("the template is one");
    let bar = bar.with_style(style).with_message(format!("{} rows", array.rows.len()));
    let bound = array.lower_bound;
    let watch = |rows: usize| bar.set_message(format!("{rows} rows, at least {bound} are needed"));
    let array = optimise(request, array, Deadline::after(limit), &watch);
    bar.finish_and_clear();
    array
}

/// A group as `--strength` takes it.
fn group(text: &str, space: &Space) -> Result<(Vec<usize>, usize), Error> {
    let wrong = |why: String| Error::Usage(format!("--strength {text}: {why}"));
    let (names, k) = text.rsplit_once('=').ok_or_else(|| wrong("expected NAME,NAME,..=K".into()))?;
    let k: usize = k.trim().parse().map_err(|_| wrong(format!("found `{k}`, expected a number of parameters")))?;
    let discrete: Vec<String> = space.discrete().map(|coordinate| coordinate.name()).collect();
    let position = |name: &str| {
        let found = discrete.iter().position(|other| other == name.trim());
        found.ok_or_else(|| match space.parameter(name.trim()) {
            Err(error) => wrong(error.to_string()),
            Ok(_) => wrong(format!("parameter `{name}` is continuous or varies over time")),
        })
    };
    let mut members = names.split(',').map(position).collect::<Result<Vec<_>, _>>()?;
    members.sort_unstable();
    if let Some(twice) = members.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(wrong(format!("parameter `{}` is named twice", discrete[twice[0]])));
    }
    if k == 0 || k > members.len() {
        return Err(wrong(format!("found {k}, expected 1 to {}, the number of its parameters", members.len())));
    }
    Ok((members, k))
}
