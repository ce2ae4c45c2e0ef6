//! The results of a perceiver over a campaign: recall, false alarms, encounters and the risk to miss one, and recall by
//! distance, height and visible share; or the pixels of a segmentation network.
//!
//! Images of one test resemble each other, so that statistics count tests: intervals come from resampled tests.

use crate::statistics::{bootstrap_interval, clopper_pearson};
use paracosm_campaign::{JsonArtefact, Log, Metric, Trial};
use paracosm_generators::Strategy;
use paracosm_perception::BINS;
use paracosm_space::plural;
use serde::Serialize;

/// The confidence of the intervals.
const CONFIDENCE: f64 = 0.95;

/// The results of a perceiver over a campaign.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Perceived {
    /// The name of the perceiver.
    pub perceiver: String,
    /// The number of tests that the perceiver finished.
    pub tests: usize,
    /// The number of images.
    pub images: u64,
    /// The results of a detector.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detection: Option<Detected>,
    /// The results of a segmentation network.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segmentation: Option<Segmented>,
}

/// The results of a detector.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Detected {
    /// The number of road users that should be detected, over all images.
    pub objects: u64,
    /// The number of these road users that were matched.
    pub matches: u64,
    /// The share of matches; `None` without road users.
    pub recall: Option<f64>,
    /// The number of detections without a road user in an image, on average.
    pub false_alarms_per_image: f64,
    /// The number of encounters: times during which a road user should be detected.
    pub encounters: u64,
    /// The number of encounters during which the road user was never matched.
    pub missed_encounters: u64,
    /// The probability to miss an encounter; `None` without encounters.
    pub risk: Option<Risk>,
    /// The mean time in seconds from the beginning of an encounter to the first match; `None` without a match.
    pub delay: Option<f64>,
    /// The average precision at an overlap of 0.5, on average over the tests; `None` without road users.
    pub average_precision: Option<f64>,
    /// The recall by distance, height and visible share. Road users that need not be detected count, too.
    pub ranges: Vec<RangeRecall>,
}

/// The probability to miss an encounter, and its interval.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Risk {
    /// The share of missed encounters.
    pub probability: f64,
    /// The interval of 95 %, from resampled tests. If no encounter is missed, its upper end is the bound of Clopper and Pearson for the
    /// share of tests with a miss, among the tests with an encounter. If all are missed, its lower end is their bound for the share of
    /// tests in which all are missed. `None` if the strategy searches for failures,
    /// because its tests then are no sample.
    pub interval: Option<[f64; 2]>,
}

/// The recall of road users in a range of a property.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RangeRecall {
    /// The name of the range, for example `distance-10-20`.
    pub range: String,
    /// The range in words.
    pub words: String,
    /// The number of road users, over all images.
    pub objects: u64,
    /// The number of road users that were matched.
    pub matches: u64,
}

/// The results of a segmentation network, over all pixels of all images.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Segmented {
    /// The intersection over union of the mask and the true mask.
    pub overlap: f64,
    /// The share of the true mask that the mask has.
    pub recall: f64,
    /// The share of the mask that is true.
    pub precision: f64,
}

impl JsonArtefact for Perceived {
    const FILE: &'static str = "perception.json";
}

impl Perceived {
    /// Computes the results of the perceiver of a campaign; `None` if no perceiver is on trial, or no test has a result.
    pub fn of(log: &Log) -> Option<Self> {
        let perceiver = log.study().perceiver()?.name().to_owned();
        let tests: Vec<Counts> = log.trials().iter().filter_map(Counts::of).collect();
        let sum = |name: &str| tests.iter().map(|test| test.number(name)).sum::<f64>();
        if tests.is_empty() {
            return None;
        }
        let images = sum("images");
        let is_detector = tests.iter().any(|test| test.get("objects").is_some());
        // Tests that were chosen by hand or from earlier results say nothing about other tests.
        let strategy = log.study().sampling().strategy;
        let is_sample = !strategy.is_adaptive() && strategy != Strategy::GIVEN;
        Some(Self {
            perceiver,
            tests: tests.len(),
            images: images as u64,
            detection: is_detector.then(|| Detected::of(&tests, images, is_sample)),
            segmentation: (!is_detector).then(|| {
                let [both, answered, missed] = ["true_positives", "false_positives", "false_negatives"].map(sum);
                Segmented {
                    overlap: both / (both + answered + missed),
                    recall: both / (both + missed),
                    precision: both / (both + answered),
                }
            }),
        })
    }
}

impl Detected {
    fn of(tests: &[Counts], images: f64, is_sample: bool) -> Self {
        let sum = |name: &str| tests.iter().map(|test| test.number(name)).sum::<f64>();
        let [objects, matches, encounters, missed] = ["objects", "matches", "encounters", "missed_encounters"].map(sum);
        let mean = |values: &[(f64, f64)]| {
            let weight: f64 = values.iter().map(|(weight, _)| weight).sum();
            (weight > 0.0).then(|| values.iter().map(|(weight, value)| weight * value).sum::<f64>() / weight)
        };
        let delays = tests.iter().filter_map(|test| {
            Some((test.number("encounters") - test.number("missed_encounters"), test.get("delay")?))
        });
        let precisions = tests.iter().filter_map(|test| Some((1.0, test.get("average_precision")?)));
        let range = |name: String, words: String| {
            let count = |of: &str| sum(&format!("{of}.{name}")) as u64;
            RangeRecall { objects: count("objects"), matches: count("matches"), range: name, words }
        };
        let ranges = BINS.iter().map(|bin| range(bin.name(), bin.words()));
        Self {
            objects: objects as u64,
            matches: matches as u64,
            recall: (objects > 0.0).then(|| matches / objects),
            false_alarms_per_image: if images > 0.0 { sum("false_alarms") / images } else { 0.0 },
            encounters: encounters as u64,
            missed_encounters: missed as u64,
            risk: (encounters > 0.0).then(|| Risk {
                probability: missed / encounters,
                interval: is_sample.then(|| interval(tests, missed, encounters)),
            }),
            delay: mean(&delays.collect::<Vec<_>>()),
            average_precision: mean(&precisions.collect::<Vec<_>>()),
            ranges: ranges.filter(|range| range.objects > 0).collect(),
        }
    }

    /// Returns the encounters in words, for example "3 of 40 missed (7.5 %, 95 % interval 2.1 to 14.6 %, by tests)".
    pub fn encounters_in_words(&self) -> String {
        let percent = |share: f64| format!("{:.1}", 100.0 * share);
        let missed = format!("{} of {} missed", self.missed_encounters, plural(self.encounters as usize, "encounter"));
        match &self.risk {
            Some(Risk { probability, interval: Some([low, high]) }) => format!(
                "{missed} ({} %, {:.0} % interval {} to {} %, by tests)",
                percent(*probability),
                100.0 * CONFIDENCE,
                percent(*low),
                percent(*high)
            ),
            Some(Risk { probability, interval: None }) => {
                format!(
                    "{missed} ({} %; no probability, because the strategy searches for failures)",
                    percent(*probability)
                )
            }
            None => missed,
        }
    }
}

/// Returns the interval of the risk to miss an encounter, by tests.
fn interval(tests: &[Counts], missed: f64, encounters: f64) -> [f64; 2] {
    let with_encounters = tests.iter().filter(|test| test.number("encounters") > 0.0).count();
    // Resamples of tests that are all the same say nothing; tests with one outcome bound the share of tests with another outcome.
    if missed == 0.0 {
        return [0.0, clopper_pearson(0, with_encounters, CONFIDENCE)[1]];
    }
    if missed == encounters {
        return [clopper_pearson(with_encounters, with_encounters, CONFIDENCE)[0], 1.0];
    }
    let counts: Vec<[f64; 2]> =
        tests.iter().map(|test| [test.number("missed_encounters"), test.number("encounters")]).collect();
    bootstrap_interval(counts.len(), |chosen| {
        let [missed, all] =
            chosen.iter().fold([0.0; 2], |[missed, all], place| [missed + counts[*place][0], all + counts[*place][1]]);
        if all > 0.0 { missed / all } else { 0.0 }
    })
}

/// The numbers of a perceiver in a test.
struct Counts(Vec<(String, f64)>);

impl Counts {
    /// Returns the numbers of a test; `None` if the perceiver has none.
    fn of(trial: &Trial) -> Option<Self> {
        let numbers = trial.metrics().into_iter().filter_map(|(name, metric)| match metric {
            Metric::Number(number) => Some((name.strip_prefix("perception.")?.to_owned(), number)),
            _ => None,
        });
        let numbers: Vec<_> = numbers.collect();
        (!numbers.is_empty()).then_some(Self(numbers))
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, number)| *number)
    }

    fn number(&self, name: &str) -> f64 {
        self.get(name).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_risk_from_tests_that_all_end_alike_has_the_interval_of_their_number() {
        let test = |missed: f64, encounters: f64| {
            Counts(vec![("missed_encounters".into(), missed), ("encounters".into(), encounters)])
        };
        // A test without an encounter says nothing, however many there are.
        let with_idle =
            |tests: [Counts; 3]| tests.into_iter().chain((0..97).map(|_| test(0.0, 0.0))).collect::<Vec<_>>();
        let missed = interval(&with_idle([test(1.0, 1.0), test(1.0, 1.0), test(1.0, 1.0)]), 3.0, 3.0);
        let found = interval(&with_idle([test(0.0, 1.0), test(0.0, 1.0), test(0.0, 1.0)]), 0.0, 3.0);
        // 0.025 to the power of 1/3.
        assert!((missed[0] - 0.292_401_773_821_287).abs() < 1e-9 && missed[1] == 1.0, "{missed:?}");
        assert!(found[0] == 0.0 && (found[1] - (1.0 - missed[0])).abs() < 1e-9, "{found:?}");
    }
}
