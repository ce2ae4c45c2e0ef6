use super::paints::{PAINTS, paint};
use super::{KINDS, car, kind};
use crate::mesh::Mesh;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// The size of [`Body::car`](paracosm_engine::object::Body::car).
const USUAL: [f32; 3] = [4.5, 1.8, 1.45];

fn bounds(mesh: &Mesh) -> [Vector3<f32>; 2] {
    let points = || mesh.vertices().iter().map(|vertex| Vector3::from(vertex.position));
    let low = points().fold(Vector3::repeat(f32::INFINITY), |low, point| low.inf(&point));
    [low, points().fold(Vector3::repeat(f32::NEG_INFINITY), |high, point| high.sup(&point))]
}

#[test]
fn every_car_fills_the_box_of_its_body_from_near_and_from_afar() {
    for (index, lines) in KINDS.iter().enumerate() {
        for size in [USUAL, lines.size] {
            let mesh = car(index, size);
            for mesh in [&mesh, mesh.coarse().expect("it has one")] {
                let [low, high] = bounds(mesh);
                let [length, width, height] = size;
                let expected =
                    [Vector3::new(-0.5 * length, -0.5 * width, 0.0), Vector3::new(0.5 * length, 0.5 * width, height)];
                assert!(
                    (low - expected[0]).amax() < 1e-3 && (high - expected[1]).amax() < 1e-3,
                    "{index}: {low} {high}"
                );
            }
        }
    }
}

#[test]
fn cars_have_few_enough_triangles_and_from_afar_very_few() {
    for index in 0..KINDS.len() {
        let mesh = car(index, USUAL);
        let count = |mesh: &Mesh| mesh.indices().len() / 3;
        let (near, far) = (count(&mesh), count(mesh.coarse().expect("it has one")));
        assert!((600..=1260).contains(&near) && far < 520, "{index}: {near} {far}");
    }
}

#[test]
fn no_triangle_of_a_car_is_degenerate_and_every_normal_is_on_its_side() {
    for index in 0..KINDS.len() {
        let mesh = car(index, USUAL);
        for triangle in mesh.indices().chunks_exact(3) {
            let corners = [0, 1, 2].map(|i| &mesh.vertices()[triangle[i] as usize]);
            let [a, b, c] = corners.map(|corner| Vector3::from(corner.position));
            let area = (b - a).cross(&(c - a));
            assert!(area.norm() > 1e-9, "{index}: {a} {b} {c}");
            for corner in corners {
                let normal = Vector3::from(corner.normal);
                assert!((normal.norm() - 1.0).abs() < 1e-4, "{index}: {normal}");
                assert!(normal.dot(&area.normalize()) > 0.3, "{index}: {normal} on {a} {b} {c}");
            }
        }
    }
}

#[test]
fn a_usual_car_is_of_any_kind_as_often_as_its_share_says_and_a_short_high_one_is_no_sports_car() {
    let all: u32 = KINDS.iter().map(|lines| lines.share).sum();
    assert_eq!(all, 100);
    let mut seen = BTreeMap::new();
    (0..all).for_each(|chance| *seen.entry(kind(USUAL, chance)).or_insert(0) += 1);
    for (index, lines) in KINDS.iter().enumerate() {
        assert_eq!(seen.get(&index), Some(&lines.share), "{index}");
    }
    let natural = (0..1000).map(|chance| KINDS[kind([3.4, 1.6, 1.6], chance)].size);
    assert!(natural.into_iter().all(|[length, _, height]| height / length > 0.33));
}

#[test]
fn a_car_of_any_proportions_has_a_kind() {
    for size in [[1.0, 1.0, 9.0], [20.0, 2.0, 0.2], [4.5, 1.8, 1.45]] {
        (0..200).for_each(|chance| assert!(kind(size, chance) < KINDS.len()));
    }
}

#[test]
fn colours_are_as_frequent_as_in_traffic() {
    assert_eq!(PAINTS.iter().map(|paint| paint.share).sum::<u32>(), 100);
    let of = |colour| PAINTS.iter().position(|paint| paint.shades.contains(&colour)).expect("it is a paint");
    let mut seen = [0; PAINTS.len()];
    (0..60_000).for_each(|chance| seen[of(paint(chance))] += 1);
    for (found, paint) in seen.into_iter().zip(&PAINTS) {
        assert_eq!(found, 600 * paint.share, "{:?}", paint.shades);
    }
}
