//! `paracosm-fuzz doctor`: shows the graphics adapter of this machine, and how fast it draws.

use super::output::{Format, FormatOption, Table, json};
use super::{Failure, Status, print};
use crate::engine::driver;
use crate::engine::{Run, Setup};
use crate::render::{Adapter, Camera, Look, RenderError, Renderer, Scene, Stages, View, WantedImages};
use clap::Args;
use nalgebra::{Isometry3, Vector3};
use serde::Serialize;
use std::time::{Duration, Instant};

/// The options of `doctor`.
#[derive(Debug, Args)]
pub(super) struct Options {
    #[command(flatten)]
    form: FormatOption,
}

/// The findings about this machine.
#[derive(Debug, Serialize)]
struct Findings {
    version: &'static str,
    target: &'static str,
    threads: usize,
    /// The drivers that can be tested.
    drivers: Vec<&'static str>,
    adapter: Option<Described>,
    /// The reason why there is no adapter, or why the adapter cannot be used, and what to do.
    problem: Option<String>,
    speed: Vec<Speed>,
}

#[derive(Debug, Serialize)]
struct Described {
    name: String,
    kind: String,
    backend: String,
    driver: String,
    max_image: u32,
    max_layers: u32,
    max_buffer: u64,
}

/// The number of images that are drawn and read back in a second.
#[derive(Debug, Serialize)]
struct Speed {
    width: u32,
    height: u32,
    outputs: &'static str,
    frames_per_second: f64,
}

/// A size of images, and the outputs that are drawn.
struct Size {
    width: u32,
    height: u32,
    depth: bool,
    semantic: bool,
    shadows: bool,
    /// The outputs in words.
    outputs: &'static str,
}

impl From<Adapter> for Described {
    fn from(adapter: Adapter) -> Self {
        let Adapter { name, driver, backend, kind, max_image, max_layers, max_buffer } = adapter;
        Self { name, kind, backend, driver, max_image, max_layers, max_buffer }
    }
}

/// The usual sizes for training networks and for looking at images, with the outputs of each.
const SIZES: [Size; 3] = [
    Size { width: 128, height: 128, depth: true, semantic: true, shadows: false, outputs: "rgb, depth, semantic" },
    Size { width: 200, height: 66, depth: false, semantic: false, shadows: false, outputs: "rgb" },
    Size { width: 640, height: 480, depth: false, semantic: false, shadows: true, outputs: "rgb, shadows" },
];

/// The number of cameras that are drawn at once, and the time for measuring each size.
const BATCH: usize = 64;
const LONG_ENOUGH: Duration = Duration::from_millis(700);

impl Options {
    pub fn execute(&self) -> Result<Status, Failure> {
        let mut findings = Findings {
            version: env!("CARGO_PKG_VERSION"),
            target: paracosm_campaign::TARGET,
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            drivers: driver::ALL.iter().map(|driver| driver.name).collect(),
            adapter: None,
            problem: None,
            speed: Vec::new(),
        };
        match Renderer::new() {
            Err(error) => {
                findings.adapter = crate::render::adapter().ok().map(Described::from);
                findings.problem = Some(error.to_string());
            }
            Ok(mut renderer) => {
                findings.adapter = Some(renderer.adapter().clone().into());
                match speeds(&mut renderer)? {
                    Ok(speed) => findings.speed = speed,
                    Err(error) => findings.problem = Some(error.to_string()),
                }
            }
        }
        print(&match self.form.format {
            Format::Table => table(&findings),
            Format::Json => json(&findings),
        })?;
        Ok(Status::Nothing)
    }
}

fn table(findings: &Findings) -> String {
    let mut table = Table::default();
    table.heading(&format!("paracosm {} on {}", findings.version, findings.target));
    table.row("threads", &findings.threads.to_string());
    table.row("drivers", &findings.drivers.join(", "));
    match &findings.adapter {
        None => table.row("graphics adapter", "none; only cameras need an adapter"),
        Some(adapter) => {
            table.row("graphics adapter", &format!("{} ({})", adapter.name, adapter.kind));
            table.row("  driver", &format!("{}, by {}", adapter.driver, adapter.backend));
            let (image, layers, buffer) = (adapter.max_image, adapter.max_layers, adapter.max_buffer);
            let limits = format!("images of {image} pixels each way, {layers} at once, {} MB", buffer / 1_000_000);
            table.row("  limits", &limits);
        }
    }
    for speed in &findings.speed {
        let Speed { width, height, outputs, frames_per_second } = speed;
        table.row(&format!("  {width} x {height}"), &format!("{frames_per_second:.0} images/s ({outputs})"));
    }
    if let Some(problem) = &findings.problem {
        table.row("problem", problem);
    }
    table.finish()
}

/// Measures how fast the beginning of the pedestrian study is drawn.
fn speeds(renderer: &mut Renderer) -> Result<Result<Vec<Speed>, RenderError>, Failure> {
    let program = &crate::catalogue().find("pedestrian-crossing")?;
    let test = program.declare()?.nominal();
    let mut run = Run::new(program, &test, Setup::asking_every(0.1))?;
    run.advance();
    let pose = run.bodies()[0].pose;
    let pose = Isometry3::new(Vector3::new(pose.position.x, pose.position.y, 1.35), Vector3::z() * pose.heading);
    let scene = Stages::default().of(run.network(), Look::Flat).scene(&run);
    let mut measured = Vec::new();
    for Size { width, height, depth, semantic, shadows, outputs } in SIZES {
        let wanted = WantedImages { rgb: true, depth, semantic, shadows, ..WantedImages::default() };
        let camera = Camera::new(width, height, 24.0, 36.0)?;
        match speed(renderer, &scene, &camera, pose, wanted) {
            Ok(frames_per_second) => measured.push(Speed { width, height, outputs, frames_per_second }),
            Err(error) => return Ok(Err(error)),
        }
    }
    Ok(Ok(measured))
}

fn speed(
    renderer: &mut Renderer,
    scene: &Scene,
    camera: &Camera,
    pose: Isometry3<f64>,
    wanted: WantedImages,
) -> Result<f64, RenderError> {
    let view = View { without: Some(1), ..View::new(scene, camera, pose) };
    let views = [view; BATCH];
    // The first batch loads meshes to the adapter and compiles its programs.
    renderer.render(&views[..1], wanted)?;
    let begin = Instant::now();
    let mut drawn = 0;
    while drawn == 0 || begin.elapsed() < LONG_ENOUGH {
        drawn += renderer.render(&views, wanted)?.len();
    }
    Ok(drawn as f64 / begin.elapsed().as_secs_f64())
}
