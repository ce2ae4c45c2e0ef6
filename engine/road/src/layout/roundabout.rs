//! Roundabouts: rings of lanes. Cars enter and leave along arcs that touch the rings.
//!
//! Lanes are numbered from the inside, as on roads, and keep their number: lane 1 leads to the inner ring lane and
//! back, across the outer ones. The arcs of an entry have a common centre. Its distance from the middle of the ring is
//! the radius of an arc plus the radius of the ring lane, so that all arcs touch their ring lanes at one angle.
//!
//! A car that enters gives way to all others. A car that leaves from an inner lane gives way to cars on outer lanes.

use super::conflicts::find_conflicts;
use super::{KERB, LINE, LanePlan, Layout, Mouth, STOP_LINE, arm, pose};
use crate::curve::Curve;
use crate::element::{Profile, Ring};
use crate::lane::LaneKind;
use crate::strip::{Strip, Surface};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::RangeInclusive;

const ARMS: RangeInclusive<i32> = 3..=8;
/// The smallest angle in radians between an entry and the next exit.
const BETWEEN: f64 = 0.05;

/// Returns the headings of the arms, clockwise from the east.
pub(super) fn headings(arms: i32) -> impl Iterator<Item = f64> {
    (0..arms).map(move |arm| -TAU * f64::from(arm) / f64::from(arms))
}

/// The measures from which everything else follows.
struct Measures {
    /// The number of ring lanes.
    n: i32,
    /// The distance from the middle of the ring to the kerb around it.
    outer: f64,
    /// The distance from the middle at which the arcs of an entry begin, and the offset of their centre to the right.
    centre: (f64, f64),
    /// The angle, seen from the middle, between an arm and the points where the arcs of the arm touch the ring.
    touch: f64,
}

fn measures(ring: &Ring, profile: &Profile) -> Measures {
    let outer = ring.island + profile.half_width();
    let aside = profile.half_width() + ring.entry;
    let apart = outer + ring.entry;
    let out = (apart * apart - aside * aside).sqrt();
    Measures { n: profile.each_way(), outer, centre: (out, aside), touch: libm::atan2(aside, out) }
}

pub(super) fn problem(ring: &Ring, profile: &Profile) -> Option<String> {
    if !ARMS.contains(&ring.arms) {
        return Some(format!("has {} arms, expected {} to {}", ring.arms, ARMS.start(), ARMS.end()));
    }
    let aside = profile.half_width() + ring.entry;
    let widest = PI / f64::from(ring.arms) - 0.5 * BETWEEN;
    let least = (aside / libm::sin(widest) - aside).max(1.0);
    let fits = ring.island >= least && ring.island <= 1000.0;
    (!fits).then(|| {
        format!(
            "has an island with a radius of {} m, expected at least {:.2} m for {} arms of {} lanes, at most 1000 m",
            ring.island, least, ring.arms, profile.lanes
        )
    })
}

impl Ring {
    /// Returns the distance from the middle of the roundabout to its points.
    pub(crate) fn reach(&self, profile: &Profile) -> f64 {
        measures(self, profile).centre.0
    }
}

pub(super) fn layout(ring: &Ring, profile: &Profile) -> Layout {
    let measures = measures(ring, profile);
    let mut layout = Layout { lanes: lanes(ring, profile, &measures), strips: Vec::new() };
    let rank = |lane: &LanePlan| match lane.kind {
        LaneKind::Entry => 2,
        LaneKind::Exit => 1,
        _ => 0,
    };
    find_conflicts(&mut layout.lanes, profile.lane_width, |lane, other| rank(lane) > rank(other));
    pave(ring, profile, &measures, &mut layout);
    layout
}

/// Returns the index of a lane. Lanes are sorted by arm (clockwise), then by kind (four kinds), then by number.
fn index(arm: i32, kind: LaneKind, number: i32, m: &Measures) -> usize {
    let kind = match kind {
        LaneKind::Entry => 0,
        LaneKind::Exit => 1,
        LaneKind::RingAtArm => 2,
        _ => 3,
    };
    ((arm * 4 + kind) * m.n + number - 1) as usize
}

fn lanes(ring: &Ring, profile: &Profile, m: &Measures) -> Vec<LanePlan> {
    let mut lanes = Vec::new();
    for (k, heading) in (0..).zip(headings(ring.arms)) {
        // Traffic goes round counter-clockwise, but arms are counted clockwise.
        let next = (k + ring.arms - 1) % ring.arms;
        let kinds = [LaneKind::Entry, LaneKind::Exit, LaneKind::RingAtArm, LaneKind::Ring];
        for kind in kinds {
            for number in 1..=m.n {
                let mouth = Some(Mouth { port: k as usize, number });
                let after_entry = index(k, LaneKind::Ring, number, m);
                let plan = LanePlan::new(kind, number, curve(kind, heading, number, ring, profile, m));
                let beside = |there: bool, number| there.then(|| index(k, kind, number, m));
                let (left, right) = (beside(number > 1, number - 1), beside(number < m.n, number + 1));
                lanes.push(match kind {
                    LaneKind::Entry => LanePlan { from: mouth, successors: vec![after_entry], ..plan },
                    LaneKind::Exit => LanePlan { to: mouth, ..plan },
                    LaneKind::RingAtArm => LanePlan { successors: vec![after_entry], left, right, ..plan },
                    _ => {
                        let ahead = [LaneKind::RingAtArm, LaneKind::Exit].map(|kind| index(next, kind, number, m));
                        LanePlan { successors: ahead.into(), left, right, ..plan }
                    }
                });
            }
        }
    }
    lanes
}

/// Returns the curve of a lane: an entry, an exit, the ring past an arm, or the ring from an entry to the next exit.
fn curve(kind: LaneKind, heading: f64, number: i32, ring: &Ring, profile: &Profile, m: &Measures) -> Curve {
    let offset = profile.lane_offset(number);
    let radius = m.centre.1 - offset;
    let sweep = FRAC_PI_2 - m.touch;
    let around = |from: f64, angle: f64| {
        let radius = ring.island + offset;
        Curve::new(arm(from).then(&pose(radius, 0.0, FRAC_PI_2)), 1.0 / radius, radius * angle)
    };
    let begin = |offset: f64| arm(heading).then(&pose(m.centre.0, offset, PI));
    match kind {
        LaneKind::Entry => Curve::new(begin(offset), -1.0 / radius, radius * sweep),
        LaneKind::Exit => Curve::new(begin(-offset), 1.0 / radius, radius * sweep).reversed(),
        LaneKind::RingAtArm => around(heading - m.touch, 2.0 * m.touch),
        _ => around(heading + m.touch, TAU / f64::from(ring.arms) - 2.0 * m.touch),
    }
}

fn pave(ring: &Ring, profile: &Profile, m: &Measures, layout: &mut Layout) {
    let circle = |radius: f64| Curve::new(pose(radius, 0.0, FRAC_PI_2), 1.0 / radius, TAU * radius);
    let strips = &mut layout.strips;
    strips.push(Strip::new(Surface::Carriageway, circle(ring.island), ring.island - m.outer, 0.0));
    strips.push(Strip::new(Surface::Island, circle(ring.island), 0.0, ring.island));
    strips.push(Strip::new(Surface::Kerb, circle(ring.island), 0.0, KERB));
    for number in 1..m.n {
        let line = circle(ring.island + f64::from(number) * profile.lane_width);
        strips.push(Strip::new(Surface::LaneLine, line, -0.5 * LINE, 0.5 * LINE).dashed(1.5, 3.0));
    }
    // The left edges of an entry's and an exit's lanes separate at the arm and end at the ring, as follows from a
    // triangle: the middle of the ring, the centre of the arc, and the point where the edge meets the kerb of the ring.
    let half = profile.half_width();
    let (edge, apart) = (ring.entry + half, ring.entry + m.outer);
    let cosine = |opposite: f64, a: f64, b: f64| libm::acos((a * a + b * b - opposite * opposite) / (2.0 * a * b));
    let mouth = cosine(edge, m.outer, apart);
    let sweep = FRAC_PI_2 - m.touch;
    let splitter = sweep - cosine(m.outer, edge, apart);
    for heading in headings(ring.arms) {
        let frame = arm(heading);
        let entry = Curve::new(frame.then(&pose(m.centre.0, half, PI)), -1.0 / ring.entry, ring.entry * sweep);
        let exit =
            Curve::new(frame.then(&pose(m.centre.0, -half, PI)), 1.0 / ring.entry, ring.entry * sweep).reversed();
        let angle = TAU / f64::from(ring.arms) - 2.0 * m.touch;
        let between =
            Curve::new(arm(heading + m.touch).then(&pose(m.outer, 0.0, FRAC_PI_2)), 1.0 / m.outer, m.outer * angle);
        for kerb in [entry, exit] {
            layout.strips.push(Strip::new(Surface::Carriageway, kerb, 0.0, half));
        }
        for kerb in [entry, between, exit] {
            layout.add_kerb(kerb, profile);
        }
        for side in [1.0, -1.0] {
            let kerb = Curve::new(frame.then(&pose(m.centre.0, 0.0, PI)), -side / edge, edge * splitter);
            let (right, left) = if side > 0.0 { (0.0, KERB) } else { (-KERB, 0.0) };
            layout.strips.push(Strip::new(Surface::Kerb, kerb, right, left));
        }
        let start = arm(heading + m.touch - mouth).then(&pose(m.outer, 0.0, FRAC_PI_2));
        let line = Curve::new(start, 1.0 / m.outer, m.outer * mouth);
        layout.strips.push(Strip::new(Surface::GiveWayLine, line, 0.0, STOP_LINE).dashed(0.5, 0.5));
    }
}
