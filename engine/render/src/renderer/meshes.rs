//! Meshes on the adapter: uploaded once, and kept as long as anybody holds them.

use super::adapter::Gpu;
use super::raw::{RawCorner, Shape};
use super::textures::{layer, pictures};
use crate::{InstanceFlaw, Mesh, SurfaceKind, Vertex};
use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Weak};

/// The least height of street lamps, in metres; lower lamps are those of cars.
const HIGH: f32 = 2.5;

/// A mesh on the adapter.
#[derive(Debug)]
pub(super) struct GpuMesh {
    pub corners: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    /// The ranges of the mesh's indices that belong to each finish, in the order of [`Finish::ALL`].
    pub parts: [Range<u32>; 5],
    /// The pictures of the surface as an input of the programs that draw surfaces, if the mesh has any.
    pub pictures: Option<wgpu::BindGroup>,
    pub low: Vector3<f64>,
    pub high: Vector3<f64>,
    /// The position of the mesh's lamp that lights the ground, if the mesh has a lamp.
    pub lamp: Option<Point3<f64>>,
}

/// The demands of a surface on the program that draws it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Finish {
    /// A surface that is neither glossy nor grained.
    Dull,
    Glossy,
    /// A surface with a picture.
    Pictured,
    /// A grained surface that does not lie on the ground, such as a wall or leaves.
    Upright,
    /// A grained surface on the ground. It is drawn last, since most other objects hide parts of it.
    Grained,
}

impl Finish {
    pub const ALL: [Self; 5] = [Self::Dull, Self::Glossy, Self::Pictured, Self::Upright, Self::Grained];

    fn of(surface: SurfaceKind) -> Self {
        match surface {
            SurfaceKind::Paint | SurfaceKind::Glass => Self::Glossy,
            SurfaceKind::Asphalt
            | SurfaceKind::Slabs
            | SurfaceKind::Concrete
            | SurfaceKind::Marking
            | SurfaceKind::Grass => Self::Grained,
            SurfaceKind::Grown | SurfaceKind::Brick | SurfaceKind::Plaster | SurfaceKind::Tiles | SurfaceKind::Bark => {
                Self::Upright
            }
            SurfaceKind::Plain
            | SurfaceKind::Cloth
            | SurfaceKind::WhiteLamp
            | SurfaceKind::RedLamp
            | SurfaceKind::Glow => Self::Dull,
        }
    }
}

/// The reason why a mesh cannot be drawn.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Unfit {
    /// A corner of the mesh has a number that is not finite.
    Corner(InstanceFlaw),
    /// The mesh needs a buffer of this size in bytes, which is more than the adapter allows.
    TooLarge(u64),
}

/// The meshes that are on the adapter, by key.
#[derive(Debug)]
pub(super) struct Meshes {
    all: BTreeMap<u64, (Weak<Mesh>, Result<GpuMesh, Unfit>)>,
    /// The layout of textures as an input of the programs that draw surfaces.
    textures: wgpu::BindGroupLayout,
}

impl Meshes {
    pub fn new(textures: wgpu::BindGroupLayout) -> Self {
        Self { all: BTreeMap::new(), textures }
    }

    /// Removes the meshes that no caller holds any more.
    pub fn evict(&mut self) {
        self.all.retain(|_, (mesh, _)| mesh.strong_count() > 0);
    }

    /// Copies a mesh to the adapter unless the adapter already has it.
    pub fn upload(&mut self, gpu: &Gpu, mesh: &Arc<Mesh>) -> &Result<GpuMesh, Unfit> {
        let Self { all, textures } = self;
        let make = || (Arc::downgrade(mesh), GpuMesh::new(gpu, textures, mesh));
        let (_, uploaded) = all.entry(mesh.key()).or_insert_with(make);
        uploaded
    }

    /// Returns the uploaded mesh with the given key.
    pub fn get(&self, key: u64) -> &GpuMesh {
        self.all[&key].1.as_ref().expect("only meshes that are fit are drawn")
    }

    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.all.len()
    }
}

impl GpuMesh {
    /// Returns the number of corner indices of the mesh.
    pub fn count(&self) -> u32 {
        self.parts[4].end
    }

    fn new(gpu: &Gpu, textures: &wgpu::BindGroupLayout, mesh: &Mesh) -> Result<Self, Unfit> {
        let finite = |vertex: &Vertex| vertex.position.iter().chain(&vertex.uv).all(|number| number.is_finite());
        if let Some(index) = mesh.vertices().iter().position(|vertex| !finite(vertex)) {
            let Vertex { position, uv, .. } = mesh.vertices()[index];
            return Err(Unfit::Corner(InstanceFlaw::Corner { index, position, uv }));
        }
        let (corners, triangles) = spoken_for(mesh);
        let (indices, parts) = parted(&triangles);
        let bytes = (corners.len() * size_of::<RawCorner>()).max(indices.len() * 4) as u64;
        if bytes > gpu.limits.max_buffer_size {
            return Err(Unfit::TooLarge(bytes));
        }
        // A mesh without corners has no bounds.
        let bounds = if corners.is_empty() { Default::default() } else { mesh.bounds() };
        let [low, high] = bounds.map(|bound| Vector3::from(bound).cast());
        let buffer = |contents: &[u8], usage| {
            let (size, usage) = (contents.len() as u64, usage | wgpu::BufferUsages::COPY_DST);
            let mesh = wgpu::BufferDescriptor { label: Some("mesh"), size, usage, mapped_at_creation: false };
            // A buffer that is created with its contents panics if the device is lost; writing to a buffer returns an
            // error.
            let buffer = gpu.device.create_buffer(&mesh);
            gpu.queue.write_buffer(&buffer, 0, contents);
            buffer
        };
        Ok(Self {
            corners: buffer(bytemuck::cast_slice(&corners), wgpu::BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
            parts,
            pictures: mesh.pictures().map(|of| pictures(gpu, textures, &of.all)),
            low,
            high,
            lamp: lamp_of(mesh),
        })
    }
}

/// Returns the middle of all lamps high up in a mesh; `None` if the mesh has no such lamp.
fn lamp_of(mesh: &Mesh) -> Option<Point3<f64>> {
    let lamps = mesh.vertices().iter().filter(|vertex| vertex.surface == SurfaceKind::WhiteLamp);
    let high: Vec<_> = lamps.filter(|vertex| vertex.position[2] > HIGH).collect();
    let sum: Vector3<f64> = high.iter().map(|vertex| Vector3::from(vertex.position).cast::<f64>()).sum();
    (!high.is_empty()).then(|| Point3::from(sum / high.len() as f64))
}

/// Returns the corners and triangles of a mesh, rearranged so that no two triangles share their first corner. Values
/// that are constant over a triangle are stored at its first corner. Triangles are turned so that they begin with a
/// corner that is still free; if no corner is free, one is doubled.
fn spoken_for(mesh: &Mesh) -> (Vec<RawCorner>, Vec<(Finish, [u32; 3])>) {
    let mut corners: Vec<RawCorner> = mesh.vertices().iter().map(raw).collect();
    let mut free = vec![true; corners.len()];
    let mut triangles = Vec::with_capacity(mesh.indices().len() / 3);
    for (index, triangle) in mesh.indices().chunks_exact(3).enumerate() {
        let picture = mesh.pictures().and_then(|pictures| pictures.of[index]);
        let [a, b, c] = [0, 1, 2].map(|corner| triangle[corner]);
        let turned = [[a, b, c], [b, c, a], [c, a, b]];
        let turned = turned.into_iter().find(|turned| free[turned[0] as usize]).unwrap_or_else(|| {
            corners.push(corners[a as usize]);
            free.push(true);
            [corners.len() as u32 - 1, b, c]
        });
        let speaker = &mut corners[turned[0] as usize];
        let Vertex { surface, semantic, .. } = mesh.vertices()[a as usize];
        // A triangle without an area has no pixels; its values only have to be finite.
        speaker.face = face(mesh, triangle).unwrap_or_default().into();
        speaker.kind = [surface as u8, semantic as u8, picture.unwrap_or_else(|| layer(surface)), 0];
        free[turned[0] as usize] = false;
        triangles.push((if picture.is_some() { Finish::Pictured } else { Finish::of(surface) }, turned));
    }
    (corners, triangles)
}

/// Returns the corner indices of triangles, sorted by finish, and the range of each finish.
fn parted(triangles: &[(Finish, [u32; 3])]) -> (Vec<u32>, [Range<u32>; 5]) {
    let mut indices = Vec::with_capacity(3 * triangles.len());
    let parts = Finish::ALL.map(|finish| {
        let begin = indices.len() as u32;
        indices.extend(triangles.iter().filter(|(of, _)| *of == finish).flat_map(|(_, corners)| corners));
        begin..indices.len() as u32
    });
    (indices, parts)
}

/// Returns the unit normal of a triangle; `None` if the area of the triangle is 0.
fn face(mesh: &Mesh, triangle: &[u32]) -> Option<Vector3<f32>> {
    let corner = |index: usize| Vector3::from(mesh.vertices()[triangle[index] as usize].position).cast::<f64>();
    let (a, b, c) = (corner(0), corner(1), corner(2));
    Some((b - a).cross(&(c - a)).try_normalize(0.0)?.cast())
}

fn raw(vertex: &Vertex) -> RawCorner {
    let whole = |part: f32| (part.clamp(-1.0, 1.0) * 32767.0).round() as i16;
    let [x, y, z] = vertex.normal.map(whole);
    let [red, green, blue] = vertex.colour.map(|part| (part.clamp(0.0, 1.0) * 65535.0).round() as u16);
    RawCorner {
        position: vertex.position,
        face: [0.0; 3],
        normal: [x, y, z, 0],
        uv: vertex.uv,
        colour: [red, green, blue, 0],
        kind: [vertex.surface as u8, vertex.semantic as u8, 0, 0],
    }
}

impl Shape {
    /// Returns the centre and the radius of a sphere around the mesh, in the camera's coordinates.
    pub fn ball(&self, mesh: &GpuMesh) -> (Point3<f64>, f64) {
        let middle = (mesh.low + mesh.high) / 2.0;
        let radius = ((mesh.high - mesh.low) / 2.0).component_mul(&self.scale).norm();
        (self.to_camera * Point3::from(middle.component_mul(&self.scale)), radius)
    }
}
