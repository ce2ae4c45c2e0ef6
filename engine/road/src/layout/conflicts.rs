//! Finds the lanes of an intersection that are in each other's way, and the places where they are.

use super::LanePlan;
use crate::centreline::Centreline;

/// The share of a lane's width below which the middles of two lanes are too close: two cars of 1.8 m in lanes of 3.5 m
/// then have 0.65 m between them.
pub(crate) const CLOSE: f64 = 0.7;
/// The distance in metres between the places at which a lane is examined.
const STEP: f64 = 0.25;
/// The exactness in metres of the ends of a conflict.
const EXACT: f64 = 1e-3;

/// A conflict of a lane, in the coordinates of its element.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ConflictPlan {
    /// The index of the other lane, with which the lane is in conflict.
    pub with: usize,
    /// The beginning and the end of the stretch that is too close to the other lane, in metres along the lane.
    pub span: (f64, f64),
    pub gives_way: bool,
}

/// Finds the conflicts of all lanes: lanes that cross or join. Lanes that part from one another, or follow one another,
/// are in no conflict. `gives_way` returns `true` if its first lane gives way to its second lane.
pub(super) fn find_conflicts(
    lanes: &mut [LanePlan],
    lane_width: f64,
    gives_way: impl Fn(&LanePlan, &LanePlan) -> bool,
) {
    let close = CLOSE * lane_width;
    for b in 1..lanes.len() {
        for a in 0..b {
            if related(lanes, a, b) {
                continue;
            }
            let (one, other) = (Centreline::from(lanes[a].curve), Centreline::from(lanes[b].curve));
            if !one.bounds().grown(close).meets(&other.bounds()) {
                continue;
            }
            if let (Some(span), Some(other_span)) = (span(&one, &other, close), span(&other, &one, close)) {
                let rules = [gives_way(&lanes[a], &lanes[b]), gives_way(&lanes[b], &lanes[a])];
                lanes[a].conflicts.push(ConflictPlan { with: b, span, gives_way: rules[0] });
                lanes[b].conflicts.push(ConflictPlan { with: a, span: other_span, gives_way: rules[1] });
            }
        }
    }
}

/// Returns `true` if two lanes begin at the same place or one lane leads to the other.
fn related(lanes: &[LanePlan], a: usize, b: usize) -> bool {
    let (one, other) = (&lanes[a], &lanes[b]);
    let fork = one.from.is_some() && one.from == other.from;
    let parted = lanes.iter().any(|lane| lane.successors.contains(&a) && lane.successors.contains(&b));
    fork || parted || one.successors.contains(&b) || other.successors.contains(&a)
}

/// Returns the shortest stretch of a line that contains all places that are too close to another line.
pub(crate) fn span(curve: &Centreline, other: &Centreline, close: f64) -> Option<(f64, f64)> {
    let distance = |s: f64| {
        let point = curve.point(s);
        (other.point(other.nearest(point)) - point).norm()
    };
    let steps = (curve.length() / STEP).ceil() as usize;
    let place = |i: usize| curve.length() * i as f64 / steps as f64;
    let is_close = |i: &usize| distance(place(*i)) < close;
    let first = (0..=steps).find(is_close)?;
    let last = (0..=steps).rev().find(is_close)?;
    // The end lies between a place that is far enough and a place that is too close.
    let end = |mut clear: f64, mut near: f64| {
        while (clear - near).abs() > EXACT {
            let middle = 0.5 * (clear + near);
            *(if distance(middle) < close { &mut near } else { &mut clear }) = middle;
        }
        clear
    };
    let from = if first == 0 { 0.0 } else { end(place(first - 1), place(first)) };
    let to = if last == steps { curve.length() } else { end(place(last + 1), place(last)) };
    Some((from, to))
}
