//! Lists the first valid combinations that no test contains.

use super::{MISSING_LISTED, advance};
use paracosm_space::rules::{Companions, Rules};
use std::collections::HashSet;

/// Pairs of a parameter and its level.
type Combination = Vec<(usize, usize)>;

/// Lists the first [`MISSING_LISTED`] valid combinations of `k` of the parameters `members` that no valid test
/// contains. The members are in ascending order.
pub(super) fn first_missing(rules: &Rules, members: &[usize], k: usize, tests: &[&[usize]]) -> Vec<Combination> {
    if k == 0 {
        return if tests.is_empty() { vec![Vec::new()] } else { Vec::new() };
    }
    // The bits of the members come first, so that the bits of later members follow those of earlier members.
    let others = (0..rules.levels().len()).filter(|parameter| members.binary_search(parameter).is_err());
    let order: Vec<usize> = members.iter().copied().chain(others).collect();
    let mut companions = Companions::new(rules, &order);
    let mut listed = Vec::new();
    let mut places: Vec<usize> = (0..k - 1).collect();
    loop {
        let set: Vec<usize> = places.iter().map(|&place| members[place]).collect();
        let lasts = &members[places.last().map_or(0, |last| last + 1)..];
        if !lasts.is_empty() {
            let most = MISSING_LISTED - listed.len();
            let found = of_heads(&mut companions, rules, &set, lasts, tests, most);
            listed.extend(found.into_iter().flatten().take(most));
            if listed.len() == MISSING_LISTED {
                return listed;
            }
        }
        if !advance(&mut places, members.len()) {
            return listed;
        }
    }
}

/// Lists the first `most` missing combinations of the parameters in `set` with each of the parameters `lasts`, which
/// come after them. The lists of later parameters may be shorter if the first list is full.
fn of_heads(
    companions: &mut Companions,
    rules: &Rules,
    set: &[usize],
    lasts: &[usize],
    tests: &[&[usize]],
    most: usize,
) -> Vec<Vec<Combination>> {
    let key = |test: &[usize]| set.iter().map(|&parameter| test[parameter]).collect::<Vec<_>>();
    let mut shown: Vec<(Vec<usize>, &[usize])> = tests.iter().map(|test| (key(test), *test)).collect();
    shown.sort_unstable();
    let firsts: Vec<usize> = lasts.iter().map(|&last| companions.first(last)).collect();
    let mut found = vec![Vec::new(); lasts.len()];
    let mut levels = vec![0; set.len()];
    loop {
        let head: Combination = set.iter().copied().zip(levels.iter().copied()).collect();
        if let Some(valid) = companions.with(&head) {
            let from = shown.partition_point(|(key, _)| *key < levels);
            let alike = || shown[from..].iter().take_while(|(key, _)| *key == levels).map(|(_, test)| test);
            let open = lasts.iter().zip(&firsts).zip(&mut found).filter(|(_, found)| found.len() < most);
            for ((&last, first), found) in open {
                let covered: HashSet<usize> = alike().map(|test| test[last]).collect();
                let is_valid = |level: &usize| valid[(first + level) / 64] >> ((first + level) % 64) & 1 == 1;
                let missing = (0..rules.levels()[last]).filter(is_valid).filter(|level| !covered.contains(level));
                let missing = missing.take(most - found.len());
                found.extend(missing.map(|level| [head.as_slice(), &[(last, level)]].concat()));
            }
        }
        let place = (0..set.len()).rev().find(|&place| levels[place] + 1 < rules.levels()[set[place]]);
        let Some(place) = place.filter(|_| found[0].len() < most) else {
            return found;
        };
        levels[place] += 1;
        levels[place + 1..].fill(0);
    }
}
