//! The speeds of an entity over time that follows targets of speeds at times.

use super::scope::Node;
use crate::xml::ReadError;

/// Targets of speeds, each at a time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Profile {
    /// The entity whose speed at the beginning is added to all speeds; `None` for absolute speeds.
    pub relative_to: Option<usize>,
    /// The seconds since the entry before, and the speed in m/s. Without a time, the limits give the time.
    entries: Vec<(Option<f64>, f64)>,
    /// The limits if the acceleration changes smoothly; `None` if the speed changes evenly between the targets.
    limits: Option<Limits>,
}

/// The greatest accelerations in m/s², and their greatest changes in m/s³, each up and down.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Limits {
    acceleration: [f64; 2],
    jerk: [f64; 2],
}

/// A profile that has begun: pieces of even jerk.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Course(Vec<Piece>);

/// A piece of a course, with the values at its beginning.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    time: f64,
    speed: f64,
    acceleration: f64,
    jerk: f64,
}

impl Profile {
    /// Reads an element `SpeedProfileAction`. `relative_to` is the entity that it names.
    pub fn read(node: Node<'_>, relative_to: Option<usize>) -> Result<Self, ReadError> {
        let entry = |entry: Node<'_>| {
            let time = entry.element.text("time").map(|_| entry.length("time")).transpose()?;
            Ok((time, entry.speed("speed")?))
        };
        let entries = node.all("SpeedProfileEntry").map(entry).collect::<Result<Vec<_>, ReadError>>()?;
        if entries.is_empty() {
            return Err(node.element.lacks("SpeedProfileEntry"));
        }
        let follows = node.one_of("followingMode", &[("follow", true), ("position", false)])?;
        let constraints = node.first("DynamicConstraints");
        let most = |name| match constraints.filter(|given| given.element.text(name).is_some()) {
            Some(given) => given.positive(name),
            None => Ok(f64::INFINITY),
        };
        let limits = Limits {
            acceleration: [most("maxAcceleration")?, most("maxDeceleration")?],
            jerk: [most("maxAccelerationRate")?, most("maxDecelerationRate")?],
        };
        let needs = entries.iter().any(|(time, _)| time.is_none());
        Ok(Self { relative_to, entries, limits: (follows || needs).then_some(limits) })
    }

    /// Returns the profile of an entity with the given greatest accelerations in m/s², up and down, where the profile has no limits of its
    /// own. Returns `None` if a target needs a limit and there is none.
    pub fn of_entity(&self, own: [f64; 2]) -> Option<Self> {
        let mut profile = self.clone();
        if let Some(limits) = &mut profile.limits {
            for (limit, own) in limits.acceleration.iter_mut().zip(own) {
                *limit = if limit.is_finite() { *limit } else { own };
            }
            let needs = self.entries.iter().any(|(time, _)| time.is_none());
            if needs && !limits.acceleration.iter().all(|limit| limit.is_finite()) {
                return None;
            }
        }
        Some(profile)
    }

    /// Begins the profile at the time 0 with a speed and an acceleration. `added` is added to all speeds.
    pub fn begin(&self, speed: f64, acceleration: f64, added: f64) -> Course {
        let mut targets = vec![(0.0, speed)];
        for (time, speed) in &self.entries {
            let (before, from) = targets[targets.len() - 1];
            let change = speed + added - from;
            let least = self.limits.map_or(0.0, |limits| change.abs() / limits.acceleration[usize::from(change < 0.0)]);
            let time = before + time.unwrap_or(0.0).max(least);
            if time > before {
                targets.push((time, speed + added));
            } else if let Some(last) = targets.last_mut() {
                // A target at once is the speed at the beginning.
                last.1 = if self.limits.is_some() { last.1 } else { speed + added };
            }
        }
        Course::through(&targets, acceleration, self.limits.map(|limits| limits.jerk))
    }
}

impl Course {
    /// Joins the straight lines between targets by pieces of the greatest jerk. Such a piece begins and ends at the same distance in
    /// time from the crossing of its lines. The first one begins at once, so that the first line is later than its targets. Where there is
    /// no time for a piece, the acceleration jumps.
    fn through(targets: &[(f64, f64)], acceleration: f64, jerk: Option<[f64; 2]>) -> Self {
        let slopes = targets.windows(2).map(|pair| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0));
        let mut pieces = vec![Piece { time: targets[0].0, speed: targets[0].1, acceleration, jerk: 0.0 }];
        for ((time, speed), slope) in targets.iter().zip(slopes.chain([0.0])) {
            let last = pieces[pieces.len() - 1];
            let change = slope - last.acceleration;
            let rate = jerk.map_or(f64::INFINITY, |jerk| if change < 0.0 { -jerk[1] } else { jerk[0] });
            let span = (change / rate).max(0.0);
            let is_first = pieces.len() == 1;
            let crossing = if is_first || change == 0.0 {
                last.time + 0.5 * span
            } else {
                // Where the last line is as fast as the line through the target.
                (speed - slope * time - last.speed + last.acceleration * last.time) / (last.acceleration - slope)
            };
            let begin = crossing - 0.5 * span;
            if span > 0.0 && begin >= last.time {
                let start = Piece { jerk: rate, ..last.moved(begin) };
                let end = Piece { jerk: 0.0, acceleration: slope, ..start.moved(begin + span) };
                pieces.extend([start, end]);
            } else {
                let time = time.max(last.time);
                pieces.push(Piece { speed: last.moved(time).speed, time, acceleration: slope, jerk: 0.0 });
            }
        }
        Self(pieces)
    }

    /// Returns the speed in m/s at a time in seconds since the beginning, and `true` from the last target on.
    pub fn at(&self, time: f64) -> (f64, bool) {
        let next = self.0.partition_point(|piece| piece.time <= time + TOLERANCE);
        (self.0[next.max(1) - 1].moved(time).speed, next == self.0.len())
    }
}

/// A sum of ticks that falls short of a time by less is the time.
const TOLERANCE: f64 = 1e-9;

impl Piece {
    /// Returns the piece from a later time on.
    fn moved(self, time: f64) -> Self {
        let seconds = time - self.time;
        Self {
            time,
            speed: self.speed + (self.acceleration + 0.5 * self.jerk * seconds) * seconds,
            acceleration: self.acceleration + self.jerk * seconds,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_change_evenly_between_targets_without_limits() {
        let course = Course::through(&[(0.0, 2.0), (4.0, 10.0), (6.0, 4.0)], 0.0, None);
        for (time, speed) in [(0.0, 2.0), (1.0, 4.0), (4.0, 10.0), (5.0, 7.0), (9.0, 4.0)] {
            assert!((course.at(time).0 - speed).abs() < 1e-9, "at {time} s: {:?}", course.at(time));
        }
        assert!(!course.at(5.9).1 && course.at(6.0).1);
    }

    #[test]
    fn a_jerk_rounds_the_corners_of_a_course() {
        let course = Course::through(&[(0.0, 0.0), (4.0, 8.0)], 0.0, Some([2.0, 4.0]));
        // The acceleration of 2 m/s² is reached after 1 s, and is given up in half a second.
        for (time, speed) in [(1.0, 1.0), (2.0, 3.0), (4.0, 7.0), (9.0, 8.0)] {
            assert!((course.at(time).0 - speed).abs() < 1e-9, "at {time} s: {:?}", course.at(time));
        }
        let step = |time: f64| (course.at(time + 1e-3).0 - 2.0 * course.at(time).0 + course.at(time - 1e-3).0) / 1e-6;
        assert!((step(4.5) + 4.0).abs() < 1e-3, "{}", step(4.5));
    }
}
