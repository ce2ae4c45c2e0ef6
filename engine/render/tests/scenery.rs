//! The scenery that the look `textured` adds to pictures. UPDATE_GOLDEN=1 writes the image; look at what changed.

mod support;

use nalgebra::{Isometry3, Point3, Vector2, Vector3};
use paracosm_engine::road::{CrossIntersection, RoadNetwork, RoadSegment, grid_city};
use paracosm_engine::sensor::Moment;
use paracosm_engine::{AutonomousVehicle, Environment, Fixture, Pedestrian, Program, Run, Scenario, Setup, Side};
use paracosm_render::{
    Camera, Cast, Instance, Look, Scene, Semantic, Stage, SurfaceKind, View, WantedImages, is_only_pictured,
};
use paracosm_space::Values;
use std::sync::{Arc, LazyLock};
use support::golden::compare;
use support::{NOTHING, one, renderer};

static CITY: LazyLock<Arc<RoadNetwork>> = LazyLock::new(|| grid_city(3, 3, 90.0, 2).build().expect("a sound city"));

fn city(s: &mut Scenario) {
    s.nominal("number", 0.0..=9.0, 0.0);
    let fog = s.nominal("fog", 0.0..=1.0, 0.0).atmospheric().incidental();
    let streets = s.place(CITY.clone());
    let way = streets.way(("street 0,0 east", 1, 20.0), ("street 1,1 south", 1, 40.0));
    s.place(AutonomousVehicle::along(way).speed(8.0));
    s.place(Environment::new().fog(fog));
}

fn highway(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(600.0).lanes(6));
    s.place(AutonomousVehicle::at(road.on_lane(1, 20.0)).speed(30.0));
}

fn street(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(300.0).zebra(200.0));
    s.place(AutonomousVehicle::at(road.on_lane(1, 20.0)).speed(10.0));
    s.place(Pedestrian::at(road.on_sidewalk(Side::Right, 100.0)));
    s.place(Fixture::tree(road.on_sidewalk(Side::Left, 60.0)));
}

/// A run of a world that begins, with a value that changes nothing in it.
fn run(world: fn(&mut Scenario), number: f64) -> Run {
    let program = Program::new("world", "a world", world);
    let mut test: Values = program.declare().expect("a sound program").nominal();
    if number > 0.0 {
        test.set("number", number);
    }
    run_of(&program, &test)
}

fn run_of(program: &Program, test: &Values) -> Run {
    Run::new(program, test, Setup::asking_every(0.1)).expect("a sound world")
}

fn dressed(run: &Run, look: Look) -> Stage {
    Stage::in_look(run.network(), look).dressed(run)
}

/// The scene of a run, and the instances that the look adds to it.
fn added(run: &Run) -> (Scene, Vec<Instance>) {
    let scene = dressed(run, Look::Textured).scene(run);
    let bare = Stage::in_look(run.network(), Look::Textured).scene(run).instances.len();
    // The ground is made anew for each stage, and comes first, so that only the rest is the same.
    let more = scene.instances[bare..].to_vec();
    (scene, more)
}

fn count(instances: &[Instance], class: Semantic) -> usize {
    let is_meant = |instance: &&Instance| instance.mesh.vertices().iter().any(|vertex| vertex.semantic == class);
    instances.iter().filter(is_meant).count()
}

fn place(instance: &Instance) -> Vector2<f64> {
    instance.pose.translation.vector.xy().cast()
}

#[test]
fn a_town_has_houses_trees_and_parked_cars_and_a_highway_has_guard_rails_and_no_houses() {
    let (_, town) = added(&run(city, 0.0));
    for class in [Semantic::Building, Semantic::Vegetation, Semantic::Car, Semantic::Pole] {
        assert!(count(&town, class) > 10, "{class:?}: {}", count(&town, class));
    }
    assert_eq!(count(&town, Semantic::GuardRail), 0);
    let (_, rural) = added(&run(highway, 0.0));
    for class in [Semantic::GuardRail, Semantic::Vegetation, Semantic::Pole] {
        assert!(count(&rural, class) > 4, "{class:?}: {}", count(&rural, class));
    }
    assert_eq!(count(&rural, Semantic::Building) + count(&rural, Semantic::Car), 0);
}

#[test]
fn fog_leaves_the_scenery_as_it_is_and_another_value_does_not() {
    let program = Program::new("world", "a world", city);
    let clear = program.declare().expect("a sound program").nominal();
    let things = |name: &str, value: f64| {
        let mut test = clear.clone();
        test.set(name, value);
        added(&run_of(&program, &test)).1.iter().map(place).collect::<Vec<_>>()
    };
    assert_eq!(things("fog", 0.5), things("fog", 0.0));
    assert_ne!(things("number", 3.0), things("number", 0.0));
}

#[test]
fn the_look_flat_has_no_scenery_of_its_own() {
    let run = run(city, 0.0);
    let bare = Stage::of(run.network()).scene(&run).instances.len();
    assert_eq!(dressed(&run, Look::Flat).scene(&run).instances.len(), bare);
}

#[test]
fn parked_cars_have_ids_of_their_own_stand_off_the_lanes_and_nothing_else_has_an_id() {
    let run = run(city, 0.0);
    let (_, town) = added(&run);
    let mut ids: Vec<u16> = town.iter().map(|instance| instance.id).filter(|id| *id != 0).collect();
    let all = ids.len();
    assert!(ids.iter().all(|id| is_only_pictured(*id)) && !is_only_pictured(run.bodies().len() as u16));
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all, "an id for each");
    for car in town.iter().filter(|instance| instance.id != 0) {
        assert_eq!(count(std::slice::from_ref(car), Semantic::Car), 1);
        for corner in [[2.25, 0.9], [2.25, -0.9], [-2.25, 0.9], [-2.25, -0.9]] {
            let corner = car.pose * Point3::new(corner[0], corner[1], 0.0);
            let corner = Vector2::new(f64::from(corner.x), f64::from(corner.y));
            for lane in run.network().lanes() {
                let off = (lane.curve.point(lane.curve.nearest(corner)) - corner).norm();
                assert!(off > 0.5 * lane.width, "a car is {off} m from the middle of a lane");
            }
        }
    }
}

#[test]
fn scenery_keeps_clear_of_people_who_may_cross_and_of_what_stands_there() {
    let run = run(street, 0.0);
    let (_, things) = added(&run);
    for state in &run.bodies()[1..] {
        let least = if state.body.class.is_road_user() { 4.0 } else { 0.3 };
        // The paving of bays is one mesh for the whole world.
        let solid = things.iter().filter(|instance| count(std::slice::from_ref(instance), Semantic::Ground) == 0);
        let near = solid.map(|instance| (place(instance) - state.pose.position).norm()).fold(f64::INFINITY, f64::min);
        assert!(near > least, "{near} m from a {}", state.body.class);
    }
    let zebra = Vector2::new(200.0, 0.0);
    let parked = things.iter().filter(|instance| instance.id != 0);
    assert!(parked.clone().count() > 3);
    assert!(parked.into_iter().all(|car| (place(car) - zebra).x.abs() > 7.0), "a car hides the crossing");
}

#[test]
fn a_thing_is_not_drawn_while_a_body_is_in_its_place() {
    let run = run(street, 0.0);
    let (_, things) = added(&run);
    let car = things.iter().find(|instance| instance.id != 0).expect("a parked car");
    let mut moment = Moment::default();
    moment.record(&run.view());
    let stage = dressed(&run, Look::Textured);
    let drawn =
        |moment: &Moment| stage.scene_at(&Cast::new(), moment).instances.iter().any(|instance| instance.id == car.id);
    assert!(drawn(&moment));
    moment.bodies[0].pose.position = place(car);
    assert!(!drawn(&moment));
}

#[test]
fn the_scenery_follows_from_the_values_of_the_test() {
    let places = |number: f64| added(&run(city, number)).1.iter().map(|instance| instance.pose).collect::<Vec<_>>();
    assert_eq!(places(3.0), places(3.0));
    assert_ne!(places(3.0), places(4.0));
}

#[test]
fn a_traffic_light_has_one_lit_lamp_and_changes_with_the_time_of_the_run() {
    let run = run(city, 0.0);
    let stage = dressed(&run, Look::Textured);
    let mut moment = Moment::default();
    moment.record(&run.view());
    let mut shown = |time: f64| {
        moment.time = time;
        let scene = stage.scene_at(&Cast::new(), &moment);
        let of_light = |instance: &Instance| {
            let vertices = instance.mesh.vertices();
            vertices.iter().any(|vertex| vertex.semantic == Semantic::TrafficLight).then(|| {
                let mut lit: Vec<[u32; 3]> = vertices
                    .iter()
                    .filter(|vertex| vertex.surface == SurfaceKind::Glow)
                    .map(|vertex| vertex.colour.map(f32::to_bits))
                    .collect();
                lit.dedup();
                assert_eq!(lit.len(), 1, "one lamp is lit");
                lit[0]
            })
        };
        scene.instances.iter().filter_map(of_light).collect::<Vec<_>>()
    };
    let begin = shown(0.0);
    assert!(begin.len() >= 4, "{} lights", begin.len());
    let mut colours: Vec<[u32; 3]> = (0..32).flat_map(|second| shown(f64::from(second))).collect();
    colours.sort_unstable();
    colours.dedup();
    assert_eq!(colours.len(), 3, "green, amber and red");
    assert_eq!(shown(32.0), begin, "a cycle takes 32 s");
}

#[test]
fn a_street_of_a_town_in_the_look_textured() {
    let Some(mut renderer) = renderer() else { return };
    let run = run(city, 0.0);
    let scene = dressed(&run, Look::Textured).scene(&run);
    let camera = Camera::new(320, 160, 24.0, 36.0).expect("a sound camera");
    let camera = camera.mounted(Point3::new(0.3, 0.0, 1.4), 0.0, 0.0, 0.0).expect("a sound place");
    let car = run.bodies()[0].pose;
    let pose = Isometry3::new(car.position.push(0.0), Vector3::z() * car.heading);
    let view = View { without: Some(1), ..View::new(&scene, &camera, pose) };
    let frame = one(&mut renderer, &view, WantedImages { rgb: true, shadows: true, ..NOTHING });
    compare("scenery", 320, frame.rgb.as_deref().expect("asked for"));
}

#[test]
fn an_intersection_of_wide_roads_has_no_houses() {
    fn wide(s: &mut Scenario) {
        let arm = |name: &str| RoadSegment::new(200.0).lanes(6).named(name);
        let cross = CrossIntersection::new().lanes(6);
        let streets = s.place(cross.connect("one", arm("east"), "one").connect("three", arm("west"), "one"));
        s.place(AutonomousVehicle::along(streets.way(("west", -1, 150.0), ("east", 1, 100.0))).speed(10.0));
    }
    let (_, things) = added(&run(wide, 0.0));
    assert_eq!(count(&things, Semantic::Building), 0);
    assert!(count(&things, Semantic::GuardRail) > 0);
}
