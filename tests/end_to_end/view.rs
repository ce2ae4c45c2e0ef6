//! The viewer: a page that plays any test and runs further tests, in a real browser and against requests of strangers.

use crate::common::{fuzz, refused, succeeds};
use crate::page::browsed;
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
        let reply = String::from_utf8_lossy(&reply).into_owned();
        let status = reply.split(' ').nth(1).unwrap().parse().unwrap();
        (status, reply.split_once("\r\n\r\n").map(|(_, body)| body.to_owned()).unwrap_or_default())
    }

    fn tried(&self, numbers: &Value) -> (u16, String) {
        self.asked(&format!("POST /{}/try", self.secret()), &[], &numbers.to_string())
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

/// The names and the contents of all files in a folder.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.display().to_string(), fs::read(path).unwrap())).collect()
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
    assert!(seen["row"].as_str().unwrap().starts_with("Test "), "{}", seen["row"]);
    assert_eq!(seen["middle"], r#"{"speed":5.25,"distance":32.5}"#);
    assert_eq!(viewing.ended(), Some(0));
    assert!(files(&dir.path().join("out")) == before, "a viewer writes nothing");
}

#[test]
fn strangers_get_nothing_from_a_viewer() {
    let dir = tempfile::tempdir().unwrap();
    succeeds(fuzz(dir.path(), &["--budget", "10", "--out", "out", "-q"]));
    let viewing = Viewing::of(dir.path(), &[]);
    let secret = viewing.secret().to_owned();
    let (status, page) = viewing.asked(&format!("GET /{secret}/"), &[], "");
    assert!(status == 200 && page.contains("connect-src 'self'") && page.contains("default-src 'none'"), "{status}");
    let run = format!("GET /{secret}/run/3");
    assert_eq!(viewing.asked(&run, &[&format!("Origin: http://{}", viewing.host())], "").0, 200);
    for line in ["Host: evil.example", "Host: 127.0.0.1", "Origin: http://evil.example", "Origin: null"] {
        assert_eq!(viewing.asked(&run, &[line], ""), (403, String::new()), "{line}");
    }
    let shorter = &secret[..secret.len() - 1];
    for path in ["/", "/run/3", "/progress", &format!("/{shorter}/"), &format!("/{shorter}0/run/3"), "/../"] {
        assert_eq!(viewing.asked(&format!("GET {path}"), &[], "").0, 403, "{path}");
    }
    for path in
        ["../campaign.json", "..%2fcampaign.json", "campaign.json", "run/../../campaign.json", "run/x", "run/-1", "try"]
    {
        assert_eq!(viewing.asked(&format!("GET /{secret}/{path}"), &[], ""), (404, String::new()), "{path}");
    }
    assert_eq!(viewing.asked(&format!("DELETE /{secret}/"), &[], "").0, 405);
    // Wrong questions are answered with the reason.
    for (numbers, says) in [
        (json!([1, 2, 3]), "found 3 numbers, expected 2"),
        (json!([1, 600]), "parameter `distance`: found 600, expected a number in [5, 60]"),
    ] {
        let (status, why) = viewing.tried(&numbers);
        assert!(status == 422 && why.contains(says), "{status} {why}");
    }
    assert_eq!(viewing.tried(&json!({"speed": 3})).0, 400);
    let (status, why) = viewing.asked(&format!("GET /{secret}/run/10"), &[], "");
    assert_eq!((status, why.as_str()), (422, "the campaign has 10 tests, and no test 10"));
    let long = format!("[{}1]", "1,".repeat(1 << 16));
    assert_eq!(viewing.asked(&format!("POST /{secret}/try"), &[], &long).0, 413);
    assert_eq!(viewing.ended(), Some(0));
    refused(&fuzz(dir.path(), &["view", "nothing"]), &["nothing/campaign.json"]);
}

#[test]
fn a_campaign_that_still_runs_grows_on_the_page() {
    let dir = tempfile::tempdir().unwrap();
    let campaign = ["grid-traffic", "--budget", "2000", "--jobs", "1", "--out", "out", "-q"];
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
    assert!(counts.is_sorted() && counts[0] < counts[2] && counts[2] < 2000, "{counts:?}");
    assert!(seen["told"].as_str().unwrap().contains("new test"), "{seen}");
    assert_eq!(seen["open"], 1);
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
    let (status, ran) = viewing.tried(&json!([0.25]));
    let ran: Value = serde_json::from_str(&ran).unwrap();
    assert_eq!(
        (status, &ran["verdict"], &ran["test"]["x"], &ran["run"]),
        (200, &json!("fail"), &json!(0.25), &Value::Null)
    );
    assert_eq!(viewing.ended(), Some(0));
}
