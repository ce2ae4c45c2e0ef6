//! Whose fault failures are: every failing test again with the reference drivers.

use crate::common::{fuzz, golden, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;

const REFERENCES: [&str; 5] = ["ideal", "cc", "rss", "fsm", "cruise"];

fn read(dir: &Path, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(dir.join(name)).unwrap()).unwrap()
}

/// The trials of the campaign that these arguments ask for.
fn campaign(dir: &Path, out: &str, more: &[&str]) -> Vec<Value> {
    succeeds(fuzz(dir, &[&["--out", out, "-q"], more].concat()));
    let log = fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn blame(dir: &Path, out: &str, more: &[&str]) -> String {
    stdout(&succeeds(fuzz(dir, &[&["blame", out, "-q"], more].concat())))
}

/// Whose fault each failure is, found again from whole campaigns of all the drivers over the same tests, in which
/// nothing but a contact can go wrong.
fn found_again(dir: &Path, more: &[&str]) -> Vec<Value> {
    let failing = campaign(dir, "out", more);
    let others: Vec<Vec<Value>> =
        REFERENCES.iter().map(|name| campaign(dir, name, &[more, &["--driver", name]].concat())).collect();
    let failures = failing.iter().enumerate().filter(|(_, trial)| trial["verdict"] == "fail");
    let fault = |(index, trial): (usize, &Value)| {
        assert!(trial["robustness"]["no-collision"].as_f64().unwrap() < 0.0, "{trial}");
        let hits = |driver: &usize| others[*driver][index]["metrics"]["contact_with"] != Value::Null;
        let by: Vec<&str> = (0..REFERENCES.len()).filter(|driver| !hits(driver)).map(|i| REFERENCES[i]).collect();
        let fault = match by.last() {
            None => "unpreventable",
            Some(&"cruise") => "induced",
            Some(_) => "preventable",
        };
        serde_json::json!([index, trial["test"], fault, by])
    };
    failures.map(fault).collect()
}

#[test]
fn it_says_which_files_it_has_written() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "out", &["--budget", "40"]);
    let said = stderr(&succeeds(fuzz(dir.path(), &["blame", "out", "--driver", "ideal"])));
    let written = "written to out/blame.json, out/blame.csv, out/blame-map.svg, out/blame-map.png";
    assert!(said.contains(written), "{said}");
    assert!(["json", "csv"].iter().all(|ending| dir.path().join(format!("out/blame.{ending}")).exists()));
}

#[test]
fn faults_are_those_that_whole_campaigns_of_the_references_show() {
    for more in [&["--budget", "120"][..], &["cut-in", "--budget", "100"]] {
        let dir = tempfile::tempdir().unwrap();
        let expected = found_again(dir.path(), more);
        blame(dir.path(), "out", &[]);
        let told = read(dir.path(), "out/blame.json");
        let failures = told["failures"].as_array().unwrap();
        let found: Vec<Value> = failures
            .iter()
            .map(|blamed| serde_json::json!([blamed["index"], blamed["test"], blamed["fault"], blamed["prevented_by"]]))
            .collect();
        assert_eq!(found, expected, "{more:?}");
        let mut kinds: Vec<&str> = failures.iter().filter_map(|blamed| blamed["fault"].as_str()).collect();
        kinds.sort_unstable();
        kinds.dedup();
        assert!(kinds.len() > 1, "{more:?}: {kinds:?}");
        for kind in ["unpreventable", "preventable", "induced"] {
            let count = failures.iter().filter(|blamed| blamed["fault"] == kind).count();
            assert_eq!(told["faults"][kind], count, "{more:?}");
        }
    }
}

#[test]
fn what_the_car_can_stop_for_is_never_unpreventable() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "out", &["--budget", "200", "--driver", "cruise"]);
    blame(dir.path(), "out", &["--driver", "ideal"]);
    // At 60 km/h on a friction of 0.8, with a tenth of a second until the driver is asked and its margin of 0.3 m.
    let speed = 60.0 / 3.6;
    let stops = speed * speed / (2.0 * 0.8 * 9.81) + 0.1 * speed + 0.3;
    let told = read(dir.path(), "out/blame.json");
    let (mut near, mut far) = (0, 0);
    for blamed in told["failures"].as_array().unwrap() {
        let distance = blamed["test"]["distance"].as_f64().unwrap();
        if distance > stops {
            assert_eq!(blamed["fault"], "preventable", "{blamed}");
            far += 1;
        }
        near += usize::from(blamed["fault"] == "unpreventable");
    }
    assert!(near > 5 && far > 20, "{near} unpreventable, {far} from far");
}

#[test]
fn the_table_says_whose_fault_failures_are_and_the_folder_has_all_of_them() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "out", &["--budget", "60"]);
    golden("blame.txt", &blame(dir.path(), "out", &["--format", "table", "--limit", "3"]));
    let files = ["blame.json", "blame.csv", "blame-map.svg"];
    let contents = || files.map(|name| fs::read_to_string(dir.path().join("out").join(name)).unwrap());
    let first = contents();
    let [told, table, picture] = &first;
    let failures = serde_json::from_str::<Value>(told).unwrap()["failures"].as_array().unwrap().len();
    assert_eq!(table.lines().count(), failures + 1);
    let header = "index,speed,distance,violates,fault,prevented_by,verdict.ideal,robustness.no-collision.ideal,";
    assert!(table.starts_with(header), "{table}");
    for text in ["unpreventable 4", "preventable 4", "induced 0", "pass 52", "judged by ideal, cc", "speed (m/s)"] {
        assert!(picture.contains(text), "{text}");
    }
    assert!(dir.path().join("out/blame-map.png").exists());
    for jobs in ["1", "2", "7"] {
        assert_eq!(blame(dir.path(), "out", &["--jobs", jobs, "--format", "json"]), first[0], "{jobs} jobs");
        assert!(contents() == first, "{jobs} jobs");
    }
}

#[test]
fn others_may_be_asked_and_the_map_has_the_axes_that_are_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let more = ["cut-in", "--budget", "60", "--spec", "always[0,5] (car.speed > 1)"];
    campaign(dir.path(), "out", &more);
    let asked = ["--driver", "reg157,aeb", "--x", "gap", "--y", "lateral_speed", "--format", "json"];
    let told: Value = serde_json::from_str(&blame(dir.path(), "out", &asked)).unwrap();
    assert_eq!(told["references"], serde_json::json!(["reg157", "aeb"]));
    // The driver under test cannot prevent its own failures.
    assert_eq!(told["prevents"]["aeb"], 0);
    let picture = fs::read_to_string(dir.path().join("out/blame-map.svg")).unwrap();
    assert!(picture.contains("gap (m)") && picture.contains("lateral_speed (m/s)"));
    refused(&fuzz(dir.path(), &["blame", "out", "--x", "gapp"]), &["`gapp`", "did you mean `gap`"]);
    let one = ["--budget", "12", "--set", "distance=11", "--driver", "cruise"];
    campaign(dir.path(), "one", &one);
    let said = stderr(&succeeds(fuzz(dir.path(), &["blame", "one"])));
    assert!(said.contains("no map") && !dir.path().join("one/blame-map.svg").exists(), "{said}");
}

#[test]
fn where_nothing_fails_nobody_is_to_blame() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "out", &["--budget", "5", "--open", "distance=50..60"]);
    let said = blame(dir.path(), "out", &["--format", "table"]);
    assert_eq!(said, "pedestrian-crossing, driver aeb: 5 tests, no failure, so nobody is to blame\n");
    assert_eq!(read(dir.path(), "out/blame.json")["failures"], serde_json::json!([]));
}

#[test]
fn who_cannot_be_asked_is_named() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "out", &["--budget", "3"]);
    let blame = |more: &[&str]| fuzz(dir.path(), &[&["blame"], more].concat());
    refused(&blame(&["out", "--driver", "ideal,cruse"]), &["no driver is called `cruse`", "did you mean `cruise`"]);
    refused(&blame(&["out", "--driver", "ideal,cc,ideal"]), &["driver `ideal` is named twice, expected once"]);
    refused(&blame(&["out", "--driver", ""]), &["no driver is called ``"]);
    refused(&blame(&["nowhere"]), &["nowhere"]);
    fs::write(dir.path().join("SPACE.toml"), "parameter = [{ name = \"x\", interval = [-1, 1] }]\n").unwrap();
    let answer = r#"while read -r line; do i=${line#*:}; echo "{\"index\":${i%%,*},\"robustness\":{\"a\":-1}}"; done"#;
    fs::write(dir.path().join("system.sh"), answer).unwrap();
    let system = ["--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "3", "--out", "system", "-q"];
    succeeds(fuzz(dir.path(), &system));
    refused(&blame(&["system"]), &["the system `sh system.sh`", "cannot replace"]);
}
