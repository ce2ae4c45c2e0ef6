//! The driver `lane-camera`: keeps its lane by what a camera at its front shows, and its speed. A demonstration of a driver
//! that sees, not of how to see well: it goes by a threshold of brightness, so that fog, dusk and a blurred lens are hard on
//! it, and it brakes for nothing but that it sees no road.
//!
//! Row by row of the image, from the nearest, it goes from where the lane should be to the right until the road ends: at
//! the kerb, or at paint. A row is a distance ahead on flat ground, and the lane's middle is so many metres to the left of
//! the edge. To that it steers by pure pursuit.
//!
//! It goes round bends, but does not slow down for them, as it is told nothing of its way: by day it keeps its lane where a bend
//! has a radius of 15 m or more and its speed asks for no more than 5 m/s² sideways on a dry road. In sharper bends to the right
//! the edge of the road leaves the image. At junctions it neither turns nor gives way.

use super::cruise::{Cruise, PERIOD};
use super::{Descriptor, Driver, Equipment, Fault, Setting, Settings, setting};
use crate::observation::{Briefing, Control, Observation};
use crate::sensor::{CameraSpec, Cameras, Image, Rig};
use nalgebra::Vector2;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "lane-camera",
    about: "keeps its speed, and its lane by the edge of the road in the images of a camera",
    settings: &SETTINGS,
    make: |settings: &Settings| Box::new(LaneCamera::new(settings)),
};

const SETTINGS: [Setting; 7] = [
    setting("rate", 10.0, "Hz", (1.0, 100.0), "images per second"),
    setting("latency", 0.0, "s", (0.0, 2.0), "from when an image is taken to when it is there"),
    setting("dropped", 0.0, "", (0.0, 1.0), "probability that an image is lost"),
    setting("blur", 0.0, "px", (0.0, 16.0), "standard deviation of the lens's blur"),
    setting("contrast", 25.0, "", (1.0, 255.0), "how much brighter than the road, of 255, its edge is at least"),
    setting("setback", 1.75, "m", (0.5, 10.0), "from the edge of the road to where it drives"),
    setting("patience", 1.0, "s", (0.0, 60.0), "how long it drives on without seeing the road, before it brakes"),
];

/// The camera: pixels across and down, focal length and width of the sensor in millimetres, where it is on the car in
/// metres, and how far down it looks in degrees.
const RESOLUTION: [u32; 2] = [200, 66];
const FOCAL: f64 = 24.0;
const SENSOR: f64 = 36.0;
const AHEAD: f64 = 0.3;
const HEIGHT: f64 = 1.35;
const PITCH: f64 = 6.0;

/// Rows that show the road farther away than this many metres ahead are too coarse to go by.
const FARTHEST: f64 = 30.0;
/// As seen from where it looks, rows count that are at most so many metres nearer or farther.
const AROUND: f64 = 3.0;
/// How hard it brakes when it sees no road, in m/s².
const BRAKES: f64 = 3.0;

/// A driver that sees by a camera.
#[derive(Debug)]
struct LaneCamera {
    camera: CameraSpec,
    contrast: f64,
    setback: f64,
    patience: f64,
    cruise: Cruise,
    /// The points of the lane's middle that the last image showed, as seen from the car's middle, the nearest first.
    lane: Vec<Vector2<f64>>,
    /// When an image showed the road last.
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
        // It begins straight ahead.
        let mut lane = 0.0;
        for row in (0..image.height).rev().map(|number| Row::of(image, number)) {
            let Some(distance) = row.distance().filter(|distance| *distance <= FARTHEST) else { return };
            if let Some(edge) = row.edge(lane, road + self.contrast) {
                lane = edge + self.setback;
                self.lane.push(Vector2::new(AHEAD + distance, lane));
            }
        }
    }

    /// Where the lane's middle is so many metres ahead: the mean of what is seen there.
    fn target(&self, metres: f64) -> Option<Vector2<f64>> {
        let there = || self.lane.iter().filter(|point| (point.x - metres).abs() <= AROUND);
        let count = there().count();
        (count > 0).then(|| there().sum::<Vector2<f64>>() / count as f64)
    }
}

/// A row of an image: a strip of flat ground.
struct Row<'a> {
    pixels: &'a [u8],
    /// What the way down of a ray is, of the way along the camera's axis: of the row's middle.
    down: f64,
}

impl<'a> Row<'a> {
    fn of(image: &'a Image, number: u32) -> Self {
        let bytes = 3 * image.width as usize;
        let pixels = &image.rgb[number as usize * bytes..][..bytes];
        Self { pixels, down: (f64::from(number) + 0.5 - 0.5 * f64::from(image.height)) / focal(image.width) }
    }

    /// How far ahead of the camera, in metres, the ground is that it shows, if it shows any.
    fn distance(&self) -> Option<f64> {
        let (sin, cos) = libm::sincos(PITCH.to_radians());
        let falls = sin + self.down * cos;
        (falls > 0.0).then(|| HEIGHT * (cos - self.down * sin) / falls)
    }

    /// How far along the camera's axis that is.
    fn depth(&self) -> Option<f64> {
        let (sin, cos) = libm::sincos(PITCH.to_radians());
        Some(self.distance()? * cos + HEIGHT * sin)
    }

    fn width(&self) -> usize {
        self.pixels.len() / 3
    }

    /// The luma of a pixel (ITU-R BT.601), from 0 to 255.
    fn brightness(&self, column: usize) -> f64 {
        let [red, green, blue] = [0, 1, 2].map(|colour| f64::from(self.pixels[3 * column + colour]));
        0.299 * red + 0.587 * green + 0.114 * blue
    }

    /// The mean brightness of its middle tenth.
    fn middle(&self) -> f64 {
        let (from, to) = (self.width() * 9 / 20, self.width() * 11 / 20 + 1);
        (from..to).map(|column| self.brightness(column)).sum::<f64>() / (to - from) as f64
    }

    /// How far to the left of straight ahead, in metres, it first gets brighter than `least`, to the right of a point that
    /// is given likewise; nothing if that is not on the image or is bright itself.
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

/// The focal length in pixels.
fn focal(width: u32) -> f64 {
    f64::from(width) * FOCAL / SENSOR
}

impl Driver for LaneCamera {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn equipment(&mut self) -> Equipment {
        let all = [("front".to_owned(), self.camera.clone())].into();
        Equipment { rig: Rig::default(), cameras: Cameras { seed: 0, all } }
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
