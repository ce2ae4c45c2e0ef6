//! Parameters that are declared by a story or by the entry of a catalog: their values, and the demands on them.
//!
//! A value can follow from parameters of the whole scenario. Then the demands on it are constraints between parameters of
//! tests. Otherwise the value is known when the file is read.

use super::demand::Demand;
use super::scope::{Node, Scope};
use crate::xml::{Element, ReadError};

/// A parameter of a part of a scenario whose value follows from parameters of the whole scenario.
#[derive(Debug, Clone)]
pub(super) struct Local {
    /// The parameters that the declaration sees; the last is the declared parameter.
    pub scope: Scope,
    pub demand: Demand,
}

/// Adds the parameters that an element declares to a scope. `assignments` are elements `ParameterAssignment`, which give values
/// instead of the values of the declarations. They do not see the declared parameters. Returns the parameters with demands that
/// depend on parameters of the whole scenario.
pub(super) fn declare(
    element: Element<'_, '_>,
    scope: &mut Scope,
    assignments: &[Node<'_>],
) -> Result<Vec<Local>, ReadError> {
    let outside = scope.len();
    let mut locals = Vec::new();
    let mut names = Vec::new();
    for declaration in declarations(element) {
        let demand = Demand::read(Node { element: declaration, scope: &*scope })?;
        let assigned = assignments.iter().find(|assignment| assigned_name(assignment.element) == Some(&demand.name));
        let (place, seen) = assigned.map_or((declaration, scope.len()), |assignment| (assignment.element, outside));
        let text = place.text("value").unwrap_or_default();
        let value = Node { element: place, scope: &*scope }.text_among(seen, "value")?;
        let value = value.unwrap_or_default().into_owned();
        scope.define(&demand.name, demand.kind, &value, (text, seen));
        names.push(demand.name.clone());
        if demand.depends_on_values() && !scope.sources(scope.len() - 1, demand.limits()).is_empty() {
            locals.push(Local { scope: scope.clone(), demand });
            continue;
        }
        if let Some(breach) = demand.breach(&value, scope) {
            return Err(breach.error(Node { element: place, scope: &*scope }, &value));
        }
    }
    for assignment in assignments.iter().map(|assignment| assignment.element) {
        let name = assigned_name(assignment);
        if !names.iter().any(|known| Some(known.as_str()) == name) {
            let found = assignment.required("parameterRef")?;
            let known = names.iter().map(String::as_str);
            return Err(assignment.dangling_value("parameterRef", found, "declared parameter", known));
        }
    }
    Ok(locals)
}

/// Returns the declarations of parameters directly within an element.
pub(super) fn declarations<'a>(element: Element<'a, 'a>) -> impl Iterator<Item = Element<'a, 'a>> {
    element.first("ParameterDeclarations").into_iter().flat_map(|all| all.all("ParameterDeclaration"))
}

/// Returns the name of the parameter to which an element `ParameterAssignment` assigns a value.
fn assigned_name<'a>(assignment: Element<'a, 'a>) -> Option<&'a str> {
    let name = assignment.text("parameterRef")?;
    Some(name.strip_prefix('$').unwrap_or(name))
}
