//! Parameters that vary over time, from the command line to the files and back; and what a scenario is made of.

use crate::common::{cover, fuzz, golden, refused, stderr, stdout, succeeds};
use std::fs;
use std::path::Path;

const OPEN: [&str; 6] =
    ["--open", "friction:piecewise-linear:2=0.3..0.8", "--open", "speed:polynomial:1", "--set", "distance=25"];

fn campaign(dir: &Path, out: &str, budget: &str, more: &[&str]) {
    succeeds(fuzz(dir, &[&["--budget", budget, "--out", out], more].concat()));
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_parameter_is_opened_as_a_signal_and_its_values_are_a_list() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "out", "20", &OPEN);
    let read = |name: &str| fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    let study = json(&read("campaign.json"));
    assert_eq!(study["space"]["parameter"][1]["signal"], json(r#"{"shape": "piecewise-linear", "pieces": 2}"#));
    let trial = json(read("trials.jsonl").lines().next().unwrap());
    assert_eq!(trial["test"]["speed"].as_array().unwrap().len(), 2);
    assert_eq!(trial["test"]["friction"].as_array().unwrap().len(), 3);
    let header = "index,speed[0],speed[1],friction[0],friction[1],friction[2],verdict,";
    assert!(read("trials.csv").starts_with(header));
    let names = json(r#"["speed[0]", "speed[1]", "friction[0]", "friction[1]", "friction[2]"]"#);
    assert_eq!(json(&read("coverage.json"))["continuous"]["parameters"], names);
    assert!(read("failure-map.svg").contains("speed[1] (m/s)"));
}

#[test]
fn a_signal_moves_what_reads_it() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "out", "1", &["--open", "speed:piecewise-linear:1", "--set", "distance=60"]);
    let replay = succeeds(fuzz(dir.path(), &["replay", "out", "0", "--format", "table"]));
    assert!(stdout(&replay).contains("[5.25, 3.6667] m/s"), "{}", stdout(&replay));
    let trace = fs::read_to_string(dir.path().join("out/trace-0.csv")).unwrap();
    let column = trace.lines().next().unwrap().split(',').position(|name| name == "pedestrian.speed").unwrap();
    let speeds = trace.lines().skip(1).map(|line| line.split(',').nth(column).unwrap().parse::<f64>().unwrap());
    let walking: Vec<f64> = speeds.filter(|speed| *speed > 0.0).collect();
    // The last step is only as long as the way that is left.
    let falling = walking[..walking.len() - 1].windows(2).all(|pair| pair[1] < pair[0]);
    assert!(falling && walking[0] < 5.25 && walking[1] > 3.7, "{walking:?}");
}

#[test]
fn a_campaign_over_signals_is_resumed_to_the_same_log() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "whole", "30", &OPEN);
    campaign(dir.path(), "cut", "30", &OPEN);
    let log = dir.path().join("cut/trials.jsonl");
    let whole = fs::read(dir.path().join("whole/trials.jsonl")).unwrap();
    fs::write(&log, &whole[..whole.len() / 2]).unwrap();
    campaign(dir.path(), "cut", "30", &[&OPEN[..], &["--resume", "--jobs", "1"]].concat());
    assert_eq!(fs::read(&log).unwrap(), whole);
}

#[test]
fn tests_of_signals_are_made_and_measured_as_tables() {
    let dir = tempfile::tempdir().unwrap();
    let toml = "[[parameter]]\nname = \"weather\"\nchoice = [\"clear\", \"fog\"]\n\
                signal = { shape = \"piecewise-constant\", pieces = 2 }\n\
                [[parameter]]\nname = \"leader_speed\"\ninterval = [0.0, 20.0]\n\
                signal = { shape = \"polynomial\", degree = 1 }\n";
    fs::write(dir.path().join("SPACE.toml"), toml).unwrap();
    let space = ["--space", "SPACE.toml"];
    let tests = cover(dir.path(), &[&["generate", "--budget", "30", "--discrete", "cross"], &space[..]].concat());
    let tests = stdout(&succeeds(tests));
    assert!(tests.starts_with("weather[0],weather[1],leader_speed[0],leader_speed[1]\n"), "{tests}");
    fs::write(dir.path().join("tests.csv"), &tests).unwrap();
    let printed = cover(dir.path(), &[&["estimate", "tests.csv", "--k", "2", "--format", "json"], &space[..]].concat());
    let measured = json(&stdout(&succeeds(printed)));
    assert_eq!(measured["discrete"]["valid"], 4);
    assert_eq!(measured["discrete"]["ratio"], 1.0);
    assert!(measured["continuous"]["dispersion"]["largest_empty_box"]["leader_speed[1]"].is_array());
    fs::write(dir.path().join("tests.csv"), tests.replace("leader_speed[1]", "leader_speed")).unwrap();
    let missing = cover(dir.path(), &[&["estimate", "tests.csv"], &space[..]].concat());
    refused(&missing, &["tests.csv, line 1", "no column is called `leader_speed[1]`"]);
}

#[test]
fn a_value_at_every_tick_is_for_those_who_ask() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--strategy", "random", "--open", "friction:per-tick", "--set", "speed=2", "--set", "distance=25"];
    campaign(dir.path(), "out", "3", &options);
    let trials = fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap();
    let trial = json(trials.lines().next().unwrap());
    assert_eq!(trial["test"]["friction"].as_array().unwrap().len(), 2500);
}

#[test]
fn signals_that_cannot_be_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let cases: &[(&[&str], &[&str])] = &[
        (&["--open", "friction:polinomial:2"], &["`polinomial`", "`polynomial`"]),
        (&["--open", "friction:polynomial"], &["`polynomial`", "number"]),
        (&["--open", "friction:piecewise-constant:0"], &["`friction`", "0 coordinates"]),
        (&["--open", "lanes:polynomial:2"], &["`lanes`", "piecewise-constant"]),
        (&["--open", "lanes:piecewise-constant:2"], &["`lanes` varies over time", "a single value"]),
        (&["--open", "speed:polynomial:2", "--set", "speed=2"], &["`speed`", "set and opened"]),
        (&["--set", "friction=0.3,0.4"], &["`friction`", "[0.3, 0.4]"]),
    ];
    for (arguments, says) in cases {
        refused(&fuzz(dir.path(), arguments), says);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "{arguments:?} wrote something");
    }
}

#[test]
fn a_scenario_is_described_and_drawn() {
    let dir = tempfile::tempdir().unwrap();
    let describe =
        |more: &[&str]| stdout(&succeeds(fuzz(dir.path(), &[&["describe", "pedestrian-crossing"], more].concat())));
    golden("describe.txt", &describe(&["--format", "table"]));
    golden("describe.dot", &describe(&["--dot"]));
    let described = json(&describe(&["--format", "json"]));
    assert_eq!(described["parameters"][0]["parameter"]["name"], "speed");
    assert_eq!(described["requirements"][0]["id"], "no-collision");
    // As it is set and opened for a campaign.
    let changed = ["--set", "friction=0.3", "--set", "speed=2", "--open", "lanes=2,4", "--format"];
    let told = describe(&[&changed[..], &["table"]].concat());
    let told: Vec<String> = told.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    for line in [
        "speed 0.5..10 m/s, nominally 1.4, plausibly 0.5..2.8, set to 2",
        "friction 0.2..0.8, nominally 0.8, set to 0.3",
        "lanes 2,4, nominally 2, open",
        "fog 0..1, nominally 0, unless opened",
    ] {
        assert!(told.iter().any(|found| found == line), "{told:#?}");
    }
    let told = json(&describe(&[&changed[..], &["json"]].concat()));
    assert_eq!((&told["parameters"][0]["open"], &told["parameters"][0]["set"]), (&false.into(), &2.into()));
    let unknown = fuzz(dir.path(), &["describe", "--set", "fiction=0.3"]);
    crate::common::refused(&unknown, &["`fiction`", "`friction`"]);
    let unknown = fuzz(dir.path(), &["describe", "pedestrian-crosing"]);
    refused(&unknown, &["`pedestrian-crossing`"]);
    assert!(stderr(&unknown).contains("paracosm-fuzz list"));
}
