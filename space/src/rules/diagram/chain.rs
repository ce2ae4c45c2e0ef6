//! A diagram as a Markov chain. The chain draws all tests with the same probability.
//!
//! A node chooses each half with this probability: the number of tests through the half, divided by the number of
//! tests through the node. Then all tests are equally probable (Knuth, *The Art of Computer Programming* 4A, 7.1.4, on
//! random solutions). The same numbers give the probability of any combination of classes.

use super::{Bits, Diagram, NONE};
use std::ops::Range;
use std::sync::Arc;

/// Random paths of a diagram that is not empty. All choices of levels are equally probable.
#[derive(Debug)]
pub(in crate::rules) struct Chain {
    diagram: Arc<Diagram>,
    /// For each turn, the number of levels before each class, and at last the number of all levels.
    before: Vec<Vec<usize>>,
    /// For each node, the probabilities of the lower and the upper half.
    halves: Vec<[f64; 2]>,
}

/// A number that may be too small for a float: the first number times two to the power of the second.
type Scaled = (f64, i32);

impl Chain {
    /// Makes the chain of a diagram. `sizes` has the number of levels in each class of each member.
    pub(in crate::rules) fn new(diagram: Arc<Diagram>, sizes: &[Vec<usize>]) -> Self {
        let before = |&place: &usize| {
            let ends = sizes[place].iter().scan(0, |end, size| {
                *end += size;
                Some(*end)
            });
            std::iter::once(0).chain(ends).collect()
        };
        let before = diagram.order.iter().map(before).collect();
        let mut chain = Self { before, halves: vec![[0.0; 2]; diagram.nodes.len()], diagram };
        // The share of the choices below a node that keep the clauses. Members that a path skips do not change the
        // share.
        let mut kept: Vec<Scaled> = vec![(1.0, 0); chain.halves.len()];
        for node in (0..chain.end()).rev() {
            let (segment, children) = (chain.diagram.segment(node), chain.diagram.nodes[node]);
            let levels = |half: Range<usize>| chain.levels(segment.turn, &half).len() as f64;
            let weigh = |child: u32, half: Range<usize>| match child {
                NONE => (0.0, i32::MIN),
                child => (kept[child as usize].0 * levels(half), kept[child as usize].1),
            };
            let low = weigh(children.low, segment.begin..segment.middle);
            let high = weigh(children.high, segment.middle..segment.end);
            let most = low.1.max(high.1);
            let weights = [low, high].map(|(weight, power)| libm::ldexp(weight, power.saturating_sub(most)));
            let all = weights[0] + weights[1];
            let (share, power) = libm::frexp(all / levels(segment.begin..segment.end));
            kept[node] = (share, most + power);
            chain.halves[node] = weights.map(|weight| weight / all);
        }
        chain
    }

    fn end(&self) -> usize {
        self.halves.len() - 1
    }

    /// Returns the levels of consecutive classes, as positions among the member's levels in the order of the classes.
    fn levels(&self, turn: usize, classes: &Range<usize>) -> Range<usize> {
        self.before[turn][classes.start]..self.before[turn][classes.end]
    }

    fn all_classes(&self, turn: usize) -> Range<usize> {
        0..self.diagram.classes[turn]
    }

    /// Draws a random path, and returns the levels of each member that it leaves open. These levels are equally
    /// probable. They are given as positions among the member's levels in the order of the classes. `share` gives
    /// random numbers from 0 to below 1.
    pub(in crate::rules) fn draw(&self, mut share: impl FnMut() -> f64) -> Vec<Range<usize>> {
        let Diagram { order, nodes, .. } = &*self.diagram;
        let mut drawn = vec![0..0; order.len()];
        for (turn, &place) in order.iter().enumerate() {
            drawn[place] = self.levels(turn, &self.all_classes(turn));
        }
        let mut node = 0;
        while node < self.end() {
            let segment = self.diagram.segment(node);
            let (child, half) = match share() < self.halves[node][0] {
                true => (nodes[node].low, segment.begin..segment.middle),
                false => (nodes[node].high, segment.middle..segment.end),
            };
            drawn[order[segment.turn]] = self.levels(segment.turn, &half);
            node = child as usize;
        }
        drawn
    }

    /// Returns, for each member and class, the probability that a path has this class and the fixed classes.
    pub(in crate::rules) fn joint(&self, fixed: &[Option<usize>]) -> Vec<Vec<f64>> {
        let Diagram { order, .. } = &*self.diagram;
        let turn = |node: usize| self.diagram.segment(node).turn;
        // The probability of reaching each node with the fixed classes.
        let mut reached = vec![0.0; self.halves.len()];
        reached[0] = self.agree(0..turn(0), fixed);
        let mut leads = Bits::new(self.halves.len());
        leads.insert(0);
        let mut nodes = Vec::new();
        while let Some(node) = leads.next(nodes.last().map_or(0, |last| last + 1)).filter(|&node| node < self.end()) {
            nodes.push(node);
            let here = reached[node];
            self.each_branch(node, fixed, |child, _, share| {
                leads.insert(child);
                reached[child] += here * share;
            });
        }
        let mut joint: Vec<Vec<f64>> = vec![Vec::new(); order.len()];
        for (turn, &place) in order.iter().enumerate() {
            joint[place] = vec![0.0; self.diagram.classes[turn]];
        }
        let mut add = |turn: usize, classes: Range<usize>, probability: f64| {
            let levels = self.levels(turn, &classes).len() as f64;
            let joint = &mut joint[order[turn]];
            match fixed[order[turn]] {
                Some(class) => joint[class] += probability,
                None => classes.for_each(|class| {
                    joint[class] += probability * (self.levels(turn, &(class..class + 1)).len() as f64 / levels);
                }),
            }
        };
        // The probabilities of going on from each node with the fixed classes, and of skipping each member on the way.
        let mut on = vec![0.0; self.halves.len()];
        on[self.end()] = 1.0;
        let mut unasked = vec![0.0; order.len()];
        for &node in nodes.iter().rev() {
            let mut all = 0.0;
            self.each_branch(node, fixed, |child, half, share| {
                all += share * on[child];
                let path = reached[node] * share * on[child];
                if turn(child) > turn(node) && path > 0.0 {
                    add(turn(node), half, path);
                    unasked[turn(node) + 1..turn(child)].iter_mut().for_each(|unasked| *unasked += path);
                }
            });
            on[node] = all;
        }
        unasked[..turn(0)].fill(reached[0] * on[0]);
        for (turn, &probability) in unasked.iter().enumerate().filter(|(_, probability)| **probability > 0.0) {
            add(turn, self.all_classes(turn), probability);
        }
        joint
    }

    /// Calls `call` with each child of a node that the fixed classes lead to, the classes on the way, and a
    /// probability. It is the probability of going to the child with all classes that are fixed before the child.
    fn each_branch(&self, node: usize, fixed: &[Option<usize>], mut call: impl FnMut(usize, Range<usize>, f64)) {
        let segment = self.diagram.segment(node);
        self.diagram.each_branch(node, fixed, |child, half| {
            let share = self.halves[node][usize::from(half.start == segment.middle)];
            let agree = match self.diagram.segment(child).turn {
                next if next > segment.turn => {
                    self.agrees(segment.turn, &half, fixed) * self.agree(segment.turn + 1..next, fixed)
                }
                _ => 1.0,
            };
            call(child, half, share * agree);
        });
    }

    /// Returns the probability that skipped members, for which all classes are open, have the fixed classes.
    fn agree(&self, turns: Range<usize>, fixed: &[Option<usize>]) -> f64 {
        turns.map(|turn| self.agrees(turn, &self.all_classes(turn), fixed)).product()
    }

    /// Returns the probability that a member with one of these classes has the fixed class.
    fn agrees(&self, turn: usize, classes: &Range<usize>, fixed: &[Option<usize>]) -> f64 {
        fixed[self.diagram.order[turn]].map_or(1.0, |class| {
            self.levels(turn, &(class..class + 1)).len() as f64 / self.levels(turn, classes).len() as f64
        })
    }
}
