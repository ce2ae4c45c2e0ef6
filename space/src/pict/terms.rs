//! Converts the comparisons of a model into expressions of the constraint language.
//!
//! PICT ignores the case of words and orders them; the constraint language does neither. So a comparison with a value
//! becomes the list of the levels at which it holds. A comparison between two parameters is written level by level if
//! the constraint language would give it another meaning.

use super::parameters::{Declared, Seen, folded};
use crate::Value;
use crate::constraint::{Expression, Operand, Relation};
use std::collections::HashSet;

/// Says that the parameter takes a negative value, or that it takes a value that is not negative.
pub(super) fn of_sign(parameter: &Declared, negative: bool) -> Expression {
    membership(parameter, parameter.values.iter().map(|listed| listed.negative == negative).collect())
}

/// Says that the word of the parameter matches the pattern. `*` stands for any characters and `?` for one character.
pub(super) fn like(parameter: &Declared, pattern: &str) -> Expression {
    let pattern = upper(pattern);
    let matching = parameter.values.iter().map(|listed| matches(&pattern, &upper(&listed.text)));
    membership(parameter, matching.collect())
}

/// Says that the parameter has this relation to a value. Both are numbers or both are words.
pub(super) fn with_value(parameter: &Declared, relation: Relation, value: Value) -> Expression {
    if relation.orders() && value.number().is_some() {
        return Expression::Compare { parameter: parameter.name.clone(), relation, with: Operand::Value(value) };
    }
    membership(parameter, parameter.values.iter().map(|listed| listed.related(relation, &value)).collect())
}

/// Says that the parameter takes one of the values.
pub(super) fn among(parameter: &Declared, values: &[Value]) -> Expression {
    let values: HashSet<Seen> = values.iter().map(Seen::of).collect();
    membership(parameter, parameter.values.iter().map(|listed| values.contains(&parameter.seen(listed))).collect())
}

/// Says that two parameters have this relation. Both have numbers or both have words.
pub(super) fn with_parameter(left: &Declared, relation: Relation, right: &Declared) -> Expression {
    let as_written =
        || Expression::Compare { parameter: left.name.clone(), relation, with: Operand::Parameter(right.name.clone()) };
    let common = left.shares_a_value(right);
    if left.numeric && (relation.orders() || common) {
        return as_written();
    }
    let key = |parameter: &Declared| parameter.values.iter().map(|listed| folded(&listed.text)).collect::<Vec<_>>();
    let (keys, partners) = (key(left), key(right));
    let related = |i: usize, j: usize| relation.holds(&keys[i], &partners[j]);
    let literal = |i: usize, j: usize| relation.holds(&(left.values[i].value == right.values[j].value), &true);
    let pairs = || (0..keys.len()).flat_map(|i| (0..partners.len()).map(move |j| (i, j)));
    if common && !relation.orders() && pairs().all(|(i, j)| related(i, j) == literal(i, j)) {
        return as_written();
    }
    // Group the levels of the left parameter that go with the same levels of the right parameter.
    let mut groups: Vec<(Vec<bool>, Vec<bool>)> = Vec::new();
    for i in 0..keys.len() {
        let partners: Vec<bool> = (0..partners.len()).map(|j| related(i, j)).collect();
        if !partners.contains(&true) {
            continue;
        }
        match groups.iter_mut().find(|(_, known)| *known == partners) {
            Some((group, _)) => group[i] = true,
            None => groups.push(((0..keys.len()).map(|other| other == i).collect(), partners)),
        }
    }
    let both = |(group, partners)| Expression::And(vec![membership(left, group), membership(right, partners)]);
    let mut cases: Vec<Expression> = groups.into_iter().map(both).collect();
    match cases.len() {
        0 => membership(left, vec![false; keys.len()]),
        1 => cases.remove(0),
        _ => Expression::Or(cases),
    }
}

/// Says that the parameter has one of the marked levels, as shortly as possible.
fn membership(parameter: &Declared, marked: Vec<bool>) -> Expression {
    let those = |mark: bool| {
        let levels = parameter.values.iter().zip(&marked).filter(|(_, marked)| **marked == mark);
        // Constraints treat equal numbers as one value.
        let mut seen = HashSet::new();
        let mut is_new = |value: &Value| match value.number() {
            Some(_) => seen.insert(Seen::of(value)),
            None => true,
        };
        levels.map(|(listed, _)| &listed.value).filter(|value| is_new(value)).cloned().collect::<Vec<Value>>()
    };
    let (inside, outside) = (those(true), those(false));
    let compare = |relation, value: &Value| Expression::Compare {
        parameter: parameter.name.clone(),
        relation,
        with: Operand::Value(value.clone()),
    };
    let among = |values| Expression::In { parameter: parameter.name.clone(), values };
    match (inside.as_slice(), outside.as_slice()) {
        ([one], [_, ..]) => compare(Relation::Equal, one),
        ([_, ..], [one]) => compare(Relation::NotEqual, one),
        (some, others) if some.len() <= others.len() => among(inside),
        _ => Expression::Not(Box::new(among(outside))),
    }
}

fn upper(text: &str) -> Vec<char> {
    folded(text).chars().collect()
}

/// Returns `true` if the whole text matches the pattern. A star takes as few characters as possible. If the rest does
/// not match, the last star takes one character more.
fn matches(pattern: &[char], text: &[char]) -> bool {
    let (mut p, mut t) = (0, 0);
    let mut star = None;
    while t < text.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p, t));
                p += 1;
            }
            Some(sign) if *sign == '?' || *sign == text[t] => {
                p += 1;
                t += 1;
            }
            _ => {
                let Some((at, taken)) = star else { return false };
                star = Some((at, taken + 1));
                p = at + 1;
                t = taken + 1;
            }
        }
    }
    pattern[p..].iter().all(|sign| *sign == '*')
}
