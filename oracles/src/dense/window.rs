//! The greatest value of a piecewise linear function in a sliding window.
//!
//! A monotone wedge keeps the breakpoints in sight that may still become the greatest (D. Lemire, "Streaming
//! maximum-minimum filter using no more than three comparisons per element", 2006).

use super::piece::{Piece, between};
use std::collections::VecDeque;

/// The times that are in sight from an instant, counted from this instant.
#[derive(Clone, Copy)]
pub(super) struct Window {
    pub start: f64,
    pub end: f64,
    /// `true` if the window includes its last instant.
    pub is_closed: bool,
}

impl Window {
    pub fn closed(start: f64, end: f64) -> Self {
        Self { start, end, is_closed: true }
    }

    pub fn before(end: f64) -> Self {
        Self { start: 0.0, end, is_closed: false }
    }
}

/// A moving window, and the breakpoints that it has reached.
pub(super) struct Sliding<'w> {
    points: &'w [(f64, f64)],
    window: Window,
    wedge: VecDeque<usize>,
    entered: usize,
    left: usize,
}

impl<'w> Sliding<'w> {
    /// Makes a window over the breakpoints `points` that stands just before time 0.
    pub fn new(points: &'w [(f64, f64)], window: Window) -> Self {
        let mut sliding = Self { points, window, wedge: VecDeque::new(), entered: 0, left: 0 };
        sliding.enter(points.partition_point(|point| point.0 - window.end < 0.0));
        sliding.leave(points.partition_point(|point| point.0 - window.start < 0.0));
        sliding
    }

    /// Moves the window past the breakpoints that an end of the window meets at the instant `now`. If these breakpoints
    /// form a jump, returns the greatest value in the window at this instant, and the limit from above.
    pub fn pass(&mut self, now: f64) -> Option<[f64; 2]> {
        let Window { start, end, is_closed } = self.window;
        let due = |from: usize, by: f64| self.points[from..].iter().take_while(|point| point.0 - by <= now).count();
        let (entering, leaving) = (due(self.entered, end), due(self.left, start));
        let [entered, left] = [self.entered + entering, self.left + leaving];
        if entering <= 1 && leaving <= 1 {
            self.enter(entered);
            self.leave(left);
            return None;
        }
        let mut value = f64::NEG_INFINITY;
        if entering == 0 {
            value = value.max(self.at(self.entered, now + end));
        }
        if leaving == 0 {
            value = value.max(self.at(self.left, now + start));
        }
        // The limit from below comes into sight before the value. They leave the sight in the same order.
        let last = if is_closed { entering / 2 } else { 0 };
        self.enter(entered.min(self.entered + last + 1));
        self.leave(self.left + leaving / 2);
        value = value.max(self.highest());
        self.enter(entered);
        self.leave(left);
        Some([value, self.value(now)])
    }

    /// Returns the greatest value in the window at the instant `now`, after [`pass`](Self::pass) has moved the window
    /// past the breakpoints at its ends.
    pub fn value(&self, now: f64) -> f64 {
        let Window { start, end, .. } = self.window;
        self.highest().max(self.at(self.left, now + start)).max(self.at(self.entered, now + end))
    }

    /// Returns the values at both ends of the window and the greatest value inside the window, until the next
    /// breakpoint or `needed`.
    pub fn piece(&self, from: f64, needed: f64) -> Piece<3> {
        let Window { start, end, .. } = self.window;
        let until = |next: usize, by: f64| self.points.get(next).map_or(needed, |point| point.0 - by);
        let to = needed.min(until(self.entered, end)).min(until(self.left, start));
        let first = (self.at(self.left, from + start), self.at(self.left, to + start));
        let last = (self.at(self.entered, from + end), self.at(self.entered, to + end));
        let inner = self.highest();
        Piece { from, to, lines: [first, last, (inner, inner)] }
    }

    fn enter(&mut self, until: usize) {
        while self.entered < until {
            while self.wedge.back().is_some_and(|i| self.points[*i].1 <= self.points[self.entered].1) {
                self.wedge.pop_back();
            }
            self.wedge.push_back(self.entered);
            self.entered += 1;
        }
    }

    fn leave(&mut self, until: usize) {
        self.left = until;
        while self.wedge.front().is_some_and(|i| *i < until) {
            self.wedge.pop_front();
        }
    }

    fn highest(&self) -> f64 {
        self.wedge.front().map_or(f64::NEG_INFINITY, |i| self.points[*i].1)
    }

    /// Returns the value at a time between breakpoint `next` and the breakpoint before it.
    fn at(&self, next: usize, time: f64) -> f64 {
        match (next.checked_sub(1), self.points.get(next)) {
            (Some(before), Some(point)) => between(self.points[before], *point, time),
            (None, Some(point)) => point.1,
            _ => self.points[self.points.len() - 1].1,
        }
    }
}
