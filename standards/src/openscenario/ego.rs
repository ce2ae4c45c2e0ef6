//! The ego vehicle: the entity whose controller is the driver under test, and when the driver has it.

use super::action::Action;
use super::handover::Handover;
use super::story::{Kind, Storyboard};
use paracosm_space::plural;
use std::path::Path;

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
        let mut moved = self.items.iter().filter(
            |item| matches!(&item.kind, Kind::Action(actors, action) if actors.contains(&ego) && action.moves()),
        );
        if let Some(item) = moved.next() {
            let (file, line) = (item.origin.0.display(), item.origin.1);
            let more = match moved.count() {
                0 => String::new(),
                more => format!("; nor have {} more", plural(more, "action")),
            };
            remarks.push(format!("{file}:{line}: `{}` does not move `{name}` while a driver has it{more}", item.name));
        }
        remarks
    }
}
