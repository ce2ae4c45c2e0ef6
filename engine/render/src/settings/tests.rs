//! The table of settings: its messages, and that one effect more is in all that goes by the table.

use super::*;
use crate::lens::{Lens, LensEffect};
use crate::{Camera, Frame, Optics};

fn cameras(lens: &[(&str, f64)]) -> Cameras {
    let lens = lens.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let position = [0.3, 0.0, 1.35];
    let front = CameraSpec {
        resolution: [8, 4],
        focal_mm: 24.0,
        sensor_mm: 36.0,
        position,
        rate: 10.0,
        lens,
        ..CameraSpec::default()
    };
    Cameras { seed: 7, all: [("front".to_owned(), front)].into(), ..Cameras::default() }
}

fn front(lens: &[(&str, f64)]) -> CameraSpec {
    cameras(lens).all["front"].clone()
}

fn refused(change: impl FnOnce(&mut CameraSpec)) -> String {
    let mut camera = front(&[]);
    change(&mut camera);
    camera_settings().check(&camera).expect_err("there is no such camera").to_string()
}

#[test]
fn numbers_out_of_range_are_refused_with_their_key_and_their_range() {
    assert_eq!(camera_settings().check(&front(&[])), Ok(()));
    let lens = |name: &'static str, value: f64| refused(|camera| camera.lens.set(name, value));
    for (said, expected) in [
        (lens("defocus", f64::NAN), "`defocus` is NaN, expected 0 to 64 pixels"),
        (lens("blur", 17.0), "`blur` is 17, expected 0 to 16 pixels"),
        (lens("vignetting", 1.5), "`vignetting` is 1.5, expected 0 to 1 (how much darker corners get: "),
        (lens("full_well", -1.0), "`full_well` is -1, expected 0 to 1e9 electrons"),
        (
            lens("bluur", 1.0),
            "a lens has no key `bluur` (did you mean `blur`?); its keys are motion, motion_angle, defocus, ",
        ),
        (lens("rate", 1.0), "a lens has no key `rate`; its keys are "),
        (refused(|camera| camera.resolution[1] = 0), "`resolution` is [8, 0], expected 1 to 8192 pixels each way"),
        (refused(|camera| camera.rate = 0.0), "`rate` is 0, expected 0.001 to 1000 Hz"),
        (
            refused(|camera| camera.position[2] = 0.0),
            "`position` is [0.3, 0.0, 0.0], expected -100 to 100 m ahead and left, and 0.05 to 100 m up",
        ),
        (
            refused(|camera| camera.yaw_pitch_roll[1] = 1e9),
            "`yaw_pitch_roll` is [0.0, 1000000000.0, 0.0], expected -360 to 360 degrees each",
        ),
        (
            refused(|camera| camera.dropped = 2.0),
            "`dropped` is 2, expected 0 to 1 (the probability that an image is lost)",
        ),
    ] {
        assert!(said.starts_with(expected), "{said}\n{expected}");
    }
}

#[test]
fn no_two_settings_have_one_name_and_examples_are_in_range() {
    let all: Vec<_> = camera_settings().iter().collect();
    for (place, setting) in all.iter().enumerate() {
        assert!(all[..place].iter().all(|earlier| earlier.name != setting.name), "{}", setting.name);
        assert!(setting.admits(setting.example) && setting.default.is_none_or(|default| setting.admits(default)));
    }
    // A key is one list, whose parts stand beside each other.
    let keys = camera_settings().keys();
    assert!(keys.iter().enumerate().all(|(place, key)| !keys[..place].contains(key)), "{keys:?}");
}

#[test]
fn cameras_that_see_the_same_are_the_same_when_they_are_complete() {
    let completed = |lens: &[(&str, f64)]| {
        let mut cameras = cameras(lens);
        camera_settings().complete(&mut cameras);
        cameras
    };
    let said = completed(&[("exposure", 1.0), ("blur", 0.5)]);
    assert_eq!(said, completed(&[("blur", 0.5), ("motion", 0.0), ("exposure", 1.0)]));
    let names: Vec<_> = said.all["front"].lens.iter().map(|(name, _)| name).collect();
    let expected = ["motion", "motion_angle", "defocus", "blur", "vignetting", "exposure", "full_well", "read_noise"];
    assert_eq!(names, expected);
    // A mistake is not lost.
    assert_eq!(completed(&[("bluur", 0.5)]).all["front"].lens.get("bluur"), Some(&0.5));
}

/// An effect of a user's own: it multiplies all light.
static GAIN: LensEffect = LensEffect {
    name: "gain",
    about: "multiplies all light",
    settings: &[CameraSetting::of_lens("gain", "", (0.0, 8.0), "how much more light there is").with_default(1.0)],
    is_idle: |settings| settings == [1.0],
    apply: |settings, light, _| light.values.iter_mut().for_each(|value| *value *= settings[0] as f32),
};
static WITH_GAIN: [&LensEffect; 2] = [&GAIN, EFFECTS[4]];

#[test]
fn one_effect_more_is_in_the_table_in_the_checks_and_in_the_image() {
    let settings = CameraSettings::with(&WITH_GAIN);
    assert_eq!(settings.of_key("gain"), Ok(vec![GAIN.settings[0]]));
    assert_eq!(settings.keys()[settings.keys().len() - 3..], ["gain", "full_well", "read_noise"]);
    assert!(camera_settings().of_key("gain").is_err());

    let flaw = Optics::with(settings, &cameras(&[("gain", 9.0)])).expect_err("it is too much").to_string();
    assert_eq!(flaw, "camera `front`: `gain` is 9, expected 0 to 8 (how much more light there is)");
    let flaw = Optics::of(&cameras(&[("gain", 2.0)])).expect_err("it is another table").to_string();
    assert!(flaw.starts_with("camera `front`: a lens has no key `gain`"), "{flaw}");

    let frame = Frame {
        camera: Camera::of(&front(&[])).expect("a sound camera"),
        rgb: None,
        linear: Some(vec![0.25; 8 * 4 * 3]),
        depth: None,
        semantic: None,
        instance: None,
        alone: None,
    };
    let image = |lens: &[(&str, f64)]| {
        let optics = Optics::with(settings, &cameras(lens)).expect("a sound camera").remove(0);
        (optics.is_plain(), optics.develop(&frame, 0).expect("it has light"))
    };
    // 0.25 and 0.5 in sRGB.
    assert_eq!((image(&[]), image(&[("gain", 2.0)])), ((true, vec![137; 96]), (false, vec![188; 96])));
    let noisy = image(&[("gain", 2.0), ("read_noise", 50.0)]).1;
    assert!(noisy.iter().any(|value| *value != 188) && noisy == image(&[("gain", 2.0), ("read_noise", 50.0)]).1);
    // The noise of an effect does not depend on the effects beside it.
    let (alone, beside) =
        (Lens::with(&[EFFECTS[4]], &front(&[("read_noise", 50.0)])), image(&[("read_noise", 50.0)]).1);
    let chance = |effect: &str| paracosm_engine::sensor::Chance::of(7, &format!("front, {effect}"), 0);
    assert_eq!(alone.develop(&frame, chance), Some(beside));
}
