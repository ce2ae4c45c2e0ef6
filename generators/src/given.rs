//! Makes strategies of tests that another program has made, so that a sampler of a user is compared like ours, and so that a campaign runs the
//! tests of a file.

use crate::point_sets::PointSets;
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};
use crate::{Generator, GeneratorError, Request};
use paracosm_space::Point;

impl PointSets {
    /// Returns the generator of the set whose number is the seed of the request, by default 1.
    pub(crate) fn generator(
        &'static self,
        strategy: &'static str,
        request: &Request,
    ) -> Result<Box<dyn Generator>, GeneratorError> {
        if !request.space.levels().is_empty() {
            return Err(GeneratorError::OnlyContinuous { strategy });
        }
        let (dims, points, number) = (request.space.dims(), request.budget, request.seed.unwrap_or(1));
        let sets = self.count(dims, points);
        let set =
            self.set(dims, points, number).ok_or(GeneratorError::NoSet { strategy, dims, points, number, sets })?;
        // A strategy with fewer tests than the others would not be compared with them.
        let mut broken = set.iter().filter_map(|point| request.space.broken(point));
        if let Some(constraint) = broken.next() {
            let (constraint, broken) = (constraint.text().to_owned(), 1 + broken.count());
            return Err(GeneratorError::BrokenSet { strategy, number, points, broken, constraint });
        }
        Ok(Box::new(Given { points: set.iter() }))
    }
}

/// The description of the strategy `given`.
const TESTS: Descriptor = Descriptor {
    name: "given",
    about: "the tests of a file, in their order (run --tests)",
    dims: ANY,
    look: Look::hollow(0x00_0000, MarkShape::Square),
    method: Method::own(|request| match request.existing {
        [] => Err(GeneratorError::NoTests { strategy: TESTS.name }),
        tests => Ok(Box::new(Tests { all: tests.to_vec(), next: 0 })),
    }),
};

/// All tests, and the position of the next one.
struct Tests {
    all: Vec<Point>,
    next: usize,
}

impl Generator for Tests {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let first = self.next;
        self.next = first.saturating_add(n).min(self.all.len());
        self.all[first..self.next].to_vec()
    }
}

impl Strategy {
    /// The strategy that proposes the existing tests of the request, in their order, also tests that break a constraint: a point may be a
    /// rounding error away from the numbers of its test, so whoever has the numbers checks them. The strategy is not in [`all`](Self::all),
    /// because it makes no tests itself.
    pub const GIVEN: Self = Self::of(&TESTS);

    /// Makes a strategy of given sets. A request with the seed s gets the set with the number s of exactly the size of the request. The
    /// strategy stays in memory until the program ends.
    pub fn of_sets(name: &str, look: Look, sets: PointSets) -> Self {
        let dims = || sets.sizes().map(|(dims, _)| dims);
        let dims = dims().min().unwrap_or(1)..=dims().max().unwrap_or(1);
        let method = Method(MethodKind::Given(Box::leak(Box::new(sets))));
        let name = Box::leak(name.to_owned().into_boxed_str());
        Self::of(Box::leak(Box::new(Descriptor { name, about: "sets of points from files", dims, look, method })))
    }

    /// Returns the given sets of the strategy; `None` if the strategy makes its sets itself.
    pub fn given(self) -> Option<&'static PointSets> {
        match self.kind() {
            MethodKind::Given(sets) => Some(sets),
            _ => None,
        }
    }
}

/// The points of a set that were not asked for yet.
struct Given {
    points: std::slice::Iter<'static, Point>,
}

impl Generator for Given {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        self.points.by_ref().take(n).cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_space::Space;

    #[test]
    fn the_existing_tests_of_a_request_are_proposed_once_in_their_order() {
        let space = Space::unit_cube(2);
        let existing = points(0.3, 4);
        let request = Request { existing: &existing, ..Request::new(&space, 3) };
        let mut given = Strategy::GIVEN.build(&request).unwrap();
        assert_eq!([given.ask(3), given.ask(3), given.ask(3)].concat(), points(0.3, 4));
        let error = Strategy::GIVEN.build(&Request::new(&space, 3)).err().expect("there are no tests");
        assert_eq!(error, GeneratorError::NoTests { strategy: "given" });
        assert_eq!("given".parse::<Strategy>().unwrap(), Strategy::GIVEN);
    }

    fn points(first: f64, count: usize) -> Vec<Point> {
        let point = |i: usize| Point { continuous: vec![first, i as f64 / count as f64], discrete: vec![] };
        (0..count).map(point).collect()
    }

    #[test]
    fn the_seed_is_the_number_of_the_set_and_other_sizes_are_refused() {
        let mut sets = PointSets::default();
        [0.1, 0.2].into_iter().for_each(|first| sets.add(points(first, 5)));
        sets.add(points(0.3, 7));
        sets.add(Vec::new());
        let strategy = Strategy::of_sets("mine", Look::hollow(0, MarkShape::Circle), sets);
        let space = Space::unit_cube(2);
        let ask = |seed, budget| strategy.build(&Request { seed, ..Request::new(&space, budget) });
        assert_eq!(ask(Some(2), 5).unwrap().ask(9), points(0.2, 5));
        assert_eq!(ask(None, 7).unwrap().ask(9), points(0.3, 7));
        let mut begun = ask(Some(1), 5).unwrap();
        assert_eq!([begun.ask(2), begun.ask(9)].concat(), points(0.1, 5));
        let error = ask(Some(3), 5).err().expect("there are two").to_string();
        assert_eq!(error, "`mine` has 2 sets of 5 points in 2 dimensions, and no set 3");
        let error = ask(Some(1), 6).err().expect("no set has this size").to_string();
        assert_eq!(error, "`mine` has 0 sets of 6 points in 2 dimensions, and no set 1");
        // With constraints, a set has as many points as the budget, and all of them keep the constraints.
        let space = space.with_constraints(["x1 < 0.15"]).unwrap();
        let ask = |seed| strategy.build(&Request { seed: Some(seed), ..Request::new(&space, 5) });
        assert_eq!(ask(1).unwrap().ask(9), points(0.1, 5));
        let says = "`mine`, set 2: 5 of 5 points break a constraint such as `x1 < 0.15`; give sets whose points all keep the constraints";
        assert_eq!(ask(2).err().expect("its points break it").to_string(), says);
    }
}
