//! A moment of a run in front of a camera: the scene to draw, and the image after the lens.

use crate::lens::Rain;
use crate::{Atmosphere, Box3, Camera, Cast, Frame, Optics, Scene, Stage, View, WantedImages, boxes_in_space};
use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_engine::sensor::Moment;

/// The id of the ego vehicle.
const OWN: u16 = 1;
/// The height of the head lamps above the ground, in metres.
const LAMPS: f64 = 0.6;

/// A moment of a run with the camera that is to draw an image of the moment.
#[derive(Clone, Copy)]
pub struct Exposure<'a> {
    /// The roads with the scenery, in the form in which they are drawn.
    pub stage: &'a Stage,
    /// The users' own models of bodies, by the indices of the bodies in the run.
    pub cast: &'a Cast,
    /// The states of all bodies at the moment, and the weather.
    pub moment: &'a Moment,
    /// The camera that takes the image, with its lens.
    pub optics: &'a Optics,
    /// The number of the image among the images of the camera.
    pub number: u64,
}

/// A scene with a camera, ready to be drawn.
#[derive(Debug)]
pub struct Sight {
    scene: Scene,
    camera: Camera,
    pose: Isometry3<f64>,
    head_lamps: Point3<f64>,
    /// The id of the ego vehicle if the camera is inside the ego vehicle. The vehicle is then not drawn, because the
    /// camera would see its inner sides.
    without: Option<u16>,
    /// The outputs that the renderer has to draw.
    pub(crate) wanted: WantedImages,
}

impl Exposure<'_> {
    /// Returns the scene and the camera from which the renderer draws the `wanted` images. Colours include shadows.
    pub fn sight(&self, wanted: WantedImages) -> Sight {
        let plain = self.optics.is_plain() && self.moment.weather.rain <= 0.0;
        let car = &self.moment.bodies[0];
        Sight {
            scene: self.stage.scene_at(self.cast, self.moment),
            camera: self.optics.camera.clone(),
            pose: self.carrier(),
            head_lamps: Point3::new(car.body.outline.half_extent().x, 0.0, LAMPS),
            without: self.is_within_the_car().then_some(OWN),
            wanted: WantedImages {
                rgb: wanted.rgb && plain,
                linear: wanted.rgb && !plain,
                shadows: wanted.rgb,
                ..wanted
            },
        }
    }

    /// Returns the pose of the car that carries the camera.
    fn carrier(&self) -> Isometry3<f64> {
        let pose = &self.moment.bodies[0].pose;
        Isometry3::new(Vector3::new(pose.position.x, pose.position.y, 0.0), Vector3::z() * pose.heading)
    }

    /// Returns the rain in front of the camera.
    fn rain(&self) -> Rain {
        let Moment { bodies, weather, .. } = self.moment;
        let camera = self.optics.camera.pose(&self.carrier());
        Rain::new(weather.rain_rate(), &Atmosphere::of(weather), &camera, &bodies[0].velocity.push(0.0))
    }

    /// Returns `true` if the camera is within the box of the car, or so near that parts of the car are too near to be
    /// drawn.
    fn is_within_the_car(&self) -> bool {
        let body = &self.moment.bodies[0].body;
        let (half, place) = (body.outline.half_extent(), self.optics.camera.mount().translation.vector);
        let along = |place: f64, half: f64| place.abs() <= half + Camera::NEAR;
        along(place.x, half.x) && along(place.y, half.y) && place.z <= body.height + Camera::NEAR
    }

    /// Returns the drawn frame with the effects of rain, lens and sensor on its colours.
    pub fn through_lens(&self, mut frame: Frame) -> Frame {
        if frame.linear.is_some() {
            self.rain().fall(&mut frame, &mut self.optics.chance("rain", self.number));
            frame.rgb = self.optics.develop(&frame, self.number);
            frame.linear = None;
        }
        frame
    }
}

impl Sight {
    /// Returns a view of the scene for [`Renderer::render`](crate::Renderer::render).
    pub fn view(&self) -> View<'_> {
        View {
            without: self.without,
            head_lamps: Some(self.head_lamps),
            ..View::new(&self.scene, &self.camera, self.pose)
        }
    }

    /// Returns the number of pixels of an image of the camera.
    pub fn pixels(&self) -> usize {
        self.camera.width() as usize * self.camera.height() as usize
    }

    /// Returns the three-dimensional boxes of the objects in the scene; empty if [`WantedImages::alone`] is not set.
    pub fn boxes(&self) -> Vec<Box3> {
        if !self.wanted.alone {
            return Vec::new();
        }
        let mut boxes = boxes_in_space(&self.scene, &self.camera, &self.pose);
        boxes.retain(|thing| Some(thing.id) != self.without);
        boxes
    }
}
