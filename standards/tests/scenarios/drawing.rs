//! The graph of a storyboard: from conditions over events and actions to entities, and back to what conditions measure.

use super::worlds::file;
use paracosm_standards::openscenario::Xosc;
use std::collections::BTreeMap;

/// The lines of a graph in the language of Graphviz, between the labels of its nodes, with the style of each.
struct Lines(Vec<(String, String, String)>);

impl Lines {
    fn of(name: &str) -> Self {
        let program = Xosc::read(&file(name)).unwrap_or_else(|error| panic!("{error}")).program();
        let dot = program.dot().unwrap();
        let mut labels = BTreeMap::new();
        let mut lines = Vec::new();
        for line in dot.lines().map(|line| line.trim().trim_end_matches(';')) {
            let (ends, style) = line.split_once(" [").unwrap_or((line, ""));
            if let Some((from, to)) = ends.split_once(" -> ") {
                lines.push((from.to_owned(), to.to_owned(), style.to_owned()));
            } else if let Some(label) = style.strip_prefix("label=\"").and_then(|rest| rest.split('"').next()) {
                labels.insert(ends.to_owned(), label.to_owned());
            }
        }
        let label = |node: &String| labels.get(node).unwrap_or_else(|| panic!("no node {node} in {dot}")).clone();
        Self(lines.iter().map(|(from, to, style)| (label(from), label(to), style.clone())).collect())
    }

    /// Returns the style of the line between two nodes.
    fn style(&self, from: &str, to: &str) -> &str {
        let found = self.0.iter().find(|(one, two, _)| one == from && two == to);
        &found.unwrap_or_else(|| panic!("no line from {from} to {to}: {:#?}", self.0)).2
    }
}

#[test]
fn the_graph_leads_from_conditions_over_events_and_actions_to_entities() {
    let lines = Lines::of("slow-leader.xosc");
    assert!(lines.style("storyboard.at once", "act: Act").contains("label=\"start\""));
    lines.style("act: Act", "slowing down: Event");
    assert!(lines.style("storyboard.at 5 s", "slowing down: Event").contains("label=\"start\""));
    lines.style("slowing down: Event", "brake: SpeedAction");
    lines.style("brake: SpeedAction", "Leader");
    lines.style("activation: Event", "activation: ActivateControllerAction");
    lines.style("activation: ActivateControllerAction", "Ego");
    lines.style("Init: TeleportAction, SpeedAction", "Leader");
}

#[test]
fn the_graph_shows_the_elements_that_conditions_ask_for_and_the_end_of_the_run() {
    let lines = Lines::of("slow-leader.xosc");
    assert!(lines.style("slowing down: Event", "storyboard.5 s after the maneuver.measure").contains("dashed"));
    let stop = lines.style("storyboard.5 s after the maneuver", "StopTrigger");
    assert!(stop.contains("label=\"stop, rising, after 5 s\""), "{stop}");
    assert!(lines.style("StopTrigger", "storyboard.stopped").contains("dashed"));
}

#[test]
fn each_of_our_files_is_drawn_with_all_its_conditions() {
    for name in ["actions.xosc", "everything.xosc", "routes.xosc", "weather.xosc", "slow-leader-variation.xosc"] {
        let lines = Lines::of(name);
        let inputs = lines.0.iter().filter(|(_, to, _)| to.starts_with("storyboard.") && to != "storyboard.stopped");
        let inputs: Vec<_> = inputs.filter(|(_, to, _)| !to.ends_with(".measure")).collect();
        for (_, input, _) in &inputs {
            assert!(lines.0.iter().any(|(from, ..)| from == input), "{name}: `{input}` starts nothing");
        }
        assert!(!inputs.is_empty(), "{name}");
    }
}
