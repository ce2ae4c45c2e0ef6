//! The sets of boxes that the search looks at, bounds and cuts.

/// A set of boxes of one kind.
pub(crate) trait Region: Sized + Send {
    /// The points, in the form in which regions read them.
    type Points<'a>: Sync;
    /// Working memory, which a thread reuses for all regions.
    type Scratch: Default;

    /// The share of the time in which the search tries to end, before it proves bounds on the way. It is small if the
    /// time to the end is often beyond all limits.
    const TIME_TO_THE_END: f64;

    /// Returns regions that together hold all boxes that can have the largest difference.
    fn all(points: &Self::Points<'_>) -> Vec<Self>;

    /// Returns an upper bound on the difference of every box of the region.
    fn bound(&self) -> f64;

    /// Returns the number of numbers that the region stores; each number takes some 12 bytes.
    fn size(&self) -> usize;

    /// Lowers the bound of the region, or solves the region. Boxes with a difference of at most `threshold` do not
    /// matter.
    fn relax(&mut self, points: &Self::Points<'_>, threshold: f64, scratch: &mut Self::Scratch) -> Relaxed;

    /// Adds regions to `parts` that together hold the boxes of the region. Boxes with a difference of at most
    /// `threshold` may be missing. The parts take at most twice the memory of the region.
    fn split(self, points: &Self::Points<'_>, threshold: f64, scratch: &mut Self::Scratch, parts: &mut Vec<Self>);
}

/// The result of the relaxation of a region.
pub(crate) enum Relaxed {
    /// No box of the region has a difference above the threshold.
    Nothing,
    /// The largest difference of a box of the region, if the relaxation has solved the region.
    Solved(f64),
    /// The region is not solved; its upper bound may be lower than before.
    Bounded,
}

/// The kind of difference between volume and share of points that a search maximises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum BoxKind {
    /// The volume of an open box less the share of points inside the box.
    Open,
    /// The share of points in a closed box, including its faces, less the volume of the box.
    Closed,
}

impl BoxKind {
    /// Both kinds of difference.
    pub(crate) const BOTH: [Self; 2] = [Self::Open, Self::Closed];
}
