//! Lenses and sensors against their closed forms.

use super::*;

fn camera(width: u32, height: u32) -> Camera {
    Camera::new(width, height, 24.0, 36.0).expect("a sound camera")
}

fn frame(camera: &Camera, light: impl Fn(u32, u32) -> f32) -> Frame {
    let (width, height) = (camera.width(), camera.height());
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let linear = pixels.flat_map(|(column, row)| [light(column, row); 3]).collect();
    Frame {
        camera: camera.clone(),
        rgb: None,
        linear: Some(linear),
        depth: None,
        semantic: None,
        instance: None,
        alone: None,
    }
}

fn moments(kernel: &Kernel) -> (f64, [f64; 2], [f64; 2]) {
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        kernel.shares().iter().map(|(x, y, share)| of(f64::from(*x), f64::from(*y)) * f64::from(*share)).sum()
    };
    (sum(&|_, _| 1.0), [sum(&|x, _| x), sum(&|_, y| y)], [sum(&|x, _| x * x), sum(&|_, y| y * y)])
}

#[test]
fn kernels_keep_all_light_in_its_place_and_are_as_wide_as_they_say() {
    // Counting over pixels adds the variance of a pixel, 1/12, sharing between neighbours that of linear interpolation,
    // 1/6 in the mean. A disc is looked at in places 1/16 apart, so that its radius r is known to 1/32 and r²/4 to
    // r/64.
    let [across, down] = Kernel::gaussian(2.5);
    let cases = [
        (across, [6.25, 0.0], 0.02),
        (down, [0.0, 6.25], 0.02),
        (Kernel::disc(6.0), [9.0 + 1.0 / 12.0, 9.0 + 1.0 / 12.0], 6.0 / 64.0),
        (Kernel::line(12.0, 0.0), [12.0 + 1.0 / 6.0, 0.0], 0.02),
        (Kernel::line(12.0, std::f64::consts::FRAC_PI_2), [0.0, 12.0 + 1.0 / 6.0], 0.02),
        (Kernel::disc(0.01), [0.0, 0.0], 0.0),
    ];
    for (kernel, variance, tolerance) in cases {
        let (sum, mean, found) = moments(&kernel);
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        assert!(mean.iter().all(|mean| mean.abs() < 1e-5), "{mean:?}");
        for axis in 0..2 {
            assert!((found[axis] - variance[axis]).abs() <= tolerance + 1e-9, "{found:?} for {variance:?}");
        }
    }
}

#[test]
fn motion_runs_the_way_it_is_told() {
    let rising = Kernel::line(9.0, std::f64::consts::FRAC_PI_4);
    let both: f64 = rising.shares().iter().map(|(x, y, share)| f64::from(x * y) * f64::from(*share)).sum();
    assert!(both < -3.0, "up is against the rows: {both}");
}

#[test]
fn a_point_becomes_the_kernel_and_an_even_image_stays_as_it_is() {
    let camera = camera(31, 21);
    let kernel = Kernel::line(7.0, 0.6);
    let point = frame(&camera, |column, row| f32::from(column == 15 && row == 10));
    let spread = kernel.apply(point.linear.as_deref().expect("it has light"), 31);
    for (x, y, share) in kernel.shares() {
        assert_eq!(spread[3 * ((10 + y) as usize * 31 + (15 + x) as usize)], *share);
    }
    let even = frame(&camera, |_, _| 0.25);
    let spread = Kernel::disc(4.0).apply(even.linear.as_deref().expect("it has light"), 31);
    assert!(spread.iter().all(|value| (value - 0.25).abs() < 1e-6));
}

/// A camera with these settings of its lens.
fn spec(lens: &[(&str, f64)]) -> CameraSpec {
    let lens = lens.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    CameraSpec { resolution: [8, 8], position: [0.0, 0.0, 1.0], lens, ..CameraSpec::default() }
}

/// The light after the lens, before it is written in sRGB.
fn through(lens: &[(&str, f64)], frame: &Frame, chance: Chance) -> Vec<f32> {
    let mut light = Light { values: frame.linear.clone().expect("it has light"), camera: &frame.camera };
    let lens = Lens::of(&spec(lens));
    let [(effect, values)] = lens.effects.as_slice() else { panic!("one effect is at work") };
    (effect.apply)(values, &mut light, &mut { chance });
    light.values
}

#[test]
fn corners_lose_light_by_the_fourth_power_of_the_cosine_and_a_stop_doubles_it() {
    let camera = camera(32, 32);
    let even = frame(&camera, |_, _| 0.1);
    let light = through(&[("vignetting", 1.0), ("exposure", 1.0)], &even, Chance::of(0, "", 0));
    let off_axis = libm::atan(std::f64::consts::SQRT_2 * 15.5 / camera.focal_pixels());
    let expected = 0.2 * libm::pow(libm::cos(off_axis), 4.0);
    assert!((f64::from(light[0]) - expected).abs() < 1e-6, "{} for {expected}", light[0]);
    let middle = light[3 * (16 * 32 + 16)];
    assert!((middle - 0.2).abs() < 1e-3, "{middle}");
}

#[test]
fn noise_keeps_the_mean_and_has_the_variance_of_counting_and_reading() {
    let camera = camera(100, 100);
    for (full_well, read_noise, level) in [(2000.0, 0.0, 0.3), (2000.0, 30.0, 0.5), (0.0, 100.0, 0.5)] {
        let even = frame(&camera, |_, _| level);
        let settings = [("full_well", full_well), ("read_noise", read_noise)];
        let light = through(&settings, &even, Chance::of(1, "front", 0));
        let n = light.len() as f64;
        let mean = light.iter().map(|value| f64::from(*value)).sum::<f64>() / n;
        let variance =
            light.iter().map(|value| (f64::from(*value) - mean) * (f64::from(*value) - mean)).sum::<f64>() / (n - 1.0);
        let well = if full_well > 0.0 { full_well } else { noise::USUAL_WELL };
        let shot = if full_well > 0.0 { f64::from(level) * well } else { 0.0 };
        let expected = (shot + read_noise * read_noise) / (well * well);
        // Five standard deviations of a mean and of a variance of so many normal numbers.
        assert!((mean - f64::from(level)).abs() < 5.0 * (expected / n).sqrt(), "{mean} for {level}");
        assert!((variance / expected - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{variance} for {expected}");
    }
}

#[test]
fn noise_is_that_of_the_frame_and_of_no_other() {
    let even = frame(&camera(8, 8), |_, _| 0.5);
    let noisy = Lens::of(&spec(&[("full_well", 500.0), ("read_noise", 5.0)]));
    let image = |name, number| noisy.develop(&even, |_| Chance::of(7, name, number)).expect("it has light");
    assert_eq!(image("front", 3), image("front", 3));
    assert_ne!(image("front", 3), image("front", 4));
    assert_ne!(image("front", 3), image("rear", 3));
}

#[test]
fn light_is_written_in_srgb() {
    for (linear, encoded) in [(-1.0, 0), (0.0, 0), (0.001, 3), (0.215_860_5, 128), (0.5, 188), (1.0, 255), (7.0, 255)] {
        assert_eq!(srgb(linear), encoded, "{linear}");
    }
    let plain = frame(&camera(4, 4), |_, _| 0.5);
    assert!(Lens::default().is_plain() && Lens::of(&spec(&[("motion_angle", 30.0), ("blur", 0.0)])).is_plain());
    assert_eq!(Lens::default().develop(&plain, |_| Chance::of(0, "", 0)), Some(vec![188; 48]));
}
