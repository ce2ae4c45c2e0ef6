//! What every strategy promises, in every kind of space and for every discrete family.
//!
//! The suite runs over `Strategy::ALL`; a new strategy is tested by being listed there.

use paracosm_coverage::{Domain, Parameter, Point, Shape, Space, Value};
use paracosm_generators::{DiscreteFamily, Generator, Request, Strategy};
use proptest::prelude::*;

const BUDGET: usize = 60;
const FAMILIES: [DiscreteFamily; 3] =
    [DiscreteFamily::Ipog, DiscreteFamily::Random { delta: 0.05 }, DiscreteFamily::Cross];

/// One of each kind: few and many continuous parameters, both kinds of parameters, only discrete ones, and such as vary
/// over time.
fn spaces() -> [Space; 6] {
    let interval = |name: &str, lo, hi| Parameter::new(name, Domain::Interval { lo, hi });
    let mixed =
        vec![interval("speed", 0.5, 10.0), choice("lanes", 3), interval("distance", -60.0, 5.0), choice("weather", 2)];
    let discrete = vec![choice("lanes", 3), choice("cars", 2), choice("only", 1), choice("colour", 4)];
    let varying = |parameter, signal| Parameter { signal: Some(signal), ..parameter };
    let signals = vec![
        varying(interval("friction", 0.2, 0.8), Shape::Polynomial { degree: 2 }),
        interval("speed", 0.5, 10.0),
        varying(choice("weather", 3), Shape::PiecewiseConstant { pieces: 2 }),
        varying(interval("light", 0.0, 1.0), Shape::PiecewiseLinear { pieces: 1 }),
    ];
    let space = |parameters| Space::new(parameters).expect("a valid space");
    let [one, five, twenty] = [1, 5, 20].map(Space::unit_cube);
    [one, five, space(mixed), space(discrete), space(signals), twenty]
}

fn choice(name: &str, levels: u32) -> Parameter {
    Parameter::new(name, Domain::Choice((0..levels).map(|level| Value::Number(level.into())).collect()))
}

/// Every strategy with every space that it covers and every family.
fn cases(spaces: &[Space]) -> impl Iterator<Item = (Strategy, Request<'_>)> {
    let requests = spaces
        .iter()
        .flat_map(|space| FAMILIES.map(|discrete| Request { seed: Some(3), discrete, ..Request::new(space, BUDGET) }));
    let covers = |strategy: &Strategy, dims| dims == 0 || strategy.dims().contains(&dims);
    requests.flat_map(move |request| {
        let strategies = Strategy::ALL.into_iter().filter(move |strategy| covers(strategy, request.space.dims()));
        strategies.map(move |strategy| (strategy, request))
    })
}

fn build(strategy: Strategy, request: &Request) -> Box<dyn Generator> {
    strategy.build(request).unwrap_or_else(|error| panic!("{strategy}: {error}"))
}

#[test]
fn points_belong_to_the_space_and_survive_decoding() {
    let spaces = spaces();
    for (strategy, request) in cases(&spaces) {
        let space = request.space;
        let levels = space.levels();
        let tests = build(strategy, &request).ask(BUDGET);
        assert!(!tests.is_empty());
        for test in tests {
            assert_eq!(test.continuous.len(), space.dims());
            assert_eq!(test.discrete.len(), levels.len());
            assert!(test.continuous.iter().all(|u| (0.0..1.0).contains(u)), "{strategy}: {test:?}");
            assert!(test.discrete.iter().zip(&levels).all(|(level, levels)| level < levels), "{strategy}: {test:?}");

            let values = space.decode(&test);
            let again = space.encode(&values).expect("decoded values lie in their domains");
            assert_eq!(again.discrete, test.discrete);
            assert_eq!(space.decode(&again), values);
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_tests_and_another_seed_others() {
    let spaces = spaces();
    for (strategy, request) in cases(&spaces) {
        let tests = build(strategy, &request).ask(BUDGET);
        assert_eq!(tests, build(strategy, &request).ask(BUDGET), "{strategy}");
        let far = Some(3 + (1 << 40));
        for seed in [None, Some(4), far] {
            let others = build(strategy, &Request { seed, ..request }).ask(BUDGET);
            let only_rows = request.space.dims() == 0;
            if only_rows && request.discrete == DiscreteFamily::Ipog {
                // The same small array may come out of several seeds.
                continue;
            }
            let nothing_random = only_rows && request.discrete == DiscreteFamily::Cross;
            assert_eq!(others == tests, nothing_random, "{strategy}, seed {seed:?}");
        }
    }
}

#[test]
fn whatever_it_is_told_it_goes_on_inside_the_domains() {
    let spaces = spaces();
    let told = [None, Some(f64::NAN), Some(f64::INFINITY), Some(f64::NEG_INFINITY), Some(-1.0), Some(0.5)];
    for (strategy, request) in cases(&spaces) {
        let mut generator = build(strategy, &request);
        for told in [&told[..], &[None; 6], &[Some(f64::NAN); 6], &[Some(f64::INFINITY); 6]] {
            let tests = generator.ask(told.len());
            generator.tell(&tests, &told[..tests.len()]);
        }
        assert!(generator.ask(6).iter().flat_map(|test| &test.continuous).all(|u| (0.0..1.0).contains(u)));
    }
}

#[test]
fn asking_for_none_gives_none_and_takes_none() {
    let spaces = spaces();
    for (strategy, request) in cases(&spaces) {
        let mut generator = build(strategy, &request);
        assert!(generator.ask(0).is_empty());
        assert_eq!(generator.ask(5), build(strategy, &request).ask(5), "{strategy}");
    }
}

#[test]
fn an_exhausted_strategy_stays_exhausted() {
    let spaces = spaces();
    for (strategy, request) in cases(&spaces) {
        let mut generator = build(strategy, &request);
        // Those that never end have given all that was asked for.
        let asked = 2 * BUDGET;
        if generator.ask(asked).len() < asked {
            assert!(generator.ask(asked).is_empty(), "{strategy}");
            generator.tell(&[], &[]);
            assert!(generator.ask(1).is_empty(), "{strategy}");
        }
    }
}

#[test]
fn the_budget_can_be_had_in_full_wherever_a_parameter_is_continuous() {
    let spaces = spaces();
    for (strategy, request) in cases(&spaces).filter(|(_, request)| request.space.dims() > 0) {
        assert_eq!(build(strategy, &request).ask(BUDGET).len(), BUDGET, "{strategy}");
    }
}

proptest! {
    // Some strategies think for milliseconds about a point, and every case runs all of them.
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn in_what_portions_tests_are_asked_for_does_not_matter(portions in prop::collection::vec(0..15_usize, 1..6)) {
        let spaces = spaces();
        for (strategy, request) in cases(&spaces) {
            let mut generator = build(strategy, &request);
            let apart: Vec<Point> = portions.iter().flat_map(|&n| generator.ask(n)).collect();
            let at_once = build(strategy, &request).ask(portions.iter().sum());
            prop_assert_eq!(apart, at_once, "{}", strategy);
        }
    }
}
