//! Finds the worst of the tests that the world could show, so that a pedestrian at 35 km/h is not the headline of a campaign.

use crate::Summary;
use paracosm_campaign::Log;
use paracosm_space::{Domain, Record, Value, Values};

/// The plausible tests of a campaign: those whose values lie within the ranges that the scenario calls plausible.
#[derive(Debug, Clone, Default)]
pub struct Plausible {
    /// The least and the greatest plausible value of each open parameter that has other values in the campaign.
    pub ranges: Record<[f64; 2]>,
    /// The summary of the plausible tests.
    pub summary: Summary,
}

impl Plausible {
    /// Looks at the trials of a campaign; `None` if the scenario calls all values of the open parameters plausible, or if the scenario is
    /// not known.
    pub fn of(log: &Log) -> Option<Self> {
        let declared = log.study().program().ok()?.declare().ok()?.parameters;
        let range = |name: &str| declared.iter().find(|declared| declared.parameter.name == name)?.plausible();
        let has_others = |domain: &Domain, [least, most]: [f64; 2]| match domain {
            Domain::Interval { lo, hi } => *lo < least || *hi > most,
            Domain::Choice(levels) => levels.iter().any(|level| !is_within(level, [least, most])),
        };
        let ranges = log.study().space().parameters().iter().filter_map(|parameter| {
            let range = range(&parameter.name).filter(|range| has_others(&parameter.domain, *range))?;
            Some((parameter.name.clone(), range))
        });
        let mut plausible = Self { ranges: ranges.collect(), summary: Summary::default() };
        plausible.ranges.iter().next()?;
        for trial in log.trials() {
            // A test that broke says nothing.
            if trial.covers() && plausible.takes(&trial.test) {
                plausible.summary.add(trial);
            }
        }
        Some(plausible)
    }

    /// Returns true if all values of a test are plausible.
    pub fn takes(&self, test: &Values) -> bool {
        let is_plausible = |(name, range): (&str, &[f64; 2])| {
            test.get(name).is_none_or(|value| value.scalars().iter().all(|value| is_within(value, *range)))
        };
        self.ranges.iter().all(is_plausible)
    }
}

fn is_within(value: &Value, [least, most]: [f64; 2]) -> bool {
    value.number().is_some_and(|number| (least..=most).contains(&number))
}
