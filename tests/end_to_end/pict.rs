//! Models and tests of PICT.

use crate::common::{cover, refused, succeeds};
use std::fs;
use std::path::Path;

fn model(dir: &Path, text: &str) {
    fs::write(dir.join("m.pict"), text).unwrap();
}

const MODEL: &str = "A: ~-1, 0, 1\nB: red | rot | rouge, green\nC: x, y\n";

/// The tests that PICT 3.7.4 makes of [`MODEL`], with the option `/o:2`.
const OF_PICT: &str = "A\tB\tC\n1\tgreen\ty\n0\trot\ty\n0\tgreen\tx\n1\trouge\tx\n~-1\tred\tx\n~-1\tgreen\ty\n";

#[test]
fn tests_of_pict_are_read_with_tabs_signs_and_aliases() {
    let dir = tempfile::tempdir().unwrap();
    model(dir.path(), MODEL);
    fs::write(dir.path().join("pict.txt"), OF_PICT).unwrap();
    let estimate = cover(dir.path(), &["estimate", "pict.txt", "--space", "m.pict", "--format", "table"]);
    let told = String::from_utf8(succeeds(estimate).stdout).unwrap();
    assert!(told.contains("6 tests over A, B, C") && told.contains("(100.0 %)"), "{told}");
    let extend = cover(dir.path(), &["generate", "--space", "m.pict", "--extend", "pict.txt"]);
    assert_eq!(String::from_utf8(succeeds(extend).stdout).unwrap(), "A,B,C\n");
    fs::write(dir.path().join("wrong.txt"), OF_PICT.replace("rouge", "rogue")).unwrap();
    let estimate = cover(dir.path(), &["estimate", "wrong.txt", "--space", "m.pict"]);
    refused(&estimate, &["wrong.txt, line 5", "found rogue, expected one of red, green"]);
}

#[test]
fn negative_values_are_written_with_their_sign_and_read_back() {
    let dir = tempfile::tempdir().unwrap();
    model(dir.path(), MODEL);
    let tests = succeeds(cover(dir.path(), &["generate", "--space", "m.pict"])).stdout;
    let text = String::from_utf8(tests).unwrap();
    assert!(text.contains("\n~-1,") && !text.contains("\n-1,"), "{text}");
    fs::write(dir.path().join("tests.csv"), &text).unwrap();
    let estimate = cover(dir.path(), &["estimate", "tests.csv", "--space", "m.pict", "--format", "table"]);
    let told = String::from_utf8(succeeds(estimate).stdout).unwrap();
    assert!(told.contains("(100.0 %)"), "{told}");
}

#[test]
fn notes_of_a_model_are_printed_and_with_strict_they_are_errors() {
    let dir = tempfile::tempdir().unwrap();
    model(dir.path(), "A: 1, 2, 3\nB: x, y\n[A] <> 3;\nIF [Bee] = \"x\" THEN [A] = 1;\n");
    let notes = [
        "m.pict: line 4, column 4: no parameter is called `Bee`, so this constraint is ignored",
        "m.pict: the constraints exclude `3` of parameter `A` from all tests",
    ];
    let told = String::from_utf8(succeeds(cover(dir.path(), &["plan", "--space", "m.pict"])).stderr).unwrap();
    notes.iter().for_each(|note| assert!(told.contains(note), "{told}"));
    for command in ["plan", "generate"] {
        refused(&cover(dir.path(), &[command, "--space", "m.pict", "--strict"]), &notes);
    }
    model(dir.path(), MODEL);
    refused(
        &cover(dir.path(), &["generate", "--space", "m.pict", "--strict"]),
        &["tests are made with the first name"],
    );
    model(dir.path(), "A: 1, 2\nB: x, y\n");
    succeeds(cover(dir.path(), &["generate", "--space", "m.pict", "--strict"]));
    refused(&cover(dir.path(), &["generate", "--space", "m.pict", "--k", "3"]), &["3", "2"]);
}

#[test]
fn tests_over_choices_with_many_values_are_planned_and_generated() {
    let dir = tempfile::tempdir().unwrap();
    let values: Vec<String> = (0..300_000).map(|i| i.to_string()).collect();
    model(dir.path(), &format!("A: {}\nB: 1, 2\n", values.join(", ")));
    succeeds(cover(dir.path(), &["plan", "--space", "m.pict"]));
    let some = succeeds(cover(dir.path(), &["generate", "--space", "m.pict", "--budget", "3"]));
    assert!(String::from_utf8(some.stderr).unwrap().contains("3 of 600000 pairs"));
    let long = "n".repeat(20_000);
    let text = format!("constraints = [\"{long} == 3\"]\n[[parameter]]\nname = \"{long}x\"\nchoice = [1, 2]\n");
    fs::write(dir.path().join("SPACE.toml"), text).unwrap();
    refused(&cover(dir.path(), &["plan", "--space", "SPACE.toml"]), &["no parameter is called"]);
}
