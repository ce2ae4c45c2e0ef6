//! Controller actions: they assign the controller of an entity, and hand the entity over to it.

use super::scope::Node;
use crate::xml::ReadError;

/// The effect of a controller action: `true` if it assigns a controller, and whether the controller then moves the entity to the
/// side and along its way. `None` changes nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Handover {
    pub assigns: bool,
    pub lateral: Option<bool>,
    pub longitudinal: Option<bool>,
}

impl Handover {
    /// Reads an element `ControllerAction`, or an `ActivateControllerAction` of version 1.0. An action that assigns a controller may
    /// activate it, too.
    pub fn read(node: Node<'_>) -> Result<Self, ReadError> {
        if node.name() == "ActivateControllerAction" {
            return Self::default().after(node, ["lateral", "longitudinal"]);
        }
        let assigned = match node.first("AssignControllerAction") {
            None => Self::default(),
            Some(assign) => {
                Self { assigns: true, ..Self::default() }.after(assign, ["activateLateral", "activateLongitudinal"])?
            }
        };
        match node.first("ActivateControllerAction") {
            Some(activate) => assigned.after(activate, ["lateral", "longitudinal"]),
            None if assigned.assigns => Ok(assigned),
            None => Err(node.element.lacks("ActivateControllerAction or AssignControllerAction")),
        }
    }

    /// Returns this effect followed by the effect that the attributes of an element describe.
    fn after(self, node: Node<'_>, [lateral, longitudinal]: [&'static str; 2]) -> Result<Self, ReadError> {
        let truth = |name| node.element.text(name).map(|_| node.truth_or(name, false)).transpose();
        Ok(Self {
            lateral: truth(lateral)?.or(self.lateral),
            longitudinal: truth(longitudinal)?.or(self.longitudinal),
            ..self
        })
    }

    /// Returns `true` if the controller moves the entity in some way after this effect alone.
    pub fn activates(self) -> bool {
        [self.lateral, self.longitudinal].contains(&Some(true))
    }
}
