//! The meaning of a constraint in a space: sets of levels and relations between levels, joined without negations.

use super::expression::{Expression, Operand, Relation};
use super::parse::Places;
use super::{ConstraintError, ConstraintFlaw};
use crate::names::nearest;
use crate::value::Meaning;
use crate::{Parameter, Value};
use std::cmp::Ordering;
use std::collections::HashSet;
use std::sync::Arc;

/// A statement about the levels of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Condition {
    /// The level of a parameter is one of the marked levels.
    Among { parameter: usize, levels: Arc<[bool]> },
    /// The relation holds between the ranks of the levels of two parameters.
    Pair { left: usize, right: usize, ranks: [Arc<[usize]>; 2], relation: Relation },
    /// The parts of a conjunction (`all`) or of a disjunction.
    Many { all: bool, parts: Vec<Condition> },
}

impl Condition {
    pub(super) const ALWAYS: Self = Condition::Many { all: true, parts: Vec::new() };
    pub(super) const NEVER: Self = Condition::Many { all: false, parts: Vec::new() };

    /// Makes the condition that the level of the parameter is one of the marked levels.
    pub(super) fn among(parameter: usize, levels: impl IntoIterator<Item = bool>) -> Self {
        let levels: Arc<[bool]> = levels.into_iter().collect();
        if levels.iter().all(|marked| *marked) {
            Condition::ALWAYS
        } else if levels.iter().any(|marked| *marked) {
            Condition::Among { parameter, levels }
        } else {
            Condition::NEVER
        }
    }

    /// Joins the parts by "and" (`all`) or by "or", and simplifies the result: it is flat, each parameter has one set
    /// of levels, and no part occurs twice.
    pub(super) fn many(all: bool, parts: impl IntoIterator<Item = Condition>) -> Self {
        let mut kept: Vec<Condition> = Vec::new();
        let mut queue: Vec<Condition> = parts.into_iter().collect();
        queue.reverse();
        while let Some(part) = queue.pop() {
            match part {
                Condition::Many { all: inner, parts } if inner == all => queue.extend(parts.into_iter().rev()),
                // A part that always holds decides a disjunction; a part that never holds decides a conjunction.
                Condition::Many { parts, .. } if parts.is_empty() => return Condition::Many { all: !all, parts },
                Condition::Among { parameter, levels } => {
                    let same = kept
                        .iter_mut()
                        .find(|other| matches!(other, Condition::Among { parameter: p, .. } if *p == parameter));
                    let Some(other) = same else {
                        kept.push(Condition::Among { parameter, levels });
                        continue;
                    };
                    let Condition::Among { levels: known, .. } = &*other else {
                        unreachable!("found as a set of levels")
                    };
                    let joint = known.iter().zip(levels.iter()).map(|(a, b)| if all { *a && *b } else { *a || *b });
                    match Condition::among(parameter, joint) {
                        joint @ Condition::Among { .. } => *other = joint,
                        // The joint set has all levels in a disjunction, or no level in a conjunction.
                        decided => return decided,
                    }
                }
                part if kept.contains(&part) => {}
                part => kept.push(part),
            }
        }
        if kept.len() == 1 { kept.remove(0) } else { Condition::Many { all, parts: kept } }
    }

    pub(super) fn holds(&self, row: &[usize]) -> bool {
        match self {
            Condition::Among { parameter, levels } => levels[row[*parameter]],
            Condition::Pair { left, right, ranks: [a, b], relation } => relation.holds(&a[row[*left]], &b[row[*right]]),
            Condition::Many { all, parts } => parts.iter().any(|part| part.holds(row) != *all) != *all,
        }
    }

    /// Returns the condition that remains if the parameter has this level.
    pub(super) fn at(&self, parameter: usize, level: usize) -> Self {
        match self {
            Condition::Among { parameter: p, levels } if *p == parameter => {
                if levels[level] {
                    Condition::ALWAYS
                } else {
                    Condition::NEVER
                }
            }
            Condition::Pair { left, right, ranks: [a, b], relation } if *left == parameter => {
                Condition::among(*right, b.iter().map(|rank| relation.holds(&a[level], rank)))
            }
            Condition::Pair { left, right, ranks: [a, b], relation } if *right == parameter => {
                Condition::among(*left, a.iter().map(|rank| relation.holds(rank, &b[level])))
            }
            Condition::Many { all, parts } => Condition::many(*all, parts.iter().map(|part| part.at(parameter, level))),
            other => other.clone(),
        }
    }
}

/// Turns expressions into conditions, and finds names and values that do not fit the parameters.
pub(super) struct Resolver<'a> {
    parameters: &'a [Parameter],
    /// The places of the comparisons that are not resolved yet.
    places: std::slice::Iter<'a, Places>,
}

/// A discrete parameter as a constraint sees it.
#[derive(Clone, Copy)]
struct Side<'a> {
    name: &'a str,
    position: usize,
    levels: &'a [Value],
}

impl<'a> Resolver<'a> {
    pub(super) fn new(parameters: &'a [Parameter], places: &'a [Places]) -> Self {
        Self { parameters, places: places.iter() }
    }

    pub(super) fn resolve(&mut self, expression: &Expression) -> Result<Condition, ConstraintError> {
        self.condition(expression, true)
    }

    /// Returns the condition that the expression holds if `holds` is true, and otherwise the opposite condition.
    fn condition(&mut self, expression: &Expression, holds: bool) -> Result<Condition, ConstraintError> {
        match expression {
            Expression::Compare { parameter, relation, with } => self.comparison(parameter, *relation, with, holds),
            Expression::In { parameter, values } => {
                let places = self.next_places();
                let side = self.side(parameter).map_err(at(places.left))?;
                let levels: HashSet<Meaning> = side.levels.iter().map(Value::meaning).collect();
                let is_level = |value: &Value| levels.contains(&value.meaning());
                if let Some((value, place)) = values.iter().zip(&places.right).find(|(value, _)| !is_level(value)) {
                    side.level(value).map_err(at(*place))?;
                }
                let values: HashSet<Meaning> = values.iter().map(Value::meaning).collect();
                let is_listed = |level: &Value| values.contains(&level.meaning());
                Ok(Condition::among(side.position, side.levels.iter().map(|level| is_listed(level) == holds)))
            }
            Expression::Relate { .. } => unreachable!("constraints that compute numbers are written as tables"),
            Expression::Not(part) => self.condition(part, !holds),
            Expression::And(parts) => self.parts(holds, parts, holds),
            Expression::Or(parts) => self.parts(!holds, parts, holds),
            Expression::Implies(condition, consequence) => {
                let parts = [self.condition(condition, !holds)?, self.condition(consequence, holds)?];
                Ok(Condition::many(!holds, parts))
            }
        }
    }

    /// Checks the names and values of an expression that may compute numbers and name continuous parameters.
    pub(super) fn check(&mut self, expression: &Expression) -> Result<(), ConstraintError> {
        self.check_part(expression, true)
    }

    /// Checks an expression that has to hold if `holds` is true, and must not hold otherwise.
    fn check_part(&mut self, expression: &Expression, holds: bool) -> Result<(), ConstraintError> {
        let demands_equality = |relation: Relation| !relation.orders() && (relation == Relation::Equal) == holds;
        match expression {
            Expression::Compare { parameter, relation, with } => {
                self.check_comparison(parameter, *relation, with, demands_equality(*relation))
            }
            Expression::In { .. } => self.condition(expression, true).map(|_| ()),
            Expression::Relate { left, relation, right } => {
                let places = self.next_places();
                let equality = demands_equality(*relation);
                for (term, place) in [(left, places.left), (right, places.right[0])] {
                    let mut flaw = None;
                    term.each_parameter(&mut |name| {
                        if flaw.is_none() {
                            flaw = self.check_number(name, equality).err();
                        }
                    });
                    flaw.map_or(Ok(()), |flaw| Err(ConstraintError::at(place, flaw)))?;
                }
                Ok(())
            }
            Expression::Not(part) => self.check_part(part, !holds),
            Expression::And(parts) | Expression::Or(parts) => {
                parts.iter().try_for_each(|part| self.check_part(part, holds))
            }
            Expression::Implies(condition, consequence) => {
                self.check_part(condition, !holds)?;
                self.check_part(consequence, holds)
            }
        }
    }

    fn check_comparison(
        &mut self,
        name: &str,
        relation: Relation,
        with: &Operand,
        equality: bool,
    ) -> Result<(), ConstraintError> {
        let has_levels = |name: &str| self.parameter(name).map(|parameter| parameter.levels().is_some());
        let continuous = [Some(name), if let Operand::Parameter(other) = with { Some(other) } else { None }];
        if continuous.into_iter().flatten().all(|name| has_levels(name).unwrap_or(true)) {
            return self.comparison(name, relation, with, true).map(|_| ());
        }
        let places = self.next_places();
        self.check_number(name, equality).map_err(at(places.left))?;
        match with {
            Operand::Parameter(other) => self.check_number(other, equality).map_err(at(places.right[0])),
            Operand::Value(value) if value.number().is_none() => {
                Err(ConstraintError::at(places.right[0], ConstraintFlaw::Size { relation, value: value.clone() }))
            }
            Operand::Value(_) => Ok(()),
        }
    }

    /// Checks that the values of a parameter are numbers, and that no continuous parameter has to be equal to
    /// something if `equality` is true.
    fn check_number(&self, name: &str, equality: bool) -> Result<(), ConstraintFlaw> {
        let parameter = self.parameter(name)?;
        let Some(levels) = parameter.levels() else {
            let flaw = ConstraintFlaw::Continuous { name: name.to_owned() };
            return if equality { Err(flaw) } else { Ok(()) };
        };
        let word = levels.iter().find(|level| level.number().is_none()).cloned();
        word.map_or(Ok(()), |word| Err(ConstraintFlaw::TermOfWord { parameter: name.to_owned(), word }))
    }

    fn parts(&mut self, all: bool, parts: &[Expression], holds: bool) -> Result<Condition, ConstraintError> {
        let parts: Result<Vec<_>, _> = parts.iter().map(|part| self.condition(part, holds)).collect();
        Ok(Condition::many(all, parts?))
    }

    fn next_places(&mut self) -> &'a Places {
        self.places.next().expect("the parser noted a place for every comparison")
    }

    fn comparison(
        &mut self,
        name: &str,
        relation: Relation,
        with: &Operand,
        holds: bool,
    ) -> Result<Condition, ConstraintError> {
        let places = self.next_places();
        let left = self.side(name).map_err(at(places.left))?;
        match with {
            Operand::Value(value) if relation.orders() => {
                left.numbers(relation).map_err(at(places.left))?;
                let Some(number) = value.number() else {
                    let flaw = ConstraintFlaw::Size { relation, value: value.clone() };
                    return Err(ConstraintError::at(places.right[0], flaw));
                };
                let related = |level: &Value| level.number().is_some_and(|level| relation.holds(&level, &number));
                Ok(Condition::among(left.position, left.levels.iter().map(|level| related(level) == holds)))
            }
            Operand::Value(value) => {
                left.level(value).map_err(at(places.right[0]))?;
                let equal = (relation == Relation::Equal) == holds;
                Ok(Condition::among(left.position, left.levels.iter().map(|level| level.means(value) == equal)))
            }
            Operand::Parameter(other) => {
                let right = self.side(other).map_err(|flaw| {
                    let level = left.levels.iter().find(|level| level.word() == Some(other));
                    let (parameter, level) = (left.name.to_owned(), level.cloned());
                    let flaw = match level {
                        Some(level) => ConstraintFlaw::Level { flaw: Box::new(flaw), parameter, level },
                        None => flaw,
                    };
                    ConstraintError::at(places.right[0], flaw)
                })?;
                left.pair(relation, right, holds).map_err(at(places.relation))
            }
        }
    }

    /// Finds the parameter with the given name, which must not vary over time.
    fn parameter(&self, name: &str) -> Result<&'a Parameter, ConstraintFlaw> {
        let owned = || name.to_owned();
        let Some(parameter) = self.parameters.iter().find(|parameter| parameter.name == name) else {
            let nearest = nearest(name, self.parameters.iter().map(|parameter| parameter.name.as_str()));
            return Err(ConstraintFlaw::Unknown { name: owned(), nearest: nearest.map(str::to_owned) });
        };
        if parameter.signal.is_some() {
            return Err(ConstraintFlaw::Varies { name: owned() });
        }
        Ok(parameter)
    }

    /// Finds the discrete parameter with the given name.
    fn side(&self, name: &str) -> Result<Side<'a>, ConstraintFlaw> {
        let parameter = self.parameter(name)?;
        let Some(levels) = parameter.levels() else {
            return Err(ConstraintFlaw::Continuous { name: name.to_owned() });
        };
        let before = self.parameters.iter().take_while(|other| other.name != name);
        let position = before.filter(|other| other.levels().is_some()).map(Parameter::coordinates).sum();
        Ok(Side { name: &parameter.name, position, levels })
    }
}

/// Adds the place to a flaw.
fn at(offset: usize) -> impl Fn(ConstraintFlaw) -> ConstraintError {
    move |flaw| ConstraintError::at(offset, flaw)
}

impl Side<'_> {
    /// Checks that the value is one of the parameter's levels.
    fn level(&self, value: &Value) -> Result<(), ConstraintFlaw> {
        if self.levels.iter().any(|level| level.means(value)) {
            return Ok(());
        }
        // The value may be a number in quotes, or a word that is nearly a level.
        let found = value.to_string();
        let word = nearest(&found, self.levels.iter().filter_map(Value::word));
        let same = self.levels.iter().find(|level| level.to_string() == found);
        let meant = same.or_else(|| self.levels.iter().find(|level| word.is_some() && level.word() == word));
        Err(ConstraintFlaw::Never {
            parameter: self.name.to_owned(),
            value: value.clone(),
            levels: self.levels.to_vec(),
            meant: meant.cloned(),
        })
    }

    /// Checks that all levels of the parameter are numbers.
    fn numbers(&self, relation: Relation) -> Result<(), ConstraintFlaw> {
        let parameter = || self.name.to_owned();
        let word = self.levels.iter().find(|level| level.number().is_none()).cloned();
        word.map_or(Ok(()), |word| Err(ConstraintFlaw::SizeOfWord { relation, parameter: parameter(), word }))
    }

    /// Returns the condition that two parameters have this relation, or its opposite if `holds` is false.
    fn pair(self, relation: Relation, other: Side, holds: bool) -> Result<Condition, ConstraintFlaw> {
        if relation.orders() {
            self.numbers(relation)?;
            other.numbers(relation)?;
        }
        let mut values: Vec<&Value> = self.levels.iter().chain(other.levels).collect();
        values.sort_by(|a, b| order(a, b));
        values.dedup_by(|a, b| order(a, b).is_eq());
        let rank = |value: &Value| values.partition_point(|known| order(known, value).is_lt());
        let ranks = [self, other].map(|side| side.levels.iter().map(rank).collect::<Arc<[usize]>>());
        let common = |ranks: &[Arc<[usize]>; 2]| {
            let known: HashSet<&usize> = ranks[1].iter().collect();
            ranks[0].iter().any(|rank| known.contains(rank))
        };
        if !relation.orders() && !common(&ranks) {
            return Err(ConstraintFlaw::NothingInCommon { parameters: [self, other].map(|side| side.name.to_owned()) });
        }
        let relation = if holds { relation } else { relation.negated() };
        let (left, right) = (self.position, other.position);
        if left == right {
            return Ok(Condition::among(left, ranks[0].iter().map(|rank| relation.holds(rank, rank))));
        }
        Ok(Condition::Pair { left, right, ranks, relation })
    }
}

/// Orders numbers by size, words by their letters, and numbers before words.
fn order(a: &Value, b: &Value) -> Ordering {
    match (a.number(), b.number()) {
        // 0 and -0 are the same value.
        (Some(a), Some(b)) => (a + 0.0).total_cmp(&(b + 0.0)),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => a.word().cmp(&b.word()),
    }
}
