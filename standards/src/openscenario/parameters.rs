//! The parameters of a scenario as parameters of tests: their declarations and their values.

use super::demand::{Breach, Demand};
use super::distribution::{Distribution, Opened};
use super::kind::Kind;
use super::local::declarations;
use super::scope::{Node, Scope, references};
use crate::xml::{Element, ReadError};
use paracosm_engine::{Declared, Scenario};
use paracosm_space::{Domain, Parameter, Value, Values};
use std::collections::BTreeSet;

/// The name of the parameter that chooses the entity which the system under test drives.
pub const EGO: &str = "ego";
/// The name of the parameter that gives the least duration in seconds of a run whose stop trigger does not come. The delay of the stop
/// trigger is added.
pub const DURATION: &str = "run_duration";
/// The names that declarations must not have, with the reasons.
const RESERVED: [(&str, &str); 2] = [(EGO, "chooses the ego vehicle"), (DURATION, "gives the duration of a run")];
/// The values of a parameter of the type of truths.
const TRUTHS: [&str; 2] = ["true", "false"];
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
pub(super) struct Declaration {
    /// The value, which may be an expression of earlier parameters.
    pub text: String,
    pub demand: Demand,
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
        let mut names = BTreeSet::new();
        let declaration = |element: Element<'_, '_>| {
            let node = Node { element, ..root };
            let name = element.required("name")?;
            if !names.insert(name.to_owned()) {
                return Err(node.unexpected("name", name, "a name that no other parameter has"));
            }
            if let Some((name, what)) = RESERVED.iter().find(|(name, _)| element.text("name") == Some(name)) {
                return Err(node.unexpected("name", name, format!("another name, because this one {what}")));
            }
            let demand = Demand::read(node)?;
            let declared = Declaration { text: element.text("value").unwrap_or_default().to_owned(), demand };
            if !declared.follows() && !declared.demand.kind.takes(&declared.text) {
                return Err(Breach::of(declared.demand.kind).error(node, &declared.text));
            }
            Ok(declared)
        };
        let declarations = declarations(root.element).map(declaration).collect::<Result<Vec<_>, ReadError>>()?;
        Ok(Self { distribution, declarations })
    }

    /// Declares the parameters in a world, and returns the values that the test gives them. A
    /// parameter whose value is an expression follows from the others.
    pub fn declared(&self, root: Node<'_>, s: &mut Scenario) -> Result<Scope, ReadError> {
        let mut given = Values::default();
        for declared in self.list() {
            let name = declared.parameter.name.clone();
            let value = s.parameter(declared).value();
            given.set(name, value);
        }
        self.values(root, &given)
    }

    /// Returns the values that a test gives the declared parameters. A parameter whose value is an expression follows from the
    /// others.
    pub fn values(&self, root: Node<'_>, given: &Values) -> Result<Scope, ReadError> {
        let mut scope = Scope::default();
        for (element, declaration) in declarations(root.element).zip(&self.declarations) {
            let node = Node { element, scope: &scope };
            let demand = &declaration.demand;
            let value = match self.given(declaration, given) {
                Some(value) => value,
                None => node.text("value")?.unwrap_or_default().into_owned(),
            };
            // A whole number that follows from other parameters is a constraint between these.
            if !demand.kind.is_whole() && !demand.kind.takes(&value) {
                return Err(Breach::of(demand.kind).error(node, &value));
            }
            scope.set(&demand.name, demand.kind, &value);
        }
        Ok(scope)
    }

    /// Returns all parameters of tests: first the parameters of the distribution, then the other declared parameters.
    fn list(&self) -> impl Iterator<Item = Declared> {
        let nominal = |name: &str| {
            self.find(name).map(|index| &self.declarations[index]).map(|of| of.demand.kind.value(&of.text))
        };
        let opened = self.distribution.0.iter().map(move |opened| {
            let whole = opened.single().is_some_and(Kind::is_whole);
            Declared { whole, ..opened.declared(nominal) }
        });
        let closed = self.declarations.iter().filter(|declaration| self.is_closed(declaration)).map(|declaration| {
            let kind = declaration.demand.kind;
            let value = kind.value(&declaration.text);
            let domain = match (kind, &value) {
                (Kind::Boolean, _) => Domain::Choice(TRUTHS.map(Value::from).into()),
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

    /// Returns the texts of the values of the declared parameters, with expressions as they are written.
    pub fn texts(&self) -> Scope {
        let mut scope = Scope::default();
        for declaration in &self.declarations {
            scope.set(declaration.name(), declaration.demand.kind, &declaration.text);
        }
        scope
    }

    /// Returns the demands on the values of the declared parameters, in the order of the declarations.
    pub fn demands(&self) -> impl Iterator<Item = &Demand> {
        self.declarations.iter().map(|declaration| &declaration.demand)
    }

    /// Returns the declarations of parameters, in the order of the file.
    pub fn declarations(&self) -> &[Declaration] {
        &self.declarations
    }

    /// Returns the values of the parameters of tests, each with its name, if the declared parameters have these texts as values. The
    /// last part is the index of the first declaration to which the parameter belongs.
    pub fn stated(&self, texts: &[&str]) -> Vec<(String, Value, usize)> {
        let text = |name: &str| self.find(name).map_or("", |at| texts[at]);
        let first = |opened: &Opened| self.declarations.iter().position(|declaration| opened.has(declaration.name()));
        let opened = self.distribution.0.iter().filter_map(|opened| {
            let at = first(opened)?;
            Some((opened.name(), opened.stated(text), at))
        });
        let closed = self.declarations.iter().zip(texts).enumerate().filter(|(_, (of, _))| self.is_closed(of));
        let closed = closed.map(|(at, (of, text))| (of.name().to_owned(), of.demand.kind.value(text), at));
        opened.chain(closed).collect()
    }

    /// Returns `true` if a parameter of tests gives the declared parameter its value, and `false` if the value follows from others.
    pub fn is_given(&self, declaration: &Declaration) -> bool {
        self.source(declaration).is_some()
    }

    /// Returns the index of the declaration of a parameter.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.declarations.iter().position(|declaration| declaration.name() == name)
    }

    /// Returns the declaration with an index.
    pub fn declaration(&self, at: usize) -> &Declaration {
        &self.declarations[at]
    }

    /// Returns `true` if a parameter of tests stands for the declared parameter alone, and the parameter is closed.
    fn is_closed(&self, declaration: &Declaration) -> bool {
        self.distribution.of(declaration.name()).is_none() && !declaration.follows()
    }

    /// Returns the value that a test gives a declared parameter; `None` if the value follows from other parameters.
    pub fn given(&self, declaration: &Declaration, test: &Values) -> Option<String> {
        if let Some(opened) = self.distribution.of(declaration.name()) {
            let parts = opened.parts(test.get(&opened.name())?);
            return parts.into_iter().find(|(name, _)| *name == declaration.name()).map(|(_, value)| value);
        }
        self.is_closed(declaration).then(|| test.get(declaration.name()).map(ToString::to_string)).flatten()
    }

    /// Returns the name of the parameter of tests that gives a declared parameter its value; `None` if the value follows from
    /// other parameters.
    pub fn source(&self, declaration: &Declaration) -> Option<String> {
        let opened = self.distribution.of(declaration.name()).map(Opened::name);
        opened.or_else(|| self.is_closed(declaration).then(|| declaration.name().to_owned()))
    }

    /// Returns the value of a declared parameter if its parameter of tests has the given value.
    pub fn part(&self, declaration: &Declaration, value: &Value) -> Value {
        let parts = self.distribution.of(declaration.name()).map(|opened| opened.parts(value)).unwrap_or_default();
        let own = parts.into_iter().find(|(name, _)| *name == declaration.name());
        own.map_or_else(|| value.clone(), |(_, text)| declaration.demand.kind.value(&text))
    }

    /// Returns the names of the parameters of tests on whose values a text depends.
    pub fn behind(&self, text: &str) -> Vec<String> {
        let mut open: Vec<&str> = references(text).collect();
        let (mut seen, mut names) = (Vec::new(), Vec::new());
        while let Some(name) = open.pop() {
            let Some(at) = self.find(name).filter(|at| !seen.contains(at)) else { continue };
            seen.push(at);
            match self.distribution.of(name) {
                Some(opened) => names.push(opened.name()),
                None if self.declarations[at].follows() => open.extend(references(&self.declarations[at].text)),
                None => names.push(name.to_owned()),
            }
        }
        names
    }

    /// Returns the parameters of tests behind declared parameters for whose values, one by one, constraints have to be
    /// written, with these values. The values are tuples and truths, with which nothing can be computed.
    pub fn cases(&self, mut open: Vec<usize>) -> Vec<(String, Vec<Value>)> {
        let mut cases: Vec<(String, Vec<Value>)> = Vec::new();
        let mut seen = Vec::new();
        while let Some(at) = open.pop() {
            if seen.contains(&at) {
                continue;
            }
            seen.push(at);
            let declaration = &self.declarations[at];
            let Some(name) = self.source(declaration) else {
                open.extend(references(&declaration.text).filter_map(|name| self.find(name)));
                continue;
            };
            let values = match self.distribution.of(declaration.name()) {
                Some(opened) => opened.tuples(),
                None if declaration.demand.kind == Kind::Boolean => Some(TRUTHS.map(Value::from).into()),
                None => None,
            };
            if let Some(values) = values.filter(|_| cases.iter().all(|(known, _)| *known != name)) {
                cases.push((name, values));
            }
        }
        cases
    }
}

/// Returns the names and the types of the parameters that a scenario declares.
pub(super) fn declared_kinds(root: Node<'_>) -> Result<Vec<(String, Kind)>, ReadError> {
    let one = |element| {
        let node = Node { element, ..root };
        Ok((element.required("name")?.to_owned(), node.kind("parameterType")?))
    };
    declarations(root.element).map(one).collect()
}

/// Returns the parameters that a scenario declares, with the values of the declarations.
pub(super) fn declared_values(root: Node<'_>) -> Result<Scope, ReadError> {
    let mut scope = Scope::default();
    for element in declarations(root.element) {
        let node = Node { element, scope: &scope };
        let kind = node.kind("parameterType")?;
        let value = node.text("value")?.unwrap_or_default().into_owned();
        scope.set(element.required("name")?, kind, &value);
    }
    Ok(scope)
}
