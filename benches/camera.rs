//! Measures how many frames a second cameras draw in `pedestrian-crossing`, with 64 cameras in a batch, each at another
//! moment of a test. Divan's items per second are the results. They depend on the adapter; if the processor draws, they
//! depend on its cores.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use nalgebra::{Isometry3, Point3, Vector3};
use paracosm::engine::{Run, Setup, driver};
use paracosm::render::{Camera, Look, Renderer, Scene, Stage, Stages, View, WantedImages};
use std::sync::Arc;

const BATCH: usize = 64;

fn main() {
    if let Ok(adapter) = paracosm::render::adapter() {
        eprintln!("{} ({}, {})", adapter.name, adapter.kind, adapter.driver);
    }
    divan::main();
}

/// Images of 128 x 128 pixels: RGB with depth and classes.
#[divan::bench(sample_count = 20)]
fn rgb_depth_semantic(bencher: Bencher) {
    batches(
        bencher,
        crossing(),
        &camera(128, 128),
        WantedImages { rgb: true, depth: true, semantic: true, ..WantedImages::default() },
    );
}

/// Images of 200 x 66 pixels: RGB.
#[divan::bench(sample_count = 20)]
fn rgb(bencher: Bencher) {
    batches(bencher, crossing(), &camera(200, 66), WantedImages { rgb: true, ..WantedImages::default() });
}

/// Images of 200 x 66 pixels: RGB with shadows, as shown to drivers with cameras.
#[divan::bench(sample_count = 20)]
fn rgb_shadows_small(bencher: Bencher) {
    batches(
        bencher,
        crossing(),
        &camera(200, 66),
        WantedImages { rgb: true, shadows: true, ..WantedImages::default() },
    );
}

/// Images of 200 x 66 pixels in each look: RGB with shadows, in a town and on a highway.
#[divan::bench(sample_count = 20, args = [("pedestrian-crossing", Look::Flat), ("pedestrian-crossing", Look::Textured),
    ("highway-traffic", Look::Flat), ("highway-traffic", Look::Textured)])]
fn looks(bencher: Bencher, (scenario, look): (&str, Look)) {
    let wanted = WantedImages { rgb: true, shadows: true, ..WantedImages::default() };
    batches(bencher, moments(scenario, look), &camera(200, 66), wanted);
}

/// The same images in the look `textured` without the scenery that this look adds: the same things as in the look `flat`.
#[divan::bench(sample_count = 20, args = ["pedestrian-crossing", "highway-traffic"])]
fn looks_without_scenery(bencher: Bencher, scenario: &str) {
    let wanted = WantedImages { rgb: true, shadows: true, ..WantedImages::default() };
    batches(
        bencher,
        moments_on(scenario, |run| Arc::new(Stage::in_look(run.network(), Look::Textured))),
        &camera(200, 66),
        wanted,
    );
}

/// Images of 640 x 480 pixels: RGB with shadows.
#[divan::bench(sample_count = 5)]
fn rgb_shadows(bencher: Bencher) {
    batches(
        bencher,
        crossing(),
        &camera(640, 480),
        WantedImages { rgb: true, shadows: true, ..WantedImages::default() },
    );
}

fn crossing() -> Vec<(Scene, Isometry3<f64>)> {
    moments("pedestrian-crossing", Look::Flat)
}

/// Returns the scenes in front of a camera behind the windscreen, with the poses of the car, three times a second.
fn moments(scenario: &str, look: Look) -> Vec<(Scene, Isometry3<f64>)> {
    moments_on(scenario, |run| Stages::default().of_run(run, look))
}

fn moments_on(scenario: &str, stage: impl Fn(&Run) -> Arc<Stage>) -> Vec<(Scene, Isometry3<f64>)> {
    let program = paracosm::scenarios::find(scenario).expect("it is in the catalogue");
    let test = program.declare().expect("it is sound").nominal();
    let mut run = Run::new(program, &test, Setup::asking_every(0.1)).expect("its nominal test is sound");
    let stage = stage(&run);
    let mut driver = driver::find("aeb").and_then(|driver| driver.build(&[])).expect("it is in the catalogue");
    let mut moments = Vec::new();
    run.watch(driver.as_mut(), |run| {
        if moments.len() < BATCH && run.time() >= moments.len() as f64 / 3.0 {
            let mut scene = stage.scene(run);
            scene.instances.retain(|instance| instance.id != 1);
            let pose = run.bodies()[0].pose;
            let place = Vector3::new(pose.position.x, pose.position.y, 0.0);
            moments.push((scene, Isometry3::new(place, Vector3::z() * pose.heading)));
        }
    });
    moments
}

fn camera(width: u32, height: u32) -> Camera {
    let camera = Camera::new(width, height, 24.0, 36.0).expect("a sound camera");
    camera.mounted(Point3::new(0.3, 0.0, 1.35), 0.0, 0.03, 0.0).expect("a sound place")
}

fn batches(bencher: Bencher, moments: Vec<(Scene, Isometry3<f64>)>, camera: &Camera, wanted: WantedImages) {
    let mut renderer = Renderer::new().expect("there is an adapter");
    assert_eq!(moments.len(), BATCH);
    bencher.counter(ItemsCount::new(BATCH)).bench_local(|| draw(&mut renderer, &moments, camera, wanted));
}

fn draw(renderer: &mut Renderer, moments: &[(Scene, Isometry3<f64>)], camera: &Camera, wanted: WantedImages) {
    let views: Vec<_> = moments.iter().map(|(scene, pose)| View::new(scene, camera, *pose)).collect();
    for frame in renderer.render(&views, wanted).expect("the adapter works") {
        black_box(frame.expect("the view is sound"));
    }
}
