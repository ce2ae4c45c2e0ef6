//! The language of constraints: what it says, against expressions evaluated by name and by hand, and how it is written.

mod common;

use common::drive;
use paracosm_space::constraint::{Expression, Operand, Relation};
use paracosm_space::rules::Clause;
use paracosm_space::{Domain, Parameter, Point, Space, SpaceError, Value, Values};
use proptest::prelude::*;

fn tests_of(space: &Space) -> Vec<Point> {
    let rows = space.levels().iter().fold(vec![vec![]], |heads: Vec<Vec<usize>>, &levels| {
        heads.iter().flat_map(|head| (0..levels).map(|level| [head.as_slice(), &[level]].concat())).collect()
    });
    let continuous = vec![0.5; space.dims()];
    rows.into_iter().map(|discrete| Point { continuous: continuous.clone(), discrete }).collect()
}

/// What an expression says of values by name.
fn meaning(expression: &Expression, test: &Values) -> bool {
    let value = |name: &str| test.get(name).expect("a parameter of the test").clone();
    match expression {
        Expression::Compare { parameter, relation, with } => {
            let left = value(parameter);
            let right = match with {
                Operand::Value(value) => value.clone(),
                Operand::Parameter(name) => value(name),
            };
            let numbers = || (left.number().expect("a number"), right.number().expect("a number"));
            match relation {
                Relation::Equal => left == right,
                Relation::NotEqual => left != right,
                Relation::Less => numbers().0 < numbers().1,
                Relation::LessOrEqual => numbers().0 <= numbers().1,
                Relation::Greater => numbers().0 > numbers().1,
                Relation::GreaterOrEqual => numbers().0 >= numbers().1,
            }
        }
        Expression::In { parameter, values } => values.iter().any(|listed| *listed == value(parameter)),
        Expression::Relate { .. } => unreachable!("computed constraints have tests of their own"),
        Expression::Not(part) => !meaning(part, test),
        Expression::And(parts) => parts.iter().all(|part| meaning(part, test)),
        Expression::Or(parts) => parts.iter().any(|part| meaning(part, test)),
        Expression::Implies(condition, consequence) => !meaning(condition, test) || meaning(consequence, test),
    }
}

fn keeps(row: &[usize], clauses: &[Clause]) -> bool {
    clauses.iter().all(|clause| {
        clause.literals.iter().any(|literal| literal.levels.iter().any(|level| row[literal.parameter] == *level))
    })
}

/// Checks that literals stand in order, each parameter once, and that none is empty or says nothing.
fn well_formed(clauses: &[Clause], levels: &[usize]) -> bool {
    let rising = |numbers: &[usize]| numbers.windows(2).all(|pair| pair[0] < pair[1]);
    clauses.iter().all(|clause| {
        let parameters: Vec<_> = clause.literals.iter().map(|literal| literal.parameter).collect();
        let fits = |literal: &paracosm_space::rules::Literal| {
            let size = levels[literal.parameter];
            rising(&literal.levels)
                && (1..size).contains(&literal.levels.len())
                && literal.levels.iter().all(|l| *l < size)
        };
        rising(&parameters) && clause.literals.iter().all(fits)
    })
}

/// A leaf for these parameters, from numbers that choose.
fn leaf(space: &Space, kind: u8, [a, b, c]: [usize; 3]) -> Expression {
    let relations = [
        Relation::Equal,
        Relation::NotEqual,
        Relation::Less,
        Relation::LessOrEqual,
        Relation::Greater,
        Relation::GreaterOrEqual,
    ];
    let discrete: Vec<_> = space.discrete().map(|coordinate| coordinate.parameter).collect();
    let left = discrete[a % discrete.len()];
    let levels = left.levels().unwrap();
    let numeric = |parameter: &Parameter| parameter.levels().unwrap().iter().all(|level| level.number().is_some());
    let relation = relations[c % if numeric(left) { 6 } else { 2 }];
    let parameter = left.name.clone();
    let right = discrete[b % discrete.len()];
    let common = levels.iter().any(|level| right.levels().unwrap().contains(level));
    match kind {
        0 => {
            let values = levels.iter().enumerate().filter(|(i, _)| (b >> i) & 1 == 1).map(|(_, level)| level.clone());
            Expression::In { parameter, values: values.collect() }
        }
        1 if common && (numeric(right) || c % 6 < 2) => {
            Expression::Compare { parameter, relation, with: Operand::Parameter(right.name.clone()) }
        }
        _ => {
            let value = Operand::Value(levels[b % levels.len()].clone());
            Expression::Compare { parameter, relation, with: value }
        }
    }
}

fn expression(space: Space) -> impl Strategy<Value = Expression> {
    let leaf = (0..3u8, [0..60usize, 0..60, 0..60]).prop_map(move |(kind, which)| leaf(&space, kind, which));
    leaf.prop_recursive(4, 24, 4, |inner| {
        let several = || prop::collection::vec(inner.clone(), 2..4);
        prop_oneof![
            inner.clone().prop_map(|part| Expression::Not(Box::new(part))),
            several().prop_map(Expression::And),
            several().prop_map(Expression::Or),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| Expression::Implies(Box::new(a), Box::new(b))),
        ]
    })
}

/// Small spaces, whose parameters share some of their values.
fn small_space() -> impl Strategy<Value = Space> {
    let words = prop::sample::subsequence(vec!["a", "b", "c", "d"], 1..=4);
    let numbers = prop::sample::subsequence(vec![-1.5, 0.0, 2.0, 7.0, 1e9], 1..=5);
    let levels = prop_oneof![
        words.prop_map(|words| words.into_iter().map(Value::from).collect::<Vec<_>>()),
        numbers.prop_map(|numbers| numbers.into_iter().map(Value::from).collect()),
    ];
    prop::collection::vec(levels, 1..=4).prop_map(|choices| {
        let names = ["plain", "with space", "in", "a]b\\c"];
        let parameter = |(name, levels): (&str, _)| Parameter::new(name, Domain::Choice(levels));
        Space::new(names.into_iter().zip(choices).map(parameter).collect()).unwrap()
    })
}

proptest! {
    #[test]
    fn an_expression_is_read_back_as_it_was_written(
        expression in small_space().prop_flat_map(expression)
    ) {
        prop_assert_eq!(expression.to_string().parse::<Expression>(), Ok(expression));
    }

    #[test]
    fn any_name_and_any_word_are_read_back_as_they_were_written(name in ".{1,8}", word in ".{0,8}", number in -1e30..1e30f64) {
        for value in [Value::Word(word), Value::Number(number)] {
            let with = Operand::Value(value.clone());
            let compare = Expression::Compare { parameter: name.clone(), relation: Relation::Equal, with };
            prop_assert_eq!(compare.to_string().parse::<Expression>(), Ok(compare));
            let among = Expression::In { parameter: name.clone(), values: vec![value.clone(), value] };
            prop_assert_eq!(among.to_string().parse::<Expression>(), Ok(among));
        }
    }

    #[test]
    fn constraints_and_their_clauses_hold_where_the_expression_is_true(
        (space, expression) in small_space().prop_flat_map(|space| (Just(space.clone()), expression(space)))
    ) {
        let levels = space.levels();
        let constrained = space.with_constraints([expression.to_string()]).unwrap();
        let clauses = constrained.clauses();
        prop_assert!(well_formed(&clauses[0], &levels), "{:?}", clauses);
        for test in tests_of(&constrained) {
            let expected = meaning(&expression, &constrained.decode(&test));
            prop_assert_eq!(constrained.allows(&test), expected, "{} {:?}", expression, test);
            prop_assert_eq!(keeps(&test.discrete, &clauses[0]), expected, "{} {:?}", expression, test);
        }
    }

    #[test]
    fn lists_of_allowed_combinations_become_clauses(
        rows in prop::collection::vec([0..6i32, 0..6i32, 0..6i32], 2..60)
    ) {
        let names = ["a", "b", "c"];
        let choice = |name: &&str| Parameter::new(*name, Domain::Choice((0..6).map(Value::from).collect()));
        let space = Space::new(names.iter().map(choice).collect()).unwrap();
        let allowed = rows.iter().map(|[a, b, c]| format!("a == {a} and b == {b} and c == {c}"));
        let space = space.with_constraints([allowed.collect::<Vec<_>>().join(" or ")]).unwrap();
        let clauses = &space.clauses()[0];
        for test in tests_of(&space) {
            let listed = rows.iter().any(|row| (0..3).all(|i| row[i] as usize == test.discrete[i]));
            prop_assert_eq!(space.allows(&test), listed);
            prop_assert_eq!(keeps(&test.discrete, clauses), listed);
        }
    }

    #[test]
    fn a_constrained_space_survives_being_written(
        (space, expressions) in small_space().prop_flat_map(|space| {
            (Just(space.clone()), prop::collection::vec(expression(space), 0..3))
        })
    ) {
        let space = space.with_constraints(expressions.iter().map(ToString::to_string)).unwrap();
        prop_assert_eq!(Space::from_toml(&space.to_toml()).unwrap(), space.clone());
        let json = serde_json::to_string(&space).unwrap();
        prop_assert_eq!(serde_json::from_str::<Space>(&json).unwrap(), space);
    }

    #[test]
    fn any_text_is_a_constraint_or_an_error_within_it(
        text in prop_oneof![".{0,40}", "([a-z ]|[0-9.\\-]|[(),'\"\\[\\]\\\\]|[=!<>&|]| and | or | not | in | implies ){0,40}"]
    ) {
        if let Err(error) = text.parse::<Expression>() {
            prop_assert!(text.is_char_boundary(error.offset), "{:?}", error);
        }
        if let Err(SpaceError::Constraint { error, .. }) = drive().with_constraints([&text]) {
            prop_assert!(text.is_char_boundary(error.offset), "{:?}", error);
        }
    }
}

#[test]
fn words_bind_as_documented() {
    let check = |text: &str, expected: &str| {
        assert_eq!(text.parse::<Expression>().unwrap(), expected.parse().unwrap(), "{text}");
    };
    check("a == 1 or b == 2 and c == 3", "a == 1 or (b == 2 and c == 3)");
    check("not a == 1 and b == 2", "(not a == 1) and b == 2");
    check("a == 1 and b == 2 implies c == 3 or d == 4", "(a == 1 and b == 2) implies (c == 3 or d == 4)");
    check("a == 1 implies b == 2 implies c == 3", "a == 1 implies (b == 2 implies c == 3)");
    check("a not in ['x', 2]", "not (a in ['x', 2])");
    check("2 < a", "a > 2");
    check("'x' == [a]", "a == 'x'");
    check("a==-1.5e+3", "[a] == -1500");
    check(r#"a == "it's""#, r"a == 'it\'s'");
}

#[test]
fn clauses_are_as_few_as_the_constraint_needs() {
    let check = |text: &str, expected: &[&[(usize, &[usize])]]| {
        let space = drive().with_constraints([text]).unwrap();
        let literals =
            |clause: &Clause| clause.literals.iter().map(|l| (l.parameter, l.levels.clone())).collect::<Vec<_>>();
        let found: Vec<_> = space.clauses()[0].iter().map(literals).collect();
        let expected: Vec<Vec<_>> =
            expected.iter().map(|clause| clause.iter().map(|(p, levels)| (*p, levels.to_vec())).collect()).collect();
        assert_eq!(found, expected, "{text}");
    };
    check("lanes == 2 implies weather != 'fog'", &[&[(0, &[0, 1]), (1, &[1, 2])]]);
    check("lanes == 2 implies weather != 'fog' and weather != 'rain'", &[&[(0, &[0]), (1, &[1, 2])]]);
    check("lanes < 6 and (lanes > 2 or open == 1)", &[&[(1, &[0, 1])], &[(1, &[1, 2]), (2, &[0])]]);
    check("open == lanes", &[&[(2, &[1])], &[(1, &[0]), (2, &[0, 2])]]);
    check("lanes > 0", &[]);
    check("lanes > 6", &[&[]]);
    check("lanes == 2 or not lanes == 2", &[]);
    check("lanes in []", &[&[]]);
    check("lanes == lanes", &[]);
    check("lanes < lanes", &[&[]]);
}

#[test]
fn relations_between_parameters_of_many_values_become_clauses() {
    let choice = |name: &str| Parameter::new(name, Domain::Choice((0..800).map(Value::from).collect()));
    let space = Space::new(vec![choice("a"), choice("b")]).unwrap();
    let space = space.with_constraints(["a == b", "a != b", "a < b"]).unwrap();
    assert_eq!(space.clauses().iter().map(Vec::len).collect::<Vec<_>>(), [800, 800, 800]);
}

#[test]
fn a_constraint_without_short_clauses_is_refused() {
    let choice = |i: usize| Parameter::new(format!("p{i}"), Domain::Choice(vec![0.into(), 1.into()]));
    let space = Space::new((0..60).map(choice).collect()).unwrap();
    let pairs: Vec<_> = (0..30).map(|i| format!("p{} == 1 and p{} == 1", 2 * i, 2 * i + 1)).collect();
    let error = space.with_constraints([pairs.join(" or ")]).unwrap_err().to_string();
    assert!(error.contains("too many clauses") && error.contains("joined by `and`"), "{error}");
}

#[test]
fn constraints_count_coordinates_where_a_choice_varies_over_time_and_refuse_to_speak_of_it() {
    let text = r#"
        constraints = ["lanes == 2 implies weather != 'fog'"]

        [[parameter]]
        name = "light"
        choice = ["day", "night"]
        signal = { shape = "piecewise-constant", pieces = 3 }

        [[parameter]]
        name = "lanes"
        choice = [2, 4]

        [[parameter]]
        name = "weather"
        choice = ["clear", "fog"]
    "#;
    let space = Space::from_toml(text).unwrap();
    let rules = space.rules().unwrap();
    assert_eq!(rules.levels(), [2, 2, 2, 2, 2]);
    assert!(!rules.allows(&[1, 1, 1, 0, 1]) && rules.allows(&[1, 1, 1, 1, 1]) && rules.allows(&[0, 0, 1, 0, 0]));
    let error = space.with_constraints(["light == 'day'"]).unwrap_err().to_string();
    assert!(error.contains("`light` varies over time, expected a parameter with one value"), "{error}");
}

#[test]
fn two_parameters_of_very_many_levels_can_be_compared() {
    let levels = |name: &str, levels: u32| {
        Parameter::new(name, Domain::Choice((0..levels).map(|level| Value::Number(level.into())).collect()))
    };
    let space = Space::new(vec![levels("a", 300), levels("b", 300), levels("c", 3)]).unwrap();
    let rules = space.with_constraints(["a < b"]).unwrap().rules().unwrap();
    // The pairs of a and b, and with c the 299 levels that each of them can have.
    assert_eq!(rules.count(&[0, 1, 2], 2).valid, 300 * 299 / 2 + 2 * 299 * 3);
    assert!(rules.is_valid(&[(0, 298), (2, 1)]) && !rules.is_valid(&[(0, 299), (2, 1)]));
}
