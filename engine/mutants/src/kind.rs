//! The descriptor of a kind of defect.

use paracosm_engine::driver::Driver;

/// A kind of defect: its name, its sizes, its source, and the function that puts it into a driver.
#[derive(Debug)]
pub struct Kind {
    /// The name of the kind.
    pub name: &'static str,
    /// A sentence about a driver with the defect, which says the meaning of the size.
    pub about: &'static str,
    /// The unit of the size.
    pub unit: &'static str,
    /// The sizes that a set of mutants uses, from slight to gross. Every number between the first and the last is a size.
    pub sizes: &'static [f64],
    /// The published fault or limit that the kind follows. "fault model" means that the kind has no such source.
    pub source: &'static str,
    pub(crate) make: fn(f64, Box<dyn Driver>) -> Box<dyn Driver>,
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Kind {
    /// Returns the least and the greatest size of the kind.
    pub fn range(&self) -> (f64, f64) {
        let [first, .., last] = *self.sizes else { panic!("`{}` has fewer than two sizes", self.name) };
        (first.min(last), first.max(last))
    }
}
