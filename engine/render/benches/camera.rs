//! Frames per second of a street with a pedestrian crossing, 64 cameras a batch, each in a world of its own. Divan's items per
//! second are the figures. They are the adapter's: on the processor, of as many cores as there are.

#[path = "../tests/support/mod.rs"]
mod support;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use nalgebra::Isometry3;
use paracosm_render::{Camera, Outputs, Renderer, Scene, View};
use support::{camera, renderer, street};

const BATCH: usize = 64;

fn main() {
    if let Ok(adapter) = paracosm_render::adapter() {
        eprintln!("{} ({}, {})", adapter.name, adapter.kind, adapter.driver);
    }
    divan::main();
}

/// 128 x 128, RGB with depth and classes.
#[divan::bench(sample_count = 20)]
fn rgb_depth_semantic(bencher: Bencher) {
    batches(bencher, &camera(128, 128), Outputs { rgb: true, depth: true, semantic: true, ..Outputs::default() });
}

/// 200 x 66, RGB.
#[divan::bench(sample_count = 20)]
fn rgb(bencher: Bencher) {
    batches(bencher, &camera(200, 66), Outputs { rgb: true, ..Outputs::default() });
}

/// 200 x 66, RGB with shadows: what drivers that see are shown.
#[divan::bench(sample_count = 20)]
fn rgb_shadows_small(bencher: Bencher) {
    batches(bencher, &camera(200, 66), Outputs { rgb: true, shadows: true, ..Outputs::default() });
}

/// 640 x 480, RGB with shadows.
#[divan::bench(sample_count = 5)]
fn rgb_shadows(bencher: Bencher) {
    batches(bencher, &camera(640, 480), Outputs { rgb: true, shadows: true, ..Outputs::default() });
}

fn batches(bencher: Bencher, camera: &Camera, wanted: Outputs) {
    let Some(mut renderer) = renderer() else { return };
    let scenes: Vec<Scene> = (0..BATCH).map(|_| street()).collect();
    bencher.counter(ItemsCount::new(BATCH)).bench_local(|| draw(&mut renderer, &scenes, camera, wanted));
}

fn draw(renderer: &mut Renderer, scenes: &[Scene], camera: &Camera, wanted: Outputs) {
    let place = |index| Isometry3::translation(0.1 * index as f64, -1.7, 0.0);
    let view = |(index, scene)| View::new(scene, camera, place(index));
    let views: Vec<_> = scenes.iter().enumerate().map(view).collect();
    for frame in renderer.render(&views, wanted).expect("the adapter works") {
        black_box(frame.expect("the view is sound"));
    }
}
