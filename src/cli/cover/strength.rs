//! The option `--strength`: groups of discrete parameters that are covered with a strength of more than k.

use crate::cli::{Strict, Verbosity, usage};
use crate::space::Space;
use paracosm_campaign::Error;

/// A group, as positions among the discrete parameters, and its strength.
pub(super) type Group = (Vec<usize>, usize);

/// Reads the groups of the option, each NAME,NAME,..=K.
pub(super) fn groups(texts: &[String], space: &Space) -> Result<Vec<Group>, Error> {
    texts.iter().map(|text| group(text, space)).collect()
}

fn group(text: &str, space: &Space) -> Result<Group, Error> {
    let wrong = |why: String| usage(format!("--strength {text}: {why}"));
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
        return Err(wrong(format!(
            "found {k}, expected 1 to {}, the number of parameters in the group",
            members.len()
        )));
    }
    Ok((members, k))
}

/// Names the groups with a strength of more than `k`, in words and parentheses; empty if there are none.
pub(super) fn beside(k: usize, groups: &[Group], space: &Space) -> String {
    let higher = groups.iter().filter(|(_, strength)| *strength > k);
    let words: Vec<String> =
        higher.map(|(members, strength)| format!("{strength}-wise among {}", names(members, space))).collect();
    if words.is_empty() { String::new() } else { format!(" ({})", words.join("; ")) }
}

/// Prints a note for each group that adds nothing.
///
/// # Errors
/// A group adds nothing, and `--strict` is given.
pub(super) fn note_pointless(
    k: usize,
    groups: &[Group],
    space: &Space,
    strict: Strict,
    verbosity: Verbosity,
) -> Result<(), Error> {
    let lower = groups.iter().filter(|(_, strength)| *strength <= k);
    let note = |(members, strength): &Group| {
        let names = names(members, space);
        format!("{strength}-wise among {names} adds nothing: all parameters are covered {k}-wise")
    };
    let notes: Vec<String> = lower.map(note).collect();
    strict.accept(&notes, "groups that add nothing; leave out the groups", verbosity)
}

fn names(members: &[usize], space: &Space) -> String {
    let discrete: Vec<String> = space.discrete().map(|coordinate| coordinate.name()).collect();
    members.iter().map(|&member| discrete[member].as_str()).collect::<Vec<_>>().join(", ")
}
