//! Classes of levels, and clauses over classes. They keep diagrams and searches small.
//!
//! A *class* is a set of levels that no literal tells apart. If a parameter has a thousand levels and a constraint
//! names one of them, the parameter has only two classes.

use super::clause::Clause;

/// A literal over classes instead of levels.
#[derive(Debug, Clone)]
pub(super) struct ClassLiteral {
    pub(super) parameter: usize,
    /// For each class, `true` if the literal holds.
    pub(super) holds: Vec<bool>,
}

/// A clause over classes instead of levels.
#[derive(Debug, Clone)]
pub(super) struct ClassClause {
    pub(super) literals: Vec<ClassLiteral>,
}

/// Parameters with their classes of levels, and the clauses that can be violated.
#[derive(Debug)]
pub(super) struct Classes {
    /// The class of each level of each parameter.
    pub(super) class_of: Vec<Vec<usize>>,
    /// The number of levels in each class of each parameter.
    pub(super) sizes: Vec<Vec<usize>>,
    pub(super) clauses: Vec<ClassClause>,
}

impl Classes {
    pub(super) fn new<'a>(levels: &[usize], clauses: impl Iterator<Item = &'a Clause> + Clone) -> Self {
        let mut class_of: Vec<Vec<usize>> = levels.iter().map(|&levels| vec![0; levels]).collect();
        let mut sizes: Vec<Vec<usize>> = levels.iter().map(|&levels| vec![levels]).collect();
        for literal in clauses.clone().flat_map(|clause| &clause.literals) {
            let (classes, sizes) = (&mut class_of[literal.parameter], &mut sizes[literal.parameter]);
            // Split every class into the levels with the literal and the other levels, unless one of the parts is
            // empty.
            let mut inside = vec![0; sizes.len()];
            for &level in &literal.levels {
                inside[classes[level]] += 1;
            }
            let mut part: Vec<Option<usize>> = vec![None; inside.len()];
            for class in 0..inside.len() {
                if inside[class] > 0 && inside[class] < sizes[class] {
                    part[class] = Some(sizes.len());
                    sizes[class] -= inside[class];
                    sizes.push(inside[class]);
                }
            }
            for &level in &literal.levels {
                classes[level] = part[classes[level]].unwrap_or(classes[level]);
            }
        }
        for (classes, sizes) in class_of.iter_mut().zip(&mut sizes) {
            number_by_first_levels(classes, sizes);
        }
        let mut model = Self { class_of, sizes, clauses: Vec::new() };
        model.clauses = model.over_classes(clauses);
        model
    }

    /// Returns the clauses that can be violated, over classes.
    pub(super) fn over_classes<'a>(&self, clauses: impl IntoIterator<Item = &'a Clause>) -> Vec<ClassClause> {
        let over_classes = |clause: &Clause| {
            let literals = clause.literals.iter().map(|literal| {
                let mut holds = vec![false; self.sizes[literal.parameter].len()];
                for &level in &literal.levels {
                    holds[self.class_of[literal.parameter][level]] = true;
                }
                ClassLiteral { parameter: literal.parameter, holds }
            });
            let literals: Vec<ClassLiteral> = literals.filter(|literal| literal.holds.contains(&true)).collect();
            let always = literals.iter().any(|literal| !literal.holds.contains(&false));
            (!always).then_some(ClassClause { literals })
        };
        clauses.into_iter().filter_map(over_classes).collect()
    }

    /// Returns the sizes of the members' classes, and the clauses that join the members.
    pub(super) fn of(&self, members: &[usize]) -> (Vec<Vec<usize>>, Vec<ClassClause>) {
        let inside = |literal: &ClassLiteral| members.binary_search(&literal.parameter).is_ok();
        let clauses = self.clauses.iter().filter(|clause| clause.literals.first().is_some_and(inside));
        (members.iter().map(|&member| self.sizes[member].clone()).collect(), clauses.cloned().collect())
    }

    /// Returns the sets of parameters that clauses join. Each set is in ascending order, and the sets are ordered by
    /// their first parameters.
    pub(super) fn groups(&self) -> Vec<Vec<usize>> {
        let parameters = self.class_of.len();
        let mut label: Vec<Option<usize>> = vec![None; parameters];
        let mut sets: Vec<Vec<usize>> = Vec::new();
        for clause in &self.clauses {
            let Some(first) = clause.literals.first() else { continue };
            let target = *label[first.parameter].get_or_insert_with(|| {
                sets.push(vec![first.parameter]);
                sets.len() - 1
            });
            for literal in &clause.literals[1..] {
                let joined = match label[literal.parameter] {
                    None => vec![literal.parameter],
                    Some(other) if other == target => continue,
                    Some(other) => std::mem::take(&mut sets[other]),
                };
                joined.iter().for_each(|&parameter| label[parameter] = Some(target));
                sets[target].extend(joined);
            }
        }
        sets.retain(|set| !set.is_empty());
        sets.iter_mut().for_each(|set| set.sort_unstable());
        sets.sort_unstable();
        sets
    }
}

/// Numbers classes in the order of their first levels, so that neighbouring levels have neighbouring classes.
fn number_by_first_levels(class_of: &mut [usize], sizes: &mut [usize]) {
    let mut number = vec![None; sizes.len()];
    let mut numbered = Vec::with_capacity(sizes.len());
    for class in class_of {
        let old = *class;
        *class = *number[old].get_or_insert_with(|| {
            numbered.push(sizes[old]);
            numbered.len() - 1
        });
    }
    sizes[..numbered.len()].copy_from_slice(&numbered);
}
