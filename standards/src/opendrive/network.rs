//! The lanes of a file as a road network: the same network as that of worlds that are programs.
//!
//! Lanes that cars drive on become lanes of the network, one for each section of a road. The file numbers lanes to the left; the
//! network numbers them to the right, so that lane -1 of the file is lane 1 of the network. Roads have the names of their
//! identifiers.

use super::arcs::{Beside, just_before, reversed};
use super::map::Map;
use super::paving;
use super::road::{Direction, End, Lane, LaneChange, Link, Road, Section, Traffic};
use paracosm_engine::road::{Centreline, Curve, LaneKind, RoadError, RoadNetwork, Survey, SurveyedLane, SurveyedRoad};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_6;
use std::sync::Arc;

/// The least width in metres, at the widest place, of a lane that cars drive on.
const NARROWEST: f64 = 1.5;

/// The greatest distance in metres between the end of a lane and the beginning of the next lane. A lane that becomes narrow
/// beside the lane that it joins ends there.
pub(crate) const GAP: f64 = 0.5;

/// The distance in metres between two places at which the width of a lane is taken, and the greatest difference of widths that
/// are the same.
const WIDTHS: f64 = 1.0;
const SAME: f64 = 0.001;

/// A lane of the file: the indices of the road and of the section, and the number.
type Key = (usize, usize, i32);

impl Map {
    /// Builds the road network of all lanes that cars drive on. Arcs approximate spirals and polynomials to
    /// 0.5 mm.
    ///
    /// # Errors
    /// The file has no lanes that cars drive on.
    pub fn network(&self) -> Result<Arc<RoadNetwork>, RoadError> {
        let mut survey = Survey { source: Some(self.text.clone()), ..Survey::default() };
        let priorities = self.junctions.iter().flat_map(|junction| &junction.priorities);
        survey.priorities = priorities.map(|(first, second)| [*first, *second]).collect();
        let mut indices: BTreeMap<Key, usize> = BTreeMap::new();
        for (r, road) in self.roads.iter().enumerate() {
            let cuts = road.cuts();
            let centre = Beside { road, offset: |_| 0.0 }.arcs([0.0, road.length], &cuts, |_, _| true);
            let straight = || Curve::new(road.line.at(0.0), 0.0, road.length).into();
            let centre = centre.into_iter().map(|(_, arc)| arc).collect::<Vec<_>>();
            let centre = if centre.is_empty() { straight() } else { Centreline::new(centre) };
            let (name, length, junction) = (road.id.clone(), road.length, road.junction);
            survey.roads.push(SurveyedRoad { name, length, centre, junction });
            for (s, section) in road.sections.iter().enumerate() {
                for lane in section.lanes.iter().filter(|lane| road.is_driven(s, lane)) {
                    if let Some(surveyed) = self.surveyed(r, s, lane, &cuts) {
                        indices.insert((r, s, lane.number), survey.lanes.len());
                        survey.lanes.push(surveyed);
                    }
                }
                paving::pave(road, s, &cuts, &mut survey.strips);
            }
        }
        for (key, index) in &indices {
            let (road, s, number) = *key;
            let section = &self.roads[road].sections[s];
            let forward = self.roads[road].leads_along(section.lane(number));
            for (side, left) in [(number + 1, forward), (number - 1, !forward)] {
                let beside = self.beside(*key, side).and_then(|key| indices.get(&key).copied());
                let lane = &mut survey.lanes[*index];
                *(if left { &mut lane.left } else { &mut lane.right }) = beside;
            }
            let end = survey.lanes[*index].line.end().position;
            let meets = |next: &usize| (survey.lanes[*next].line.start().position - end).norm() <= GAP;
            let successors = self.after(*key, forward);
            let successors = successors.iter().filter_map(|key| indices.get(key).copied()).filter(meets).collect();
            survey.lanes[*index].successors = successors;
        }
        survey.build()
    }

    /// Returns a lane of the survey; `None` if the lane has no length, as on the inner side of a tight bend.
    fn surveyed(&self, index: usize, s: usize, lane: &Lane, cuts: &[f64]) -> Option<SurveyedLane> {
        let road = &self.roads[index];
        let section = &road.sections[s];
        let middle = |at: f64| road.middle(s, lane.number, at);
        let arcs = Beside { road, offset: middle }.arcs([section.s, section.end], cuts, |_, _| true);
        let mut arcs: Vec<Curve> = arcs.into_iter().map(|(_, arc)| arc).collect();
        let mut span = [section.s, section.end];
        if !road.leads_along(Some(lane)) {
            arcs = arcs.iter().rev().map(reversed).collect();
            span.reverse();
        }
        let kind = match road.junction {
            None => LaneKind::Road,
            Some(_) => turn(&arcs),
        };
        let width_at = |at: f64| road.width(s, lane.number, at).max(0.1);
        let width = width_at(0.5 * (section.s + section.end));
        let line = (!arcs.is_empty()).then(|| Centreline::new(arcs))?;
        let limits = road.stretches(s, lane, span, line.length());
        let widths = widths(span, line.length(), |at| width_at(just_before(at, section.s)));
        Some(SurveyedLane { kind, width, widths, limits, ..SurveyedLane::new(index, -lane.number, span, line) })
    }

    /// Returns the lane with a number beside a lane, if it leads in the same direction and cars may change to it.
    fn beside(&self, (road, s, number): Key, other: i32) -> Option<Key> {
        // Lane 0 has no width: the lanes on both sides of it are beside each other.
        let other = if other == 0 { other + (other - number) } else { other };
        let of = &self.roads[road];
        let section = &of.sections[s];
        let [here, there] = [section.lane(number)?, section.lane(other)?];
        let same = of.leads_along(Some(here)) == of.leads_along(Some(there));
        let inner = if number.signum() != other.signum() {
            section.lane(0)?
        } else if number.abs() < other.abs() {
            here
        } else {
            there
        };
        let at = 0.5 * (section.s + section.end);
        let mark = inner.marks.iter().rev().find(|mark| mark.s <= at);
        let allowed = match mark.map_or(LaneChange::Both, |mark| mark.change) {
            LaneChange::Both => true,
            LaneChange::None => false,
            LaneChange::Increase => other > number,
            LaneChange::Decrease => other < number,
        };
        (same && allowed).then_some((road, s, other))
    }

    /// Returns the lanes to which cars drive from the end of a lane.
    fn after(&self, (r, s, number): Key, forward: bool) -> Vec<Key> {
        let road = &self.roads[r];
        let Some(lane) = road.sections[s].lane(number) else { return Vec::new() };
        let (end, next, numbers) = if forward {
            (End::End, s + 1, &lane.successors)
        } else {
            (End::Start, s.wrapping_sub(1), &lane.predecessors)
        };
        if next < road.sections.len() {
            return self.entered(r, next, numbers, forward);
        }
        match road.link(end) {
            None => Vec::new(),
            Some(Link::Road(to, at)) => self.entered_at(to, at, numbers),
            Some(Link::Junction(junction)) => {
                let connections = self.junctions[junction].connections.iter();
                let ours = connections.filter(|connection| {
                    // A road may meet the same junction at both ends.
                    let back = self.roads[connection.to].link(connection.at);
                    connection.from == r && !matches!(back, Some(Link::Road(of, other)) if of == r && other != end)
                });
                ours.flat_map(|connection| self.entered_at(connection.to, connection.at, &connection.next(number)))
                    .collect()
            }
        }
    }

    /// Returns the lanes that are entered at an end of a road.
    fn entered_at(&self, road: usize, at: End, numbers: &[i32]) -> Vec<Key> {
        match at {
            End::Start => self.entered(road, 0, numbers, true),
            End::End => self.entered(road, self.roads[road].sections.len() - 1, numbers, false),
        }
    }

    /// Returns the lanes of a section that lead in the direction in which they are entered.
    fn entered(&self, road: usize, section: usize, numbers: &[i32], forward: bool) -> Vec<Key> {
        let leads = |number: &&i32| {
            let lane = self.roads[road].sections[section].lane(**number);
            lane.is_some() && self.roads[road].leads_along(lane) == forward
        };
        numbers.iter().filter(leads).map(|number| (road, section, *number)).collect()
    }
}

impl Road {
    /// Returns `true` if the traffic on a lane drives in the direction of the reference line.
    pub(crate) fn leads_along(&self, lane: Option<&Lane>) -> bool {
        let Some(lane) = lane else { return true };
        let standard = match self.traffic {
            Traffic::RightHand => lane.number < 0,
            Traffic::LeftHand => lane.number > 0,
        };
        standard != (lane.direction == Direction::Reversed)
    }

    /// Returns `true` if cars drive on a lane of a section.
    pub(super) fn is_driven(&self, section: usize, lane: &Lane) -> bool {
        let Section { s, end, .. } = self.sections[section];
        lane.number != 0 && lane.kind.is_driven() && end > s && self.widest(section, lane.number) >= NARROWEST
    }

    /// Returns the width in metres of a lane of a section at its widest place.
    pub(super) fn widest(&self, section: usize, lane: i32) -> f64 {
        let Section { s, end, .. } = self.sections[section];
        (0..=8).map(|i| self.width(section, lane, s + (end - s) * f64::from(i) / 8.0)).fold(0.0, f64::max)
    }

    /// Returns the places along the road at which polynomials or pieces of the reference line begin.
    fn cuts(&self) -> Vec<f64> {
        let mut cuts: Vec<f64> = self.line.pieces().iter().map(|piece| piece.s).collect();
        cuts.extend(self.offset.pieces().iter().map(|piece| piece.s));
        let lanes = self.sections.iter().flat_map(|section| &section.lanes);
        cuts.extend(lanes.flat_map(|lane| lane.extent.cubics().pieces().iter().map(|piece| piece.s)));
        cuts.extend(self.sections.iter().map(|section| section.s));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    }
}

/// Returns the widths along a lane, at places along the lane; nothing if the width does not change. `span` is the beginning and
/// the end of the lane in metres along the road.
fn widths([from, to]: [f64; 2], length: f64, width_at: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let count = (length / WIDTHS).ceil().max(1.0);
    let share = |i: usize| i as f64 / count;
    let widths: Vec<_> =
        (0..=count as usize).map(|i| [share(i) * length, width_at(from + share(i) * (to - from))]).collect();
    let first = widths[0][1];
    if widths.iter().all(|[_, width]| (width - first).abs() < SAME) { Vec::new() } else { widths }
}

/// Returns the kind of a lane of a junction, by the angle that it turns.
fn turn(arcs: &[Curve]) -> LaneKind {
    match arcs.iter().map(|arc| arc.curvature() * arc.length()).sum::<f64>() {
        angle if angle > FRAC_PI_6 => LaneKind::Left,
        angle if angle < -FRAC_PI_6 => LaneKind::Right,
        _ => LaneKind::Straight,
    }
}
