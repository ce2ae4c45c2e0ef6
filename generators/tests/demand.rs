//! Covering arrays of mixed strength and with negative values against trying every test.

#[path = "../../space/tests/models/mod.rs"]
mod models;

use models::{all_tests, keeps, models};
use paracosm_coverage::Deadline;
use paracosm_generators::covering::{CoveringArray, CoveringRequest, covering_array, optimise};
use paracosm_space::demand::TestKind;
use paracosm_space::rules::{Clause, Rules};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::time::Duration;

/// What is asked for, in plain words.
#[derive(Debug, Clone)]
struct Asked {
    levels: Vec<usize>,
    constraints: Vec<Vec<Clause>>,
    negatives: Vec<(usize, usize)>,
    k: usize,
    groups: Vec<(Vec<usize>, usize)>,
    existing: Vec<Vec<Option<usize>>>,
}

/// A combination with the number of the family that asks for it.
type Wanted = BTreeSet<(usize, Vec<(usize, usize)>)>;

impl Asked {
    fn negatives_of(&self, test: &[usize]) -> Vec<usize> {
        (0..test.len()).filter(|&parameter| self.negatives.contains(&(parameter, test[parameter]))).collect()
    }

    fn sound(&self) -> Vec<Vec<usize>> {
        let keeps = |test: &Vec<usize>| self.constraints.iter().all(|constraint| keeps(constraint, test));
        all_tests(&self.levels).into_iter().filter(keeps).filter(|test| self.negatives_of(test).len() <= 1).collect()
    }

    /// All combinations of k, and of more in the groups, that a test counts for.
    fn shown(&self, test: &[usize]) -> Wanted {
        let every: Vec<usize> = (0..self.levels.len()).collect();
        let higher = self.groups.iter().filter(|(_, k)| *k > self.k);
        let families = std::iter::once((&every, self.k)).chain(higher.map(|(members, k)| (members, *k)));
        let own = self.negatives_of(test);
        let mut shown = BTreeSet::new();
        for (family, (members, k)) in families.enumerate() {
            for bits in (0..1usize << members.len()).filter(|bits| bits.count_ones() as usize == k) {
                let chosen = (0..members.len()).filter(|i| bits >> i & 1 == 1).map(|i| members[i]);
                let mut tuple: Vec<(usize, usize)> = chosen.map(|parameter| (parameter, test[parameter])).collect();
                tuple.sort_unstable();
                if own.iter().all(|&only| tuple.contains(&(only, test[only]))) {
                    shown.insert((family, tuple));
                }
            }
        }
        shown
    }

    fn is_answered(&self, array: &CoveringArray) -> Result<(), TestCaseError> {
        let sound = self.sound();
        prop_assert!(array.rows.iter().all(|row| sound.contains(row)));
        let wanted: Wanted = sound.iter().flat_map(|test| self.shown(test)).collect();
        let shown: Wanted = array.rows.iter().flat_map(|row| self.shown(row)).collect();
        prop_assert!(wanted == shown, "not covered: {:?}", wanted.difference(&shown).next());
        prop_assert!(array.rows.len() as u64 >= array.lower_bound);
        let fits = |test: &[Option<usize>], row: &[usize]| {
            test.iter().zip(row).all(|(level, own)| level.is_none_or(|level| level == *own))
        };
        for (index, test) in self.existing.iter().enumerate() {
            let can_be_kept = sound.iter().any(|row| fits(test, row));
            prop_assert_eq!(can_be_kept, !array.invalid.contains(&index));
            prop_assert!(!can_be_kept || array.rows[..array.kept].iter().any(|row| fits(test, row)));
        }
        prop_assert_eq!(array.kept + array.invalid.len(), self.existing.len());
        // Next comes always a row that adds most.
        let mut before: Wanted = array.rows[..array.kept].iter().flat_map(|row| self.shown(row)).collect();
        for (i, row) in array.rows.iter().enumerate().skip(array.kept) {
            let gain = |row: &[usize]| self.shown(row).difference(&before).count();
            prop_assert!(array.rows[i..].iter().all(|other| gain(other) <= gain(row)), "row {i} comes too early");
            before.extend(self.shown(row));
        }
        Ok(())
    }

    /// The largest number of combinations that some parameters have, for tests without a negative value and for those
    /// with each: there cannot be fewer tests.
    fn least(&self) -> usize {
        let sound = self.sound();
        let of = |negative: Option<(usize, usize)>| {
            let kind = sound.iter().filter(|test| {
                let own = self.negatives_of(test).first().map(|&parameter| (parameter, test[parameter]));
                own == negative
            });
            let all: Wanted = kind.flat_map(|test| self.shown(test)).collect();
            let parameters = |(family, tuple): &(usize, Vec<(usize, usize)>)| {
                (*family, tuple.iter().map(|pair| pair.0).collect::<Vec<_>>())
            };
            let sets: BTreeSet<_> = all.iter().map(parameters).collect();
            sets.iter().map(|set| all.iter().filter(|wanted| parameters(wanted) == *set).count()).max().unwrap_or(0)
        };
        of(None) + self.negatives.iter().map(|&negative| of(Some(negative))).sum::<usize>()
    }
}

fn asked() -> impl Strategy<Value = Asked> {
    models().prop_flat_map(|(levels, constraints)| {
        let n = levels.len();
        let pairs: Vec<(usize, usize)> = (0..n).flat_map(|p| (0..levels[p]).map(move |level| (p, level))).collect();
        let most = pairs.len().min(3);
        let group = prop::sample::subsequence((0..n).collect::<Vec<_>>(), 1..=n).prop_shuffle();
        let group = group.prop_flat_map(|members| (Just(members.clone()), 1..=members.len()));
        let test: Vec<_> = levels.iter().map(|&levels| prop::option::of(0..levels)).collect();
        (
            Just((levels, constraints)),
            prop::sample::subsequence(pairs, 0..=most),
            1..=n.min(3),
            prop::collection::vec(group, 0..3),
            prop::collection::vec(test, 0..4),
        )
            .prop_map(|((levels, constraints), negatives, k, groups, existing)| Asked {
                levels,
                constraints,
                negatives,
                k,
                groups,
                existing,
            })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn groups_and_negative_values_are_covered_in_an_order_that_covers_most_first(asked in asked()) {
        let Ok(kinds) = TestKind::all(&asked.levels, &asked.constraints, &asked.negatives) else {
            prop_assert!(asked.sound().is_empty());
            return Ok(());
        };
        let rules = Rules::new(&asked.levels, &asked.constraints).unwrap();
        let request = CoveringRequest {
            kinds: &kinds,
            groups: &asked.groups,
            existing: &asked.existing,
            ..CoveringRequest::new(&rules, asked.k)
        };
        let array = covering_array(&request).unwrap();
        asked.is_answered(&array)?;
        // Theory may know of more, as of binary parameters beside one with more levels.
        prop_assert!(array.lower_bound >= asked.least() as u64);
        prop_assert_eq!(request.lower_bound().unwrap(), u128::from(array.lower_bound));
        let size = array.rows.len();
        let smaller = optimise(&request, array, Deadline::after(Duration::from_millis(2)), &|_| ());
        asked.is_answered(&smaller)?;
        prop_assert!(smaller.rows.len() <= size);
    }
}

#[test]
fn each_level_of_one_parameter_needs_an_array_of_the_others() {
    let rules = Rules::free(&[4, 2, 2, 2, 2]);
    let kinds = TestKind::all(&[4, 2, 2, 2, 2], &[], &[]).unwrap();
    let array = covering_array(&CoveringRequest { kinds: &kinds, ..CoveringRequest::new(&rules, 3) }).unwrap();
    // Five tests show all pairs of four binary parameters, and four do not.
    assert_eq!(array.lower_bound, 4 * 5);
    assert!(array.rows.len() >= 20);
}

#[test]
fn a_negative_value_is_shown_with_every_other_value_and_hides_them_from_each_other() {
    let rules = Rules::free(&[3, 3, 3]);
    let array = |k: usize, negatives: &[(usize, usize)]| {
        let kinds = TestKind::all(&[3, 3, 3], &[], negatives).unwrap();
        let array = covering_array(&CoveringRequest { kinds: &kinds, ..CoveringRequest::new(&rules, k) }).unwrap();
        (array.rows.len(), array.lower_bound)
    };
    assert_eq!(array(2, &[]), (9, 9));
    // Six pairs of the first parameter with another, nine of the others; then three tests of the negative value.
    assert_eq!(array(2, &[(0, 2)]), (9 + 3, 9 + 3));
    assert_eq!(array(2, &[(0, 1), (0, 2)]), (9 + 3 + 3, 9 + 3 + 3));
    assert_eq!(array(1, &[(0, 2), (1, 2), (2, 2)]), (2 + 3, 2 + 3));
}
