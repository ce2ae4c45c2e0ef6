//! The driver `lane-camera`: it keeps its speed, and its lane by the images of a front camera. It demonstrates a driver
//! that sees, not how to see well. It uses a threshold of brightness, so fog, dusk and a blurred lens are hard for it.
//! It brakes only if it sees no road.
//!
//! Row by row of the image, from the nearest, it searches from where the lane should be to the right until the road
//! ends, at the kerb or at paint. Each row is a distance ahead on flat ground. The lane's middle is a set distance to
//! the left of the edge. The driver steers to it by pure pursuit.
//!
//! It goes round bends but does not slow down for them, as it is told nothing of its way. By day it keeps its lane in
//! bends with a radius of 15 m or more, if its speed asks for no more than 5 m/s² sideways on a dry road. In sharper
//! bends to the right the edge of the road leaves the image. At junctions it neither turns nor gives way.

use super::cruise::{Cruise, PERIOD};
use super::{Descriptor, Driver, Equipment, Fault, Setting, Settings, setting};
use crate::observation::{Briefing, Control, Observation};
use crate::sensor::{CameraSpec, Cameras, Image, Rig};
use nalgebra::Vector2;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "lane-camera",
    about: "keeps its speed and its lane; finds the edge of the road in the images of a camera",
    settings: &SETTINGS,
    make: |settings: &Settings| Box::new(LaneCamera::new(settings)),
};

const SETTINGS: [Setting; 7] = [
    setting("rate", 10.0, "Hz", (1.0, 100.0), "images per second"),
    setting("latency", 0.0, "s", (0.0, 2.0), "delay from when an image is taken to when it arrives"),
    setting("dropped", 0.0, "", (0.0, 1.0), "probability that an image is lost"),
    setting("blur", 0.0, "px", (0.0, 16.0), "standard deviation of the lens's blur"),
    setting("contrast", 25.0, "", (1.0, 255.0), "least difference in brightness between the road and its edge, of 255"),
    setting("setback", 1.75, "m", (0.5, 10.0), "distance from the edge of the road at which it drives"),
    setting("patience", 1.0, "s", (0.0, 60.0), "how long the driver goes on without seeing the road before it brakes"),
];

/// The camera: its pixels across and down, focal length and sensor width in millimetres, position on the car in metres,
/// and downward pitch in degrees.
const RESOLUTION: [u32; 2] = [200, 66];
const FOCAL: f64 = 24.0;
const SENSOR: f64 = 36.0;
const AHEAD: f64 = 0.3;
const HEIGHT: f64 = 1.35;
const PITCH: f64 = 6.0;

/// The greatest distance ahead in metres of the rows that are used. Rows that show a greater distance are too coarse.
const FARTHEST: f64 = 30.0;
/// The greatest distance in metres between a row that counts and the point that the driver looks at.
const AROUND: f64 = 3.0;
/// The deceleration in m/s² if the driver sees no road.
const BRAKES: f64 = 3.0;

/// A driver that sees the road by a camera.
#[derive(Debug)]
struct LaneCamera {
    camera: CameraSpec,
    contrast: f64,
    setback: f64,
    patience: f64,
    cruise: Cruise,
    /// The points of the lane's middle in the last image, as seen from the car's middle, the nearest first.
    lane: Vec<Vector2<f64>>,
    /// The time of the last image that showed the road.
    seen: f64,
    steering: f64,
}

impl LaneCamera {
    fn new(settings: &Settings) -> Self {
        let mut camera = CameraSpec {
            resolution: RESOLUTION,
            focal_mm: FOCAL,
            sensor_mm: SENSOR,
            position: [AHEAD, 0.0, HEIGHT],
            yaw_pitch_roll: [0.0, PITCH, 0.0],
            rate: settings.get("rate"),
            latency: settings.get("latency"),
            dropped: settings.get("dropped"),
            ..CameraSpec::default()
        };
        camera.lens.set("blur", settings.get("blur"));
        Self {
            camera,
            contrast: settings.get("contrast"),
            setback: settings.get("setback"),
            patience: settings.get("patience"),
            cruise: Cruise::default(),
            lane: Vec::new(),
            seen: 0.0,
            steering: 0.0,
        }
    }

    /// Finds the lane's middle in an image.
    fn look(&mut self, image: &Image) {
        self.lane.clear();
        let road = Row::of(image, image.height - 1).middle();
        // The search begins straight ahead.
        let mut lane = 0.0;
        for row in (0..image.height).rev().map(|number| Row::of(image, number)) {
            let Some(distance) = row.distance().filter(|distance| *distance <= FARTHEST) else { return };
            if let Some(edge) = row.edge(lane, road + self.contrast) {
                lane = edge + self.setback;
                self.lane.push(Vector2::new(AHEAD + distance, lane));
            }
        }
    }

    /// Returns the middle of the lane `metres` metres ahead, as the mean of the points that were seen near there.
    fn target(&self, metres: f64) -> Option<Vector2<f64>> {
        let there = || self.lane.iter().filter(|point| (point.x - metres).abs() <= AROUND);
        let count = there().count();
        (count > 0).then(|| there().sum::<Vector2<f64>>() / count as f64)
    }
}

/// A row of an image, which shows a strip of flat ground.
struct Row<'a> {
    pixels: &'a [u8],
    /// The slope of the ray through the row's middle, as its descent per metre along the camera's axis.
    down: f64,
}

impl<'a> Row<'a> {
    fn of(image: &'a Image, number: u32) -> Self {
        let bytes = 3 * image.width as usize;
        let pixels = &image.rgb[number as usize * bytes..][..bytes];
        Self { pixels, down: (f64::from(number) + 0.5 - 0.5 * f64::from(image.height)) / focal(image.width) }
    }

    /// Returns the distance ahead in metres to the ground that the row shows; `None` if the row shows no ground.
    fn distance(&self) -> Option<f64> {
        let (sin, cos) = libm::sincos(PITCH.to_radians());
        let falls = sin + self.down * cos;
        (falls > 0.0).then(|| HEIGHT * (cos - self.down * sin) / falls)
    }

    /// Returns the depth in metres, along the camera's axis, of the ground that the row shows.
    fn depth(&self) -> Option<f64> {
        let (sin, cos) = libm::sincos(PITCH.to_radians());
        Some(self.distance()? * cos + HEIGHT * sin)
    }

    fn width(&self) -> usize {
        self.pixels.len() / 3
    }

    /// Returns the luma of a pixel (ITU-R BT.601), from 0 to 255.
    fn brightness(&self, column: usize) -> f64 {
        let [red, green, blue] = [0, 1, 2].map(|colour| f64::from(self.pixels[3 * column + colour]));
        0.299 * red + 0.587 * green + 0.114 * blue
    }

    /// Returns the mean brightness of the row's middle tenth.
    fn middle(&self) -> f64 {
        let (from, to) = (self.width() * 9 / 20, self.width() * 11 / 20 + 1);
        (from..to).map(|column| self.brightness(column)).sum::<f64>() / (to - from) as f64
    }

    /// Returns the offset of the road's edge in metres to the left. The edge is the first pixel of at least the
    /// brightness `least` to the right of `from`. `None` if `from` (metres to the left) is outside or bright.
    fn edge(&self, from: f64, least: f64) -> Option<f64> {
        let (focal, half) = (focal(self.width() as u32), 0.5 * self.width() as f64);
        let depth = self.depth()?;
        let begin = half - focal * from / depth;
        if !(0.0..self.width() as f64).contains(&begin) || self.brightness(begin as usize) >= least {
            return None;
        }
        let bright = (begin as usize..self.width()).find(|column| self.brightness(*column) >= least)?;
        Some((half - bright as f64) * depth / focal)
    }
}

/// Returns the focal length in pixels.
fn focal(width: u32) -> f64 {
    f64::from(width) * FOCAL / SENSOR
}

impl Driver for LaneCamera {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn equipment(&mut self) -> Equipment {
        let all = [("front".to_owned(), self.camera.clone())].into();
        Equipment { rig: Rig::default(), cameras: Cameras { all, ..Cameras::default() } }
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.lane.clear();
        (self.seen, self.steering) = (0.0, 0.0);
        self.cruise.reset(briefing)
    }

    fn perceive(&mut self, _: &Rig, images: &[Image]) -> Result<(), Fault> {
        if let Some(image) = images.last() {
            self.look(image);
            if !self.lane.is_empty() {
                self.seen = image.time;
            }
        }
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        if let Some(target) = self.target(Cruise::looks_ahead(observation.speed)) {
            self.steering = self.cruise.steering(target);
        }
        let blind = observation.time - self.seen > self.patience;
        let acceleration = if blind { -BRAKES } else { self.cruise.keeping(observation.speed) };
        Ok(Control { throttle: self.cruise.throttle(acceleration), steering: self.steering })
    }
}

#[cfg(test)]
mod tests;
