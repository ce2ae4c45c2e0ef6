//! The shapes of objects: triangles with normals, texture coordinates and surface kinds.

pub(crate) mod barriers;
pub(crate) mod bicycle;
pub(crate) mod bus;
pub(crate) mod car;
pub(crate) mod cars;
pub(crate) mod clay;
pub(crate) mod colours;
pub(crate) mod furniture;
pub(crate) mod garb;
pub(crate) mod house;
pub(crate) mod lamps;
pub(crate) mod models;
pub(crate) mod motorcycle;
pub(crate) mod person;
pub(crate) mod picture;
mod plant;
pub(crate) mod signs;
pub(crate) mod traffic_light;
pub(crate) mod truck;
pub(crate) mod van;

use picture::{Picture, Pictures};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The finish of a surface, which determines how the surface reflects or emits light. In the look
/// [`Textured`](crate::Look::Textured), the kinds from [`Asphalt`](Self::Asphalt) on that are not lamps have textures,
/// which follow the texture coordinates in metres. In the look [`Flat`](crate::Look::Flat) they have a grain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum SurfaceKind {
    /// A dull surface in the colour of its corners.
    Plain = 0,
    /// A glossy surface in the colour of the instance, for example the body of a car.
    Paint = 1,
    /// A dull surface in the colour of the instance, for example a jacket or a wall.
    Cloth = 2,
    /// A dark and glossy surface, for example a window.
    Glass = 3,
    /// A grained surface in the colour of its corners, whose grain follows the texture coordinates in metres.
    Asphalt = 4,
    /// A coarsely and unevenly grained surface, for example grass or leaves.
    Grown = 5,
    /// A white lamp that shines in the dark, for example a head lamp or a street lamp.
    WhiteLamp = 6,
    /// A red lamp that shines in the dark, for example a rear lamp.
    RedLamp = 7,
    /// Paving slabs in the colour of their corners, for example a sidewalk.
    Slabs = 8,
    /// Concrete in the colour of its corners, for example a kerb.
    Concrete = 9,
    /// Worn paint on a road in the colour of its corners.
    Marking = 10,
    /// Grass in the colour of its corners.
    Grass = 11,
    /// A wall of bricks in the colour of the instance.
    Brick = 12,
    /// A plastered wall in the colour of the instance.
    Plaster = 13,
    /// Roof tiles in the colour of their corners.
    Tiles = 14,
    /// The bark of a tree in the colour of its corners.
    Bark = 15,
    /// A lamp that shines in the colour of its corners by day and night, for example a brake lamp. In the look
    /// [`Flat`](crate::Look::Flat) it does not shine.
    Glow = 16,
}

/// The semantic class of an object, with the numbers of CARLA's classes since its version 0.9.14.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[expect(missing_docs, reason = "the names are those of the classes")]
pub enum Semantic {
    Unlabeled = 0,
    Road = 1,
    Sidewalk = 2,
    Building = 3,
    Wall = 4,
    Fence = 5,
    Pole = 6,
    TrafficLight = 7,
    TrafficSign = 8,
    Vegetation = 9,
    Terrain = 10,
    Sky = 11,
    Pedestrian = 12,
    Rider = 13,
    Car = 14,
    Truck = 15,
    Bus = 16,
    Train = 17,
    Motorcycle = 18,
    Bicycle = 19,
    Static = 20,
    Dynamic = 21,
    Other = 22,
    Water = 23,
    RoadLine = 24,
    Ground = 25,
    Bridge = 26,
    RailTrack = 27,
    GuardRail = 28,
}

/// A corner of a mesh's triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The position of the corner in metres.
    pub position: [f32; 3],
    /// The normal of the surface at the corner, as a unit vector that points outwards.
    pub normal: [f32; 3],
    /// The texture coordinates of the corner, in metres for grained surfaces.
    pub uv: [f32; 2],
    /// The red, green and blue of the corner in linear light, from 0 to 1.
    pub colour: [f32; 3],
    /// The finish of the surface, which determines how the surface reflects or emits light.
    pub surface: SurfaceKind,
    /// The semantic class of the object to which the corner belongs.
    pub semantic: Semantic,
}

/// The surface of an object as triangles, whose corners are counter-clockwise as seen from outside.
#[derive(Debug)]
pub struct Mesh {
    key: u64,
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
    bounds: [[f32; 3]; 2],
    coarse: Option<Coarse>,
    pictures: Option<Pictures>,
}

/// A mesh of the same shape with fewer triangles.
#[derive(Debug)]
struct Coarse {
    mesh: Arc<Mesh>,
    detail: f32,
}

impl Mesh {
    /// Makes a mesh of corners and of the indices of each triangle's three corners. Every three indices make a
    /// triangle.
    ///
    /// # Panics
    /// An index names no corner, or the number of indices is not a multiple of three.
    pub fn new(vertices: Vec<Vertex>, indices: Vec<u32>) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        assert!(indices.len().is_multiple_of(3), "three indices make a triangle");
        assert!(indices.iter().all(|index| (*index as usize) < vertices.len()), "an index names a corner");
        let bound = |start: f32, best: fn(f32, f32) -> f32| {
            let positions = vertices.iter().map(|vertex| vertex.position);
            positions.fold([start; 3], |bound, of| std::array::from_fn(|axis| best(bound[axis], of[axis])))
        };
        let bounds = [bound(f32::INFINITY, f32::min), bound(f32::NEG_INFINITY, f32::max)];
        Self { key: NEXT.fetch_add(1, Ordering::Relaxed), vertices, indices, bounds, coarse: None, pictures: None }
    }

    /// Sets a mesh of the same shape with fewer triangles. `detail` is the size in metres, across the mesh, of the largest
    /// parts that the coarse mesh lacks. In the look [`Textured`](crate::Look::Textured), a renderer draws the coarse mesh
    /// where these parts are smaller than three quarters of a pixel, and for shadows. The coarse mesh may have a coarse mesh of
    /// its own.
    pub fn with_coarse(self, coarse: impl Into<Arc<Self>>, detail: f32) -> Self {
        Self { coarse: Some(Coarse { mesh: coarse.into(), detail }), ..self }
    }

    /// Adds the pictures of the surface, and for each triangle the place of its picture, if it has one.
    pub(crate) fn with_pictures(self, all: Vec<Picture>, of: Vec<Option<u8>>) -> Self {
        let pictures = (!all.is_empty()).then_some(Pictures { all, of });
        Self { pictures, ..self }
    }

    /// Returns the pictures of the surface, if it has any.
    pub(crate) fn pictures(&self) -> Option<&Pictures> {
        self.pictures.as_ref()
    }

    /// Returns the mesh of the same shape with fewer triangles, if there is one.
    pub fn coarse(&self) -> Option<&Arc<Self>> {
        self.coarse.as_ref().map(|coarse| &coarse.mesh)
    }

    /// Returns the size in metres of the largest parts that the mesh with fewer triangles lacks; 0 without such a mesh.
    pub fn detail(&self) -> f32 {
        self.coarse.as_ref().map_or(0.0, |coarse| coarse.detail)
    }

    /// Returns a number that identifies the mesh within the process. A renderer uses it to know which meshes it has
    /// uploaded.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// Returns the least and the greatest coordinates of the corners in metres; infinite if there are no corners.
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        self.bounds
    }

    /// Returns the corners of the mesh.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Returns the indices of the corners, three indices for each triangle.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }
}

#[cfg(test)]
mod tests;
