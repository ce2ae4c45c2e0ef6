//! Formulas asked of traces in files and pipes.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

const TRACE: &str = "time,speed,on\n0,1,true\n0.5,3,true\n1,2,false\n1.5,0,false\n";

#[test]
fn a_formula_is_judged_with_its_moment_and_its_reason() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("t.csv"), TRACE).unwrap();
    let specs = [
        "--spec",
        "always (speed < 2.5)",
        "--spec",
        "eventually[0,9] on until (speed > 2)",
        "--spec",
        "F[0,9] (speed > 9)",
    ];
    let asked = [&["monitor", "t.csv"][..], &specs].concat();
    let said = succeeds(fuzz(dir.path(), &[&asked[..], &["--format", "json"]].concat()));
    assert!(stderr(&said).contains("spec-1 violated at 0.5 s\n"), "{}", stderr(&said));
    let said: Value = serde_json::from_str(&stdout(&said)).unwrap();
    let first = json!({"id": "spec-1", "formula": "always (speed < 2.5)", "truth": "violated", "decided_at": 0.5,
        "robustness": -0.5, "lower": -0.5, "upper": -0.5, "cause": {"time": 0.5, "part": "(speed < 2.5)"}});
    assert_eq!((&said["requirements"][0], &said["samples"], &said["complete"]), (&first, &json!(4), &json!(true)));
    assert_eq!(said["requirements"][1]["truth"], "holds");
    assert_eq!(
        (&said["requirements"][2]["truth"], &said["requirements"][2]["upper"]),
        (&json!("undecided"), &json!("inf"))
    );
    let table = stdout(&succeeds(fuzz(dir.path(), &[&asked[..], &["--format", "table"]].concat())));
    assert!(table.contains("violated, known at 0.5 s") && table.contains("`(speed < 2.5)` at 0.5 s"), "{table}");
    let status = |more: &[&str]| fuzz(dir.path(), &[&asked[..], more].concat()).status.code();
    assert_eq!(status(&["--fail-on-violation"]), Some(1));
    let dense = ["monitor", "t.csv", "--dense", "--spec", "always[0.125,0.25] (speed > 1)", "--format", "json"];
    let dense: Value = serde_json::from_str(&stdout(&succeeds(fuzz(dir.path(), &dense)))).unwrap();
    assert_eq!((&dense["requirements"][0]["robustness"], &dense["time"]), (&json!(0.5), &json!("dense")));
    assert_eq!(dense["requirements"][0]["cause"], json!({"time": 0.125, "part": "(speed > 1)"}));
}

#[test]
fn a_stream_is_left_when_all_is_decided() {
    let dir = tempfile::tempdir().unwrap();
    let mut monitor = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"))
        .args(["monitor", "--spec", "always (speed < 2.5)", "--stop-when-decided", "--format", "json"])
        .current_dir(dir.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The pipe stays open: it must not wait for more.
    let mut stream = monitor.stdin.take().unwrap();
    stream.write_all(TRACE.as_bytes()).unwrap();
    stream.flush().unwrap();
    let output = monitor.wait_with_output().unwrap();
    drop(stream);
    let said: Value = serde_json::from_str(&stdout(&succeeds(output))).unwrap();
    assert_eq!((&said["samples"], &said["complete"]), (&json!(2), &json!(false)));
    let requirement = &said["requirements"][0];
    assert_eq!((&requirement["robustness"], &requirement["lower"]), (&json!(-0.5), &json!("-inf")));
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("t.csv"), TRACE).unwrap();
    fs::write(dir.path().join("gap.csv"), TRACE.replace("1,2,", "1,NaN,")).unwrap();
    for (arguments, says) in [
        (&["t.csv", "--spec", "always (sped < 2)"][..], &["--spec always (sped < 2)", "did you mean `speed`?"][..]),
        (&["t.csv", "--spec", "always[0,0.25] (speed < 2)"], &["0.25 s is not a multiple"]),
        (&["t.csv", "--spec", "always (speed <"], &["column 16"]),
        (&["gap.csv", "--spec", "always (speed < 2)"], &["gap.csv", "line 4", "`speed` is `NaN`"]),
        (&["none.csv", "--spec", "always (speed < 2)"], &["cannot read none.csv"]),
        (&["t.csv"], &["--spec"]),
        (&["t.csv", "--dense", "--spec", "always on"], &["spec-1", "not a piecewise linear function"]),
    ] {
        refused(&fuzz(dir.path(), &[&["monitor"], arguments].concat()), says);
    }
}

#[test]
fn a_log_with_uneven_samples_is_sampled_again() {
    let dir = tempfile::tempdir().unwrap();
    let log = "time,speed,brake\n1764324000.5,10,false\n1764324000.75,20,true\n1764324002.5,20,true\n";
    std::fs::write(dir.path().join("log.csv"), log).unwrap();
    let run = |more: &[&str]| {
        fuzz(dir.path(), &[&["monitor", "log.csv", "--spec", "always[0,0.2] (speed < 17)"], more].concat())
    };
    refused(&run(&[]), &["the trace begins at 1764324000.5 s, expected 0 s", "--every SECONDS"]);
    // 10 m/s rise to 20 m/s within a quarter of a second.
    let found = stdout(&succeeds(run(&["--every", "0.05"])));
    assert!(found.contains("41 samples every 0.05 s") && found.contains("violated"), "{found}");
    refused(&run(&["--every", "0"]), &["--every 0: expected a number of seconds above 0"]);
    refused(&run(&["--every", "1e-9"]), &["line 3: the trace would have", "choose a longer period"]);
}
