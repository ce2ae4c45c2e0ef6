//! The networks that see of Figures 7 and 8, on trial.

mod detectors;
pub mod fig8;

use indicatif::ProgressBar;
use paracosm::Study;
use paracosm::campaign::cameras::VariedCameras;
use paracosm::campaign::gallery::{Gallery, Shown};
use paracosm::engine::sensor::{CameraSpec, Cameras};
use paracosm::generators::{Request, Strategy};
use paracosm::render::Look;
use std::error::Error;

type Failure = Box<dyn Error + Send + Sync>;

/// The id in images of the truck that crosses `highway-traffic`: the ego vehicle has 1, and the fleet follows.
const CROSSING_TRUCK: u16 = 2;

/// Returns a camera on top of the car with one focal length in millimetres, and this number of images a second.
fn still(resolution: [u32; 2], focal_mm: f64, rate: f64) -> VariedCameras {
    let position = [0.3, 0.0, 1.65];
    let front = CameraSpec { resolution, focal_mm, sensor_mm: 36.0, position, rate, ..CameraSpec::default() };
    VariedCameras::from(Cameras { seed: 0, all: [("front".to_owned(), front)].into() }).in_look(Look::Textured)
}

/// Returns the images of Halton tests of a study.
fn halton(study: &Study, cameras: &VariedCameras, tests: usize, bar: &ProgressBar) -> Result<Vec<Shown>, Failure> {
    let mut gallery = Gallery::new(study, cameras.clone(), Look::Textured)?;
    let request = Request { seed: Some(1), ..Request::new(study.space(), tests) };
    let mut shown = Vec::new();
    for point in Strategy::HALTON.build(&request)?.ask(tests) {
        shown.extend(gallery.show(&study.space().decode(&point))?);
        bar.inc(1);
    }
    Ok(shown)
}
