//! The parameters of a scenario as parameters of tests: their declarations, their values, and their constraints.

use super::demand::{Breach, Demand};
use super::distribution::{Distribution, Opened};
use super::kind::Kind;
use super::local::{Local, declarations};
use super::scope::{Node, Scope, references};
use crate::xml::{ExpressionFlaw, ReadError};
use paracosm_engine::{Constraint, Declared, Scenario};
use paracosm_space::{Domain, Parameter, Value, Values};
use std::sync::Arc;

/// The name of the parameter that chooses the entity which the system under test drives.
pub const EGO: &str = "ego";
/// The bound of a parameter that is a number without a distribution.
const BOUND: f64 = 1e9;

/// The parameters that a scenario declares, with a distribution of their values.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    distribution: Distribution,
    declarations: Vec<Declaration>,
}

/// The declaration of a parameter.
#[derive(Debug)]
struct Declaration {
    /// The value, which may be an expression of earlier parameters.
    text: String,
    demand: Demand,
}

impl Declaration {
    fn name(&self) -> &str {
        &self.demand.name
    }

    /// Returns `true` if the value follows from other parameters.
    fn follows(&self) -> bool {
        self.text.starts_with('$')
    }
}

impl Parameters {
    /// Reads the declarations of a scenario.
    pub fn read(root: Node<'_>, distribution: Distribution) -> Result<Self, ReadError> {
        let declaration = |element| {
            let node = Node { element, ..root };
            if element.text("name") == Some(EGO) {
                return Err(node.unexpected("name", EGO, "another name, because this one chooses the ego vehicle"));
            }
            let demand = Demand::read(node)?;
            let declared = Declaration { text: element.text("value").unwrap_or_default().to_owned(), demand };
            if !declared.follows() && !declared.demand.kind.takes(&declared.text) {
                return Err(Breach::of(declared.demand.kind).error(node, &declared.text));
            }
            Ok(declared)
        };
        let declarations = declarations(root.element).map(declaration).collect::<Result<_, ReadError>>()?;
        Ok(Self { distribution, declarations })
    }

    /// Declares the parameters and their constraints in a world, and returns the values that the test gives them. A
    /// parameter whose value is an expression follows from the others.
    pub fn declared(self: &Arc<Self>, root: Node<'_>, s: &mut Scenario) -> Result<Scope, ReadError> {
        let mut given = Values::default();
        for declared in self.list() {
            let name = declared.parameter.name.clone();
            let value = s.parameter(declared).value();
            given.set(name, value);
        }
        let mut scope = Scope::default();
        for (index, (element, declaration)) in declarations(root.element).zip(&self.declarations).enumerate() {
            let node = Node { element, scope: &scope };
            let (demand, given) = (&declaration.demand, self.given(declaration, &given));
            let value = match &given {
                Some(value) => value.clone(),
                None => node.text("value")?.unwrap_or_default().into_owned(),
            };
            let is_constraint = demand.depends_on_values() && (demand.has_limits() || given.is_none());
            if is_constraint {
                let all = self.clone();
                s.constrain(Constraint::new(self.sources(index), move |test| all.broken(index, test)));
            } else if !demand.kind.takes(&value) {
                return Err(Breach::of(demand.kind).error(node, &value));
            }
            scope.set(demand.name.as_str(), value);
        }
        Ok(scope)
    }

    /// Makes the constraint between parameters of tests that a parameter of a part of the scenario makes.
    pub fn constraint(self: &Arc<Self>, local: Local) -> Constraint {
        let all = self.clone();
        Constraint::new(self.behind(local.sources()), move |test| match all.scope(test) {
            Ok(scope) => local.broken(scope),
            Err(flaw) => Some(flaw.to_string()),
        })
    }

    /// Returns all parameters of tests: first the parameters of the distribution, then the other declared parameters.
    fn list(&self) -> impl Iterator<Item = Declared> {
        let nominal = |name: &str| {
            self.find(name).map(|index| &self.declarations[index]).map(|of| of.demand.kind.value(&of.text))
        };
        let whole = |opened: &Opened| {
            opened
                .single()
                .and_then(|name| self.find(name))
                .is_some_and(|at| self.declarations[at].demand.kind.is_whole())
        };
        let opened = self.distribution.0.iter();
        let opened = opened.map(move |opened| Declared { whole: whole(opened), ..opened.declared(nominal) });
        let closed = self.declarations.iter().filter(|declaration| self.is_closed(declaration)).map(|declaration| {
            let kind = declaration.demand.kind;
            let value = kind.value(&declaration.text);
            let domain = match (kind, &value) {
                (Kind::Boolean, _) => Domain::Choice(vec!["true".into(), "false".into()]),
                (Kind::Whole(least, most), _) => Domain::Interval { lo: least as f64, hi: most as f64 },
                (_, Value::Number(number)) => Domain::Interval { lo: (-BOUND).min(*number), hi: BOUND.max(*number) },
                (_, other) => Domain::Choice(vec![other.clone()]),
            };
            let mut parameter = Parameter::new(declaration.name(), domain);
            parameter.default = Some(value);
            let (takes_texts, whole) = (kind.is_text(), kind.is_whole());
            Declared { open: false, takes_texts, whole, ..Declared::open(parameter) }
        });
        opened.chain(closed)
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.declarations.iter().position(|declaration| declaration.name() == name)
    }

    /// Returns `true` if a parameter of tests stands for the declared parameter alone, and the parameter is closed.
    fn is_closed(&self, declaration: &Declaration) -> bool {
        self.distribution.of(declaration.name()).is_none() && !declaration.follows()
    }

    /// Returns the value that a test gives a declared parameter; `None` if the value follows from other parameters.
    fn given(&self, declaration: &Declaration, test: &Values) -> Option<String> {
        if let Some(opened) = self.distribution.of(declaration.name()) {
            let parts = opened.parts(test.get(&opened.name())?);
            return parts.into_iter().find(|(name, _)| *name == declaration.name()).map(|(_, value)| value);
        }
        self.is_closed(declaration).then(|| test.get(declaration.name()).map(ToString::to_string)).flatten()
    }

    /// Returns the values of all declared parameters in a test.
    fn scope(&self, test: &Values) -> Result<Scope, ExpressionFlaw> {
        let mut scope = Scope::default();
        for declaration in &self.declarations {
            let value = match self.given(declaration, test) {
                Some(value) => value,
                None => scope.resolve(&declaration.text)?.into_owned(),
            };
            scope.set(declaration.name(), value);
        }
        Ok(scope)
    }

    /// Returns the names of the parameters of tests on which the demands on a declared parameter depend.
    fn sources(&self, index: usize) -> Vec<String> {
        let limits = self.declarations[index].demand.limits().flat_map(references);
        self.behind(std::iter::once(index).chain(limits.filter_map(|name| self.find(name))).collect())
    }

    /// Returns the names of the parameters of tests from which the values of declared parameters follow.
    fn behind(&self, mut open: Vec<usize>) -> Vec<String> {
        let (mut names, mut seen): (Vec<String>, Vec<usize>) = Default::default();
        while let Some(index) = open.pop() {
            if seen.contains(&index) {
                continue;
            }
            seen.push(index);
            let declaration = &self.declarations[index];
            let own = self.distribution.of(declaration.name()).map(Opened::name);
            let own = own.or_else(|| self.is_closed(declaration).then(|| declaration.name().to_owned()));
            match own {
                Some(name) if names.contains(&name) => (),
                Some(name) => names.push(name),
                None => open.extend(references(&declaration.text).filter_map(|name| self.find(name))),
            }
        }
        names
    }

    /// Returns the reason why a test breaks the demands on a declared parameter; `None` if it keeps them.
    fn broken(&self, index: usize, test: &Values) -> Option<String> {
        let demand = &self.declarations[index].demand;
        match self.scope(test) {
            Ok(scope) => demand.broken(&scope),
            Err(flaw) => Some(format!("the constraints of `{}` cannot be computed: {flaw}", demand.name)),
        }
    }
}

/// Returns the names and the types of the parameters that a scenario declares.
pub(super) fn declared_kinds(root: Node<'_>) -> Result<Vec<(String, Kind)>, ReadError> {
    let one = |element| {
        let node = Node { element, ..root };
        Ok((element.required("name")?.to_owned(), Kind::read(node)?))
    };
    declarations(root.element).map(one).collect()
}

/// Returns the parameters that a scenario declares, with the values of the declarations.
pub(super) fn declared_values(root: Node<'_>) -> Result<Scope, ReadError> {
    let mut scope = Scope::default();
    for element in declarations(root.element) {
        let value = Node { element, scope: &scope }.text("value")?.unwrap_or_default().into_owned();
        scope.set(element.required("name")?, value);
    }
    Ok(scope)
}
