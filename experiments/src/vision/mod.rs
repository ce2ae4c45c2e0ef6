//! The networks that see of Figures 5 to 8: how they are taught, and the studies that put them on trial.

pub mod conditions;
mod detectors;
pub mod fig6;
pub mod fig8;
mod hog;
pub mod recall;
pub mod road;
mod sheet;
mod support_vectors;
pub mod vehicles;

use crate::scenario;
use indicatif::ProgressBar;
use paracosm::Study;
use paracosm::campaign::cameras::VariedCameras;
use paracosm::campaign::gallery::{Gallery, Shown};
use paracosm::campaign::perception::RoadUser;
use paracosm::engine::sensor::{CameraSpec, Cameras};
use paracosm::generators::{Request, Strategy};
use paracosm::render::Look;
use paracosm::space::{Domain, Parameter, Space};
use std::error::Error;

type Failure = Box<dyn Error + Send + Sync>;

/// A scenario whose images are lessons.
#[derive(Debug, Clone, Copy)]
struct Lesson {
    scenario: &'static str,
    /// A parameter that is fixed.
    fixed: Option<(&'static str, f64)>,
}

impl Lesson {
    const fn of(scenario: &'static str) -> Self {
        Self { scenario, fixed: None }
    }

    const fn fixed(self, parameter: &'static str, value: f64) -> Self {
        Self { fixed: Some((parameter, value)), ..self }
    }
}

/// The parameter that varies the focal length.
const LENS: &str = "camera.front.focal_mm";

/// Returns a camera on top of the car, with an image each second. It has one focal length in millimetres, or a range of
/// them.
fn cameras(resolution: [u32; 2], focal_mm: (f64, f64)) -> Result<VariedCameras, Failure> {
    if focal_mm.0 == focal_mm.1 {
        return Ok(still(resolution, focal_mm.0, 1.0));
    }
    let (lo, hi) = focal_mm;
    varied(resolution, Domain::Interval { lo, hi }, 0.5 * (lo + hi), 1.0)
}

/// Returns a camera on top of the car whose focal length in millimetres varies, with its usual value, and this number of
/// images a second.
fn varied(resolution: [u32; 2], focal_mm: Domain, usual: f64, rate: f64) -> Result<VariedCameras, Failure> {
    let cameras = still(resolution, usual, rate).nominal().clone();
    let (unit, default) = (Some("mm".to_owned()), Some(usual.into()));
    let lens = Parameter { unit, default, ..Parameter::new(LENS, focal_mm) };
    Ok(VariedCameras::of_space(cameras, &Space::new(vec![lens])?).in_look(Look::Textured))
}

/// Returns a camera on top of the car with one focal length in millimetres, and this number of images a second.
fn still(resolution: [u32; 2], focal_mm: f64, rate: f64) -> VariedCameras {
    let position = [0.3, 0.0, 1.65];
    let front = CameraSpec { resolution, focal_mm, sensor_mm: 36.0, position, rate, ..CameraSpec::default() };
    VariedCameras::from(Cameras {
        look: Look::Textured,
        all: [("front".to_owned(), front)].into(),
        ..Cameras::default()
    })
}

/// Makes something of each image of Halton tests of a study, in a list for each test.
fn halton<T>(
    study: &Study,
    cameras: &VariedCameras,
    (tests, seed): (usize, u64),
    bar: &ProgressBar,
    mut of: impl FnMut(Shown) -> T,
) -> Result<Vec<Vec<T>>, Failure> {
    let mut gallery = Gallery::new(study, cameras.clone())?;
    let request = Request { seed: Some(seed), ..Request::new(study.space(), tests) };
    let mut made = Vec::new();
    for point in Strategy::HALTON.build(&request)?.ask(tests) {
        made.push(gallery.show(&study.space().decode(&point))?.into_iter().map(&mut of).collect());
        bar.inc(1);
    }
    Ok(made)
}

/// The seed of the tests of lessons. Other tests have other seeds.
const LESSONS: u64 = 1;

/// Makes something of each image of lessons, with the place of the lesson, by this number of tests in each lesson.
fn lessons<T>(
    lessons: &[Lesson],
    tests: usize,
    cameras: &VariedCameras,
    bar: &ProgressBar,
    of: impl Fn(usize, &Shown) -> T,
) -> Result<Vec<T>, Failure> {
    bar.set_length((lessons.len() * tests) as u64);
    let mut made = Vec::new();
    for (place, Lesson { scenario: name, fixed }) in lessons.iter().enumerate() {
        let mut study = scenario(name)?.driver("planner").open_over("light", Domain::Interval { lo: 0.6, hi: 1.0 });
        if let Some((parameter, value)) = fixed {
            study = study.fix(parameter, *value);
        }
        let study = study.open_cameras(cameras).build()?;
        made.extend(halton(&study, cameras, (tests, LESSONS), bar, |shown| of(place, &shown))?.into_iter().flatten());
    }
    Ok(made)
}

/// Returns `true` for road users that detectors of vehicles should find.
fn is_vehicle(user: &RoadUser) -> bool {
    ["car", "van", "truck", "bus"].contains(&user.kind.as_str())
}

/// Returns `true` for the truck that crosses `highway-traffic`. It is the first car of the fleet, whose ids in images
/// follow the id of the ego vehicle, 1.
fn is_crossing_truck(user: &RoadUser) -> bool {
    user.id == 2 && user.kind == "truck"
}
