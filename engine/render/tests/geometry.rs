//! Where things are on the image.

mod support;

use nalgebra::{Isometry3, Point2, Point3, Vector3};
use paracosm_render::{Camera, Frame, Semantic, SurfaceKind, View, WantedImages, boxes, boxes_in_space};
use std::sync::Arc;
use support::{EVERYTHING, camera, cuboid, look, one, renderer, scene, sheet, street, thing};

const THINGS: WantedImages = WantedImages { semantic: true, instance: true, alone: true, ..support::NOTHING };

#[test]
fn the_field_of_view_is_that_of_the_focal_length() {
    for (focal, degrees) in [(10.0, 121.9), (34.0, 55.8), (50.0, 39.6)] {
        let camera = Camera::new(640, 480, focal, 36.0).expect("a sound camera");
        assert!((camera.field_of_view().to_degrees() - degrees).abs() < 0.05, "{focal} mm");
        assert_eq!(camera.focal_pixels(), focal * 640.0 / 36.0);
    }
}

#[test]
fn a_board_as_wide_as_the_field_of_view_fills_the_image_to_the_pixel() {
    let Some(mut renderer) = renderer() else { return };
    for (focal, width) in [(10.0, 200), (34.0, 201), (50.0, 640)] {
        let camera = Camera::new(width, 9, focal, 36.0).expect("a sound camera");
        // Its face is 8 m away, where one pixel is so many metres.
        let pixel = 8.0 * 36.0 / focal / f64::from(width);
        for (inset, expected) in [(0.45, width), (0.55, width - 2), (1.45, width - 2), (1.55, width - 4)] {
            let across = (pixel * (f64::from(width) - 2.0 * inset)) as f32;
            let board = Arc::new(cuboid([0.5, across, 40.0], look([0.5; 3], SurfaceKind::Plain, Semantic::Wall)));
            let scene = scene(vec![thing(&board, [8.25, 0.0, -20.0], 0.0, 1)]);
            let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), THINGS);
            let row = &frame.instance.expect("asked for")[4 * width as usize..][..width as usize];
            assert_eq!(row.iter().filter(|id| **id == 1).count(), expected as usize, "{focal} mm, {inset} pixels in");
        }
    }
}

#[test]
fn a_flat_road_is_where_its_outline_is() {
    let Some(mut renderer) = renderer() else { return };
    let road = Arc::new(sheet([-20.0, -3.5], [400.0, 3.5], look([0.1; 3], SurfaceKind::Asphalt, Semantic::Road)));
    let scene = scene(vec![thing(&road, [0.0; 3], 0.2, 0)]);
    let to_road = scene.instances[0].pose.cast::<f64>().inverse();
    for camera in [
        camera(320, 240),
        Camera::new(201, 67, 15.0, 36.0)
            .expect("sound")
            .mounted(Point3::new(1.0, 0.4, 1.3), 0.1, 0.05, 0.04)
            .expect("sound"),
    ] {
        let pose = Isometry3::translation(0.0, -1.5, 0.0);
        let frame = one(&mut renderer, &View::new(&scene, &camera, pose), THINGS);
        let to_road = to_road * camera.pose(&pose);
        let on_road = |at: Point2<f64>| {
            let (from, ray) = (to_road * Point3::origin(), to_road * camera.ray(at));
            let met = from - ray * (from.z / ray.z);
            ray.z < 0.0 && met.y.abs() < 3.5 && (-20.0..400.0).contains(&met.x)
        };
        let mut road_pixels = 0;
        for (index, class) in frame.semantic.expect("asked for").into_iter().enumerate() {
            let (column, row) = (index as u32 % camera.width(), index as u32 / camera.width());
            let middle = Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let is_road = class == Semantic::Road as u8;
            road_pixels += usize::from(is_road);
            // Within a hundredth of a pixel of the outline either is right; the issue is content with a whole one.
            let around = [(-0.01, 0.0), (0.01, 0.0), (0.0, -0.01), (0.0, 0.01)];
            let near = around.into_iter().any(|(x, y)| on_road(Point2::new(middle.x + x, middle.y + y)) == is_road);
            assert!(on_road(middle) == is_road || near, "pixel ({column}, {row}) has class {class}");
        }
        assert!(road_pixels > 1000, "{road_pixels} pixels of road");
    }
}

#[test]
fn a_mount_turns_left_down_and_right() {
    let camera = Camera::new(100, 100, 18.0, 36.0).expect("a sound camera");
    let along = |yaw, pitch, roll| {
        let mounted = camera.clone().mounted(Point3::origin(), yaw, pitch, roll).expect("a sound mount");
        (mounted.mount() * Vector3::x(), mounted.mount() * Vector3::y())
    };
    assert!(along(0.1, 0.0, 0.0).0.y > 0.0, "yaw is to the left");
    assert!(along(0.0, 0.1, 0.0).0.z < 0.0, "pitch is down");
    assert!(along(0.0, 0.0, 0.1).1.z > 0.0, "rolled to the right, the left side is up");
    for (x, y) in [(0.5, 0.5), (50.0, 50.0), (99.5, 3.25)] {
        let ray = camera.ray(Point2::new(x, y));
        let back = camera.project(&Point3::from(ray * 7.0)).expect("it is before the camera");
        assert!((back - Point2::new(x, y)).norm() < 1e-12);
    }
    assert_eq!(camera.project(&Point3::new(-1.0, 0.0, 0.0)), None);
}

/// What there is to say of a thing, from its pixels one by one.
fn naive(frame: &Frame, id: u16) -> (u32, [u32; 2], [u32; 2]) {
    let ids = frame.instance.as_ref().expect("asked for");
    let of_it = |index: &usize| ids[*index] == id;
    let pixels: Vec<_> = (0..ids.len())
        .filter(of_it)
        .map(|index| (index as u32 % frame.width(), index as u32 / frame.width()))
        .collect();
    let columns = || pixels.iter().map(|(column, _)| *column);
    let rows = || pixels.iter().map(|(_, row)| *row);
    let min = [columns().min().unwrap_or(0), rows().min().unwrap_or(0)];
    (pixels.len() as u32, min, [columns().max().unwrap_or(0), rows().max().unwrap_or(0)])
}

#[test]
fn boxes_are_those_of_the_pixels_and_occlusion_is_measured_against_the_thing_alone() {
    let Some(mut renderer) = renderer() else { return };
    let (scene, camera) = (street(), camera(320, 240));
    let pose = Isometry3::translation(0.0, -1.7, 0.0);
    let frame = one(&mut renderer, &View::new(&scene, &camera, pose), EVERYTHING);
    let found = boxes(&frame).expect("there are instances");
    assert!(found.len() >= 8, "{} things", found.len());
    assert!(found.iter().any(|thing| thing.occlusion.is_some_and(|hidden| hidden > 0.3)), "nothing is hidden");
    for thing in found {
        let visible = thing.visible;
        assert_eq!((visible.pixels, visible.min, visible.max), naive(&frame, visible.id), "thing {}", visible.id);
        let mut alone = scene.clone();
        alone.instances.retain(|instance| instance.id == visible.id);
        let alone = one(&mut renderer, &View::new(&alone, &camera, pose), THINGS);
        let (pixels, min, max) = naive(&alone, visible.id);
        let extent = frame.alone.iter().flatten().find(|extent| extent.id == visible.id).expect("it is visible");
        assert_eq!((extent.pixels, extent.min, extent.max), (pixels, min, max), "thing {} alone", visible.id);
        assert_eq!(thing.occlusion, Some(1.0 - f64::from(visible.pixels) / f64::from(pixels)));
        let class = match visible.id {
            1 | 2 => Semantic::Pedestrian,
            10..20 => Semantic::Car,
            _ => Semantic::Building,
        };
        assert_eq!(thing.semantic, Some(class as u8));
    }
}

#[test]
fn many_things_alone_are_told_apart() {
    let Some(mut renderer) = renderer() else { return };
    let post = Arc::new(cuboid([0.1, 0.1, 1.0], look([0.5; 3], SurfaceKind::Plain, Semantic::Pole)));
    // More than the bits of two words, one behind the other.
    let place = |index: u16| [5.0 + 0.2 * f32::from(index), 0.0, 0.0];
    let scene = scene((0..70).map(|index| thing(&post, place(index), 0.0, 3 * index + 7)).collect());
    let frame = one(&mut renderer, &View::new(&scene, &camera(101, 100), Isometry3::identity()), THINGS);
    let alone = frame.alone.as_ref().expect("asked for");
    assert_eq!(
        alone.iter().map(|extent| extent.id).collect::<Vec<_>>(),
        (0..70).map(|index| 3 * index + 7).collect::<Vec<_>>()
    );
    for index in [0, 31, 32, 63, 64, 69] {
        let single = support::scene(vec![scene.instances[index].clone()]);
        let single = one(&mut renderer, &View::new(&single, &camera(101, 100), Isometry3::identity()), THINGS);
        let (pixels, min, max) = naive(&single, alone[index].id);
        assert!(pixels > 0);
        assert_eq!((alone[index].pixels, alone[index].min, alone[index].max), (pixels, min, max), "thing {index}");
    }
    assert_eq!(boxes(&frame).expect("there are instances")[0].occlusion, Some(0.0));
}

#[test]
fn boxes_in_space_hold_what_is_seen_of_things() {
    let Some(mut renderer) = renderer() else { return };
    let (scene, camera) = (street(), camera(320, 240));
    let pose = Isometry3::translation(0.0, -1.7, 0.0);
    let frame = one(&mut renderer, &View::new(&scene, &camera, pose), EVERYTHING);
    let in_space = boxes_in_space(&scene, &camera, &pose);
    for thing in boxes(&frame).expect("there are instances") {
        let around = in_space.iter().find(|around| around.id == thing.visible.id).expect("each thing has one");
        let corners: Vec<_> = around.projected(&camera).into_iter().flatten().collect();
        if corners.len() < 8 {
            continue;
        }
        let within = |axis: usize| {
            let low = corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
            let high = corners.iter().map(|corner| corner[axis]).fold(f64::NEG_INFINITY, f64::max);
            low - 0.5 <= f64::from(thing.visible.min[axis]) && f64::from(thing.visible.max[axis]) <= high + 0.5
        };
        assert!(within(0) && within(1), "thing {} is outside of its box", thing.visible.id);
    }
    let car = in_space.iter().find(|around| around.id == 12).expect("the car");
    assert!((car.size - Vector3::new(4.36, 1.8, 1.44)).norm() < 0.02, "{}", car.size);
    assert!((car.pose.translation.vector - Vector3::new(11.0, -0.7, 0.72 - 1.5)).norm() < 0.01, "{}", car.pose);
}
