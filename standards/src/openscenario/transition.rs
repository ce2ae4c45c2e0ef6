//! Transitions from a value to another value: their shapes, and the times that they take.

use super::names::Names;
use super::scope::Node;
use crate::xml::ReadError;
use std::f64::consts::{FRAC_PI_2, PI};

/// The way in which a value changes to another value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dynamics {
    pub shape: Shape,
    pub extent: Extent,
}

/// The shape of a transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Linear,
    Cubic,
    Sinusoidal,
    Step,
}

/// The extent of a transition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Extent {
    /// The transition takes so many seconds.
    Time(f64),
    /// The entity travels so many metres during the transition.
    Distance(f64),
    /// The greatest rate of change during the transition.
    Rate(f64),
}

/// A transition that has begun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transition {
    pub start: f64,
    pub target: f64,
    shape: Shape,
    /// The seconds or metres that the transition takes.
    span: f64,
    /// `true` if the span is in metres.
    by_distance: bool,
    /// The seconds or metres so far.
    done: f64,
}

pub(super) const SHAPES: [(&str, Shape); 4] =
    [("linear", Shape::Linear), ("cubic", Shape::Cubic), ("sinusoidal", Shape::Sinusoidal), ("step", Shape::Step)];

impl Shape {
    /// Returns the share of the change after a share `p` of the span, in [0, 1].
    fn share(self, p: f64) -> f64 {
        match self {
            Self::Linear => p,
            Self::Cubic => p * p * (3.0 - 2.0 * p),
            Self::Sinusoidal => 0.5 * (1.0 - libm::cos(PI * p)),
            Self::Step => 1.0,
        }
    }

    /// Returns the derivative of [`Shape::share`].
    fn slope(self, p: f64) -> f64 {
        match self {
            Self::Linear => 1.0,
            Self::Cubic => 6.0 * p * (1.0 - p),
            Self::Sinusoidal => FRAC_PI_2 * libm::sin(PI * p),
            Self::Step => 0.0,
        }
    }

    /// Returns the greatest slope of the shape.
    fn steepest(self) -> f64 {
        match self {
            Self::Linear => 1.0,
            Self::Cubic => 1.5,
            Self::Sinusoidal => FRAC_PI_2,
            Self::Step => 0.0,
        }
    }

    /// Returns the mean magnitude of a value that changes from `start` to `target`.
    fn mean_magnitude(self, start: f64, target: f64) -> f64 {
        let at = |part: usize| start + (target - start) * self.share((part as f64 + 0.5) / PARTS as f64);
        (0..PARTS).map(|part| at(part).abs()).sum::<f64>() / PARTS as f64
    }

    /// Returns the seconds that a change by `change` takes if the second derivative is at most `most`.
    pub fn time_within(self, change: f64, most: f64) -> f64 {
        let second = match self {
            Self::Linear | Self::Step => 0.0,
            Self::Cubic => 6.0,
            Self::Sinusoidal => 0.5 * PI * PI,
        };
        (second * change.abs() / most).sqrt()
    }
}

impl Dynamics {
    /// Reads an element such as `SpeedActionDynamics`. The sign of a rate has no effect: the target gives the direction.
    pub fn read(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let shape = node.one_of("dynamicsShape", &SHAPES)?;
        let extent: fn(f64) -> Extent = node.one_of(
            "dynamicsDimension",
            &[
                ("time", Extent::Time as fn(f64) -> Extent),
                ("distance", Extent::Distance),
                ("rate", |rate: f64| Extent::Rate(rate.abs())),
            ],
        )?;
        let value = match extent(0.0) {
            Extent::Rate(_) => {
                let rate = node.number("value")?;
                if rate < 0.0 {
                    let reason = "the sign of a rate changes nothing: the target gives the direction";
                    names.catalogs.remark(node, "value", reason);
                }
                rate
            }
            _ => node.length("value")?,
        };
        Ok(Self { shape, extent: extent(value) })
    }

    /// Begins a transition.
    pub fn from(self, start: f64, target: f64) -> Transition {
        let change = (target - start).abs();
        let (span, by_distance) = match self.extent {
            _ if self.shape == Shape::Step || change == 0.0 => (0.0, false),
            Extent::Time(seconds) => (seconds, false),
            Extent::Distance(metres) => (metres, true),
            Extent::Rate(rate) => (self.shape.steepest() * change / rate, false),
        };
        Transition { start, target, shape: self.shape, span, by_distance, done: 0.0 }
    }

    /// Begins a transition of the speed itself. A distance stands for the time in which the entity covers the distance, because a speed
    /// that followed the distance would never leave 0.
    pub fn of_speed(self, start: f64, target: f64) -> Transition {
        match self.extent {
            Extent::Distance(metres) => {
                let seconds = metres / self.shape.mean_magnitude(start, target);
                Self { extent: Extent::Time(seconds), ..self }.from(start, target)
            }
            _ => self.from(start, target),
        }
    }
}

impl Transition {
    /// Returns the same transition at a rate of change of at most `most` by the second. A step has no rate.
    pub fn within(self, most: f64) -> Self {
        let least = self.shape.steepest() * (self.target - self.start).abs() / most;
        if self.by_distance || self.shape == Shape::Step { self } else { Self { span: self.span.max(least), ..self } }
    }

    /// Returns the value at the present place of the transition.
    pub fn value(&self) -> f64 {
        if self.is_over() {
            return self.target;
        }
        self.start + (self.target - self.start) * self.shape.share(self.done / self.span)
    }

    /// Returns the rate at which the value changes, by the second; 0 for a transition by distance.
    pub fn rate(&self) -> f64 {
        if self.is_over() || self.by_distance {
            return 0.0;
        }
        (self.target - self.start) * self.shape.slope(self.done / self.span) / self.span
    }

    /// Returns `true` if the value is the target. A transition at the rate 0 never ends.
    pub fn is_over(&self) -> bool {
        self.done >= self.span - TOLERANCE
    }

    /// Moves the transition on by a tick of `dt` seconds in which the entity travels `metres` metres.
    pub fn advance(&mut self, dt: f64, metres: f64) {
        self.done += if self.by_distance { metres } else { dt };
    }
}

/// The number of parts of a transition in which its mean is summed up.
const PARTS: usize = 1000;
/// A sum of ticks that falls short of a span by less is the span.
const TOLERANCE: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_the_greatest_rate_of_the_transition() {
        for (_, shape) in SHAPES.into_iter().filter(|(_, shape)| *shape != Shape::Step) {
            let mut transition = Dynamics { shape, extent: Extent::Rate(2.0) }.from(1.0, -4.0);
            let (mut greatest, mut before): (f64, f64) = (0.0, transition.value());
            for _ in 0..2000 {
                transition.advance(0.005, 0.0);
                greatest = greatest.max((transition.value() - before).abs() / 0.005);
                before = transition.value();
            }
            assert!((greatest - 2.0).abs() < 1e-3, "{shape:?}: {greatest}");
            assert!(transition.is_over() && transition.value() == -4.0);
        }
    }

    #[test]
    fn a_speed_changes_within_its_distance() {
        for (_, shape) in SHAPES.into_iter().filter(|(_, shape)| *shape != Shape::Step) {
            for (start, target) in [(0.0, 20.0), (30.0, 0.0), (10.0, 14.0), (5.0, -5.0), (8.0, -2.0), (0.0, -3.0)] {
                let mut transition = Dynamics { shape, extent: Extent::Distance(40.0) }.of_speed(start, target);
                let mut metres = 0.0;
                while !transition.is_over() {
                    transition.advance(0.001, 0.0);
                    metres += transition.value().abs() * 0.001;
                }
                assert!((metres - 40.0).abs() < 0.05, "{shape:?} from {start} to {target}: {metres} m");
            }
        }
    }

    #[test]
    fn an_acceleration_limits_the_time_of_a_transition() {
        for shape in [Shape::Cubic, Shape::Sinusoidal] {
            let span = shape.time_within(1.5, 0.3);
            let at = |seconds: f64| 1.5 * shape.share(seconds / span);
            let bend = |at_seconds: f64| (at(at_seconds) - 2.0 * at(at_seconds - 1e-3) + at(at_seconds - 2e-3)) / 1e-6;
            assert!((bend(2e-3) - 0.3).abs() < 2e-3, "{shape:?}: {}", bend(2e-3));
        }
    }
}
