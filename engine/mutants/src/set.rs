//! Fixed sets of mutants.
//!
//! A comparison of test suites is fair only if the mutants were fixed before. So a set follows from the space, the number
//! of mutants and the seed, and each place in the set has random numbers of its own. Kinds take turns. From one turn of a
//! kind to its next, the size goes one step through the ladder, and the number of conditions goes from 0 to 3.

use crate::chance::mixed;
use crate::kind::Kind;
use crate::kinds::ALL;
use crate::{Condition, Defect, Mutant};
use paracosm_space::{Domain, Parameter, Space};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeSet;

/// The greatest number of conditions of a mutant.
const MOST_CONDITIONS: usize = 3;
/// The shares of a parameter's range that a condition covers.
const SHARES: [f64; 3] = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0];
/// The number of draws until a place is given up, because all its mutants are in the set already.
const TRIES: usize = 32;
/// The number of turns of a kind after which its sizes and numbers of conditions have all been there: more than the
/// longest ladder times four.
const TURNS: usize = 48;
/// The digits of the end of an interval, counted from the first digit of the parameter's range.
const DIGITS: i32 = 3;

/// Makes a set of `count` mutants of all kinds for the tests of a space.
///
/// The set for a number is the beginning of the set for a greater number. No two mutants are equal. The set has fewer
/// mutants than `count` if the space has so few parameters that there are no further mutants. Conditions are about the
/// parameters of the space that are constant in each test and have more than one value.
pub fn mutants(space: &Space, count: usize, seed: u64) -> Vec<Mutant> {
    mutants_where(space, count, seed, |_| true)
}

/// Makes a set as [`mutants`] does, but only of the defects that `keep` keeps. An audit keeps the defects that change a verdict
/// somewhere, because other defects make mutants that nobody can tell from the given driver.
pub fn mutants_where(space: &Space, count: usize, seed: u64, mut keep: impl FnMut(Defect) -> bool) -> Vec<Mutant> {
    let ladder =
        |kind: &&'static Kind| -> Vec<Defect> { Defect::all_of(kind).filter(|defect| keep(*defect)).collect() };
    let ladders: Vec<_> = ALL.iter().map(ladder).filter(|ladder| !ladder.is_empty()).collect();
    let parameters = space.parameters().iter().filter(|parameter| can_be_a_condition(parameter)).collect();
    let rules = Rules { ladders, parameters, seed };
    let (mut set, mut known) = (Vec::new(), BTreeSet::new());
    let mut fruitless = 0;
    for place in 0_usize.. {
        if set.len() == count || fruitless == rules.ladders.len() * TURNS {
            break;
        }
        let mutant = rules.at(place).find(|mutant| known.insert(key(mutant)));
        fruitless = if mutant.is_some() { 0 } else { fruitless + 1 };
        set.extend(mutant);
    }
    set
}

fn can_be_a_condition(parameter: &Parameter) -> bool {
    parameter.signal.is_none() && parameter.levels().is_none_or(|levels| levels.len() > 1)
}

/// Returns a text that two mutants share only if they are equal.
fn key(mutant: &Mutant) -> String {
    format!("{mutant:?}")
}

/// The facts that a set follows from.
struct Rules<'a> {
    /// The defects of each kind, from slight to gross.
    ladders: Vec<Vec<Defect>>,
    /// The parameters that conditions may be about.
    parameters: Vec<&'a Parameter>,
    seed: u64,
}

impl Rules<'_> {
    /// Returns the mutants that may stand at a place, the preferred first. If they are all in the set already, further
    /// conditions make new mutants.
    fn at(&self, place: usize) -> impl Iterator<Item = Mutant> {
        let (turn, index) = (place / self.ladders.len(), place % self.ladders.len());
        let ladder = &self.ladders[index];
        // One step of the ladder for each turn, and one more condition; after a pass through the ladder, one condition is
        // skipped, so that each size meets each number of conditions. Kinds begin at different sizes.
        let (pass, step) = (turn / ladder.len(), turn % ladder.len());
        let defect = ladder[(step + 5 * index) % ladder.len()];
        let most = MOST_CONDITIONS.min(self.parameters.len());
        let fewest = ((pass + step + index) % (MOST_CONDITIONS + 1)).min(most);
        let mut random = Pcg64::seed_from_u64(mixed(mixed(self.seed) ^ place as u64));
        (fewest..=most)
            .flat_map(|conditions| [conditions; TRIES])
            .map(move |conditions| Mutant { defect, when: some(conditions, &self.parameters, &mut random) })
    }
}

/// Returns conditions on random parameters, in the order of the parameters.
fn some(count: usize, parameters: &[&Parameter], random: &mut Pcg64) -> Vec<Condition> {
    let mut chosen = BTreeSet::new();
    while chosen.len() < count {
        chosen.insert(below(parameters.len(), random));
    }
    chosen.into_iter().map(|index| condition(parameters[index], random)).collect()
}

/// Returns a random number below `count`, which is the same on machines with other widths of numbers.
fn below(count: usize, random: &mut Pcg64) -> usize {
    ((random.random::<f64>() * count as f64) as usize).min(count - 1)
}

fn condition(parameter: &Parameter, random: &mut Pcg64) -> Condition {
    let name = parameter.name.clone();
    match &parameter.domain {
        Domain::Choice(levels) => Condition::Is { parameter: name, value: levels[below(levels.len(), random)].clone() },
        Domain::Interval { lo, hi } => {
            let share = SHARES[below(SHARES.len(), random)];
            let begin = (1.0 - share) * random.random::<f64>();
            let end = |coordinate| rounded(parameter.value_at(coordinate), *lo, *hi);
            Condition::Within { parameter: name, lo: end(begin), hi: end(begin + share) }
        }
    }
}

/// Rounds a number of an interval, so that people can read it. It stays in the interval.
fn rounded(number: f64, lo: f64, hi: f64) -> f64 {
    let digits = DIGITS - libm::floor(libm::log10(hi - lo)).clamp(-300.0, 300.0) as i32;
    // Text rounds to the number that is written in the shortest way.
    let text = format!("{number:.*}", digits.clamp(0, 17) as usize);
    text.parse().unwrap_or(number).clamp(lo, hi)
}
