//! What comes after a failure: stopping there, its mode, the simplest test that fails so, and the file that keeps it.

use crate::common::{fuzz, golden, refused, stderr, stdout, succeeds, without_study};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The parameters of the paper's study with what the scenario has besides.
const OPEN: &[&str] = &["--open", "friction", "--open", "fog", "--open", "light", "--open", "lanes"];

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("it is JSON")
}

fn read(dir: &Path, name: &str) -> Value {
    json(&fs::read_to_string(dir.join(name)).unwrap())
}

fn trials(dir: &Path, out: &str) -> Vec<Value> {
    fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap().lines().map(json).collect()
}

/// The index of the first failing trial.
fn failing(dir: &Path, out: &str) -> String {
    trials(dir, out).iter().position(|trial| trial["verdict"] == "fail").unwrap().to_string()
}

/// The index of the failing trial that is the least bad.
fn mildest(dir: &Path, out: &str) -> String {
    let trials = trials(dir, out);
    let worth = |index: &usize| trials[*index]["robustness"]["no-collision"].as_f64().unwrap();
    let failing = (0..trials.len()).filter(|index| trials[*index]["verdict"] == "fail");
    failing.max_by(|a, b| worth(a).total_cmp(&worth(b))).unwrap().to_string()
}

/// A campaign of 40 tests in `dir/out`.
fn campaign(dir: &Path, more: &[&str]) {
    succeeds(fuzz(dir, &[&["--budget", "40", "--out", "out", "-q"], more].concat()));
}

#[test]
fn the_first_failing_test_is_the_last_one_whatever_the_number_of_jobs() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let whole = fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap();
    let first: usize = failing(dir.path(), "out").parse().unwrap();
    let expected: String = whole.split_inclusive('\n').take(first + 1).collect();
    for jobs in ["1", "2", "8"] {
        let named = ["--strategy", "halton", "--stop-at-first"];
        let options = [&["--budget", "40", "--out", jobs, "--jobs", jobs], &named[..]].concat();
        let summary = json(&stdout(&succeeds(fuzz(dir.path(), &[&options[..], &["--format", "json"]].concat()))));
        let log = dir.path().join(jobs).join("trials.jsonl");
        let stopped = fs::read_to_string(&log).unwrap();
        assert_eq!(without_study(&stopped), without_study(&expected), "{jobs} jobs");
        assert_eq!((summary["stopped_at_first"].clone(), summary["tests"].clone()), (true.into(), (first + 1).into()));
        assert_eq!(summary["coverage"]["tests"], first + 1);
        // Cut anywhere, it ends with the same log, also where nothing is missing.
        for lines in 0..=first + 1 {
            fs::write(&log, stopped.split_inclusive('\n').take(lines).collect::<String>()).unwrap();
            succeeds(fuzz(dir.path(), &[&options[..], &["--resume", "-q"]].concat()));
            assert_eq!(fs::read_to_string(&log).unwrap(), stopped, "{lines} lines were there");
        }
    }
    let more = fuzz(dir.path(), &["--budget", "40", "--out", "1", "--resume"]);
    refused(&more, &["different campaign", "`stop_at_first` is true"]);
    let whole = without_study(&whole);
    fs::write(dir.path().join("1/trials.jsonl"), whole.split_inclusive('\n').take(first + 2).collect::<String>())
        .unwrap();
    let edited =
        fuzz(dir.path(), &["--strategy", "halton", "--budget", "40", "--out", "1", "--resume", "--stop-at-first"]);
    refused(&edited, &[&format!("trial {}", first + 1), "edited"]);
}

#[test]
fn who_stops_at_the_first_failure_searches_for_it_unless_something_else_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let strategy = |out: &str, options: &[&str]| {
        let all = [&["--budget", "4", "--out", out, "--stop-at-first"], options].concat();
        succeeds(fuzz(dir.path(), &all));
        read(dir.path(), &format!("{out}/campaign.json"))["strategy"].clone()
    };
    assert_eq!(strategy("a", &[]), "auto");
    assert_eq!(strategy("b", &["--strategy", "sobol"]), "sobol");
    assert_eq!(strategy("c", &["--open", "lanes", "--discrete", "cross"]), "halton");
}

#[test]
fn a_campaign_that_stops_says_so_and_one_without_a_failure_goes_to_its_end() {
    let dir = tempfile::tempdir().unwrap();
    let table = ["--stop-at-first", "--format", "table"];
    let stopped = succeeds(fuzz(dir.path(), &[&["--budget", "40", "--out", "a"], &table[..]].concat()));
    assert!(stdout(&stopped).contains("stopped               at the first failing test; the budget was 40 tests"));
    assert!(!stderr(&stopped).contains("ended before its budget"));
    let safe = ["--set", "distance=60", "--open", "speed=0.5..1", "--budget", "4", "--out", "b"];
    let safe = stdout(&succeeds(fuzz(dir.path(), &[&safe[..], &table[..]].concat())));
    assert!(safe.contains(": 4 tests") && !safe.contains("stopped"), "{safe}");
}

#[test]
fn the_opened_study_fails_in_at_least_three_ways_which_its_summary_names() {
    let dir = tempfile::tempdir().unwrap();
    let options = [&["pedestrian-crossing", "--out", "out", "--format", "table"], OPEN].concat();
    let summary = stdout(&succeeds(fuzz(dir.path(), &options)));
    let (_, shown) = summary.split_once("  failure modes").unwrap();
    let shown: String = shown.lines().take_while(|line| !line.starts_with("  picture")).collect::<Vec<_>>().join("\n");
    golden("modes.txt", &format!("{shown}\n"));
    let modes = read(dir.path(), "out/modes.json");
    let of = modes["modes"].as_array().unwrap();
    assert!(of.len() >= 3, "{modes}");
    let trials = trials(dir.path(), "out");
    assert_eq!(trials.len(), 500);
    // Every failing test is in one mode, and is what its mode says.
    let mut seen = Vec::new();
    for mode in of {
        let members: Vec<usize> =
            mode["trials"].as_array().unwrap().iter().map(|index| index.as_u64().unwrap() as usize).collect();
        assert_eq!(mode["count"], members.len());
        for member in &members {
            let metrics = &trials[*member]["metrics"];
            assert_eq!(trials[*member]["verdict"], "fail");
            assert_eq!(metrics["contact_face"], mode["contact"]["face"]);
            assert_eq!(metrics["contact_motion"], mode["contact"]["motion"]);
            let time = metrics["critical_time.no-collision"].as_f64().unwrap();
            let range = &mode["figures"]["critical_time"];
            assert!(range[0].as_f64().unwrap() <= time && time <= range[1].as_f64().unwrap());
        }
        let of_mode = |key: &str| members.contains(&(mode[key].as_u64().unwrap() as usize));
        assert!(of_mode("representative") && of_mode("worst"));
        let worth = |index: usize| trials[index]["robustness"]["no-collision"].as_f64().unwrap();
        let worst = mode["worst"].as_u64().unwrap() as usize;
        assert!(members.iter().all(|member| worth(worst) <= worth(*member)));
        seen.extend(members);
    }
    seen.sort_unstable();
    let failing: Vec<usize> = (0..500).filter(|index| trials[*index]["verdict"] == "fail").collect();
    assert_eq!(seen, failing);
    assert_eq!(modes["failures"], failing.len());
}

#[test]
fn what_is_violated_without_a_contact_is_a_mode_by_its_time_and_place() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["roundabout-entry", "--budget", "60", "--out", "out", "-q", "--format", "json"];
    let summary = json(&stdout(&succeeds(fuzz(dir.path(), &options))));
    assert_eq!(summary["modes"], read(dir.path(), "out/modes.json")["modes"]);
    let mode = &summary["modes"][0];
    assert_eq!((&mode["contact"], &mode["violates"]), (&Value::Null, &serde_json::json!(["right-of-way"])));
    let words = mode["words"].as_str().unwrap();
    assert!(words.starts_with("violates right-of-way, ") && words.contains(" s after the start, after "), "{words}");
}

#[test]
fn a_campaign_without_failures_has_no_modes() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "1", "--out", "out", "-q"]));
    assert_eq!(read(dir.path(), "out/modes.json"), serde_json::json!({"failures": 0, "modes": []}));
}

/// The parameters of a shrunk test by name: before, after, and whether that is nominal.
fn changes(shrunk: &Value) -> Vec<(String, Value, bool)> {
    let parameters = shrunk["parameters"].as_array().unwrap().iter();
    parameters
        .map(|change| {
            let name = change["name"].as_str().unwrap().to_owned();
            (name, change["after"].clone(), change["nominal"].as_bool().unwrap())
        })
        .collect()
}

#[test]
fn a_shrunk_test_fails_and_passes_with_any_of_its_parameters_nominal() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), OPEN);
    let index = failing(dir.path(), "out");
    let shrink = |more: &[&str]| fuzz(dir.path(), &[&["shrink", "out", &index], more].concat());
    golden("shrink.txt", &stdout(&succeeds(shrink(&["--format", "table"]))));
    let printed = stdout(&succeeds(shrink(&["--save", "kept/first.json", "--format", "json"])));
    assert_eq!(printed, stdout(&succeeds(shrink(&["--format", "json"]))), "shrinking is deterministic");
    let shrunk = json(&printed);
    assert_eq!((&shrunk["trial"]["verdict"], &shrunk["minimal"]), (&"fail".into(), &true.into()));
    let needed: Vec<_> = changes(&shrunk).into_iter().filter(|(_, _, nominal)| !nominal).collect();
    let names: Vec<&str> = needed.iter().map(|(name, _, _)| name.as_str()).collect();
    assert!(!names.is_empty() && !names.contains(&"fog") && !names.contains(&"light"), "{names:?}");
    // The file runs, and with any of the parameters nominal it is a file of a test that does not fail.
    let text = fs::read_to_string(dir.path().join("kept/first.json")).unwrap();
    golden("regression.json", &text.replace(paracosm::campaign::TARGET, "TARGET"));
    let described = json(&stdout(&succeeds(fuzz(dir.path(), &["describe", "--format", "json"]))));
    for (name, _, _) in &needed {
        let parameters = described["parameters"].as_array().unwrap().iter();
        let nominal =
            parameters.clone().find(|declared| declared["parameter"]["name"] == **name).unwrap()["nominal"].clone();
        let mut other = json(&text);
        other["test"][name] = nominal;
        other["expect"] = "pass".into();
        fs::write(dir.path().join("other.json"), other.to_string()).unwrap();
        let passes =
            stdout(&succeeds(fuzz(dir.path(), &["replay", "other.json", "--fail-on-violation", "--format", "json"])));
        assert_eq!(json(&passes)[0]["replayed"]["as_expected"], true, "{name}: {passes}");
    }
}

#[test]
fn shrinking_keeps_to_the_mode_where_that_is_asked_for_and_says_otherwise_when_it_does_not() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), OPEN);
    let mut changed = 0;
    for mode in read(dir.path(), "out/modes.json")["modes"].as_array().unwrap() {
        let index = mode["representative"].to_string();
        let shrunk = json(&stdout(&succeeds(fuzz(dir.path(), &["shrink", "out", &index, "--format", "json"]))));
        assert!(shrunk["trial"]["robustness"]["no-collision"].as_f64().unwrap() < 0.0, "{shrunk}");
        let metrics = &shrunk["trial"]["metrics"];
        let same =
            ["with", "face", "motion"].iter().all(|what| metrics[format!("contact_{what}")] == mode["contact"][what]);
        assert_eq!(shrunk["same_mode"], same, "{shrunk}");
        let table = stdout(&succeeds(fuzz(dir.path(), &["shrink", "out", &index, "--format", "table"])));
        assert_eq!(table.contains("  fails in another way  the car "), !same, "{table}");
        assert_eq!(table.contains("; --same-mode keeps this mode\n"), !same, "{table}");
        changed += usize::from(!same);
    }
    assert!(changed > 0);
    for mode in read(dir.path(), "out/modes.json")["modes"].as_array().unwrap() {
        let index = mode["representative"].to_string();
        let shrunk =
            json(&stdout(&succeeds(fuzz(dir.path(), &["shrink", "out", &index, "--same-mode", "--format", "json"]))));
        let metrics = &shrunk["trial"]["metrics"];
        assert_eq!(metrics["contact_face"], mode["contact"]["face"], "{shrunk}");
        assert_eq!(metrics["contact_motion"], mode["contact"]["motion"], "{shrunk}");
    }
}

#[test]
fn signals_are_shrunk_to_fewer_pieces() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &["--open", "friction:piecewise-constant:8=0.2..0.8"]);
    let index = failing(dir.path(), "out");
    let shrunk = json(&stdout(&succeeds(fuzz(dir.path(), &["shrink", "out", &index, "--format", "json"]))));
    let friction = &shrunk["parameters"].as_array().unwrap()[2];
    let distinct = |value: &Value| {
        let mut values: Vec<String> = value.as_array().unwrap().iter().map(ToString::to_string).collect();
        values.dedup();
        values.len()
    };
    assert_eq!((distinct(&friction["before"]), friction["after"].as_array().unwrap().len()), (8, 8));
    assert!(distinct(&friction["after"]) <= 2, "{friction}");
}

#[test]
fn few_runs_shrink_less_and_that_is_said() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), OPEN);
    let index = failing(dir.path(), "out");
    let shrunk =
        json(&stdout(&succeeds(fuzz(dir.path(), &["shrink", "out", &index, "--budget", "3", "--format", "json"]))));
    assert_eq!((&shrunk["runs"], &shrunk["minimal"]), (&3.into(), &false.into()));
    assert_eq!(shrunk["trial"]["verdict"], "fail");
}

#[test]
fn what_cannot_be_shrunk_or_saved_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let index = failing(dir.path(), "out");
    refused(&fuzz(dir.path(), &["shrink", "nowhere", "1"]), &["nowhere/campaign.json"]);
    refused(&fuzz(dir.path(), &["shrink", "out", "40"]), &["no test 40", "0 to 39"]);
    refused(&fuzz(dir.path(), &["shrink", "out", "0"]), &["test 0 has the verdict `pass`", "nothing to shrink"]);
    refused(&fuzz(dir.path(), &["shrink", "out", &index, "--save", "out/campaign.json"]), &["out/campaign.json"]);
    fs::write(dir.path().join("there.json"), "{}").unwrap();
    refused(&fuzz(dir.path(), &["shrink", "out", &index, "--save", "there.json"]), &["there.json exists"]);
    assert_eq!(fs::read_to_string(dir.path().join("there.json")).unwrap(), "{}");
}

#[test]
fn regression_files_tell_in_a_line_and_by_the_exit_status_what_became_of_them() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let index = mildest(dir.path(), "out");
    succeeds(fuzz(dir.path(), &["shrink", "out", &index, "--save", "open.json", "-q"]));
    let text = fs::read_to_string(dir.path().join("open.json")).unwrap();
    let edited = |name: &str, change: &dyn Fn(&mut Value)| {
        let mut file = json(&text);
        change(&mut file);
        fs::write(dir.path().join(name), file.to_string()).unwrap();
    };
    // Mended: the driver reacts at once. Broken again: it was expected to pass.
    let quick = |file: &mut Value| file["study"]["driver"]["settings"]["latency"] = 0.0.into();
    edited("mended.json", &|file| {
        quick(file);
        file["expect"] = "pass".into();
    });
    edited("again.json", &|file| file["expect"] = "pass".into());
    edited("noticed.json", &quick);
    edited("older.json", &|file| {
        quick(file);
        file["study"]["version"] = "0.0.1".into();
    });
    // It stops for good long before it comes to the pedestrian.
    edited("other.json", &|file| {
        for (setting, value) in [("latency", 0.0), ("ttc", 3.0), ("samples", 3.0)] {
            file["study"]["driver"]["settings"][setting] = value.into();
        }
        file["trace_hash"] = Value::Null;
    });
    // An older version of the scenario had a parameter that it has no longer.
    edited("broken.json", &|file| {
        file["study"]["version"] = "0.0.1".into();
        file["study"]["fixed"]["wind"] = 1.0.into();
    });
    let replay = |files: &[&str]| fuzz(dir.path(), &[&["replay", "--format", "table"], files].concat());
    let mut told = String::new();
    for (files, status) in [
        (&["open.json", "mended.json", "again.json", "older.json"][..], 0),
        (&["mended.json", "--fail-on-violation"], 0),
        (&["again.json", "mended.json", "--fail-on-violation"], 1),
        (&["open.json", "--fail-on-violation"], 1),
        (&["open.json", "mended.json", "--fail-on-unexpected"], 0),
        (&["again.json", "--fail-on-unexpected"], 1),
        (&["other.json", "--fail-on-unexpected"], 1),
        (&["open.json", "--expect", "pass"], 0),
        (&["noticed.json"], 2),
        (&["other.json"], 0),
        (&["noticed.json", "--expect", "pass"], 0),
        (&["broken.json", "open.json", "--fail-on-violation"], 2),
    ] {
        let output = replay(files);
        assert_eq!(output.status.code(), Some(status), "{files:?}: {}{}", stdout(&output), stderr(&output));
        told.push_str(&format!("replay {}\n{}{}exit {status}\n\n", files.join(" "), stdout(&output), stderr(&output)));
    }
    golden("regressions.txt", &told);
}

#[test]
fn files_that_are_no_regressions_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let index = failing(dir.path(), "out");
    succeeds(fuzz(dir.path(), &["shrink", "out", &index, "--save", "open.json", "-q"]));
    let text = fs::read_to_string(dir.path().join("open.json")).unwrap();
    let write = |text: &str| fs::write(dir.path().join("bad.json"), text).unwrap();
    let cases = [
        ("{\"expect\": 1}".to_owned(), "the file is not a regression test"),
        (text.replace("\"no-collision\"\n", "\"no-colision\"\n"), "no requirement is called `no-colision`"),
        (text.replace("\"expect\": \"fail\"", "\"expect\": \"fial\""), "`fial`"),
        (text.replacen("\"distance\"", "\"distanse\"", 1), "`distanse`"),
    ];
    for (text, says) in cases {
        write(&text);
        refused(&fuzz(dir.path(), &["replay", "bad.json"]), &["bad.json", says]);
    }
    refused(&fuzz(dir.path(), &["replay", "out"]), &["out is a folder", "index"]);
    refused(&fuzz(dir.path(), &["replay", "out", "one"]), &["found `one`", "index"]);
    refused(&fuzz(dir.path(), &["replay", "out", "1", "--expect", "pass"]), &["--expect"]);
    refused(&fuzz(dir.path(), &["replay", "out", "1", "--fail-on-unexpected"]), &["--fail-on-unexpected"]);
    refused(&fuzz(dir.path(), &["replay", "open.json", "--draw", "a.svg"]), &["--draw", "replay DIR INDEX"]);
    refused(&fuzz(dir.path(), &["replay", "nowhere.json"]), &["nowhere.json"]);
}
