//! Campaigns that are repeated, split, killed or given worlds that break: nothing is lost, nothing differs.

use crate::common::{fuzz, refused, stderr, succeeds};
use paracosm::engine::{AutonomousVehicle, Pedestrian, Program, RoadSegment, Scenario, Side, eventually, never};
use paracosm::oracles::Verdict;
use paracosm::{Campaign, Study, Trial};
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn log(dir: &Path, name: &str) -> Vec<u8> {
    fs::read(dir.join(name).join("trials.jsonl")).unwrap()
}

fn run(dir: &Path, name: &str, more: &[&str]) -> Vec<u8> {
    succeeds(fuzz(dir, &[&["--budget", "200", "--out", name], more].concat()));
    log(dir, name)
}

#[test]
fn trials_are_the_same_for_any_number_of_jobs_and_for_every_run() {
    let dir = tempfile::tempdir().unwrap();
    let one = run(dir.path(), "one", &["--jobs", "1"]);
    assert_eq!(one, run(dir.path(), "two", &["--jobs", "2"]));
    assert_eq!(one, run(dir.path(), "again", &["--jobs", "2"]));
    assert_eq!(one, run(dir.path(), "eight", &["--jobs", "8"]));
}

#[test]
fn a_log_cut_at_any_byte_is_completed_to_the_same_log() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--budget", "6", "--out", "out", "-q"];
    succeeds(fuzz(dir.path(), &options));
    let whole = log(dir.path(), "out");
    let path = dir.path().join("out/trials.jsonl");
    let first_line = whole.iter().position(|byte| *byte == b'\n').unwrap();
    let cuts = [0, 1, first_line - 1, first_line, first_line + 1, first_line + 2, whole.len() - 1, whole.len()];
    for cut in cuts {
        fs::write(&path, &whole[..cut]).unwrap();
        succeeds(fuzz(dir.path(), &[&options[..], &["--resume"]].concat()));
        assert!(log(dir.path(), "out") == whole, "cut at byte {cut}");
    }
}

#[test]
fn a_campaign_killed_at_a_bad_moment_is_completed_to_the_same_log() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--budget", "1500", "--jobs", "2", "-q"];
    succeeds(fuzz(dir.path(), &[&options[..], &["--out", "whole"]].concat()));
    let whole = log(dir.path(), "whole");
    for lines in [1, 300] {
        let name = format!("killed-{lines}");
        let resume = [&options[..], &["--resume", "--out", &name]].concat();
        let mut child = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
        let mut child = child.args(&resume).current_dir(dir.path()).stdout(Stdio::null()).spawn().unwrap();
        let path = dir.path().join(&name).join("trials.jsonl");
        let begun = Instant::now();
        while fs::metadata(&path).map_or(0, |file| file.len()) < lines * 300 {
            assert!(begun.elapsed() < Duration::from_secs(60), "the campaign writes nothing");
            assert!(child.try_wait().unwrap().is_none(), "the campaign was over before it could be killed");
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(log(dir.path(), &name).len() < whole.len());
        succeeds(fuzz(dir.path(), &resume));
        assert!(log(dir.path(), &name) == whole, "killed after {lines} lines");
    }
}

#[test]
fn a_full_disk_ends_the_campaign_with_a_message_and_loses_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let whole = run(dir.path(), "whole", &[]);
    // A limit on the size of files stands in for the disk: writing fails in the middle of a line.
    let script = "trap '' XFSZ; ulimit -f 40; exec \"$0\" \"$@\"";
    let options = ["--budget", "200", "--out", "full"];
    let mut shell = Command::new("sh");
    let shell = shell.args(["-c", script, env!("CARGO_BIN_EXE_paracosm-fuzz")]).args(options);
    let full = shell.current_dir(dir.path()).output().unwrap();
    refused(&full, &["cannot write", "full/trials.jsonl", "trials are safe", "--resume"]);
    let written = log(dir.path(), "full");
    assert!(whole.starts_with(&written) && written.len() > 10_000 && written.len() < whole.len());
    assert!(run(dir.path(), "full", &["--resume"]) == whole);
}

#[test]
fn a_campaign_whose_folder_is_removed_ends_and_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let child = child.args(["--budget", "1000000", "--out", "out"]).current_dir(dir.path());
    let child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    // The log is the first file of the folder. It gets its first line when the campaign has begun.
    while fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap_or_default().is_empty() {
        std::thread::sleep(Duration::from_millis(1));
    }
    fs::remove_dir_all(dir.path().join("out")).unwrap();
    refused(&child.wait_with_output().unwrap(), &["out/trials.jsonl was removed or moved"]);
}

#[test]
fn a_campaign_whose_tests_end_otherwise_now_is_not_continued() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), "out", &[]);
    let path = dir.path().join("out/trials.jsonl");
    let whole = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = whole.lines().take(100).collect();
    let last = lines.iter().rposition(|line| line.contains("\"verdict\":\"fail\"")).unwrap();
    // To the campaign, a log that was written by other code is a log that was edited.
    for (what, by) in [("trace_hash\":\"", "trace_hash\":\"0"), ("\"no-collision\":-", "\"no-collision\":-1")] {
        let mut edited: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        edited[last] = edited[last].replacen(what, by, 1);
        assert_ne!(edited[last], lines[last]);
        let text = edited.join("\n") + "\n";
        fs::write(&path, &text).unwrap();
        let output = fuzz(dir.path(), &["--budget", "200", "--out", "out", "--resume"]);
        refused(
            &output,
            &[&format!("test {last} ends otherwise than in the log"), "begin a new campaign in another folder"],
        );
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
}

#[test]
fn resume_begins_a_campaign_that_is_not_there_and_does_nothing_to_a_complete_one() {
    let dir = tempfile::tempdir().unwrap();
    let begun = run(dir.path(), "out", &["--resume"]);
    assert_eq!(begun, run(dir.path(), "out", &["--resume"]));
}

#[test]
fn nothing_is_overwritten() {
    let dir = tempfile::tempdir().unwrap();
    let before = run(dir.path(), "out", &[]);
    refused(&fuzz(dir.path(), &["--budget", "200", "--out", "out"]), &["out", "--resume", "--out"]);
    let different = fuzz(dir.path(), &["--budget", "300", "--out", "out", "--resume"]);
    refused(&different, &["out", "different campaign", "`budget` is 200", "300"]);
    assert_eq!(before, log(dir.path(), "out"));
    fs::remove_file(dir.path().join("out/campaign.json")).unwrap();
    let orphan = fuzz(dir.path(), &["--budget", "200", "--out", "out", "--resume"]);
    refused(&orphan, &["trials.jsonl but no campaign.json"]);
    assert_eq!(before, log(dir.path(), "out"));
    fs::create_dir(dir.path().join("mine")).unwrap();
    fs::write(dir.path().join("mine/failure-map.svg"), "a drawing").unwrap();
    refused(&fuzz(dir.path(), &["--out", "mine"]), &["mine", "failure-map.svg"]);
    assert_eq!(fs::read_to_string(dir.path().join("mine/failure-map.svg")).unwrap(), "a drawing");
}

#[test]
fn a_broken_line_in_the_log_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let whole = String::from_utf8(run(dir.path(), "out", &[])).unwrap();
    let path = dir.path().join("out/trials.jsonl");
    let lines: Vec<&str> = whole.lines().collect();
    let with_third = |line: &str| [&lines[..2], &[line], &lines[3..]].concat().join("\n") + "\n";
    for (line, says) in [
        (&lines[2][..40], "the line is not a trial"),
        ("", "the line is not a trial"),
        (lines[7], "found trial 7, expected trial 2"),
        (&lines[2].replace("ticks", "tics"), "tics"),
        (&format!("{}\r", lines[2]), "carriage return"),
    ] {
        fs::write(&path, with_third(line)).unwrap();
        for command in [&["--budget", "200", "--out", "out", "--resume"][..], &["replay", "out", "0"]] {
            refused(&fuzz(dir.path(), command), &["trials.jsonl, line 3", says]);
        }
        assert_eq!(fs::read_to_string(&path).unwrap(), with_third(line), "the log was touched");
    }
    fs::write(&path, [lines[0].as_bytes(), b"\n\xff\xfe\n"].concat()).unwrap();
    refused(&fuzz(dir.path(), &["--budget", "200", "--out", "out", "--resume"]), &["line 2", "UTF-8"]);
    // Another test than the strategy proposes there.
    fs::write(&path, with_third(&lines[2].replace("\"speed\":7.625", "\"speed\":7.5"))).unwrap();
    refused(&fuzz(dir.path(), &["--budget", "200", "--out", "out", "--resume"]), &["trial 2"]);
}

#[test]
fn two_processes_cannot_write_to_one_folder() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), "out", &[]);
    let log = fs::File::options().write(true).open(dir.path().join("out/trials.jsonl")).unwrap();
    log.lock().unwrap();
    refused(&fuzz(dir.path(), &["--budget", "200", "--out", "out", "--resume"]), &["is writing to out"]);
}

/// A study of a program that is not in the catalogue, run to its end.
fn trials(build: fn(&mut Scenario), driver: &str) -> Vec<Trial> {
    let program = Program::new("test", "a world for this test", build);
    let study = Study::of(program).driver(driver).budget(16).build().unwrap();
    let campaign = Campaign::new(&study).unwrap().jobs(NonZeroUsize::new(2).unwrap());
    campaign.into_log().unwrap().trials().to_vec()
}

fn count(trials: &[Trial], verdict: Verdict) -> usize {
    trials.iter().filter(|trial| trial.verdict == verdict).count()
}

#[test]
fn a_test_that_panics_is_an_error_and_the_others_go_on() {
    fn panics(s: &mut Scenario) {
        let x = s.interval("x", 0.0..=1.0);
        assert!(x.value() <= 0.5, "x is {}", x.value());
        let road = s.place(RoadSegment::new(200.0));
        s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(5.0));
        s.duration(1.0);
    }
    let trials = trials(panics, "cruise");
    assert_eq!((count(&trials, Verdict::Error), count(&trials, Verdict::Pass)), (7, 9));
    let error = trials.iter().find_map(Trial::error).unwrap();
    assert!(error.contains("x is 0.75"), "{error}");
}

#[test]
fn a_scenario_that_panics_at_some_values_ends_no_command() {
    fn panics(s: &mut Scenario) {
        let x = s.interval("x", 0.0..=1.0).default(0.1);
        assert!(x.value() <= 0.4, "x is {}", x.value());
        let road = s.place(RoadSegment::new(200.0));
        s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(5.0));
        s.duration(1.0);
    }
    let program = Program::new("panics", "panics at most values", panics);
    let study = Study::of(program.clone()).driver("cruise").budget(4).build().unwrap();
    let said = "scenario `panics` panicked with the values of a test: x is 0.5";
    let test = study.space().decode(&paracosm::space::Point { continuous: vec![0.5], discrete: Vec::new() });
    assert_eq!(program.check(&test).unwrap_err().to_string(), said);
    assert_eq!(program.reaches(&test).unwrap_err().to_string(), said);
    // The commands ask before the tests which parameters nothing reads.
    assert!(paracosm::analysis::effects::foreseen(&study).is_ok());
    let dir = tempfile::tempdir().unwrap();
    let report = paracosm::run_into(&study, &dir.path().join("out"), &mut []).unwrap();
    assert_eq!((report.summary.count(Verdict::Error), report.summary.count(Verdict::Pass)), (2, 2));
}

#[test]
fn a_range_that_is_no_part_of_a_parameter_is_a_mistake_of_the_scenario() {
    fn plausible(s: &mut Scenario) {
        s.interval("v", 1.0..=6.0).plausible(10.0..=20.0);
    }
    fn opens(s: &mut Scenario) {
        s.nominal("v", 1.0..=6.0, 2.0).opens(3.0..=7.0);
    }
    fn turned(s: &mut Scenario) {
        let (least, greatest) = (4.0, 3.0);
        s.interval("v", 1.0..=6.0).plausible(least..=greatest);
    }
    for (build, says) in [
        (plausible as fn(&mut Scenario), "parameter `v`: plausible is 10..20, expected a part of 1..6"),
        (opens, "parameter `v`: opens is 3..7, expected a part of 1..6"),
        (turned, "parameter `v`: plausible is 4..3, expected a part of 1..6"),
    ] {
        let error = Program::new("ranges", "has a wrong range", build).declare().unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn a_state_that_is_no_number_is_an_error() {
    fn no_number(s: &mut Scenario) {
        let x = s.interval("x", 0.0..=1.0);
        let road = s.place(RoadSegment::new(200.0).friction(if x.value() > 0.5 { f64::NAN } else { 0.8 }));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(20.0));
        let walker = s.place(Pedestrian::at(road.on_lane(1, 50.0)));
        walker.walk(road.on_lane(1, 200.0), 1.0);
        s.require("no-collision", never(car.collides()));
    }
    let trials = trials(no_number, "aeb");
    assert_eq!(count(&trials, Verdict::Error), 7);
    let error = trials.iter().find_map(Trial::error).unwrap();
    assert!(error.contains("friction") && error.contains("NaN"), "{error}");
}

#[test]
fn a_world_that_cannot_be_built_is_invalid_and_says_why() {
    fn overlaps(s: &mut Scenario) {
        let at = s.interval("at", 0.0..=100.0);
        let road = s.place(RoadSegment::new(80.0));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)));
        s.place(Pedestrian::at(road.on_lane(1, at.value())));
        s.duration(0.5);
        s.require("still", eventually(car.speed().at_most(0.0)));
    }
    let trials = trials(overlaps, "cruise");
    let errors: Vec<&str> = trials.iter().filter_map(Trial::error).collect();
    assert_eq!(count(&trials, Verdict::Invalid), errors.len());
    assert!(errors.contains(&"car and pedestrian overlap at the start; place them apart"), "{errors:?}");
    assert!(errors.iter().any(|error| error.contains("along `road`, which is 80 m long")), "{errors:?}");
    assert!(count(&trials, Verdict::Pass) > 8);
}

#[test]
fn a_walker_that_never_starts_leaves_the_test_inconclusive() {
    fn never_near(s: &mut Scenario) {
        let speed = s.interval("speed", 1.0..=20.0);
        let road = s.place(RoadSegment::new(500.0));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(speed.value()));
        let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, 100.0)));
        let near = car.gap_along(&road.crossing(100.0)).below(20.0);
        walker.walk(road.on_sidewalk(Side::Right, 100.0), 1.0).skip_until(&near);
        s.premise(&near);
        s.require("no-collision", never(car.collides()));
    }
    let trials = trials(never_near, "aeb");
    assert!(count(&trials, Verdict::Inconclusive) > 0 && count(&trials, Verdict::Pass) > 0);
    for trial in &trials {
        let slow = trial.test.get("speed").unwrap().number().unwrap() * 10.0 < 100.0 - 20.0 - 12.3;
        assert_eq!(trial.verdict == Verdict::Inconclusive, slow, "{trial:?}");
    }
}

#[test]
fn a_requirement_that_a_contact_left_undecided_has_no_robustness() {
    fn ends_early(s: &mut Scenario) {
        let speed = s.interval("speed", 10.0..=20.0);
        let road = s.place(RoadSegment::new(500.0));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(speed.value()));
        s.place(Pedestrian::at(road.on_lane(1, 60.0)));
        s.require("no-collision", never(car.collides())).unit("m");
        s.require("progress", eventually(car.travelled().at_least(100.0))).unit("m");
    }
    for trial in trials(ends_early, "cruise") {
        assert_eq!(trial.verdict, Verdict::Fail);
        assert_eq!(trial.robustness("progress"), None);
        let missing = -trial.robustness("no-collision").unwrap();
        let speed = trial.test.get("speed").unwrap().number().unwrap();
        assert!((missing - speed * speed / (2.0 * 0.8 * 9.80665)).abs() < 1e-9, "{trial:?}");
    }
}

#[test]
fn a_campaign_in_which_every_test_breaks_is_a_failed_run() {
    let dir = tempfile::tempdir().unwrap();
    // Nothing in the catalogue breaks; a log in which everything broke does as well.
    run(dir.path(), "out", &[]);
    let path = dir.path().join("out/trials.jsonl");
    let broken = fs::read_to_string(&path).unwrap().replace("\"pass\"", "\"error\"").replace("\"fail\"", "\"error\"");
    fs::write(&path, broken.replace("\"error\":null", "\"error\":\"out of fuel\"")).unwrap();
    let output = fuzz(dir.path(), &["--budget", "200", "--out", "out", "--resume"]);
    refused(&output, &["every test ended in an error", "out of fuel"]);
    assert!(!stderr(&output).is_empty());
}
