//! The looks of images: what they change, and what they do not.

mod support;

use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, BodyState};
use paracosm_engine::road::RoadSegment;
use paracosm_render::{Atmosphere, Camera, Frame, Look, Scene, Semantic, Stage, SurfaceKind, View, WantedImages};
use std::sync::Arc;
use support::golden::compare;
use support::{EVERYTHING, NOTHING, RGB, camera, look, one, renderer, sheet, street, thing};

/// Bodies of every kind that the looks draw differently, on a road.
fn bodies() -> Vec<BodyState> {
    let mut bodies = Vec::new();
    let mut add = |body: Body, x: f64, y: f64, heading: f64| {
        let pose = Pose { position: [x, y].into(), heading };
        let velocity = [1.0, 0.0].into();
        bodies.push(BodyState { body, pose, velocity, altitude: 0.0, travelled: 0.7 * x, present: true });
    };
    for number in 0..6 {
        let ahead = 9.0 + 7.0 * f64::from(number);
        add(Body::car(), ahead, if number % 2 == 0 { -1.7 } else { 1.8 }, if number % 2 == 0 { 0.0 } else { 3.1 });
        add(if number == 4 { Body::child() } else { Body::adult() }, ahead, -4.6, 0.0);
    }
    add(Body::block(paracosm_engine::object::Class::Building, 10.0, 8.0, 7.0).coloured([165, 95, 75]), 26.0, 12.0, 0.3);
    add(Body::block(paracosm_engine::object::Class::Building, 10.0, 8.0, 7.0), 20.0, -13.0, -1.5);
    add(Body::disc(paracosm_engine::object::Class::Tree, 0.3, 6.0), 12.0, 6.0, 0.0);
    bodies
}

/// A road with bodies in a look.
fn town(version: Look, air: Atmosphere) -> Scene {
    let network = RoadSegment::new(200.0).build().expect("a sound road");
    Stage::in_look(&network, version).scene_of(bodies().iter().enumerate(), air)
}

fn frames(renderer: &mut paracosm_render::Renderer, views: &[View<'_>], wanted: WantedImages) -> Vec<Frame> {
    let frames = renderer.render(views, wanted).expect("the adapter works");
    frames.into_iter().map(|frame| frame.expect("the view is sound")).collect()
}

/// The mean of the absolute differences of two images, in levels from 0 to 255.
fn apart(a: &[u8], b: &[u8]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
}

#[test]
fn a_town_in_the_look_textured() {
    let Some(mut renderer) = renderer() else { return };
    let scene = town(Look::Textured, Atmosphere::default());
    let camera = camera(320, 160);
    let view = View::new(&scene, &camera, Isometry3::translation(0.0, -1.7, 0.0));
    let wanted = WantedImages { rgb: true, semantic: true, shadows: true, ..NOTHING };
    let frame = one(&mut renderer, &view, wanted);
    compare("textured", 320, frame.rgb.as_deref().expect("asked for"));
    let classes = frame.semantic.expect("asked for");
    for class in [Semantic::Road, Semantic::RoadLine, Semantic::Sidewalk, Semantic::Car, Semantic::Pedestrian] {
        assert!(classes.iter().filter(|id| **id == class as u8).count() > 50, "{class:?}");
    }
}

#[test]
fn the_looks_differ_in_colours_and_shapes_and_a_scene_of_the_look_flat_needs_no_textures() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(200, 66);
    let mut seen = |version: Look| {
        let scene = town(version, Atmosphere::default());
        one(&mut renderer, &View::new(&scene, &camera, Isometry3::translation(0.0, -1.7, 0.0)), EVERYTHING)
    };
    let (flat, textured) = (seen(Look::Flat), seen(Look::Textured));
    let off = apart(flat.rgb.as_ref().expect("asked for"), textured.rgb.as_ref().expect("asked for"));
    assert!(off > 4.0, "{off} levels between the looks");
    // All things are where they were.
    let ids =
        |frame: &Frame| frame.alone.as_ref().expect("asked for").iter().map(|extent| extent.id).collect::<Vec<_>>();
    assert_eq!(ids(&flat), ids(&textured));
}

#[test]
fn textured_images_are_the_same_twice_and_in_any_batch_also_with_flat_ones() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(200, 66);
    let scenes: Vec<Scene> = (0..8)
        .map(|index| {
            let version = if index % 3 == 1 { Look::Flat } else { Look::Textured };
            let extinction = if index % 4 == 2 { 0.02 } else { 0.0 };
            town(version, Atmosphere { light: 1.0 - index as f32 / 8.0, extinction, ..Atmosphere::default() })
        })
        .collect();
    let view = |scene| View::new(scene, &camera, Isometry3::translation(0.0, -1.7, 0.0));
    let views: Vec<_> = scenes.iter().map(view).collect();
    let together = frames(&mut renderer, &views, EVERYTHING);
    assert!(frames(&mut renderer, &views, EVERYTHING) == together, "another time, another image");
    let backwards: Vec<_> = views.iter().rev().copied().collect();
    let mut turned = frames(&mut renderer, &backwards, EVERYTHING);
    turned.reverse();
    assert!(turned == together, "the order matters");
    let Some(mut other) = support::renderer() else { return };
    for (view, frame) in views.iter().zip(&together) {
        assert!(one(&mut other, view, EVERYTHING) == *frame, "the company or the renderer matters");
    }
}

/// How much an image of a wide plane changes when the camera moves by 3 cm: the mean over its near half, and over the
/// part from 20 m on.
fn flicker(renderer: &mut paracosm_render::Renderer, surface: SurfaceKind) -> [f64; 2] {
    let of = look([0.3, 0.28, 0.26], surface, Semantic::Road);
    let plane = Arc::new(sheet([-50.0, -300.0], [600.0, 300.0], of));
    let mut scene = support::scene(vec![thing(&plane, [0.0; 3], 0.0, 0)]);
    scene.look = Look::Textured;
    let camera = Camera::new(200, 150, 24.0, 36.0).expect("a sound camera");
    let camera = camera.mounted(Point3::new(0.0, 0.0, 1.5), 0.0, 0.0, 0.0).expect("a sound mount");
    let mut seen = |ahead: f64| {
        let frame = one(renderer, &View::new(&scene, &camera, Isometry3::translation(ahead, 0.4 * ahead, 0.0)), RGB);
        frame.rgb.expect("asked for")
    };
    let (before, after) = (seen(0.0), seen(0.03));
    // A row at d pixels below the horizon shows the plane 1.5 focal / d metres away.
    let row = |metres: f64| 75 + (1.5 * camera.focal_pixels() / metres) as usize;
    let rows = |from: usize, to: usize| apart(&before[600 * from..600 * to], &after[600 * from..600 * to]);
    [rows(row(6.0), 150), rows(76, row(20.0))]
}

#[test]
fn far_ground_does_not_flicker_when_the_camera_moves_a_little() {
    let Some(mut renderer) = renderer() else { return };
    for surface in
        [SurfaceKind::Asphalt, SurfaceKind::Slabs, SurfaceKind::Grass, SurfaceKind::Brick, SurfaceKind::Tiles]
    {
        let [near, far] = flicker(&mut renderer, surface);
        eprintln!("{surface:?}: {near:.2} near, {far:.2} far");
        assert!(near > 0.5, "{surface:?} has no texture: {near} levels");
        assert!(far < 1.0, "{surface:?} flickers far away: {far} levels");
    }
}

#[test]
fn a_body_with_a_colour_of_its_own_keeps_it_and_one_of_the_usual_colour_gets_one_by_its_id() {
    let network = RoadSegment::new(200.0).build().expect("a sound road");
    let stage = Stage::in_look(&network, Look::Textured);
    let pose = Pose { position: [100.0, 0.0].into(), heading: 0.0 };
    let paint = |body: Body, index: usize| {
        let velocity = Vector3::zeros().xy();
        let state = BodyState { body, pose, velocity, altitude: 0.0, travelled: 0.0, present: true };
        let scene = stage.scene_of([(index, &state)], Atmosphere::default());
        let own = scene.instances.iter().find(|instance| instance.id == index as u16 + 1).expect("it is there");
        (own.paint, own.mesh.key())
    };
    let red = paint(Body::car().coloured([170, 30, 30]), 3).0;
    assert!((0..40).all(|index| paint(Body::car().coloured([170, 30, 30]), index).0 == red));
    let mut usual: Vec<_> = (0..400).map(|index| paint(Body::car(), index)).collect();
    assert_eq!(usual, (0..400).map(|index| paint(Body::car(), index)).collect::<Vec<_>>());
    let white = usual.iter().filter(|(paint, _)| paint.iter().all(|part| *part > 0.7)).count();
    assert!((120..190).contains(&white), "{white} of 400 cars are white, expected about 38 %");
    usual.sort_by_key(|(_, mesh)| *mesh);
    usual.dedup_by_key(|(_, mesh)| *mesh);
    assert!(usual.len() >= 8, "{} bodies", usual.len());
}

#[test]
fn no_run_is_needed_to_choose_a_look_and_street_scenes_of_users_take_it_too() {
    let Some(mut renderer) = renderer() else { return };
    let (mut scene, camera) = (street(), camera(200, 66));
    let pose = Isometry3::translation(0.0, -1.7, 0.0);
    let flat = one(&mut renderer, &View::new(&scene, &camera, pose), RGB);
    scene.look = Look::Textured;
    let textured = one(&mut renderer, &View::new(&scene, &camera, pose), RGB);
    assert!(flat.rgb != textured.rgb);
}
