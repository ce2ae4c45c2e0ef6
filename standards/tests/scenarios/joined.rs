//! Roads that join, well or badly: entities that go from one to the next, and distances across the joint.

use super::worlds::{at, driven_by, led};
use paracosm_oracles::Trace;
use paracosm_standards::openscenario::Xosc;
use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A lane of 3.5 m with links to lanes before and after.
fn lane(number: i32, successor: &str) -> String {
    let link =
        if successor.is_empty() { String::new() } else { format!("<link><successor id=\"{successor}\"/></link>") };
    format!(
        "<lane id=\"{number}\" type=\"driving\">{link}<width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
    )
}

fn section(s: f64, left: &str, right: &str) -> String {
    let side =
        |name: &str, lanes: &str| if lanes.is_empty() { String::new() } else { format!("<{name}>{lanes}</{name}>") };
    let (left, right) = (side("left", left), side("right", right));
    format!("<laneSection s=\"{s}\">{left}<center><lane id=\"0\" type=\"none\"/></center>{right}</laneSection>")
}

/// A straight road of 100 m from a place.
fn road(id: u32, [x, y, heading]: [f64; 3], link: &str, sections: &str) -> String {
    format!(
        "<road id=\"{id}\" length=\"100\" junction=\"-1\"><link>{link}</link><planView><geometry s=\"0\" x=\"{x}\" y=\"{y}\" \
         hdg=\"{heading}\" length=\"100\"><line/></geometry></planView><lanes>{sections}</lanes></road>"
    )
}

fn follows(id: u32, contact: &str) -> String {
    format!("<successor elementType=\"road\" elementId=\"{id}\" contactPoint=\"{contact}\"/>")
}

/// Two roads in a line whose directions are against each other.
fn against() -> String {
    let first = section(0.0, "", &lane(-1, "1"));
    let second = section(0.0, &lane(1, "-1"), "");
    road(1, [0.0; 3], &follows(2, "end"), &first) + &road(2, [200.0, 0.0, PI], &follows(1, "end"), &second)
}

fn speed(metres: f64) -> String {
    format!(
        "<LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape=\"step\" dynamicsDimension=\"time\" value=\"0\"/>\
         <SpeedActionTarget><AbsoluteTargetSpeed value=\"{metres}\"/></SpeedActionTarget></SpeedAction></LongitudinalAction>"
    )
}

/// A scenario on roads, with entities that have a place and a speed, and actions of entities that begin at 0.5 s.
struct Scene<'a> {
    roads: String,
    entities: &'a [(&'a str, &'a str, f64)],
    actions: &'a [(&'a str, String)],
    /// A condition that ends the run.
    stop: &'a str,
}

impl Scene<'_> {
    fn write(&self) -> (TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let header = "<OpenDRIVE><header revMajor=\"1\" revMinor=\"7\"/>";
        fs::write(folder.path().join("roads.xodr"), format!("{header}{}</OpenDRIVE>", self.roads)).unwrap();
        let vehicle = |name: &str| {
            format!(
                "<ScenarioObject name=\"{name}\"><Vehicle name=\"car\" vehicleCategory=\"car\"><BoundingBox><Center x=\"1.4\" \
                 y=\"0\" z=\"0.75\"/><Dimensions width=\"2\" length=\"4\" height=\"1.5\"/></BoundingBox><Performance \
                 maxSpeed=\"70\" maxDeceleration=\"10\" maxAcceleration=\"10\"/><Axles><FrontAxle maxSteering=\"0.5\" \
                 wheelDiameter=\"0.6\" trackWidth=\"1.6\" positionX=\"2.8\" positionZ=\"0.3\"/><RearAxle maxSteering=\"0\" \
                 wheelDiameter=\"0.6\" trackWidth=\"1.6\" positionX=\"0\" positionZ=\"0.3\"/></Axles></Vehicle></ScenarioObject>"
            )
        };
        let entities: String = self.entities.iter().map(|(name, ..)| vehicle(name)).collect();
        let place = |(name, place, metres): &(&str, &str, f64)| {
            format!(
                "<Private entityRef=\"{name}\"><PrivateAction><TeleportAction><Position>{place}</Position></TeleportAction>\
                 </PrivateAction><PrivateAction>{}</PrivateAction></Private>",
                speed(*metres)
            )
        };
        let places: String = self.entities.iter().map(place).collect();
        let group = |(name, action): &(&str, String)| {
            format!(
                "<ManeuverGroup name=\"{name}\" maximumExecutionCount=\"1\"><Actors selectTriggeringEntities=\"false\">\
                 <EntityRef entityRef=\"{name}\"/></Actors><Maneuver name=\"{name}\"><Event name=\"{name}\" priority=\"parallel\">\
                 <Action name=\"{name} acts\"><PrivateAction>{action}</PrivateAction></Action><StartTrigger><ConditionGroup>\
                 <Condition name=\"begins\" delay=\"0\" conditionEdge=\"none\"><ByValueCondition><SimulationTimeCondition \
                 value=\"0.5\" rule=\"greaterOrEqual\"/></ByValueCondition></Condition></ConditionGroup></StartTrigger></Event>\
                 </Maneuver></ManeuverGroup>"
            )
        };
        let groups: String = self.actions.iter().map(group).collect();
        let story = if groups.is_empty() {
            String::new()
        } else {
            format!("<Story name=\"story\"><Act name=\"act\">{groups}<StartTrigger/></Act></Story>")
        };
        let condition = |inner: &str| {
            format!(
                "<ConditionGroup><Condition name=\"ends\" delay=\"0\" conditionEdge=\"none\">{inner}</Condition></ConditionGroup>"
            )
        };
        let end = condition(
            "<ByValueCondition><SimulationTimeCondition value=\"8\" rule=\"greaterOrEqual\"/></ByValueCondition>",
        );
        let measured = if self.stop.is_empty() {
            String::new()
        } else {
            condition(&format!(
                "<ByEntityCondition><TriggeringEntities triggeringEntitiesRule=\"any\"><EntityRef entityRef=\"Ego\"/>\
                 </TriggeringEntities><EntityCondition>{}</EntityCondition></ByEntityCondition>",
                self.stop
            ))
        };
        let text = format!(
            "<OpenSCENARIO><FileHeader revMajor=\"1\" revMinor=\"2\" date=\"2026-11-27T00:00:00\" description=\"\" author=\"\"/>\
             <CatalogLocations/><RoadNetwork><LogicFile filepath=\"roads.xodr\"/></RoadNetwork><Entities>{entities}</Entities>\
             <Storyboard><Init><Actions>{places}</Actions></Init>{story}<StopTrigger>{measured}{end}</StopTrigger></Storyboard>\
             </OpenSCENARIO>"
        );
        let path = folder.path().join("scene.xosc");
        fs::write(&path, text).unwrap();
        (folder, path)
    }

    fn tried(&self) -> Result<Trace, String> {
        let (_folder, path) = self.write();
        traced(&path)
    }

    /// Runs the scene with a pedestrian as `T`.
    fn with_pedestrian(&self) -> Result<Trace, String> {
        let pedestrian = "<Pedestrian mass=\"70\" name=\"p\" pedestrianCategory=\"pedestrian\"><BoundingBox><Center x=\"0\" \
                          y=\"0\" z=\"0.9\"/><Dimensions width=\"0.5\" length=\"0.5\" height=\"1.8\"/></BoundingBox></Pedestrian>";
        let (_folder, path) = self.write();
        let text = fs::read_to_string(&path).unwrap();
        let named = "<ScenarioObject name=\"T\">";
        let from = text.find(named).unwrap() + named.len();
        let to = from + text[from..].find("</ScenarioObject>").unwrap();
        fs::write(&path, format!("{}{pedestrian}{}", &text[..from], &text[to..])).unwrap();
        traced(&path)
    }

    fn run(&self) -> Trace {
        self.tried().unwrap_or_else(|error| panic!("{error}"))
    }

    /// Returns the seconds after which the run ends.
    fn end(&self) -> f64 {
        let trace = self.run();
        (trace.len() - 1) as f64 * trace.dt()
    }
}

fn traced(path: &Path) -> Result<Trace, String> {
    let program = Xosc::read(path).map_err(|error| error.to_string())?.program();
    let outcome = led(&program).map_err(|error| error.to_string())?;
    outcome.trace.ok_or_else(|| format!("{:?}", outcome.ending))
}

const EGO: (&str, &str, f64) = ("Ego", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"10\"/>", 10.0);

/// Returns the places of an entity every 0.01 s.
fn ways(trace: &Trace, name: &str) -> Vec<[f64; 2]> {
    let [x, y] = ["x", "y"].map(|axis| trace.signal(&format!("{name}.{axis}")).unwrap().collect::<Vec<_>>());
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
}

#[track_caller]
fn moves_without_jumps(trace: &Trace, name: &str) {
    for pair in ways(trace, name).windows(2) {
        let metres = libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
        assert!(metres <= 0.11, "{name} jumps by {metres} m from {:?}", pair[0]);
    }
}

#[test]
fn an_entity_goes_straight_on_where_its_lane_ends() {
    let both = format!("{}{}", lane(-1, "-1"), lane(-2, ""));
    let within = section(0.0, "", &both) + &section(50.0, "", &lane(-1, ""));
    let next = road(1, [0.0; 3], &follows(2, "start"), &section(0.0, "", &both))
        + &road(2, [100.0, 0.0, 0.0], "", &section(0.0, "", &lane(-1, "")));
    for roads in [road(1, [0.0; 3], "", &within), next] {
        let ending = ("T", "<LanePosition roadId=\"1\" laneId=\"-2\" s=\"30\"/>", 10.0);
        let trace = Scene { roads, entities: &[EGO, ending], actions: &[], stop: "" }.run();
        moves_without_jumps(&trace, "T");
        let y = at(&trace, "T.y", 6.9);
        assert!((y + 5.25).abs() < 1e-6, "{y}");
    }
}

#[test]
fn nobody_uses_a_link_between_roads_that_do_not_meet() {
    let lanes = section(0.0, "", &lane(-1, "-1"));
    for (far, contact) in [([100.0, 30.0, 0.0], "start"), ([100.0, 0.0, 0.0], "end")] {
        let roads = road(1, [0.0; 3], &follows(2, contact), &lanes) + &road(2, far, "", &lanes);
        let other = ("T", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"30\"/>", 10.0);
        let trace = Scene { roads, entities: &[EGO, other], actions: &[], stop: "" }.run();
        moves_without_jumps(&trace, "T");
        let x = at(&trace, "T.x", 7.9);
        assert!((x - 100.0).abs() < 0.3, "{x}");
    }
}

#[test]
fn positions_beside_an_entity_go_on_over_a_road_of_the_other_direction() {
    for place in [
        "<RelativeLanePosition entityRef=\"Ego\" dLane=\"0\" ds=\"120\"/>",
        "<RelativeLanePosition entityRef=\"Ego\" dLane=\"0\" dsLane=\"120\"/>",
        "<RelativeRoadPosition entityRef=\"Ego\" ds=\"120\" dt=\"0\"/>",
    ] {
        let trace = Scene { roads: against(), entities: &[EGO, ("T", place, 1.0)], actions: &[], stop: "" }.run();
        let (x, y, heading) = (at(&trace, "T.x", 0.0), at(&trace, "T.y", 0.0), at(&trace, "T.heading", 0.0));
        assert!((x - 130.0).abs() < 1e-6 && (y + 1.75).abs() < 1e-6, "{place}: ({x}, {y})");
        assert!(libm::sin(0.5 * heading).abs() < 1e-6, "{place}: {heading}");
    }
}

#[test]
fn distances_to_the_side_go_on_over_a_road_of_the_other_direction() {
    let other = ("T", "<LanePosition roadId=\"2\" laneId=\"1\" s=\"50\"/>", 0.0);
    let distance = |rule: &str, value: f64| {
        format!(
            "<RelativeDistanceCondition entityRef=\"T\" relativeDistanceType=\"lateral\" value=\"{value}\" freespace=\"false\" \
             rule=\"{rule}\" coordinateSystem=\"road\"/>"
        )
    };
    let scene = |stop: &str| Scene { roads: against(), entities: &[EGO, other], actions: &[], stop }.end();
    assert!(scene(&distance("lessThan", 0.1)) < 0.05);
    assert!(scene(&distance("greaterThan", 0.1)) > 7.9);
    let aside = "<LateralAction><LateralDistanceAction entityRef=\"T\" distance=\"1\" freespace=\"false\" continuous=\"true\" \
                 displacement=\"leftToReferencedEntity\" coordinateSystem=\"road\"><DynamicConstraints maxAcceleration=\"3\" \
                 maxDeceleration=\"3\" maxSpeed=\"2\"/></LateralDistanceAction></LateralAction>";
    let actions = [("Ego", aside.to_owned())];
    let trace = Scene { roads: against(), entities: &[EGO, other], actions: &actions, stop: "" }.run();
    assert!((at(&trace, "Ego.y", 7.0) + 0.75).abs() < 0.05, "{}", at(&trace, "Ego.y", 7.0));
}

#[test]
fn distances_to_the_side_are_between_boxes_if_they_say_so() {
    let roads = || road(1, [0.0; 3], "", &section(0.0, "", &format!("{}{}", lane(-1, ""), lane(-2, ""))));
    let other = ("T", "<LanePosition roadId=\"1\" laneId=\"-2\" s=\"12\"/>", 10.0);
    for system in ["road", "lane", "entity"] {
        let distance = |rule: &str, value: f64| {
            format!(
                "<RelativeDistanceCondition entityRef=\"T\" relativeDistanceType=\"lateral\" value=\"{value}\" freespace=\"true\" \
                 rule=\"{rule}\" coordinateSystem=\"{system}\"/>"
            )
        };
        let scene = |stop: &str| Scene { roads: roads(), entities: &[EGO, other], actions: &[], stop }.end();
        // The middles are 3.5 m apart, and the boxes are 2 m wide.
        assert!(scene(&distance("lessThan", 1.51)) < 0.05, "{system}");
        assert!(scene(&distance("lessThan", 1.49)) > 7.9, "{system}");
    }
}

fn long() -> String {
    road(1, [0.0; 3], "", &section(0.0, "", &lane(-1, ""))).replace("\"100\"", "\"1000\"")
}

#[test]
fn actions_of_the_story_do_not_move_the_car_of_a_driver() {
    let follower = ("T", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"200\"/>", 10.0);
    let same = "<LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape=\"step\" dynamicsDimension=\"time\" value=\"0\"/>\
                <SpeedActionTarget><RelativeTargetSpeed entityRef=\"Ego\" value=\"0\" speedTargetValueType=\"delta\" \
                continuous=\"true\"/></SpeedActionTarget></SpeedAction></LongitudinalAction>";
    let slower = speed(2.0).replace("step", "linear").replace("value=\"0\"", "value=\"3\"");
    for own in [speed(2.0), slower] {
        let actions = [("Ego", own), ("T", same.to_owned())];
        let scene = Scene { roads: long(), entities: &[EGO, follower], actions: &actions, stop: "" };
        let (_folder, path) = scene.write();
        let program = Xosc::read(&path).unwrap().program();
        let notes = program.notes(&program.declare().unwrap().nominal());
        assert!(
            notes.iter().any(|note| note.contains("`Ego acts` does not move `Ego` while a driver has it")),
            "{notes:?}"
        );
        let trace = driven_by("cruise", &program).trace.unwrap();
        for seconds in [0.6, 2.0, 5.0] {
            let (ego, other) = (at(&trace, "Ego.speed", seconds), at(&trace, "T.speed", seconds));
            assert!((ego - 10.0).abs() < 0.05 && (other - ego).abs() < 0.05, "{ego} and {other} m/s at {seconds} s");
        }
        // Without a driver they do.
        assert_eq!(at(&scene.run(), "Ego.speed", 5.0), 2.0);
    }
}

#[test]
fn an_entity_without_limits_makes_up_its_distance() {
    for (limits, least) in [("maxSpeed=\"20\"", 19.9), ("maxAcceleration=\"3\"", 13.0), ("maxDeceleration=\"3\"", 19.0)]
    {
        let action = format!(
            "<LongitudinalAction><LongitudinalDistanceAction entityRef=\"Ego\" distance=\"20\" freespace=\"false\" \
             continuous=\"true\" displacement=\"trailingReferencedEntity\" coordinateSystem=\"road\"><DynamicConstraints {limits}/>\
             </LongitudinalDistanceAction></LongitudinalAction>"
        );
        let actions = [("T", action)];
        let ahead = ("Ego", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"100\"/>", 10.0);
        let behind = ("T", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"40\"/>", 10.0);
        let scene = Scene { roads: long(), entities: &[ahead, behind], actions: &actions, stop: "" };
        let trace = scene.with_pedestrian().unwrap_or_else(|error| panic!("{limits}: {error}"));
        let fastest = trace.signal("T.speed").unwrap().fold(0.0, f64::max);
        assert!(fastest >= least, "{limits}: {fastest} m/s");
        let gap = at(&trace, "Ego.x", 7.9) - at(&trace, "T.x", 7.9);
        assert!((19.0..45.0).contains(&gap), "{limits}: {gap} m");
    }
}

#[test]
fn a_synchronized_entity_may_arrive_at_a_standstill() {
    let place = |s: f64| format!("<LanePosition roadId=\"1\" laneId=\"-1\" s=\"{s}\"/>");
    let action = format!(
        "<SynchronizeAction masterEntityRef=\"Ego\"><TargetPositionMaster>{}</TargetPositionMaster><TargetPosition>{}\
         </TargetPosition><FinalSpeed><AbsoluteSpeed value=\"0\"/></FinalSpeed></SynchronizeAction>",
        place(70.0),
        place(300.0)
    );
    let actions = [("T", action)];
    let other = ("T", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"260\"/>", 10.0);
    let trace = Scene { roads: long(), entities: &[EGO, other], actions: &actions, stop: "" }.run();
    // The ego vehicle arrives after 6 s.
    for seconds in [6.0, 7.5] {
        let (x, metres) = (at(&trace, "T.x", seconds), at(&trace, "T.speed", seconds));
        assert!((x - 300.0).abs() < 0.1 && metres.abs() < 0.1, "{x} m and {metres} m/s at {seconds} s");
    }
}

#[test]
fn the_time_before_the_beginning_on_a_trajectory_does_not_count() {
    let follow = |from: f64, timing: &str| {
        let vertex = |time: f64, x: f64| {
            format!("<Vertex time=\"{time}\"><Position><WorldPosition x=\"{x}\" y=\"-1.75\"/></Position></Vertex>")
        };
        let vertices = vertex(0.0, 100.0) + &vertex(2.0, 140.0) + &vertex(12.0, 240.0);
        format!(
            "<RoutingAction><FollowTrajectoryAction initialDistanceOffset=\"{from}\"><TrajectoryRef><Trajectory name=\"t\" \
             closed=\"false\"><Shape><Polyline>{vertices}</Polyline></Shape></Trajectory></TrajectoryRef>{timing}\
             <TrajectoryFollowingMode followingMode=\"position\"/></FollowTrajectoryAction></RoutingAction>"
        )
    };
    let timing =
        "<TimeReference><Timing domainAbsoluteRelative=\"relative\" scale=\"1\" offset=\"0\"/></TimeReference>";
    let other = ("T", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"100\"/>", 5.0);
    let run = |from: f64, timing: &str| {
        let actions = [("T", follow(from, timing))];
        Scene { roads: long(), entities: &[EGO, other], actions: &actions, stop: "" }.tried()
    };
    let (whole, part) = (run(0.0, timing).unwrap(), run(40.0, timing).unwrap());
    // The first 40 m take 2 s.
    for seconds in [1.0, 3.0, 5.0] {
        let (late, early) = (at(&whole, "T.x", seconds + 2.0), at(&part, "T.x", seconds));
        assert!((late - early).abs() < 0.11, "{late} and {early} m at {seconds} s");
    }
    for timing in [timing, "<TimeReference><None/></TimeReference>"] {
        let error = run(5000.0, timing).expect_err("the way is shorter");
        assert!(error.contains("the way begins at 5000 m, and it is 140 m long"), "{error}");
    }
}

#[test]
fn a_profile_without_times_has_the_limits_of_its_vehicle() {
    let profile = "<LongitudinalAction><SpeedProfileAction followingMode=\"position\"><SpeedProfileEntry speed=\"30\"/>\
                   </SpeedProfileAction></LongitudinalAction>";
    let actions = [("T", profile.to_owned())];
    let other = ("T", "<LanePosition roadId=\"1\" laneId=\"-1\" s=\"100\"/>", 10.0);
    let trace = Scene { roads: long(), entities: &[EGO, other], actions: &actions, stop: "" }.run();
    // From 0.5 s on with 10 m/s².
    for (seconds, metres) in [(1.5, 20.0), (2.5, 30.0), (4.0, 30.0)] {
        let found = at(&trace, "T.speed", seconds);
        assert!((found - metres).abs() < 0.11, "{found} m/s at {seconds} s");
    }
    let error = Scene { roads: long(), entities: &[EGO, other], actions: &actions, stop: "" }.with_pedestrian();
    let says = "`T` has no greatest acceleration; give each SpeedProfileEntry a time";
    assert!(error.as_ref().is_err_and(|error| error.contains(says)), "{error:?}");
}
