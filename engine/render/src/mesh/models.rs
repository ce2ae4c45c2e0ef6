//! The built-in shapes, made once for a process, so that a renderer uploads each only once.

use super::colours::linear;
use super::furniture::{self, Plate};
use super::garb::{GARBS, Garb, USUAL};
use super::house::{Plan, Walls};
use super::lamps::{Lit, shining};
use super::signs::SIGNS;
use super::traffic_light::{Aspect, traffic_light};
use super::{Mesh, SurfaceKind, barriers, bicycle, bus, car, cars, motorcycle, person, plant, truck, van};
use crate::Look;
use paracosm_engine::object::Colour;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// The built-in shapes.
pub(crate) struct Models {
    pub car: Arc<Mesh>,
    pub van: Arc<Mesh>,
    pub truck: Arc<Mesh>,
    pub bus: Arc<Mesh>,
    pub motorcycle: Arc<Mesh>,
    pub bicycle: Arc<Mesh>,
    pub parked_bicycle: Arc<Mesh>,
    /// The people of the look `flat`: an adult and a child.
    pub usual: [Person; 2],
    pub pole: Arc<Mesh>,
    pub lantern: Arc<Mesh>,
    /// The meshes of the plates of traffic signs, in the order of [`PLATES`].
    pub plates: [Arc<Mesh>; 4],
    pub cone: Arc<Mesh>,
    pub barrel: Arc<Mesh>,
    pub ball: Arc<Mesh>,
    pub parcel: Arc<Mesh>,
    pub barrier: Arc<Mesh>,
    pub bollard: Arc<Mesh>,
    pub delineator: Arc<Mesh>,
    pub rail: Arc<Mesh>,
    /// The traffic lights, in the order of [`Aspect::ALL`].
    pub lights: [Arc<Mesh>; 3],
    /// People by the place of their garb in [`GARBS`]; `true` for children.
    people: Shelf<(usize, bool), Person>,
    /// The meshes of cars of many kinds, by kind and size in millimetres.
    cars: Shelf<(usize, [u32; 3])>,
    /// The meshes of vehicles with lamps that shine, by the key of the mesh without.
    shining: Shelf<(u64, Lit)>,
    /// The traffic signs of the look `textured`, by their place in [`SIGNS`].
    signs: Shelf<usize>,
    /// The trunks of trees, by their surface.
    trunks: Shelf<SurfaceKind>,
    houses: Shelf<(Plan, Walls)>,
    /// The meshes of the crowns of trees, by colour; `true` for conifers.
    crowns: Shelf<(bool, Colour, Look)>,
}

/// Shapes that are made when they are first asked for.
type Shelf<K, V = Arc<Mesh>> = Mutex<BTreeMap<K, V>>;

/// The meshes of the parts of a person.
#[derive(Debug, Clone)]
pub(crate) struct Person {
    pub trunk: Arc<Mesh>,
    /// The left arm and the right arm.
    pub arms: [Arc<Mesh>; 2],
    pub thigh: Arc<Mesh>,
    pub shin: Arc<Mesh>,
}

/// The size of a child's head, relative to that of an adult of the same height.
const CHILD: f32 = 1.3;

impl Person {
    fn new(child: bool, garb: &Garb) -> Self {
        Self {
            trunk: person::trunk(if child { CHILD } else { 1.0 }, garb).into(),
            arms: [1.0, -1.0].map(|side| person::arm(side, garb).into()),
            thigh: person::thigh(garb).into(),
            shin: person::shin(garb).into(),
        }
    }
}

const PLATES: [Plate; 4] = [Plate::Limit, Plate::GiveWay, Plate::Stop, Plate::Hint];

impl Models {
    /// Returns the meshes that all renderers of this process share.
    pub fn shared() -> &'static Self {
        static SHARED: LazyLock<Models> = LazyLock::new(Models::new);
        &SHARED
    }

    fn new() -> Self {
        Self {
            car: car::car().into(),
            van: van::van().into(),
            truck: truck::truck().into(),
            bus: bus::bus().into(),
            motorcycle: motorcycle::motorcycle().into(),
            bicycle: bicycle::bicycle().into(),
            parked_bicycle: bicycle::parked().into(),
            usual: [false, true].map(|child| Person::new(child, &USUAL)),
            pole: furniture::pole().into(),
            lantern: furniture::lantern().into(),
            plates: PLATES.map(|plate| furniture::plate(plate).into()),
            cone: furniture::cone().into(),
            barrel: furniture::barrel().into(),
            ball: furniture::ball().into(),
            parcel: furniture::parcel().into(),
            barrier: furniture::barrier().into(),
            bollard: barriers::bollard().into(),
            delineator: barriers::delineator().into(),
            rail: barriers::rail().into(),
            lights: Aspect::ALL.map(|lit| traffic_light(lit).into()),
            people: Shelf::default(),
            cars: Shelf::default(),
            shining: Shelf::default(),
            signs: Shelf::default(),
            trunks: Shelf::default(),
            houses: Shelf::default(),
            crowns: Shelf::default(),
        }
    }

    /// Returns the meshes of a person in one of [`GARBS`], by a number that chance has chosen.
    pub fn person(&self, chance: u32, child: bool) -> Person {
        let garb = chance as usize % GARBS.len();
        take(&self.people, (garb, child), || Person::new(child, &GARBS[garb]))
    }

    /// Returns the mesh of a car of a kind, with a length, a width and a height in metres.
    pub fn car_of(&self, kind: usize, size: [f32; 3]) -> Arc<Mesh> {
        let millimetres = size.map(|metres| (1000.0 * metres).round() as u32);
        take(&self.cars, (kind, millimetres), || cars::car(kind, size).into())
    }

    /// Returns one of the vehicles of these models with lamps that shine.
    pub fn shining(&self, vehicle: &Arc<Mesh>, lit: Lit) -> Arc<Mesh> {
        if lit.is_any() {
            take(&self.shining, (vehicle.key(), lit), || shining(vehicle, lit).into())
        } else {
            vehicle.clone()
        }
    }

    /// Returns the mesh of the trunk of a tree in a look.
    pub fn trunk(&self, look: Look) -> Arc<Mesh> {
        let surface = match look {
            Look::Flat => SurfaceKind::Plain,
            Look::Textured => SurfaceKind::Bark,
        };
        take(&self.trunks, surface, || plant::trunk(surface).into())
    }

    /// Returns the mesh of one of [`SIGNS`], by a number that chance has chosen.
    pub fn sign(&self, chance: usize) -> Arc<Mesh> {
        let sign = chance % SIGNS.len();
        take(&self.signs, sign, || SIGNS[sign]().into())
    }

    pub fn house(&self, plan: Plan, walls: Walls) -> Arc<Mesh> {
        take(&self.houses, (plan, walls), || plan.mesh(walls).into())
    }

    /// Returns the mesh of the crown of a tree in a look. In the look `textured`, it has fewer triangles from afar.
    pub fn crown(&self, conifer: bool, colour: Colour, look: Look) -> Arc<Mesh> {
        let near = || plant::crown(conifer, linear(colour));
        take(&self.crowns, (conifer, colour, look), || match look {
            Look::Flat => near().into(),
            Look::Textured => near().with_coarse(plant::far_crown(conifer, linear(colour)), plant::BOUGH).into(),
        })
    }
}

fn take<K: Ord, V: Clone>(shelf: &Shelf<K, V>, key: K, make: impl FnOnce() -> V) -> V {
    let mut shelf = shelf.lock().unwrap_or_else(PoisonError::into_inner);
    shelf.entry(key).or_insert_with(make).clone()
}
