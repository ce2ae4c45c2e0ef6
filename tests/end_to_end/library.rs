//! The library does all that the program does: a campaign that is run by a few lines of Rust leaves the same folder.

use crate::common::{fuzz, succeeds};
use crate::perceivers::runs_blind;
use paracosm::campaign::{DERIVED, Extension};
use paracosm::generators::Strategy;
use paracosm::{Campaign, Folder, Study, catalogue};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs;
use std::path::Path;

#[allow(dead_code)]
#[path = "../../examples/campaign.rs"]
mod example;

/// The files of a folder with their contents.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap())).collect()
}

#[test]
fn the_example_leaves_the_folder_that_the_program_leaves() {
    let text = include_str!("../../examples/campaign.rs");
    assert!(text.lines().count() <= 25, "the example has {} lines", text.lines().count());
    let dir = tempfile::tempdir().unwrap();
    example::campaign(&dir.path().join("library")).unwrap();
    succeeds(fuzz(dir.path(), &["--out", "program", "-q"]));
    let [library, program] = ["library", "program"].map(|name| contents(&dir.path().join(name)));
    assert_eq!(library.keys().collect::<Vec<_>>(), program.keys().collect::<Vec<_>>());
    for (name, bytes) in &library {
        assert!(*bytes == program[name], "{name} differs");
    }
    assert!(library.len() >= 9, "{:?}", library.keys());
}

#[test]
fn every_file_of_a_campaign_is_its_own_and_every_name_of_its_own_is_written_by_some_command() {
    let dir = tempfile::tempdir().unwrap();
    let open = ["--budget", "120", "--open", "lanes=2,4,6", "--open", "zebra", "--locate", "--junit"];
    succeeds(fuzz(dir.path(), &[&open[..], &["--out", "out", "-q"]].concat()));
    succeeds(fuzz(dir.path(), &["blame", "out", "-q"]));
    succeeds(fuzz(dir.path(), &["map", "out", "--show", "severity", "-q"]));
    let mut written = contents(&dir.path().join("out"));
    // Points are those of scenarios on a grid of Euro NCAP.
    succeeds(fuzz(dir.path(), &["ncap-cpfa", "--budget", "1", "--out", "ncap", "-q"]));
    written.extend(contents(&dir.path().join("ncap")));
    let perceived = tempfile::tempdir().unwrap();
    if runs_blind(perceived.path()) {
        written.extend(contents(&perceived.path().join("out")));
    } else {
        written.insert("perception.json".to_owned(), Vec::new());
    }
    for name in written.keys() {
        assert!(Folder::owns(OsStr::new(name)), "{name} is not known as a campaign's own");
    }
    let written: BTreeSet<&str> = written.keys().map(String::as_str).collect();
    let missing: Vec<&str> = DERIVED.into_iter().filter(|name| !written.contains(name)).collect();
    assert!(missing.is_empty(), "no command wrote {missing:?}; there are {written:?}");
}

#[test]
fn the_log_of_a_campaign_that_extends_others_counts_their_tests() {
    let dir = tempfile::tempdir().unwrap();
    let old = dir.path().join("old.csv");
    fs::write(&old, "speed,distance\n1,10\n2,20\n3,30\n").unwrap();
    let study = Study::of(catalogue().find("pedestrian-crossing").unwrap()).strategy(Strategy::GREEDY).budget(4);
    let study = study.build().unwrap();
    let extension = Extension::read(&old, &study).unwrap();
    let log = Campaign::new(&study).unwrap().extending(&extension).unwrap().into_log().unwrap();
    assert_eq!((log.trials().len(), log.test_set().unwrap().points.len()), (4, 7));
}

#[test]
fn a_driver_that_nobody_offers_is_a_failure_of_the_environment() {
    let program = paracosm::catalogue().find("pedestrian-crossing").expect("it is in the catalogue");
    let study = paracosm::Study::of(program).driver("grpc://127.0.0.1:1").build().expect("a sound study");
    let error = paracosm::Campaign::new(&study).err().expect("nobody listens there");
    assert!(matches!(error, paracosm::Error::Environment(_)), "{error}");
    assert!(error.to_string().contains("127.0.0.1:1"), "{error}");
}

#[test]
fn a_study_whose_strategy_cannot_do_what_is_asked_is_not_built() {
    let program = paracosm::catalogue().find("pedestrian-crossing").expect("it is in the catalogue");
    let study = paracosm::Study::of(program).open("friction").strategy(Strategy::FIBONACCI).build();
    let error = study.expect_err("fibonacci covers two parameters, and three are open");
    assert!(matches!(error, paracosm::Error::Use(_)), "{error}");
    assert!(error.to_string().contains("fibonacci"), "{error}");
}

#[test]
fn a_driver_of_ones_own_cannot_have_the_name_of_another_driver() {
    let study = Study::of(catalogue().find("cut-in").unwrap());
    let make = || paracosm::engine::driver::find("cruise").unwrap().build(&[]).unwrap();
    let error = study.clone().own_driver("aeb", make).build().unwrap_err().to_string();
    assert!(error.contains("a driver is called `aeb` already: give your driver another name"), "{error}");
    study.own_driver("my-aeb", make).build().unwrap();
}
