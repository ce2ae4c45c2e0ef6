//! What scenarios have around them, by the command line: closed it changes nothing, opened it is seen.

use crate::common::{fuzz, refused, stdout, succeeds, without_study};
use std::fs;
use std::path::Path;

const CAMERAS: &str = "[camera.front]\nresolution = [80, 48]\nfocal_mm = 24.0\nsensor_mm = 36.0\nposition = [0.3, 0.0, 1.4]\n\
                       rate = 1.0\nfull_well = 2000.0\nread_noise = 20.0\n";

fn image(path: &Path) -> Vec<u8> {
    let file = fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a small one")];
    reader.next_frame(&mut pixels).expect("a PNG");
    pixels
}

/// Records a test of `pedestrian-crossing` with these options: its log, and the folder of its images.
fn recorded(dir: &Path, out: &str, options: &[&str]) -> (String, std::path::PathBuf) {
    fs::write(dir.join("cameras.toml"), CAMERAS).expect("a file");
    let record = ["record", "pedestrian-crossing", "--budget", "1", "--cameras", "cameras.toml", "--out", out];
    succeeds(fuzz(dir, &[&record[..], options].concat()));
    let log = without_study(&fs::read_to_string(dir.join(out).join("trials.jsonl")).expect("a log"));
    (log, dir.join(out).join("000000/front"))
}

#[test]
fn the_sun_the_roadside_and_the_zebra_are_seen_and_the_test_is_the_same() {
    if !crate::cameras::can_draw() {
        return;
    }
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    let (log, usual) = recorded(dir, "usual", &[]);
    let rgb = |folder: &Path| image(&folder.join("rgb/000000.png"));
    let classes =
        |folder: &Path, id: u8| image(&folder.join("semantic/000000.png")).iter().filter(|class| **class == id).count();
    let changed = |name: &str, option: &str| {
        let (other, folder) = recorded(dir, name, &["--set", option]);
        assert_ne!(rgb(&usual), rgb(&folder), "{option}");
        (other, folder)
    };
    let (_, sun) = changed("sun", "sun_elevation=8");
    let bright = |folder: &Path| rgb(folder).iter().map(|byte| f64::from(*byte)).sum::<f64>();
    assert!(bright(&sun) < bright(&usual));
    assert_eq!(changed("side", "sun_azimuth=0").0, log);
    let (striped, zebra) = changed("zebra", "zebra=1");
    assert_eq!(striped, log);
    assert!(classes(&zebra, 24) > 0);
    let (_, roadside) = changed("roadside", "roadside=1");
    for (class, what) in [(9, "trees"), (3, "houses")] {
        assert!(classes(&usual, class) == 0 && classes(&roadside, class) > 20, "{what}");
    }
    let things = |folder: &Path| {
        let mut ids = image(&folder.join("instance/000000.png"));
        ids.sort_unstable();
        ids.dedup();
        ids.len()
    };
    assert!(things(&roadside) > things(&usual) + 4);
}

#[test]
fn a_campaign_written_before_its_scenario_asked_for_the_sun_is_replayed_as_it_was() {
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    succeeds(fuzz(dir, &["cut-in", "--budget", "2", "--out", "old"]));
    let path = dir.join("old/campaign.json");
    let mut study: serde_json::Value = serde_json::from_slice(&fs::read(&path).expect("a file")).expect("JSON");
    let fixed = study["fixed"].as_object_mut().expect("an object");
    for name in ["fog", "light", "rain", "sun_elevation", "sun_azimuth", "roadside"] {
        assert!(fixed.remove(name).is_some(), "{name}");
    }
    fs::write(&path, study.to_string()).expect("a file");
    let log = fs::read_to_string(dir.join("old/trials.jsonl")).expect("a log");
    fs::write(dir.join("old/trials.jsonl"), without_study(&log)).expect("a file");
    assert!(stdout(&succeeds(fuzz(dir, &["replay", "old", "1", "--format", "json"]))).contains("trace_hash"));
}

#[test]
fn the_sun_can_be_opened_over_its_range_and_over_time_and_no_further() {
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    let open = |options: &[&str]| fuzz(dir, &[&["ncap-cpna", "--budget", "2", "--out", "x"][..], options].concat());
    refused(&open(&["--open", "sun_elevation=0..100"]), &["sun_elevation", "100", "90"]);
    refused(&open(&["--set", "roadside=2"]), &["roadside", "2", "1"]);
    refused(&open(&["--set", "zebra=1"]), &["no parameter `zebra`"]);
    refused(&open(&["--open", "roadside:piecewise-linear:2"]), &["roadside", "varies over time"]);
    succeeds(open(&["--open", "sun_azimuth:piecewise-linear:2", "--open", "sun_elevation=5..60"]));
    let log = fs::read_to_string(dir.join("x/trials.jsonl")).expect("a log");
    assert!(log.lines().all(|line| line.contains("\"error\":null")), "{log}");
}
