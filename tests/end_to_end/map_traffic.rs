//! The scenario `map-traffic` on the command line: maps of users, campaigns that go on and are replayed, and what is refused.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Returns a folder with the roads of a scenario as a map, `city.xodr`.
fn folder() -> TempDir {
    let dir = tempfile::tempdir().expect("a folder");
    succeeds(fuzz(dir.path(), &["describe", "grid-traffic", "--roads", "city.xodr"]));
    dir
}

/// Returns the log of a campaign.
fn log(dir: &Path, folder: &str) -> String {
    fs::read_to_string(dir.join(folder).join("trials.jsonl")).expect("a log")
}

#[test]
fn a_campaign_on_a_map_of_a_user_is_the_same_with_two_threads_goes_on_and_is_replayed() {
    let dir = folder();
    let campaign = |more: &[&str]| {
        let common = ["map-traffic", "--set", "roads=city.xodr", "--open", "cars=0..20", "--driver", "planner"];
        let chosen = ["--strategy", "random", "--seed", "3", "--budget", "8"];
        succeeds(fuzz(dir.path(), &[&common[..], &chosen, more].concat()));
    };
    campaign(&["--jobs", "1", "--out", "one"]);
    campaign(&["--jobs", "2", "--out", "two"]);
    assert_eq!(log(dir.path(), "one"), log(dir.path(), "two"));
    let begun: String = log(dir.path(), "two").lines().take(3).map(|line| format!("{line}\n")).collect();
    fs::write(dir.path().join("two/trials.jsonl"), begun).expect("it is writable");
    campaign(&["--out", "two", "--resume"]);
    assert_eq!(log(dir.path(), "one"), log(dir.path(), "two"));
    let trials: Vec<serde_json::Value> =
        log(dir.path(), "one").lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert!(trials.iter().all(|trial| trial["verdict"] == "pass" || trial["verdict"] == "fail"), "{trials:?}");
    let replayed = stdout(&succeeds(fuzz(dir.path(), &["replay", "one", "5"])));
    assert!(replayed.contains(trials[5]["trace_hash"].as_str().expect("a hash")), "{replayed}");
}

#[test]
fn several_maps_are_the_levels_of_the_parameter() {
    let dir = folder();
    let arguments = ["map-traffic", "--open", "roads=town,city.xodr", "--driver", "cruise", "--strategy", "random"];
    succeeds(fuzz(dir.path(), &[&arguments[..], &["--budget", "12", "--out", "c"]].concat()));
    for map in ["\"roads\":\"town\"", "\"roads\":\"city.xodr\""] {
        assert!(log(dir.path(), "c").contains(map), "no test has {map}");
    }
}

#[test]
fn the_parts_of_a_map_without_effect_are_noted_once_before_the_tests() {
    let dir = folder();
    let text = fs::read_to_string(dir.path().join("city.xodr")).expect("it is there");
    let text = text.replacen("</OpenDRIVE>", "<userData code=\"colour\" value=\"red\"/></OpenDRIVE>", 1);
    fs::write(dir.path().join("city.xodr"), text).expect("it is writable");
    let note = "`userData` has no effect: it is data for other programs";
    for [option, roads, out] in [["--set", "roads=city.xodr", "set"], ["--open", "roads=town,city.xodr", "opened"]] {
        let more = ["map-traffic", "--driver", "cruise", "--budget", "3", option, roads, "--out", out];
        let ran = stderr(&succeeds(fuzz(dir.path(), &more)));
        assert!(ran.matches(note).count() == 1 && ran.contains("city.xodr:"), "{ran}");
    }
}

#[test]
fn a_map_that_cannot_be_used_is_refused_before_the_first_test() {
    let dir = folder();
    let road = r#"<OpenDRIVE><header revMajor="1" revMinor="6"/>
        <road id="1" length="LENGTH" junction="-1">
        <planView><geometry s="0" x="0" y="0" hdg="0" length="30"><line/></geometry></planView>
        <lanes><laneSection s="0"><center><lane id="0" type="none"/></center>
        <right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right>
        </laneSection></lanes></road></OpenDRIVE>"#;
    for (name, length) in [("wrong.xodr", "far"), ("short.xodr", "30")] {
        fs::write(dir.path().join(name), road.replace("LENGTH", length)).expect("it is writable");
    }
    let with = |more: &[&str]| fuzz(dir.path(), &[&["map-traffic", "--out", "c"], more].concat());
    refused(&with(&["--set", "roads=wrong.xodr"]), &["wrong.xodr:2: `length=\"far\"` of <road>", "a finite number"]);
    refused(&with(&["--set", "roads=absent.xodr"]), &["absent.xodr: the file cannot be read"]);
    refused(&with(&["--set", "roads=short.xodr"]), &["short.xodr: the longest way", "expected at least 40 m"]);
    refused(&with(&["--open", "roads=town,absent.xodr"]), &["absent.xodr: the file cannot be read"]);
    refused(&with(&["--set", "roads=town", "--set", "cars=41"]), &["`cars`"]);
    assert!(!dir.path().join("c").exists());
}
