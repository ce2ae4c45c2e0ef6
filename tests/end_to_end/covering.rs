//! Discrete parameters and constraints as users meet them: covering arrays, PICT models, (k, epsilon)-covering sets.

use crate::common::{cover, fuzz, golden, refused, stderr, stdout, succeeds};
use crate::mixed_space::{SPACE, discrete_space, generated, measured, rows};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

const MODEL: &str = "\
Type:   Single, Span, Stripe\n\
Size:   10, 100, 5000\n\
System: FAT, NTFS\n\
Zip:    On, Off\n\
\n\
IF [System] = \"FAT\" THEN [Size] <= 100;\n";

#[test]
fn an_array_keeps_the_constraints_covers_all_pairs_and_says_how_small_it_can_be() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), discrete_space()).unwrap();
    let (csv, notes) = generated(dir.path(), &["--space", "SPACE.toml"]);
    let rows = rows(&csv);
    let violates = |row: &Vec<String>| row[0] == "2" && row[1] == "fog" || row[2] == "truck" && row[0] == "6";
    assert!(!rows.iter().any(violates));
    // By hand: 8 of lanes and sky, 5 of lanes and car, 6 of lanes and wet, 6 and 6 with sky, 4 of car and wet.
    let mut pairs = BTreeSet::new();
    for row in &rows {
        for i in 0..4 {
            pairs.extend((i + 1..4).map(|j| (i, j, row[i].clone(), row[j].clone())));
        }
    }
    assert_eq!(pairs.len(), 8 + 5 + 6 + 6 + 6 + 4);
    assert!(notes.contains(&format!("a 2-wise covering array of {} rows; ", rows.len())), "{notes}");
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let coverage = measured(dir.path(), &["tests.csv", "--space", "SPACE.toml"]);
    assert_eq!(coverage["discrete"]["valid"], 35);
    assert_eq!(coverage["discrete"]["covered"], 35);
    assert_eq!(coverage["k_wise_dispersion"]["upper"], 0.0);
}

#[test]
fn tests_that_violate_a_constraint_cover_nothing_and_are_counted() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), discrete_space()).unwrap();
    fs::write(dir.path().join("tests.csv"), "lanes,sky,car,wet\n2,fog,small,no\n2,rain,small,no\n").unwrap();
    let coverage = measured(dir.path(), &["tests.csv", "--space", "SPACE.toml"]);
    assert_eq!((&coverage["tests"], &coverage["violating"]), (&Value::from(2), &Value::from(1)));
    assert_eq!(coverage["discrete"]["covered"], 6);
}

#[test]
fn a_model_of_pict_is_read_wherever_a_space_is() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("MODEL.pict"), MODEL).unwrap();
    let (csv, notes) = generated(dir.path(), &["--space", "MODEL.pict"]);
    let rows = rows(&csv);
    assert!(csv.starts_with("Type,Size,System,Zip\n"));
    assert!(rows.iter().all(|row| row[2] != "FAT" || row[1] != "5000"));
    // Three types with three sizes each.
    assert_eq!(rows.len(), 9);
    assert!(notes.contains("9 rows; proved to be the fewest"), "{notes}");
    fs::write(dir.path().join("tests.csv"), &csv).unwrap();
    assert_eq!(measured(dir.path(), &["tests.csv", "--space", "MODEL.pict"])["discrete"]["ratio"], 1.0);
    let plan = stdout(&succeeds(cover(dir.path(), &["plan", "--space", "MODEL.pict", "--format", "table"])));
    assert!(plan.contains("any rows") && plan.contains("needed by any set"), "{plan}");
    fs::write(dir.path().join("WRONG.pict"), MODEL.replace("[Size] <=", "[Sise] <=")).unwrap();
    refused(
        &cover(dir.path(), &["generate", "--space", "WRONG.pict", "--strict"]),
        &["WRONG.pict: line 6, column 26", "`Size`"],
    );
}

#[test]
fn existing_tests_are_kept_and_completed() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), discrete_space()).unwrap();
    let old = "lanes,sky,car,wet\n4,fog,truck,yes\n2,clear,small,no\n6,rain,small,yes\n";
    fs::write(dir.path().join("old.csv"), old).unwrap();
    let (added, notes) = generated(dir.path(), &["--space", "SPACE.toml", "--extend", "old.csv"]);
    assert!(notes.contains("(3 of them existing)"), "{notes}");
    let all = old.to_owned() + added.split_once('\n').unwrap().1;
    fs::write(dir.path().join("all.csv"), all).unwrap();
    assert_eq!(measured(dir.path(), &["all.csv", "--space", "SPACE.toml"])["discrete"]["ratio"], 1.0);
    assert!(rows(&added).len() < 10);
}

#[test]
fn named_groups_are_covered_at_a_higher_strength() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), discrete_space()).unwrap();
    let (csv, _) = generated(dir.path(), &["--space", "SPACE.toml", "--strength", "lanes,sky,wet=3"]);
    let triples: BTreeSet<_> =
        rows(&csv).into_iter().map(|row| (row[0].clone(), row[1].clone(), row[3].clone())).collect();
    assert_eq!(triples.len(), 16);
    for (strength, says) in [
        ("lanes,sky", "expected NAME,NAME,..=K"),
        ("lanes,ski=2", "`sky`"),
        ("lanes,sky=3", "expected 1 to 2"),
        ("lanes,lanes=2", "named twice"),
    ] {
        refused(
            &cover(dir.path(), &["generate", "--space", "SPACE.toml", "--strength", strength]),
            &["--strength", says],
        );
    }
}

#[test]
fn a_smaller_array_is_looked_for_on_request() {
    let dir = tempfile::tempdir().unwrap();
    let parameter = |i| format!("[[parameter]]\nname = \"p{i}\"\nchoice = [1, 2, 3, 4]\n");
    fs::write(dir.path().join("SPACE.toml"), (0..8).map(parameter).collect::<String>()).unwrap();
    let (plain, _) = generated(dir.path(), &["--space", "SPACE.toml", "--k", "3"]);
    let (smaller, _) = generated(dir.path(), &["--space", "SPACE.toml", "--k", "3", "--optimise", "0.5"]);
    assert!(rows(&smaller).len() <= rows(&plain).len());
    fs::write(dir.path().join("tests.csv"), smaller).unwrap();
    let coverage = measured(dir.path(), &["tests.csv", "--space", "SPACE.toml", "--k", "3"]);
    assert_eq!(coverage["discrete"]["ratio"], 1.0);
}

#[test]
fn constraints_that_no_test_keeps_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let space = discrete_space().replace(
        "constraints = [",
        "constraints = [\"sky == 'fog' or wet == 'yes'\", \"wet == 'no'\", \"sky in ['clear', 'rain']\", ",
    );
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let output = cover(dir.path(), &["generate", "--space", "SPACE.toml"]);
    let line = 1 + discrete_space().lines().position(|line| line.starts_with("constraints")).unwrap();
    let named = ["wet == 'no'", "sky in ['clear', 'rain']"].map(|text| format!("\n  SPACE.toml:{line}: {text}"));
    refused(&output, &["SPACE.toml: no test keeps these constraints together:\n", &named[0], &named[1]]);
    assert!(!stderr(&output).contains("lanes"), "only those in conflict are named");
}

#[test]
fn statements_of_a_model_that_no_test_keeps_are_named_with_their_lines() {
    let dir = tempfile::tempdir().unwrap();
    let model = "a: 1, 2\nb: ~-1, 3\nc: ~-1, ~-2, 4\n\nIF [a] = 1\n  THEN [b] = -1;\n[a] <> 2; [c] < 0;\n[b] < 9;\n";
    fs::write(dir.path().join("m.pict"), model).unwrap();
    let output = cover(dir.path(), &["generate", "--space", "m.pict"]);
    let named = "m.pict: no test keeps these constraints together:\n  m.pict:5: IF [a] = 1 THEN [b] = -1;\n  \
                 m.pict:7: [a] <> 2;\n  m.pict:7: [c] < 0;\n  b == -1 implies c == 4";
    refused(&output, &[named]);
}

#[test]
fn all_combinations_under_constraints_are_those_that_keep_them() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let (cross, _) = generated(dir.path(), &["--space", "SPACE.toml", "--discrete", "cross", "--budget", "1000"]);
    let distinct: BTreeSet<Vec<String>> = rows(&cross).into_iter().map(|row| row[1..].to_vec()).collect();
    // Of 36 combinations, 4 with fog on 2 lanes and 6 with a truck on 6.
    assert_eq!(distinct.len(), 26);
}

#[test]
fn a_certificate_claims_nothing_of_what_constraints_exclude() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let (csv, _) = generated(dir.path(), &["--space", "SPACE.toml", "--strategy", "greedy", "--budget", "60"]);
    fs::write(dir.path().join("tests.csv"), csv).unwrap();
    let coverage = measured(dir.path(), &["tests.csv", "--space", "SPACE.toml", "--certificate", "c.json"]);
    assert!(coverage["k_wise_dispersion"]["upper"].as_f64().unwrap() < 0.5, "{coverage}");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/check_certificate.py");
    match Command::new("python3").arg(script).arg(dir.path().join("c.json")).output() {
        Err(_) => eprintln!("python3 was not found: the certificate was not checked"),
        Ok(checked) => {
            let says = stdout(&succeeds(checked));
            let proved = "in any 2 parameters but 2 combinations of values, which constraints exclude, has been hit";
            assert!(says.contains(proved), "{says}");
        }
    }
}

#[test]
fn where_nothing_is_missing_nothing_is_added() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), discrete_space()).unwrap();
    let (all, _) = generated(dir.path(), &["--space", "SPACE.toml"]);
    fs::write(dir.path().join("all.csv"), all).unwrap();
    let (added, _) = generated(dir.path(), &["--space", "SPACE.toml", "--extend", "all.csv"]);
    assert_eq!(added, "lanes,sky,car,wet\n");
}

#[test]
fn rows_that_are_begun_are_completed_and_count_as_new() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), discrete_space()).unwrap();
    fs::write(dir.path().join("begun.csv"), "lanes,sky,car,wet\n2,,truck,\n4,fog,small,no\n,fog,,yes\n").unwrap();
    let (added, notes) = generated(dir.path(), &["--space", "SPACE.toml", "--extend", "begun.csv"]);
    assert!(notes.contains("(3 of them existing, 2 completed)"), "{notes}");
    let rows = rows(&added);
    assert!(rows.iter().any(|row| row[0] == "2" && row[2] == "truck" && row[1] != "fog"));
    assert!(!rows.contains(&["4", "fog", "small", "no"].map(str::to_owned).to_vec()), "it is there already");
    let all = added + "4,fog,small,no\n";
    fs::write(dir.path().join("all.csv"), all).unwrap();
    assert_eq!(measured(dir.path(), &["all.csv", "--space", "SPACE.toml"])["discrete"]["ratio"], 1.0);
    fs::write(dir.path().join("wrong.csv"), "lanes,sky,car,wet\n2,,lorry,\n").unwrap();
    let output = cover(dir.path(), &["generate", "--space", "SPACE.toml", "--extend", "wrong.csv"]);
    refused(&output, &["wrong.csv, line 2", "`car`", "lorry", "small, truck"]);
}

#[test]
fn a_random_family_says_what_it_promises_beside_what_was_measured() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    fs::write(dir.path().join("FREE.pict"), MODEL.split("IF").next().unwrap()).unwrap();
    fs::write(dir.path().join("MODEL.pict"), MODEL).unwrap();
    let cases: [&[&str]; 7] = [
        &["--space", "FREE.pict"],
        &["--space", "FREE.pict", "--k", "3", "--seed", "1"],
        &["--space", "MODEL.pict"],
        &["--space", "MODEL.pict", "--delta", "0.000001"],
        &["--space", "SPACE.toml", "--epsilon", "0.3"],
        &["--space", "SPACE.toml", "--budget", "30"],
        &["--space", "SPACE.toml", "--budget", "5"],
    ];
    let mut all = String::new();
    for case in cases {
        let (csv, notes) = generated(dir.path(), &[case, &["--discrete", "random"]].concat());
        if case[1] == "MODEL.pict" {
            assert!(rows(&csv).iter().all(|row| row[2] != "FAT" || row[1] != "5000"));
        }
        all += &format!("generate {} --discrete random\n{notes}", case.join(" "));
    }
    golden("random.txt", &all);
}

#[test]
fn a_random_family_of_which_rows_are_asked_for_has_no_promise_without_them() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let arguments = ["--space", "SPACE.toml", "--strategy", "greedy", "--discrete", "random", "--budget", "5"];
    let (_, rows) = generated(dir.path(), &arguments);
    assert!(rows.contains("random rows"), "{rows}");
    let aim = ["--measure", "k-wise-dispersion"];
    let (_, all_at_once) = generated(dir.path(), &[&arguments[..], &aim].concat());
    assert!(!all_at_once.contains("random rows"), "{all_at_once}");
}

#[test]
fn delta_is_refused_where_nothing_is_random() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), SPACE).unwrap();
    let with = |more: &[&str]| cover(dir.path(), &[&["generate", "--space", "SPACE.toml"], more].concat());
    refused(&with(&["--delta", "0.1"]), &["`ipog` needs no delta", "only the family random"]);
    refused(&with(&["--delta", "0.1", "--discrete", "cross"]), &["`cross` needs no delta", "only the family random"]);
    refused(&with(&["--delta", "1", "--discrete", "random"]), &["delta is 1", "above 0 and below 1"]);
    let fuzz = fuzz(dir.path(), &["--open", "lanes=2,4", "--delta", "0.1"]);
    refused(&fuzz, &["`ipog` needs no delta", "only the family random"]);
}

#[test]
fn a_campaign_with_random_rows_says_what_they_promise_and_what_they_cover() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = |more: &[&str]| {
        let open = ["--open", "lanes=2,4,6", "--open", "friction=0.2,0.5,0.8", "--discrete", "random"];
        stdout(&succeeds(fuzz(dir.path(), &[&open, more].concat())))
    };
    let table = campaign(&["--budget", "50", "--delta", "0.3", "--format", "table", "--out", "enough"]);
    let lines = table.lines().skip_while(|line| !line.contains("random rows")).take(3);
    golden("random-campaign.txt", &lines.fold(String::new(), |lines, line| lines + line + "\n"));
    let study = fs::read_to_string(dir.path().join("enough/campaign.json")).unwrap();
    assert_eq!(serde_json::from_str::<Value>(&study).unwrap()["delta"], 0.3);
    let summary: Value =
        serde_json::from_str(&campaign(&["--budget", "20", "--out", "fewer", "--format", "json"])).unwrap();
    let random = &summary["random_rows"];
    assert_eq!((&random["k"], &random["delta"], &random["rows"]), (&2.into(), &0.05.into(), &20.into()));
    // Nine combinations, each in a row with probability 1/9.
    let missed = (0..20).fold(9.0, |missed, _| missed * 8.0 / 9.0);
    let guaranteed = 1.0 - missed;
    assert!((random["guaranteed_probability"].as_f64().unwrap() - guaranteed).abs() < 1e-9, "{random}");
    assert_eq!(random["different"], summary["coverage"]["discrete"]["covered"]);
}

#[test]
fn tests_that_do_not_count_are_named_by_line_and_reason() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("SPACE.toml"), discrete_space()).unwrap();
    let begun = "lanes,sky,car,wet\n2,,truck,\n2,fog,,\n4,rain,small,no\n6,clear,truck,yes\n2,fog,,\n";
    fs::write(dir.path().join("begun.csv"), begun).unwrap();
    let (_, notes) = generated(dir.path(), &["--space", "SPACE.toml", "--extend", "begun.csv"]);
    assert!(notes.contains("2 different existing rows violate a constraint and do not count\n"), "{notes}");
    let refused: Vec<&str> = notes.lines().filter(|line| line.contains("excluded by")).collect();
    assert_eq!(refused.len(), 2, "{notes}");
    assert!(refused[0].starts_with("line 3: lanes 2, sky fog: excluded by `"), "{notes}");
    assert!(refused[1].starts_with("line 5: lanes 6, sky clear, car truck, wet yes: excluded by `"), "{notes}");
    assert!(notes.contains("(2 of them existing, 1 completed)"), "{notes}");
    // Where a test cannot be begun, tests are counted instead of lines.
    fs::write(dir.path().join("MIXED.toml"), SPACE).unwrap();
    fs::write(dir.path().join("mixed.csv"), "speed,lanes,sky,car,wet\n1,4,fog,small,no\n2,2,fog,small,no\n").unwrap();
    let mixed = ["--space", "MIXED.toml", "--discrete", "ipog", "--extend", "mixed.csv", "--budget", "20"];
    let (_, notes) = generated(dir.path(), &mixed);
    assert!(notes.contains("test 2: lanes 2, sky fog, car small, wet no: excluded by `"), "{notes}");
}

#[test]
fn a_budget_below_the_rows_says_what_its_tests_cover() {
    let dir = tempfile::tempdir().unwrap();
    let choice = |name| format!("[[parameter]]\nname = \"{name}\"\nchoice = [1, 2, 3]\n");
    let space: String = ["a", "b", "c", "d"].map(choice).concat();
    fs::write(dir.path().join("SPACE.toml"), &space).unwrap();
    let (csv, notes) = generated(dir.path(), &["--space", "SPACE.toml", "--budget", "5"]);
    // The nine rows of the array have each of the 54 pairs once, six a row.
    assert_eq!(rows(&csv).len(), 5);
    assert!(notes.contains("5 of the 9 rows: 30 of 54 pairs\n"), "{notes}");
    let (_, notes) = generated(dir.path(), &["--space", "SPACE.toml", "--budget", "9"]);
    assert!(!notes.contains("of the 9 rows"), "{notes}");
    let speed = "[[parameter]]\nname = \"speed\"\ninterval = [0, 1]\n";
    fs::write(dir.path().join("MIXED.toml"), speed.to_owned() + &space).unwrap();
    let (_, notes) = generated(dir.path(), &["--space", "MIXED.toml", "--budget", "5"]);
    assert!(notes.contains("5 of the 9 rows: 30 of 54 pairs\nnot 2-wise complete"), "{notes}");
}
