//! Nothing of a file is ignored silently: second elements, versions, names that are taken, and files that are no files.

use super::bad::{changed_in, messages_of};
use super::worlds::file;
use paracosm_standards::openscenario::Xosc;
use std::fs;

const LEADER: &str = "slow-leader.xosc";
const ALL: &str = "everything.xosc";
const TUPLES: &str = "slow-leader-tuples.xosc";
const VARIATION: &str = "slow-leader-variation.xosc";

#[track_caller]
pub fn refuses(scenario: &str, found: &str, by: &str, expected: &str) {
    let message = messages_of(scenario, found, by);
    assert!(message.contains(expected), "expected `{expected}` for `{by}` in: {message}");
}

/// Reads the scenario of the slow leader with a change in a file that it needs, or that needs it. Messages have paths from its folder.
pub fn read(name: &str, found: &str, by: &str) -> Result<Xosc, String> {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("catalogs")).unwrap();
    for copied in [LEADER, TUPLES, VARIATION, "straight.xodr", "catalogs/entities.xosc"] {
        fs::copy(file(copied), folder.path().join(copied)).unwrap();
    }
    let text = fs::read_to_string(file(name)).unwrap();
    assert!(text.contains(found), "{found}");
    fs::write(folder.path().join(name), text.replacen(found, by, 1)).unwrap();
    let main = if name.starts_with("slow") { name } else { LEADER };
    let start = format!("{}/", folder.path().display());
    Xosc::read(&folder.path().join(main)).map_err(|error| error.to_string().replace(&start, ""))
}

pub fn message_of(name: &str, found: &str, by: &str) -> String {
    read(name, found, by).err().expect("it is refused")
}

#[test]
fn a_second_element_is_refused_where_the_standard_has_one() {
    let lane = "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"/>";
    let world = "<WorldPosition x=\"0\" y=\"0\"/>";
    refuses(LEADER, lane, &lane.repeat(2), "29: <Position> has a second <LanePosition>, expected at most one");
    refuses(
        LEADER,
        lane,
        &format!("{lane}{world}"),
        "29: <Position> has <WorldPosition> beside <LanePosition>, expected only one of them",
    );
    for (found, first, says) in [
        ("<SpeedActionTarget>", "<SpeedActionTarget/>", "<SpeedAction> has a second <SpeedActionTarget>"),
        ("<LogicFile", "<LogicFile filepath=\"straight.xodr\"/>", "<RoadNetwork> has a second <LogicFile>"),
        ("<Actors ", "<Actors selectTriggeringEntities=\"false\"/>", "<ManeuverGroup> has a second <Actors>"),
        (
            "<TeleportAction>",
            "<VisibilityAction graphics=\"true\" sensors=\"true\" traffic=\"true\"/>",
            "<PrivateAction> has <TeleportAction> beside <VisibilityAction>",
        ),
        (
            "<SimulationTimeCondition",
            "<SimulationTimeCondition value=\"9\" rule=\"lessThan\"/>",
            "<ByValueCondition> has a second <SimulationTimeCondition>",
        ),
        (
            "<SimulationTimeCondition",
            "<ParameterCondition parameterRef=\"gap\" value=\"9\" rule=\"lessThan\"/>",
            "<ByValueCondition> has <SimulationTimeCondition> beside <ParameterCondition>",
        ),
        (
            "<ActivateControllerAction",
            "<ActivateControllerAction lateral=\"true\"/>",
            "<ControllerAction> has a second <ActivateControllerAction>",
        ),
        ("<Directory", "<Directory path=\"catalogs\"/>", "<VehicleCatalog> has a second <Directory>"),
    ] {
        refuses(LEADER, found, &format!("{first}{found}"), says);
    }
    for (found, first, says) in [
        ("<StandStillCondition", "<StandStillCondition duration=\"2\"/>", "has a second <StandStillCondition>"),
        ("<Polyline>", "<Polyline/>", "<Shape> has a second <Polyline>"),
        ("<TimeReference><Timing", "<TimeReference><None/></TimeReference>", "has a second <TimeReference>"),
        ("<Timing", "<None/>", "<TimeReference> has <Timing> beside <None>"),
        ("<MiscObject name", "<CatalogReference/>", "<ScenarioObject> has <MiscObject> beside <CatalogReference>"),
    ] {
        refuses(ALL, found, &format!("{first}{found}"), says);
    }
}

#[test]
fn a_second_distribution_is_refused() {
    let set = "<DistributionSet>";
    let message =
        message_of(VARIATION, set, &format!("<DistributionSet><Element value=\"1\"/></DistributionSet>{set}"));
    let says =
        "slow-leader-variation.xosc:11: <DeterministicSingleParameterDistribution> has a second <DistributionSet>";
    assert!(message.starts_with(says), "{message}");
    let message = message_of(VARIATION, "</Deterministic>", "</Deterministic><Stochastic numberOfTestRuns=\"1\"/>");
    assert!(message.contains("<ParameterValueDistribution> has <Stochastic> beside <Deterministic>"), "{message}");
}

#[test]
fn an_action_may_assign_a_controller_and_activate_it() {
    let activate = "<ActivateControllerAction lateral=\"true\" longitudinal=\"true\"/>";
    let assign = "<AssignControllerAction><Controller name=\"a\"/></AssignControllerAction>";
    assert_eq!(messages_of(LEADER, activate, &format!("{assign}{activate}")), "none");
}

#[test]
fn the_version_of_a_file_is_one_that_is_read() {
    let header = "3: `revM";
    refuses(
        LEADER,
        "revMajor=\"1\"",
        "revMajor=\"2\"",
        &format!("{header}ajor=\"2\"` of <FileHeader> is not allowed, expected 1"),
    );
    for minor in ["9", "three", "-1", "1.0"] {
        let says =
            format!("{header}inor=\"{minor}\"` of <FileHeader> is not allowed, expected a whole number of at most 3");
        refuses(LEADER, "revMinor=\"3\"", &format!("revMinor=\"{minor}\""), &says);
    }
    refuses(LEADER, "revMinor=\"3\"", "", "<FileHeader> has no attribute `revMinor`");
    for name in [VARIATION, "catalogs/entities.xosc"] {
        let message = message_of(name, "revMinor=\"3\"", "revMinor=\"4\"");
        assert!(message.starts_with(&format!("{name}:3: `revMinor=\"4\"` of <FileHeader>")), "{message}");
    }
    let text = fs::read_to_string(file(LEADER)).unwrap();
    let line = text.lines().nth(2).unwrap();
    refuses(LEADER, line, "", "2: <OpenSCENARIO> contains no <FileHeader>");
}

#[test]
fn a_name_is_taken_once() {
    let count = "<VariableDeclaration name=\"open\"";
    refuses(
        ALL,
        count,
        "<VariableDeclaration name=\"count\"",
        "10: `name=\"count\"` of <VariableDeclaration> is taken: the element in line 9 has the same value",
    );
    let selection = |name: &str| {
        format!(
            "<EntitySelection name=\"{name}\"><Members><ByType objectType=\"vehicle\"/></Members></EntitySelection>"
        )
    };
    for name in ["cars", "Leader"] {
        let by = format!("{}\n{}</Entities>", selection("cars"), selection(name));
        refuses(
            LEADER,
            "</Entities>",
            &by,
            &format!("`name=\"{name}\"` of <EntitySelection> is taken: the element in line "),
        );
    }
    let message = message_of("catalogs/entities.xosc", "<Pedestrian name", "<Vehicle name=\"car\"/>\n<Pedestrian name");
    assert!(
        message.starts_with("catalogs/entities.xosc:17: `name=\"car\"` of <Vehicle> is taken: the element in line 5 "),
        "{message}"
    );
}

#[test]
fn siblings_of_the_storyboard_have_different_names() {
    let group = "<ManeuverGroup name=\"group\" maximumExecutionCount=\"1\"><Actors selectTriggeringEntities=\"false\"/></ManeuverGroup>";
    let act = format!("<Act name=\"act\">{group}</Act>");
    for (found, by, says) in [
        ("</Story>", format!("{act}</Story>"), "68: `name=\"act\"` of <Act> is taken: the element in line 44 "),
        ("</Act>", format!("{group}</Act>"), "`name=\"group\"` of <ManeuverGroup> is taken"),
        (
            "</CatalogReference>\n        </ManeuverGroup>",
            "</CatalogReference>\n<CatalogReference catalogName=\"entities\" entryName=\"slow-down\"/></ManeuverGroup>"
                .to_owned(),
            "50: `entryName=\"slow-down\"` of <CatalogReference> is taken: the element in line 47 ",
        ),
        ("</Story>", format!("</Story><Story name=\"story\">{act}</Story>"), "`name=\"story\"` of <Story> is taken"),
    ] {
        refuses(LEADER, found, &by, says);
    }
}

#[test]
fn a_name_has_no_line_breaks() {
    let says = r#"`name="Lea\nder"` of <ScenarioObject> is not allowed, expected a name without line breaks"#;
    refuses(LEADER, "name=\"Leader\"", "name=\"Lea&#10;der\"", says);
    refuses(LEADER, "Act name=\"act\"", "Act name=\"a&#9;ct\"", r#"`name="a\tct"` of <Act>"#);
}

#[test]
fn a_file_that_is_named_is_a_file() {
    refuses(
        LEADER,
        "filepath=\"straight.xodr\"",
        "filepath=\"\"",
        "`filepath=\"\"` of <LogicFile> is not allowed, expected a value",
    );
    refuses(
        LEADER,
        "\"straight.xodr\"",
        "\"catalogs\"",
        "17: `filepath=\"catalogs\"` of <LogicFile> is not allowed, expected a file that exists, and ",
    );
    refuses(LEADER, "\"straight.xodr\"", "\"catalogs\"", "catalogs is a folder");
    for wrong in ["\"slow-leadr.xosc\"", "\"slow-leader.xsoc\"", "\"slow-leader\""] {
        let message = message_of(VARIATION, "\"slow-leader.xosc\"", wrong);
        assert!(message.ends_with("(did you mean `slow-leader.xosc`?)"), "{message}");
    }
}

#[test]
fn an_entry_of_another_kind_is_named_with_its_place() {
    let message = messages_of(LEADER, "entryName=\"car\"", "entryName=\"left\"");
    assert!(message.contains("`entryName=\"left\"` of <CatalogReference> is not allowed, expected a Vehicle or Pedestrian or MiscObject; the entry in "), "{message}");
    assert!(message.ends_with("entities.xosc:26 is a Route"), "{message}");
}

#[test]
fn the_parts_of_a_catalog_may_be_in_two_files_but_an_entry_in_one_alone() {
    let (folder, path) = changed_in("slow-leader.xosc", "entryName=\"slow-down\"", "entryName=\"slow-down\"");
    let entities = folder.path().join("catalogs/entities.xosc");
    let text = fs::read_to_string(&entities).unwrap();
    let (start, end) = (text.find("<Maneuver name=\"slow-down\"").unwrap(), text.find("</Catalog>").unwrap());
    let head = &text[..text.find("<Vehicle").unwrap()];
    // The second file has the maneuver alone.
    fs::write(folder.path().join("catalogs/zz.xosc"), format!("{head}{}", &text[start..])).unwrap();
    let message = Xosc::read(&path).err().expect("the maneuver is in both").to_string();
    let says = "zz.xosc:5: the catalog has a second <Maneuver> with the name `slow-down`: the first one is in ";
    assert!(message.contains(says) && message.contains("entities.xosc:38"), "{message}");
    fs::write(&entities, format!("{}{}", &text[..start], &text[end..])).unwrap();
    Xosc::read(&path).unwrap_or_else(|error| panic!("{error}"));
}
