//! Decision diagrams of groups of parameters. Every path from the root to the end is a way to keep the clauses.
//!
//! A node divides a segment of a member's classes into two halves. So classes with the same child share a branch, and
//! nodes that differ in few classes share most of their children: a comparison of two members with n classes has about
//! n log n nodes, while a table has n squared entries. Nodes with the same children are merged, and choices without
//! influence are left out (Bryant, *Graph-based algorithms for Boolean function manipulation*, IEEE Transactions on
//! Computers 35, 1986).

mod chain;
mod compile;

pub(super) use chain::Chain;

use super::classes::ClassClause;
use compile::Node;
use std::ops::Range;

/// The mark of a missing child: nothing in this half keeps the clauses.
pub(super) const NONE: u32 = u32::MAX;

/// A range of classes of a member. A node decides in which half of the range the class is.
#[derive(Debug)]
pub(super) struct Segment {
    /// The position of the member in the order of the diagram.
    pub(super) turn: usize,
    pub(super) begin: usize,
    pub(super) middle: usize,
    pub(super) end: usize,
}

/// A reduced decision diagram.
#[derive(Debug)]
pub(super) struct Diagram {
    /// The members in the order in which they are decided, and the number of classes of each.
    order: Vec<usize>,
    classes: Vec<usize>,
    /// The segments in the order in which they are decided, and a last segment behind the last member.
    segments: Vec<Segment>,
    /// The nodes in the order of their segments, from the root to the end. Empty if nothing keeps the clauses.
    nodes: Vec<Node>,
}

impl Diagram {
    /// Compiles the clauses among members with these classes, or returns `None` if the diagram is too large.
    pub(super) fn new(members: &[usize], sizes: &[Vec<usize>], clauses: &[ClassClause]) -> Option<Self> {
        let place = |parameter: usize| members.binary_search(&parameter).expect("clauses are among the members");
        let places: Vec<Vec<usize>> =
            clauses.iter().map(|clause| clause.literals.iter().map(|l| place(l.parameter)).collect()).collect();
        let order = order(members.len(), &places);
        let mut turn = vec![0; order.len()];
        for (i, &place) in order.iter().enumerate() {
            turn[place] = i;
        }
        let classes: Vec<usize> = order.iter().map(|&place| sizes[place].len()).collect();
        let mut segments = Vec::new();
        for (turn, &classes) in classes.iter().enumerate() {
            divide(turn, 0..classes, &mut segments);
        }
        segments.push(Segment { turn: order.len(), begin: 0, middle: 0, end: 0 });
        let nodes = compile::nodes(&segments, &classes, clauses, |parameter| turn[place(parameter)])?;
        Some(Self { order, classes, segments, nodes })
    }

    /// Returns `true` if there is no path.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    fn segment(&self, node: usize) -> &Segment {
        &self.segments[self.nodes[node].segment as usize]
    }

    /// Calls `call` with each child of a node and the classes that lead to the child. Skips a half without the fixed
    /// class.
    #[inline(always)]
    fn each_branch(&self, node: usize, fixed: &[Option<usize>], mut call: impl FnMut(usize, Range<usize>)) {
        let (Node { low, high, .. }, segment) = (self.nodes[node], self.segment(node));
        let fixed = fixed[self.order[segment.turn]];
        if low != NONE && fixed.is_none_or(|class| class < segment.middle) {
            call(low as usize, segment.begin..segment.middle);
        }
        if high != NONE && fixed.is_none_or(|class| class >= segment.middle) {
            call(high as usize, segment.middle..segment.end);
        }
    }

    /// Returns `true` if a path has these classes, one for each member.
    pub(super) fn has(&self, class: impl Fn(usize) -> usize) -> bool {
        let mut node = 0;
        while node + 1 < self.nodes.len() {
            let segment = self.segment(node);
            let lower = class(self.order[segment.turn]) < segment.middle;
            let child = if lower { self.nodes[node].low } else { self.nodes[node].high };
            if child == NONE {
                return false;
            }
            node = child as usize;
        }
        true
    }

    /// Returns `true` if a path has the fixed classes.
    pub(super) fn holds(&self, fixed: &[Option<usize>]) -> bool {
        let end = self.nodes.len() - 1;
        let mut seen = Bits::new(self.nodes.len());
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            if node == end {
                return true;
            }
            self.each_branch(node, fixed, |child, _| {
                if seen.insert(child) {
                    stack.push(child);
                }
            });
        }
        false
    }

    /// Returns, for each member and class, `true` if a path has this class and the fixed classes.
    pub(super) fn supported(&self, fixed: &[Option<usize>]) -> Vec<Vec<bool>> {
        let end = self.nodes.len() - 1;
        // First the nodes that paths reach; then, from the end upwards, only the nodes that lead to the end.
        let mut leads = Bits::new(self.nodes.len());
        leads.insert(0);
        let mut reached = Vec::new();
        while let Some(node) = leads.next(reached.last().map_or(0, |last| last + 1)).filter(|&node| node < end) {
            reached.push(node);
            self.each_branch(node, fixed, |child, _| {
                leads.insert(child);
            });
        }
        let mut supported: Vec<Vec<bool>> = vec![Vec::new(); self.order.len()];
        for (&place, &classes) in self.order.iter().zip(&self.classes) {
            supported[place] = vec![false; classes];
        }
        // A path may skip members. The changes in the number of paths that skip a member, from each turn to the next.
        let mut unasked = vec![0isize; self.order.len() + 1];
        let mut skip = |turns: Range<usize>| {
            unasked[turns.start] += 1;
            unasked[turns.end] -= 1;
        };
        for &node in reached.iter().rev() {
            let turn = self.segment(node).turn;
            let mut ends = false;
            self.each_branch(node, fixed, |child, half| {
                if leads.contains(child) {
                    ends = true;
                    let next = self.segment(child).turn;
                    if next > turn {
                        supported[self.order[turn]][half].fill(true);
                        skip(turn + 1..next);
                    }
                }
            });
            if !ends {
                leads.remove(node);
            }
        }
        if leads.contains(0) {
            skip(0..self.segment(0).turn);
        }
        let mut depth = 0;
        for (&place, change) in self.order.iter().zip(unasked) {
            depth += change;
            match fixed[place] {
                Some(class) => {
                    // Every half that a path took has the fixed class.
                    let some = depth > 0 || supported[place][class];
                    supported[place].fill(false);
                    supported[place][class] = some;
                }
                None if depth > 0 => supported[place].fill(true),
                None => {}
            }
        }
        supported
    }

    /// Counts the tests: each path counts as often as its classes have levels.
    pub(super) fn tests(&self, sizes: &[Vec<usize>]) -> f64 {
        let levels = |turn: usize, classes: Range<usize>| sizes[self.order[turn]][classes].iter().sum::<usize>() as f64;
        let all = |turns: Range<usize>| turns.map(|turn| levels(turn, 0..self.classes[turn])).product::<f64>();
        let nothing = vec![None; self.order.len()];
        let mut below = vec![1.0; self.nodes.len()];
        for node in (0..self.nodes.len() - 1).rev() {
            let turn = self.segment(node).turn;
            let mut paths = 0.0;
            self.each_branch(node, &nothing, |child, half| {
                paths += match self.segment(child).turn {
                    next if next > turn => levels(turn, half) * all(turn + 1..next) * below[child],
                    _ => below[child],
                };
            });
            below[node] = paths;
        }
        all(0..self.segment(0).turn) * below[0]
    }
}

/// Appends the segments of a member's classes. Each segment comes before its halves: the lower half comes next. The
/// upper half comes as many places behind the segment as the lower half has classes.
fn divide(turn: usize, classes: Range<usize>, segments: &mut Vec<Segment>) {
    if classes.len() > 1 {
        let middle = classes.start + classes.len() / 2;
        segments.push(Segment { turn, begin: classes.start, middle, end: classes.end });
        divide(turn, classes.start..middle, segments);
        divide(turn, middle..classes.end, segments);
    }
}

/// Orders the members so that few clauses have members on both sides of a place. The next member is always the one
/// that leaves the fewest clauses open.
fn order(members: usize, clauses: &[Vec<usize>]) -> Vec<usize> {
    let mut placed = vec![false; members];
    let mut order = Vec::with_capacity(members);
    let open = |placed: &[bool]| {
        clauses.iter().filter(|c| c.iter().any(|&p| placed[p]) && c.iter().any(|&p| !placed[p])).count()
    };
    for _ in 0..members {
        let rank = |&place: &usize| {
            let mut placed = placed.clone();
            placed[place] = true;
            open(&placed)
        };
        let next = (0..members).filter(|&place| !placed[place]).min_by_key(rank).expect("a member is left");
        placed[next] = true;
        order.push(next);
    }
    order
}

/// A set of numbers, with a bit for each number.
struct Bits(Vec<u64>);

impl Bits {
    fn new(numbers: usize) -> Self {
        Self(vec![0; numbers.div_ceil(64)])
    }

    fn contains(&self, number: usize) -> bool {
        self.0[number / 64] >> (number % 64) & 1 == 1
    }

    /// Adds a number, and returns `true` if it is new.
    fn insert(&mut self, number: usize) -> bool {
        let new = !self.contains(number);
        self.0[number / 64] |= 1 << (number % 64);
        new
    }

    fn remove(&mut self, number: usize) {
        self.0[number / 64] &= !(1 << (number % 64));
    }

    /// Returns the first number of the set that is at least `from`.
    fn next(&self, from: usize) -> Option<usize> {
        let first = self.0.get(from / 64)? & u64::MAX << (from % 64);
        if first != 0 {
            return Some(from / 64 * 64 + first.trailing_zeros() as usize);
        }
        let word = (from / 64 + 1..self.0.len()).find(|&word| self.0[word] != 0)?;
        Some(word * 64 + self.0[word].trailing_zeros() as usize)
    }
}
