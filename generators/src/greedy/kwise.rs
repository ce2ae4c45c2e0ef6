//! Places the next test where it breaks the largest holes of any k parameters, discrete and continuous at once.
//!
//! A *view* of the tests is a choice of k parameters, with a combination of values of the discrete ones among them.
//! It is a set of points over its continuous parameters, with empty boxes of its own, or just the question whether
//! such a test exists. The k-wise dispersion is the largest hole of all views. A test is a point of many views, and
//! should break as much as possible in all of them. It starts in the largest hole. Its coordinates are chosen one
//! after the other, twice over, each from two dozen candidates by the sum that [`Holes`] explains.
//!
//! On a discrete space alone this is the greedy covering array of Cohen, Dalal, Fredman and Patton (The AETG system,
//! IEEE Trans. Softw. Eng. 23, 1997).

use super::Holes;
use super::room::{Room, wrap};
use crate::strategy::MakeBoxes;
use crate::{Generator, GeneratorError};
use paracosm_coverage::Projection;
use paracosm_coverage::empty_boxes::EmptyBoxes;
use paracosm_coverage::kwise_dispersion::projections;
use paracosm_space::Point;
use paracosm_space::rules::Rules;
use rand::Rng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64;

/// The number of beginnings, of which the best is taken.
const BEGINNINGS: usize = 3;

/// The number of times that each coordinate is chosen: first from anywhere, then near its first value.
const ROUNDS: usize = 2;

/// The number of candidates for a coordinate.
const CANDIDATES: usize = 24;

/// The greatest distance of candidates of the second round from the choice of the first round.
const NEAR: f64 = 0.02;

/// The greatest number of views: more are a mistake rather than a plan.
const MOST_VIEWS: usize = 200_000;

/// The number of boxes that all views keep together.
const MOST_BOXES: usize = 2_000_000;

/// A choice of parameters, with values for the discrete ones, and the holes that it shows.
struct View {
    projection: Projection,
    /// The positions of the view's parameters among all parameters, the continuous ones first.
    coordinates: Vec<usize>,
    holes: Kept,
}

/// The state of a view.
enum Kept {
    /// The empty boxes over its continuous parameters.
    Boxes(EmptyBoxes),
    /// `true` if a test has the values of the view, all of whose parameters are discrete.
    Covered(bool),
}

/// The holes of a view that count now.
enum Hole {
    /// Large boxes.
    Boxes(Holes),
    /// Values that no test has: the worst possible hole.
    Row,
}

/// The holes of all views that count now.
struct LargeHoles<'a> {
    dims: usize,
    periodic: bool,
    rules: &'a Rules,
    holes: Vec<(&'a Projection, Hole)>,
    /// For each coordinate, the positions of its holes.
    of_coordinate: Vec<Vec<usize>>,
}

/// The greedy choice of tests for k-wise dispersion, with the holes in any k parameters that the tests so far leave.
pub(crate) struct KwiseGreedy {
    dims: usize,
    periodic: bool,
    rules: Rules,
    views: Vec<View>,
    rng: Pcg64,
}

impl KwiseGreedy {
    /// Makes the greedy choice of tests that fill the holes of `existing` tests in any `k` parameters. `make` makes the
    /// kind of holes that count.
    ///
    /// # Errors
    /// `k` is not in 1 to the number of parameters, or there are too many views.
    pub(crate) fn new(
        make: MakeBoxes,
        dims: usize,
        rules: &Rules,
        k: usize,
        rng: Pcg64,
        existing: &[Point],
    ) -> Result<Self, GeneratorError> {
        let parameters = dims + rules.levels().len();
        let projections = projections(dims, rules, k).map_err(|_| GeneratorError::AllStrength { k, parameters })?;
        let chosen: Vec<Projection> = projections.take(MOST_VIEWS + 1).collect();
        if chosen.len() > MOST_VIEWS {
            return Err(GeneratorError::Views { k, most: MOST_VIEWS });
        }
        let most = (MOST_BOXES / chosen.len()).max(100);
        let kept = |projection: &Projection| match projection.axes.len() {
            0 => Kept::Covered(false),
            axes => Kept::Boxes(make(axes, most).expect("there is an axis")),
        };
        let view = |projection: Projection| View {
            holes: kept(&projection),
            coordinates: coordinates(&projection, dims),
            projection,
        };
        let views: Vec<View> = chosen.into_iter().map(view).collect();
        let periodic = views.iter().any(|view| matches!(&view.holes, Kept::Boxes(boxes) if boxes.is_periodic()));
        let mut greedy = Self { dims, periodic, rules: rules.clone(), views, rng };
        for test in existing {
            greedy.add(test);
        }
        Ok(greedy)
    }

    /// Adds a test.
    fn add(&mut self, test: &Point) {
        for View { projection, holes, .. } in &mut self.views {
            if projection.selects(test) {
                match holes {
                    Kept::Boxes(boxes) => boxes.add(&projection.of(test)).expect("a point of the cube"),
                    Kept::Covered(covered) => *covered = true,
                }
            }
        }
    }

    /// The next test.
    fn next(&mut self) -> Point {
        let Self { dims, periodic, rules, views, rng } = self;
        let largest = views.iter().map(View::largest).fold(0.0, f64::max);
        let worst: Vec<&View> = views.iter().filter(|view| view.largest() == largest).collect();
        let holes = LargeHoles::of(views, largest, *dims, *periodic, rules);
        let beginnings = (0..BEGINNINGS).map(|_| {
            let test = holes.begin(worst[rng.random_range(0..worst.len())], rng);
            (holes.left_by(None, &test), test)
        });
        let (_, mut best) = beginnings.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are beginnings");
        best.continuous.iter_mut().for_each(|x| *x = wrap(*x));
        self.add(&best);
        best
    }
}

/// The positions of a projection's parameters among all parameters, the continuous ones first.
fn coordinates(projection: &Projection, dims: usize) -> Vec<usize> {
    let discrete = projection.fixed.iter().map(|(parameter, _)| dims + parameter);
    projection.axes.iter().copied().chain(discrete).collect()
}

impl<'a> LargeHoles<'a> {
    /// Collects the holes that count beside the largest hole of all views.
    fn of(views: &'a [View], largest: f64, dims: usize, periodic: bool, rules: &'a Rules) -> Self {
        let of_coordinate = vec![Vec::new(); dims + rules.levels().len()];
        let mut large = Self { dims, periodic, rules, holes: Vec::new(), of_coordinate };
        for view in views {
            let Some(hole) = view.hole(largest) else { continue };
            for &coordinate in &view.coordinates {
                large.of_coordinate[coordinate].push(large.holes.len());
            }
            large.holes.push((&view.projection, hole));
        }
        large
    }

    /// The amount by which a test changes the sum over the views of a coordinate, or over all views.
    fn left_by(&self, coordinate: Option<usize>, test: &Point) -> f64 {
        let left = |(projection, hole): &(&Projection, Hole)| match hole {
            _ if !projection.selects(test) => 0.0,
            Hole::Row => -1.0,
            Hole::Boxes(holes) => holes.left_by(&projection.of(test)),
        };
        match coordinate {
            None => self.holes.iter().map(left).sum(),
            Some(coordinate) => self.of_coordinate[coordinate].iter().map(|&hole| left(&self.holes[hole])).sum(),
        }
    }

    /// A test in the largest hole of a view that also breaks other holes well.
    fn begin(&self, first: &View, rng: &mut Pcg64) -> Point {
        let View { projection, holes: kept, .. } = first;
        let mut test = Point {
            continuous: (0..self.dims).map(|_| rng.random()).collect(),
            discrete: self.random_row(&projection.fixed, rng),
        };
        // Along the axes of the view the test stays in the hole, and it keeps the hole's values.
        let mut rooms = vec![Room::anywhere(self.periodic); self.dims];
        if let Kept::Boxes(boxes) = kept {
            for (of_view, &axis) in projection.axes.iter().enumerate() {
                rooms[axis] = Room::within(boxes.largest().side(of_view));
                test.continuous[axis] = rooms[axis].at(test.continuous[axis]);
            }
        }
        let mut free: Vec<usize> = (0..self.dims + self.rules.levels().len()).collect();
        for &(parameter, _) in &projection.fixed {
            free.retain(|coordinate| *coordinate != self.dims + parameter);
        }
        for round in 0..ROUNDS {
            free.shuffle(rng);
            for &coordinate in &free {
                match coordinate.checked_sub(self.dims) {
                    None => self.choose_number(coordinate, rooms[coordinate], round, &mut test, rng),
                    Some(parameter) => self.choose_level(parameter, &mut test),
                }
            }
        }
        test
    }

    /// A row with these values that satisfies the constraints; the other parameters get random levels, one after the
    /// other.
    fn random_row(&self, fixed: &[(usize, usize)], rng: &mut Pcg64) -> Vec<usize> {
        let levels = self.rules.levels();
        let mut chosen = fixed.to_vec();
        let mut open: Vec<usize> = (0..levels.len()).filter(|open| fixed.iter().all(|pair| pair.0 != *open)).collect();
        open.shuffle(rng);
        for parameter in open {
            let with = |&level: &usize| self.rules.is_valid(&[&chosen[..], &[(parameter, level)]].concat());
            let valid: Vec<usize> = (0..levels[parameter]).filter(with).collect();
            chosen.push((parameter, valid[rng.random_range(0..valid.len())]));
        }
        chosen.sort_unstable();
        chosen.into_iter().map(|(_, level)| level).collect()
    }

    /// Moves a test along an axis to the place where it breaks most.
    fn choose_number(&self, axis: usize, room: Room, round: usize, test: &mut Point, rng: &mut Pcg64) {
        let now = test.continuous[axis];
        let mut best = (self.left_by(Some(axis), test), now);
        for _ in 0..CANDIDATES {
            let random: f64 = rng.random();
            let candidate = if round == 0 { room.at(random) } else { now + NEAR * room.width * (2.0 * random - 1.0) };
            if !room.holds(candidate) {
                continue;
            }
            test.continuous[axis] = candidate;
            let left = self.left_by(Some(axis), test);
            if left < best.0 {
                best = (left, candidate);
            }
        }
        test.continuous[axis] = best.1;
    }

    /// Gives a test the level of a parameter with which it breaks most.
    fn choose_level(&self, parameter: usize, test: &mut Point) {
        let mut best = (f64::INFINITY, test.discrete[parameter]);
        // From a random level on, so that no level is preferred if all are equally good.
        let (levels, start) = (self.rules.levels()[parameter], test.discrete[parameter]);
        for level in (start..levels).chain(0..start) {
            test.discrete[parameter] = level;
            if !self.rules.allows_at(parameter, &test.discrete) {
                continue;
            }
            let left = self.left_by(Some(self.dims + parameter), test);
            if left < best.0 {
                best = (left, level);
            }
        }
        test.discrete[parameter] = best.1;
    }
}

impl View {
    /// The volume of the largest hole.
    fn largest(&self) -> f64 {
        match &self.holes {
            Kept::Boxes(boxes) => boxes.largest().volume(),
            Kept::Covered(covered) => f64::from(u8::from(!covered)),
        }
    }

    /// The holes that count beside the largest hole of all views.
    fn hole(&self, largest: f64) -> Option<Hole> {
        match &self.holes {
            Kept::Covered(covered) => (!covered).then_some(Hole::Row),
            Kept::Boxes(boxes) => {
                let anywhere = vec![Room::anywhere(boxes.is_periodic()); self.projection.axes.len()];
                Some(Holes::around(boxes, &anywhere, largest)).filter(|holes| !holes.is_empty()).map(Hole::Boxes)
            }
        }
    }
}

impl Generator for KwiseGreedy {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        (0..n).map(|_| self.next()).collect()
    }
}
