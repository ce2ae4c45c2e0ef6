//! An image is the same with whatever it is drawn.

mod support;

use nalgebra::Isometry3;
use paracosm_render::{Atmosphere, Camera, Frame, Scene, View, WantedImages};
use support::{EVERYTHING, RGB, camera, one, renderer, street};

/// Worlds of different weather, seen by cameras of different sizes, some of each.
fn worlds() -> Vec<(Scene, Camera, Isometry3<f64>)> {
    let sizes = [(128, 128), (200, 66), (200, 66), (97, 31), (128, 128)];
    let world = |index: usize| {
        let mut scene = street();
        let part = index as f32 / 15.0;
        scene.air = Atmosphere {
            light: 1.0 - part,
            extinction: if index % 4 == 2 { 0.03 } else { 0.0 },
            ..Atmosphere::default()
        };
        scene.instances.rotate_left(index);
        let (width, height) = sizes[index % sizes.len()];
        (scene, camera(width, height), Isometry3::translation(0.37 * index as f64, -1.7, 0.0))
    };
    (0..15).map(world).collect()
}

fn frames(renderer: &mut paracosm_render::Renderer, views: &[View<'_>], wanted: WantedImages) -> Vec<Frame> {
    let frames = renderer.render(views, wanted).expect("the adapter works");
    frames.into_iter().map(|frame| frame.expect("the view is sound")).collect()
}

#[test]
fn an_image_is_the_same_alone_and_in_any_batch_in_any_order_and_on_any_day() {
    let Some(mut renderer) = renderer() else { return };
    let worlds = worlds();
    let views: Vec<_> = worlds.iter().map(|(scene, camera, pose)| View::new(scene, camera, *pose)).collect();
    let together = frames(&mut renderer, &views, EVERYTHING);
    let backwards: Vec<_> = views.iter().rev().copied().collect();
    let mut turned = frames(&mut renderer, &backwards, EVERYTHING);
    turned.reverse();
    assert!(together == turned, "the order matters");
    let Some(mut other) = support::renderer() else { return };
    for (view, frame) in views.iter().zip(&together) {
        assert!(one(&mut renderer, view, EVERYTHING) == *frame, "the company matters");
        assert!(one(&mut other, view, EVERYTHING) == *frame, "the renderer matters");
    }
}

#[test]
fn an_image_does_not_depend_on_which_others_are_asked_for() {
    let Some(mut renderer) = renderer() else { return };
    let worlds = worlds();
    let views: Vec<_> = worlds.iter().map(|(scene, camera, pose)| View::new(scene, camera, *pose)).collect();
    let all = frames(&mut renderer, &views, WantedImages { shadows: false, ..EVERYTHING });
    for wanted in [
        RGB,
        WantedImages { depth: true, ..support::NOTHING },
        WantedImages { semantic: true, rgb: true, ..support::NOTHING },
    ] {
        for (some, all) in frames(&mut renderer, &views, wanted).into_iter().zip(&all) {
            assert!(if wanted.rgb { some.rgb == all.rgb } else { some.rgb.is_none() });
            assert!(if wanted.depth { some.depth == all.depth } else { some.depth.is_none() });
            assert!(if wanted.semantic { some.semantic == all.semantic } else { some.semantic.is_none() });
            assert!(some.instance.is_none() && some.alone.is_none() && some.linear.is_none());
        }
    }
}

#[test]
fn more_views_than_fit_into_a_batch_are_drawn_in_several() {
    let Some(mut renderer) = renderer() else { return };
    let (scene, camera) = (street(), camera(64, 40));
    let view = |index: usize| View::new(&scene, &camera, Isometry3::translation(0.1 * index as f64, -1.7, 0.0));
    let views: Vec<_> = (0..150).map(view).collect();
    let together = frames(&mut renderer, &views, RGB);
    for index in [0, 63, 64, 127, 128, 149] {
        assert!(one(&mut renderer, &views[index], RGB) == together[index], "view {index} is another");
    }
}

#[test]
fn nothing_asked_for_is_nothing_drawn() {
    let Some(mut renderer) = renderer() else { return };
    assert!(renderer.render(&[], EVERYTHING).expect("the adapter works").is_empty());
    let (scene, camera) = (street(), camera(64, 40));
    let frame =
        one(&mut renderer, &View::new(&scene, &camera, Isometry3::translation(0.0, -1.7, 0.0)), support::NOTHING);
    assert!(frame.rgb.is_none() && frame.depth.is_none() && frame.semantic.is_none() && frame.alone.is_none());
}
