//! No command says that all is well, or that nothing was found, when it has seen too little.

use crate::common::{cover, fuzz, refused, stderr, stdout, succeeds};
use std::fs;

#[test]
fn a_bench_of_a_system_that_never_answers_is_no_result() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), "[[parameter]]\nname = \"x\"\ninterval = [0, 1]\n").unwrap();
    let bench = ["bench", "--system", "false", "--space", "SPACE.toml", "--spec", "always (y < 2.5)"];
    let more =
        ["--strategies", "random,halton", "--budget", "5", "--seeds", "2", "--reference-tests", "0", "--out", "b"];
    let output = fuzz(dir.path(), &[&bench[..], &more].concat());
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("10 of 10 tests of halton on false ended in an error"), "{said}");
    assert!(said.contains("every test of every run ended in an error"), "{said}");
    let runs = fs::read_to_string(dir.path().join("b/runs.csv")).unwrap();
    assert!(runs.lines().nth(1).unwrap().contains("random,1,5,,0,5,"), "{runs}");
}

#[test]
fn given_points_go_to_the_parameters_that_their_columns_name() {
    let dir = tempfile::tempdir().unwrap();
    let points = [[0.2, 0.1], [0.5, 0.2], [0.9, 0.4], [0.3, 0.8], [0.7, 0.05]];
    for (folder, header, swap) in [
        ("named", "speed,distance", false),
        ("swapped", "distance,speed", true),
        ("plain", "x1,x2", false),
        ("other", "foo,bar", false),
    ] {
        fs::create_dir(dir.path().join(folder)).unwrap();
        for seed in [1, 2] {
            let rows: String =
                points.iter().map(|[x, y]| if swap { format!("{y},{x}\n") } else { format!("{x},{y}\n") }).collect();
            fs::write(dir.path().join(folder).join(format!("{seed}.csv")), format!("{header}\n{rows}")).unwrap();
        }
    }
    let bench = |sets: &str, out: &str| {
        let arguments = ["bench", "pedestrian-crossing", "--strategies", sets, "--budget", "5", "--seeds", "2"];
        fuzz(dir.path(), &[&arguments[..], &["--reference-tests", "0", "--out", out]].concat())
    };
    succeeds(bench("a=named/*.csv,b=swapped/*.csv,c=plain/*.csv", "out"));
    let runs = fs::read_to_string(dir.path().join("out/runs.csv")).unwrap();
    let of = |name: &str| -> Vec<String> {
        runs.lines().filter_map(|line| line.split_once(&format!(",{name},")).map(|(_, rest)| rest.to_owned())).collect()
    };
    assert_eq!((of("a").len(), of("a"), of("a")), (2, of("b"), of("c")), "{runs}");
    let said = stderr(&bench("d=other/*.csv", "out2"));
    assert!(said.contains("found the columns foo, bar, expected speed, distance; or x1, x2 and so on"), "{said}");
}

#[test]
fn strategies_with_another_number_of_sets_for_each_size_are_compared() {
    let dir = tempfile::tempdir().unwrap();
    for (size, sets) in [(16, 3), (32, 2)] {
        for set in 0..sets {
            let row = |i: usize| {
                format!("{},{}\n", (i as f64 + 0.5) / size as f64, ((i * 7 + set) % size) as f64 / size as f64)
            };
            fs::write(dir.path().join(format!("{size}-{set}.csv")), (0..size).map(row).collect::<String>()).unwrap();
        }
    }
    let arguments = ["compare", "--strategies", "halton,mine=*.csv", "--dims", "2", "--budgets", "16,32"];
    let more = ["--seeds", "3", "--measures", "dispersion", "--out", "c"];
    succeeds(cover(dir.path(), &[&arguments[..], &more].concat()));
}

#[test]
fn a_log_that_decides_nothing_or_loses_samples_is_no_silent_success() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("spike.csv"), "time,speed\n0,1\n0.33,1\n0.35,99\n0.37,1\n1,1\n").unwrap();
    let monitor = |more: &[&str]| fuzz(dir.path(), &[&["monitor", "spike.csv", "--fail-on-violation"], more].concat());
    let coarse = succeeds(monitor(&["--every", "0.1", "--spec", "always (speed < 5)"]));
    let said = stderr(&coarse);
    assert!(said.contains("1 of 5 samples read count for nothing in some signal"), "{said}");
    assert!(said.contains("every sample but perhaps the last one counts"), "{said}");
    assert_eq!(monitor(&["--every", "0.02", "--spec", "always (speed < 5)"]).status.code(), Some(1));
    let later = monitor(&["--every", "0.02", "--spec", "always[5,6] (speed < 5)"]);
    assert_eq!(later.status.code(), Some(2));
    assert!(stderr(&later).contains("is undecided: the trace ends at 1 s"), "{}", stderr(&later));
}

#[test]
fn a_difference_names_all_that_differs_and_a_gate_needs_the_same_tests_and_requirements() {
    let dir = tempfile::tempdir().unwrap();
    let run = |budget: &str, more: &[&str], out: &str| {
        let usual = ["cut-in", "--driver", "rss", "--budget", budget, "--out", out];
        succeeds(fuzz(dir.path(), &[&usual[..], more].concat()))
    };
    run("20", &[], "before");
    run("20", &["--set", "friction=0.4"], "ice");
    run("20", &["--spec", "always (car.speed < 99)"], "more");
    run("10", &[], "less");
    let printed = stdout(&succeeds(fuzz(dir.path(), &["diff", "before", "ice"])));
    assert!(printed.contains("also different        friction is 0.8 before and 0.4 after"), "{printed}");
    succeeds(fuzz(dir.path(), &["diff", "before", "more", "--fail-on-new-failure"]));
    let gate = |before: &str, after: &str| fuzz(dir.path(), &["diff", before, after, "--fail-on-new-failure"]);
    let dropped = gate("more", "before");
    assert_eq!(dropped.status.code(), Some(2));
    assert!(
        stderr(&dropped).contains("the requirement spec-1 of more is not the same in before"),
        "{}",
        stderr(&dropped)
    );
    // A campaign that repeats tests has all of its own tests.
    succeeds(fuzz(dir.path(), &["cut-in", "--strategy", "random-corners", "--budget", "60", "--out", "corners"]));
    succeeds(gate("corners", "corners"));
    let less = gate("before", "less");
    assert_eq!(less.status.code(), Some(2));
    assert!(stderr(&less).contains("less does not have 10 tests of before"), "{}", stderr(&less));
}

#[test]
fn given_values_that_nobody_reads_are_named_and_explain_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let fog = succeeds(fuzz(dir.path(), &["--set", "fog=1", "--set", "friction=0.5", "--budget", "5", "--out", "fog"]));
    let said = stderr(&fog);
    assert!(said.contains("no effect: the given values of fog: read by neither"), "{said}");
    let nominal = succeeds(fuzz(dir.path(), &["--set", "fog=0", "--budget", "5", "--out", "clear"]));
    assert!(!stderr(&nominal).contains("no effect"), "{}", stderr(&nominal));
    let open = ["--open", "fog", "--open", "light", "--open", "friction", "--budget", "200", "--out", "open"];
    let printed = stdout(&succeeds(fuzz(dir.path(), &open)));
    let rules: Vec<&str> = printed.lines().filter(|line| line.contains(" tests where ")).collect();
    assert!(
        !rules.is_empty() && rules.iter().all(|rule| !rule.contains("fog") && !rule.contains("light")),
        "{printed}"
    );
}

#[test]
fn a_campaign_that_has_not_ended_says_so() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "30", "--out", "out"]));
    // As after a crash.
    fs::remove_file(dir.path().join("out/coverage.json")).unwrap();
    let log = fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap();
    fs::write(dir.path().join("out/trials.jsonl"), log.split_inclusive('\n').take(12).collect::<String>()).unwrap();
    for command in ["trace", "map", "blame"] {
        let said = stderr(&succeeds(fuzz(dir.path(), &[command, "out"])));
        assert!(
            said.contains("the campaign in out has not ended: 12 of at most 30 tests have run"),
            "{command}: {said}"
        );
    }
}

#[test]
fn blame_is_not_for_a_world_that_has_changed() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "30", "--out", "out"]));
    succeeds(fuzz(dir.path(), &["blame", "out"]));
    // As if the code of the scenario had changed: the first failing test has another trace.
    let log = fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap();
    let failing = log.lines().find(|line| line.contains("\"verdict\":\"fail\"")).unwrap();
    let (before, after) = failing.split_once("\"trace_hash\":\"").unwrap();
    let other = format!("{before}\"trace_hash\":\"{}{}", "0".repeat(16), &after[16..]);
    fs::write(dir.path().join("out/trials.jsonl"), log.replace(failing, &other)).unwrap();
    refused(&fuzz(dir.path(), &["blame", "out"]), &["has another trace than in the log", "has changed since"]);
}

#[test]
fn two_columns_of_one_name_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let space = "[[parameter]]\nname = \"x\"\ninterval = [0, 1]\n[[parameter]]\nname = \"y\"\ninterval = [0, 1]\n";
    fs::write(dir.path().join("S.toml"), space).unwrap();
    fs::write(dir.path().join("t.csv"), "x,y,x\n0.1,0.2,0.9\n").unwrap();
    refused(&cover(dir.path(), &["estimate", "t.csv", "--space", "S.toml"]), &["two columns are called `x`"]);
}

#[test]
fn points_say_which_fixed_parameter_is_not_the_one_of_the_protocol() {
    let dir = tempfile::tempdir().unwrap();
    let grid = ["ncap-cpfa", "--open", "ego_speed=10,20,30,40,50,60", "--discrete", "cross", "--budget", "6"];
    let printed = stdout(&succeeds(fuzz(dir.path(), &[&grid[..], &["--set", "friction=0.5", "--out", "p"]].concat())));
    assert!(printed.contains("points on this grid   none: friction is 0.5, the protocol has 0.8"), "{printed}");
}

#[test]
fn an_interval_of_three_numbers_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("S.toml"), "[[parameter]]\nname = \"x\"\ninterval = [0, 10, 20]\n").unwrap();
    let output = cover(dir.path(), &["generate", "--space", "S.toml", "--budget", "4"]);
    refused(&output, &["found 3 numbers as the interval, expected [lo, hi]"]);
}

#[test]
fn a_gate_refuses_a_requirement_that_nobody_judges() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("R.toml"), "[[requirement]]\nid = \"no-colision\"\n").unwrap();
    let gate =
        ["--requirements", "R.toml", "--budget", "5", "--fail-on-violation", "--driver", "ideal", "--set", "speed=1"];
    let output = fuzz(dir.path(), &gate);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("requirement `no-colision` was not judged"), "{}", stderr(&output));
    // A requirement that nobody has a formula for yet is no mistake, and hides no violation.
    fs::write(dir.path().join("R.toml"), "[[requirement]]\nid = \"horn\"\ntext = \"The car sounds its horn.\"\n")
        .unwrap();
    succeeds(fuzz(dir.path(), &[&gate[..], &["--out", "horn"]].concat()));
    let failing = ["--requirements", "R.toml", "--budget", "60", "--fail-on-violation", "--out", "failing"];
    assert_eq!(fuzz(dir.path(), &failing).status.code(), Some(1));
}

#[test]
fn a_formula_that_counts_at_the_beginning_alone_has_a_note() {
    let dir = tempfile::tempdir().unwrap();
    for (out, spec, part) in [
        ("one", "car.clearance_to_pedestrian > 1", Some("(car.clearance_to_pedestrian > 1)")),
        ("two", "always (car.speed < 5) implies car.speed < 3", Some("(car.speed < 3)")),
        ("three", "always (car.speed < 50 or car.clearance > 1)", None),
    ] {
        let said = stderr(&succeeds(fuzz(dir.path(), &["--spec", spec, "--budget", "3", "--out", out])));
        let note =
            part.map(|part| format!("spec-1: `{part}` counts at the beginning of a run alone; `always {part}` is"));
        assert_eq!(said.contains("counts at the beginning"), note.is_some(), "{said}");
        assert!(note.is_none_or(|note| said.contains(&note)), "{said}");
    }
    fs::write(dir.path().join("t.csv"), "time,x\n0,0\n0.1,9\n").unwrap();
    let monitored = succeeds(fuzz(dir.path(), &["monitor", "t.csv", "--spec", "x < 1", "--fail-on-violation"]));
    assert!(stderr(&monitored).contains("spec-1: `(x < 1)` counts at the beginning"), "{}", stderr(&monitored));
}

#[test]
fn a_driver_does_not_excuse_its_own_failures_and_excused_failures_alone_show_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let own = fuzz(dir.path(), &["--driver", "cruise", "--reference", "cruise", "--budget", "5"]);
    refused(&own, &["--reference cruise: the driver under test avoids none of its own failures"]);
    let excused = ["--set", "speed=9", "--set", "distance=8", "--reference", "ideal,cc", "--fail-on-violation"];
    let output = fuzz(dir.path(), &excused);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no test passed or failed (1 unpreventable)"), "{}", stderr(&output));
}

#[test]
fn an_export_says_which_surroundings_it_lacks() {
    let dir = tempfile::tempdir().unwrap();
    let slippery = ["--budget", "2", "--set", "friction=0.4", "--open", "fog=0.2..0.5", "--out", "slip", "-q"];
    succeeds(fuzz(dir.path(), &slippery));
    let said = stderr(&succeeds(fuzz(dir.path(), &["export", "slip", "1", "--out", "case"])));
    assert!(said.contains("the export does not have friction = 0.4, fog = 0."), "{said}");
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "dry", "-q"]));
    let said = stderr(&succeeds(fuzz(dir.path(), &["export", "dry", "1", "--out", "dry-case"])));
    assert!(!said.contains("does not have"), "{said}");
}
