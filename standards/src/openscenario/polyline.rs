//! Recorded poses as the vertices of a polyline with times, as few as are needed.

use paracosm_engine::Pose;

/// The greatest distance in metres between a recorded position and the polyline at the same time.
const DISTANCE: f64 = 2e-3;
/// The greatest difference in radians between a recorded heading and the heading of the polyline at the same time.
const TURN: f64 = 1e-3;
/// The greatest number of recorded poses between two vertices. It bounds the time for the search.
const MOST_BETWEEN: usize = 500;

/// Returns the poses at the vertices. Between two vertices, positions and headings change evenly over time, and differ by at
/// most 2 mm and 0.001 rad from the recorded poses, and speeds by at most `speed` m/s.
pub(super) fn simplified(poses: &[(f64, Pose)], speed: f64) -> Vec<(f64, Pose)> {
    let Some(last) = poses.len().checked_sub(1) else { return Vec::new() };
    let mut kept = vec![poses[0]];
    let mut start = 0;
    while start < last {
        // The greatest step is found by doubling the step and then by halving the difference.
        let fits =
            |step: usize| start + step <= last && step <= MOST_BETWEEN && is_even(&poses[start..=start + step], speed);
        let mut step = 1;
        while fits(2 * step) {
            step *= 2;
        }
        let mut more = step / 2;
        while more > 0 {
            if fits(step + more) {
                step += more;
            }
            more /= 2;
        }
        start += step;
        kept.push(poses[start]);
    }
    // An entity at rest has a single vertex.
    let is_at_rest = kept.iter().all(|(_, pose)| (pose.position - kept[0].1.position).norm() <= DISTANCE);
    if is_at_rest && kept.iter().all(|(_, pose)| (pose.heading - kept[0].1.heading).abs() <= TURN) {
        kept.truncate(1);
    }
    kept
}

/// Returns `true` if poses change evenly from the first to the last.
fn is_even(poses: &[(f64, Pose)], speed: f64) -> bool {
    let ((from, first), (to, last)) = (poses[0], poses[poses.len() - 1]);
    let fast = |(from, a): (f64, Pose), (to, b): (f64, Pose)| (b.position - a.position).norm() / (to - from);
    let mean = fast(poses[0], poses[poses.len() - 1]);
    if poses.windows(2).any(|pair| (fast(pair[0], pair[1]) - mean).abs() > speed) {
        return false;
    }
    poses.iter().all(|(time, pose)| {
        let share = (time - from) / (to - from);
        let position = first.position + (last.position - first.position) * share;
        let heading = first.heading + (last.heading - first.heading) * share;
        (pose.position - position).norm() <= DISTANCE && (pose.heading - heading).abs() <= TURN
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    fn poses(at: impl Fn(f64) -> Pose) -> Vec<(f64, Pose)> {
        (0..=300).map(|tick| f64::from(tick) * 0.01).map(|time| (time, at(time))).collect()
    }

    #[test]
    fn even_motion_has_two_vertices_and_rest_has_one() {
        let even = poses(|time| Pose { position: Vector2::new(10.0 * time, 0.0), heading: 0.0 });
        assert_eq!(simplified(&even, 0.005), [even[0], even[300]]);
        let rest = poses(|_| Pose { position: Vector2::new(1.0, 2.0), heading: 3.0 });
        assert_eq!(simplified(&rest, 0.005), [rest[0]]);
    }

    #[test]
    fn every_recorded_pose_is_close_to_the_polyline() {
        let braking = poses(|time| {
            let position = Vector2::new(20.0 * time - 3.0 * time * time, libm::sin(time));
            Pose { position, heading: 0.1 * libm::cos(time) }
        });
        let vertices = simplified(&braking, f64::INFINITY);
        assert!(vertices.len() > 10 && vertices.len() < 100, "{}", vertices.len());
        for (time, pose) in &braking {
            let next = vertices.partition_point(|(at, _)| at < time).max(1);
            let ((from, a), (to, b)) = (vertices[next - 1], vertices[next]);
            let share = (time - from) / (to - from);
            let found = a.position + (b.position - a.position) * share;
            assert!((found - pose.position).norm() <= 1.01 * DISTANCE);
        }
    }
}
