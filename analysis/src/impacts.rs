//! Says how severe the contacts of a campaign are, by the speed of the ego vehicle.

use paracosm_campaign::Log;
use serde::Serialize;

/// The impact speeds of a campaign, each the speed of the ego vehicle at its first contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Impacts {
    /// The number of tests with a contact.
    pub contacts: usize,
    /// The median of the impact speeds, in m/s: of an even number, the higher of both in the middle.
    pub median: f64,
    /// The greatest impact speed, in m/s.
    pub greatest: f64,
    /// The index of the first test with the greatest impact speed.
    pub index: usize,
}

impl Impacts {
    /// Looks at the trials of a campaign; `None` if no trial has a contact.
    pub fn of(log: &Log) -> Option<Self> {
        let speed = |trial: &paracosm_campaign::Trial| Some((trial.contact()?.speed, trial.index));
        let mut speeds: Vec<(f64, usize)> = log.trials().iter().filter_map(speed).collect();
        // The first of equal speeds is the last in this order.
        speeds.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let (greatest, index) = *speeds.last()?;
        Some(Self { contacts: speeds.len(), median: speeds[speeds.len() / 2].0, greatest, index })
    }
}
