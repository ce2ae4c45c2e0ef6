//! A moment before a camera: the scene to draw for it, and the image after its lens.

use crate::lens::Rain;
use crate::{Atmosphere, Box3, Camera, Cast, Frame, Optics, Scene, Stage, View, WantedImages, boxes_in_space};
use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_engine::sensor::Moment;

/// The id of the car under test.
const OWN: u16 = 1;
/// How high head lamps are, in metres.
const LAMPS: f64 = 0.6;

/// A moment that a camera is to draw.
#[derive(Clone, Copy)]
pub struct Exposure<'a> {
    /// The roads and what stands beside them.
    pub stage: &'a Stage,
    /// The shapes of the bodies.
    pub cast: &'a Cast,
    /// Where all bodies are, and the weather.
    pub moment: &'a Moment,
    /// The camera.
    pub optics: &'a Optics,
    /// Which of the camera's images it is.
    pub number: u64,
}

/// A scene before a camera, ready to be drawn.
#[derive(Debug)]
pub struct Sight {
    scene: Scene,
    camera: Camera,
    pose: Isometry3<f64>,
    head_lamps: Point3<f64>,
    /// What is left out: the car itself, of which a camera within it would see the inside.
    without: Option<u16>,
    /// The outputs that the renderer has to draw.
    pub(crate) wanted: WantedImages,
}

impl Exposure<'_> {
    /// The scene to draw for these outputs. Colours come with shadows.
    pub fn sight(&self, wanted: WantedImages) -> Sight {
        let plain = self.optics.is_plain() && self.moment.weather.rain <= 0.0;
        let Moment { bodies, weather, .. } = self.moment;
        let car = &bodies[0];
        Sight {
            scene: self.stage.scene_with(self.cast, bodies.iter().enumerate(), Atmosphere::of(weather)),
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

    /// Where the car is that carries the camera.
    fn carrier(&self) -> Isometry3<f64> {
        let pose = &self.moment.bodies[0].pose;
        Isometry3::new(Vector3::new(pose.position.x, pose.position.y, 0.0), Vector3::z() * pose.heading)
    }

    /// The rain before the camera.
    fn rain(&self) -> Rain {
        let Moment { bodies, weather, .. } = self.moment;
        let camera = self.optics.camera.pose(&self.carrier());
        Rain::new(weather.rain_rate(), &Atmosphere::of(weather), &camera, &bodies[0].velocity.push(0.0))
    }

    /// Whether the camera is within the box of the car, or so near that parts of the car would be too near to be drawn.
    fn is_within_the_car(&self) -> bool {
        let body = &self.moment.bodies[0].body;
        let (half, place) = (body.outline.half_extent(), self.optics.camera.mount().translation.vector);
        let along = |place: f64, half: f64| place.abs() <= half + Camera::NEAR;
        along(place.x, half.x) && along(place.y, half.y) && place.z <= body.height + Camera::NEAR
    }

    /// A drawn frame, with the colours that the camera gives.
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
    /// The scene as the renderer takes it.
    pub fn view(&self) -> View<'_> {
        View {
            without: self.without,
            head_lamps: Some(self.head_lamps),
            ..View::new(&self.scene, &self.camera, self.pose)
        }
    }

    /// The number of pixels of an image.
    pub fn pixels(&self) -> usize {
        self.camera.width() as usize * self.camera.height() as usize
    }

    /// The things in front of the camera, where boxes are wanted.
    pub fn boxes(&self) -> Vec<Box3> {
        if !self.wanted.alone {
            return Vec::new();
        }
        let mut boxes = boxes_in_space(&self.scene, &self.camera, &self.pose);
        boxes.retain(|thing| Some(thing.id) != self.without);
        boxes
    }
}
