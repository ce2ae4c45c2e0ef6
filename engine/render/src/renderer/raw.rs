//! The data that is written to the adapter, byte for byte as the shaders read it.

use bytemuck::{Pod, Zeroable};
use nalgebra::{Isometry3, Matrix3, Vector3};
use wgpu::{VertexAttribute, VertexBufferLayout, VertexStepMode, vertex_attr_array};

/// The data of a view: `View` in view.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub(super) struct RawView {
    pub image: [f32; 4],
    pub project: [f32; 4],
    pub sun: [f32; 4],
    pub up: [f32; 4],
    pub sun_light: [f32; 4],
    pub sky_light: [f32; 4],
    pub ground_light: [f32; 4],
    pub air: [f32; 4],
    pub zenith: [f32; 4],
    pub head_lamps: [f32; 4],
    pub head_beam: [f32; 4],
    pub street_lamps: [[f32; 4]; 8],
    pub shadow: [[f32; 4]; 3],
    pub counts: [u32; 4],
}

/// A corner of a mesh, as the shaders read it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct RawCorner {
    pub position: [f32; 3],
    /// The normal of the triangle of which the vertex is the first corner.
    pub face: [f32; 3],
    pub normal: [i16; 4],
    pub uv: [f32; 2],
    pub colour: [u16; 4],
    /// The surface kind, the class and the layer of the texture or picture as bytes, followed by an unused byte.
    pub kind: [u8; 4],
}

impl RawCorner {
    const ATTRIBUTES: [VertexAttribute; 6] = vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Snorm16x4, 3 => Float32x2, 4 => Unorm16x4, 5 => Uint8x4
    ];

    pub const LAYOUT: VertexBufferLayout<'static> = VertexBufferLayout {
        array_stride: size_of::<Self>() as u64,
        step_mode: VertexStepMode::Vertex,
        attributes: &Self::ATTRIBUTES,
    };
}

/// The place of an instance's mesh relative to a camera.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    /// The transformation from the coordinates of the scaled mesh to the camera's coordinates.
    pub to_camera: Isometry3<f64>,
    /// The factors by which the instance is larger than the mesh.
    pub scale: Vector3<f64>,
}

impl Shape {
    /// Returns the linear part of the transformation from the mesh to the camera.
    pub fn turn(&self) -> Matrix3<f64> {
        self.to_camera.rotation.to_rotation_matrix() * Matrix3::from_diagonal(&self.scale)
    }

    /// Returns the position of the pinhole, in the mesh's coordinates.
    pub fn eye(&self) -> Vector3<f64> {
        self.to_camera.inverse().translation.vector.component_div(&self.scale)
    }
}

/// An instance in front of a camera, as the shaders read it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct RawInstance {
    rows: [[f32; 4]; 3],
    eye: [f32; 3],
    unscale: [f32; 3],
    paint: [f32; 3],
    /// The id of the instance in the lower half, and the index of its bit in the masks in the upper half.
    id: u32,
}

impl RawInstance {
    const ATTRIBUTES: [VertexAttribute; 7] = vertex_attr_array![
        6 => Float32x4, 7 => Float32x4, 8 => Float32x4, 9 => Float32x3, 10 => Float32x3, 11 => Float32x3, 12 => Uint32
    ];

    pub const LAYOUT: VertexBufferLayout<'static> = VertexBufferLayout {
        array_stride: size_of::<Self>() as u64,
        step_mode: VertexStepMode::Instance,
        attributes: &Self::ATTRIBUTES,
    };

    pub fn new(shape: &Shape, paint: [f32; 3], id: u16, bit: u32) -> Self {
        let (turn, shift) = (shape.turn(), shape.to_camera.translation.vector);
        let row =
            |axis: usize| [turn[(axis, 0)] as f32, turn[(axis, 1)] as f32, turn[(axis, 2)] as f32, shift[axis] as f32];
        Self {
            rows: std::array::from_fn(row),
            eye: shape.eye().cast::<f32>().into(),
            unscale: shape.scale.map(|along| (1.0 / (along * along)) as f32).into(),
            paint,
            id: u32::from(id) | bit << 16,
        }
    }
}

/// Returns the rows of a rigid motion followed by a linear map and a shift.
pub(super) fn rows(linear: &Matrix3<f64>, motion: &Isometry3<f64>, shift: &Vector3<f64>) -> [[f32; 4]; 3] {
    let turn = linear * motion.rotation.to_rotation_matrix();
    let moved = linear * motion.translation.vector + shift;
    std::array::from_fn(|axis| {
        [turn[(axis, 0)] as f32, turn[(axis, 1)] as f32, turn[(axis, 2)] as f32, moved[axis] as f32]
    })
}

/// Joins three numbers and a fourth.
pub(super) fn four(three: impl Into<[f32; 3]>, fourth: f32) -> [f32; 4] {
    let [x, y, z] = three.into();
    [x, y, z, fourth]
}
