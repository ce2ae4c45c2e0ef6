//! Clothoids: curves whose curvature changes evenly, as roads and the paths of cars have them.

use super::scope::Node;
use crate::xml::ReadError;

/// The greatest length in metres of all clothoids of a way.
const LONGEST: f64 = 100_000.0;

/// A curve whose curvature changes evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clothoid {
    /// The curvature at the beginning in 1/m, and its change in 1/m².
    pub curvature: f64,
    pub rate: f64,
    /// The length in metres.
    pub length: f64,
    /// The turn at the beginning in radians.
    pub turn: f64,
    /// The time in seconds at the beginning.
    pub time: f64,
}

impl Clothoid {
    /// Reads the length of a clothoid after `before` metres of other clothoids.
    pub fn length(node: Node<'_>, before: f64) -> Result<f64, ReadError> {
        let length = node.length("length")?;
        if before + length <= LONGEST {
            return Ok(length);
        }
        let expected = format!("at most {LONGEST} m for the whole trajectory");
        Err(node.unexpected("length", &node.required("length")?, expected))
    }

    /// Reads an element `ClothoidSplineSegment` after `before` metres of other segments. Only the first one may have a start.
    pub fn read(segment: Node<'_>, is_first: bool, before: f64) -> Result<Self, ReadError> {
        if let Some(position) = segment.first("PositionStart").filter(|_| !is_first) {
            return Err(
                position.refused("only the first segment has a start; the others begin where the one before ends")
            );
        }
        let (from, to) = (segment.number("curvatureStart")?, segment.number("curvatureEnd")?);
        let length = Self::length(segment, before)?;
        Ok(Self {
            curvature: from,
            rate: if length > 0.0 { (to - from) / length } else { 0.0 },
            length,
            turn: segment.number_or("hOffset", 0.0)?,
            time: segment.number_or("timeStart", 0.0)?,
        })
    }
}
