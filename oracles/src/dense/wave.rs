//! Piecewise linear functions of time, and what operators make of them.
//!
//! The algorithms are those of Donzé, Ferrère and Maler ("Efficient robust monitoring for STL", CAV 2013): maxima over
//! a moving window by a monotone wedge (Lemire, 2006) of breakpoints beside the values at the window's two ends, and
//! `until` segment by segment from the end. All take time linear in the number of breakpoints.

use std::collections::VecDeque;

/// How far beyond its end a function may be asked because of rounded sums of time bounds, relative to that time.
pub(super) const TOLERANCE: f64 = 1e-9;

/// A piecewise linear function from time 0 on, as its breakpoints. It jumps where two follow at one instant, and may be
/// infinite from one breakpoint to the next.
#[derive(Debug, Clone)]
pub(super) struct Wave(Vec<(f64, f64)>);

impl Wave {
    /// The function through these points, of which there is one at time 0.
    pub fn new(points: Vec<(f64, f64)>) -> Self {
        Self(points)
    }

    /// The same value from time 0 to `end`.
    pub fn constant(value: f64, end: f64) -> Self {
        Self(vec![(0.0, value), (end, value)])
    }

    pub fn points(&self) -> &[(f64, f64)] {
        &self.0
    }

    /// The end and the value there.
    pub fn last(&self) -> (f64, f64) {
        self.0[self.0.len() - 1]
    }

    fn end(&self) -> f64 {
        self.last().0
    }

    /// The function with this value at its end.
    pub fn ending(mut self, value: f64) -> Self {
        let end = self.end();
        push(&mut self.0, (end, value));
        self
    }

    /// The value at time 0.
    pub fn first(&self) -> f64 {
        self.0[0].1
    }

    /// Every value times a number.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.0.iter_mut().for_each(|point| point.1 *= factor);
        self
    }

    /// Run backwards from its end.
    pub fn reversed(mut self) -> Self {
        let end = self.end();
        self.0.reverse();
        self.0.iter_mut().for_each(|point| point.0 = end - point.0);
        self
    }

    /// The function up to an instant and before a jump there.
    pub fn cut(mut self, end: f64) -> Self {
        let within = self.0.partition_point(|point| point.0 < end);
        if let Some(next) = self.0.get(within).copied() {
            let value = within.checked_sub(1).map_or(next.1, |before| between(self.0[before], next, end));
            self.0.truncate(within);
            self.0.push((end, value));
        }
        self
    }

    /// The function from an instant on, counted from there.
    pub fn after(&self, time: f64) -> Self {
        let from = self.0.partition_point(|point| point.0 < time);
        let later = self.0[from..].iter().map(|point| (point.0 - time, point.1));
        let mut points = Vec::with_capacity(later.len() + 1);
        match (from.checked_sub(1).map(|before| self.0[before]), self.0.get(from)) {
            (Some(before), Some(next)) if next.0 > time => points.push((0.0, between(before, *next, time))),
            (Some(before), None) => points.push((0.0, before.1)),
            _ => {}
        }
        points.extend(later);
        Self(points)
    }

    /// The function and, after its end, another one.
    pub fn followed_by(mut self, other: &Self) -> Self {
        let end = self.end();
        // What the other is at its very beginning this one is at its end.
        let after = other.0.partition_point(|point| point.0 <= 0.0).saturating_sub(1);
        let later = other.0[after..].iter().map(|point| (end + point.0, point.1));
        later.for_each(|point| push(&mut self.0, point));
        self
    }

    /// The greatest value of all.
    pub fn greatest_of_all(&self) -> f64 {
        self.0.iter().map(|point| point.1).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Every value more by a number.
    pub fn raised(mut self, by: f64) -> Self {
        self.0.iter_mut().for_each(|point| point.1 += by);
        self
    }

    /// The sum of two functions.
    pub fn sum(&self, other: &Self) -> Self {
        let mut result = Vec::with_capacity(self.0.len() + other.0.len());
        self.together(other, |Piece { from, to, lines: [a, b] }| {
            push(&mut result, (from, a.0 + b.0));
            push(&mut result, (to, a.1 + b.1));
        });
        Self(result)
    }

    /// Two functions joined at each instant by one that is linear wherever neither is the greater by turns.
    fn joined(&self, other: &Self, join: impl Fn([f64; 2]) -> f64) -> Self {
        let mut result = Vec::with_capacity(self.0.len() + other.0.len());
        self.together(other, |piece| piece.push(&mut result, &join));
        Self(result)
    }

    pub fn max(&self, other: &Self) -> Self {
        self.joined(other, |[a, b]| a.max(b))
    }

    pub fn min(&self, other: &Self) -> Self {
        self.joined(other, |[a, b]| a.min(b))
    }

    /// The pieces over which two functions are both linear, before them the instant 0.
    fn together(&self, other: &Self, mut visit: impl FnMut(Piece<2>)) {
        let (mut i, mut j) = (0, 0);
        let mut from = 0.0;
        visit(Piece { from, to: from, lines: [(self.first(), self.first()), (other.first(), other.first())] });
        loop {
            let ends = [self.0.get(i + 1), other.0.get(j + 1)];
            let Some(to) = ends.into_iter().flatten().map(|point| point.0).min_by(f64::total_cmp) else { return };
            visit(Piece { from, to, lines: [self.line(i, from, to), other.line(j, from, to)] });
            i += usize::from(ends[0].is_some_and(|point| point.0 <= to));
            j += usize::from(ends[1].is_some_and(|point| point.0 <= to));
            from = to;
        }
    }

    /// The values at two instants of the piece that begins with breakpoint `i`.
    fn line(&self, i: usize, from: f64, to: f64) -> (f64, f64) {
        let first = self.0[i];
        match self.0.get(i + 1) {
            None => (first.1, first.1),
            Some(second) if first.0 == second.0 => (first.1, second.1),
            Some(second) => (between(first, *second, from), between(first, *second, to)),
        }
    }

    /// The greatest value over `[t + start, t + end]`, for `t` from 0 to `needed`; beyond the end it is `outside`.
    pub fn greatest(mut self, start: f64, end: f64, needed: f64, outside: f64) -> Self {
        let last = self.end();
        if needed + end > last + TOLERANCE * last.max(1.0) {
            self.0.extend([(last, outside), (needed + end + 1.0, outside)]);
        }
        let points = &self.0;
        let mut wedge: VecDeque<usize> = VecDeque::new();
        let (mut entered, mut left) = (0, 0);
        let enter = |wedge: &mut VecDeque<usize>, entered: &mut usize| {
            while wedge.back().is_some_and(|i| points[*i].1 <= points[*entered].1) {
                wedge.pop_back();
            }
            wedge.push_back(*entered);
            *entered += 1;
        };
        let leave = |wedge: &mut VecDeque<usize>, left: &mut usize| {
            if wedge.front() == Some(left) {
                wedge.pop_front();
            }
            *left += 1;
        };
        let highest = |wedge: &VecDeque<usize>| wedge.front().map_or(f64::NEG_INFINITY, |i| points[*i].1);
        let at = |next: usize, time: f64| match (next.checked_sub(1), points.get(next)) {
            (Some(before), Some(point)) => between(points[before], *point, time),
            (None, Some(point)) => point.1,
            _ => points[points.len() - 1].1,
        };
        // The very first window ends before a jump at its end.
        while points.get(entered).is_some_and(|point| point.0 - end < 0.0) {
            enter(&mut wedge, &mut entered);
        }
        while points.get(left).is_some_and(|point| point.0 - start < 0.0) {
            leave(&mut wedge, &mut left);
        }
        let mut result = Vec::with_capacity(2 * points.len());
        result.push((0.0, highest(&wedge).max(at(left, start)).max(at(entered, end))));
        let mut from = 0.0;
        loop {
            while points.get(entered).is_some_and(|point| point.0 - end <= from) {
                enter(&mut wedge, &mut entered);
            }
            while points.get(left).is_some_and(|point| point.0 - start <= from) {
                leave(&mut wedge, &mut left);
            }
            if from >= needed {
                return Self(result);
            }
            let mut to = needed;
            to = points.get(entered).map_or(to, |point| to.min(point.0 - end));
            to = points.get(left).map_or(to, |point| to.min(point.0 - start));
            let first = (at(left, from + start), at(left, to + start));
            let last = (at(entered, from + end), at(entered, to + end));
            let inner = highest(&wedge);
            let piece = Piece { from, to, lines: [first, last, (inner, inner)] };
            piece.push(&mut result, |[a, b, c]| a.max(b).max(c));
            from = to;
        }
    }

    /// The greatest value from each instant on, that beyond the end included.
    pub fn greatest_from_now(self, outside: f64) -> Self {
        let mut result = Vec::with_capacity(self.0.len());
        let (end, last) = self.0[self.0.len() - 1];
        let mut rest = outside.max(last);
        result.push((end, rest));
        for ends in self.0.windows(2).rev() {
            let [(from, first), (to, last)] = [ends[0], ends[1]];
            let piece = Piece { from: to, to: from, lines: [(last, first), (rest, rest)] };
            piece.push(&mut result, |[value, rest]| value.max(rest));
            rest = rest.max(first);
        }
        result.reverse();
        Self(result)
    }

    /// What `hold until goal` is worth at each instant, however late the goal; beyond the end it is `outside`. Time may run
    /// `back`: then what a function is at a jump is what it jumps to.
    pub fn until(hold: &Self, goal: &Self, back: bool, outside: f64) -> Self {
        let mut pieces = Vec::with_capacity(hold.0.len() + goal.0.len());
        hold.together(goal, |piece| pieces.push(piece));
        let mut result = Vec::with_capacity(pieces.len());
        let mut rest = outside;
        for Piece { from, to, lines: [(h0, h1), (g0, g1)] } in pieces.into_iter().rev() {
            // The best goal that is reached within this piece or after it, as far as `hold` is not what limits it.
            let (hold, best) = if from == to {
                // What comes after a jump is reached only by way of what `hold` jumps to, but for the jump's own instant.
                ((h1, h0), if back { g1.max(rest) } else { h1.min(rest) })
            } else if h1 > h0 {
                ((h1, h0), g1.max(rest))
            } else {
                // `hold` is least where the goal is reached.
                let meeting = if g1 > g0 { meeting((h0, h1), (g0, g1)) } else { f64::NEG_INFINITY };
                ((f64::INFINITY, f64::INFINITY), meeting.max(h1.min(rest)))
            };
            let piece = Piece { from: to, to: from, lines: [(g1, g0), hold, (best, best)] };
            piece.push(&mut result, |[goal, hold, best]| goal.max(hold.min(best)));
            rest = result[result.len() - 1].1;
        }
        result.reverse();
        Self(result)
    }
}

/// The greatest that the lesser of a falling and a rising line comes to.
fn meeting((h0, h1): (f64, f64), (g0, g1): (f64, f64)) -> f64 {
    if h0 > g0 && g1 > h1 {
        let share = (h0 - g0) / ((h0 - g0) + (g1 - h1));
        return g0 + (g1 - g0) * share;
    }
    h0.min(g0).max(h1.min(g1))
}

/// The value at an instant of the line through two points.
pub(super) fn between((t0, v0): (f64, f64), (t1, v1): (f64, f64), time: f64) -> f64 {
    if time <= t0 || v0 == v1 {
        v0
    } else if time >= t1 {
        v1
    } else {
        v0 + (v1 - v0) * ((time - t0) / (t1 - t0))
    }
}

/// Lines from one instant to another, which may be the earlier one.
#[derive(Debug, Clone, Copy)]
struct Piece<const N: usize> {
    from: f64,
    to: f64,
    lines: [(f64, f64); N],
}

impl<const N: usize> Piece<N> {
    /// Appends what `join` makes of the lines, with a breakpoint wherever two of them cross.
    #[inline]
    fn push(self, points: &mut Vec<(f64, f64)>, join: impl Fn([f64; N]) -> f64) {
        let Self { from, to, lines } = self;
        push(points, (from, join(lines.map(|line| line.0))));
        let mut crossings = [f64::INFINITY; 3];
        let mut count = 0;
        // At a jump there is nothing between the values before and after it.
        let lasting = if from == to { &lines[..0] } else { &lines[..] };
        for (i, a) in lasting.iter().enumerate() {
            for b in &lines[..i] {
                let (before, after) = (a.0 - b.0, a.1 - b.1);
                if before * after < 0.0 && (before - after).is_finite() {
                    crossings[count] = before / (before - after);
                    count += 1;
                }
            }
        }
        if count > 1 {
            crossings[..count].sort_by(f64::total_cmp);
        }
        for share in &crossings[..count] {
            let values = lines.map(|(v0, v1)| if v0 == v1 { v0 } else { v0 + (v1 - v0) * share });
            push(points, (from + (to - from) * share, join(values)));
        }
        push(points, (to, join(lines.map(|line| line.1))));
    }
}

/// Appends a breakpoint, unless there is none.
fn push(points: &mut Vec<(f64, f64)>, point: (f64, f64)) {
    if let [.., before, last] = points[..]
        && before.1 == point.1
        && last.1 == point.1
    {
        points.pop();
    }
    if points.last() != Some(&point) {
        points.push(point);
    }
}
