//! Finds out which lamps of a vehicle shine: brake lamps by its deceleration, indicators by its motion across its lane and
//! by the lane that it is on.
//!
//! Vehicles give no signals themselves, so their lamps follow from what they do. Nothing in a run depends on them.

use super::cells::Cells;
use crate::mesh::lamps::Lit;
use crate::scene::figure::lot;
use paracosm_engine::object::{BodyState, Class};
use paracosm_engine::road::{Centreline, Lane, LaneId, LaneKind, RoadNetwork};
use paracosm_engine::sensor::Moment;

/// The deceleration in m/s² from which brake lamps shine. UN R13-H (5.2.22) allows them from 0.7 m/s² on, and asks for
/// them above 1.3 m/s².
const BRAKES: f64 = 0.7;
/// The speed in m/s below which a vehicle stands. A vehicle that drove and stands keeps its brakes on.
const STANDS: f64 = 0.1;
/// The flashes of an indicator in a second. UN R6 (annex 1) asks for 60 to 120 in a minute.
const FLASHES: f64 = 1.5;
/// The speed across the lane in m/s from which a vehicle changes lanes.
const ACROSS: f64 = 0.3;
/// The distance in metres before a turn from which a vehicle shows it, if its lane leads nowhere else.
const BEFORE: f64 = 30.0;
/// The greatest distance of a vehicle from the edge of its lane, in metres.
const BESIDE: f64 = 0.5;
/// The greatest angle in radians between a vehicle and its lane, and the metres beside a lane that count as much as a
/// radian.
const TURNED: f64 = 1.0;
const PER_RADIAN: f64 = 2.0;
/// Two lanes fit equally well if they differ by less than this many metres.
const ALIKE: f64 = 0.05;

/// The lanes of a network, which say where vehicles turn, sorted by the cells of a grid that they lie in.
#[derive(Debug)]
pub(super) struct Signals {
    lanes: Vec<OfLane>,
    cells: Cells,
}

/// The part of a lane that signals need.
#[derive(Debug)]
struct OfLane {
    curve: Centreline,
    width: f64,
    /// The turn that the lane makes, and the turn at its end if it leads nowhere else.
    turn: Turn,
    next: Turn,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Turn {
    None,
    Left,
    Right,
}

impl Turn {
    /// Returns the turn of a lane. Traffic around a roundabout leaves it to the right.
    fn of(lane: &Lane) -> Self {
        match lane.kind {
            LaneKind::Left => Self::Left,
            LaneKind::Right | LaneKind::Exit => Self::Right,
            LaneKind::Road | LaneKind::Straight | LaneKind::Entry | LaneKind::Ring | LaneKind::RingAtArm => Self::None,
        }
    }
}

impl Signals {
    pub fn of(network: &RoadNetwork) -> Self {
        let of_lane = |lane: &Lane| {
            let turn = |next: &LaneId| Turn::of(network.lane(*next));
            let mut turns: Vec<Turn> = lane.successors.iter().map(turn).collect();
            turns.dedup();
            let next = if let [only] = turns[..] { only } else { Turn::None };
            OfLane { curve: lane.curve.clone(), width: lane.width, turn: Turn::of(lane), next }
        };
        let lanes: Vec<OfLane> = network.lanes().iter().map(of_lane).collect();
        let mut cells = Cells::default();
        for (index, lane) in lanes.iter().enumerate() {
            let half = 0.5 * lane.width + BESIDE;
            lane.curve.curves().for_each(|curve| cells.add_strip(index, curve, -half, half));
        }
        Self { lanes, cells }
    }

    /// Returns the lamps of a body that shine at a moment. `index` is the place of the body among the bodies.
    pub fn lit(&self, index: usize, state: &BodyState, moment: &Moment) -> Lit {
        if !matches!(state.body.class, Class::Car | Class::Van | Class::Truck | Class::Bus | Class::Motorcycle) {
            return Lit::default();
        }
        let speed = state.velocity.norm();
        let acceleration = moment.accelerations.get(index).copied().unwrap_or_default();
        let brakes = acceleration < -BRAKES || (speed < STANDS && state.travelled > 1.0);
        // Indicators of different vehicles do not flash together.
        let start = f64::from(lot(index as u16, FLASH) % 1000) / 1000.0;
        let flash = (moment.time * FLASHES + start).fract() < 0.5;
        let turn = if flash { self.turn(state) } else { Turn::None };
        Lit { brakes, left: turn == Turn::Left, right: turn == Turn::Right }
    }

    /// Returns the direction that a vehicle indicates.
    fn turn(&self, state: &BodyState) -> Turn {
        let Some((lane, s)) = self.lane_of(state) else { return Turn::None };
        let across = lane.curve.at(s).turn_to_local(state.velocity).y;
        if lane.turn != Turn::None {
            lane.turn
        } else if across.abs() > ACROSS {
            if across > 0.0 { Turn::Left } else { Turn::Right }
        } else if lane.curve.length() - s < BEFORE {
            lane.next
        } else {
            Turn::None
        }
    }

    /// Returns the lane that fits a vehicle best, and the distance along it. If a lane that turns and one that does not
    /// fit equally well, as at the beginning of a turn, the vehicle does not turn yet.
    fn lane_of(&self, state: &BodyState) -> Option<(&OfLane, f64)> {
        let fit = |index: usize| {
            let lane = &self.lanes[index];
            let s = lane.curve.nearest(state.pose.position);
            let on_lane = lane.curve.at(s);
            let place = on_lane.to_local(state.pose.position);
            let (sin, cos) = libm::sincos(state.pose.heading - on_lane.heading);
            let angle = libm::atan2(sin, cos).abs();
            let is_beside = place.x.abs() < 1e-3 + 1e-6 * place.y.abs();
            let fits = is_beside && place.y.abs() < 0.5 * lane.width + BESIDE && angle < TURNED;
            fits.then(|| (place.y.abs() + PER_RADIAN * angle, lane, s))
        };
        let fits: Vec<_> = self.cells.at(state.pose.position).filter_map(fit).collect();
        let best = fits.iter().map(|(off, ..)| *off).fold(f64::INFINITY, f64::min);
        let alike = fits.into_iter().filter(|(off, ..)| *off < best + ALIKE);
        alike.min_by_key(|(_, lane, _)| lane.turn).map(|(_, lane, s)| (lane, s))
    }
}

/// The purpose of the lot that shifts the flashes of a vehicle.
const FLASH: u32 = 3;
