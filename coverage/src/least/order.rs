//! The order of points along all axes, as far as it is decided, and the boxes between points.

/// The order of points. Along the first axis, the points are numbered from 1. Along each other axis, some of the first points are in their order.
#[derive(Debug, Clone)]
pub(super) struct Order {
    points: usize,
    /// The number of points whose places are decided along all axes.
    pub decided: usize,
    /// The decided points along each axis but the first, from the lowest to the highest.
    sequences: Vec<Vec<usize>>,
}

/// A box between points or ends of the cube, with at most a number of points inside.
#[derive(Debug, Clone)]
pub(super) struct Gap {
    /// The nodes at both ends along each axis.
    pub ends: Vec<(usize, usize)>,
    /// The most points that may be inside.
    pub inside: usize,
}

/// An interval between two nodes of an axis, with the points that may be inside as bits.
struct Interval {
    ends: (usize, usize),
    inside: u64,
    /// The interval is within this interval when one end moves to the next node.
    wider: [Option<u64>; 2],
}

impl Order {
    /// Makes an order in which nothing is decided along the axes after the first.
    pub fn new(points: usize, dims: usize) -> Self {
        Self { points, decided: 0, sequences: vec![Vec::new(); dims - 1] }
    }

    /// Returns true if all points have their places.
    pub fn is_complete(&self) -> bool {
        self.decided == self.points
    }

    /// Returns the orders in which the next point has each of its places, with the neighbours of the point along each axis but the first. The second point lies above
    /// the first along all axes: otherwise the mirror image does.
    pub fn children(&self) -> Vec<(Self, Vec<(usize, usize)>)> {
        let next = self.decided + 1;
        let mut children = vec![(Self { decided: next, ..self.clone() }, Vec::new())];
        for axis in 0..self.sequences.len() {
            let first = usize::from(self.decided == 1);
            let with = |(order, beside): (Self, Vec<(usize, usize)>)| {
                let sequence = self.sequences[axis].clone();
                (first..=sequence.len()).map(move |place| {
                    let (mut order, mut beside) = (order.clone(), beside.clone());
                    let before = place.checked_sub(1).map_or(0, |before| sequence[before]);
                    let after = sequence.get(place).copied().unwrap_or(order.points + 1);
                    beside.push((before, after));
                    order.sequences[axis].insert(place, next);
                    (order, beside)
                })
            };
            children = children.into_iter().flat_map(with).collect();
        }
        children
    }

    /// Returns the boxes that cannot grow without another point inside.
    pub fn gaps(&self) -> Vec<Gap> {
        let axes: Vec<Vec<Interval>> = (0..=self.sequences.len()).map(|axis| self.intervals(axis)).collect();
        let mut gaps = Vec::new();
        collect(&axes, &mut Vec::new(), u64::MAX, &mut gaps);
        gaps
    }

    fn intervals(&self, axis: usize) -> Vec<Interval> {
        let all: Vec<usize> = (1..=self.points).collect();
        let (order, open): (&[usize], u64) = match axis.checked_sub(1) {
            None => (&all, 0),
            Some(other) => (&self.sequences[other], (self.decided + 1..=self.points).map(|point| 1 << point).sum()),
        };
        let node = |place: usize| match place {
            0 => 0,
            _ => order.get(place - 1).copied().unwrap_or(self.points + 1),
        };
        let last = order.len() + 1;
        let inside =
            |low: usize, high: usize| -> u64 { open | (low + 1..high).map(|place| 1 << node(place)).sum::<u64>() };
        let pairs = (0..=last).flat_map(|low| (low + 1..=last).map(move |high| (low, high)));
        let interval = |(low, high): (usize, usize)| Interval {
            ends: (node(low), node(high)),
            inside: inside(low, high),
            wider: [low.checked_sub(1).map(|low| inside(low, high)), (high < last).then(|| inside(low, high + 1))],
        };
        pairs.map(interval).collect()
    }
}

/// Collects the boxes that cannot grow along any axis without another point inside.
fn collect<'a>(axes: &'a [Vec<Interval>], chosen: &mut Vec<&'a Interval>, inside: u64, gaps: &mut Vec<Gap>) {
    let Some(axis) = axes.get(chosen.len()) else {
        let ends = chosen.iter().map(|interval| interval.ends).collect();
        gaps.push(Gap { ends, inside: inside.count_ones() as usize });
        return;
    };
    for interval in axis {
        chosen.push(interval);
        let inside = inside & interval.inside;
        // What can grow without another point can also grow within fewer points.
        if !can_grow(chosen, inside) {
            collect(axes, chosen, inside, gaps);
        }
        chosen.pop();
    }
}

/// Returns true if an interval of a product can be wider without another point inside the product.
fn can_grow(chosen: &[&Interval], inside: u64) -> bool {
    chosen.iter().enumerate().any(|(axis, interval)| {
        let others = chosen.iter().enumerate().filter(|(other, _)| *other != axis);
        let others = others.fold(u64::MAX, |inside, (_, other)| inside & other.inside);
        interval.wider.iter().flatten().any(|wider| wider & others == inside)
    })
}
