//! A portfolio of searches that learn from each other's tests, for systems about which nothing is known.
//!
//! No search is best everywhere. On our functions (experiments/strategies.md) CMA-ES with preselection nearly always
//! needs the fewest tests, and it leads. The others choose tests in proportion to its tests: `bayes` half as many and
//! `nelder-mead` a tenth. If a second, flatter minimum misleads the leader, `bayes` finds in two thirds of the tests
//! what the leader finds with restarts. Simplices follow a valley that bends.
//!
//! The shares are fixed, because results before the first failure do not show which search will find it. They were
//! chosen with the seeds 1,000 to 1,029 and 2,000 to 2,029. Between three tests of `bayes` for ten of the leader and
//! ten for ten little changes. If the leader waits for results, no other search takes its share: its tests are better
//! chosen when these results are known, so a batch may be shorter than requested. In an earlier version each search
//! got its share of each request; since the leader tests few at a time, the others had most of the tests.

use super::bayes::Bayes;
use super::cmaes::Cmaes;
use super::cube::Axis;
use super::nelder_mead::nelder_mead;
use super::{Adaptive, signals};
use super::{Evaluation, Optimiser};
use crate::seeded::{Purpose, seeded};
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use nalgebra::DMatrix;
use rand::Rng;
use rand_pcg::Pcg64;
use std::collections::BTreeMap;

impl Strategy {
    /// The strategy "auto", which runs several searches for a failure side by side, for unknown systems.
    pub const AUTO: Self = Self::of(&Descriptor {
        name: "auto",
        about: "gp-cmaes, bayes and nelder-mead side by side, learning from each other: for unknown systems",
        dims: ANY,
        look: Look::filled(0x7b_3294, MarkShape::Diamond),
        method: Method(MethodKind::Search {
            seeks_a_failure: true,
            build: |it, request, rules| {
                Adaptive::build(it, request, rules, |axes, rng| {
                    Box::new(Auto::new(axes, signals::covariance(request.space), rng))
                })
            },
        }),
    });
}

/// The search of the strategy "auto", which combines several searches with their shares of the tests.
pub(super) struct Auto {
    members: Vec<Member>,
    /// For each proposal without a result, the member that proposed it and the member's own number for it.
    out: BTreeMap<usize, (usize, usize)>,
    proposals: usize,
}

struct Member {
    search: Box<dyn Optimiser>,
    /// The number of tests that the member chooses for each test of the leader.
    share: f64,
    proposals: usize,
    /// The number of tests that the member may still choose.
    owed: f64,
}

/// The index of the member that the others follow, and of the member that never waits.
const LEADER: usize = 0;
const READY: usize = 1;

impl Auto {
    pub(super) fn new(axes: Vec<Axis>, covariance: DMatrix<f64>, mut rng: Pcg64) -> Self {
        let mut chance = || seeded(rng.random(), Purpose::Search, 0);
        let bayes = Box::new(Bayes::new(axes.clone(), chance()));
        let simplices = Box::new(nelder_mead(axes.clone(), chance()));
        let cmaes = Box::new(Cmaes::preselected(axes, covariance, chance()));
        let member = |search, share| Member { search, share, proposals: 0, owed: 0.0 };
        let members = vec![member(cmaes as Box<dyn Optimiser>, 1.0), member(bayes, 0.5), member(simplices, 0.1)];
        Self { members, out: BTreeMap::new(), proposals: 0 }
    }

    /// The proposals of a member, at most `n` places.
    fn of_member(&mut self, index: usize, n: usize) -> Vec<Vec<f64>> {
        if n == 0 {
            return Vec::new();
        }
        let member = &mut self.members[index];
        let places = member.search.propose(n);
        for _ in &places {
            self.out.insert(self.proposals, (index, member.proposals));
            self.proposals += 1;
            member.proposals += 1;
        }
        places
    }
}

impl Optimiser for Auto {
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>> {
        let mut places = Vec::new();
        for index in LEADER + 1..self.members.len() {
            let owed = &mut self.members[index].owed;
            let quota = (owed.floor() as usize).min(n - places.len());
            *owed -= quota as f64;
            places.extend(self.of_member(index, quota));
        }
        let led = self.of_member(LEADER, n - places.len());
        self.members.iter_mut().for_each(|member| member.owed += member.share * led.len() as f64);
        places.extend(led);
        if places.is_empty() {
            places = self.of_member(READY, n);
        }
        places
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        let owner = proposal.and_then(|proposal| self.out.remove(&proposal));
        for (index, member) in self.members.iter_mut().enumerate() {
            let own = owner.filter(|owner| owner.0 == index).map(|owner| owner.1);
            member.search.learn(own, trial);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_others_choose_in_proportion_to_the_leader_however_many_tests_are_asked_for() {
        for n in [1, 3, 16] {
            let mut auto = Auto::new(vec![Axis::Continuous; 2], DMatrix::identity(2, 2), seeded(1, Purpose::Search, 0));
            let robustness = |at: &[f64]| Some(1.0 + at[0] + at[1] * at[1]);
            for at in [[0.3, 0.2], [0.7, 0.9], [0.5, 0.4]] {
                auto.learn(None, &Evaluation { at: at.into(), robustness: robustness(&at) });
            }
            let mut told = 0;
            while told < 100 {
                let places = auto.propose(n);
                assert!((1..=n).contains(&places.len()));
                for at in places {
                    auto.learn(Some(told), &Evaluation { robustness: robustness(&at), at });
                    told += 1;
                }
            }
            let [led, bayes, simplices] = [0, 1, 2].map(|member| auto.members[member].proposals as f64);
            assert!(
                (bayes - 0.5 * led).abs() < 4.0 && (simplices - 0.1 * led).abs() < 2.0,
                "{led} {bayes} {simplices}"
            );
        }
    }
}
