//! The drawing of a storyboard: which conditions start and stop which elements, and whom the actions move.

use super::action::Action;
use super::condition::{Condition, Edge, Trigger};
use super::handover::Handover;
use super::measure::{Bearing, Goal, Measure};
use super::story::{Item, Kind, Storyboard};
use paracosm_engine::object::{Input, Output};
use paracosm_engine::stream::{Form, Part, Sketch};
use std::collections::BTreeMap;

impl Storyboard {
    /// Draws the storyboard behind its conditions, of which `inputs` are the inputs in their order. `measures` are the outputs that the
    /// conditions compare, and `stopped` is the output of the stop trigger.
    pub fn sketch(
        &self,
        sketch: &mut Sketch,
        inputs: &[Input<bool>],
        measures: &[(Measure, Output<f64>)],
        stopped: &Output<bool>,
    ) {
        let entities: Vec<Part> =
            self.entities.iter().map(|entity| sketch.part(entity.name.as_str(), Form::Actor)).collect();
        self.sketch_init(sketch, &entities);
        let mut inputs = inputs.iter();
        // The parameters of the scenario are variables, too. Most are neither changed nor compared.
        let mut others: BTreeMap<Option<usize>, Part> = BTreeMap::new();
        let mut other = |sketch: &mut Sketch, variable: Option<usize>| {
            let name = variable.map_or("environment".to_owned(), |at| format!("variable {}", self.variables[at].name));
            *others.entry(variable).or_insert_with(|| sketch.part(name, Form::Actor))
        };
        let mut parts: Vec<Option<Part>> = Vec::new();
        for (index, item) in self.items.iter().enumerate() {
            let part = self.is_drawn(index).then(|| sketch.part(label(item), form(&item.kind)));
            parts.push(part);
            let Some(part) = part else { continue };
            if let Some(around) = self.around(index).find_map(|around| parts[around]) {
                sketch.leads(around, part);
            }
            triggered(sketch, &mut inputs, part, [("start", &item.start), ("stop", &item.stop)]);
            match &item.kind {
                Kind::Action(actors, _) => actors.iter().for_each(|entity| sketch.leads(part, entities[*entity])),
                Kind::Change(changed, _) => {
                    let to = other(sketch, Some(*changed));
                    sketch.leads(part, to);
                }
                Kind::Environment(_) => {
                    let to = other(sketch, None);
                    sketch.leads(part, to);
                }
                Kind::Story | Kind::Act | Kind::Group | Kind::Maneuver | Kind::Event(_) => (),
            }
        }
        if self.stop.is_some() {
            let end = sketch.part("StopTrigger", Form::Step);
            triggered(sketch, &mut inputs, end, [("stop", &self.stop), ("", &None)]);
            sketch.shows(end, &stopped.stream());
        }
        for (measure, output) in measures {
            let shown: Vec<Part> = match measure {
                Measure::State { element, .. } => parts[*element].into_iter().collect(),
                Measure::Variable(of) | Measure::VariableIs(of, _) => vec![other(sketch, Some(*of))],
                Measure::TimeOfDay => vec![other(sketch, None)],
                of_entities => measured(of_entities).into_iter().map(|entity| entities[entity]).collect(),
            };
            shown.into_iter().for_each(|part| sketch.shows(part, &output.stream()));
        }
    }

    /// Draws the initial actions, with one part for each entity.
    fn sketch_init(&self, sketch: &mut Sketch, entities: &[Part]) {
        for (entity, part) in entities.iter().enumerate() {
            let own = self.init.iter().filter(|(of, ..)| *of == entity);
            let names: Vec<&str> = own.map(|(_, action, _)| name(action)).collect();
            if !names.is_empty() {
                let init = sketch.part(format!("Init: {}", names.join(", ")), Form::Action);
                sketch.leads(init, *part);
            }
        }
    }

    /// Returns `true` for the elements that the drawing has: events, actions, and elements with triggers or to which conditions refer.
    fn is_drawn(&self, index: usize) -> bool {
        let Item { kind, start, stop, .. } = &self.items[index];
        let is_container = matches!(kind, Kind::Story | Kind::Act | Kind::Group | Kind::Maneuver);
        let is_meant = |trigger: &Trigger| {
            let mut measures = trigger.iter().flatten().flat_map(|condition| &condition.check.measures);
            measures.any(|measure| matches!(measure, Measure::State { element, .. } if *element == index))
        };
        let mut triggers = self.items.iter().flat_map(|item| [&item.start, &item.stop]).chain([&self.stop]).flatten();
        !is_container || start.is_some() || stop.is_some() || triggers.any(is_meant)
    }

    /// Returns the elements around an element, the nearest first.
    fn around(&self, index: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(self.items[index].parent, |around| self.items[*around].parent)
    }
}

/// Draws the lines from the conditions of triggers to an element.
fn triggered<'i>(
    sketch: &mut Sketch,
    inputs: &mut impl Iterator<Item = &'i Input<bool>>,
    part: Part,
    triggers: [(&str, &Option<Trigger>); 2],
) {
    for (words, trigger) in triggers {
        let groups = trigger.iter().flatten();
        let several = trigger.as_ref().is_some_and(|groups| groups.len() > 1);
        for (number, group) in (1..).zip(groups) {
            let words = if several { format!("{words}, group {number}") } else { words.to_owned() };
            for condition in group {
                let input = inputs.next().expect("each condition has an input");
                sketch.starts(input.reader(), part, format!("{words}{}", when(condition)));
            }
        }
    }
}

/// Describes the edge and the delay of a condition.
fn when(condition: &Condition) -> String {
    let edge = match condition.edge {
        Edge::None => "",
        Edge::Rising => ", rising",
        Edge::Falling => ", falling",
        Edge::Either => ", rising or falling",
    };
    let delay = if condition.delay == 0.0 { String::new() } else { format!(", after {} s", condition.delay) };
    format!("{edge}{delay}")
}

/// Returns the label of an element: its name and its kind.
fn label(item: &Item) -> String {
    let kind = match &item.kind {
        Kind::Story => "Story",
        Kind::Act => "Act",
        Kind::Group => "ManeuverGroup",
        Kind::Maneuver => "Maneuver",
        Kind::Event(_) => "Event",
        Kind::Action(_, action) => name(action),
        Kind::Change(..) => "VariableAction",
        Kind::Environment(_) => "EnvironmentAction",
    };
    format!("{}: {kind}", item.name)
}

fn form(kind: &Kind) -> Form {
    match kind {
        Kind::Action(..) | Kind::Change(..) | Kind::Environment(_) => Form::Action,
        Kind::Story | Kind::Act | Kind::Group | Kind::Maneuver | Kind::Event(_) => Form::Step,
    }
}

/// Returns the name of an action in the standard.
fn name(action: &Action) -> &'static str {
    match action {
        Action::Teleport(_) => "TeleportAction",
        Action::Speed { .. } => "SpeedAction",
        Action::Profile(_) => "SpeedProfileAction",
        Action::Gap { .. } => "LongitudinalDistanceAction",
        Action::Beside(_) => "LateralDistanceAction",
        Action::LaneChange { .. } => "LaneChangeAction",
        Action::LaneOffset { .. } => "LaneOffsetAction",
        Action::Trajectory(_) => "FollowTrajectoryAction",
        Action::Route(_) => "AssignRouteAction",
        Action::Acquire(_) => "AcquirePositionAction",
        Action::Synchronize(_) => "SynchronizeAction",
        Action::Control(Handover { assigns: true, .. }) => "AssignControllerAction",
        Action::Control(_) => "ActivateControllerAction",
        Action::Add(_) => "AddEntityAction",
        Action::Delete => "DeleteEntityAction",
        Action::Nothing => "an action without effect",
    }
}

/// Returns the entities whose motion a measure depends on.
fn measured(measure: &Measure) -> Vec<usize> {
    let goal = |to: &Goal| match to {
        Goal::Entity(other) => Some(*other),
        Goal::Place(_) => None,
    };
    match measure {
        Measure::Speed { entity, .. }
        | Measure::Acceleration { entity, .. }
        | Measure::Standing { entity }
        | Measure::Travelled { entity }
        | Measure::EndOfRoad { entity }
        | Measure::Offroad { entity } => vec![*entity],
        Measure::RelativeSpeed { entity, other, .. } | Measure::Headway { entity, to: other, .. } => {
            vec![*entity, *other]
        }
        Measure::Distance { entity, to, .. } | Measure::TimeToCollision { entity, to, .. } => {
            [*entity].into_iter().chain(goal(to)).collect()
        }
        Measure::Touching { entity, others } => [*entity].into_iter().chain(others.iter().copied()).collect(),
        Measure::Clearance(area) => [area.entity].into_iter().chain(area.others.iter().copied()).collect(),
        Measure::Turned { entity, from: Bearing::Entity(other), .. } => vec![*entity, *other],
        Measure::Turned { entity, .. } => vec![*entity],
        Measure::Time
        | Measure::TimeOfDay
        | Measure::Constant(_)
        | Measure::Variable(_)
        | Measure::VariableIs(..)
        | Measure::State { .. } => Vec::new(),
    }
}
