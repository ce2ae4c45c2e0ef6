//! Stages as users set them: the ground of networks, the figures of bodies, and the air of weathers.

use nalgebra::{Point3, Vector2, Vector3};
use paracosm_engine::object::{Body, BodyState, Class};
use paracosm_engine::road::{
    CrossIntersection, RoadNetwork, RoadSegment, Roundabout, Strip, Surface, TIntersection, grid_city,
};
use paracosm_engine::{
    AutonomousVehicle, Environment, Pedestrian, Pose, Program, Run, Scenario, Setup, Side, Stream, Weather, driver,
    eventually, never,
};
use paracosm_render::{Atmosphere, Instance, Look, Mesh, Scene, Semantic, Stage, Stages, Vertex};
use paracosm_space::Values;
use std::sync::Arc;

fn standing(body: Body, x: f64, y: f64, heading: f64) -> BodyState {
    let pose = Pose { position: Vector2::new(x, y), heading };
    BodyState { body, pose, velocity: Vector2::zeros(), altitude: 0.0, travelled: 0.0, present: true }
}

fn road() -> Arc<RoadNetwork> {
    RoadSegment::new(100.0).zebra(50.0).build().unwrap()
}

fn scene(bodies: &[BodyState]) -> Scene {
    Stage::of(&road()).scene_of(bodies.iter().enumerate(), Atmosphere::default())
}

/// The corners of what belongs to a body, as seen from its pose.
fn corners(scene: &Scene, index: usize, pose: &Pose) -> Vec<Point3<f32>> {
    let own = scene.instances.iter().filter(|instance| usize::from(instance.id) == index + 1);
    let corner = |(instance, vertex): (&Instance, &Vertex)| {
        let point =
            instance.pose * Point3::from(Vector3::from(vertex.position).component_mul(&Vector3::from(instance.scale)));
        let seen = pose.to_local(Vector2::new(f64::from(point.x), f64::from(point.y)));
        Point3::new(seen.x as f32, seen.y as f32, point.z)
    };
    own.flat_map(|instance| instance.mesh.vertices().iter().map(move |vertex| corner((instance, vertex)))).collect()
}

fn bounds(corners: &[Point3<f32>]) -> [Point3<f32>; 2] {
    let all = |pick: fn(f32, f32) -> f32| {
        corners.iter().copied().reduce(|a, b| Point3::from(a.coords.zip_map(&b.coords, pick))).expect("it has corners")
    };
    [all(f32::min), all(f32::max)]
}

#[test]
fn a_vehicle_fills_the_box_of_its_body_wherever_it_stands() {
    let bodies = [
        standing(Body::car(), 10.0, 3.0, 0.7),
        standing(Body::block(Class::Car, 3.6, 1.6, 1.6), 20.0, 3.0, -2.0),
        standing(Body::truck(), 40.0, 0.0, 3.0),
        standing(Body::bicycle(), 60.0, 0.0, 1.0),
        standing(Body::block(Class::Building, 17.0, 11.0, 13.0), 60.0, 30.0, 1.2),
        standing(Body::block(Class::Prop, 0.5, 2.0, 1.0), 80.0, 0.0, 0.1),
        standing(Body::block(Class::Prop, 2.0, 0.5, 1.0), 80.0, 4.0, 0.1),
        standing(Body::block(Class::Prop, 1.0, 1.5, 2.0), 90.0, 4.0, 0.1),
        standing(Body::disc(Class::Prop, 0.3, 0.7), 95.0, 4.0, 0.0),
        BodyState { altitude: 2.0, ..standing(Body::disc(Class::Prop, 0.4, 0.5), 95.0, 0.0, 0.0) },
    ];
    let scene = scene(&bodies);
    for (index, state) in bodies.iter().enumerate() {
        let [min, max] = bounds(&corners(&scene, index, &state.pose));
        let half = state.body.outline.half_extent().map(|metres| metres as f32);
        let (low, high) = (state.altitude as f32, (state.altitude + state.body.height) as f32);
        let expected = [Point3::new(-half.x, -half.y, low), Point3::new(half.x, half.y, high)];
        assert!((min - expected[0]).amax() < 0.01 && (max - expected[1]).amax() < 0.01, "{index}: {min} {max}");
    }
}

#[test]
fn a_tree_and_a_sign_have_the_height_of_their_bodies_and_a_trunk_of_their_outlines() {
    for body in
        [Body::disc(Class::Tree, 0.3, 6.0), Body::disc(Class::Sign, 0.05, 2.5), Body::disc(Class::Sign, 0.1, 6.0)]
    {
        let state = standing(body, 50.0, 20.0, 0.4);
        let corners = corners(&scene(&[state]), 0, &state.pose);
        let [min, max] = bounds(&corners);
        assert!(min.z.abs() < 0.01 && (max.z - body.height as f32).abs() < 0.01, "{min} {max}");
        let foot: Vec<_> = corners.into_iter().filter(|corner| corner.z < 0.1).collect();
        let [min, max] = bounds(&foot);
        let radius = body.outline.reach() as f32;
        assert!((max.x - radius).abs() < 0.01 && (min.y + radius).abs() < 0.01, "{min} {max}");
    }
}

#[test]
fn a_person_stands_in_its_box_and_walks_on_its_soles() {
    for body in [Body::adult(), Body::child()] {
        let still = standing(body, 20.0, 0.0, 0.5);
        let radius = body.outline.reach() as f32;
        let [min, max] = bounds(&corners(&scene(&[still]), 0, &still.pose));
        assert!(min.z.abs() < 0.01 && (max.z - body.height as f32).abs() < 0.01, "{min} {max}");
        assert!((max.y - radius).abs() < 0.01 && (min.y + radius).abs() < 0.01 && max.x < radius, "{min} {max}");
        for step in 0..20 {
            let velocity = still.pose.forward() * 1.4;
            let state = BodyState { travelled: 0.1 * f64::from(step), velocity, ..still };
            let [min, max] = bounds(&corners(&scene(&[state]), 0, &state.pose));
            assert!(min.z.abs() < 0.01, "{min} after {} m", state.travelled);
            assert!(max.z > 0.93 * body.height as f32 && max.z < 1.01 * body.height as f32, "{max}");
        }
    }
}

#[test]
fn legs_swing_with_the_way_and_further_with_the_speed() {
    let stride = |travelled: f64, speed: f64| {
        let state = standing(Body::adult(), 20.0, 0.0, 0.0);
        let state = BodyState { travelled, velocity: Vector2::new(speed, 0.0), ..state };
        let [min, max] = bounds(&corners(&scene(&[state]), 0, &state.pose));
        max.x - min.x
    };
    let widest = |speed: f64| (0..32).map(|i| stride(0.05 * f64::from(i), speed)).fold(0.0, f32::max);
    assert!(widest(0.7) > stride(0.0, 0.0) + 0.1 && widest(1.4) > widest(0.7) + 0.1 && widest(4.0) > widest(1.4) + 0.1);
    // The same way is the same pose, whenever it is asked; two steps on it is so again.
    assert_eq!(stride(0.4, 1.4), stride(0.4, 1.4));
    assert!((stride(0.4, 1.4) - stride(0.4 + 0.89 * 1.8, 1.4)).abs() < 1e-3);
    assert!((stride(0.4, 1.4) - stride(0.8, 1.4)).abs() > 0.05);
}

#[test]
fn people_step_up_to_the_sidewalk() {
    let network = road();
    let stage = Stage::of(&network);
    let foot = |y: f64| {
        let state = standing(Body::adult(), 20.0, y, 0.0);
        let scene = stage.scene_of([(0, &state)], Atmosphere::default());
        bounds(&corners(&scene, 0, &state.pose))[0].z
    };
    let sidewalk = network.on_sidewalk("road", Side::Left, 20.0).unwrap().position.y;
    assert!(foot(0.0).abs() < 1e-3 && (foot(sidewalk) - 0.12).abs() < 1e-3 && foot(30.0).abs() < 1e-3);
    let heights: Vec<f32> = (0..=20).map(|i| foot(3.3 + 0.05 * f64::from(i))).collect();
    assert!(heights.windows(2).all(|pair| (0.0..0.05).contains(&(pair[1] - pair[0]))), "{heights:?}");
}

/// The area of what faces up of a class, in square metres.
fn area(scene: &Scene, semantic: Semantic) -> f64 {
    let of = |mesh: &Mesh| -> f64 {
        let corner = |index: &u32| &mesh.vertices()[*index as usize];
        let triangles =
            mesh.indices().chunks_exact(3).map(|triangle| [&triangle[0], &triangle[1], &triangle[2]].map(corner));
        let up = triangles.filter(|corners| corners[0].semantic == semantic && corners[0].normal[2] > 0.9);
        up.map(|corners| {
            let [a, b, c] = corners.map(|corner| Vector3::from(corner.position).xy());
            0.5 * f64::from((b - a).perp(&(c - a)))
        })
        .sum()
    };
    scene.instances.iter().map(|instance| of(&instance.mesh)).sum()
}

#[test]
fn a_road_has_the_area_of_its_strips() {
    for network in [road(), RoadSegment::arc(60.0, -1.4).lanes(4).build().unwrap()] {
        let ground = Stage::of(&network).scene_of([], Atmosphere::default());
        let strips = network.strips();
        let of = |wanted: &dyn Fn(Surface) -> bool, shrunk: f64| -> f64 {
            let parts = strips.iter().filter(|strip| wanted(strip.surface)).flat_map(Strip::solid_parts);
            parts.map(|part| part.middle().length() * (part.left - part.right - shrunk)).sum()
        };
        let lines = of(&|surface| surface >= Surface::CentreLine, 0.0);
        let walks = of(&|surface| surface == Surface::Sidewalk, 0.05) + of(&|surface| surface == Surface::Kerb, 0.0);
        let paved = of(&|surface| surface == Surface::Carriageway, -0.1);
        assert!((area(&ground, Semantic::RoadLine) - lines).abs() < 0.01 * lines);
        assert!((area(&ground, Semantic::Sidewalk) - walks).abs() < 0.01 * walks);
        assert!((area(&ground, Semantic::Road) - paved).abs() < 0.01 * paved);
    }
}

#[test]
fn all_that_lies_on_the_ground_faces_up_or_aside() {
    let networks = [
        CrossIntersection::new().lanes(4).build(),
        TIntersection::new().build(),
        Roundabout::new().lanes(4).island(20.0).build(),
        RoadSegment::new(40.0).sidewalk(0.0).build(),
        RoadSegment::new(40.0).sidewalk(0.03).build(),
    ];
    for network in networks.map(Result::unwrap) {
        for instance in Stage::of(&network).scene_of([], Atmosphere::default()).instances {
            let mesh = &instance.mesh;
            for triangle in mesh.indices().chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|corner| &mesh.vertices()[triangle[corner] as usize]);
                let [p, q, r] = [a, b, c].map(|corner| Vector3::from(corner.position));
                let out = (q - p).cross(&(r - p));
                assert!(out.norm() > 1e-9 && out.normalize().z > -1e-3);
                for corner in [a, b, c] {
                    let normal = Vector3::from(corner.normal);
                    assert!((normal.norm() - 1.0).abs() < 1e-4 && normal.dot(&out.normalize()) > 0.6);
                }
            }
        }
    }
}

#[test]
fn a_city_is_made_of_chunks_near_their_places() {
    let city = grid_city(4, 4, 80.0, 2).build().unwrap();
    let ground = Stage::of(&city).scene_of([], Atmosphere::default()).instances;
    let (plain, chunks) = ground.split_last().unwrap();
    assert!(chunks.len() > 9 && plain.mesh.vertices().iter().all(|vertex| vertex.semantic == Semantic::Terrain));
    for vertex in chunks.iter().flat_map(|chunk| chunk.mesh.vertices()) {
        assert!(vertex.position[..2].iter().all(|metres| (-40.0..140.0).contains(metres)), "{:?}", vertex.position);
    }
}

#[test]
fn tests_on_one_network_share_its_stage() {
    let (stages, network) = (Stages::default(), road());
    let first = stages.of(&network, Look::Flat);
    assert!(Arc::ptr_eq(&first, &stages.of(&network.clone(), Look::Flat)));
    assert!(!Arc::ptr_eq(&first, &stages.of(&network, Look::Textured)));
    assert!(!Arc::ptr_eq(&first, &stages.of(&road(), Look::Flat)));
}

#[test]
fn bodies_have_their_colours_and_ids_and_leave_when_they_leave() {
    let bodies = [
        standing(Body::car().coloured([255, 188, 0]), 10.0, 0.0, 0.0),
        BodyState { present: false, ..standing(Body::car(), 20.0, 0.0, 0.0) },
        standing(Body::car(), 30.0, 0.0, 0.0),
    ];
    let scene = scene(&bodies);
    let ids: Vec<u16> = scene.instances.iter().map(|instance| instance.id).filter(|id| *id > 0).collect();
    assert_eq!(ids, [1, 3]);
    let paint = scene.instances.iter().find(|instance| instance.id == 1).unwrap().paint;
    // 188 of sRGB is half of the light.
    assert!((paint[0] - 1.0).abs() < 1e-6 && (paint[1] - 0.5029).abs() < 1e-3 && paint[2] == 0.0, "{paint:?}");
}

#[test]
fn the_same_state_is_the_same_scene() {
    let bodies = [standing(Body::disc(Class::Tree, 0.3, 6.0), 5.0, 9.0, 0.0), standing(Body::adult(), 8.0, 9.0, 0.0)];
    let (network, air) = (road(), Atmosphere::default());
    let look = |stage: &Stage| {
        let scene = stage.scene_of(bodies.iter().enumerate(), air);
        let seen = |instance: &Instance| (instance.pose, instance.scale, instance.mesh.vertices().to_vec());
        scene.instances.iter().map(seen).collect::<Vec<_>>()
    };
    assert!(look(&Stage::of(&network)) == look(&Stage::of(&network)));
}

#[test]
fn a_model_of_the_users_own_is_stretched_to_the_body() {
    let corner = |x: f32, y: f32, z: f32| Vertex {
        position: [x, y, z],
        normal: [0.0, 0.0, 1.0],
        uv: [0.0; 2],
        colour: [0.5; 3],
        surface: paracosm_render::SurfaceKind::Plain,
        semantic: Semantic::Car,
    };
    let mesh = Mesh::new(vec![corner(1.0, 1.0, 1.0), corner(3.0, 1.0, 1.5), corner(1.0, 5.0, 2.0)], vec![0, 1, 2]);
    let state = standing(Body::car(), 20.0, 1.0, 0.8);
    let stage = Stage::of(&road()).model(Class::Car, mesh);
    let [min, max] = bounds(&corners(&stage.scene_of([(0, &state)], Atmosphere::default()), 0, &state.pose));
    let expected = [Point3::new(-2.25, -0.9, 0.0), Point3::new(2.25, 0.9, 1.45)];
    assert!((min - expected[0]).amax() < 0.01 && (max - expected[1]).amax() < 0.01, "{min} {max}");
}

#[test]
fn fog_grows_thicker_from_nothing_to_ten_metres() {
    let extinction = |fog: f64| Atmosphere::of(&Weather { fog, ..Weather::default() }).extinction;
    assert_eq!(extinction(0.0), 0.0);
    assert!((3.912 / extinction(1.0) - 10.0).abs() < 1e-3);
    let values: Vec<f32> = (0..=100).map(|i| extinction(f64::from(i) / 100.0)).collect();
    assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
    assert!((3.912 / extinction(0.5) - 326.0).abs() < 1.0 && (3.912 / extinction(0.2) - 3350.0).abs() < 20.0);
    assert_eq!(Atmosphere::of(&Weather::default()), Atmosphere::default());
}

/// Dusk, with a pedestrian who walks.
fn dusk(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(200.0));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(5.0));
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, 60.0)));
    walker.walk(road.on_sidewalk(Side::Left, 100.0), 1.5);
    let falling = Stream::<()>::tick().scan(1.0, |light: f64, ()| (light - 0.001).max(0.0));
    s.place(Environment::new().light(falling).fog(0.3).sun(0.2, 1.0));
    s.duration(4.0);
    s.require("somewhere", eventually(car.travelled().above(1.0)));
    s.require("slow", never(car.speed().above(30.0)));
}

#[test]
fn a_run_is_seen_as_it_stands_at_each_moment() {
    let program = Program::new("dusk", "dusk", dusk);
    let mut run = Run::new(&program, &Values::default(), Setup::asking_every(0.1)).unwrap();
    let stage = Stage::of(run.network());
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    let mut seen: Vec<Scene> = Vec::new();
    run.watch(driver.as_mut(), |run| seen.push(stage.scene(run)));
    assert_eq!(seen.len(), 41);
    let (first, last) = (&seen[0], &seen[40]);
    assert!((first.air.light - 0.999).abs() < 1e-6 && (last.air.light - 0.599).abs() < 1e-6);
    assert!(last.air.extinction > 0.0 && (last.air.sun_elevation, last.air.sun_azimuth) == (0.2, 1.0));
    let place = |scene: &Scene, id: u16| {
        scene.instances.iter().find(|instance| instance.id == id).unwrap().pose.translation.vector
    };
    assert!((place(last, 1).x - place(first, 1).x) > 15.0 && (place(last, 2).x - place(first, 2).x - 6.0).abs() < 0.05);
}
