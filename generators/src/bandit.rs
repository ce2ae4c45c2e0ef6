//! Runs one search for each requirement, and decides which search proposes the next tests.
//!
//! The worst of several robustness values hides all others. If one requirement is always nearly violated but never
//! violated, a search for the worst value never sees another requirement that can be violated. So every requirement
//! gets its own search, which is told the results of all tests. A bandit, UCB1 (Auer, Cesa-Bianchi and Fischer 2002),
//! divides the tests among the searches, after Zhang, Hasuo and Arcaini ("Multi-armed bandits for Boolean connectives
//! in hybrid system falsification", CAV 2019). As in their work, the worth of a turn does not depend on scales: it is
//! the share of the way from the greatest robustness to a violation that the requirement has covered. Unlike in their
//! work, a turn is worth nothing if it has brought nothing new, so that a search that no longer improves gives way.

use crate::Generator;
use paracosm_space::Point;

/// The bonus for an arm that had few turns, as a multiple of the bonus of UCB1.
const CURIOSITY: f64 = 0.2;

/// A turn has brought something new if it lowered the least robustness by more than this share of the range.
const NEW: f64 = 0.01;

/// A bandit algorithm that divides the tests among several searches. Its proposals follow from the proposals of the
/// searches and from the results.
pub struct Bandit {
    arms: Vec<Arm>,
    turns: usize,
    /// The index of the search whose turn it is.
    active: usize,
}

struct Arm {
    search: Box<dyn Generator>,
    turns: usize,
    worth: f64,
    /// The range of robustness so far.
    range: Option<(f64, f64)>,
}

impl Bandit {
    /// Makes a bandit that divides the tests among the given searches. There must be at least one search.
    pub fn new(searches: Vec<Box<dyn Generator>>) -> Self {
        let arm = |search| Arm { search, turns: 0, worth: 0.0, range: None };
        Self { arms: searches.into_iter().map(arm).collect(), turns: 0, active: 0 }
    }

    /// Returns at most `n` new tests, which are all proposals of the same search.
    ///
    /// There may be fewer than `n`. There are none once the search has nothing more to propose.
    pub fn ask(&mut self, n: usize) -> Vec<Point> {
        let urge = |arm: &Arm| {
            let turns = arm.turns.max(1) as f64;
            arm.worth / turns + CURIOSITY * (2.0 * libm::log(self.turns.max(1) as f64) / turns).sqrt()
        };
        // The first among equals.
        let urges: Vec<f64> = self.arms.iter().map(urge).collect();
        self.active = (1..urges.len()).fold(0, |best, arm| if urges[arm] > urges[best] { arm } else { best });
        self.arms[self.active].search.ask(n)
    }

    /// Passes the results of tests to all searches. The tests need not be the tests of the last request. For each test,
    /// `robustness` has the robustness of every requirement in the order of the searches; `None` if it is unknown.
    pub fn tell(&mut self, tests: &[Point], robustness: &[Vec<Option<f64>>]) {
        for (index, arm) in self.arms.iter_mut().enumerate() {
            let told: Vec<Option<f64>> = robustness.iter().map(|all| all.get(index).copied().flatten()).collect();
            let worth = arm.learn(&told);
            // All searches begin with the same tests, which count as a turn of each search.
            if index == self.active || self.turns == 0 {
                arm.worth += worth;
                arm.turns += 1;
            }
            arm.search.tell(tests, &told);
        }
        self.turns += 1;
    }
}

impl Arm {
    /// Takes tests into the range of robustness, and returns their worth as a turn.
    fn learn(&mut self, told: &[Option<f64>]) -> f64 {
        let before = self.range;
        for robustness in told.iter().flatten().filter(|robustness| robustness.is_finite()) {
            let (least, most) = self.range.unwrap_or((*robustness, *robustness));
            self.range = Some((least.min(*robustness), most.max(*robustness)));
        }
        let Some((least, most)) = self.range else { return 0.0 };
        let before = before.map_or(most, |(least, _)| least);
        if before - least > NEW * (most - least) { ((most - least) / most.max(0.0)).min(1.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Strategy};
    use paracosm_space::Space;

    /// Proposes its own number again and again, and remembers its results.
    struct Fixed(f64);

    impl Generator for Fixed {
        fn ask(&mut self, n: usize) -> Vec<Point> {
            vec![Point { continuous: vec![self.0], discrete: vec![] }; n]
        }
    }

    /// The order of the turns, if each search finds these values in order and then repeats its last; all in this
    /// unit.
    fn turns(finds: [&[f64]; 2], unit: f64) -> Vec<usize> {
        let searches: [Box<dyn Generator>; 2] = [Box::new(Fixed(0.0)), Box::new(Fixed(1.0))];
        let mut bandit = Bandit::new(searches.into());
        bandit.tell(&[Point::default()], &[vec![Some(10.0 * unit), Some(10.0)]]);
        let mut done = [0, 0];
        let mut turns = Vec::new();
        for _ in 0..30 {
            let tests = bandit.ask(1);
            let arm = tests[0].continuous[0] as usize;
            let found = finds[arm][done[arm].min(finds[arm].len() - 1)];
            done[arm] += 1;
            let robustness = [0, 1].map(|other| (other == arm).then_some(if arm == 0 { found * unit } else { found }));
            bandit.tell(&tests, &[robustness.to_vec()]);
            turns.push(arm);
        }
        turns
    }

    fn of_first(turns: &[usize]) -> usize {
        turns.iter().filter(|arm| **arm == 0).count()
    }

    #[test]
    fn a_search_that_comes_down_is_continued_and_one_at_rest_gives_way() {
        let down: Vec<f64> = (0..30).map(|step| 9.0 - f64::from(step)).collect();
        assert!(of_first(&turns([&[1.0], &down], 1.0)) < 10);
        assert!(of_first(&turns([&down, &[1.0]], 1.0)) > 20);
        let equal = of_first(&turns([&[9.0], &[9.0]], 1.0));
        assert!((13..=17).contains(&equal), "{equal}");
    }

    #[test]
    fn the_unit_of_a_requirement_changes_nothing() {
        let down: Vec<f64> = (1..9).map(|step| 10.0 - f64::from(step)).collect();
        assert_eq!(turns([&down, &[9.0, 8.0]], 1.0), turns([&down, &[9.0, 8.0]], 1.0 / 1024.0));
    }

    #[test]
    fn what_is_told_may_be_anything() {
        let space = Space::unit_cube(2);
        let search = |_| Strategy::CMAES.build(&Request::new(&space, 50)).unwrap();
        let mut bandit = Bandit::new((0..3).map(search).collect());
        let odd = [None, Some(f64::NAN), Some(f64::INFINITY), Some(f64::NEG_INFINITY), Some(1e300), Some(-0.0)];
        for round in 0..20 {
            let tests = bandit.ask(4);
            let of = |test: usize| (0..round % 4).map(|arm| odd[(round + test * arm) % odd.len()]).collect();
            bandit.tell(&tests, &(0..tests.len()).map(of).collect::<Vec<_>>());
        }
        assert!(bandit.arms.iter().all(|arm| arm.worth.is_finite()));
    }
}
