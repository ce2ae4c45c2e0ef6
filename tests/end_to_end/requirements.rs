//! For the test engineer: requirements from a file, requirement by test, JUnit's reports, the design domain.

use crate::common::{fuzz, golden, refused, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const REQUIREMENTS: &str = r#"[[requirement]]
id = "no-collision"
text = "The car touches nobody."
source = "UN R157, 5.2.5"
severity = "critical"

[[requirement]]
id = "comfort"
text = "In the first second the car brakes gently."
source = "REQ-12 <draft> & more"
severity = "minor"
formula = "always[0,1] (car.acceleration > -3)"
unit = "m/s^2"
scale = 3

[[requirement]]
id = "horn"
text = "The car sounds its horn."

[odd.visibility]
varied = ["fog", "light"]

[odd.surface]
fixed = "dry asphalt"
excluded = "snow and ice: no winter tyres"
"#;

const OPEN: [&str; 6] = ["--open", "fog", "--open", "light", "--open", "lanes=2,4"];

/// A campaign of that many tests in `dir/out`, with the file of requirements.
fn campaign(dir: &Path, budget: &str, more: &[&str]) -> String {
    fs::write(dir.join("requirements.toml"), REQUIREMENTS).unwrap();
    let asked = ["--requirements", "requirements.toml", "--out", "out", "-q", "--budget", budget];
    stdout(&succeeds(fuzz(dir, &[&asked[..], &OPEN, more].concat())))
}

fn trials(dir: &Path, out: &str) -> Vec<Value> {
    let log = fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_requirement_may_speak_of_the_time_between_samples() {
    let dir = tempfile::tempdir().unwrap();
    let ask = |out: &str, more: &str| {
        fs::write(dir.path().join("r.toml"), format!("[[requirement]]\nid = \"soon\"\n{more}\n")).unwrap();
        fuzz(dir.path(), &["--requirements", "r.toml", "--out", out, "-q", "--budget", "4"])
    };
    let formula = "formula = \"always[0,0.125] (car.speed < 16)\"";
    refused(&ask("out", formula), &["r.toml, line 3", "0.125 s is not a multiple"]);
    refused(&ask("out", &format!("{formula}\ntime = \"dens\"")), &["r.toml, line 4", "`dens`", "`dense`"]);
    let square = "formula = \"always (car.speed * car.speed < 16)\"\ntime = \"dense\"";
    refused(&ask("out", square), &["r.toml, line 3", "not a piecewise linear function"]);
    succeeds(ask("out", &format!("{formula}\ntime = \"dense\"")));
    for trial in trials(dir.path(), "out") {
        let robustness = trial["robustness"]["soon"].as_f64().unwrap();
        assert_eq!(
            trial["verdict"] == "fail",
            robustness < 0.0 || trial["robustness"]["no-collision"].as_f64() < Some(0.0)
        );
        assert!((-1.0..0.0).contains(&robustness), "{trial}");
    }
    let study: Value = serde_json::from_slice(&fs::read(dir.path().join("out/campaign.json")).unwrap()).unwrap();
    assert_eq!((&study["requirements"][2]["time"], &study["requirements"][0]["time"]), (&json!("dense"), &Value::Null));
    succeeds(fuzz(dir.path(), &["replay", "out", "1"]));
}

#[test]
fn a_formula_may_use_signals_that_are_measured_on_request_and_the_run_stays_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let spec = "always (car.clearance_to_pedestrian > 0.5 and car.time_to_collision > 0.3)";
    succeeds(fuzz(dir.path(), &["--budget", "12", "--out", "plain", "-q"]));
    succeeds(fuzz(dir.path(), &["--budget", "12", "--out", "asked", "--spec", spec, "-q"]));
    let [plain, asked] = ["plain", "asked"].map(|out| trials(dir.path(), out));
    for (plain, asked) in plain.iter().zip(&asked) {
        assert_eq!(plain["robustness"]["no-collision"], asked["robustness"]["no-collision"]);
        assert_eq!(plain["ticks"], asked["ticks"]);
        let [all, spec] = [&plain["robustness"]["no-collision"], &asked["robustness"]["spec-1"]].map(Value::as_f64);
        assert!(spec.unwrap() <= all.unwrap() - 0.5 + 1e-9, "the pedestrian is the only other body: {asked}");
    }
    // The file of the study asks for the same signals.
    succeeds(fuzz(dir.path(), &["replay", "asked", "2"]));
    let slip = fuzz(dir.path(), &["--out", "slip", "--spec", "always (car.clearence_to_bicycle > 1)"]);
    let definition = "`car.clearance_to_bicycle`: as car.clearance, from bicycles only; infinite without one (m)";
    refused(&slip, &["did you mean `car.clearance_to_bicycle`?", definition]);
}

#[test]
fn a_file_adds_requirements_and_says_where_they_come_from() {
    let dir = tempfile::tempdir().unwrap();
    let summary = campaign(dir.path(), "12", &["--format", "table", "--spec", "G (car.speed < 30)"]);
    for text in
        ["; critical; UN R157, 5.2.5\n", "comfort: violated in 0 tests; at worst 3 m/s^2 (test 0); minor; REQ-12"]
    {
        assert!(summary.contains(text), "{text}: {summary}");
    }
    assert!(summary.contains("design domain         surface: fixed: dry asphalt; excluded: snow and ice"), "{summary}");
    assert!(summary.contains("visibility: varied by fog 0..1 (no effect), light 0..1 (no effect)"), "{summary}");
    let study: Value =
        serde_json::from_str(&fs::read_to_string(dir.path().join("out/campaign.json")).unwrap()).unwrap();
    let ids: Vec<&Value> = study["requirements"].as_array().unwrap().iter().map(|stated| &stated["id"]).collect();
    assert_eq!(ids, ["no-collision", "progress", "comfort", "horn", "spec-1"]);
    let expected = json!({"id": "no-collision", "text": "The car touches nobody.", "unit": "m", "scale": 5.0,
        "formula": "always not (car.clearance <= 0)", "source": "UN R157, 5.2.5", "severity": "critical"});
    assert_eq!(study["requirements"][0], expected);
    let comfort = &study["requirements"][2];
    assert_eq!([&comfort["unit"], &comfort["scale"]], [&json!("m/s^2"), &json!(3.0)]);
    // What is asked is evaluated, and the run itself is the one of a campaign that asks nothing more.
    let plain = [&["--out", "plain", "-q", "--budget", "12"][..], &OPEN].concat();
    succeeds(fuzz(dir.path(), &plain));
    for (plain, asked) in trials(dir.path(), "plain").iter().zip(&trials(dir.path(), "out")) {
        assert_eq!(plain["trace_hash"], asked["trace_hash"]);
        assert!(asked["robustness"]["comfort"].is_number() && asked["robustness"].get("horn").is_none(), "{asked}");
    }
    succeeds(fuzz(dir.path(), &["replay", "out", "3"]));
    let other = fuzz(dir.path(), &[&["--out", "out", "--resume", "--budget", "12"][..], &OPEN].concat());
    refused(&other, &["different campaign", "`odd`", "snow and ice"]);
    let said =
        stderr(&fuzz(dir.path(), &[&["--requirements", "requirements.toml", "--budget", "1"][..], &OPEN].concat()));
    assert!(said.contains("requirement `horn` is not judged"), "{said}");
}

#[test]
fn what_is_wrong_with_a_file_is_named_with_its_line() {
    let dir = tempfile::tempdir().unwrap();
    let cases: [(&str, &str, &[&str]); 12] = [
        ("no-collision", "no collision", &["line 2", "`no collision`", "expected a word"]),
        ("severity = \"minor\"", "sevrity = \"minor\"", &["line 11", "`sevrity`", "did you mean `severity`"]),
        ("car.acceleration", "car.aceleration", &["line 12", "column 14", "did you mean `car.acceleration`"]),
        ("[0,1]", "[0,1.0001]", &["line 12", "comfort"]),
        ("scale = 3", "scale = -3", &["line 14", "`scale` is -3", "above 0"]),
        ("scale = 3", "scale = nan", &["line 14", "`scale` is NaN"]),
        ("\"horn\"", "\"comfort\"", &["line 17", "`comfort` stands twice"]),
        ("id = \"comfort\"", "id = \"progress\"", &["line 8", "`progress` is the scenario's", "a formula"]),
        ("severity = \"critical\"", "unit = \"km\"", &["line 2", "`no-collision` is the scenario's", "a unit"]),
        ("\"fog\", ", "\"fogg\", ", &["line 21", "no `fogg`", "did you mean `fog`"]),
        ("\"fog\", ", "\"friction\", ", &["line 21", "`friction` is not varied but 0.8", "--open friction"]),
        ("fixed = \"dry asphalt\"\nexcluded = ", "about = ", &["line 24", "`about`", "`excluded`"]),
    ];
    let refuses = |text: &str, says: &[&str]| {
        fs::write(dir.path().join("bad.toml"), text).unwrap();
        let asked = ["--requirements", "bad.toml", "--budget", "3"];
        refused(&fuzz(dir.path(), &[&asked[..], &OPEN].concat()), &[&["bad.toml"], says].concat());
    };
    for (from, to, says) in cases {
        assert!(REQUIREMENTS.contains(from), "{from}");
        refuses(&REQUIREMENTS.replacen(from, to, 1), says);
    }
    refuses("[odd.people]\nvaried = []\n", &["line 1", "`people`", "expected `varied`, `fixed` or `excluded`"]);
    refuses("[odd.people", &["line 1"]);
    refused(&fuzz(dir.path(), &["--requirements", "nowhere.toml"]), &["nowhere.toml"]);
}

#[test]
fn trace_shows_requirement_by_test_and_what_is_untested() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), "20", &[]);
    golden("trace.txt", &stdout(&succeeds(fuzz(dir.path(), &["trace", "out", "--format", "table"]))));
    let told = succeeds(fuzz(dir.path(), &["trace", "out", "--csv", "matrix.csv", "--format", "json"]));
    let told: Value = serde_json::from_str(&stdout(&told)).unwrap();
    // Counted again from the log, in which every test came to its situation.
    let trials = trials(dir.path(), "out");
    for traced in told["requirements"].as_array().unwrap() {
        let id = traced["id"].as_str().unwrap();
        let worths =
            || trials.iter().enumerate().filter_map(|(i, trial)| Some((i, trial["robustness"].get(id)?.as_f64()?)));
        let violated: Vec<usize> = worths().filter(|(_, worth)| *worth < 0.0).map(|(i, _)| i).collect();
        assert_eq!(traced["failed"], violated.len(), "{id}");
        assert_eq!(traced["violated_in"], json!(violated), "{id}");
        assert_eq!(traced["passed"], worths().count() - violated.len(), "{id}");
        let worst = worths().min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(
            traced["worst"],
            worst.map_or(Value::Null, |(i, worth)| json!({"index": i, "robustness": worth})),
            "{id}"
        );
    }
    let rows = fs::read_to_string(dir.path().join("matrix.csv")).unwrap();
    assert!(rows.starts_with("requirement,text,source,severity,formula,unit,tests,passed,failed,"), "{rows}");
    assert_eq!(rows.lines().count(), 5);
    // A column for each test, in which the requirements that it violates have failed.
    let mut matrix = csv::Reader::from_reader(rows.as_bytes());
    let tests: Vec<String> = matrix.headers().unwrap().iter().skip(14).map(str::to_owned).collect();
    assert_eq!(tests, (0..20).map(|i| format!("test.{i}")).collect::<Vec<_>>());
    for (row, traced) in matrix.records().zip(told["requirements"].as_array().unwrap()) {
        let row = row.unwrap();
        let failed: Vec<usize> = (0..20).filter(|i| &row[14 + i] == "failed").collect();
        assert_eq!(json!(failed), traced["violated_in"], "{row:?}");
    }
    fs::write(dir.path().join("matrix.csv"), "older").unwrap();
    succeeds(fuzz(dir.path(), &["trace", "out", "--csv", "matrix.csv", "--format", "json"]));
    assert_eq!(fs::read_to_string(dir.path().join("matrix.csv")).unwrap(), rows);
    refused(&fuzz(dir.path(), &["trace", "out", "--csv", "matrix.txt"]), &["matrix.txt", ".csv"]);
    refused(&fuzz(dir.path(), &["trace", "nowhere"]), &["nowhere"]);
}

#[test]
fn the_example_of_a_file_is_one() {
    let dir = tempfile::tempdir().unwrap();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/requirements.toml");
    let asked = ["--requirements", example.to_str().unwrap(), "--open", "fog", "--budget", "4", "--out", "out", "-q"];
    succeeds(fuzz(dir.path(), &asked));
    let told = stdout(&succeeds(fuzz(dir.path(), &["trace", "out", "--format", "table"])));
    for text in [
        "calm-start    4       0",
        "the requirement has no formula",
        "fixed: dry asphalt",
        "varied by speed 0.5..10 m/s",
    ] {
        assert!(told.contains(text), "{text}: {told}");
    }
}

#[test]
fn no_word_of_a_report_promises_what_tests_cannot() {
    let dir = tempfile::tempdir().unwrap();
    let summary = campaign(dir.path(), "8", &["--junit", "--format", "table"]);
    let trace = stdout(&succeeds(fuzz(dir.path(), &["trace", "out", "--format", "table"])));
    let junit = fs::read_to_string(dir.path().join("out/junit.xml")).unwrap();
    for text in [summary, trace, junit] {
        let text = text.to_lowercase();
        assert!(!["safe", "complian", "certif", "conform"].iter().any(|word| text.contains(word)), "{text}");
    }
}

/// A system that passes, fails, breaks and passes again, over a space that says what of the design domain it is about.
fn system(dir: &Path) {
    let answers = r#"while read -r line; do
i=${line#*:}; i=${i%%,*}
case $i in
1) echo "{\"index\":1,\"robustness\":{\"above\":-0.25,\"far\":2}}" ;;
2) printf '%s\n' '{"index":2,"error":"it said <no> & \"never\"\nand left"}' ;;
*) echo "{\"index\":$i,\"robustness\":{\"above\":1,\"far\":2}}" ;;
esac
done
"#;
    fs::write(dir.join("system.sh"), answers).unwrap();
    let space = "[[parameter]]\nname = \"x\"\ninterval = [-1, 1]\n\n[odd.load]\nvaried = [\"x\"]\n";
    fs::write(dir.join("SPACE.toml"), space).unwrap();
    let requirements =
        "[[requirement]]\nid = \"above\"\ntext = \"It stays above.\"\nunit = \"m\"\nscale = 2\nseverity = \"major\"\n";
    fs::write(dir.join("requirements.toml"), requirements).unwrap();
}

const SYSTEM: [&str; 10] = [
    "--system",
    "sh system.sh",
    "--space",
    "SPACE.toml",
    "--requirements",
    "requirements.toml",
    "--budget",
    "4",
    "--out",
    "out",
];

#[test]
fn a_system_that_judges_itself_is_held_to_the_requirements_of_the_file() {
    let dir = tempfile::tempdir().unwrap();
    system(dir.path());
    let summary = stdout(&succeeds(fuzz(dir.path(), &[&SYSTEM[..], &["--format", "table", "-q"]].concat())));
    assert!(summary.contains("above: violated in 1 test; at worst -0.25 m (test 1); major\n"), "{summary}");
    assert!(summary.contains("design domain         load: varied by x -1..1\n"), "{summary}");
    let told = stdout(&succeeds(fuzz(dir.path(), &["trace", "out", "--format", "table"])));
    assert!(told.starts_with("system sh system.sh: 4 tests, 1 of them broke or could not be built\n"), "{told}");
    assert!(told.contains("  far                   (no text: the system judges it)\n"), "{told}");
    let space = fs::read_to_string(dir.path().join("SPACE.toml")).unwrap();
    fs::write(dir.path().join("SPACE.toml"), space.replace("[\"x\"]", "[\"y\"]")).unwrap();
    refused(&fuzz(dir.path(), &SYSTEM), &["SPACE.toml", "line 6", "`load`", "no `y`"]);
    fs::write(dir.path().join("SPACE.toml"), &space).unwrap();
    let twice = fs::read_to_string(dir.path().join("requirements.toml")).unwrap() + "[odd.a]\nfixed = \"b\"\n";
    fs::write(dir.path().join("requirements.toml"), twice).unwrap();
    refused(&fuzz(dir.path(), &SYSTEM), &["requirements.toml", "[odd]", "one file only"]);
}

/// The opening tags of a document with their attributes, unescaped; checks that it is well-formed as far as we write
/// XML.
fn elements(document: &str) -> Vec<(String, Vec<(String, String)>)> {
    let body = document.strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n").expect("it says what it is");
    let (mut open, mut found) = (Vec::new(), Vec::new());
    let mut rest = body;
    while let Some((before, after)) = rest.split_once('<') {
        assert!(!before.contains(['>', '"']) || before.trim().is_empty(), "{before}");
        let (tag, after) = after.split_once('>').expect("a tag ends");
        rest = after;
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name));
            continue;
        }
        let (name, mut attributes) =
            tag.trim_end_matches('/').split_once(' ').unwrap_or((tag.trim_end_matches('/'), ""));
        let mut all = Vec::new();
        while let Some((key, value)) = attributes.trim_start().split_once("=\"") {
            let (value, others) = value.split_once('"').expect("a value ends");
            assert!(!value.contains(['<', '>', '\n', '\t']), "{value}");
            all.push((key.to_owned(), unescaped(value)));
            attributes = others;
        }
        if !tag.ends_with('/') {
            open.push(name.to_owned());
        }
        found.push((name.to_owned(), all));
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} {rest}");
    found
}

fn unescaped(text: &str) -> String {
    let (mut plain, mut rest) = (String::new(), text);
    while let Some((before, after)) = rest.split_once('&') {
        let (name, after) = after.split_once(';').expect("a reference ends");
        plain.push_str(before);
        plain.push(match name {
            "amp" => '&',
            "lt" => '<',
            "gt" => '>',
            "quot" => '"',
            "apos" => '\'',
            code => char::from_u32(code.strip_prefix('#').unwrap().parse().unwrap()).unwrap(),
        });
        rest = after;
    }
    plain + rest
}

fn attribute<'a>(element: &'a (String, Vec<(String, String)>), name: &str) -> &'a str {
    element.1.iter().find(|(key, _)| key == name).map_or("", |(_, value)| value)
}

#[test]
fn a_junit_report_has_a_test_case_for_every_trial() {
    let dir = tempfile::tempdir().unwrap();
    system(dir.path());
    succeeds(fuzz(dir.path(), &[&SYSTEM[..], &["--junit", "-q"]].concat()));
    let report = fs::read_to_string(dir.path().join("out/junit.xml")).unwrap();
    let all = elements(&report);
    let error = all.iter().find(|element| element.0 == "error").unwrap();
    assert!(attribute(error, "message").ends_with("it said <no> & \"never\""), "{error:?}");
    let (_, description) = report.split_once("<error ").and_then(|(_, rest)| rest.split_once('>')).unwrap();
    let (description, _) = description.split_once("</error>").unwrap();
    assert!(unescaped(description).contains("it said <no> & \"never\"\nand left"), "{description}");
    let program = env!("CARGO_BIN_EXE_paracosm-fuzz");
    golden("junit.xml", &report.replace(program, "paracosm-fuzz"));
    // Of a scenario that cannot always be built, counted again from the log.
    let cut_in = ["cut-in", "--budget", "40", "--out", "cut", "--junit", "-q"];
    succeeds(fuzz(dir.path(), &cut_in));
    let all = elements(&fs::read_to_string(dir.path().join("cut/junit.xml")).unwrap());
    let of = |name: &str| all.iter().filter(|element| element.0 == name).count();
    let trials = trials(dir.path(), "cut");
    let ended = |verdict: &str| trials.iter().filter(|trial| trial["verdict"] == verdict).count();
    let counts = [("failures", "failure", "fail"), ("errors", "error", "error"), ("skipped", "skipped", "invalid")];
    for (total, element, verdict) in counts {
        assert_eq!(of(element), ended(verdict), "{verdict}");
        assert_eq!(attribute(&all[0], total), ended(verdict).to_string());
        assert_eq!(attribute(&all[1], total), ended(verdict).to_string());
    }
    assert!(ended("fail") > 0 && ended("invalid") > 0 && of("testcase") == 40);
}

#[test]
fn regressions_report_to_ci_as_well() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "40", "--out", "out", "-q"]));
    let trials = trials(dir.path(), "out");
    let worth = |index: &usize| trials[*index]["robustness"]["no-collision"].as_f64().unwrap();
    let failing = (0..trials.len()).filter(|index| trials[*index]["verdict"] == "fail");
    let mildest = failing.max_by(|a, b| worth(a).total_cmp(&worth(b))).unwrap().to_string();
    succeeds(fuzz(dir.path(), &["shrink", "out", &mildest, "--budget", "1", "--save", "a.json", "-q"]));
    let regression: Value = serde_json::from_str(&fs::read_to_string(dir.path().join("a.json")).unwrap()).unwrap();
    let edited = |name: &str, edit: &dyn Fn(&mut Value)| {
        let mut other = regression.clone();
        edit(&mut other);
        fs::write(dir.path().join(name), other.to_string()).unwrap();
    };
    edited("expected-to-pass.json", &|file| file["expect"] = "pass".into());
    edited("mended.json", &|file| {
        file["study"]["driver"]["settings"]["latency"] = 0.0.into();
        file["trace_hash"] = Value::Null;
    });
    edited("other-trace.json", &|file| file["trace_hash"] = "00".into());
    // How it ends, and how many failures, errors and skipped tests the report has.
    let cases = [
        ("a", 1, [0, 0, 0]),
        ("expected-to-pass", 1, [1, 0, 0]),
        ("mended", 0, [0, 0, 1]),
        ("other-trace", 2, [0, 1, 0]),
    ];
    for (name, status, counts) in cases {
        let (file, report) = (format!("{name}.json"), format!("{name}.xml"));
        let ended = fuzz(dir.path(), &["replay", &file, "--junit", &report, "--fail-on-violation"]);
        assert_eq!(ended.status.code(), Some(status), "{name}: {}{}", stdout(&ended), stderr(&ended));
        let all = elements(&fs::read_to_string(dir.path().join(&report)).unwrap());
        let found = ["failures", "errors", "skipped"].map(|count| attribute(&all[1], count).parse::<usize>().unwrap());
        assert_eq!(found, counts, "{name}");
    }
    let replay = ["replay", "a.json", "--junit", "report.xml"];
    succeeds(fuzz(dir.path(), &replay));
    let all = elements(&fs::read_to_string(dir.path().join("report.xml")).unwrap());
    assert_eq!(attribute(&all[1], "name"), "a.json");
    assert!(
        all.iter().any(|element| attribute(element, "name") == "expected" && attribute(element, "value") == "fail")
    );
    let replays = all.iter().filter(|element| attribute(element, "name") == "replay");
    assert!(replays.map(|element| attribute(element, "value")).eq(["paracosm-fuzz replay a.json"]));
    // A report is replaced by the next, in which every file has a case of its own.
    succeeds(fuzz(dir.path(), &["replay", "a.json", "expected-to-pass.json", "--junit", "report.xml"]));
    let all = elements(&fs::read_to_string(dir.path().join("report.xml")).unwrap());
    let cases: Vec<_> = all.iter().filter(|element| element.0 == "testcase").collect();
    let names: Vec<String> = cases.iter().map(|case| attribute(case, "name").to_owned()).collect();
    assert_eq!(names, ["a.json", "expected-to-pass.json"]);
    // What was simulated is not what it took.
    assert!(all.iter().all(|element| attribute(element, "time").is_empty()));
    let seconds = all.iter().filter(|element| attribute(element, "name") == "simulated_seconds");
    assert!(seconds.map(|element| attribute(element, "value").parse::<f64>().unwrap()).all(|seconds| seconds > 0.0));
    let own = ["replay", "a.json", "--junit", "out/campaign.json"];
    refused(&fuzz(dir.path(), &own), &["a file that belongs to campaigns"]);
    // No regression file is taken for one.
    let swallowed = ["replay", "--junit", "a.json", "mended.json"];
    refused(&fuzz(dir.path(), &swallowed), &["--junit a.json", "expected FILE.xml"]);
    refused(&fuzz(dir.path(), &["replay", "out", "1", "--junit", "b.xml"]), &["--junit is for regression files"]);
}
