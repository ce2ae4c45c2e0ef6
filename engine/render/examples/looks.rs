//! Draws the same streets in every look, as PNG files in a folder, and prints how fast each look is drawn:
//!
//! ```text
//! cargo run --release -p paracosm-render --example looks -- FOLDER
//! ```

use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_engine::object::{Body, BodyState, Class};
use paracosm_engine::road::{Composite, CrossIntersection};
use paracosm_engine::sensor::Moment;
use paracosm_engine::{
    AutonomousVehicle, Environment, Pose, Program, RoadSegment, Roadside, Run, Scenario, Setup, Weather,
};
use paracosm_render::{Atmosphere, Camera, Cast, Look, Renderer, Scene, Stage, View, WantedImages};
use std::error::Error;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The number of images in a batch, and the number of batches for each measurement.
const BATCH: usize = 64;
const ROUNDS: usize = 9;
const COLOURS: WantedImages = WantedImages {
    rgb: true,
    shadows: true,
    linear: false,
    depth: false,
    semantic: false,
    instance: false,
    alone: false,
};

fn street(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(300.0).zebra(60.0));
    s.place(AutonomousVehicle::at(road.on_lane(1, 20.0)).speed(10.0));
    s.place(Environment::new());
    s.place(Roadside::new(1.0));
}

/// Returns the bodies of a street: traffic in both directions, and people, before a car at x = 20.
fn bodies(run: &Run) -> Vec<BodyState> {
    let mut bodies = run.bodies().to_vec();
    let own = bodies[0].pose;
    let mut add = |body: Body, ahead: f64, left: f64, turned: f64, speed: f64| {
        let position = own.position + nalgebra::Vector2::new(ahead, left);
        let velocity = nalgebra::Vector2::new(libm::cos(turned), libm::sin(turned)) * speed;
        let pose = Pose { position, heading: turned };
        bodies.push(BodyState { body, pose, velocity, altitude: 0.0, travelled: ahead, present: true });
    };
    let back = std::f64::consts::PI;
    for (number, ahead) in [11.0, 19.0, 30.0, 45.0, 70.0, 100.0].into_iter().enumerate() {
        add(Body::car(), ahead, 0.0, 0.0, 8.0);
        add(Body::car(), ahead + 4.0 + number as f64, 3.5, back, 8.0);
    }
    add(Body::van(), 58.0, 0.0, 0.0, 8.0);
    add(Body::truck(), 85.0, 0.0, 0.0, 8.0);
    for number in 0..8 {
        let (ahead, side) = (9.0 + 4.3 * f64::from(number), if number % 2 == 0 { -3.2 } else { 6.8 });
        let body = if number == 5 { Body::child() } else { Body::adult() };
        add(body, ahead, side, if number % 3 == 0 { 0.0 } else { back }, 1.3);
    }
    add(Body::adult(), 24.0, -0.5, 1.57, 1.4);
    bodies
}

fn camera(width: u32, height: u32) -> Result<Camera, Box<dyn Error>> {
    Ok(Camera::new(width, height, 24.0, 36.0)?.mounted(Point3::new(0.3, 0.0, 1.4), 0.0, 0.02, 0.0)?)
}

/// Returns the moment of the given bodies, of which every third brakes.
fn moment(bodies: &[BodyState]) -> Moment {
    let accelerations = (0..bodies.len()).map(|index| if index % 3 == 0 { -2.0 } else { 0.0 }).collect();
    Moment { bodies: bodies.to_vec(), accelerations, weather: Weather::default(), ..Moment::default() }
}

fn carrier(pose: &Pose) -> Isometry3<f64> {
    Isometry3::new(pose.position.push(0.0), Vector3::z() * pose.heading)
}

fn write(path: &Path, [width, height]: [u32; 2], rgb: &[u8]) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(File::create(path)?, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(rgb)?;
    Ok(())
}

/// A crossing of wide roads, and the same of narrow ones, with a car that comes to it from the west.
fn crossing(s: &mut Scenario) {
    let lanes = s.choice("lanes", [2, 4, 6]).default(6).value();
    let arm = |name: &str| RoadSegment::new(150.0).lanes(lanes).named(name);
    let cross = CrossIntersection::new().lanes(lanes);
    let arms = [("one", "east"), ("two", "south"), ("three", "west"), ("four", "north")];
    let cross = arms.into_iter().fold(Composite::from(cross.named("cross")), |all, (port, name)| {
        all.connect(&format!("cross.{port}"), arm(name), "one")
    });
    let streets = s.place(cross);
    s.place(AutonomousVehicle::along(streets.way(("west", -1, 45.0), ("east", 1, 60.0))).speed(10.0));
    s.place(Environment::new());
}

/// Draws a crossing as a car sees it that comes to it.
fn draw_crossing(renderer: &mut Renderer, file: &Path, lanes: f64) -> Result<(), Box<dyn Error>> {
    let program = Program::new("crossing", "a crossing", crossing);
    let mut test = program.declare()?.nominal();
    test.set("lanes", lanes);
    let run = Run::new(&program, &test, Setup::asking_every(0.1))?;
    let scene = Stage::in_look(run.network(), Look::Textured).dressed(&run).scene(&run);
    let view = camera(1280, 720)?;
    let view = View { without: Some(1), ..View::new(&scene, &view, carrier(&run.bodies()[0].pose)) };
    let frame = renderer.render(&[view], COLOURS)?.remove(0)?;
    write(file, [1280, 720], &frame.rgb.ok_or("the frame has no colours")?)
}

/// The columns and rows of a sheet of portraits, and the width and the height of a portrait in pixels.
const SHEET: [usize; 2] = [4, 5];
const PORTRAIT: [usize; 2] = [320, 200];

/// Draws as many bodies with different ids as fit on a sheet, each alone and from a distance, partly from behind.
fn portraits(renderer: &mut Renderer, file: &Path, body: Body, far: f64) -> Result<(), Box<dyn Error>> {
    let stage = Stage::in_look(&*RoadSegment::new(400.0).build()?, Look::Textured);
    let camera = Camera::new(PORTRAIT[0] as u32, PORTRAIT[1] as u32, 50.0, 36.0)?;
    let standing = |number: usize| {
        // What signs show depends on their place.
        let pose = Pose { position: [100.0 + number as f64, 0.0].into(), heading: 0.0 };
        let travelled = 0.31 * number as f64;
        BodyState { body, pose, velocity: [1.2, 0.0].into(), altitude: 0.0, travelled, present: true }
    };
    let mut sheet = Vec::new();
    for row in 0..SHEET[1] {
        let mut images = Vec::new();
        for number in SHEET[0] * row..SHEET[0] * (row + 1) {
            let scene = stage.scene_of([(number, &standing(number))], Atmosphere::default());
            let share = if body.class == Class::Sign { 0.85 } else { 0.5 };
            let middle = Point3::from(standing(number).pose.position.push(share * body.height));
            let (x, y) = if number % 3 == 2 && body.class != Class::Sign { (-0.75, -0.66) } else { (0.75, -0.66) };
            let eye = middle + Vector3::new(x, y, 0.16) * far;
            let turn = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.16, libm::atan2(-y, -x));
            let view = View::new(&scene, &camera, Isometry3::from_parts(eye.into(), turn));
            images.push(renderer.render(&[view], COLOURS)?.remove(0)?.rgb.ok_or("the frame has no colours")?);
        }
        for line in 0..PORTRAIT[1] {
            let line = 3 * PORTRAIT[0] * line..3 * PORTRAIT[0] * (line + 1);
            images.iter().for_each(|image| sheet.extend_from_slice(&image[line.clone()]));
        }
    }
    write(file, [SHEET[0] * PORTRAIT[0], SHEET[1] * PORTRAIT[1]].map(|pixels| pixels as u32), &sheet)
}

/// Returns the seconds that a batch of images takes.
fn seconds(renderer: &mut Renderer, scene: &Scene, start: &Pose, wanted: WantedImages) -> Result<f64, Box<dyn Error>> {
    let camera = camera(200, 66)?;
    let poses: Vec<_> =
        (0..BATCH).map(|i| carrier(start) * Isometry3::translation(0.05 * i as f64, 0.0, 0.0)).collect();
    let views: Vec<_> =
        poses.iter().map(|pose| View { without: Some(1), ..View::new(scene, &camera, *pose) }).collect();
    let begin = Instant::now();
    renderer.render(&views, wanted)?;
    Ok(begin.elapsed().as_secs_f64())
}

/// Prints how fast the looks draw the same bodies on the same road.
fn measure(
    renderer: &mut Renderer,
    name: &str,
    run: &Run,
    bodies: &[BodyState],
    wanted: WantedImages,
) -> Result<(), Box<dyn Error>> {
    let stage = |look: Look| Stage::in_look(run.network(), look).dressed(run);
    let scene = |look: Look| stage(look).scene_at(&Cast::new(), &moment(bodies));
    let scenes = Look::ALL.map(scene);
    // The looks take turns, so that a slow moment of the machine meets them all.
    let mut times = Look::ALL.map(|_| Vec::new());
    for _ in 0..ROUNDS {
        for (scene, times) in scenes.iter().zip(&mut times) {
            times.push(seconds(renderer, scene, &bodies[0].pose, wanted)?);
        }
    }
    let [flat, textured] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    let speed = |seconds: f64| BATCH as f64 / seconds;
    println!(
        "{name}: {:.0} flat and {:.0} textured images of 200 x 66 pixels a second, a ratio of {:.2}",
        speed(flat),
        speed(textured),
        flat / textured
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder: PathBuf = std::env::args().nth(1).ok_or("usage: looks FOLDER")?.into();
    std::fs::create_dir_all(&folder)?;
    let mut renderer = Renderer::new()?;
    let program = Program::new("street", "a street with things beside it", street);
    let run = Run::new(&program, &program.declare()?.nominal(), Setup::asking_every(0.1))?;
    let bodies = bodies(&run);
    let own = bodies[0].pose;
    let low = Atmosphere { sun_elevation: 0.3, sun_azimuth: 0.9, ..Atmosphere::default() };
    for look in Look::ALL {
        let stage = Stage::in_look(run.network(), look).dressed(&run);
        for (weather, air) in [("", Atmosphere::default()), ("-low-sun", low)] {
            let scene = Scene { air, ..stage.scene_at(&Cast::new(), &moment(&bodies)) };
            for (width, height) in [(640, 480), (200, 66), (1280, 720)] {
                let camera = camera(width, height)?;
                let view = View { without: Some(1), ..View::new(&scene, &camera, carrier(&own)) };
                let frame = renderer.render(&[view], COLOURS)?.remove(0)?;
                let file = folder.join(format!("street-{look}{weather}-{width}x{height}.png"));
                write(&file, [width, height], &frame.rgb.ok_or("the frame has no colours")?)?;
            }
        }
    }
    for lanes in [2.0, 4.0, 6.0] {
        draw_crossing(&mut renderer, &folder.join(format!("crossing-{lanes}.png")), lanes)?;
    }
    portraits(&mut renderer, &folder.join("cars.png"), Body::car(), 7.5)?;
    portraits(&mut renderer, &folder.join("people.png"), Body::adult(), 4.5)?;
    portraits(&mut renderer, &folder.join("signs.png"), Body::disc(Class::Sign, 0.05, 2.5), 3.0)?;
    let traffic: Vec<_> = bodies.iter().filter(|state| state.body.class.is_road_user()).copied().collect();
    let few = &traffic[..4];
    let bare = WantedImages { shadows: false, ..COLOURS };
    for (shadows, wanted) in [("with shadows", COLOURS), ("without shadows", bare)] {
        measure(&mut renderer, &format!("a full street {shadows}"), &run, &bodies, wanted)?;
        measure(&mut renderer, &format!("four road users {shadows}"), &run, few, wanted)?;
    }
    Ok(())
}
