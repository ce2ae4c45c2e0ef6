//! Elements have what the standard demands and nothing else; values without effect are checked as well.

use super::bad::changed_in;
use super::strict::refuses;
use super::worlds::led;
use paracosm_standards::openscenario::Xosc;
use std::fs;

const LEADER: &str = "slow-leader.xosc";
const ALL: &str = "everything.xosc";

/// Returns the notes on a file with a change, without the notes on its catalogs.
fn notes(scenario: &str, found: &str, by: &str) -> Vec<String> {
    let (_folder, path) = changed_in(scenario, found, by);
    let program = Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program();
    let start = format!("{}:", path.display());
    let nominal = program.declare().unwrap().nominal();
    program.notes(&nominal).iter().filter_map(|note| note.strip_prefix(&start)).map(str::to_owned).collect()
}

#[test]
fn an_attribute_that_the_standard_demands_is_missed_with_the_similar_one() {
    refuses(
        LEADER,
        "<Event name=\"activation\"",
        "<Event nmae=\"activation\"",
        "<Event> has no attribute `name`, which the standard requires; it has `nmae`, which the standard does not have",
    );
    for (found, by, says) in [
        ("<Action name=\"activation\">", "<Action>", "<Action> has no attribute `name`, which the standard requires"),
        (
            " author=\"the authors of PARACOSM\"",
            "",
            "<FileHeader> has no attribute `author`, which the standard requires",
        ),
        ("name=\"group\" maximumExecutionCount=\"1\"", "name=\"group\"", "no attribute `maximumExecutionCount`"),
    ] {
        refuses(LEADER, found, by, says);
    }
}

#[test]
fn an_attribute_that_the_standard_does_not_have_is_noted_with_the_similar_one() {
    let notes = notes(LEADER, "<Event name=\"activation\"", "<Event name=\"activation\" maximumExecutionCont=\"2\"");
    let says = "`Event.maximumExecutionCont` has no effect: the standard does not have this attribute (did you mean \
                `maximumExecutionCount`?)";
    assert!(notes.iter().any(|note| note.contains(says)), "{notes:?}");
}

#[test]
fn an_element_that_contains_nothing_is_refused_where_the_standard_wants_something() {
    for (found, by, says) in [
        ("<ActivateControllerAction lateral=\"true\" longitudinal=\"true\"/>", "", "<ControllerAction> contains no <"),
        ("</Storyboard>", "<StopTrigger><ConditionGroup/></StopTrigger></Storyboard>", "<Storyboard> has a second"),
        ("<ConditionGroup>", "<ConditionGroup/><ConditionGroup>", "<ConditionGroup> contains no <Condition>"),
        ("</Maneuver>", "<Event name=\"empty\" priority=\"skip\"/></Maneuver>", "<Event> contains no <Action>"),
        ("</Story>", "</Story><Story name=\"empty\"/>", "<Story> contains no <Act>"),
        ("</Init>", "</Init><Story name=\"empty\"><Act name=\"empty\"/></Story>", "<Act> contains no <ManeuverGroup>"),
        ("<FileHeader", "<!-- <FileHeader", "is not well-formed XML"),
    ] {
        refuses(LEADER, found, by, says);
    }
}

#[test]
fn a_text_between_elements_is_refused_with_its_line() {
    refuses(
        LEADER,
        "<Entities>",
        "<Entities>\n\n  Ego,",
        "<Entities> contains the text `Ego,`, expected elements only",
    );
    let long = "a".repeat(500);
    let says = format!("<Entities> contains the text `{}…`, expected", &long[..80]);
    refuses(LEADER, "<Entities>", &format!("<Entities>{long}"), &says);
    assert!(notes(LEADER, "<Entities>", "<Entities><!-- a comment is no text -->").is_empty());
}

#[test]
fn values_without_effect_are_checked() {
    for (found, by, says) in [
        ("role=\"civil\"", "role=\"civl\"", "`role=\"civl\"` of <Vehicle> is not allowed, expected one of none, ambul"),
        (
            "routingAlgorithm=\"shortest\"",
            "routingAlgorithm=\"short\"",
            "`routingAlgorithm=\"short\"` of <RelativeDist",
        ),
        ("followingMode=\"follow\"", "followingMode=\"led\"", "`followingMode=\"led\"` of <SpeedActionDynamics>"),
        ("dz=\"0.5\"", "dz=\"up\"", "`dz=\"up\"` of <RelativeObjectPosition> is not allowed, expected a finite number"),
        ("lighting=\"true\"", "lighting=\"on\"", "`lighting=\"on\"` of <ActivateControllerAction>"),
        ("Category=\"pedestrian\"", "Category=\"walker\"", "`pedestrianCategory=\"walker\"` of <Pedestrian>"),
        ("Category=\"obstacle\"", "Category=\"box\"", "`miscObjectCategory=\"box\"` of <MiscObject>"),
    ] {
        refuses(ALL, found, by, says);
    }
}

#[test]
fn values_that_mean_the_same_as_no_attribute_are_not_noted() {
    let place = "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"/>";
    let with = |rolls: &str, by: &str| {
        let turned = format!(
            "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"><Orientation type=\"relative\" h=\"0\" p=\"{rolls}\" r=\"0.0\"/>\
             </LanePosition>"
        );
        notes(LEADER, place, &format!("{turned}{by}"))
    };
    assert!(with("0", "").is_empty());
    let found = with("0.1", "");
    assert!(found[0].contains("`Orientation.p` has no effect: the world is flat"), "{found:?}");
}

#[test]
fn an_entity_that_sensors_do_not_see_is_refused() {
    let all = "sensors=\"true\" traffic=\"true\"";
    let says =
        "`sensors=\"false\"` of <VisibilityAction> is not allowed, expected true: sensors and drivers see all entities";
    refuses(ALL, all, "sensors=\"false\" traffic=\"true\"", says);
    refuses(ALL, all, "sensors=\"true\" traffic=\"false\"", "`traffic=\"false\"` of <VisibilityAction>");
}

#[test]
fn a_negative_rate_is_noted_and_its_sign_changes_nothing() {
    let catalog = |rate: &str| {
        let (folder, path) = changed_in(LEADER, "Ego", "Ego");
        let file = folder.path().join("catalogs/entities.xosc");
        let text = fs::read_to_string(&file).unwrap().replacen(
            "\"rate\" value=\"2\"",
            &format!("\"rate\" value=\"{rate}\""),
            1,
        );
        fs::write(&file, text).unwrap();
        let program = Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program();
        let notes = program.notes(&program.declare().unwrap().nominal());
        (led(&program).unwrap().trace.unwrap().hash(), notes)
    };
    let (falls, notes) = catalog("-2");
    let says =
        "`SpeedActionDynamics.value` has no effect: the sign of a rate changes nothing: the target gives the direction";
    assert!(notes.iter().any(|note| note.contains(says)), "{notes:?}");
    let (rises, notes) = catalog("2");
    assert!(!notes.iter().any(|note| note.contains("rate")), "{notes:?}");
    assert_eq!(falls, rises);
}

#[test]
fn a_catalog_folder_that_does_not_exist_is_noted() {
    let notes = notes(ALL, "path=\"absent\"", "path=\"absent\"");
    assert!(notes.iter().any(|note| note.contains("there is no folder ") && note.starts_with("21:")), "{notes:?}");
}

#[test]
fn an_action_on_a_variable_has_a_value_of_its_type() {
    let sets = "variableRef=\"count\"><SetAction value=\"2\"/>";
    let says = "`value=\"fast\"` of <SetAction> is not allowed, expected a finite number";
    refuses(ALL, sets, &sets.replace("\"2\"", "\"fast\""), says);
    let says = "`value=\"2\"` of <SetAction> is not allowed, expected true or false";
    refuses(ALL, sets, &sets.replace("count", "open"), says);
    let adds = "variableRef=\"count\"><ModifyAction><Rule><AddValue";
    refuses(ALL, adds, &adds.replace("count", "open"), "128: `open` is no number, so nothing can be added to it");
}
