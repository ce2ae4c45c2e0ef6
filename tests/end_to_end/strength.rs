//! Mixed strength and negative values as users meet them: the same groups and models made, planned and measured.

use crate::common::{cover, golden, refused, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const SPACE: &str = "\
constraints = [\"lanes == 2 implies sky != 'fog'\"]\n\
[[parameter]]\nname = \"lanes\"\nchoice = [2, 4]\n\
[[parameter]]\nname = \"sky\"\nchoice = [\"clear\", \"rain\", \"fog\"]\n\
[[parameter]]\nname = \"car\"\nchoice = [\"small\", \"truck\"]\n\
[[parameter]]\nname = \"wet\"\nchoice = [\"no\", \"yes\"]\n";

const MODEL: &str = "\
Speed:  ~-1, 30, 50\n\
Lanes:  2, 4, ~99\n\
Sky:    clear, fog\n\
Wet:    no, yes\n\
\n\
{ Lanes, Sky, Wet } @ 3\n";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(dir.path().join(name), text).unwrap();
    }
    dir
}

fn run(dir: &Path, command: &str) -> (String, String) {
    let output = succeeds(cover(dir, &command.split(' ').collect::<Vec<_>>()));
    (stdout(&output), stderr(&output))
}

fn discrete(dir: &Path, command: &str) -> Value {
    serde_json::from_str::<Value>(&run(dir, &format!("{command} --format json")).0).unwrap()["discrete"].clone()
}

#[test]
fn a_group_is_measured_at_its_own_strength_beside_all_pairs() {
    let tests =
        "lanes,sky,car,wet\n2,clear,small,no\n2,rain,truck,no\n4,fog,small,yes\n4,fog,truck,no\n2,fog,small,no\n";
    let dir = folder(&[("SPACE.toml", SPACE), ("tests.csv", tests)]);
    let command = "estimate tests.csv --space SPACE.toml --strength lanes,sky,wet=3 --strength car,wet=1";
    let measured = discrete(dir.path(), command);
    // Ten of lanes, sky and wet, for fog needs four lanes; the last test violates that.
    assert_eq!((&measured["k"], &measured["valid"]), (&json!(2), &json!(29)));
    let group = &measured["strengths"][0];
    assert_eq!(group["parameters"], json!(["lanes", "sky", "wet"]));
    assert_eq!((&group["k"], &group["valid"], &group["covered"]), (&json!(3), &json!(10), &json!(4)));
    assert_eq!(group["missing"][0], json!({"lanes": 2, "sky": "clear", "wet": "yes"}));
    assert_eq!(measured["strengths"][1]["ratio"], json!(1.0));
    golden("estimate-strength.json", &run(dir.path(), &format!("{command} --format json")).0);
    golden("estimate-strength.txt", &run(dir.path(), command).0);
    assert!(discrete(dir.path(), "estimate tests.csv --space SPACE.toml").get("strengths").is_none());
}

#[test]
fn what_is_made_for_a_model_is_measured_as_complete_and_stated_with_its_bound() {
    let dir = folder(&[("MODEL.pict", MODEL)]);
    let (csv, notes) = run(dir.path(), "generate --space MODEL.pict --strength Speed,Sky,Wet=3");
    golden("generate-strength.txt", &notes);
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let command = "estimate tests.csv --space MODEL.pict --strength Speed,Sky,Wet=3";
    let measured = discrete(dir.path(), command);
    // Pairs without a negative value: six times two values with two; with one: two values of three other parameters.
    assert_eq!((&measured["valid"], &measured["ratio"]), (&json!(6 * 4 + 2 * 6), &json!(1.0)));
    // Triples of two values each, and the pairs of the others beside the negative value.
    for group in measured["strengths"].as_array().unwrap() {
        assert_eq!((&group["valid"], &group["ratio"]), (&json!(8 + 4), &json!(1.0)));
    }
    let (smaller, _) = run(dir.path(), "generate --space MODEL.pict --strength Speed,Sky,Wet=3 --optimise 0.2");
    fs::write(dir.path().join("tests.csv"), smaller).unwrap();
    assert_eq!(discrete(dir.path(), command)["ratio"], json!(1.0));
}

#[test]
fn a_test_with_a_negative_value_counts_only_for_that_value() {
    let tests = "Speed,Lanes,Sky,Wet\n-1,2,clear,no\n30,4,fog,yes\n";
    let dir =
        folder(&[("MODEL.pict", MODEL), ("tests.csv", tests), ("both.csv", "Speed,Lanes,Sky,Wet\n-1,99,fog,no\n")]);
    let measured = discrete(dir.path(), "estimate tests.csv --space MODEL.pict");
    // Three pairs with -1, six of the other test; and of the group only the other test's.
    assert_eq!(measured["covered"], json!(3 + 6));
    assert_eq!(measured["strengths"][0]["covered"], json!(1));
    let missing = json!({"Lanes": 2, "Sky": "clear"});
    let all = run(dir.path(), "estimate tests.csv --space MODEL.pict --format json").0;
    assert!(measured["missing"].as_array().unwrap().contains(&missing), "{all}");
    let all: Value = serde_json::from_str(&all).unwrap();
    assert_eq!(all["k_wise_dispersion"]["lower"], json!(1.0));
    let both: Value =
        serde_json::from_str(&run(dir.path(), "estimate both.csv --space MODEL.pict --format json").0).unwrap();
    assert_eq!((&both["violating"], &both["discrete"]["covered"]), (&json!(1), &json!(0)));
}

#[test]
fn a_plan_counts_the_rows_that_groups_and_negative_values_take() {
    let dir = folder(&[("SPACE.toml", SPACE), ("MODEL.pict", MODEL)]);
    let plan = |arguments: &str| run(dir.path(), &format!("plan {arguments} --format table"));
    let (text, notes) = plan("--space SPACE.toml --strength lanes,sky,wet=3 --strength car,wet=2");
    golden("plan-strength.txt", &text);
    assert_eq!(notes, "2-wise among car, wet adds nothing: all parameters are covered 2-wise\n");
    // Eight triples without a negative value, four pairs beside 99, and beside -1 pairs: two values alone.
    let (text, _) = plan("--space MODEL.pict");
    let least = text.lines().find(|line| line.contains("any rows")).unwrap();
    assert_eq!(least.split_whitespace().nth(2), Some("14"), "{text}");
    assert!(!text.contains("random rows"), "{text}");
}

#[test]
fn groups_that_add_nothing_are_said_to() {
    let dir = folder(&[("SPACE.toml", SPACE), ("MODEL.pict", MODEL)]);
    let (_, notes) = run(dir.path(), "generate --space SPACE.toml --strength lanes,sky=1");
    assert!(notes.contains("1-wise among lanes, sky adds nothing: all parameters are covered 2-wise\n"), "{notes}");
    let (_, notes) = run(dir.path(), "generate --space MODEL.pict --k 3");
    assert!(notes.contains("3-wise among Lanes, Sky, Wet adds nothing"), "{notes}");
    for command in ["plan", "generate"] {
        let strict =
            |more: &[&str]| cover(dir.path(), &[&[command, "--space", "SPACE.toml", "--strict"], more].concat());
        let says = ["--strict refuses groups that add nothing", "1-wise among lanes, sky adds nothing"];
        refused(&strict(&["--strength", "lanes,sky=1"]), &says);
        succeeds(strict(&["--strength", "lanes,sky,wet=3"]));
    }
}

#[test]
fn what_has_no_meaning_is_refused() {
    let mixed = SPACE.replace(
        "[[parameter]]\nname = \"lanes\"",
        "[[parameter]]\nname = \"speed\"\ninterval = [0, 9]\n[[parameter]]\nname = \"lanes\"",
    );
    let begun = "speed,lanes,sky,car,wet\n1,2,,small,no\n";
    let one = MODEL.replace(", ~99", "");
    let tests = "lanes,sky,car,wet\n2,clear,small,no\n";
    let dir = folder(&[
        ("SPACE.toml", SPACE),
        ("MIXED.toml", &mixed),
        ("MODEL.pict", MODEL),
        ("ONE.pict", &one),
        ("begun.csv", begun),
        ("mixed.csv", &begun.replace(",,", ",rain,")),
        ("tests.csv", tests),
        ("model.csv", "Speed,Lanes,Sky,Wet\n30,2,fog,no\n"),
    ]);
    let cases: [(&str, &[&str]); 8] = [
        ("estimate tests.csv --space SPACE.toml --strength lanes,ski=2", &["--strength", "`ski`", "`sky`"]),
        ("estimate tests.csv --space SPACE.toml --strength lanes,sky=3", &["found 3, expected 1 to 2"]),
        ("estimate tests.csv --space SPACE.toml --strength lanes,sky=2 --measures star", &["the measure k-wise"]),
        ("estimate mixed.csv --space MIXED.toml --strength speed,sky=2", &["`speed` is continuous"]),
        ("plan --space SPACE.toml --strength lanes,lanes=2", &["`lanes` is named twice"]),
        ("generate --space ONE.pict --discrete random", &["negative values (`~`)", "use --discrete ipog"]),
        ("estimate model.csv --space MODEL.pict --certificate c.json", &["negative values (`~`)"]),
        (
            "generate --space MIXED.toml --extend begun.csv --budget 5",
            &["begun.csv, line 2: column `sky`: found an empty cell", "only if no parameter is continuous"],
        ),
    ];
    for (command, says) in cases {
        refused(&cover(dir.path(), &command.split(' ').collect::<Vec<_>>()), says);
    }
}
