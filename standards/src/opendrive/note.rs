//! Remarks on a file that was read: the parts without an effect, and everything that differs from the file.

use crate::xml::NoEffect;
use std::fmt;

/// A remark on a file that was read.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// Elements or attributes have no effect.
    NoEffect(NoEffect),
    /// The file has an older version than the oldest that is supported.
    Old {
        /// The minor version of the file; the major version is 1.
        minor: u32,
    },
    /// The world is flat, but the roads of the file are not.
    Flat {
        /// The greatest height of a road in the file, in metres; its magnitude if it is below zero.
        height: f64,
        /// The greatest roll of a road in the file, in radians.
        roll: f64,
    },
    /// The link of a lane leads to a lane that does not exist. Cars do not use the link.
    NoLane {
        /// The line of the link in the file, from 1.
        line: u32,
        /// The number of the missing lane.
        lane: i32,
    },
    /// The reference line of a road is not continuous.
    Jump {
        /// The identifier of the road.
        road: String,
        /// The place of the jump, in metres along the road.
        s: f64,
        /// The distance between the two ends, in metres.
        gap: f64,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoEffect(NoEffect { name, reason, count, line }) => {
                let times = if *count == 1 { String::new() } else { format!(" ({count} times)") };
                write!(f, "line {line}: `{name}`{times} has no effect: {reason}")
            }
            Self::Old { minor } => {
                write!(
                    f,
                    "the file has version 1.{minor}, older than the supported versions; it is read as version 1.4"
                )
            }
            Self::Flat { height, roll } => {
                write!(f, "the world is flat: heights up to {height:.2} m")?;
                if *roll > 0.0 {
                    write!(f, " and roll up to {roll:.3} rad")?;
                }
                f.write_str(" are left out")
            }
            Self::NoLane { line, lane } => {
                write!(f, "line {line}: the link leads to lane {lane}, which does not exist there; cars do not use it")
            }
            Self::Jump { road, s, gap } => {
                write!(f, "the reference line of road `{road}` jumps by {gap:.3} m at s = {s:.3} m")
            }
        }
    }
}
