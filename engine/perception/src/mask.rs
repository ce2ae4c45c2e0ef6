//! Masks of one class, and the measures of a mask against the true mask.

use std::ops::AddAssign;

/// The pixels of an image that belong to a class, in rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// True for each pixel of the class.
    pub pixels: Vec<bool>,
}

/// The number of pixels by their answer and their truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Confusion {
    /// Pixels of the class that the mask has.
    pub true_positives: u64,
    /// Pixels of other classes that the mask has.
    pub false_positives: u64,
    /// Pixels of the class that the mask does not have.
    pub false_negatives: u64,
    /// Pixels of other classes that the mask does not have.
    pub true_negatives: u64,
}

impl Confusion {
    /// Counts the pixels of an answer.
    ///
    /// # Panics
    /// The two masks have different sizes.
    pub fn of(answer: &Mask, truth: &Mask) -> Self {
        assert_eq!((answer.width, answer.height), (truth.width, truth.height), "the masks must have the same size");
        let mut counts = Self::default();
        for (answered, is_true) in answer.pixels.iter().zip(&truth.pixels) {
            *match (answered, is_true) {
                (true, true) => &mut counts.true_positives,
                (true, false) => &mut counts.false_positives,
                (false, true) => &mut counts.false_negatives,
                (false, false) => &mut counts.true_negatives,
            } += 1;
        }
        counts
    }

    /// Returns the intersection over union of the answer and the truth, from 0 to 1; 1 if both are empty.
    pub fn overlap(&self) -> f64 {
        share(self.true_positives, self.true_positives + self.false_positives + self.false_negatives)
    }

    /// Returns the share of the answer that is true, from 0 to 1; 1 if the answer is empty.
    pub fn precision(&self) -> f64 {
        share(self.true_positives, self.true_positives + self.false_positives)
    }

    /// Returns the share of the truth that the answer has, from 0 to 1; 1 if the truth is empty.
    pub fn recall(&self) -> f64 {
        share(self.true_positives, self.true_positives + self.false_negatives)
    }
}

impl AddAssign for Confusion {
    fn add_assign(&mut self, other: Self) {
        self.true_positives += other.true_positives;
        self.false_positives += other.false_positives;
        self.false_negatives += other.false_negatives;
        self.true_negatives += other.true_negatives;
    }
}

fn share(part: u64, whole: u64) -> f64 {
    if whole == 0 { 1.0 } else { part as f64 / whole as f64 }
}
