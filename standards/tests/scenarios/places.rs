//! Places and lanes that a scenario names and that the map does not have, and entities without a place.

use super::bad::{changed_in, messages_of};
use super::worlds::led;
use paracosm_standards::openscenario::Xosc;

/// A condition of the ego vehicle.
fn stop_trigger(condition: &str) -> String {
    format!(
        "<StopTrigger><ConditionGroup><Condition name=\"there\" delay=\"0\" conditionEdge=\"none\"><ByEntityCondition>\
         <TriggeringEntities triggeringEntitiesRule=\"any\"><EntityRef entityRef=\"Ego\"/></TriggeringEntities>\
         <EntityCondition>{condition}</EntityCondition></ByEntityCondition></Condition></ConditionGroup>"
    )
}

/// The places that the map does not have, with the messages about them.
const PLACES: [(&str, &str); 6] = [
    (
        "<LanePosition roadId=\"nope\" laneId=\"-1\" s=\"10\"/>",
        "69: `roadId=\"nope\"` of <LanePosition> is not allowed, expected a road of the map: 1",
    ),
    (
        "<LanePosition roadId=\"1\" laneId=\"-9\" s=\"10\"/>",
        "69: `laneId=\"-9\"` of <LanePosition> is not allowed, expected a lane of road `1` at s = 10 m: -2, -1, 1, 2",
    ),
    (
        "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"5000\"/>",
        "69: `s=\"5000\"` of <LanePosition> is not allowed, expected a place on road `1`, which is 1000 m long",
    ),
    ("<LanePosition roadId=\"1\" laneId=\"-1\" s=\"-1\"/>", "69: `s=\"-1\"` of <LanePosition> is not allowed"),
    ("<RoadPosition roadId=\"12\" s=\"10\" t=\"0\"/>", "expected a road of the map: 1 (did you mean `1`?)"),
    ("<RoadPosition roadId=\"1\" s=\"1000.1\" t=\"0\"/>", "69: `s=\"1000.1\"` of <RoadPosition> is not allowed"),
];

#[test]
fn a_condition_on_a_place_that_does_not_exist_is_refused() {
    let stop = "<StopTrigger><ConditionGroup>";
    for (place, expected) in PLACES {
        for condition in [
            format!("<ReachPositionCondition tolerance=\"1\"><Position>{place}</Position></ReachPositionCondition>"),
            format!(
                "<DistanceCondition value=\"1\" rule=\"lessThan\" freespace=\"false\"><Position>{place}</Position>\
                 </DistanceCondition>"
            ),
            format!(
                "<TimeToCollisionCondition value=\"1\" rule=\"lessThan\" freespace=\"false\">\
                 <TimeToCollisionConditionTarget><Position>{place}</Position></TimeToCollisionConditionTarget>\
                 </TimeToCollisionCondition>"
            ),
        ] {
            let by = format!("{}<ConditionGroup>", stop_trigger(&condition));
            let message = messages_of("slow-leader.xosc", stop, &by);
            assert!(message.contains(expected), "{condition}: {message}");
        }
    }
}

#[test]
fn an_action_of_a_story_at_a_place_that_does_not_exist_is_refused() {
    let activation = "<PrivateAction><ControllerAction>\n                <ActivateControllerAction lateral=\"true\" \
                      longitudinal=\"true\"/>\n              </ControllerAction></PrivateAction>";
    let place = "<Position><LanePosition roadId=\"nope\" laneId=\"-1\" s=\"10\"/></Position>";
    let sound = place.replace("nope", "1");
    let vertices = format!("<Vertex time=\"0\">{sound}</Vertex><Vertex time=\"1\">{place}</Vertex>");
    let target = |position: &str, name: &str| position.replace("Position>", &format!("{name}>"));
    for action in [
        format!("<PrivateAction><TeleportAction>{place}</TeleportAction></PrivateAction>"),
        format!(
            "<PrivateAction><RoutingAction><AcquirePositionAction>{place}</AcquirePositionAction></RoutingAction></PrivateAction>"
        ),
        format!(
            "<PrivateAction><RoutingAction><AssignRouteAction><Route name=\"r\" closed=\"false\">\
             <Waypoint routeStrategy=\"shortest\">{sound}</Waypoint><Waypoint routeStrategy=\"shortest\">{place}</Waypoint>\
             </Route></AssignRouteAction></RoutingAction></PrivateAction>"
        ),
        format!(
            "<PrivateAction><RoutingAction><FollowTrajectoryAction><TrajectoryRef><Trajectory name=\"t\" closed=\"false\">\
             <Shape><Polyline>{vertices}</Polyline></Shape></Trajectory></TrajectoryRef><TimeReference><None/></TimeReference>\
             <TrajectoryFollowingMode followingMode=\"position\"/></FollowTrajectoryAction></RoutingAction></PrivateAction>"
        ),
        format!(
            "<PrivateAction><SynchronizeAction masterEntityRef=\"Ego\">{}{}</SynchronizeAction></PrivateAction>",
            "<TargetPositionMaster><LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"/></TargetPositionMaster>",
            target("<Position><LanePosition roadId=\"nope\" laneId=\"-1\" s=\"10\"/></Position>", "TargetPosition")
                .replace("LaneTargetPosition", "LanePosition"),
        ),
        format!(
            "<GlobalAction><EntityAction entityRef=\"Leader\"><AddEntityAction>{place}</AddEntityAction></EntityAction></GlobalAction>"
        ),
    ] {
        let message = messages_of("slow-leader.xosc", activation, &action);
        assert!(message.contains("expected a road of the map: 1"), "{action}: {message}");
    }
}

#[test]
fn a_place_that_depends_on_the_test_is_checked_with_the_values_of_the_test() {
    let condition = "<ReachPositionCondition tolerance=\"1\"><Position><LanePosition roadId=\"1\" laneId=\"-1\" s=\"$gap\"/>\
                     </Position></ReachPositionCondition>";
    let by = format!("{}<ConditionGroup>", stop_trigger(condition));
    let (_folder, path) = changed_in("slow-leader.xosc", "<StopTrigger><ConditionGroup>", &by);
    let program = Xosc::read(&path).unwrap().program();
    let mut test = program.declare().unwrap().nominal();
    program.check(&test).unwrap();
    test.set("gap", 995.0);
    let message = program.check(&test).unwrap_err().to_string();
    // The leader begins 10 m further.
    assert!(message.contains("bad.xosc:36: `s=\"1005\"` of <LanePosition> is not allowed"), "{message}");
    test.set("gap", -1.0);
    let message = program.check(&test).unwrap_err().to_string();
    assert!(message.contains("bad.xosc:69: `s=\"-1\"` of <LanePosition> is not allowed"), "{message}");
}

#[test]
fn the_value_of_a_declaration_that_no_test_has_may_name_no_place() {
    // The tests have the gaps of the distribution.
    let (folder, path) = changed_in(
        "slow-leader.xosc",
        "name=\"gap\" parameterType=\"double\" value=\"50\"",
        "name=\"gap\" parameterType=\"double\" value=\"5000\"",
    );
    let text = std::fs::read_to_string(super::worlds::file("slow-leader-variation.xosc")).unwrap();
    let variation = folder.path().join("variation.xosc");
    std::fs::write(&variation, text.replace("slow-leader.xosc", "bad.xosc")).unwrap();
    let program = Xosc::read(&variation).unwrap().program();
    program.check(&program.declare().unwrap().nominal()).unwrap();
    let message = Xosc::read(&path).unwrap().program().declare().unwrap_err().to_string();
    assert!(message.contains("bad.xosc:36: `s=\"5010\"` of <LanePosition> is not allowed"), "{message}");
}

/// A change of the ego vehicle to a lane.
fn lane_change(lane: &str) -> String {
    format!(
        "<PrivateAction><LateralAction><LaneChangeAction>\
         <LaneChangeActionDynamics dynamicsShape=\"linear\" dynamicsDimension=\"time\" value=\"3\"/>\
         <LaneChangeTarget><AbsoluteTargetLane value=\"{lane}\"/></LaneChangeTarget></LaneChangeAction></LateralAction></PrivateAction>"
    )
}

const ACTIVATION: &str = "<PrivateAction><ControllerAction>\n                <ActivateControllerAction lateral=\"true\" \
                          longitudinal=\"true\"/>\n              </ControllerAction></PrivateAction>";

#[test]
fn a_change_to_a_lane_that_no_road_has_is_refused() {
    let message = messages_of("slow-leader.xosc", ACTIVATION, &lane_change("-77"));
    let expected = "55: `value=\"-77\"` of <AbsoluteTargetLane> is not allowed, expected a lane of the map, whose lanes are -2 to 2";
    assert!(message.contains(expected), "{message}");
}

#[test]
fn a_change_to_a_lane_that_only_another_road_has_ends_the_run_with_the_line_of_the_action() {
    let (folder, path) = changed_in("slow-leader.xosc", ACTIVATION, &lane_change("-3"));
    // Another road, far away, has three lanes.
    let roads = folder.path().join("straight.xodr");
    let text = std::fs::read_to_string(&roads).unwrap();
    let at = text.find("<road").unwrap();
    let end = text.find("</road>").unwrap() + "</road>".len();
    let third = "<lane id=\"-3\" type=\"driving\" level=\"false\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane></right>";
    let other = text[at..end]
        .replacen("id=\"1\"", "id=\"other\"", 1)
        .replace("y=\"0\"", "y=\"500\"")
        .replace("</right>", third);
    std::fs::write(&roads, format!("{}{other}{}", &text[..end], &text[end..])).unwrap();
    let program = Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program();
    let ending = format!("{:?}", led(&program).unwrap().ending);
    for expected in ["bad.xosc:55\"", "activation", "road `1` has no lane -3 at s = 40 m"] {
        assert!(ending.contains(expected), "{ending}");
    }
}

/// Returns the notes on a scenario.
fn notes(path: &std::path::Path) -> Vec<String> {
    let program = Xosc::read(path).unwrap_or_else(|error| panic!("{error}")).program();
    program.notes(&program.declare().unwrap().nominal())
}

/// The initial action that gives the leader its place.
const OF_LEADER: &str = "<PrivateAction><TeleportAction><Position><LanePosition roadId=\"1\" laneId=\"-1\" s=\"$start\"/></Position>\
                         </TeleportAction></PrivateAction>";

#[test]
fn an_entity_without_a_place_at_the_beginning_is_noted_with_its_line() {
    let (_folder, path) = changed_in("slow-leader.xosc", OF_LEADER, "");
    let notes = notes(&path);
    let expected = "bad.xosc:20: `Leader` begins at the place (0, 0), because no initial action gives it a place";
    assert!(notes.iter().any(|note| note.contains(expected)), "{notes:?}");
    let (_folder, path) = changed_in("slow-leader.xosc", "", "");
    assert!(!self::notes(&path).iter().any(|note| note.contains("begins at")));
}

#[test]
fn the_ego_vehicle_needs_a_place_at_the_beginning() {
    let of_ego = OF_LEADER.replace("$start", "10");
    let message = messages_of("slow-leader.xosc", &of_ego, "");
    let expected =
        "bad.xosc:19: the ego vehicle `Ego` has no place at the beginning, expected a TeleportAction of `Ego` in Init";
    assert!(message.contains(expected), "{message}");
}

#[test]
fn the_signals_of_an_entity_with_the_name_of_the_ego_vehicle_are_noted() {
    let (_folder, path) = changed_in("slow-leader.xosc", "", "");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"Leader\"", "\"car\"")).unwrap();
    let notes = notes(&path);
    let expected = "bad.xosc:20: the signals of the entity `car` are `car-2.*`, because `car` is the ego vehicle";
    assert!(notes.iter().any(|note| note.contains(expected)), "{notes:?}");
    let trace = led(&Xosc::read(&path).unwrap().program()).unwrap().trace.unwrap();
    assert!(trace.signal("car-2.x").is_some());
}

#[test]
fn a_clothoid_that_is_longer_than_any_road_is_refused_with_its_line() {
    let shape = |length: &str| {
        format!(
            "<PrivateAction><RoutingAction><FollowTrajectoryAction><TrajectoryRef><Trajectory name=\"t\" closed=\"false\">\
             <Shape><Clothoid curvature=\"0\" curvaturePrime=\"1e-9\" length=\"{length}\"><Position>\
             <LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"/></Position></Clothoid></Shape></Trajectory></TrajectoryRef>\
             <TimeReference><None/></TimeReference><TrajectoryFollowingMode followingMode=\"position\"/>\
             </FollowTrajectoryAction></RoutingAction></PrivateAction>"
        )
    };
    let message = messages_of("slow-leader.xosc", ACTIVATION, &shape("1e9"));
    let expected =
        "55: `length=\"1e9\"` of <Clothoid> is not allowed, expected at most 100000 m for the whole trajectory";
    assert!(message.contains(expected), "{message}");
    let (_folder, path) = changed_in("slow-leader.xosc", ACTIVATION, &shape("100000"));
    let begin = std::time::Instant::now();
    led(&Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program()).unwrap();
    assert!(begin.elapsed().as_secs() < 10, "{:?}", begin.elapsed());
}

#[test]
fn a_set_of_very_many_values_is_read_soon() {
    let (folder, _) = changed_in("slow-leader.xosc", "", "");
    std::fs::copy(super::worlds::file("slow-leader.xosc"), folder.path().join("slow-leader.xosc")).unwrap();
    let text = std::fs::read_to_string(super::worlds::file("slow-leader-variation.xosc")).unwrap();
    let all: String =
        (0..100_000).map(|number| format!("<Element value=\"{}\"/>\n", 1000.0 + 0.001 * f64::from(number))).collect();
    let path = folder.path().join("variation.xosc");
    std::fs::write(&path, text.replacen("<DistributionSet>", &format!("<DistributionSet>{all}"), 1)).unwrap();
    let begin = std::time::Instant::now();
    let program = Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program();
    program.check(&program.declare().unwrap().nominal()).unwrap();
    assert!(begin.elapsed().as_secs() < 10, "{:?}", begin.elapsed());
}

/// Adds a road to the map of a folder, to which the first road does not lead.
fn add_second_road(folder: &std::path::Path) {
    let map = folder.join("straight.xodr");
    let text = std::fs::read_to_string(&map).unwrap();
    let (start, close) = (text.find("<road ").unwrap(), text.find("</road>").unwrap() + "</road>".len());
    let second = text[start..close].replacen("id=\"1\"", "id=\"2\"", 1).replacen(" y=\"0", " y=\"500", 1);
    std::fs::write(&map, format!("{}{second}{}", &text[..close], &text[close..])).unwrap();
}

fn waypoint(position: &str) -> String {
    format!("<Waypoint routeStrategy=\"shortest\"><Position>{position}</Position></Waypoint>")
}

#[test]
fn a_route_or_a_target_of_an_action_without_a_way_is_refused() {
    let here = waypoint("<LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"/>");
    let there = waypoint("<LanePosition roadId=\"2\" laneId=\"-1\" s=\"10\"/>");
    let assign =
        format!("<AssignRouteAction><Route name=\"r\" closed=\"false\">{here}{there}</Route></AssignRouteAction>");
    let acquire =
        "<AcquirePositionAction><Position><WorldPosition x=\"9000\" y=\"9000\"/></Position></AcquirePositionAction>";
    for (action, expected) in
        [(&*assign, "no road leads from road `1` to road `2`"), (acquire, "the way leads to a place beside all roads")]
    {
        let by = format!("<PrivateAction><RoutingAction>{action}</RoutingAction></PrivateAction>");
        let (folder, path) = changed_in("slow-leader.xosc", ACTIVATION, &by);
        add_second_road(folder.path());
        let declared = Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program().declare();
        let message = declared.unwrap_err().to_string();
        let says = format!("bad.xosc:55: the action `activation` cannot begin: {expected}");
        assert!(message.contains(&says), "{message}");
    }
}

#[test]
fn a_condition_on_a_place_of_a_route_without_a_way_is_refused() {
    let [here, there] = [10, 400].map(|s| waypoint(&format!("<LanePosition roadId=\"1\" laneId=\"-1\" s=\"{s}\"/>")));
    let [other, beside] =
        ["<LanePosition roadId=\"2\" laneId=\"-1\" s=\"10\"/>", "<WorldPosition x=\"9000\" y=\"9000\"/>"].map(waypoint);
    let relative = waypoint("<RelativeObjectPosition entityRef=\"Leader\" dx=\"9000\" dy=\"0\"/>");
    for (end, expected) in [
        (there, None),
        (relative, None),
        (other, Some("no road leads from road `1` to road `2`")),
        (beside, Some("a waypoint of the route is beside all roads")),
    ] {
        let condition = format!(
            "<ReachPositionCondition tolerance=\"1\"><Position><RoutePosition><RouteRef><Route name=\"r\" closed=\"false\">\
             {here}{end}</Route></RouteRef><InRoutePosition><FromRoadCoordinates pathS=\"20\" t=\"0\"/></InRoutePosition>\
             </RoutePosition></Position></ReachPositionCondition>"
        );
        let by = format!("{}<ConditionGroup>", stop_trigger(&condition));
        let (folder, path) = changed_in("slow-leader.xosc", "<StopTrigger><ConditionGroup>", &by);
        add_second_road(folder.path());
        let declared = Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program().declare();
        match expected {
            None => assert!(declared.is_ok(), "{declared:?}"),
            Some(expected) => {
                let message = declared.unwrap_err().to_string();
                let says = format!(
                    "bad.xosc:69: the condition `there` never holds, because its position has no place: {expected}"
                );
                assert!(message.contains(&says), "{message}");
            }
        }
    }
}
