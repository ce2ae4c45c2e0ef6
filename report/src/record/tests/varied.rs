//! Cameras whose settings vary from test to test.

use super::*;
use paracosm_campaign::cameras::{VariedCameras, read_cameras, standard_cameras};
use paracosm_space::{Record, Value, Values};

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

fn varied() -> VariedCameras {
    let file = tempfile::NamedTempFile::new().expect("a file");
    fs::write(file.path(), VARIED).expect("a file");
    read_cameras(file.path()).expect("sound cameras")
}

#[test]
fn what_varies_stands_in_the_middle_where_no_test_says_otherwise_and_where_a_test_says_it_does_there() {
    let cameras = varied();
    let front = &cameras.nominal().all["front"];
    let exposure = |camera: &CameraSpec| *camera.lens.get("exposure").expect("it is said");
    assert_eq!((front.focal_mm, front.position, exposure(front)), (24.0, [0.3, 0.0, 1.4], -1.5));
    assert_eq!((front.yaw_pitch_roll, front.resolution, front.rate), ([0.0, 0.0, 0.5], [48, 32], 2.0));
    assert!(cameras.vary() && cameras.of_test(&Values::default()) == *cameras.nominal());
    let settings = [("focal_mm", 21.5), ("up", 1.25), ("pitch", -1.75), ("exposure", 1.5)];
    let test: Values =
        settings.map(|(name, value)| (format!("camera.front.{name}"), value.into())).into_iter().collect();
    let found = cameras.of_test(&test);
    let changed = &found.all["front"];
    assert_eq!((changed.focal_mm, changed.position[2], exposure(changed)), (21.5, 1.25, 1.5));
    assert_eq!(changed.yaw_pitch_roll, [0.0, -1.75, 0.5]);
    let lens = Record::from_iter([("exposure".to_owned(), -1.5)]);
    assert_eq!(CameraSpec { focal_mm: 24.0, position: front.position, lens, ..changed.clone() }, {
        CameraSpec { yaw_pitch_roll: changed.yaw_pitch_roll, ..front.clone() }
    });
    assert_ne!(found.seed, cameras.nominal().seed, "its noise is its own");
    assert_eq!(found, cameras.of_test(&test));
    // Of other cameras than it knows a test may say what it likes.
    let closed = VariedCameras::from(standard_cameras());
    assert!(!closed.vary() && closed.of_test(&test) == standard_cameras());
}

#[test]
fn varied_settings_are_parameters_of_tests_whose_worlds_know_nothing_of_them() {
    let cameras = varied();
    let study = || of("pedestrian-crossing");
    let (plain, before) = tests_of(study(), 3);
    let (opened, trials) = tests_of(study().open_cameras(&cameras), 3);
    let names: Vec<_> = opened.space().parameters().iter().map(|parameter| parameter.name.as_str()).collect();
    let settings = ["exposure", "focal_mm", "up", "pitch"].map(|name| format!("camera.front.{name}"));
    assert_eq!(names[..2], ["speed", "distance"]);
    assert_eq!(names[2..], settings);
    assert_eq!(opened.space().parameter(&settings[3]).unwrap().unit.as_deref(), Some("degrees"));
    let worker = &mut Worker::new(&plain).unwrap();
    for trial in &trials {
        let number = |name: &String| trial.test.get(name).and_then(Value::number).expect("it is a number");
        assert!([-1.5, 0.0, 1.5].contains(&number(&settings[0])));
        assert!((20.0..=28.0).contains(&number(&settings[1])) && (-2.0..=2.0).contains(&number(&settings[3])));
        let world: Values = ["speed", "distance"]
            .map(|name| (name.to_owned(), trial.test.get(name).unwrap().clone()))
            .into_iter()
            .collect();
        assert_eq!(worker.run(trial.index, &world).0.trace_hash, trial.trace_hash);
    }
    assert_ne!(trials[0].test.get(&settings[1]), trials[1].test.get(&settings[1]));
    // Closed, there is nothing new.
    let (_, closed) = tests_of(study().open_cameras(&VariedCameras::from(standard_cameras())), 3);
    assert_eq!(closed, before);
}

#[test]
fn each_test_is_recorded_with_the_settings_that_it_gives_and_says_which_they_are() {
    if !can_draw() {
        return;
    }
    let cameras = varied();
    let (study, trials) = tests_of(of("pedestrian-crossing").open_cameras(&cameras), 3);
    let dir = tempfile::tempdir().expect("a folder");
    let dataset = Dataset::open(dir.path(), cameras.clone(), Kept::ALL, None).expect("a new data set");
    let mut projector = Projector::new(cameras.nominal(), Kept::ALL.outputs()).expect("there is an adapter");
    let mut worker = Worker::new(&study).expect("it can be run");
    for trial in &trials {
        dataset.record(&mut worker, trial, &mut projector).expect("it is recorded");
        let folder = dir.path().join(format!("{:06}", trial.index));
        let text = fs::read(folder.join("calibration.json")).expect("a file");
        let calibration: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
        let front = &calibration["cameras"]["front"];
        let given = |name: &str| trial.test.get(&format!("camera.front.{name}")).and_then(Value::number);
        for name in ["focal_mm", "up", "pitch", "exposure"] {
            assert_eq!(front["varied"][name].as_f64(), given(name), "{name}");
        }
        let focal = front["K"][0][0].as_f64().expect("a number");
        assert!((focal - given("focal_mm").expect("it is there") / 36.0 * 48.0).abs() < 1e-9, "{focal}");
        assert_eq!(front["camera_to_car"][2][3].as_f64(), given("up"));
        // The image is that of these very cameras.
        let own = cameras.of_test(&trial.test);
        let (number, frame) = frames(&study, trial, &own).swap_remove(0);
        let image = fs::read(folder.join(format!("front/rgb/{number:06}.png"))).expect("an image");
        let expected = image::png(image::Pixels::Colours(&frame.rgb.expect("colours")), own.all["front"].resolution);
        assert!(image == expected.expect("it can be written"));
    }
}

#[test]
fn cameras_are_written_with_all_settings_in_one_order_whatever_was_said_of_them() {
    let core = r#""resolution":[48,32],"focal_mm":24.0,"sensor_mm":36.0,"position":[0.3,0.0,1.35],"yaw_pitch_roll":[0.0,0.0,0.0],"rate":2.0,"latency":0.0,"dropped":0.0"#;
    let lens = r#""motion":0.0,"motion_angle":0.0,"defocus":0.0,"blur":0.5,"vignetting":0.0,"exposure":-1.0,"full_well":0.0,"read_noise":0.0"#;
    let mut said = cameras("exposure = -1\nblur = 0.5\n");
    paracosm_render::camera_settings().complete(&mut said);
    let written = serde_json::to_string(&said).expect("it is JSON");
    assert_eq!(written, format!(r#"{{"seed":0,"camera":{{"front":{{{core},{lens}}}}}}}"#));
    assert_eq!(serde_json::from_str::<Cameras>(&written).expect("cameras"), said);
}
