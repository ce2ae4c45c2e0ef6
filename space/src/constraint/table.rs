//! Writes a condition that a function decides as expressions, so that strategies and measures can use the condition.

use super::expression::{Expression, Operand, Relation};
use crate::{Parameter, Value};

/// The greatest number of combinations of levels for which the function is asked.
const MOST_COMBINATIONS: usize = 200_000;

/// Returns the number of levels of each parameter; `None` if there are too many combinations of levels.
fn sizes(parameters: &[&Parameter]) -> Option<Vec<usize>> {
    let levels = |parameter: &&Parameter| parameter.levels().map(<[_]>::len).filter(|_| parameter.signal.is_none());
    let sizes: Vec<usize> = parameters.iter().map(levels).collect::<Option<_>>()?;
    let combinations = sizes.iter().try_fold(1usize, |product, size| product.checked_mul(*size))?;
    (combinations <= MOST_COMBINATIONS).then_some(sizes)
}

/// Returns expressions that hold together exactly for the combinations of levels for which `holds` returns `true`. `holds`
/// gets a value for each of the parameters. If there are no parameters, there are no expressions.
///
/// Returns `None` if a parameter is continuous or varies over time, or if there are more than 200,000 combinations.
pub(super) fn expressions(
    parameters: &[&Parameter],
    mut holds: impl FnMut(&[&Value]) -> bool,
) -> Option<Vec<Expression>> {
    let sizes = sizes(parameters)?;
    let Some((last, others)) = parameters.split_last() else { return Some(Vec::new()) };
    let mut written = Vec::new();
    let mut outer = vec![0; others.len().saturating_sub(1)];
    loop {
        let fixed: Vec<Value> = outer.iter().zip(others).map(|(level, parameter)| at(parameter, *level)).collect();
        // The values of the parameter before the last one, grouped by the values that they leave to the last one.
        let mut groups: Vec<(Vec<Value>, Vec<Value>)> = Vec::new();
        let middle = others.last().map(|parameter| parameter.levels().unwrap_or_default());
        let middle: Vec<Option<&Value>> = middle.map_or(vec![None], |values| values.iter().map(Some).collect());
        for value in middle {
            let left = last.levels().unwrap_or_default().iter().filter(|end| {
                let row: Vec<&Value> = fixed.iter().chain(value).chain([*end]).collect();
                holds(&row)
            });
            let left: Vec<Value> = left.cloned().collect();
            match groups.iter_mut().find(|(_, others)| *others == left) {
                Some((values, _)) => values.extend(value.cloned()),
                None => groups.push((value.cloned().into_iter().collect(), left)),
            }
        }
        let all = last.levels().unwrap_or_default().len();
        for (values, left) in groups.into_iter().filter(|(_, left)| left.len() < all) {
            let known = fixed.iter().zip(others).map(|(value, parameter)| one_of(parameter, vec![value.clone()]));
            let known = known.chain(others.last().map(|parameter| one_of(parameter, values))).collect();
            written.push(statement(known, one_of(last, left)));
        }
        if !next(&mut outer, &sizes) {
            return Some(written);
        }
    }
}

/// Moves to the next combination of levels; `false` after the last one.
fn next(levels: &mut [usize], sizes: &[usize]) -> bool {
    for (level, size) in levels.iter_mut().zip(sizes).rev() {
        *level += 1;
        if *level < *size {
            return true;
        }
        *level = 0;
    }
    false
}

fn at(parameter: &Parameter, level: usize) -> Value {
    parameter.levels().unwrap_or_default()[level].clone()
}

fn one_of(parameter: &Parameter, mut values: Vec<Value>) -> Expression {
    let parameter = parameter.name.clone();
    if values.len() == 1 {
        return Expression::Compare { parameter, relation: Relation::Equal, with: Operand::Value(values.remove(0)) };
    }
    Expression::In { parameter, values }
}

/// Returns the statement that `consequence` follows from all of `known`.
fn statement(mut known: Vec<Expression>, consequence: Expression) -> Expression {
    let condition = match known.len() {
        0 => return consequence,
        1 => known.remove(0),
        _ => Expression::And(known),
    };
    match &consequence {
        Expression::In { values, .. } if values.is_empty() => Expression::Not(Box::new(condition)),
        _ => Expression::Implies(Box::new(condition), Box::new(consequence)),
    }
}

#[cfg(test)]
mod tests {
    use super::expressions;
    use crate::{Domain, Parameter, Point, Space, Value};
    use proptest::prelude::*;

    fn parameter(name: &str, levels: usize) -> Parameter {
        Parameter::new(name, Domain::Choice((0..levels).map(|level| Value::Number(level as f64)).collect()))
    }

    #[test]
    fn continuous_parameters_have_no_table() {
        let speed = Parameter::new("speed", Domain::Interval { lo: 0.0, hi: 1.0 });
        assert_eq!(expressions(&[&parameter("a", 2), &speed], |_| true), None);
    }

    #[test]
    fn too_many_combinations_have_no_table() {
        let (a, b) = (parameter("a", 500), parameter("b", 500));
        assert!(expressions(&[&a], |_| true).is_some());
        assert_eq!(expressions(&[&a, &b], |_| true), None);
    }

    #[test]
    fn a_condition_that_always_holds_needs_no_expression() {
        assert_eq!(expressions(&[&parameter("a", 2), &parameter("b", 2)], |_| true), Some(Vec::new()));
    }

    proptest! {
        #[test]
        fn expressions_hold_exactly_where_the_function_holds(
            sizes in prop::collection::vec(1usize..4, 1..5),
            kept in prop::collection::vec(any::<bool>(), 256),
        ) {
            let parameters: Vec<Parameter> =
                sizes.iter().enumerate().map(|(i, size)| parameter(&format!("p{i}"), *size)).collect();
            let index = |row: &[usize]| row.iter().fold(0, |index, level| index * 4 + level);
            let by_value = |row: &[&Value]| {
                let levels: Vec<usize> = row.iter().map(|value| value.number().unwrap() as usize).collect();
                kept[index(&levels)]
            };
            let written = expressions(&parameters.iter().collect::<Vec<_>>(), by_value).unwrap();
            let texts: Vec<String> = written.iter().map(ToString::to_string).collect();
            let space = Space::new(parameters).unwrap().with_constraints(&texts).unwrap();
            let mut row = vec![0; sizes.len()];
            loop {
                let point = Point { continuous: vec![], discrete: row.clone() };
                prop_assert_eq!(space.allows(&point), kept[index(&row)], "{:?} {:?}", row, texts);
                if !super::next(&mut row, &sizes) {
                    break;
                }
            }
        }
    }
}
