//! Scenarios of files (ASAM OpenSCENARIO): campaigns over their parameters, replays, descriptions, and files with mistakes.

use crate::common::{cover, fuzz, refused, stderr, stdout, succeeds};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Scenarios of our own, with their catalogs.
const FILES: [&str; 6] = [
    "straight.xodr",
    "slow-leader.xosc",
    "slow-leader-variation.xosc",
    "slow-leader-chances.xosc",
    "slow-leader-shapes.xosc",
    "catalogs/entities.xosc",
];

/// Returns a folder with the scenarios of our own and their catalogs.
pub fn folder() -> TempDir {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("standards/tests/scenarios/files");
    let dir = tempfile::tempdir().expect("a folder");
    fs::create_dir(dir.path().join("catalogs")).expect("it is writable");
    for name in FILES {
        fs::copy(from.join(name), dir.path().join(name)).expect("it is there");
    }
    dir
}

/// Returns the trials of a campaign.
fn trials(dir: &Path, folder: &str) -> Vec<serde_json::Value> {
    let text = fs::read_to_string(dir.join(folder).join("trials.jsonl")).expect("a log");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn a_distribution_of_parameters_is_a_campaign_and_its_trials_are_replayed() {
    let dir = folder();
    let arguments =
        ["slow-leader-variation.xosc", "--driver", "aeb", "--strategy", "random", "--budget", "30", "--out", "c"];
    succeeds(fuzz(dir.path(), &arguments));
    let trials = trials(dir.path(), "c");
    assert!(trials.len() >= 5, "{} trials", trials.len());
    for trial in &trials {
        let speed = trial["test"]["speed"].as_f64().expect("a speed");
        // A constraint of the scenario allows at most 50 m/s.
        assert!([20.0, 30.0, 40.0, 50.0].contains(&speed), "{trial}");
        assert!(["pass", "fail"].map(Into::into).contains(&trial["verdict"]), "{trial}");
    }
    let study = fs::read_to_string(dir.path().join("c/campaign.json")).expect("a study");
    assert!(study.contains("\"speed > 0 and speed <= 50\""), "{study}");
    let valid = &trials[0];
    let index = valid["index"].to_string();
    let replayed = stdout(&fuzz(dir.path(), &["replay", "c", &index]));
    assert!(replayed.contains(valid["trace_hash"].as_str().expect("a hash")), "{replayed}");
}

#[test]
fn with_continuous_a_range_is_an_interval_and_no_test_breaks_a_constraint() {
    let dir = folder();
    let arguments = ["slow-leader-variation.xosc", "--driver", "aeb", "--continuous", "--budget", "40", "--out", "c"];
    succeeds(fuzz(dir.path(), &arguments));
    let trials = trials(dir.path(), "c");
    assert_eq!(trials.len(), 40);
    let speeds: Vec<f64> = trials.iter().map(|trial| trial["test"]["speed"].as_f64().expect("a speed")).collect();
    assert!(speeds.iter().all(|speed| (20.0..=50.0).contains(speed)), "{speeds:?}");
    assert!(speeds.iter().any(|speed| speed % 10.0 != 0.0), "{speeds:?}");
}

#[test]
fn describe_shows_the_constraints_of_a_scenario() {
    let dir = folder();
    let described = stdout(&succeeds(fuzz(dir.path(), &["describe", "slow-leader.xosc"])));
    let says = "constraints\n                              speed > 0 and speed <= 50\n";
    assert!(described.contains(says), "{described}");
}

#[test]
fn fixed_values_that_break_a_constraint_are_refused_with_its_place() {
    let dir = folder();
    let says = "slow-leader.xosc:5: no test keeps the constraint `speed > 0 and speed <= 50` with speed = 60";
    let arguments = ["slow-leader.xosc", "--driver", "aeb", "--open", "gap=20..50", "--set", "speed=60"];
    refused(&fuzz(dir.path(), &arguments), &[says]);
    let path = dir.path().join("slow-leader.xosc");
    let text = fs::read_to_string(&path).expect("it is there");
    let declared = "name=\"speed\" parameterType=\"double\" value=\"30\"";
    fs::write(&path, text.replace(declared, &declared.replace("30", "60"))).expect("it is writable");
    refused(&fuzz(dir.path(), &arguments[..5]), &[says]);
}

#[test]
fn a_campaign_on_a_file_is_resumed_with_the_same_bytes() {
    let dir = folder();
    for (out, more) in [("listed", "--k=2"), ("continuous", "--continuous")] {
        let arguments = ["slow-leader-variation.xosc", "--driver", "aeb", "--budget", "8", more, "--out", out];
        succeeds(fuzz(dir.path(), &arguments));
        let path = dir.path().join(out).join("trials.jsonl");
        let whole = fs::read_to_string(&path).expect("a log");
        let half: String = whole.lines().take(3).flat_map(|line| [line, "\n"]).collect();
        fs::write(&path, half).expect("it is writable");
        succeeds(fuzz(dir.path(), &[&arguments[..], &["--resume"]].concat()));
        assert_eq!(fs::read_to_string(&path).expect("a log"), whole, "{out}");
    }
}

#[test]
fn a_campaign_is_not_resumed_after_a_file_of_its_scenario_has_changed() {
    for (file, found, by) in [
        ("slow-leader.xosc", "$gap + 10", "$gap + 11"),
        ("catalogs/entities.xosc", "mass=\"1500\"", "mass=\"1501\""),
        ("straight.xodr", "name=", " name="),
    ] {
        let dir = folder();
        let run = |more: &[&str]| {
            let given = ["slow-leader-variation.xosc", "--driver", "aeb", "--budget", "6", "--out", "c"];
            fuzz(dir.path(), &[&given, more].concat())
        };
        succeeds(run(&[]));
        succeeds(run(&["--resume"]));
        let path = dir.path().join(file);
        let text = fs::read_to_string(&path).expect("it is readable");
        assert!(text.contains(found), "{file}");
        fs::write(&path, text.replacen(found, by, 1)).expect("it is writable");
        refused(&run(&["--resume"]), &["`scenario_files`"]);
    }
}

#[test]
fn the_space_of_a_scenario_file_or_of_a_campaign_is_planned_and_covered() {
    let dir = folder();
    let plan =
        |space: &str| stdout(&succeeds(cover(dir.path(), &["plan", "--space", space, "--k", "2", "--format", "json"])));
    assert!(plan("slow-leader-variation.xosc").contains("\"k\""));
    succeeds(fuzz(dir.path(), &["slow-leader-variation.xosc", "--continuous", "--budget", "5", "--out", "c"]));
    let tests = stdout(&succeeds(cover(dir.path(), &["generate", "--space", "c", "--budget", "12"])));
    assert_eq!(tests.lines().count(), 13, "{tests}");
    assert!(tests.starts_with("speed,"), "{tests}");
}

#[test]
fn a_range_that_is_not_there_and_a_space_without_tests_are_refused() {
    let dir = folder();
    refused(&fuzz(dir.path(), &["pedestrian-crossing", "--continuous", "--out", "c"]), &["no open range with a step"]);
    let text = fs::read_to_string(dir.path().join("slow-leader.xosc")).expect("it is there");
    let text = text.replacen("rule=\"greaterThan\" value=\"0\"", "rule=\"greaterThan\" value=\"49.99\"", 1);
    fs::write(dir.path().join("slow-leader.xosc"), text).expect("it is writable");
    let arguments = ["slow-leader-variation.xosc", "--continuous", "--out", "c"];
    refused(&fuzz(dir.path(), &arguments), &["of 2048 tests keep the constraints", "`speed > 49.99 and speed <= 50`"]);
    assert!(!dir.path().join("c").exists());
}

#[test]
fn a_violation_that_no_reference_driver_avoids_is_unpreventable() {
    let dir = folder();
    let run = |out: &str, jobs: &str, more: &[&str]| {
        // This driver brakes when it is too late.
        let late = ["--driver", "aeb", "--set", "driver.ttc=0.05"];
        let mut arguments = vec!["slow-leader.xosc", "--open", "gap=10..60", "--budget", "20"];
        arguments.extend(late);
        arguments.extend(["--jobs", jobs, "--out", out]);
        arguments.extend(more);
        succeeds(fuzz(dir.path(), &arguments));
        trials(dir.path(), out)
    };
    let alone = run("alone", "1", &[]);
    assert!(alone.iter().all(|trial| trial["verdict"] == "fail"), "the driver brakes too late: {alone:?}");
    // The scenario sets nobody in the way who cannot be avoided by braking, except a driver who does not brake, either.
    let cruise = run("cruise", "1", &["--reference", "cruise"]);
    assert!(cruise.iter().all(|trial| trial["verdict"] == "unpreventable"), "{cruise:?}");
    let braking = run("braking", "1", &["--reference", "cruise,aeb"]);
    assert!(braking.iter().any(|trial| trial["verdict"] == "fail"), "{braking:?}");
    assert_eq!(braking, run("parallel", "2", &["--reference", "cruise,aeb"]));
    let index = braking.iter().position(|trial| trial["verdict"] == "fail").expect("a failure").to_string();
    let replayed = stdout(&fuzz(dir.path(), &["replay", "braking", &index]));
    assert!(replayed.contains("fail"), "{replayed}");
    refused(
        &fuzz(dir.path(), &["slow-leader.xosc", "--open", "gap=5..60", "--reference", "aeeb", "--out", "x"]),
        &["did you mean `aeb`?"],
    );
}

#[test]
fn another_entity_of_a_scenario_can_be_the_ego_vehicle() {
    let dir = folder();
    let arguments = ["slow-leader.xosc", "--ego", "Leader", "--open", "gap=40..60", "--budget", "3", "--out", "c"];
    succeeds(fuzz(dir.path(), &arguments));
    let study = fs::read_to_string(dir.path().join("c/campaign.json")).expect("a study");
    assert!(study.contains("\"ego\": \"Leader\""), "{study}");
    let arguments = ["slow-leader.xosc", "--ego", "Leadr", "--open", "gap=40..60", "--out", "d"];
    refused(&fuzz(dir.path(), &arguments), &["Leader"]);
}

#[test]
fn closed_parameters_of_a_scenario_can_be_set_and_opened() {
    let dir = folder();
    let arguments = [
        "slow-leader.xosc",
        "--driver",
        "cruise",
        "--open",
        "gap=5..100",
        "--set",
        "speed=20",
        "--budget",
        "8",
        "--out",
        "c",
    ];
    succeeds(fuzz(dir.path(), &arguments));
    for trial in trials(dir.path(), "c") {
        let gap = trial["test"]["gap"].as_f64().expect("a gap");
        assert!((5.0..=100.0).contains(&gap), "{trial}");
    }
}

#[test]
fn the_default_driver_leaves_the_car_to_the_scenario() {
    let dir = folder();
    let arguments = ["slow-leader.xosc", "--driver", "default", "--open", "gap=40..60", "--budget", "2", "--out", "c"];
    succeeds(fuzz(dir.path(), &arguments));
    // The ego vehicle drives into its slow leader, and the run goes on to the stop trigger after 20 s.
    for trial in trials(dir.path(), "c") {
        assert_eq!(trial["verdict"], "fail");
        assert!(trial["ticks"].as_u64().expect("ticks") > 1990, "{trial}");
    }
}

#[test]
fn a_scenario_of_a_file_is_described_with_its_graph_of_streams() {
    let dir = folder();
    let text = stdout(&succeeds(fuzz(dir.path(), &["describe", "slow-leader-variation.xosc", "--format", "table"])));
    for part in ["speed", "gap", "no-collision", "a scenario of a file"] {
        assert!(text.contains(part), "`{part}` is missing in: {text}");
    }
    let dot = stdout(&succeeds(fuzz(dir.path(), &["describe", "slow-leader-variation.xosc", "--dot"])));
    assert!(dot.contains("storyboard") && dot.contains("at 5 s"), "{dot}");
}

#[test]
fn a_scenario_file_without_open_parameters_is_described_with_its_closed_ones() {
    let dir = folder();
    let table = stdout(&succeeds(fuzz(dir.path(), &["describe", "slow-leader.xosc", "--format", "table"])));
    for part in ["\nparameters\n", "nominally 50, unless opened", "no-collision", "Leader.speed"] {
        assert!(table.contains(part), "`{part}` is missing in: {table}");
    }
    let described = |options: &[&str]| {
        let output = fuzz(dir.path(), &[&["describe", "slow-leader.xosc", "--format", "json"], options].concat());
        serde_json::from_str::<serde_json::Value>(&stdout(&succeeds(output))).expect("it is JSON")
    };
    let json = described(&["--set", "gap=70", "--driver", "planner"]);
    let parameters = json["parameters"].as_array().expect("a list");
    let of = |name: &str| parameters.iter().find(|one| one["parameter"]["name"] == name).expect("it is listed");
    assert!(parameters.iter().all(|one| one["open"] == false), "{json}");
    assert_eq!((&of("speed")["nominal"], &of("gap")["nominal"]), (&30.into(), &50.into()));
    assert_eq!((&of("speed")["set"], &of("gap")["set"]), (&serde_json::Value::Null, &70.into()));
    assert!(described(&["--open", "gap"])["parameters"].to_string().contains("\"open\":true"));
    let dot = stdout(&succeeds(fuzz(dir.path(), &["describe", "slow-leader.xosc", "--dot"])));
    assert!(dot.contains("storyboard"), "{dot}");
    let drawn = succeeds(fuzz(dir.path(), &["describe", "slow-leader.xosc", "--draw", "world.svg"]));
    assert!(dir.path().join("world.svg").exists(), "{}", stderr(&drawn));
    // Without an open parameter, a campaign is one test. A probability needs something to vary.
    let one = succeeds(fuzz(dir.path(), &["slow-leader.xosc", "--budget", "3", "--out", "one"]));
    assert!(stderr(&one).contains("so there is one test; --open NAME=LO..HI varies one of speed, gap, ego"));
    refused(
        &fuzz(dir.path(), &["likelihood", "slow-leader.xosc"]),
        &["has no open parameter", "open some of", "speed, gap, ego", "--open NAME=LO..HI"],
    );
    refused(
        &fuzz(dir.path(), &["likelihood", "slow-leader.xosc", "--set", "gap=70"]),
        &["with `gap` fixed no parameter"],
    );
}

#[test]
fn the_parts_of_files_without_effect_are_noted_once_before_the_tests() {
    let dir = folder();
    let notes = [
        "catalogs/entities.xosc:9: `Axles` has no effect: ",
        "catalogs/entities.xosc:14: `Properties` has no effect: it is data for other programs",
    ];
    let text = fs::read_to_string(dir.path().join("straight.xodr")).expect("it is there");
    let hill = "<elevationProfile><elevation s=\"0\" a=\"0\" b=\"0.01\" c=\"0\" d=\"0\"/></elevationProfile><lanes>";
    fs::write(dir.path().join("straight.xodr"), text.replacen("<lanes>", hill, 1)).expect("it is writable");
    let flat = "straight.xodr: the world is flat: heights up to 10.00 m are left out";
    let arguments = ["slow-leader-variation.xosc", "--driver", "aeb", "--budget", "4", "--out", "c"];
    let ran = stderr(&succeeds(fuzz(dir.path(), &arguments)));
    for note in notes.into_iter().chain([flat]) {
        assert_eq!(ran.matches(note).count(), 1, "`{note}` in: {ran}");
    }
    let quiet =
        stderr(&succeeds(fuzz(dir.path(), &["slow-leader-variation.xosc", "-q", "--budget", "2", "--out", "q"])));
    assert_eq!(quiet, "");
    let table = stdout(&succeeds(fuzz(dir.path(), &["describe", "slow-leader-variation.xosc", "--format", "table"])));
    assert!(table.contains("\nnotes\n") && table.contains(notes[0]) && table.contains(flat), "{table}");
    let json = stdout(&succeeds(fuzz(dir.path(), &["describe", "slow-leader-variation.xosc", "--format", "json"])));
    let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
    assert_eq!(json["notes"].as_array().map(Vec::len), Some(3), "{json}");
}

#[test]
fn a_parameter_of_whole_numbers_is_opened_to_whole_numbers() {
    let dir = folder();
    let text = fs::read_to_string(dir.path().join("slow-leader.xosc")).expect("it is there");
    let text =
        text.replacen("name=\"gap\" parameterType=\"double\"", "name=\"gap\" parameterType=\"unsignedShort\"", 1);
    fs::write(dir.path().join("whole.xosc"), text).expect("it is writable");
    succeeds(fuzz(dir.path(), &["whole.xosc", "--open", "gap=40..47", "--budget", "20", "--out", "c"]));
    let mut gaps: Vec<u64> =
        trials(dir.path(), "c").iter().map(|trial| trial["test"]["gap"].as_u64().expect("a whole number")).collect();
    gaps.sort_unstable();
    assert_eq!(gaps, [40, 41, 42, 43, 44, 45, 46, 47]);
    for (option, value, says) in [
        ("--open", "gap=40.5..47", "parameter `gap`: found 40.5, expected a whole number"),
        ("--open", "gap=40,41.5", "parameter `gap`: found 41.5, expected a whole number"),
        ("--open", "gap=-1..3", "parameter `gap`: found -1, expected"),
        ("--open", "gap", "0 to 65535 are 65536 of them, expected at most 10000"),
        ("--set", "gap=4.5", "parameter `gap`: found 4.5, expected a whole number"),
        ("--set", "gap=70000", "parameter `gap`: found 70000, expected"),
    ] {
        refused(&fuzz(dir.path(), &["whole.xosc", option, value, "--open", "speed=20..30", "--out", "d"]), &[says]);
    }
    assert!(!dir.path().join("d").exists());
}

#[test]
fn a_text_that_looks_like_a_number_keeps_the_constraints_of_its_parameter() {
    let dir = folder();
    let change = |name: &str, changes: [&str; 2], by: [&str; 2]| {
        let mut text = fs::read_to_string(dir.path().join(name)).expect("it is there");
        for (found, by) in changes.iter().zip(by) {
            assert!(text.contains(found), "{found}");
            text = text.replacen(found, by, 1);
        }
        fs::write(dir.path().join(name), text).expect("it is writable");
    };
    let lane = "<ParameterDeclarations><ParameterDeclaration name=\"lane\" parameterType=\"string\" value=\"-1\">\
        <ConstraintGroup><ValueConstraint rule=\"equalTo\" value=\"-1\"/></ConstraintGroup>\
        <ConstraintGroup><ValueConstraint rule=\"equalTo\" value=\"-2\"/></ConstraintGroup></ParameterDeclaration>";
    change("slow-leader.xosc", ["<ParameterDeclarations>", "laneId=\"-1\""], [lane, "laneId=\"$lane\""]);
    let lanes =
        "<DistributionSet><Element value=\"-1\"/><Element value=\"-2\"/><Element value=\"-3\"/></DistributionSet>";
    let gaps = "<DistributionSet><Element value=\"20\"/><Element value=\"50\"/></DistributionSet>";
    change("slow-leader-variation.xosc", ["parameterName=\"gap\"", gaps], ["parameterName=\"lane\"", lanes]);
    let lanes = |out: &str| {
        let mut lanes: Vec<String> =
            trials(dir.path(), out).iter().map(|trial| trial["test"]["lane"].to_string()).collect();
        lanes.sort_unstable();
        lanes.dedup();
        lanes
    };
    let run = |file: &str, options: &[&str]| {
        fuzz(dir.path(), &[&[file, "--driver", "aeb", "--budget", "8"], options].concat())
    };
    succeeds(run("slow-leader-variation.xosc", &["--out", "all"]));
    assert_eq!(lanes("all"), ["\"-1\"", "\"-2\""]);
    succeeds(fuzz(dir.path(), &["replay", "all", "0"]));
    succeeds(run("slow-leader-variation.xosc", &["--set", "lane=-2", "--out", "fixed"]));
    succeeds(run("slow-leader.xosc", &["--open", "lane=-2", "--open", "speed=20..30", "--out", "opened"]));
    assert_eq!(lanes("opened"), ["\"-2\""]);
    refused(
        &run("slow-leader-variation.xosc", &["--set", "lane=-3", "--out", "no"]),
        &["`lane == '-1' or lane == '-2'`"],
    );
}

#[test]
fn a_scenario_with_a_mistake_is_refused_with_its_line_and_nothing_is_written() {
    let dir = folder();
    let text = fs::read_to_string(dir.path().join("slow-leader.xosc")).expect("it is there");
    fs::write(dir.path().join("bad.xosc"), text.replacen("entryName=\"car\"", "entryName=\"cat\"", 1))
        .expect("it is writable");
    let output = fuzz(dir.path(), &["bad.xosc", "--driver", "aeb", "--out", "c"]);
    refused(&output, &["bad.xosc:19:", "did you mean `car`?"]);
    let output = fuzz(dir.path(), &["absent.xosc", "--driver", "aeb", "--out", "c"]);
    refused(&output, &["absent.xosc: the file cannot be read"]);
    assert!(!dir.path().join("c").exists());
}

#[test]
fn a_test_in_which_an_expression_divides_by_zero_is_invalid() {
    let dir = folder();
    let text = fs::read_to_string(dir.path().join("slow-leader.xosc")).expect("it is there");
    fs::write(dir.path().join("divides.xosc"), text.replacen("$gap + 10", "100 / ($gap - 45) + 160", 1))
        .expect("it is writable");
    succeeds(fuzz(dir.path(), &["divides.xosc", "--open", "gap=44,45,46", "--budget", "3", "--out", "c"]));
    for trial in trials(dir.path(), "c") {
        let says = trial["error"].as_str().unwrap_or_default();
        assert_eq!(trial["verdict"] == "invalid", trial["test"]["gap"] == 45, "{trial}");
        assert_eq!(
            says.contains("divides.xosc:12: ") && says.contains("it divides by zero"),
            trial["test"]["gap"] == 45
        );
    }
}

#[test]
fn the_elements_of_the_standards_are_listed() {
    let dir = tempfile::tempdir().expect("a folder");
    for (standard, element) in [("openscenario", "LaneChangeAction"), ("opendrive", "geometry")] {
        let table = stdout(&succeeds(fuzz(dir.path(), &["list", standard, "--format", "table"])));
        let line = table.lines().find(|line| line.starts_with(element)).expect("it is listed");
        assert!(line.ends_with("read"), "{line}");
        assert!(line.contains(".xosc") || line.contains(".xodr"), "{line}");
        let json = stdout(&succeeds(fuzz(dir.path(), &["list", standard, "--format", "json"])));
        let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
        let rows = json.as_array().expect("a list");
        assert!(rows.iter().any(|row| row["support"] == "refused"));
        let tests = rows.iter().map(|row| row["test"].as_str().expect("a path"));
        for test in tests {
            assert!(!test.is_empty() && Path::new(env!("CARGO_MANIFEST_DIR")).join(test).is_file(), "`{test}`");
        }
    }
}

#[test]
fn a_campaign_on_a_file_is_replayed_from_any_folder_and_after_a_move() {
    let dir = folder();
    let inside = |name: &str| dir.path().join(name);
    fs::create_dir_all(inside("runs/of today")).expect("it is writable");
    let out = ["slow-leader-variation.xosc", "--driver", "aeb", "--budget", "2", "--out", "runs/of today/c"];
    succeeds(fuzz(dir.path(), &out));
    let hash = trials(dir.path(), "runs/of today/c")[0]["trace_hash"].as_str().expect("a hash").to_owned();
    let replays = |from: &Path, campaign: &str| {
        let replayed = stdout(&succeeds(fuzz(from, &["replay", campaign, "0"])));
        assert!(replayed.contains(&hash), "{campaign}: {replayed}");
    };
    replays(dir.path(), "runs/of today/c");
    replays(&inside("runs/of today"), "c");
    let elsewhere = tempfile::tempdir().expect("a folder");
    replays(elsewhere.path(), &inside("runs/of today/c").display().to_string());
    // Everything moves together.
    let moved = elsewhere.path().join("moved");
    fs::create_dir_all(moved.join("runs")).expect("it is writable");
    fs::create_dir(moved.join("catalogs")).expect("it is writable");
    for name in FILES {
        fs::rename(inside(name), moved.join(name)).expect("it is there");
    }
    fs::rename(inside("runs/of today/c"), moved.join("runs/c")).expect("it is there");
    replays(&moved.join("catalogs"), "../runs/c");
    // Without its scenario, the campaign says what is missing.
    fs::rename(moved.join("runs/c"), inside("c")).expect("it is there");
    let says = ["found no file slow-leader-variation.xosc in ", "/c, in a folder around it, or in the present folder"];
    refused(&fuzz(elsewhere.path(), &["replay", &inside("c").display().to_string(), "0"]), &says);
}

#[test]
fn the_ending_of_a_scenario_file_may_have_capital_letters() {
    let dir = folder();
    for (from, to) in [("slow-leader.xosc", "LEADER.XOSC"), ("straight.xodr", "STRAIGHT.XODR")] {
        fs::rename(dir.path().join(from), dir.path().join(to)).expect("it is there");
    }
    fs::rename(dir.path().join("catalogs/entities.xosc"), dir.path().join("catalogs/ENTITIES.XOSC"))
        .expect("it is there");
    let text = fs::read_to_string(dir.path().join("LEADER.XOSC")).expect("it is there");
    fs::write(dir.path().join("LEADER.XOSC"), text.replace("straight.xodr", "STRAIGHT.XODR")).expect("it is writable");
    succeeds(fuzz(dir.path(), &["LEADER.XOSC", "--open", "gap=40..60", "--budget", "2", "--out", "c"]));
    succeeds(fuzz(dir.path(), &["export", "c", "0", "--ego-as", "controller", "--out", "case"]));
    succeeds(fuzz(dir.path(), &["roads", "STRAIGHT.XODR"]));
    succeeds(fuzz(dir.path(), &["map-traffic", "--set", "roads=STRAIGHT.XODR", "--budget", "2", "--out", "m"]));
}

#[test]
fn a_campaign_is_not_resumed_after_a_road_that_a_parameter_chooses_has_changed() {
    let dir = folder();
    let road = fs::read_to_string(dir.path().join("straight.xodr")).expect("it is there");
    fs::write(dir.path().join("other.xodr"), &road).expect("it is writable");
    let scenario = fs::read_to_string(dir.path().join("slow-leader.xosc")).expect("it is there");
    let declared = "<ParameterDeclaration name=\"road\" parameterType=\"string\" value=\"straight.xodr\"/>";
    let scenario = scenario.replacen("  </ParameterDeclarations>", &format!("{declared}</ParameterDeclarations>"), 1);
    let scenario = scenario.replace("filepath=\"straight.xodr\"", "filepath=\"$road\"");
    fs::write(dir.path().join("slow-leader.xosc"), scenario).expect("it is writable");
    let variation = fs::read_to_string(dir.path().join("slow-leader-variation.xosc")).expect("it is there");
    let chosen = "<DeterministicSingleParameterDistribution parameterName=\"road\"><DistributionSet>\
                  <Element value=\"straight.xodr\"/><Element value=\"other.xodr\"/>\
                  </DistributionSet></DeterministicSingleParameterDistribution></Deterministic>";
    fs::write(dir.path().join("slow-leader-variation.xosc"), variation.replace("</Deterministic>", chosen))
        .expect("it is writable");
    let given = ["slow-leader-variation.xosc", "--budget", "6"];
    let other = [&given[..], &["--set", "road=other.xodr"]].concat();
    let opened = [&["slow-leader.xosc"], &given[1..], &["--open", "road=straight.xodr,other.xodr"]].concat();
    let of_map = ["map-traffic", "--set", "roads=other.xodr", "--set", "cars=0", "--budget", "2"];
    let all: [(&str, &[&str]); 4] = [("a", &given), ("b", &other), ("c", &opened), ("d", &of_map)];
    let run = |(out, given): (&str, &[&str]), more: &[&str]| fuzz(dir.path(), &[given, &["--out", out], more].concat());
    for one in all {
        succeeds(run(one, &[]));
        succeeds(run(one, &["--resume"]));
    }
    fs::write(dir.path().join("other.xodr"), road.replacen("name=", " name=", 1)).expect("it is writable");
    for one in all {
        refused(&run(one, &["--resume"]), &["`scenario_files`"]);
    }
}
