//! Bad input: refused with exit status 2 and a message that says what is wrong where, and nothing is written.

use crate::common::{cover, fuzz, refused, succeeds, without_study};
use serde_json::Value;
use std::fs;
use std::process::Command;

#[test]
fn a_folder_after_resume_is_taken_for_no_scenario() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "slippery", "-q"]));
    let resume = |name: &str| fuzz(dir.path(), &["--resume", name]);
    refused(&resume("slipery"), &["slipery is neither a campaign folder", "`--out slippery --resume`"]);
    refused(&resume("slippery"), &["slippery is the folder of a campaign, not a scenario", "--out slippery --resume"]);
    refused(&resume("pedestrian-crosing"), &["nor a scenario", "`pedestrian-crossing`"]);
    refused(&resume("nothing-like-it"), &["nothing-like-it", "--out names the folder\n"]);
    assert!(!dir.path().join("paracosm-out").exists());
}

#[test]
fn wrong_campaigns_are_refused_with_the_nearest_valid_name() {
    let dir = tempfile::tempdir().unwrap();
    let cases: &[(&[&str], &[&str])] = &[
        (&["pedestrian-crosing"], &["`pedestrian-crosing`", "`pedestrian-crossing`"]),
        (&["--strategy", "haltom"], &["`haltom`", "`halton`"]),
        (&["--driver", "eab"], &["`eab`", "`aeb`"]),
        (&["--driver", "nothing-like-it"], &["`nothing-like-it`", "paracosm-fuzz list"]),
        (&["--open", "fiction"], &["`fiction`", "`friction`"]),
        (&["--set", "lane=4"], &["`lane`", "`lanes`"]),
        (&["--set", "driver.tcc=1"], &["`tcc`", "`ttc`"]),
        (&["--set", "lanes=3"], &["`lanes`", "found 3", "2, 4, 6"]),
        (&["--set", "speed"], &["NAME=VALUE"]),
        (&["--set", "driver.ttc=soon"], &["`soon`", "number"]),
        (&["--set", "driver.samples=3.7"], &["`samples`", "3.7", "whole number"]),
        (&["--set", "friction=0.5", "--open", "friction"], &["`friction`", "set and opened"]),
        (&["--set", "speed=1", "--set", "speed=2"], &["`speed`", "set twice"]),
        (&["--set", "driver.ttc=NaN"], &["`ttc`", "NaN", "0 to 10"]),
        (&["--set", "friction=NaN"], &["`friction`", "NaN"]),
        (&["--set", "speed=1", "--set", "distance=9", "--k", "2"], &["k is 2", "discrete parameters, which is 0"]),
        (&["--set", "speed=1", "--set", "distance=9", "--budget", "0"], &["budget is 0"]),
        (&["--budget", "0"], &["budget is 0"]),
        (&["--budget", "-3"], &["error: --budget <N>: found `-3`, expected a whole number from 0 on\n"]),
        (&["--budget", "many"], &["error: --budget <N>: found `many`, expected a whole number from 0 on\n"]),
        (&["--jobs", "0"], &["error: --jobs <N>: found `0`, expected a whole number from 1 on\n"]),
        (&["--locate=x"], &["error: --locate[=<N>]: found `x`, expected a whole number from 0 on\n"]),
        (&["--epsilon", "little"], &["error: --epsilon <E>: found `little`, expected a number\n"]),
        (&["--seed", "18446744073709551616"], &["--seed <N>", "expected a smaller number"]),
        (&["--open", "speed=5..5"], &["`speed`", "[5, 5]"]),
        (&["--open", "speed=7..5"], &["`speed`", "[7, 5]"]),
        (&["--open", "speed=NaN..5"], &["`speed`", "NaN"]),
        (&["--open", "speed=1..inf"], &["`speed`", "inf"]),
        (&["--open", "speed=1..99"], &["`speed`", "99", "[0.5, 10]"]),
        (&["--open", "speed=a..b"], &["`a..b`", "LO..HI"]),
        (&["--open", "lanes=2..6"], &["`lanes`", "not an interval"]),
        (&["--open", "lanes=2,3"], &["`lanes`", "found 3"]),
        (&["--open", "lanes=2,2"], &["`lanes`", "twice"]),
        (&["--k", "2"], &["k is 2", "discrete parameters, which is 0"]),
        (&["--open", "lanes", "--k", "0"], &["k is 0"]),
        (&["--discrete", "crosss"], &["`crosss`", "`cross`"]),
        (&["--strategy", "random", "--skip", "3"], &["`random`", "halton"]),
        (&["--strategy", "fibonacci", "--open", "friction"], &["fibonacci", "exactly 2"]),
        (&["--skip", "9007199254740992"], &["halton"]),
        (&["--no-such-flag"], &["--no-such-flag"]),
    ];
    for (arguments, says) in cases {
        refused(&fuzz(dir.path(), arguments), says);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "{arguments:?} wrote something");
    }
}

#[test]
fn folders_that_cannot_be_written_are_named() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("file"), "").unwrap();
    refused(&fuzz(dir.path(), &["--out", "file"]), &["file is a file, expected a folder"]);
    refused(&fuzz(dir.path(), &["--out", "file/out"]), &["cannot create", "file/out"]);
    refused(&fuzz(dir.path(), &["--out", "/proc/paracosm"]), &["cannot create", "/proc/paracosm"]);
}

#[test]
fn replays_of_what_is_not_there_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    refused(&fuzz(dir.path(), &["replay", "nowhere", "1"]), &["nowhere/campaign.json"]);
    succeeds(fuzz(dir.path(), &["--budget", "3", "--out", "out", "-q"]));
    refused(&fuzz(dir.path(), &["replay", "out", "3"]), &["no test 3", "0 to 2"]);
    refused(&fuzz(dir.path(), &["replay", "out", "-1"]), &["-1"]);
    refused(&fuzz(dir.path(), &["replay", "out", "1", "--trace", "no/such/trace.csv"]), &["no/such/trace.csv"]);
    fs::write(dir.path().join("out/campaign.json"), "{\"format\": 1}").unwrap();
    refused(&fuzz(dir.path(), &["replay", "out", "1"]), &["campaign.json", "missing field"]);
    refused(&cover(dir.path(), &["estimate", "out"]), &["campaign.json", "missing field"]);
}

#[test]
fn broken_files_of_tests_are_refused_with_the_line() {
    let dir = tempfile::tempdir().unwrap();
    let cases: &[(&[u8], &[&str])] = &[
        (b"", &["empty", "header"]),
        (b"a,b\n0.1,0.2\n0.3\n", &["line 3", "found 1 field, expected 2"]),
        (b"a,b\n0.1,far\n", &["line 2", "`b`", "`far`", "number"]),
        (b"a,b\n0.1,\n", &["line 2", "`b`", "an empty cell"]),
        (b"a,b\n0.1,1.2\n", &["line 2", "`b`", "1.2", "[0, 1]", "--space"]),
        (b"a,b\n0.1,-0.2\n", &["line 2", "-0.2"]),
        (b"a,b\n0.1,NaN\n", &["line 2", "NaN"]),
        (b"a,b\n0.1,inf\n", &["line 2", "inf"]),
        (b"0.5 0.5\n0.1 far\n", &["line 2", "`x2`", "`far`", "number"]),
        (b"# points\n0.5 0.5\n0.1\n", &["line 3", "found 1 field, expected 2"]),
        (b"nan 0.5\n", &["line 1", "`x1`", "`nan`", "number"]),
        (b"0,1\n0.1,0.2\n", &["the first line `0,1` seems to have the numbers of the columns"]),
        (b"# a, b\n", &["empty", "or numbers"]),
        (b"a;b\n0.1;0.2\n", &["line 1", "`;`"]),
        (b"a,a\n0.1,0.2\n", &["line 1", "`a`", "twice"]),
        (b"a,b\n0.1,\xff\n", &["line 2", "UTF-8"]),
    ];
    for (contents, says) in cases {
        fs::write(dir.path().join("tests.csv"), contents).unwrap();
        let says = [&["tests.csv"], *says].concat();
        refused(&cover(dir.path(), &["estimate", "tests.csv"]), &says);
    }
    let space = "[[parameter]]\nname = \"speed\"\ninterval = [0.5, 10.0]\n\
                 [[parameter]]\nname = \"gap\"\ninterval = [5, 60]\n";
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    fs::write(dir.path().join("three.txt"), "0.1 0.2 0.3\n").unwrap();
    fs::write(dir.path().join("renamed.txt"), "# pace, gap\n1 20\n").unwrap();
    let of_space = |file: &str| cover(dir.path(), &["estimate", file, "--space", "SPACE.toml"]);
    let says = ["three.txt", "found 3 columns without names, expected 2, in this order: speed, gap"];
    refused(&of_space("three.txt"), &says);
    let says = ["renamed.txt", "a comment names the columns `pace, gap`", "among them speed, gap"];
    refused(&of_space("renamed.txt"), &says);
    refused(&cover(dir.path(), &["estimate", "missing.csv"]), &["missing.csv"]);
    refused(&cover(dir.path(), &["estimate"]), &["paracosm-out"]);
}

#[test]
fn broken_spaces_and_tests_outside_of_them_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let estimate = |space: &str, tests: &str| {
        fs::write(dir.path().join("SPACE.toml"), space).unwrap();
        fs::write(dir.path().join("tests.csv"), tests).unwrap();
        cover(dir.path(), &["estimate", "tests.csv", "--space", "SPACE.toml"])
    };
    let speed = "[[parameter]]\nname = \"speed\"\ninterval = [0.0, 10.0]\n";
    let lanes = "[[parameter]]\nname = \"lanes\"\nchoice = [2, 4]\n";
    refused(&estimate("", "speed\n1\n"), &["SPACE.toml", "parameter"]);
    refused(&estimate("[[parameter]\n", "speed\n1\n"), &["SPACE.toml", "line 1"]);
    refused(&estimate(&speed.replace("10.0", "0.0"), "speed\n1\n"), &["SPACE.toml", "`speed`", "[0, 0]"]);
    refused(&estimate(&speed.replace("10.0", "nan"), "speed\n1\n"), &["SPACE.toml", "`speed`", "NaN"]);
    refused(&estimate(&speed.repeat(2), "speed\n1\n"), &["SPACE.toml", "`speed`", "twice"]);
    refused(&estimate(speed, "sped\n1\n"), &["tests.csv, line 1", "`speed`", "`sped`"]);
    refused(&estimate(speed, "speed\n11\n"), &["tests.csv, line 2", "11", "[0, 10]"]);
    refused(&estimate(&format!("{speed}{lanes}"), "speed,lanes\n1,3\n"), &["line 2", "`lanes`", "2, 4"]);
    succeeds(estimate(&format!("{speed}{lanes}"), "lanes,verdict,speed\n2,pass,1\n"));
}

#[test]
fn measurements_that_make_no_sense_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("none.csv"), "a,b\n").unwrap();
    let estimate = |more: &[&str]| cover(dir.path(), &[&["estimate"], more].concat());
    succeeds(estimate(&["none.csv"]));
    refused(&estimate(&["none.csv", "--measures", "dispersal"]), &["`dispersal`", "`dispersion`"]);
    refused(&estimate(&["none.csv", "--k", "3"]), &["k is 3", "1 to 2"]);
    refused(&estimate(&["none.csv", "--k", "0"]), &["k is 0"]);
    refused(&estimate(&["none.csv", "--time-limit", "-1"]), &["-1"]);
    refused(&estimate(&["none.csv", "--time-limit", "NaN"]), &["NaN"]);
    refused(&estimate(&["--strategy", "halton", "--dims", "2"]), &["--budget"]);
    refused(&estimate(&["--strategy", "halton", "--dims", "0", "--budget", "5"]), &["no parameters"]);
    refused(&estimate(&["--strategy", "halton", "--dims", "2", "--budget", "0"]), &["budget"]);
    refused(&estimate(&["--strategy", "halton", "--dims", "2", "--budget", "999999999999"]), &["at most"]);
    refused(&estimate(&["--strategy", "hlton", "--dims", "2", "--budget", "5"]), &["`halton`"]);
}

#[test]
fn times_that_are_none_and_files_that_are_no_text_are_refused_with_what_was_expected() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("m.pict"), "A: 1, 2\nB: 1, 2\n").unwrap();
    let generate = |more: &[&str]| cover(dir.path(), &[&["generate", "--space"], more].concat());
    let expected = "error: --optimise -1: expected a number of seconds, 0 or more\n";
    refused(&generate(&["m.pict", "--optimise", "-1"]), &[expected]);
    refused(&generate(&["m.pict", "--optimise", "soon"]), &["--optimise <SECONDS>: found `soon`, expected a number"]);
    for name in ["latin1.pict", "latin1.toml"] {
        fs::write(dir.path().join(name), b"A: 1, 2\nB: caf\xe9, tea\n").unwrap();
        refused(&generate(&[name]), &[&format!("{name}, line 2: found bytes that are not UTF-8, expected")]);
    }
}

#[test]
fn names_and_values_that_tables_and_pictures_cannot_show_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    for (space, says) in [
        ("parameter = [{ name = \"a\\u0007b\", interval = [0, 1] }]\n", "the name of parameter 1"),
        ("parameter = [{ name = \"a\", choice = [\"x\", \"y\\u001b[31m\"] }]\n", "a value of parameter 1"),
        ("parameter = [{ name = \"=f(1)\", interval = [0, 1] }]\n", "the name of parameter 1 is a formula"),
    ] {
        fs::write(dir.path().join("SPACE.toml"), space).unwrap();
        let generate = cover(dir.path(), &["generate", "--space", "SPACE.toml", "--budget", "2"]);
        refused(&generate, &["SPACE.toml", says]);
    }
}

#[test]
fn values_out_of_range_in_a_log_are_named_with_file_and_line() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "5", "--out", "out", "-q"]));
    let log = dir.path().join("out/trials.jsonl");
    let text = fs::read_to_string(&log).unwrap();
    let speed = text.lines().nth(2).unwrap().split("\"speed\":").nth(1).unwrap().split(',').next().unwrap().to_owned();
    fs::write(&log, text.replace(&format!("\"speed\":{speed}"), "\"speed\":1e9")).unwrap();
    for command in [&["replay", "out", "0"] as &[&str], &["map", "out"], &["--budget", "5", "--out", "out", "--resume"]]
    {
        refused(&fuzz(dir.path(), command), &["out/trials.jsonl, line 3", "speed", "1000000000"]);
    }
    refused(&cover(dir.path(), &["estimate", "out"]), &["out/trials.jsonl, line 3"]);
}

/// Entries of a `campaign.json`, wrong values for them, and words that the error has to have.
const WRONG_ENTRIES: [(&str, &str, &[&str]); 35] = [
    ("/dt", "1e-12", &["`duration` is", "expected 1 to 10000000 ticks"]),
    ("/dt", "0.02", &["`dt` is 0.02 s, expected", "as in the scenario `pedestrian-crossing`"]),
    ("/dt", "\"x\"", &["`dt`: invalid type: string \"x\"", "line "]),
    ("/dt", "null", &["the entry `dt` is missing, which a study with `scenario` has"]),
    ("/timeout", "60.0", &["found the entry `timeout` beside `scenario`"]),
    ("/system", "\"./sut\"", &["found the entry `scenario` beside `system`"]),
    ("/requirements/0/scale", "\"x\"", &["`requirements[0].scale`: invalid type", "line "]),
    ("/duration", "-5.0", &["`duration` is -5.0, expected a number of seconds above 0"]),
    ("/duration", "1e300", &["`duration` is 1", "ticks"]),
    ("/durations", "5.0", &["unknown field `durations`", "`duration`"]),
    ("/requirements/0/scale", "-1.0", &["`scale of no-collision` is -1.0", "expected a number above 0"]),
    ("/requirements/0/scale", "3.5", &["`scale of requirement", "is 3.5, expected"]),
    ("/requirements/0/formula", "\"G (gap >= 5)\"", &["`formula of requirement", "(gap >= 5)", "as in the scenario"]),
    ("/requirements/0/formula", "\"G (gap >=\"", &["`G (gap >=`"]),
    ("/requirements/0/id", "\"mine\"", &["the requirement `", "is missing"]),
    ("/requirements/0/id", "\"a\\u0007b\"", &["the id of requirement 1 has the control character"]),
    ("/requirements/0/weight", "3", &["unknown field `weight`"]),
    ("/requirements", "[]", &["the requirement `", "of the scenario `pedestrian-crossing` is missing"]),
    ("/fixed/friction", "100", &["`fixed`: ", "`friction`"]),
    ("/fixed/frction", "0.5", &["`fixed`: scenario `pedestrian-crossing` has no parameter `frction`", "`friction`"]),
    ("/fixed/speed", "5.0", &["`space`: parameter `speed` is set and opened"]),
    (
        "/space/parameter",
        "[{\"name\": \"distance\", \"interval\": [5, 60], \"unit\": \"m\"}]",
        &["the parameter `speed` of the scenario `pedestrian-crossing` is missing"],
    ),
    ("/space/parameter/0/name", "\"sped\"", &["`space`: scenario `pedestrian-crossing` has no parameter `sped`"]),
    ("/space/parameter/0/interval", "[0.5, 1e9]", &["`space`: ", "`speed`", "1000000000"]),
    ("/requirements/0/scale", "null", &["`scale of requirement no-collision` is nothing, expected"]),
    ("/driver/name", "\"cnn\"", &["driver `cnn` is a network, but the entry `network` is missing"]),
    ("/driver/settings/brking", "1.0", &["`driver`: driver `aeb` has no setting `brking`"]),
    ("/driver/colour", "1.0", &["unknown field `colour`"]),
    ("/resistance", "{\"rolling\": 0.5}", &["`resistance`: vehicle.rolling is 0.5, expected a number from 0 to 0.1"]),
    ("/resistance", "{\"drag\": 0.5}", &["unknown field `drag`", "`drag_area`"]),
    ("/k", "1000000000", &["`k` is 1000000000, expected a number from 1 to"]),
    ("/epsilon", "-0.5", &["`epsilon` is -0.5"]),
    ("/budget", "0", &["the budget is 0, expected at least 1 test"]),
    ("/batch", "0", &["the batch is 0, expected at least 1 test"]),
    ("/vehicle", "\"boat\"", &["`vehicle`: unknown variant `boat`", "line "]),
];

#[test]
fn every_command_refuses_a_study_with_a_wrong_entry_and_names_the_entry() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "out", "-q"]));
    let file = dir.path().join("out/campaign.json");
    let whole: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    let log = dir.path().join("out/trials.jsonl");
    // A log of an older version does not name its study, so that a changed study is not recognised by its hash.
    fs::write(&log, without_study(&fs::read_to_string(&log).unwrap())).unwrap();
    for (entry, wrong, words) in WRONG_ENTRIES {
        let mut changed = whole.clone();
        let (around, name) = entry.rsplit_once('/').unwrap();
        changed.pointer_mut(around).unwrap()[name] = serde_json::from_str(wrong).unwrap();
        fs::write(&file, changed.to_string()).unwrap();
        for command in ["map", "trace", "blame"] {
            refused(&fuzz(dir.path(), &[command, "out"]), &[&["out/campaign.json"], words].concat());
        }
        refused(&fuzz(dir.path(), &["replay", "out", "0"]), words);
    }
}

#[test]
fn a_study_that_was_changed_after_its_tests_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "out", "-q"]));
    let file = dir.path().join("out/campaign.json");
    let whole = fs::read_to_string(&file).unwrap();
    fs::write(&file, whole.replace("\"budget\": 2", "\"budget\": 3")).unwrap();
    refused(&fuzz(dir.path(), &["replay", "out", "0"]), &["campaign.json was changed"]);
}

#[test]
fn a_log_in_which_only_some_lines_name_their_study_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "4", "--out", "out", "-q"]));
    let log = dir.path().join("out/trials.jsonl");
    let named = fs::read_to_string(&log).unwrap();
    let without = without_study(&named);
    let mixed: Vec<&str> = named.lines().take(2).chain(without.lines().skip(2)).collect();
    fs::write(&log, mixed.join("\n") + "\n").unwrap();
    refused(&cover(dir.path(), &["estimate", "out"]), &["out/trials.jsonl, line 3", "two campaigns were mixed"]);
}

#[test]
fn a_log_that_contradicts_itself_is_refused_with_the_line() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "5", "--out", "out", "-q"]));
    let log = dir.path().join("out/trials.jsonl");
    let whole = fs::read_to_string(&log).unwrap();
    let third = whole.lines().nth(2).unwrap();
    assert!(third.contains("\"verdict\":\"fail\""), "{third}");
    for (from, to, says) in [
        ("\"verdict\":\"fail\"", "\"verdict\":\"pass\"", "`verdict` is `pass`, but the least robustness is -"),
        ("\"no-collision\":-", "\"no-collision\":", "`verdict` is `fail`, but the least robustness is "),
        (
            "\"robustness\":{\"no-collision\"",
            "\"robustness\":{\"no-colision\"",
            "no requirement `no-colision` (did you mean",
        ),
        ("\"verdict\":\"fail\"", "\"verdict\":\"unpreventable\"", "the study has no reference drivers"),
        ("\"error\":null", "\"error\":\"lost\"", "`verdict` is `fail`, but `error` is there"),
        ("\"verdict\":\"fail\"", "\"verdict\":\"error\"", "`verdict` is `error`, but `error` is missing"),
        (
            "\"ticks\":",
            "\"ticks\":\"a\",\"tock\":",
            "`ticks`: invalid type: string \"a\", expected a whole number (column",
        ),
    ] {
        let changed = third.replacen(from, to, 1);
        assert_ne!(changed, third);
        fs::write(&log, whole.replace(third, &changed)).unwrap();
        for command in [&["map", "out"] as &[&str], &["trace", "out"], &["--budget", "5", "--out", "out", "--resume"]] {
            refused(&fuzz(dir.path(), command), &["out/trials.jsonl, line 3", says]);
        }
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_or_a_device_in_place_of_a_file_of_a_campaign_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    for file in ["trials.jsonl", "campaign.json"] {
        let out = dir.path().join("out");
        let _ = fs::remove_dir_all(&out);
        succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "out", "-q"]));
        fs::remove_file(out.join(file)).unwrap();
        assert!(Command::new("mkfifo").arg(out.join(file)).status().unwrap().success());
        for command in
            [&["map", "out"] as &[&str], &["replay", "out", "0"], &["--budget", "2", "--out", "out", "--resume"]]
        {
            refused(&fuzz(dir.path(), command), &[file, "found no regular file"]);
        }
        refused(&cover(dir.path(), &["estimate", "out"]), &[file, "found no regular file"]);
        fs::remove_file(out.join(file)).unwrap();
        std::os::unix::fs::symlink("/dev/zero", out.join(file)).unwrap();
        refused(&fuzz(dir.path(), &["map", "out"]), &[file, "found no regular file"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_input_without_end_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink("/dev/zero", dir.path().join("SPACE.toml")).unwrap();
    refused(&cover(dir.path(), &["estimate", "/dev/zero"]), &["/dev/zero", "a line has more than 64 MiB"]);
    refused(&fuzz(dir.path(), &["monitor", "/dev/zero", "--spec", "G (a > 1)"]), &["a line has more than 64 MiB"]);
    refused(&cover(dir.path(), &["plan", "--space", "SPACE.toml"]), &["SPACE.toml", "more than 256 MiB"]);
}

#[test]
fn the_map_of_a_campaign_with_a_very_long_name_is_drawn() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "4", "--out", "out", "-q"]));
    let log = dir.path().join("out/trials.jsonl");
    fs::write(&log, without_study(&fs::read_to_string(&log).unwrap())).unwrap();
    let file = dir.path().join("out/campaign.json");
    let whole = fs::read_to_string(&file).unwrap();
    for name in ["p".repeat(1_000_000), "p ".repeat(500_000)] {
        fs::write(&file, whole.replace("pedestrian-crossing", &name)).unwrap();
        succeeds(fuzz(dir.path(), &["map", "out"]));
    }
}
