//! Finds all levels that are valid together with fixed levels, as sets of bits.
//!
//! Each level of each parameter has a bit. A fixed level excludes only bits of parameters in its own group. The bits
//! that remain of a group are stored for each set of fixed levels, since combinations of k levels have most of their
//! levels in common.

use super::Rules;
use std::collections::HashMap;

/// The bits of a group that remain with some fixed levels, or `None` if the fixed levels exclude each other.
type Left = Option<Box<[u64]>>;

/// A search for the levels that are valid together with fixed levels of other parameters. It stores its results.
#[derive(Debug)]
pub struct Companions<'r> {
    rules: &'r Rules,
    first: Vec<usize>,
    /// The bits of the levels that are valid on their own.
    alone: Vec<u64>,
    /// The bits of each group.
    groups: Vec<Vec<u64>>,
    known: Vec<HashMap<Vec<(usize, usize)>, Left>>,
    mask: Vec<u64>,
}

impl<'r> Companions<'r> {
    /// Prepares a search that follows the given rules. The bits follow the parameters in the given order: the first
    /// parameter has the lowest bits.
    ///
    /// # Panics
    /// `order` is not a permutation of the parameters.
    pub fn new(rules: &'r Rules, order: &[usize]) -> Self {
        let levels = rules.levels();
        let mut first = vec![usize::MAX; levels.len()];
        let mut width = 0;
        for &parameter in order {
            first[parameter] = width;
            width += levels[parameter];
        }
        assert!(order.len() == levels.len() && !first.contains(&usize::MAX), "each parameter has its place");
        let words = width.div_ceil(64);
        let mut groups = vec![vec![0; words]; rules.groups()];
        let mut alone = vec![0; words];
        for parameter in 0..levels.len() {
            let bits = first[parameter]..first[parameter] + levels[parameter];
            match rules.group_of(parameter) {
                None => bits.for_each(|bit| set(&mut alone, bit)),
                Some(group) => bits.for_each(|bit| set(&mut groups[group], bit)),
            }
        }
        let known = vec![HashMap::new(); groups.len()];
        let mut companions = Self { rules, first, alone, groups, known, mask: vec![0; words] };
        for group in 0..rules.groups() {
            let left = companions.left(group, &[]).expect("a group can be kept");
            companions.alone.iter_mut().zip(left).for_each(|(all, left)| *all |= left);
        }
        companions
    }

    /// Returns the position of the bit that stands for a parameter's first level.
    pub fn first(&self, parameter: usize) -> usize {
        self.first[parameter]
    }

    /// Returns the number of 64-bit words that hold a bit for every level.
    pub fn words(&self) -> usize {
        self.alone.len()
    }

    fn left(&self, group: usize, fixed: &[(usize, usize)]) -> Left {
        let level = |parameter: usize| fixed.iter().find(|pair| pair.0 == parameter).map(|pair| pair.1);
        let supported = self.rules.supported(group, level);
        let mut bits = vec![0; self.words()];
        for (&member, supported) in self.rules.members(group).iter().zip(&supported) {
            let levels = supported.iter().enumerate().filter(|(_, supported)| **supported);
            levels.for_each(|(level, _)| set(&mut bits, self.first[member] + level));
        }
        supported[0].contains(&true).then(|| bits.into())
    }

    /// Returns the levels that are valid together with the fixed (parameter, level) pairs, as a set of bits, or `None`
    /// if no test has all pairs. The bits of fixed parameters have no meaning.
    ///
    /// # Panics
    /// A parameter or a level does not exist, or a parameter is fixed twice.
    pub fn with(&mut self, fixed: &[(usize, usize)]) -> Option<&[u64]> {
        if fixed.iter().all(|&(parameter, _)| self.rules.group_of(parameter).is_none()) {
            return Some(&self.alone);
        }
        self.mask.copy_from_slice(&self.alone);
        for (i, &(parameter, _)) in fixed.iter().enumerate() {
            let Some(group) = self.rules.group_of(parameter) else { continue };
            let inside = |pair: &&(usize, usize)| self.rules.group_of(pair.0) == Some(group);
            if fixed[..i].iter().any(|pair| inside(&pair)) {
                continue;
            }
            let inside: Vec<(usize, usize)> = fixed[i..].iter().filter(inside).copied().collect();
            if !self.known[group].contains_key(&inside) {
                let left = self.left(group, &inside);
                self.known[group].insert(inside.clone(), left);
            }
            let left = self.known[group][&inside].as_ref()?;
            for ((mask, group), left) in self.mask.iter_mut().zip(&self.groups[group]).zip(left) {
                *mask &= !group | left;
            }
        }
        Some(&self.mask)
    }
}

fn set(bits: &mut [u64], bit: usize) {
    bits[bit / 64] |= 1 << (bit % 64);
}
