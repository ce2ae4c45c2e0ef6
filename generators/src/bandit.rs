//! One search for each requirement, and who of them may propose the next tests.
//!
//! The worst of several robustness values hides all others: where one requirement is always nearly violated and never
//! is, a search for the worst sees nothing of the one that can be. So every requirement gets a search of its own, which
//! is told how all tests went; and in the manner of Zhang, Hasuo and Arcaini ("Multi-armed bandits for Boolean
//! connectives in hybrid system falsification", CAV 2019) a bandit shares the tests out between them. It is UCB1 (Auer,
//! Cesa-Bianchi and Fischer 2002). A turn is worth by how much of the range of robustness that was seen so far it has
//! made that range longer at its lower end, which does not depend on scales: a search that comes down is continued, one
//! that has come to rest gives way.

use crate::Generator;
use paracosm_coverage::Point;

/// What is added to the mean worth of an arm that was pulled rarely, in multiples of what UCB1 adds.
const CURIOSITY: f64 = 0.1;

/// Searches that compete for tests. What it proposes follows from what its searches propose and from what it is told.
pub struct Bandit {
    arms: Vec<Arm>,
    turns: usize,
    /// Whose turn it is.
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
    /// Lets these searches compete, of which there is at least one.
    pub fn new(searches: Vec<Box<dyn Generator>>) -> Self {
        let arm = |search| Arm { search, turns: 0, worth: 0.0, range: None };
        Self { arms: searches.into_iter().map(arm).collect(), turns: 0, active: 0 }
    }

    /// The next tests, at most `n`, all of one search.
    ///
    /// There may be fewer, and there are none once there is nothing more to propose.
    pub fn ask(&mut self, n: usize) -> Vec<Point> {
        let urge = |arm: &Arm| match arm.turns {
            0 => f64::INFINITY,
            turns => {
                let pulls = turns as f64;
                arm.worth / pulls + CURIOSITY * (2.0 * libm::log(self.turns as f64) / pulls).sqrt()
            }
        };
        // The first among equals.
        let urges: Vec<f64> = self.arms.iter().map(urge).collect();
        self.active = (1..urges.len()).fold(0, |best, arm| if urges[arm] > urges[best] { arm } else { best });
        self.arms[self.active].search.ask(n)
    }

    /// How tests went, those that were asked for last or others: for each the robustness of every requirement in the
    /// order of the searches, `None` where nothing is known.
    pub fn tell(&mut self, tests: &[Point], robustness: &[Vec<Option<f64>>]) {
        for (index, arm) in self.arms.iter_mut().enumerate() {
            let told: Vec<Option<f64>> = robustness.iter().map(|all| all.get(index).copied().flatten()).collect();
            let gain = arm.learn(&told);
            if index == self.active {
                arm.worth += gain;
                arm.turns += 1;
            }
            arm.search.tell(tests, &told);
        }
        self.turns += 1;
    }
}

impl Arm {
    /// Takes tests into the range of robustness; how much of the range is new at its lower end.
    fn learn(&mut self, told: &[Option<f64>]) -> f64 {
        let before = self.range;
        for robustness in told.iter().flatten().filter(|robustness| robustness.is_finite()) {
            let (least, most) = self.range.unwrap_or((*robustness, *robustness));
            self.range = Some((least.min(*robustness), most.max(*robustness)));
        }
        match (before, self.range) {
            (Some((before, _)), Some((least, most))) if most > least => (before - least) / (most - least),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Strategy};
    use paracosm_coverage::Space;

    /// Proposes its own number for ever, and remembers what it was told.
    struct Fixed(f64);

    impl Generator for Fixed {
        fn ask(&mut self, n: usize) -> Vec<Point> {
            vec![Point { continuous: vec![self.0], discrete: vec![] }; n]
        }
    }

    /// Whose turns it is, where each search finds these in turn and then nothing new.
    fn turns(finds: [&[f64]; 2], rounds: usize) -> Vec<usize> {
        let searches: [Box<dyn Generator>; 2] = [Box::new(Fixed(0.0)), Box::new(Fixed(1.0))];
        let mut bandit = Bandit::new(searches.into());
        bandit.tell(&[Point::default()], &[vec![Some(10.0), Some(10.0)]]);
        let mut done = [0, 0];
        let mut turns = Vec::new();
        for _ in 0..rounds {
            let tests = bandit.ask(1);
            let arm = tests[0].continuous[0] as usize;
            let found = finds[arm].get(done[arm]).or(finds[arm].last()).copied();
            done[arm] += 1;
            let mut robustness = vec![Some(10.0), Some(10.0)];
            robustness[arm] = found;
            bandit.tell(&tests, &[robustness]);
            turns.push(arm);
        }
        turns
    }

    #[test]
    fn a_search_that_comes_down_is_continued_and_one_at_rest_gives_way() {
        let down: Vec<f64> = (0..40).map(|step| 9.0 - f64::from(step)).collect();
        let of_first = turns([&[9.0], &down], 30).iter().filter(|arm| **arm == 0).count();
        assert!(of_first < 10, "{of_first}");
        let equal = turns([&[9.0], &[9.0]], 30).iter().filter(|arm| **arm == 0).count();
        assert!((13..=17).contains(&equal), "{equal}");
    }

    #[test]
    fn the_scale_of_a_requirement_changes_nothing() {
        let down = |scale: f64| -> Vec<f64> { (1..9).map(|step| 10.0 - scale * f64::from(step * step)).collect() };
        assert_eq!(turns([&down(1.0), &[9.0, 8.0]], 20), turns([&down(1e-6), &[9.0, 8.0]], 20));
    }

    #[test]
    fn what_is_told_may_be_anything() {
        let space = Space::unit_cube(2);
        let search = |_| Strategy::Cmaes.build(&Request::new(&space, 50)).unwrap();
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
