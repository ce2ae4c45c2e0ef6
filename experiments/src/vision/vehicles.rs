//! Teaches the detectors of vehicles: single-shot networks, and HOG with a linear support vector machine.

use super::detectors::{HOG, INPUT, RESOLUTION, SINGLE_SHOTS, SingleShot};
use super::hog::{self, Hit, Window};
use super::{Failure, Lesson, lessons, still, support_vectors};
use crate::{Done, write};
use image::GrayImage;
use image::imageops;
use indicatif::ProgressBar;
use paracosm::campaign::gallery::Shown;
use paracosm::perception::{Extent, Rect};
use paracosm_neural::vision::learn::{Example, Goal, Recipe, Target, train};
use rand::SeedableRng;
use rand::seq::IndexedRandom;
use rand_pcg::Pcg64;
use std::path::Path;

/// The scenarios of the lessons. Figure 8 shows `highway-traffic` with the traffic of seed 1.
const LESSONS: [Lesson; 6] = [
    Lesson::of("highway-traffic").fixed("traffic_seed", 2.0),
    Lesson::of("highway-traffic").fixed("traffic_seed", 3.0),
    Lesson::of("highway-traffic").fixed("traffic_seed", 4.0),
    Lesson::of("ncap-ccr"),
    Lesson::of("grid-traffic"),
    Lesson::of("roundabout-entry"),
];
/// The lessons without vehicles that cross: the highway and the car ahead. Images with the crossing truck are left out.
const AHEAD: usize = 4;
/// The number of tests of each lesson.
const TESTS: usize = 6;
/// The least visible share of a vehicle that a detector should find, and its least height in pixels of the image.
const VISIBLE: f64 = 0.25;
const HEIGHT: f64 = 8.0;

/// An image of a lesson.
struct Seen {
    /// The place of the lesson.
    lesson: usize,
    /// The image in half its resolution, with three bytes a pixel.
    half: Vec<u8>,
    grey: GrayImage,
    vehicles: Vec<Vehicle>,
}

/// A vehicle in an image of a lesson.
#[derive(Clone, Copy)]
struct Vehicle {
    rect: Rect,
    visible: f64,
    crosses: bool,
}

/// Teaches all detectors and writes them to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let seen = lessons(&LESSONS, TESTS, &still(RESOLUTION, 24.0, 1.0), bar, Seen::of)?;
    let mut table = vec!["network,epoch,examples,loss".to_owned()];
    for SingleShot { name, crossing, .. } in SINGLE_SHOTS {
        let chosen = seen.iter().filter(|seen| crossing || seen.has_none_that_crosses());
        let examples: Vec<Example> = chosen.map(Seen::example).collect();
        let recipe = Recipe { resolution: INPUT, seed: 1, batch: 8, epochs: 10, rates: [1e-3, 1e-5] };
        let story = "made by: cargo run --release -p paracosm-experiments -- train-vehicles";
        let contents = train(Goal::Vehicles, &recipe, &examples, story, |epoch, loss| {
            bar.suspend(|| eprintln!("{name}, epoch {epoch}: loss {loss:.5}"));
            table.push(format!("{name},{epoch},{},{loss}", examples.len()));
        });
        write(&out.join(format!("{name}.onnx")), contents)?;
        write(&out.join("learning-vehicles.csv"), table.join("\n") + "\n")?;
    }
    write(&out.join(format!("{HOG}.json")), serde_json::to_string(&hog(&seen, bar)?)?)
}

impl Seen {
    fn of(lesson: usize, shown: &Shown) -> Self {
        let picture = shown.picture();
        let users = shown.road_users(Extent::Visible);
        let vehicles = users.iter().filter(|user| super::is_vehicle(user)).map(|user| Vehicle {
            rect: user.rect,
            visible: user.visible,
            crosses: super::is_crossing_truck(user),
        });
        Self { lesson, half: half(picture.rgb, RESOLUTION), grey: hog::grey(&picture), vehicles: vehicles.collect() }
    }

    fn has_none_that_crosses(&self) -> bool {
        self.lesson < AHEAD && self.vehicles.iter().all(|vehicle| !vehicle.crosses)
    }

    fn example(&self) -> Example {
        let target = |vehicle: &Vehicle| {
            let Rect { left, top, width, height } = vehicle.rect;
            let rect = Rect { left: 0.5 * left, top: 0.5 * top, width: 0.5 * width, height: 0.5 * height };
            Target { rect, crowd: vehicle.visible < VISIBLE || height < HEIGHT }
        };
        Example::of_vehicles(self.half.clone(), INPUT, &self.vehicles.iter().map(target).collect::<Vec<_>>())
    }
}

/// Returns the means of squares of 2 x 2 pixels, as a network sees an image that is stretched to half its size.
fn half(rgb: &[u8], [width, height]: [u32; 2]) -> Vec<u8> {
    let row = 3 * width as usize;
    let mut small = Vec::with_capacity(rgb.len() / 4);
    for y in 0..height as usize / 2 {
        for x in 0..width as usize / 2 {
            for channel in 0..3 {
                let first = 2 * y * row + 6 * x + channel;
                let sum: u32 = [0, 3, row, row + 3].iter().map(|step| u32::from(rgb[first + step])).sum();
                small.push(((sum + 2) / 4) as u8);
            }
        }
    }
    small
}

/// The windows of vehicles from behind and from the side, in cells.
const WINDOWS: [[usize; 2]; 2] = [[7, 6], [13, 6]];
/// The ratio of width to height of a box that parts the windows.
const PART: f64 = 1.7;
/// The least height of a vehicle that HOG should find, in pixels.
const LEAST: f64 = 32.0;
/// The windows without a vehicle that an image gives: at first at random, then in each of three rounds the worst false
/// alarms (the "hard negatives" of Dalal and Triggs).
const OTHERS: usize = 10;
const ROUNDS: usize = 3;
/// One of this many images gives windows without a vehicle.
const EVERY: usize = 3;
/// The overlap (IoU) with a vehicle from which on a window is neither a vehicle nor something else.
const UNCLEAR: f64 = 0.3;

/// Teaches the windows of HOG.
fn hog(seen: &[Seen], bar: &ProgressBar) -> Result<Vec<Window>, Failure> {
    let mut chance = Pcg64::seed_from_u64(1);
    let mut windows = WINDOWS.map(Window::new);
    let mut examples: [support_vectors::Examples; 2] = Default::default();
    for seen in seen {
        for vehicle in seen.vehicles.iter().filter(|vehicle| vehicle.visible >= 0.75 && vehicle.rect.height >= LEAST) {
            let place = usize::from(vehicle.rect.width / vehicle.rect.height >= PART);
            let mirrored = imageops::flip_horizontal(&seen.grey);
            let left = f64::from(RESOLUTION[0]) - vehicle.rect.left - vehicle.rect.width;
            let views = [(&seen.grey, vehicle.rect), (&mirrored, Rect { left, ..vehicle.rect })];
            let descriptors = views.iter().filter_map(|(image, rect)| windows[place].descriptor(image, rect));
            examples[place].extend(descriptors.map(|descriptor| (descriptor, true)));
        }
    }
    for round in 0..=ROUNDS {
        for seen in seen.iter().step_by(EVERY) {
            let levels = hog::levels(&seen.grey);
            for (window, examples) in windows.iter().zip(&mut examples) {
                // Before the first training all weights are zero, and all places are hits.
                let mut hits = window.hits(&levels, 0.0);
                hits.retain(|hit| seen.vehicles.iter().all(|one| one.rect.overlap(&hit.rect) < UNCLEAR));
                let chosen = if round == 0 {
                    hits.choose_multiple(&mut chance, OTHERS).collect()
                } else {
                    hits.sort_by(|a, b| b.margin.total_cmp(&a.margin));
                    apart(&hits)
                };
                let others =
                    chosen.iter().map(|Hit { level, place, .. }| window.descriptor_at(&levels[*level], *place));
                examples.extend(others.map(|descriptor| (descriptor, false)));
            }
        }
        for (window, examples) in windows.iter_mut().zip(&examples) {
            (window.weights, window.bias) = support_vectors::train(examples)?;
            let vehicles = examples.iter().filter(|(_, is_vehicle)| *is_vehicle).count();
            bar.suspend(|| eprintln!("HOG, round {round}: {vehicles} vehicles, {} others", examples.len() - vehicles));
        }
    }
    Ok(windows.into())
}

/// Returns the first hits, without hits that overlap an earlier one.
fn apart(hits: &[Hit]) -> Vec<&Hit> {
    let mut chosen: Vec<&Hit> = Vec::new();
    for hit in hits {
        if chosen.len() == OTHERS {
            break;
        }
        if chosen.iter().all(|one| one.rect.overlap(&hit.rect) < UNCLEAR) {
            chosen.push(hit);
        }
    }
    chosen
}
