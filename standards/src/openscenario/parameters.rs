//! The parameters of a scenario as parameters of tests: their declarations, their values, and their constraints.

use super::constraints::{Said, written};
use super::distribution::{Distribution, Opened, parsed};
use super::rule::Rule;
use super::scope::{Node, Scope, references};
use crate::xml::{Flaw, ReadError};
use paracosm_engine::{Declared, Scenario};
use paracosm_space::constraint::Expression;
use paracosm_space::{Domain, Parameter, Value, Values};

/// The name of the parameter that chooses the entity which the system under test drives.
pub const EGO: &str = "ego";
/// The types whose values are texts, also if they look like numbers.
const TEXTS: [&str; 2] = ["string", "dateTime"];
/// The type of truths.
const BOOLEAN: &str = "boolean";
/// The values of a parameter of the type of truths.
const TRUTHS: [&str; 2] = ["true", "false"];
/// The bound of a parameter that is a number without a distribution.
const BOUND: f64 = 1e9;

/// The parameters that a scenario declares, with a distribution of their values.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    distribution: Distribution,
    declarations: Vec<Declaration>,
    constraints: Vec<Expression>,
}

/// The declaration of a parameter.
#[derive(Debug)]
pub(super) struct Declaration {
    pub name: String,
    /// The type in words of the standard, for example `double`.
    kind: String,
    /// The value, which may be an expression of earlier parameters.
    pub text: String,
    /// The groups of constraints: the groups are alternatives, and the limits of a group hold together. A limit may be an
    /// expression of any parameters.
    pub groups: Vec<Vec<(Rule, String)>>,
}

impl Parameters {
    /// Reads the declarations of a scenario.
    pub fn read(root: Node<'_>, distribution: Distribution) -> Result<Self, ReadError> {
        let limit = |node: Node<'_>| Ok((Rule::read(node)?, node.element.required("value")?.to_owned()));
        let declaration = |node: Node<'_>| {
            if node.element.text("name") == Some(EGO) {
                let (element, attribute) = (node.name().to_owned(), "name".to_owned());
                let expected = "another name, because this one chooses the ego vehicle".to_owned();
                return Err(node.error(Flaw::Value {
                    element,
                    attribute,
                    found: EGO.to_owned(),
                    expected,
                    nearest: None,
                }));
            }
            let groups = node.all("ConstraintGroup").map(|group| group.all("ValueConstraint").map(limit).collect());
            Ok(Declaration {
                name: node.element.required("name")?.to_owned(),
                kind: node.element.text("parameterType").unwrap_or_default().to_owned(),
                text: node.element.text("value").unwrap_or_default().to_owned(),
                groups: groups.collect::<Result<_, ReadError>>()?,
            })
        };
        let declarations = declarations(root).map(declaration).collect::<Result<_, ReadError>>()?;
        let mut read = Self { distribution, declarations, constraints: Vec::new() };
        for (node, declaration) in self::declarations(root).zip(&read.declarations) {
            if declaration.groups.is_empty() {
                continue;
            }
            let said = written(&read, declaration).map_err(|flaw| {
                let (element, attribute) = ("ConstraintGroup".to_owned(), "value".to_owned());
                node.error(Flaw::Expression { element, attribute, text: declaration.name.clone(), flaw })
            })?;
            match said {
                Said::Always => {}
                Said::If(expression) => read.constraints.push(expression),
                Said::Never => {
                    let (element, attribute) = (node.name().to_owned(), "value".to_owned());
                    let (found, expected) = (declaration.text.clone(), "a value that its constraints allow".to_owned());
                    return Err(node.error(Flaw::Value { element, attribute, found, expected, nearest: None }));
                }
            }
        }
        Ok(read)
    }

    /// Declares the parameters and their constraints in a world, and returns the values that the test gives them. A
    /// parameter whose value is an expression follows from the others.
    pub fn declared(&self, root: Node<'_>, s: &mut Scenario) -> Result<Scope, ReadError> {
        let mut given = Values::default();
        for declared in self.list() {
            let name = declared.parameter.name.clone();
            let value = s.parameter(declared).value();
            given.set(name, value);
        }
        for constraint in &self.constraints {
            s.constrain(constraint.clone());
        }
        let mut scope = Scope::default();
        for (node, declaration) in declarations(root).zip(&self.declarations) {
            let value = match self.given(declaration, &given) {
                Some(value) => value,
                None => Node { scope: &scope, ..node }.text("value")?.unwrap_or_default().into_owned(),
            };
            scope.set(declaration.name.as_str(), value);
        }
        Ok(scope)
    }

    /// Returns all parameters of tests: first the parameters of the distribution, then the other declared parameters.
    fn list(&self) -> impl Iterator<Item = Declared> {
        let nominal = |name: &str| self.find(name).map(|declaration| parsed(&declaration.text));
        let opened = self.distribution.0.iter().map(move |opened| opened.declared(nominal));
        let closed = self.declarations.iter().filter(|declaration| self.is_closed(declaration)).map(|declaration| {
            let takes_texts = declaration.takes_texts();
            let value = if takes_texts { Value::from(declaration.text.as_str()) } else { parsed(&declaration.text) };
            let domain = match value {
                _ if declaration.kind == BOOLEAN => Domain::Choice(TRUTHS.map(Value::from).into()),
                Value::Number(number) => Domain::Interval { lo: (-BOUND).min(number), hi: BOUND.max(number) },
                ref other => Domain::Choice(vec![other.clone()]),
            };
            let mut parameter = Parameter::new(declaration.name.as_str(), domain);
            parameter.default = Some(value);
            Declared { open: false, takes_texts, ..Declared::open(parameter) }
        });
        opened.chain(closed)
    }

    /// Returns the declaration of a parameter.
    pub fn find(&self, name: &str) -> Option<&Declaration> {
        self.declarations.iter().find(|declaration| declaration.name == name)
    }

    /// Iterates over the names of all declared parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.declarations.iter().map(|declaration| declaration.name.as_str())
    }

    /// Returns `true` if a parameter of tests stands for the declared parameter alone, and the parameter is closed.
    fn is_closed(&self, declaration: &Declaration) -> bool {
        self.distribution.of(&declaration.name).is_none() && !declaration.text.starts_with('$')
    }

    /// Returns the value that a test gives a declared parameter; `None` if the value follows from other parameters.
    fn given(&self, declaration: &Declaration, test: &Values) -> Option<String> {
        if let Some(opened) = self.distribution.of(&declaration.name) {
            let parts = opened.parts(test.get(&opened.name())?);
            return parts.into_iter().find(|(name, _)| *name == declaration.name).map(|(_, value)| value);
        }
        self.is_closed(declaration).then(|| test.get(&declaration.name).map(ToString::to_string)).flatten()
    }

    /// Returns the name of the parameter of tests that gives a declared parameter its value; `None` if the value follows from
    /// other parameters.
    pub fn source(&self, declaration: &Declaration) -> Option<String> {
        let opened = self.distribution.of(&declaration.name).map(Opened::name);
        opened.or_else(|| self.is_closed(declaration).then(|| declaration.name.clone()))
    }

    /// Returns the value of a declared parameter if its parameter of tests has the given value.
    pub fn part(&self, declaration: &Declaration, value: &Value) -> Value {
        let parts = self.distribution.of(&declaration.name).map(|opened| opened.parts(value)).unwrap_or_default();
        let own = parts.into_iter().find(|(name, _)| *name == declaration.name);
        own.map_or_else(|| value.clone(), |(_, text)| parsed(&text))
    }

    /// Returns the parameters of tests for whose values, one by one, the constraints of a declared parameter have to be
    /// written, with these values. They are tuples and truths, with which nothing can be computed.
    pub fn cases(&self, declaration: &Declaration) -> Vec<(String, Vec<Value>)> {
        let mut cases: Vec<(String, Vec<Value>)> = Vec::new();
        let (mut open, mut seen) = (vec![declaration], Vec::new());
        let limits = declaration.groups.iter().flatten().flat_map(|(_, text)| references(text));
        open.extend(limits.filter_map(|name| self.find(name)));
        while let Some(declaration) = open.pop() {
            if seen.contains(&declaration.name.as_str()) {
                continue;
            }
            seen.push(&declaration.name);
            let Some(name) = self.source(declaration) else {
                open.extend(references(&declaration.text).filter_map(|name| self.find(name)));
                continue;
            };
            let values = match self.distribution.of(&declaration.name) {
                Some(opened) => opened.tuples(),
                None if declaration.kind == BOOLEAN => Some(TRUTHS.map(Value::from).into()),
                None => None,
            };
            if let Some(values) = values.filter(|_| cases.iter().all(|(known, _)| *known != name)) {
                cases.push((name, values));
            }
        }
        cases
    }
}

impl Declaration {
    /// Returns `true` if the values of the parameter are texts, also if they look like numbers.
    pub fn takes_texts(&self) -> bool {
        TEXTS.contains(&self.kind.as_str())
    }
}

/// Returns the names of the parameters that a scenario declares.
pub(super) fn declared_names(root: Node<'_>) -> Result<Vec<String>, ReadError> {
    declarations(root).map(|declaration| Ok(declaration.element.required("name")?.to_owned())).collect()
}

fn declarations(root: Node<'_>) -> impl Iterator<Item = Node<'_>> {
    root.first("ParameterDeclarations").into_iter().flat_map(|all| all.all("ParameterDeclaration"))
}
