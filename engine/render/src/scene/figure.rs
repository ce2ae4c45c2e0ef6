//! Turns a body into the meshes that stand for it, with their places.
//!
//! A mesh has the size of its kind and is stretched to the size of the body. Trees and signs are drawn wider than their
//! outline, because the outline is that of the trunk or the pole.

mod gait;
mod variety;

pub(in crate::scene) use variety::lot;

use super::Instance;
use crate::Look;
use crate::mesh::colours::linear;
use crate::mesh::house::Walls;
use crate::mesh::lamps::Lit;
use crate::mesh::models::Models;
use crate::mesh::{Mesh, bicycle, bus, car, cars, furniture, house, motorcycle, truck, van};
use gait::walker;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use paracosm_engine::object::{Body, BodyState, Class, Outline};
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

/// The radius of a crown as a share of the height of the tree: broad leaves, conifer.
const CROWN: [f32; 2] = [0.25, 0.19];
/// The height at which a crown begins, as a share of the height of the tree: broad leaves, conifer.
const BOUGHS: [f32; 2] = [0.28, 0.10];
/// A sign that is taller than this is drawn as a lamp post, in metres.
const LAMP_POST: f32 = 3.8;
/// A bicycle lower than this has no rider, in metres.
const RIDDEN: f32 = 1.3;
/// A person smaller than this is a child, in metres.
const CHILD: f32 = 1.4;

/// A body that is being drawn.
pub(super) struct Figure<'a> {
    pub state: &'a BodyState,
    /// The pose of the body, with its heading along x and its feet or wheels at z = 0.
    pub pose: Isometry3<f32>,
    /// The length, the width and the height of the body in metres.
    pub size: [f32; 3],
    pub paint: [f32; 3],
    pub id: u16,
    pub look: Look,
    /// The lamps of a vehicle that shine.
    pub lit: Lit,
}

impl<'a> Figure<'a> {
    /// Makes a drawable figure of a body that stands `raised` metres above the road.
    pub fn new(state: &'a BodyState, raised: f32, id: u16, look: Look) -> Self {
        let position = state.pose.position.map(|metres| metres as f32);
        let up = state.altitude as f32 + raised;
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), state.pose.heading as f32);
        let pose = Isometry3::from_parts(Translation3::new(position.x, position.y, up), turn);
        let colour = match look {
            Look::Flat => state.body.colour,
            Look::Textured => variety::colour(&state.body, id),
        };
        Self { state, pose, size: size(&state.body), paint: linear(colour), id, look, lit: Lit::default() }
    }

    /// Returns an instance of a mesh at the pose `at` relative to the body.
    pub fn part(&self, mesh: &Arc<Mesh>, at: Isometry3<f32>, scale: [f32; 3]) -> Instance {
        Instance { mesh: mesh.clone(), pose: self.pose * at, scale, paint: self.paint, id: self.id }
    }

    /// Returns an instance of a mesh of the size `modelled`, stretched to the size of the body.
    pub fn stretched(&self, mesh: &Arc<Mesh>, modelled: [f32; 3]) -> Instance {
        let scale = [0, 1, 2].map(|axis| self.size[axis] / modelled[axis]);
        self.part(mesh, Isometry3::identity(), scale)
    }

    /// Adds instances of all meshes that represent the body to the scene.
    pub fn draw(&self, scene: &mut Vec<Instance>) {
        let models = Models::shared();
        match self.state.body.class {
            Class::Car if self.look == Look::Textured => {
                let kind = cars::kind(self.size, variety::lot(self.id, variety::KIND));
                let car = models.shining(&models.car_of(kind, self.size), self.lit);
                scene.push(self.stretched(&car, self.size));
            }
            Class::Car => scene.push(self.stretched(&models.car, car::SIZE)),
            Class::Van => scene.push(self.stretched(&models.shining(&models.van, self.lit), van::SIZE)),
            Class::Truck => scene.push(self.stretched(&models.shining(&models.truck, self.lit), truck::SIZE)),
            Class::Bus => scene.push(self.stretched(&models.shining(&models.bus, self.lit), bus::SIZE)),
            Class::Motorcycle => {
                scene.push(self.stretched(&models.shining(&models.motorcycle, self.lit), motorcycle::SIZE));
            }
            Class::Bicycle if self.size[2] < RIDDEN => {
                scene.push(self.stretched(&models.parked_bicycle, bicycle::PARKED));
            }
            Class::Bicycle => scene.push(self.stretched(&models.bicycle, bicycle::SIZE)),
            Class::Pedestrian => walker(self, models, scene),
            Class::Building => {
                let plan = house::Plan::of(self.size);
                scene.push(self.stretched(&models.house(plan, self.walls()), plan.size()));
            }
            Class::Tree => self.tree(models, scene),
            Class::Sign => self.sign(models, scene),
            Class::Prop => scene.push(self.prop(models)),
        }
    }

    /// Returns the surfaces of a house. A house as red as bricks has walls of brick, and so have some others.
    fn walls(&self) -> Walls {
        let [red, _, blue] = self.state.body.colour;
        match self.look {
            Look::Flat => Walls::Flat,
            Look::Textured if red > blue.saturating_add(60) || self.chance().is_multiple_of(5) => Walls::Brick,
            Look::Textured => Walls::Plaster,
        }
    }

    fn tree(&self, models: &Models, scene: &mut Vec<Instance>) {
        let [length, width, height] = self.size;
        let chance = self.chance();
        let conifer = chance.is_multiple_of(2);
        let (wide, low) = (2.0 * CROWN[usize::from(conifer)] * height, BOUGHS[usize::from(conifer)] * height);
        scene.push(self.part(
            &models.trunk(self.look),
            Isometry3::identity(),
            [0.5 * length, 0.5 * width, 0.6 * height],
        ));
        let turned = Isometry3::new(Vector3::z() * low, Vector3::z() * (chance % 360) as f32);
        let crown = models.crown(conifer, self.state.body.colour, self.look);
        scene.push(self.part(&crown, turned, [wide, wide, height - low]));
    }

    fn sign(&self, models: &Models, scene: &mut Vec<Instance>) {
        let [length, width, height] = self.size;
        scene.push(self.part(&models.pole, Isometry3::identity(), [0.5 * length, 0.5 * width, height]));
        if height > LAMP_POST {
            scene.push(self.part(
                &models.lantern,
                Isometry3::translation(0.0, 0.0, height - furniture::LANTERN),
                [1.0; 3],
            ));
        } else {
            let chance = self.chance() as usize;
            let plate = match self.look {
                Look::Flat => models.plates[chance % models.plates.len()].clone(),
                Look::Textured => models.sign(chance),
            };
            let scale = (0.4 * height / furniture::PLATE).min(1.0);
            let up = height - furniture::PLATE * scale;
            scene.push(self.part(&plate, Isometry3::translation(0.5 * length + 0.015, 0.0, up), [scale; 3]));
        }
    }

    fn prop(&self, models: &Models) -> Instance {
        let [length, width, height] = self.size;
        let mesh = match self.state.body.outline {
            Outline::Disc { .. } if height <= length => &models.ball,
            Outline::Disc { .. } if height <= 1.2 => &models.cone,
            Outline::Disc { .. } => &models.barrel,
            Outline::Rectangle { .. } if height < 1.5 && width >= 2.5 * length => &models.barrier,
            Outline::Rectangle { .. } if height < 1.5 && length >= 2.5 * width => {
                let turn = Isometry3::rotation(Vector3::z() * FRAC_PI_2);
                return self.part(&models.barrier, turn, [width, length, height]);
            }
            Outline::Rectangle { .. } => &models.parcel,
        };
        self.stretched(mesh, [1.0; 3])
    }

    /// Returns a pseudorandom number that depends only on the place of the body. It is the hash FNV-1a (Fowler, Noll,
    /// Vo) over centimetres.
    fn chance(&self) -> u32 {
        let place = self.state.pose.position.map(|metres| (metres * 100.0).round() as i64);
        let bytes = place.iter().flat_map(|centimetres| centimetres.to_le_bytes());
        let hash = bytes
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
        (hash ^ (hash >> 32)) as u32 >> 7
    }
}

/// Returns the length, width and height of a body in metres.
fn size(body: &Body) -> [f32; 3] {
    let half = body.outline.half_extent();
    [2.0 * half.x, 2.0 * half.y, body.height].map(|metres| metres as f32)
}
