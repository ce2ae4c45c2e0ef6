//! The names to which the elements of a scenario refer.

use super::catalogs::Catalogs;
use super::entity::ObjectType;
use super::kind::Kind;
use super::reference::References;
use super::scope::Node;
use super::site::Sites;
use crate::xml::ReadError;

/// The names that a scenario declares, in their order, and its catalogs.
#[derive(Clone, Copy)]
pub(super) struct Names<'a> {
    pub entities: &'a [String],
    /// The types of the entities.
    pub types: &'a [ObjectType],
    /// The selections of entities, each with its members.
    pub selections: &'a [(String, Vec<usize>)],
    /// The variables, and after them the parameters of the whole scenario.
    pub variables: &'a [String],
    /// The types of the variables and parameters.
    pub kinds: &'a [Kind],
    /// The number of variables without the parameters.
    pub declared: usize,
    pub catalogs: &'a Catalogs<'a>,
    pub sites: Sites<'a>,
    /// The references to elements of the storyboard, which are resolved later.
    pub references: &'a References,
}

impl Names<'_> {
    /// Returns the index of the entity that an attribute names.
    pub fn entity(self, node: Node<'_>, attribute: &'static str) -> Result<usize, ReadError> {
        let name = node.required(attribute)?;
        let index = self.entities.iter().position(|known| *known == name);
        index.ok_or_else(|| node.dangling(attribute, "entity", self.entities.iter().map(String::as_str)))
    }

    /// Returns the indices of the entities that an attribute names: one entity, or the members of a selection.
    pub fn group(self, node: Node<'_>, attribute: &'static str) -> Result<Vec<usize>, ReadError> {
        let name = node.required(attribute)?;
        match self.selections.iter().find(|(known, _)| *known == name) {
            Some((_, members)) => Ok(members.clone()),
            None => self.entity(node, attribute).map(|entity| vec![entity]),
        }
    }

    /// Returns the indices of the entities of a type.
    pub fn of_type(self, wanted: ObjectType) -> Vec<usize> {
        (0..self.types.len()).filter(|index| self.types[*index] == wanted).collect()
    }

    /// Returns the index of the variable that an attribute names.
    pub fn variable(self, node: Node<'_>, attribute: &'static str) -> Result<usize, ReadError> {
        let name = node.element.required(attribute)?;
        let name = name.strip_prefix('$').unwrap_or(name);
        let variables = &self.variables[..self.declared];
        let index = variables.iter().position(|known| known == name);
        let names = variables.iter().map(String::as_str);
        index.ok_or_else(|| node.element.dangling_value(attribute, name, "variable", names))
    }

    /// Returns the index of the variable for the parameter that an attribute names; `None` for a parameter of a part of the scenario,
    /// which never changes.
    pub fn parameter(self, node: Node<'_>, attribute: &'static str) -> Result<Option<usize>, ReadError> {
        let name = node.element.required(attribute)?;
        let name = name.strip_prefix('$').unwrap_or(name);
        match node.scope.names().filter(|known| *known == name).count() {
            0 => Err(node.element.dangling_value(attribute, name, "parameter", node.scope.names())),
            1 => {
                Ok(self.variables[self.declared..].iter().position(|known| known == name).map(|at| self.declared + at))
            }
            _ => Ok(None),
        }
    }
}
