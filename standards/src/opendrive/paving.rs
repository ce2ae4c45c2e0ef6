//! The visible surfaces of a road of a file: its lanes by their types, and the lines between them.

use super::arcs::Beside;
use super::road::{Lane, LaneType, MarkType, Road};
use paracosm_engine::road::{Strip, Surface};

/// The greatest change of a width in metres along one strip.
const STEP: f64 = 0.05;
/// The width in metres of a line whose width the file does not say.
const LINE: f64 = 0.12;
/// The lengths of a dash and of a gap in metres.
const DASH: (f64, f64) = (3.0, 6.0);
/// The least width in metres of a surface.
const THINNEST: f64 = 0.01;

/// Adds the surfaces of a section of a road.
pub(super) fn pave(road: &Road, section: usize, cuts: &[f64], strips: &mut Vec<Strip>) {
    let whole = &road.sections[section];
    for lane in &whole.lanes {
        if let Some(surface) = surface(lane.kind) {
            let at = |s: f64| {
                let number = lane.number;
                let half = 0.5 * road.width(section, number, s);
                (road.middle(section, number, s), [-half, half])
            };
            lay(road, [whole.s, whole.end], cuts, surface, at, strips);
        }
        mark(road, section, lane, cuts, strips);
    }
}

/// Returns the surface of a lane; `None` if nothing is paved.
fn surface(kind: LaneType) -> Option<Surface> {
    use LaneType as T;
    match kind {
        T::None | T::Rail => None,
        T::Sidewalk | T::Walking => Some(Surface::Sidewalk),
        T::Curb => Some(Surface::Kerb),
        T::Median => Some(Surface::Island),
        _ => Some(Surface::Carriageway),
    }
}

/// Adds the marks on the outer border of a lane.
fn mark(road: &Road, section: usize, lane: &Lane, cuts: &[f64], strips: &mut Vec<Strip>) {
    let whole = &road.sections[section];
    let ends = lane.marks.iter().skip(1).map(|mark| mark.s).chain([whole.end]);
    let surface = if lane.number == 0 { Surface::CentreLine } else { Surface::LaneLine };
    for (mark, end) in lane.marks.iter().zip(ends) {
        let half = 0.5 * mark.width.filter(|width| *width > 0.0).unwrap_or(LINE);
        // The lines of a mark: the middle of each in half widths to the left of the border, and `true` for a broken line.
        let lines: &[(f64, bool)] = match mark.kind {
            MarkType::Solid | MarkType::Edge => &[(0.0, false)],
            MarkType::Broken => &[(0.0, true)],
            MarkType::SolidSolid => &[(-2.0, false), (2.0, false)],
            MarkType::SolidBroken => &[(2.0, false), (-2.0, true)],
            MarkType::BrokenSolid => &[(2.0, true), (-2.0, false)],
            MarkType::BrokenBroken => &[(-2.0, true), (2.0, true)],
            MarkType::None | MarkType::BottsDots | MarkType::Grass | MarkType::Curb | MarkType::Custom => &[],
        };
        // The first of two lines is the inner line.
        let outward = if lane.number > 0 { -1.0 } else { 1.0 };
        for (aside, broken) in lines {
            let at = |s: f64| {
                let border = road.border(section, lane.number, s).unwrap_or_default();
                (border + outward * aside * half, [-half, half])
            };
            let [from, to] = [mark.s.max(whole.s), end.min(whole.end)];
            for [from, to] in if *broken { dashes(from, to) } else { vec![[from, to]] } {
                lay(road, [from, to], cuts, surface, at, strips);
            }
        }
    }
}

/// Returns the dashes of a broken line between two places. They continue from section to section of a road.
fn dashes(from: f64, to: f64) -> Vec<[f64; 2]> {
    let (dash, gap) = DASH;
    let period = dash + gap;
    let first = (from / period).floor() as i64;
    let last = (to / period).floor() as i64;
    let clipped = |i: i64| {
        let start = i as f64 * period + 0.5 * gap;
        [start.max(from), (start + dash).min(to)]
    };
    (first..=last).map(clipped).filter(|[from, to]| from < to).collect()
}

/// Adds strips between two places. `at` returns the distance of the middle of the surface from the reference line, and the
/// distances of its sides from the middle.
fn lay(
    road: &Road,
    [from, to]: [f64; 2],
    cuts: &[f64],
    surface: Surface,
    at: impl Fn(f64) -> (f64, [f64; 2]),
    strips: &mut Vec<Strip>,
) {
    if to - from < THINNEST {
        return;
    }
    let is_even = |a: f64, b: f64| {
        let [(_, one), (_, other)] = [at(a), at(b)];
        (0..2).all(|side| (one[side] - other[side]).abs() <= STEP)
    };
    let mut start = from;
    for (end, curve) in (Beside { road, offset: |s| at(s).0 }).arcs([from, to], cuts, is_even) {
        let (_, [right, left]) = at(0.5 * (start + end));
        start = end;
        if left - right >= THINNEST {
            strips.push(Strip { surface, curve, right, left, dash: None });
        }
    }
}
