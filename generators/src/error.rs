//! Errors of building a generator; each message says what was found and what was expected.

use crate::covering::CoveringError;
use paracosm_space::plural;
use paracosm_space::{SpaceError, did_you_mean};
use thiserror::Error;

/// The reason why a generator cannot be built.
#[derive(Debug, PartialEq, Error)]
pub enum GeneratorError {
    /// No strategy has the name that the user gave.
    #[error("no strategy is called `{name}`{}", did_you_mean(.nearest))]
    UnknownStrategy {
        /// The given name, which no strategy has.
        name: String,
        /// The name of the strategy that the user perhaps meant; `None` if no strategy has a similar name.
        nearest: Option<&'static str>,
    },
    /// The strategy of a program is not there.
    #[error("{}", missing(.name.as_deref()))]
    OwnIsMissing {
        /// The name of the strategy; `None` if nothing names it.
        name: Option<String>,
    },
    /// The strategy of a program makes no generator.
    #[error("the strategy `{name}`: {why}")]
    OwnFailed {
        /// The name of the strategy.
        name: String,
        /// The reason that the strategy gives.
        why: String,
    },
    /// No discrete family has the name that the user gave.
    #[error("no discrete family is called `{name}`{}; the families are ipog, random and cross", did_you_mean(.nearest))]
    UnknownFamily {
        /// The given name, which no discrete family has.
        name: String,
        /// The name of the discrete family that the user perhaps meant; `None` if no family has a similar name.
        nearest: Option<&'static str>,
    },
    /// The strategy has points of continuous coordinates only, and the space has discrete parameters.
    #[error("`{strategy}` has points of continuous parameters only, and this space has discrete parameters")]
    OnlyContinuous {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
    },
    /// The strategy consists of given sets, and no set has the size and the number of the request.
    #[error(
        "`{strategy}` has {} of {} in {}, and no set {number}", plural(*sets, "set"), plural(*points, "point"), plural(*dims, "dimension")
    )]
    NoSet {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
        /// The number of dimensions of the space.
        dims: usize,
        /// The number of points that were asked for.
        points: usize,
        /// The number of the set that was asked for, from 1.
        number: u64,
        /// The number of sets of this size.
        sets: usize,
    },
    /// Points of a given set break a constraint.
    #[error(
        "`{strategy}`, set {number}: {broken} of {} break a constraint such as `{constraint}`; give sets whose points all keep the constraints",
        plural(*points, "point")
    )]
    BrokenSet {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
        /// The number of the set, from 1.
        number: u64,
        /// The number of points of the set.
        points: usize,
        /// The number of points that break a constraint.
        broken: usize,
        /// The first broken constraint.
        constraint: String,
    },
    /// The strategy runs the tests of a file, and there are none.
    #[error(
        "`{strategy}` runs the tests of a file, and no file has a test: `paracosm-fuzz run --tests TESTS.csv` names one"
    )]
    NoTests {
        /// The name of the strategy.
        strategy: &'static str,
    },
    /// The space has no parameter.
    #[error("the space has no parameters; a generator needs at least one")]
    EmptySpace,
    /// The budget is 0 tests, but a generator needs at least 1 test.
    #[error("the budget is 0 tests; a budget must be at least 1")]
    NoBudget,
    /// A start index was given for a strategy that is not a sequence.
    #[error("`{strategy}` is not a sequence and cannot skip points; use one of {sequences}, or do not skip")]
    NoSequence {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
        /// The names of the strategies that can skip points.
        sequences: String,
    },
    /// The strategy is not made for the number of continuous coordinates of the space.
    #[error("`{strategy}` is made for {made_for} continuous coordinates; the space has {dims}; use {instead}")]
    Dimensions {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
        /// The number of continuous coordinates for which the strategy is made, in words.
        made_for: String,
        /// The number of continuous coordinates of the space.
        dims: usize,
        /// The name of a strategy that is made for the number of coordinates of the space.
        instead: &'static str,
    },
    /// The request needs an index beyond the number of points that the strategy can compute.
    #[error("`{strategy}` has {len} points, but the request needs index {last}; lower the budget or the skip")]
    IndexLimit {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
        /// The number of points that the strategy can compute.
        len: u64,
        /// The index of the last point that the request needs.
        last: u64,
    },
    /// The set of the request, which is made as a whole, has more coordinates than are kept in memory.
    #[error(
        "`{strategy}` makes its points as a whole, and {points} points in {dims} dimensions have more than 10,000,000 \
         coordinates, the most that are kept in memory; use halton"
    )]
    SetLimit {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
        /// The number of points of the set.
        points: u64,
        /// The number of dimensions of the set.
        dims: usize,
    },
    /// The strategy `best` has no set of so many points.
    #[error("best searches for sets of at most {most} points, and a set of {points} is asked for; use greedy")]
    BestLimit {
        /// The number of points.
        points: usize,
        /// The most points.
        most: usize,
    },
    /// The given epsilon, a volume of an empty box, is not above 0 and below 1.
    #[error("epsilon is {0}; the volume of an empty box must be above 0 and below 1")]
    Epsilon(f64),
    /// An epsilon was given for a strategy that must know the number of tests beforehand.
    #[error("`{strategy}` must know the number of tests beforehand, but epsilon leaves it open; use halton or greedy")]
    Sized {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
    },
    /// An epsilon was given for a strategy that follows failures and does not fill holes.
    #[error(
        "`{strategy}` goes where tests fail and leaves holes elsewhere; epsilon forbids holes: use halton or greedy"
    )]
    NoEpsilon {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
    },
    /// Existing tests were given for a strategy that cannot extend existing tests.
    #[error("`{strategy}` does not look at existing tests and cannot extend them; use greedy")]
    NoExtension {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
    },
    /// A measure to make small was given for a strategy that cannot aim at a measure.
    #[error("`{strategy}` cannot aim at a measure; use greedy, or give no measure to aim at")]
    NoAim {
        /// The name of the strategy that cannot serve the request.
        strategy: &'static str,
    },
    /// The strategy `greedy` cannot aim at a measure with the given name.
    #[error("greedy cannot aim at `{name}`{}; it can aim at dispersion and k-wise-dispersion", did_you_mean(.nearest))]
    UnknownAim {
        /// The given name, which is not the name of a measure for `greedy`.
        name: String,
        /// The name of the measure that the user perhaps meant; `None` if no measure has a similar name.
        nearest: Option<&'static str>,
    },
    /// An existing test does not belong to the space of the request.
    #[error("existing test {index} does not belong to the space; give each parameter of the space a valid value")]
    Foreign {
        /// The position of the wrong test among the existing tests, from 0.
        index: usize,
    },
    /// There are more choices of k parameters with their values than the strategy `greedy` can handle.
    #[error("there are more than {most} choices of {k} parameters with their values; use a smaller k")]
    Views {
        /// The requested strength k, which is the number of parameters in a combination.
        k: usize,
        /// The greatest number of choices of parameters that `greedy` handles.
        most: usize,
    },
    /// The strength k is 0 or exceeds the number of all parameters, continuous and discrete.
    #[error("k is {k}, but the space has {}; expected k from 1 to that number", plural(*parameters, "parameter"))]
    AllStrength {
        /// The requested strength k, which is the number of parameters in a combination.
        k: usize,
        /// The number of parameters of the space, continuous and discrete.
        parameters: usize,
    },
    /// The strength k is 0 or exceeds the number of discrete parameters.
    #[error("k is {k}, expected a number from 1 to the number of discrete parameters, which is {parameters}")]
    Strength {
        /// The requested strength k, which is the number of parameters in a combination.
        k: usize,
        /// The number of discrete parameters of the space.
        parameters: usize,
    },
    /// Hardly any test keeps the constraints of the space.
    #[error(
        "only {valid} of {probes} tests keep the constraints, expected 1 of 100; many break `{constraint}`: make the intervals of \
         its parameters smaller, or fix one of the parameters"
    )]
    Rare {
        /// The number of tests that keep the constraints.
        valid: usize,
        /// The number of tests that were tried.
        probes: usize,
        /// The text of a constraint that tests break.
        constraint: String,
    },
    /// The constraints join too many parameters to compute the probability of a combination in random rows.
    #[error(
        "the constraints join too many parameters to compute a combination's probability, so a random family would \
         guarantee nothing; use ipog"
    )]
    RandomUnderConstraints,
    /// The covering array of the discrete parameters cannot be constructed.
    #[error(transparent)]
    Covering(#[from] CoveringError),
    /// The constraints of the space contradict each other, or cannot be decided.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// The given delta, the probability that random rows miss a combination, is not above 0 and below 1.
    #[error("delta is {0}; the probability of missing a combination must be above 0 and below 1")]
    Delta(f64),
    /// A delta was given for a discrete family that misses no combination.
    #[error("only the family random has a delta, because it may miss combinations; `{family}` needs no delta")]
    NoDelta {
        /// The name of the discrete family that has no delta.
        family: &'static str,
    },
    /// The discrete family has more rows than a generator can use.
    #[error("the discrete family has {rows} rows, more than 10,000,000; {advice}")]
    FamilyTooLarge {
        /// The number of rows of the discrete family, in words.
        rows: String,
        /// Advice to the user for a family with fewer rows.
        advice: &'static str,
    },
}

fn missing(name: Option<&str>) -> String {
    match name {
        Some(name) => format!(
            "the strategy `{name}` is an object of the program that ran the campaign: give the strategy again (in Python `Study(.., strategy=..)`)"
        ),
        None => "the strategy `own` is the name for the strategy of a program, which only a program can give (in Python `Study(.., strategy=..)`)"
            .to_owned(),
    }
}
