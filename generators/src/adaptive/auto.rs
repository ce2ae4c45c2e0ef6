//! A portfolio of searches that learn from each other's tests, for systems about which nothing is known.
//!
//! No search is best everywhere, so there are two stages, each with a leader. The other searches choose tests in
//! proportion to the leader's tests.
//!
//! At first CMA-ES with preselection leads. On a function whose slope leads to the failure it needs the fewest tests,
//! and a few dozen tests are enough. A function that has not failed until then is likely to have basins that lead
//! nowhere, and the search beyond them leads (`beyond`) until there is a failure. On random functions with decoys the
//! two stages find nine of ten failures, and the first stage alone finds seven (experiments/strategies.md). If the
//! search beyond known basins led from the beginning, it would take up to 1.5 times the tests where the slope is right.
//! Simplices follow a valley that bends, in both stages.
//!
//! The shares of the first stage were chosen on ten functions, its length and the shares of the second stage on the
//! random functions 0 to 199. If the leader waits for results, no other search takes its share: its tests are better
//! chosen when these results are known, so a batch may be shorter than requested. If all searches wait, `bayes` chooses.

use super::bayes::Bayes;
use super::bend::is_failure;
use super::beyond::Beyond;
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
        about: "gp-cmaes with bayes, then a search that leaves known basins: for unknown systems",
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
    /// `true` once a test has failed.
    failed: bool,
}

struct Member {
    search: Box<dyn Optimiser>,
    proposals: usize,
    /// The number of tests that the member may still choose.
    owed: f64,
}

/// A stage of the search.
struct Stage {
    /// The index of the member that the others follow.
    leader: usize,
    /// The number of tests that each member chooses for each test of the leader.
    shares: [f64; 4],
}

/// The indices of members. Simplices are between `bayes` and the search beyond known basins.
const CMAES: usize = 0;
const BAYES: usize = 1;
const BEYOND: usize = 3;

const FIRST: Stage = Stage { leader: CMAES, shares: [1.0, 0.5, 0.1, 0.0] };
const LATER: Stage = Stage { leader: BEYOND, shares: [0.25, 0.0, 0.1, 1.0] };

/// The number of tests of the first stage, without the opening.
const FIRST_TESTS: usize = 30;

/// The member that never waits.
const READY: usize = BAYES;

impl Auto {
    pub(super) fn new(axes: Vec<Axis>, covariance: DMatrix<f64>, mut rng: Pcg64) -> Self {
        let mut chance = || seeded(rng.random(), Purpose::Search, 0);
        let bayes = Box::new(Bayes::new(axes.clone(), chance()));
        let simplices = Box::new(nelder_mead(axes.clone(), chance()));
        let cmaes = Box::new(Cmaes::preselected(axes.clone(), covariance, chance()));
        let beyond = Box::new(Beyond::new(axes, chance()));
        // In the order of their indices.
        let searches: [Box<dyn Optimiser>; 4] = [cmaes, bayes, simplices, beyond];
        let members = searches.into_iter().map(|search| Member { search, proposals: 0, owed: 0.0 }).collect();
        Self { members, out: BTreeMap::new(), proposals: 0, failed: false }
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
        let is_first = self.failed || self.proposals < FIRST_TESTS;
        let Stage { leader, shares } = if is_first { FIRST } else { LATER };
        let mut places = Vec::new();
        for index in (0..self.members.len()).filter(|&index| index != leader) {
            let quota = (self.members[index].owed as usize).min(n - places.len());
            let chosen = self.of_member(index, quota);
            self.members[index].owed -= quota as f64;
            places.extend(chosen);
        }
        let led = self.of_member(leader, n - places.len());
        for (index, (member, share)) in self.members.iter_mut().zip(shares).enumerate() {
            member.owed += if index == leader { 0.0 } else { share * led.len() as f64 };
        }
        places.extend(led);
        if places.is_empty() {
            places = self.of_member(READY, n);
        }
        places
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Evaluation) {
        self.failed |= trial.robustness.is_some_and(is_failure);
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
            while told < 130 {
                let places = auto.propose(n);
                assert!((1..=n).contains(&places.len()));
                for at in places {
                    auto.learn(Some(told), &Evaluation { robustness: robustness(&at), at });
                    told += 1;
                }
            }
            let chosen = [0, 1, 2, 3].map(|member: usize| auto.members[member].proposals as f64);
            let first = FIRST_TESTS as f64 / FIRST.shares.iter().sum::<f64>();
            let later = (told as f64 - FIRST_TESTS as f64) / LATER.shares.iter().sum::<f64>();
            for (member, chosen) in chosen.into_iter().enumerate() {
                let expected = first * FIRST.shares[member] + later * LATER.shares[member];
                assert!((chosen - expected).abs() < 6.0, "{member}: {chosen} of {told}, {expected} expected");
            }
        }
    }

    #[test]
    fn a_failure_ends_the_search_beyond_known_basins() {
        let mut auto = Auto::new(vec![Axis::Continuous; 2], DMatrix::identity(2, 2), seeded(2, Purpose::Search, 0));
        let mut told = 0;
        let mut beyond_after = [0, 0];
        for sign in [1.0, -1.0] {
            auto.learn(None, &Evaluation { at: vec![0.3, 0.2 * sign + 0.5], robustness: Some(sign) });
            let end = told + 60;
            while told < end {
                for at in auto.propose(4) {
                    auto.learn(Some(told), &Evaluation { robustness: Some(1.0 + at[0] + at[1] * at[1]), at });
                    told += 1;
                }
            }
            beyond_after[usize::from(sign < 0.0)] = auto.members[BEYOND].proposals;
        }
        // The search may still be owed a test from before the failure.
        assert!(beyond_after[0] > 10 && beyond_after[1] <= beyond_after[0] + 1, "{beyond_after:?}");
    }
}
