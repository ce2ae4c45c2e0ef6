//! Piecewise linear functions of time, and what operators make of them.
//!
//! The algorithms are those of Donzé, Ferrère and Maler ("Efficient robust monitoring for STL", CAV 2013): maxima over
//! a moving window by a monotone wedge of breakpoints beside the values at the window's two ends, and `until` segment by
//! segment from the end. All take time linear in the number of breakpoints. Where a function jumps it has a value of its
//! own beside the limits on both sides, so that windows are closed as they are written.

use super::piece::{Piece, between, push};
use super::window::{Sliding, Window};

/// How far beyond its end a function may be asked because of rounded sums of time bounds, relative to that time.
pub(super) const TOLERANCE: f64 = 1e-9;

/// A piecewise linear function from time 0 on, as its breakpoints. Where it jumps three follow at one instant: the limit
/// from below, the value, and the limit from above; at its beginning and end the missing limit is the value. It may be
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

    /// The function up to an instant.
    pub fn cut(mut self, end: f64) -> Self {
        let within = self.0.partition_point(|point| point.0 < end);
        if within < self.0.len() {
            let [below, value, _] = self.around(within, end);
            self.0.truncate(within);
            [below, value, value].into_iter().for_each(|value| push(&mut self.0, (end, value)));
        }
        self
    }

    /// The function from an instant on, counted from there.
    pub fn after(&self, time: f64) -> Self {
        let from = self.0.partition_point(|point| point.0 < time);
        let [_, value, above] = self.around(from, time);
        let later = self.0.partition_point(|point| point.0 <= time);
        let mut points = Vec::with_capacity(self.0.len() - later + 3);
        [value, value, above].into_iter().for_each(|value| push(&mut points, (0.0, value)));
        points.extend(self.0[later..].iter().map(|point| (point.0 - time, point.1)));
        Self(points)
    }

    /// The function and, after its end, another one, of whose beginning only what comes right after it is left.
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

    /// The limit from below, the value and the limit from above at an instant, before which there are so many breakpoints.
    fn around(&self, before: usize, time: f64) -> [f64; 3] {
        let here = self.0[before..].iter().take_while(|point| point.0 <= time).count();
        if here > 0 {
            return [0, here / 2, here - 1].map(|place| self.0[before + place].1);
        }
        let next = self.0[before.min(self.0.len() - 1)];
        [before.checked_sub(1).map_or(next.1, |last| between(self.0[last], next, time)); 3]
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
        self.together(other, |Piece { to, lines: [a, b], .. }| push(&mut result, (to, a.1 + b.1)));
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

    /// The pieces over which two functions are both linear, before them the instant 0. Where one jumps there are two that
    /// take no time, from the limit from below to the value and on to the limit from above.
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

    /// The time of breakpoint `i`, of which there may be none.
    fn time(&self, i: usize) -> f64 {
        self.0.get(i).map_or(f64::INFINITY, |point| point.0)
    }

    /// Goes on from breakpoint `i` to the last at this instant, and tells what the function is around it.
    fn leap(&self, i: &mut usize, time: f64) -> [f64; 3] {
        let around = self.around(*i + usize::from(self.0[*i].0 < time), time);
        while self.time(*i + 1) <= time {
            *i += 1;
        }
        around
    }

    /// The values at two instants of the piece that begins with breakpoint `i`.
    fn line(&self, i: usize, from: f64, to: f64) -> (f64, f64) {
        let first = self.0[i];
        match self.0.get(i + 1) {
            None => (first.1, first.1),
            Some(second) => (between(first, *second, from), between(first, *second, to)),
        }
    }

    /// The greatest value over a window, seen from the instants from 0 to `needed`; beyond the end it is `outside`.
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

    /// The greatest value from each instant on, that beyond the end included.
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

    /// What `hold until goal` is worth at each instant, however late the goal; beyond the end it is `outside`.
    pub fn until(hold: &Self, goal: &Self, outside: f64) -> Self {
        let mut pieces = Vec::with_capacity(hold.0.len() + goal.0.len());
        hold.together(goal, |piece| pieces.push(piece));
        let mut result = Vec::with_capacity(pieces.len());
        let Piece { to, lines: [hold, goal], .. } = pieces[pieces.len() - 1];
        let mut rest = goal.1.max(hold.1.min(outside));
        result.push((to, rest));
        for Piece { from, to, lines: [(h0, h1), (g0, g1)] } in pieces.drain(1..).rev() {
            // The best goal that is reached within this piece or after it, as far as `hold` is not what limits it.
            let (hold, best) = if h1 > h0 || from == to {
                ((h1, h0), rest)
            } else {
                // `hold` is least where the goal is reached.
                let meeting = if g1 > g0 { meeting((h0, h1), (g0, g1)) } else { f64::NEG_INFINITY };
                ((f64::INFINITY, f64::INFINITY), meeting.max(h1.min(rest)))
            };
            let piece = Piece { from: to, to: from, lines: [(g1, g0), hold, (best, best)] };
            piece.push(&mut result, |[goal, hold, best]| goal.max(hold.min(best)));
            rest = result[result.len() - 1].1;
            if from != to {
                // What comes after an instant is reached only by way of what `hold` is right after it.
                rest = rest.min(h0);
            }
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
