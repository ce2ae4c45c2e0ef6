//! The declarations of parameters: their types, and the constraints of parameters in stories and catalogs.

use super::bad::changed_in;
use super::worlds::file;
use paracosm_engine::Program;
use paracosm_space::constraint::Expression;
use paracosm_space::{Domain, Value};
use paracosm_standards::openscenario::Xosc;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

const GAP: &str = "name=\"gap\" parameterType=\"double\" value=\"50\"";
const LENGTH: &str = "<ParameterDeclaration name=\"length\" parameterType=\"double\" value=\"5\"/>";
const ASSIGNED: &str = "parameterRef=\"length\" value=\"4\"";

/// Writes the scenario of the slow leader with changes in it, in its catalog, and in the file of a distribution.
fn changed(scenario: &[(&str, &str)], catalog: &[(&str, &str)], variation: &[(&str, &str)]) -> (TempDir, PathBuf) {
    let (folder, path) = changed_in("slow-leader.xosc", "<OpenSCENARIO>", "<OpenSCENARIO>");
    let path = |name: &str| if name == "slow-leader.xosc" { path.clone() } else { folder.path().join(name) };
    fs::copy(file("slow-leader-variation.xosc"), path("variation.xosc")).unwrap();
    let scenario_of_variation = [("slow-leader.xosc", "bad.xosc")];
    for (name, changes) in [
        ("slow-leader.xosc", scenario),
        ("catalogs/entities.xosc", catalog),
        ("variation.xosc", &scenario_of_variation),
        ("variation.xosc", variation),
    ] {
        let mut text = fs::read_to_string(path(name)).unwrap();
        for (found, by) in changes {
            assert!(text.contains(found), "{found}");
            text = text.replacen(found, by, 1);
        }
        fs::write(path(name), text).unwrap();
    }
    let read = path(if variation.is_empty() { "slow-leader.xosc" } else { "variation.xosc" });
    (folder, read)
}

fn program(scenario: &[(&str, &str)], catalog: &[(&str, &str)], variation: &[(&str, &str)]) -> Result<Program, String> {
    let (folder, path) = changed(scenario, catalog, variation);
    let read = Xosc::read(&path).map(Xosc::program);
    read.map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

#[track_caller]
fn refuses(scenario: &[(&str, &str)], catalog: &[(&str, &str)], variation: &[(&str, &str)], says: &str) {
    let message = program(scenario, catalog, variation).expect_err("it was accepted");
    assert!(message.contains(says), "expected `{says}` in: {message}");
}

/// Returns the names of the parameters of each constraint, and the answer to a test with these values.
fn checked(program: &Program, values: &[(&str, f64)]) -> (Vec<Vec<String>>, Result<(), String>) {
    let declaration = program.declare().unwrap();
    let mut test = declaration.nominal();
    for (name, value) in values {
        test.set(*name, Value::Number(*value));
    }
    let names = |expression: &Expression| expression.names().into_iter().map(str::to_owned).collect();
    let names = declaration.constraints.iter().map(|constraint| names(&constraint.expression)).collect();
    (names, program.check(&test).map_err(|error| error.to_string()))
}

#[test]
fn a_declared_value_has_the_type_of_its_parameter() {
    for (kind, value, expected) in [
        ("int", "50.5", "a whole number from -2147483648 to 2147483647"),
        ("integer", "50.5", "a whole number from -2147483648 to 2147483647"),
        ("unsignedInt", "-1", "a whole number from 0 to 4294967295"),
        ("unsignedShort", "65536", "a whole number from 0 to 65535"),
        ("double", "near", "a finite number"),
        ("double", "NaN", "a finite number"),
        ("boolean", "yes", "true or false"),
        ("dateTime", "noon", "a time such as 2026-01-31T12:00:00"),
    ] {
        let by = format!("name=\"gap\" parameterType=\"{kind}\" value=\"{value}\"");
        let says =
            format!("bad.xosc:11: `value=\"{value}\"` of <ParameterDeclaration> is not allowed, expected {expected}");
        refuses(&[(GAP, &by)], &[], &[], &says);
    }
    refuses(&[("\"double\" value=\"50\"", "\"integr\" value=\"50\"")], &[], &[], "did you mean `integer`?");
    refuses(&[("parameterType=\"double\" value=\"50\"", "value=\"50\"")], &[], &[], "no attribute `parameterType`");
}

#[test]
fn a_distribution_has_values_of_the_type_of_its_parameter() {
    let whole = [(GAP, "name=\"gap\" parameterType=\"unsignedShort\" value=\"50\"")];
    let expected = "is not allowed, expected a whole number from 0 to 65535";
    refuses(
        &whole,
        &[],
        &[("<Element value=\"20\"/>", "<Element value=\"20.5\"/>")],
        &format!("variation.xosc:11: `value=\"20.5\"` of <Element> {expected}"),
    );
    let range = |step: &str, lower: &str| {
        format!(
            "<DistributionRange stepWidth=\"{step}\"><Range lowerLimit=\"{lower}\" upperLimit=\"50\"/></DistributionRange>"
        )
    };
    let set = "<DistributionSet><Element value=\"20\"/><Element value=\"50\"/></DistributionSet>";
    refuses(
        &whole,
        &[],
        &[(set, &range("0.5", "20"))],
        &format!("variation.xosc:11: `stepWidth=\"0.5\"` of <DistributionRange> {expected}"),
    );
    refuses(
        &whole,
        &[],
        &[(set, &range("10", "-20"))],
        &format!("variation.xosc:11: `lowerLimit=\"-20\"` of <Range> {expected}"),
    );
    let text = [(GAP, "name=\"gap\" parameterType=\"string\" value=\"50\"")];
    refuses(&text, &[], &[(set, &range("10", "20"))], "expected a parameter whose type is a number");
    let program = program(&whole, &[], &[(set, &range("10", "20"))]).unwrap();
    let gap =
        program.declare().unwrap().parameters.into_iter().find(|declared| declared.parameter.name == "gap").unwrap();
    let levels = [20.0, 30.0, 40.0, 50.0].map(Value::Number).to_vec();
    assert_eq!((gap.whole, gap.opened().domain), (true, Domain::Choice(levels)));
}

#[test]
fn a_set_has_each_value_once_and_a_range_goes_up() {
    for (found, by, says) in [
        (
            "<Element value=\"20\"/><Element value=\"50\"/>",
            "<Element value=\"20\"/><Element value=\"20.0\"/>",
            "variation.xosc:11: `value=\"20.0\"` of <Element> is not allowed, expected a value that the set does not have yet",
        ),
        (
            "lowerLimit=\"20\" upperLimit=\"60\"",
            "lowerLimit=\"60\" upperLimit=\"20\"",
            "variation.xosc:8: `upperLimit=\"20\"` of <Range> is not allowed, expected a number of at least 60",
        ),
        (
            "filepath=\"bad.xosc\"",
            "filepath=\"catalogs\"",
            "variation.xosc:5: `filepath=\"catalogs\"` of <ScenarioFile> is not allowed, expected a file that exists",
        ),
        (
            "filepath=\"bad.xosc\"",
            "filepath=\"variation.xosc\"",
            "variation.xosc:2: <OpenSCENARIO> contains no <Storyboard>",
        ),
    ] {
        refuses(&[], &[], &[(found, by)], says);
    }
}

#[test]
fn an_entry_of_a_catalog_that_refers_to_itself_is_refused() {
    let place = |kind: &str, name: &str, at: &str| {
        format!(
            "<{kind}Position{at}><{kind}Ref><CatalogReference catalogName=\"entities\" entryName=\"{name}\"/></{kind}Ref>"
        )
    };
    let on_route = |name: &str| {
        let from = "<InRoutePosition><FromRoadCoordinates pathS=\"1\" t=\"0\"/></InRoutePosition></RoutePosition>";
        format!("{}{from}", place("Route", name, ""))
    };
    let on_trajectory = |name: &str| format!("{}</TrajectoryPosition>", place("Trajectory", name, " s=\"1\" t=\"0\""));
    let lane = "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"/>";
    let catalog = "<VehicleCatalog><Directory path=\"catalogs\"/></VehicleCatalog>";
    let all = [catalog, &catalog.replace("Vehicle", "Route"), &catalog.replace("Vehicle", "Trajectory")].concat();
    let route = |name: &str, next: &str| {
        let waypoint =
            |position: &str| format!("<Waypoint routeStrategy=\"shortest\"><Position>{position}</Position></Waypoint>");
        format!("<Route name=\"{name}\" closed=\"false\">{}{}</Route>", waypoint(&on_route(next)), waypoint(lane))
    };
    let vertex = |position: &str| format!("<Vertex><Position>{position}</Position></Vertex>");
    let trajectory = format!(
        "<Trajectory name=\"self\" closed=\"false\"><Shape><Polyline>{}{}</Polyline></Shape></Trajectory>",
        vertex(&on_trajectory("self")),
        vertex(lane)
    );
    let entries = [
        route("one", "two"),
        "\n".to_owned(),
        route("two", "one"),
        "\n".to_owned(),
        trajectory,
        "</Catalog>".to_owned(),
    ]
    .concat();
    for (position, name) in [(on_route("one"), "one"), (on_trajectory("self"), "self")] {
        let says = format!(
            "`entryName=\"{name}\"` of <CatalogReference> is not allowed, expected an entry that does not refer to itself"
        );
        refuses(&[(catalog, &all), (lane, &position)], &[("</Catalog>", &entries)], &[], &says);
    }
}

#[test]
fn a_whole_number_has_no_distribution_over_an_interval_and_no_set_with_fractions() {
    for (name, found, by, says) in [
        (
            "slow-leader-chances.xosc",
            "name=\"speed\" parameterType=\"double\"",
            "name=\"speed\" parameterType=\"integer\"",
            "`parameterName=\"speed\"` of <StochasticDistribution> is not allowed, expected a parameter of the type double",
        ),
        (
            "slow-leader-tuples.xosc",
            "name=\"gap\" parameterType=\"double\"",
            "name=\"gap\" parameterType=\"boolean\"",
            "of <ParameterAssignment> is not allowed, expected true or false",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let scenario = fs::read_to_string(file("slow-leader.xosc")).unwrap();
        let scenario =
            scenario.replacen(found, by, 1).replacen("\"boolean\" value=\"50\"", "\"boolean\" value=\"1\"", 1);
        fs::write(folder.path().join("slow-leader.xosc"), scenario).unwrap();
        fs::copy(file(name), folder.path().join(name)).unwrap();
        let message = Xosc::read(&folder.path().join(name)).err().expect("it is refused").to_string();
        assert!(message.contains(name) && message.contains(says), "{message}");
    }
}

#[test]
fn closed_whole_numbers_and_truths_take_their_values_alone() {
    let scenario = [
        (GAP, "name=\"gap\" parameterType=\"unsignedShort\" value=\"50\""),
        ("name=\"start\"", "name=\"wet\" parameterType=\"boolean\" value=\"1\"/><ParameterDeclaration name=\"start\""),
    ];
    let declaration = program(&scenario, &[], &[]).unwrap().declare().unwrap();
    let declared = |name: &str| declaration.parameters.iter().find(|one| one.parameter.name == name).unwrap();
    let gap = |value: f64| declared("gap").check(&Value::Number(value)).map_err(|error| error.to_string());
    assert_eq!(gap(65_535.0), Ok(()));
    assert_eq!(gap(20.5), Err("parameter `gap`: found 20.5, expected a whole number".to_owned()));
    for value in [-1.0, 65_536.0] {
        assert!(
            gap(value).is_err_and(|message| message.contains("[0, 65535]") || message.contains("0..65535")),
            "{value}"
        );
    }
    assert_eq!(declared("wet").nominal(), Value::from("true"));
    assert!(declared("wet").check(&Value::from("yes")).is_err());
}

#[test]
fn a_whole_number_that_follows_from_others_is_a_constraint_between_them() {
    let start = "name=\"start\" parameterType=\"double\" value=\"${$gap + 10}\"";
    let whole = "name=\"start\" parameterType=\"integer\" value=\"${$gap / 2 + 60}\"";
    let program = program(&[(start, whole)], &[], &[]).unwrap();
    let (names, even) = checked(&program, &[("gap", 40.0)]);
    assert_eq!((names, even), (vec![vec!["speed".to_owned()], vec!["gap".to_owned()]], Ok(())));
    let message = checked(&program, &[("gap", 41.0)]).1.unwrap_err();
    assert!(message.contains("bad.xosc:12: the constraint `(gap / 2 + 60) % 1 == 0 and"), "{message}");
}

#[test]
fn an_assignment_to_a_parameter_of_a_catalog_has_its_type_and_keeps_its_constraints() {
    let whole = [(LENGTH, "<ParameterDeclaration name=\"length\" parameterType=\"int\" value=\"5\"/>")];
    refuses(
        &[(ASSIGNED, "parameterRef=\"length\" value=\"4.5\"")],
        &whole,
        &[],
        "bad.xosc:22: `value=\"4.5\"` of <ParameterAssignment> is not allowed, expected a whole number",
    );
    let limited = |value: &str| {
        format!(
            "<ParameterDeclaration name=\"length\" parameterType=\"double\" value=\"{value}\"><ConstraintGroup>\
             <ValueConstraint rule=\"lessOrEqual\" value=\"4.5\"/></ConstraintGroup></ParameterDeclaration>"
        )
    };
    // The ego vehicle has the value of the declaration.
    refuses(
        &[],
        &[(LENGTH, &limited("5"))],
        &[],
        "entities.xosc:6: `value=\"5\"` of <ParameterDeclaration> is not allowed, expected a value that is at most 4.5",
    );
    refuses(
        &[(ASSIGNED, "parameterRef=\"length\" value=\"6\"")],
        &[(LENGTH, &limited("4"))],
        &[],
        "bad.xosc:22: `value=\"6\"` of <ParameterAssignment> is not allowed, expected a value that is at most 4.5",
    );
    refuses(
        &[(ASSIGNED, "parameterRef=\"lenght\" value=\"4\"")],
        &[],
        &[],
        "bad.xosc:22: `parameterRef=\"lenght\"` of <ParameterAssignment> names no declared parameter of the file (did you mean `length`?)",
    );
    assert!(program(&[], &[(LENGTH, &limited("4"))], &[]).is_ok());
}

#[test]
fn constraints_of_catalogs_and_stories_are_constraints_between_the_parameters_behind_them() {
    let limited = "<ParameterDeclaration name=\"length\" parameterType=\"double\" value=\"4\"/>\
        <ParameterDeclaration name=\"half\" parameterType=\"double\" value=\"${$length / 2}\"><ConstraintGroup>\
        <ValueConstraint rule=\"lessOrEqual\" value=\"3\"/></ConstraintGroup></ParameterDeclaration>";
    let story = "<Story name=\"story\"><ParameterDeclarations><ParameterDeclaration name=\"own\" parameterType=\"double\" \
        value=\"$speed\"><ConstraintGroup><ValueConstraint rule=\"notEqualTo\" value=\"$gap\"/></ConstraintGroup>\
        </ParameterDeclaration></ParameterDeclarations>";
    let scenario = [(ASSIGNED, "parameterRef=\"length\" value=\"${$gap / 10}\""), ("<Story name=\"story\">", story)];
    let program = program(&scenario, &[(LENGTH, limited)], &[]).unwrap();
    let (mut names, nominal) = checked(&program, &[]);
    names.iter_mut().for_each(|names| names.sort());
    assert_eq!(names, [vec!["speed"], vec!["gap"], vec!["gap", "speed"]]);
    assert_eq!(nominal, Ok(()));
    // The length is 7 m, and half of it follows from the assigned value.
    let message = checked(&program, &[("gap", 70.0)]).1.unwrap_err();
    assert!(
        message.contains("entities.xosc:6: the constraint `gap / 10 / 2 <= 3` does not hold for gap = 70"),
        "{message}"
    );
    let message = checked(&program, &[("gap", 30.0)]).1.unwrap_err();
    assert!(message.contains("the constraint `speed != gap` does not hold for speed = 30, gap = 30"), "{message}");
}

#[test]
fn constraints_on_parameters_that_name_each_other_very_often_are_refused() {
    let last =
        "<ConstraintGroup><ValueConstraint rule=\"lessThan\" value=\"1\"/></ConstraintGroup></ParameterDeclaration>";
    let declared = |count: usize, value: &dyn Fn(usize) -> String| {
        let mut text =
            "<ParameterDeclarations><ParameterDeclaration name=\"p0\" parameterType=\"double\" value=\"0\"/>"
                .to_owned();
        for i in 1..=count {
            let end = if i < count { "/>".to_owned() } else { format!(">{last}") };
            text += &format!(
                "<ParameterDeclaration name=\"p{i}\" parameterType=\"double\" value=\"{}\"{end}",
                value(i - 1)
            );
        }
        text
    };
    let twice = |count| declared(count, &|i| format!("${{$p{i} + $p{i}}}"));
    let next = |count| declared(count, &|i| format!("${{$p{i} + 0}}"));
    assert!(program(&[("<ParameterDeclarations>", &twice(8))], &[], &[]).is_ok());
    assert!(program(&[("<ParameterDeclarations>", &next(400))], &[], &[]).is_ok());
    for text in [twice(60), next(3000)] {
        refuses(&[("<ParameterDeclarations>", &text)], &[], &[], "bad.xosc:4: ");
        refuses(&[("<ParameterDeclarations>", &text)], &[], &[], "it has more than 500 operators");
    }
}

#[test]
fn a_limit_of_another_type_and_a_name_that_is_taken_are_refused_with_their_lines() {
    for (found, by, says) in [
        (
            "rule=\"lessOrEqual\" value=\"50\"",
            "rule=\"lessOrEqual\" value=\"x\"",
            "bad.xosc:8: `value=\"x\"` of <ValueConstraint> is not allowed, expected a finite number",
        ),
        (
            "<ParameterDeclaration name=\"gap\"",
            "<ParameterDeclaration name=\"speed\"",
            "bad.xosc:11: `name=\"speed\"` of <ParameterDeclaration> is not allowed, expected a name that no other parameter has",
        ),
    ] {
        refuses(&[(found, by)], &[], &[], says);
    }
}

#[test]
fn the_values_of_a_range_have_the_decimals_of_the_file() {
    let set = "<DistributionSet><Element value=\"20\"/><Element value=\"50\"/></DistributionSet>";
    for (lower, step, upper, expected) in [
        ("0", "0.3", "1", vec![0.0, 0.3, 0.6, 0.9]),
        ("0.1", "0.1", "0.5", vec![0.1, 0.2, 0.3, 0.4, 0.5]),
        ("-0.05", "0.025", "0.05", vec![-0.05, -0.025, 0.0, 0.025, 0.05]),
        ("1e0", "5e-1", "2", vec![1.0, 1.5, 2.0]),
    ] {
        let range = format!(
            "<DistributionRange stepWidth=\"{step}\"><Range lowerLimit=\"{lower}\" upperLimit=\"{upper}\"/></DistributionRange>"
        );
        let program = program(&[], &[], &[(set, &range)]).unwrap();
        let declared = program.declare().unwrap().parameters;
        let gap = declared.into_iter().find(|declared| declared.parameter.name == "gap").unwrap();
        let levels = expected.into_iter().map(Value::Number).collect();
        assert_eq!(gap.opened().domain, Domain::Choice(levels), "{lower} {step} {upper}");
    }
}
