//! Shapes of things: triangles with normals, texture coordinates, and what they are made of.

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

/// How a surface answers to light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum SurfaceKind {
    /// Its own colour, dull.
    Plain = 0,
    /// The colour of the instance, glossy: a car's body.
    Paint = 1,
    /// The colour of the instance, dull: a jacket, a wall.
    Cloth = 2,
    /// Dark and glossy.
    Glass = 3,
    /// Its own colour, grained over the texture coordinates, which are metres.
    Asphalt = 4,
    /// As asphalt, but coarse and uneven: grass, leaves.
    Grown = 5,
    /// Shines by itself when it is dark: head lamps, street lamps.
    WhiteLamp = 6,
    /// Shines red by itself when it is dark.
    RedLamp = 7,
}

/// What a thing is, with the numbers of CARLA's semantic classes since its version 0.9.14.
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
    /// Metres.
    pub position: [f32; 3],
    /// A unit vector out of the surface.
    pub normal: [f32; 3],
    /// Texture coordinates; of grained surfaces in metres.
    pub uv: [f32; 2],
    /// Red, green and blue in linear light, from 0 to 1.
    pub colour: [f32; 3],
    /// How it answers to light.
    pub surface: SurfaceKind,
    /// What it is part of.
    pub semantic: Semantic,
}

/// Triangles, counter-clockwise as seen from outside.
#[derive(Debug)]
pub struct Mesh {
    key: u64,
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
}

impl Mesh {
    /// A mesh of these corners, of which every three indices make a triangle.
    ///
    /// # Panics
    /// An index names no corner, or they are no multiple of three.
    pub fn new(vertices: Vec<Vertex>, indices: Vec<u32>) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        assert!(indices.len().is_multiple_of(3), "three indices make a triangle");
        assert!(indices.iter().all(|index| (*index as usize) < vertices.len()), "an index names a corner");
        Self { key: NEXT.fetch_add(1, Ordering::Relaxed), vertices, indices }
    }

    /// A number that no other mesh of this process has: by it a renderer knows what it has uploaded.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// The corners.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Three indices of corners for each triangle.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }
}

#[cfg(test)]
mod tests;
