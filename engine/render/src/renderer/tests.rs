//! What only the renderer itself can see: that it forgets meshes, which mesh of an object it draws, and that it survives the loss
//! of its device.

#[path = "../../tests/support/adapter.rs"]
mod adapter;

use super::Renderer;
use super::prepare::levels;
use crate::{Camera, Instance, Look, Mesh, RenderError, Scene, Semantic, SurfaceKind, Vertex, View, WantedImages};
use nalgebra::Isometry3;
use std::sync::Arc;

fn renderer() -> Option<Renderer> {
    adapter::unless_missing(Renderer::new())
}

/// A board across the way of a camera at the origin.
fn board() -> Scene {
    let corner = |y: f32, z: f32| Vertex {
        position: [0.0, y, z],
        normal: [-1.0, 0.0, 0.0],
        uv: [y, z],
        colour: [0.5; 3],
        surface: SurfaceKind::Plain,
        semantic: Semantic::Wall,
    };
    let corners = vec![corner(-9.0, -9.0), corner(-9.0, 9.0), corner(9.0, 9.0), corner(9.0, -9.0)];
    let mesh = Arc::new(Mesh::new(corners, vec![0, 1, 2, 0, 2, 3]));
    let pose = Isometry3::translation(5.0, 0.0, 0.0);
    Scene {
        instances: vec![Instance { mesh, pose, scale: [1.0; 3], paint: [0.5; 3], id: 3 }],
        air: crate::Atmosphere::default(),
        look: crate::Look::Flat,
    }
}

const INSTANCES: WantedImages = WantedImages {
    instance: true,
    rgb: false,
    linear: false,
    depth: false,
    semantic: false,
    alone: false,
    shadows: false,
};

fn camera() -> Camera {
    Camera::new(7, 5, 24.0, 36.0).expect("a sound camera")
}

#[test]
fn a_mesh_that_nobody_has_any_more_is_forgotten() {
    let Some(mut renderer) = renderer() else { return };
    let (first, second, camera) = (board(), board(), camera());
    let here = Isometry3::identity();
    let both = [View::new(&first, &camera, here), View::new(&second, &camera, here)];
    renderer.render(&both, INSTANCES).expect("the adapter works");
    assert_eq!(renderer.meshes.len(), 2);
    drop(second);
    renderer.render(&[View::new(&first, &camera, here)], INSTANCES).expect("the adapter works");
    assert_eq!(renderer.meshes.len(), 1);
}

#[test]
fn layers_are_used_again_and_those_of_other_sizes_do_not_pile_up() {
    let Some(mut renderer) = renderer() else { return };
    let scene = board();
    for width in 1..12 {
        let camera = Camera::new(width, 5, 24.0, 36.0).expect("a sound camera");
        let view = View::new(&scene, &camera, Isometry3::identity());
        for views in [vec![view; 3], vec![view], vec![view; 70]] {
            assert_eq!(renderer.render(&views, INSTANCES).expect("the adapter works").len(), views.len());
        }
        assert!(renderer.idle.len() <= super::MOST_IDLE);
    }
}

#[test]
fn a_lost_device_is_an_error_and_a_new_renderer_sees_again() {
    let Some(mut renderer) = renderer() else { return };
    let (scene, camera) = (board(), camera());
    let views = [View::new(&scene, &camera, Isometry3::identity())];
    renderer.render(&views, INSTANCES).expect("the adapter works");
    renderer.lose();
    // What it has never drawn before fails no otherwise.
    let new = board();
    for views in [[View::new(&new, &camera, Isometry3::identity())], views, views] {
        let error = renderer.render(&views, INSTANCES).expect_err("it is lost");
        assert!(matches!(error, RenderError::Lost { .. }), "{error}");
    }
    let mut renderer = self::renderer().expect("there was an adapter a moment ago");
    let frames = renderer.render(&views, INSTANCES).expect("the adapter works");
    let frame = frames[0].as_ref().expect("a sound view");
    assert!(frame.instance.iter().flatten().all(|id| *id == 3));
}

#[test]
fn masks_of_things_alone_are_the_same_in_however_many_bands_they_are_drawn() {
    let Some(mut renderer) = renderer() else { return };
    let mut scene = board();
    let mesh = scene.instances[0].mesh.clone();
    // More things than a word has bits, one behind the other, each with a place and a size of its own.
    for id in 10..80 {
        let (along, across) = (6.0 + 0.1 * f32::from(id), 0.05 * f32::from(id) - 2.0);
        let pose = Isometry3::translation(along, across, 0.02 * f32::from(id));
        let scale = [1.0, 0.002 * f32::from(id), 0.1];
        scene.instances.push(Instance { mesh: mesh.clone(), pose, scale, paint: [0.5; 3], id });
    }
    let wanted = WantedImages { alone: true, ..INSTANCES };
    let cameras = [(48, 31), (20, 7)].map(|(width, height)| Camera::new(width, height, 24.0, 36.0).expect("a camera"));
    let views: Vec<_> = cameras.iter().chain(&cameras).map(|c| View::new(&scene, c, Isometry3::identity())).collect();
    let whole = renderer.render(&views, wanted).expect("the adapter works");
    let things = whole[0].as_ref().expect("a sound view").alone.as_ref().map_or(0, Vec::len);
    assert!(things > 64, "{things} things");
    // 3 words a pixel are 576 bytes a row of the larger camera.
    for limit in [576, 600, 3 * 576, 10_000] {
        renderer.most_masks = limit;
        assert!(renderer.render(&views, wanted).expect("the adapter works") == whole, "{limit} bytes at a time");
    }
    renderer.most_masks = 575;
    let refused =
        renderer.render(&views[..1], wanted).expect("the adapter works").remove(0).expect_err("a row is more");
    assert!(refused.to_string().contains("a row of pixels in the occlusion masks"), "{refused}");
}

#[test]
fn a_coarse_mesh_is_drawn_where_its_missing_parts_are_small_and_never_in_the_look_flat() {
    let mesh = || Mesh::new(Vec::new(), Vec::new());
    let [near, middle, far] = [mesh(), mesh(), mesh()];
    let keys = [near.key(), middle.key(), far.key()];
    let instance = Instance {
        mesh: near.with_coarse(middle.with_coarse(far, 0.5), 0.1).into(),
        pose: Isometry3::identity(),
        scale: [2.0, 1.0, 9.0],
        paint: [1.0; 3],
        id: 0,
    };
    // The mesh is stretched by 2 across, so its parts are twice as large.
    for (invisible, drawn) in [(-1.0, 0), (0.19, 0), (0.21, 1), (0.99, 1), (1.01, 2)] {
        assert_eq!(levels(&instance, Look::Textured, invisible), (keys[drawn], keys[2]), "{invisible}");
        assert_eq!(levels(&instance, Look::Flat, invisible), (keys[0], keys[0]), "{invisible}");
    }
}
