//! The files that commands write: nothing that is no regular file is replaced, and nothing of the user is lost.

use crate::common::{cover, fuzz, refused, stdout, succeeds};
use std::fs::{self, Permissions};
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;
use std::thread;

/// A folder with the campaign `camp` of two tests.
fn campaign() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "camp", "-q"]));
    dir
}

/// Replays a test, with its trace in a file.
fn trace_to(dir: &Path, file: &str) {
    succeeds(fuzz(dir, &["replay", "camp", "1", "--trace", file]));
}

/// The trace of the test, as it is in a usual file.
fn trace(dir: &Path) -> String {
    trace_to(dir, "usual.csv");
    fs::read_to_string(dir.join("usual.csv")).unwrap()
}

#[test]
fn a_device_stays_a_device_also_behind_a_link() {
    let dir = campaign();
    symlink("/dev/null", dir.path().join("link.csv")).unwrap();
    for file in ["/dev/null", "link.csv"] {
        trace_to(dir.path(), file);
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device(), "{file}");
    }
    assert!(dir.path().join("link.csv").is_symlink());
    let full = fuzz(dir.path(), &["replay", "camp", "1", "--trace", "/dev/full"]);
    refused(&full, &["/dev/full", "No space left"]);
}

#[test]
fn a_pipe_gets_what_a_file_would_hold() {
    let dir = campaign();
    let pipe = dir.path().join("pipe.csv");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo is there").success());
    let reader = thread::spawn({
        let pipe = pipe.clone();
        move || fs::read_to_string(pipe).unwrap()
    });
    trace_to(dir.path(), "pipe.csv");
    assert_eq!(reader.join().unwrap(), trace(dir.path()));
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
}

#[test]
fn the_standard_output_gets_the_file_and_the_result_also_if_it_is_a_file() {
    let dir = campaign();
    let replay = ["replay", "camp", "1", "--trace", "/dev/stdout", "--format", "json", "-q"];
    let piped = stdout(&succeeds(fuzz(dir.path(), &replay)));
    assert!(piped.starts_with(&trace(dir.path())) && piped.ends_with("}\n"), "{piped}");
    let all = fs::File::create(dir.path().join("all.txt")).unwrap();
    let program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"))
        .args(replay)
        .current_dir(dir.path())
        .stdout(all)
        .status()
        .unwrap();
    assert!(program.success());
    assert_eq!(fs::read_to_string(dir.path().join("all.txt")).unwrap(), piped);
}

#[test]
fn a_link_stays_a_link_and_its_end_gets_the_file() {
    let dir = campaign();
    let path = |name: &str| dir.path().join(name);
    fs::create_dir(path("elsewhere")).unwrap();
    fs::write(path("elsewhere/old.csv"), "old").unwrap();
    symlink("elsewhere/old.csv", path("to-old.csv")).unwrap();
    symlink("to-new.csv", path("to-link.csv")).unwrap();
    symlink("elsewhere/new.csv", path("to-new.csv")).unwrap();
    for (link, end) in [("to-old.csv", "elsewhere/old.csv"), ("to-link.csv", "elsewhere/new.csv")] {
        trace_to(dir.path(), link);
        assert!(path(link).is_symlink());
        assert!(!path(end).is_symlink());
        assert_eq!(fs::read_to_string(path(end)).unwrap(), trace(dir.path()));
    }
    symlink("round.csv", path("round.csv")).unwrap();
    refused(&fuzz(dir.path(), &["replay", "camp", "1", "--trace", "round.csv"]), &["round.csv"]);
}

#[test]
fn files_that_end_in_part_are_somebody_elses() {
    let dir = campaign();
    let path = |name: &str| dir.path().join(name);
    fs::write(path("mine.csv.part"), "mine").unwrap();
    fs::write(path("victim"), "precious").unwrap();
    symlink("victim", path("t.csv.part")).unwrap();
    trace_to(dir.path(), "mine.csv");
    trace_to(dir.path(), "t.csv");
    assert_eq!(fs::read_to_string(path("mine.csv.part")).unwrap(), "mine");
    assert_eq!(fs::read_to_string(path("victim")).unwrap(), "precious");
    let left = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert_eq!(left.filter(|name| name.ends_with(".part")).count(), 2, "no temporary file is left");
}

#[test]
fn the_mode_and_the_owner_of_a_file_stay() {
    let dir = campaign();
    let file = dir.path().join("secret.csv");
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, Permissions::from_mode(0o600)).unwrap();
    // Only the superuser can give a file away.
    let given = Command::new("chown").arg("65534:65534").arg(&file).output().is_ok_and(|done| done.status.success());
    let before = fs::metadata(&file).unwrap();
    trace_to(dir.path(), "secret.csv");
    let after = fs::metadata(&file).unwrap();
    let facts = |there: &fs::Metadata| (there.mode(), there.uid(), there.gid());
    assert_eq!(facts(&after), facts(&before));
    assert!(!given || after.uid() == 65534);
    assert_eq!(fs::read_to_string(&file).unwrap(), trace(dir.path()));
}

#[test]
fn a_new_file_has_the_mode_of_other_new_files() {
    let dir = campaign();
    fs::write(dir.path().join("other"), "").unwrap();
    trace_to(dir.path(), "new.csv");
    let mode = |name: &str| fs::metadata(dir.path().join(name)).unwrap().mode();
    assert_eq!(mode("new.csv"), mode("other"));
}

#[test]
fn a_file_that_is_read_is_not_written() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name);
    let points = "a,b\n0.1,0.2\n0.6,0.7\n";
    fs::write(path("p.csv"), points).unwrap();
    symlink("p.csv", path("link.csv")).unwrap();
    fs::hard_link(path("p.csv"), path("hard.csv")).unwrap();
    for (read, written) in
        [("p.csv", "p.csv"), ("p.csv", "./p.csv"), ("p.csv", "link.csv"), ("link.csv", "p.csv"), ("p.csv", "hard.csv")]
    {
        let output = cover(dir.path(), &["estimate", read, "--certificate", written]);
        refused(&output, &["--certificate", written, "this command reads"]);
        assert_eq!(fs::read_to_string(path("p.csv")).unwrap(), points);
    }
}

#[test]
fn a_link_does_not_hide_a_file_of_a_campaign() {
    let dir = campaign();
    symlink("camp/trials.jsonl", dir.path().join("innocent.csv")).unwrap();
    let before = fs::read(dir.path().join("camp/trials.jsonl")).unwrap();
    refused(&fuzz(dir.path(), &["trace", "camp", "--csv", "innocent.csv"]), &["belongs to campaigns"]);
    refused(&fuzz(dir.path(), &["replay", "camp", "1", "--trace", "innocent.csv"]), &["belongs to campaigns"]);
    assert_eq!(fs::read(dir.path().join("camp/trials.jsonl")).unwrap(), before);
}

#[test]
fn a_folder_that_was_removed_or_moved_is_not_called_safe() {
    for change in ["rm -r camp", "mv camp moved", "mv camp moved; mkdir camp; : > camp/trials.jsonl"] {
        let dir = tempfile::tempdir().unwrap();
        let system = format!(
            "while read -r line; do i=${{line#*:}}; i=${{i%%,*}}; if [ $i = 3 ]; then {change}; fi
             echo \"{{\\\"index\\\":$i,\\\"robustness\\\":{{\\\"a\\\":1}}}}\"; done"
        );
        fs::write(dir.path().join("system.sh"), system).unwrap();
        fs::write(dir.path().join("SPACE.toml"), "parameter = [{ name = \"x\", interval = [-1, 1] }]\n").unwrap();
        let arguments = ["--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "9", "--jobs", "1", "-q"];
        let output = fuzz(dir.path(), &[&arguments[..], &["--out", "camp"]].concat());
        refused(&output, &["removed or moved", "if it was removed, they are lost"]);
        assert!(!crate::common::stderr(&output).contains("are safe"));
        let begun = dir.path().join("camp/trials.jsonl");
        assert!(fs::read_to_string(begun).unwrap_or_default().is_empty(), "nothing is written to another campaign");
    }
}

#[test]
fn a_replay_that_differs_from_the_log_leaves_nothing_behind() {
    let dir = campaign();
    let log = dir.path().join("camp/trials.jsonl");
    let text = fs::read_to_string(&log).unwrap();
    let hash = text.split("\"trace_hash\":\"").nth(1).unwrap().split('"').next().unwrap();
    fs::write(&log, text.replace(hash, &"0".repeat(hash.len()))).unwrap();
    let before = fs::read_dir(dir.path().join("camp")).unwrap().count();
    let replay = ["replay", "camp", "0", "--draw", "run.svg", "--trace", "run.csv"];
    refused(&fuzz(dir.path(), &replay), &["test 0 differs from the log", "trace hash: "]);
    refused(&fuzz(dir.path(), &["replay", "camp", "0"]), &["differs from the log"]);
    assert!(!dir.path().join("run.svg").exists() && !dir.path().join("run.csv").exists());
    assert_eq!(fs::read_dir(dir.path().join("camp")).unwrap().count(), before);
}

#[test]
fn a_replay_whose_usual_trace_cannot_be_written_says_so_and_succeeds() {
    let dir = campaign();
    fs::create_dir(dir.path().join("camp/trace-1.csv")).unwrap();
    let replay = succeeds(fuzz(dir.path(), &["replay", "camp", "1"]));
    let told = String::from_utf8(replay.stderr).unwrap();
    assert!(told.contains("the trace was not written: ") && told.contains("give another file with --trace"), "{told}");
    refused(&fuzz(dir.path(), &["replay", "camp", "1", "--trace", "camp/trace-1.csv"]), &["camp/trace-1.csv"]);
}

#[test]
fn a_link_to_a_folder_that_does_not_exist_yet_is_followed() {
    let dir = campaign();
    fs::create_dir(dir.path().join("there")).unwrap();
    symlink("there/new", dir.path().join("link")).unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "1", "--out", "link", "-q"]));
    assert!(dir.path().join("there/new/trials.jsonl").exists() && dir.path().join("link").is_symlink());
    symlink("loop", dir.path().join("loop")).unwrap();
    refused(&fuzz(dir.path(), &["--budget", "1", "--out", "loop", "-q"]), &["loop", "links without an end"]);
}

#[test]
fn campaigns_over_huge_intervals_have_their_maps() {
    let dir = tempfile::tempdir().unwrap();
    let system = r#"python3 -c "
import json, sys
for line in sys.stdin:
    test = json.loads(line)
    print(json.dumps({'index': test['index'], 'robustness': {'small': 0.5 - test['test']['b']}}), flush=True)
""#;
    for (lo, hi) in
        [("10.0", "1e18"), ("0", "1e22"), ("-1e308", "1.7e308"), ("0", "5e-324"), ("1e300", "1.0000001e300")]
    {
        let space = format!(
            "[[parameter]]\nname = \"a\"\ninterval = [{lo}, {hi}]\n[[parameter]]\nname = \"b\"\ninterval = [0, 1]\n"
        );
        fs::write(dir.path().join("SPACE.toml"), space).unwrap();
        let out = format!("out{hi}");
        let run = ["--system", system, "--space", "SPACE.toml", "--budget", "20", "--out", &out, "-q"];
        succeeds(fuzz(dir.path(), &run));
        assert!(dir.path().join(&out).join("failure-map.svg").exists(), "{lo} to {hi}");
    }
}

#[test]
fn links_in_the_folder_of_a_campaign_lead_nowhere() {
    let dir = campaign();
    let precious = dir.path().join("precious");
    fs::write(&precious, "precious").unwrap();
    for (file, commands) in [
        ("failure-map.svg", &[&["map", "camp"] as &[&str]] as &[&[&str]]),
        ("blame.json", &[&["blame", "camp"]]),
        ("trials.csv", &[&["--budget", "2", "--out", "camp", "--resume"]]),
        ("trace-1.csv", &[&["replay", "camp", "1"]]),
        ("trials.jsonl", &[&["--budget", "2", "--out", "camp", "--resume"]]),
        ("campaign.json", &[&["--budget", "2", "--out", "camp", "--resume"]]),
    ] {
        let path = dir.path().join("camp").join(file);
        let before = fs::read(&path).ok();
        let _ = fs::remove_file(&path);
        symlink("../precious", &path).unwrap();
        for command in commands {
            let output = fuzz(dir.path(), command);
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.code() != Some(0) || told.contains("is a link"), "{command:?}: {told}");
            assert_eq!(fs::read_to_string(&precious).unwrap(), "precious", "{command:?}");
        }
        fs::remove_file(&path).unwrap();
        before.into_iter().for_each(|contents| fs::write(&path, contents).unwrap());
    }
}

#[test]
fn a_picture_of_a_world_replaces_no_file_that_the_command_reads() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("rq.toml"), "[[requirement]]\nid = \"a\"\ntext = \"b\"\n").unwrap();
    symlink("rq.toml", dir.path().join("rq.svg")).unwrap();
    let describe = ["describe", "pedestrian-crossing", "--requirements", "rq.toml", "--draw", "rq.svg"];
    refused(&fuzz(dir.path(), &describe), &["rq.svg"]);
    assert!(fs::read_to_string(dir.path().join("rq.toml")).unwrap().starts_with("[[requirement]]"));
}

#[test]
fn a_full_standard_output_is_named_by_generate() {
    let dir = tempfile::tempdir().unwrap();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-cover"));
    let program = program.args(["generate", "--dims", "2", "--budget", "5"]).current_dir(dir.path()).stdout(full);
    refused(&program.output().unwrap(), &["cannot write to the standard output: No space left"]);
}

#[test]
fn a_full_standard_output_is_named_by_the_help() {
    for arguments in [&["--help"] as &[&str], &["--version"], &["replay", "--help"]] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
        let output = program.args(arguments).stdout(full).output().unwrap();
        refused(&output, &["cannot write to the standard output: No space left"]);
    }
}

#[test]
fn a_picture_or_a_table_goes_to_a_device_in_the_first_format() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "4", "--out", "camp", "-q"]));
    let map = succeeds(fuzz(dir.path(), &["map", "camp", "--out", "/dev/stdout", "--format", "json", "-q"]));
    let text = String::from_utf8_lossy(&map.stdout);
    assert!(text.starts_with("<svg"), "{}", text.chars().take(100).collect::<String>());
    refused(&fuzz(dir.path(), &["trace", "camp", "--csv", "/dev/full"]), &["/dev/full", "No space left"]);
    refused(&fuzz(dir.path(), &["describe", "t-loop", "--draw", "/dev/full"]), &["/dev/full", "No space left"]);
}

#[test]
fn a_replay_into_a_folder_that_does_not_exist_leaves_no_drawing() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "camp", "-q"]));
    for trace in ["nowhere/trace.csv", "/dev/full"] {
        let replay = fuzz(dir.path(), &["replay", "camp", "1", "--draw", "run.svg", "--trace", trace]);
        refused(&replay, &[trace]);
        assert!(!dir.path().join("run.svg").exists(), "{trace}");
    }
    let out = fuzz(dir.path(), &["map", "camp", "--out", "nowhere/map.svg"]);
    refused(&out, &["--out nowhere/map.svg: the folder nowhere does not exist"]);
}

#[test]
#[cfg(target_os = "linux")]
fn verdicts_have_a_colour_and_a_sign_on_a_terminal_unless_the_user_wants_none() {
    let dir = campaign();
    let command = format!("'{}' replay camp 1 -q", env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let on_terminal = |variables: &[(&str, &str)]| {
        let mut script = Command::new("script");
        script
            .args(["-qec", &command, "/dev/null"])
            .current_dir(dir.path())
            .env_remove("NO_COLOR")
            .env("TERM", "xterm");
        stdout(&succeeds(script.envs(variables.iter().copied()).output().expect("a program of Linux")))
            .replace("\r\n", "\n")
    };
    let plain = stdout(&succeeds(fuzz(dir.path(), &["replay", "camp", "1", "-q"])));
    assert!(plain.starts_with("test 1: pass\n"), "{plain}");
    assert_eq!(on_terminal(&[]), plain.replacen("pass", "\x1b[32m✓ pass\x1b[0m", 1));
    for variable in [("NO_COLOR", "1"), ("TERM", "dumb")] {
        assert_eq!(on_terminal(&[variable]), plain, "{variable:?}");
    }
}
