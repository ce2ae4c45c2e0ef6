//! The detectors of a comparison. The threshold of each detector is frozen on easy scenes; then the detector sees other
//! scenes.

use super::hog::Hog;
use super::{Failure, halton, is_vehicle, still};
use crate::scenario;
use indicatif::ProgressBar;
use paracosm::campaign::gallery::Shown;
use paracosm::campaign::perception::RoadUser;
use paracosm::perception::{
    Areas, Criterion, Detection, Detector, Extent, Matching, Object, Perceiver, PerceiverError, Percept, Picture, Task,
    match_boxes, suppress,
};
use paracosm_neural::vision::learn::Goal;
use paracosm_neural::vision::{Description, Vision};
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// The width and the height of images in pixels, and of the input of our networks: half of them.
pub const RESOLUTION: [u32; 2] = [640, 384];
pub const INPUT: [u32; 2] = [RESOLUTION[0] / 2, RESOLUTION[1] / 2];

/// The folder of the fetched detectors.
const FETCHED: &str = "target/detectors";

/// The fetched detectors. `experiments/detectors` has the script that fetches them.
pub const NAMES: [&str; 3] = ["ssd-coco", "centernet-coco", "ssd-open-images"];

/// A single-shot network that was trained here.
pub struct SingleShot {
    /// The name of the detector, and of its file.
    pub name: &'static str,
    /// True if vehicles that cross were in its lessons.
    pub crossing: bool,
    contents: &'static [u8],
}

/// The single-shot networks. `train-vehicles` made them.
pub const SINGLE_SHOTS: [SingleShot; 2] = [
    SingleShot { name: "single-shot", crossing: true, contents: include_bytes!("../../networks/single-shot.onnx") },
    SingleShot {
        name: "single-shot-ahead",
        crossing: false,
        contents: include_bytes!("../../networks/single-shot-ahead.onnx"),
    },
];

/// The name of the detector by histograms of oriented gradients, and its windows.
pub const HOG: &str = "hog";
const HOG_WINDOWS: &str = include_str!("../../networks/hog.json");

/// The overlap (IoU) from which on a detection matches.
pub const OVERLAP: f64 = 0.5;
/// The least visible share of a vehicle that counts.
const VISIBLE: f64 = 0.25;
/// The least height of a vehicle that counts, in pixels of the image.
const HEIGHT: f64 = 8.0;
/// The least score of a box that counts.
const FLOOR: f64 = 0.05;
/// The number of false alarms in an image at which thresholds are frozen.
pub const ALARMS: f64 = 0.1;

/// The easy scenes in which thresholds are frozen: the scenarios, and the number of tests.
const EASY: [&str; 3] = ["follow-leader", "cut-in", "oncoming-distractor"];
const EASY_TESTS: usize = 4;
/// The seed of the tests of easy scenes.
const EASY_SEED: u64 = 1;

/// A detector with its name.
pub struct Named {
    /// The name of the detector.
    pub name: &'static str,
    perceiver: Box<dyn Perceiver>,
    detector: Detector,
    make: Arc<dyn Fn() -> Box<dyn Perceiver> + Send + Sync>,
}

/// A detector with another threshold than its own.
struct Frozen {
    perceiver: Box<dyn Perceiver>,
    task: Task,
}

impl Perceiver for Frozen {
    fn task(&self) -> &Task {
        &self.task
    }

    fn scale(&self, width: u32, height: u32) -> f64 {
        self.perceiver.scale(width, height)
    }

    fn perceive(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, PerceiverError> {
        self.perceiver.perceive(pictures)
    }
}

/// The boxes of a detector in an image that mean vehicles, sorted by score, after the non-maximum suppression.
pub type Found = Vec<Detection>;

/// The vehicles in an image that count, and those that need not be found.
pub struct Vehicles {
    /// The vehicles.
    pub users: Vec<RoadUser>,
    /// The vehicles as objects; crowds need not be found.
    pub objects: Vec<Object>,
}

/// Returns all detectors that are there, and the names of the fetched detectors that are absent.
pub fn all() -> Result<(Vec<Named>, Vec<&'static str>), Failure> {
    let (mut all, mut absent) = (Vec::new(), Vec::new());
    for name in NAMES {
        let file = Path::new(FETCHED).join(name);
        match fs::read(file.with_extension("onnx")) {
            Ok(contents) => {
                all.push(Named::network(name, &contents, &fs::read_to_string(file.with_extension("toml"))?)?);
            }
            Err(_) => absent.push(name),
        }
    }
    for SingleShot { name, contents, .. } in SINGLE_SHOTS {
        all.push(Named::network(name, contents, &Goal::Vehicles.description(INPUT))?);
    }
    all.push(Named::of(HOG, Hog::read(HOG_WINDOWS)?)?);
    Ok((all, absent))
}

/// Returns the images of easy scenes: few vehicles, by day.
pub fn easy(bar: &ProgressBar) -> Result<Vec<Shown>, Failure> {
    bar.set_length((EASY.len() * EASY_TESTS) as u64);
    let mut all = Vec::new();
    for name in EASY {
        let study = scenario(name)?.driver("planner").build()?;
        let tests = halton(&study, &still(RESOLUTION, 24.0, 1.0), (EASY_TESTS, EASY_SEED), bar, |shown| shown)?;
        all.extend(tests.into_iter().flatten());
    }
    Ok(all)
}

impl Named {
    /// Reads a network from an ONNX file and its description.
    fn network(name: &'static str, contents: &[u8], description: &str) -> Result<Self, Failure> {
        Self::of(name, Vision::read(contents, Description::parse(description)?)?)
    }

    fn of(name: &'static str, perceiver: impl Perceiver + Clone + Sync + 'static) -> Result<Self, Failure> {
        let Task::Detection(detector) = perceiver.task().clone() else {
            return Err(format!("{name} is no detector").into());
        };
        let make: Arc<dyn Fn() -> Box<dyn Perceiver> + Send + Sync> = Arc::new(move || Box::new(perceiver.clone()));
        Ok(Self { name, perceiver: make(), detector, make })
    }

    /// Returns a function that makes the detector with another threshold, for campaigns.
    pub fn frozen(&self, threshold: f64) -> impl Fn() -> Box<dyn Perceiver> + Send + Sync + Clone + use<> {
        let (make, task) = (self.make.clone(), Task::Detection(Detector { threshold, ..self.detector.clone() }));
        move || Box::new(Frozen { perceiver: make(), task: task.clone() })
    }

    /// Returns the factor that makes pixels of the detector's input from pixels of images, by the height.
    pub fn scale(&self) -> f64 {
        self.perceiver.scale(RESOLUTION[0], RESOLUTION[1])
    }

    /// Returns the boxes that mean vehicles in an image.
    pub fn find(&mut self, picture: Picture<'_>) -> Result<Found, Failure> {
        let Percept::Boxes(boxes) = self.perceiver.perceive(&[picture])?.remove(0) else { return Ok(Vec::new()) };
        let vehicles = self.detector.groups.iter().position(|group| group.is.iter().any(|kind| kind == "car"));
        let group_of = self.detector.groups_of_classes();
        // Classes of vehicles are one class: the best box of any of them wins.
        let meant = boxes.iter().filter(|one| vehicles.is_some() && group_of[one.class] == vehicles);
        let as_one: Vec<Detection> = meant.map(|one| Detection { class: 0, ..*one }).collect();
        Ok(suppress(&as_one, FLOOR, self.detector.overlap))
    }

    /// Returns the vehicles in an image and the boxes that the detector found. A vehicle counts if at least a quarter of
    /// it is visible and it is at least 8 pixels high.
    pub fn see(&mut self, shown: &Shown) -> Result<(Vehicles, Found), Failure> {
        let counts = |user: &RoadUser| user.visible >= VISIBLE && user.rect.height >= HEIGHT;
        Ok((Vehicles::of(shown, self.detector.extent, counts), self.find(shown.picture())?))
    }

    /// Returns the least threshold with at most 0.1 false alarms an image, over images of easy scenes.
    pub fn freeze(&mut self, easy: &[Shown]) -> Result<f64, Failure> {
        let mut alarms: Vec<f64> = Vec::new();
        for shown in easy {
            let (vehicles, found) = self.see(shown)?;
            let matching = vehicles.matched(&found, 0.0);
            let pairs = matching.detections.iter().zip(&matching.objects);
            alarms.extend(pairs.filter(|(_, object)| object.is_none()).map(|(place, _)| found[*place].score));
        }
        alarms.sort_by(|a, b| b.total_cmp(a));
        let allowed = (ALARMS * easy.len() as f64).floor() as usize;
        // Just above the score of the first false alarm that is one too many.
        Ok(alarms.get(allowed).map_or(FLOOR, |score| score.next_up()))
    }

    /// Returns the extent of the boxes that the detector makes.
    pub fn extent(&self) -> Extent {
        self.detector.extent
    }
}

impl Vehicles {
    /// Returns the vehicles in an image, with boxes of this extent. Other vehicles than those that count need not be
    /// found.
    pub fn of(shown: &Shown, extent: Extent, counts: impl Fn(&RoadUser) -> bool) -> Self {
        let users: Vec<RoadUser> = shown.road_users(extent).into_iter().filter(is_vehicle).collect();
        let object = |user: &RoadUser| Object { rect: user.rect, area: f64::from(user.pixels), crowd: !counts(user) };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_beside_a_network_describes_it() {
        assert_eq!(include_str!("../../networks/single-shot.toml"), Goal::Vehicles.description(INPUT));
    }
}
