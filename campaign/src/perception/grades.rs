//! The grades of a perceiver over a whole test, which become metrics of the trial: counts over all images, encounters,
//! average precision, and counts by distance, height and visible share.

use super::truth::RoadUser;
use crate::trial::Metric;
use paracosm_perception::{
    Areas, Axis, BINS, Confusion, Criterion, Detection, Encounter, Encounters, Object, Tally, match_boxes, suppress,
};

/// The least score of a box that counts for the average precision.
const FLOOR: f64 = 0.05;

/// The grades of a detector.
#[derive(Debug, Default)]
pub(super) struct Grades {
    images: usize,
    objects: usize,
    matches: usize,
    false_alarms: usize,
    /// For each group of the detector, the matches at all scores.
    tallies: Vec<Tally>,
    /// For each range of a property, the road users and the matches.
    bins: [[usize; 2]; BINS.len()],
    /// The pixels of a segmentation network.
    pixels: Option<Confusion>,
}

impl Grades {
    /// Counts an image: the road users that should be detected, the matches, and the false alarms.
    pub fn count(&mut self, objects: usize, matches: usize, false_alarms: usize) {
        self.images += 1;
        self.objects += objects;
        self.matches += matches;
        self.false_alarms += false_alarms;
    }

    /// Counts the pixels of a mask.
    pub fn count_pixels(&mut self, counts: Confusion) {
        self.images += 1;
        *self.pixels.get_or_insert_default() += counts;
    }

    /// Adds all boxes of a group in an image to the average precision of the group.
    pub fn tally(&mut self, group: usize, truth: &[Object], boxes: &[Detection], (overlap, least): (f64, f64)) {
        self.tallies.resize_with(self.tallies.len().max(group + 1), Tally::default);
        let boxes = suppress(boxes, FLOOR, overlap);
        self.tallies[group].add(truth, &boxes, Criterion::Overlap(least), Areas::ALL);
    }

    /// Counts the road users that a group means, by their properties. `detections` are the detections of the group. A
    /// road user counts even if it need not be detected. `scale` makes pixels of the perceiver's input from pixels of the
    /// image. Returns the number of road users with a match.
    pub fn count_by_ranges(&mut self, users: &[&RoadUser], detections: &[Detection], least: f64, scale: f64) -> usize {
        let object = |user: &&RoadUser| Object { rect: user.rect, area: f64::from(user.pixels), crowd: false };
        let truth: Vec<Object> = users.iter().map(object).collect();
        let matching = match_boxes(&truth, detections, Criterion::Overlap(least), Areas::ALL);
        for (user, detection) in users.iter().zip(&matching.detected) {
            let value = |axis: Axis| match axis {
                Axis::Distance => user.distance,
                Axis::Height => user.rect.height * scale,
                Axis::Visible => user.visible,
            };
            let within = BINS.iter().zip(&mut self.bins).filter(|(bin, _)| bin.contains(value(bin.axis)));
            for (_, [objects, matches]) in within {
                *objects += 1;
                *matches += usize::from(detection.is_some());
            }
        }
        matching.detected.iter().flatten().count()
    }

    /// Returns the metrics of the test.
    pub fn metrics(&self, encounters: &Encounters) -> Vec<(String, Metric)> {
        let number = |name: &str, number: f64| (format!("perception.{name}"), Metric::Number(number));
        if let Some(pixels) = &self.pixels {
            let numbers = [
                ("images", self.images as f64),
                ("true_positives", pixels.true_positives as f64),
                ("false_positives", pixels.false_positives as f64),
                ("false_negatives", pixels.false_negatives as f64),
                ("true_negatives", pixels.true_negatives as f64),
            ];
            return numbers.into_iter().map(|(name, value)| number(name, value)).collect();
        }
        let all = encounters.all();
        let delays: Vec<f64> = all.iter().filter_map(Encounter::delay).collect();
        let precisions: Vec<f64> = self.tallies.iter().filter_map(Tally::average_precision).collect();
        let mean = |of: &[f64]| (!of.is_empty()).then(|| of.iter().sum::<f64>() / of.len() as f64);
        let counts = [
            ("images", self.images),
            ("objects", self.objects),
            ("matches", self.matches),
            ("false_alarms", self.false_alarms),
            ("encounters", all.len()),
            ("missed_encounters", all.len() - delays.len()),
        ];
        let mut metrics: Vec<_> = counts.into_iter().map(|(name, count)| number(name, count as f64)).collect();
        metrics.extend(mean(&delays).map(|delay| number("delay", delay)));
        metrics.extend(mean(&precisions).map(|precision| number("average_precision", precision)));
        for (bin, [objects, matches]) in BINS.iter().zip(self.bins).filter(|(_, [objects, _])| *objects > 0) {
            metrics.push(number(&format!("objects.{}", bin.name()), objects as f64));
            metrics.push(number(&format!("matches.{}", bin.name()), matches as f64));
        }
        metrics
    }
}
