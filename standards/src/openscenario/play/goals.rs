//! The positions of conditions and the routes of actions that have no place on the map: such a condition would never hold, and such an
//! action could not begin.

use super::actor::Whereabouts;
use super::find::{Lost, find, legs};
use super::stage::Stage;
use crate::opendrive::Map;
use crate::openscenario::action::Action;
use crate::openscenario::condition::Condition;
use crate::openscenario::measure::{Goal, Measure};
use crate::openscenario::position::{Position, RoutePlace, Way};
use crate::openscenario::story::{Kind, Storyboard};
use std::path::PathBuf;
use thiserror::Error;

/// An element of a storyboard with a position that has no place, or with a route that has no way.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}:{line}: {element}: {lost}", file.display())]
pub(in crate::openscenario) struct Nowhere {
    file: PathBuf,
    line: u32,
    /// The element and what it cannot do, in words.
    element: String,
    lost: Lost,
}

/// Checks the positions on routes and trajectories in the conditions of a storyboard, and the routes of its actions. A position that
/// depends on an entity is left out, because entities move. All other positions have been checked when they were read.
pub(in crate::openscenario) fn check_goals(board: &Storyboard, map: &Map) -> Result<(), Nowhere> {
    let nowhere = |lost: Option<Lost>, (file, line): &(PathBuf, u32), element: String| match lost {
        None => Ok(()),
        Some(lost) => Err(Nowhere { file: file.clone(), line: *line, element, lost }),
    };
    Stage::conditions(board).try_for_each(|condition| {
        let mut goals = condition.check.measures.iter().filter_map(goal);
        let lost = goals.find_map(|position| find(position, &[], map).err());
        let Condition { name, origin, .. } = condition;
        nowhere(lost, origin, format!("the condition `{name}` never holds, because its position has no place"))
    })?;
    board.items.iter().try_for_each(|item| {
        let Kind::Action(_, action) = &item.kind else { return Ok(()) };
        nowhere(astray(action, map), &item.origin, format!("the action `{}` cannot begin", item.name))
    })
}

/// Returns the reason why an action has no route; `None` if it may have one.
fn astray(action: &Action, map: &Map) -> Option<Lost> {
    match action {
        Action::Route(route) if route.waypoints.iter().all(is_fixed) => legs(route, &[], map).err(),
        Action::Acquire(position) if is_fixed(position) => match find(position, &[], map) {
            Ok(Whereabouts::OnLane(_)) => None,
            Ok(Whereabouts::Free(_)) => Some(Lost::Beside),
            Err(lost) => Some(lost),
        },
        _ => None,
    }
}

/// Returns the position on a fixed route or trajectory that a measure has.
fn goal(measure: &Measure) -> Option<&Position> {
    let (Measure::Distance { to, .. } | Measure::TimeToCollision { to, .. }) = measure else { return None };
    match to {
        Goal::Place(position @ (Position::OnRoute { .. } | Position::Along { .. })) if is_fixed(position) => {
            Some(position)
        }
        _ => None,
    }
}

/// Returns `true` if a position does not depend on an entity.
fn is_fixed(position: &Position) -> bool {
    match position {
        Position::World { .. } | Position::Lane { .. } | Position::Road { .. } => true,
        Position::RelativeLane { .. }
        | Position::RelativeRoad { .. }
        | Position::RelativeWorld { .. }
        | Position::RelativeObject { .. } => false,
        Position::OnRoute { route, place, .. } => {
            !matches!(place, RoutePlace::Entity(_)) && route.waypoints.iter().all(is_fixed)
        }
        Position::Along { way, .. } => match &**way {
            Way::Polyline { vertices: points, .. } | Way::Nurbs { points, .. } => {
                points.iter().all(|vertex| is_fixed(&vertex.position))
            }
            Way::Clothoids { start, .. } => start.as_ref().is_some_and(|start| is_fixed(start)),
        },
    }
}
