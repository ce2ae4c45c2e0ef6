//! `export`: tests as files of OpenSCENARIO and OpenDRIVE, which are read back and judged by the checkers of ASAM.

use crate::common::{fuzz, refused, stderr, succeeds};
use paracosm::engine::driver::find;
use paracosm::engine::vehicle::VehicleModel;
use paracosm::engine::{Control, Motion, Run, Setup, Step, simulate};
use paracosm::standards::openscenario::Xosc;
use paracosm::{Log, campaign::Worker};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The greatest distance in metres of a body of the exported scenario from the body in the test.
const CLOSE: f64 = 0.005;

/// The scenarios whose tests are exported, each with the name of its folders and with further options.
const SCENARIOS: [(&str, &str, &[&str]); 8] = [
    ("crossing", "pedestrian-crossing", &[]),
    ("highway", "highway-traffic", &[]),
    ("grid", "grid-traffic", &["--driver", "planner"]),
    ("roundabout", "roundabout-entry", &["--driver", "planner"]),
    ("map", "map-traffic", &["--driver", "planner"]),
    // The file of the roads has trees, posts, a house and a parked car.
    ("objects", "map-traffic", &["--driver", "planner", "--set", "roads=FOLDER/objects.xodr", "--open", "cars=0..1"]),
    ("leader", "FOLDER/slow-leader.xosc", &["--open", "gap=20..60"]),
    // An entity is added, and another one is deleted.
    ("actions", "FOLDER/actions.xosc", &["--open", "count=2..3", "--driver", "default"]),
];

/// Returns a folder with campaigns of two tests, in which test 1 of each is exported to the folder `NAME-case`.
fn exported() -> tempfile::TempDir {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("standards/tests");
    let dir = tempfile::tempdir().expect("a folder");
    fs::create_dir(dir.path().join("catalogs")).expect("it is writable");
    for name in ["straight.xodr", "slow-leader.xosc", "actions.xosc", "catalogs/entities.xosc"] {
        fs::copy(from.join("scenarios/files").join(name), dir.path().join(name)).expect("it is there");
    }
    fs::copy(from.join("roads/files/objects.xodr"), dir.path().join("objects.xodr")).expect("it is there");
    // A log names files as the command did.
    let here = dir.path().to_string_lossy();
    for (name, scenario, options) in SCENARIOS {
        let (log, case) = (format!("{name}-log"), format!("{name}-case"));
        let given = [&[scenario, "--budget", "2", "--out", &log], options].concat();
        let given: Vec<String> = given.iter().map(|argument| argument.replace("FOLDER", &here)).collect();
        succeeds(fuzz(dir.path(), &given.iter().map(String::as_str).collect::<Vec<_>>()));
        succeeds(fuzz(dir.path(), &["export", &log, "1", "--out", &case]));
        if scenario.ends_with(".xosc") {
            let storyboard = format!("{name}-storyboard");
            let output = fuzz(dir.path(), &["export", &log, "1", "--out", &storyboard, "--ego-as", "controller"]);
            assert!(stderr(&succeeds(output)).contains("`Ego` is left to the other simulator"));
        }
    }
    dir
}

/// Plays a concrete scenario to its end.
fn played(file: &Path) -> Motion {
    let program = Xosc::read(file).unwrap_or_else(|error| panic!("{error}")).program();
    let nominal = program.declare().expect("it is sound").nominal();
    let setup = Setup { takes_over: false, ..Setup::asking_every(0.1) };
    let mut run = Run::new(&program, &nominal, setup).expect("it begins");
    run.record_motion();
    while let Step::Need(_) = run.advance() {
        run.supply(Control::default());
    }
    run.motion().expect("it is recorded").clone()
}

/// Returns the motion of everything in a test of a campaign.
fn recorded(dir: &Path, index: usize) -> Motion {
    let log = Log::read(dir, &paracosm::catalogue()).expect("a log");
    Worker::new(log.study()).expect("a worker").record(&log.trials()[index]).expect("it repeats").motion
}

/// Returns the greatest distance in metres between the bodies of two motions at a tick.
fn distance(test: &Motion, export: &Motion) -> f64 {
    let present: Vec<_> = test.tracks.iter().filter(|track| track.poses.iter().any(Option::is_some)).collect();
    assert_eq!(present.len(), export.tracks.len());
    let mut greatest: f64 = 0.0;
    for (one, other) in present.iter().zip(&export.tracks) {
        // A scenario of a file has 100 ticks in a second, and the test may have fewer.
        let stride = (test.dt / export.dt).round() as usize;
        assert!(other.poses.len() >= stride * (one.poses.len() - 1), "{}: it ends early", one.name);
        for (a, b) in one.poses.iter().zip(other.poses.iter().step_by(stride)) {
            assert_eq!(a.is_some(), b.is_some(), "{}: {a:?} in the test, {b:?} in the export", one.name);
            let far = a.zip(*b).map(|(a, b)| (a.position - b.position).norm());
            greatest = far.map_or(greatest, |far| greatest.max(far));
        }
    }
    greatest
}

#[test]
fn exported_tests_are_read_back_with_the_same_motion() {
    let dir = exported();
    for (name, ..) in SCENARIOS {
        let log = dir.path().join(format!("{name}-log"));
        let case = dir.path().join(format!("{name}-case/{name}-case.xosc"));
        let far = distance(&recorded(&log, 1), &played(&case));
        assert!(far <= CLOSE, "{name}: {far} m");
        eprintln!("{name}: {far:.6} m, {} bytes", fs::metadata(&case).expect("it is there").len());
    }
    // The entities of a file keep their boxes and names, so their reference points move as recorded.
    let text = fs::read_to_string(dir.path().join("leader-case/leader-case.xosc")).expect("it is there");
    assert!(text.contains("<ScenarioObject name=\"Leader\">") && text.contains("<Center x=\"1.4\""), "{text}");
}

#[test]
fn the_storyboard_of_a_file_is_exported_with_the_values_of_the_test_and_gives_the_same_trace() {
    let dir = exported();
    for (name, driver) in [("leader", "aeb"), ("actions", "default")] {
        let log = Log::read(&dir.path().join(format!("{name}-log")), &paracosm::catalogue()).expect("a log");
        let folder = dir.path().join(format!("{name}-storyboard"));
        let mut files: Vec<_> =
            fs::read_dir(&folder).expect("it is there").map(|file| file.expect("one").file_name()).collect();
        files.sort();
        let scenario = format!("{name}-storyboard.xosc");
        assert_eq!(files, [scenario.as_str(), "roads.xodr"]);
        // Nothing else is needed.
        let moved = tempfile::tempdir().expect("a folder");
        for file in files {
            fs::copy(folder.join(&file), moved.path().join(&file)).expect("it is there");
        }
        let program = Xosc::read(&moved.path().join(&scenario)).unwrap_or_else(|error| panic!("{error}")).program();
        let descriptor = find(driver).expect("a driver");
        let mut driver = (descriptor.make)(&descriptor.settings(&[]).expect("no settings"));
        let nominal = program.declare().expect("it is sound").nominal();
        let trace = simulate(&program, &nominal, VehicleModel::default(), driver.as_mut()).trace.expect("a trace");
        assert_eq!(Some(trace.hash()), log.trials()[1].trace_hash, "{name}");
    }
}

#[test]
fn an_export_replaces_nothing_and_leaves_the_ego_vehicle_to_a_controller() {
    let dir = tempfile::tempdir().expect("a folder");
    succeeds(fuzz(dir.path(), &["pedestrian-crossing", "--budget", "2", "--out", "log"]));
    let output = succeeds(fuzz(dir.path(), &["export", "log", "0", "--out", "case", "--ego-as", "controller"]));
    let says = stderr(&output);
    assert!(says.contains("except the ego vehicle") && says.contains("the scenario is a program"), "{says}");
    let text = fs::read_to_string(dir.path().join("case/case.xosc")).expect("it was written");
    assert_eq!(text.matches("<FollowTrajectoryAction>").count(), 1, "{text}");
    refused(&fuzz(dir.path(), &["export", "log", "0", "--out", "case"]), &["case.xosc exists"]);
    refused(&fuzz(dir.path(), &["export", "log", "7", "--out", "other"]), &["7"]);
    assert!(!dir.path().join("other").exists());
}

/// Returns the Python that has the checkers of ASAM.
pub fn judge() -> Option<PathBuf> {
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/checker/bin/python3");
    let found =
        Command::new(&python).args(["-c", "import qc_opendrive, qc_openscenario"]).stderr(Stdio::null()).status();
    let found = found.is_ok_and(|status| status.success());
    if !found {
        eprintln!("no checkers of ASAM: the test is skipped");
    }
    found.then_some(python)
}

/// Returns the report of a checker on a file.
pub fn report(python: &Path, file: &Path, [module, bundle]: [&str; 2]) -> String {
    let [config, result] = ["xml", "xqar"].map(|ending| file.with_extension(ending));
    let (input, output) = (file.display(), result.display());
    let settings = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Config><Param name=\"InputFile\" value=\"{input}\"/>\
         <CheckerBundle application=\"{bundle}\"><Param name=\"resultFile\" value=\"{output}\"/></CheckerBundle></Config>"
    );
    fs::write(&config, settings).expect("the folder is writable");
    let run = format!("import sys; from {module}.main import main; sys.argv = ['{module}', '-c', sys.argv[1]]; main()");
    let output = Command::new(python).args(["-c", &run]).arg(&config).output().expect("python3 starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(&result).expect("the checker writes a report")
}

#[test]
fn exports_pass_the_quality_checkers_of_asam() {
    let Some(python) = judge() else { return };
    let dir = exported();
    let scenarios = ["qc_openscenario", "xoscBundle"];
    let trajectories = SCENARIOS.map(|(name, ..)| format!("{name}-case"));
    for name in trajectories.into_iter().chain(["leader-storyboard", "actions-storyboard"].map(str::to_owned)) {
        let case = dir.path().join(&name);
        let checked = report(&python, &case.join(format!("{name}.xosc")), scenarios);
        assert!(checked.matches("status=\"completed\"").count() >= 5, "{name}: {checked}");
        assert!(!checked.contains("<Issue"), "{name}: {checked}");
        let checked = report(&python, &case.join("roads.xodr"), ["qc_opendrive", "xodrBundle"]);
        assert!(!checked.contains("<Issue"), "{name}: {checked}");
    }
    // The checker finds what is wrong.
    let file = dir.path().join("crossing-case/wrong.xosc");
    let text = fs::read_to_string(file.with_file_name("crossing-case.xosc")).expect("it was written");
    fs::write(&file, text.replacen("<EntityRef entityRef=\"", "<EntityRef entityRef=\"No", 1)).expect("it is writable");
    assert!(report(&python, &file, scenarios).contains("<Issue"));
}
