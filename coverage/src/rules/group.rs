//! Parameters that constraints join, and the clauses among them.
//!
//! Levels that no literal tells apart are taken together as a *class*: a parameter of a thousand levels of which
//! a constraint singles out one is, to the constraints, a parameter of two.

use super::clause::Clause;
use super::diagram::{Chain, Diagram};
use super::encoding::Undecided;
use super::search::Search;
use std::sync::Arc;

/// A literal over classes.
#[derive(Debug, Clone)]
pub(super) struct ClassLiteral {
    pub(super) parameter: usize,
    /// Whether it holds, for each class.
    pub(super) holds: Vec<bool>,
}

/// A clause over classes.
#[derive(Debug, Clone)]
pub(super) struct ClassClause {
    pub(super) literals: Vec<ClassLiteral>,
}

/// Parameters with their classes of levels, and clauses that can be violated.
#[derive(Debug)]
pub(super) struct Model {
    /// The class of each level of each parameter.
    pub(super) class_of: Vec<Vec<usize>>,
    /// How many levels are in each class of each parameter.
    pub(super) sizes: Vec<Vec<usize>>,
    pub(super) clauses: Vec<ClassClause>,
}

impl Model {
    pub(super) fn new<'a>(levels: &[usize], clauses: impl Iterator<Item = &'a Clause> + Clone) -> Self {
        let mut class_of: Vec<Vec<usize>> = levels.iter().map(|&levels| vec![0; levels]).collect();
        let mut sizes: Vec<Vec<usize>> = levels.iter().map(|&levels| vec![levels]).collect();
        for literal in clauses.clone().flat_map(|clause| &clause.literals) {
            let (classes, sizes) = (&mut class_of[literal.parameter], &mut sizes[literal.parameter]);
            // Every class is split into what the literal has of it and the rest, unless one of both is empty.
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

    /// Those of the clauses that can be violated, over classes.
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

    /// The sizes of the classes of parameters that clauses join, and these clauses.
    pub(super) fn of(&self, members: &[usize]) -> (Vec<Vec<usize>>, Vec<ClassClause>) {
        let inside = |literal: &ClassLiteral| members.binary_search(&literal.parameter).is_ok();
        let clauses = self.clauses.iter().filter(|clause| clause.literals.first().is_some_and(inside));
        (members.iter().map(|&member| self.sizes[member].clone()).collect(), clauses.cloned().collect())
    }

    /// The sets of parameters that clauses join, each in ascending order, by their first parameters.
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

/// Numbers classes in the order of their first levels, so that what is near by level is near by class.
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

/// How questions about a group are answered.
#[derive(Debug)]
enum Engine {
    Diagram(Arc<Diagram>),
    Search(Box<Search>),
}

/// A set of parameters that clauses join.
#[derive(Debug)]
pub(super) struct Group {
    members: Vec<usize>,
    /// The class of each level, and the number of levels in each class, of each member.
    class_of: Vec<Vec<usize>>,
    pub(super) sizes: Vec<Vec<usize>>,
    clauses: Vec<ClassClause>,
    /// The clauses with each member.
    clauses_of: Vec<Vec<usize>>,
    engine: Engine,
}

impl Group {
    /// The group of these parameters; none if its clauses cannot be kept together.
    ///
    /// # Errors
    /// Whether they can takes too long to find out.
    pub(super) fn new(model: &Model, members: Vec<usize>) -> Result<Option<Self>, Undecided> {
        let place = |parameter: usize| members.binary_search(&parameter).ok();
        let (sizes, clauses) = model.of(&members);
        let mut clauses_of = vec![Vec::new(); members.len()];
        for (index, clause) in clauses.iter().enumerate() {
            for place in clause.literals.iter().filter_map(|literal| place(literal.parameter)) {
                clauses_of[place].push(index);
            }
        }
        let engine = match Diagram::new(&members, &sizes, &clauses) {
            Some(diagram) if diagram.is_empty() => return Ok(None),
            Some(diagram) => Engine::Diagram(Arc::new(diagram)),
            None => match Search::new(&members, &sizes, &clauses)? {
                Some(search) => Engine::Search(Box::new(search)),
                None => return Ok(None),
            },
        };
        let class_of = members.iter().map(|&member| model.class_of[member].clone()).collect();
        Ok(Some(Self { members, class_of, sizes, clauses, clauses_of, engine }))
    }

    pub(super) fn members(&self) -> &[usize] {
        &self.members
    }

    /// Where a parameter stands among the members.
    pub(super) fn place(&self, parameter: usize) -> Option<usize> {
        self.members.binary_search(&parameter).ok()
    }

    fn keeps(&self, clause: usize, test: &[usize]) -> bool {
        self.clauses[clause].literals.iter().any(|literal| {
            let place = self.place(literal.parameter).expect("clauses do not leave their group");
            literal.holds[self.class_of[place][test[literal.parameter]]]
        })
    }

    pub(super) fn allows(&self, test: &[usize]) -> bool {
        match &self.engine {
            Engine::Diagram(diagram) => diagram.has(|place| self.class_of[place][test[self.members[place]]]),
            Engine::Search(_) => (0..self.clauses.len()).all(|clause| self.keeps(clause, test)),
        }
    }

    /// Whether a test keeps the clauses with a member.
    pub(super) fn allows_at(&self, parameter: usize, test: &[usize]) -> bool {
        let place = self.place(parameter).expect("the parameter is a member");
        self.clauses_of[place].iter().all(|&clause| self.keeps(clause, test))
    }

    fn classes(&self, fixed: impl Fn(usize) -> Option<usize>) -> Vec<Option<usize>> {
        let members = self.members.iter().zip(&self.class_of);
        members.map(|(&member, class_of)| fixed(member).map(|level| class_of[level])).collect()
    }

    pub(super) fn holds(&self, fixed: impl Fn(usize) -> Option<usize>) -> bool {
        let fixed = self.classes(fixed);
        match &self.engine {
            Engine::Diagram(diagram) => match fixed.iter().copied().collect::<Option<Vec<usize>>>() {
                Some(all) => diagram.has(|place| all[place]),
                None => diagram.holds(&fixed),
            },
            Engine::Search(search) => search.holds(&fixed),
        }
    }

    /// Which classes of each member go with the fixed ones.
    pub(super) fn supported_classes(&self, fixed: &[Option<usize>]) -> Vec<Vec<bool>> {
        match &self.engine {
            Engine::Diagram(diagram) => diagram.supported(fixed),
            Engine::Search(search) => search.supported(fixed),
        }
    }

    pub(super) fn supported(&self, fixed: impl Fn(usize) -> Option<usize>) -> Vec<Vec<bool>> {
        let fixed_levels: Vec<Option<usize>> = self.members.iter().map(|&member| fixed(member)).collect();
        let supported = self.supported_classes(&self.classes(fixed));
        let members = self.class_of.iter().zip(&supported).zip(fixed_levels);
        members
            .map(|((class_of, supported), fixed)| {
                let levels = class_of.iter().enumerate();
                levels.map(|(level, &class)| supported[class] && fixed.is_none_or(|fixed| fixed == level)).collect()
            })
            .collect()
    }

    /// Which levels of one member go with the fixed ones; no more is searched for than that.
    pub(super) fn supported_at(&self, parameter: usize, fixed: impl Fn(usize) -> Option<usize>) -> Vec<bool> {
        let place = self.place(parameter).expect("the parameter is a member");
        let (classes, level) = (self.classes(&fixed), fixed(parameter));
        let supported = match &self.engine {
            Engine::Diagram(diagram) => diagram.supported(&classes).swap_remove(place),
            Engine::Search(search) => search.supported_at(place, &classes),
        };
        let levels = self.class_of[place].iter().enumerate();
        levels.map(|(other, &class)| supported[class] && level.is_none_or(|level| level == other)).collect()
    }

    /// How many ways there are to choose the members; none where that cannot be counted.
    pub(super) fn tests(&self) -> Option<f64> {
        match &self.engine {
            Engine::Diagram(diagram) => Some(diagram.tests(&self.sizes)),
            Engine::Search(_) => None,
        }
    }

    /// Random ways to choose the members, all equally probable; none where they cannot be counted.
    pub(super) fn chain(&self) -> Option<Chain> {
        match &self.engine {
            Engine::Diagram(diagram) => Some(Chain::new(diagram.clone(), &self.sizes)),
            Engine::Search(_) => None,
        }
    }

    /// The levels of each member in the order of their classes.
    pub(super) fn levels_by_class(&self) -> Vec<Vec<usize>> {
        let by_class = |class_of: &Vec<usize>| {
            let mut levels: Vec<usize> = (0..class_of.len()).collect();
            levels.sort_by_key(|&level| class_of[level]);
            levels
        };
        self.class_of.iter().map(by_class).collect()
    }
}
