//! The boxes that a detector answers, and their non-maximum suppression.

use crate::Rect;

/// A box that a detector answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// The index of the class among the classes of the detector.
    pub class: usize,
    /// The score, from 0 to 1.
    pub score: f64,
    /// The box on the image.
    pub rect: Rect,
}

/// Returns the detections whose score is at least `threshold`, without the detections that cover the same object as a
/// better one of their class: the overlap (IoU) with the better one is above `overlap`. The result is sorted by score,
/// the best detection first; detections of the same score keep their order.
///
/// The algorithm is greedy non-maximum suppression (Felzenszwalb et al., "Object detection with discriminatively trained
/// part-based models", 2010).
pub fn suppress(detections: &[Detection], threshold: f64, overlap: f64) -> Vec<Detection> {
    let mut sorted: Vec<Detection> = detections.iter().filter(|one| one.score >= threshold).copied().collect();
    sorted.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: Vec<Detection> = Vec::new();
    for one in sorted {
        let same = |other: &Detection| other.class == one.class && other.rect.overlap(&one.rect) > overlap;
        if !kept.iter().any(same) {
            kept.push(one);
        }
    }
    kept
}
