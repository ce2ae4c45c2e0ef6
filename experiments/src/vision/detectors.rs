//! The detectors of a comparison. The threshold of each detector is frozen on easy scenes; then the detector sees other
//! scenes.

use super::Failure;
use paracosm::campaign::gallery::Shown;
use paracosm::campaign::perception::RoadUser;
use paracosm::perception::{
    Areas, Criterion, Detection, Detector, Matching, Object, Perceiver, Percept, Picture, Task, match_boxes, suppress,
};
use paracosm_neural::vision::{Description, Vision};
use std::fs;
use std::path::Path;

/// The folder of the fetched detectors.
const FETCHED: &str = "target/detectors";

/// The fetched detectors. `experiments/detectors` has the script that fetches them.
pub const NAMES: [&str; 3] = ["ssd-coco", "centernet-coco", "ssd-open-images"];

/// The overlap (IoU) from which on a detection matches.
const OVERLAP: f64 = 0.5;
/// The least visible share of a vehicle that counts.
const VISIBLE: f64 = 0.25;
/// The least score of a box that counts.
const FLOOR: f64 = 0.05;
/// The number of false alarms in an image at which thresholds are frozen.
pub const ALARMS: f64 = 0.1;

/// A detector with its name.
pub struct Named {
    /// The name of the detector.
    pub name: &'static str,
    network: Vision,
    detector: Detector,
}

/// The boxes of a detector in an image that mean vehicles, sorted by score, after the non-maximum suppression.
pub type Found = Vec<Detection>;

/// The vehicles in an image that count, and those that need not be found.
pub struct Vehicles {
    /// The vehicles.
    pub users: Vec<RoadUser>,
    objects: Vec<Object>,
}

/// Returns the fetched detectors that are there, and the names of the others.
pub fn fetched() -> Result<(Vec<Named>, Vec<&'static str>), Failure> {
    let (mut all, mut absent) = (Vec::new(), Vec::new());
    for name in NAMES {
        let file = Path::new(FETCHED).join(name);
        match fs::read(file.with_extension("onnx")) {
            Ok(contents) => all.push(Named::read(name, &contents, &fs::read_to_string(file.with_extension("toml"))?)?),
            Err(_) => absent.push(name),
        }
    }
    Ok((all, absent))
}

impl Named {
    /// Reads a detector from an ONNX file and its description.
    pub fn read(name: &'static str, contents: &[u8], description: &str) -> Result<Self, Failure> {
        let description = Description::parse(description)?;
        let Task::Detection(detector) = description.task.clone() else {
            return Err(format!("{name} is no detector").into());
        };
        Ok(Self { name, network: Vision::read(contents, description)?, detector })
    }

    /// Returns the boxes that mean vehicles in an image.
    pub fn find(&mut self, picture: Picture<'_>) -> Result<Found, Failure> {
        let Percept::Boxes(boxes) = self.network.perceive(&[picture])?.remove(0) else { return Ok(Vec::new()) };
        let vehicles = self.detector.groups.iter().position(|group| group.is.iter().any(|kind| kind == "car"));
        let group_of = self.detector.groups_of_classes();
        // Classes of vehicles are one class: the best box of any of them wins.
        let meant = boxes.iter().filter(|one| vehicles.is_some() && group_of[one.class] == vehicles);
        let as_one: Vec<Detection> = meant.map(|one| Detection { class: 0, ..*one }).collect();
        Ok(suppress(&as_one, FLOOR, self.detector.overlap))
    }
}

impl Vehicles {
    /// Returns the vehicles in an image, with boxes as the detector makes them. A vehicle counts if `counts` says so and
    /// at least a quarter of it is visible.
    pub fn of(shown: &Shown, detector: &Named, counts: impl Fn(&RoadUser) -> bool) -> Self {
        let is_vehicle = |user: &RoadUser| ["car", "van", "truck", "bus"].contains(&user.kind.as_str());
        let users: Vec<RoadUser> = shown.road_users(detector.detector.extent).into_iter().filter(is_vehicle).collect();
        let object = |user: &RoadUser| Object {
            rect: user.rect,
            area: f64::from(user.pixels),
            crowd: user.visible < VISIBLE || !counts(user),
        };
        Self { objects: users.iter().map(object).collect(), users }
    }

    /// Matches the boxes with a score of at least the threshold.
    pub fn matched(&self, found: &Found, threshold: f64) -> Matching {
        let boxes: Vec<Detection> = found.iter().filter(|one| one.score >= threshold).copied().collect();
        match_boxes(&self.objects, &boxes, Criterion::Overlap(OVERLAP), Areas::ALL)
    }

    /// Returns the places of the vehicles that count.
    pub fn counting(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.objects.len()).filter(|place| !self.objects[*place].crowd)
    }
}

/// Returns the least threshold with at most this number of false alarms an image.
pub fn frozen(images: &[(Vehicles, Found)]) -> f64 {
    let mut alarms: Vec<f64> = Vec::new();
    for (vehicles, found) in images {
        let matching = vehicles.matched(found, 0.0);
        let pairs = matching.detections.iter().zip(&matching.objects);
        alarms.extend(pairs.filter(|(_, object)| object.is_none()).map(|(place, _)| found[*place].score));
    }
    alarms.sort_by(|a, b| b.total_cmp(a));
    let allowed = (ALARMS * images.len() as f64).floor() as usize;
    // Just above the score of the first false alarm that is one too many.
    alarms.get(allowed).map_or(FLOOR, |score| score.next_up())
}
