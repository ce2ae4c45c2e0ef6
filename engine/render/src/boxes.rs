//! Boxes around objects: on the image, from their pixels, and in space, from their meshes.

use crate::frame::Extent;
use crate::{Camera, Frame, Instance, Scene};
use nalgebra::{Isometry3, Point2, Point3, Vector3};
use std::collections::BTreeMap;

/// The box around the visible pixels of an object in an image, with the object's class and occlusion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box2 {
    /// The number and the bounds of the visible pixels of the object.
    pub visible: Extent,
    /// The most frequent semantic class among the visible pixels of the object; `None` if the frame has no classes.
    pub semantic: Option<u8>,
    /// The hidden share of the object's pixels, from 0 to 1; `None` if [`Frame::alone`] is `None`.
    pub occlusion: Option<f64>,
}

/// The three-dimensional box around an object, in the camera's coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Box3 {
    /// The id of the object in the scene.
    pub id: u16,
    /// The transformation from the box's coordinates, whose origin is the middle of the box, to the camera's
    /// coordinates.
    pub pose: Isometry3<f64>,
    /// The lengths of the box in metres, along its own x, y and z axes.
    pub size: Vector3<f64>,
}

/// Returns a box for each object that has an id and is visible in the frame, sorted by id; `None` if the frame has no
/// image of ids.
pub fn boxes(frame: &Frame) -> Option<Vec<Box2>> {
    let instance = frame.instance.as_ref()?;
    let mut extents = BTreeMap::<u16, (Extent, [u32; 256])>::new();
    for (index, id) in instance.iter().enumerate().filter(|(_, id)| **id != 0) {
        let at = [index as u32 % frame.width(), index as u32 / frame.width()];
        let class = frame.semantic.as_ref().map_or(0, |semantic| semantic[index]);
        let (_, classes) = extents
            .entry(*id)
            .and_modify(|(extent, _)| extent.add(at))
            .or_insert_with(|| (Extent::of_pixel(*id, at), [0; 256]));
        classes[usize::from(class)] += 1;
    }
    let hidden = |visible: &Extent| {
        let alone = frame.alone.as_ref()?.iter().find(|alone| alone.id == visible.id)?;
        Some(1.0 - f64::from(visible.pixels) / f64::from(alone.pixels))
    };
    let finished = |(visible, classes): (Extent, [u32; 256])| Box2 {
        visible,
        semantic: frame.semantic.as_ref().map(|_| most_frequent(&classes)),
        occlusion: hidden(&visible),
    };
    Some(extents.into_values().map(finished).collect())
}

fn most_frequent(classes: &[u32; 256]) -> u8 {
    (0..=255).rev().max_by_key(|class| classes[usize::from(*class)]).unwrap_or_default()
}

/// Returns a three-dimensional box for each object of the scene that has an id, sorted by id, in the coordinates of a
/// camera on a vehicle with the pose `carrier`. An object of several instances has one box around all of them, which is
/// turned like the first instance.
pub fn boxes_in_space(scene: &Scene, camera: &Camera, carrier: &Isometry3<f64>) -> Vec<Box3> {
    let mut things = BTreeMap::<u16, Vec<&Instance>>::new();
    for instance in scene.instances.iter().filter(|instance| instance.id != 0) {
        things.entry(instance.id).or_default().push(instance);
    }
    let to_camera = camera.pose(carrier).inverse();
    let around = |(id, instances): (u16, Vec<&Instance>)| {
        let base: Isometry3<f64> = instances[0].pose.cast();
        let to_base = base.inverse();
        let (low, high) = match instances[..] {
            // The mesh of a single instance knows its bounds.
            [only] => bounds_of(only),
            _ => {
                let corners = instances.iter().flat_map(|instance| corners_of(instance, &to_base));
                corners.fold(EMPTY, |(low, high), corner| (low.inf(&corner), high.sup(&corner)))
            }
        };
        let middle = nalgebra::center(&low, &high);
        let pose = to_camera * base * Isometry3::translation(middle.x, middle.y, middle.z);
        (low.x <= high.x).then(|| Box3 { id, pose, size: high - low })
    };
    things.into_iter().filter_map(around).collect()
}

const EMPTY: (Point3<f64>, Point3<f64>) = (
    Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
    Point3::new(-f64::INFINITY, -f64::INFINITY, -f64::INFINITY),
);

/// Returns the least and the greatest coordinates of the corners of an instance's mesh, turned like the instance.
fn bounds_of(instance: &Instance) -> (Point3<f64>, Point3<f64>) {
    let [low, high] = instance.mesh.bounds().map(|bound| {
        Point3::from(Vector3::from(bound).cast::<f64>().component_mul(&Vector3::from(instance.scale).cast()))
    });
    (low, high)
}

/// Returns the positions of all corners of an instance's mesh, moved from the world by `motion`.
fn corners_of<'a>(instance: &'a Instance, motion: &Isometry3<f64>) -> impl Iterator<Item = Point3<f64>> + use<'a> {
    let pose: Isometry3<f64> = motion * instance.pose.cast::<f64>();
    let scale = Vector3::from(instance.scale).cast::<f64>();
    instance
        .mesh
        .vertices()
        .iter()
        .map(move |vertex| pose * Point3::from(Vector3::from(vertex.position).cast::<f64>().component_mul(&scale)))
}

impl Box3 {
    /// Returns the eight corners of the box, in the camera's coordinates. The lowest bit of an index is 1 for a front
    /// corner, the second bit for a left corner, the third bit for an upper corner.
    pub fn corners(&self) -> [Point3<f64>; 8] {
        std::array::from_fn(|index| {
            let side = |axis: usize| if index >> axis & 1 == 1 { 0.5 } else { -0.5 };
            self.pose * Point3::new(side(0) * self.size.x, side(1) * self.size.y, side(2) * self.size.z)
        })
    }

    /// Returns the pixel coordinates of the box's eight corners; `None` for a corner that is not in front of the
    /// camera.
    pub fn projected(&self, camera: &Camera) -> [Option<Point2<f64>>; 8] {
        self.corners().map(|corner| camera.project(&corner))
    }
}
