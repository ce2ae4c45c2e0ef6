//! Gives a campaign the points of Euro NCAP, if the campaign ran every test of a grid of the protocol.
//!
//! The bands, the ranges and the points are those of the protocol *Crash Avoidance, Frontal Collisions* 1.2 for 2026, as the rating
//! calculator of Euro NCAP has them (the Python package `euroncap-rating-2026`). The calculator judges this module in a test. Euro NCAP
//! drives real cars, checks predictions of the manufacturer, and adds the points of further scenarios to a rating in stars. A simulation
//! cannot do that: these are points on one grid.

use paracosm_campaign::{JsonArtefact, Log, Study};
use paracosm_space::{Value, Values, plural};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// The protocol of the points, with its version.
pub const PROTOCOL: &str = "Euro NCAP Crash Avoidance, Frontal Collisions 1.2 (2026)";

/// A grid of tests that the protocol gives points for.
#[derive(Debug)]
pub struct Grid {
    /// The name in the protocol.
    pub name: &'static str,
    /// The name of the scenario whose tests are on the grid.
    pub scenario: &'static str,
    /// The points if every test of the grid ends without a contact.
    pub points: f64,
    /// The values of the parameters that vary on the grid. The first is the speed of the car under test in km/h.
    axes: &'static [(&'static str, &'static [f64])],
    /// The value of a parameter that is a word, and the same in all tests of the grid.
    fixed: Option<(&'static str, &'static str)>,
}

/// The speeds of a car that meets a pedestrian, in km/h.
const TO_PEDESTRIANS: &[f64] = &[10.0, 20.0, 30.0, 40.0, 50.0, 60.0];
/// The speeds of a car that comes upon a standing car, in km/h.
const TO_CARS: &[f64] = &[10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];

/// The standard ranges of the protocol that scenarios of the catalogue can run as a whole, in the order of the protocol. An overlap of 50, 75
/// and 100 % is an impact location of 0, 25 and 50 % there, or of 100, 75 and 50 % on the other side.
static GRIDS: [Grid; 4] = [
    Grid {
        name: "CCRs",
        scenario: "ncap-ccr",
        points: 1.2,
        axes: &[("ego_speed", TO_CARS), ("overlap", &[-50.0, -75.0, 100.0, 75.0, 50.0])],
        fixed: Some(("target", "standing")),
    },
    Grid {
        name: "CPNA day",
        scenario: "ncap-cpna",
        points: 0.5,
        axes: &[("ego_speed", TO_PEDESTRIANS), ("impact", &[25.0, 50.0, 75.0])],
        fixed: None,
    },
    Grid { name: "CPFA day", scenario: "ncap-cpfa", points: 0.5, axes: &[("ego_speed", TO_PEDESTRIANS)], fixed: None },
    Grid {
        name: "CPNCO day",
        scenario: "ncap-cpnco",
        points: 1.0,
        axes: &[("ego_speed", TO_PEDESTRIANS)],
        fixed: None,
    },
];

/// Returns the grid that a scenario runs tests of; `None` if there is none.
pub fn grid(scenario: &str) -> Option<&'static Grid> {
    GRIDS.iter().find(|grid| grid.scenario == scenario)
}

/// The points of a campaign on a grid of Euro NCAP.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Points {
    /// The protocol with its version.
    pub protocol: &'static str,
    /// The name of the grid in the protocol.
    pub grid: &'static str,
    /// The number of tests on the grid.
    pub cells: usize,
    /// The number of tests on the grid that the campaign ran, and in which the situation came about.
    pub ran: usize,
    /// The number of tests on the grid in which the situation never came about: the car was too slow, say.
    pub without_situation: usize,
    /// The fixed parameters whose value is not the value of the protocol, in words.
    pub other: Vec<String>,
    /// The points; `None` if a test of the grid has not run, or if its situation never came about.
    pub points: Option<f64>,
    /// The greatest number of points on the grid.
    pub of: f64,
}

impl Points {
    /// Looks at the trials of a campaign. `None` if the scenario runs no tests of a grid of the protocol, or if a perceiver is on trial. If
    /// two tests are at the same place of the grid, the worse one counts.
    pub fn of(log: &Log) -> Option<Self> {
        let study = log.study();
        if study.perceiver().is_some() {
            return None;
        }
        let scenario = study.subject().scenario().ok()?.scenario();
        let grid = grid(scenario)?;
        let nominal = nominal(study)?;
        let mut shares: BTreeMap<Vec<usize>, f64> = BTreeMap::new();
        let mut missed = BTreeSet::new();
        for trial in log.trials().iter().filter(|trial| trial.covers()) {
            let Some(place) = grid.place(&study.complete(&trial.test), &nominal) else { continue };
            if trial.contact().is_none() && trial.triggered() != Some(true) {
                missed.insert(place);
            } else {
                let share = share(grid.axes[0].1[place[0]], trial.contact().map_or(0.0, |contact| 3.6 * contact.speed));
                let worst = shares.entry(place).or_insert(share);
                *worst = worst.min(share);
            }
        }
        let (cells, ran, without_situation) = (grid.cells(), shares.len(), missed.len());
        let is_whole = ran == cells && without_situation == 0;
        let points = is_whole.then(|| grid.points * shares.values().sum::<f64>() / cells as f64);
        let (protocol, name, of) = (PROTOCOL, grid.name, grid.points);
        let other = grid.other(study.fixed(), &nominal);
        Some(Self { protocol, grid: name, cells, ran, without_situation, other, points, of })
    }

    /// Describes the points in words, or why there are none.
    pub fn in_words(&self) -> String {
        let Self { grid, cells, ran, without_situation, other, points, of, .. } = self;
        match points {
            Some(points) => format!("{points:.3} of {of:.3}: {grid}, {}", plural(*cells, "test")),
            None if *without_situation > 0 => {
                let missed = plural(*without_situation, "test");
                format!("none: in {missed} of {grid}, the situation never came about")
            }
            None if !other.is_empty() => format!("none: {}", other.join(", ")),
            None => format!("none: {ran} of the {cells} tests of {grid} have run"),
        }
    }
}

impl JsonArtefact for Points {
    const FILE: &'static str = "points.json";
}

impl Grid {
    /// Returns the number of tests on the grid.
    pub fn cells(&self) -> usize {
        self.axes.iter().map(|(_, values)| values.len()).product()
    }

    /// Says which fixed parameters have another value than in the protocol.
    fn other(&self, fixed: &Values, nominal: &Values) -> Vec<String> {
        let words = |(name, value): (&str, &Value)| {
            let is_axis = self.axes.iter().any(|(axis, _)| *axis == name);
            let expected = match self.fixed {
                Some((of_protocol, word)) if name == of_protocol => word.to_owned(),
                _ => nominal.get(name)?.to_string(),
            };
            let found = value.to_string();
            (!is_axis && found != expected).then(|| format!("{name} is {found}, the protocol has {expected}"))
        };
        fixed.iter().filter_map(words).collect()
    }

    /// Returns the options of a campaign that runs every test of the grid.
    pub fn options(&self) -> String {
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let fixed = self.fixed.map(|(name, value)| format!("--set {name}={value} ")).unwrap_or_default();
        let open = self.axes.iter().map(|(name, values)| format!("--open {name}={} ", list(values)));
        format!("{fixed}{}--discrete cross --budget {}", open.collect::<String>(), self.cells())
    }

    /// Returns the place of a test on each axis; `None` if the test is beside the grid, or another parameter is not nominal.
    fn place(&self, values: &Values, nominal: &Values) -> Option<Vec<usize>> {
        let is_as_it_must = |(name, value): (&str, &Value)| match self.fixed {
            Some((fixed, word)) if name == fixed => value.to_string() == word,
            _ => self.axes.iter().any(|(axis, _)| *axis == name) || Some(value) == nominal.get(name),
        };
        let at = |(name, places): &(&str, &[f64])| {
            let value = values.get(name).or_else(|| nominal.get(name))?.number()?;
            places.iter().position(|place| *place == value)
        };
        values.iter().all(is_as_it_must).then(|| self.axes.iter().map(at).collect())?
    }
}

/// Returns the share of its points that a test gets. Both speeds are in km/h: that of the car at the beginning, and that of the impact, 0 without
/// an impact. A car that drives 50 km/h or more gets three, two or one quarter for an impact below 10, 20 or 30 km/h. A slower car starts at a
/// lower band, and gets nothing for any impact from 20 km/h down (section 5.2 of the protocol).
fn share(speed: f64, impact: f64) -> f64 {
    if impact <= 0.0 {
        return 1.0;
    }
    let first = ((50.0 - speed) / 10.0).clamp(0.0, 3.0);
    (0.75 - 0.25 * (first + (impact / 10.0).floor())).max(0.0)
}

/// Returns the nominal value of each parameter of the scenario.
fn nominal(study: &Study) -> Option<Values> {
    let declared = study.program().ok()?.declare().ok()?.parameters;
    Some(declared.iter().map(|declared| (declared.parameter.name.clone(), declared.nominal())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share by the upper edges of the bands of impact speeds in km/h, as the calculator lists them.
    fn band(speed: f64, impact: f64) -> f64 {
        let bands: &[(f64, f64)] = match speed {
            10.0 | 20.0 => &[(f64::INFINITY, 0.0)],
            30.0 => &[(10.0, 0.25), (f64::INFINITY, 0.0)],
            40.0 => &[(10.0, 0.5), (20.0, 0.25), (f64::INFINITY, 0.0)],
            _ => &[(10.0, 0.75), (20.0, 0.5), (30.0, 0.25), (f64::INFINITY, 0.0)],
        };
        if impact == 0.0 { 1.0 } else { bands.iter().find(|(above, _)| impact < *above).unwrap().1 }
    }

    #[test]
    fn shares_are_those_of_the_bands_at_every_speed_also_at_their_edges() {
        for speed in TO_CARS {
            for impact in
                (0..=80).flat_map(|speed| [f64::from(speed), f64::from(speed) + 0.5, f64::from(speed).next_down()])
            {
                let impact = impact.max(0.0);
                assert_eq!(share(*speed, impact), band(*speed, impact), "{speed} km/h, impact at {impact} km/h");
            }
        }
    }
}
