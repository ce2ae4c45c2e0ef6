//! The viewer: a page that plays any test and runs further tests, in a real browser and against requests of strangers.

use crate::cameras::can_draw;
use crate::common::{files, fuzz, refused, stdout, succeeds};
use crate::page::browsed;
use base64::Engine;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A viewer that runs, with the address of its page.
struct Viewing {
    child: Child,
    address: String,
}

impl Viewing {
    fn of(dir: &Path, options: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
        let program = program.args(["view", "out", "-q"]).args(options).current_dir(dir).stdout(Stdio::piped());
        let mut child = program.spawn().expect("the program starts");
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        Self { child, address: address.trim().to_owned() }
    }

    fn host(&self) -> &str {
        self.address.strip_prefix("http://").unwrap().split('/').next().unwrap()
    }

    fn secret(&self) -> &str {
        self.address.trim_end_matches('/').rsplit('/').next().unwrap()
    }

    /// The status and the body of the answer to a request with these lines, and with the host of the viewer unless a line names another one.
    fn asked(&self, first: &str, lines: &[&str], body: &str) -> (u16, String) {
        let (status, body) = self.answered(first, lines, body);
        (status, String::from_utf8(body).unwrap())
    }

    fn answered(&self, first: &str, lines: &[&str], body: &str) -> (u16, Vec<u8>) {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        let mut request = format!("{first} HTTP/1.1\r\nConnection: close\r\nContent-Length: {}\r\n", body.len());
        if !lines.iter().any(|line| line.starts_with("Host:")) {
            request.push_str(&format!("Host: {}\r\n", self.host()));
        }
        lines.iter().for_each(|line| request.push_str(&format!("{line}\r\n")));
        request.push_str(&format!("\r\n{body}"));
        stream.write_all(request.as_bytes()).unwrap();
        let mut reply = Vec::new();
        stream.read_to_end(&mut reply).unwrap();
        let head = reply.windows(4).position(|end| end == b"\r\n\r\n").expect("an answer has a head");
        let status = String::from_utf8_lossy(&reply[..head]).split(' ').nth(1).unwrap().parse().unwrap();
        (status, reply[head + 4..].to_vec())
    }

    /// The status and the body of the answer to a question of the page.
    fn told(&self, question: &Value) -> (u16, Vec<u8>) {
        self.answered(&format!("POST /{}/ask", self.secret()), &[], &question.to_string())
    }

    /// The answer to a question of the page, in JSON.
    fn tells(&self, question: &Value) -> Value {
        let (status, body) = self.told(question);
        assert_eq!(status, 200, "{question}: {}", String::from_utf8_lossy(&body));
        serde_json::from_slice(&body).unwrap()
    }

    /// The reason why a question of the page has no answer.
    fn refuses(&self, question: &Value) -> String {
        let (status, body) = self.told(question);
        assert_eq!(status, 422, "{question}");
        String::from_utf8(body).unwrap()
    }

    /// Interrupts the viewer; returns its exit status.
    fn ended(mut self) -> Option<i32> {
        let sent = Command::new("kill").args(["-INT", &self.child.id().to_string()]).status();
        assert!(sent.expect("kill is there").success());
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(20) {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.code();
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        panic!("the viewer does not end");
    }
}

impl Drop for Viewing {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The verdict and the trace hash of a test as the program runs it.
fn by_program(dir: &Path, values: &str) -> (String, String) {
    let values: Value = serde_json::from_str(values).unwrap();
    let set = values.as_object().unwrap().iter().map(|(name, value)| format!("{name}={value}"));
    let options = set.flat_map(|value| ["--set".to_owned(), value]).collect::<Vec<_>>();
    let options: Vec<&str> = ["--out", "one", "-q"].into_iter().chain(options.iter().map(String::as_str)).collect();
    succeeds(fuzz(dir, &options));
    let trial: Value = serde_json::from_str(&fs::read_to_string(dir.join("one/trials.jsonl")).unwrap()).unwrap();
    fs::remove_dir_all(dir.join("one")).unwrap();
    ["verdict", "trace_hash"].map(|key| trial[key].as_str().unwrap().to_owned()).into()
}

#[test]
fn a_click_on_the_map_and_a_dragged_value_run_tests_that_end_as_the_program_says() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "40", "--out", "out", "-q"]));
    let before = files(&dir.path().join("out"));
    let viewing = Viewing::of(dir.path(), &[]);
    let Some(seen) = browsed("view.mjs", &[&viewing.address, "use"]) else { return };
    assert_eq!((&seen["errors"], &seen["foreign"]), (&json!([]), &json!(0)), "{seen}");
    assert_eq!(seen["plays"], true);
    for tried in [&seen["clicked"], &seen["dragged"]] {
        let (verdict, hash) = by_program(dir.path(), tried["values"].as_str().unwrap());
        assert!(tried["verdict"].as_str().unwrap().ends_with(&verdict), "{tried}");
        assert_eq!(tried["hash"], hash, "{tried}");
    }
    assert_ne!(seen["clicked"]["values"], seen["dragged"]["values"]);
    assert_eq!((&seen["run"][0], &seen["run"][2]), (&json!("new"), &seen["clicked"]["hash"]), "{seen}");
    assert!(seen["blame"].as_str().unwrap().contains("prevent"), "{seen}");
    assert!(seen["shrunk"].as_str().unwrap().contains("violates no-collision already when"), "{seen}");
    assert!(seen["simplest"]["verdict"].as_str().unwrap().ends_with("fail"), "{seen}");
    if can_draw() {
        assert_eq!(seen["film"], json!([640, 360, 0]), "{seen}");
    }
    assert_eq!(seen["above"], true);
    assert!(seen["row"].as_str().unwrap().starts_with("Test "), "{}", seen["row"]);
    assert_eq!(seen["middle"], r#"{"speed":5.25,"distance":32.5}"#);
    // The map is 64 times as large as at first, around the middle.
    let zoomed: BTreeMap<String, f64> = serde_json::from_str(seen["zoomed"].as_str().unwrap()).unwrap();
    for (name, middle, width) in [("speed", 5.25, 9.5 / 64.0), ("distance", 32.5, 55.0 / 64.0)] {
        assert!((zoomed[name] - middle).abs() <= width / 2.0, "{name}: {zoomed:?}");
        let digits = zoomed[name].to_string().split_once('.').map_or(0, |(_, digits)| digits.len());
        assert!((2..=5).contains(&digits), "{name}: {zoomed:?}");
    }
    assert_eq!(viewing.ended(), Some(0));
    assert!(files(&dir.path().join("out")) == before, "a viewer writes nothing");
}

#[test]
fn the_buttons_of_a_failing_test_answer_as_the_commands_do() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "60", "--out", "out", "-q"]));
    let viewing = Viewing::of(dir.path(), &[]);
    let printed = |command: &[&str]| serde_json::from_str::<Value>(&stdout(&fuzz(dir.path(), command))).unwrap();
    let blame = printed(&["blame", "out", "--format", "json"]);
    let failures = blame["failures"].as_array().unwrap();
    assert!(failures.len() > 3);
    for failure in failures {
        let index = &failure["index"];
        let mut blamed = viewing.tells(&json!({"blame": index}));
        let sentence = blamed["sentence"].take();
        assert!(sentence.as_str().unwrap().starts_with(failure["fault"].as_str().unwrap()), "{sentence}");
        blamed.as_object_mut().unwrap().remove("sentence");
        assert_eq!(blamed, *failure);
        let mut shrunk = viewing.tells(&json!({"shrink": index}));
        let expected = printed(&["shrink", "out", &index.to_string(), "--format", "json"]);
        // The numbers are the test again.
        let numbers = shrunk["numbers"].take();
        let played = viewing.tells(&json!({"run": numbers}));
        let simplest = &expected["trial"];
        assert_eq!((&played["test"], &played["trace_hash"]), (&simplest["test"], &simplest["trace_hash"]));
        for key in ["numbers", "search"] {
            shrunk.as_object_mut().unwrap().remove(key);
        }
        assert_eq!(shrunk, expected);
        // A new test is asked about in the same way as a test of the campaign.
        let again = viewing.tells(&json!({"blame": numbers}));
        assert_eq!(again["violates"], expected["violates"], "{again}");
    }
    let passing = (0..60).find(|index| failures.iter().all(|failure| failure["index"] != *index)).unwrap();
    for question in [json!({"shrink": passing}), json!({"blame": passing})] {
        assert!(viewing.refuses(&question).contains("expected a failing test"));
    }
}

#[test]
fn the_page_asks_for_maps_over_other_parameters_and_gets_the_maps_of_the_program() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["cut-in", "--driver", "aeb", "--budget", "60", "--out", "out", "-q"]));
    let viewing = Viewing::of(dir.path(), &[]);
    succeeds(fuzz(dir.path(), &["map", "out", "--x", "relative_speed", "--y", "lateral_speed", "-q"]));
    let csv = fs::read_to_string(dir.path().join("out/failure-map.csv")).unwrap();
    let map = viewing.tells(&json!({"map": [1, 3]}));
    assert_eq!(map["axes"], json!([1, 3]));
    let percent = base64::engine::general_purpose::STANDARD.decode(map["percent"].as_str().unwrap()).unwrap();
    let expected = csv.lines().skip(1).map(|line| {
        let probability = line.split(',').nth(2).unwrap();
        probability.parse::<f64>().map_or(255, |probability| (100.0 * probability).round() as u8)
    });
    assert_eq!(percent, expected.collect::<Vec<_>>());
    for pair in [[0, 0], [0, 4]] {
        let says = format!(
            "a map needs two different continuous coordinates, found the coordinates {} and {}",
            pair[0], pair[1]
        );
        assert_eq!(viewing.refuses(&json!({"map": pair})), says);
    }
    let Some(seen) = browsed("view.mjs", &[&viewing.address, "maps"]) else { return };
    assert_eq!((&seen["errors"], &seen["shaded"]), (&json!([]), &json!([true, true])), "{seen}");
}

#[test]
fn a_test_that_ends_otherwise_than_in_the_log_is_shown_with_a_warning() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "5", "--out", "out", "-q"]));
    let log = dir.path().join("out/trials.jsonl");
    let text = fs::read_to_string(&log).unwrap();
    let other = text.replacen("\"trace_hash\":\"", "\"trace_hash\":\"0", 1);
    fs::write(&log, other).unwrap();
    let viewing = Viewing::of(dir.path(), &[]);
    let differs = viewing.tells(&json!({"run": 0}))["differs"].to_string();
    assert!(differs.contains("The log says that test 0 ends as") && differs.contains("another trace"), "{differs}");
    assert_eq!(viewing.tells(&json!({"run": 1}))["differs"], Value::Null);
    // The page is made again for a folder that has changed, and only then.
    let page = || viewing.asked(&format!("GET /{}/", viewing.secret()), &[], "").1;
    let before = page();
    assert!(page() == before);
    succeeds(fuzz(dir.path(), &["blame", "out", "-q"]));
    assert!(page() != before);
}

#[test]
fn a_viewer_has_the_port_that_the_user_asks_for() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "out", "-q"]));
    let free = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let viewing = Viewing::of(dir.path(), &["--port", &free.to_string()]);
    assert_eq!(viewing.host(), format!("127.0.0.1:{free}"));
    let taken = fuzz(dir.path(), &["view", "out", "--port", &free.to_string()]);
    refused(&taken, &["the viewer cannot listen at 127.0.0.1"]);
}

#[test]
fn a_film_of_the_viewer_is_the_film_of_the_program() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "5", "--out", "out", "-q"]));
    let file = r#"
[camera.low]
focal_mm = 24.0
sensor_mm = 36.0
position = [2.0, 0.0, 0.4]
resolution = [64, 48]
rate = 4
[camera.rear]
focal_mm = 20.0
sensor_mm = 36.0
position = [-2.0, 0.0, 1.2]
yaw_pitch_roll = [180.0, 0.0, 0.0]
resolution = [80, 50]
rate = 5
"#;
    fs::write(dir.path().join("cameras.toml"), file).unwrap();
    let viewing = Viewing::of(dir.path(), &["--cameras", "cameras.toml"]);
    assert_eq!(viewing.tells(&json!("cameras")), json!(["low", "rear"]));
    if !can_draw() {
        return;
    }
    let (status, film) = viewing.told(&json!({"film": {"test": 2, "camera": "rear"}}));
    assert_eq!(status, 200, "{}", String::from_utf8_lossy(&film));
    let camera = ["--cameras", "cameras.toml", "--through", "rear", "--camera", "rear.mp4"];
    succeeds(fuzz(dir.path(), &[&["replay", "out", "2", "-q"], &camera[..]].concat()));
    assert!(film == fs::read(dir.path().join("rear.mp4")).unwrap(), "{} bytes", film.len());
    // The films of other tests and of another camera are others.
    for question in [json!({"test": 3, "camera": "rear"}), json!({"test": 2, "camera": "low"})] {
        assert!(viewing.told(&json!({"film": question})).1 != film);
    }
    assert_eq!(viewing.ended(), Some(0));
}

#[test]
fn a_viewer_ends_while_it_shrinks_and_stops_shrinking_once_nobody_waits() {
    let dir = tempfile::tempdir().unwrap();
    // Only one test fails, so that every step of the search is in vain.
    let slow = r#"while read -r line; do sleep 0.2; echo x >> asked; i=${line#*:}
case $line in *0.7654321*0.654321*) r=-2;; *) r=2;; esac
echo "{\"index\":${i%%,*},\"robustness\":{\"r\":$r}}"; done"#;
    fs::write(dir.path().join("system.sh"), slow).unwrap();
    let space = "parameter = [{ name = \"x\", interval = [0.123, 1] }, { name = \"y\", interval = [0.123, 1] }]\n";
    fs::write(dir.path().join("SPACE.toml"), space).unwrap();
    let system = ["--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "1", "--out", "out", "-q"];
    succeeds(fuzz(dir.path(), &system));
    let viewing = Viewing::of(dir.path(), &["--trust"]);
    let asked = || fs::read_to_string(dir.path().join("asked")).unwrap().lines().count();
    let settled = |least: usize| {
        while asked() < least {
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    // Somebody asks, and leaves.
    let mut stream = TcpStream::connect(viewing.host()).unwrap();
    let body = r#"{"shrink":[0.7654321,0.654321]}"#;
    let (secret, host) = (viewing.secret(), viewing.host());
    write!(stream, "POST /{secret}/ask HTTP/1.1\r\nHost: {host}\r\nContent-Length: {}\r\n\r\n{body}", body.len())
        .unwrap();
    settled(4);
    drop(stream);
    std::thread::sleep(Duration::from_secs(1));
    let after = asked();
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(asked(), after, "the search goes on though nobody waits");
    // Somebody asks, and the viewer is interrupted.
    let mut stream = TcpStream::connect(viewing.host()).unwrap();
    write!(stream, "POST /{secret}/ask HTTP/1.1\r\nHost: {host}\r\nContent-Length: {}\r\n\r\n{body}", body.len())
        .unwrap();
    settled(after + 2);
    assert_eq!(viewing.ended(), Some(0));
}

#[test]
fn strangers_get_nothing_from_a_viewer() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "10", "--out", "out", "-q"]));
    let viewing = Viewing::of(dir.path(), &[]);
    let secret = viewing.secret().to_owned();
    let (status, page) = viewing.asked(&format!("GET /{secret}/"), &[], "");
    assert!(status == 200 && page.contains("connect-src 'self'") && page.contains("default-src 'none'"), "{status}");
    let (ask, run) = (format!("POST /{secret}/ask"), r#"{"run":3}"#);
    assert_eq!(viewing.asked(&ask, &[&format!("Origin: http://{}", viewing.host())], run).0, 200);
    for line in ["Host: evil.example", "Host: 127.0.0.1", "Origin: http://evil.example", "Origin: null"] {
        let (status, body) = viewing.asked(&ask, &[line], run);
        assert!(status == 403 && body.starts_with("this is not the address of a page"), "{line}: {status} {body}");
    }
    let (shorter, last) = secret.split_at(secret.len() - 1);
    let other = if last == "0" { "1" } else { "0" };
    for path in ["/", "/ask", &format!("/{shorter}/"), &format!("/{shorter}{other}/ask"), "/../"] {
        assert_eq!(viewing.asked(&format!("GET {path}"), &[], "").0, 403, "{path}");
    }
    for path in ["../campaign.json", "..%2fcampaign.json", "campaign.json", "ask/../../campaign.json", "ask"] {
        let (status, body) = viewing.asked(&format!("GET /{secret}/{path}"), &[], "");
        assert!(status == 404 && body.starts_with("nothing is here"), "{path}: {status} {body}");
    }
    assert_eq!(viewing.asked(&format!("DELETE /{secret}/"), &[], "").0, 405);
    // Wrong questions are answered with the reason.
    for (question, says) in [
        (json!({"run": [1, 2, 3]}), "found 3 numbers, expected 2: one for each coordinate"),
        (json!({"run": [1, 600]}), "parameter `distance`: found 600, expected a number in [5, 60]"),
        (json!({"run": 10}), "the campaign has 10 tests, and no test 10"),
        (json!({"shrink": 10}), "the campaign has 10 tests, and no test 10"),
        (json!({"blame": [1, 2, 3]}), "found 3 numbers, expected 2: one for each coordinate"),
        (json!({"film": {"test": 3, "camera": "../front"}}), "no camera is named `../front`"),
    ] {
        assert!(viewing.refuses(&question).contains(says), "{question}: {}", viewing.refuses(&question));
    }
    for question in [json!({"run": {"speed": 3}}), json!({"run": -1}), json!("page"), json!({"film": 3}), json!(3)] {
        assert_eq!(viewing.told(&question).0, 400, "{question}");
    }
    let long = format!("{{\"run\":[{}1]}}", "1,".repeat(1 << 16));
    assert_eq!(viewing.asked(&ask, &[], &long).0, 413);
    assert_eq!(viewing.ended(), Some(0));
    refused(&fuzz(dir.path(), &["view", "nothing"]), &["nothing/campaign.json"]);
}

#[test]
fn a_campaign_that_still_runs_grows_on_the_page() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = [
        "grid-traffic",
        "--open",
        "friction",
        "--set",
        "traffic_seed=1",
        "--budget",
        "2000",
        "--jobs",
        "1",
        "--out",
        "out",
        "-q",
    ];
    let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let mut campaign = program.args(campaign).current_dir(dir.path()).stdout(Stdio::null()).spawn().unwrap();
    let log = dir.path().join("out/trials.jsonl");
    while fs::read_to_string(&log).unwrap_or_default().lines().count() < 5 {
        std::thread::sleep(Duration::from_millis(20));
    }
    let viewing = Viewing::of(dir.path(), &[]);
    let seen = browsed("view.mjs", &[&viewing.address, "follow"]);
    campaign.kill().unwrap();
    campaign.wait().unwrap();
    let Some(seen) = seen else { return };
    assert_eq!(seen["errors"], json!([]), "{seen}");
    let counts: Vec<u64> = seen["counts"].as_array().unwrap().iter().map(|count| count.as_u64().unwrap()).collect();
    assert!(counts.is_sorted() && counts[0] < counts[1] && counts[1] < 2000, "{counts:?}");
    assert!(seen["told"].as_str().unwrap().contains("new test"), "{seen}");
    assert_eq!((&seen["open"], &seen["isKept"]), (&json!(1), &json!(true)));
}

#[test]
fn a_system_has_no_world_to_show_and_its_tests_run_if_its_command_is_trusted() {
    let dir = tempfile::tempdir().unwrap();
    let answer = r#"while read -r line; do i=${line#*:}; echo "{\"index\":${i%%,*},\"robustness\":{\"r\":-2}}"; done"#;
    fs::write(dir.path().join("system.sh"), answer).unwrap();
    fs::write(dir.path().join("SPACE.toml"), "parameter = [{ name = \"x\", interval = [0, 1] }]\n").unwrap();
    succeeds(fuzz(
        dir.path(),
        &["--system", "sh system.sh", "--space", "SPACE.toml", "--budget", "3", "--out", "out", "-q"],
    ));
    refused(&fuzz(dir.path(), &["view", "out"]), &["--trust"]);
    let viewing = Viewing::of(dir.path(), &["--trust"]);
    let ran = viewing.tells(&json!({"run": [0.25]}));
    assert_eq!((&ran["verdict"], &ran["test"]["x"], &ran["run"]), (&json!("fail"), &json!(0.25), &Value::Null));
    let shrunk = viewing.tells(&json!({"shrink": [0.25]}));
    assert_eq!((&shrunk["numbers"], &shrunk["violates"]), (&json!([0.5]), &json!(["r"])), "{shrunk}");
    assert!(viewing.refuses(&json!({"blame": 0})).contains("which a reference driver cannot replace"));
    assert_eq!(viewing.ended(), Some(0));
}
