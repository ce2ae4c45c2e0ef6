//! What every strategy promises, in every kind of space and for every discrete family.
//!
//! The suite runs over `Strategy::all()` and over a strategy that only the suite knows. A new strategy is tested by
//! being listed there.

use paracosm_generators::{Descriptor, DiscreteFamily, Generator, Look, MarkShape as Mark, Method, Request, Strategy};
use paracosm_space::{Domain, Parameter, Point, Shape, Space, Value};
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

/// A strategy that only this suite knows: what is said of all strategies is said of it, too.
static SCRATCH: Descriptor = Descriptor {
    name: "scratch",
    about: "random points under another name: a strategy of this test",
    dims: 1..=usize::MAX,
    look: Look::filled(0x12_3456, Mark::Circle),
    method: Method::own(|request| Strategy::RANDOM.build(request)),
};

fn strategies() -> impl Iterator<Item = Strategy> {
    Strategy::all().chain([Strategy::of(&SCRATCH)])
}

/// Every strategy with every space that it covers and every family.
fn cases(spaces: &[Space]) -> impl Iterator<Item = (Strategy, Request<'_>)> {
    let requests = spaces
        .iter()
        .flat_map(|space| FAMILIES.map(|discrete| Request { seed: Some(3), discrete, ..Request::new(space, BUDGET) }));
    let covers = |strategy: &Strategy, dims| dims == 0 || strategy.dims().contains(&dims);
    requests.flat_map(move |request| {
        let strategies = strategies().filter(move |strategy| covers(strategy, request.space.dims()));
        strategies.map(move |strategy| (strategy, request))
    })
}

/// The first `n` tests of a campaign on which nothing depends: adaptive strategies are told how each test went, by a
/// robustness that has its least value inside.
fn run(generator: &mut dyn Generator, n: usize) -> Vec<Point> {
    let mut tests = Vec::new();
    while tests.len() < n {
        let asked = generator.ask((n - tests.len()).min(16));
        if asked.is_empty() {
            break;
        }
        let robustness: Vec<Option<f64>> = asked.iter().map(|test| Some(robustness(test))).collect();
        generator.tell(&asked, &robustness);
        tests.extend(asked);
    }
    tests
}

fn robustness(test: &Point) -> f64 {
    let continuous: f64 = test.continuous.iter().map(|u| (u - 0.3) * (u - 0.3)).sum();
    continuous + test.discrete.iter().map(|&level| (level as f64 - 1.0).abs()).sum::<f64>() - 0.1
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
        let tests = run(&mut *build(strategy, &request), BUDGET);
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
        let tests = run(&mut *build(strategy, &request), BUDGET);
        assert_eq!(tests, run(&mut *build(strategy, &request), BUDGET), "{strategy}");
        let far = Some(3 + (1 << 40));
        for seed in [None, Some(4), far] {
            let others = run(&mut *build(strategy, &Request { seed, ..request }), BUDGET);
            let only_rows = request.space.dims() == 0;
            if only_rows && strategy.is_adaptive() {
                // All rows come out, in an order that the seed need not change.
                continue;
            }
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
        for untold in [0, 2] {
            let mut generator = build(strategy, &request);
            for round in 0..8 {
                let told = [&told[..], &[None; 6], &[Some(f64::NAN); 6], &[Some(f64::INFINITY); 6]][round % 4];
                let mut tests = generator.ask(told.len());
                // Some are never told, and the others in another order; one is told twice, and one nobody asked for.
                tests.truncate(tests.len().saturating_sub(untold));
                tests.reverse();
                generator.tell(&tests, &told[..tests.len()]);
                generator.tell(&tests[..tests.len().min(1)], &told[1..2]);
                let foreign = build(Strategy::RANDOM, &Request { seed: Some(round as u64), ..request }).ask(1);
                generator.tell(&foreign, &told[2..3]);
            }
            let more = generator.ask(6);
            assert!(more.iter().flat_map(|test| &test.continuous).all(|u| (0.0..1.0).contains(u)));
            // Within the budget; adaptive strategies may have been told of all rows there are.
            assert!(request.space.dims() == 0 || !more.is_empty(), "{strategy}");
        }
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
        let asked = 2 * BUDGET;
        // Those that never end have given all that was asked for.
        if run(&mut *generator, asked).len() < asked {
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
        assert_eq!(run(&mut *build(strategy, &request), BUDGET).len(), BUDGET, "{strategy}");
    }
}

#[test]
fn open_loop_strategies_are_asked_for_the_budget_at_once_and_adaptive_ones_always_have_a_test_even_untold() {
    let spaces = spaces();
    for (strategy, request) in cases(&spaces).filter(|(_, request)| request.space.dims() > 0) {
        let mut generator = build(strategy, &request);
        if strategy.is_adaptive() {
            assert!((0..BUDGET).all(|_| (1..=3).contains(&generator.ask(3).len())), "{strategy}");
        } else {
            assert_eq!(generator.ask(BUDGET).len(), BUDGET, "{strategy}");
        }
    }
}

#[test]
fn no_adaptive_strategy_proposes_a_test_twice_and_all_rows_come_out_where_nothing_is_continuous() {
    let spaces = spaces();
    for (strategy, request) in cases(&spaces).filter(|(strategy, _)| strategy.is_adaptive()) {
        let tests = run(&mut *build(strategy, &request), BUDGET);
        let bits =
            |test: &Point| (test.continuous.iter().map(|u| u.to_bits()).collect::<Vec<_>>(), test.discrete.clone());
        let different: std::collections::BTreeSet<_> = tests.iter().map(bits).collect();
        assert_eq!(different.len(), tests.len(), "{strategy}");
        if request.space.dims() == 0 {
            assert_eq!(tests.len(), request.space.levels().iter().product::<usize>(), "{strategy}");
        }
    }
}

#[test]
fn constraints_are_kept_whatever_a_strategy_learns() {
    let text = "constraints = [\"lanes == 2 implies weather != 'fog'\", \"cars > lanes\"]
        parameter = [{ name = \"lanes\", choice = [2, 4, 6] }, { name = \"x\", interval = [0, 9] },
        { name = \"weather\", choice = [\"clear\", \"rain\", \"fog\"] }, { name = \"cars\", choice = [1, 3, 5, 7] }]";
    let space = Space::from_toml(text).expect("a valid space");
    for strategy in strategies().filter(|strategy| strategy.dims().contains(&1)) {
        let tests = run(&mut *build(strategy, &Request { seed: Some(1), ..Request::new(&space, BUDGET) }), BUDGET);
        assert!(tests.iter().all(|test| space.allows(test)), "{strategy}");
    }
}

proptest! {
    // Some strategies think for milliseconds about a point, and every case runs all of them.
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn in_what_portions_open_loop_tests_are_asked_for_does_not_matter(portions in prop::collection::vec(0..15_usize, 1..6)) {
        let spaces = spaces();
        for (strategy, request) in cases(&spaces).filter(|(strategy, _)| !strategy.is_adaptive()) {
            let mut generator = build(strategy, &request);
            let apart: Vec<Point> = portions.iter().flat_map(|&n| generator.ask(n)).collect();
            let at_once = build(strategy, &request).ask(portions.iter().sum());
            prop_assert_eq!(apart, at_once, "{}", strategy);
        }
    }
}
