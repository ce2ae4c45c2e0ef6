//! The parsers of files and answers that somebody else may have written, except networks
//! (`engine/neural/src/limits.rs`).
//!
//! `cargo fuzz` and the tests of the workspace (`tests/parsers`) share this table. Each parser may refuse its input
//! with an error. A parser must not panic, hang, or take more than 2 GiB of memory.

use paracosm::campaign::cameras::read_cameras;
use paracosm::campaign::seeing::{read_meaning, read_percepts};
use paracosm::campaign::{Answer, Log, Regression, SpaceFile, StudyFile, TestSet, Trust, read_tests, read_trace};
use paracosm::oracles::Formula;
use paracosm::perception::{Detector, Picture, Segmenter, Task};
use paracosm::space::constraint::Expression;
use paracosm::space::{Distribution, Space};
use paracosm::{Study, catalogue};
use std::fmt::Display;
use std::fs;
use std::path::Path;

/// A parser and its name.
pub struct Parser {
    /// The name of the parser and of the folder with its seeds.
    pub name: &'static str,
    /// Reads an input. Formats an error as a message, and uses a value.
    pub read: fn(&[u8]),
}

/// All parsers.
pub const PARSERS: &[Parser] = &[
    Parser { name: "space", read: |data| in_file("SPACE.toml", data, |path| look(SpaceFile::read(path), use_space)) },
    Parser { name: "pict", read: |data| in_file("model.pict", data, |path| look(SpaceFile::read(path), use_space)) },
    Parser { name: "formula", read: formula },
    Parser { name: "points", read: |data| in_file("points.csv", data, |path| look(read_tests(path, None), use_tests)) },
    Parser { name: "tests", read: |data| in_file("tests.csv", data, tests) },
    Parser { name: "trace", read: |data| look(read_trace(Path::new("-"), data, None, |_| Ok(true)), |_| ()) },
    Parser { name: "trials", read: trials },
    Parser { name: "study", read: study },
    Parser { name: "cameras", read: |data| in_file("cameras.toml", data, |path| look(read_cameras(path), |_| ())) },
    Parser { name: "requirements", read: |data| in_file("requirements.toml", data, requirements) },
    Parser { name: "regression", read: |data| in_file("regression.json", data, regression) },
    Parser { name: "gltf", read: |data| in_file("model.gltf", data, gltf) },
    Parser { name: "glb", read: |data| in_file("model.glb", data, gltf) },
    Parser { name: "answer", read: |data| look(Answer::read(&String::from_utf8_lossy(data), 3), |_| ()) },
    Parser { name: "percepts", read: percepts },
];

/// Writes the message of an error, or uses a value.
fn look<T, E: Display>(result: Result<T, E>, using: impl FnOnce(T)) {
    match result {
        Ok(value) => using(value),
        Err(error) => assert!(!error.to_string().is_empty(), "an error says something"),
    }
}

fn in_file(name: &str, data: &[u8], read: impl FnOnce(&Path)) {
    let folder = tempfile::tempdir().expect("there is room for a file");
    let path = folder.path().join(name);
    fs::write(&path, data).expect("there is room for a file");
    read(&path);
}

fn use_space(file: SpaceFile) {
    let written = file.space.to_toml();
    assert_eq!(Space::from_toml(&written).as_ref(), Ok(&file.space), "{written}");
}

fn use_tests(tests: TestSet) {
    tests.points.iter().for_each(|point| drop(tests.space.decode(point)));
}

fn formula(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    look(text.parse::<Formula>(), |formula| {
        let written = formula.to_string();
        assert_eq!(written.parse::<Formula>().as_ref(), Ok(&formula), "{written}");
    });
    look(Formula::parse(&text, &["car.speed", "gap"]), |_| ());
    look(text.parse::<Expression>(), |expression| {
        let written = expression.to_string();
        assert_eq!(written.parse::<Expression>().as_ref(), Ok(&expression), "{written}");
    });
    look(text.parse::<Distribution>(), |_| ());
}

const SPACE_OF_TESTS: &str = "\
[[parameter]]
name = \"speed\"
interval = [0.5, 10.0]
[[parameter]]
name = \"sky\"
choice = [\"clear\", \"fog\", 3]
";

fn tests(path: &Path) {
    let space = || SpaceFile::from(Space::from_toml(SPACE_OF_TESTS).expect("the space is valid"));
    look(read_tests(path, Some(space())), use_tests);
    look(TestSet::read_partial(path, &space().space, &space().aliases), |_| ());
}

/// A campaign whose log has the input as its trials.
fn trials(data: &[u8]) {
    let folder = tempfile::tempdir().expect("there is room for a folder");
    let study = include_str!("../seeds/study/crossing.json");
    fs::write(folder.path().join("campaign.json"), study).expect("there is room for a file");
    fs::write(folder.path().join("trials.jsonl"), data).expect("there is room for a file");
    look(Log::read(folder.path(), &catalogue()), |log| look(log.test_set(), use_tests));
}

/// A study, and the campaign in whose folder the study stands.
fn study(data: &[u8]) {
    look(StudyFile::parse(&String::from_utf8_lossy(data), &catalogue()), |file| {
        let written = serde_json::to_string(&file).expect("a study is JSON");
        look(StudyFile::parse(&written, &catalogue()), |_| ());
    });
    let folder = tempfile::tempdir().expect("there is room for a folder");
    fs::write(folder.path().join("campaign.json"), data).expect("there is room for a file");
    fs::write(folder.path().join("trials.jsonl"), b"").expect("there is room for a file");
    look(Log::read(folder.path(), &catalogue()), |log| {
        // Nothing that a file names is run without trust.
        look(
            paracosm::campaign::Worker::until(
                log.trusting(&Trust::default()).study(),
                paracosm::campaign::Supervision::default(),
            ),
            |_| (),
        );
    });
}

/// An answer of a perceiver in a process: the meaning of its answers, or what it sees in two images.
fn percepts(data: &[u8]) {
    let line = String::from_utf8_lossy(data);
    look(read_meaning(&line), |_| ());
    let picture = Picture { width: 6, height: 4, rgb: &[0; 72] };
    let detection = Task::Detection(Detector::of(["car", "person"].map(str::to_owned).into()));
    let segmentation = Task::Segmentation(Segmenter { is: vec!["road".to_owned()] });
    for task in [detection, segmentation] {
        look(read_percepts(&line, &task, &[picture; 2]), |percepts| {
            assert_eq!(percepts.len(), 2);
            look(task.check(&[picture; 2], &percepts), |()| ());
        });
    }
}

fn requirements(path: &Path) {
    let program = catalogue().find("pedestrian-crossing").expect("the scenario is there");
    look(Study::of(program).require(path).build(), |_| ());
}

fn regression(path: &Path) {
    look(Regression::read(path, &catalogue()), |_: Regression| ());
}

fn gltf(path: &Path) {
    use paracosm::render::{Semantic, gltf::load};
    look(load(path, Semantic::Road), |_| ());
}
