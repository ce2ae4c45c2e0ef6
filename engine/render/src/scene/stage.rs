//! Makes a scene of a run: the ground, which is built once for a network, and the figures of the bodies on it.

use super::figure::Figure;
use super::ground::ground;
use super::pavement::Pavement;
use super::scenery::Scenery;
use super::signals::Signals;
use super::{Atmosphere, Instance, Scene};
use crate::mesh::lamps::Lit;
use crate::{Look, Mesh};
use nalgebra::{Isometry3, Vector3};
use paracosm_engine::Run;
use paracosm_engine::object::{BodyState, Class};
use paracosm_engine::road::RoadNetwork;
use paracosm_engine::sensor::Moment;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// The drawable scenery of a road network, built once and shared by the scenes of all runs on the network.
///
/// ```
/// use paracosm_engine::road::CrossIntersection;
/// use paracosm_render::{Atmosphere, Stage};
///
/// let stage = Stage::of(&*CrossIntersection::new().build()?);
/// let empty = stage.scene_of([], Atmosphere::default());
/// assert!(empty.instances.iter().all(|instance| instance.id == 0));
/// # Ok::<(), paracosm_engine::road::RoadError>(())
/// ```
#[derive(Debug)]
pub struct Stage {
    look: Look,
    still: Vec<Instance>,
    pavement: Arc<Pavement>,
    signals: Arc<Signals>,
    models: BTreeMap<Class, Arc<Model>>,
    scenery: Scenery,
}

/// A user's own mesh, which is stretched to the bounding box of the body that it represents. The front of the mesh is
/// along x.
#[derive(Debug)]
pub struct Model {
    mesh: Arc<Mesh>,
    /// The middle of the bottom of the mesh's bounding box.
    foot: Vector3<f32>,
    size: [f32; 3],
}

/// The users' own models of the bodies of a run, by the indices of the bodies.
pub type Cast = BTreeMap<usize, Arc<Model>>;

impl Stage {
    /// Makes the drawable scenery of a road network in the look [`Look::Flat`].
    pub fn of(network: &RoadNetwork) -> Self {
        Self::in_look(network, Look::Flat)
    }

    /// Makes the drawable scenery of a road network. All scenes of the stage have the given look.
    pub fn in_look(network: &RoadNetwork, look: Look) -> Self {
        Self {
            look,
            still: ground(network, look),
            pavement: Arc::new(Pavement::of(network)),
            signals: Arc::new(Signals::of(network)),
            models: BTreeMap::new(),
            scenery: Scenery::default(),
        }
    }

    /// Returns the same stage with the scenery that the look [`Textured`](Look::Textured) adds to the world of a run that
    /// has just begun: houses, trees, parked cars, posts and guard rails, traffic lights. It follows from the roads and from
    /// the values of the test, and exists only in pictures. The look [`Flat`](Look::Flat) adds nothing.
    pub fn dressed(&self, run: &Run) -> Self {
        let scenery = match self.look {
            Look::Flat => Scenery::default(),
            Look::Textured => Scenery::of(run),
        };
        let Self { look, still, pavement, signals, models, .. } = self;
        let (still, pavement, signals, models) = (still.clone(), pavement.clone(), signals.clone(), models.clone());
        Self { look: *look, still, pavement, signals, models, scenery }
    }

    /// Returns the look of all scenes of the stage.
    pub fn look(&self) -> Look {
        self.look
    }

    /// Sets a user's own mesh as the model of all bodies of a class. The front of the mesh is along x.
    pub fn model(mut self, class: Class, mesh: impl Into<Arc<Mesh>>) -> Self {
        self.models.insert(class, Arc::new(Model::new(mesh)));
        self
    }

    /// Returns the scene of a run at its current tick, with all bodies that are in the world. The ego vehicle has the
    /// id 1, so that a camera mounted on it can leave it out.
    pub fn scene(&self, run: &Run) -> Scene {
        if self.look == Look::Flat {
            // No lamp shines, so the accelerations are not needed.
            return self.scene_of(run.bodies().iter().enumerate(), Atmosphere::of(&run.weather()));
        }
        let mut moment = Moment::default();
        moment.record(&run.view());
        self.scene_at(&Cast::new(), &moment)
    }

    /// Returns the scene of a moment, with the bodies in `cast` drawn as users' own models. In the look
    /// [`Textured`](Look::Textured), vehicles show brake lamps and direction indicators.
    pub fn scene_at(&self, cast: &Cast, moment: &Moment) -> Scene {
        let lit = |index: usize, state: &BodyState| match self.look {
            Look::Flat => Lit::default(),
            Look::Textured => self.signals.lit(index, state, moment),
        };
        let mut scene = self.build(cast, moment.bodies.iter().enumerate(), Atmosphere::of(&moment.weather), lit);
        self.scenery.draw(&moment.bodies, moment.time, &mut scene.instances);
        scene
    }

    /// Returns the scene of the given bodies in the given light and fog. Each body comes with its index in the run;
    /// bodies that left the world are skipped.
    pub fn scene_of<'a>(&self, bodies: impl IntoIterator<Item = (usize, &'a BodyState)>, air: Atmosphere) -> Scene {
        self.scene_with(&Cast::new(), bodies, air)
    }

    /// Returns the scene of the given bodies, with the bodies in `cast` drawn as users' own models.
    pub fn scene_with<'a>(
        &self,
        cast: &Cast,
        bodies: impl IntoIterator<Item = (usize, &'a BodyState)>,
        air: Atmosphere,
    ) -> Scene {
        self.build(cast, bodies, air, |_, _| Lit::default())
    }

    fn build<'a>(
        &self,
        cast: &Cast,
        bodies: impl IntoIterator<Item = (usize, &'a BodyState)>,
        air: Atmosphere,
        lit: impl Fn(usize, &BodyState) -> Lit,
    ) -> Scene {
        let mut instances = self.still.clone();
        for (index, state) in bodies.into_iter().filter(|(_, state)| state.present) {
            let on_foot = matches!(state.body.class, Class::Pedestrian | Class::Bicycle);
            let raised = if on_foot { self.pavement.height(state.pose.position) } else { 0.0 };
            let id = u16::try_from(index + 1).unwrap_or(u16::MAX);
            let figure = Figure { lit: lit(index, state), ..Figure::new(state, raised as f32, id, self.look) };
            let of_class = || self.models.get(&state.body.class).map(Arc::as_ref);
            match cast.get(&index).map(Arc::as_ref).or_else(of_class) {
                Some(model) => instances.push(model.instance(&figure)),
                None => figure.draw(&mut instances),
            }
        }
        Scene { instances, air, look: self.look }
    }
}

impl Model {
    /// Makes a model from a mesh, whose bounding box is computed.
    pub fn new(mesh: impl Into<Arc<Mesh>>) -> Self {
        let mesh = mesh.into();
        let [min, max] = mesh.bounds().map(Vector3::from);
        let foot = Vector3::new(0.5 * (min.x + max.x), 0.5 * (min.y + max.y), min.z);
        let size = (max - min).map(|metres| if metres > 0.0 { metres } else { 1.0 }).into();
        Self { mesh, foot, size }
    }

    fn instance(&self, figure: &Figure<'_>) -> Instance {
        let mut instance = figure.stretched(&self.mesh, self.size);
        let moved = self.foot.component_mul(&Vector3::from(instance.scale));
        instance.pose *= Isometry3::translation(-moved.x, -moved.y, -moved.z);
        instance
    }
}

/// A cache of the drawable sceneries of road networks, kept as long as the networks live.
#[derive(Debug, Default)]
pub struct Stages {
    known: Mutex<Vec<(Weak<RoadNetwork>, Arc<Stage>)>>,
}

impl Stages {
    /// Returns the stage of a run that has just begun, with the scenery of the look ([`Stage::dressed`]).
    pub fn of_run(&self, run: &Run, look: Look) -> Arc<Stage> {
        let stage = self.of(run.network(), look);
        match look {
            Look::Flat => stage,
            Look::Textured => Arc::new(stage.dressed(run)),
        }
    }

    /// Returns the drawable scenery of a road network in a look, from the cache if possible. Tests on the same network share
    /// one stage of each look.
    pub fn of(&self, network: &Arc<RoadNetwork>, look: Look) -> Arc<Stage> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.retain(|(of, _)| of.strong_count() > 0);
        let same =
            |(of, stage): &&(Weak<RoadNetwork>, Arc<Stage>)| of.as_ptr() == Arc::as_ptr(network) && stage.look == look;
        if let Some((_, stage)) = known.iter().find(same) {
            return stage.clone();
        }
        let stage = Arc::new(Stage::in_look(network, look));
        known.push((Arc::downgrade(network), stage.clone()));
        stage
    }
}
