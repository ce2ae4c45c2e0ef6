use super::*;
use crate::object::{Outline, VehicleKind};
use crate::sensor::{Chance, Lidar, LidarSettings, Mount, Scan, Sensor};
use nalgebra::Vector3;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::Cuboid;

/// Without noise, and without any echo lost.
fn exact() -> LidarSettings {
    LidarSettings { noise: 0.0, sure: 0.0, ..LidarSettings::default() }
}

fn scan(settings: LidarSettings, world: &World) -> Scan {
    scan_by_chance(settings, world, 0)
}

fn scan_by_chance(settings: LidarSettings, world: &World, number: u64) -> Scan {
    let mut scan = Scan::default();
    Lidar::new(settings).unwrap().sense(&world.view(0.0), &mut Chance::of(5, "lidar", number), &mut scan);
    scan
}

fn distance(position: Vector3<f32>) -> f64 {
    position.cast::<f64>().norm()
}

/// How far along a ray a body is first met: by trying each of its surfaces, in the coordinates of the world.
fn meets(state: &BodyState, from: Vector3<f64>, way: Vector3<f64>) -> Option<f64> {
    let (bottom, top) = (state.altitude, state.altitude + state.body.height);
    let mut candidates = vec![0.0];
    candidates.extend([bottom, top].map(|z| (z - from.z) / way.z));
    let offset = from.xy() - state.pose.position;
    match state.body.outline {
        Outline::Rectangle { length, width } => {
            for (normal, half) in [(state.pose.forward(), 0.5 * length), (state.pose.left(), 0.5 * width)] {
                candidates.extend([-half, half].map(|side| (side - normal.dot(&offset)) / normal.dot(&way.xy())));
            }
        }
        Outline::Disc { radius } => {
            let (a, b) = (way.xy().norm_squared(), offset.dot(&way.xy()));
            let root = (b * b - a * (offset.norm_squared() - radius * radius)).sqrt();
            candidates.extend([(-b - root) / a, (-b + root) / a]);
        }
    }
    let inside = |t: &f64| {
        let point = from + way * *t;
        let offset = point.xy() - state.pose.position;
        let in_outline = match state.body.outline {
            Outline::Rectangle { length, width } => {
                let (x, y) = (state.pose.forward().dot(&offset).abs(), state.pose.left().dot(&offset).abs());
                x <= 0.5 * length + 1e-9 && y <= 0.5 * width + 1e-9
            }
            Outline::Disc { radius } => offset.norm() <= radius + 1e-9,
        };
        *t >= 0.0 && t.is_finite() && in_outline && (bottom - 1e-9..=top + 1e-9).contains(&point.z)
    };
    candidates.into_iter().filter(inside).reduce(f64::min)
}

/// What a beam hits: how far away, and what.
fn analytic(world: &World, from: Vector3<f64>, way: Vector3<f64>, range: f64) -> Option<(f64, u32)> {
    let ground = (way.z < 0.0).then(|| (-from.z / way.z, 0));
    let bodies = world.bodies.iter().enumerate().skip(1).filter(|(_, state)| state.present);
    let bodies = bodies.filter_map(|(index, state)| Some((meets(state, from, way)?, index as u32)));
    // Of two at one distance, the first: as a scan has it where the sensor is inside of both.
    let hits = ground.into_iter().chain(bodies.map(|(t, index)| (t, index + 1)));
    hits.reduce(|best, hit| if hit.0 < best.0 { hit } else { best }).filter(|hit| hit.0 <= range)
}

proptest! {
    #[test]
    fn every_beam_measures_what_the_surfaces_around_it_say(
        car in poses(500.0),
        around in prop::collection::vec((bodies(), poses(60.0), 0.0..3.0, prop::bool::weighted(0.9)), 0..15),
        mount in (-2.0..2.0, -2.0..2.0, 0.2..4.0, -3.2..3.2),
        (lowest, field, channels) in (-1.4..0.4, 0.01..0.9, 1_usize..12),
        (columns, range) in (1_usize..120, 5.0..150.0),
    ) {
        let mut world = World::of(car);
        for (body, at, altitude, present) in around {
            let at = pose(car.position.x + at.position.x, car.position.y + at.position.y, at.heading);
            world.bodies.push(BodyState { altitude, present, ..BodyState::at_rest(body, at) });
        }
        let mount = Mount { position: Vector3::new(mount.0, mount.1, mount.2), heading: mount.3 };
        let highest = lowest + field;
        let settings = LidarSettings { mount, lowest, highest, channels, columns, range, ..exact() };
        let scan = scan(settings, &world);
        let sensor = mount.pose(&world.car);
        let from = Vector3::new(sensor.position.x, sensor.position.y, mount.position.z);
        let mut points = scan.points.iter();
        for beam in Lidar::new(settings).unwrap().beams() {
            let local = beam.direction();
            let flat = sensor.forward() * local.x + sensor.left() * local.y;
            if let Some((range, id)) = analytic(&world, from, Vector3::new(flat.x, flat.y, local.z), range) {
                let point = points.next().expect("an echo");
                prop_assert_eq!(point.id, id, "{:?} at {} m", beam, range);
                let off = (point.position.cast::<f64>() - local * range).norm();
                // A millimetre is promised; what there is comes from the 32 bits of the points.
                prop_assert!(off < 2e-7 * range + 1e-9, "{:?} is off by {} at {} m", beam, off, range);
            }
        }
        prop_assert!(points.next().is_none(), "more echoes than expected");
    }

    #[test]
    fn boxes_are_hit_where_parry_hits_them(
        elevation in -1.0..1.0, far in 1.0..150.0, heading in -3.2..3.2,
        size in (1.0..10.0, 1.0..10.0, 1.0..5.0), inside in (-0.9..0.9, -0.9..0.9, -0.9..0.9),
    ) {
        // A single beam ahead, and a box that it ends in.
        let height = 90.0;
        let mount = Mount::above(height);
        let settings = LidarSettings { mount, channels: 1, columns: 1, lowest: elevation, highest: elevation, range: 200.0, ..exact() };
        let way = Lidar::new(settings).unwrap().beams().next().unwrap().direction();
        let half = Vector3::new(size.0, size.1, size.2) * 0.5;
        let target = half.component_mul(&Vector3::new(inside.0, inside.1, inside.2));
        let turned = Pose { position: Vector2::zeros(), heading }.turn_to_plane(target.xy());
        let middle: Vector3<f64> = way * far - Vector3::new(turned.x, turned.y, target.z);
        let mut world = World::of(pose(0.0, 0.0, 0.0));
        let body = Body::block(Class::Car, size.0, size.1, size.2);
        let altitude = height + middle.z - half.z;
        prop_assume!(altitude > 0.0);
        world.bodies.push(BodyState { altitude, ..BodyState::at_rest(body, pose(middle.x, middle.y, heading)) });
        let found = distance(scan(settings, &world).points[0].position);

        let at = pose(middle.x, middle.y, heading);
        let (from, along) = (at.to_local(Vector2::zeros()), at.turn_to_local(way.xy()));
        let narrow = |x: f64, y: f64, z: f64| [x as f32, y as f32, z as f32].into();
        let ray = Ray::new(narrow(from.x, from.y, -middle.z), narrow(along.x, along.y, way.z));
        let hit = Cuboid::new(narrow(half.x, half.y, half.z)).cast_local_ray_and_get_normal(&ray, 1000.0, true).unwrap();
        // In 32 bits, the more a face is grazed the worse.
        let steep = hit.normal.dot(ray.dir).abs();
        prop_assume!(hit.time_of_impact == 0.0 || steep > 0.1);
        prop_assert!((found - f64::from(hit.time_of_impact)).abs() < 1e-3, "{} and {}", found, hit.time_of_impact);
    }
}

#[test]
fn echoes_fade_in_clear_air_and_in_fog() {
    let mut world = World::of(pose(0.0, 0.0, 0.0)).with(
        Body::block(Class::Building, 2.0, 30.0, 20.0),
        pose(51.0, 0.0, 0.0),
        Vector2::zeros(),
    );
    let settings = LidarSettings { channels: 1, columns: 1, lowest: 0.0, highest: 0.0, ..exact() };
    let ahead = scan(settings, &world).points[0];
    assert_eq!((ahead.position, ahead.id), (Vector3::new(50.0, 0.0, 0.0), 2));
    assert!((f64::from(ahead.intensity) - libm::exp(-0.004 * 50.0)).abs() < 1e-6);
    // A visibility of 100 m: there and back.
    world.extinction = 3.912 / 100.0;
    let intensity = libm::exp(-(0.004 + 2.0 * 0.03912) * 50.0);
    assert!((f64::from(scan(settings, &world).points[0].intensity) - intensity).abs() < 1e-6);
}

/// All around at this distance.
fn surrounded(distance: f64) -> World {
    let wall = |x, y, heading| (Body::block(Class::Building, 1.0, 2.2 * distance, 50.0), pose(x, y, heading));
    let off = distance + 0.5;
    let quarter = std::f64::consts::FRAC_PI_2;
    [wall(off, 0.0, 0.0), wall(-off, 0.0, 0.0), wall(0.0, off, quarter), wall(0.0, -off, quarter)]
        .into_iter()
        .fold(World::of(pose(0.0, 0.0, 0.0)), |world, (body, at)| world.with(body, at, Vector2::zeros()))
}

#[test]
fn as_many_echoes_are_lost_as_their_intensities_say() {
    let mut world = surrounded(40.0);
    let settings = LidarSettings { lowest: 0.0, loss: 0.1, noise: 0.0, ..LidarSettings::default() };
    for extinction in [0.0, 0.005, 0.02, 0.5] {
        world.extinction = extinction;
        let all = scan(LidarSettings { sure: 0.0, loss: 0.0, ..settings }, &world).points;
        assert_eq!(all.len(), 32 * 1800);
        let kept = all.iter().map(|point| 0.9 * (f64::from(point.intensity) / 0.8).min(1.0));
        let (expected, variance) = kept.fold((0.0, 0.0), |(sum, spread), p| (sum + p, spread + p * (1.0 - p)));
        let found = scan(settings, &world).points.len() as f64;
        assert!(
            (found - expected).abs() <= 5.0 * variance.sqrt(),
            "{found} echoes in {extinction}, expected {expected}"
        );
    }
}

#[test]
fn the_noise_of_distances_is_normal() {
    let world = surrounded(30.0);
    let settings = LidarSettings { noise: 0.05, ..exact() };
    let (noisy, truth) = (scan(settings, &world), scan(exact(), &world));
    let pairs = noisy.points.iter().zip(&truth.points);
    let errors: Vec<f64> = pairs.map(|(a, b)| distance(a.position) - distance(b.position)).collect();
    assert_eq!(errors.len(), 32 * 1800);
    check_normal("distance", &errors, 0.0, 0.05);
}

#[test]
fn what_one_beam_hits_does_not_shift_the_noise_of_the_others() {
    let empty = World::of(pose(0.0, 0.0, 0.0));
    let world = World::of(pose(0.0, 0.0, 0.0)).with(Body::truck(), pose(20.0, 3.0, 0.3), Vector2::zeros());
    let settings = LidarSettings::default();
    let (without, with) = (scan(settings, &empty), scan(settings, &world));
    let ground = |scan: &Scan| scan.points.iter().filter(|point| point.id == 0).copied().collect::<Vec<_>>();
    let (behind, seen) = (ground(&without), ground(&with));
    assert!(with.points.len() != behind.len() && seen.len() < behind.len(), "the truck hides some of the ground");
    assert!(seen.iter().all(|point| behind.contains(point)));
    assert_eq!(with, scan(settings, &world), "the same chance is the same scan");
    assert_ne!(with, scan_by_chance(settings, &world, 1));
}

#[test]
fn a_vehicle_is_as_high_and_as_wide_for_a_lidar_as_its_kind_is() {
    // 200 channels from 20 degrees below the horizon to 20 above: at 10 m, 3.5 cm between two of them.
    let settings = LidarSettings { channels: 200, lowest: -0.35, highest: 0.35, columns: 4000, ..exact() };
    for kind in VehicleKind::ALL {
        let [length, width, height] = kind.size;
        let rear = 10.0;
        let world =
            World::of(pose(0.0, 0.0, 0.0)).with(Body::of(&kind), pose(rear + 0.5 * length, 0.0, 0.0), Vector2::zeros());
        let mount = settings.mount.position;
        let points: Vec<_> = scan(settings, &world)
            .points
            .into_iter()
            .filter(|point| point.id == 2)
            .map(|point| point.position.cast::<f64>() + Vector3::new(mount.x, mount.y, mount.z))
            .filter(|point| (point.x - rear).abs() < 1e-3)
            .collect();
        let most = |of: fn(&Vector3<f64>) -> f64| points.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let top = height - most(|point| point.z);
        let side = 0.5 * width - most(|point| point.y);
        assert!((-1e-6..0.06).contains(&top), "{}: {top} m below the roof", kind.name);
        assert!((-1e-6..0.03).contains(&side), "{}: {side} m inside of the left side", kind.name);
    }
}

#[test]
fn points_are_written_as_kitti_has_them() {
    let world = World::of(pose(0.0, 0.0, 0.0)).with(Body::truck(), pose(20.0, 0.0, 0.0), Vector2::zeros());
    let scan = scan(LidarSettings::default(), &world);
    let bytes = scan.to_kitti();
    assert_eq!(bytes.len(), 16 * scan.points.len());
    let read: Vec<f32> = bytes.chunks(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect();
    for (point, numbers) in scan.points.iter().zip(read.chunks(4)) {
        assert_eq!([point.position.x, point.position.y, point.position.z, point.intensity], numbers);
    }
}

#[test]
fn a_scan_allocates_nothing() {
    let world = surrounded(30.0);
    let mut lidar = Lidar::new(LidarSettings::default()).unwrap();
    let mut scan = Scan::default();
    let mut sense = |number| lidar.sense(&world.view(0.0), &mut Chance::of(1, "lidar", number), &mut scan);
    sense(0);
    let after = allocation_counter::measure(|| sense(1));
    assert_eq!((after.count_total, after.bytes_total), (0, 0));
}

#[test]
fn a_lidar_that_cannot_be_says_why() {
    let usual = LidarSettings::default();
    let message = |settings| refusal(Lidar::new(settings));
    assert_eq!(message(LidarSettings { channels: 0, ..usual }), "lidar: `channels` is 0, expected 1 to 512");
    assert_eq!(message(LidarSettings { range: -3.0, ..usual }), "lidar: `range` is -3 m, expected 0.1 to 10000 m");
    assert_eq!(message(LidarSettings { noise: f64::NAN, ..usual }), "lidar: `noise` is NaN m, expected 0 to 100 m");
    assert_eq!(
        message(LidarSettings { lowest: 0.2, highest: 0.1, ..usual }),
        "lidar: `lowest` is 0.2 rad, expected less than `highest`, which is 0.1 rad"
    );
    let mount = Mount::above(f64::INFINITY);
    assert_eq!(message(LidarSettings { mount, ..usual }), "lidar: `mount.position.z` is inf m, expected 0 to 100 m");
}
