//! Matches detections with the objects of an image, as the evaluation of COCO does (Lin et al., "Microsoft COCO: Common
//! Objects in Context", 2014; the code of `pycocotools`).

use crate::{Areas, Detection, Object, Rect};

/// The similarity of a detection and an object from which on the detection may match the object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Criterion {
    /// The least intersection over union of the boxes. For a crowd it is the share of the detection that lies in the
    /// crowd.
    Overlap(f64),
    /// The greatest distance between the centres of the boxes, as a share of the diagonal of the object's box.
    Centres(f64),
}

/// The greatest number of detections of an image that are matched; COCO takes the best 100.
const MOST: usize = 100;

/// The matches of an image.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Matching {
    /// The detections that were matched, as indices of the given detections, the best first.
    pub detections: Vec<usize>,
    /// The object of each of these detections; `None` for a detection without an object.
    pub objects: Vec<Option<usize>>,
    /// The detection of each object; `None` for an object without a detection.
    pub detected: Vec<Option<usize>>,
}

/// Matches the detections of one class in one image with the objects of the class. The best detection chooses first. It
/// takes the most similar object that no other detection has, and an object that does not count only if no other object
/// is similar enough. An object does not count if it is a crowd or if its area is not within `areas`. Only the 100 best
/// detections are matched.
pub fn match_boxes(objects: &[Object], detections: &[Detection], criterion: Criterion, areas: Areas) -> Matching {
    let mut best: Vec<usize> = (0..detections.len()).collect();
    best.sort_by(|a, b| detections[*b].score.total_cmp(&detections[*a].score));
    best.truncate(MOST);
    // Objects that count come first, in their order.
    let mut order: Vec<usize> = (0..objects.len()).collect();
    order.sort_by_key(|object| !areas.count(&objects[*object]));
    let mut detected = vec![None; objects.len()];
    let mut chosen = Vec::with_capacity(best.len());
    for detection in &best {
        let rect = &detections[*detection].rect;
        let mut found: Option<usize> = None;
        let mut least = criterion.least();
        for &object in &order {
            if detected[object].is_some() && !objects[object].crowd {
                continue;
            }
            if !areas.count(&objects[object]) && found.is_some_and(|found| areas.count(&objects[found])) {
                break;
            }
            let similarity = criterion.similarity(rect, &objects[object]);
            if similarity >= least {
                (least, found) = (similarity, Some(object));
            }
        }
        if let Some(object) = found {
            detected[object] = Some(*detection);
        }
        chosen.push(found);
    }
    Matching { detections: best, objects: chosen, detected }
}

impl Criterion {
    /// Returns the least similarity of a match.
    fn least(self) -> f64 {
        match self {
            // An overlap of 1 may be a little less in the arithmetic of a computer.
            Self::Overlap(least) => least.min(1.0 - 1e-10),
            Self::Centres(most) => 1.0 - most,
        }
    }

    fn similarity(self, rect: &Rect, object: &Object) -> f64 {
        match self {
            Self::Overlap(_) if object.crowd => rect.share_in(&object.rect),
            Self::Overlap(_) => rect.overlap(&object.rect),
            Self::Centres(_) => {
                let ([x, y], [to_x, to_y]) = (rect.centre(), object.rect.centre());
                1.0 - libm::hypot(to_x - x, to_y - y) / object.rect.diagonal()
            }
        }
    }
}
