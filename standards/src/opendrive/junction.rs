//! A junction of a file: the roads that meet, and the connections between their lanes.

use super::road::End;

/// A junction.
#[derive(Debug, Clone, PartialEq)]
pub struct Junction {
    /// The identifier of the junction, unique in the file.
    pub id: String,
    /// The name of the junction; empty if it has none.
    pub name: String,
    /// The kind of the junction.
    pub kind: JunctionKind,
    /// The connections from roads into the junction.
    pub connections: Vec<Connection>,
    /// Pairs of roads of the junction, by their indices: traffic on the first has priority over traffic on the second.
    pub priorities: Vec<(usize, usize)>,
}

/// The kind of a junction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JunctionKind {
    /// Roads of the junction connect the roads that meet.
    Common,
    /// The roads that meet are linked directly, as where a ramp leaves a motorway.
    Direct,
    /// People cross a road.
    Crossing,
}

/// A connection from a road into a junction.
#[derive(Debug, Clone, PartialEq)]
pub struct Connection {
    /// The index of the road that leads to the junction.
    pub from: usize,
    /// The index of the road that the traffic takes next: a road of the junction, or the linked road of a direct junction.
    pub to: usize,
    /// The end of the next road that is met.
    pub at: End,
    /// Pairs of numbers of lanes: of the road that leads to the junction, and of the next road. If there are none, lanes with
    /// the same numbers are linked.
    pub lanes: Vec<(i32, i32)>,
}

impl Connection {
    /// Returns the numbers of the lanes of the next road that follow a lane.
    pub fn next(&self, lane: i32) -> Vec<i32> {
        if self.lanes.is_empty() {
            return vec![lane];
        }
        self.lanes.iter().filter(|(from, _)| *from == lane).map(|(_, to)| *to).collect()
    }
}
