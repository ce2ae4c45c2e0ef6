//! Random tests that keep all constraints, all of them equally probable.
//!
//! Groups do not restrict each other. So each group is drawn on its own, with the probabilities of its diagram, and no
//! test is drawn in vain. The same probabilities give the probability of a combination of levels.

use super::Rules;
use super::diagram::Chain;

/// A source of random tests that keep all constraints and are equally probable.
#[derive(Debug)]
pub struct UniformTests {
    levels: Vec<usize>,
    groups: Vec<RandomGroup>,
}

/// A group of parameters that constraints join.
#[derive(Debug)]
struct RandomGroup {
    members: Vec<usize>,
    /// The levels of each member in the order of their classes, and the number of levels in each class.
    levels: Vec<Vec<usize>>,
    sizes: Vec<Vec<usize>>,
    chain: Chain,
}

/// A set of equally probable combinations of levels of the same parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alike {
    /// The number of parameters that each combination has.
    pub parameters: usize,
    /// The number of equally probable combinations in the set.
    pub combinations: f64,
    /// The probability that a random test has a given combination of the set.
    pub probability: f64,
}

impl Rules {
    /// Makes a source of equally probable random tests, or returns `None` if the tests cannot be counted. The tests
    /// cannot be counted if the diagram of a group would be too large.
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
    /// Draws a random test, as a level for each parameter. `below(n)` has to give a uniformly random number below n.
    pub fn draw(&self, mut below: impl FnMut(usize) -> usize) -> Vec<usize> {
        let mut test: Vec<Option<usize>> = vec![None; self.levels.len()];
        for group in &self.groups {
            // Use all 53 binary digits of a float.
            let mut share = || (below(1 << 26) as f64 + below(1 << 27) as f64 / (1 << 27) as f64) / (1 << 26) as f64;
            let open = group.chain.draw(&mut share);
            for ((&member, levels), open) in group.members.iter().zip(&group.levels).zip(open) {
                test[member] = Some(levels[open.start + below(open.len())]);
            }
        }
        let free = test.iter().zip(&self.levels);
        free.map(|(level, &levels)| level.unwrap_or_else(|| below(levels))).collect()
    }

    /// Calls `visit` with all valid combinations of levels of 1 to `k` parameters that constraints join in a group. One
    /// group follows the other. `visit` gets the number of the group and combinations that are equally probable.
    pub fn combinations(&self, k: usize, visit: &mut impl FnMut(usize, Alike)) {
        for (number, group) in self.groups.iter().enumerate() {
            let mut fixed = vec![None; group.members.len()];
            let nothing = Alike { parameters: 0, combinations: 1.0, probability: 1.0 };
            group.combinations(0, k, nothing, &mut fixed, &mut |alike| visit(number, alike));
        }
    }
}

impl RandomGroup {
    /// Visits the combinations of the fixed classes with members from `next` on.
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
                // The levels of a class share the probability of the class.
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
