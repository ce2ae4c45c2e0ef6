//! Light, fog and lamps.

mod support;

use nalgebra::{Isometry3, Point3};
use paracosm_render::{Atmosphere, Camera, Instance, Scene, Semantic, SurfaceKind, View, WantedImages};
use std::sync::Arc;
use support::{RGB, camera, cuboid, look, one, renderer, scene, sheet, street, thing};

/// The transfer function of sRGB (IEC 61966-2-1), as a number from 0 to 255.
fn srgb(linear: f32) -> f64 {
    let linear = f64::from(linear);
    255.0 * if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

const LIGHT: WantedImages = WantedImages { rgb: true, linear: true, depth: true, ..support::NOTHING };

fn mean(rgb: &[u8]) -> f64 {
    rgb.iter().map(|part| f64::from(*part)).sum::<f64>() / rgb.len() as f64
}

#[test]
fn fog_is_that_of_koschmieder() {
    let Some(mut renderer) = renderer() else { return };
    let (camera, pose) = (camera(160, 100), Isometry3::translation(0.0, -1.7, 0.0));
    let mut scene = street();
    // An evening without lamps, and noon.
    for light in [0.7, 1.0] {
        scene.air = Atmosphere { light, ..Atmosphere::default() };
        let clear = one(&mut renderer, &View::new(&scene, &camera, pose), LIGHT);
        for visibility in [20.0, 60.0, 300.0, 5000.0] {
            scene.air.extinction = 3.912 / visibility;
            let fogged = one(&mut renderer, &View::new(&scene, &camera, pose), LIGHT);
            let (light, depth) = (clear.linear.as_ref().expect("asked for"), clear.depth.as_ref().expect("asked for"));
            let air = scene.air.colour();
            let mut worst = 0.0_f64;
            for (index, distance) in depth.iter().enumerate().filter(|(_, distance)| distance.is_finite()) {
                let left = libm::expf(-scene.air.extinction * distance);
                for colour in 0..3 {
                    let expected = srgb(light[3 * index + colour] * left + air[colour] * (1.0 - left));
                    let found = f64::from(fogged.rgb.as_ref().expect("asked for")[3 * index + colour]);
                    worst = worst.max((found - expected).abs());
                }
            }
            eprintln!("fog of {visibility} m: at most {worst:.3} / 255 off");
            assert!(worst <= 1.0, "{worst} / 255 off at a visibility of {visibility} m");
        }
    }
}

#[test]
fn colours_are_those_of_linear_light() {
    let Some(mut renderer) = renderer() else { return };
    let (scene, camera) = (street(), camera(160, 100));
    let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::translation(0.0, -1.7, 0.0)), LIGHT);
    let pairs = frame.rgb.iter().flatten().zip(frame.linear.iter().flatten());
    let worst = pairs.map(|(rgb, linear)| (f64::from(*rgb) - srgb(linear.min(1.0))).abs()).fold(0.0, f64::max);
    eprintln!("sRGB: at most {worst:.3} / 255 off");
    // Half is rounding; adapters may compute the transfer function by an approximation.
    assert!(worst <= 1.0, "{worst} / 255 off");
}

#[test]
fn a_wall_gets_the_light_that_the_sun_sends_it() {
    let Some(mut renderer) = renderer() else { return };
    let wall = Arc::new(cuboid([1.0, 40.0, 20.0], look([1.0; 3], SurfaceKind::Plain, Semantic::Wall)));
    let camera = camera(20, 20);
    let mut seen = |azimuth: f32, elevation: f32, light: f32| {
        let mut scene = scene(vec![thing(&wall, [10.0, 0.0, -9.0], 0.0, 0)]);
        scene.air = Atmosphere { light, sun_azimuth: azimuth, sun_elevation: elevation, extinction: 0.0 };
        let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), LIGHT);
        frame.linear.expect("asked for")[0]
    };
    let pi = std::f32::consts::PI;
    let shaded = seen(0.0, 0.5, 1.0);
    // Lambert: what the sun adds goes with the cosine between the wall and the way to it.
    let (straight, slanted) = (seen(pi, 0.5, 1.0) - shaded, seen(pi - 1.0, 0.5, 1.0) - shaded);
    assert!(straight > 0.3, "{straight}");
    assert!((slanted / straight - libm::cosf(1.0)).abs() < 1e-3, "{}", slanted / straight);
    // Half the light is half as bright, and at night the sun is gone.
    assert!((seen(pi, 0.5, 0.5) / seen(pi, 0.5, 1.0) - 0.5).abs() < 0.01);
    assert_eq!(seen(pi, -0.1, 1.0), seen(0.0, -0.1, 1.0));
    assert!(seen(pi, -0.5, 0.0) < 0.03);
}

/// A box on a light floor under a sun that stands to the left.
fn box_in_the_sun() -> Scene {
    let floor = Arc::new(sheet([-50.0, -50.0], [50.0, 50.0], look([0.8; 3], SurfaceKind::Plain, Semantic::Ground)));
    let tower = Arc::new(cuboid([1.0, 1.0, 3.0], look([0.8; 3], SurfaceKind::Plain, Semantic::Static)));
    let mut scene = scene(vec![thing(&floor, [0.0; 3], 0.0, 0), thing(&tower, [12.0, 4.0, 0.0], 0.0, 1)]);
    scene.air = Atmosphere { sun_azimuth: std::f32::consts::FRAC_PI_2, sun_elevation: 0.6, ..Atmosphere::default() };
    scene
}

#[test]
fn shadows_fall_where_the_sun_is_hidden() {
    let Some(mut renderer) = renderer() else { return };
    let (scene, camera) = (box_in_the_sun(), camera(320, 200));
    let wanted = WantedImages { shadows: true, linear: true, instance: true, ..support::NOTHING };
    let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), wanted);
    let brightness = |place: Point3<f64>| {
        let at = camera.project(&(camera.pose(&Isometry3::identity()).inverse() * place)).expect("before the camera");
        let index = at.y as usize * 320 + at.x as usize;
        assert_eq!(frame.instance.as_ref().expect("asked for")[index], 0, "{place} is not on the floor");
        frame.linear.as_ref().expect("asked for")[3 * index]
    };
    let length = 3.0 / libm::tan(0.6);
    let lit = brightness(Point3::new(12.0, -3.0, 0.0));
    let edge = 3.5 - length;
    for (y, expected) in [(edge - 0.5, true), (edge + 0.5, false), (2.0, false), (3.2, false)] {
        assert_eq!(brightness(Point3::new(12.0, y, 0.0)) > 0.9 * lit, expected, "at y = {y}");
    }
    for x in [11.2, 12.8] {
        assert!(brightness(Point3::new(x, 2.0, 0.0)) > 0.9 * lit, "beside the shadow, at x = {x}");
    }
    // Without shadows the same place is as bright as the rest.
    let frame = one(
        &mut renderer,
        &View::new(&scene, &camera, Isometry3::identity()),
        WantedImages { shadows: false, ..wanted },
    );
    let floor = frame.instance.iter().flatten().zip(frame.linear.iter().flatten().step_by(3)).skip(320 * 150);
    assert!(floor.filter(|(id, _)| **id == 0).all(|(_, light)| (light - lit).abs() < 1e-3));
}

#[test]
fn things_out_of_sight_throw_shadows_into_the_image() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(320, 200);
    let floor = Arc::new(sheet([-50.0, -50.0], [50.0, 50.0], look([0.8; 3], SurfaceKind::Plain, Semantic::Ground)));
    let tower = Arc::new(cuboid([1.0, 1.0, 8.0], look([0.8; 3], SurfaceKind::Plain, Semantic::Static)));
    let at = camera.project(&(camera.pose(&Isometry3::identity()).inverse() * Point3::new(14.0, 0.0, 0.0)));
    let index = at.map(|at| at.y as usize * 320 + at.x as usize).expect("before the camera");
    let wanted = WantedImages { shadows: true, linear: true, ..support::NOTHING };
    // The sun shines from where the tower stands: behind the camera, or beside the place that is seen.
    for (place, azimuth) in [([-4.0, 0.0, 0.0], 1.0), ([14.0, 16.0, 0.0], 0.5), ([14.0, -16.0, 0.0], -0.5)] {
        let mut light = |towers: usize| {
            let things = [thing(&floor, [0.0; 3], 0.0, 0), thing(&tower, place, 0.0, 1)];
            let mut scene = scene(things.into_iter().take(1 + towers).collect());
            let sun_azimuth = azimuth * std::f32::consts::PI;
            scene.air = Atmosphere { sun_azimuth, sun_elevation: 0.35, ..Atmosphere::default() };
            let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), wanted);
            frame.linear.expect("asked for")[3 * index]
        };
        assert!(light(1) < 0.9 * light(0), "the tower at {place:?} throws no shadow");
    }
}

#[test]
fn a_level_floor_throws_no_shadow_on_itself_however_low_the_sun() {
    let Some(mut renderer) = renderer() else { return };
    let slope = Arc::new(cuboid([60.0, 60.0, 0.5], look([0.8; 3], SurfaceKind::Plain, Semantic::Ground)));
    let mut scene = scene(vec![thing(&slope, [20.0, 0.0, -0.5], 0.0, 0)]);
    let camera = camera(160, 100);
    for elevation in [0.05, 0.2, 0.8, 1.5] {
        scene.air.sun_elevation = elevation;
        let view = View::new(&scene, &camera, Isometry3::identity());
        let with = one(&mut renderer, &view, WantedImages { shadows: true, ..RGB });
        assert_eq!(with.rgb, one(&mut renderer, &view, RGB).rgb, "with the sun {elevation} rad high");
    }
}

#[test]
fn lamps_shine_at_night_and_not_by_day() {
    let Some(mut renderer) = renderer() else { return };
    let camera: Camera = camera(160, 100);
    let pose = Isometry3::translation(0.0, -1.7, 0.0);
    let mut scene = street();
    scene.air = Atmosphere { light: 0.0, sun_elevation: -0.3, ..Atmosphere::default() };
    let dark = Scene { instances: without_lamps(&scene.instances), ..scene };
    let head_lamps = Some(Point3::new(2.0, 0.0, 0.6));
    let mut seen = |scene: &Scene, head_lamps| {
        let view = View { head_lamps, ..View::new(scene, &camera, pose) };
        mean(&one(&mut renderer, &view, RGB).rgb.expect("asked for"))
    };
    let (nothing, street_lamps, both) = (seen(&dark, None), seen(&scene, None), seen(&scene, head_lamps));
    assert!(nothing > 1.0 && nothing < 30.0, "a dark night of {nothing}");
    assert!(street_lamps > nothing + 5.0, "{street_lamps} against {nothing}");
    assert!(both > street_lamps + 5.0, "{both} against {street_lamps}");
    scene.air = Atmosphere::default();
    assert_eq!(seen(&scene, head_lamps), seen(&scene, None));
}

/// All but the posts, which are the things with lamps more than 4 m up.
fn without_lamps(instances: &[Instance]) -> Vec<Instance> {
    let lamp = |instance: &&Instance| {
        instance
            .mesh
            .vertices()
            .iter()
            .any(|vertex| vertex.surface == SurfaceKind::WhiteLamp && vertex.position[2] > 4.0)
    };
    instances.iter().filter(|instance| !lamp(instance)).cloned().collect()
}

#[test]
fn the_sky_meets_the_fog_at_the_horizon() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(31, 400);
    for extinction in [0.0, 0.002, 0.1] {
        let scene = Scene { air: Atmosphere { extinction, ..Atmosphere::default() }, ..scene(Vec::new()) };
        let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), LIGHT);
        let linear = frame.linear.expect("asked for");
        let horizon = &linear[3 * (31 * 200 + 15)..][..3];
        let air = scene.air.colour();
        assert!(horizon.iter().zip(air).all(|(found, air)| (found - air).abs() < 1e-5), "{horizon:?} is not {air:?}");
        // Upwards it becomes bluer, the less the thicker the fog.
        let up = &linear[3 * 15..][..3];
        assert_eq!(up[2] - up[0] > air[2] - air[0] + 0.02, extinction < 0.05, "{up:?}");
    }
}
