//! Certificates: what `estimate --certificate` writes is accepted by a checker that shares nothing with it, and what
//! somebody has tampered with is not.

use crate::common::{cover, refused, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const SPACE: &str = "[[parameter]]\nname = \"lanes\"\nchoice = [2, 4, 6]\n\
                     [[parameter]]\nname = \"weather\"\nchoice = [\"clear\", \"fog\"]\n\
                     [[parameter]]\nname = \"speed\"\ninterval = [0.0, 10.0]\n\
                     [[parameter]]\nname = \"distance\"\ninterval = [5.0, 60.0]\n";

/// `estimate` of the first `n` of 200 tests of a mixed space, with a certificate.
fn estimate(dir: &Path, n: u32, more: &[&str]) -> Output {
    fs::write(dir.join("SPACE.toml"), SPACE).unwrap();
    let mut tests = "lanes,weather,speed,distance\n".to_owned();
    for i in 1..=n {
        let lanes = 2 + 2 * (i % 3);
        let weather = if i / 3 % 2 == 0 { "clear" } else { "fog" };
        let (speed, distance) = (f64::from(i * 89 % 200) / 20.0, 5.0 + f64::from(i * 121 % 199) * 55.0 / 199.0);
        tests += &format!("{lanes},{weather},{speed},{distance}\n");
    }
    fs::write(dir.join("tests.csv"), tests).unwrap();
    let arguments =
        ["estimate", "tests.csv", "--space", "SPACE.toml", "--certificate", "certificate.json", "--format", "json"];
    cover(dir, &[&arguments, more].concat())
}

fn read(dir: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(dir.join("certificate.json")).unwrap()).unwrap()
}

/// What the independent checker says of a certificate; none where there is no Python to run it.
pub fn check(dir: &Path, certificate: &Value) -> Option<Output> {
    let file = dir.join("to-check.json");
    fs::write(&file, certificate.to_string()).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/check_certificate.py");
    let output = Command::new("python3").arg(script).arg(file).output();
    if output.is_err() {
        eprintln!("python3 was not found: the certificate is not checked");
    }
    output.ok()
}

/// The claim about a measure.
pub fn claim<'a>(certificate: &'a mut Value, measure: &str) -> &'a mut Value {
    let claims = certificate["claims"].as_array_mut().unwrap();
    claims.iter_mut().find(|claim| claim["measure"] == measure).unwrap()
}

#[test]
fn a_certificate_proves_what_estimate_prints_and_is_accepted() {
    let dir = tempfile::tempdir().unwrap();
    let output = succeeds(estimate(dir.path(), 200, &[]));
    assert!(stderr(&output).contains("k-wise-dispersion, k = 2 at most"), "{}", stderr(&output));
    let printed: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let mut certificate = read(dir.path());
    let measured = [("dispersion", &printed["continuous"]["dispersion"], 1), {
        // Two continuous parameters; one of 2 with one of 5 values; 3 values with 2.
        ("k-wise-dispersion", &printed["k_wise_dispersion"], 1 + 2 * 5 + 6)
    }];
    for (measure, printed, projections) in measured {
        let claim = claim(&mut certificate, measure);
        let (lower, upper) = (claim["lower"].as_f64().unwrap(), claim["upper"].as_f64().unwrap());
        assert_eq!(lower, printed["lower"]);
        assert!(lower < upper && upper <= lower * (1.0 + 1e-11), "{upper}");
        assert_eq!(claim["proofs"].as_array().unwrap().len(), projections);
    }
    assert_eq!(
        claim(&mut certificate, "dispersion")["witness"]["values"]["empty_box"],
        printed["continuous"]["dispersion"]["largest_empty_box"]
    );
    if let Some(checked) = check(dir.path(), &certificate) {
        let says = stdout(&succeeds(checked));
        assert!(says.contains("in any 2 parameters has been hit: proved (17 projections, "), "{says}");
        assert!(
            says.contains("in all 2 continuous parameters together has been hit: proved (1 projections, "),
            "{says}"
        );
    }
}

#[test]
fn what_is_printed_does_not_depend_on_the_certificate() {
    let dir = tempfile::tempdir().unwrap();
    let with = stdout(&succeeds(estimate(dir.path(), 50, &[])));
    let without =
        stdout(&succeeds(cover(dir.path(), &["estimate", "tests.csv", "--space", "SPACE.toml", "--format", "json"])));
    assert_eq!(with, without);
}

#[test]
fn a_certificate_that_was_tampered_with_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(estimate(dir.path(), 200, &[]));
    let refuses = |says: &str, tamper: &dyn Fn(&mut Value)| {
        let mut certificate = read(dir.path());
        tamper(&mut certificate);
        assert!(certificate != read(dir.path()), "{says}: nothing was changed");
        let Some(checked) = check(dir.path(), &certificate) else { return };
        let message = stderr(&checked);
        assert_eq!(checked.status.code(), Some(1), "{says}: {}", stdout(&checked));
        assert!(message.starts_with("refused: ") && message.contains(says), "`{says}` is missing in: {message}");
    };
    refuses("is not inside the box", &|certificate| {
        let pivot = claim(certificate, "dispersion")["proofs"][0]["pivots"][0].as_u64().unwrap();
        certificate["coordinates"][pivot as usize] = json!([0.0, 0.0]);
    });
    refuses("is inside the witness", &|certificate| {
        let witness = &claim(certificate, "dispersion")["witness"];
        let middle = |axis: usize| {
            let end = |end: &str| witness[end][axis].as_f64().unwrap();
            f64::midpoint(end("lower"), end("upper"))
        };
        certificate["coordinates"][7] = json!([middle(0), middle(1)]);
    });
    refuses("is inside the witness", &|certificate| {
        claim(certificate, "k-wise-dispersion")["witness"] =
            json!({"fixed": [], "axes": [0, 1], "lower": [0, 0], "upper": [1, 1]});
    });
    refuses("the witness has the volume", &|certificate| {
        let claim = claim(certificate, "dispersion");
        claim["lower"] = json!(claim["lower"].as_f64().unwrap() * 0.99);
    });
    refuses("the bounds contradict each other", &|certificate| {
        let claim = claim(certificate, "dispersion");
        claim["upper"] = json!(claim["lower"].as_f64().unwrap() * 0.99);
    });
    for measure in ["dispersion", "k-wise-dispersion"] {
        refuses("box from", &|certificate| {
            let claim = claim(certificate, measure);
            claim["upper"] = json!(claim["upper"].as_f64().unwrap() * 0.99);
            (claim["lower"], claim["witness"]) = (json!(0.0), Value::Null);
        });
        refuses("there is no proof", &|certificate| {
            claim(certificate, measure)["proofs"].as_array_mut().unwrap().pop().unwrap();
        });
        refuses("the proof ends", &|certificate| {
            claim(certificate, measure)["proofs"][0]["pivots"].as_array_mut().unwrap().pop().unwrap();
        });
        refuses("goes on after its end", &|certificate| {
            claim(certificate, measure)["proofs"][0]["pivots"].as_array_mut().unwrap().push(json!(0));
        });
    }
    refuses("is no test that is selected", &|certificate| {
        let proofs = claim(certificate, "k-wise-dispersion")["proofs"].as_array_mut().unwrap();
        let (first, second) = (proofs.len() - 1, proofs.len() - 2);
        proofs[first]["pivots"] = proofs[second]["pivots"].clone();
    });
    refuses("in any 3 parameters", &|certificate| claim(certificate, "k-wise-dispersion")["k"] = json!(3));
    refuses("excluded, but there are no constraints", &|certificate| {
        let forged = claim(certificate, "k-wise-dispersion");
        (forged["excluded"], forged["proofs"], forged["upper"]) = (json!([[]]), json!([]), json!(0.9));
    });
    refuses("a combination of no values is excluded", &|certificate| {
        certificate["constraints"] = json!(["lanes == 2"]);
        claim(certificate, "k-wise-dispersion")["excluded"] = json!([[]]);
    });
    refuses("there are no 0 parameters", &|certificate| claim(certificate, "k-wise-dispersion")["k"] = json!(0));
}

#[test]
fn what_nothing_covers_and_what_was_not_proved_is_said() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(estimate(dir.path(), 2, &[]));
    let mut uncovered = read(dir.path());
    assert_eq!(claim(&mut uncovered, "k-wise-dispersion")["upper"], 1.0);
    if let Some(checked) = check(dir.path(), &uncovered) {
        let says = stdout(&succeeds(checked));
        assert!(says.contains("region of volume 1.0 in any 2 parameters has not been hit: shown"), "{says}");
        assert!(says.contains("nothing is proved of larger regions in any 2 parameters: there are none"), "{says}");
    }
    fs::remove_file(dir.path().join("certificate.json")).unwrap();
    let output = succeeds(estimate(dir.path(), 200, &["--time-limit", "0"]));
    assert!(stderr(&output).contains("warning: dispersion: "), "{}", stderr(&output));
    let mut hurried = read(dir.path());
    assert_eq!(claim(&mut hurried, "dispersion")["proofs"], json!([]));
    if let Some(checked) = check(dir.path(), &hurried) {
        let says = stdout(&succeeds(checked));
        assert!(says.contains("nothing is proved") && says.contains("the time limit"), "{says}");
    }
}

#[test]
fn a_certificate_replaces_an_older_one_and_needs_something_to_prove() {
    let dir = tempfile::tempdir().unwrap();
    let nothing = estimate(dir.path(), 20, &["--measures", "star,k-wise"]);
    refused(&nothing, &["certificate", "`dispersion`", "`k-wise-dispersion`"]);
    assert!(!dir.path().join("certificate.json").exists());
    fs::write(dir.path().join("certificate.json"), "older").unwrap();
    succeeds(estimate(dir.path(), 20, &[]));
    assert!(fs::read_to_string(dir.path().join("certificate.json")).unwrap().starts_with('{'));
}

/// The number of malformed certificates that are checked.
const MALFORMED: u64 = 200;

#[test]
fn the_checker_refuses_malformed_certificates_in_its_own_words() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(estimate(dir.path(), 30, &[]));
    let whole = read(dir.path());
    let (mut refusals, mut places) = (0, 0);
    count(&whole, &mut places);
    for turn in 0..MALFORMED {
        let mut certificate = whole.clone();
        let wrong = [json!(null), json!(-1), json!("x"), json!([]), json!({}), json!(1e308), json!(true), json!([[0]])];
        let (mut place, with) = (turn * 7919 % places, wrong[(turn % 8) as usize].clone());
        replace(&mut certificate, &mut place, &with);
        let Some(checked) = check(dir.path(), &certificate) else { return };
        let message = stderr(&checked);
        match checked.status.code() {
            Some(0) => {}
            code => {
                refusals += 1;
                assert!(code == Some(1) && message.starts_with("refused: "), "{with} in place {turn}: {message}");
            }
        }
    }
    assert!(refusals > MALFORMED / 2, "{refusals}");
    for (text, says) in [
        ("", "is not JSON"),
        ("{", "is not JSON"),
        ("[]", "expected an object"),
        ("NaN", "expected an object"),
        ("\u{ff}", "expected"),
        (&"[".repeat(100_000), "nested too deeply"),
    ] {
        let file = dir.path().join("text.json");
        fs::write(&file, text).unwrap();
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/check_certificate.py");
        let Ok(checked) = Command::new("python3").arg(script).arg(file).output() else { return };
        let message = stderr(&checked);
        assert!(message.starts_with("refused: "), "{message}");
        assert!(message.contains(says) || text == "\u{ff}", "{message}");
    }
}

/// Counts the values in a value.
fn count(value: &Value, places: &mut u64) {
    *places += 1;
    match value {
        Value::Array(items) => items.iter().for_each(|item| count(item, places)),
        Value::Object(entries) => entries.values().for_each(|entry| count(entry, places)),
        _ => {}
    }
}

/// Replaces the value in a place, counted as `count` counts.
fn replace(value: &mut Value, place: &mut u64, with: &Value) {
    if *place == 0 {
        *value = with.clone();
        *place = u64::MAX;
        return;
    }
    *place = place.wrapping_sub(1);
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| replace(item, place, with)),
        Value::Object(entries) => entries.values_mut().for_each(|entry| replace(entry, place, with)),
        _ => {}
    }
}
