//! The shapes of things: triangles with normals, texture coordinates and surface kinds.

pub(crate) mod bicycle;
pub(crate) mod car;
pub(crate) mod clay;
mod colours;
pub(crate) mod furniture;
pub(crate) mod house;
pub(crate) mod models;
pub(crate) mod person;
mod plant;
pub(crate) mod truck;

use std::sync::atomic::{AtomicU64, Ordering};

/// The way in which a surface reacts to light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum SurfaceKind {
    /// Dull, in the surface's own colour.
    Plain = 0,
    /// Glossy, in the colour of the instance: the body of a car.
    Paint = 1,
    /// Dull, in the colour of the instance: a jacket, a wall.
    Cloth = 2,
    /// Dark and glossy.
    Glass = 3,
    /// Grained, in the surface's own colour; the grain follows the texture coordinates, which are metres.
    Asphalt = 4,
    /// Grained like asphalt, but coarse and uneven: grass, leaves.
    Grown = 5,
    /// A lamp that shines white when it is dark: a head lamp, a street lamp.
    WhiteLamp = 6,
    /// A lamp that shines red when it is dark.
    RedLamp = 7,
}

/// The class of a thing, with the numbers of CARLA's semantic classes since its version 0.9.14.
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

/// A corner of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The position of the corner in metres.
    pub position: [f32; 3],
    /// The normal of the surface, a unit vector that points outwards.
    pub normal: [f32; 3],
    /// The texture coordinates; for grained surfaces in metres.
    pub uv: [f32; 2],
    /// The colour of the corner, red, green and blue in linear light, from 0 to 1.
    pub colour: [f32; 3],
    /// The way in which the surface reacts to light.
    pub surface: SurfaceKind,
    /// The class of the thing that the corner is part of.
    pub semantic: Semantic,
}

/// The shape of a thing, made of triangles whose corners are counter-clockwise as seen from outside.
#[derive(Debug)]
pub struct Mesh {
    key: u64,
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
}

impl Mesh {
    /// Makes a mesh of these corners. Every three indices make a triangle.
    ///
    /// # Panics
    /// An index names no corner, or the number of indices is not a multiple of three.
    pub fn new(vertices: Vec<Vertex>, indices: Vec<u32>) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        assert!(indices.len().is_multiple_of(3), "three indices make a triangle");
        assert!(indices.iter().all(|index| (*index as usize) < vertices.len()), "an index names a corner");
        Self { key: NEXT.fetch_add(1, Ordering::Relaxed), vertices, indices }
    }

    /// Returns a number that no other mesh of this process has. A renderer uses it to know which meshes it has
    /// uploaded.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// Returns the corners of the mesh.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Returns the indices of the corners, three for each triangle.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }
}

#[cfg(test)]
mod tests;
