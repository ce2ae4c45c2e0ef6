//! What recordings are as a whole: whose noise they have, what is missing in them, and how they are put together.

use super::*;
use paracosm_campaign::Error;
use paracosm_campaign::cameras::VariedCameras;
use paracosm_render::{Camera, Optics};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The usual cameras with a change.
fn changed(more: &str, change: impl Fn(&mut CameraSpec)) -> Cameras {
    let mut cameras = cameras(more);
    cameras.all.values_mut().for_each(change);
    cameras
}

/// The numbers of the images of a camera that were not lost.
fn kept(film: &Film) -> Vec<u64> {
    film.shots[0].iter().map(|shot| shot.number).collect()
}

/// The colours of the first image of a film.
fn first_image(film: &Film, cameras: &Cameras) -> Vec<u8> {
    let mut projector =
        Projector::new(cameras, "rgb".parse::<Kept>().expect("it is one").outputs()).expect("an adapter");
    let alone = Film { shots: vec![film.shots[0][..1].to_vec()], ..film.clone() };
    let mut colours = Vec::new();
    let show = |mut pictures: Vec<Developed<'_>>| {
        colours = pictures.remove(0).1.expect("it is outside").frame.rgb.expect("it was asked for");
        Ok(())
    };
    projector.show(&alone, 0, show).expect("it is drawn");
    colours
}

#[test]
fn every_test_has_noise_of_its_own_and_loses_images_of_its_own_and_the_same_each_time() {
    let (study, trials) = two_tests();
    let noisy = changed("dropped = 0.5\nread_noise = 500.0\n", |camera| camera.rate = 20.0);
    let film = |place: usize| filmed(&study, &trials[place], &noisy).expect("it can be filmed");
    let (first, second) = (film(0), film(1));
    assert_eq!((kept(&first), first.seed), (kept(&film(0)), film(0).seed));
    let lost = |film: &Film| (0..40).filter(|number| !kept(film).contains(number)).collect::<Vec<u64>>();
    assert!(lost(&first).len() > 5 && lost(&first) != lost(&second), "{:?} {:?}", lost(&first), lost(&second));
    if can_draw() {
        let other = Film { seed: second.seed, ..first.clone() };
        let image = first_image(&first, &noisy);
        assert!(image == first_image(&first, &noisy));
        let different = image.iter().zip(first_image(&other, &noisy)).filter(|(a, b)| **a != *b).count();
        assert!(4 * different > image.len(), "{different} of {} numbers differ", image.len());
    }
}

#[test]
fn a_camera_inside_a_body_is_said_and_marked() {
    if !can_draw() {
        return;
    }
    let (study, trials) = tests_of(of("follow-leader").fix("gap", 30.0), 1);
    let ahead = changed("", |camera| {
        camera.position = [30.0, 0.0, 0.6];
        camera.rate = 10.0;
    });
    let dir = tempfile::tempdir().expect("a folder");
    let dataset = Dataset::open(dir.path(), ahead.clone(), Kept::ALL, None).expect("a new data set");
    let mut projector = Projector::new(&ahead, Kept::ALL.outputs()).expect("there is an adapter");
    let mut worker = Worker::new(&study).expect("it can be run");
    let recorded = dataset.record(&mut worker, &trials[0], &mut projector).expect("it is recorded");
    assert_eq!(recorded.notes.len(), 1, "{recorded:?}");
    assert!(
        recorded.notes[0].contains("of camera `front` left out: the camera was inside `leader`, first at "),
        "{recorded:?}"
    );
    let files = files(&dir.path().join("000000"));
    let controls = String::from_utf8(files[Path::new("controls.csv")].clone()).expect("text");
    let (inside, outside): (Vec<_>, Vec<_>) = controls.lines().skip(1).partition(|line| line.ends_with(",leader"));
    assert!(!inside.is_empty() && outside.len() == recorded.images, "{controls}");
    assert!(recorded.notes[0].starts_with(&inside.len().to_string()), "{recorded:?}");

    let lost = cameras("dropped = 1.0\n");
    let dir = tempfile::tempdir().expect("a folder");
    let dataset = Dataset::open(dir.path(), lost.clone(), Kept::ALL, None);
    let mut projector = Projector::new(&lost, Kept::ALL.outputs()).expect("there is an adapter");
    let recorded = dataset.and_then(|dataset| dataset.record(&mut worker, &trials[0], &mut projector));
    let recorded = recorded.expect("it is recorded");
    assert!(recorded.images == 0 && recorded.notes[0].contains("`front` has no image"), "{recorded:?}");
}

#[test]
fn a_camera_behind_the_car_sees_it_and_one_within_it_does_not() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let own = |cameras: &Cameras| {
        let (_, frame) = frames(&study, &trials[0], cameras).swap_remove(0);
        frame.instance.expect("it was asked for").iter().filter(|id| **id == 1).count()
    };
    assert_eq!(own(&cameras("")), 0);
    let chase = changed("", |camera| {
        camera.position = [-8.0, 0.0, 4.0];
        camera.yaw_pitch_roll = [0.0, 20.0, 0.0];
    });
    let pixels = own(&chase);
    assert!((20..48 * 32 / 2).contains(&pixels), "{pixels} pixels");
}

#[test]
fn all_tests_are_one_set_of_boxes_whose_files_there_are() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let parsed = |path: &Path| -> serde_json::Value {
        serde_json::from_slice(&fs::read(path).expect("a file")).expect("it is JSON")
    };
    let list = |value: &serde_json::Value, name: &str| value[name].as_array().expect("a list").clone();
    for (outputs, named) in [("semantic,boxes", true), ("boxes", false)] {
        let dir = tempfile::tempdir().expect("a folder");
        recorded(dir.path(), &cameras(""), outputs.parse().expect("outputs"), &trials, &study);
        let all = parsed(&dir.path().join("annotations.json"));
        let each: Vec<_> =
            ["000000", "000001"].map(|test| parsed(&dir.path().join(test).join("annotations.json"))).into();
        let mut next = 0;
        for (name, key) in [("images", "id"), ("annotations", "id")] {
            let ids: Vec<_> = list(&all, name).iter().map(|entry| entry[key].as_u64().expect("a number")).collect();
            assert_eq!(ids, (1..=ids.len() as u64).collect::<Vec<_>>(), "{name}");
            assert_eq!(ids.len(), each.iter().map(|test| list(test, name).len()).sum::<usize>());
            next = ids.len();
        }
        assert!(next > 0, "something is seen");
        let first = list(&each[0], "images").len() as u64;
        let later = list(&each[1], "annotations")[0]["image_id"].as_u64().expect("a number");
        let place = list(&each[0], "annotations").len();
        assert_eq!(list(&all, "annotations")[place]["image_id"], first + later);
        assert_eq!(all["categories"], each[0]["categories"]);
        for image in list(&all, "images") {
            let file = image.get("file_name").map(|name| dir.path().join(name.as_str().expect("a path")));
            assert_eq!(file.is_some_and(|file| file.is_file()), named, "{image}");
            assert_eq!(image.get("file_name").is_some(), named, "{image}");
        }
    }
}

#[test]
fn a_clip_leaves_what_is_not_its_own_alone() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let dir = tempfile::tempdir().expect("a folder");
    for foreign in ["foo.part", ".foo.0.part", ".film.gif.0.part"] {
        fs::create_dir(dir.path().join(foreign)).expect("a folder");
        fs::write(dir.path().join(foreign).join("999999.png"), "x").expect("a file");
    }
    let foreign = files(dir.path());
    let mut worker = Worker::new(&study).expect("it can be run");
    let mut clip = |name: &str, cameras: &Cameras| {
        Clip::new(&dir.path().join(name)).and_then(|clip| clip.write(&mut worker, &trials[0], cameras))
    };
    for name in ["foo", "film.gif", "film.mp4"] {
        let refused = clip(name, &cameras("dropped = 1.0\n")).expect_err("there is nothing to see").to_string();
        assert!(refused.contains("saw nothing") && refused.contains("`dropped` is 1"), "{refused}");
        assert_eq!(files(dir.path()), foreign);
    }
    let film = filmed(&study, &trials[0], &cameras("")).expect("it can be filmed");
    for name in ["foo", "film.gif", "film.mp4"] {
        let written = clip(name, &cameras("")).expect("it is written");
        assert!(written[0].starts_with(&format!("{} images of camera `front`", film.shots[0].len())), "{written:?}");
    }
    let after = files(dir.path());
    assert!(foreign.iter().all(|(path, contents)| after.get(path) == Some(contents)));
    assert_eq!(after.len(), foreign.len() + film.shots[0].len() + 2);
}

#[test]
fn a_clip_that_is_interrupted_or_cannot_be_written_leaves_nothing_behind() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let dir = tempfile::tempdir().expect("a folder");
    let mut worker = Worker::new(&study).expect("it can be run");
    for name in ["foo", "film.gif", "film.mp4"] {
        let clip = Clip::new(&dir.path().join(name)).expect("it is new").until(Arc::new(AtomicBool::new(true)));
        let stopped = clip.write(&mut worker, &trials[0], &cameras("")).expect_err("it was stopped");
        assert!(matches!(stopped, Error::Interrupted), "{stopped}");
        assert_eq!(fs::read_dir(dir.path()).expect("a folder").count(), 0, "{name}");
    }
    // Somebody makes a folder of the film's name meanwhile.
    let clip = Clip::new(&dir.path().join("film.mp4")).expect("it is new");
    fs::create_dir_all(dir.path().join("film.mp4/theirs")).expect("a folder");
    clip.write(&mut worker, &trials[0], &cameras("")).expect_err("the name is taken");
    let left: Vec<_> =
        fs::read_dir(dir.path()).expect("a folder").map(|entry| entry.expect("an entry").file_name()).collect();
    assert_eq!(left, ["film.mp4"]);
}

#[test]
fn a_recording_that_fails_half_way_leaves_no_part_of_the_test_behind() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let dir = tempfile::tempdir().expect("a folder");
    let dataset = Dataset::open(dir.path(), cameras(""), Kept::ALL, None).expect("a new data set");
    let mut projector = Projector::new(&cameras(""), Kept::ALL.outputs()).expect("there is an adapter");
    let mut worker = Worker::new(&study).expect("it can be run");
    fs::write(dir.path().join("000000.part"), "no folder").expect("a file");
    dataset.record(&mut worker, &trials[0], &mut projector).expect_err("a file is in the way");
    fs::remove_file(dir.path().join("000000.part")).expect("a file");
    dataset.record(&mut worker, &trials[0], &mut projector).expect("it is recorded");
    let mut left: Vec<_> =
        fs::read_dir(dir.path()).expect("a folder").map(|entry| entry.expect("an entry").file_name()).collect();
    left.sort();
    assert_eq!(left, ["000000", "recording.json"]);
}

#[test]
fn images_that_are_too_large_for_the_adapter_are_refused_with_the_name_of_their_camera() {
    if !can_draw() {
        return;
    }
    let mut projector = Projector::new(&cameras(""), Kept::ALL.outputs()).expect("there is an adapter");
    let most = projector.adapter().max_image;
    let of = |width: u32| {
        let mut optics = Optics::of(&cameras("")).expect("sound cameras");
        optics[0].camera = Camera::new(width, 1, 24.0, 36.0).expect("a camera");
        optics
    };
    let refused = projector.take(of(most + 1)).expect_err("it is too large").to_string();
    assert!(refused.contains("camera `front`") && refused.contains(&(most + 1).to_string()), "{refused}");
    projector.take(of(most)).expect("it is as large as can be");
}

#[test]
fn a_camera_faster_than_the_ticks_of_a_scenario_is_refused() {
    let (study, trials) = two_tests();
    let fast = changed("", |camera| camera.rate = 101.0);
    let opened = of("pedestrian-crossing").open_cameras(&VariedCameras::from(fast.clone())).build();
    for said in [opened.map(drop), filmed(&study, &trials[0], &fast).map(drop)] {
        let said = said.expect_err("it is too fast").to_string();
        assert!(said.contains("camera `front`: `rate` is 101 Hz, expected at most 100 Hz"), "{said}");
    }
    let tick = changed("", |camera| camera.rate = 100.0);
    of("pedestrian-crossing").open_cameras(&VariedCameras::from(tick)).build().expect("an image a tick");
}

#[test]
fn a_parked_car_that_exists_only_in_pictures_is_a_crowd_in_the_labels() {
    if !can_draw() {
        return;
    }
    let (study, trials) = tests_of(of("pedestrian-crossing"), 1);
    let wide = changed("", |camera| camera.resolution = [160, 100]);
    let textured = paracosm_campaign::cameras::VariedCameras::from(wide).in_look(paracosm_render::Look::Textured);
    let dir = tempfile::tempdir().expect("a folder");
    let dataset = Dataset::open(dir.path(), textured.clone(), Kept::ALL, None).expect("a new data set");
    let mut projector = Projector::new(textured.nominal(), Kept::ALL.outputs()).expect("there is an adapter");
    let mut worker = Worker::new(&study).expect("it can be run");
    dataset.record(&mut worker, &trials[0], &mut projector).expect("it is recorded");
    let text = fs::read_to_string(dir.path().join("000000/annotations.json")).expect("it is there");
    let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let of_kind = |crowd: bool| {
        let all = read["annotations"].as_array().expect("a list").iter();
        all.filter(|one| (one["iscrowd"] == 1) == crowd).map(|one| one["instance"].as_u64()).collect::<Vec<_>>()
    };
    let pictured = |id: &Option<u64>| paracosm_render::is_only_pictured(id.expect("a number") as u16);
    let (crowds, objects) = (of_kind(true), of_kind(false));
    assert!(crowds.len() > 10 && crowds.iter().all(pictured), "{crowds:?}");
    assert!(!objects.is_empty() && !objects.iter().any(pictured), "{objects:?}");
}
