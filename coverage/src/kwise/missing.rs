//! Lists the first valid combinations that no test contains.

use super::{MISSING_LISTED, advance};
use paracosm_space::rules::{Companions, Rules};

/// A combination of levels of k - 1 parameters that is missing together with levels of later parameters.
struct Head {
    levels: Vec<(usize, usize)>,
    /// The missing levels of later parameters, a bit each.
    missing: Vec<u64>,
}

/// Lists the first [`MISSING_LISTED`] valid combinations of `k` of the parameters `members` that no valid test
/// contains. The members are in ascending order.
pub(super) fn first_missing(
    rules: &Rules,
    members: &[usize],
    k: usize,
    tests: &[&[usize]],
) -> Vec<Vec<(usize, usize)>> {
    if k == 0 {
        return if tests.is_empty() { vec![Vec::new()] } else { Vec::new() };
    }
    // The bits of the members come first, so that the bits of later members follow those of earlier members.
    let others = (0..rules.levels().len()).filter(|parameter| members.binary_search(parameter).is_err());
    let order: Vec<usize> = members.iter().copied().chain(others).collect();
    let mut companions = Companions::new(rules, &order);
    let end: usize = members.iter().map(|&member| rules.levels()[member]).sum();
    let mut listed = Vec::new();
    let mut places: Vec<usize> = (0..k - 1).collect();
    loop {
        let set: Vec<usize> = places.iter().map(|&place| members[place]).collect();
        let next = places.last().map_or(0, |last| last + 1);
        let heads = if next < members.len() { heads(&mut companions, rules, &set, end, tests) } else { Vec::new() };
        if !heads.is_empty() {
            for &last in &members[next..] {
                for head in &heads {
                    for level in 0..rules.levels()[last] {
                        let bit = companions.first(last) + level;
                        if head.missing[bit / 64] >> (bit % 64) & 1 == 1 {
                            listed.push([head.levels.as_slice(), &[(last, level)]].concat());
                            if listed.len() == MISSING_LISTED {
                                return listed;
                            }
                        }
                    }
                }
            }
        }
        if !advance(&mut places, members.len()) {
            return listed;
        }
    }
}

/// The combinations of levels of the parameters in `set` that are missing with a level of a later parameter, for
/// later parameters whose bits are below `end`.
fn heads(companions: &mut Companions, rules: &Rules, set: &[usize], end: usize, tests: &[&[usize]]) -> Vec<Head> {
    let key = |test: &[usize]| set.iter().map(|&parameter| test[parameter]).collect::<Vec<_>>();
    let mut shown: Vec<(Vec<usize>, &[usize])> = tests.iter().map(|test| (key(test), *test)).collect();
    shown.sort_unstable();
    let begin = set.last().map_or(0, |&last| companions.first(last) + rules.levels()[last]);

    let mut heads = Vec::new();
    let mut levels = vec![0; set.len()];
    loop {
        let fixed: Vec<(usize, usize)> = set.iter().copied().zip(levels.iter().copied()).collect();
        if let Some(valid) = companions.with(&fixed) {
            let mut missing = valid[..end.div_ceil(64)].to_vec();
            missing[..begin / 64].fill(0);
            if let Some(word) = missing.get_mut(begin / 64) {
                *word &= u64::MAX << (begin % 64);
            }
            if !end.is_multiple_of(64) {
                *missing.last_mut().expect("there are members") &= !(u64::MAX << (end % 64));
            }
            let from = shown.partition_point(|(key, _)| *key < levels);
            for (_, test) in shown[from..].iter().take_while(|(key, _)| *key == levels) {
                for (parameter, level) in test.iter().enumerate() {
                    let bit = companions.first(parameter) + level;
                    if bit < end {
                        missing[bit / 64] &= !(1 << (bit % 64));
                    }
                }
            }
            if missing.iter().any(|&word| word != 0) {
                heads.push(Head { levels: fixed, missing });
            }
        }
        let Some(place) = (0..set.len()).rev().find(|&place| levels[place] + 1 < rules.levels()[set[place]]) else {
            return heads;
        };
        levels[place] += 1;
        levels[place + 1..].fill(0);
    }
}
