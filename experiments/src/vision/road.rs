//! Teaches the networks that mark the road, for Figure 6: five at one focal length, and five at all lengths.

use super::{Failure, Lesson, cameras, lessons};
use crate::{Done, write};
use indicatif::ProgressBar;
use paracosm::perception::Segmenter;
use paracosm_neural::vision::learn::{Example, Goal, Recipe, train};
use std::path::Path;

/// The width and the height of the images in pixels.
pub const RESOLUTION: [u32; 2] = [160, 96];

/// The seeds of the networks.
pub const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];

/// The focal lengths of the lessons of a network in millimetres, with the name of the network.
#[derive(Debug, Clone, Copy)]
pub struct Course {
    /// The name of the networks.
    pub name: &'static str,
    /// The shortest and the longest focal length.
    pub focal_mm: (f64, f64),
}

/// The focal length at which the first networks were taught.
pub const TAUGHT: f64 = 34.0;

/// The courses.
pub const COURSES: [Course; 2] =
    [Course { name: "one-length", focal_mm: (TAUGHT, TAUGHT) }, Course { name: "all-lengths", focal_mm: (10.0, 50.0) }];

/// The scenarios of the lessons. The scene of Figure 6 is `highway-traffic` with the traffic of seed 1, which no lesson
/// has.
const LESSONS: [Lesson; 8] = [
    Lesson::of("highway-traffic").fixed("traffic_seed", 2.0),
    Lesson::of("highway-traffic").fixed("traffic_seed", 3.0),
    Lesson::of("highway-traffic").fixed("traffic_seed", 4.0),
    Lesson::of("grid-traffic"),
    Lesson::of("t-loop"),
    Lesson::of("roundabout-entry"),
    Lesson::of("follow-leader"),
    Lesson::of("pedestrian-crossing"),
];

/// The number of tests in each scenario of the lessons.
const TESTS: usize = 5;

/// Teaches all networks and writes them to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let mut table = vec!["course,seed,epoch,examples,loss".to_owned()];
    for Course { name, focal_mm } in COURSES {
        let examples = examples(focal_mm, bar)?;
        for seed in SEEDS {
            let recipe = Recipe { resolution: RESOLUTION, seed, batch: 16, epochs: 6, rates: [2e-3, 1e-4] };
            let story = "made by: cargo run --release -p paracosm-experiments -- train-road";
            let contents = train(Goal::Road, &recipe, &examples, story, |epoch, loss| {
                bar.suspend(|| eprintln!("{name}, seed {seed}, epoch {epoch}: loss {loss:.5}"));
                table.push(format!("{name},{seed},{epoch},{},{loss}", examples.len()));
            });
            write(&out.join(format!("road-{name}-{seed}.onnx")), contents)?;
            write(&out.join("learning-road.csv"), table.join("\n") + "\n")?;
        }
    }
    write(&out.join("road.toml"), Goal::Road.description(RESOLUTION))
}

/// Returns the examples of a course.
fn examples(focal_mm: (f64, f64), bar: &ProgressBar) -> Result<Vec<Example>, Failure> {
    let road = Segmenter::default();
    lessons(&LESSONS, TESTS, &cameras(RESOLUTION, focal_mm)?, bar, |_, shown| {
        Example::of_road(shown.picture().rgb.to_vec(), &shown.mask(&road.is).pixels)
    })
}
