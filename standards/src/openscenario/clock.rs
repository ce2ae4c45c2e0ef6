//! The time of day in a scenario.

use super::moment::moment;
use super::scope::Node;
use crate::xml::ReadError;

/// A time of day that begins at a moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Clock {
    /// The seconds since the beginning of the year 1970 in Greenwich.
    pub seconds: f64,
    /// The seconds by which clocks at the place of the scenario are ahead of clocks in Greenwich.
    zone: f64,
    /// `true` if the time goes on during the run, `false` if it stands.
    pub runs: bool,
}

impl Clock {
    /// Reads an element `TimeOfDay`.
    pub fn read(node: Node<'_>) -> Result<Self, ReadError> {
        let (seconds, zone) = time(node)?;
        Ok(Self { seconds, zone, runs: node.truth_or("animation", false)? })
    }

    /// Returns the seconds since the beginning of the year 1970 at the place of the scenario.
    pub fn local(&self) -> f64 {
        self.seconds + self.zone
    }

    /// Returns a clock that stands at a time.
    #[cfg(test)]
    pub fn at(text: &str) -> Self {
        let (seconds, zone) = moment(text).expect("it is a time");
        Self { seconds, zone, runs: false }
    }
}

/// Returns the seconds since the beginning of the year 1970 that an attribute `dateTime` gives.
pub(super) fn seconds(node: Node<'_>) -> Result<f64, ReadError> {
    time(node).map(|(seconds, _)| seconds)
}

/// Returns the time of an attribute `dateTime`, and its zone.
fn time(node: Node<'_>) -> Result<(f64, f64), ReadError> {
    let text = node.required("dateTime")?;
    let wrong = || node.element.unexpected_value("dateTime", &text, "a time such as 2026-01-31T12:00:00", []);
    moment(&text).ok_or_else(wrong)
}
