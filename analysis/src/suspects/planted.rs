//! Campaigns in which guilty combinations are planted, and located again.

use super::*;
use paracosm_space::{Domain, Parameter, Value};
use proptest::prelude::*;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeSet;

/// (parameter, level) pairs.
type Pairs = Vec<(usize, usize)>;

/// A system of discrete parameters that fails where a test has all values of a planted combination, and tests of it.
#[derive(Debug)]
struct Planted {
    space: Space,
    guilty: Vec<Pairs>,
    rows: Vec<Vec<usize>>,
}

fn has(test: &[usize], values: &[(usize, usize)]) -> bool {
    values.iter().all(|&(parameter, level)| test[parameter] == level)
}

impl Planted {
    /// So many combinations of one to three values, or fewer, and random tests of which some fail and some pass.
    fn random(rng: &mut Pcg64, combinations: usize) -> Self {
        loop {
            let levels: Vec<usize> = (0..rng.random_range(4..=10)).map(|_| rng.random_range(2..=4)).collect();
            let mut guilty = Vec::new();
            for _ in 0..combinations {
                let chosen: BTreeSet<usize> =
                    (0..rng.random_range(1..=3)).map(|_| rng.random_range(0..levels.len())).collect();
                guilty.push(chosen.into_iter().map(|p| (p, rng.random_range(0..levels[p]))).collect());
            }
            let tests = rng.random_range(10..=60);
            let rows = (0..tests).map(|_| levels.iter().map(|&n| rng.random_range(0..n)).collect()).collect();
            let choice = |n: usize| Domain::Choice((0..n).map(|level| Value::Number(level as f64)).collect());
            let parameters = levels.iter().enumerate().map(|(i, &n)| Parameter::new(format!("p{i}"), choice(n)));
            let planted = Self { space: Space::new(parameters.collect()).unwrap(), guilty, rows };
            let failures = planted.failing().len();
            if 0 < failures && failures < tests {
                return planted;
            }
        }
    }

    fn fails(&self, test: &[usize]) -> bool {
        self.guilty.iter().any(|values| has(test, values))
    }

    fn failing(&self) -> Vec<usize> {
        (0..self.rows.len()).filter(|&row| self.fails(&self.rows[row])).collect()
    }

    /// Returns true if every test that has these values fails: in all choices of levels for the parameters that matter.
    fn condemns(&self, values: &[(usize, usize)]) -> bool {
        let levels = self.space.levels();
        let mut test = vec![0; levels.len()];
        values.iter().for_each(|&(parameter, level)| test[parameter] = level);
        let involved: BTreeSet<usize> = self.guilty.iter().flatten().map(|value| value.0).collect();
        let free: Vec<usize> = involved.into_iter().filter(|&p| values.iter().all(|value| value.0 != p)).collect();
        loop {
            if !self.fails(&test) {
                return false;
            }
            let Some(&next) = free.iter().find(|&&p| test[p] + 1 < levels[p]) else { return true };
            test[next] += 1;
            free.iter().take_while(|&&p| p != next).for_each(|&p| test[p] = 0);
        }
    }

    /// Returns the located combinations, and the tests that were run for them.
    fn locate(&self, limit: usize) -> (LocatedReport, Vec<Vec<usize>>) {
        let evidence = Evidence {
            space: &self.space,
            rules: self.space.rules().unwrap(),
            tests: self.rows.iter().map(|row| JudgedTest { levels: row.clone(), failed: self.fails(row) }).collect(),
            points: self.rows.iter().map(|row| Point { continuous: Vec::new(), discrete: row.clone() }).collect(),
            indices: (0..self.rows.len()).collect(),
        };
        let mut ran = Vec::new();
        let located = LocatedReport::by(&evidence, limit, |test| {
            let levels = self.space.encode(test).unwrap().discrete;
            let verdict = if self.fails(&levels) { Verdict::Fail } else { Verdict::Pass };
            ran.push(levels);
            Ok(verdict)
        });
        (located.unwrap(), ran)
    }

    fn guilty_of(&self, located: &LocatedReport) -> Vec<Pairs> {
        let guilty = located.locations.iter().filter(|location| location.conclusion == Conclusion::Guilty);
        guilty.map(|location| pairs(&location.values)).collect()
    }
}

fn pairs(values: &Values) -> Pairs {
    let parameter = |name: &str| name[1..].parse::<usize>().unwrap();
    values.iter().map(|(name, level)| (parameter(name), level.number().unwrap() as usize)).collect()
}

/// k (ceil(log2 N) + 1), in the plainest way.
fn promised(k: usize, parameters: usize) -> usize {
    let mut halvings = 0;
    while 1 << halvings < parameters {
        halvings += 1;
    }
    k * (halvings + 1)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn one_guilty_combination_is_located_within_the_bound_and_explains_all_failures(seed in any::<u64>()) {
        let planted = Planted::random(&mut Pcg64::seed_from_u64(seed), 1);
        let (located, ran) = planted.locate(200);
        prop_assert_eq!(planted.guilty_of(&located), planted.guilty.clone());
        prop_assert!(ran.len() <= promised(planted.guilty[0].len(), planted.space.levels().len()), "{} tests", ran.len());
        prop_assert_eq!(located.locations[0].bound, Some(promised(planted.guilty[0].len(), planted.space.levels().len())));
        prop_assert_eq!(&located.locations[0].explains, &planted.failing());
        prop_assert!(located.unexplained.is_empty());
    }

    #[test]
    fn of_several_guilty_combinations_nothing_is_said_that_a_test_contradicts(
        seed in any::<u64>(),
        combinations in 2..=3usize,
        limit in prop::sample::select(vec![0, 3, 10, 200]),
    ) {
        let planted = Planted::random(&mut Pcg64::seed_from_u64(seed), combinations);
        let (located, ran) = planted.locate(limit);
        prop_assert!(located.ran == ran.len() && ran.len() <= limit);
        let listed: usize = located.locations.iter().map(|location| location.tests.len()).sum();
        prop_assert_eq!(listed, ran.len());
        // No test is run twice, none of the campaign again.
        let mut known: BTreeSet<&Vec<usize>> = planted.rows.iter().collect();
        prop_assert!(ran.iter().all(|test| known.insert(test)));
        let passes_with = |values: &[(usize, usize)]| known.iter().any(|test| has(test, values) && !planted.fails(test));
        let guilty = planted.guilty_of(&located);
        for values in &guilty {
            prop_assert!(!passes_with(values));
            // Without any one of its values, it is in a test that passed; but for those which what was found guilty
            // before, and is kept out of tests, ties to others.
            let location = located.locations.iter().find(|location| pairs(&location.values) == *values).unwrap();
            let tied = pairs(&location.undivided);
            for i in (0..values.len()).filter(|&i| !tied.contains(&values[i])) {
                prop_assert!(passes_with(&[&values[..i], &values[i + 1..]].concat()), "{values:?}");
            }
        }
        // A failure is explained, or it is said why not.
        let explained = |row: usize| guilty.iter().any(|values| has(&planted.rows[row], values));
        let (explained, left): (Vec<usize>, Vec<usize>) = planted.failing().into_iter().partition(|&row| explained(row));
        let unexplained: Vec<usize> = located.unexplained.iter().map(|unexplained| unexplained.failing).collect();
        prop_assert_eq!(unexplained, left);
        prop_assert!(located.unexplained.iter().all(|unexplained| unexplained.why != Conclusion::Guilty));
        let explains: BTreeSet<usize> = located.locations.iter().flat_map(|location| &location.explains).copied().collect();
        prop_assert!(explains.into_iter().eq(explained));
        let out_of_tests = located.unexplained.iter().any(|unexplained| unexplained.why == Conclusion::LimitReached);
        prop_assert!(!out_of_tests || ran.len() == limit);
    }
}

/// Nothing can be certain of several combinations short of running all tests; but nearly always all of them are found.
#[test]
fn of_several_guilty_combinations_nearly_all_systems_are_explained_by_what_always_fails() {
    for (combinations, most_tests) in [(2, 13), (3, 19)] {
        let mut rng = Pcg64::seed_from_u64(combinations);
        let (mut right, mut tests) = (0, 0);
        for _ in 0..1000 {
            let planted = Planted::random(&mut rng, combinations as usize);
            let (located, ran) = planted.locate(200);
            let guilty = planted.guilty_of(&located);
            right +=
                usize::from(located.unexplained.is_empty() && guilty.iter().all(|values| planted.condemns(values)));
            tests += ran.len();
        }
        assert!(right >= 980, "{combinations} combinations: {right} of 1000");
        assert!(tests <= most_tests * 1000, "{combinations} combinations: {tests} tests");
    }
}
