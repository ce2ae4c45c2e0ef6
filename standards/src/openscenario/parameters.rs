//! The parameters of a scenario as parameters of tests: their declarations, their values, and their constraints.

use super::distribution::{Distribution, Opened, parsed};
use super::rule::Rule;
use super::scope::{Node, Scope, references};
use crate::xml::{ExpressionFlaw, Flaw, ReadError};
use paracosm_engine::{Constraint, Declared, Scenario};
use paracosm_space::{Domain, Parameter, Value, Values};
use std::sync::Arc;

/// The name of the parameter that chooses the entity which the system under test drives.
pub const EGO: &str = "ego";
/// The types whose values are texts, also if they look like numbers.
const TEXTS: [&str; 2] = ["string", "dateTime"];
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
    name: String,
    /// The type in words of the standard, for example `double`.
    kind: String,
    /// The value, which may be an expression of earlier parameters.
    text: String,
    /// The groups of constraints: the groups are alternatives, and the limits of a group hold together.
    groups: Vec<Vec<Limit>>,
}

/// A limit of a parameter, which may be an expression of any parameters.
#[derive(Debug)]
struct Limit {
    rule: Rule,
    text: String,
}

impl Parameters {
    /// Reads the declarations of a scenario.
    pub fn read(root: Node<'_>, distribution: Distribution) -> Result<Self, ReadError> {
        let limit =
            |node: Node<'_>| Ok(Limit { rule: Rule::read(node)?, text: node.element.required("value")?.to_owned() });
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
        for index in (0..self.declarations.len()).filter(|index| !self.declarations[*index].groups.is_empty()) {
            let all = self.clone();
            s.constrain(Constraint::new(self.sources(index), move |test| all.broken(index, test)));
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
        let nominal = |name: &str| self.find(name).map(|index| parsed(&self.declarations[index].text));
        let opened = self.distribution.0.iter().map(move |opened| opened.declared(nominal));
        let closed = self.declarations.iter().filter(|declaration| self.is_closed(declaration)).map(|declaration| {
            let takes_texts = TEXTS.contains(&declaration.kind.as_str());
            let value = if takes_texts { Value::from(declaration.text.as_str()) } else { parsed(&declaration.text) };
            let domain = match value {
                _ if declaration.kind == "boolean" => Domain::Choice(vec!["true".into(), "false".into()]),
                Value::Number(number) => Domain::Interval { lo: (-BOUND).min(number), hi: BOUND.max(number) },
                ref other => Domain::Choice(vec![other.clone()]),
            };
            let mut parameter = Parameter::new(declaration.name.as_str(), domain);
            parameter.default = Some(value);
            Declared { open: false, takes_texts, ..Declared::open(parameter) }
        });
        opened.chain(closed)
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.declarations.iter().position(|declaration| declaration.name == name)
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

    /// Returns the values of all declared parameters in a test.
    fn scope(&self, test: &Values) -> Result<Scope, ExpressionFlaw> {
        let mut scope = Scope::default();
        for declaration in &self.declarations {
            let value = match self.given(declaration, test) {
                Some(value) => value,
                None => scope.resolve(&declaration.text)?.into_owned(),
            };
            scope.set(declaration.name.as_str(), value);
        }
        Ok(scope)
    }

    /// Returns the names of the parameters of tests on which the constraints of a declared parameter depend.
    fn sources(&self, index: usize) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        let (mut open, mut seen) = (vec![index], Vec::new());
        let limits = self.declarations[index].groups.iter().flatten().flat_map(|limit| references(&limit.text));
        open.extend(limits.filter_map(|name| self.find(name)));
        while let Some(index) = open.pop() {
            if seen.contains(&index) {
                continue;
            }
            seen.push(index);
            let declaration = &self.declarations[index];
            let own = self.distribution.of(&declaration.name).map(Opened::name);
            let own = own.or_else(|| self.is_closed(declaration).then(|| declaration.name.clone()));
            match own {
                Some(name) if names.contains(&name) => (),
                Some(name) => names.push(name),
                None => open.extend(references(&declaration.text).filter_map(|name| self.find(name))),
            }
        }
        names
    }

    /// Returns the reason why a test breaks the constraints of a declared parameter; `None` if a group of them holds.
    fn broken(&self, index: usize, test: &Values) -> Option<String> {
        let Declaration { name, groups, .. } = &self.declarations[index];
        let scope = match self.scope(test) {
            Ok(scope) => scope,
            Err(flaw) => return Some(format!("the constraints of `{name}` cannot be computed: {flaw}")),
        };
        let value = parsed(scope.get(name).unwrap_or_default());
        let mut described = Vec::new();
        for group in groups {
            let mut holds = true;
            let mut members = Vec::new();
            for Limit { rule, text } in group {
                let limit = match scope.resolve(text) {
                    Ok(limit) => limit,
                    Err(flaw) => return Some(format!("a limit of `{name}` cannot be computed: `{text}`: {flaw}")),
                };
                holds &= rule.holds(&value, &parsed(&limit));
                members.push(format!("{} {limit}", rule.words()));
            }
            if holds {
                return None;
            }
            described.push(members.join(" and "));
        }
        Some(format!("`{name}` is {value}, expected a value that is {}", described.join(", or ")))
    }
}

/// Returns the names of the parameters that a scenario declares.
pub(super) fn declared_names(root: Node<'_>) -> Result<Vec<String>, ReadError> {
    declarations(root).map(|declaration| Ok(declaration.element.required("name")?.to_owned())).collect()
}

fn declarations(root: Node<'_>) -> impl Iterator<Item = Node<'_>> {
    root.first("ParameterDeclarations").into_iter().flat_map(|all| all.all("ParameterDeclaration"))
}
