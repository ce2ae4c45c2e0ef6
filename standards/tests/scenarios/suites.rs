//! Suites of tests as files: concrete scenarios are read as tests, and tests are written as a distribution.

use super::bad::changed_in;
use super::worlds::file;
use paracosm_space::{Value, Values};
use paracosm_standards::openscenario::{ValueSetFlaw, Xosc, value_sets};
use std::fs;
use std::path::Path;

/// Returns the values that a changed copy of a scenario states for another scenario, or the message.
fn stated(scenario: &str, found: &str, by: &str) -> Result<Vec<(String, Value, u32)>, String> {
    let (_folder, path) = changed_in("slow-leader.xosc", found, by);
    let read = Xosc::read(&file(scenario)).unwrap_or_else(|error| panic!("{error}"));
    read.test_in(&path).map_err(|error| error.to_string().replace(&path.display().to_string(), "copy"))
}

fn stated_value(scenario: &str, found: &str, by: &str, name: &str) -> Value {
    let values = stated(scenario, found, by).unwrap_or_else(|error| panic!("{error}"));
    values.into_iter().find(|(known, ..)| known == name).unwrap_or_else(|| panic!("no {name}")).1
}

#[test]
fn a_copy_with_another_value_of_a_parameter_is_a_test() {
    let values = stated(
        "slow-leader.xosc",
        "\"gap\" parameterType=\"double\" value=\"50\"",
        "\"gap\" parameterType=\"double\" value=\"42.5\"",
    );
    let expected = [("speed".to_owned(), Value::Number(30.0), 5), ("gap".to_owned(), Value::Number(42.5), 11)];
    assert_eq!(values, Ok(expected.to_vec()));
    // The header, comments and spaces do not matter, and numbers may be written in another way.
    for (found, by) in [
        ("description=\"a leader slows down\"", "description=\"test 7\""),
        ("<Storyboard>", "<!-- a comment --><Storyboard >"),
        ("<EntityRef entityRef=\"Leader\"/>", "<EntityRef\n  entityRef = 'Leader'></EntityRef>"),
        ("laneId=\"-1\" s=\"10\"", "s=\"10.0\" laneId=\"-1\""),
        (
            "<OpenSCENARIO>",
            "<OpenSCENARIO xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xsi:noNamespaceSchemaLocation=\"a.xsd\">",
        ),
    ] {
        assert!(stated("slow-leader.xosc", found, by).is_ok(), "{by}: {:?}", stated("slow-leader.xosc", found, by));
    }
}

#[test]
fn the_file_of_a_distribution_takes_copies_of_its_scenario() {
    let speed = ("value=\"30\"", "value=\"20.0\"");
    assert_eq!(stated_value("slow-leader-variation.xosc", speed.0, speed.1, "speed"), Value::Number(20.0));
    // Parameters that change together are one value: the tuple with these values, or else the values of the file.
    let tuple = |by| stated_value("slow-leader-tuples.xosc", "value=\"30\"", by, "speed|gap");
    assert_eq!(tuple("value=\"30.0\""), Value::from("30|50"));
    assert_eq!(tuple("value=\"20\""), Value::from("20|50"));
}

#[test]
fn a_file_that_differs_in_anything_else_is_refused_with_both_places() {
    for (found, by, expected) in [
        ("s=\"10\"", "s=\"11\"", "found `s=\"11\"` of <LanePosition>, expected `s=\"10\"` of <LanePosition> as in"),
        (
            "dynamicsShape=\"step\" ",
            "",
            "found no attribute `dynamicsShape` of <SpeedActionDynamics>, expected `dynamicsShape=\"step\"`",
        ),
        (
            "<Act name=\"act\">",
            "<Act name=\"act\" new=\"1\">",
            "found `new=\"1\"` of <Act>, expected no attribute `new` of <Act>",
        ),
        (
            "<Entities>",
            "<Entities><ScenarioObject name=\"Third\"/>",
            "found `name=\"Third\"` of <ScenarioObject>, expected `name=\"Ego\"`",
        ),
        (
            "<CatalogLocations>",
            "<VariableDeclarations/><CatalogLocations>",
            "found <VariableDeclarations>, expected <CatalogLocations> as in",
        ),
        (
            "<Act name=\"act\">",
            "<Act name=\"act\"/><Act name=\"act\">",
            "found the end of <Act>, expected <ManeuverGroup> as in",
        ),
        (
            "name=\"gap\"",
            "name=\"distance\"",
            "found `name=\"distance\"` of <ParameterDeclaration>, expected `name=\"gap\"`",
        ),
        (
            "value=\"50\"/>\n      </ConstraintGroup>",
            "value=\"60\"/>\n      </ConstraintGroup>",
            "found `value=\"60\"` of <ValueConstraint>, expected `value=\"50\"`",
        ),
        (
            "name=\"speed\" parameterType=\"double\"",
            "name=\"speed\" parameterType=\"string\"",
            "found `parameterType=\"string\"`",
        ),
        ("<Actions>", "<Actions>now", "found the text `now` in <Actions>, expected the text `` in <Actions>"),
        ("${$gap + 10}", "70", "found `value=\"70\"` of <ParameterDeclaration>, expected `value=\"60\"`"),
        (
            "value=\"50\"/>\n    <",
            "value=\"far\"/>\n    <",
            "`value=\"far\"` of <ParameterDeclaration> is not allowed, expected a finite number",
        ),
        ("value=\"50\"/>\n    <", "value=\"$speed\"/>\n    <", "is not allowed, expected a finite number"),
    ] {
        let message = stated("slow-leader.xosc", found, by).expect_err(by);
        assert!(message.starts_with("copy:") && message.contains(expected), "{by}: {message}");
    }
    // A value that follows from others may be an expression, or what it gives.
    assert!(stated("slow-leader.xosc", "${$gap + 10}", "60.0").is_ok());
}

#[test]
fn the_roads_and_catalogs_beside_a_copy_must_be_the_same() {
    let (folder, path) = changed_in("slow-leader.xosc", "value=\"30\"", "value=\"20\"");
    let read = Xosc::read(&file("slow-leader.xosc")).unwrap();
    assert!(read.test_in(&path).is_ok());
    let road = folder.path().join("straight.xodr");
    fs::write(&road, fs::read_to_string(&road).unwrap() + "<!-- wider -->").unwrap();
    let message = read.test_in(&path).unwrap_err().to_string();
    assert!(message.contains("`filepath=\"straight.xodr\"` of <LogicFile>, with other contents"), "{message}");
    // A copy without its roads is played on the roads of the scenario.
    fs::remove_file(&road).unwrap();
    assert!(read.test_in(&path).is_ok());
    let entities = folder.path().join("catalogs/entities.xosc");
    fs::write(&entities, fs::read_to_string(&entities).unwrap().replace("value=\"20\"", "value=\"21\"")).unwrap();
    let message = read.test_in(&path).unwrap_err().to_string();
    assert!(message.contains("`path=\"catalogs\"` of <Directory>, with other contents"), "{message}");
    // The path from another folder leads to the same road.
    let inner = folder.path().join("suite");
    fs::create_dir(&inner).unwrap();
    fs::copy(file("straight.xodr"), &road).unwrap();
    let (base, copy) = (folder.path().join("base.xosc"), inner.join("copy.xosc"));
    let text = fs::read_to_string(file("slow-leader.xosc")).unwrap();
    fs::write(&base, &text).unwrap();
    let moved = text.replace("\"straight.xodr\"", "\"../straight.xodr\"").replace("\"catalogs\"", "\"../catalogs\"");
    fs::write(&copy, moved).unwrap();
    assert!(Xosc::read(&base).unwrap().test_in(&copy).is_ok());
}

fn test(values: &[(&str, Value)]) -> Values {
    values.iter().map(|(name, value)| (*name, value.clone())).collect()
}

#[test]
fn tests_are_written_as_a_distribution_that_has_exactly_these_tests() {
    let (folder, scenario) = changed_in("slow-leader.xosc", "a leader", "a leader");
    let out = folder.path().join("audit/one");
    fs::create_dir_all(&out).unwrap();
    let tests: Vec<Values> = [(21.25, 50.0), (0.1 + 0.2, 20.0), (21.25, 50.0)]
        .map(|(speed, gap)| test(&[("speed", Value::Number(speed)), ("gap", Value::Number(gap))]))
        .into();
    let text = value_sets(&scenario, &out, &tests, &Values::default()).unwrap();
    assert!(text.contains("<ScenarioFile filepath=\"../../bad.xosc\"/>"), "{text}");
    let listed = out.join("additions-1.xosc");
    fs::write(&listed, &text).unwrap();
    let declaration = Xosc::read(&listed).unwrap_or_else(|error| panic!("{error}")).program().declare().unwrap();
    let open: Vec<_> = declaration.parameters.iter().filter(|declared| declared.open).collect();
    assert_eq!(open.len(), 1);
    assert_eq!(open[0].parameter.name, "speed|gap");
    let levels = open[0].parameter.levels().unwrap();
    assert_eq!(levels, ["21.25|50", "0.30000000000000004|20"].map(Value::from));
    // A distribution of the same scenario is no scenario: its scenario is named.
    let variation = folder.path().join("slow-leader-variation.xosc");
    fs::write(folder.path().join("slow-leader.xosc"), fs::read(&scenario).unwrap()).unwrap();
    fs::copy(file("slow-leader-variation.xosc"), &variation).unwrap();
    let text = value_sets(&variation, folder.path(), &tests, &Values::default()).unwrap();
    assert!(text.contains("<ScenarioFile filepath=\"slow-leader.xosc\"/>"), "{text}");
}

#[test]
fn a_distribution_of_tests_has_the_fixed_values_that_differ_from_the_file_and_no_entity() {
    let (folder, scenario) = changed_in("slow-leader.xosc", "a leader", "a leader");
    let tests = [test(&[("speed", Value::Number(25.0))])];
    let fixed = |gap: f64| test(&[("gap", Value::Number(gap)), ("ego", Value::from("Ego"))]);
    let written = |gap: f64| value_sets(&scenario, folder.path(), &tests, &fixed(gap)).unwrap();
    assert!(written(70.0).contains("<ParameterAssignment parameterRef=\"gap\" value=\"70\"/>"));
    assert!(!written(50.0).contains("parameterRef=\"gap\""));
    let far = value_sets(&scenario, Path::new("/proc"), &tests, &Values::default()).unwrap_err();
    assert!(matches!(far, ValueSetFlaw::FarAway { .. }), "{far}");
    let flaw = value_sets(&scenario, folder.path(), &[], &Values::default()).unwrap_err();
    assert!(matches!(flaw, ValueSetFlaw::NoTest), "{flaw}");
    let tests = [test(&[("ego", Value::from("Leader"))])];
    let flaw = value_sets(&scenario, folder.path(), &tests, &Values::default()).unwrap_err();
    assert!(matches!(&flaw, ValueSetFlaw::NotDeclared { name } if name == "ego"), "{flaw}");
}
