//! Values against the standard are refused, with the place of the value.

use super::strict::{message_of, read, refuses};

const LEADER: &str = "slow-leader.xosc";
const ALL: &str = "everything.xosc";
const TUPLES: &str = "slow-leader-tuples.xosc";
const VARIATION: &str = "slow-leader-variation.xosc";

#[test]
fn distances_and_times_are_not_negative() {
    let says = "is not allowed, expected a number that is not negative";
    for (found, by, element) in [
        ("freespace=\"false\" value=\"58\"", "freespace=\"false\" value=\"-58\"", "RelativeDistanceCondition"),
        (
            "<TimeToCollisionCondition value=\"0.1\"",
            "<TimeToCollisionCondition value=\"-1\"",
            "TimeToCollisionCondition",
        ),
        ("entityRef=\"B\" value=\"1\"", "entityRef=\"B\" value=\"-1\"", "TimeHeadwayCondition"),
        ("<DistanceCondition value=\"1\"", "<DistanceCondition value=\"-1\"", "DistanceCondition"),
        ("Vertex time=\"4\"", "Vertex time=\"-4\"", "Vertex"),
        ("initialDistanceOffset=\"0\"", "initialDistanceOffset=\"-1\"", "FollowTrajectoryAction"),
    ] {
        refuses(ALL, found, by, &format!("of <{element}> {says}"));
    }
}

#[test]
fn a_variable_has_a_type_and_a_value_of_its_type() {
    refuses(
        ALL,
        "variableType=\"double\"",
        "variableType=\"dubble\"",
        "9: `variableType=\"dubble\"` of <VariableDeclaration>",
    );
    refuses(ALL, "variableType=\"double\"", "variableType=\"dubble\"", "did you mean `double`?");
    let by = "variableType=\"double\" value=\"many\"";
    let says = "9: `value=\"many\"` of <VariableDeclaration> is not allowed, expected a finite number";
    refuses(ALL, "variableType=\"double\" value=\"1\"", by, says);
}

#[test]
fn a_polyline_has_two_points_and_times_that_do_not_fall() {
    let second = "<Vertex time=\"4\"><Position><WorldPosition x=\"160\" y=\"4.25\" h=\"0\"/></Position></Vertex>";
    refuses(ALL, second, "", "160: <Polyline> has 1 point, expected at least 2");
    refuses(ALL, "Vertex time=\"4\"", "Vertex", "162: <Vertex> has no attribute `time`");
    refuses(
        ALL,
        "Vertex time=\"0\"",
        "Vertex time=\"5\"",
        "162: `time=\"4\"` of <Vertex> is not allowed, expected at least 5, the time of the vertex before",
    );
}

#[test]
fn a_route_has_two_waypoints() {
    let second = "<Waypoint routeStrategy=\"shortest\"><Position><LanePosition roadId=\"1\" laneId=\"-1\" s=\"50\"/></Position></Waypoint>";
    let route = "<AssignRouteAction><Route name=\"a\" closed=\"false\">";
    let actor = "<TeleportAction>";
    let one = format!(
        "<RoutingAction>{route}{second}</Route></AssignRouteAction></RoutingAction></PrivateAction><PrivateAction>{actor}"
    );
    refuses(LEADER, actor, &one, "29: <Route> has 1 waypoint, expected at least 2");
}

#[test]
fn a_distance_is_given_in_metres_or_in_seconds() {
    let distance = "entityRef=\"B\" distance=\"30\"";
    refuses(
        ALL,
        distance,
        "entityRef=\"B\" distance=\"30\" timeGap=\"2\"",
        "194: <LongitudinalDistanceAction> has both `distance` and `timeGap`, expected one of them",
    );
    refuses(
        ALL,
        distance,
        "entityRef=\"B\"",
        "194: <LongitudinalDistanceAction> has neither `distance` nor `timeGap`, expected one of them",
    );
}

#[test]
fn a_group_of_constraints_has_a_constraint() {
    refuses(
        LEADER,
        "<ConstraintGroup>",
        "<ConstraintGroup/><ConstraintGroup>",
        "6: <ConstraintGroup> contains no <ValueConstraint>",
    );
}

#[test]
fn words_have_no_order() {
    let found = "<SimulationTimeCondition value=\"1\" rule=\"greaterOrEqual\"/>";
    let by = "<ParameterCondition parameterRef=\"gap\" value=\"far\" rule=\"equalTo\"/>";
    refuses(LEADER, found, by, "59: `value=\"far\"` of <ParameterCondition> is not allowed, expected a finite number");
    refuses(
        "actions.xosc",
        "parameterRef=\"mode\" value=\"slow\" rule=\"equalTo\"",
        "parameterRef=\"mode\" value=\"slow\" rule=\"lessThan\"",
        "of <ParameterCondition> is not allowed, expected equalTo or notEqualTo, because `slow` is no number",
    );
}

#[test]
fn absurd_magnitudes_are_refused() {
    let most = "expected a magnitude of at most";
    let lane = "laneId=\"-1\" s=\"10\"";
    refuses(
        LEADER,
        lane,
        &format!("{lane} offset=\"1e300\""),
        &format!("29: `offset=\"1e300\"` of <LanePosition> is not allowed, {most} 1000000000"),
    );
    refuses(
        LEADER,
        "value=\"$speed\"",
        "value=\"1e308\"",
        &format!("32: `value=\"1e308\"` of <AbsoluteTargetSpeed> is not allowed, {most} 1000000"),
    );
}

#[test]
fn a_place_in_a_message_has_few_digits() {
    let by = "value=\"${$gap * 1.1 + 1000.3}\"";
    refuses(
        LEADER,
        "value=\"${$gap + 10}\"",
        by,
        "`s=\"1055.3\"` of <LanePosition> is not allowed, expected a place on road `1`, which is 1000 m long",
    );
}

#[test]
fn a_distribution_has_values() {
    for (name, found, by, says) in [
        (
            VARIATION,
            "<Element value=\"20\"/><Element value=\"50\"/>",
            "",
            "11: <DistributionSet> contains no <Element>",
        ),
        (
            TUPLES,
            "<ParameterAssignment parameterRef=\"gap\" value=\"20\"/>",
            "<ParameterAssignment parameterRef=\"speed\" value=\"25\"/>",
            "11: `parameterRef=\"speed\"` of <ParameterAssignment> is not allowed, expected a parameter to which the set has not assigned a value yet",
        ),
    ] {
        let message = message_of(name, found, by);
        assert!(message.starts_with(&format!("{name}:{says}")), "{message}");
    }
    let tuples = std::fs::read_to_string(super::worlds::file(TUPLES)).unwrap();
    let within = |tag: &str| {
        let (open, close) = (format!("<{tag}>"), format!("</{tag}>"));
        let from = tuples.find(&open).unwrap() + open.len();
        let to = tuples.find(&close).unwrap();
        tuples[from..to].to_owned()
    };
    let message = message_of(TUPLES, &within("ValueSetDistribution"), "");
    assert!(
        message.starts_with(&format!("{TUPLES}:8: <ValueSetDistribution> contains no <ParameterValueSet>")),
        "{message}"
    );
    let message = message_of(TUPLES, &within("ParameterValueSet"), "");
    assert!(
        message.starts_with(&format!("{TUPLES}:9: <ParameterValueSet> contains no <ParameterAssignment>")),
        "{message}"
    );
}

#[test]
fn a_set_may_assign_its_parameters_in_another_order() {
    let assigned = |of: &str, value: &str| format!("<ParameterAssignment parameterRef=\"{of}\" value=\"{value}\"/>");
    let (speed, gap) = (assigned("speed", "30"), assigned("gap", "50"));
    let found = format!("{speed}\n            {gap}");
    let program = read(TUPLES, &found, &format!("{gap}{speed}")).unwrap().program();
    let declaration = program.declare().unwrap();
    let tuples = &declaration.parameters[0].parameter;
    assert_eq!((tuples.name.as_str(), tuples.default.clone()), ("speed|gap", Some("30|50".into())));
}
