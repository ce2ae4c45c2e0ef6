//! `paracosm-fuzz bench`: what it writes, that it is right, that it goes on where it was, and what it refuses.

use crate::common::{fuzz, golden, refused, stdout, succeeds};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A tiny study in `dir/NAME`.
fn bench(dir: &Path, name: &str, more: &[&str]) -> String {
    let study = ["bench", "--scenarios", "pedestrian-crossing,ball5", "--strategies", "random,halton,cmaes,auto"];
    let sizes = ["--budget", "40", "--seeds", "4", "--reference-tests", "400", "--quiet", "--out", name];
    stdout(&succeeds(fuzz(dir, &[&study, sizes.as_slice(), more].concat())))
}

/// The rows of a CSV, each by the names of its columns.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let header: Vec<String> = lines.next().unwrap().collect();
    lines.map(|line| header.iter().cloned().zip(line).collect()).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> Option<f64> {
    (!row[column].is_empty()).then(|| row[column].parse().unwrap())
}

#[test]
fn a_bench_has_a_row_for_every_run_and_a_table_of_them() {
    let dir = tempfile::tempdir().unwrap();
    let printed = bench(dir.path(), "out", &["--format", "table"]);
    golden("bench.txt", &printed);
    let out = dir.path().join("out");
    let mut names: Vec<_> =
        fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let mut expected: Vec<String> = ["ball5-survival", "pedestrian-crossing-recall", "pedestrian-crossing-survival"]
        .iter()
        .flat_map(|figure| ["png", "svg"].map(|end| format!("{figure}.{end}")))
        .collect();
    let files = ["bench.json", "correlations.csv", "maps", "runs.csv", "standings.csv", "summary.csv", "survival.csv"];
    expected.extend(files.map(str::to_owned));
    expected.push("table.tex".into());
    expected.sort();
    assert_eq!(names, expected);
    let runs = rows(&out.join("runs.csv"));
    assert_eq!(runs.len(), 2 * 4 * 4);
    for run in &runs {
        let is_function = run["scenario"] == "ball5";
        assert_eq!(run["recall"].is_empty(), is_function, "{run:?}");
        assert_eq!(run["dispersion"].is_empty(), is_function, "{run:?}");
        let first = number(run, "first_failure");
        assert!(first.is_none_or(|first| first <= number(run, "tests").unwrap()), "{run:?}");
        assert_eq!(first.is_none(), run["failures"] == "0", "{run:?}");
    }
}

#[test]
fn the_summary_is_what_the_rows_say() {
    let dir = tempfile::tempdir().unwrap();
    bench(dir.path(), "out", &["--baseline", "halton"]);
    let out = dir.path().join("out");
    let (runs, summary) = (rows(&out.join("runs.csv")), rows(&out.join("summary.csv")));
    assert_eq!(summary.len(), 2 * 4);
    let waited = |scenario: &str, strategy: &str| -> Vec<f64> {
        let here = runs.iter().filter(|run| run["scenario"] == scenario && run["strategy"] == strategy);
        here.map(|run| number(run, "first_failure").unwrap_or(40.0)).collect()
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    for cell in &summary {
        let scenario = &cell["scenario"];
        let mine = waited(scenario, &cell["strategy"]);
        let close = |column: &str, expected: f64| {
            let found = number(cell, column).unwrap();
            assert!((found - expected).abs() < 1e-9, "{column}: {found}, expected {expected} in {cell:?}");
        };
        close("restricted_mean", mean(&mine));
        let best = ["random", "halton", "cmaes"].map(|strategy| mean(&waited(scenario, strategy)));
        close("over_best", mean(&mine) / best.into_iter().fold(f64::INFINITY, f64::min));
        if cell["strategy"] == "halton" {
            assert!(["ratio", "holm_p", "log_rank_p"].iter().all(|column| cell[*column].is_empty()));
        } else {
            close("ratio", mean(&mine) / mean(&waited(scenario, "halton")));
        }
    }
    let curve: Vec<_> = rows(&out.join("survival.csv"));
    for step in &curve {
        let mine = waited(&step["scenario"], &step["strategy"]);
        let later = mine.iter().filter(|time| **time > number(step, "tests").unwrap()).count();
        let found = number(step, "without_failure").unwrap();
        // A run that ends at the budget without a failure is later than it.
        assert!(step["tests"] == "40" || (found - later as f64 / 4.0).abs() < 1e-12, "{step:?}");
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_jobs_nor_on_being_cut_short() {
    let dir = tempfile::tempdir().unwrap();
    let one = bench(dir.path(), "one", &["--jobs", "1"]);
    let text = fs::read_to_string(dir.path().join("one/runs.csv")).unwrap();
    // What a kill leaves behind: some rows, and one without an end; nothing of what is derived.
    let two = dir.path().join("two");
    fs::create_dir(&two).unwrap();
    fs::copy(dir.path().join("one/bench.json"), two.join("bench.json")).unwrap();
    fs::write(two.join("runs.csv"), &text[..text.len() / 3]).unwrap();
    let again = bench(dir.path(), "two", &["--jobs", "2", "--resume"]);
    assert_eq!(one.replace("one", "two"), again);
    for name in ["runs.csv", "summary.csv", "table.tex", "maps/pedestrian-crossing.json", "ball5-survival.svg"] {
        let read = |folder: &str| fs::read_to_string(dir.path().join(folder).join(name)).unwrap();
        let without_command = |text: String| text.lines().filter(|l| !l.contains("\"command\"")).collect::<String>();
        assert!(without_command(read("one")) == without_command(read("two")), "{name} differs");
    }
}

#[test]
fn a_run_is_the_campaign_of_its_seed() {
    let dir = tempfile::tempdir().unwrap();
    bench(dir.path(), "out", &["--seed", "7"]);
    for strategy in ["halton", "cmaes"] {
        let campaign = [
            "run",
            "--strategy",
            strategy,
            "--budget",
            "40",
            "--seed",
            "9",
            "--out",
            strategy,
            "--quiet",
            "--format",
            "json",
        ];
        let printed: Value =
            serde_json::from_str(&stdout(&succeeds(fuzz(dir.path(), &campaign)))).expect("the summary is JSON");
        let trials = fs::read_to_string(dir.path().join(strategy).join("trials.jsonl")).unwrap();
        let first = trials.lines().position(|line| line.contains("\"verdict\":\"fail\"")).map(|index| index + 1);
        let runs = rows(&dir.path().join("out/runs.csv"));
        let run = runs
            .iter()
            .find(|run| run["scenario"] == "pedestrian-crossing" && run["strategy"] == strategy && run["seed"] == "9");
        let run = run.unwrap();
        assert_eq!(number(run, "first_failure"), first.map(|first| first as f64));
        assert_eq!(number(run, "failures"), printed["verdicts"]["fail"].as_f64());
        let dispersion = printed["coverage"]["continuous"]["dispersion"]["upper"].as_f64();
        // The points of a campaign were values in between.
        let off = number(run, "dispersion").unwrap() - dispersion.unwrap();
        assert!(off.abs() < 1e-12, "{off}");
    }
}

#[test]
fn a_map_that_was_written_judges_runs_as_the_map_that_was_made() {
    let dir = tempfile::tempdir().unwrap();
    let small = ["bench", "--strategies", "random", "--budget", "30", "--seeds", "2", "--quiet"];
    succeeds(fuzz(dir.path(), &[small.as_slice(), &["--out", "made", "--reference-tests", "400"]].concat()));
    let map = dir.path().join("made/maps/pedestrian-crossing.json");
    let written: Value = serde_json::from_str(&fs::read_to_string(map).unwrap()).unwrap();
    let verdicts = written["verdicts"].as_array().unwrap().iter().map(|line| line.as_str().unwrap().len());
    assert_eq!(verdicts.sum::<usize>(), 400);
    succeeds(fuzz(dir.path(), &[small.as_slice(), &["--out", "read", "--reference", "made/maps"]].concat()));
    let runs = |folder: &str| fs::read_to_string(dir.path().join(folder).join("runs.csv")).unwrap();
    assert_eq!(runs("made"), runs("read"));
    assert!(number(&rows(&dir.path().join("made/runs.csv"))[0], "recall").is_some());
}

/// A bench of a system with three switches that fails for one setting of them; its table and its folder.
fn switches(dir: &Path, failing: &str, strategies: &str) -> String {
    let switch = |name: &str| format!("{{ name = \"{name}\", choice = [0, 1] }}");
    fs::write(dir.join("SPACE.toml"), format!("parameter = [{}, {}, {}]", switch("a"), switch("b"), switch("c")))
        .unwrap();
    let answer = r#"echo "{\"index\":${i%%,*},\"robustness\":{\"holds\":$r}}""#;
    let judge = format!("case $line in *{failing}*) r=-1;; *) r=1;; esac");
    fs::write(dir.join("system.sh"), format!("while read -r line; do i=${{line#*:}}\n{judge}\n{answer}\ndone\n"))
        .unwrap();
    let system = ["bench", "--system", "sh system.sh", "--space", "SPACE.toml", "--strategies", strategies];
    let sizes = ["--budget", "20", "--seeds", "6", "--reference-tests", "0", "--quiet", "--format", "table"];
    stdout(&succeeds(fuzz(dir, &[&system[..], &sizes].concat())))
}

#[test]
fn a_combination_that_a_covering_array_leaves_out_is_found() {
    let dir = tempfile::tempdir().unwrap();
    switches(dir.path(), r#"'"a":1,"b":1,"c":1}'"#, "random,halton,lhs,pso");
    for run in rows(&dir.path().join("paracosm-bench/runs.csv")) {
        assert!(number(&run, "first_failure").is_some_and(|first| first <= 8.0), "{run:?}");
        assert_eq!((number(&run, "tests"), number(&run, "failures")), (Some(8.0), Some(1.0)), "{run:?}");
    }
}

#[test]
fn a_run_that_has_tested_all_there_is_in_vain_is_not_censored() {
    let dir = tempfile::tempdir().unwrap();
    let table = switches(dir.path(), "never", "random,cmaes");
    for strategy in ["random", "cmaes"] {
        let said = format!(
            "{strategy}: 6 of 6 runs tried every test that the strategy can propose and found no failure; each of these runs counts as 20 tests"
        );
        assert!(table.contains(&said), "{table}");
    }
    for cell in rows(&dir.path().join("paracosm-bench/summary.csv")) {
        assert_eq!((&cell["found"][..], &cell["exhausted"][..], &cell["restricted_mean"][..]), ("0", "6", "20"));
    }
}

#[test]
fn what_cannot_be_benched_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let bench = |more: &[&str]| fuzz(dir.path(), &[&["bench"], more].concat());
    refused(&bench(&["--scenarios", "cutin"]), &["`cutin`", "did you mean `cut-in`"]);
    refused(&bench(&["--scenarios", "bal5"]), &["did you mean `ball5`"]);
    refused(&bench(&["--scenarios", "cut-in,cut-in"]), &["cut-in is twice in the list of scenarios"]);
    refused(&bench(&["--strategies", "cmase"]), &["`cmase`", "cmaes"]);
    refused(&bench(&["--seeds", "1"]), &["seeds is 1", "at least 2"]);
    refused(&bench(&["--budget", "0"]), &["0 as the budget"]);
    refused(
        &bench(&["--baseline", "greedy"]),
        &["the baseline greedy is not among the strategies: add it to them, or choose another baseline"],
    );
    refused(&bench(&["--strategies", "fibonacci", "--scenarios", "ball5"]), &["fibonacci on ball5"]);
    refused(&bench(&["--scenarios", "cut-in+wind"]), &["wind"]);
    fs::write(dir.path().join("there"), "").unwrap();
    refused(&bench(&["--out", "there"]), &["is a file"]);
    refused(&bench(&["--out", "."]), &["is not empty"]);
    let small = ["--budget", "5", "--seeds", "2", "--reference-tests", "20", "--strategies", "random", "--out", "out"];
    succeeds(bench(&small));
    refused(&bench(&[&small[2..], &["--budget", "6", "--resume"]].concat()), &["different bench", "`budget`"]);
    let runs = dir.path().join("out/runs.csv");
    let text = fs::read_to_string(&runs).unwrap();
    fs::write(&runs, text.replace("random,2", "random,3")).unwrap();
    refused(&bench(&[small.as_slice(), &["--resume"]].concat()), &["runs.csv, line 3", "edited"]);
}

#[test]
fn a_bench_with_too_few_given_sets_is_refused_before_the_first_run() {
    let dir = tempfile::tempdir().unwrap();
    for set in ["a", "b"] {
        fs::write(dir.path().join(format!("{set}.csv")), "x1,x2\n0.1,0.2\n0.7,0.4\n0.3,0.9\n").unwrap();
    }
    let study = [
        "bench",
        "--scenarios",
        "pedestrian-crossing",
        "--strategies",
        "random,mine=*.csv",
        "--budget",
        "3",
        "--reference-tests",
        "0",
    ];
    let run = |seeds: &str| fuzz(dir.path(), &[&study[..], &["--seeds", seeds, "--quiet", "--out", "out"]].concat());
    refused(&run("3"), &["`mine` has 2 sets of 3 points in 2 dimensions, and no set 3"]);
    let last =
        fuzz(dir.path(), &[&study[..], &["--seeds", "2", "--seed", "18446744073709551614", "--out", "out"]].concat());
    refused(&last, &["and no set 18446744073709551614"]);
    assert!(!dir.path().join("out").exists());
    succeeds(run("2"));
}
