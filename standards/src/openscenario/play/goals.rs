//! The positions of conditions that have no place on the map: such a condition would never hold, without a word.

use super::find::{Lost, find};
use super::stage::Stage;
use crate::opendrive::Map;
use crate::openscenario::condition::Condition;
use crate::openscenario::measure::{Goal, Measure};
use crate::openscenario::position::{Position, RoutePlace, Way};
use crate::openscenario::story::Storyboard;
use std::path::PathBuf;
use thiserror::Error;

/// A condition on a position without a place.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}:{line}: the condition `{condition}` never holds, because its position has no place: {lost}", file.display())]
pub(in crate::openscenario) struct Nowhere {
    file: PathBuf,
    line: u32,
    condition: String,
    lost: Lost,
}

/// Checks the positions on routes and trajectories in the conditions of a storyboard. A position that depends on an entity is left
/// out, because entities move. All other positions have been checked when they were read.
pub(in crate::openscenario) fn check_goals(board: &Storyboard, map: &Map) -> Result<(), Nowhere> {
    Stage::conditions(board).try_for_each(|condition| {
        let mut goals = condition.check.measures.iter().filter_map(goal);
        let lost = goals.find_map(|position| find(position, &[], map).err());
        let Condition { name, origin: (file, line), .. } = condition;
        lost.map_or(Ok(()), |lost| Err(Nowhere { file: file.clone(), line: *line, condition: name.clone(), lost }))
    })
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
