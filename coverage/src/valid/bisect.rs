//! The bisection of the cube into cells that are valid, invalid or too small to go on.
//!
//! The largest undecided cell is cut first. It is cut along the axis that decides the most of it; if no axis decides
//! anything, along its longest side. The bisection ends when it has asked a number of questions. It reads no clock, so that
//! the same constraints give the same cells.

use super::{Cases, Cell, Content, ValidPart};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// The limits of a bisection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Limits {
    /// The greatest number of cells that are cut.
    pub cuts: usize,
    /// The greatest number of boxes for which the constraints are computed.
    pub questions: usize,
}

/// A cell that is not decided yet.
struct Open {
    volume: f64,
    index: usize,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

/// A way to cut a cell, with the answers for both halves.
struct Choice {
    axis: usize,
    at: f64,
    answers: [Content; 2],
}

impl ValidPart {
    /// Bisects the cube along `axes`. `answer` says whether all tests of a box are valid, no test is, or neither is certain.
    pub(super) fn bisect(
        cases: Cases,
        axes: Vec<usize>,
        limits: Limits,
        mut answer: impl FnMut(&[f64], &[f64]) -> Content,
    ) -> Self {
        let dims = cases.continuous.len();
        let (lower, upper) = (vec![0.0; dims], vec![1.0; dims]);
        let mut part = Self { dims, axes, cases, cells: Vec::new() };
        let mut open = BinaryHeap::new();
        let mut left = limits.questions.saturating_sub(1);
        let first = answer(&lower, &upper);
        part.add(Open { volume: 1.0, index: 0, lower, upper }, first, &mut open);
        for _ in 0..limits.cuts {
            let Some(asked) = left.checked_sub(2 * part.axes.len()).filter(|_| !part.axes.is_empty()) else { break };
            let Some(Open { volume, index, lower, upper }) = open.pop() else { break };
            left = asked;
            let Some(Choice { axis, at, answers }) = part.choose(&lower, &upper, &mut answer) else { continue };
            let along = part.axes[axis];
            let halves = [part.cells.len(), part.cells.len() + 1];
            part.cells[index].content = Content::Cut { axis, at, halves };
            for (half, decided) in answers.into_iter().enumerate() {
                let (mut lower, mut upper) = (lower.clone(), upper.clone());
                if half == 0 {
                    upper[along] = at;
                } else {
                    lower[along] = at;
                }
                part.add(Open { volume: volume / 2.0, index: halves[half], lower, upper }, decided, &mut open);
            }
        }
        part.sum();
        part
    }

    /// Adds a cell that is not cut.
    fn add(&mut self, cell: Open, content: Content, open: &mut BinaryHeap<Open>) {
        let certain = if matches!(content, Content::Valid { .. }) { cell.volume } else { 0.0 };
        let possible = if content == Content::Invalid { 0.0 } else { cell.volume };
        self.cells.push(Cell { certain, possible, content });
        if content == Content::Undecided {
            open.push(cell);
        }
    }

    /// Chooses the cut of a cell that decides the most; `None` if the cell is too small to be cut.
    fn choose(
        &self,
        lower: &[f64],
        upper: &[f64],
        answer: &mut impl FnMut(&[f64], &[f64]) -> Content,
    ) -> Option<Choice> {
        let mut best: Option<(usize, f64, Choice)> = None;
        for (axis, &along) in self.axes.iter().enumerate() {
            let (from, to) = (lower[along], upper[along]);
            let at = 0.5 * (from + to);
            if !(from < at && at < to) {
                continue;
            }
            let mut half = |low: f64, high: f64| {
                let (mut lower, mut upper) = (lower.to_vec(), upper.to_vec());
                (lower[along], upper[along]) = (low, high);
                answer(&lower, &upper)
            };
            let answers = [half(from, at), half(at, to)];
            let decided = answers.iter().filter(|answer| **answer != Content::Undecided).count();
            let length = to - from;
            if best.as_ref().is_none_or(|(most, longest, _)| (decided, length) > (*most, *longest)) {
                best = Some((decided, length, Choice { axis, at, answers }));
            }
        }
        best.map(|(_, _, choice)| choice)
    }

    /// Computes the volumes of cells from the volumes of their halves, in the order in which weights are summed.
    fn sum(&mut self) {
        for index in (0..self.cells.len()).rev() {
            if let Content::Cut { halves: [low, high], .. } = self.cells[index].content {
                self.cells[index].certain = self.cells[low].certain + self.cells[high].certain;
                self.cells[index].possible = self.cells[low].possible + self.cells[high].possible;
            }
        }
    }
}

impl Open {
    fn rank(&self) -> (f64, Reverse<usize>) {
        (self.volume, Reverse(self.index))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        let ((volume, index), (of_other, index_of_other)) = (self.rank(), other.rank());
        volume.total_cmp(&of_other).then(index.cmp(&index_of_other))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}
