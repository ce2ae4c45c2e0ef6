//! Random tests that keep all constraints, every one as probable as any other.
//!
//! Groups do not restrict each other, so each is drawn on its own, by the shares of its diagram; no test is drawn
//! in vain. How probable a combination of levels is follows from the same shares.

use super::Rules;
use super::diagram::Chain;

/// Uniformly random tests among those that keep all constraints.
#[derive(Debug)]
pub struct UniformTests {
    levels: Vec<usize>,
    groups: Vec<RandomGroup>,
}

/// The parameters that constraints join.
#[derive(Debug)]
struct RandomGroup {
    members: Vec<usize>,
    /// The levels of each member in the order of their classes, and how many there are in each class.
    levels: Vec<Vec<usize>>,
    sizes: Vec<Vec<usize>>,
    chain: Chain,
}

/// Combinations of levels of as many parameters that are equally probable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alike {
    /// How many parameters they combine.
    pub parameters: usize,
    /// How many combinations there are.
    pub combinations: f64,
    /// The probability that a random test has one of them, the same for each.
    pub probability: f64,
}

impl Rules {
    /// Random tests that keep all constraints; none where a group of parameters is too entangled to be counted.
    pub fn uniform(&self) -> Option<UniformTests> {
        let group = |group: &super::group::Group| {
            let (members, sizes) = (group.members().to_vec(), group.sizes.clone());
            Some(RandomGroup { members, levels: group.levels_by_class(), sizes, chain: group.chain()? })
        };
        let groups = self.groups.iter().map(group).collect::<Option<_>>()?;
        Some(UniformTests { levels: self.levels.clone(), groups })
    }
}

impl UniformTests {
    /// A random test, a level for each parameter. `below(n)` gives one of the numbers below n, each as probable.
    pub fn draw(&self, mut below: impl FnMut(usize) -> usize) -> Vec<usize> {
        let mut test: Vec<Option<usize>> = vec![None; self.levels.len()];
        for group in &self.groups {
            // All 53 binary digits of a float.
            let mut share = || (below(1 << 26) as f64 + below(1 << 27) as f64 / (1 << 27) as f64) / (1 << 26) as f64;
            let open = group.chain.draw(&mut share);
            for ((&member, levels), open) in group.members.iter().zip(&group.levels).zip(open) {
                test[member] = Some(levels[open.start + below(open.len())]);
            }
        }
        let free = test.iter().zip(&self.levels);
        free.map(|(level, &levels)| level.unwrap_or_else(|| below(levels))).collect()
    }

    /// Shows `visit` the valid combinations of 1 to `k` parameters of each group that constraints join, one group
    /// after the other: the group's number with combinations that are alike.
    pub fn combinations(&self, k: usize, visit: &mut impl FnMut(usize, Alike)) {
        for (number, group) in self.groups.iter().enumerate() {
            let mut fixed = vec![None; group.members.len()];
            let nothing = Alike { parameters: 0, combinations: 1.0, probability: 1.0 };
            group.combinations(0, k, nothing, &mut fixed, &mut |alike| visit(number, alike));
        }
    }
}

impl RandomGroup {
    /// The combinations of the fixed classes with members from `next` on.
    fn combinations(
        &self,
        next: usize,
        k: usize,
        of: Alike,
        fixed: &mut [Option<usize>],
        visit: &mut dyn FnMut(Alike),
    ) {
        if of.parameters == k || next == self.members.len() {
            return;
        }
        let joint = self.chain.joint(fixed);
        for place in next..self.members.len() {
            let classes = joint[place].iter().enumerate().filter(|(_, probability)| **probability > 0.0);
            for (class, probability) in classes {
                let combinations = of.combinations * self.sizes[place][class] as f64;
                // The levels of a class share its probability.
                let with = Alike {
                    parameters: of.parameters + 1,
                    combinations,
                    probability: (probability / combinations).min(1.0),
                };
                visit(with);
                fixed[place] = Some(class);
                self.combinations(place + 1, k, with, fixed, visit);
                fixed[place] = None;
            }
        }
    }
}
