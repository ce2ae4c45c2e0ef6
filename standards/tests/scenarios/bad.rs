//! Files with mistakes: each is refused with its file, its line and what to do.

use super::worlds::file;
use paracosm_standards::openscenario::{Xosc, elements};
use paracosm_standards::{Flaw, Support};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Writes a scenario in which a text is replaced by another text, with its catalog and its road. Returns the folder and the file.
pub fn changed_in(scenario: &str, found: &str, by: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("catalogs")).unwrap();
    for name in ["straight.xodr", "crossing.xodr", "catalogs/entities.xosc"] {
        fs::copy(file(name), folder.path().join(name)).unwrap();
    }
    let text = fs::read_to_string(file(scenario)).unwrap();
    assert!(text.contains(found), "{found}");
    let path = folder.path().join("bad.xosc");
    fs::write(&path, text.replacen(found, by, 1)).unwrap();
    (folder, path)
}

/// Returns the messages about a scenario in which a text is replaced by another text.
fn messages(found: &str, by: &str) -> String {
    messages_of("slow-leader.xosc", found, by)
}

pub fn messages_of(scenario: &str, found: &str, by: &str) -> String {
    let (folder, path) = changed_in(scenario, found, by);
    match Xosc::read(&path) {
        Err(error) => {
            assert!(error.file.starts_with(folder.path()), "{error}");
            format!("{}: {}", error.line.map_or("file".to_owned(), |line| line.to_string()), error.flaw)
        }
        Ok(scenario) => {
            let program = scenario.program();
            let checked = program.declare().and_then(|declaration| program.check(&declaration.nominal()));
            checked.map_or_else(|error| error.to_string(), |()| "none".to_owned())
        }
    }
}

#[test]
fn a_mistake_is_reported_with_its_place_and_the_nearest_name() {
    for (found, by, expected) in [
        ("entityRef=\"Leader\"", "entityRef=\"Leadr\"", "names no entity of the file (did you mean `Leader`?)"),
        ("entryName=\"car\"/>", "entryName=\"cat\"/>", "did you mean `car`?"),
        ("catalogName=\"entities\"", "catalogName=\"entitys\"", "did you mean `entities`?"),
        ("$gap + 10", "$gat + 10", "there is no parameter `gat` (did you mean `gap`?)"),
        (
            "$gap + 10",
            "$start + 10",
            "12: `value=\"${$start + 10}\"` of <ParameterDeclaration> has no value: it names the parameter `start` itself",
        ),
        (
            "rule=\"lessOrEqual\" value=\"50\"",
            "rule=\"lessOrEqual\" value=\"$gop\"",
            "8: `value=\"$gop\"` of <ValueConstraint> has no value: there is no parameter `gop` (did you mean `gap`?)",
        ),
        ("$gap + 10", "$gap / 0", "it divides by zero"),
        ("$gap + 10", "$gap +", "it ends where a value was expected"),
        (
            "value=\"$speed\"",
            "value=\"fast\"",
            "`value=\"fast\"` of <AbsoluteTargetSpeed> is not allowed, expected a finite number",
        ),
        ("value=\"$speed\"", "value=\"NaN\"", "expected a finite number"),
        (
            "straight.xodr",
            "strait.xodr",
            "17: `filepath=\"strait.xodr\"` of <LogicFile> is not allowed, expected a file that exists, and there is no ",
        ),
        ("straight.xodr", "strait.xodr", "strait.xodr (did you mean `straight.xodr`?)"),
        ("straight.xodr", "/etc/hostname", "expected a path in the folder of the scenario"),
        (
            "straight.xodr",
            "../../../../../../../../../../etc/hostname",
            "a relative path that does not lead up to the root",
        ),
        ("Directory path=\"catalogs\"", "Directory path=\"/etc\"", "15: `path=\"/etc\"` of <Directory> is not allowed"),
        ("Directory path=\"catalogs\"", "Directory path=\"cats\"", "15: the folder "),
        ("maximumExecutionCount=\"1\"", "maximumExecutionCount=\"-1\"", "expected a whole number above 0"),
        (
            "maximumExecutionCount=\"1\"",
            "maximumExecutionCount=\"0\"",
            "45: `maximumExecutionCount=\"0\"` of <ManeuverGroup>",
        ),
        (
            "storyboardElementRef=\"slowing down\"",
            "storyboardElementRef=\"slowing dow\"",
            "71: `storyboardElementRef=\"slowing dow\"` of <StoryboardElementStateCondition> names no event of the file \
             (did you mean `slowing down`?)",
        ),
        (
            "storyboardElementRef=\"slowing down\"",
            "storyboardElementRef=\"activation::slowing down\"",
            "names no event of the file (did you mean `slowing down`?)",
        ),
        (
            "storyboardElementType=\"event\" storyboardElementRef",
            "storyboardElementType=\"act\" storyboardElementRef",
            "names no act of the file",
        ),
        (
            "<Event name=\"activation\"",
            "<Event name=\"slowing down\"",
            "names more than one event: write `story::act::group::",
        ),
        (
            "laneId=\"-1\" s=\"10\"",
            "laneId=\"0\" s=\"10\"",
            "expected the number of a lane with a width, which is not 0",
        ),
        ("delay=\"5\"", "delay=\"-5\"", "expected a number that is not negative"),
        (
            "dynamicsDimension=\"time\" value=\"0\"",
            "dynamicsDimension=\"time\" value=\"-1\"",
            "expected a number that is not negative",
        ),
        ("$gap + 10", "100 / ($gap - 50)", "it divides by zero"),
        (
            "parameterType=\"double\" value=\"50\"",
            "parameterType=\"double\" value=\"$start\"",
            "11: `value=\"$start\"` of <ParameterDeclaration> has no value: the parameter `start` is declared later; declare it",
        ),
        (
            "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"$start\"/>",
            "<RelativeLanePosition entityRef=\"Leader\" dLane=\"0\" ds=\"5\"/>",
            "bad.xosc:36: an initial action of `Leader` cannot begin: `Leader` is beside all roads or has no place yet",
        ),
        (
            "roadId=\"1\" laneId=\"-1\" s=\"10\"",
            "roadId=\"7\" laneId=\"-1\" s=\"10\"",
            "29: `roadId=\"7\"` of <LanePosition> is not allowed, expected a road of the map: 1",
        ),
        ("laneId=\"-1\" s=\"10\"", "laneId=\"-3\" s=\"10\"", "expected a lane of road `1` at s = 10 m: -2, -1, 1, 2"),
        ("laneId=\"-1\" s=\"10\"", "laneId=\"-1\" s=\"2000\"", "expected a place on road `1`, which is 1000 m long"),
        ("<SpeedAction>", "<SpedAction/><SpeedAction>", "did you mean `SpeedAction`?"),
        ("dynamicsShape=\"step\"", "dynamicsShape=\"stepp\"", "did you mean `step`?"),
        ("priority=\"override\"", "", "has no attribute `priority`"),
        ("name=\"Leader\"", "name=\"Ego\"", "is taken"),
        (
            "rule=\"greaterThan\" value=\"0\"",
            "rule=\"greaterThan\" value=\"40\"",
            "bad.xosc:5: the constraint `speed > 40 and speed <= 50` does not hold for speed = 30",
        ),
        ("</OpenSCENARIO>", "", "not well-formed XML"),
        ("<OpenSCENARIO>", "<!DOCTYPE a [<!ENTITY b \"c\">]><OpenSCENARIO>", "document type"),
    ] {
        let message = messages(found, by);
        assert!(message.contains(expected), "{by}: {message}");
    }
}

#[test]
fn a_mistake_in_an_action_or_a_condition_is_reported() {
    for (scenario, found, by, expected) in [
        ("actions.xosc", "order=\"3\"", "order=\"9\"", "expected a number from 2 to 3, the number of control points"),
        ("actions.xosc", "<Knot value=\"1\"/></Nurbs>", "</Nurbs>", "with 6 knots that rise, not 5"),
        (
            "actions.xosc",
            "weight=\"1\"",
            "weight=\"0\"",
            "`weight=\"0\"` of <ControlPoint> is not allowed, expected a number above 0",
        ),
        ("actions.xosc", "maxDeceleration=\"2\"", "maxDeceleration=\"0\"", "expected a number above 0"),
        ("actions.xosc", "maxDeceleration=\"1\"", "maxDeceleration=\"-1\"", "expected a number that is not negative"),
        (
            "actions.xosc",
            "parameterRef=\"$count\"",
            "parameterRef=\"$coun\"",
            "names no parameter of the file (did you mean `count`?)",
        ),
        (
            "actions.xosc",
            "<EntityRef entityRef=\"First\"/>",
            "<EntityRef entityRef=\"Firs\"/>",
            "did you mean `First`?",
        ),
        ("actions.xosc", "objectType=\"pedestrian\"", "objectType=\"person\"", "did you mean `pedestrian`?"),
        (
            "actions.xosc",
            "angleType=\"heading\"",
            "angleType=\"pitch\"",
            "is not allowed, expected heading: the world is flat",
        ),
        ("actions.xosc", "displacement=\"rightTo", "displacement=\"rigtTo", "did you mean `rightToReferencedEntity`?"),
        ("actions.xosc", "dateTime=\"2026-01-31T11", "dateTime=\"2026-31-01T11", "expected a time such as"),
        ("routes.xosc", "entryName=\"left\"", "entryName=\"lef\"", "did you mean `left`?"),
        ("routes.xosc", "<FromCurrentEntity entityRef=\"OnLane\"/>", "<FromNowhere/>", "<FromNowhere>"),
        (
            "routes.xosc",
            "roadId=\"3\" laneId=\"-1\" s=\"50\"",
            "roadId=\"2\" laneId=\"-1\" s=\"500\"",
            "`s=\"500\"` of <LanePosition> is not allowed, expected a place on road `2`",
        ),
        (
            "routes.xosc",
            "roadId=\"1\" laneId=\"-1\" s=\"10\"/></Position></Waypoint>",
            "roadId=\"2\" laneId=\"-1\" s=\"60\"/></Position></Waypoint>",
            "no road leads from road `2` to road `3`",
        ),
    ] {
        let message = messages_of(scenario, found, by);
        assert!(message.contains(expected), "{by}: {message}");
    }
}

/// Returns a file in which an element stands within all its ancestors.
fn nested(path: &[&str]) -> String {
    let header = "<FileHeader revMajor=\"1\" revMinor=\"3\"/>";
    let open: String = path.iter().map(|name| format!("<{name}>")).collect();
    let open = open.replacen('>', &format!(">{header}"), 1);
    let close: String = path.iter().rev().map(|name| format!("</{name}>")).collect();
    open + &close
}

#[test]
fn every_refused_element_is_refused_by_its_name() {
    // The ways from the outermost element to each element that is read.
    let mut ways: BTreeMap<&str, Vec<&str>> = BTreeMap::from([("OpenSCENARIO", vec!["OpenSCENARIO"])]);
    let read: Vec<_> = elements().filter(|element| element.support == Support::Read).collect();
    loop {
        let known = ways.len();
        for element in &read {
            if let Some(way) = ways.get(element.parent).cloned() {
                ways.entry(element.name).or_insert_with(|| way.into_iter().chain([element.name]).collect());
            }
        }
        if ways.len() == known {
            break;
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("refused.xosc");
    let mut count = 0;
    for element in elements() {
        let Support::Refused(reason) = element.support else { continue };
        let Some(way) = ways.get(element.parent) else { continue };
        if let Some(attribute) = element.name.strip_prefix('@') {
            let refused = ["true", "false", "pitch"].into_iter().filter(|value| {
                fs::write(&path, nested(way).replacen("></", &format!(" {attribute}=\"{value}\"></"), 1)).unwrap();
                let error = Xosc::read(&path).err().expect("the file lacks much").to_string();
                error.contains(&format!("`{attribute}=\"{value}\"` of <{}>", element.parent)) && error.contains(reason)
            });
            assert_eq!(refused.count(), 1, "{way:?} {attribute}");
            continue;
        }
        let all: Vec<&str> = way.iter().copied().chain([element.name]).collect();
        fs::write(&path, nested(&all)).unwrap();
        let error = Xosc::read(&path).err().expect("it is refused");
        let Flaw::Refused { element: named, reason: given } = &*error.flaw else { panic!("{error}") };
        assert_eq!((named.as_str(), *given), (element.name, reason), "{all:?}");
        count += 1;
    }
    assert!(count >= 15, "{count} elements");
}

#[test]
fn a_distribution_of_a_parameter_that_is_not_declared_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(file("slow-leader.xosc"), folder.path().join("slow-leader.xosc")).unwrap();
    let text = fs::read_to_string(file("slow-leader-variation.xosc")).unwrap();
    let path = folder.path().join("variation.xosc");
    fs::write(&path, text.replacen("parameterName=\"speed\"", "parameterName=\"sped\"", 1)).unwrap();
    let message = Xosc::read(&path).err().expect("it is refused").to_string();
    assert!(message.contains("variation.xosc:7") && message.contains("did you mean `speed`?"), "{message}");
}

#[test]
fn a_parameter_has_one_distribution_and_a_set_has_all_parameters() {
    let read = |name: &str, found: &str, by: &str| {
        let folder = tempfile::tempdir().unwrap();
        fs::copy(file("slow-leader.xosc"), folder.path().join("slow-leader.xosc")).unwrap();
        let text = fs::read_to_string(file(name)).unwrap();
        assert!(text.contains(found), "{found}");
        let path = folder.path().join("variation.xosc");
        fs::write(&path, text.replacen(found, by, 1)).unwrap();
        Xosc::read(&path).err().expect("it is refused").to_string()
    };
    let message = read("slow-leader-variation.xosc", "parameterName=\"gap\"", "parameterName=\"speed\"");
    assert!(message.contains("one distribution of each parameter"), "{message}");
    let second = "<ParameterAssignment parameterRef=\"gap\" value=\"50\"/>";
    let message = read("slow-leader-tuples.xosc", second, "");
    assert!(message.contains("an assignment of `gap`"), "{message}");
}

#[test]
fn the_name_of_the_parameter_of_the_ego_vehicle_is_taken() {
    let message = messages("name=\"start\"", "name=\"ego\"");
    assert!(message.contains("chooses the ego vehicle"), "{message}");
}

#[test]
fn a_folder_is_no_scenario() {
    assert!(Xosc::read(Path::new(env!("CARGO_MANIFEST_DIR"))).is_err());
}
