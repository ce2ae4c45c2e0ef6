//! Draws shots, as many at once as fit, and lets each go through its camera's lens.

use super::{Film, Shot, cameras};
use crate::Error;
use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_engine::sensor::{Cameras, Chance};
use paracosm_render::{
    Adapter, Air, Box3, Camera, Frame, Outputs, RenderError, Renderer, Scene, View, ViewError, boxes_in_space,
};
use rayon::prelude::*;

/// How many pixels are drawn at once, so that large images do not fill the memory, and how many images at most.
const PIXELS: u64 = 1 << 22;
const IMAGES: u64 = 64;

/// The id of the car under test, which would see its own inside.
const OWN: u16 = 1;
/// How high head lamps are, in metres.
const LAMPS: f64 = 0.6;

/// Draws the films of one set of cameras.
#[derive(Debug)]
pub struct Projector {
    renderer: Renderer,
    cameras: Vec<(String, Camera, paracosm_render::lens::Effects)>,
    seed: u64,
    wanted: Outputs,
}

/// A shot that was drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// All that was asked for; its colours are those that the camera gives.
    pub frame: Frame,
    /// The things in front of the camera.
    pub boxes: Vec<Box3>,
}

impl Projector {
    /// A projector of these cameras' films on the best adapter of this machine. Colours come with shadows.
    ///
    /// # Errors
    /// There is no adapter, or no such camera.
    pub fn new(cameras: &Cameras, wanted: Outputs) -> Result<Self, Error> {
        let unusable = |error: RenderError| Error::Usage(error.to_string());
        let described = cameras.all.iter().map(|(name, mounted)| {
            let camera = cameras::camera(mounted).map_err(|error| Error::Usage(format!("camera `{name}`: {error}")))?;
            Ok((name.clone(), camera, cameras::effects(mounted)))
        });
        let cameras_ready = described.collect::<Result<_, Error>>()?;
        let renderer = Renderer::new().map_err(unusable)?;
        Ok(Self { renderer, cameras: cameras_ready, seed: cameras.seed, wanted })
    }

    /// What it draws with.
    pub fn adapter(&self) -> &Adapter {
        self.renderer.adapter()
    }

    /// Draws all shots of a camera, which is given by its place among the names, and shows them in order. A shot from
    /// within something that the car ran into shows nothing, and is none.
    ///
    /// # Errors
    /// A view cannot be drawn, the adapter is lost, or `show` fails.
    pub fn show(
        &mut self,
        film: &Film,
        camera: usize,
        mut show: impl FnMut(Vec<(&Shot, Picture)>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let pixels = self.cameras[camera].1.width() as u64 * u64::from(self.cameras[camera].1.height());
        let at_once = (PIXELS / pixels).clamp(1, IMAGES) as usize;
        for shots in film.shots[camera].chunks(at_once) {
            show(self.draw(film, camera, shots)?)?;
        }
        Ok(())
    }

    fn draw<'f>(&mut self, film: &Film, camera: usize, shots: &'f [Shot]) -> Result<Vec<(&'f Shot, Picture)>, Error> {
        let (name, camera, effects) = &self.cameras[camera];
        let plain = effects.are_none();
        let wanted = Outputs {
            rgb: self.wanted.rgb && plain,
            linear: self.wanted.rgb && !plain,
            shadows: self.wanted.rgb,
            ..self.wanted
        };
        let scenes: Vec<Scene> = shots.iter().map(|shot| scene(film, shot)).collect();
        let views: Vec<View<'_>> = shots.iter().zip(&scenes).map(|(shot, scene)| view(shot, scene, camera)).collect();
        let frames = self.renderer.render(&views, wanted).map_err(|error| Error::Usage(error.to_string()))?;
        let mut drawn = Vec::with_capacity(shots.len());
        for ((shot, view), frame) in shots.iter().zip(&views).zip(frames) {
            match frame {
                Ok(frame) => drawn.push((shot, view, frame)),
                Err(ViewError::Inside { .. }) => (),
                Err(error) => {
                    return Err(Error::Usage(format!("camera `{name}`, image {}: {error}", shot.number)));
                }
            }
        }
        let (seed, colours) = (self.seed, self.wanted.rgb);
        let developed = |(shot, view, mut frame): (&'f Shot, &View<'_>, Frame)| {
            if colours && !plain {
                let mut chance = Chance::of(seed, &format!("{name}, noise"), shot.number);
                frame.rgb = effects.develop(&frame, &mut chance);
                frame.linear = None;
            }
            let mut boxes = boxes_in_space(view.scene, camera, &view.pose);
            boxes.retain(|thing| thing.id != OWN);
            (shot, Picture { frame, boxes })
        };
        Ok(drawn.into_par_iter().map(developed).collect())
    }
}

fn scene(film: &Film, shot: &Shot) -> Scene {
    film.stage.scene_of(shot.moment.bodies.iter().enumerate(), Air::of(&shot.moment.weather))
}

fn view<'a>(shot: &Shot, scene: &'a Scene, camera: &'a Camera) -> View<'a> {
    let car = &shot.moment.bodies[0];
    let place = Vector3::new(car.pose.position.x, car.pose.position.y, 0.0);
    let pose = Isometry3::new(place, Vector3::z() * car.pose.heading);
    let lamps = Point3::new(car.body.outline.half_extent().x, 0.0, LAMPS);
    View { without: Some(OWN), head_lamps: Some(lamps), ..View::new(scene, camera, pose) }
}
