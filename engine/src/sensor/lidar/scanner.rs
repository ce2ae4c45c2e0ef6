//! Casts the beams of a scan.
//!
//! All bodies are upright prisms, and all beams of a column lie in one upright plane. So the outline of a body is cut
//! only once for a column, and for each channel it remains to find the heights of its beam between the two cuts. Only
//! the columns between a body's azimuths check the body: for beams from one place, that is a better broad phase than
//! any tree.

use super::unit;
use crate::object::{BodyState, Outline};
use nalgebra::{Vector2, Vector3};
use paracosm_road::Pose;
use std::f64::consts::{PI, TAU};

/// The number of columns by which the interval of a body is widened on either side, against rounding.
const SLACK: f64 = 0.01;

/// The beams of a LiDAR, with the nearest hit of each beam so far.
#[derive(Debug, Clone)]
pub(super) struct Scanner {
    channels: Vec<Channel>,
    /// The unit vectors of the columns in the plane.
    columns: Vec<Vector2<f64>>,
    /// The nearest hit of each beam, column by column.
    nearest: Vec<Hit>,
    /// The height of the sensor above the ground, and its range, in metres.
    height: f64,
    range: f64,
}

/// The beams at one elevation.
#[derive(Debug, Clone, Copy)]
struct Channel {
    cos: f64,
    sin: f64,
    /// The horizontal distance in metres over which the beam rises by a metre, cos / sin.
    along: f64,
}

/// The distance and the id of the surface that a beam hits.
#[derive(Debug, Clone, Copy)]
struct Hit {
    distance: f64,
    id: u32,
}

/// The direction of a beam, with the beam's nearest hit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Echo {
    pub direction: Vector3<f64>,
    /// The distance of the hit in metres; infinite if the beam hits nothing.
    pub distance: f64,
    pub id: u32,
}

/// Returns the azimuth of a column in radians.
pub(super) fn azimuth(column: usize, columns: usize) -> f64 {
    TAU * column as f64 / columns as f64
}

impl Scanner {
    /// Makes a scanner with evenly spaced columns and the given elevations of the channels in radians.
    pub fn new(columns: usize, elevations: &[f64]) -> Self {
        let channel = |elevation: &f64| {
            let (sin, cos) = libm::sincos(*elevation);
            Channel { cos, sin, along: cos / sin }
        };
        Self {
            channels: elevations.iter().map(channel).collect(),
            columns: (0..columns).map(|column| unit(azimuth(column, columns))).collect(),
            nearest: Vec::with_capacity(columns * elevations.len()),
            height: 0.0,
            range: 0.0,
        }
    }

    /// Begins a scan from a sensor `height` metres above flat ground, up to `range` metres.
    pub fn begin(&mut self, height: f64, range: f64) {
        (self.height, self.range) = (height, range);
        let ground = |channel: &Channel| {
            let distance = if channel.sin < 0.0 { -height / channel.sin } else { f64::INFINITY };
            Hit { distance, id: 0 }
        };
        self.nearest.clear();
        for _ in 0..self.columns.len() {
            self.nearest.extend(self.channels.iter().map(ground));
        }
    }

    /// Adds a body to the scan of a sensor with the given pose.
    pub fn add(&mut self, id: u32, state: &BodyState, sensor: &Pose) {
        let outline = &state.body.outline;
        let at = sensor.relative(&state.pose);
        if at.position.norm() - outline.reach() > self.range {
            return;
        }
        let (from, until) = azimuths(outline, &at);
        let columns = self.columns.len();
        let step = TAU / columns as f64;
        let first = (from / step - SLACK).ceil() as i64;
        let last = ((until / step + SLACK).floor() as i64).min(first + columns as i64 - 1);
        let floor = state.altitude - self.height;
        let ceiling = floor + state.body.height;
        for column in first..=last {
            let column = column.rem_euclid(columns as i64) as usize;
            if let Some((enters, leaves)) = cut(outline, &at, self.columns[column]) {
                let beams = column * self.channels.len();
                for (channel, nearest) in self.channels.iter().zip(&mut self.nearest[beams..]) {
                    let (low, high) = channel.between(floor, ceiling);
                    let along = enters.max(low);
                    let distance = along / channel.cos;
                    if along <= leaves.min(high) && distance < nearest.distance {
                        *nearest = Hit { distance, id };
                    }
                }
            }
        }
    }

    /// Returns the nearest hits of all beams, column by column.
    pub fn echoes(&self) -> impl Iterator<Item = Echo> + use<'_> {
        let beams = self.columns.iter().flat_map(|column| self.channels.iter().map(move |channel| (column, channel)));
        beams.zip(&self.nearest).map(|((column, channel), hit)| Echo {
            direction: Vector3::new(channel.cos * column.x, channel.cos * column.y, channel.sin),
            distance: hit.distance,
            id: hit.id,
        })
    }
}

impl Channel {
    /// Returns the start and the end of the beam's part between two heights, in metres along the ground. The heights
    /// are in metres relative to the sensor. If there is no such part, it is infinity and minus infinity.
    fn between(&self, floor: f64, ceiling: f64) -> (f64, f64) {
        if self.sin > 0.0 {
            (floor * self.along, ceiling * self.along)
        } else if self.sin < 0.0 {
            (ceiling * self.along, floor * self.along)
        } else if floor <= 0.0 && 0.0 <= ceiling {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            (f64::INFINITY, f64::NEG_INFINITY)
        }
    }
}

/// Returns the azimuths in radians between which an outline lies whose pose is `at` as seen from the sensor. The second
/// is not less than the first. The azimuths span a full turn if the sensor is over the outline.
fn azimuths(outline: &Outline, at: &Pose) -> (f64, f64) {
    let distance = at.position.norm();
    let middle = libm::atan2(at.position.y, at.position.x);
    match *outline {
        Outline::Disc { radius } if distance > radius => {
            let half = libm::asin(radius / distance);
            (middle - half, middle + half)
        }
        Outline::Rectangle { .. } => {
            let half = outline.half_extent();
            let sensor = at.to_local(Vector2::zeros());
            if sensor.x.abs() <= half.x && sensor.y.abs() <= half.y {
                return (0.0, TAU);
            }
            // From outside, every part of the outline is less than half a turn from its middle.
            let (ahead, left) = (at.forward() * half.x, at.left() * half.y);
            let corners = [ahead + left, ahead - left, -ahead - left, -ahead + left].map(|corner| at.position + corner);
            let aside = corners.map(|corner| libm::atan2(at.position.perp(&corner), at.position.dot(&corner)));
            let (least, most) = aside.into_iter().fold((PI, -PI), |(a, b), angle| (a.min(angle), b.max(angle)));
            (middle + least, middle + most)
        }
        Outline::Disc { .. } => (0.0, TAU),
    }
}

/// Returns the distances in metres at which the ray from the sensor enters and leaves an outline, if it does.
fn cut(outline: &Outline, at: &Pose, direction: Vector2<f64>) -> Option<(f64, f64)> {
    let (enters, leaves) = match *outline {
        Outline::Rectangle { .. } => {
            let (from, way) = (at.to_local(Vector2::zeros()), at.turn_to_local(direction));
            let half = outline.half_extent();
            let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
            for axis in 0..2 {
                if way[axis] != 0.0 {
                    let sides = [-half[axis], half[axis]].map(|side| (side - from[axis]) / way[axis]);
                    enters = enters.max(sides[0].min(sides[1]));
                    leaves = leaves.min(sides[0].max(sides[1]));
                } else if from[axis].abs() > half[axis] {
                    return None;
                }
            }
            (enters, leaves)
        }
        Outline::Disc { radius } => {
            let (middle, aside) = (direction.dot(&at.position), direction.perp(&at.position));
            let square = (radius - aside) * (radius + aside);
            if square < 0.0 {
                return None;
            }
            let half = square.sqrt();
            ((middle - half).max(0.0), middle + half)
        }
    };
    (enters <= leaves).then_some((enters, leaves))
}
