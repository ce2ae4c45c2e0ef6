//! Straight and curved roads.

use super::{LINE, LanePlan, Layout, Mouth, Port};
use crate::curve::Curve;
use crate::element::{Profile, Segment};
use crate::geometry::Pose;
use crate::geometry::wrapped;
use crate::lane::LaneKind;
use crate::strip::{Strip, Surface};
use std::f64::consts::PI;

/// The width of a zebra crossing, in metres along the road.
pub(crate) const ZEBRA: f64 = 4.0;
/// The width of a crossing's stripes and of the gaps between them, in metres.
const STRIPE: f64 = 0.5;
/// The length in metres before and after a zebra crossing that has no other markings.
const BEFORE_ZEBRA: f64 = 1.0;
/// The lengths of dash and gap in metres of the lines between lanes.
const DASH: (f64, f64) = (3.0, 6.0);
/// The allowed lengths of a road, in metres.
const LENGTHS: std::ops::RangeInclusive<f64> = 0.1..=100_000.0;
/// The largest radius in metres. Beyond it, an arc is practically a line.
const LARGEST_RADIUS: f64 = 100_000.0;
/// The largest angle in radians that a road may turn by, so that no road meets itself.
const LARGEST_ANGLE: f64 = 1.5 * PI;

pub(super) fn problem(road: &Segment, profile: &Profile) -> Option<String> {
    if !LENGTHS.contains(&road.length) {
        let (least, most) = LENGTHS.into_inner();
        return Some(format!("has a length of {} m, expected {least} to {most} m", road.length));
    }
    if road.curvature != 0.0 {
        let (radius, angle) = (1.0 / road.curvature.abs(), (road.length * road.curvature).abs());
        let least = profile.half_width() + profile.sidewalk;
        if !(radius > least && radius <= LARGEST_RADIUS) {
            return Some(format!(
                "bends with a radius of {radius} m, expected more than {least} m, its width on either side, \
                 and at most {LARGEST_RADIUS} m"
            ));
        }
        if angle > LARGEST_ANGLE {
            let (degrees, most) = (angle.to_degrees(), LARGEST_ANGLE.to_degrees());
            return Some(format!("turns by {degrees:.1} degrees, expected at most {most} degrees"));
        }
    }
    let mut end = 0.0;
    for at in road.zebras() {
        let (from, to) = (at - 0.5 * ZEBRA, at + 0.5 * ZEBRA);
        if !(from >= end && to <= road.length) {
            return Some(format!(
                "has a zebra crossing at {at} m that needs {ZEBRA} m of the road's {} m for itself",
                road.length
            ));
        }
        end = to;
    }
    None
}

pub(super) fn ports(road: &Segment) -> [Port; 2] {
    let centre = road.centre_line();
    let start = Pose { heading: wrapped(centre.start().heading + PI), ..centre.start() };
    [Port { name: "one", pose: start }, Port { name: "two", pose: centre.end() }]
}

pub(super) fn layout(road: &Segment, profile: &Profile) -> Layout {
    let centre = road.centre_line();
    let mut layout = Layout::default();
    let n = profile.each_way();
    for forward in [true, false] {
        for number in 1..=n {
            let offset = profile.lane_offset(number);
            let curve = if forward { centre.offset(-offset) } else { centre.offset(offset).reversed() };
            let mouth = |port| Some(Mouth { port, number });
            let index = layout.lanes.len();
            layout.lanes.push(LanePlan {
                from: mouth(if forward { 0 } else { 1 }),
                to: mouth(if forward { 1 } else { 0 }),
                left: (number > 1).then(|| index - 1),
                right: (number < n).then_some(index + 1),
                ..LanePlan::new(LaneKind::Road, if forward { number } else { -number }, curve)
            });
        }
    }
    let half = profile.half_width();
    layout.strips.push(Strip::new(Surface::Carriageway, centre, -half, half));
    layout.add_kerb(centre.offset(-half), profile);
    layout.add_kerb(centre.offset(half).reversed(), profile);
    for stretch in between_zebras(road) {
        paint_lines(&centre.piece(stretch.0, stretch.1), profile, &mut layout.strips);
    }
    for at in road.zebras() {
        paint_zebra(&centre.piece(at - 0.5 * ZEBRA, at + 0.5 * ZEBRA), half, &mut layout.strips);
    }
    layout
}

/// Returns the stretches of a road that have lines between their lanes.
fn between_zebras(road: &Segment) -> Vec<(f64, f64)> {
    let clear = 0.5 * ZEBRA + BEFORE_ZEBRA;
    let mut stretches = Vec::new();
    let mut from = 0.0;
    for at in road.zebras() {
        stretches.push((from, at - clear));
        from = at + clear;
    }
    stretches.push((from, road.length));
    stretches.retain(|(from, to)| to > from);
    stretches
}

fn paint_lines(centre: &Curve, profile: &Profile, strips: &mut Vec<Strip>) {
    let line = |surface, offset: f64| Strip::new(surface, *centre, offset - 0.5 * LINE, offset + 0.5 * LINE);
    let n = profile.each_way();
    if n == 1 {
        strips.push(line(Surface::CentreLine, 0.0).dashed(DASH.0, DASH.1));
    } else {
        // Two lines with a line's width between them: cars must not cross them.
        strips.extend([-LINE, LINE].map(|offset| line(Surface::CentreLine, offset)));
    }
    for number in 1..n {
        let offset = f64::from(number) * profile.lane_width;
        strips.extend([-offset, offset].map(|offset| line(Surface::LaneLine, offset).dashed(DASH.0, DASH.1)));
    }
}

/// Paints as many stripes along the road as there is room for, with equal margins at the kerbs.
fn paint_zebra(stretch: &Curve, half: f64, strips: &mut Vec<Strip>) {
    let count = ((2.0 * half - STRIPE) / (2.0 * STRIPE)) as usize + 1;
    let first = -(count as f64 - 0.5) * STRIPE;
    for i in 0..count {
        let right = first + 2.0 * i as f64 * STRIPE;
        strips.push(Strip::new(Surface::Zebra, *stretch, right, right + STRIPE));
    }
}
