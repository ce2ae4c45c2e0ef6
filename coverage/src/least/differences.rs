//! Bounds on all differences of the coordinates of points along one axis, as whole numbers, so that sums are exact.

/// The number of units in the length of the cube.
pub(super) const UNIT: i64 = 1 << 40;

/// The bounds along one axis. Node 0 is the lower end of the cube, the last node is the upper end, and the nodes between them are points. The bounds are closed: none
/// follows from two others.
#[derive(Debug, Clone)]
pub(super) struct Differences {
    nodes: usize,
    /// At `from * nodes + to`: the greatest difference between the coordinate of `to` and the coordinate of `from`.
    most: Vec<i64>,
}

impl Differences {
    /// Makes the bounds of points that lie anywhere between the ends of the cube.
    pub fn of_the_cube(points: usize) -> Self {
        let nodes = points + 2;
        let mut most = vec![UNIT; nodes * nodes];
        for node in 0..nodes {
            most[node * nodes + node] = 0;
            // No node is below the lower end or above the upper end.
            most[node * nodes] = 0;
            most[(nodes - 1) * nodes + node] = 0;
        }
        most[(nodes - 1) * nodes] = -UNIT;
        Self { nodes, most }
    }

    /// Returns the number of points and of ends.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Returns the greatest difference between the coordinate of `to` and that of `from`.
    pub fn most(&self, from: usize, to: usize) -> i64 {
        self.most[from * self.nodes + to]
    }

    /// Returns the least difference between the coordinate of `to` and that of `from`.
    pub fn least(&self, from: usize, to: usize) -> i64 {
        -self.most(to, from)
    }

    /// Demands that a difference is at most a bound. Returns false if no coordinates keep all bounds.
    pub fn demand(&mut self, from: usize, to: usize, bound: i64) -> bool {
        if bound >= self.most(from, to) {
            return true;
        }
        if self.most(to, from) + bound < 0 {
            return false;
        }
        for start in 0..self.nodes {
            let so_far = self.most(start, from) + bound;
            for end in 0..self.nodes {
                let through = so_far + self.most(to, end);
                let most = &mut self.most[start * self.nodes + end];
                *most = through.min(*most);
            }
        }
        true
    }
}
