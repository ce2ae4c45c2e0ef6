//! Drivers in Python, by the package in `python/`.

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// The folder of the package.
pub fn package() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/python"))
}

/// A command that starts Python with this script and the package, as it is in this tree. None, with a note, where there
/// is no Python with what the package needs, unless somebody insists.
pub fn python(script: &Path) -> Option<String> {
    let needs = "import google.protobuf, grpc, numpy, sys; assert sys.version_info >= (3, 10)";
    let has = |name: &&str| Command::new(name).args(["-c", needs]).output().is_ok_and(|output| output.status.success());
    let Some(name) = ["python3", "python"].into_iter().find(has) else {
        let required = std::env::var_os("PARACOSM_REQUIRE_PYTHON").is_some_and(|required| required == "1");
        assert!(!required, "PARACOSM_REQUIRE_PYTHON=1: there is no Python 3.10 with grpcio, numpy and protobuf");
        eprintln!("SKIPPED: no Python 3.10 with grpcio, numpy and protobuf; pip install './python[grpc]'");
        return None;
    };
    let path = package().join("src");
    Some(format!("env 'PYTHONPATH={}' {name} '{}'", path.display(), script.display()))
}

/// The command for a driver whose class has this body.
fn driver(dir: &Path, body: &str) -> Option<String> {
    let script = dir.join("driver.py");
    let body = body.replace('\n', "\n    ");
    let text = format!(
        "import os\nimport numpy as np\nfrom paracosm import Camera, Control, Delivery, Driver, Gnss, Imu, Inaccuracy, Lidar, Mount\n\n\nclass Mine(Driver):\n    {body}\n\n\nMine().serve()\n"
    );
    fs::write(&script, text).unwrap();
    python(&script)
}

fn run(dir: &Path, command: &str, options: &[&str]) -> Output {
    fuzz(dir, &[&["--driver-command", command, "--format", "json"][..], options].concat())
}

fn trials(dir: &Path, out: &str) -> Vec<Value> {
    let log = fs::read_to_string(dir.join(out).join("trials.jsonl")).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Where the car was at the end of a test: how far to the left of the middle of the road.
fn last_y(dir: &Path, out: &str) -> f64 {
    let trace = succeeds(fuzz(dir, &["replay", out, "0", "--trust", "--trace", &format!("{out}.csv")]));
    drop(trace);
    let text = fs::read_to_string(dir.join(format!("{out}.csv"))).unwrap();
    let column = text.lines().next().unwrap().split(',').position(|name| name == "car.y");
    text.lines().last().unwrap().split(',').nth(column.expect("it says where the car is")).unwrap().parse().unwrap()
}

/// Prints the classes of the README's table with their fields.
const FIELDS: &str = "import paracosm as p, dataclasses
for name in ['Briefing', 'Observation', 'Way', 'Body', 'Control']:
    print(name, *(field.name for field in dataclasses.fields(getattr(p, name))))";

#[test]
fn the_readme_has_every_field_of_an_observation() {
    let dir = tempfile::tempdir().unwrap();
    let script = dir.path().join("fields.py");
    fs::write(&script, FIELDS).unwrap();
    let Some(command) = python(&script) else { return };
    let output = succeeds(Command::new("sh").args(["-c", &command]).output().unwrap());
    let readme = fs::read_to_string(package().join("README.md")).unwrap();
    let (mut class, mut table) = (String::new(), String::new());
    for row in readme.lines().filter(|line| line.starts_with("| `") || line.starts_with("| | `")) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        if !cells[1].is_empty() {
            class = cells[1].trim_matches('`').to_owned();
            table.push_str(&format!("\n{class}"));
        }
        cells[2].split(", ").for_each(|field| table.push_str(&format!(" {}", field.trim_matches('`'))));
    }
    assert!(!class.is_empty());
    assert_eq!(table.trim(), stdout(&output).trim());
}

#[test]
fn the_example_that_brakes_for_others_hits_fewer_than_a_car_that_does_not_brake() {
    let Some(command) = python(&package().join("examples/brake.py")) else { return };
    let dir = tempfile::tempdir().unwrap();
    let failing = |driver: [&str; 2]| {
        let options = ["pedestrian-crossing", "--budget", "100", "--format", "json", "--out", driver[1]];
        let out = stdout(&succeeds(fuzz(dir.path(), &[&driver[..], &options].concat())));
        serde_json::from_str::<Value>(&out).unwrap()["verdicts"]["fail"].as_u64().unwrap()
    };
    let [brakes, cruises] = [failing(["--driver-command", &command]), failing(["--driver", "cruise"])];
    assert!(2 * brakes < cruises, "{brakes} and {cruises} tests fail");
}

#[test]
fn thirty_lines_of_numpy_keep_a_car_in_its_lane_by_what_they_see() {
    let Some(command) = python(&package().join("examples/lane_follow.py")) else { return };
    if paracosm::render::adapter().is_err() {
        eprintln!("SKIPPED: nothing to draw with");
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let options = ["--set", "leader_speed=20", "--set", "gap=60", "--open", "approach_speed=10..20", "--budget", "3"];
    let run = |out: &str, more: &[&str]| {
        let all = [&["follow-leader", "--driver-command", &command, "--out", out][..], &options, more].concat();
        succeeds(fuzz(dir, &all));
        trials(dir, out)
    };
    for trial in run("middle", &["--jobs", "1"]) {
        assert_eq!(trial["verdict"], "pass", "{trial}");
    }
    assert_eq!(run("two", &["--jobs", "2"]), trials(dir, "middle"));
    run("right", &["--set", "driver.to_kerb=1.25"]);
    let (middle, right) = (last_y(dir, "middle"), last_y(dir, "right"));
    assert!((middle - right - 0.5).abs() < 0.1, "it goes to {middle} m, and half a metre further right to {right} m");
}

#[test]
fn what_goes_wrong_in_python_is_said_with_its_place() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    for (i, (step, says)) in [
        (
            "return Control(1.0 / (observation.time - 0.5), 0.0)",
            "the driver's throttle is -2, expected -1 to 1 at 0.000 s",
        ),
        (
            "if observation.time > 0.95: raise ValueError('lost my way')\nreturn Control()",
            "the driver gave up at 1.000 s: ValueError: lost my way (driver.py, line 10, in step)",
        ),
        ("return 0.5", "TypeError: step returned 0.5, expected a Control"),
        ("return Control('fast')", "ValueError: could not convert string to float: 'fast'"),
        (
            "import sys; sys.exit('no fuel')",
            "the driver gave up at 0.000 s: SystemExit: no fuel (driver.py, line 10, in step)",
        ),
        (
            "if observation.time > 0.5: os._exit(5)\nreturn Control()",
            "the process ended without an answer (exit status: 5)",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let step = step.replace('\n', "\n    ");
        let Some(command) = driver(dir, &format!("period = 0.1\n\ndef step(self, observation):\n    {step}")) else {
            return;
        };
        let failed = run(dir, &command, &["--budget", "1", "--out", &i.to_string()]);
        refused(&failed, &["every test ended in an error"]);
        let error = trials(dir, &i.to_string())[0]["error"].as_str().unwrap().to_owned();
        assert!(error.contains(says), "`{says}` is missing in {error}");
    }
    let Some(command) = driver(dir, "settings = {'gain': 1.0}\nstep = None") else { return };
    let set = run(dir, &command, &["--set", "driver.gian=2", "--out", "out"]);
    refused(&set, &["Mine has no setting `gian` (did you mean `gain`?)"]);
    let Some(command) = driver(dir, "lidars = {'roof': Lidar(channels=1000)}") else { return };
    refused(&run(dir, &command, &["--out", "out"]), &["an impossible sensor", "`channels` is 1000"]);
    let Some(command) = driver(dir, "camera = Camera(wide=3)") else { return };
    let broken = run(dir, &command, &["--out", "out"]);
    refused(&broken, &["the process ended before it listened", "unexpected keyword argument 'wide'"]);
}

#[test]
fn a_driver_in_python_is_told_what_it_asks_for() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    // What does not hold ends the test.
    let body = r#"
period = 0.05
others = True
settings = {"gain": 1.0, "limit": 3.0}
lidars = {"roof": Lidar(columns=90, mount=Mount(z=1.9))}
gnss = {"gps": Gnss(period=0.2, delivery=Delivery(latency=0.1))}
imus = {"imu": Imu(acceleration=Inaccuracy())}

def reset(self, briefing):
    assert self.seed == 5 and self.settings == {"gain": 2.0, "limit": 3.0}
    assert 4 < briefing.vehicle.length < 5 and 16 < briefing.cruise_speed < 17
    self.steps = self.scans = self.fixes = self.inertia = 0

def step(self, observation):
    assert observation.way.ahead.shape == (16, 3) and observation.way.spacing == 2.5
    assert abs(observation.time - 0.05 * self.steps) < 1e-9 and observation.images == {}
    assert np.hypot(*observation.odometry[:2]) - observation.travelled < 1e-6
    pedestrian, = [body for body in observation.others if body.kind == "pedestrian"]
    assert pedestrian.position.shape == (2,) and 0.2 < pedestrian.length < 1
    for scan in observation.scans:
        assert scan.sensor == "roof" and scan.points.shape[1] == 4 and scan.points.dtype == np.float32
        assert abs(np.median(scan.points[:, 2]) + 1.9) < 0.1
    for fix in observation.fixes:
        assert np.linalg.norm(fix.velocity) > 10 and observation.time - fix.time > 0.0999
    for one in observation.inertia:
        assert abs(one.acceleration[0]) < 12
    self.steps += 1
    self.scans += len(observation.scans)
    self.fixes += len(observation.fixes)
    self.inertia += len(observation.inertia)
    if self.steps == 21:
        assert (self.scans, self.fixes, self.inertia) == (11, 5, 101), (self.scans, self.fixes, self.inertia)
    return Control(np.float32(0.0), 0)
"#;
    let Some(command) = driver(dir, body) else { return };
    let told = run(dir, &command, &["--budget", "2", "--set", "driver.seed=5", "--set", "driver.gain=2"]);
    let output = succeeds(told);
    assert!(stdout(&output).contains("\"error\": 0"), "{}{}", stdout(&output), stderr(&output));
    for trial in trials(dir, "paracosm-out") {
        assert_eq!(trial["error"], Value::Null);
    }
}

#[test]
fn an_example_without_its_packages_says_how_to_install_them() {
    let script = package().join("examples/lane_follow.py");
    // Isolated, and without what was installed.
    let ran = Command::new("python3").args(["-I", "-S"]).arg(script).output();
    let Ok(ran) = ran else {
        eprintln!("SKIPPED: no python3");
        return;
    };
    let said = stderr(&ran);
    assert!(
        !ran.status.success() && said.starts_with("lane_follow.py needs the package numpy: pip install "),
        "{said}"
    );
    assert!(said.trim_end().ends_with("python") && said.lines().count() == 1, "{said}");
}
