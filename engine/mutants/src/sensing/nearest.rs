//! A list of objects that is too short.

use crate::flaw::{Flaw, flawed};
use crate::kind::Kind;
use paracosm_engine::Observation;

pub(crate) const NEAREST_ONLY: Kind = Kind {
    name: "nearest-only",
    about: "sees only the nearest bodies; their number is the size, rounded down",
    unit: "bodies",
    sizes: &[12.0, 8.0, 6.0, 4.0, 3.0, 2.0, 1.0],
    source: "fault model: a list of objects with a fixed number of places",
    make: |count, driver| flawed(driver, Nearest { count: count as usize, nearest: Vec::new() }),
};

struct Nearest {
    count: usize,
    /// The distances in metres and the numbers of the bodies.
    nearest: Vec<(f64, usize)>,
}

impl Flaw for Nearest {
    const SEES: bool = true;

    fn see(&mut self, seen: &mut Observation) {
        if seen.others.len() <= self.count {
            return;
        }
        self.nearest.clear();
        self.nearest.extend(seen.others.iter().map(|body| (body.position.norm(), body.id)));
        self.nearest.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.nearest.truncate(self.count);
        seen.others.retain(|body| self.nearest.iter().any(|(_, id)| *id == body.id));
    }
}
