//! Drivers in a process of their own: the program of these tests, started again, serves them.

use crate::cameras::can_draw;
use crate::common::{fuzz, refused, stderr, stdout, succeeds, without_study};
use paracosm::engine::driver::{Driver, Fault, find};
use paracosm::engine::{Briefing, Control, Observation};
use paracosm::rpc::{SessionOptions, serve};
use serde_json::{Value, json};
use std::fs;
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// The driver `aeb`, which goes wrong in a way of its own when it sees somebody run.
struct Served {
    aeb: Box<dyn Driver>,
    options: SessionOptions,
    /// True if the driver only accelerates.
    races: bool,
}

/// The number of tests of this process.
static TESTS: AtomicU32 = AtomicU32::new(0);

impl Served {
    fn wish(&self, name: &str) -> f64 {
        self.options.settings.get(name).copied().unwrap_or(f64::INFINITY)
    }
}

impl Driver for Served {
    fn period(&self) -> f64 {
        self.aeb.period()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        // These count over all tests of the process, and over all tests of the session, as no driver should.
        let before = f64::from(TESTS.fetch_add(1, Ordering::Relaxed));
        if before >= self.wish("stale") {
            return Err(Fault::new("stale"));
        }
        self.races = before >= self.wish("tires");
        let tests = self.wish("lives") - 1.0;
        if tests < 0.0 {
            eprintln!("worn out");
            std::process::exit(9);
        }
        if tests.is_finite() {
            self.options.settings.insert("lives".into(), tests);
        }
        self.aeb.reset(briefing)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let runs = |limit: f64| observation.others.iter().any(|other| other.velocity.norm() > limit);
        // Relative to the ground, so that it is how fast somebody walks.
        if self.races || self.wish("tires").is_finite() && runs(5.0) {
            return Ok(Control { throttle: 1.0, steering: 0.0 });
        }
        if runs(self.wish("exits")) {
            eprintln!("out of fuel");
            std::process::exit(3);
        } else if runs(self.wish("hangs")) {
            sleep(Duration::from_secs(1000));
        } else if runs(self.wish("fails")) {
            return Err(Fault::new("too fast for me"));
        } else if runs(self.wish("panics")) {
            panic!("no such gear");
        } else if runs(self.wish("slips")) {
            return Ok(Control { throttle: f64::NAN, steering: 0.0 });
        } else if runs(self.wish("overdoes")) {
            return Ok(Control { throttle: 0.0, steering: -1.5 });
        }
        self.aeb.step(observation)
    }
}

/// Not a test, but what the tests start as a driver.
#[test]
fn served_to_others() {
    let Ok(address) = std::env::var("PARACOSM_ADDRESS") else { return };
    std::thread::spawn(|| {
        let _ = std::io::copy(&mut std::io::stdin(), &mut std::io::sink());
        std::process::exit(0);
    });
    let make = |options: &SessionOptions| -> Result<Box<dyn Driver>, Fault> {
        if options.settings.contains_key("gain") {
            return Err(Fault::new("no setting `gain`"));
        }
        if options.settings.contains_key("sees") {
            return find("lane-camera").unwrap().build(&[]).map_err(|error| Fault::new(error.to_string()));
        }
        Ok(Box::new(Served { aeb: find("aeb").unwrap().build(&[]).unwrap(), options: options.clone(), races: false }))
    };
    serve(TcpListener::bind(address).unwrap(), "served", make).unwrap();
}

/// The command that starts a driver. The driver prints what every program of tests prints, that it runs a test.
fn command() -> String {
    let program = std::env::current_exe().unwrap();
    format!("'{}' external_drivers::served_to_others --exact --nocapture", program.display())
}

/// A driver that was started, and where it listens.
struct Server(std::process::Child, String);

impl Server {
    fn start() -> Self {
        let address = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string();
        let mut program = Command::new(std::env::current_exe().unwrap());
        program.args(["external_drivers::served_to_others", "--exact", "--nocapture"]);
        program.env("PARACOSM_ADDRESS", &address).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
        let server = Self(program.spawn().unwrap(), format!("grpc://{address}"));
        while std::net::TcpStream::connect(&address).is_err() {
            sleep(Duration::from_millis(5));
        }
        server
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

/// The log of a campaign, without the hash of the study.
fn log(dir: &Path, out: &str) -> String {
    without_study(&whole_log(dir, out))
}

fn whole_log(dir: &Path, out: &str) -> String {
    fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap()
}

fn trials(dir: &Path, out: &str) -> Vec<Value> {
    log(dir, out).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// A campaign of a driver that is started.
fn run(dir: &Path, out: &str, options: &[&str]) -> Output {
    fuzz(dir, &[&["--driver-command", &command(), "--out", out, "--format", "table"][..], options].concat())
}

#[test]
fn a_campaign_over_grpc_has_the_log_of_the_same_driver_in_process_for_any_number_of_workers() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    succeeds(fuzz(dir, &["--driver", "aeb", "--budget", "40", "--out", "near"]));
    let server = Server::start();
    for jobs in ["1", "2"] {
        let started = format!("started-{jobs}");
        succeeds(run(dir, &started, &["--budget", "40", "--jobs", jobs]));
        assert_eq!(log(dir, &started), log(dir, "near"));
        let connected = format!("connected-{jobs}");
        succeeds(fuzz(dir, &["--driver", &server.1, "--budget", "40", "--jobs", jobs, "--out", &connected]));
        assert_eq!(log(dir, &connected), log(dir, "near"));
    }
    let study = |out: &str| -> Value {
        serde_json::from_str(&fs::read_to_string(dir.join(out).join("campaign.json")).unwrap()).unwrap()
    };
    let driver = json!({"name": server.1, "settings": {}, "external": {"by": "address", "timeout": 60.0}});
    assert_eq!(study("connected-1")["driver"], driver);
    let driver = json!({"name": command(), "settings": {}, "external": {"by": "command", "timeout": 60.0}});
    assert_eq!(study("started-1")["driver"], driver);
}

#[test]
fn a_driver_that_sees_has_the_same_log_over_grpc() {
    if !can_draw() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let few = ["follow-leader", "--budget", "4", "--set", "leader_speed=12", "--open", "fog"];
    succeeds(fuzz(dir, &[&few[..], &["--driver", "lane-camera", "--out", "near"]].concat()));
    for jobs in ["1", "2"] {
        let far = ["--set", "driver.sees=1", "--jobs", jobs];
        succeeds(run(dir, jobs, &[&few[..], &far].concat()));
        assert_eq!(log(dir, jobs), log(dir, "near"));
    }
}

/// What a driver does when somebody runs at more than 8.8 m/s, and what is said of it.
const BAD: [(&str, &str); 6] = [
    ("exits", "the process ended without an answer (exit status: 3); its last words: "),
    ("hangs", "the driver did not answer within 2 s"),
    ("fails", "too fast for me"),
    ("panics", "the driver panicked: no such gear"),
    ("slips", "the driver's throttle is NaN, expected -1 to 1"),
    ("overdoes", "the driver's steering is -1.5, expected -1 to 1"),
];

#[test]
fn a_driver_that_goes_wrong_ends_that_test_with_an_error_that_says_how_and_no_other() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    succeeds(fuzz(dir, &["--driver", "aeb", "--budget", "12", "--out", "near"]));
    let near = trials(dir, "near");
    for (way, says) in BAD {
        let set = format!("driver.{way}=8.8");
        // Others have to answer in time, however busy this machine is.
        let timeout = if way == "hangs" { "2" } else { "60" };
        let options = |jobs| ["--budget", "12", "--set", &set, "--timeout", timeout, "--jobs", jobs];
        let (one, many) = (format!("{way}-1"), format!("{way}-3"));
        succeeds(run(dir, &one, &options("1")));
        let mut errors = 0;
        for (trial, near) in trials(dir, &one).iter().zip(&near) {
            if trial["verdict"] == "error" {
                errors += 1;
                assert!(trial["test"]["speed"].as_f64().unwrap() > 8.8, "{trial}");
                assert!(trial["error"].as_str().unwrap().contains(says), "{trial}");
            } else {
                assert_eq!(trial, near);
            }
        }
        assert!(errors > 0, "{way}");
        succeeds(run(dir, &many, &options("3")));
        assert_eq!(log(dir, &one), log(dir, &many), "{way}");
    }
    let broken = trials(dir, "exits-1").iter().position(|trial| trial["verdict"] == "error").unwrap();
    assert!(trials(dir, "exits-1")[broken]["error"].as_str().unwrap().contains("out of fuel"));
    let replay = fuzz(dir, &["replay", "exits-1", &broken.to_string(), "--trust", "--format", "table"]);
    assert!(stdout(&succeeds(replay)).contains("out of fuel"));
}

#[test]
fn a_test_is_not_held_against_a_driver_that_earlier_tests_have_worn_out() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    succeeds(fuzz(dir, &["--driver", "aeb", "--budget", "20", "--out", "near"]));
    let worn = succeeds(run(dir, "worn", &["--budget", "20", "--set", "driver.lives=3", "--jobs", "2"]));
    assert_eq!(log(dir, "worn"), log(dir, "near"));
    // Nobody may take such a driver for a sound one.
    let note = "tests ended in an error, and had a result when a new process or a new connection ran them again: the program may keep something from test to test";
    assert!(stdout(&worn).contains(note), "{}", stdout(&worn));
    // It keeps a number in the process, where a new session does not help.
    let stale = succeeds(run(dir, "stale", &["--budget", "20", "--set", "driver.stale=3", "--jobs", "2"]));
    assert_eq!(log(dir, "stale"), log(dir, "near"));
    assert!(stdout(&stale).contains(note), "{}", stdout(&stale));
    let sound = succeeds(run(dir, "sound", &["--budget", "20"]));
    assert!(!stdout(&sound).contains("ran them again"), "{}", stdout(&sound));
}

#[test]
fn a_campaign_whose_driver_answers_otherwise_by_now_is_continued_with_a_note() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    succeeds(run(dir, "out", &["--budget", "12"]));
    let whole = whole_log(dir, "out");
    let log = dir.join("out/trials.jsonl");
    let first: Vec<&str> = whole.lines().take(6).collect();
    let resume = || stdout(&succeeds(run(dir, "out", &["--budget", "12", "--resume"])));
    fs::write(&log, first.join("\n") + "\n").unwrap();
    assert!(!resume().contains("ends otherwise"));
    assert_eq!(whole_log(dir, "out"), whole);
    // To the campaign, a log of another driver is a log that was edited.
    fs::write(&log, first.join("\n").replace("trace_hash\":\"", "trace_hash\":\"0") + "\n").unwrap();
    let notes = resume();
    assert!(notes.contains("test 5 ends otherwise now than before the campaign was continued"), "{notes}");
}

#[test]
fn shrink_trusts_no_test_that_fails_only_after_other_tests_of_the_process() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    // From its second test on, a process only accelerates. In its first test, it does so only for somebody who runs.
    fs::write(dir.join("t.csv"), "speed,distance\n9,60\n").unwrap();
    let calm = ["--spec", "always (car.throttle < 1)"];
    succeeds(run(dir, "out", &[&["--tests", "t.csv", "--set", "driver.tires=1"], &calm[..]].concat()));
    assert_eq!(trials(dir, "out")[0]["verdict"], "fail");
    let says = "fails in a process that ran other tests, and not in a new process";
    refused(&fuzz(dir, &["shrink", "out", "0", "--trust", "--save", "saved.json"]), &["test 0", says]);
    assert!(!dir.join("saved.json").exists());
}

#[test]
fn the_output_of_a_driver_is_kept_beside_the_campaign_and_shown_to_those_who_ask() {
    let dir = tempfile::tempdir().unwrap();
    let printed = succeeds(run(dir.path(), "quiet", &["--budget", "2", "--jobs", "1"]));
    assert!(!stderr(&printed).contains("running 1 test"), "{}", stderr(&printed));
    let log = fs::read_to_string(dir.path().join("quiet/driver.log")).unwrap();
    assert!(log.lines().any(|line| line == "running 1 test"), "{log}");
    let printed = succeeds(run(dir.path(), "verbose", &["--budget", "2", "--jobs", "1", "-v"]));
    assert!(stderr(&printed).contains("driver: running 1 test"), "{}", stderr(&printed));
    let replayed = |more: &str| stderr(&succeeds(fuzz(dir.path(), &["replay", "quiet", "1", "--trust", more])));
    assert!(replayed("-v").contains("driver: running 1 test") && !replayed("-q").contains("running 1 test"));
    // A driver of this process prints nothing.
    succeeds(fuzz(dir.path(), &["--budget", "2", "--out", "own"]));
    let beside = ["driver.log", "commands.json"].map(|file| dir.path().join("own").join(file).exists());
    assert_eq!(beside, [false, false]);
}

#[test]
fn a_replay_from_another_folder_runs_the_command_where_the_campaign_ran_it_if_it_is_trusted() {
    let dir = tempfile::tempdir().unwrap();
    let [home, elsewhere] = ["home", "elsewhere"].map(|name| dir.path().join(name));
    [&home, &elsewhere].into_iter().for_each(|folder| fs::create_dir(folder).unwrap());
    fs::write(home.join("driver.sh"), format!("exec {}\n", command())).unwrap();
    let driver = ["--driver-command", "sh driver.sh"];
    succeeds(fuzz(&home, &[&driver[..], &["--budget", "2", "--out", "out"]].concat()));
    let record = fs::read_to_string(home.join("out/commands.json")).unwrap();
    assert_eq!(record, "{\"run_in\":\"..\"}\n");
    succeeds(fuzz(&home, &[&["replay", "out", "1"], &driver[..]].concat()));
    succeeds(fuzz(&elsewhere, &["replay", "../home/out", "1", "--trust"]));
    // A stranger's folder may name any folder, so a command that the user gives runs where the user is.
    let here = fuzz(&elsewhere, &[&["replay", "../home/out", "1"], &driver[..]].concat());
    let home = home.canonicalize().unwrap();
    let note = format!("the commands of this campaign ran in {}; if you trust the campaign, --trust", home.display());
    refused(&here, &[&note, "driver.sh"]);
    // The folder may have moved with everything in it.
    fs::rename(&home, dir.path().join("moved")).unwrap();
    succeeds(fuzz(&elsewhere, &["replay", "../moved/out", "1", "--trust"]));
}

#[cfg(target_os = "linux")]
#[test]
fn a_campaign_runs_in_a_folder_whose_name_is_no_text() {
    use std::os::unix::ffi::OsStrExt;
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join(std::ffi::OsStr::from_bytes(b"no-text-\xff"));
    fs::create_dir(&folder).unwrap();
    succeeds(fuzz(&folder, &["--driver-command", &command(), "--budget", "1", "--out", "../out"]));
    assert!(dir.path().join("out/trials.jsonl").exists() && !dir.path().join("out/commands.json").exists());
}

#[test]
fn a_campaign_of_a_driver_is_continued_replayed_and_shrunk() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    succeeds(run(dir, "whole", &["--budget", "40", "--set", "driver.latency=0.2"]));
    // As if it had been killed in the middle of a line.
    let whole = whole_log(dir, "whole");
    let lines: Vec<&str> = whole.lines().collect();
    fs::create_dir(dir.join("half")).unwrap();
    fs::copy(dir.join("whole/campaign.json"), dir.join("half/campaign.json")).unwrap();
    fs::write(dir.join("half/trials.jsonl"), format!("{}\n{{\"index\"", lines[..17].join("\n"))).unwrap();
    succeeds(run(dir, "half", &["--budget", "40", "--set", "driver.latency=0.2", "--resume"]));
    assert_eq!(whole_log(dir, "half"), whole);
    let other = run(dir, "half", &["--budget", "40", "--set", "driver.latency=0.3", "--resume"]);
    refused(&other, &["half"]);
    let failing = trials(dir, "whole").iter().position(|trial| trial["verdict"] == "fail").expect("one is too late");
    succeeds(fuzz(dir, &["replay", "whole", &failing.to_string(), "--trust"]));
    succeeds(fuzz(dir, &["shrink", "whole", &failing.to_string(), "--trust"]));
}

#[test]
fn latency_lets_controls_take_effect_later() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let worst = |latency: &str| {
        let set = format!("driver.latency={latency}");
        succeeds(run(dir, latency, &["--budget", "60", "--set", &set]));
        trials(dir, latency).iter().filter(|trial| trial["verdict"] == "fail").count()
    };
    assert!(worst("0") < worst("0.5"), "half a second is 8 m");
}

#[test]
fn what_is_no_driver_is_refused_before_the_first_test() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let unused = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let unused = format!("grpc://{unused}");
    let (served, exits) = (command(), "sh -c 'echo no licence >&2; exit 4'");
    let cases: &[(&[&str], &[&str])] = &[
        (&["--driver", &unused], &[&unused, "no process listens at this address; start the driver first"]),
        (&["--driver", "grpc://localhost"], &["grpc://localhost", "no port", "grpc://127.0.0.1:50051"]),
        (&["--driver", "http://localhost:1"], &["does not begin with grpc://", "expected grpc://HOST:PORT"]),
        (&["--driver", "grpc://no-such-host.invalid:1"], &["the name of the host is not known; check the address"]),
        (&["--driver-command", ""], &["--driver-command", "found no program"]),
        (&["--driver-command", "sh 'x"], &["--driver-command", "a quote is not closed"]),
        (&["--driver-command", "no-such-program x"], &["cannot start `no-such-program`"]),
        (
            &["--driver-command", exits],
            &["the process ended before it listened at PARACOSM_ADDRESS (exit status: 4)", "no licence"],
        ),
        (&["--driver-command", "sleep 1000", "--timeout", "0.3"], &["does not listen at PARACOSM_ADDRESS within 3 s"]),
        (&["--driver-command", &served, "--set", "driver.gain=1"], &["no setting `gain`"]),
        (
            &["--driver-command", &served, "--set", "driver.latency=-1"],
            &["driver.latency is -1, expected a number from 0"],
        ),
        (&["--driver-command", &served, "--set", "driver.seed=0.5"], &["driver.seed is 0.5, expected a whole number"]),
        (&["--driver-command", &served, "--timeout", "0"], &["time-out is 0"]),
        (&["--driver-command", &served, "--driver", "aeb"], &["--driver"]),
        (&["--driver", "aeb", "--timeout", "3"], &["--timeout applies to", "--driver-command"]),
    ];
    for (arguments, says) in cases {
        refused(&fuzz(dir, &[arguments, &["--out", "out"][..]].concat()), says);
        assert!(!dir.join("out").exists(), "{arguments:?} wrote something");
    }
}

#[test]
fn a_driver_that_never_drives_is_given_up() {
    let dir = tempfile::tempdir().unwrap();
    let given_up = run(dir.path(), "out", &["--set", "driver.fails=0.1", "--open", "speed=1..10"]);
    refused(&given_up, &["first 50 tests ended in an error", "too fast for me"]);
}

#[test]
fn an_interrupt_does_not_wait_for_a_driver_that_hangs() {
    let dir = tempfile::tempdir().unwrap();
    let options = ["--driver-command", &command(), "--set", "driver.hangs=8.8", "--timeout", "1000", "--jobs", "1"];
    let mut campaign = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let campaign = campaign.args(options).current_dir(dir.path()).stdout(Stdio::null()).stderr(Stdio::piped());
    let campaign = campaign.spawn().unwrap();
    let logged =
        || fs::read_to_string(dir.path().join("paracosm-out/trials.jsonl")).unwrap_or_default().lines().count();
    // Until it is as far as it comes.
    let mut last = 0;
    while last == 0 || logged() > last {
        last = logged();
        sleep(Duration::from_millis(500));
    }
    assert!(Command::new("kill").args(["-INT", &campaign.id().to_string()]).status().unwrap().success());
    let says = format!("the first {last} trials are safe");
    refused(&campaign.wait_with_output().unwrap(), &["interrupted", &says, "--resume"]);
}
