//! The hand-over of the ego vehicle from the scenario to the driver under test: the driver is the controller of the entity.

use super::action::Action;
use super::scope::Node;
use super::story::{Kind, Storyboard};
use crate::xml::ReadError;
use std::path::Path;

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
    fn activates(self) -> bool {
        [self.lateral, self.longitudinal].contains(&Some(true))
    }
}

impl Storyboard {
    /// Returns the controller actions of an entity, each with its line and with `true` if it is an initial action.
    fn handovers(&self, entity: usize) -> impl Iterator<Item = (Handover, u32, bool)> {
        let initial = self.init.iter().filter(move |(of, _, _)| *of == entity).filter_map(|(_, action, line)| {
            let Action::Control(handover) = action else { return None };
            Some((*handover, *line, true))
        });
        let later = self.items.iter().filter_map(move |item| match &item.kind {
            Kind::Action(actors, Action::Control(handover)) if actors.contains(&entity) => {
                Some((*handover, item.origin.1, false))
            }
            _ => None,
        });
        initial.chain(later)
    }

    /// Returns the index of the entity that the system under test drives if nobody chooses another: `Ego`, or the first entity
    /// that has a controller or gets one, or the first entity.
    pub fn usual_ego(&self) -> usize {
        let named = self.entities.iter().position(|entity| entity.name == "Ego");
        let has_controller = |index: &usize| {
            self.entities[*index].is_controlled || self.handovers(*index).any(|(handover, ..)| handover.assigns)
        };
        named.or_else(|| (0..self.entities.len()).find(has_controller)).unwrap_or(0)
    }

    /// Returns `true` if an action activates the controller of an entity. Otherwise the controller is active from the beginning.
    pub fn activates(&self, entity: usize) -> bool {
        self.handovers(entity).any(|(handover, ..)| handover.activates())
    }

    /// Describes actions by which the driver does not have the ego vehicle when the file may suggest it.
    pub fn handover_remarks(&self, ego: usize, file: &Path) -> Vec<String> {
        let (file, name) = (file.display(), &self.entities[ego].name);
        let mut remarks = Vec::new();
        let first = self.handovers(ego).find(|(handover, ..)| handover.activates());
        if let Some((_, line, _)) = first {
            let is_activated =
                |of: fn(Handover) -> Option<bool>| self.handovers(ego).any(|(handover, ..)| of(handover) == Some(true));
            let half = match [is_activated(|of| of.lateral), is_activated(|of| of.longitudinal)] {
                [false, _] => Some("lateral"),
                [_, false] => Some("longitudinal"),
                [true, true] => None,
            };
            if let Some(half) = half {
                remarks.push(format!(
                    "{file}:{line}: a driver never drives `{name}`, because no action activates its {half} control; a driver \
                     needs both"
                ));
            }
        }
        let mut back = self.handovers(ego).filter(|(handover, _, is_initial)| {
            !is_initial && [handover.lateral, handover.longitudinal].contains(&Some(false))
        });
        if let Some((_, line, _)) = back.next() {
            remarks.push(format!(
                "{file}:{line}: a driver that has `{name}` keeps it, although the action deactivates it"
            ));
        }
        remarks
    }
}
