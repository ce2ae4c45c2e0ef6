//! Locating guilty combinations that the test knows and the locator does not.

#[path = "../../space/tests/models/mod.rs"]
mod models;

use models::{all_tests, keeps, models};
use paracosm_coverage::suspects::{JudgedTest, LocateError, Located, Locator, Standing};
use paracosm_space::rules::{Clause, Literal, Rules};
use proptest::prelude::*;

type Values = Vec<(usize, usize)>;

fn contains(test: &[usize], values: &[(usize, usize)]) -> bool {
    values.iter().all(|&(parameter, level)| test[parameter] == level)
}

/// Answers every question; the tests that were asked for.
fn locate(
    rules: &Rules,
    failing: &[usize],
    passing: &[usize],
    fails: impl Fn(&[usize]) -> bool,
) -> (Located, Vec<JudgedTest>) {
    let mut locator = Locator::new(rules, failing, passing).unwrap();
    let mut asked = Vec::new();
    while let Some(test) = locator.question() {
        let test = JudgedTest { levels: test.to_vec(), failed: fails(test) };
        locator.tell(test.failed);
        asked.push(test);
    }
    (locator.located().unwrap(), asked)
}

/// k (ceil(log2 N) + 1), in the plainest way.
fn promised(k: usize, parameters: usize) -> usize {
    let mut halvings = 0;
    while 1 << halvings < parameters {
        halvings += 1;
    }
    k * (halvings + 1)
}

/// A failing test with a guilty combination of up to four of its values, and a passing test; which of the two tests'
/// values agree is drawn, with the bits of `shared`.
fn cases() -> impl Strategy<Value = (Vec<usize>, Vec<usize>, Vec<usize>, Values, bool)> {
    let parameters = prop::collection::vec((2..=5usize, any::<usize>(), any::<usize>(), any::<bool>()), 1..=60);
    (parameters, prop::collection::vec(any::<prop::sample::Index>(), 1..=4), any::<bool>()).prop_map(
        |(parameters, guilty, share_guilty)| {
            let levels: Vec<usize> = parameters.iter().map(|p| p.0).collect();
            let failing: Vec<usize> = parameters.iter().map(|p| p.1 % p.0).collect();
            let mut guilty: Vec<usize> = guilty.iter().map(|index| index.index(levels.len())).collect();
            guilty.sort_unstable();
            guilty.dedup();
            let other = |i: usize| (failing[i] + 1 + parameters[i].2 % (levels[i] - 1)) % levels[i];
            let passing = (0..levels.len()).map(|i| {
                let differs = !parameters[i].3 || (guilty.contains(&i) && !share_guilty) || i == guilty[0];
                if differs { other(i) } else { failing[i] }
            });
            let passing = passing.collect();
            let guilty = guilty.into_iter().map(|i| (i, failing[i])).collect();
            (levels, failing, passing, guilty, share_guilty)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn one_guilty_combination_is_found_within_the_promised_number_of_tests(
        (levels, failing, passing, guilty, _) in cases()
    ) {
        let rules = Rules::free(&levels);
        let (located, asked) = locate(&rules, &failing, &passing, |test| contains(test, &guilty));
        prop_assert_eq!(&located.values, &guilty);
        prop_assert!(located.undivided.is_empty());
        prop_assert_eq!(located.bound, Some(promised(guilty.len(), levels.len())));
        prop_assert_eq!(located.tests, asked.len());
        prop_assert!(asked.len() <= promised(guilty.len(), levels.len()), "{} tests", asked.len());
        prop_assert_eq!(located.standing(&asked), Standing::Sole);
        // The witness has nothing else of the failing test.
        let kept: Values = (0..levels.len()).filter(|&i| located.witness[i] == failing[i]).map(|i| (i, failing[i])).collect();
        prop_assert_eq!(kept, guilty);
    }

    #[test]
    fn a_cautious_search_changes_values_to_none_that_are_unsafe_and_finds_the_guilty_that_can_be_changed(
        (levels, failing, passing, guilty, _) in cases(),
        bits in any::<u64>(),
    ) {
        let rules = Rules::free(&levels);
        let is_safe = |parameter: usize, level: usize| bits.rotate_left((5 * parameter + level) as u32) & 1 == 1;
        let mut locator = Locator::cautious(&rules, &failing, &passing, is_safe).unwrap();
        while let Some(test) = locator.question().map(<[usize]>::to_vec) {
            for (parameter, &level) in test.iter().enumerate() {
                let known = level == failing[parameter] || level == passing[parameter];
                prop_assert!(known || is_safe(parameter, level));
            }
            locator.tell(contains(&test, &guilty));
        }
        let can_change = |&(parameter, level): &(usize, usize)| {
            passing[parameter] != level || (0..levels[parameter]).any(|other| other != level && is_safe(parameter, other))
        };
        let found: Values = guilty.into_iter().filter(can_change).collect();
        prop_assert_eq!(locator.located().unwrap().values, found);
    }

    #[test]
    fn of_several_guilty_combinations_one_is_found_or_known_tests_refute_it(
        levels in prop::collection::vec(2..=3usize, 2..=5),
        chosen in prop::collection::vec((1..32usize, any::<prop::sample::Index>()), 2..=3),
        picks in any::<[prop::sample::Index; 2]>(),
    ) {
        let every = all_tests(&levels);
        let causes: Vec<Values> = chosen.iter().map(|(bits, test)| {
            let test = test.get(&every);
            (0..levels.len()).filter(|i| bits >> i & 1 == 1).map(|i| (i, test[i])).collect()
        }).filter(|values: &Values| !values.is_empty()).collect();
        let fails = |test: &[usize]| causes.iter().any(|cause| contains(test, cause));
        let (failing, passing): (Vec<Vec<usize>>, Vec<Vec<usize>>) = every.iter().cloned().partition(|test| fails(test));
        if failing.is_empty() || passing.is_empty() {
            return Ok(());
        }
        let rules = Rules::free(&levels);
        let (located, _) = locate(&rules, picks[0].get(&failing).as_slice(), picks[1].get(&passing).as_slice(), fails);
        let known: Vec<JudgedTest> =
            every.iter().map(|test| JudgedTest { levels: test.clone(), failed: fails(test) }).collect();
        match located.standing(&known) {
            Standing::Sole => {
                prop_assert!(every.iter().all(|test| fails(test) == contains(test, &located.values)));
            }
            Standing::OneOfSeveral(others) => {
                prop_assert!(!others.is_empty());
                for other in others {
                    prop_assert!(fails(&every[other]) && !contains(&every[other], &located.values));
                }
                prop_assert!(every.iter().all(|test| fails(test) || !contains(test, &located.values)));
            }
            Standing::Refuted(passed) => {
                prop_assert!(!passed.is_empty());
                for position in passed {
                    prop_assert!(!fails(&every[position]) && contains(&every[position], &located.values));
                }
            }
        }
    }

    #[test]
    fn under_constraints_every_question_is_valid_and_the_guilty_are_found_up_to_what_follows_from_them(
        (levels, constraints) in models(),
        picks in any::<[prop::sample::Index; 2]>(),
        bits in 1..32usize,
    ) {
        let valid: Vec<Vec<usize>> = all_tests(&levels)
            .into_iter().filter(|test| constraints.iter().all(|constraint| keeps(constraint, test))).collect();
        let Ok(rules) = Rules::new(&levels, &constraints) else { return Ok(()) };
        let failing = picks[0].get(&valid);
        let guilty: Values = (0..levels.len()).filter(|i| bits >> i & 1 == 1).map(|i| (i, failing[i])).collect();
        let passing: Vec<Vec<usize>> = valid.iter().filter(|test| !contains(test, &guilty)).cloned().collect();
        if passing.is_empty() {
            return Ok(());
        }
        let (located, asked) = locate(&rules, failing, picks[1].get(&passing).as_slice(), |test| contains(test, &guilty));
        prop_assert!(asked.iter().all(|test| valid.contains(&test.levels)));
        prop_assert!(located.bound.is_none_or(|bound| asked.len() <= bound), "{} of {:?}", asked.len(), located.bound);
        for test in &valid {
            let (found, hidden) = (contains(test, &located.values), contains(test, &guilty));
            prop_assert!(hidden || !found);
            // What could not be divided may hold innocent values.
            prop_assert!(found || !hidden || !located.undivided.is_empty());
        }
        prop_assert!(located.undivided.iter().all(|value| located.values.contains(value)));
        // Put into another test, they leave as much of it as one by one the constraints allow.
        for other in passing.iter().take(5) {
            let both = located.put_into(&rules, other);
            prop_assert!(valid.contains(&both) && contains(&both, &located.values));
            let mut kept = located.values.clone();
            for (parameter, &level) in other.iter().enumerate() {
                if kept.iter().all(|value| value.0 != parameter) {
                    let fits = |level: usize| {
                        valid.iter().any(|test| contains(test, &kept) && test[parameter] == level)
                    };
                    prop_assert_eq!(both[parameter] == level, fits(level));
                    kept.push((parameter, both[parameter]));
                }
            }
        }
    }
}

/// A test that keeps the constraints and follows the wishes as far as it can, one after the other.
fn wished(rules: &Rules, first: &[(usize, usize)], wishes: &[usize]) -> Option<Vec<usize>> {
    let mut partial = vec![None; wishes.len()];
    first.iter().for_each(|&(parameter, level)| partial[parameter] = Some(level));
    rules.completes(&partial)?;
    for (parameter, &wish) in wishes.iter().enumerate() {
        if partial[parameter].is_none() {
            partial[parameter] = Some(wish % rules.levels()[parameter]);
            if rules.completes(&partial).is_none() {
                partial[parameter] = None;
            }
        }
    }
    rules.completes(&partial)
}

/// Up to 60 parameters, clauses between two and three of them, and wishes for two tests.
fn entangled() -> impl Strategy<Value = (Vec<usize>, Vec<Vec<Clause>>, Vec<usize>, Vec<usize>)> {
    prop::collection::vec((2..=4usize, any::<usize>(), any::<usize>()), 8..=60).prop_flat_map(|parameters| {
        let levels: Vec<usize> = parameters.iter().map(|p| p.0).collect();
        let (a, b) = parameters.iter().map(|p| (p.1, p.2)).unzip();
        let sizes = levels.clone();
        let literal = (any::<prop::sample::Index>(), any::<usize>());
        let clause = prop::collection::vec(literal, 2..=3).prop_map(move |drawn| {
            let mut literals: Vec<Literal> = Vec::new();
            for (index, level) in drawn {
                let parameter = index.index(sizes.len());
                let but = level % sizes[parameter];
                if literals.iter().all(|literal| literal.parameter != parameter) {
                    let levels = (0..sizes[parameter]).filter(|&level| level != but).collect();
                    literals.push(Literal { parameter, levels });
                }
            }
            vec![Clause { literals }]
        });
        let clauses = parameters.len();
        (Just(levels), prop::collection::vec(clause, 1..=clauses), Just(a), Just(b))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn among_sixty_entangled_parameters_the_guilty_are_found_within_the_bound_or_no_bound_is_claimed(
        (levels, constraints, a, b) in entangled(),
        chosen in prop::collection::vec(any::<prop::sample::Index>(), 1..=4),
    ) {
        let Ok(rules) = Rules::new(&levels, &constraints) else { return Ok(()) };
        let failing = wished(&rules, &[], &a).unwrap();
        let mut guilty: Values = chosen.iter().map(|i| i.index(levels.len())).map(|i| (i, failing[i])).collect();
        guilty.sort_unstable();
        guilty.dedup();
        let other = (0..levels[guilty[0].0]).filter(|&level| level != guilty[0].1);
        let Some(passing) = other.filter_map(|level| wished(&rules, &[(guilty[0].0, level)], &b)).next() else {
            return Ok(());
        };
        let (located, asked) = locate(&rules, &failing, &passing, |test| contains(test, &guilty));
        prop_assert!(asked.iter().all(|test| constraints.iter().all(|constraint| keeps(constraint, &test.levels))));
        prop_assert!(located.bound.is_none_or(|bound| asked.len() <= bound), "{} of {:?}", asked.len(), located.bound);
        prop_assert_eq!(located.standing(&asked), Standing::Sole);
        // Whatever has the one has the other.
        let implies = |values: &[(usize, usize)], (parameter, level): (usize, usize)| {
            let with = |other| rules.is_valid(&[values, &[(parameter, other)]].concat());
            values.contains(&(parameter, level)) || (0..levels[parameter]).all(|other| other == level || !with(other))
        };
        prop_assert!(guilty.iter().all(|&value| implies(&located.values, value)));
        prop_assert!(!located.undivided.is_empty() || located.values.iter().all(|&value| implies(&guilty, value)));
    }
}

#[test]
fn values_that_only_change_together_are_found_together() {
    // The first two parameters are always equal.
    let literal = |parameter, level: usize| Literal { parameter, levels: vec![level] };
    let clause = |a: Literal, b: Literal| vec![Clause { literals: vec![a, b] }];
    let constraints = [clause(literal(0, 0), literal(1, 1)), clause(literal(0, 1), literal(1, 0))];
    let rules = Rules::new(&[2, 2, 2, 2], &constraints).unwrap();
    let (located, asked) = locate(&rules, &[1, 1, 1, 1], &[0, 0, 0, 0], |test| test[0] == 1 && test[3] == 1);
    assert_eq!(located.values, [(0, 1), (1, 1), (3, 1)]);
    assert_eq!(located.undivided, [(0, 1), (1, 1)]);
    assert_eq!((located.bound, asked.len()), (None, 3));
}

#[test]
fn tests_that_cannot_be_compared_are_refused() {
    let forbidden = vec![Clause { literals: vec![Literal { parameter: 0, levels: vec![0] }] }];
    let rules = Rules::new(&[2, 2], &[forbidden]).unwrap();
    assert_eq!(Locator::new(&rules, &[0, 0], &[0, 0]).unwrap_err(), LocateError::Same);
    assert_eq!(Locator::new(&rules, &[1, 0], &[0, 0]).unwrap_err(), LocateError::Invalid { role: "failing" });
    let message = Locator::new(&rules, &[0, 0], &[0]).unwrap_err().to_string();
    assert_eq!(message, "test 1 has 1 level, expected 2");
}
