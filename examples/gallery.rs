//! Draws every kind of object from three sides, and some scenarios from the driver's eye, as PNG files in a folder:
//!
//! ```text
//! cargo run --release --example gallery -- FOLDER
//! ```

use nalgebra::{Isometry3, Point3, Vector3};
use paracosm::engine::object::{Body, BodyState, Class};
use paracosm::engine::road::{CrossIntersection, RoadNetwork, RoadSegment, Roundabout};
use paracosm::engine::{Pose, Run, Setup, driver};
use paracosm::render::{Atmosphere, Camera, Frame, Look, Renderer, Scene, Stage, Stages, View, WantedImages};
use paracosm::space::Values;
use std::error::Error;
use std::fs::File;
use std::path::{Path, PathBuf};

/// The width of a sensor in millimetres, and the focal lengths of a camera that looks at one thing and of a camera in a
/// car.
const SENSOR: f64 = 36.0;
const PORTRAIT: f64 = 50.0;
const WIDE: f64 = 24.0;
/// The scenarios, each with the time in seconds at which it is drawn.
const SCENARIOS: [(&str, f64); 6] = [
    ("pedestrian-crossing", 5.0),
    ("follow-leader", 3.0),
    ("t-loop", 2.0),
    ("grid-traffic", 6.0),
    ("roundabout-entry", 5.0),
    ("highway-traffic", 3.0),
];

struct Gallery {
    folder: PathBuf,
    renderer: Renderer,
}

impl Gallery {
    fn draw(&mut self, name: &str, scene: &Scene, camera: &Camera, pose: Isometry3<f64>) -> Result<(), Box<dyn Error>> {
        let head_lamps = (scene.air.light < 0.5).then(|| Point3::new(2.2, 0.0, 0.6));
        let view = View { head_lamps, ..View::new(scene, camera, pose) };
        let wanted = WantedImages { rgb: true, shadows: true, ..WantedImages::default() };
        let frame = self.renderer.render(&[view], wanted)?.pop().expect("one view, one frame")?;
        write(&self.folder.join(format!("{name}.png")), &frame)
    }

    /// Draws things on a road from three sides, `far` metres away.
    fn portrait(&mut self, name: &str, bodies: &[BodyState], far: f64) -> Result<(), Box<dyn Error>> {
        let network = RoadSegment::new(200.0).build()?;
        let scene = Stage::of(&network).scene_of(bodies.iter().enumerate(), Atmosphere::default());
        let triangles: usize = scene.instances.iter().map(|instance| instance.mesh.indices().len() / 3).sum();
        let ground: usize = Stage::of(&network)
            .scene_of([], Atmosphere::default())
            .instances
            .iter()
            .map(|instance| instance.mesh.indices().len() / 3)
            .sum();
        println!("{name}: {} triangles", triangles - ground);
        let camera = Camera::new(480, 360, PORTRAIT, SENSOR)?;
        let middle = Point3::new(100.0, 0.0, 0.5 * bodies[0].body.height);
        for (side, (x, y, up)) in
            [("front", (0.8, 0.6, 0.35)), ("rear", (-0.8, -0.6, 0.35)), ("side", (0.0, -1.0, 0.1))]
        {
            let eye = middle + Vector3::new(x, y, up) * far;
            self.draw(&format!("{name}-{side}"), &scene, &camera, looking(eye, middle))?;
        }
        Ok(())
    }

    /// Draws an empty network from a place above it.
    fn roads(&mut self, name: &str, network: &RoadNetwork) -> Result<(), Box<dyn Error>> {
        let scene = Stage::of(network).scene_of([], Atmosphere::default());
        let camera = Camera::new(800, 450, WIDE, SENSOR)?;
        self.draw(name, &scene, &camera, looking(Point3::new(-32.0, -20.0, 16.0), Point3::origin()))
    }

    /// Draws a scenario as its car sees it, with the scenario's own weather if `air` is `None`.
    fn scenario(
        &mut self,
        stages: &Stages,
        name: &str,
        at: f64,
        air: Option<Atmosphere>,
    ) -> Result<(), Box<dyn Error>> {
        let program = paracosm::scenarios::find(name).ok_or("the catalogue has no scenario of this name")?;
        let test: Values = program.declare()?.nominal();
        let mut run = Run::new(program, &test, Setup::asking_every(0.1))?;
        let stage = stages.of(run.network(), Look::Flat);
        let mut driver = driver::find("cruise")?.build(&[])?;
        let mut seen = None;
        run.watch(driver.as_mut(), |run| {
            if run.time() <= at {
                seen = Some((stage.scene(run), run.bodies()[0].pose));
            }
        });
        let (mut scene, pose) = seen.ok_or("the run was over before it began")?;
        scene.instances.retain(|instance| instance.id != 1);
        scene.air = air.unwrap_or(scene.air);
        let camera = Camera::new(800, 400, WIDE, SENSOR)?.mounted(Point3::new(0.3, 0.0, 1.35), 0.0, 0.03, 0.0)?;
        let weather = if air.is_some() { "-in-fog-at-dusk" } else { "" };
        self.draw(&format!("scenario-{name}{weather}"), &scene, &camera, carrier(&pose))
    }
}

/// Returns the pose of a camera at `eye` that looks at `target`.
fn looking(eye: Point3<f64>, target: Point3<f64>) -> Isometry3<f64> {
    let way = target - eye;
    let (yaw, pitch) = (libm::atan2(way.y, way.x), -libm::atan2(way.z, way.xy().norm()));
    Isometry3::from_parts(eye.into(), nalgebra::UnitQuaternion::from_euler_angles(0.0, pitch, yaw))
}

fn carrier(pose: &Pose) -> Isometry3<f64> {
    Isometry3::new(Vector3::new(pose.position.x, pose.position.y, 0.0), Vector3::z() * pose.heading)
}

fn write(path: &Path, frame: &Frame) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(File::create(path)?, frame.width(), frame.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(frame.rgb.as_deref().ok_or("the frame has no colours")?)?;
    Ok(())
}

fn standing(body: Body, y: f64) -> BodyState {
    let pose = Pose { position: [100.0, y].into(), heading: 0.0 };
    BodyState { body, pose, velocity: [0.0, 0.0].into(), altitude: 0.0, travelled: 0.0, present: true }
}

/// Returns a person on the way, at a speed in m/s.
fn walking(body: Body, y: f64, speed: f64, travelled: f64) -> BodyState {
    BodyState { velocity: [speed, 0.0].into(), travelled, ..standing(body, y) }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder: PathBuf = std::env::args().nth(1).ok_or("usage: gallery FOLDER")?.into();
    std::fs::create_dir_all(&folder)?;
    let mut gallery = Gallery { folder, renderer: Renderer::new()? };
    let sign = |y: f64, height: f64| standing(Body::disc(Class::Sign, 0.05, height), y);
    let tree = |y: f64, height: f64| standing(Body::disc(Class::Tree, 0.3, height), y);
    let people = [
        walking(Body::adult(), 0.0, 1.4, 0.35),
        walking(Body::child(), 1.0, 1.2, 0.2),
        walking(Body::adult().coloured([190, 60, 40]), -1.0, 4.5, 0.6),
        standing(Body::adult().coloured([60, 110, 60]), 2.0),
    ];
    let props = [
        standing(Body::disc(Class::Prop, 0.4, 1.3), 0.0),
        standing(Body::disc(Class::Prop, 0.2, 0.7), 1.0),
        standing(Body::disc(Class::Prop, 0.3, 0.6), 1.9),
        standing(Body::block(Class::Prop, 0.6, 0.8, 0.6), -1.2),
        standing(Body::block(Class::Prop, 0.5, 2.0, 1.0), -3.0),
    ];
    let portraits: [(&str, &[BodyState], f64); 13] = [
        ("car", &[standing(Body::car().coloured([170, 30, 30]), 0.0)], 8.0),
        ("truck", &[standing(Body::truck(), 0.0)], 17.0),
        ("van", &[standing(Body::van(), 0.0)], 11.0),
        ("bus", &[standing(Body::bus(), 0.0)], 20.0),
        ("motorcycle", &[standing(Body::motorcycle().coloured([30, 60, 150]), 0.0)], 4.0),
        ("bicycle", &[standing(Body::bicycle().coloured([20, 120, 60]), 0.0)], 4.0),
        ("pedestrian", &[standing(Body::adult(), 0.0)], 4.0),
        ("people", &people, 7.0),
        ("house", &[standing(Body::block(Class::Building, 10.0, 8.0, 7.0), 0.0)], 24.0),
        ("flats", &[standing(Body::block(Class::Building, 24.0, 14.0, 21.0), 0.0)], 60.0),
        ("trees", &[tree(-1.0, 6.0), tree(4.0, 7.0), tree(-6.0, 7.0)], 20.0),
        (
            "signs",
            &[sign(0.0, 2.5), sign(0.9, 2.5), sign(1.7, 2.5), sign(-0.9, 2.5), sign(-1.8, 2.5), sign(-2.6, 5.0)],
            9.0,
        ),
        ("props", &props, 7.0),
    ];
    for (name, bodies, far) in portraits {
        gallery.portrait(name, bodies, far)?;
    }
    gallery.roads("roads-cross", &*CrossIntersection::new().lanes(4).build()?)?;
    gallery.roads("roads-roundabout", &*Roundabout::new().build()?)?;
    let stages = Stages::default();
    for (name, at) in SCENARIOS {
        gallery.scenario(&stages, name, at, None)?;
    }
    let dusk = Atmosphere { light: 0.25, sun_elevation: 0.05, sun_azimuth: 2.3, extinction: 0.012 };
    gallery.scenario(&stages, "highway-traffic", 3.0, Some(dusk))
}
