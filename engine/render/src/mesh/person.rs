//! The parts of a person. Each part turns about a joint, which lies at the origin of the part's mesh.

use super::clay::{Clay, Matter, Point, at, oval};
use super::garb::{Cut, Garb, Hair};
use super::{Mesh, Semantic, SurfaceKind};

/// Depth, width and height of the whole person as modelled, in metres. Width and height are those of
/// [`Body::adult`](paracosm_engine::object::Body::adult).
pub(crate) const SIZE: [f32; 3] = [0.5, 0.5, 1.8];

/// The place of the hip joint: to the side, and up.
pub(crate) const HIP: [f32; 2] = [0.095, 0.92];
/// The place of the shoulder joint: to the side, and up.
pub(crate) const SHOULDER: [f32; 2] = [0.195, 1.44];
/// The length of the thigh, from the hip to the knee.
pub(crate) const THIGH: f32 = 0.44;
/// The length of the shin, from the knee to the sole.
pub(crate) const SHIN: f32 = 0.48;
/// The reach of the sole behind the knee and ahead of it.
pub(crate) const SOLE: [f32; 2] = [-0.09, 0.17];

fn matter(colour: [f32; 3]) -> Matter {
    Matter::new(SurfaceKind::Plain, colour, Semantic::Pedestrian)
}

fn jacket() -> Matter {
    Matter::painted(SurfaceKind::Cloth, Semantic::Pedestrian)
}

/// Makes the hips, trunk, neck and head, above the middle between the soles. The head of a child is larger relative to
/// its body.
pub(crate) fn trunk(head: f32, garb: &Garb) -> Mesh {
    let mut clay = Clay::default();
    let stack = |layers: &[(f32, f32, f32)]| -> Vec<Vec<Point>> {
        layers.iter().map(|(z, deep, wide)| oval(at(0.0, 0.0, *z), *deep, *wide, 8)).collect()
    };
    let (deep, wide) = (garb.belly, 0.5 + 0.5 * garb.belly);
    clay.loft(
        &stack(&[(0.82, 0.08, 0.13), (0.90, 0.115 * deep, 0.175 * wide), (0.99, 0.105 * deep, 0.165 * wide)]),
        matter(garb.trousers),
    );
    let jacket_layers = [
        (0.93, 0.13 * deep, 0.19 * wide),
        (1.10, 0.115 * deep, 0.165 * wide),
        (1.30, 0.13, 0.195),
        (1.43, 0.105, 0.205),
        (1.50, 0.06, 0.10),
    ];
    clay.loft(&stack(&jacket_layers), jacket());
    match garb.cut {
        Cut::Jacket | Cut::Shirt => {}
        Cut::Coat => clay.loft(&stack(&[(0.58, 0.17, 0.205), (0.95, 0.135 * deep, 0.192 * wide)]), jacket()),
        Cut::Skirt => {
            clay.loft(&stack(&[(0.52, 0.19, 0.215), (0.98, 0.12 * deep, 0.172 * wide)]), matter(garb.trousers));
        }
    }
    if let Some(bag) = garb.bag {
        clay.cuboid([-0.245, -0.135, 1.04], [-0.10, 0.135, 1.42], matter(bag));
    }
    let neck = 1.8 - 0.29 * head;
    clay.loft(&stack(&[(1.46, 0.05, 0.05), (neck + 0.06, 0.05, 0.05)]), matter(garb.skin));
    let radius = 0.125 * head;
    clay.ball(at(0.015, 0.0, 1.785 - radius), [0.8 * radius, 0.66 * radius, radius], 8, matter(garb.skin));
    let crown = at(-0.016 * head, 0.0, 1.8 - 0.72 * radius);
    let hair = matter(garb.hair);
    clay.ball(
        crown,
        [0.8 * radius, 0.74 * radius, 0.72 * radius],
        8,
        if garb.hairdo == Hair::Cap { jacket() } else { hair },
    );
    if garb.hairdo == Hair::Long {
        let lock = |z: f32, deep: f32, wide: f32| oval(at(-0.045 * head, 0.0, z), deep * head, wide * head, 8);
        clay.loft(&[lock(1.44, 0.045, 0.085), lock(1.72, 0.06, 0.095)], hair);
    }
    // A nose shows which way the person looks.
    clay.cuboid(
        [0.1 * head, -0.012, 1.76 - radius],
        [0.8 * radius + 0.035, 0.012, 1.785 - 0.85 * radius],
        matter(garb.skin),
    );
    clay.mesh()
}

/// Makes an arm that hangs from the shoulder: the left arm for `side` 1, its mirror image for -1.
pub(crate) fn arm(side: f32, garb: &Garb) -> Mesh {
    let mut clay = Clay::default();
    let (elbow, wrist) = (at(-0.02, side * 0.01, -0.29), at(0.05, side * 0.005, -0.54));
    let sleeve = if garb.cut == Cut::Shirt { matter(garb.skin) } else { jacket() };
    clay.ball(at(0.0, 0.0, 0.0), [0.06, 0.055, 0.06], 6, jacket());
    clay.tube([elbow, at(0.0, 0.0, 0.0)], [0.044, 0.053], 6, jacket());
    clay.tube([wrist, elbow], [0.034, 0.044], 6, sleeve);
    clay.ball(wrist + at(0.015, 0.0, -0.05), [0.04, 0.025, 0.07], 6, matter(garb.skin));
    clay.mesh()
}

/// Makes a leg from the hip to the knee.
pub(crate) fn thigh(garb: &Garb) -> Mesh {
    let mut clay = Clay::default();
    clay.tube([at(0.0, 0.0, -THIGH - 0.02), at(0.0, 0.0, 0.03)], [0.062, 0.09], 7, matter(garb.trousers));
    clay.mesh()
}

/// Makes a leg from the knee to the sole.
pub(crate) fn shin(garb: &Garb) -> Mesh {
    let mut clay = Clay::default();
    clay.tube([at(-0.01, 0.0, 0.09 - SHIN), at(0.0, 0.0, 0.03)], [0.045, 0.062], 7, matter(garb.shins()));
    let [heel, toe] = SOLE;
    let shoe = [[heel, -SHIN], [toe, -SHIN], [toe, 0.04 - SHIN], [0.05, 0.11 - SHIN], [heel, 0.11 - SHIN]];
    clay.prism(&shoe, [-0.045, 0.045], matter(garb.shoes));
    clay.mesh()
}
