//! The option `--strength`: groups of discrete parameters of which more than k are covered together.

use crate::cli::usage;
use crate::space::Space;
use paracosm_campaign::Error;

/// A group, as positions among the discrete parameters, and how many of them are covered together.
pub(super) type Group = (Vec<usize>, usize);

/// The groups that the option names, NAME,NAME,..=K each.
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
        return Err(wrong(format!("found {k}, expected 1 to {}, the number of its parameters", members.len())));
    }
    Ok((members, k))
}

/// The groups that add something to all combinations of `k`, in words and parentheses; nothing where there are none.
pub(super) fn beside(k: usize, groups: &[Group], space: &Space) -> String {
    let higher = groups.iter().filter(|(_, strength)| *strength > k);
    let words: Vec<String> =
        higher.map(|(members, strength)| format!("{strength}-wise among {}", names(members, space))).collect();
    if words.is_empty() { String::new() } else { format!(" ({})", words.join("; ")) }
}

/// What is to be said where `k` is more than there are discrete parameters, beside which there are continuous ones.
pub(super) fn capped(k: Option<usize>, space: &Space) -> Option<String> {
    let (discrete, dims) = (space.levels().len(), space.dims());
    let k = k.filter(|k| dims > 0 && (1..*k).contains(&discrete) && *k <= discrete + dims)?;
    let (parameters, them) = if discrete == 1 { ("parameter is", "it") } else { ("parameters are", "them") };
    Some(format!("k is {k}, but only {discrete} {parameters} discrete: for {them} k is {discrete}"))
}

/// What is to be said of groups that add nothing, one note for each.
pub(super) fn pointless<'a>(k: usize, groups: &'a [Group], space: &'a Space) -> impl Iterator<Item = String> + 'a {
    let lower = groups.iter().filter(move |(_, strength)| *strength <= k);
    lower.map(move |(members, strength)| {
        let names = names(members, space);
        format!("{strength}-wise among {names} adds nothing: all parameters are covered {k}-wise")
    })
}

fn names(members: &[usize], space: &Space) -> String {
    let discrete: Vec<String> = space.discrete().map(|coordinate| coordinate.name()).collect();
    members.iter().map(|&member| discrete[member].as_str()).collect::<Vec<_>>().join(", ")
}
