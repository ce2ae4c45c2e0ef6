//! Files of cameras: every setting can be given, and an error says the line, the key, the value, and the values that
//! were expected.

use super::*;
use std::fs;

/// Four settings vary.
const VARIED: &str = r#"
seed = 5
[camera.front]
resolution = [48, 32]
focal_mm = "20..28"
sensor_mm = 36
position = [0.3, 0.0, "1.2..1.6"]
yaw_pitch_roll = [0, "-2..2", 0.5]
rate = 2
exposure = "-1.5,0,1.5"
"#;

#[test]
fn files_of_cameras_say_the_line_and_the_key_what_was_found_and_what_was_expected() {
    let said = |from: &str, to: &str| {
        assert!(VARIED.contains(from));
        let flaw = parse(&VARIED.replace(from, to)).err().unwrap_or_else(|| panic!("{to} is taken"));
        format!("{}: {}", flaw.line.map_or("-".to_owned(), |line| line.to_string()), flaw.flaw)
    };
    for (from, to, expected) in [
        (
            "seed = 5",
            "sed = 5",
            "2: unknown key `sed` in a file of cameras, expected `seed`, `look` or tables [camera.NAME] (did you mean `seed`?)",
        ),
        ("seed = 5", "look = \"texture\"", "2: no look is called `texture` (did you mean `textured`?)"),
        ("seed = 5", "look = 3", "2: `look` is 3, expected \"flat\" or \"textured\""),
        ("seed = 5", "seed = -1", "2: `seed` is -1, expected a whole number from 0 on"),
        (
            "[camera.front]",
            "[cameras.front]",
            "3: unknown key `cameras` in a file of cameras, expected `seed`, `look` or tables [camera.NAME] (did you mean `camera`?)",
        ),
        (
            "exposure",
            "exposre",
            "10: camera `front`: a camera has no key `exposre` (did you mean `exposure`?); its keys are resolution, focal_mm",
        ),
        ("rate = 2\n", "", "3: camera `front` has no `rate`, expected images a second, such as `rate = 10.0`"),
        (
            "rate = 2",
            "rate = \"2..9\"",
            "9: camera `front`: `rate` is \"2..9\", expected one number of Hz, because this setting cannot vary from test to test",
        ),
        (
            "rate = 2",
            "rate = true",
            "9: camera `front`: `rate` is true, expected a number of Hz, or a range such as \"1..2\"",
        ),
        (
            "\"-2..2\"",
            "\"2..-2\"",
            "8: camera `front`: pitch in `yaw_pitch_roll` is \"2..-2\", expected \"LO..HI\" with the lower number first, or \"A,B,C\" with no number twice; all are numbers of degrees",
        ),
        ("\"-1.5,0,1.5\"", "\"dark\"", "10: camera `front`: `exposure` is \"dark\", expected \"LO..HI\""),
        ("\"-1.5,0,1.5\"", "\"0,0\"", "10: camera `front`: `exposure` is \"0,0\", expected"),
        ("\"-1.5,0,1.5\"", "\"0..nan\"", "10: camera `front`: `exposure` is \"0..nan\", expected"),
        ("\"-1.5,0,1.5\"", "\"0..90\"", "10: camera `front`: `exposure` is 90, expected -20 to 20 stops"),
        ("\"20..28\"", "\"0..28\"", "5: camera `front`: `focal_mm` is 0, expected 0.1 to 10000 mm"),
        ("\"1.2..1.6\"", "\"-1..1.6\"", "7: camera `front`: `position` is [0.3, 0.0, -1.0], expected"),
        (
            "[0.3, 0.0, \"1.2..1.6\"]",
            "1.35",
            "7: camera `front`: `position` is 1.35, expected a list of 3 numbers: ahead, left, up",
        ),
        (
            "[48, 32]",
            "[48.5, 32]",
            "4: camera `front`: `resolution` is [48.5, 32], expected two whole numbers, the width and the height in pixels",
        ),
        ("[48, 32]", "\"large\"", "4: camera `front`: `resolution` is \"large\", expected two whole numbers"),
        (
            "[camera.front]",
            "[camera.\"front left\"]",
            "3: camera `front left`: expected a name of letters, digits, - and _",
        ),
        (
            "[camera.front]",
            "[camera]\nrear = 5\n[camera.front]",
            "4: camera `rear` is 5, expected a table [camera.rear]",
        ),
        ("= [48, 32]", "= [48, 32", "5: "),
    ] {
        let found = said(from, to);
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
}

#[test]
fn every_setting_of_a_camera_can_be_said_in_a_file() {
    let standard = standard_cameras_file();
    let read = parse(&standard).expect("sound cameras");
    assert_eq!(*read.nominal(), standard_cameras());
    assert!(!read.vary());
    let keys = paracosm_render::camera_settings().keys();
    assert!(keys.iter().all(|key| standard.contains(&format!("\n{key} = "))), "{keys:?}");
    let written = toml::Value::try_from(standard_cameras()).expect("TOML");
    let known = written["camera"]["front"].as_table().expect("a table");
    assert_eq!(known.keys().map(String::as_str).collect::<std::collections::BTreeSet<_>>(), keys.into_iter().collect());
}

#[test]
fn files_of_cameras_say_what_is_wrong_with_them() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("cameras.toml");
    let said = |text: &str| {
        fs::write(&path, text).expect("a file");
        read_cameras(&path).map_or_else(|error| error.to_string(), |_| "nothing".to_owned())
    };
    let standard = standard_cameras_file();
    assert_eq!(said(&standard), "nothing");
    let changed = |from: &str, to: &str| {
        assert!(standard.contains(from));
        said(&standard.replace(from, to))
    };
    for (from, to, word) in [
        ("focal_mm = 24.0", "focal_mm = 0.0", "camera `front`: `focal_mm` is 0, expected 0.1 to 10000 mm"),
        ("focal_mm = 24.0", "focal_mm = 1e-300", "`focal_mm`"),
        ("focal_mm = 24.0", "focal_mm = 1e300", "`focal_mm`"),
        ("sensor_mm = 36.0", "sensor_mm = nan", "`sensor_mm` is NaN, expected 0.1 to 1000 mm"),
        ("[0.3, 0.0, 1.35]", "[0.3, 0.0, -1.35]", "`position` is [0.3, 0.0, -1.35], expected -100 to 100 m ahead"),
        ("[0.3, 0.0, 1.35]", "[1e30, 0.0, 1.35]", "`position`"),
        ("[0.0, 2.0, 0.0]", "[0.0, 1e9, 0.0]", "`yaw_pitch_roll`"),
        ("rate = 10.0", "rate = 0.0", "`rate` is 0, expected 0.001 to 1000 Hz"),
        ("[640, 360]", "[200000, 360]", "`resolution` is [200000, 360], expected 1 to 8192 pixels each way"),
        ("[640, 360]", "[0, 360]", "`resolution`"),
        ("vignetting = 0.0", "vignetting = 2.0", "`vignetting` is 2"),
        ("defocus", "defocuss", "line"),
        ("[camera.front]", "[camera.\"../front\"]", "../front"),
    ] {
        let message = changed(from, to);
        assert!(message.contains(word), "{message}");
    }
    assert!(said("seed = 1\n[camera]").contains("no camera"));
}
