//! The commands as a user gives them: what they print and what they write.

use crate::common::{cover, fuzz, golden, stderr, stdout, succeeds, without_study};
use paracosm::Log;
use paracosm::report::{FailureMap, Picture};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A small campaign in `dir/out`.
fn campaign(dir: &Path, more: &[&str]) -> String {
    let arguments = [&["--budget", "40", "--out", "out", "--format", "table"], more].concat();
    stdout(&succeeds(fuzz(dir, &arguments)))
}

/// What is printed, without the path of the program.
fn without_program(text: &str) -> String {
    text.replace(env!("CARGO_BIN_EXE_paracosm-fuzz"), "paracosm-fuzz")
}

#[test]
fn a_campaign_prints_a_summary_that_ends_with_the_replay_of_the_worst_test() {
    let dir = tempfile::tempdir().unwrap();
    golden("summary.txt", &without_program(&campaign(dir.path(), &[])));
}

#[test]
fn a_scenario_without_an_open_parameter_is_one_test_like_any_other() {
    let dir = tempfile::tempdir().unwrap();
    let set = ["--set", "ego_speed=40", "--set", "overlap=50", "--set", "target=standing"];
    let run = |more: &[&str]| fuzz(dir.path(), &[&["run", "ncap-ccr"], &set[..], more].concat());
    let ran = succeeds(run(&["--out", "one", "--format", "table"]));
    assert!(stderr(&ran).contains("no parameter is open, so there is one test"), "{}", stderr(&ran));
    let text = stdout(&ran);
    assert!(text.starts_with("ncap-ccr, driver aeb: 1 test\n"), "{text}");
    assert!(text.contains("ego_speed 40") && text.contains("replay one 0"), "{text}");
    // The test can be continued, replayed and measured, and fails the run if it fails.
    let json: serde_json::Value =
        serde_json::from_str(&stdout(&succeeds(run(&["--out", "one", "--resume", "--format", "json"])))).unwrap();
    assert_eq!((&json["tests"], &json["coverage"]["tests"]), (&1.into(), &1.into()));
    succeeds(fuzz(dir.path(), &["replay", "one", "0"]));
    succeeds(fuzz(dir.path(), &["trace", "one"]));
    succeeds(cover(dir.path(), &["estimate", "one"]));
    let failing = run(&["--driver", "cruise", "--out", "failing", "--strategy", "random", "--fail-on-violation"]);
    assert_eq!(failing.status.code(), Some(1), "{}", stderr(&failing));
}

#[test]
fn a_campaign_leaves_its_folder_as_the_contract_says() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let out = dir.path().join("out");
    let mut names: Vec<_> =
        fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let expected = [
        "campaign.json",
        "coverage.json",
        "effects.json",
        "explanation.json",
        "failure-map.csv",
        "failure-map.png",
        "failure-map.svg",
        "modes.json",
        "trials.csv",
        "trials.jsonl",
    ];
    assert_eq!(names, expected);
    golden("campaign.json", &fs::read_to_string(out.join("campaign.json")).unwrap().replace(target(), "TARGET"));
    let trials = fs::read_to_string(out.join("trials.jsonl")).unwrap();
    // The study has the version of the software and the target, so that its hash differs.
    let trials = without_study(&trials);
    assert_eq!(trials.lines().count(), 40);
    golden("trials.head.jsonl", &trials.lines().take(4).map(|line| format!("{line}\n")).collect::<String>());
    let table = fs::read_to_string(out.join("trials.csv")).unwrap();
    golden("trials.head.csv", &table.lines().take(4).map(|line| format!("{line}\n")).collect::<String>());
    golden("coverage.json", &fs::read_to_string(out.join("coverage.json")).unwrap());
}

/// The target that this test was built for, as it stands in `campaign.json`.
fn target() -> &'static str {
    paracosm::campaign::TARGET
}

#[test]
fn the_failure_map_is_the_same_picture_everywhere() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    // Without the estimate behind it, whose last digits are up to the processor.
    let log = Log::read(&dir.path().join("out"), &paracosm::catalogue()).unwrap();
    golden("failure-map.svg", &Picture::of(FailureMap::of(&log).unwrap()).svg().unwrap());
    let png = fs::read(dir.path().join("out/failure-map.png")).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), (1800, 1360));
}

#[test]
fn estimate_of_a_campaign_prints_what_its_coverage_json_holds() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let printed = stdout(&succeeds(cover(dir.path(), &["estimate", "out", "--time-limit", "5", "--format", "json"])));
    assert_eq!(printed, fs::read_to_string(dir.path().join("out/coverage.json")).unwrap());
    let piped = stdout(&succeeds(cover(dir.path(), &["estimate", "out"])));
    assert_eq!(piped, stdout(&succeeds(cover(dir.path(), &["estimate", "out", "--format", "table"]))));
    assert_ne!(piped, printed, "a pipe gets a table, like a terminal");
    // The flat table of the same trials, with the space beside it, says the same.
    let toml = "[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10.0]\n\
                [[parameter]]\nname = \"distance\"\ninterval = [5.0, 60.0]\n";
    fs::write(dir.path().join("SPACE.toml"), toml).unwrap();
    let table = cover(dir.path(), &["estimate", "out/trials.csv", "--space", "SPACE.toml", "--format", "json"]);
    assert_eq!(stdout(&succeeds(table)), printed);
}

#[test]
fn estimate_of_points_in_a_file_and_of_a_strategy_agree() {
    let dir = tempfile::tempdir().unwrap();
    let points = "x1,x2\n0.5,0.3333333333333333\n0.25,0.6666666666666666\n0.75,0.1111111111111111\n";
    fs::write(dir.path().join("points.csv"), points).unwrap();
    let file = stdout(&succeeds(cover(dir.path(), &["estimate", "points.csv", "--format", "table"])));
    golden("estimate.txt", &file);
    let strategy = ["estimate", "--strategy", "halton", "--dims", "2", "--budget", "3", "--format", "table"];
    let strategy = stdout(&succeeds(cover(dir.path(), &strategy)));
    assert_eq!(strategy.lines().skip(1).collect::<Vec<_>>(), file.lines().skip(1).collect::<Vec<_>>());
}

/// The files are as `numpy.savetxt` writes them by default, with a header, with commas, and with a format that aligns.
#[test]
fn files_of_numbers_and_standard_input_are_measured_as_a_csv_with_the_same_tests() {
    let dir = tempfile::tempdir().unwrap();
    let space = "[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10.0]\n\
                 [[parameter]]\nname = \"gap\"\ninterval = [5.0, 60.0]\n";
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let csv = "speed,gap\n1.5,20\n9.25,40\n0.5,60\n";
    let estimate = |text: &str, from: &str| {
        fs::write(dir.path().join("tests"), text).unwrap();
        let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-cover"));
        program.args(["estimate", from, "--space", "SPACE.toml"]).current_dir(dir.path());
        program.stdin(fs::File::open(dir.path().join("tests")).unwrap());
        let printed = stdout(&succeeds(program.output().unwrap()));
        assert!(from != "-" || printed.contains("standard input: 3 tests over speed, gap"), "{printed}");
        printed.lines().skip(1).map(str::to_owned).collect::<Vec<_>>()
    };
    let expected = estimate(csv, "tests");
    let files = [
        "1.500000000000000000e+00 2.000000000000000000e+01\n9.25e+00 4.0e+01\n5e-01 6e+01\n",
        "# speed gap\n1.5 20\n9.25 40\n0.5 60\n",
        "# made on Monday\n# gap,speed\n20,1.5\n40,9.25\n# the last\n60,0.5\n",
        "   1.5     20.0\r\n   9.25    40.0\r\n\n\t0.5\t60\r\n",
        "\u{feff}1.5,20\n9.25,40\n0.5,60\n",
        "\n\"1.5\",\"20\"\n\"9.25\",\"40\"\n\"0.5\",\"60\"\n",
        "# Gap [m], Speed [m/s]\n\n# made by nobody\n20 1.5\n40 9.25\n60 0.5\n",
    ];
    for text in files {
        assert_eq!(estimate(text, "tests"), expected, "{text}");
        assert_eq!(estimate(text, "-"), expected, "{text}");
    }
    assert_eq!(estimate(csv, "-"), expected);
}

#[test]
fn estimate_counts_the_combinations_of_discrete_parameters() {
    let dir = tempfile::tempdir().unwrap();
    let toml = "[[parameter]]\nname = \"lanes\"\nchoice = [2, 4, 6]\n\
                [[parameter]]\nname = \"weather\"\nchoice = [\"clear\", \"fog\"]\n\
                [[parameter]]\nname = \"speed\"\ninterval = [0.0, 10.0]\n";
    fs::write(dir.path().join("SPACE.toml"), toml).unwrap();
    let tests = "speed,weather,lanes\n1,clear,2\n2,fog,4\n3,clear,6\n4,fog,6\n5,fog,2\n";
    fs::write(dir.path().join("tests.csv"), tests).unwrap();
    let printed = cover(dir.path(), &["estimate", "tests.csv", "--space", "SPACE.toml", "--format", "json"]);
    golden("estimate-mixed.json", &stdout(&succeeds(printed)));
}

#[test]
fn replay_repeats_a_test_with_the_same_hash_and_writes_its_trace() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let replay = succeeds(fuzz(dir.path(), &["replay", "out", "17", "--format", "json"]));
    let log = without_study(&fs::read_to_string(dir.path().join("out/trials.jsonl")).unwrap());
    let line = log.lines().nth(17).unwrap();
    let printed: serde_json::Value = serde_json::from_str(&stdout(&replay)).unwrap();
    assert_eq!(printed, serde_json::from_str::<serde_json::Value>(line).unwrap());
    let trace = fs::read_to_string(dir.path().join("out/trace-17.csv")).unwrap();
    assert_eq!(trace.lines().count(), 1 + 2501);
    golden("trace.head.csv", &trace.lines().take(3).map(|line| format!("{line}\n")).collect::<String>());
}

#[test]
fn estimate_of_a_campaign_looks_at_as_many_parameters_together_as_the_campaign_did() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &["--open", "lanes", "--open", "friction=0.2,0.5,0.8", "--k", "1"]);
    let printed = stdout(&succeeds(cover(dir.path(), &["estimate", "out", "--format", "json"])));
    assert_eq!(printed, fs::read_to_string(dir.path().join("out/coverage.json")).unwrap());
    let json: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((json["discrete"]["k"].as_u64(), json["discrete"]["valid"].as_u64()), (Some(1), Some(6)));
}

#[test]
fn a_space_without_continuous_parameters_is_tested_once_each_and_that_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--open", "lanes", "--open", "friction=0.2,0.5,0.8", "--set", "speed=2", "--set", "distance=20"];
    for (family, out) in [("random", "a"), ("cross", "b")] {
        let options = [&options[..], &["--discrete", family, "--out", out]].concat();
        let note = stderr(&succeeds(fuzz(dir.path(), &options)));
        assert!(note.contains("the strategy has only 9 tests for these parameters"), "{note}");
        assert!(note.contains("no failure map"), "{note}");
        assert_eq!(fs::read_to_string(dir.path().join(out).join("trials.jsonl")).unwrap().lines().count(), 9);
    }
}

#[test]
fn a_campaign_with_all_combinations_of_two_values_says_how_the_budget_is_used() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--open", "lanes", "--open", "friction=0.2,0.5,0.8", "--open", "speed=1,2", "--set", "distance=20"];
    let more = "; `--k 3` covers combinations of 3 values, and `--discrete random` uses the whole budget";
    let note = |out: &str, more: &[&str]| {
        stderr(&succeeds(fuzz(dir.path(), &[&options[..], &["--budget", "15", "--out", out], more].concat())))
    };
    let found = note("a", &[]);
    assert!(found.contains(&format!("the strategy has only 9 tests for these parameters{more}")), "{found}");
    for (out, options) in [("b", ["--k", "3"]), ("c", ["--discrete", "random"])] {
        let found = note(out, &options);
        assert!(!found.contains("before its budget"), "{found}");
        assert_eq!(fs::read_to_string(dir.path().join(out).join("trials.jsonl")).unwrap().lines().count(), 15);
    }
}

#[test]
fn a_trace_does_not_replace_a_file_of_the_campaign() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let before = fs::read(dir.path().join("out/trials.jsonl")).unwrap();
    let replay = fuzz(dir.path(), &["replay", "out", "3", "--trace", "out/trials.jsonl"]);
    crate::common::refused(&replay, &["out/trials.jsonl", "belongs to campaigns"]);
    assert_eq!(fs::read(dir.path().join("out/trials.jsonl")).unwrap(), before);
}

#[test]
fn replay_fails_where_the_log_says_something_else() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let log = dir.path().join("out/trials.jsonl");
    let mut lines: Vec<String> = fs::read_to_string(&log).unwrap().lines().map(str::to_owned).collect();
    lines[3] = lines[3].replace("\"trace_hash\":\"", "\"trace_hash\":\"f00");
    fs::write(&log, lines.join("\n") + "\n").unwrap();
    crate::common::refused(&fuzz(dir.path(), &["replay", "out", "3"]), &["test 3", "differs", "f00"]);
}

#[test]
fn exit_status_1_says_that_a_violation_was_found_and_only_where_asked() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let violated = fuzz(dir.path(), &["--budget", "40", "--out", "again", "--fail-on-violation"]);
    assert_eq!(violated.status.code(), Some(1), "{}", stderr(&violated));
    let kept = fuzz(dir.path(), &["--budget", "1", "--out", "one", "--fail-on-violation"]);
    assert_eq!(kept.status.code(), Some(0), "{}", stderr(&kept));
    let trials = fs::read_to_string(dir.path().join("again/trials.jsonl")).unwrap();
    let failing = trials.lines().position(|line| line.contains("\"fail\"")).unwrap().to_string();
    let replay = fuzz(dir.path(), &["replay", "again", &failing, "--fail-on-violation"]);
    assert_eq!(replay.status.code(), Some(1), "{}", stderr(&replay));
}

/// A system that cannot run its second test.
const BREAKS: &str = r#"while read -r line; do i=${line#*:}; i=${i%%,*}
if [ $i = 1 ]; then echo "{\"index\":$i,\"error\":\"no licence\"}"; else echo "{\"index\":$i,\"robustness\":{\"a\":1}}"; fi; done"#;

#[test]
fn a_gate_does_not_open_if_a_test_has_no_verdict() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("system.sh"), BREAKS).unwrap();
    fs::write(dir.path().join("SPACE.toml"), "parameter = [{ name = \"x\", interval = [-1, 1] }]\n").unwrap();
    let system = ["--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "4", "-q", "--out"];
    succeeds(fuzz(dir.path(), &[&system[..], &["open"]].concat()));
    let gate = fuzz(dir.path(), &[&system[..], &["gate", "--fail-on-violation"]].concat());
    crate::common::refused(&gate, &["1 of 4 tests ended in an error", "the first, test 1: ", "no licence"]);
    assert!(stdout(&gate).contains("error"), "the summary is printed all the same");
    let replay = ["replay", "gate", "1", "--trust"];
    succeeds(fuzz(dir.path(), &replay));
    let replayed = fuzz(dir.path(), &[&replay[..], &["--fail-on-violation"]].concat());
    crate::common::refused(&replayed, &["test 1 ended in an error", "no licence"]);
}

#[test]
fn a_gate_does_not_open_if_no_test_shows_anything() {
    let dir = tempfile::tempdir().unwrap();
    // The pedestrian waits behind the car, so that the situation never comes about.
    let never = ["ncap-cpfa", "--driver", "aeb", "--set", "driver.ttc=10", "--set", "driver.field_of_view=180"];
    let never = [&never[..], &["--set", "driver.clear_ttc=20", "--set", "driver.margin=2"]].concat();
    let one = [&never[..], &["--set", "ego_speed=10", "--out", "one", "-q"]].concat();
    let free = stdout(&succeeds(fuzz(dir.path(), &one)));
    assert!(free.contains("inconclusive"), "{free}");
    let gate = [&never[..], &["--set", "ego_speed=10", "--out", "gate", "--fail-on-violation"]].concat();
    crate::common::refused(&fuzz(dir.path(), &gate), &["no test passed or failed (1 inconclusive)"]);
}

#[test]
fn open_and_set_change_the_space_and_the_rest() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--open", "friction=0.3..0.8", "--open", "lanes", "--set", "speed=2", "--set", "driver.ttc=1.2"];
    campaign(dir.path(), &options);
    let text = fs::read_to_string(dir.path().join("out/campaign.json")).unwrap();
    let study: serde_json::Value = serde_json::from_str(&text).unwrap();
    let names: Vec<_> = study["space"]["parameter"].as_array().unwrap().iter().map(|p| p["name"].clone()).collect();
    assert_eq!(names, ["distance", "friction", "lanes"]);
    assert_eq!(study["fixed"]["speed"], 2);
    assert_eq!(study["driver"]["settings"]["ttc"], 1.2);
    // Every value of `lanes` was tested, and the coverage says so.
    let coverage: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(dir.path().join("out/coverage.json")).unwrap()).unwrap();
    assert_eq!(coverage["discrete"]["covered"], 3);
}

#[test]
fn list_shows_scenarios_strategies_and_drivers() {
    let dir = tempfile::tempdir().unwrap();
    golden("list.txt", &stdout(&succeeds(fuzz(dir.path(), &["list", "--format", "table"]))));
    let json = stdout(&succeeds(fuzz(dir.path(), &["list", "--format", "json"])));
    let list: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(list["drivers"][0]["name"], "aeb");
}

/// The help of a command on a terminal with this number of columns.
fn help(program: &str, columns: usize, arguments: &[&str]) -> String {
    let path = match program {
        "paracosm-fuzz" => env!("CARGO_BIN_EXE_paracosm-fuzz"),
        _ => env!("CARGO_BIN_EXE_paracosm-cover"),
    };
    let output = Command::new(path).args(arguments).env("COLUMNS", columns.to_string()).output().expect("it starts");
    stdout(&succeeds(output))
}

/// The commands of a program, from its own short help.
fn commands(program: &str) -> Vec<String> {
    let help = help(program, 80, &["-h"]);
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = lines.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help");
    names.map(str::to_owned).collect()
}

#[test]
fn short_help_fits_a_screen_and_long_help_has_an_example_and_wraps_once() {
    for (program, least) in [("paracosm-fuzz", 17), ("paracosm-cover", 4)] {
        let commands = commands(program);
        assert!(commands.len() >= least, "{commands:?}");
        for command in [""].into_iter().chain(commands.iter().map(String::as_str)) {
            let of = |columns: usize, flag: &str| {
                let arguments: Vec<&str> = [command, flag].into_iter().filter(|word| !word.is_empty()).collect();
                help(program, columns, &arguments)
            };
            let short = of(80, "-h");
            assert!(short.lines().count() <= 45, "{program} {command}: {} lines\n{short}", short.lines().count());
            let long = of(100, "--help");
            assert!(long.contains("Example") && long.contains(&format!("{program} ")), "{command}: {long}");
            for columns in [60, 80, 120] {
                let usage = |line: &str| line.trim_start_matches("Usage:").trim_start().starts_with(program);
                for line in of(columns, "--help").lines().filter(|line| line.starts_with("  paracosm") || !usage(line))
                {
                    // One word may be longer than a line.
                    let has_one_word = line.split_whitespace().count() == 1;
                    assert!(line.chars().count() <= columns || has_one_word, "{command}, {columns} columns: {line}");
                }
            }
            // Text that is wrapped by hand has short lines on a wide terminal, and ragged lines on a narrow one.
            let wide = of(2000, "--help");
            let of_text = wide.lines().filter(|line| !line.starts_with(' ') && !line.is_empty()).collect::<Vec<_>>();
            for pair in of_text.windows(2) {
                let follows = wide.contains(&pair.join("\n"));
                assert!(!follows || pair[1].starts_with("Usage") || pair[0].ends_with(':'), "{command}: {pair:?}");
            }
        }
    }
}

#[test]
fn quiet_says_nothing_and_verbose_names_the_tests_that_do_not_pass() {
    let dir = tempfile::tempdir().unwrap();
    let quiet = succeeds(fuzz(dir.path(), &["-q", "--budget", "40", "--out", "a"]));
    assert_eq!(stderr(&quiet), "");
    let verbose = succeeds(fuzz(dir.path(), &["-v", "--budget", "40", "--out", "b"]));
    assert!(stderr(&verbose).contains(": fail, speed "), "{}", stderr(&verbose));
}
