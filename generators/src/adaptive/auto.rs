//! A portfolio: several searches side by side that learn from each other's tests. What to use where nothing is known.
//!
//! No search is best everywhere. On our functions (BENCHMARKS.md) `bayes` needs the fewest tests nearly always; where it
//! does not, its model is misled: by a valley that bends, which `nelder-mead` follows, or by a second, flatter minimum,
//! which restarts get away from; `cmaes` is what goes on working over hundreds of tests, on rough ground, with many
//! parameters, and where corners fail: its samples stop at the ends of the axes.
//!
//! Of every twenty tests `bayes` and `cmaes` choose nine each and `nelder-mead` two. With half for `bayes` and a quarter for each of
//! the others `auto` took 1.7 times the tests of the best single strategy where one corner of 32 fails, and hardly fewer
//! elsewhere; with half for `cmaes` 1.7 times as many in `follow-leader`, where `cmaes` is misled. With these shares it takes at
//! most 1.4 times as many on the functions (experiments/strategies.md has what is open elsewhere). Swarms as a fourth search
//! were tried: best alone in corners, they are too slow with a share of the tests.
//!
//! The shares are fixed: which search will find the failure does not show in how it did before there was one. A search that
//! waits for outcomes leaves its tests undone, and the batch is shorter: tests that another would do in its place are better
//! chosen when these outcomes are known. Where all others wait, `bayes` does not.

use super::bayes::Bayes;
use super::cmaes::Cmaes;
use super::cube::Axis;
use super::nelder_mead::nelder_mead;
use super::{Search, Trial};
use crate::seeded::{Purpose, seeded};
use nalgebra::DMatrix;
use rand::Rng;
use rand_pcg::Pcg64;
use std::collections::BTreeMap;

/// The searches with their shares of the tests.
pub(super) struct Auto {
    members: Vec<Member>,
    /// Of each proposal that is out, whose it is and which of its own.
    out: BTreeMap<usize, (usize, usize)>,
    proposals: usize,
}

struct Member {
    search: Box<dyn Search>,
    share: f64,
    proposals: usize,
    /// How many tests it is owed.
    owed: f64,
}

impl Auto {
    pub(super) fn new(axes: Vec<Axis>, covariance: DMatrix<f64>, mut rng: Pcg64) -> Self {
        let mut chance = || seeded(rng.random(), Purpose::Search, 0);
        let bayes = Box::new(Bayes::new(axes.clone(), chance()));
        let simplices = Box::new(nelder_mead(axes.clone(), chance()));
        let cmaes = Box::new(Cmaes::new(axes, covariance, chance()));
        let member = |search, share| Member { search, share, proposals: 0, owed: 0.0 };
        // The first is asked where no other has anything to propose.
        let members = vec![member(bayes as Box<dyn Search>, 0.45), member(simplices, 0.1), member(cmaes, 0.45)];
        Self { members, out: BTreeMap::new(), proposals: 0 }
    }

    /// How many of `n` tests each member is to choose.
    fn quotas(&mut self, n: usize) -> Vec<usize> {
        let mut quotas = vec![0; self.members.len()];
        for _ in 0..n {
            self.members.iter_mut().for_each(|member| member.owed += member.share);
            // Of those owed as much the first.
            let most =
                (0..self.members.len()).rev().max_by(|&a, &b| self.members[a].owed.total_cmp(&self.members[b].owed));
            let most = most.expect("there are members");
            self.members[most].owed -= 1.0;
            quotas[most] += 1;
        }
        quotas
    }

    /// What a member proposes, at most `n` places.
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

impl Search for Auto {
    fn propose(&mut self, n: usize) -> Vec<Vec<f64>> {
        let quotas = self.quotas(n);
        let mut places = Vec::new();
        for (index, quota) in quotas.into_iter().enumerate().rev() {
            places.extend(self.of_member(index, quota));
        }
        if places.is_empty() {
            places = self.of_member(0, n);
        }
        places
    }

    fn learn(&mut self, proposal: Option<usize>, trial: &Trial) {
        let owner = proposal.and_then(|proposal| self.out.remove(&proposal));
        for (index, member) in self.members.iter_mut().enumerate() {
            let own = owner.filter(|owner| owner.0 == index).map(|owner| owner.1);
            member.search.learn(own, trial);
        }
    }
}
