//! Prepares a view for the adapter: checks that it can be drawn, finds the objects in sight, and computes their places.

use super::adapter::Gpu;
use super::inside::inside;
use super::meshes::{GpuMesh, Meshes, Unfit};
use super::raw::Shape;
use super::raw::{RawInstance, RawView, four};
use super::shadow::{ShadowMap, to_sun};
use crate::{Camera, Instance, InstanceFlaw, Look, Mesh, View, ViewError, WantedImages};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use std::collections::{BTreeMap, BTreeSet};
use std::iter::successors;
use std::ops::Range;
use std::sync::Arc;

/// A view that is ready to be drawn.
#[derive(Debug, Clone)]
pub(super) struct Prepared {
    pub raw: RawView,
    pub look: Look,
    /// The index of the shadow map among the sizes of maps.
    pub shadows: usize,
    /// The instances that the camera sees, and the instances that throw shadows.
    pub instances: Vec<RawInstance>,
    pub draws: Vec<Draw>,
    pub casters: Vec<Draw>,
    /// The index of each object's bit in the masks without occlusion, by the object's id; empty without masks.
    pub bits: BTreeMap<u16, u32>,
}

/// The conditions besides daylight.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Weather {
    /// True if head lamps and street lamps shine.
    pub lamps: bool,
    pub fog: bool,
}

/// A mesh that is drawn for some of the instances of its view.
#[derive(Debug, Clone)]
pub(super) struct Draw {
    pub mesh: u64,
    pub instances: Range<u32>,
    /// True if the instances have ids, so that images show which of them is where.
    pub has_ids: bool,
}

impl Prepared {
    /// Returns the weather conditions that determine which shader programs draw the view.
    pub fn weather(&self) -> Weather {
        Weather { lamps: self.raw.sun[3] > 0.0, fog: self.raw.up[3] > 0.0 }
    }

    /// Returns the number of 32-bit words for each pixel in the masks of objects without occlusion.
    pub fn words(&self) -> u32 {
        (self.bits.len() as u32).div_ceil(32)
    }
}

/// The size in pixels below which parts of objects may be missing. With twice this size, a detector that learned from
/// photographs found 30 vehicles instead of 46 in the study `fig8`.
const INVISIBLE: f64 = 0.75;

/// An instance that may be drawn.
struct Placed<'a> {
    instance: &'a Instance,
    mesh: &'a GpuMesh,
    /// The key of the mesh that is fine enough for the size of the object in the image, and the key of the coarsest mesh.
    fine_enough: u64,
    coarsest: u64,
    shape: Shape,
    middle: Point3<f64>,
    radius: f64,
}

/// Prepares a view.
pub(super) fn prepare(
    gpu: &Gpu,
    meshes: &mut Meshes,
    view: &View<'_>,
    wanted: WantedImages,
) -> Result<Prepared, ViewError> {
    check(view)?;
    let eye = view.camera.pose(&view.pose);
    let to_eye = eye.inverse();
    let seen = || view.scene.instances.iter().enumerate().filter(|(_, instance)| view.without != Some(instance.id));
    for (index, instance) in seen() {
        check_instance(index, instance)?;
        let unfit = |unfit: &Unfit| not_drawable(gpu, index, instance.id, unfit);
        for mesh in successors(Some(&instance.mesh), |mesh| mesh.coarse()) {
            meshes.upload(gpu, mesh).as_ref().map_err(unfit)?;
        }
    }
    let focal = view.camera.focal_pixels();
    let mut placed = Vec::with_capacity(view.scene.instances.len());
    for (index, instance) in seen() {
        let mesh = meshes.get(instance.mesh.key());
        let shape = shape(instance, &to_eye);
        check_outside(index, instance, mesh, &shape)?;
        let (middle, radius) = shape.ball(mesh);
        let invisible = INVISIBLE * (middle.coords.norm() - radius) / focal;
        let (fine_enough, coarsest) = levels(instance, view.scene.look, invisible);
        placed.push(Placed { instance, mesh, fine_enough, coarsest, shape, middle, radius });
    }
    // Near objects hide far objects, whose hidden pixels then need no colour.
    placed.sort_by(|a, b| a.middle.coords.norm_squared().total_cmp(&b.middle.coords.norm_squared()));

    let sun = to_sun(&view.scene.air);
    let map = ShadowMap::new(&eye, focal, &sun, view.scene.look);
    let frustum = Frustum::new(view.camera);
    let mut prepared = Prepared {
        raw: raw_view(view, &eye, &sun, &map, &placed),
        look: view.scene.look,
        shadows: map.grade,
        instances: Vec::with_capacity(placed.len()),
        draws: Vec::new(),
        casters: Vec::new(),
        bits: BTreeMap::new(),
    };
    let in_sight: Vec<_> = placed.iter().filter(|placed| frustum.meets(&placed.middle, placed.radius)).collect();
    if wanted.alone {
        let ids: BTreeSet<u16> = in_sight.iter().map(|placed| placed.instance.id).collect();
        prepared.bits = ids.into_iter().filter(|id| *id != 0).zip(0..).collect();
    }
    prepared.draws = prepared.add(in_sight.into_iter(), |placed| placed.fine_enough);
    if wanted.shadows && wanted.light() && prepared.raw.sun_light.iter().any(|light| *light > 0.0) {
        let shade = Shade { eye: &eye, sun: &sun };
        let throws = |placed: &&Placed<'_>| {
            let (middle, radius) = (&placed.middle, placed.radius);
            let is_caught = is_solid(placed, map.low()) && map.catches(middle, radius);
            is_caught && frustum.meets_swept(middle, &shade.of(middle, radius), radius + SHADE_MARGIN)
        };
        prepared.casters = prepared.add(placed.iter().filter(throws), |placed| placed.coarsest);
    }
    Ok(prepared)
}

impl Prepared {
    /// Adds the given instances, sorted by mesh, and apart by whether they have ids. `mesh` returns the key of the mesh that
    /// is drawn for an instance.
    fn add<'a>(
        &mut self,
        placed: impl Iterator<Item = &'a Placed<'a>>,
        mesh: impl Fn(&Placed<'_>) -> u64,
    ) -> Vec<Draw> {
        let mut groups: Vec<((u64, bool), Vec<&Placed<'_>>)> = Vec::new();
        let mut group_of = BTreeMap::new();
        for placed in placed {
            let key = (mesh(placed), placed.instance.id != 0);
            let group = *group_of.entry(key).or_insert(groups.len());
            if group == groups.len() {
                groups.push((key, Vec::new()));
            }
            groups[group].1.push(placed);
        }
        let draw = |((mesh, has_ids), group): ((u64, bool), Vec<&Placed<'_>>)| {
            let first = self.instances.len() as u32;
            for placed in group {
                let bit = self.bits.get(&placed.instance.id).copied().unwrap_or_default();
                self.instances.push(RawInstance::new(&placed.shape, placed.instance.paint, placed.instance.id, bit));
            }
            Draw { mesh, instances: first..self.instances.len() as u32, has_ids }
        };
        groups.into_iter().map(draw).collect()
    }
}

/// Returns `true` if the object can throw a shadow because it is higher than `low` metres. The ground cannot.
fn is_solid(placed: &Placed<'_>, low: f64) -> bool {
    (placed.mesh.high.z - placed.mesh.low.z) * placed.shape.scale.z > low
}

/// Returns the keys of the mesh that is fine enough where parts of `invisible` metres may be missing, and of the coarsest
/// mesh. The look `flat` draws no coarse meshes.
pub(super) fn levels(instance: &Instance, look: Look, invisible: f64) -> (u64, u64) {
    if look == Look::Flat {
        return (instance.mesh.key(), instance.mesh.key());
    }
    let across = f64::from(instance.scale[0].max(instance.scale[1]));
    let is_fine = |mesh: &&Arc<Mesh>| across * f64::from(mesh.detail()) >= invisible;
    let all = || successors(Some(&instance.mesh), |mesh| mesh.coarse());
    let coarsest = all().last().map_or(instance.mesh.key(), |mesh| mesh.key());
    (all().find(is_fine).map_or(coarsest, |mesh| mesh.key()), coarsest)
}

fn shape(instance: &Instance, to_eye: &Isometry3<f64>) -> Shape {
    let pose: Isometry3<f64> = instance.pose.cast();
    // A rotation of length 1 in 32 bits does not have exactly length 1 in 64 bits.
    let turn = UnitQuaternion::new_normalize(pose.rotation.into_inner());
    let pose = Isometry3::from_parts(pose.translation, turn);
    Shape { to_camera: to_eye * pose, scale: Vector3::from(instance.scale).cast() }
}

fn check(view: &View<'_>) -> Result<(), ViewError> {
    let lamps = view.head_lamps.unwrap_or_default();
    let numbers = view.pose.translation.vector.iter().chain(view.pose.rotation.coords.iter()).chain(lamps.iter());
    if !numbers.copied().all(f64::is_finite) {
        return Err(ViewError::Pose { pose: view.pose, head_lamps: view.head_lamps });
    }
    view.scene.air.check()
}

fn check_instance(index: usize, instance: &Instance) -> Result<(), ViewError> {
    let wrong = |flaw| Err(ViewError::Instance { index, id: instance.id, flaw });
    let pose = &instance.pose;
    let numbers = pose.translation.vector.iter().chain(pose.rotation.coords.iter());
    if !numbers.copied().all(f32::is_finite) {
        return wrong(InstanceFlaw::Pose(*pose));
    }
    if !instance.scale.iter().all(|along| along.is_normal() && *along > 0.0) {
        return wrong(InstanceFlaw::Scale(instance.scale));
    }
    if !instance.paint.iter().all(|part| (0.0..=1.0).contains(part)) {
        return wrong(InstanceFlaw::Paint(instance.paint));
    }
    Ok(())
}

fn not_drawable(gpu: &Gpu, index: usize, id: u16, unfit: &Unfit) -> ViewError {
    match unfit {
        Unfit::Corner(flaw) => ViewError::Instance { index, id, flaw: flaw.clone() },
        Unfit::TooLarge(bytes) => {
            ViewError::TooMuch { what: "a mesh", bytes: *bytes, limit: gpu.limits.max_buffer_size }
        }
    }
}

fn check_outside(index: usize, instance: &Instance, mesh: &GpuMesh, shape: &Shape) -> Result<(), ViewError> {
    let eye = shape.eye();
    let around = (0..3).all(|axis| mesh.low[axis] < eye[axis] && eye[axis] < mesh.high[axis]);
    if around && inside(&instance.mesh, &eye) {
        return Err(ViewError::Inside { index, id: instance.id });
    }
    Ok(())
}

/// The region that a camera sees, given by the planes that bound it.
struct Frustum {
    /// The normals of the planes, as unit vectors that point into the region. The planes go through the pinhole.
    sides: [Vector3<f64>; 4],
}

impl Frustum {
    fn new(camera: &Camera) -> Self {
        let focal = camera.focal_pixels();
        let (across, down) = (f64::from(camera.width()) / 2.0 / focal, f64::from(camera.height()) / 2.0 / focal);
        let sides = [(across, -1.0, 0.0), (across, 1.0, 0.0), (down, 0.0, -1.0), (down, 0.0, 1.0)];
        Self { sides: sides.map(|(x, y, z)| Vector3::new(x, y, z).normalize()) }
    }

    fn meets(&self, middle: &Point3<f64>, radius: f64) -> bool {
        self.meets_swept(middle, &Vector3::zeros(), radius)
    }

    /// Returns `false` if a ball that moves along a straight line never touches the region.
    fn meets_swept(&self, middle: &Point3<f64>, along: &Vector3<f64>, radius: f64) -> bool {
        let end = middle.coords + along;
        let farthest = |side: &Vector3<f64>| side.dot(&middle.coords).max(side.dot(&end));
        middle.x.max(end.x) > Camera::NEAR - radius && self.sides.iter().all(|side| farthest(side) > -radius)
    }
}

/// The distance in metres from the shadow of a ball within which points may read it, because shadows have soft edges.
const SHADE_MARGIN: f64 = 0.5;
/// The height of the lowest surface that shadows fall on, in metres.
const LOWEST: f64 = -1.0;

/// The way of shadows, away from the sun to the ground.
struct Shade<'a> {
    eye: &'a Isometry3<f64>,
    /// The direction to the sun, in the world.
    sun: &'a Vector3<f64>,
}

impl Shade<'_> {
    /// Returns the way of the shadow of a ball, in the camera's coordinates.
    fn of(&self, middle: &Point3<f64>, radius: f64) -> Vector3<f64> {
        let height = (self.eye * middle).z + radius - LOWEST;
        let length = (height / self.sun.z.max(1e-6)).clamp(0.0, ShadowMap::DEPTH);
        self.eye.inverse_transform_vector(&(-self.sun * length))
    }
}

/// The brightness of a street lamp and of a pair of head lamps: the light that a surface receives, times square metres.
const STREET_LAMP: f32 = 14.0;
const HEAD_LAMPS: f32 = 90.0;
/// The greatest distance of a street lamp from a point 15 m ahead of the camera, in metres; farther lamps are not
/// computed.
const LAMP_REACH: f64 = 60.0;

fn raw_view(
    view: &View<'_>,
    eye: &Isometry3<f64>,
    sun: &Vector3<f64>,
    map: &ShadowMap,
    placed: &[Placed<'_>],
) -> RawView {
    let (camera, air) = (view.camera, &view.scene.air);
    let (focal, to_eye) = (camera.focal_pixels(), eye.inverse());
    let (width, height) = (f64::from(camera.width()), f64::from(camera.height()));
    let light = air.lit();
    let before = |direction: Vector3<f64>| (to_eye * direction).cast::<f32>();
    let head = view.head_lamps.filter(|_| light.lamps > 0.0);
    let lamp = |place: Point3<f64>, bright: f32| four((to_eye * place).coords.cast::<f32>(), bright);
    RawView {
        image: [(width / 2.0) as f32, (height / 2.0) as f32, (1.0 / focal) as f32, Camera::NEAR as f32],
        project: [(2.0 * focal / width) as f32, (2.0 * focal / height) as f32, 0.0, 0.0],
        sun: four(before(*sun), light.lamps),
        up: four(before(Vector3::z()), air.extinction),
        sun_light: four(light.sun, 0.0),
        sky_light: four(light.sky, 0.0),
        ground_light: four(light.ground, 0.0),
        air: four(air.colour(), 0.0),
        zenith: four(light.zenith, 0.0),
        head_lamps: head.map_or([0.0; 4], |place| lamp(view.pose * place, HEAD_LAMPS * light.lamps)),
        head_beam: four(before(view.pose * Vector3::new(1.0, 0.0, -0.03).normalize()), 0.0),
        street_lamps: street_lamps(placed, light.lamps),
        shadow: map.rows(),
        counts: [0; 4],
    }
}

/// Returns the positions and the brightness of the most important street lamps, in the camera's coordinates.
fn street_lamps(placed: &[Placed<'_>], bright: f32) -> [[f32; 4]; 8] {
    let mut lamps = [[0.0; 4]; 8];
    if bright == 0.0 {
        return lamps;
    }
    let ahead = Point3::new(15.0, 0.0, 0.0);
    let place = |placed: &Placed<'_>| {
        let lamp = placed.mesh.lamp?.coords.component_mul(&placed.shape.scale);
        Some(placed.shape.to_camera * Point3::from(lamp))
    };
    let mut places: Vec<_> = placed.iter().filter_map(place).collect();
    places.sort_by(|a, b| (a - ahead).norm_squared().total_cmp(&(b - ahead).norm_squared()));
    let near = places.iter().take_while(|place| (*place - ahead).norm() < LAMP_REACH);
    for (lamp, place) in lamps.iter_mut().zip(near) {
        *lamp = four(place.coords.cast::<f32>(), STREET_LAMP * bright);
    }
    lamps
}
