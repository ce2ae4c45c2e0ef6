//! Depth against rays cast on the processor, that share nothing with the renderer.

mod support;

use nalgebra::{Isometry3, Point2, Point3, UnitQuaternion, Vector3};
use paracosm_render::{Camera, Frame, Instance, Mesh, Semantic, SurfaceKind, View, WantedImages};
use std::sync::Arc;
use support::{Look, ball, camera, cuboid, look, one, renderer, scene, sheet, thing};

const DEPTH: WantedImages = WantedImages { depth: true, instance: true, ..support::NOTHING };

fn grey() -> Look {
    look([0.5; 3], SurfaceKind::Plain, Semantic::Other)
}

/// Where a ray from a point meets a thing first, in multiples of the ray.
type Cast<'a> = dyn Fn(&Point3<f64>, &Vector3<f64>) -> Option<f64> + 'a;

/// The distance to a box from -size/2 to size/2 across and 0 to size up, by slabs.
fn meets_box(size: [f64; 3], from: &Point3<f64>, ray: &Vector3<f64>) -> Option<f64> {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let low = if axis == 2 { 0.0 } else { -size[axis] / 2.0 };
        let (a, b) = ((low - from[axis]) / ray[axis], (low + size[axis] - from[axis]) / ray[axis]);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    (enter < leave).then_some(enter)
}

fn meets_ball(radius: f64, from: &Point3<f64>, ray: &Vector3<f64>) -> Option<f64> {
    let (half, across) = (from.coords.dot(ray), ray.norm_squared());
    let inside = half * half - across * (from.coords.norm_squared() - radius * radius);
    (inside > 0.0).then(|| (-half - inside.sqrt()) / across)
}

/// The distance to the nearest triangle that faces the ray (Möller and Trumbore 1997).
fn meets_mesh(mesh: &Mesh, from: &Point3<f64>, ray: &Vector3<f64>) -> Option<f64> {
    let corner = |index: u32| Point3::from(mesh.vertices()[index as usize].position).cast::<f64>();
    let met = mesh.indices().chunks_exact(3).filter_map(|triangle| {
        let [a, b, c] = [0, 1, 2].map(|index| corner(triangle[index]));
        let (u, v) = (b - a, c - a);
        let across = ray.cross(&v);
        let facing = u.dot(&across);
        let beside = from - a;
        let (along_u, turned) = (beside.dot(&across) / facing, beside.cross(&u));
        let along_v = ray.dot(&turned) / facing;
        let inside = facing > 0.0 && along_u >= 0.0 && along_v >= 0.0 && along_u + along_v <= 1.0;
        inside.then(|| v.dot(&turned) / facing)
    });
    met.filter(|met| *met > 0.0).min_by(f64::total_cmp)
}

/// Compares a frame with what rays meet: the greatest error in units of what is allowed (1 mm or 1e-4 of the distance,
/// whichever is more), and how many pixels are of another thing than the ray meets.
fn compare(frame: &Frame, eye: &Isometry3<f64>, things: &[(&Instance, &Cast<'_>)]) -> (f64, usize) {
    let (depth, ids) = (frame.depth.as_ref().expect("asked for"), frame.instance.as_ref().expect("asked for"));
    let planar = frame.planar_depth().expect("there is depth");
    let (mut worst, mut others, mut met) = (0.0_f64, 0, 0);
    for index in 0..depth.len() {
        let (column, row) = (index as u32 % frame.width(), index as u32 / frame.width());
        let ray = frame.camera.ray(Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5));
        let cast = |(instance, cast): &(&Instance, &Cast<'_>)| {
            let pose: Isometry3<f64> = instance.pose.cast();
            let to_thing = pose.inverse() * eye;
            Some((cast(&(to_thing * Point3::origin()), &(to_thing * ray))?, instance.id))
        };
        let first = things.iter().filter_map(cast).min_by(|a, b| a.0.total_cmp(&b.0));
        match first {
            Some((along, id)) if id == ids[index] => {
                let (radial, found) = (along * ray.norm(), f64::from(depth[index]));
                worst = worst.max((found - radial).abs() / (1e-4 * radial).max(1e-3));
                worst = worst.max((f64::from(planar[index]) - along).abs() / (1e-4 * along).max(1e-3));
                met += 1;
            }
            None if ids[index] == 0 => assert_eq!(depth[index], f32::INFINITY),
            _ => others += 1,
        }
    }
    assert!(met > depth.len() / 50, "only {met} pixels met anything");
    (worst, others)
}

fn tilted(camera: Camera) -> Camera {
    camera.mounted(Point3::new(1.2, -0.3, 1.4), 0.13, 0.04, -0.07).expect("a sound mount")
}

#[test]
fn depth_of_boxes_and_planes_is_that_of_a_ray() {
    let Some(mut renderer) = renderer() else { return };
    let ground = Arc::new(sheet([-900.0, -800.0], [900.0, 800.0], grey()));
    let sizes = [[1.0, 2.0, 1.5], [4.0, 1.8, 1.4], [0.4, 0.5, 1.8], [30.0, 12.0, 9.0]];
    let boxes = sizes.map(|size| Arc::new(cuboid(size, grey())));
    let mut placed = vec![(thing(&ground, [0.0; 3], 0.0, 1), None)];
    for (index, (x, y, yaw)) in [
        (6.0, 1.5, 0.4),
        (12.0, -2.0, 1.1),
        (5.0, -0.8, 0.0),
        (60.0, 20.0, 0.7),
        (25.0, 4.0, -0.3),
        (300.0, -80.0, 0.2),
    ]
    .into_iter()
    .enumerate()
    {
        placed.push((thing(&boxes[index % 4], [x, y, 0.0], yaw, 2 + index as u16), Some(sizes[index % 4])));
    }
    let scene = scene(placed.iter().map(|(instance, _)| instance.clone()).collect());
    // Far from the origin too, where 32 bits have little left behind the point.
    for (at, camera) in [([0.0, 0.0], camera(320, 200)), ([-40.0, 2.0], tilted(camera(321, 123)))] {
        let pose = Isometry3::translation(at[0], at[1], 0.0);
        let frame = one(&mut renderer, &View::new(&scene, &camera, pose), DEPTH);
        let casts: Vec<Box<Cast<'_>>> = placed
            .iter()
            .map(|(_, size)| match size {
                Some(size) => {
                    let size = size.map(f64::from);
                    Box::new(move |from: &Point3<f64>, ray: &Vector3<f64>| meets_box(size, from, ray)) as Box<Cast<'_>>
                }
                None => Box::new(|from: &Point3<f64>, ray: &Vector3<f64>| {
                    let along = -from.z / ray.z;
                    let met = from + ray * along;
                    (along > 0.0 && met.x.abs() < 900.0 && met.y.abs() < 800.0).then_some(along)
                }),
            })
            .collect();
        let things: Vec<_> = placed.iter().zip(&casts).map(|((instance, _), cast)| (instance, cast.as_ref())).collect();
        let (worst, others) = compare(&frame, &camera.pose(&pose), &things);
        eprintln!("boxes and planes: {worst:.4} of what is allowed, {others} pixels of another thing");
        assert!(worst <= 1.0, "{worst} times what is allowed");
        assert!(others <= 12, "{others} pixels are of another thing than rays meet");
    }
}

#[test]
fn depth_of_a_fine_ball_is_that_of_a_sphere() {
    let Some(mut renderer) = renderer() else { return };
    let radius = 0.8;
    let mesh = Arc::new(ball(radius as f32, 500, grey()));
    let instance = thing(&mesh, [4.0, 0.2, 1.5], 0.3, 1);
    let scene = scene(vec![instance.clone()]);
    let (camera, pose) = (camera(200, 160), Isometry3::identity());
    let frame = one(&mut renderer, &View::new(&scene, &camera, pose), DEPTH);
    // On the very limb a ball of triangles ends before the sphere does.
    let sphere = |from: &Point3<f64>, ray: &Vector3<f64>| {
        meets_ball(radius * 0.9995, from, ray).and(meets_ball(radius, from, ray))
    };
    let (worst, others) = compare(&frame, &camera.pose(&pose), &[(&instance, &sphere)]);
    eprintln!("sphere: {worst:.4} of what is allowed, {others} pixels of another thing");
    assert!(worst <= 1.0, "{worst} times what is allowed");
    assert!(others <= 20, "{others} pixels are of another thing than rays meet");
}

#[test]
fn depth_of_any_mesh_is_that_of_its_triangles() {
    let Some(mut renderer) = renderer() else { return };
    let mesh = Arc::new(ball(1.0, 14, grey()));
    let mut instance = thing(&mesh, [5.0, -0.4, 1.1], 0.9, 1);
    instance.pose.rotation = UnitQuaternion::from_euler_angles(0.3, -0.5, 0.9);
    let scene = scene(vec![instance.clone()]);
    let (camera, pose) = (tilted(camera(160, 120)), Isometry3::identity());
    let frame = one(&mut renderer, &View::new(&scene, &camera, pose), DEPTH);
    let cast = |from: &Point3<f64>, ray: &Vector3<f64>| meets_mesh(&mesh, from, ray);
    let (worst, others) = compare(&frame, &camera.pose(&pose), &[(&instance, &cast)]);
    eprintln!("triangles: {worst:.4} of what is allowed, {others} pixels of another thing");
    assert!(worst <= 1.0, "{worst} times what is allowed");
    assert!(others <= 3, "{others} pixels are of another thing than rays meet");
}

#[test]
fn a_scaled_thing_is_as_far_away_as_one_of_that_size() {
    let Some(mut renderer) = renderer() else { return };
    let (size, scale) = ([1.0, 0.5, 2.0], [3.0, 4.0, 0.7]);
    let mesh = Arc::new(cuboid(size, grey()));
    let instance = Instance { scale, ..thing(&mesh, [9.0, 0.5, 0.2], 0.6, 1) };
    let scene = scene(vec![instance.clone()]);
    let (camera, pose) = (camera(128, 128), Isometry3::identity());
    let frame = one(&mut renderer, &View::new(&scene, &camera, pose), DEPTH);
    let scaled = std::array::from_fn(|axis| f64::from(size[axis]) * f64::from(scale[axis]));
    let cast = |from: &Point3<f64>, ray: &Vector3<f64>| meets_box(scaled, from, ray);
    let (worst, others) = compare(&frame, &camera.pose(&pose), &[(&instance, &cast)]);
    assert!(worst <= 1.0, "{worst} times what is allowed");
    assert!(others <= 3, "{others} pixels are of another thing than rays meet");
}
