//! Piecewise linear functions of time, and the results of operators on them.
//!
//! The algorithms are those of Donzé, Ferrère and Maler ("Efficient robust monitoring for STL", CAV 2013). The maximum
//! over a moving window comes from a monotone wedge of breakpoints and the values at both ends of the window. `until`
//! is computed segment by segment from the end. All algorithms take time linear in the number of breakpoints. Where a
//! function jumps it has a value of its own beside the limits on both sides, so that windows can include their ends.

use super::piece::{Piece, between, push};
use super::window::{Sliding, Window};

/// The time after its end at which a function may be read, relative to the end. Sums of time bounds are rounded.
pub(super) const TOLERANCE: f64 = 1e-9;

/// A piecewise linear function from time 0 on, stored as its breakpoints. A jump has three breakpoints at one instant:
/// the limit from below, the value, and the limit from above. At the beginning and the end, the missing limit equals
/// the value. The function may be infinite from one breakpoint to the next.
#[derive(Debug, Clone)]
pub(super) struct Wave(Vec<(f64, f64)>);

impl Wave {
    /// Makes the piecewise linear function through the given breakpoints. One breakpoint is at time 0.
    pub fn new(points: Vec<(f64, f64)>) -> Self {
        Self(points)
    }

    /// Makes the function that has the given value from time 0 to `end`.
    pub fn constant(value: f64, end: f64) -> Self {
        Self(vec![(0.0, value), (end, value)])
    }

    pub fn points(&self) -> &[(f64, f64)] {
        &self.0
    }

    /// Returns the time at which the function ends, and the value of the function at this time.
    pub fn last(&self) -> (f64, f64) {
        self.0[self.0.len() - 1]
    }

    fn end(&self) -> f64 {
        self.last().0
    }

    /// Returns the value of the function at time 0.
    pub fn first(&self) -> f64 {
        self.0[0].1
    }

    /// Multiplies every value of the function by `factor`.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.0.iter_mut().for_each(|point| point.1 *= factor);
        self
    }

    /// Returns the function reversed in time, so that its end becomes time 0.
    pub fn reversed(mut self) -> Self {
        let end = self.end();
        self.0.reverse();
        self.0.iter_mut().for_each(|point| point.0 = end - point.0);
        self
    }

    /// Returns the part of the function up to the time `end`.
    pub fn cut(mut self, end: f64) -> Self {
        let within = self.0.partition_point(|point| point.0 < end);
        if within < self.0.len() {
            let [below, value, _] = self.around(within, end);
            self.0.truncate(within);
            [below, value, value].into_iter().for_each(|value| push(&mut self.0, (end, value)));
        }
        self
    }

    /// Returns the part of the function from the given time on, with times counted from this time.
    pub fn after(&self, time: f64) -> Self {
        let from = self.0.partition_point(|point| point.0 < time);
        let [_, value, above] = self.around(from, time);
        let later = self.0.partition_point(|point| point.0 <= time);
        let mut points = Vec::with_capacity(self.0.len() - later + 3);
        [value, value, above].into_iter().for_each(|value| push(&mut points, (0.0, value)));
        points.extend(self.0[later..].iter().map(|point| (point.0 - time, point.1)));
        Self(points)
    }

    /// Continues the function after its end with the function `other`. At the joint, `other` gives only the limit from
    /// above.
    pub fn followed_by(mut self, other: &Self) -> Self {
        let (end, value) = self.last();
        let before = self.0.partition_point(|point| point.0 < end);
        let below = self.0[before].1;
        self.0.truncate(before);
        let later = other.0.partition_point(|point| point.0 <= 0.0);
        let above = other.0[later.saturating_sub(1)].1;
        [below, value, above].into_iter().for_each(|value| push(&mut self.0, (end, value)));
        self.0.extend(other.0[later..].iter().map(|point| (end + point.0, point.1)));
        self
    }

    /// Returns the limit from below, the value and the limit from above at an instant behind `before` breakpoints.
    fn around(&self, before: usize, time: f64) -> [f64; 3] {
        let here = self.0[before..].iter().take_while(|point| point.0 <= time).count();
        if here > 0 {
            return [0, here / 2, here - 1].map(|place| self.0[before + place].1);
        }
        let next = self.0[before.min(self.0.len() - 1)];
        [before.checked_sub(1).map_or(next.1, |last| between(self.0[last], next, time)); 3]
    }

    /// Returns the greatest value that the function ever has.
    pub fn greatest_of_all(&self) -> f64 {
        self.0.iter().map(|point| point.1).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Adds the number `by` to every value of the function.
    pub fn raised(mut self, by: f64) -> Self {
        self.0.iter_mut().for_each(|point| point.1 += by);
        self
    }

    /// Returns the sum of this function and the function `other`.
    pub fn sum(&self, other: &Self) -> Self {
        let mut result = Vec::with_capacity(self.0.len() + other.0.len());
        self.together(other, |Piece { to, lines: [a, b], .. }| push(&mut result, (to, a.1 + b.1)));
        Self(result)
    }

    /// Joins two functions at each instant. `join` has to be linear between the instants at which the functions cross.
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

    /// Visits the pieces on which both functions are linear, in order. The first piece is the instant 0. At a jump
    /// there are two pieces of no duration: from the limit from below to the value, and on to the limit from above.
    fn together(&self, other: &Self, mut visit: impl FnMut(Piece<2>)) {
        let (mut i, mut j) = (0, 0);
        let mut now = 0.0;
        visit(Piece { from: now, to: now, lines: [(self.first(), self.first()), (other.first(), other.first())] });
        loop {
            let next = self.time(i + 1).min(other.time(j + 1));
            if next <= now {
                let (a, b) = (self.leap(&mut i, now), other.leap(&mut j, now));
                visit(Piece { from: now, to: now, lines: [(a[0], a[1]), (b[0], b[1])] });
                visit(Piece { from: now, to: now, lines: [(a[1], a[2]), (b[1], b[2])] });
                continue;
            }
            if next == f64::INFINITY {
                return;
            }
            visit(Piece { from: now, to: next, lines: [self.line(i, now, next), other.line(j, now, next)] });
            i += usize::from(self.time(i + 1) <= next);
            j += usize::from(other.time(j + 1) <= next);
            now = next;
        }
    }

    /// Returns the time of breakpoint `i`, or infinity if the breakpoint does not exist.
    fn time(&self, i: usize) -> f64 {
        self.0.get(i).map_or(f64::INFINITY, |point| point.0)
    }

    /// Moves `i` to the last breakpoint at this instant, and returns both limits with the value between them.
    fn leap(&self, i: &mut usize, time: f64) -> [f64; 3] {
        let around = self.around(*i + usize::from(self.0[*i].0 < time), time);
        while self.time(*i + 1) <= time {
            *i += 1;
        }
        around
    }

    /// Returns the values at two instants of the piece that begins with breakpoint `i`.
    fn line(&self, i: usize, from: f64, to: f64) -> (f64, f64) {
        let first = self.0[i];
        match self.0.get(i + 1) {
            None => (first.1, first.1),
            Some(second) => (between(first, *second, from), between(first, *second, to)),
        }
    }

    /// Returns the greatest value of the function in a window that moves from time 0 to `needed`. Beyond the end the
    /// value is `outside`.
    pub fn greatest(mut self, window: Window, needed: f64, outside: f64) -> Self {
        let (last, value) = self.last();
        if needed + window.end > last + TOLERANCE * last.max(1.0) {
            self.0.extend([(last, value), (last, outside), (needed + window.end + 1.0, outside)]);
        }
        let mut sliding = Sliding::new(&self.0, window);
        let mut result = Vec::with_capacity(2 * self.0.len());
        let mut now = 0.0;
        loop {
            let leap = sliding.pass(now);
            if result.is_empty() {
                result.push((now, leap.map_or_else(|| sliding.value(now), |[value, _]| value)));
            }
            if let Some([value, above]) = leap {
                push(&mut result, (now, value));
                push(&mut result, (now, if now < needed { above } else { value }));
            }
            if now >= needed {
                return Self(result);
            }
            let piece = sliding.piece(now, needed);
            piece.push(&mut result, |[a, b, c]| a.max(b).max(c));
            now = piece.to;
        }
    }

    /// Returns the function of the greatest values from each instant to the end. The value beyond the end, `outside`,
    /// counts too.
    pub fn greatest_from_now(self, outside: f64) -> Self {
        let mut result = Vec::with_capacity(self.0.len());
        let (end, last) = self.last();
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

    /// Returns the robustness of `hold until goal` at each instant, without a time bound. It is `outside` beyond the
    /// end.
    pub fn until(hold: &Self, goal: &Self, outside: f64) -> Self {
        let mut pieces = Vec::with_capacity(hold.0.len() + goal.0.len());
        hold.together(goal, |piece| pieces.push(piece));
        let mut result = Vec::with_capacity(pieces.len());
        let Piece { to, lines: [hold, goal], .. } = pieces[pieces.len() - 1];
        let mut rest = goal.1.max(hold.1.min(outside));
        result.push((to, rest));
        for Piece { from, to, lines: [(h0, h1), (g0, g1)] } in pieces.drain(1..).rev() {
            // The best goal that is reached within this piece or after it, if `hold` does not limit it.
            let (hold, best) = if h1 > h0 || from == to {
                ((h1, h0), rest)
            } else {
                // A falling `hold` is least at the instant at which the goal is reached.
                let meeting = if g1 > g0 { meeting((h0, h1), (g0, g1)) } else { f64::NEG_INFINITY };
                ((f64::INFINITY, f64::INFINITY), meeting.max(h1.min(rest)))
            };
            let piece = Piece { from: to, to: from, lines: [(g1, g0), hold, (best, best)] };
            piece.push(&mut result, |[goal, hold, best]| goal.max(hold.min(best)));
            rest = result[result.len() - 1].1;
            if from != to {
                // The instants after this one are reached only through the value of `hold` right after it.
                rest = rest.min(h0);
            }
        }
        result.reverse();
        Self(result)
    }
}

/// Returns the greatest value of the minimum of a falling and a rising line.
fn meeting((h0, h1): (f64, f64), (g0, g1): (f64, f64)) -> f64 {
    if h0 > g0 && g1 > h1 {
        let share = (h0 - g0) / ((h0 - g0) + (g1 - h1));
        return g0 + (g1 - g0) * share;
    }
    h0.min(g0).max(h1.min(g1))
}
