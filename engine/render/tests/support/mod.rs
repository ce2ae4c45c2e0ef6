//! Little meshes and scenes, and a renderer where there is an adapter.

#![allow(dead_code, reason = "each test file uses some of it")]

mod adapter;
pub mod golden;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use paracosm_render::{
    Atmosphere, Camera, Frame, Instance, Mesh, Renderer, Scene, Semantic, SurfaceKind, Vertex, View, WantedImages,
};
use std::sync::Arc;

/// A renderer; `None`, and a note, where there is no adapter and nobody insists.
pub fn renderer() -> Option<Renderer> {
    adapter::unless_missing(Renderer::new())
}

pub const NOTHING: WantedImages = WantedImages {
    rgb: false,
    linear: false,
    depth: false,
    semantic: false,
    instance: false,
    alone: false,
    shadows: false,
};
pub const RGB: WantedImages = WantedImages { rgb: true, ..NOTHING };
pub const EVERYTHING: WantedImages =
    WantedImages { rgb: true, linear: true, depth: true, semantic: true, instance: true, alone: true, shadows: true };

/// One frame of one view.
pub fn one(renderer: &mut Renderer, view: &View<'_>, wanted: WantedImages) -> Frame {
    let mut frames = renderer.render(std::slice::from_ref(view), wanted).expect("the adapter works");
    frames.pop().expect("one view, one frame").expect("the view is sound")
}

pub fn vertex(position: [f32; 3], normal: [f32; 3], look: Look) -> Vertex {
    let Look { colour, surface, semantic } = look;
    Vertex { position, normal, uv: [position[0], position[1]], colour, surface, semantic }
}

#[derive(Clone, Copy)]
pub struct Look {
    pub colour: [f32; 3],
    pub surface: SurfaceKind,
    pub semantic: Semantic,
}

pub fn look(colour: [f32; 3], surface: SurfaceKind, semantic: Semantic) -> Look {
    Look { colour, surface, semantic }
}

/// A box from -size/2 to size/2 across and from 0 to size up.
pub fn cuboid(size: [f32; 3], look: Look) -> Mesh {
    let mut vertices = Vec::new();
    let mut indices = Vec::new();
    for (axis, side) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0_f32)] {
        let mut normal = [0.0; 3];
        normal[axis] = side;
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let first = vertices.len() as u32;
        for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0_f32)] {
            let mut corner = [0.0; 3];
            (corner[axis], corner[u], corner[v]) = (side, a * side, b);
            let at = |axis: usize| corner[axis] * size[axis] / 2.0;
            vertices.push(vertex([at(0), at(1), at(2) + size[2] / 2.0], normal, look));
        }
        indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    Mesh::new(vertices, indices)
}

/// A level rectangle of which x and y go from these to those.
pub fn sheet(low: [f32; 2], high: [f32; 2], look: Look) -> Mesh {
    let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
    let vertices = corners.map(|[x, y]| vertex([x, y, 0.0], [0.0, 0.0, 1.0], look));
    Mesh::new(vertices.to_vec(), vec![0, 1, 2, 0, 2, 3])
}

/// A ball around the origin of 2 * rings * rings triangles or so.
pub fn ball(radius: f32, rings: u32, look: Look) -> Mesh {
    let around = 2 * rings;
    let mut vertices = Vec::new();
    let mut indices = Vec::new();
    for ring in 0..=rings {
        let (sin_down, cos_down) = libm::sincosf(ring as f32 / rings as f32 * std::f32::consts::PI);
        for step in 0..=around {
            let (sin, cos) = libm::sincosf(step as f32 / around as f32 * std::f32::consts::TAU);
            let normal = [sin_down * cos, sin_down * sin, cos_down];
            vertices.push(vertex(normal.map(|part| part * radius), normal, look));
        }
    }
    for ring in 0..rings {
        for step in 0..around {
            let upper = ring * (around + 1) + step;
            let lower = upper + around + 1;
            indices.extend([upper, lower, upper + 1, upper + 1, lower, lower + 1]);
        }
    }
    Mesh::new(vertices, indices)
}

/// A thing here, turned by this yaw.
pub fn thing(mesh: &Arc<Mesh>, place: [f32; 3], yaw: f32, id: u16) -> Instance {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
    let pose = Isometry3::from_parts(Translation3::from(Vector3::from(place)), turn);
    Instance { mesh: Arc::clone(mesh), pose, scale: [1.0; 3], paint: [0.5, 0.1, 0.1], id }
}

pub fn scene(instances: Vec<Instance>) -> Scene {
    Scene { instances, air: Atmosphere::default(), look: paracosm_render::Look::Flat }
}

/// A camera 1.5 m above the origin of what carries it, that looks forward.
pub fn camera(width: u32, height: u32) -> Camera {
    let camera = Camera::new(width, height, 24.0, 36.0).expect("a sound camera");
    camera.mounted(Point3::new(0.0, 0.0, 1.5), 0.0, 0.0, 0.0).expect("a sound mount")
}

/// A street with a crossing, parked cars, houses, trees, lamps and people: about 30 things of 10 meshes.
pub fn street() -> Scene {
    let plain = |colour, semantic| look(colour, SurfaceKind::Plain, semantic);
    let meshes = [
        sheet([-100.0, -60.0], [300.0, 60.0], look([0.10, 0.17, 0.04], SurfaceKind::Grown, Semantic::Terrain)),
        sheet([-50.0, -3.5], [250.0, 3.5], look([0.075, 0.075, 0.08], SurfaceKind::Asphalt, Semantic::Road)),
        sheet([-1.5, -0.06], [1.5, 0.06], plain([0.8, 0.8, 0.8], Semantic::RoadLine)),
        sheet([-1.5, -0.25], [1.5, 0.25], plain([0.8, 0.8, 0.8], Semantic::RoadLine)),
        cuboid([300.0, 2.0, 0.12], plain([0.35, 0.34, 0.33], Semantic::Sidewalk)),
        cuboid([10.0, 8.0, 7.0], look([0.5; 3], SurfaceKind::Cloth, Semantic::Building)),
        car(),
        ball(1.0, 12, look([0.08, 0.2, 0.03], SurfaceKind::Grown, Semantic::Vegetation)),
        cuboid([0.25, 0.25, 3.0], plain([0.15, 0.1, 0.06], Semantic::Vegetation)),
        person(),
        lamp_post(),
    ]
    .map(Arc::new);
    let [ground, road, dash, bar, kerb, house, car, crown, trunk, person, post] = &meshes;
    let mut instances = vec![
        thing(ground, [0.0, 0.0, -0.02], 0.0, 0),
        thing(road, [0.0; 3], 0.0, 0),
        thing(kerb, [100.0, 4.5, 0.0], 0.0, 0),
        thing(kerb, [100.0, -4.5, 0.0], 0.0, 0),
    ];
    instances.extend((0..6).map(|index| thing(dash, [6.0 + 6.0 * index as f32, 0.0, 0.01], 0.0, 0)));
    instances.extend((0..7).map(|index| thing(bar, [22.0, -3.0 + index as f32, 0.015], 0.0, 0)));
    for (index, (x, y, paint)) in [
        (12.0, 11.0, [0.5, 0.3, 0.2]),
        (24.0, 11.0, [0.55, 0.5, 0.4]),
        (38.0, 11.0, [0.3, 0.35, 0.4]),
        (18.0, -11.0, [0.5, 0.45, 0.35]),
        (34.0, -11.0, [0.45, 0.25, 0.2]),
    ]
    .into_iter()
    .enumerate()
    {
        instances.push(Instance { paint, ..thing(house, [x, y, 0.0], 0.0, 20 + index as u16) });
    }
    for (index, (x, y, paint)) in
        [(14.0, 2.4, [0.02, 0.08, 0.3]), (30.0, 2.4, [0.4, 0.4, 0.42]), (11.0, -2.4, [0.35, 0.02, 0.02])]
            .into_iter()
            .enumerate()
    {
        instances.push(Instance { paint, ..thing(car, [x, y, 0.0], 0.0, 10 + index as u16) });
    }
    for (x, y) in [(20.0, 5.2), (32.0, -5.2), (46.0, 5.2)] {
        instances.push(thing(trunk, [x, y, 0.1], 0.0, 0));
        instances.push(Instance { scale: [1.6, 1.6, 1.3], ..thing(crown, [x, y, 3.6], 0.3, 0) });
    }
    instances.push(Instance { paint: [0.6, 0.25, 0.02], ..thing(person, [22.0, -1.2, 0.0], 1.6, 1) });
    instances.push(Instance { paint: [0.05, 0.2, 0.4], ..thing(person, [26.0, 4.4, 0.12], 0.4, 2) });
    instances.push(thing(post, [16.0, -4.2, 0.1], 1.57, 0));
    instances.push(thing(post, [28.0, 4.2, 0.1], -1.57, 0));
    scene(instances)
}

/// Several meshes as one.
fn joined(parts: impl IntoIterator<Item = (Mesh, [f32; 3])>) -> Mesh {
    let mut vertices = Vec::new();
    let mut indices = Vec::new();
    for (part, at) in parts {
        let first = vertices.len() as u32;
        indices.extend(part.indices().iter().map(|index| first + index));
        vertices.extend(part.vertices().iter().map(|vertex| Vertex {
            position: std::array::from_fn(|axis| vertex.position[axis] + at[axis]),
            ..*vertex
        }));
    }
    Mesh::new(vertices, indices)
}

fn car() -> Mesh {
    let of = |surface, colour| look(colour, surface, Semantic::Car);
    let tyre = || cuboid([0.62, 0.2, 0.62], of(SurfaceKind::Plain, [0.02; 3]));
    joined([
        (cuboid([4.3, 1.8, 0.6], of(SurfaceKind::Paint, [1.0; 3])), [0.0, 0.0, 0.3]),
        (cuboid([2.2, 1.6, 0.5], of(SurfaceKind::Glass, [0.03; 3])), [-0.2, 0.0, 0.9]),
        (cuboid([2.0, 1.5, 0.06], of(SurfaceKind::Paint, [1.0; 3])), [-0.2, 0.0, 1.38]),
        (cuboid([0.04, 0.3, 0.15], of(SurfaceKind::RedLamp, [0.3, 0.0, 0.0])), [-2.16, 0.7, 0.65]),
        (cuboid([0.04, 0.3, 0.15], of(SurfaceKind::RedLamp, [0.3, 0.0, 0.0])), [-2.16, -0.7, 0.65]),
        (cuboid([0.04, 0.3, 0.15], of(SurfaceKind::WhiteLamp, [0.8; 3])), [2.16, 0.7, 0.6]),
        (cuboid([0.04, 0.3, 0.15], of(SurfaceKind::WhiteLamp, [0.8; 3])), [2.16, -0.7, 0.6]),
        (tyre(), [1.4, 0.8, 0.0]),
        (tyre(), [1.4, -0.8, 0.0]),
        (tyre(), [-1.4, 0.8, 0.0]),
        (tyre(), [-1.4, -0.8, 0.0]),
    ])
}

fn person() -> Mesh {
    let of = |surface, colour| look(colour, surface, Semantic::Pedestrian);
    joined([
        (cuboid([0.22, 0.16, 0.8], of(SurfaceKind::Plain, [0.03, 0.03, 0.06])), [0.0, 0.1, 0.0]),
        (cuboid([0.22, 0.16, 0.8], of(SurfaceKind::Plain, [0.03, 0.03, 0.06])), [0.0, -0.1, 0.0]),
        (cuboid([0.28, 0.46, 0.65], of(SurfaceKind::Cloth, [1.0; 3])), [0.0, 0.0, 0.8]),
        (ball(0.13, 8, of(SurfaceKind::Plain, [0.5, 0.3, 0.2])), [0.0, 0.0, 1.62]),
    ])
}

fn lamp_post() -> Mesh {
    let of = |surface, colour| look(colour, surface, Semantic::Pole);
    joined([
        (cuboid([0.14, 0.14, 5.0], of(SurfaceKind::Plain, [0.2; 3])), [0.0; 3]),
        (cuboid([1.2, 0.1, 0.1], of(SurfaceKind::Plain, [0.2; 3])), [0.6, 0.0, 4.95]),
        (cuboid([0.5, 0.2, 0.08], of(SurfaceKind::WhiteLamp, [0.7; 3])), [1.1, 0.0, 4.87]),
    ])
}
