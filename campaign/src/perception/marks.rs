//! The marks of a perceiver: what its answer to an image is worth.

use super::grades::Grades;
use super::truth::{RoadUser, mask, road_users};
use crate::trial::Metric;
use paracosm_engine::sensor::Moment;
use paracosm_perception::{
    Areas, Confusion, Criterion, Detection, Detector, Encounters, Object, Percept, Task, match_boxes, suppress,
};
use paracosm_render::{Camera, Rendering};

/// The overlap (IoU) from which on a detection matches a road user.
const OVERLAP: f64 = 0.5;
/// The distance of the centres up to which a detection is centred on a road user, as a share of the diagonal of its box.
const CENTRED: f64 = 0.25;
/// The least visible share of a road user that counts for recall by distance, height and visible share.
const SEEN: f64 = 0.25;

/// The values of the signals over the images of a test.
#[derive(Debug)]
pub(super) struct Marks {
    encounters: Encounters,
    grades: Grades,
    /// The factor that makes pixels of the perceiver's input from pixels of an image.
    scale: f64,
    /// For each image its time, and the values of the signals after the number of images.
    images: Vec<(f64, Vec<f64>)>,
}

impl Marks {
    /// Makes the marks before the first image. `scale` makes pixels of the perceiver's input from pixels of an image.
    pub fn new(scale: f64) -> Self {
        Self { encounters: Encounters::default(), grades: Grades::default(), scale, images: Vec::new() }
    }

    /// Returns the metrics of the test.
    pub fn metrics(&self) -> Vec<(String, Metric)> {
        self.grades.metrics(&self.encounters)
    }

    /// Adds the answer to the next image.
    pub fn add(
        &mut self,
        task: &Task,
        percept: &Percept,
        (picture, moment): (&Rendering, &Moment),
        time: f64,
        camera: &Camera,
    ) {
        let values = match (task, percept) {
            (Task::Detection(detector), Percept::Boxes(boxes)) => {
                let users = road_users(picture, moment, camera, detector.extent);
                self.detected(detector, boxes, &users, time)
            }
            (Task::Segmentation(segmenter), Percept::Mask(answer)) => {
                let counts = Confusion::of(answer, &mask(picture, &segmenter.is));
                self.grades.count_pixels(counts);
                vec![counts.overlap(), counts.recall(), counts.precision()]
            }
            // The answers of a task are checked before they get marks.
            _ => unreachable!("the kind of an answer is the kind of its task"),
        };
        self.images.push((time, values));
    }

    fn detected(&mut self, detector: &Detector, boxes: &[Detection], users: &[RoadUser], time: f64) -> Vec<f64> {
        let group_of = detector.groups_of_classes();
        let found = suppress(boxes, detector.threshold, detector.overlap);
        let (mut objects, mut matches, mut centred, mut false_alarms) = (0usize, 0usize, 0usize, 0usize);
        let (mut visible, mut seen) = (0usize, 0usize);
        let mut margin: f64 = 1.0;
        let mut wanted = Vec::new();
        for (place, group) in detector.groups.iter().enumerate() {
            let is_meant = |user: &&RoadUser| group.is.contains(&user.kind) || group.may_be.contains(&user.kind);
            let users: Vec<&RoadUser> = users.iter().filter(is_meant).collect();
            let must = |user: &RoadUser| group.is.contains(&user.kind) && user.should_be_detected();
            let truth: Vec<Object> = users
                .iter()
                .map(|user| Object { rect: user.rect, area: f64::from(user.pixels), crowd: !must(user) })
                .collect();
            let of_group = |one: &&Detection| group_of[one.class] == Some(place);
            let detections: Vec<Detection> = found.iter().filter(of_group).copied().collect();
            let boxes: Vec<Detection> = boxes.iter().filter(of_group).copied().collect();
            let matching = match_boxes(&truth, &detections, Criterion::Overlap(OVERLAP), Areas::ALL);
            let by_centres = match_boxes(&truth, &detections, Criterion::Centres(CENTRED), Areas::ALL);
            let on_objects = by_centres.detected.iter().zip(&truth).filter(|(_, object)| !object.crowd);
            centred += on_objects.filter(|(detection, _)| detection.is_some()).count();
            self.grades.tally(place, &truth, &boxes, (detector.overlap, OVERLAP));
            let meant = users.iter().filter(|user| group.is.contains(&user.kind) && user.visible >= SEEN);
            let meant: Vec<&RoadUser> = meant.copied().collect();
            visible += meant.len();
            seen += self.grades.count_by_ranges(&meant, &detections, OVERLAP, self.scale);
            false_alarms += matching.objects.iter().filter(|object| object.is_none()).count();
            for (user, detection) in users.iter().zip(&matching.detected).filter(|(user, _)| must(user)) {
                objects += 1;
                matches += usize::from(detection.is_some());
                wanted.push((user.id, detection.is_some()));
                let on_user = boxes.iter().filter(|one| one.rect.overlap(&user.rect) >= OVERLAP);
                let best = on_user.map(|one| one.score).fold(0.0, f64::max);
                margin = margin.min(best - detector.threshold);
            }
        }
        self.encounters.see(time, wanted);
        self.grades.count(objects, matches, false_alarms);
        let share = |part: usize, whole: usize| if whole == 0 { 1.0 } else { part as f64 / whole as f64 };
        vec![
            objects as f64,
            matches as f64,
            (objects - matches) as f64,
            centred as f64,
            visible as f64,
            seen as f64,
            false_alarms as f64,
            share(matches, objects),
            share(matches, matches + false_alarms),
            margin,
            self.encounters.unmatched(time),
        ]
    }

    /// Returns the values of the signals at a time: the number of images so far, and the values of the last image. Before
    /// the first image nothing is missed.
    pub fn at(&self, task: &Task, time: f64) -> Vec<f64> {
        let taken = self.images.partition_point(|(at, _)| *at <= time + 1e-9);
        let values = match (taken.checked_sub(1), task) {
            (Some(last), _) => self.images[last].1.clone(),
            (None, Task::Detection(_)) => vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0],
            (None, Task::Segmentation(_)) => vec![1.0, 1.0, 1.0],
        };
        std::iter::once(taken as f64).chain(values).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use paracosm_engine::Pose;
    use paracosm_engine::object::{Body, BodyState};
    use paracosm_perception::Rect;
    use paracosm_render::{Frame, Semantic, is_only_pictured};

    #[test]
    fn a_detector_that_finds_a_parked_car_of_the_picture_is_neither_rewarded_nor_punished() {
        // The right half of an image of 4 x 2 pixels shows a car that no body of the run is.
        let id = u16::MAX;
        assert!(is_only_pictured(id));
        let camera = Camera::new(4, 2, 24.0, 36.0).expect("a sound camera");
        let halves = |left: u16, right: u16| [left, left, right, right].repeat(2);
        let frame = Frame {
            camera: camera.clone(),
            rgb: None,
            linear: None,
            depth: None,
            semantic: Some(halves(Semantic::Road as u16, Semantic::Car as u16).into_iter().map(|n| n as u8).collect()),
            instance: Some(halves(0, id)),
            alone: None,
        };
        let picture = Rendering { frame, boxes: Vec::new() };
        let own = BodyState {
            body: Body::car(),
            pose: Pose { position: [0.0, 0.0].into(), heading: 0.0 },
            velocity: [0.0, 0.0].into(),
            altitude: 0.0,
            travelled: 0.0,
            present: true,
        };
        let moment = Moment { bodies: vec![own], ..Moment::default() };
        let task = Task::Detection(Detector::of(vec!["car".to_owned()]));
        let marks = |boxes: Vec<Detection>| {
            let mut marks = Marks::new(1.0);
            marks.add(&task, &Percept::Boxes(boxes), (&picture, &moment), 0.0, &camera);
            marks.at(&task, 0.0)
        };
        let car = Rect::between([2.0, 0.0], [4.0, 2.0]);
        let found = marks(vec![Detection { class: 0, score: 0.9, rect: car }]);
        assert_eq!(found, marks(Vec::new()));
        // A detection where there is no car is a false alarm.
        let road = Rect::between([0.0, 0.0], [2.0, 2.0]);
        assert_ne!(found, marks(vec![Detection { class: 0, score: 0.9, rect: road }]));
    }
}
