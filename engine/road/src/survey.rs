//! Road networks that are described lane by lane, for example by a file.

use super::bounds::{Bounds, Tree};
use super::centreline::Centreline;
use super::error::RoadError;
use super::lane::{Lane, LaneConflict, LaneId, LaneKind, SpeedLimit};
use super::layout::{CLOSE, span};
use super::network::{Course, Placed, RoadNetwork};
use super::strip::Strip;
use crate::geometry::wrapped;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_4, PI};
use std::sync::Arc;

/// The distance in metres up to which two lanes begin at the same place.
const TOGETHER: f64 = 0.01;

/// A road network that is described lane by lane. [`Survey::build`] finds the lanes that are in each other's way, and makes the
/// network.
///
/// ```
/// use nalgebra::Vector2;
/// use paracosm_road::{Curve, LaneKind, Pose, Survey, SurveyedLane, SurveyedRoad};
///
/// let centre = Curve::new(Pose { position: Vector2::zeros(), heading: 0.0 }, 0.0, 80.0);
/// let lane = SurveyedLane { width: 3.5, ..SurveyedLane::new(0, 1, [0.0, 80.0], centre.into()) };
/// let road = SurveyedRoad { name: "7".to_owned(), length: 80.0, centre: centre.into(), junction: None };
/// let network = Survey { roads: vec![road], lanes: vec![lane], ..Survey::default() }.build()?;
/// assert_eq!(network.on_lane("7", 1, 30.0)?.position.x, 30.0);
/// # Ok::<(), paracosm_road::RoadError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Survey {
    /// The roads of the network.
    pub roads: Vec<SurveyedRoad>,
    /// The lanes of the network.
    pub lanes: Vec<SurveyedLane>,
    /// The visible surfaces of the network.
    pub strips: Vec<Strip>,
    /// Pairs of roads of a junction, by their indices: cars on the second road give way to cars on the first road.
    pub priorities: Vec<[usize; 2]>,
    /// The text of the file that describes the lanes; `None` without a file.
    pub source: Option<Arc<str>>,
}

/// A road of a [`Survey`].
#[derive(Debug, Clone)]
pub struct SurveyedRoad {
    /// The name of the road, unique in the network.
    pub name: String,
    /// The length of the road in metres: the place at its end.
    pub length: f64,
    /// The line along which places on the road are measured. If the line is an approximation, its length may differ slightly
    /// from the length of the road; places are then in proportion.
    pub centre: Centreline,
    /// The number of the junction that the road belongs to. Lanes of the same junction can be in each other's way.
    pub junction: Option<usize>,
}

/// A lane of a [`Survey`]. Other lanes are named by their indices.
#[derive(Debug, Clone)]
pub struct SurveyedLane {
    /// The index of the road that the lane belongs to.
    pub road: usize,
    /// The number of the lane: 1, 2, ... to the right of the centre line, and -1, -2, ... to the left.
    pub number: i32,
    /// The kind of the lane.
    pub kind: LaneKind,
    /// The beginning and the end of the lane in its direction of traffic, in metres along the road.
    pub span: [f64; 2],
    /// The line along the middle of the lane, in the direction of traffic.
    pub line: Centreline,
    /// The width of the lane in metres; in the middle of its length, if the width changes.
    pub width: f64,
    /// Places in metres along the lane, in their order, each with the width there; empty if the width does not change.
    pub widths: Vec<[f64; 2]>,
    /// The next lane to the left in the same direction, if cars may change to it.
    pub left: Option<usize>,
    /// The next lane to the right in the same direction, if cars may change to it.
    pub right: Option<usize>,
    /// The lanes that begin at the end of the lane.
    pub successors: Vec<usize>,
    /// The stretches with a speed limit, in the order of their places along the lane.
    pub limits: Vec<SpeedLimit>,
}

impl SurveyedLane {
    /// Makes a lane of a road without neighbours and successors, 3.5 m wide.
    pub fn new(road: usize, number: i32, span: [f64; 2], line: Centreline) -> Self {
        let (left, right, successors, kind) = (None, None, Vec::new(), LaneKind::Road);
        Self {
            road,
            number,
            kind,
            span,
            line,
            width: 3.5,
            widths: Vec::new(),
            left,
            right,
            successors,
            limits: Vec::new(),
        }
    }
}

impl Survey {
    /// Builds the network. If two lanes of a junction cross or join, one gives way: as [`Survey::priorities`] says; else a
    /// lane that turns left to a lane from ahead; else a lane to a lane from its right.
    ///
    /// # Errors
    /// Two roads have the same name, there are no lanes, or a number is not finite.
    ///
    /// # Panics
    /// An index names no road or lane.
    pub fn build(self) -> Result<Arc<RoadNetwork>, RoadError> {
        self.check()?;
        let Self { roads, lanes: drafts, strips, priorities, source } = self;
        let priorities: BTreeSet<[usize; 2]> = priorities.into_iter().collect();
        let mut order: Vec<usize> = (0..drafts.len()).collect();
        // The lanes of a road follow one another in the network.
        order.sort_by_key(|index| drafts[*index].road);
        let mut places = vec![0; drafts.len()];
        order.iter().enumerate().for_each(|(place, index)| places[*index] = place);
        let id = |index: &usize| LaneId::new(places[*index]);
        let lane = |index: &usize| {
            let draft = &drafts[*index];
            Lane {
                element: draft.road,
                kind: draft.kind,
                number: draft.number,
                curve: draft.line.clone(),
                width: draft.width,
                widths: draft.widths.clone(),
                left: draft.left.as_ref().map(id),
                right: draft.right.as_ref().map(id),
                successors: draft.successors.iter().map(id).collect(),
                predecessors: Vec::new(),
                conflicts: Vec::new(),
                limits: draft.limits.clone(),
            }
        };
        let mut lanes: Vec<Lane> = order.iter().map(lane).collect();
        let mut junctions: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (place, index) in order.iter().enumerate() {
            if let Some(junction) = roads[drafts[*index].road].junction {
                junctions.entry(junction).or_default().push(place);
            }
        }
        let mut before: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (index, lane) in lanes.iter().enumerate() {
            lane.successors.iter().for_each(|next| before.entry(next.index()).or_default().push(index));
        }
        junctions.values().for_each(|of_one| find_conflicts(&mut lanes, of_one, &before, &priorities));
        let mut end = 0;
        let element = |(index, road): (usize, SurveyedRoad)| {
            let start = end;
            end += order[start..].iter().take_while(|lane| drafts[**lane].road == index).count();
            let spans = order[start..end].iter().map(|lane| drafts[*lane].span).collect();
            Placed {
                name: road.name,
                points: Vec::new(),
                lanes: start..end,
                mouths: vec![[None; 2]; end - start],
                course: Some(Course::Surveyed { centre: road.centre, length: road.length, spans }),
            }
        };
        let elements = roads.into_iter().enumerate().map(element).collect();
        let mut network = RoadNetwork::of(elements, lanes, Vec::new(), strips);
        network.source = source;
        Ok(Arc::new(network))
    }

    fn check(&self) -> Result<(), RoadError> {
        let mut names = BTreeMap::new();
        for road in &self.roads {
            if names.insert(&road.name, ()).is_some() {
                return Err(RoadError::NameTaken { name: road.name.clone() });
            }
        }
        let wrong = |element: &str, problem: String| Err(RoadError::Element { element: element.to_owned(), problem });
        if self.lanes.is_empty() {
            return wrong("the network", "has no lanes, expected at least one".to_owned());
        }
        for lane in &self.lanes {
            let bounds = lane.line.bounds();
            let is_sound = lane.line.length() > 0.0
                && lane.line.length().is_finite()
                && bounds.min.iter().chain(bounds.max.iter()).all(|metres| metres.is_finite())
                && lane.width > 0.0
                && lane.width.is_finite();
            if !is_sound {
                let number = lane.number;
                let problem =
                    format!("has a lane {number} without length or width, or with numbers that are not finite");
                return wrong(&self.roads[lane.road].name, problem);
            }
        }
        Ok(())
    }
}

/// Finds the conflicts between lanes of a junction: lanes that cross or join. Lanes that part from one another, or follow one
/// another, are in no conflict.
fn find_conflicts(
    lanes: &mut [Lane],
    of_one: &[usize],
    before: &BTreeMap<usize, Vec<usize>>,
    priorities: &BTreeSet<[usize; 2]>,
) {
    // The tree keeps the search from growing with the square of the number of lanes.
    let widest = of_one.iter().map(|lane| lanes[*lane].width).fold(0.0, f64::max);
    let boxes: Vec<Bounds> = of_one.iter().map(|lane| lanes[*lane].curve.bounds()).collect();
    let tree = Tree::new(&boxes);
    for (i, &b) in of_one.iter().enumerate() {
        let mut earlier = tree.near(&boxes[i].grown(CLOSE * widest));
        earlier.retain(|index| (*index as usize) < i);
        earlier.sort_unstable();
        for a in earlier.into_iter().map(|index| of_one[index as usize]) {
            let [one, other] = [&lanes[a], &lanes[b]];
            let starts = [one, other].map(|lane| lane.curve.start().position);
            let parted = before_both(before, [a, b]) || (starts[0] - starts[1]).norm() < TOGETHER;
            let is_beside = one.left == Some(LaneId::new(b)) || one.right == Some(LaneId::new(b));
            let follows = one.successors.contains(&LaneId::new(b)) || other.successors.contains(&LaneId::new(a));
            let close = CLOSE * 0.5 * (one.width + other.width);
            if is_beside || follows || parted || !one.curve.bounds().grown(close).meets(&other.curve.bounds()) {
                continue;
            }
            let spans = [span(&one.curve, &other.curve, close), span(&other.curve, &one.curve, close)];
            if let [Some(span), Some(other_span)] = spans {
                let rules = [gives_way(one, other, priorities), gives_way(other, one, priorities)];
                let conflict = |with, (from, to): (f64, f64), gives_way| LaneConflict {
                    with: LaneId::new(with),
                    from,
                    to,
                    gives_way,
                };
                lanes[a].conflicts.push(conflict(b, span, rules[0]));
                lanes[b].conflicts.push(conflict(a, other_span, rules[1]));
            }
        }
    }
}

/// Returns `true` if a lane leads to both of two lanes.
fn before_both(before: &BTreeMap<usize, Vec<usize>>, [a, b]: [usize; 2]) -> bool {
    let [of_a, of_b] = [a, b].map(|lane| before.get(&lane).map_or(&[][..], Vec::as_slice));
    of_a.iter().any(|lane| of_b.contains(lane))
}

/// Returns `true` if a lane gives way to another lane of the same junction.
fn gives_way(lane: &Lane, other: &Lane, priorities: &BTreeSet<[usize; 2]>) -> bool {
    let goes_first = |first: &Lane, second: &Lane| priorities.contains(&[first.element, second.element]);
    if goes_first(lane, other) != goes_first(other, lane) {
        return goes_first(other, lane);
    }
    let turned = wrapped(other.curve.start().heading - lane.curve.start().heading);
    if turned.abs() > PI - FRAC_PI_4 {
        lane.kind == LaneKind::Left && other.kind != LaneKind::Left
    } else {
        // A car from the right drives to the left.
        turned > 0.0
    }
}
