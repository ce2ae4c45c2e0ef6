//! Variables of a scenario: values that actions change during a run, and that conditions read.

use super::kind::Kind;
use super::names::Names;
use super::parameters::declared_kinds;
use super::scope::Node;
use super::taken::Taken;
use crate::xml::{Flaw, Misfit, ReadError, Value};

/// A variable with its value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    pub name: String,
    pub kind: Kind,
    pub value: Value,
}

/// A change of a variable.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Change {
    Set(Value),
    Add(f64),
    Multiply(f64),
}

impl Variable {
    /// Reads the variables that a scenario declares. Its parameters follow as further variables, because actions change them, too.
    pub fn all(root: Node<'_>) -> Result<Vec<Self>, ReadError> {
        let declarations = root.first("VariableDeclarations");
        let declared = declarations.into_iter().flat_map(|all| all.all("VariableDeclaration"));
        let mut taken = Taken::default();
        let read = |declaration: Node<'_>| {
            let name = declaration.label_required()?.into_owned();
            taken.claim(declaration, &name)?;
            let kind = declaration.kind("variableType")?;
            let value = declaration.text("value")?.unwrap_or_default();
            if !kind.takes(&value) {
                return Err(declaration.unexpected("value", &value, kind.expected()));
            }
            Ok(Self { name, kind, value: kind.typed(&value) })
        };
        let parameters = declared_kinds(root)?.into_iter().map(|(name, kind)| {
            let value = kind.typed(root.scope.get(&name).unwrap_or_default());
            Ok(Self { name, kind, value })
        });
        declared.map(read).chain(parameters).collect()
    }

    /// Changes the value.
    ///
    /// # Errors
    /// The new value is not of the type. The variable keeps its value.
    pub fn change(&mut self, change: &Change) -> Result<(), Misfit> {
        let value = match (change, &self.value) {
            (Change::Set(new), _) => new.clone(),
            (Change::Add(by), Value::Number(number)) => Value::Number(number + by),
            (Change::Multiply(by), Value::Number(number)) => Value::Number(number * by),
            (Change::Add(_) | Change::Multiply(_), other) => other.clone(),
        };
        let text = value.to_string();
        if !self.kind.takes(&text) {
            return Err(Misfit { name: self.name.clone(), value: text, expected: self.kind.expected() });
        }
        self.value = value;
        Ok(())
    }
}

impl Change {
    /// Reads an element `VariableAction` or `ParameterAction`: the index of the variable and the change.
    pub fn read(node: Node<'_>, names: Names<'_>) -> Result<(usize, Self), ReadError> {
        let variable = if node.name() == "ParameterAction" {
            let local = || node.refused("only a parameter of the whole scenario changes; use a VariableAction");
            names.parameter(node, "parameterRef")?.ok_or_else(local)?
        } else {
            names.variable(node, "variableRef")?
        };
        let of = names.kinds[variable];
        let kind = node.choice("SetAction or ModifyAction")?;
        let change = match kind.name() {
            "SetAction" => Self::Set(of.typed(&kind.of_kind("value", of)?)),
            _ => {
                if !of.is_number() {
                    let (rule, name) = (kind.child("Rule")?, &names.variables[variable]);
                    return Err(rule.error(Flaw::NoNumber { name: name.clone() }));
                }
                let rule = kind.child("Rule")?.choice("AddValue or MultiplyByValue")?;
                let by = rule.number("value")?;
                if rule.name() == "AddValue" { Self::Add(by) } else { Self::Multiply(by) }
            }
        };
        Ok((variable, change))
    }
}
