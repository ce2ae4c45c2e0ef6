//! What cannot be drawn is said, and keeps nothing else from being drawn.

mod support;

use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_render::{
    Atmosphere, Camera, Frame, Instance, Mesh, RenderError, Renderer, Scene, Semantic, SurfaceKind, View, ViewError,
};
use std::process::Command;
use std::sync::Arc;
use support::{EVERYTHING, Look, RGB, camera, cuboid, look, one, renderer, scene, sheet, street, thing};

fn grey() -> Look {
    look([0.5; 3], SurfaceKind::Plain, Semantic::Other)
}

#[test]
fn a_camera_without_pixels_or_length_is_refused() {
    let refused =
        |width, height, focal, sensor| Camera::new(width, height, focal, sensor).expect_err("refused").to_string();
    assert_eq!(refused(0, 480, 24.0, 36.0), "a resolution of 0 x 480 pixels, expected at least 1 x 1");
    assert_eq!(refused(640, 0, 24.0, 36.0), "a resolution of 640 x 0 pixels, expected at least 1 x 1");
    assert_eq!(refused(640, 480, 0.0, 36.0), "a focal length of 0 mm, expected a finite number above 0");
    assert_eq!(refused(640, 480, f64::NAN, 36.0), "a focal length of NaN mm, expected a finite number above 0");
    assert_eq!(refused(640, 480, 24.0, -1.0), "a sensor width of -1 mm, expected a finite number above 0");
    let mounted = camera(1, 1).mounted(Point3::new(0.0, f64::NAN, 1.0), 0.0, f64::INFINITY, 0.0);
    assert_eq!(
        mounted.expect_err("refused").to_string(),
        "a mount with a number that is not finite: (0, NaN, 1), yaw 0, pitch inf, roll 0"
    );
}

fn refused(renderer: &mut Renderer, view: &View<'_>) -> ViewError {
    let frames: Vec<Result<Frame, ViewError>> =
        renderer.render(std::slice::from_ref(view), EVERYTHING).expect("the adapter works");
    frames.into_iter().next().expect("one view").expect_err("refused")
}

#[test]
fn what_is_wrong_with_a_view_is_said_and_the_views_beside_it_are_drawn() {
    let Some(mut renderer) = renderer() else { return };
    let (sound, camera) = (street(), camera(64, 48));
    let here = Isometry3::translation(0.0, -1.7, 0.0);
    let nowhere = Isometry3::translation(f64::NAN, 0.0, 0.0);
    let wide = Camera::new(1_000_000, 2, 24.0, 36.0).expect("sound but large");
    let views = [
        View::new(&sound, &camera, here),
        View::new(&sound, &camera, nowhere),
        View::new(&sound, &wide, here),
        View::new(&sound, &camera, here),
    ];
    let frames = renderer.render(&views, RGB).expect("the adapter works");
    assert_eq!(frames[0].as_ref().expect("sound"), &one(&mut renderer, &views[0], RGB));
    assert!(frames[0] == frames[3]);
    let message = frames[1].as_ref().expect_err("nowhere").to_string();
    assert!(message.starts_with("the pose of the camera has a number that is not finite"), "{message}");
    let limit = renderer.adapter().max_image;
    let expected =
        format!("the image is 1000000 x 2 pixels, expected at most {limit} each way on this graphics adapter");
    assert_eq!(frames[2].as_ref().expect_err("too wide").to_string(), expected);
}

#[test]
fn what_is_wrong_with_a_thing_or_the_air_is_said() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(64, 48);
    let mesh = Arc::new(cuboid([1.0; 3], grey()));
    let sound = thing(&mesh, [9.0, 0.0, 0.0], 0.0, 7);
    let mut message = |instance: Instance, air: Atmosphere| {
        let scene = Scene { instances: vec![sound.clone(), instance], air, ..scene(Vec::new()) };
        refused(&mut renderer, &View::new(&scene, &camera, Isometry3::identity())).to_string()
    };
    let air = Atmosphere::default();
    let lost = thing(&mesh, [f32::INFINITY, 0.0, 0.0], 0.0, 7);
    assert!(message(lost, air).starts_with("instance 1 of the scene (id 7) has a pose of "));
    let flat = Instance { scale: [1.0, 0.0, 1.0], ..sound.clone() };
    assert_eq!(
        message(flat, air),
        "instance 1 of the scene (id 7) has a scale of [1.0, 0.0, 1.0], expected finite numbers above 0"
    );
    let bright = Instance { paint: [0.0, 2.0, 0.0], ..sound.clone() };
    assert_eq!(
        message(bright, air),
        "instance 1 of the scene (id 7) has a paint of [0.0, 2.0, 0.0], expected numbers from 0 to 1"
    );
    let mut vertices = mesh.vertices().to_vec();
    vertices[5].position[1] = f32::NAN;
    let torn = thing(&Arc::new(Mesh::new(vertices, mesh.indices().to_vec())), [9.0, 0.0, 0.0], 0.0, 7);
    let found = message(torn, air);
    assert!(found.starts_with("instance 1 of the scene (id 7) has a mesh whose corner 5 is at ["), "{found}");
    assert_eq!(message(sound.clone(), Atmosphere { light: 1.5, ..air }), "the air has a light of 1.5, expected 0 to 1");
    assert_eq!(
        message(sound.clone(), Atmosphere { extinction: -0.1, ..air }),
        "the air has an extinction of -0.1, expected a finite number from 0 on"
    );
    assert!(message(sound.clone(), Atmosphere { sun_azimuth: f32::NAN, ..air }).starts_with("the air has an azimuth"));
}

#[test]
fn a_camera_inside_a_body_says_which_and_that_body_can_be_left_out() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(64, 48);
    let body = Arc::new(cuboid([4.0, 2.0, 3.0], grey()));
    let board = Arc::new(sheet([-50.0, -50.0], [50.0, 50.0], grey()));
    let scene = scene(vec![thing(&board, [0.0, 0.0, 2.0], 0.0, 1), thing(&body, [3.0, 0.0, 0.0], 0.5, 5)]);
    let inside = View::new(&scene, &camera, Isometry3::translation(3.5, 0.2, 0.0));
    let error = refused(&mut renderer, &inside);
    assert_eq!(error, ViewError::Inside { index: 1, id: 5 });
    assert!(error.to_string().starts_with("the camera is inside instance 1 of the scene (id 5)"), "{error}");
    // Below a roof of nothing but a sheet one is not inside, nor beside a body.
    one(&mut renderer, &View { without: Some(5), ..inside }, EVERYTHING);
    one(&mut renderer, &View::new(&scene, &camera, Isometry3::translation(-2.0, 0.0, 0.0)), EVERYTHING);
    one(&mut renderer, &View::new(&scene, &camera, Isometry3::translation(3.5, 0.2, 3.0)), EVERYTHING);
}

#[test]
fn odd_meshes_are_drawn_as_what_they_are() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(64, 48);
    let empty = Arc::new(Mesh::new(Vec::new(), Vec::new()));
    let corner = support::vertex([0.0; 3], [0.0; 3], grey());
    let pointless = Arc::new(Mesh::new(vec![corner; 3], vec![0, 1, 2, 0, 0, 0]));
    let mut scene = scene(vec![thing(&empty, [9.0, 0.0, 1.0], 0.0, 1), thing(&pointless, [9.0, 0.0, 1.5], 0.0, 2)]);
    let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), EVERYTHING);
    assert!(frame.instance.expect("asked for").iter().all(|id| *id == 0));
    scene.instances.clear();
    let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), EVERYTHING);
    assert!(frame.depth.expect("asked for").iter().all(|depth| *depth == f32::INFINITY));
    assert!(frame.semantic.expect("asked for").iter().all(|class| *class == Semantic::Sky as u8));
}

#[test]
fn a_thing_behind_the_camera_is_seen_when_it_turns_round() {
    let Some(mut renderer) = renderer() else { return };
    let camera = camera(64, 48);
    let mesh = Arc::new(cuboid([1.0, 1.0, 4.0], grey()));
    let scene = scene(vec![thing(&mesh, [-3.0, 0.0, 0.0], 0.0, 1)]);
    for (turn, seen) in [(0.0, false), (std::f64::consts::PI, true)] {
        let view = View::new(&scene, &camera, Isometry3::rotation(Vector3::z() * turn));
        let frame = one(&mut renderer, &view, EVERYTHING);
        assert_eq!(frame.instance.expect("asked for").contains(&1), seen, "turned by {turn}");
        assert_eq!(frame.alone.expect("asked for").len(), usize::from(seen));
    }
}

/// Not a test of its own: what the test below runs where no adapter is to be found.
#[test]
#[ignore = "run by another test"]
fn without_an_adapter() {
    let error = Renderer::new().expect_err("there is none");
    assert!(matches!(error, RenderError::NoAdapter(_)), "{error}");
    println!("found: {error}");
}

#[test]
#[cfg(target_os = "linux")]
fn without_an_adapter_the_package_to_install_is_named() {
    let this = std::env::current_exe().expect("it runs");
    let output = Command::new(this)
        .args(["--ignored", "--exact", "without_an_adapter", "--nocapture"])
        .env("VK_DRIVER_FILES", "/dev/null")
        .env("VK_ICD_FILENAMES", "/dev/null")
        .output()
        .expect("it runs");
    let found = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{found} {}", String::from_utf8_lossy(&output.stderr));
    assert!(found.contains("apt install mesa-vulkan-drivers"), "{found}");
}
