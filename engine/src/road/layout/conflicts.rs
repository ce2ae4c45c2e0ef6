//! Which lanes of an intersection are in each other's way, and where.

use super::LanePlan;
use crate::road::curve::Curve;

/// Two lanes are in each other's way where their middles are nearer than this share of a lane's width: two cars of
/// 1.8 m in lanes of 3.5 m then have 0.65 m between them.
const CLOSE: f64 = 0.7;
/// Metres between the places at which a lane is looked at.
const STEP: f64 = 0.25;
/// To how many metres the ends of a conflict are found.
const EXACT: f64 = 1e-3;

/// A conflict of a lane, as an element knows it.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::road) struct ConflictPlan {
    /// The index of the other lane.
    pub with: usize,
    /// From where to where along the lane they are too close.
    pub span: (f64, f64),
    pub gives_way: bool,
}

/// Fills in the conflicts of all lanes: with those that cross them or join them. Lanes that part from one another,
/// or follow one another, are in no conflict. `gives_way` says whether the first of two lanes does.
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
            let (one, other) = (lanes[a].curve, lanes[b].curve);
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

/// Whether two lanes begin at the same place or one leads to the other.
fn related(lanes: &[LanePlan], a: usize, b: usize) -> bool {
    let (one, other) = (&lanes[a], &lanes[b]);
    let fork = one.from.is_some() && one.from == other.from;
    let parted = lanes.iter().any(|lane| lane.successors.contains(&a) && lane.successors.contains(&b));
    fork || parted || one.successors.contains(&b) || other.successors.contains(&a)
}

/// From where to where along a curve it is too close to another: the least stretch that holds all such places.
fn span(curve: &Curve, other: &Curve, close: f64) -> Option<(f64, f64)> {
    let distance = |s: f64| {
        let point = curve.point(s);
        (other.point(other.nearest(point)) - point).norm()
    };
    let steps = (curve.length() / STEP).ceil() as usize;
    let place = |i: usize| curve.length() * i as f64 / steps as f64;
    let is_close = |i: &usize| distance(place(*i)) < close;
    let first = (0..=steps).find(is_close)?;
    let last = (0..=steps).rev().find(is_close)?;
    // Between a place that is clear and one that is close lies the end.
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
