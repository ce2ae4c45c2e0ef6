//! Remarks on a file that was read: the parts without an effect, and everything that differs from the file.

use crate::xml::{NoEffect, short};
use std::fmt;
use std::path::Path;

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
    /// Links of lanes lead to lanes that do not exist. Cars do not use the links.
    NoLane {
        /// The line of the first link in the file, from 1.
        line: u32,
        /// The number of the missing lane of the first link.
        lane: i32,
        /// The number of links.
        count: usize,
    },
    /// Lanes have links beyond an end of their road at which the road has no link. Cars do not use the links.
    NoRoad {
        /// The line of the first link in the file, from 1.
        line: u32,
        /// The number of links.
        count: usize,
    },
    /// Links join lanes that cars drive on, but the lanes do not meet. Cars do not use the links.
    Apart {
        /// The line of the first link in the file, from 1.
        line: u32,
        /// The distance between the middles of the two lanes of the first link, in metres.
        gap: f64,
        /// The number of links.
        count: usize,
    },
    /// Objects, or signals, have the identifier of another one. They are read all the same.
    SameId {
        /// The line of the first such object in the file, from 1.
        line: u32,
        /// The name of its element: `object` or `signal`.
        element: &'static str,
        /// The identifier.
        id: String,
        /// The number of such objects.
        count: usize,
    },
    /// Objects, corners of outlines, repetitions of objects, or signals reach beyond the end of their road. The rest of a repetition
    /// is cut, and everything else is moved to the end.
    BeyondEnd {
        /// The line of the first such element in the file, from 1.
        line: u32,
        /// The name of the elements: `object`, `cornerRoad`, `repeat` or `signal`.
        element: &'static str,
        /// The distance in metres from the end of the road to the end of the first element.
        excess: f64,
        /// The number of such elements.
        count: usize,
    },
    /// Reference lines of roads are not continuous.
    Jump {
        /// The identifier of the road with the widest jump.
        road: String,
        /// The place of the widest jump, in metres along the road.
        s: f64,
        /// The distance between the two ends at the widest jump, in metres.
        gap: f64,
        /// The number of jumps.
        count: usize,
    },
    /// Reference lines of roads have kinks. Entities turn there within a tick.
    Kink {
        /// The identifier of the road with the sharpest kink.
        road: String,
        /// The place of the sharpest kink, in metres along the road.
        s: f64,
        /// The angle of the sharpest kink in radians.
        angle: f64,
        /// The number of kinks.
        count: usize,
    },
    /// Linked roads do not meet. Nobody uses the links.
    RoadApart {
        /// The line of the first link in the file, from 1.
        line: u32,
        /// The distance between the ends of the reference lines of the first link, in metres.
        gap: f64,
        /// The number of links.
        count: usize,
    },
    /// Pieces of reference lines do not end where the next piece of the road begins, or where the road ends. A piece that is too
    /// short continues with its shape, and a piece that is too long is cut.
    Length {
        /// The identifier of the road with the greatest difference.
        road: String,
        /// The place at which the piece begins, in metres along the road.
        s: f64,
        /// The length of the piece in metres.
        length: f64,
        /// The distance in metres from the place to the next piece, or to the end of the road.
        span: f64,
        /// The number of pieces.
        count: usize,
    },
    /// Sections of lanes have no length. Cars do not drive from the section before to the section after.
    NoLength {
        /// The identifier of the road with the first section.
        road: String,
        /// The place of the first section, in metres along the road.
        s: f64,
        /// The number of sections.
        count: usize,
    },
    /// Lanes of a type that cars drive on are too narrow for cars.
    Narrow {
        /// The identifier of the road with the first lane.
        road: String,
        /// The number of the first lane.
        lane: i32,
        /// The width of the first lane at its widest place, in metres.
        width: f64,
        /// The number of lanes, counted in each section.
        count: usize,
    },
    /// Junctions have no connections. Cars do not cross them.
    NoConnection {
        /// The identifier of the first junction.
        junction: String,
        /// The number of junctions.
        count: usize,
    },
    /// Lanes are for both directions. Cars drive on the lanes only in the direction of the side of the lane.
    OneWay {
        /// The identifier of the road with the first lane.
        road: String,
        /// The number of the first lane.
        lane: i32,
        /// The number of lanes, counted in each section.
        count: usize,
    },
}

impl Note {
    /// Returns the line of the file that the remark is about, from 1; `None` if it is about no single line.
    pub fn line(&self) -> Option<u32> {
        match self {
            Self::NoEffect(NoEffect { line, .. })
            | Self::NoLane { line, .. }
            | Self::NoRoad { line, .. }
            | Self::SameId { line, .. }
            | Self::BeyondEnd { line, .. }
            | Self::Apart { line, .. }
            | Self::RoadApart { line, .. } => Some(*line),
            _ => None,
        }
    }

    /// Describes the remark with the path of its file and its line.
    pub fn in_file(&self, file: &Path) -> String {
        let line = self.line().map(|line| format!(":{line}")).unwrap_or_default();
        format!("{}{line}: {self}", file.display())
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoEffect(part) => part.fmt(f),
            Self::Old { minor } => {
                write!(
                    f,
                    "the file has version 1.{minor}, older than the supported versions; it is read as version 1.4"
                )
            }
            Self::Flat { height, roll } => {
                write!(f, "the world is flat: heights up to {} m", short(*height, 2))?;
                if *roll > 0.0 {
                    write!(f, " and roll up to {} rad", short(*roll, 3))?;
                }
                f.write_str(" are left out")
            }
            Self::NoLane { lane, count, .. } => {
                write!(f, "the link leads to lane {lane}, which does not exist there; cars do not use it")?;
                others(f, *count, "link")
            }
            Self::NoRoad { count, .. } => {
                f.write_str(
                    "the lane has a link beyond the end of its road, but the road has none there; cars do not use it",
                )?;
                others(f, *count, "link")
            }
            Self::Apart { gap, count, .. } => {
                write!(f, "the link joins lanes that are {gap:.3} m apart; cars do not use it")?;
                others(f, *count, "link")
            }
            Self::SameId { element, id, count, .. } => {
                write!(f, "the {element} has the id `{id}` of another {element}; both are read")?;
                others(f, *count, element)
            }
            Self::BeyondEnd { element, excess, count, .. } => {
                let effect = if *element == "repeat" { "the rest is cut" } else { "it is moved to the end" };
                write!(f, "the {element} reaches {excess:.3} m beyond the end of its road; {effect}")?;
                others(f, *count, element)
            }
            Self::Jump { road, s, gap, count } => {
                write!(f, "the reference line of road `{road}` jumps by {gap:.3} m at s = {s:.3} m")?;
                others(f, *count, "jump")
            }
            Self::Kink { road, s, angle, count } => {
                write!(f, "the reference line of road `{road}` turns by {angle:.3} rad at s = {s:.3} m")?;
                others(f, *count, "kink")
            }
            Self::RoadApart { gap, count, .. } => {
                write!(f, "the link joins roads that are {gap:.3} m apart; nobody uses it")?;
                others(f, *count, "link")
            }
            Self::Length { road, s, length, span, count } => {
                let effect = if length < span { "its shape continues" } else { "the rest is cut" };
                write!(
                    f,
                    "the piece at s = {s:.3} m of the reference line of road `{road}` is {length:.3} m long, but its share of the \
                     road is {span:.3} m: {effect}"
                )?;
                others(f, *count, "piece")
            }
            Self::NoLength { road, s, count } => {
                write!(
                    f,
                    "the section of lanes at s = {s:.3} m of road `{road}` has no length; cars do not drive over it"
                )?;
                others(f, *count, "section")
            }
            Self::Narrow { road, lane, width, count } => {
                write!(f, "lane {lane} of road `{road}` is at most {width:.3} m wide; cars do not drive on it")?;
                others(f, *count, "lane")
            }
            Self::NoConnection { junction, count } => {
                write!(f, "junction `{junction}` has no connections; cars do not cross it")?;
                others(f, *count, "junction")
            }
            Self::OneWay { road, lane, count } => {
                write!(
                    f,
                    "lane {lane} of road `{road}` is for both directions; cars drive only in the direction of its side"
                )?;
                others(f, *count, "lane")
            }
        }
    }
}

/// Writes how many more places there are than the one that was named.
fn others(f: &mut fmt::Formatter<'_>, count: usize, name: &str) -> fmt::Result {
    match count.saturating_sub(1) {
        0 => Ok(()),
        1 => write!(f, "; and 1 {name} more"),
        more => write!(f, "; and {more} {name}s more"),
    }
}
