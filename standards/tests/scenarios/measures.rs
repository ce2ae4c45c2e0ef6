//! What conditions measure: speeds and accelerations in a direction or in all, and values of types.

use super::bad::changed_in;
use super::worlds::{at, led};
use paracosm_oracles::Trace;
use paracosm_standards::openscenario::Xosc;
use std::f64::consts::PI;

const LEADER: &str = "slow-leader.xosc";
const ROUTES: &str = "routes.xosc";
const STOP: &str = "<StopTrigger>";
/// The initial speed of the leader.
const DYNAMICS: &str = "<SpeedActionDynamics dynamicsShape=\"step\" dynamicsDimension=\"time\" value=\"0\"/>\n          \
                        <SpeedActionTarget><RelativeTargetSpeed entityRef=\"Ego\" value=\"0\" \
                        speedTargetValueType=\"delta\" continuous=\"false\"/></SpeedActionTarget>";

/// Runs a scenario with changes. Returns the trace, or the reason why there is none.
fn tried(scenario: &str, changes: &[(&str, &str)]) -> Result<Trace, String> {
    let (_folder, path) = changed_in(scenario, "<OpenSCENARIO>", "<OpenSCENARIO>");
    let mut text = std::fs::read_to_string(&path).unwrap();
    for (found, by) in changes {
        assert!(text.contains(found), "{found}");
        text = text.replacen(found, by, 1);
    }
    std::fs::write(&path, text).unwrap();
    let program = Xosc::read(&path).map_err(|error| error.to_string())?.program();
    let outcome = led(&program).map_err(|error| error.to_string())?;
    outcome.trace.ok_or_else(|| format!("{:?}", outcome.ending))
}

fn run(scenario: &str, changes: &[(&str, &str)]) -> Trace {
    tried(scenario, changes).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the seconds after which a run ends if it also ends at a condition.
fn end(scenario: &str, entity: &str, condition: &str, changes: &[(&str, &str)]) -> f64 {
    let inner = match entity {
        "" => format!("<ByValueCondition>{condition}</ByValueCondition>"),
        entity => format!(
            "<ByEntityCondition><TriggeringEntities triggeringEntitiesRule=\"any\"><EntityRef entityRef=\"{entity}\"/>\
             </TriggeringEntities><EntityCondition>{condition}</EntityCondition></ByEntityCondition>"
        ),
    };
    let stop = format!(
        "<StopTrigger><ConditionGroup><Condition name=\"measured\" delay=\"0\" conditionEdge=\"none\">{inner}</Condition>\
         </ConditionGroup>"
    );
    let trace = run(scenario, &[changes, &[(STOP, stop.as_str())]].concat());
    (trace.len() - 1) as f64 * trace.dt()
}

#[test]
fn a_speed_that_changes_over_a_distance_begins_at_a_standstill() {
    for shape in ["linear", "cubic", "sinusoidal"] {
        let by = format!(
            "<SpeedActionDynamics dynamicsShape=\"{shape}\" dynamicsDimension=\"distance\" value=\"40\"/>\
             <SpeedActionTarget><AbsoluteTargetSpeed value=\"20\"/></SpeedActionTarget>"
        );
        let trace = run(LEADER, &[(DYNAMICS, &by)]);
        // The mean speed of each shape is 10 m/s, so that 40 m take 4 s.
        for (seconds, speed) in [(0.0, 0.0), (2.0, 10.0), (4.0, 20.0)] {
            let found = at(&trace, "Leader.speed", seconds);
            assert!((found - speed).abs() < 1e-6, "{shape}: {found} m/s at {seconds} s");
        }
        let found = at(&trace, "Leader.x", 4.0) - at(&trace, "Leader.x", 0.0);
        assert!((found - 40.0).abs() < 0.11, "{shape}: {found} m");
    }
}

#[test]
fn a_relative_speed_in_a_direction_counts_along_the_axes_of_the_triggering_entity() {
    let condition = |value: f64, rule: &str, direction: &str| {
        format!("<RelativeSpeedCondition entityRef=\"Leader\" value=\"{value}\" rule=\"{rule}\" {direction}/>")
    };
    // The leader comes towards the ego vehicle, both at 30 m/s.
    let comes = format!(
        "<LanePosition roadId=\"1\" laneId=\"1\" s=\"$start\"><Orientation type=\"relative\" h=\"{}\"/></LanePosition>",
        0.0
    );
    let comes = [("<LanePosition roadId=\"1\" laneId=\"-1\" s=\"$start\"/>", comes.as_str())];
    let longitudinal = "direction=\"longitudinal\"";
    assert!(end(LEADER, "Ego", &condition(59.9, "greaterThan", longitudinal), &comes) < 0.05);
    assert!(end(LEADER, "Ego", &condition(60.1, "greaterThan", longitudinal), &comes) > 4.9);
    // Without a direction, the speeds are compared as they are.
    assert!(end(LEADER, "Ego", &condition(0.0, "equalTo", ""), &comes) < 0.05);
    // The leader goes to the left of the ego vehicle, beside all roads.
    let leaves = format!("<WorldPosition x=\"300\" y=\"100\" h=\"{}\"/>", PI / 2.0);
    let leaves = [("<LanePosition roadId=\"1\" laneId=\"-1\" s=\"$start\"/>", leaves.as_str())];
    let lateral = "direction=\"lateral\"";
    assert!(end(LEADER, "Ego", &condition(-29.9, "lessThan", lateral), &leaves) < 0.05);
    assert!(end(LEADER, "Ego", &condition(-30.1, "lessThan", lateral), &leaves) > 4.9);
    assert!(end(LEADER, "Ego", &condition(29.9, "greaterThan", longitudinal), &leaves) < 0.05);
}

#[test]
fn an_entity_that_is_put_at_a_place_keeps_its_velocity() {
    let activation = "<ControllerAction>\n                <ActivateControllerAction lateral=\"true\" \
                      longitudinal=\"true\"/>\n              </ControllerAction>";
    let jump =
        "<TeleportAction><Position><LanePosition roadId=\"1\" laneId=\"-1\" s=\"100\"/></Position></TeleportAction>";
    let condition =
        "<RelativeSpeedCondition entityRef=\"Ego\" value=\"5\" rule=\"greaterThan\" direction=\"longitudinal\"/>";
    assert!(end(LEADER, "Leader", condition, &[(activation, jump)]) > 4.9);
}

#[test]
fn an_acceleration_counts_in_a_direction_or_in_all() {
    let condition = |value: f64, rule: &str, direction: &str| {
        format!("<AccelerationCondition value=\"{value}\" rule=\"{rule}\" {direction}/>")
    };
    // The leader brakes at 2 m/s² from 5 s on.
    assert!((end(LEADER, "Leader", &condition(1.9, "greaterThan", ""), &[]) - 5.0).abs() < 0.05);
    let longitudinal = "direction=\"longitudinal\"";
    assert!((end(LEADER, "Leader", &condition(-1.9, "lessThan", longitudinal), &[]) - 5.0).abs() < 0.05);
    assert!(end(LEADER, "Leader", &condition(0.1, "greaterThan", longitudinal), &[]) > 15.0);
    // A car goes to the left around a bend: v² / r with v = 10 m/s and r = 11.75 m, from (130 - 50) / 10 s on.
    let lateral = "direction=\"lateral\"";
    for direction in ["", lateral] {
        let seconds = end(ROUTES, "Left", &condition(8.4, "greaterThan", direction), &[]);
        assert!((seconds - 8.0).abs() < 0.05, "{seconds} s");
        assert!(end(ROUTES, "Left", &condition(8.6, "greaterThan", direction), &[]) > 13.9);
    }
}

#[test]
fn a_truth_may_be_a_number_in_a_file() {
    let second = "<ParameterDeclaration name=\"gap\"";
    for (declared, wanted) in [("1", "true"), ("true", "1"), ("1", "1"), ("0", "false"), ("false", "0")] {
        let wet =
            format!("<ParameterDeclaration name=\"wet\" parameterType=\"boolean\" value=\"{declared}\"/>{second}");
        let condition = format!("<ParameterCondition parameterRef=\"wet\" value=\"{wanted}\" rule=\"equalTo\"/>");
        let seconds = end(LEADER, "", &condition, &[(second, &wet)]);
        assert!(seconds < 0.05, "{declared} is not {wanted}: {seconds} s");
        let condition = condition.replace("equalTo", "notEqualTo");
        assert!(end(LEADER, "", &condition, &[(second, &wet)]) > 15.0, "{declared} differs from {wanted}");
    }
    let declared = format!(
        "<ParameterDeclaration name=\"wet\" parameterType=\"boolean\" value=\"1\"/>\
         <ParameterDeclaration name=\"dry\" parameterType=\"boolean\" value=\"${{not $wet or false}}\"/>{second}"
    );
    let condition = "<ParameterCondition parameterRef=\"dry\" value=\"0\" rule=\"equalTo\"/>";
    assert!(end(LEADER, "", condition, &[(second, &declared)]) < 0.05);
    let variable = "<VariableDeclarations><VariableDeclaration name=\"wet\" variableType=\"boolean\" value=\"1\"/>\
                    </VariableDeclarations><CatalogLocations>";
    let condition = "<VariableCondition variableRef=\"wet\" value=\"true\" rule=\"equalTo\"/>";
    assert!(end(LEADER, "", condition, &[("<CatalogLocations>", variable)]) < 0.05);
}

#[test]
fn an_entity_keeps_no_distance_to_itself() {
    let activation = "<ControllerAction>\n                <ActivateControllerAction lateral=\"true\" \
                      longitudinal=\"true\"/>\n              </ControllerAction>";
    for (action, kind) in
        [("LongitudinalDistanceAction", "distance=\"10\""), ("LateralDistanceAction", "distance=\"1\"")]
    {
        let outer = action.replace("DistanceAction", "Action");
        let by =
            format!("<{outer}><{action} entityRef=\"Ego\" {kind} continuous=\"true\" freespace=\"false\"/></{outer}>");
        let error = tried(LEADER, &[(activation, by.as_str())]).expect_err("it was accepted");
        assert!(error.contains("`Ego` cannot keep a distance to itself"), "{error}");
    }
}

#[test]
fn a_variable_keeps_its_type() {
    let variable = |kind: &str| {
        format!(
            "<VariableDeclarations><VariableDeclaration name=\"lives\" variableType=\"{kind}\" value=\"1\"/>\
             </VariableDeclarations><CatalogLocations>"
        )
    };
    let change = |rule: &str| {
        format!(
            "<GlobalAction><VariableAction variableRef=\"lives\"><ModifyAction><Rule>{rule}</Rule></ModifyAction>\
             </VariableAction></GlobalAction>"
        )
    };
    let activation = "<PrivateAction><ControllerAction>\n                <ActivateControllerAction lateral=\"true\" \
                      longitudinal=\"true\"/>\n              </ControllerAction></PrivateAction>";
    for (kind, rule, says) in [
        (
            "unsignedInt",
            "<AddValue value=\"-5\"/>",
            Some("`lives` becomes -4, expected a whole number from 0 to 4294967295"),
        ),
        (
            "int",
            "<MultiplyByValue value=\"0.5\"/>",
            Some("`lives` becomes 0.5, expected a whole number from -2147483648"),
        ),
        ("int", "<AddValue value=\"-5\"/>", None),
        ("double", "<MultiplyByValue value=\"0.5\"/>", None),
    ] {
        // As an initial action, and as an action of the story.
        let init = format!("{}</Actions></Init>", change(rule));
        for (at, by, line) in [("</Actions></Init>", init, 42), (activation, change(rule), 55)] {
            let declared = variable(kind);
            let error = tried(LEADER, &[("<CatalogLocations>", declared.as_str()), (at, by.as_str())]).err();
            let place = format!("bad.xosc:{line}");
            let is_told =
                |says: &str| error.as_ref().is_some_and(|error| error.contains(says) && error.contains(&place));
            assert!(says.map_or(error.is_none(), is_told), "{kind} {rule}: {error:?}");
        }
    }
}

#[test]
fn a_text_that_looks_like_a_number_stays_a_text() {
    let second = "<ParameterDeclaration name=\"gap\"";
    for text in ["inf", "NaN", "1e3", "007"] {
        let plan = format!("<ParameterDeclaration name=\"plan\" parameterType=\"string\" value=\"{text}\"/>{second}");
        let condition =
            |wanted: &str| format!("<ParameterCondition parameterRef=\"plan\" value=\"{wanted}\" rule=\"equalTo\"/>");
        assert!(end(LEADER, "", &condition(text), &[(second, &plan)]) < 0.05, "{text}");
        assert!(end(LEADER, "", &condition("7"), &[(second, &plan)]) > 15.0, "{text}");
    }
}
