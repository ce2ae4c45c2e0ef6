//! Reads the models of users when they are needed.

use super::{Appearance, Appearances, first_of};
use crate::Reason;
use paracosm_engine::Run;
use paracosm_engine::object::Class;
use paracosm_render::gltf::{self, GltfError};
use paracosm_render::{Cast, Look, Mesh, Model, Semantic};
use std::sync::{Arc, OnceLock};
use thiserror::Error;

/// The model of each look that has been read, or that was not needed so far.
pub(super) type Loaded = [OnceLock<Arc<Model>>; Look::ALL.len()];

/// The reason why a file cannot be used as the 3D model of an actor.
#[derive(Debug, Error)]
pub enum ModelFlaw {
    /// The file cannot be read, or is not a usable 3D model.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// The 3D model has changed since the campaign was run.
    #[error("the model {file} has the hash {found}, expected {expected}: the campaign was run with another model")]
    Changed {
        /// The path of the file with the 3D model.
        file: String,
        /// The present hash of the 3D model.
        found: String,
        /// The hash of the 3D model when the campaign was run.
        expected: String,
    },
}

impl Reason for ModelFlaw {}

impl Appearances {
    /// Returns the 3D model of each body of a run that a model replaces in images of the given look.
    ///
    /// # Errors
    /// A file can no longer be read, or has changed since the study was made.
    pub fn cast(&self, run: &Run, look: Look) -> Result<Cast, ModelFlaw> {
        let mut cast = Cast::new();
        if self.is_empty() {
            return Ok(cast);
        }
        for (body, state) in run.bodies().iter().enumerate() {
            let name = run.name_of(body);
            if let Some(appearance) = self.0.get(name).or_else(|| self.0.get(first_of(name))) {
                cast.insert(body, appearance.model(state.body.class, look)?);
            }
        }
        Ok(cast)
    }
}

impl Appearance {
    /// Reads the 3D model in a file, for an actor of the given class.
    pub fn read(file: &str, class: Class) -> Result<Self, ModelFlaw> {
        let (hash, model) = load(file, class)?;
        let loaded = Look::ALL.map(|look| if look == Look::Flat { Arc::clone(&model).into() } else { OnceLock::new() });
        Ok(Self { file: file.to_owned(), hash, loaded })
    }

    /// Returns the model of a look. The hash of the study is the hash of the flat model, without the pictures on it.
    fn model(&self, class: Class, look: Look) -> Result<Arc<Model>, ModelFlaw> {
        let [flat, textured] = &self.loaded;
        if look == Look::Textured {
            self.model(class, Look::Flat)?;
            if let Some(model) = textured.get() {
                return Ok(model.clone());
            }
            let mesh = gltf::load_in_look(&self.file, semantic(class), look)?;
            return Ok(textured.get_or_init(|| Arc::new(Model::new(mesh))).clone());
        }
        if let Some(model) = flat.get() {
            return Ok(model.clone());
        }
        let (found, model) = load(&self.file, class)?;
        if found != self.hash {
            return Err(ModelFlaw::Changed { file: self.file.clone(), found, expected: self.hash.clone() });
        }
        Ok(flat.get_or_init(|| model).clone())
    }
}

fn load(file: &str, class: Class) -> Result<(String, Arc<Model>), ModelFlaw> {
    let mesh = gltf::load(file, semantic(class))?;
    Ok((hash(&mesh), Arc::new(Model::new(mesh))))
}

fn semantic(class: Class) -> Semantic {
    match class {
        // CARLA has no class for vans. Cityscapes counts them among the cars.
        Class::Car | Class::Van => Semantic::Car,
        Class::Truck => Semantic::Truck,
        Class::Bus => Semantic::Bus,
        Class::Motorcycle => Semantic::Motorcycle,
        Class::Bicycle => Semantic::Bicycle,
        Class::Pedestrian => Semantic::Pedestrian,
        Class::Building => Semantic::Building,
        Class::Tree => Semantic::Vegetation,
        Class::Sign => Semantic::TrafficSign,
        Class::Prop => Semantic::Dynamic,
    }
}

/// Returns the hash of everything in a mesh that is drawn, whatever file it was read from.
fn hash(mesh: &Mesh) -> String {
    let mut bytes = Vec::new();
    for vertex in mesh.vertices() {
        let numbers = vertex.position.iter().chain(&vertex.normal).chain(&vertex.uv).chain(&vertex.colour);
        bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
        bytes.extend([vertex.surface as u8, vertex.semantic as u8]);
    }
    bytes.extend(mesh.indices().iter().flat_map(|index| index.to_le_bytes()));
    format!("{:032x}", xxhash_rust::xxh3::xxh3_128(&bytes))
}
