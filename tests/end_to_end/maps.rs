//! Failure maps with the probability of failure, over any two parameters, and explanations in words.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use paracosm::generators::{FailureModel, Strategy};
use paracosm::report::{FailureMap, Picture};
use paracosm::space::Point;
use paracosm::{Campaign, Log, Study};
use std::fs;
use std::path::Path;

/// A campaign of three numbers and a choice in `dir/out`.
fn campaign(dir: &Path) -> String {
    let arguments = ["--budget", "80", "--open", "friction", "--open", "lanes=2,4", "--format", "table"];
    stdout(&succeeds(fuzz(dir, &[&arguments[..], &["--out", "out"]].concat())))
}

#[test]
fn a_map_over_other_parameters_says_what_is_known_of_every_place() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path());
    let read = |name: &str| fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    assert!(read("failure-map.csv").starts_with("speed,distance,probability,deviation,decided\n"));
    let map = ["map", "out", "--x", "distance", "--y", "friction", "--format", "json"];
    let said = stdout(&succeeds(fuzz(dir.path(), &map)));
    assert!(said.contains("\"others\": [\n    \"speed\",\n    \"lanes\"\n  ]"), "{said}");
    let (picture, numbers) = (read("failure-map.svg"), read("failure-map.csv"));
    for text in [
        "distance (m)",
        "friction",
        "averaged over the other open parameters: speed,",
        "probability of failure",
        "undecided",
    ] {
        assert!(picture.contains(text), "{text}");
    }
    assert!(picture.len() < 200_000, "{} bytes", picture.len());
    let mut decided = 0;
    for line in numbers.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [x, y, p, deviation] = [0, 1, 2, 3].map(|i| fields[i].parse::<f64>().unwrap());
        assert!((5.0..=60.0).contains(&x) && (0.2..=0.8).contains(&y), "{line}");
        assert!((0.0..=1.0).contains(&p) && (0.0..=0.6).contains(&deviation), "{line}");
        decided += usize::from(!fields[4].is_empty());
    }
    let places = numbers.lines().count() - 1;
    let share = decided as f64 / places as f64;
    let told: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert!((told["decided"].as_f64().unwrap() - share).abs() < 1e-12, "{said} {share}");
    // Drawn again it is the same, also in the place of what was drawn before.
    fs::write(dir.path().join("mine.svg"), "older").unwrap();
    succeeds(fuzz(dir.path(), &[&map[..], &["--out", "mine.svg"]].concat()));
    assert!(fs::read_to_string(dir.path().join("mine.svg")).unwrap() == picture);
    refused(
        &fuzz(dir.path(), &[&map[..], &["--out", "out/failure-map.csv"]].concat()),
        &["a file that belongs to campaigns"],
    );
}

#[test]
fn five_tests_in_ten_parameters_decide_nothing_of_a_map() {
    let dir = tempfile::tempdir().unwrap();
    let parameter =
        |i: usize| format!("[[parameter]]\nname = \"a_parameter_with_a_name_{i}\"\ninterval = [0.0, 1.0]\n");
    fs::write(dir.path().join("space.toml"), (0..10).map(parameter).collect::<String>()).unwrap();
    // Fails in one test of two.
    let system = "i=0; while read -r line; do echo \"{\\\"index\\\":$i,\\\"robustness\\\":{\\\"above\\\":$((1 - 2 * (i % 2)))}}\"; \
        i=$((i + 1)); done";
    fs::write(dir.path().join("system.sh"), system).unwrap();
    let run =
        ["--system", "sh system.sh", "--space", "space.toml", "--budget", "5", "--jobs", "1", "--out", "out", "-q"];
    succeeds(fuzz(dir.path(), &run));
    let said = stdout(&succeeds(fuzz(dir.path(), &["map", "out", "--format", "table"])));
    assert!(said.contains("decided               nothing of the map: more tests are needed"), "{said}");
    // What varies beside the axes is said in lines that are no longer than the picture is wide.
    let picture = fs::read_to_string(dir.path().join("out/failure-map.svg")).unwrap();
    let texts: Vec<&str> = picture.lines().filter(|line| !line.contains('<')).collect();
    let note: Vec<&&str> = texts.iter().filter(|text| text.contains("a_parameter_with_a_name_")).collect();
    assert!(note.len() == 5 && texts.iter().all(|text| text.len() < 140), "{texts:?}");
}

#[test]
fn a_map_over_what_is_no_axis_is_refused_with_the_parameters_that_are() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path());
    let map = |more: &[&str]| fuzz(dir.path(), &[&["map", "out"], more].concat());
    refused(
        &map(&["--x", "sped", "--y", "friction"]),
        &["do not vary a parameter `sped`", "did you mean `speed`", "distance, friction"],
    );
    refused(&map(&["--x", "lanes"]), &["`lanes` is a discrete parameter", "speed, distance, friction"]);
    refused(&map(&["--x", "speed", "--y", "speed"]), &["both axes are `speed`"]);
    refused(&map(&["--out", "map.gif"]), &["--out map.gif", ".svg or .png or .csv"]);
    refused(&fuzz(dir.path(), &["map", "nowhere"]), &["nowhere"]);
    let one = ["--budget", "9", "--set", "speed=2", "--out", "one"];
    let said = stderr(&succeeds(fuzz(dir.path(), &one)));
    assert!(said.contains("no failure map"), "{said}");
    refused(&fuzz(dir.path(), &["map", "one"]), &["two open continuous parameters"]);
}

#[test]
fn where_all_tests_pass_the_map_has_marks_and_nothing_is_estimated() {
    let dir = tempfile::tempdir().unwrap();
    let open = ["--open", "distance=50..60", "--open", "speed=5..9", "--budget", "12", "--out", "out"];
    succeeds(fuzz(dir.path(), &open));
    assert!(dir.path().join("out/failure-map.svg").exists());
    assert!(!dir.path().join("out/failure-map.csv").exists());
    assert!(!dir.path().join("out/explanation.json").exists());
    refused(&fuzz(dir.path(), &["map", "out", "--out", "map.csv"]), &["map.csv", "a failing test and a passing test"]);
}

#[test]
fn a_campaign_says_in_words_when_tests_fail_and_how_far_that_can_be_trusted() {
    let dir = tempfile::tempdir().unwrap();
    let arguments = ["--driver", "cruise", "--budget", "500", "--out", "out"];
    let summary = stdout(&succeeds(fuzz(dir.path(), &[&arguments[..], &["--format", "table"]].concat())));
    let (_, shown) = summary.split_once("  explanation").unwrap();
    let lines = shown.lines().take_while(|line| !line.starts_with("  picture"));
    let shown = lines.map(|line| line.trim_start().trim_start_matches("how good").trim_start()).collect::<Vec<_>>();
    let text = fs::read_to_string(dir.path().join("out/explanation.json")).unwrap();
    let told: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(shown.join("; "), told["words"].as_str().unwrap());
    // The rules are counted again from the table, by their words.
    let table = fs::read_to_string(dir.path().join("out/trials.csv")).unwrap();
    let tests: Vec<(f64, f64, bool)> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>())
        .map(|fields| (fields[1].parse().unwrap(), fields[2].parse().unwrap(), fields[3] == "fail"))
        .collect();
    let holds = |condition: &str, (speed, distance, _): &(f64, f64, bool)| {
        let words: Vec<&str> = condition.split(' ').collect();
        let value = if words[0] == "speed" { speed } else { distance };
        let number = |i: usize| words[i].parse::<f64>().unwrap();
        match words[1] {
            ">" => *value > number(2),
            "<" => *value < number(2),
            _ => number(2) < *value && *value < number(4),
        }
    };
    let rules = told["rules"].as_array().unwrap();
    assert!(!rules.is_empty() && rules.len() < 5, "{text}");
    for rule in rules {
        let conditions: Vec<&str> = rule["conditions"].as_array().unwrap().iter().filter_map(|c| c.as_str()).collect();
        let inside = tests.iter().filter(|test| conditions.iter().all(|condition| holds(condition, test)));
        assert_eq!(rule["tests"], inside.clone().count(), "{text}");
        assert_eq!(rule["failures"], inside.filter(|test| test.2).count(), "{text}");
    }
}

/// A campaign in so many open parameters more than the scenario's own, and its tests.
fn run(scenario: &str, open: &[&str], budget: usize) -> Log {
    let study = Study::of(paracosm::catalogue().find(scenario).unwrap()).budget(budget);
    let study = open.iter().fold(study, |study, name| study.open(name)).build().unwrap();
    Campaign::new(&study).unwrap().into_log().unwrap()
}

#[test]
fn over_whichever_parameters_a_map_is_drawn_as_many_tests_fail_in_all_as_were_counted() {
    let log = run("pedestrian-crossing", &["friction", "fog", "light", "lanes"], 500);
    let counted = log.trials().iter().filter(|trial| trial.is_failure()).count() as f64 / 500.0;
    // Two standard errors of the count.
    let error = 2.0 * (counted * (1.0 - counted) / 500.0).sqrt();
    for pair in [["speed", "distance"], ["friction", "light"], ["fog", "friction"], ["fog", "light"]] {
        let estimate = FailureMap::over(&log, pair).unwrap().estimate.unwrap();
        assert!((estimate.mean() - counted).abs() < error, "{pair:?}: {}, counted {counted}", estimate.mean());
    }
}

#[test]
fn where_tests_cannot_be_built_the_map_is_invalid_and_failing_is_counted_among_the_others() {
    let log = run("cut-in", &[], 300);
    let map = FailureMap::over(&log, ["ego_speed", "relative_speed"]).unwrap();
    let estimate = map.estimate.as_ref().unwrap();
    let csv = String::from_utf8(estimate.csv()).unwrap();
    let (mut right, mut places) = (0, 0);
    for line in csv.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [ego, relative] = [0, 1].map(|i| fields[i].parse::<f64>().unwrap());
        // The other vehicle would drive backwards, or slower than half of the lateral speeds (0.5 to 3 m/s).
        let other = (ego + relative) / 3.6;
        right += usize::from((other < 1.75) == (fields[4] == "invalid"));
        assert_eq!(fields[2].is_empty(), fields[4] == "invalid", "{line}");
        places += 1;
    }
    assert!(right as f64 > 0.95 * f64::from(places), "{right} of {places} places");
    let failing = log.trials().iter().filter(|trial| trial.is_failure()).count() as f64;
    let counted = failing / log.trials().iter().filter(|trial| trial.covers()).count() as f64;
    assert!((estimate.mean() - counted).abs() < 0.05, "{}, counted {counted}", estimate.mean());
    let picture = Picture::of(map).svg().unwrap();
    assert!(picture.contains("invalid"));
}

/// The tests of a campaign in three parameters, with their robustness.
fn three_parameters(strategy: Strategy, budget: usize) -> (Study, Vec<Point>, Vec<f64>) {
    let study = Study::of(paracosm::catalogue().find("pedestrian-crossing").unwrap()).open("friction");
    let study = study.strategy(strategy).budget(budget).seed(1).build().unwrap();
    let log = Campaign::new(&study).unwrap().into_log().unwrap();
    let points = log.trials().iter().map(|trial| study.space().encode(&trial.test).unwrap()).collect();
    let robustness = log.trials().iter().map(|trial| log.scales().objective(trial).unwrap()).collect();
    (study, points, robustness)
}

#[test]
fn after_200_tests_of_boundary_95_percent_of_the_map_are_told_right() {
    let (study, tests, robustness) = three_parameters(Strategy::BOUNDARY, 200);
    let (_, map, truth) = three_parameters(Strategy::RANDOM, 4000);
    let model = FailureModel::fit(study.space(), &tests, &robustness).unwrap();
    let told = model.probabilities(&map);
    let right = told.iter().zip(&truth).filter(|(p, truth)| (**p > 0.5) == truth.is_sign_negative()).count();
    assert!(right as f64 >= 0.95 * 4000.0, "{right} of 4000");
}

#[test]
fn the_first_map_is_over_the_parameters_that_separate_failing_tests_best() {
    let dir = tempfile::tempdir().unwrap();
    let run = ["cut-in", "--driver", "rss", "--budget", "300", "--out", "out"];
    let summary = stdout(&succeeds(fuzz(dir.path(), &run)));
    let read = |name: &str| fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    assert!(read("explanation.json").contains("where gap < "), "{}", read("explanation.json"));
    // The gap is the third parameter of the scenario.
    let header = read("failure-map.csv").lines().next().unwrap().to_owned();
    assert!(header.split(',').take(2).any(|name| name == "gap"), "{header}");
    assert!(summary.contains("out/failure-map.png, over gap (m) and "), "{summary}");
    // The same axes are the default of `map`, and one axis that is given leaves room for the best other one.
    let other = read("failure-map.csv");
    succeeds(fuzz(dir.path(), &["map", "out"]));
    assert_eq!(read("failure-map.csv"), other);
    succeeds(fuzz(dir.path(), &["map", "out", "--x", "ego_speed"]));
    assert!(read("failure-map.csv").starts_with("ego_speed,gap,"));
}

#[test]
fn a_map_names_the_parameters_that_changed_nothing() {
    let dir = tempfile::tempdir().unwrap();
    // The driver `aeb` does not see the fog.
    succeeds(fuzz(dir.path(), &["--open", "fog", "--budget", "60", "--out", "out"]));
    let read = |name: &str| fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    let picture = read("failure-map.svg");
    assert!(picture.contains("no effect: fog"), "{picture}");
    succeeds(fuzz(dir.path(), &["map", "out", "--x", "fog", "--y", "speed", "--out", "fog.svg"]));
    let other = fs::read_to_string(dir.path().join("fog.svg")).unwrap();
    assert!(other.contains("no effect: fog"), "{other}");
    // The same axes give the same picture again.
    succeeds(fuzz(dir.path(), &["map", "out"]));
    assert_eq!(read("failure-map.svg"), picture);
    succeeds(fuzz(dir.path(), &["--budget", "60", "--out", "none"]));
    assert!(!fs::read_to_string(dir.path().join("none/failure-map.svg")).unwrap().contains("no effect"));
}
