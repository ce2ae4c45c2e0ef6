//! The reach of the parameters of a test into its world.
//!
//! A parameter that nothing reads changes no run, whatever its value is. Streams say who reads them. A plain value may go anywhere in
//! the program, so a program that asks for it counts as a reader.

use super::Scenario;
use crate::stream::{Equation, Node, order};
use std::collections::BTreeSet;
use std::rc::Rc;

/// The part of a test's world that a parameter may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reach {
    /// Nothing: nobody reads the parameter.
    Nothing,
    /// Light, fog, rain on sensors, or the sun, and nothing else. It changes a run only if the ego vehicle has sensors or cameras.
    Air,
    /// Any part of the world, of the requirements, or of the scenery.
    World,
}

/// The uses of a parameter by a program, besides streams.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Use {
    /// `true` if the program has asked for the parameter as a plain value.
    pub value: bool,
    /// `true` if the program has declared that the parameter changes the air alone.
    pub atmospheric: bool,
}

impl Scenario {
    /// Returns how far each parameter reaches, in the order of the declaration. All streams must have been laid out before.
    pub(crate) fn reaches(&self) -> Vec<(String, Reach)> {
        let equations = self.equations.borrow();
        let mut world: Vec<Rc<Node>> = self.readers().into_iter().map(|(_, node)| node).collect();
        // The readers begin with the friction and the weather.
        let air: Vec<Rc<Node>> = world.drain(1..1 + self.weather().count()).collect();
        let (world, air) = (read_by(&world, &equations), read_by(&air, &equations));
        let reach = |name: &str, of: Use| {
            // Each parameter but those of the air decides where the scenery stands.
            let is_in_scenery = !self.scenery.is_empty() && !of.atmospheric;
            match (of.value || is_in_scenery || world.contains(name), air.contains(name)) {
                (true, _) => Reach::World,
                (false, true) => Reach::Air,
                (false, false) => Reach::Nothing,
            }
        };
        let (parameters, uses) = (self.parameters.borrow(), self.uses.borrow());
        let names = parameters.iter().map(|declared| &declared.parameter.name);
        names.zip(uses.iter()).map(|(name, of)| (name.clone(), reach(name, *of))).collect()
    }
}

/// Returns the names of the parameters that nodes depend on.
fn read_by(nodes: &[Rc<Node>], equations: &[Equation]) -> BTreeSet<String> {
    let all = order(nodes, equations).expect("what has been laid out can be laid out again");
    all.into_iter().filter_map(|node| node.parameter().map(str::to_owned)).collect()
}
