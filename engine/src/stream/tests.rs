//! Combinators one by one, and all of them against lists.

use super::*;
use nalgebra::Vector2;
use paracosm_space::Shape;
use proptest::prelude::*;
use std::cell::RefCell;
use std::rc::Rc;

/// The stream `x`, an output of the world.
fn x() -> Stream<f64> {
    Stream::output(Source(0), "x".into())
}

/// The stream `y`, another one.
fn y() -> Stream<f64> {
    Stream::output(Source(1), "y".into())
}

/// Runs `stream` over ticks at which `x` and `y` are these.
fn over<T: Datum>(stream: &Stream<T>, ticks: &[(Option<f64>, Option<f64>)]) -> Vec<Option<T>> {
    let mut graph = Graph::new([&stream.node], &[], 2).unwrap();
    let slot = graph.slot(&stream.node);
    let mut values = Vec::new();
    for (tick, (x, y)) in ticks.iter().enumerate() {
        let clock = Clock { tick, ticks: ticks.len() - 1, dt: 0.5 };
        let outputs = [x, y].map(|output| output.map_or(DatumSample::Absent, DatumSample::Number));
        graph.outputs().copy_from_slice(&outputs);
        graph.tick(clock);
        values.push(graph.value(slot));
    }
    values
}

/// Checks a stream against a row of the tables in the documentation: what it is at the five ticks at which `x` is 1, 2,
/// 3, 4, 5 and `y` is absent, 7, absent, 8, 9.
fn row<T: Datum + PartialEq + std::fmt::Debug>(stream: &Stream<T>, expected: [Option<T>; 5]) {
    let ys = [None, Some(7.0), None, Some(8.0), Some(9.0)];
    let ticks: Vec<_> = (1..6).map(f64::from).map(Some).zip(ys).collect();
    assert_eq!(over(stream, &ticks), expected, "{stream:?}");
}

/// At ticks 2 and 4 it occurs.
fn e() -> Stream<bool> {
    x().equals(3.0) | x().equals(5.0)
}

fn numbers(expected: [f64; 5]) -> [Option<f64>; 5] {
    expected.map(|number| Some(number).filter(|number| !number.is_nan()))
}

const NONE: f64 = f64::NAN;

#[test]
fn every_row_of_the_table_is_as_the_documentation_says() {
    row(&Stream::constant(6.0), numbers([6.0; 5]));
    row(&Stream::tick(), [Some(()); 5]);
    row(&Stream::time(), numbers([0.0, 0.5, 1.0, 1.5, 2.0]));
    row(&x().map(|x| 10.0 * x), numbers([10.0, 20.0, 30.0, 40.0, 50.0]));
    row(&x().filter(|x| x % 2.0 == 1.0), numbers([1.0, NONE, 3.0, NONE, 5.0]));
    row(&x().when(&e()), numbers([NONE, NONE, 3.0, NONE, 5.0]));
    row(&x().zip(&y()), [None, Some((2.0, 7.0)), None, Some((4.0, 8.0)), Some((5.0, 9.0))]);
    row(&(x() + y()), numbers([NONE, 9.0, NONE, 12.0, 14.0]));
    row(&y().take(2), numbers([NONE, 7.0, NONE, 8.0, NONE]));
    row(&y().take(2).concat(&x()), numbers([NONE, 7.0, NONE, 8.0, 5.0]));
    row(&y().sum(), numbers([NONE, 7.0, NONE, 15.0, 24.0]));
    row(&y().scan(1.0, |sum, y| sum * y), numbers([NONE, 7.0, NONE, 56.0, 504.0]));
    row(&y().merge(&x()), numbers([1.0, 7.0, 3.0, 8.0, 9.0]));
    row(&x().take_until(&e()), numbers([1.0, 2.0, NONE, NONE, NONE]));
    row(&x().skip_until(&e()), numbers([NONE, NONE, 3.0, 4.0, 5.0]));
    row(&y().pre(), numbers([NONE, NONE, 7.0, NONE, 8.0]));
    row(&y().hold(0.0), numbers([0.0, 7.0, 7.0, 8.0, 9.0]));
    row(&x().pre().initially(0.0), numbers([0.0, 1.0, 2.0, 3.0, 4.0]));
}

#[test]
fn what_has_begun_or_ended_stays_so_when_the_event_is_over() {
    let e = || x().equals(2.0);
    row(&x().skip_until(&e()), numbers([NONE, 2.0, 3.0, 4.0, 5.0]));
    row(&x().take_until(&e()), numbers([1.0, NONE, NONE, NONE, NONE]));
}

#[test]
fn an_event_is_a_truth_that_holds_or_any_other_value_that_is_there() {
    row(&x().skip_until(&y()), numbers([NONE, 2.0, 3.0, 4.0, 5.0]));
    row(&x().skip_until(&y().above(8.0)), numbers([NONE, NONE, NONE, NONE, 5.0]));
    row(&x().when(&Stream::tick().when(&e())), numbers([NONE, NONE, 3.0, NONE, 5.0]));
}

#[test]
fn what_follows_a_stream_that_ends_by_an_event_follows_at_once() {
    row(&x().take_until(&e()).concat(&-x()), numbers([1.0, 2.0, -3.0, -4.0, -5.0]));
    row(&x().take(0).concat(&x().take(2)).concat(&Stream::constant(0.0)), numbers([1.0, 2.0, 0.0, 0.0, 0.0]));
}

#[test]
fn truths_numbers_and_vectors_are_computed_where_all_operands_are() {
    row(&(x().above(1.5) & x().below(4.5)), [false, true, true, true, false].map(Some));
    row(&!(x().at_most(1.0) | x().at_least(4.0)), [false, true, true, false, false].map(Some));
    row(&y().above(7.5), [None, Some(false), None, Some(true), Some(true)]);
    row(&(10.0 / x().min(2.0).max(y())), numbers([NONE, 10.0 / 7.0, NONE, 1.25, 10.0 / 9.0]));
    row(&(x() - 3.0).abs().sqrt(), numbers([2.0f64.sqrt(), 1.0, 0.0, 1.0, 2.0f64.sqrt()]));
    let v = Stream::vector(x() * 3.0, x() * 4.0);
    row(&v.norm(), numbers([5.0, 10.0, 15.0, 20.0, 25.0]));
    row(&(&v - &v * 0.5).dot(Vector2::new(2.0, 0.0)), numbers([3.0, 6.0, 9.0, 12.0, 15.0]));
    row(&(-v.x() + v.y()), numbers([1.0, 2.0, 3.0, 4.0, 5.0]));
    row(&v.sum().y(), numbers([4.0, 12.0, 24.0, 40.0, 60.0]));
    row(&Stream::constant(1.0).min(f64::NAN).equals(1.0), [Some(false); 5]);
}

#[test]
fn words_and_pairs_are_values_like_others() {
    let weather = x().map(|x| if x < 2.5 { "clear" } else { "fog" });
    row(&weather, ["clear", "clear", "fog", "fog", "fog"].map(Some));
    row(&weather.equals("fog"), [false, false, true, true, true].map(Some));
    let pair = y().zip(&weather);
    row(
        &pair.hold((0.0, "rain")),
        [(0.0, "rain"), (7.0, "clear"), (7.0, "clear"), (8.0, "fog"), (9.0, "fog")].map(Some),
    );
    row(&pair.pre(), [None, None, Some((7.0, "clear")), None, Some((8.0, "fog"))]);
    row(&pair.zip(&x()).map(|((y, _), x)| x + y), numbers([NONE, 9.0, NONE, 12.0, 14.0]));
}

#[test]
fn an_effect_takes_place_at_the_ticks_that_have_a_value() {
    let seen = Rc::new(RefCell::new(Vec::new()));
    let sink = seen.clone();
    let effect = y().for_each(move |y| sink.borrow_mut().push(y));
    let mut graph = Graph::new([&effect.0], &[], 2).unwrap();
    for (tick, y) in [None, Some(7.0), Some(8.0)].into_iter().enumerate() {
        graph.outputs()[1] = y.map_or(DatumSample::Absent, DatumSample::Number);
        graph.tick(Clock { tick, ticks: 2, dt: 0.5 });
    }
    assert_eq!(*seen.borrow(), [7.0, 8.0]);
}

#[test]
fn a_signal_goes_through_its_values() {
    let signal = |shape, values: &[f64]| {
        let values = values.iter().map(|value| DatumSample::Number(*value)).collect();
        Stream::<f64>::new(NodeKind::Signal { parameter: "p".into(), shape, values }, [])
    };
    row(&signal(Shape::PiecewiseConstant { pieces: 2 }, &[1.0, 2.0]), numbers([1.0, 1.0, 2.0, 2.0, 2.0]));
    row(&signal(Shape::PiecewiseLinear { pieces: 2 }, &[0.0, 2.0, 1.0]), numbers([0.0, 1.0, 2.0, 1.5, 1.0]));
    row(&signal(Shape::Polynomial { degree: 1 }, &[0.0, 4.0]), numbers([0.0, 1.0, 2.0, 3.0, 4.0]));
}

#[test]
fn a_shared_expression_is_evaluated_once() {
    let calls = Rc::new(RefCell::new(0));
    let counter = calls.clone();
    let gap = x().map(move |x| {
        *counter.borrow_mut() += 1;
        x - 1.0
    });
    row(&(&gap + gap.named("gap")), numbers([0.0, 2.0, 4.0, 6.0, 8.0]));
    assert_eq!(*calls.borrow(), 5);
}

#[test]
fn an_expression_prints_as_it_is_written() {
    let check = |stream: &Stream<bool>, expected: &str| assert_eq!(stream.node.to_string(), expected);
    check(&(x() - 2.0).below(30.0), "((x - 2) < 30)");
    check(&x().named("gap").take(3).merge(&-y()).at_least(0.5), "(merge(take(gap, 3), -y) >= 0.5)");
    check(&!x().hold(1.0).equals(y().pre()), "not((hold(x, 1) == pre(y)))");
    check(&x().zip(&y()).map(|(x, y)| x > y).skip_until(&Stream::tick()), "skip_until(map(zip(x, y)), tick)");
}

#[test]
fn a_long_chain_needs_no_deep_stack() {
    let chain = (0..200_000).fold(x(), |chain, _| chain + 1.0);
    assert_eq!(over(&chain, &[(Some(1.0), None)]), [Some(200_001.0)]);
}

/// An expression over `x` and `y`, of which both a stream and a list can be made.
#[derive(Debug, Clone)]
enum Expression {
    X,
    Y,
    Constant(f64),
    Map(Box<Expression>),
    Filter(Box<Expression>),
    When(Box<Expression>, Box<Expression>),
    Zip(Box<Expression>, Box<Expression>),
    Add(Box<Expression>, Box<Expression>),
    Take(Box<Expression>, usize),
    Concat(Box<Expression>, Box<Expression>),
    Initially(Box<Expression>, f64),
    Sum(Box<Expression>),
    Scan(Box<Expression>),
    Merge(Box<Expression>, Box<Expression>),
    TakeUntil(Box<Expression>, Box<Expression>),
    SkipUntil(Box<Expression>, Box<Expression>),
    Pre(Box<Expression>),
    Hold(Box<Expression>),
}

/// A stream as the list of its values, and the tick from which on it is over.
#[derive(Debug, Clone)]
struct List {
    values: Vec<Option<f64>>,
    over: usize,
}

const NEVER: usize = usize::MAX;

impl Expression {
    fn stream(&self) -> Stream<f64> {
        use Expression::*;
        match self {
            X => x(),
            Y => y(),
            Constant(value) => Stream::constant(*value),
            Map(a) => a.stream().map(|a| 2.0 * a + 1.0),
            Filter(a) => a.stream().filter(|a| a > 1.0),
            When(a, e) => a.stream().when(&e.stream().above(1.0)),
            Zip(a, b) => a.stream().zip(&b.stream()).map(|(a, b)| 10.0 * a + b),
            Add(a, b) => a.stream() + b.stream(),
            Take(a, count) => a.stream().take(*count),
            Concat(a, b) => a.stream().concat(&b.stream()),
            Initially(a, value) => a.stream().initially(*value),
            Sum(a) => a.stream().sum(),
            Scan(a) => a.stream().scan(1.0, |before, a| a - before),
            Merge(a, b) => a.stream().merge(&b.stream()),
            TakeUntil(a, e) => a.stream().take_until(&e.stream().above(1.0)),
            SkipUntil(a, e) => a.stream().skip_until(&e.stream().above(1.0)),
            Pre(a) => a.stream().pre(),
            Hold(a) => a.stream().hold(-1.0),
        }
    }

    /// What the documentation says, in words of lists.
    fn list(&self, xs: &[Option<f64>], ys: &[Option<f64>]) -> List {
        use Expression::*;
        let of = |expression: &Expression| expression.list(xs, ys);
        let n = xs.len();
        match self {
            X => List { values: xs.to_vec(), over: NEVER },
            Y => List { values: ys.to_vec(), over: NEVER },
            Constant(value) => List { values: vec![Some(*value); n], over: NEVER },
            Map(a) => of(a).each(|_, a| a.map(|a| 2.0 * a + 1.0)),
            Filter(a) => of(a).each(|_, a| a.filter(|a| *a > 1.0)),
            When(a, e) => {
                let (a, e) = (of(a), of(e));
                let over = a.over.min(e.over);
                List { over, ..a.each(|t, a| if e.occurs(t) { a } else { None }) }
            }
            Zip(a, b) => of(a).both(&of(b), |a, b| 10.0 * a + b),
            Add(a, b) => of(a).both(&of(b), |a, b| a + b),
            Take(a, count) => {
                let a = of(a);
                let mut present: Vec<usize> = (0..n).filter(|t| a.values[*t].is_some()).collect();
                present.truncate(*count);
                let enough = present.len() == *count;
                let over = if enough { present.last().map_or(0, |last| last + 1) } else { NEVER };
                List { over: over.min(a.over), ..a.each(|t, a| if present.contains(&t) { a } else { None }) }
            }
            Concat(a, b) => {
                let (a, b) = (of(a), of(b));
                let (from, over) = (a.over, a.over.max(b.over));
                List { over, ..a.each(|t, a| if t >= from { b.values[t] } else { a }) }
            }
            Initially(a, value) => {
                let a = of(a);
                let over = a.over.max(1);
                List { over, ..a.each(|t, a| if t == 0 { Some(*value) } else { a }) }
            }
            Sum(a) => of(a).folded(0.0, |before, a| before + a),
            Scan(a) => of(a).folded(1.0, |before, a| a - before),
            Merge(a, b) => {
                let (a, b) = (of(a), of(b));
                let over = a.over.max(b.over);
                List { over, ..a.each(|t, a| a.or(b.values[t])) }
            }
            TakeUntil(a, e) => {
                let (a, e) = (of(a), of(e));
                let end = (0..n).find(|t| e.occurs(*t)).unwrap_or(NEVER);
                List { over: a.over.min(end), ..a.each(|t, a| a.filter(|_| t < end)) }
            }
            SkipUntil(a, e) => {
                let (a, e) = (of(a), of(e));
                let begin = (0..n).find(|t| e.occurs(*t)).unwrap_or(NEVER);
                a.each(|t, a| a.filter(|_| t >= begin))
            }
            Pre(a) => {
                let a = of(a);
                let values = (0..n).map(|t| if t == 0 { None } else { a.values[t - 1] }).collect();
                List { values, over: a.over.saturating_add(1) }
            }
            Hold(a) => {
                let a = of(a);
                let latest = |t: usize| a.values[..=t].iter().rev().find_map(|a| *a).unwrap_or(-1.0);
                List { values: (0..n).map(|t| Some(latest(t))).collect(), over: NEVER }
            }
        }
    }
}

impl List {
    fn each(&self, f: impl Fn(usize, Option<f64>) -> Option<f64>) -> Self {
        let values = self.values.iter().enumerate().map(|(t, value)| f(t, *value)).collect();
        Self { values, over: self.over }
    }

    fn both(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let pair = |t: usize, a: Option<f64>| a.zip(other.values[t]).map(|(a, b)| f(a, b));
        Self { over: self.over.min(other.over), ..self.each(pair) }
    }

    fn folded(&self, initial: f64, f: impl Fn(f64, f64) -> f64) -> Self {
        let so_far = |t: usize| self.values[..=t].iter().flatten().fold(initial, |before, a| f(before, *a));
        self.each(|t, a| a.map(|_| so_far(t)))
    }

    fn occurs(&self, t: usize) -> bool {
        self.values[t].is_some_and(|value| value > 1.0)
    }
}

fn expressions() -> impl Strategy<Value = Expression> {
    use Expression::*;
    let leaf = prop_oneof![3 => Just(X), 3 => Just(Y), 1 => (0..4i32).prop_map(|value| Constant(value.into()))];
    leaf.prop_recursive(5, 40, 2, |inner| {
        let one = || inner.clone().prop_map(Box::new);
        let two = || (one(), one());
        prop_oneof![
            one().prop_map(Map),
            one().prop_map(Filter),
            two().prop_map(|(a, b)| When(a, b)),
            two().prop_map(|(a, b)| Zip(a, b)),
            two().prop_map(|(a, b)| Add(a, b)),
            (one(), 0..4usize).prop_map(|(a, count)| Take(a, count)),
            two().prop_map(|(a, b)| Concat(a, b)),
            (one(), 0..4i32).prop_map(|(a, value)| Initially(a, value.into())),
            one().prop_map(Sum),
            one().prop_map(Scan),
            two().prop_map(|(a, b)| Merge(a, b)),
            two().prop_map(|(a, b)| TakeUntil(a, b)),
            two().prop_map(|(a, b)| SkipUntil(a, b)),
            one().prop_map(Pre),
            one().prop_map(Hold),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn streams_mean_what_lists_say(
        expression in expressions(),
        ticks in prop::collection::vec((prop::option::of(0..4i32), prop::option::of(0..4i32)), 1..12),
    ) {
        let ticks: Vec<_> = ticks.into_iter().map(|(x, y)| (x.map(f64::from), y.map(f64::from))).collect();
        let (xs, ys): (Vec<_>, Vec<_>) = ticks.iter().copied().unzip();
        // In lists as long as this, values may grow beyond what sums exactly; both sides round alike.
        prop_assert_eq!(over(&expression.stream(), &ticks), expression.list(&xs, &ys).values);
    }
}
