//! Constraints that compute numbers and name continuous parameters, against a naive evaluation of single tests.

use paracosm_space::constraint::{Expression, Function, Operand, Relation, Specialised, Term};
use paracosm_space::{Domain, Parameter, Point, Space, Value, Values};
use proptest::prelude::*;

const RELATIONS: [Relation; 6] = [
    Relation::Less,
    Relation::LessOrEqual,
    Relation::Greater,
    Relation::GreaterOrEqual,
    Relation::Equal,
    Relation::NotEqual,
];

fn space() -> Space {
    let interval = |name: &str, lo, hi| Parameter::new(name, Domain::Interval { lo, hi });
    let choice = |name: &str, levels: &[f64]| {
        Parameter::new(name, Domain::Choice(levels.iter().map(|level| Value::Number(*level)).collect()))
    };
    Space::new(vec![
        interval("speed", 0.0, 10.0),
        choice("lanes", &[1.0, 2.0, 4.0]),
        interval("the gap", -5.0, 20.0),
        choice("min", &[-1.0, 0.0, 3.5]),
    ])
    .unwrap()
}

/// The value of a term, in the words of the documentation of the functions.
fn number(term: &Term, test: &Values) -> Option<f64> {
    let value = match term {
        Term::Number(number) => *number,
        Term::Parameter(name) => test.get(name)?.number()?,
        Term::Applied(function, operands) => {
            let operands: Vec<f64> = operands.iter().map(|term| number(term, test)).collect::<Option<_>>()?;
            let a = operands[0];
            let b = || operands[1];
            match function {
                Function::Add => a + b(),
                Function::Subtract => a - b(),
                Function::Multiply => a * b(),
                Function::Divide => a / b(),
                Function::Remainder => a - b() * (a / b()).trunc(),
                Function::Negate => 0.0 - a,
                Function::Least => {
                    if a < b() {
                        a
                    } else {
                        b()
                    }
                }
                Function::Greatest => {
                    if a > b() {
                        a
                    } else {
                        b()
                    }
                }
                Function::Absolute => {
                    if a < 0.0 {
                        -a
                    } else {
                        a
                    }
                }
                Function::Root => a.sqrt(),
                Function::Floor => a.floor(),
                other => panic!("{other:?} is not generated"),
            }
        }
    };
    value.is_finite().then_some(value)
}

fn naive(expression: &Expression, test: &Values) -> bool {
    let related = |left: Option<f64>, relation: &Relation, right: Option<f64>| matches!((left, right), (Some(left), Some(right)) if relation.holds(&left, &right));
    match expression {
        Expression::Compare { parameter, relation, with } => {
            let right = match with {
                Operand::Value(value) => value.number(),
                Operand::Parameter(name) => test.get(name).and_then(Value::number),
            };
            related(test.get(parameter).and_then(Value::number), relation, right)
        }
        Expression::In { parameter, values } => values.iter().any(|value| test.get(parameter) == Some(value)),
        Expression::Relate { left, relation, right } => related(number(left, test), relation, number(right, test)),
        Expression::Not(part) => !naive(part, test),
        Expression::And(parts) => parts.iter().all(|part| naive(part, test)),
        Expression::Or(parts) => parts.iter().any(|part| naive(part, test)),
        Expression::Implies(condition, consequence) => !naive(condition, test) || naive(consequence, test),
    }
}

/// A term of the parameters with the given names. Its numbers are whole, so that many of its values are exact.
fn term(names: &'static [&'static str]) -> impl Strategy<Value = Term> {
    let leaf = prop_oneof![
        (-6..7i32).prop_map(|number| Term::Number(f64::from(number))),
        prop::sample::select(names).prop_map(|name| Term::Parameter(name.to_owned())),
    ];
    leaf.prop_recursive(3, 8, 2, |inner| {
        let two = prop::sample::select(vec![
            Function::Add,
            Function::Subtract,
            Function::Multiply,
            Function::Divide,
            Function::Least,
            Function::Greatest,
        ]);
        let one = prop::sample::select(vec![Function::Absolute, Function::Root, Function::Floor]);
        prop_oneof![
            (two, inner.clone(), inner.clone()).prop_map(|(function, a, b)| Term::Applied(function, vec![a, b])),
            (one, inner.clone()).prop_map(|(function, a)| Term::Applied(function, vec![a])),
            inner.prop_map(Term::negative),
        ]
    })
}

/// A statement about the parameters with the given names, which compares sizes only.
fn expression(names: &'static [&'static str]) -> impl Strategy<Value = Expression> {
    let relation = || prop::sample::select(&RELATIONS[..4]);
    let leaf = (term(names), relation(), term(names)).prop_filter_map("a parameter", |(left, relation, right)| {
        let related = Expression::Relate { left, relation, right };
        // What the text of the expression says, in the form that the parser gives it.
        related.to_string().parse::<Expression>().ok()
    });
    leaf.prop_recursive(3, 10, 3, |inner| {
        let several = || prop::collection::vec(inner.clone(), 2..4);
        prop_oneof![
            inner.clone().prop_map(|part| Expression::Not(Box::new(part))),
            several().prop_map(Expression::And),
            several().prop_map(Expression::Or),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| Expression::Implies(Box::new(a), Box::new(b))),
        ]
    })
}

const ALL: &[&str] = &["speed", "lanes", "the gap", "min"];
const DISCRETE: &[&str] = &["lanes", "min"];

fn point() -> impl Strategy<Value = Point> {
    (prop::collection::vec(0.0..=1.0f64, 2), prop::collection::vec(0..3usize, 2))
        .prop_map(|(continuous, discrete)| Point { continuous, discrete })
}

proptest! {
    #[test]
    fn a_constraint_allows_the_tests_that_it_says(expression in expression(ALL), points in prop::collection::vec(point(), 20)) {
        let text = expression.to_string();
        prop_assert_eq!(&text.parse::<Expression>().unwrap(), &expression, "{}", text);
        let space = space().with_constraints([&text]).unwrap();
        for point in points {
            let says = naive(&expression, &space.decode(&point));
            prop_assert_eq!(space.allows(&point), says, "{} {:?}", text, point);
            // The condition on the levels leaves out no test that keeps the constraint.
            prop_assert!(!says || space.constraints()[0].holds(&point.discrete), "{}", text);
        }
    }

    #[test]
    fn the_levels_decide_a_computed_constraint_on_discrete_parameters(expression in expression(DISCRETE)) {
        let space = space().with_constraints([expression.to_string()]).unwrap();
        prop_assert!(!space.checks_each_test());
        for row in (0..9).map(|row| vec![row / 3, row % 3]) {
            let point = Point { continuous: vec![0.5, 0.5], discrete: row.clone() };
            let says = naive(&expression, &space.decode(&point));
            prop_assert_eq!(space.constraints()[0].holds(&row), says, "{} {:?}", expression, row);
        }
    }

    #[test]
    fn what_is_certain_of_a_part_of_the_space_is_true_of_each_test(
        expression in expression(ALL),
        corners in [[0..=8u8, 0..=8u8], [0..=8u8, 0..=8u8]],
        inside in prop::collection::vec([0.0..=1.0f64, 0.0..=1.0f64], 20),
        row in prop::collection::vec(0..3usize, 2),
    ) {
        let space = space().with_constraints([expression.to_string()]).unwrap();
        let ends = corners.map(|[a, b]| [f64::from(a.min(b)) / 8.0, f64::from(a.max(b)) / 8.0]);
        let (lower, upper) = (ends.map(|[lower, _]| lower), ends.map(|[_, upper]| upper));
        let certain = space.allows_part(&row, &lower, &upper);
        let corners = (0..4).map(|corner| [f64::from(corner % 2), f64::from(corner / 2)]);
        for at in inside.into_iter().chain(corners) {
            let along = |axis: usize| lower[axis] + at[axis] * (upper[axis] - lower[axis]);
            let point = Point { continuous: vec![along(0), along(1)], discrete: row.clone() };
            let says = naive(&expression, &space.decode(&point));
            prop_assert!(certain.is_none_or(|certain| certain == says), "{} {:?} {:?}", expression, point, certain);
        }
    }

    #[test]
    fn a_specialised_constraint_says_the_same_of_the_tests_with_the_fixed_values(
        expression in expression(ALL),
        points in prop::collection::vec(point(), 10),
        fixed in prop::sample::subsequence(ALL, 0..=4),
    ) {
        let space = space();
        for point in points {
            let test = space.decode(&point);
            let known = |name: &str| fixed.contains(&name).then(|| test.get(name).cloned()).flatten();
            let left = match expression.specialised(&known, &|_, _| true) {
                Specialised::Always => true,
                Specialised::Never => false,
                Specialised::Open(left) => {
                    prop_assert!(left.names().iter().all(|name| !fixed.contains(name)), "{}", left);
                    left.holds(&test)
                }
            };
            prop_assert_eq!(left, naive(&expression, &test), "{} {:?}", expression, test);
        }
    }
}

#[test]
fn a_value_that_a_parameter_never_takes_is_left_out() {
    let takes = |_: &str, value: &Value| *value == Value::from("car");
    let specialised = |text: &str| text.parse::<Expression>().unwrap().specialised(&|_| None, &takes);
    assert_eq!(specialised("model == 'tram'"), Specialised::Never);
    assert_eq!(specialised("model != 'tram'"), Specialised::Always);
    let open = |text: &str| Specialised::Open(text.parse().unwrap());
    assert_eq!(specialised("model in ['tram', 'car'] and model != 'tram'"), open("model in ['car']"));
    assert_eq!(specialised("model == 'tram' implies speed < 3"), Specialised::Always);
}

#[test]
fn terms_are_written_with_as_few_parentheses_as_they_need() {
    for text in [
        "a + b - c < 2",
        "a - (b - c) < 2",
        "a * (b + c) >= -d",
        "a / b % c > a - -2",
        "-(a + b) < min(a, max(b, 2))",
        "(a + b) * 2 < pow(c, 0.5) and not a - b >= sqrt(abs(c))",
    ] {
        assert_eq!(text.parse::<Expression>().unwrap().to_string(), text);
    }
    assert_eq!("((a)+(b))<(2)".parse::<Expression>().unwrap().to_string(), "a + b < 2");
    assert_eq!("a-2 <3".parse::<Expression>().unwrap().to_string(), "a - 2 < 3");
    assert_eq!("(a) < 2 and (b < 3)".parse::<Expression>().unwrap().to_string(), "a < 2 and b < 3");
}

#[test]
fn certainty_is_found_at_bounds_that_are_computed_exactly() {
    let space = space().with_constraints(["speed + [the gap] <= 10"]).unwrap();
    let part = |lower: [f64; 2], upper: [f64; 2]| space.allows_part(&[0, 0], &lower, &upper);
    // The speed is at most 5, and the gap is at most 5.
    assert_eq!(part([0.0, 0.0], [0.5, 0.4]), Some(true));
    assert_eq!(part([0.5, 0.4], [0.6, 0.5]), None);
    assert_eq!(part([0.5, 0.5], [0.6, 0.6]), Some(false));
}

#[test]
fn the_longest_comparison_is_read_written_and_checked() {
    let text = format!("speed{} < 3000", " + speed".repeat(1000));
    let space = space().with_constraints([&text]).unwrap();
    assert_eq!(space.constraints()[0].expression().to_string(), text);
    let test = |share: f64| Point { continuous: vec![share, 0.0], discrete: vec![0, 0] };
    assert!(space.allows(&test(0.2)) && !space.allows(&test(0.4)));
}

#[test]
fn a_constraint_that_no_value_of_an_interval_keeps_is_broken_by_every_row() {
    for text in ["speed > 10.5", "abs(speed) < -1", "speed * speed - 101 > 0"] {
        let space = space().with_constraints([text]).unwrap();
        assert!(!space.constraints()[0].holds(&[0, 0]), "{text}");
        assert!(space.rules().is_err(), "{text}");
    }
}

#[test]
fn continuous_parameters_may_have_to_differ() {
    let test =
        |speed: f64, gap: f64| Point { continuous: vec![speed / 10.0, (gap + 5.0) / 25.0], discrete: vec![0, 0] };
    let part = |space: &Space| space.allows_part(&[0, 0], &[0.0, 0.0], &[1.0, 1.0]);
    for text in [
        "speed != [the gap]",
        "not speed == [the gap]",
        "speed == [the gap] implies lanes == 4",
        "speed > 20 or [the gap] != speed",
    ] {
        let space = space().with_constraints([text]).unwrap();
        assert!(!space.allows(&test(5.0, 5.0)), "{text}");
        assert!(space.allows(&test(5.0, 5.1)) && space.allows(&test(2.5, 5.0)), "{text}");
        // The equal values have no volume.
        assert_eq!(part(&space), Some(true), "{text}");
        let place = [0.5, 0.4];
        assert_eq!(space.allows_part(&[0, 0], &place, &place), Some(false), "{text}");
    }
    let number = space().with_constraints(["speed != 5"]).unwrap();
    assert!(!number.allows(&test(5.0, 0.0)) && number.allows(&test(4.0, 0.0)) && part(&number) == Some(true));
    // Intervals do not decide this: two different terms may be equal everywhere.
    let computed = space().with_constraints(["speed + 1 != max(speed + 1, [the gap] - 20)"]).unwrap();
    assert_eq!(part(&computed), None);
    let never = space().with_constraints(["speed != speed"]).unwrap();
    assert!(!never.allows(&test(5.0, 5.0)) && part(&never).is_none());
}
