//! Systems that others wrote: shell scripts that answer as they should, and as they should not.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const SPACE: &str = "parameter = [{ name = \"x\", interval = [-1, 1] }, { name = \"y\", interval = [0, 1] }]\n";

/// A system that has the index of a test in `$i` and its first value in `$x` when it does this.
fn script(dir: &Path, answer: &str) {
    let read = "i=${line#*:}; i=${i%%,*}; x=${line#*'\"x\":'}; x=${x%%,*}";
    fs::write(dir.join("system.sh"), format!("while read -r line; do {read}\n{answer}\ndone\n")).unwrap();
    fs::write(dir.join("SPACE.toml"), SPACE).unwrap();
}

const ROBUSTNESS: &str = r#"echo "{\"index\":$i,\"robustness\":{\"above\":$x,\"far\":2}}""#;
const TRACE: &str =
    r#"echo "{\"index\":$i,\"trace\":{\"time\":[0,0.1,0.2],\"speed\":[1,$x,1],\"on\":[true,true,false]}}""#;

fn run(dir: &Path, out: &str, more: &[&str]) -> Output {
    let system = ["--system", "sh system.sh", "--space", "SPACE.toml", "-q", "--out", out];
    let json: &[&str] = if more.contains(&"--format") { &[] } else { &["--format", "json"] };
    fuzz(dir, &[&system[..], more, json].concat())
}

fn log(dir: &Path, out: &str) -> String {
    fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap()
}

fn trials(dir: &Path, out: &str) -> Vec<Value> {
    log(dir, out).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Of two requirements the first is in thousands, and the second is the one that is violated by far.
const TWO_SIZES: &str = r#"case $x in -*) rpm=-500;; *) rpm=${x}e3;; esac; if [ "$i" = 7 ]; then gap=-0.9; else gap=0.3; fi
echo "{\"index\":$i,\"robustness\":{\"rpm\":$rpm,\"gap\":$gap}}""#;

#[test]
fn scales_that_a_campaign_has_learned_are_kept_and_used_by_whatever_comes_after_it() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), TWO_SIZES);
    let study = |out: &str| fs::read_to_string(dir.path().join(out).join("campaign.json")).unwrap();
    for strategy in ["halton", "cmaes"] {
        let options = ["--budget", "40", "--strategy", strategy];
        let summary = run(dir.path(), strategy, &[&options[..], &["--format", "json"]].concat());
        let summary: Value = serde_json::from_str(&stdout(&succeeds(summary))).unwrap();
        let learned = serde_json::from_str::<Value>(&study(strategy)).unwrap()["learned_scales"].clone();
        assert_eq!(learned["gap"], 0.9, "{strategy}");
        assert!(learned["rpm"].as_f64().is_some_and(|scale| scale > 600.0), "{strategy}: {learned}");
        // The other one is violated by 500, which is little for it.
        assert_eq!((&summary["worst"]["index"], &summary["worst"]["requirement"]), (&json!(7), &json!("gap")));
        let map = || fs::read_to_string(dir.path().join(strategy).join("failure-map.csv")).unwrap();
        let (before, whole) = (map(), study(strategy));
        succeeds(fuzz(dir.path(), &["map", strategy, "-q"]));
        assert_eq!(map(), before);
        // A campaign that is cut short goes on with the same ones, and ends with the same files.
        let log = dir.path().join(strategy).join("trials.jsonl");
        let lines = log_lines(&log, 20);
        let all = fs::read_to_string(&log).unwrap();
        fs::write(&log, lines).unwrap();
        succeeds(run(dir.path(), strategy, &[&options[..], &["--resume"]].concat()));
        assert_eq!((fs::read_to_string(&log).unwrap(), study(strategy), map()), (all, whole, before));
    }
}

fn log_lines(log: &Path, count: usize) -> String {
    fs::read_to_string(log).unwrap().split_inclusive('\n').take(count).collect()
}

#[test]
fn robustness_is_judged_by_its_sign_and_shown_in_every_file() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), ROBUSTNESS);
    let summary = succeeds(run(dir.path(), "out", &["--budget", "40", "--format", "table"]));
    assert!(stdout(&summary).starts_with("system sh system.sh, strategy halton: 40 tests\n"), "{}", stdout(&summary));
    for trial in trials(dir.path(), "out") {
        let x = trial["test"]["x"].as_f64().unwrap();
        assert_eq!(trial["verdict"], if x < 0.0 { "fail" } else { "pass" }, "{trial}");
        assert_eq!(trial["robustness"], json!({"above": x, "far": 2.0}));
        assert_eq!((&trial["trace_hash"], &trial["ticks"]), (&Value::Null, &json!(0)));
    }
    let read = |name: &str| fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    assert!(read("trials.csv").starts_with("index,x,y,verdict,robustness.above,robustness.far,ticks,"));
    assert!(read("failure-map.svg").contains("system sh system.sh"));
    let study: Value = serde_json::from_str(&read("campaign.json")).unwrap();
    assert_eq!((&study["system"], &study["timeout"]), (&json!("sh system.sh"), &json!(60.0)));
    let replay =
        succeeds(fuzz(dir.path(), &["replay", "out", "7", "--trust", "--format", "table", "--trace", "trace.csv"]));
    assert!(stdout(&replay).contains("trace hash            none, as logged"), "{}", stdout(&replay));
    assert!(stderr(&replay).contains("no trace to write") && !dir.path().join("trace.csv").exists());
    // A system that answers otherwise by now.
    script(dir.path(), &ROBUSTNESS.replace('2', "3"));
    refused(
        &fuzz(dir.path(), &["replay", "out", "7", "--trust"]),
        &["test 7 differs from the log", "far: 3, logged 2"],
    );
    let drawn = fuzz(dir.path(), &["replay", "out", "7", "--trust", "--draw", "test.svg"]);
    refused(&drawn, &["test.svg", "no world to draw"]);
}

#[test]
fn formulas_are_asked_of_traces_and_each_is_reported() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), TRACE);
    let specs = ["--spec", "always (speed > -0.5)", "--spec", "on until[0,0.2] (speed > 0 and not on)"];
    let summary = succeeds(run(dir.path(), "out", &[&specs[..], &["--budget", "30"]].concat()));
    let trials = trials(dir.path(), "out");
    for trial in &trials {
        let x = trial["test"]["x"].as_f64().unwrap();
        assert_eq!(trial["verdict"], if x <= -0.5 { "fail" } else { "pass" }, "{trial}");
        assert_eq!(trial["robustness"]["spec-1"], x.min(1.0) + 0.5);
        assert_eq!(trial["ticks"], 2);
        let cause = json!({"critical_time.spec-1": 0.1, "critical_part.spec-1": "(speed > -0.5)"});
        assert_eq!(trial["metrics"], if x <= -0.5 { cause } else { json!({}) }, "{trial}");
        assert_eq!(trial["trace_hash"].as_str().unwrap().len(), 32);
    }
    let failed = trials.iter().filter(|trial| trial["verdict"] == "fail").count();
    let requirements: Value = serde_json::from_str::<Value>(&stdout(&summary)).unwrap()["requirements"].take();
    assert_eq!((&requirements[0]["id"], &requirements[0]["violated"]), (&json!("spec-1"), &json!(failed)));
    assert_eq!((&requirements[1]["id"], &requirements[1]["violated"]), (&json!("spec-2"), &json!(0)));
    let said: Value = serde_json::from_str(&stdout(&summary)).unwrap();
    assert_eq!(said["worst"]["cause"], json!({"time": 0.1, "part": "(speed > -0.5)"}));
    assert_eq!(said["modes"][0]["words"], "violates spec-1, by `(speed > -0.5)`, 0.1 s after the start");
    let worst = said["worst"]["index"].to_string();
    let replay = stdout(&succeeds(fuzz(dir.path(), &["replay", "out", &worst, "--trust", "--format", "table"])));
    assert!(replay.contains("critical_part.spec-1  (speed > -0.5)\n"), "{replay}");
    succeeds(fuzz(dir.path(), &["replay", "out", "2", "--trust", "--trace", "trace.csv"]));
    let trace = fs::read_to_string(dir.path().join("trace.csv")).unwrap();
    assert_eq!(trace, "time,speed,on\n0,1,1\n0.1,0.5,1\n0.2,1,0\n");
    let late = run(dir.path(), "late", &["--spec", "eventually[0,5] (speed > 9)", "--budget", "4"]);
    assert!(stdout(&late).contains("\"inconclusive\": 4"), "{}", stdout(&succeeds(late)));
}

#[test]
fn a_formula_may_speak_of_the_time_between_samples_and_names_the_instant_that_counts() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), TRACE);
    let dense = ["--spec", "always[0.05,0.05] (speed > 0.3)", "--dense", "--budget", "30"];
    let summary = succeeds(run(dir.path(), "out", &dense));
    let trials = trials(dir.path(), "out");
    for trial in &trials {
        let robustness = 0.5 + 0.5 * trial["test"]["x"].as_f64().unwrap() - 0.3;
        assert!((trial["robustness"]["spec-1"].as_f64().unwrap() - robustness).abs() < 1e-12, "{trial}");
        let cause = json!({"critical_time.spec-1": 0.05, "critical_part.spec-1": "(speed > 0.3)"});
        assert_eq!(trial["metrics"], if robustness < 0.0 { cause } else { json!({}) }, "{trial}");
    }
    let failed = trials.iter().filter(|trial| trial["verdict"] == "fail").count();
    assert!(0 < failed && failed < 30, "{failed}");
    let study: Value =
        serde_json::from_str(&fs::read_to_string(dir.path().join("out/campaign.json")).unwrap()).unwrap();
    assert_eq!(study["requirements"][0]["time"], "dense");
    let said: Value = serde_json::from_str(&stdout(&summary)).unwrap();
    assert_eq!(said["worst"]["cause"], json!({"time": 0.05, "part": "(speed > 0.3)"}));
    assert_eq!(said["modes"][0]["words"], "violates spec-1, by `(speed > 0.3)`, 0.1 s after the start");
    let worst = said["worst"]["index"].to_string();
    let replay = stdout(&succeeds(fuzz(dir.path(), &["replay", "out", &worst, "--trust", "--format", "table"])));
    assert!(replay.contains("critical_part.spec-1  (speed > 0.3)\n"), "{replay}");
    // What is missing is asked in the same way, and by no other.
    let whole = log(dir.path(), "out");
    let file = dir.path().join("out/trials.jsonl");
    fs::write(&file, log_lines(&file, 11)).unwrap();
    let sampled = run(dir.path(), "out", &["--spec", "always[0.1,0.1] (speed > 0.3)", "--budget", "30", "--resume"]);
    refused(&sampled, &["different campaign", "`requirements`"]);
    succeeds(run(dir.path(), "out", &[&dense[..], &["--resume"]].concat()));
    assert_eq!(log(dir.path(), "out"), whole);
}

/// Answers of test 2, and what is said of them.
const BAD: &[(&str, &str)] = &[
    ("echo garbage", "found `garbage` in column 1"),
    (
        "echo '{\"index\":2,\"trace\":{\"time\":[0,1],\"speed\":[NaN,1]}}'",
        "`speed` has no finite value (NaN, infinity or null) at sample 0, 0 s",
    ),
    (
        "echo '{\"index\":2,\"trace\":{\"time\":[0,1],\"speed\":[1,null]}}'",
        "`speed` has no finite value (NaN, infinity or null) at sample 1, 1 s",
    ),
    ("echo '{\"index\":2,\"trace\":{\"time\":[0,1],\"sped\":[0,0]}}'", "no signal `speed` (did you mean `sped`?)"),
    (
        "echo '{\"index\":1,\"trace\":{\"time\":[0,1],\"speed\":[0,0]}}'",
        "found the answer to test 1, expected the answer to",
    ),
    ("echo '{\"index\":2,\"robustness\":{\"a\":1}}'", "answers with robustness, expected a trace"),
    ("echo '{\"index\":2,\"error\":\"diverged\"}'", "diverged"),
    ("echo; echo", "found `` in column 1"),
    ("printf '\\377\\n'", "not UTF-8"),
    ("echo half; kill -9 $$", "found `half`"),
    ("printf '{\"index\":2,'; kill -9 $$", "ended without an answer (signal: 9"),
    ("echo out of fuel >&2; exit 3", "ended without an answer (exit status: 3); its last words: out of fuel"),
    ("exec >&-; sleep 1000", "closed its output without an answer"),
    ("sleep 1000 & sleep 1000 | sleep 1000", "no answer within 0.5 s"),
];

#[test]
fn bad_answers_are_errors_that_say_why_and_the_rest_goes_on_for_any_number_of_workers() {
    let dir = tempfile::tempdir().unwrap();
    let good = TRACE;
    for (i, (bad, says)) in BAD.iter().enumerate() {
        script(dir.path(), &format!("case $i in 2) {bad};; *) {good};; esac"));
        let run = |out: &str, jobs: &str| {
            let options = ["--budget", "6", "--timeout", "0.5", "--spec", "always (speed > -2)", "--jobs", jobs];
            succeeds(run(dir.path(), out, &options));
        };
        let (one, many) = (format!("one-{i}"), format!("many-{i}"));
        run(&one, "1");
        for trial in trials(dir.path(), &one) {
            assert_eq!(trial["verdict"] == "error", trial["index"] == 2, "{bad}: {trial}");
            let error = trial["error"].as_str().unwrap_or(says);
            assert!(error.contains(says), "{bad}: `{says}` is missing in {error}");
        }
        run(&many, "3");
        assert_eq!(log(dir.path(), &one), log(dir.path(), &many), "{bad}");
    }
    // A replay comes to the same end.
    succeeds(fuzz(dir.path(), &["replay", "one-13", "2", "--trust"]));
}

#[test]
fn what_a_process_started_ends_with_it() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), &format!("case $i in 1) sleep 1000 & echo $! >> pids; wait;; *) {ROBUSTNESS};; esac"));
    succeeds(run(dir.path(), "out", &["--budget", "4", "--timeout", "0.3"]));
    let pids = fs::read_to_string(dir.path().join("pids")).unwrap();
    assert!(!pids.is_empty());
    for pid in pids.lines() {
        // Whoever inherits an orphan may not have buried it yet.
        let state = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
        assert!(state.is_empty() || state.contains(") Z "), "{state}");
    }
}

#[test]
fn a_process_is_started_once_for_each_worker_also_by_adaptive_strategies() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), ROBUSTNESS);
    let system = fs::read_to_string(dir.path().join("system.sh")).unwrap();
    fs::write(dir.path().join("system.sh"), format!("echo started >> starts\n{system}")).unwrap();
    succeeds(run(dir.path(), "out", &["--budget", "50", "--jobs", "2", "--strategy", "cmaes", "--batch", "5"]));
    let starts = fs::read_to_string(dir.path().join("starts")).unwrap().lines().count();
    assert!(starts <= 2, "it was started {starts} times");
}

#[test]
fn every_command_that_runs_tests_says_which_errors_did_not_repeat() {
    let dir = tempfile::tempdir().unwrap();
    // Each process answers one test, and breaks at the second.
    let worn_out = |answer: &str| format!("n=$((n+1)); [ $n -gt 1 ] && exit 1; {answer}");
    script(dir.path(), &worn_out(ROBUSTNESS));
    let aloud = |out: &str, more: &[&str]| {
        let system = ["--system", "sh system.sh", "--space", "SPACE.toml", "--out", out];
        fuzz(dir.path(), &[&system[..], more].concat())
    };
    let said = succeeds(aloud("out", &["--budget", "20"]));
    assert!(stdout(&said).contains("had a result when"), "{}", stdout(&said));
    let printed = succeeds(aloud("json", &["--budget", "20", "--format", "json"]));
    let printed: Value = serde_json::from_str(&stdout(&printed)).unwrap();
    let kept: Value = serde_json::from_str(&fs::read_to_string(dir.path().join("json/doubts.json")).unwrap()).unwrap();
    assert!(
        kept["doubts"] == printed["doubts"] && kept["doubts"][0].to_string().contains("had a result when"),
        "{kept}"
    );
    // Whoever reads the folder later is told, and so is the reader of its page.
    let map = fuzz(dir.path(), &["trace", "json"]);
    assert!(stderr(&map).contains("json: ") && stderr(&map).contains("had a result when"), "{}", stderr(&map));
    succeeds(fuzz(dir.path(), &["report", "json", "--out", "page.html", "--trust"]));
    let found = crate::page::findings(&dir.path().join("page.html"));
    assert_eq!((&found[0]["label"], &found[0]["lines"]), (&Value::from("doubts"), &kept["doubts"]));
    let sensitivity = ["sensitivity", "out", "--system", "sh system.sh", "--budget", "100"];
    let said = succeeds(fuzz(dir.path(), &sensitivity));
    assert!(stderr(&said).contains("had a result when"), "{}", stderr(&said));
    // An answer that says that the test could not be run is no result.
    let diverged = r#"echo "{\"index\":$i,\"error\":\"diverged\"}""#;
    script(dir.path(), &worn_out(&format!("if [ -e begun ]; then {diverged}; else touch begun; {ROBUSTNESS}; fi")));
    let said = aloud("diverged", &["--budget", "5", "--jobs", "1"]);
    assert!(!stdout(&said).contains("had a result when") && !dir.path().join("diverged/doubts.json").exists());
    assert!(stdout(&said).contains("error                 4"), "{}", stdout(&said));
}

#[test]
fn a_process_that_ends_between_tests_is_started_again() {
    let dir = tempfile::tempdir().unwrap();
    // The second ends before its answer arrives.
    for (out, answer) in
        [("at-once", format!("{ROBUSTNESS}; exit 0")), ("late", format!("(sleep 0.1; {ROBUSTNESS}) & exit 0"))]
    {
        script(dir.path(), &answer);
        let printed = succeeds(fuzz(
            dir.path(),
            &["--system", "sh system.sh", "--space", "SPACE.toml", "--out", out, "--budget", "8", "--jobs", "1"],
        ));
        let note = "7 tests ended in an error, and had a result when a new process or a new connection ran them again";
        let printed = stdout(&printed);
        assert!(printed.contains(note) && printed.contains("the first, test 1: "), "{printed}");
        assert!(trials(dir.path(), out).iter().all(|trial| trial["error"].is_null()), "{}", log(dir.path(), out));
    }
}

#[test]
fn all_answers_judge_the_same_requirements() {
    let dir = tempfile::tempdir().unwrap();
    script(
        dir.path(),
        r#"case $i in 5) name=below;; *) name=above;; esac; echo "{\"index\":$i,\"robustness\":{\"$name\":1}}""#,
    );
    succeeds(run(dir.path(), "out", &["--budget", "9"]));
    let trials = trials(dir.path(), "out");
    assert_eq!(trials[5]["error"], "found the robustness of below, expected the robustness of above, as in test 0");
    assert_eq!(trials.iter().filter(|trial| trial["verdict"] == "pass").count(), 8);
    succeeds(fuzz(dir.path(), &["replay", "out", "5", "--trust"]));
}

#[test]
fn systems_that_answer_nothing_are_failed_runs() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), TRACE);
    refused(&run(dir.path(), "no-spec", &["--budget", "4"]), &["every test ended in an error", "no formula judges it"]);
    assert_eq!(trials(dir.path(), "no-spec").len(), 4);
    script(dir.path(), "echo no licence >&2; exit 1");
    for _ in 0..2 {
        let given_up = run(dir.path(), "none", &["--resume"]);
        refused(&given_up, &["first 50 tests ended in an error", "given up", "no licence"]);
        assert_eq!(trials(dir.path(), "none").len(), 50);
    }
}

#[test]
fn a_formula_that_fits_no_trace_is_given_up_soon_and_one_that_fits_some_is_not() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), TRACE);
    for (out, formula, why) in [
        ("typo", "always (sped > 0)", "the trace has no signal `sped` (did you mean `speed`?)"),
        ("tick", "always[0,0.05] (speed > 0)", "the time bound 0.05 s is not a multiple of the sample period 0.1 s"),
    ] {
        let says = ["each of the first 3 tests", &format!("spec-1 does not fit the trace: {why}")];
        refused(&run(dir.path(), out, &["--spec", formula, "--budget", "60"]), &says);
        assert_eq!(trials(dir.path(), out).len(), 3);
    }
    // Traces that differ may be followed by one that it fits.
    script(dir.path(), &format!("case $i in 1) {};; *) {TRACE};; esac", TRACE.replace("[0,0.1,0.2]", "[0,0.2,0.4]")));
    let ticks = run(dir.path(), "ticks", &["--spec", "always[0,0.05] (speed > 0)", "--budget", "6"]);
    refused(&ticks, &["every test ended in an error"]);
    // A test that comes to nothing else is no sign that the formula fits.
    script(dir.path(), &format!("case $i in 1) echo garbage;; *) {TRACE};; esac"));
    let says = ["each of the first 4 tests", "test 0: spec-1 does not fit the trace"];
    refused(&run(dir.path(), "garbage", &["--spec", "always (sped > 0)", "--budget", "60"]), &says);
    script(dir.path(), &format!("case $i in 0|1|3) {};; *) {TRACE};; esac", TRACE.replace("speed", "sped")));
    succeeds(run(dir.path(), "some", &["--spec", "always (speed > -9)", "--budget", "8"]));
    let broken: Vec<Value> = trials(dir.path(), "some").iter().map(|trial| trial["verdict"].clone()).collect();
    assert_eq!(broken, ["error", "error", "pass", "error", "pass", "pass", "pass", "pass"]);
}

#[test]
fn a_signal_that_the_first_traces_lack_may_come_later_unless_its_name_is_a_slip_of_the_pen() {
    let dir = tempfile::tempdir().unwrap();
    // The second car is there in some tests only, and from the eighth on at that.
    script(
        dir.path(),
        &format!(
            "case $i in [0-6]) {};; *) {};; esac",
            TRACE.replace("speed", "car1.speed"),
            TRACE.replace("speed", "car2.speed")
        ),
    );
    let late = run(dir.path(), "late", &["--spec", "always (car2.speed > -9)", "--budget", "12"]);
    assert!(stdout(&succeeds(late)).contains("\"pass\": 5"));
    let trials = trials(dir.path(), "late");
    let lacks = "spec-1 cannot judge this trace: the trace has no signal `car2.speed` (did you mean `car1.speed`?)";
    assert!(trials[..7].iter().all(|trial| trial["error"] == lacks), "{}", trials[0]);
    // What never comes is waited for as long as any system is; whoever looks on is told at once.
    let options = ["--system", "sh system.sh", "--space", "SPACE.toml", "--out", "never", "--budget", "60"];
    let never = fuzz(dir.path(), &[&options[..], &["--spec", "always (velocity > 0)"]].concat());
    let says = "test 0 ended in an error: spec-1 cannot judge this trace: the trace has no signal `velocity`\n";
    assert_eq!(stderr(&never).matches(says).count(), 1, "{}", stderr(&never));
    refused(&never, &["each of the first 50 tests", "test 0: spec-1 cannot judge this trace"]);
}

#[test]
fn what_makes_no_sense_is_refused_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), TRACE);
    fs::write(dir.path().join("model.pict"), "a: 1, 2\nb: 1, ~2\n").unwrap();
    let cases: &[(&[&str], &[&str])] = &[
        (&["--system", "sh system.sh"], &["--space"]),
        (&["--space", "SPACE.toml"], &["--system"]),
        (&["--timeout", "3"], &["--system"]),
        (&["--system", "no-such-program -x", "--space", "SPACE.toml"], &["cannot start", "`no-such-program`"]),
        (&["--system", "", "--space", "SPACE.toml"], &["found no program"]),
        (&["--system", "sh 'system.sh", "--space", "SPACE.toml"], &["quote is not closed"]),
        (&["--system", "sh system.sh", "--space", "SPACE.tml"], &["cannot read SPACE.tml"]),
        (&["--system", "sh system.sh", "--space", "model.pict"], &["model.pict", "negative values"]),
        (&["--system", "sh system.sh", "--space", "SPACE.toml", "--timeout", "0"], &["time-out is 0"]),
        (&["--system", "sh system.sh", "--space", "SPACE.toml", "--timeout", "NaN"], &["time-out is NaN"]),
        (&["--system", "sh system.sh", "--space", "SPACE.toml", "--driver", "aeb"], &["--driver"]),
        (&["--system", "sh system.sh", "--space", "SPACE.toml", "--set", "x=1"], &["--set"]),
        (&["pedestrian-crossing", "--system", "sh system.sh", "--space", "SPACE.toml"], &["SCENARIO"]),
        (&["--system", "sh system.sh", "--space", "SPACE.toml", "--spec", "G (speed <"], &["column 11", "the end"]),
    ];
    for (arguments, says) in cases {
        refused(&fuzz(dir.path(), &[arguments, &["--out", "out"][..]].concat()), says);
        assert!(!dir.path().join("out").exists(), "{arguments:?} wrote something");
    }
}

#[test]
fn a_campaign_of_a_system_that_is_killed_is_completed_to_the_same_log() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), &format!("case $i in 17) exit 1;; esac; {ROBUSTNESS}"));
    for strategy in ["halton", "cmaes", "bayes"] {
        let options = ["--budget", "60", "--strategy", strategy, "--seed", "1"];
        let out = |name: &str| format!("{strategy}-{name}");
        succeeds(run(dir.path(), &out("whole"), &[&options[..], &["--jobs", "1"]].concat()));
        let whole = log(dir.path(), &out("whole"));
        let name = out("killed");
        let resume = [&options[..], &["--resume"]].concat();
        // It kills the campaign once it has come so far.
        let killer =
            format!("case $i in 33) if [ ! -e {name}.done ]; then touch {name}.done; kill -9 $PPID; fi;; esac");
        let system = fs::read_to_string(dir.path().join("system.sh")).unwrap();
        fs::write(dir.path().join("system.sh"), system.replace("case $i in 17)", &format!("{killer}; case $i in 17)")))
            .unwrap();
        assert_eq!(run(dir.path(), &name, &resume).status.code(), None);
        fs::write(dir.path().join("system.sh"), system).unwrap();
        assert!(log(dir.path(), &name).len() < whole.len());
        succeeds(run(dir.path(), &name, &resume));
        assert_eq!(log(dir.path(), &name), whole, "{strategy}");
    }
}

#[test]
fn an_interrupt_does_not_wait_for_a_system_that_hangs() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), &format!("case $i in 3) kill -INT $PPID; sleep 1000;; *) {ROBUSTNESS};; esac"));
    let options = ["--system", "sh system.sh", "--space", "SPACE.toml", "--timeout", "1000", "--jobs", "1"];
    let mut campaign = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let campaign = campaign.args(options).current_dir(dir.path()).stdout(Stdio::null()).stderr(Stdio::piped());
    let output = campaign.spawn().unwrap().wait_with_output().unwrap();
    refused(&output, &["interrupted", "the first 3 trials are safe", "--resume"]);
}

/// An answer with a first signal and so many others, called s0, s1 and so on.
fn signals(first: &str, count: usize) -> String {
    let printed = r#"printf "{\"index\":%d,\"trace\":{\"FIRST\":[0,1]", i"#.replace("FIRST", first);
    format!(
        r#"awk -v i="$i" 'BEGIN {{ {printed}
for (n = 0; n < {count}; n++) printf ",\"s%d\":[0,1]", n; print "}}}}" }}'"#
    )
}

#[test]
fn an_answer_with_very_many_signals_is_read_in_time() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), &signals("time", 200_000));
    succeeds(run(dir.path(), "many", &["--spec", "s199999 >= 0", "--budget", "1", "--timeout", "30"]));
    assert_eq!(trials(dir.path(), "many")[0]["verdict"], "pass");
}

#[test]
fn a_message_about_very_many_signals_stays_short() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), &signals("s", 1000));
    run(dir.path(), "many", &["--spec", "s1 >= 0", "--budget", "1"]);
    let error = trials(dir.path(), "many")[0]["error"].as_str().unwrap().to_owned();
    assert!(error.contains("s18 and 981 more, expected `time` among them"), "{error}");
}

#[test]
fn an_answer_that_is_too_long_is_an_error_that_names_the_limit() {
    let dir = tempfile::tempdir().unwrap();
    script(dir.path(), "head -c 70000000 /dev/zero | tr '\\0' ' '; echo");
    run(dir.path(), "long", &["--budget", "1"]);
    let error = trials(dir.path(), "long")[0]["error"].as_str().unwrap().to_owned();
    assert!(error.contains("longer than 64 MiB"), "{error}");
}
