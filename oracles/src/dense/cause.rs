//! Finds the cause of a formula's robustness in dense time.
//!
//! The worth of an operator equals the worth of an operand at an instant in sight. So the search goes from the formula
//! down to a comparison. It takes the first instant with the nearest worth: lines were followed to their crossings, so
//! rounding leaves no two numbers exactly the same. If an operand is constant for a while, it takes an instant in the
//! middle: at the ends, another part may have the same worth by chance. If an operand jumps, the side of the instant
//! matters, and time bounds are rounded, too. So the search looks from the instant itself or from a tiny distance (a
//! hair) before or after it. Instants that are much nearer to each other than a hair are the same instant.

use super::piece::between;
use super::unit::Unit;
use super::wave::Wave;
use crate::{Connective, Formula, Interval, Modality, Sequence};

/// The relative rounding of worths and times. It is far more than the rounding of a formula's sums, and far less than
/// any duration or worth that matters.
const ROUNDING: f64 = 1e-12;

/// Returns the small distance beside an instant from which the search looks, on a trace that ends at `end` units.
pub(super) fn hair(end: f64) -> f64 {
    ROUNDING * end.max(1.0)
}

/// Returns the distance below which two instants are the same, on a trace that ends at `end` units.
fn same(end: f64) -> f64 {
    0.25 * hair(end)
}

/// The side of an instant: right before it, the instant itself, or right after it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Before,
    At,
    After,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Moment {
    time: f64,
    side: Side,
}

impl Moment {
    fn before(time: f64) -> Self {
        Self { time, side: Side::Before }
    }

    fn at(time: f64) -> Self {
        Self { time, side: Side::At }
    }

    fn after(time: f64) -> Self {
        Self { time, side: Side::After }
    }
}

/// A part of the formula, the moment at which it counts, and its worth at this moment.
struct Step<'f> {
    part: &'f Formula,
    moment: Moment,
    worth: f64,
}

/// The parts of a formula, each with its worth over time.
pub(super) struct Causes<'f> {
    /// The time of the last sample of the trace, in units.
    pub end: f64,
    pub unit: Unit,
    pub parts: Vec<(&'f Formula, Wave)>,
}

impl<'f> Causes<'f> {
    /// Returns the part of a formula that gives the formula the robustness `worth` at time 0, and the time at which the
    /// part counts.
    pub fn of(&self, formula: &'f Formula, worth: f64) -> (&'f Formula, f64) {
        let mut step = Step { part: formula, moment: Moment::at(0.0), worth };
        while let Some(next) = self.after(&step) {
            step = next;
        }
        (step.part, step.moment.time)
    }

    /// Returns the operand that gives a part of the formula its worth, and the moment at which the operand counts.
    /// `None` if the part has no operands or sees none.
    fn after(&self, step: &Step<'f>) -> Option<Step<'f>> {
        let Step { moment, worth, .. } = *step;
        match step.part {
            Formula::Constant(_) | Formula::Flag(_) | Formula::Compare(..) => None,
            Formula::Not(inner) => Some(Step { part: inner, moment, worth: -worth }),
            Formula::Join(connective, left, right) => {
                let left_worth = if *connective == Connective::Implies { -worth } else { worth };
                let off = |part: &Formula, worth: f64| distance(self.reader(part).at(moment), worth);
                let is_left = off(left, left_worth) <= off(right, worth);
                let (part, worth) = if is_left { (left, left_worth) } else { (right, worth) };
                Some(Step { part, moment, worth })
            }
            Formula::Modal(modality, interval, inner) => {
                let view = View {
                    past: matches!(modality, Modality::Historically | Modality::Once),
                    sign: if matches!(modality, Modality::Always | Modality::Historically) { -1.0 } else { 1.0 },
                    ..self.view(*interval, moment)
                };
                let (_, moment) = view.responsible(None, self.reader(inner), worth)?;
                Some(Step { part: inner, moment, worth })
            }
            Formula::Sequence(sequence, interval, hold, goal) => {
                let view = View {
                    past: *sequence == Sequence::Since,
                    sign: if *sequence == Sequence::Release { -1.0 } else { 1.0 },
                    ..self.view(*interval, moment)
                };
                let (is_goal, moment) = view.responsible(Some(self.reader(hold)), self.reader(goal), worth)?;
                Some(Step { part: if is_goal { goal } else { hold }, moment, worth })
            }
        }
    }

    fn reader(&self, part: &Formula) -> Reader<'_> {
        let kept = self.parts.iter().find(|(kept, _)| std::ptr::eq(*kept, part));
        let points = kept.expect("every part was kept").1.points();
        Reader { points, same: same(self.end), place: 0, is_plain: is_plain(part) }
    }

    /// Returns the time from which the search looks, which is a hair beside the moment or at the moment.
    fn eye(&self, moment: Moment) -> f64 {
        let hair = hair(self.end);
        let aside = match moment.side {
            Side::Before => -hair,
            Side::At => 0.0,
            Side::After => hair,
        };
        (moment.time + aside).clamp(0.0, self.end)
    }

    fn view(&self, interval: Interval, moment: Moment) -> View {
        View {
            interval: self.unit.of_interval(interval),
            moment,
            eye: self.eye(moment),
            end: self.end,
            past: false,
            sign: 1.0,
        }
    }
}

/// The sight of a temporal operator at a moment, expressed by its counterpart that takes maxima.
struct View {
    interval: Interval,
    moment: Moment,
    eye: f64,
    end: f64,
    past: bool,
    /// The factor, 1 or -1, that turns a minimum over time into a maximum.
    sign: f64,
}

impl View {
    /// Returns the moment at which an operand gives the operator its worth. The boolean is `true` if the worth comes
    /// from the goal, and `false` if it comes from the operand that has to hold before.
    fn responsible(&self, hold: Option<Reader>, goal: Reader, worth: f64) -> Option<(bool, Moment)> {
        let [from, to] = self.window();
        if from > to {
            return None;
        }
        let instants = self.instants([hold.as_ref(), Some(&goal)], [from, to]);
        let mut scan = Scan {
            window: [from, to],
            hair: hair(self.end),
            same: same(self.end),
            goal,
            hold,
            sign: self.sign,
            weakest: Least { worth: f64::INFINITY, moment: self.moment, is_firm: false },
            nearest: Nearest::to(self.sign * worth),
        };
        for (place, now) in instants.iter().enumerate() {
            scan.be(Moment::at(*now));
            let Some(next) = instants.get(place + 1) else { break };
            let ends = if self.past {
                [Moment::before(*now), Moment::after(*next)]
            } else {
                [Moment::after(*now), Moment::before(*next)]
            };
            scan.follow(ends);
        }
        let (is_goal, found) = scan.nearest.found?;
        Some((is_goal, self.placed(found)))
    }

    /// Returns the first and the last instant of the trace at which the operator looks.
    fn window(&self) -> [f64; 2] {
        let [first, last] = self.edges();
        [first.min(last).max(0.0), first.max(last).min(self.end)]
    }

    /// Returns the nearer and the farther edge of the window.
    fn edges(&self) -> [f64; 2] {
        let Interval { start, end, .. } = self.interval;
        [start, end].map(|by| {
            let edge = if self.past { self.eye - by } else { self.eye + by };
            let ends = [0.0, self.end];
            ends.into_iter().find(|end| (edge - end).abs() <= same(self.end)).unwrap_or(edge)
        })
    }

    /// Returns the instants between which the operands are straight, from here to the far edge of the window, the
    /// nearest first.
    fn instants(&self, operands: [Option<&Reader>; 2], [from, to]: [f64; 2]) -> Vec<f64> {
        let [first, last] = [from.min(self.eye), to.max(self.eye)];
        let mut instants = vec![self.eye, from, to];
        for reader in operands.into_iter().flatten() {
            let points = reader.points.iter().map(|point| point.0);
            instants.extend(points.filter(|time| first < *time && *time < last));
        }
        instants.sort_by(f64::total_cmp);
        instants.dedup_by(|later, earlier| *later - *earlier <= same(self.end));
        if self.past {
            instants.reverse();
        }
        instants
    }

    /// Moves a moment that was found at an edge of the window, or at the eye, back to the moment beside which the
    /// search looks.
    fn placed(&self, found: Moment) -> Moment {
        let aside = self.eye - self.moment.time;
        let edge = self.eye == found.time || self.edges().contains(&found.time);
        if aside == 0.0 || !edge {
            return found;
        }
        Moment { time: (found.time - aside).max(0.0), side: self.moment.side }
    }
}

/// The least worth so far, and its moment. `is_firm` is `false` if another part may have the same worth there by
/// chance.
#[derive(Clone, Copy)]
struct Least {
    worth: f64,
    moment: Moment,
    is_firm: bool,
}

/// A search that moves away from the instant of an operator.
struct Scan<'w> {
    window: [f64; 2],
    /// The shortest duration. Anything shorter is only rounding.
    hair: f64,
    /// The distance below which two instants are the same.
    same: f64,
    goal: Reader<'w>,
    hold: Option<Reader<'w>>,
    sign: f64,
    /// The least worth of the operand that had to hold so far.
    weakest: Least,
    nearest: Nearest<(bool, Moment)>,
}

impl Scan<'_> {
    /// Returns the worth of the operand that has to hold, and the worth of the goal.
    fn worths(&mut self, moment: Moment) -> [f64; 2] {
        let hold = self.hold.as_mut().map_or(f64::INFINITY, |hold| self.sign * hold.at(moment));
        [hold, self.sign * self.goal.at(moment)]
    }

    /// Visits an instant during the search. The goal may be reached before the other operand has to hold here.
    fn be(&mut self, moment: Moment) {
        let [hold, goal] = self.worths(moment);
        self.reach(goal, moment, self.goal.is_plain);
        self.hold(hold, moment, self.is_plain());
    }

    /// Follows a straight piece from its beginning to its end.
    fn follow(&mut self, [near, far]: [Moment; 2]) {
        let ends = [near, far].map(|moment| self.worths(moment));
        let [[h0, g0], [h1, g1]] = ends;
        let hair = self.hair;
        let at = |share: f64| {
            let time = near.time + (far.time - near.time) * share;
            let end = [near, far].into_iter().find(|end| (time - end.time).abs() <= hair);
            end.unwrap_or(Moment::at(time))
        };
        // Up to this share of the piece, `hold` is above the goal.
        let meets = if g1 > h1 { (h0 - g0) / ((h0 - g0) + (g1 - h1)) } else { 1.0 };
        self.pass(ends[0], near);
        let [holds_still, goal_still] = [is_near(h0, h1), is_near(g0, g1)];
        let lasts = (far.time - near.time).abs() > 4.0 * hair;
        if holds_still && lasts {
            self.hold(h0, at(0.5), true);
        }
        if goal_still && lasts && (h0 > g0 || h0.min(h1) >= g0) {
            self.reach(g0, at(0.5 * meets), true);
        }
        // The greatest value of a piece is at its ends, or at the meeting of a falling `hold` and a rising goal.
        if !holds_still && !goal_still && h0 > g0 && g1 > h1 {
            let meeting = g0 + (g1 - g0) * meets;
            self.pass([meeting; 2], at(meets));
        }
        self.pass(ends[1], far);
    }

    fn pass(&mut self, [hold, goal]: [f64; 2], moment: Moment) {
        self.hold(hold, moment, self.is_plain());
        self.reach(goal, moment, self.goal.is_plain);
    }

    fn is_plain(&self) -> bool {
        self.hold.as_ref().is_none_or(|hold| hold.is_plain)
    }

    /// Passes a moment at which the operand has to hold.
    fn hold(&mut self, worth: f64, moment: Moment, is_firm: bool) {
        let Least { worth: least, is_firm: was_firm, .. } = self.weakest;
        if if is_near(worth, least) { is_firm && !was_firm } else { worth < least } {
            self.weakest = Least { worth, moment, is_firm };
        }
    }

    fn sees(&self, Moment { time, side }: Moment) -> bool {
        let [from, to] = self.window;
        let by = self.same;
        match side {
            Side::Before => from + by < time && time <= to + by,
            Side::At => from - by <= time && time <= to + by,
            Side::After => from - by <= time && time < to - by,
        }
    }

    /// Reaches the goal at a moment, if the moment is in the window.
    fn reach(&mut self, goal: f64, moment: Moment, is_firm: bool) {
        if self.sees(moment) {
            let Least { worth, moment: when, is_firm: held_firmly } = self.weakest;
            if goal <= worth {
                self.nearest.offer(goal, is_firm, (true, moment));
            } else {
                self.nearest.offer(worth, held_firmly, (false, when));
            }
        }
    }
}

/// The first offer whose worth is nearest to the sought worth, up to rounding. A firm offer is better than others.
struct Nearest<T> {
    sought: f64,
    distance: f64,
    is_firm: bool,
    found: Option<T>,
}

impl<T> Nearest<T> {
    fn to(sought: f64) -> Self {
        Self { sought, distance: f64::INFINITY, is_firm: false, found: None }
    }

    fn offer(&mut self, worth: f64, is_firm: bool, what: T) {
        let distance = distance(worth, self.sought);
        if distance < self.distance || distance == self.distance && is_firm && !self.is_firm {
            *self = Self { distance, is_firm, found: Some(what), ..*self };
        }
    }
}

/// Returns the distance of two worths, or 0 if they are the same up to rounding.
fn distance(worth: f64, other: f64) -> f64 {
    if is_near(worth, other) { 0.0 } else { (worth - other).abs() }
}

/// Returns `true` if two worths are the same up to rounding.
fn is_near(worth: f64, other: f64) -> bool {
    worth == other || (worth - other).abs() <= ROUNDING * other.abs().clamp(1.0, f64::MAX)
}

/// Returns `true` if only one part of the formula can be the cause of its worth.
fn is_plain(formula: &Formula) -> bool {
    match formula {
        Formula::Not(inner) => is_plain(inner),
        Formula::Join(..) | Formula::Modal(..) | Formula::Sequence(..) => false,
        _ => true,
    }
}

/// Reads a function of time at one moment after another. Neighbouring moments are found quickly.
struct Reader<'w> {
    points: &'w [(f64, f64)],
    /// The distance below which two instants are the same.
    same: f64,
    place: usize,
    is_plain: bool,
}

impl Reader<'_> {
    fn at(&mut self, Moment { time, side }: Moment) -> f64 {
        let [from, to] = [time - self.same, time + self.same];
        let is_before = |point: &(f64, f64)| if side == Side::After { point.0 <= to } else { point.0 < from };
        while self.points.get(self.place).is_some_and(is_before) {
            self.place += 1;
        }
        while self.place > 0 && !is_before(&self.points[self.place - 1]) {
            self.place -= 1;
        }
        let here = self.points[self.place..].iter().take_while(|point| point.0 <= to).count();
        if side == Side::At && here > 0 {
            return self.points[self.place + here / 2].1;
        }
        match (self.place.checked_sub(1).map(|before| self.points[before]), self.points.get(self.place)) {
            (Some(before), Some(next)) => between(before, *next, time),
            (Some(point), None) => point.1,
            (None, _) => self.points[0].1,
        }
    }
}
