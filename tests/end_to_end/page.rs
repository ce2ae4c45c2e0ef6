//! The report page, in a real browser.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a browser sees on a page; `None` if there is no browser, with a note.
fn seen(page: &Path, task: &str) -> Option<Value> {
    browsed("page.mjs", &[page.to_str().unwrap(), task])
}

/// What a script sees in a browser; `None` if there is no browser, with a note.
pub fn browsed(script: &str, arguments: &[&str]) -> Option<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let modules = root.join("target/npm");
    let browser = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].into_iter().find(|path| Path::new(path).exists());
    let (Some(browser), true) = (browser, modules.join("node_modules/playwright-core").exists()) else {
        eprintln!("SKIPPED: no Chromium, or no playwright-core in target/npm");
        return None;
    };
    let output = Command::new("node")
        .arg(root.join("tests/end_to_end").join(script))
        .args([modules.as_path(), Path::new(browser)])
        .args(arguments)
        .output()
        .expect("node starts");
    assert!(output.status.success(), "{}", stderr(&output));
    Some(serde_json::from_slice(&output.stdout).expect("the script prints JSON"))
}

/// Writes the page of a campaign, and returns its path.
fn report(dir: &Path, options: &[&str]) -> PathBuf {
    let printed = stdout(&succeeds(fuzz(dir, &[&["report", "out", "--out", "page.html"], options].concat())));
    assert_eq!(printed, "page.html\n");
    dir.join("page.html")
}

/// The tests of the campaign.
fn trials(dir: &Path) -> Vec<Value> {
    let log = fs::read_to_string(dir.join("out/trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_page_opens_without_any_request_and_plays_the_worst_test() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--strategy", "halton", "--budget", "500", "--out", "out", "-q"]));
    let page = report(dir.path(), &[]);
    let size = fs::metadata(&page).unwrap().len();
    assert!(size < 1_500_000, "the page of 500 tests has {size} bytes");
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.contains("default-src 'none'"), "the page forbids requests");
    let again = fs::read(report(dir.path(), &[])).unwrap();
    assert!(again == text.as_bytes(), "the same campaign has the same page");
    let Some(seen) = seen(&page, "use") else { return };
    assert_eq!(seen["requests"].as_array().unwrap().len(), 1, "only the page itself: {}", seen["requests"]);
    assert_eq!((&seen["errors"], &seen["dialogs"]), (&serde_json::json!([]), &serde_json::json!(0)));
    assert_eq!(seen["headline"], "✗ 65 of 500 tests fail (13.0 %), 435 pass.");
    let summary = stdout(&succeeds(fuzz(dir.path(), &["map", "out", "--format", "json", "-q"])));
    assert_eq!(serde_json::from_str::<Value>(&summary).unwrap()["tests"], 500);
    assert_eq!(seen["plays"], true);
    assert!(seen["test"].as_str().unwrap().contains("fail"), "{}", seen["test"]);
    assert!(seen["contact"].as_u64().unwrap() > 40, "the contact is marked: {}", seen["contact"]);
    assert!(seen["plots"].as_u64().unwrap() >= 3, "{}", seen["plots"]);
    assert_eq!((&seen["changes"], &seen["returns"]), (&true.into(), &true.into()), "axes change the map");
    assert_eq!((&seen["all"], &seen["cleared"]), (&"500 tests".into(), &"500 tests".into()));
    let brushed = seen["brushed"].as_str().unwrap();
    assert!(brushed.ends_with("of 500 tests") && !brushed.starts_with("500"), "{brushed}");
    assert_eq!(seen["failing"], "65 of 500 tests");
    let pointed = seen["pointed"].as_str().unwrap();
    assert!(
        pointed.starts_with("test 2: fail; no-collision -17.7") && pointed.contains("progress undecided"),
        "{pointed}"
    );
    assert!(seen["byMatrix"].as_str().unwrap().contains("est 2"), "{}", seen["byMatrix"]);
    assert_eq!((&seen["ids"], &seen["state"]), (&json!([]), &json!("playing")), "{seen}");
    assert_eq!(seen["paused"], "paused", "the space bar pauses the run that was just opened");
    assert_eq!((&seen["run"][1], &seen["focus"]), (&json!("ended"), &json!("Next failing test")));
    let fails = trials(dir.path()).iter().filter(|trial| trial["verdict"] == "fail").count();
    assert_eq!((&seen["spots"], &seen["bySpot"]), (&json!(fails), &seen["spot"]));
    // The second failing test of the campaign.
    let failing = trials(dir.path()).into_iter().filter(|trial| trial["verdict"] == "fail").nth(1).unwrap();
    for named in [&seen["focused"], &seen["byStripKey"]] {
        let name = format!("est {}: ", failing["index"]);
        assert!(named.as_str().unwrap().contains(&name), "{named}, expected {name}");
    }
    assert!(seen["byKeyboard"].as_str().unwrap().contains("fail"), "{}", seen["byKeyboard"]);
}

#[test]
fn names_of_strangers_are_text_on_the_page() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(
        dir.path().join("system.sh"),
        r#"while read -r line; do i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"robustness\":{\"a\":-1}}"; done"#,
    )
    .unwrap();
    let hostile = "</script><img src=x onerror=alert(1)><b>\u{202e}\"'&";
    let unit = serde_json::to_string(&hostile).unwrap();
    let space = format!(
        "parameter = [{{ name = \"x\", interval = [-1, 1], unit = {unit} }}, {{ name = \"y\", interval = [0, 1], unit = \"{}\" }}]\n",
        "L".repeat(10_000)
    );
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let command = format!("sh system.sh '{}'", hostile.replace('\'', ""));
    let system = ["--system", &command, "--space", "SPACE.toml", "--budget", "8", "--out", "out", "-q"];
    succeeds(fuzz(dir.path(), &system));
    let page = report(dir.path(), &[]);
    let text = fs::read_to_string(&page).unwrap();
    assert!(!text.contains("<img"), "the page has the name as an element");
    let Some(seen) = seen(&page, "look") else { return };
    assert_eq!((&seen["dialogs"], &seen["elements"]), (&0.into(), &0.into()), "{seen}");
    assert_eq!(seen["errors"], serde_json::json!([]));
    assert!(seen["text"].as_str().unwrap().contains("<img src=x onerror=alert(1)>"), "{}", seen["text"]);
    assert!(seen["headline"].as_str().unwrap().contains("8 of 8 tests fail"), "{}", seen["headline"]);
    // A name that turns the text, or that has 10,000 letters, changes nothing beside it.
    assert!(!seen["text"].as_str().unwrap().contains('\u{202e}'));
    let heights: Vec<f64> = serde_json::from_value(seen["heights"].clone()).unwrap();
    assert!(heights[0] < 900.0 && heights[1..].iter().all(|height| *height < 400.0), "{heights:?}");
    assert!(seen["width"].as_f64().unwrap() <= 0.0, "{}", seen["width"]);
    assert_eq!(seen["twice"], serde_json::json!([]));
}

#[test]
fn a_page_keeps_to_its_size_and_says_what_is_left_out() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--strategy", "halton", "--budget", "1500", "--out", "out", "-q"]));
    for megabytes in ["0.22", "0.3", "1"] {
        let page = report(dir.path(), &["--max-mb", megabytes]);
        let size = fs::metadata(&page).unwrap().len() as f64;
        assert!(size <= 1e6 * megabytes.parse::<f64>().unwrap(), "{megabytes} MB: {size} bytes");
    }
    report(dir.path(), &["--max-mb", "0.25"]);
    if let Some(seen) = seen(&dir.path().join("page.html"), "look") {
        assert!(seen["text"].as_str().unwrap().contains("left out"), "{}", seen["text"]);
    }
    let small = fuzz(dir.path(), &["report", "out", "--out", "small.html", "--max-mb", "0.01"]);
    refused(&small, &["the page needs at least", "allow more with --max-mb"]);
    assert!(!dir.path().join("small.html").exists());
    refused(&fuzz(dir.path(), &["report", "out", "--out", "page.txt"]), &["--out page.txt: expected FILE.html"]);
    refused(&fuzz(dir.path(), &["report", "out", "--max-mb", "0"]), &["--max-mb is 0, expected a number above 0"]);
}

#[test]
fn a_page_shows_what_changed_since_a_baseline() {
    let dir = tempfile::tempdir().unwrap();
    for (driver, out) in [("aeb", "before"), ("planner", "out")] {
        succeeds(fuzz(dir.path(), &["--driver", driver, "--budget", "100", "--out", out, "-q"]));
    }
    let page = report(dir.path(), &["--baseline", "before"]);
    let Some(seen) = seen(&page, "look") else { return };
    let text = seen["text"].as_str().unwrap();
    assert!(text.contains("new failures: 1") && text.contains("mended: 7"), "{text}");
    assert!(text.contains("Since pedestrian-crossing, driver aeb: 1 new failure, 7 mended, "), "{text}");
}

/// The findings of a page by their labels.
pub fn findings(page: &Path) -> Vec<Value> {
    let script = "import base64, gzip, json, re, sys\ntext = open(sys.argv[1]).read()\n\
        part = re.search('id=\"document\">([^<]*)', text)[1]\n\
        print(json.dumps(json.loads(gzip.decompress(base64.b64decode(part)))['findings']))";
    let output = Command::new("python3").args(["-c", script]).arg(page).output().expect("python3 starts");
    serde_json::from_slice(&succeeds(output).stdout).expect("JSON")
}

#[test]
fn a_page_gives_no_sensitivity_to_a_parameter_without_effect() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--open", "fog", "--driver", "aeb", "--budget", "100", "--out", "out", "-q"]));
    let all = findings(&report(dir.path(), &[]));
    let sensitivity = all.iter().find(|finding| finding["label"] == "sensitivity").unwrap();
    let rows: Vec<&str> =
        sensitivity["table"]["rows"].as_array().unwrap().iter().map(|row| row[0].as_str().unwrap()).collect();
    assert!(!rows.is_empty() && !rows.contains(&"fog"), "{rows:?}");
    let says = "Left out, because they had no effect: fog. The model gives fog a total share of ";
    let lines = sensitivity["lines"].as_array().unwrap();
    assert!(lines.iter().any(|line| line.as_str().unwrap().starts_with(says)), "{lines:?}");
}

#[test]
fn a_page_has_the_sensitivity_the_blame_and_the_suspects_as_tables() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "200", "--out", "out", "-q"]));
    succeeds(fuzz(dir.path(), &["blame", "out", "-q"]));
    let all = findings(&report(dir.path(), &[]));
    let of = |label: &str| {
        all.iter().find(|finding| finding["label"] == label).unwrap_or_else(|| panic!("{label}: {all:?}"))
    };
    // The table is the table of the command.
    let command = stdout(&succeeds(fuzz(dir.path(), &["sensitivity", "out"])));
    for row in of("sensitivity")["table"]["rows"].as_array().unwrap() {
        let cells: Vec<&str> = row.as_array().unwrap().iter().map(|cell| cell.as_str().unwrap()).collect();
        assert!(command.lines().any(|line| cells.iter().all(|cell| line.contains(cell))), "{cells:?}\n{command}");
    }
    let blame: Value = serde_json::from_slice(&fs::read(dir.path().join("out/blame.json")).unwrap()).unwrap();
    for row in of("blame")["table"]["rows"].as_array().unwrap() {
        let driver = row[0].as_str().unwrap();
        assert_eq!(row[1], blame["prevents"][driver].to_string(), "{driver}");
    }
    fs::remove_dir_all(dir.path().join("out")).unwrap();
    // Without a failure there is nobody to blame.
    succeeds(fuzz(dir.path(), &["--set", "speed=0.5", "--set", "distance=20", "--out", "out", "-q"]));
    succeeds(fuzz(dir.path(), &["blame", "out", "-q"]));
    let none = findings(&report(dir.path(), &[]));
    assert!(none.iter().all(|finding| finding["label"] != "blame"), "{none:?}");
    fs::remove_dir_all(dir.path().join("out")).unwrap();
    // The system fails for one pair of values.
    let pair = r#"case $line in *'"a":"x","b":"u"'*) r=-1;; *) r=1;; esac"#;
    let answer = r#"i=${line#*:}; i=${i%%,*}; echo "{\"index\":$i,\"robustness\":{\"above\":$r}}""#;
    fs::write(dir.path().join("system.sh"), format!("while read -r line; do {pair}; {answer}; done\n")).unwrap();
    let choice = |name: &str, levels: &str| format!("[[parameter]]\nname = \"{name}\"\nchoice = [{levels}]\n");
    let space = choice("a", "\"x\", \"y\"") + &choice("b", "\"u\", \"v\"") + &choice("c", "\"p\", \"q\"");
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let system = ["--system", "sh system.sh"];
    let run = ["run", "--space", "SPACE.toml", "--k", "3", "--budget", "8", "--locate", "--out", "out", "-q"];
    succeeds(fuzz(dir.path(), &[&run[..], &system].concat()));
    let all = findings(&report(dir.path(), &system));
    for label in ["suspects", "located"] {
        let found = all.iter().find(|finding| finding["label"] == label).unwrap_or_else(|| panic!("{label}: {all:?}"));
        assert_eq!(found["table"]["rows"][0][0], "a x, b u", "{found}");
    }
}

#[test]
fn a_page_has_the_results_of_an_audit_of_the_same_scenario_and_driver() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "30", "--out", "out", "-q"]));
    let audit = ["audit", "pedestrian-crossing", "--tests", "out", "--tests", "halton:12", "--format", "json", "-q"];
    let printed = fuzz(dir.path(), &[&audit[..], &["--mutants", "10", "--screen", "16"]].concat());
    let printed: Value = serde_json::from_str(&stdout(&succeeds(printed))).unwrap();
    let all = findings(&report(dir.path(), &["--audit", "paracosm-audit"]));
    let found = all.iter().find(|finding| finding["label"] == "audit").unwrap();
    let rows = found["table"]["rows"].as_array().unwrap();
    for (row, suite) in rows.iter().zip([&printed, &printed["others"][0]]) {
        let mutants = &suite["mutants"];
        assert_eq!((row[0].as_str(), row[1].as_str()), (suite["suite"].as_str(), Some(&*suite["tests"].to_string())));
        let score = format!(": {} of {}", mutants["killed"], mutants["counted"]);
        assert!(row[3].as_str().unwrap().ends_with(&score), "{row}");
        let hole: f64 = row[2].as_str().unwrap().parse().unwrap();
        assert!((hole - suite["hole"]["lower"].as_f64().unwrap()).abs() < 1e-5, "{row}");
    }
    assert_eq!(rows.len(), 2);
    let witness = printed["others"][0]["witness"]["failing"].as_u64().expect("12 tests leave a hole that matters");
    assert!(found["lines"].to_string().contains(&format!("and fails in {witness} of 64 tests there")), "{found}");
    succeeds(fuzz(dir.path(), &["--driver", "planner", "--budget", "3", "--out", "other", "-q"]));
    let report = |folder: &str, audit: &str| fuzz(dir.path(), &["report", folder, "--audit", audit, "--out", "x.html"]);
    let says = "the audit in paracosm-audit is about `pedestrian-crossing, driver aeb`, and the campaign about `pedestrian-crossing, driver planner`";
    refused(&report("other", "paracosm-audit"), &[says]);
    refused(&report("out", "nowhere"), &["nowhere/audit.json"]);
}

#[test]
fn a_page_of_an_untrusted_driver_has_no_runs_and_says_so() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "40", "--out", "out", "-q"]));
    let file = dir.path().join("out/campaign.json");
    let mut study: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    study["driver"] = serde_json::json!({"name": "touch ran", "settings": {},
        "external": {"by": "command", "timeout": 5.0}});
    fs::write(&file, study.to_string()).unwrap();
    let log = dir.path().join("out/trials.jsonl");
    fs::write(&log, crate::common::without_study(&fs::read_to_string(&log).unwrap())).unwrap();
    let written = succeeds(fuzz(dir.path(), &["report", "out", "--out", "page.html"]));
    assert!(
        stderr(&written).contains("the page has no runs: the file names the command `touch ran`"),
        "{}",
        stderr(&written)
    );
    assert!(!dir.path().join("ran").exists());
    let Some(seen) = seen(&dir.path().join("page.html"), "look") else { return };
    assert!(seen["text"].as_str().unwrap().contains("There are none: the file names the command"), "{}", seen["text"]);
}

#[test]
fn an_infinite_robustness_and_a_single_parameter_are_shown() {
    let dir = tempfile::tempdir().unwrap();
    let always = "true or (car.speed > 1)";
    succeeds(fuzz(dir.path(), &["--set", "distance=20", "--budget", "30", "--spec", always, "--out", "out"]));
    let Some(seen) = seen(&report(dir.path(), &[]), "look") else { return };
    assert_eq!(seen["errors"], Value::Array(Vec::new()));
    let text = seen["text"].as_str().unwrap();
    assert!(text.contains("infinite in test"), "{text}");
    let says = "There is no failure map: a map needs two open continuous parameters, and this study has one.";
    assert!(text.contains(says), "{text}");
}

/// The sources of the page's program and its build, which the repository has. Without npm they cannot be compared.
#[test]
fn the_bundle_is_what_its_sources_give() {
    let web = Path::new(env!("CARGO_MANIFEST_DIR")).join("report/web");
    let copy = tempfile::tempdir().unwrap();
    for file in ["package.json", "package-lock.json", "tsconfig.json", "vite.config.ts", "hash.mjs", ".npmrc"] {
        fs::copy(web.join(file), copy.path().join(file)).unwrap();
    }
    fs::create_dir(copy.path().join("src")).unwrap();
    for file in fs::read_dir(web.join("src")).unwrap() {
        let file = file.unwrap().path();
        fs::copy(&file, copy.path().join("src").join(file.file_name().unwrap())).unwrap();
    }
    let npm = |arguments: &[&str]| Command::new("npm").args(arguments).current_dir(copy.path()).output();
    let installed = npm(&["ci", "--no-audit", "--no-fund", "--loglevel=error"]);
    // A lock file that does not belong to the package is a mistake of ours, on every machine.
    assert!(
        !installed.as_ref().is_ok_and(|output| stderr(output).contains("EUSAGE")),
        "{}",
        stderr(&installed.unwrap())
    );
    if !installed.is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: npm does not install what the page is built with");
        return;
    }
    let built = npm(&["run", "build"]).unwrap();
    assert!(built.status.success(), "{}{}", stdout(&built), stderr(&built));
    for file in ["page.js", "page.css", "page.js.sha256", "page.css.sha256"] {
        let [ours, theirs] =
            [web.as_path(), copy.path()].map(|folder| fs::read(folder.join("dist").join(file)).unwrap());
        assert!(ours == theirs, "report/web/dist/{file} is not what `npm run build` gives");
    }
}
