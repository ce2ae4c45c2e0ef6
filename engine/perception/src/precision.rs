//! Average precision and recall over many images, as the evaluation of COCO computes them.

use crate::{Areas, Criterion, Detection, Matching, Object, match_boxes};

/// The matches of one class over many images, from which average precision and recall follow.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tally {
    /// The score of each detection that counts, and whether the detection matches an object.
    scored: Vec<(f64, bool)>,
    /// The number of objects that count.
    objects: usize,
}

/// The recalls at which COCO reads the precision: 0, 0.01 and so on until 1.
const RECALLS: usize = 101;

impl Tally {
    /// Matches the detections of one class in one image with the objects of the class, counts them, and returns the
    /// matches. Objects do not count if they are crowds or if their area is not within `areas`. Detections of other areas
    /// without a match do not count either.
    pub fn add(
        &mut self,
        objects: &[Object],
        detections: &[Detection],
        criterion: Criterion,
        areas: Areas,
    ) -> Matching {
        let matching = match_boxes(objects, detections, criterion, areas);
        for (detection, object) in matching.detections.iter().zip(&matching.objects) {
            let Detection { score, rect, .. } = detections[*detection];
            let counts = match object {
                Some(object) => areas.count(&objects[*object]),
                None => areas.contains(rect.area()),
            };
            if counts {
                self.scored.push((score, object.is_some()));
            }
        }
        self.objects += objects.iter().filter(|object| areas.count(object)).count();
        matching
    }

    /// Adds the matches of further images.
    pub fn join(&mut self, later: &Self) {
        self.scored.extend_from_slice(&later.scored);
        self.objects += later.objects;
    }

    /// Returns the number of objects that count.
    pub fn objects(&self) -> usize {
        self.objects
    }

    /// Returns the number of objects that were matched.
    pub fn matches(&self) -> usize {
        self.scored.iter().filter(|(_, matches)| *matches).count()
    }

    /// Returns the number of detections that count and match no object.
    pub fn false_alarms(&self) -> usize {
        self.scored.len() - self.matches()
    }

    /// Returns the share of the objects that were matched, from 0 to 1; `None` without objects.
    pub fn recall(&self) -> Option<f64> {
        (self.objects > 0).then(|| self.matches() as f64 / self.objects as f64)
    }

    /// Returns the average precision, from 0 to 1: the mean of the precision at 101 recalls, where the precision at a
    /// recall is the greatest precision at this recall or above. `None` without objects.
    pub fn average_precision(&self) -> Option<f64> {
        if self.objects == 0 {
            return None;
        }
        let mut sorted = self.scored.clone();
        sorted.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        let (mut matches, mut curve) = (0usize, Vec::with_capacity(sorted.len()));
        for (answered, (_, is_match)) in (1usize..).zip(&sorted) {
            matches += usize::from(*is_match);
            curve.push((matches as f64 / self.objects as f64, matches as f64 / answered as f64));
        }
        for place in (1..curve.len()).rev() {
            curve[place - 1].1 = curve[place - 1].1.max(curve[place].1);
        }
        let at = |step: usize| {
            // As numpy computes the 101 recalls of COCO: 0.07 is 7 times 0.01 here, which is not the nearest number.
            let recall = if step + 1 == RECALLS { 1.0 } else { step as f64 * 0.01 };
            let place = curve.partition_point(|(reached, _)| *reached < recall);
            curve.get(place).map_or(0.0, |(_, precision)| *precision)
        };
        Some((0..RECALLS).map(at).sum::<f64>() / RECALLS as f64)
    }
}
