//! `paracosm-fuzz sensitivity`, and SALib as a judge of its indices.

use crate::common::{fuzz, golden, refused, stdout, succeeds};
use paracosm::analysis::sensitivity::{Explained, Factor, explain, of_tests};
use paracosm::campaign::{Campaign, Log, Study};
use serde_json::{Value, json};
use std::cell::RefCell;
use std::f64::consts::PI;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Runs a small campaign in a folder.
fn campaign(dir: &Path, more: &[&str]) {
    succeeds(fuzz(dir, &[&["--budget", "200", "--strategy", "halton", "--out", "c"], more].concat()));
}

#[test]
fn the_indices_come_from_the_model_or_from_tests_and_are_the_same_with_any_number_of_jobs() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &[]);
    let before = fs::read(dir.path().join("c/trials.jsonl")).unwrap();
    let run = |more: &[&str]| stdout(&succeeds(fuzz(dir.path(), &[&["sensitivity", "c"], more].concat())));
    golden("sensitivity-of-the-model.txt", &run(&[]));
    golden("sensitivity-of-tests.txt", &run(&["--budget", "1000"]));
    let json = run(&["--budget", "1000", "--format", "json", "--jobs", "1"]);
    golden("sensitivity.json", &json);
    assert_eq!(run(&["--budget", "1000", "--format", "json", "--jobs", "3"]), json);
    assert_eq!(fs::read(dir.path().join("c/trials.jsonl")).unwrap(), before, "the campaign stays as it is");
}

#[test]
fn a_parameter_without_effect_has_no_share_and_stands_last() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &["--open", "fog"]);
    let found = stdout(&succeeds(fuzz(dir.path(), &["sensitivity", "c", "--budget", "500", "--format", "json"])));
    let found: Value = serde_json::from_str(&found).unwrap();
    for quantity in ["failure", "robustness"] {
        let last = found[quantity]["parameters"].as_array().unwrap().last().unwrap();
        assert_eq!(last["name"], "fog");
        for index in ["first_order", "total"] {
            assert_eq!(last[index], json!({"estimate": 0.0, "lower": 0.0, "upper": 0.0}), "{quantity}");
        }
    }
}

#[test]
fn what_has_no_indices_is_refused_in_words() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), &["--set", "speed=0.5", "--set", "distance=20", "--open", "rain"]);
    refused(&fuzz(dir.path(), &["sensitivity", "c"]), &["no model of its failures, because no test failed"]);
    refused(&fuzz(dir.path(), &["sensitivity", "c", "--budget", "10"]), &["the budget is 10, expected at least 48"]);
    refused(&fuzz(dir.path(), &["sensitivity", "d"]), &["d"]);
    // All tests pass, so that only the robustness differs.
    let found = stdout(&succeeds(fuzz(dir.path(), &["sensitivity", "c", "--budget", "100"])));
    assert!(found.contains("Nothing to explain: the failure (1 or 0) is the same in all tests."), "{found}");
}

#[test]
fn parameters_with_a_constraint_between_them_have_no_indices() {
    let dir = tempfile::tempdir().unwrap();
    // Every test passes.
    let answer = r#"i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"robustness\":{\"above\":1}}""#;
    fs::write(dir.path().join("system.sh"), format!("while read -r line; do {answer}; done\n")).unwrap();
    let interval = |name: &str| format!("[[parameter]]\nname = \"{name}\"\ninterval = [0, 1]\n");
    let space = format!("constraints = [\"x < y\"]\n{}{}", interval("x"), interval("y"));
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let system = ["--system", "sh system.sh"];
    campaign(dir.path(), &[&system[..], &["--space", "SPACE.toml"]].concat());
    for budget in [&["--budget", "100"][..], &[]] {
        let refusal = fuzz(dir.path(), &[&["sensitivity", "c"], &system[..], budget].concat());
        refused(&refusal, &["the constraints leave a part of the space", "not independent"]);
    }
}

/// A quantity of a point of the unit cube.
type Quantity<'a> = Box<dyn Fn(&[Vec<f64>]) -> Vec<f64> + 'a>;

/// Returns what SALib says to each case; `None` if it is not installed.
fn judged(task: &str, cases: &[Value]) -> Option<Vec<Value>> {
    let has_judge = Command::new("python3").args(["-c", "import SALib"]).stderr(Stdio::null()).status();
    if !has_judge.is_ok_and(|status| status.success()) {
        eprintln!("SKIPPED: no SALib");
        return None;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/end_to_end/salib_judge.py");
    let arguments = [script.to_str().unwrap(), task];
    let mut judge =
        Command::new("python3").args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    judge.stdin.take().unwrap().write_all(json!(cases).to_string().as_bytes()).unwrap();
    let output = judge.wait_with_output().unwrap();
    assert!(output.status.success());
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// Checks that SALib finds the same indices: exactly those for our points, and for its own points others within the intervals.
fn agrees(of: &str, ours: &Explained, same: &Value, other: &Value) {
    for found in &ours.parameters {
        let at: usize = found.name[1..].parse().unwrap();
        for (index, name) in [(found.first_order, "S1"), (found.total, "ST")] {
            let number = |of: &Value, name: &str| of[name][at].as_f64().unwrap();
            let (theirs, elsewhere) = (number(same, name), number(other, name));
            assert!((index.estimate - theirs).abs() < 1e-9, "{of}, {} of {}: {index:?} {theirs}", name, found.name);
            let is_within = (index.lower..=index.upper).contains(&elsewhere);
            assert!(is_within, "{of}, {name} of {}: {index:?}, SALib {elsewhere}", found.name);
        }
    }
}

#[test]
fn salib_finds_the_same_indices_of_three_functions_and_a_scenario() {
    const PAIRS: usize = 1024;
    let study = Study::of(paracosm::catalogue().find("pedestrian-crossing").unwrap()).open("friction").budget(20);
    let study = study.build().unwrap();
    let log = Log::new(study.clone(), [].into(), None, Vec::new());
    let campaign = Campaign::new(&study).unwrap();
    let robustness = |points: &[Vec<f64>]| {
        let tests: Vec<_> =
            points.iter().map(|point| study.space().decode(&study.space().at_quantiles(point))).collect();
        let mut found = Vec::new();
        let watch = |trial: &paracosm::campaign::Trial| {
            found.push(log.scales().objective(trial).unwrap());
            Ok(())
        };
        campaign.run_tests(&tests, 0, watch).unwrap();
        found
    };
    let each = |f: fn(&[f64]) -> f64| -> Quantity<'static> {
        Box::new(move |points| points.iter().map(|point| f(point)).collect())
    };
    let cases: [(&str, usize, Quantity); 4] = [
        (
            "Ishigami",
            3,
            each(|u| {
                let [x, y, z] = [0, 1, 2].map(|at| PI * (2.0 * u[at] - 1.0));
                libm::sin(x) + 7.0 * libm::sin(y) * libm::sin(y) + 0.1 * z * z * z * z * libm::sin(x)
            }),
        ),
        (
            "G",
            4,
            each(|u| {
                let factor = |(x, a): (&f64, f64)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a);
                u.iter().zip([0.0, 1.0, 4.5, 9.0]).map(factor).product()
            }),
        ),
        ("a corner", 3, each(|u| f64::from(u8::from(u[0] + u[1] < 0.6)))),
        ("pedestrian-crossing", 3, Box::new(robustness)),
    ];
    // The values at our points, in the order of SALib: both tests of a pair, with the mixed ones between them.
    let mut ours = Vec::new();
    let mut same = Vec::new();
    for (_, parameters, quantity) in &cases {
        let factors: Vec<Factor> =
            (0..*parameters).map(|at| Factor { name: format!("x{at}"), coordinates: 1 }).collect();
        let seen = RefCell::new(Vec::new());
        let mut evaluate = |points: &[Vec<f64>]| {
            let values = quantity(points);
            for row in values.chunks(parameters + 2) {
                seen.borrow_mut().extend([&row[..1], &row[2..], &row[1..2]].concat());
            }
            Ok(values.into_iter().map(|value| Some(vec![value])).collect())
        };
        ours.push(explain(&factors, PAIRS, 5, &mut evaluate).unwrap().explained.remove(0));
        same.push(json!({"parameters": parameters, "values": seen.into_inner()}));
    }
    let asked: Vec<Value> = cases.iter().map(|case| json!({"parameters": case.1, "pairs": PAIRS})).collect();
    let Some(samples) = judged("sample", &asked) else { return };
    let other = cases.iter().zip(samples).map(|((_, parameters, quantity), sample)| {
        let points: Vec<Vec<f64>> = serde_json::from_value(sample).unwrap();
        json!({"parameters": parameters, "values": quantity(&points)})
    });
    let other = judged("analyze", &other.collect::<Vec<_>>()).unwrap();
    let same = judged("analyze", &same).unwrap();
    for (((of, ..), ours), (same, other)) in cases.iter().zip(&ours).zip(same.iter().zip(&other)) {
        agrees(of, ours, same, other);
    }
    // The command finds what the function does.
    let found = of_tests(&log, &campaign, 5 * PAIRS, 5, |_| Ok(())).unwrap().robustness.unwrap();
    let totals = |explained: &Explained| -> Vec<f64> {
        explained.parameters.iter().map(|indices| indices.total.estimate).collect()
    };
    assert_eq!(totals(&found), totals(&ours[3]));
}
