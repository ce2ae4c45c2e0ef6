//! Functions with a known set of failures, which test strategies without the cost of a simulation.
//!
//! Each function stands for one thing that makes failures hard to find. The seed decides where the failure lies, so
//! that no strategy is good at one place by luck. Values below 0 are failures. Random functions (`landscape`) differ in
//! all of these things at once.

mod landscape;

use crate::{Request, Strategy};
use landscape::{Kind, Landscape};
use paracosm_space::{Domain, Parameter, Point, Space, Value};
use std::borrow::Cow;

/// The radius of a ball whose volume is a thousandth of the unit cube of five dimensions.
const BALL: f64 = 0.1801;

/// A test function for strategies, which gives tests a robustness and has a known set of failures.
#[derive(Debug, Clone)]
pub struct Function {
    /// The name by which users ask for the test function.
    pub name: Cow<'static, str>,
    /// The difficulty that the test function poses to strategies, in a few words.
    pub about: Cow<'static, str>,
    dims: usize,
    /// The number of levels of each discrete parameter, whose values are words.
    words: Cow<'static, [usize]>,
    rule: Rule,
}

#[derive(Debug, Clone, Copy)]
enum Rule {
    /// The robustness of a test, and of the hidden test in the middle of the failure.
    Known(fn(&Point, &Point) -> Option<f64>),
    /// The random function of a number.
    Random(u64),
}

/// A test function whose failure lies at a fixed place in the space.
#[derive(Debug, Clone)]
pub struct Placed(Place);

#[derive(Debug, Clone)]
enum Place {
    Known { robustness: fn(&Point, &Point) -> Option<f64>, hidden: Point },
    Random(Box<Landscape>),
}

const fn function(
    name: &'static str,
    about: &'static str,
    dims: usize,
    words: &'static [usize],
    robustness: fn(&Point, &Point) -> Option<f64>,
) -> Function {
    Function {
        name: Cow::Borrowed(name),
        about: Cow::Borrowed(about),
        dims,
        words: Cow::Borrowed(words),
        rule: Rule::Known(robustness),
    }
}

/// The beginning of the names of random functions.
const RANDOM: &str = "random";

impl Function {
    /// All test functions of this crate, except for the random ones.
    pub const ALL: [Self; 10] = [
        function("corner5", "within 0.05 of one of 32 corners", 5, &[], corner),
        function("ball5", "a ball of volume 0.001", 5, &[], |x, hidden| Some(distance(x, hidden) - BALL)),
        function("decoy5", "a ball of volume 0.001 beside a wider minimum without a failure", 5, &[], decoy),
        function("errors5", "a ball of volume 0.001, with nearly half of the space in error", 5, &[], errors),
        function("valley2", "the end of Rosenbrock's valley", 2, &[], valley),
        function("ring2", "a circle 0.0016 wide", 2, &[], |x, hidden| Some((distance(x, hidden) - 0.2).abs() - 0.0008)),
        function("rough3", "a ball among waves", 3, &[], rough),
        function("few20", "20 parameters, only three of which matter", 20, &[], few),
        function(
            "words2",
            "a disc in one of 64 combinations of words, where each right word helps",
            2,
            &[4, 4, 4],
            |x, hidden| Some(0.2 * wrong(x, hidden) as f64 + distance(x, hidden) - 0.15),
        ),
        function(
            "needle2",
            "a disc in one of 16 combinations of words, where only the whole combination helps",
            2,
            &[4, 4],
            |x, hidden| Some(if wrong(x, hidden) > 0 { 0.5 } else { 0.0 } + distance(x, hidden) - 0.15),
        ),
    ];

    /// Returns the random function of a number, with a narrow failure and one to four basins that lead nowhere.
    pub fn random(number: u64) -> Self {
        let kind = Kind::new(number);
        Self {
            name: format!("{RANDOM}{number}").into(),
            about: kind.to_string().into(),
            dims: kind.dims,
            words: kind.words.into(),
            rule: Rule::Random(number),
        }
    }

    /// Returns the function of a name, which is the name of a function of [`Function::ALL`] or `random` with a number.
    pub fn named(name: &str) -> Option<Self> {
        let number = name.strip_prefix(RANDOM).and_then(|number| number.parse().ok());
        let random = number.map(Self::random).filter(|random| random.name == name);
        Self::ALL.into_iter().find(|function| function.name == name).or(random)
    }

    /// Returns the space of the tests of the function.
    pub fn space(&self) -> Space {
        let word = |(i, &levels): (usize, &usize)| {
            let levels = (0..levels).map(|level| Value::Word(format!("w{level}"))).collect();
            Parameter::new(format!("word{i}"), Domain::Choice(levels))
        };
        let words = self.words.iter().enumerate().map(word);
        let parameters = Space::unit_cube(self.dims).parameters().iter().cloned().chain(words).collect();
        Space::new(parameters).expect("the parameters have names of their own")
    }

    /// Returns the function with its failure at a place that depends on the seed. The place is away from the border. The
    /// whole failure lies in the cube, except for random functions.
    pub fn placed(&self, seed: u64) -> Placed {
        let robustness = match self.rule {
            Rule::Known(robustness) => robustness,
            Rule::Random(number) => return Placed(Place::Random(Box::new(Landscape::new(number, seed)))),
        };
        let space = self.space();
        // Far from the seeds of the strategies: otherwise a random test would hit the place itself.
        let request = Request { seed: Some(seed.wrapping_add(1_000_000)), ..Request::new(&space, 300) };
        let test = Strategy::RANDOM.build(&request).map(|mut random| random.ask(1).remove(0));
        let mut hidden = test.expect("every space has a random test");
        hidden.continuous.iter_mut().for_each(|u| *u = 0.19 + 0.62 * *u);
        // The first row of a family hardly depends on its seed.
        hidden.discrete.iter_mut().zip(self.words.iter()).for_each(|(level, &levels)| {
            *level = (*level + (seed % levels as u64) as usize * 7 + (seed / levels as u64) as usize % levels) % levels;
        });
        Placed(Place::Known { robustness, hidden })
    }
}

impl Placed {
    /// Returns the robustness of a test, which is below 0 if the test fails; `None` if the test ends in an error.
    pub fn robustness(&self, test: &Point) -> Option<f64> {
        match &self.0 {
            Place::Known { robustness, hidden } => robustness(test, hidden),
            Place::Random(landscape) => landscape.robustness(test),
        }
    }
}

fn distance(x: &Point, hidden: &Point) -> f64 {
    distance_between(&x.continuous, &hidden.continuous)
}

fn distance_between(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn wrong(x: &Point, hidden: &Point) -> usize {
    x.discrete.iter().zip(&hidden.discrete).filter(|(a, b)| a != b).count()
}

fn corner(x: &Point, hidden: &Point) -> Option<f64> {
    let away = |(x, c): (&f64, &f64)| (x - c.round()).abs();
    Some(x.continuous.iter().zip(&hidden.continuous).map(away).fold(0.0, f64::max) - 0.05)
}

/// The slope leads to the decoy from most places.
fn decoy(x: &Point, hidden: &Point) -> Option<f64> {
    let decoy = Point { continuous: hidden.continuous.iter().map(|c| 1.0 - c).collect(), ..Point::default() };
    Some((2.0 * (distance(x, hidden) - BALL)).min(0.05 + distance(x, &decoy)))
}

fn errors(x: &Point, hidden: &Point) -> Option<f64> {
    let away = if hidden.continuous[0] < 0.5 { x.continuous[0] > 0.55 } else { x.continuous[0] < 0.45 };
    (!away).then(|| distance(x, hidden) - BALL)
}

/// The failure is about a thousandth of the plane. Its place does not depend on the seed.
fn valley(x: &Point, _: &Point) -> Option<f64> {
    let (a, b) = (4.0 * x.continuous[0] - 2.0, 4.0 * x.continuous[1] - 1.0);
    let (bend, ahead) = (b - a * a, 1.0 - a);
    Some(100.0 * bend * bend + ahead * ahead - 0.04)
}

fn rough(x: &Point, hidden: &Point) -> Option<f64> {
    let wave = |(x, c): (&f64, &f64)| 0.05 * (1.0 - libm::cos(30.0 * (x - c)));
    let waves: f64 = x.continuous.iter().zip(&hidden.continuous).map(wave).sum();
    Some(distance(x, hidden) + waves - 0.08)
}

fn few(x: &Point, hidden: &Point) -> Option<f64> {
    let part = |i: usize| (x.continuous[i] - hidden.continuous[i]) * (x.continuous[i] - hidden.continuous[i]);
    Some((part(2) + part(9) + part(16)).sqrt() - 0.062)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hidden(placed: &Placed) -> Point {
        match &placed.0 {
            Place::Known { hidden, .. } => hidden.clone(),
            Place::Random(landscape) => landscape.hidden(),
        }
    }

    #[test]
    fn the_failure_is_where_it_is_said_to_be_and_nowhere_at_the_decoy() {
        for function in
            Function::ALL.into_iter().filter(|function| !["corner5", "valley2", "ring2"].contains(&&*function.name))
        {
            for seed in 0..5 {
                let placed = function.placed(seed);
                assert!(placed.robustness(&hidden(&placed)).is_some_and(|r| r < 0.0), "{} {seed}", function.name);
            }
        }
        let decoy = Function::ALL[2].placed(1);
        let there =
            Point { continuous: hidden(&decoy).continuous.iter().map(|c| 1.0 - c).collect(), ..Point::default() };
        assert!(decoy.robustness(&there).is_some_and(|r| r > 0.0));
    }

    #[test]
    fn a_random_function_fails_at_its_place_and_at_as_few_tests_as_its_kind_says() {
        for number in 0..40 {
            let function = Function::named(&format!("random{number}")).unwrap();
            let placed = function.placed(7);
            assert!(placed.robustness(&hidden(&placed)).is_some_and(|r| r < 0.0), "{}", function.about);
            let space = function.space();
            let mut random = Strategy::RANDOM.build_independent(&Request::new(&space, 20_000)).unwrap();
            let tests = random.ask(20_000);
            let results: Vec<Option<f64>> = tests.iter().map(|test| placed.robustness(test)).collect();
            let failing = results.iter().flatten().filter(|robustness| **robustness < 0.0).count();
            // At most 0.5 % of the tests fail, which are 100 with a deviation of 10.
            assert!(failing < 140, "{number}: {failing} of 20,000, {}", function.about);
            let errors = results.iter().filter(|robustness| robustness.is_none()).count();
            assert!(errors < 12_000, "{number}: {errors} of 20,000");
        }
        assert!(
            ["random", "randomx", "random1.5", "random+1", "random007", "random99999999999999999999"]
                .iter()
                .all(|name| Function::named(name).is_none())
        );
    }

    #[test]
    fn the_ball_has_a_thousandth_of_the_volume() {
        let [_, ball, ..] = Function::ALL;
        let space = ball.space();
        let mut random = Strategy::RANDOM.build(&Request::new(&space, 100_000)).unwrap();
        let placed = ball.placed(3);
        let inside = random.ask(100_000).iter().filter(|test| placed.robustness(test).unwrap() < 0.0).count();
        // 100 expected, with a deviation of 10.
        assert!((65..=135).contains(&inside), "{inside}");
    }
}
