use super::*;
use crate::sensor::{Beam, Lidar, LidarSettings, Mount, Pinhole, Scan, scan_of_depth};
use nalgebra::Vector3;

const HEIGHT: f64 = 2.0;
/// Metres to a wall across the way.
const WALL: f64 = 25.0;

fn camera() -> Pinhole {
    Pinhole::new([400, 200], 1.5)
}

/// The distances that the camera sees over flat ground before a wall, by the definition of a pinhole camera.
fn picture(camera: &Pinhole) -> Vec<f32> {
    let pixels = (0..camera.size[1]).flat_map(|row| (0..camera.size[0]).map(move |column| (column, row)));
    let distances = pixels.map(|(column, row)| {
        let x = (column as f64 + 0.5 - camera.centre[0]) / camera.focal[0];
        let y = (row as f64 + 0.5 - camera.centre[1]) / camera.focal[1];
        let forward = if y > 0.0 { WALL.min(HEIGHT / y) } else { WALL };
        (forward * (1.0 + x * x + y * y).sqrt()) as f32
    });
    distances.collect()
}

#[test]
fn points_of_a_depth_image_are_on_the_surfaces_in_the_directions_of_the_beams() {
    let camera = camera();
    let lidar = Lidar::new(LidarSettings { mount: Mount::above(HEIGHT), ..LidarSettings::default() }).unwrap();
    let mut scan = Scan::default();
    scan_of_depth(&camera, &picture(&camera), lidar.beams(), 100.0, 0.01, &mut scan).unwrap();
    let inside = |beam: &Beam| {
        let way = beam.direction();
        let (across, down) = (way.y / way.x * camera.focal[0], way.z / way.x * camera.focal[1]);
        way.x > 0.0 && across > -200.0 && across <= 200.0 && down > -100.0 && down <= 100.0
    };
    let beams: Vec<Beam> = lidar.beams().filter(inside).collect();
    assert!(beams.len() > 5000);
    assert_eq!(scan.points.len(), beams.len());
    // From the middle of a pixel to its corner.
    let most = 0.5 * 2_f64.sqrt() / camera.focal[0];
    for (beam, point) in beams.iter().zip(&scan.points) {
        let at: Vector3<f64> = point.position.cast();
        assert!((at.z + HEIGHT).abs() < 1e-3 || (at.x - WALL).abs() < 1e-3, "{at:?} is in the air");
        assert!(at.normalize().cross(&beam.direction()).norm() <= most + 1e-9, "{at:?} is not on {beam:?}");
        assert!((f64::from(point.intensity) - libm::exp(-0.01 * at.norm())).abs() < 1e-6);
    }
}

#[test]
fn what_is_too_far_or_no_number_is_no_echo() {
    let camera = Pinhole::new([2, 1], 1.0);
    let beams = [0.1, -0.1, 3.0].map(|azimuth| Beam { azimuth, elevation: 0.0 });
    let count = |depth: &[f32]| {
        let mut scan = Scan::default();
        scan_of_depth(&camera, depth, beams, 50.0, 0.0, &mut scan).map(|()| scan.points.len())
    };
    assert_eq!(count(&[10.0, 20.0]), Ok(2), "behind the camera it sees nothing");
    assert_eq!(count(&[f32::INFINITY, 20.0]), Ok(1));
    assert_eq!(count(&[f32::NAN, -1.0]), Ok(0));
    assert_eq!(refusal(count(&[10.0])), "the depth image has 1 pixel, expected the camera's 2 x 1");
    let blind = Pinhole { focal: [0.0, 1.0], ..camera };
    let refused = scan_of_depth(&blind, &[1.0, 1.0], beams, 50.0, 0.0, &mut Scan::default());
    assert_eq!(refusal(refused), "depth camera: `focal[0]` is 0 px, expected 0.001 to 1000000 px");
}
