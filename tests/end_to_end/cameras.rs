//! What cameras see of tests, by the command line: `record`, `replay --camera` and `doctor`.

#[path = "../../engine/render/tests/support/adapter.rs"]
mod adapter;

use crate::common::{fuzz, refused, stderr, stdout, succeeds};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// Whether there is something to draw with; a note where there is not, unless somebody insists.
pub fn can_draw() -> bool {
    adapter::unless_missing(paracosm::render::adapter()).is_some()
}

/// The default cameras, but small and slow.
fn write_cameras(dir: &Path) {
    let printed = stdout(&succeeds(fuzz(dir, &["record", "--print-cameras"])));
    let small = printed.replace("[640, 360]", "[40, 24]").replace("rate = 10.0", "rate = 1.0");
    assert_ne!(small, printed);
    fs::write(dir.join("cameras.toml"), small).expect("a file");
}

#[test]
fn a_recording_is_a_campaign_with_images_and_can_be_resumed_and_replayed() {
    if !can_draw() {
        return;
    }
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    write_cameras(dir);
    let record = ["record", "--budget", "2", "--cameras", "cameras.toml", "--out", "images"];
    let first = succeeds(fuzz(dir, &record));
    assert!(stderr(&first).contains("of 2 tests written to images"), "{}", stderr(&first));
    let image = dir.join("images/000001/front/rgb/000000.png");
    let before = fs::read(&image).expect("an image");
    fs::remove_dir_all(dir.join("images/000001")).expect("a folder");
    let resumed = succeeds(fuzz(dir, &[&record[..], &["--resume", "--jobs", "1"]].concat()));
    assert!(stderr(&resumed).contains("of 1 test written to images"), "{}", stderr(&resumed));
    assert!(before == fs::read(&image).expect("an image"));
    refused(&fuzz(dir, &[&record[..], &["--resume", "--outputs", "rgb"]].concat()), &["other cameras, outputs"]);

    let replay = ["replay", "images", "1", "--cameras", "cameras.toml", "--camera"];
    succeeds(fuzz(dir, &[&replay[..], &["front.gif"]].concat()));
    succeeds(fuzz(dir, &[&replay[..], &["front"]].concat()));
    assert!(before == fs::read(dir.join("front/000000.png")).expect("an image"));
    let film = fs::read(dir.join("front.gif")).expect("a film");
    let mut frames = gif::DecodeOptions::new().read_info(&film[..]).expect("a GIF");
    assert_eq!((frames.width(), frames.height()), (40, 24));
    let mut count = 0;
    while frames.read_next_frame().expect("a frame").is_some() {
        count += 1;
    }
    assert_eq!(count, fs::read_dir(dir.join("front")).expect("a folder").count());
    succeeds(fuzz(dir, &[&replay[..], &["front.mp4"]].concat()));
    shows_the_same(dir, "front.mp4", "front", count);
    succeeds(fuzz(dir, &[&replay[..], &["front.gif"]].concat()));
    refused(&fuzz(dir, &[&replay[..], &["front"]].concat()), &["front exists"]);
}

#[test]
fn a_machine_without_a_desktop_prints_no_message_of_the_graphics_driver() {
    if !can_draw() {
        return;
    }
    let mut program = Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"));
    let doctor = succeeds(program.arg("doctor").env_remove("XDG_RUNTIME_DIR").output().expect("it runs"));
    assert!(stdout(&doctor).contains("graphics adapter"), "{}", stdout(&doctor));
    assert_eq!(stderr(&doctor), "");
}

#[test]
fn pycocotools_makes_masks_of_a_recording_and_viewers_show_classes_in_colours() {
    if !can_draw() {
        return;
    }
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    write_cameras(dir);
    let record = ["record", "grid-traffic", "--budget", "2", "--cameras", "cameras.toml", "--out", "images"];
    succeeds(fuzz(dir, &record));
    let file = fs::File::open(dir.join("images/000001/front/semantic/000000.png")).expect("an image");
    let image = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
    let palette = image.info().palette.as_ref().expect("a palette");
    // The colour of roads in CARLA and Cityscapes.
    assert_eq!(palette[3..6], [128, 64, 128]);
    let has_judge = Command::new("python3").args(["-c", "import pycocotools"]).stderr(Stdio::null()).status();
    if !has_judge.is_ok_and(|status| status.success()) {
        eprintln!("no pycocotools: the masks are not compared");
        return;
    }
    let judge = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/end_to_end/coco_judge.py");
    let judged =
        succeeds(Command::new("python3").args([judge, "images/annotations.json"]).current_dir(dir).output().unwrap());
    let count: usize = stdout(&judged).trim().parse().expect("a number");
    assert!(count > 20, "only {count} objects were compared");
}

#[test]
fn all_parameters_of_a_scenario_can_be_fixed_if_a_setting_of_a_camera_is_open() {
    if !can_draw() {
        return;
    }
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    write_cameras(dir);
    let fixed = ["record", "--set", "speed=1", "--set", "distance=9", "--cameras", "cameras.toml", "--budget", "2"];
    let one = succeeds(fuzz(dir, &[&fixed[..], &["--out", "one"]].concat()));
    assert!(stderr(&one).contains("of 1 test written"), "{}", stderr(&one));
    let cameras = fs::read_to_string(dir.join("cameras.toml")).expect("a file");
    let opened = cameras.replace("focal_mm = 24.0", "focal_mm = \"10..50\"");
    assert_ne!(opened, cameras);
    fs::write(dir.join("cameras.toml"), opened).expect("a file");
    let recorded = succeeds(fuzz(dir, &fixed));
    assert!(stderr(&recorded).contains("of 2 tests written"), "{}", stderr(&recorded));
}

/// Checks that a film has so many pictures of 40 x 24 pixels, and, where there is something that can decode it, that
/// they are hardly other than those in a folder.
fn shows_the_same(dir: &Path, film: &str, folder: &str, count: usize) {
    let file = fs::read(dir.join(film)).expect("a film");
    let place = file.windows(4).position(|kind| kind == b"stsz").expect("sizes of pictures");
    let sizes = &file[place + 12..];
    assert_eq!(u32::from_be_bytes([sizes[0], sizes[1], sizes[2], sizes[3]]) as usize, count);
    let decoder = ["-v", "error", "-i", film, "-f", "rawvideo", "-pix_fmt", "rgb24", "-fps_mode", "passthrough", "-"];
    let Ok(decoded) = std::process::Command::new("ffmpeg").args(decoder).current_dir(dir).output() else {
        eprintln!("SKIPPED: no ffmpeg, so that nobody looks at the pictures of {film}");
        return;
    };
    assert!(decoded.status.success(), "{}", stderr(&decoded));
    let frames = decoded.stdout.chunks_exact(40 * 24 * 3);
    assert_eq!(frames.len(), count);
    for (number, frame) in frames.enumerate() {
        let image = fs::File::open(dir.join(folder).join(format!("{number:06}.png"))).expect("an image");
        let mut reader = png::Decoder::new(std::io::BufReader::new(image)).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("it fits into memory")];
        reader.next_frame(&mut pixels).expect("an image");
        let apart: u64 = pixels.iter().zip(frame).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        let mean = apart as f64 / pixels.len() as f64;
        assert!(mean < 6.0, "picture {number} is {mean} off on average");
    }
}

#[test]
fn settings_of_cameras_vary_with_the_tests_and_stand_in_the_log() {
    if !can_draw() {
        return;
    }
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    write_cameras(dir);
    let closed = fs::read_to_string(dir.join("cameras.toml")).expect("a file");
    let open =
        closed.replace("exposure = 0.0", "exposure = \"-2..2\"").replace("[0.0, 2.0, 0.0]", "[0.0, \"0..4\", 0.0]");
    fs::write(dir.join("cameras.toml"), &open).expect("a file");
    let record = ["record", "--budget", "3", "--cameras", "cameras.toml", "--outputs", "rgb", "--out", "images"];
    succeeds(fuzz(dir, &record));
    let log = fs::read_to_string(dir.join("images/trials.jsonl")).expect("a log");
    let third: serde_json::Value = serde_json::from_str(log.lines().nth(2).expect("a third test")).expect("JSON");
    let (exposure, pitch) = (&third["test"]["camera.front.exposure"], &third["test"]["camera.front.pitch"]);
    let calibration = fs::read_to_string(dir.join("images/000002/calibration.json")).expect("a file");
    let calibration: serde_json::Value = serde_json::from_str(&calibration).expect("JSON");
    let front = &calibration["cameras"]["front"];
    assert_eq!((&front["varied"]["exposure"], &front["yaw_pitch_roll"][1]), (exposure, pitch));
    // A replay films through the very cameras of its test.
    succeeds(fuzz(dir, &["replay", "images", "2", "--cameras", "cameras.toml", "--camera", "front"]));
    let image = |path: &str| fs::read(dir.join(path)).expect("an image");
    assert!(image("front/000002.png") == image("images/000002/front/rgb/000002.png"));
    // Another range is another study.
    fs::write(dir.join("cameras.toml"), open.replace("-2..2", "-1..1")).expect("a file");
    refused(&fuzz(dir, &[&record[..], &["--resume"]].concat()), &["images"]);
    fs::write(dir.join("cameras.toml"), open.replace("-2..2", "2..-2")).expect("a file");
    refused(
        &fuzz(dir, &record),
        &["cameras.toml, line 22: camera `front`: `exposure` is \"2..-2\", expected \"LO..HI\""],
    );
}

#[test]
fn a_driver_that_sees_is_tested_replayed_and_recorded_like_any_other() {
    if !can_draw() {
        return;
    }
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    write_cameras(dir);
    let open = ["oncoming-distractor", "--driver", "lane-camera", "--open", "fog", "--budget", "3"];
    let jobs = |jobs: &str, out: &str| {
        succeeds(fuzz(dir, &[&open[..], &["--jobs", jobs, "--out", out]].concat()));
        fs::read_to_string(dir.join(out).join("trials.jsonl")).expect("a log")
    };
    let log = jobs("1", "one");
    assert_eq!(log.lines().filter(|line| line.contains("\"error\":null")).count(), 3, "{log}");
    assert_eq!(log, jobs("2", "two"));
    let whole = log.split_inclusive('\n').take(1).collect::<String>();
    fs::write(dir.join("two/trials.jsonl"), whole).expect("a file");
    succeeds(fuzz(dir, &[&open[..], &["--jobs", "2", "--out", "two", "--resume"]].concat()));
    assert_eq!(log, fs::read_to_string(dir.join("two/trials.jsonl")).expect("a log"));
    succeeds(fuzz(dir, &["replay", "one", "2", "--camera", "front", "--cameras", "cameras.toml"]));
    // What is filmed where nothing is said is what the driver sees, whose images are larger than those of the file.
    let own = succeeds(fuzz(dir, &["replay", "one", "2", "--camera", "own"]));
    assert!(stderr(&own).contains("images of camera `front` written to own"), "{}", stderr(&own));
    let width =
        |folder: &str| fs::read(dir.join(folder).join("000001.png")).map(|png| png[16..20].to_vec()).expect("an image");
    assert_eq!((width("own"), width("front")), (vec![0, 0, 0, 200], vec![0, 0, 0, 40]));
    let nobody = ["replay", "one", "2", "--camera", "film.mp4", "--through", "fornt"];
    refused(&fuzz(dir, &nobody), &["--through fornt", "expected one of front", "did you mean `front`?"]);
    let record = ["--cameras", "cameras.toml", "--outputs", "rgb", "--out", "images"];
    succeeds(fuzz(dir, &[&["record"][..], &open, &record].concat()));
    let filmed = |path: &str| fs::read(dir.join(path)).expect("an image");
    assert!(filmed("front/000003.png") == filmed("images/000002/front/rgb/000003.png"));
}

#[test]
fn what_cannot_be_recorded_is_said_before_anything_is_run() {
    let dir = tempfile::tempdir().expect("a folder");
    let dir = dir.path();
    succeeds(fuzz(dir, &["--budget", "2"]));
    let film = |path| fuzz(dir, &["replay", "paracosm-out", "0", "--camera", path]);
    refused(&film("front.mp5"), &["`.mp5`", "FILE.mp4", "FILE.gif", "FOLDER", "did you mean `mp4`?"]);
    refused(&film("front.avi"), &["`.avi`", "FILE.mp4"]);
    refused(&fuzz(dir, &["record", "--outputs", "rgb,dept"]), &["unknown output `dept`", "`depth`"]);
    fs::write(dir.join("cameras.toml"), "[camera.front]\nresolutoin = [1, 1]\n").expect("a file");
    refused(
        &fuzz(dir, &["record", "--cameras", "cameras.toml", "--out", "x"]),
        &["cameras.toml, line 2", "resolution"],
    );
    fs::write(dir.join("space.toml"), "[[parameter]]\nname = \"x\"\ninterval = [0.0, 1.0]\n").expect("a file");
    refused(&fuzz(dir, &["record", "--system", "cat", "--space", "space.toml"]), &["--system"]);
    assert!(!dir.join("x").exists());
}

#[test]
fn the_doctor_says_what_there_is_and_what_to_install_where_there_is_nothing() {
    let dir = tempfile::tempdir().expect("a folder");
    let found: serde_json::Value =
        serde_json::from_str(&stdout(&succeeds(fuzz(dir.path(), &["doctor", "--format", "json"])))).expect("JSON");
    assert_eq!(found["version"], env!("CARGO_PKG_VERSION"));
    assert!(found["drivers"].as_array().expect("a list").iter().any(|name| name == "aeb"));
    match paracosm::render::adapter() {
        Ok(adapter) => {
            assert_eq!(found["adapter"]["name"], adapter.name);
            let speeds = found["speed"].as_array().expect("a list");
            assert_eq!(speeds.len(), 3);
            assert!(speeds.iter().all(|speed| speed["frames_per_second"].as_f64() > Some(0.0)));
        }
        Err(_) => {
            assert!(found["adapter"].is_null());
            assert!(found["problem"].as_str().expect("there is one").contains("mesa-vulkan-drivers"));
        }
    }
}

/// A machine whose drivers are hidden is one without an adapter.
#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_only_what_needs_cameras_is_refused() {
    let dir = tempfile::tempdir().expect("a folder");
    let blind = |arguments: &[&str]| {
        std::process::Command::new(env!("CARGO_BIN_EXE_paracosm-fuzz"))
            .args(arguments)
            .env("VK_DRIVER_FILES", "/nonexistent")
            .env("VK_ICD_FILENAMES", "/nonexistent")
            .current_dir(dir.path())
            .output()
            .expect("the program starts")
    };
    succeeds(blind(&["--budget", "2"]));
    refused(&blind(&["record", "--budget", "2", "--out", "images"]), &["mesa-vulkan-drivers"]);
    refused(&blind(&["replay", "paracosm-out", "0", "--camera", "front.gif"]), &["mesa-vulkan-drivers"]);
    let seeing = ["follow-leader", "--driver", "lane-camera", "--budget", "2", "--out", "seen"];
    refused(&blind(&seeing), &["the driver sees through cameras", "mesa-vulkan-drivers"]);
    assert!(!dir.path().join("images").exists() && !dir.path().join("seen").exists());
    let told = stdout(&succeeds(blind(&["doctor", "--format", "table"])));
    assert!(told.contains("none") && told.contains("apt install mesa-vulkan-drivers"), "{told}");
}
