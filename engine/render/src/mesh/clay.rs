//! Models shapes: triangles out of a few primitives; normals and texture coordinates are computed at the end.
//!
//! Everything is flat until [`Clay::mesh`] smooths the edges that bend by less than [`CREASE`]: a tube of ten sides
//! looks round, and a box keeps its edges. Texture coordinates are metres along the two axes that a facet faces least.

use super::{Mesh, SurfaceKind, Vertex};
use crate::Semantic;
use nalgebra::{Matrix3, Vector3};
use std::collections::HashMap;
use std::f32::consts::{FRAC_PI_2, TAU};

/// The cosine of the angle (46 degrees) between two facets from which on there is an edge between them.
const CREASE: f32 = 0.695;

/// A point of a shape, in metres.
pub(crate) type Point = Vector3<f32>;

/// The material of a facet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Matter {
    /// The colour of the material in linear light.
    pub colour: [f32; 3],
    pub surface: SurfaceKind,
    pub semantic: Semantic,
}

impl Matter {
    pub fn new(surface: SurfaceKind, colour: [f32; 3], semantic: Semantic) -> Self {
        Self { colour, surface, semantic }
    }

    /// Makes a material that gets its colour from the instance of the mesh.
    pub fn painted(surface: SurfaceKind, semantic: Semantic) -> Self {
        Self::new(surface, [1.0; 3], semantic)
    }
}

/// A shape that is being modelled.
#[derive(Debug, Default)]
pub(crate) struct Clay {
    triangles: Vec<([Point; 3], Matter)>,
}

pub(crate) fn at(x: f32, y: f32, z: f32) -> Point {
    Point::new(x, y, z)
}

/// Returns a regular polygon around a centre, counter-clockwise as seen against the direction of `axis`. One corner
/// lies towards z, or towards x if the axis is z.
pub(crate) fn ring(centre: Point, axis: Point, radius: f32, sides: usize) -> Vec<Point> {
    let axis = axis.normalize();
    let up = if axis.z.abs() > 0.9 { Point::x() } else { Point::z() };
    let up = (up - axis * axis.dot(&up)).normalize();
    let side = axis.cross(&up);
    let corner = |i: usize| {
        let (sin, cos) = libm::sincosf(TAU * i as f32 / sides as f32);
        centre + (up * cos + side * sin) * radius
    };
    (0..sides).map(corner).collect()
}

/// Returns a level oval with the half-axes `x` and `y`, counter-clockwise as seen from above.
pub(crate) fn oval(centre: Point, x: f32, y: f32, sides: usize) -> Vec<Point> {
    let stretched = |corner: Point| at(centre.x + x * corner.x, centre.y + y * corner.y, centre.z);
    ring(Point::zeros(), Point::z(), 1.0, sides).into_iter().map(stretched).collect()
}

/// Returns the part of a four-sided facet between the shares `u` and `v` of its sides, raised by `lift` metres. The
/// facet's corners are counter-clockwise; u runs from the first to the second corner, v from the first to the last.
pub(crate) fn patch(facet: [Point; 4], u: [f32; 2], v: [f32; 2], lift: f32) -> [Point; 4] {
    let normal = (facet[2] - facet[0]).cross(&(facet[3] - facet[1])).normalize();
    let point = |u: f32, v: f32| {
        let [low, high] = [facet[0].lerp(&facet[1], u), facet[3].lerp(&facet[2], u)];
        low.lerp(&high, v) + normal * lift
    };
    [point(u[0], v[0]), point(u[1], v[0]), point(u[1], v[1]), point(u[0], v[1])]
}

impl Clay {
    /// Adds a flat convex polygon whose corners are counter-clockwise as seen from outside. Corners may coincide.
    pub fn facet(&mut self, corners: &[Point], of: Matter) {
        for i in 1..corners.len() - 1 {
            let triangle = [corners[0], corners[i], corners[i + 1]];
            if area(&triangle).norm() > 1e-9 {
                self.triangles.push((triangle, of));
            }
        }
    }

    /// Adds a box whose edges are parallel to the axes.
    pub fn cuboid(&mut self, min: [f32; 3], max: [f32; 3], of: Matter) {
        let level =
            |z: f32| [(min[0], min[1]), (max[0], min[1]), (max[0], max[1]), (min[0], max[1])].map(|(x, y)| at(x, y, z));
        self.loft(&[level(min[2]).to_vec(), level(max[2]).to_vec()], of);
    }

    /// Adds a solid that connects rings of equally many points, each ring counter-clockwise as seen from the next ring.
    pub fn loft(&mut self, rings: &[Vec<Point>], of: Matter) {
        self.hose(rings, of);
        let (first, last) = (&rings[0], &rings[rings.len() - 1]);
        self.facet(&first.iter().rev().copied().collect::<Vec<_>>(), of);
        self.facet(last, of);
    }

    /// Adds a prism over a convex profile between two values of y. The profile is in metres ahead and up,
    /// counter-clockwise as seen from the right.
    pub fn prism(&mut self, profile: &[[f32; 2]], across: [f32; 2], of: Matter) {
        let side = |y: f32| profile.iter().map(|[x, z]| at(*x, y, *z)).collect();
        self.loft(&[side(across[1]), side(across[0])], of);
    }

    /// Adds the surface of the solid that [`Clay::loft`] adds, without the surfaces at both ends.
    pub fn hose(&mut self, rings: &[Vec<Point>], of: Matter) {
        for pair in rings.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            for i in 0..a.len() {
                let j = (i + 1) % a.len();
                self.facet(&[a[i], a[j], b[j], b[i]], of);
            }
        }
    }

    /// Adds a round rod whose ends may have different radii.
    pub fn tube(&mut self, ends: [Point; 2], radii: [f32; 2], sides: usize, of: Matter) {
        let axis = ends[1] - ends[0];
        let rings = [0, 1].map(|end| ring(ends[end], axis, radii[end], sides));
        self.loft(&rings, of);
    }

    /// Adds an ellipsoid of `sides` facets around and half as many layers.
    pub fn ball(&mut self, centre: Point, radii: [f32; 3], sides: usize, of: Matter) {
        let layers = sides / 2;
        let layer = |i: usize| {
            let (sin, cos) = libm::sincosf(2.0 * FRAC_PI_2 * i as f32 / layers as f32);
            let wide = if i == 0 || i == layers { 0.0 } else { sin };
            oval(centre - Point::z() * (radii[2] * cos), radii[0] * wide, radii[1] * wide, sides)
        };
        self.hose(&(0..=layers).map(layer).collect::<Vec<_>>(), of);
    }

    /// Adds a tyre as an open ring around an axle along y.
    pub fn tyre(&mut self, centre: Point, radii: [f32; 2], width: f32, sides: usize, of: Matter) {
        let side = |y: f32, radius: f32| ring(centre + Point::y() * y, Point::y(), radius, sides);
        let [inner, outer] = radii;
        let half = 0.5 * width;
        self.hose(
            &[side(half, inner), side(-half, inner), side(-half, outer), side(half, outer), side(half, inner)],
            of,
        );
    }

    /// Adds the shapes that `build` adds, and their mirror images on the other side of the plane y = 0.
    pub fn mirrored(&mut self, build: impl Fn(&mut Self)) {
        let first = self.triangles.len();
        build(self);
        let flipped = |(corners, of): &([Point; 3], Matter)| {
            let [a, b, c] = corners.map(|corner| at(corner.x, -corner.y, corner.z));
            ([a, c, b], *of)
        };
        let mirrored: Vec<_> = self.triangles[first..].iter().map(flipped).collect();
        self.triangles.extend(mirrored);
    }

    /// Returns the shape, stretched to a length, a width and a height, and moved so that its middle is above the
    /// origin.
    pub fn fitted(mut self, size: [f32; 3]) -> Self {
        let corners = || self.triangles.iter().flat_map(|(corners, _)| corners);
        let min = corners().fold(Point::repeat(f32::INFINITY), |min, corner| min.inf(corner));
        let max = corners().fold(Point::repeat(f32::NEG_INFINITY), |max, corner| max.sup(corner));
        let stretch = Matrix3::from_diagonal(&Point::from(size).component_div(&(max - min)));
        let middle = at(0.5 * (min.x + max.x), 0.5 * (min.y + max.y), min.z);
        for corner in self.triangles.iter_mut().flat_map(|(corners, _)| corners) {
            *corner = stretch * (*corner - middle);
        }
        self
    }

    /// Returns the triangles of the shape as a mesh.
    pub fn mesh(self) -> Mesh {
        self.mesh_at([0.0; 2])
    }

    /// Returns the triangles of the shape as a mesh whose texture coordinates begin at a place, in metres along x and
    /// y.
    pub fn mesh_at(self, place: [f64; 2]) -> Mesh {
        let facing: Vec<Point> = self.triangles.iter().map(|(corners, _)| area(corners)).collect();
        let mut around: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
        for (index, (corners, _)) in self.triangles.iter().enumerate() {
            corners.iter().for_each(|corner| around.entry(bits(corner)).or_default().push(index));
        }
        let mut known: HashMap<[u32; 6], Vec<u32>> = HashMap::new();
        let (mut vertices, mut indices): (Vec<Vertex>, Vec<u32>) = Default::default();
        for (index, (corners, of)) in self.triangles.iter().enumerate() {
            let face = facing[index].normalize();
            for corner in corners {
                let near = around[&bits(corner)].iter().map(|index| facing[*index]);
                let normal: Point = near.filter(|facing| facing.normalize().dot(&face) > CREASE).sum();
                let normal = normal.normalize();
                let vertex = Vertex {
                    position: (*corner).into(),
                    normal: normal.into(),
                    uv: unwrapped(corner, &face, place),
                    colour: of.colour,
                    surface: of.surface,
                    semantic: of.semantic,
                };
                let ([x, y, z], [a, b, c]) = (bits(corner), bits(&normal));
                let alike = known.entry([x, y, z, a, b, c]).or_default();
                let found = alike.iter().copied().find(|at| vertices[*at as usize] == vertex);
                indices.push(found.unwrap_or_else(|| {
                    vertices.push(vertex);
                    alike.push(vertices.len() as u32 - 1);
                    vertices.len() as u32 - 1
                }));
            }
        }
        Mesh::new(vertices, indices)
    }
}

/// Returns a vector that points out of a triangle and is twice as long as the triangle's area.
fn area(corners: &[Point; 3]) -> Point {
    (corners[1] - corners[0]).cross(&(corners[2] - corners[0]))
}

/// Returns the texture coordinates in metres of a point, in the coordinate plane that is most parallel to the facet.
fn unwrapped(point: &Point, facing: &Point, place: [f64; 2]) -> [f32; 2] {
    let [x, y] = [f64::from(point.x) + place[0], f64::from(point.y) + place[1]].map(|metres| metres as f32);
    match facing.iamax() {
        0 => [y, point.z],
        1 => [x, point.z],
        _ => [x, y],
    }
}

/// Returns the bits of a point's coordinates, which are equal for equal points. 0 and -0 give the same bits.
fn bits(point: &Point) -> [u32; 3] {
    let [x, y, z]: [f32; 3] = (*point).into();
    [x, y, z].map(|metres| (metres + 0.0).to_bits())
}
