//! T- and cross-intersections: arms at right angles. Every movement is a line or an arc between two arms.
//!
//! All lanes lead straight on if there is an opposite arm. Then the lane next to the centre line also turns left, and
//! the lane next to the kerb turns right. At the stem of a T, the left half of the lanes turns left and the right half
//! turns right; the middle lane of an odd number turns both ways. Every movement keeps its lane number.
//!
//! A car from the stem of a T gives way to the road that the stem ends at. Otherwise, a car that turns left gives way
//! to cars that come towards it, and every car gives way to cars from the right.

use super::conflicts::find_conflicts;
use super::{LanePlan, Layout, Mouth, STOP_LINE, arm, pose};
use crate::curve::Curve;
use crate::element::Profile;
use crate::geometry::wrapped;
use crate::lane::LaneKind;
use crate::strip::{Strip, Surface};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};
use std::ops::RangeInclusive;

pub(super) fn layout(arms: &[f64], corner: f64, profile: &Profile) -> Layout {
    let mut layout = Layout::default();
    for (from, heading) in arms.iter().enumerate() {
        for kind in [LaneKind::Straight, LaneKind::Left, LaneKind::Right] {
            if let Some(to) = target(arms, *heading, kind) {
                for number in numbers(arms, *heading, kind, profile.each_way()) {
                    layout.lanes.push(movement(*heading, kind, number, corner, profile, [from, to]));
                }
            }
        }
        pave(arms, *heading, corner, profile, &mut layout);
    }
    find_conflicts(&mut layout.lanes, profile.lane_width, |lane, other| gives_way(arms, lane, other));
    layout
}

fn gives_way(arms: &[f64], lane: &LanePlan, other: &LanePlan) -> bool {
    let heading = |lane: &LanePlan| lane.from.map_or(0.0, |mouth| arms[mouth.port]);
    let stem = |lane: &LanePlan| target(arms, heading(lane), LaneKind::Straight).is_none();
    let turned = wrapped(heading(other) - heading(lane));
    if stem(lane) || stem(other) {
        stem(lane)
    } else if turned.abs() > 0.75 * PI {
        lane.kind == LaneKind::Left && other.kind != LaneKind::Left
    } else {
        turned > 0.0
    }
}

/// Returns the arm that a movement leads to, if it starts at the arm with this heading.
fn target(arms: &[f64], heading: f64, kind: LaneKind) -> Option<usize> {
    let turned = match kind {
        LaneKind::Straight => PI,
        LaneKind::Left => -FRAC_PI_2,
        _ => FRAC_PI_2,
    };
    arms.iter().position(|arm| wrapped(arm - heading - turned).abs() < 0.1)
}

/// Returns the numbers of the lanes that make a movement.
fn numbers(arms: &[f64], heading: f64, kind: LaneKind, n: i32) -> RangeInclusive<i32> {
    let straight = target(arms, heading, LaneKind::Straight).is_some();
    match kind {
        LaneKind::Straight => 1..=n,
        LaneKind::Left if straight => 1..=1,
        LaneKind::Left => 1..=(n + 1) / 2,
        _ if straight => n..=n,
        _ => n / 2 + 1..=n,
    }
}

fn movement(heading: f64, kind: LaneKind, number: i32, corner: f64, profile: &Profile, ports: [usize; 2]) -> LanePlan {
    let reach = profile.half_width() + corner;
    let offset = profile.lane_offset(number);
    // Cars come in on the right of an arm: where y is positive, seen from the middle.
    let start = arm(heading).then(&pose(reach, offset, PI));
    let turn = |radius: f64, side: f64| Curve::new(start, side / radius, FRAC_PI_2 * radius);
    let curve = match kind {
        LaneKind::Left => turn(reach + offset, 1.0),
        LaneKind::Right => turn(reach - offset, -1.0),
        _ => Curve::new(start, 0.0, 2.0 * reach),
    };
    let [from, to] = ports.map(|port| Some(Mouth { port, number }));
    LanePlan { from, to, ..LanePlan::new(kind, number, curve) }
}

/// Adds the ground of an arm, and the kerb from the side of its incoming lanes to the next arm on the right.
fn pave(arms: &[f64], heading: f64, corner: f64, profile: &Profile, layout: &mut Layout) {
    let half = profile.half_width();
    let reach = half + corner;
    let frame = arm(heading);
    let inward = Curve::new(frame.then(&pose(reach, 0.0, PI)), 0.0, reach + half);
    layout.strips.push(Strip::new(Surface::Carriageway, inward, -half, half));
    let edge = frame.then(&pose(reach, half, PI));
    let straight = target(arms, heading, LaneKind::Straight).is_some();
    if target(arms, heading, LaneKind::Right).is_some() {
        let kerb = Curve::new(edge, -1.0 / corner, FRAC_PI_2 * corner);
        // The strip reaches a little beyond the point where the edges of the two roads would meet.
        layout.strips.push(Strip::new(Surface::Carriageway, kerb, 0.0, (SQRT_2 - 1.0) * corner + 0.1));
        layout.add_kerb(kerb, profile);
    } else if straight {
        layout.add_kerb(Curve::new(edge, 0.0, 2.0 * reach), profile);
    }
    // At a T, cars on the through road go first.
    let through = straight && arms.len() == 3;
    if !through {
        let across = Curve::new(frame.then(&pose(reach - 0.5 * STOP_LINE, 0.2, FRAC_PI_2)), 0.0, half - 0.4);
        let (right, left) = (-0.5 * STOP_LINE, 0.5 * STOP_LINE);
        layout.strips.push(match arms.len() {
            3 => Strip::new(Surface::GiveWayLine, across, right, left).dashed(0.5, 0.25),
            _ => Strip::new(Surface::StopLine, across, right, left),
        });
    }
}
