use super::clay::{Clay, Matter, Point, at, oval};
use super::furniture::{self, Plate};
use super::garb::{GARBS, USUAL};
use super::signs::SIGNS;
use super::{Mesh, Semantic, SurfaceKind, bicycle, bus, car, house, motorcycle, person, plant, truck, van};
use std::collections::BTreeMap;

fn plain() -> Matter {
    Matter::new(SurfaceKind::Plain, [0.5; 3], Semantic::Other)
}

fn shape(build: impl FnOnce(&mut Clay)) -> Mesh {
    let mut clay = Clay::default();
    build(&mut clay);
    clay.mesh()
}

fn plans() -> impl Iterator<Item = house::Plan> {
    [[10.0, 8.0, 7.0], [3.0, 3.0, 2.5], [24.0, 14.0, 21.0], [200.0, 9.0, 120.0]].into_iter().map(house::Plan::of)
}

/// All shapes by name.
fn all() -> Vec<(String, Mesh)> {
    let plates = [Plate::Limit, Plate::GiveWay, Plate::Stop, Plate::Hint];
    let named = [
        ("car", car::car()),
        ("van", van::van()),
        ("truck", truck::truck()),
        ("bus", bus::bus()),
        ("motorcycle", motorcycle::motorcycle()),
        ("bicycle", bicycle::bicycle()),
        ("adult", person::trunk(1.0, &USUAL)),
        ("child", person::trunk(1.3, &USUAL)),
        ("left arm", person::arm(1.0, &USUAL)),
        ("right arm", person::arm(-1.0, &USUAL)),
        ("thigh", person::thigh(&USUAL)),
        ("shin", person::shin(&USUAL)),
        ("trunk", plant::trunk(SurfaceKind::Bark)),
        ("conifer", plant::crown(true, [0.1; 3])),
        ("broad leaves", plant::crown(false, [0.1; 3])),
        ("pole", furniture::pole()),
        ("lantern", furniture::lantern()),
        ("cone", furniture::cone()),
        ("barrel", furniture::barrel()),
        ("ball", furniture::ball()),
        ("parcel", furniture::parcel()),
        ("barrier", furniture::barrier()),
    ];
    let named = named.into_iter().map(|(name, mesh)| (name.to_owned(), mesh));
    let plates = plates.into_iter().map(|plate| (format!("{plate:?}"), furniture::plate(plate)));
    let signs = SIGNS.iter().enumerate().map(|(i, sign)| (format!("sign {i}"), sign()));
    named
        .chain(plates)
        .chain(signs)
        .chain(plans().map(|plan| (format!("{plan:?}"), plan.mesh(house::Walls::Flat))))
        .collect()
}

fn triangles(mesh: &Mesh) -> impl Iterator<Item = [(Point, Point); 3]> {
    mesh.indices().chunks_exact(3).map(|triangle| {
        [0, 1, 2].map(|corner| {
            let vertex = &mesh.vertices()[triangle[corner] as usize];
            (Point::from(vertex.position), Point::from(vertex.normal))
        })
    })
}

fn bounds(mesh: &Mesh) -> [Point; 2] {
    let points = || mesh.vertices().iter().map(|vertex| Point::from(vertex.position));
    let min = points().fold(Point::repeat(f32::INFINITY), |min, point| min.inf(&point));
    [min, points().fold(Point::repeat(f32::NEG_INFINITY), |max, point| max.sup(&point))]
}

/// The volume within a closed surface, by the divergence theorem.
fn volume(mesh: &Mesh) -> f32 {
    triangles(mesh).map(|[(a, _), (b, _), (c, _)]| a.dot(&b.cross(&c)) / 6.0).sum()
}

#[test]
fn no_triangle_is_degenerate_and_every_normal_is_a_unit_vector_on_its_side() {
    for (name, mesh) in all() {
        assert!(!mesh.indices().is_empty(), "{name}");
        for corners in triangles(&mesh) {
            let [(a, _), (b, _), (c, _)] = corners;
            let area = (b - a).cross(&(c - a));
            assert!(area.norm() > 1e-9, "{name}: {a} {b} {c}");
            for (_, normal) in corners {
                assert!((normal.norm() - 1.0).abs() < 1e-4, "{name}: {normal}");
                assert!(normal.dot(&area.normalize()) > 0.3, "{name}: {normal} on {a} {b} {c}");
            }
        }
    }
}

#[test]
fn vehicles_houses_and_things_fill_their_boxes_and_stand_on_the_ground() {
    let one = [1.0; 3];
    let mut boxes = vec![
        (car::car(), car::SIZE),
        (van::van(), van::SIZE),
        (truck::truck(), truck::SIZE),
        (bus::bus(), bus::SIZE),
        (motorcycle::motorcycle(), motorcycle::SIZE),
        (bicycle::bicycle(), bicycle::SIZE),
        (furniture::cone(), one),
        (furniture::barrel(), one),
        (furniture::ball(), one),
        (furniture::parcel(), one),
        (furniture::barrier(), one),
        (plant::crown(true, one), one),
        (plant::crown(false, one), one),
    ];
    boxes.extend(plans().map(|plan| (plan.mesh(house::Walls::Flat), plan.size())));
    for (mesh, [length, width, height]) in boxes {
        let [min, max] = bounds(&mesh);
        let expected = [at(-0.5 * length, -0.5 * width, 0.0), at(0.5 * length, 0.5 * width, height)];
        assert!((min - expected[0]).amax() < 1e-3 && (max - expected[1]).amax() < 1e-3, "{min} {max}");
    }
}

#[test]
fn the_wheels_of_vehicles_touch_the_ground() {
    for (mesh, rings) in [(car::car(), 4), (van::van(), 4), (truck::truck(), 6), (bus::bus(), 4)] {
        let lowest = mesh.vertices().iter().filter(|vertex| vertex.position[2] < 0.01);
        let mut feet: Vec<[i32; 2]> =
            lowest.map(|vertex| [vertex.position[0].round() as i32, vertex.position[1].signum() as i32]).collect();
        feet.sort_unstable();
        feet.dedup();
        assert_eq!(feet.len(), rings, "{feet:?}");
    }
}

/// Of a closed surface every edge is an edge of two triangles, once each way.
fn is_closed(mesh: &Mesh) -> bool {
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    let bits = |point: Point| <[f32; 3]>::from(point).map(|metres| (metres + 0.0).to_bits());
    for corners in triangles(mesh) {
        let corners = corners.map(|(point, _)| bits(point));
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            *edges.entry([corners[a], corners[b]]).or_default() += 1;
            *edges.entry([corners[b], corners[a]]).or_default() -= 1;
        }
    }
    edges.values().all(|count| *count == 0)
}

#[test]
fn what_shapes_are_made_of_is_closed_faces_outward_and_has_its_volume() {
    let pi = std::f32::consts::PI;
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let cases: [(&str, Mesh, f32, f32); 6] = [
        ("cuboid", shape(|clay| clay.cuboid([-1.0, 2.0, 0.5], [1.0, 3.0, 1.5], plain())), 2.0, 1e-5),
        ("prism", shape(|clay| clay.prism(&square, [-1.0, 2.0], plain())), 3.0, 1e-5),
        (
            "tube",
            shape(|clay| clay.tube([at(1.0, 0.0, 0.0), at(1.0, 0.0, 2.0)], [1.0; 2], 64, plain())),
            2.0 * pi,
            0.02,
        ),
        (
            "slanted",
            shape(|clay| clay.tube([at(0.0, 0.0, 0.0), at(3.0, 0.0, 4.0)], [1.0; 2], 64, plain())),
            5.0 * pi,
            0.05,
        ),
        ("ball", shape(|clay| clay.ball(at(0.0, 1.0, 0.0), [1.0, 2.0, 3.0], 48, plain())), 8.0 * pi, 0.2),
        ("tyre", shape(|clay| clay.tyre(at(0.0, 0.0, 1.0), [0.5, 1.0], 1.0, 64, plain())), 0.75 * pi, 0.01),
    ];
    for (name, mesh, expected, tolerance) in cases {
        assert!(is_closed(&mesh), "{name}");
        assert!((volume(&mesh) - expected).abs() < tolerance, "{name}: {} {expected}", volume(&mesh));
    }
}

#[test]
fn a_cone_has_no_triangles_at_its_tip_that_are_none() {
    let cone =
        shape(|clay| clay.loft(&[oval(at(0.0, 0.0, 0.0), 1.0, 1.0, 9), oval(at(0.0, 0.0, 1.0), 0.0, 0.0, 9)], plain()));
    assert!(is_closed(&cone));
    assert_eq!(triangles(&cone).count(), 9 + 7);
}

#[test]
fn what_bends_little_is_smooth_and_what_bends_much_has_edges() {
    let ball = shape(|clay| clay.ball(Point::zeros(), [1.0; 3], 24, plain()));
    for vertex in ball.vertices() {
        let (position, normal) = (Point::from(vertex.position), Point::from(vertex.normal));
        assert!(normal.dot(&position) > 0.99, "{normal} at {position}");
    }
    let cube = shape(|clay| clay.cuboid([0.0; 3], [1.0; 3], plain()));
    assert_eq!((cube.vertices().len(), cube.indices().len()), (24, 36));
    assert!(cube.vertices().iter().all(|vertex| vertex.normal.iter().filter(|part| part.abs() == 1.0).count() == 1));
}

#[test]
fn a_mirrored_shape_faces_outward_on_both_sides() {
    let pair = shape(|clay| clay.mirrored(|clay| clay.cuboid([0.0, 1.0, 0.0], [1.0, 2.0, 1.0], plain())));
    assert!(is_closed(&pair) && (volume(&pair) - 2.0).abs() < 1e-5);
}

#[test]
fn a_person_of_parts_has_the_height_and_the_width_of_its_body() {
    let [min, max] = bounds(&person::trunk(1.0, &USUAL));
    assert!((max.z - person::SIZE[2]).abs() < 0.01, "{max}");
    let [_, arm] = bounds(&person::arm(1.0, &USUAL));
    assert!((arm.y + person::SHOULDER[0] - 0.5 * person::SIZE[1]).abs() < 0.01, "{arm}");
    assert!(max.y - min.y < person::SIZE[1] && max.x - min.x < person::SIZE[0]);
    let sole = bounds(&person::shin(&USUAL))[0].z;
    assert!((sole + person::SHIN).abs() < 1e-6 && (person::THIGH + person::SHIN - person::HIP[1]).abs() < 1e-6);
    assert!((bounds(&person::trunk(1.3, &USUAL))[1].z - person::SIZE[2]).abs() < 0.01);
}

#[test]
fn people_of_every_build_keep_within_the_outline_of_their_body() {
    for (index, garb) in GARBS.iter().enumerate() {
        for head in [1.0, 1.3] {
            let [min, max] = bounds(&person::trunk(head, garb));
            let half = 0.5 * person::SIZE[1] + 1e-6;
            assert!(max.y <= half && max.x <= half && min.x >= -half, "{index}: {min} {max}");
            assert!((max.z - person::SIZE[2]).abs() < 0.01, "{index}: {max}");
        }
    }
}

#[test]
fn texture_coordinates_are_metres_of_the_place() {
    let mut clay = Clay::default();
    clay.facet(&[at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(2.0, 1.0, 0.0)], plain());
    clay.facet(&[at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(2.0, 0.0, 3.0)], plain());
    let mesh = clay.mesh_at([10.0, 20.0]);
    let uv: Vec<[f32; 2]> = mesh.indices().iter().map(|index| mesh.vertices()[*index as usize].uv).collect();
    assert_eq!(uv, [[10.0, 20.0], [12.0, 20.0], [12.0, 21.0], [10.0, 0.0], [12.0, 0.0], [12.0, 3.0]]);
}

#[test]
fn there_are_few_enough_triangles_to_draw_many() {
    let count = |mesh: &Mesh| mesh.indices().len() / 3;
    let limbs = 2 * (count(&person::arm(1.0, &USUAL)) + count(&person::thigh(&USUAL)) + count(&person::shin(&USUAL)));
    for (what, found) in [
        ("car", count(&car::car())),
        ("van", count(&van::van())),
        ("truck", count(&truck::truck())),
        ("bus", count(&bus::bus())),
        ("motorcycle", count(&motorcycle::motorcycle())),
        ("bicycle", count(&bicycle::bicycle())),
        ("person", count(&person::trunk(1.0, &USUAL)) + limbs),
    ] {
        assert!((300..=800).contains(&found), "{what}: {found}");
    }
}
