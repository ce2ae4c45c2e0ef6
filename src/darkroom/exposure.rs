//! A moment before a camera: what there is to draw, and what its lens makes of it.

use super::Optics;
use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_engine::sensor::Moment;
use paracosm_render::lens::Rain;
use paracosm_render::{Air, Box3, Camera, Cast, Frame, Outputs, Scene, Stage, View, boxes_in_space};

/// The id of the car under test.
const OWN: u16 = 1;
/// How high head lamps are, in metres.
const LAMPS: f64 = 0.6;

/// A moment that a camera is to draw.
#[derive(Clone, Copy)]
pub(crate) struct Exposure<'a> {
    pub stage: &'a Stage,
    pub cast: &'a Cast,
    pub moment: &'a Moment,
    pub optics: &'a Optics,
    /// Which of the camera's images it is.
    pub number: u64,
}

/// What there is to draw.
#[derive(Debug)]
pub(crate) struct Sight {
    scene: Scene,
    camera: Camera,
    pose: Isometry3<f64>,
    head_lamps: Point3<f64>,
    /// What is left out: the car itself, of which a camera within it would see the inside.
    without: Option<u16>,
    pub wanted: Outputs,
}

impl Exposure<'_> {
    /// What there is to draw to have these outputs. Colours come with shadows.
    pub fn sight(&self, wanted: Outputs) -> Sight {
        let plain = self.optics.are_plain() && self.moment.weather.rain <= 0.0;
        let Moment { bodies, weather, .. } = self.moment;
        let car = &bodies[0];
        Sight {
            scene: self.stage.scene_with(self.cast, bodies.iter().enumerate(), Air::of(weather)),
            camera: self.optics.camera.clone(),
            pose: self.carrier(),
            head_lamps: Point3::new(car.body.outline.half_extent().x, 0.0, LAMPS),
            without: self.is_within_the_car().then_some(OWN),
            wanted: Outputs { rgb: wanted.rgb && plain, linear: wanted.rgb && !plain, shadows: wanted.rgb, ..wanted },
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
        Rain::new(weather.rain_rate(), &Air::of(weather), &camera, &bodies[0].velocity.push(0.0))
    }

    /// Whether the camera is within the box of the car, or so near that parts of the car would be too near to be drawn.
    fn is_within_the_car(&self) -> bool {
        let body = &self.moment.bodies[0].body;
        let (half, place) = (body.outline.half_extent(), self.optics.camera.mount().translation.vector);
        let along = |place: f64, half: f64| place.abs() <= half + Camera::NEAR;
        along(place.x, half.x) && along(place.y, half.y) && place.z <= body.height + Camera::NEAR
    }

    /// What was drawn, with the colours that the camera gives.
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
    pub fn view(&self) -> View<'_> {
        View {
            without: self.without,
            head_lamps: Some(self.head_lamps),
            ..View::new(&self.scene, &self.camera, self.pose)
        }
    }

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
