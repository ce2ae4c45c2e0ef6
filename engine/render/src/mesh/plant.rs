//! Trees: trunks, and crowns of two kinds.

use super::clay::{Clay, Matter, at, oval};
use super::colours::BARK;
use super::{Mesh, Semantic, SurfaceKind};

/// The size of the parts of a crown that are missing from afar, relative to the width of the crown.
pub(crate) const BOUGH: f32 = 0.08;
/// The size of the edges that a round trunk or pole has from afar, relative to its radius.
pub(super) const EDGE: f32 = 0.5;

/// A trunk of radius 1 and height 1, whose bark has the given surface.
pub(crate) fn trunk(surface: SurfaceKind) -> Mesh {
    let mut clay = Clay::default();
    let bark = Matter::new(surface, BARK, Semantic::Vegetation);
    let shape = |sides: usize| [(0.0, 1.0), (1.0, 0.6)].map(|(z, radius)| oval(at(0.0, 0.0, z), radius, radius, sides));
    clay.loft(&shape(8), bark);
    let mut far = Clay::default();
    far.hose(&shape(5), Matter { surface: SurfaceKind::Plain, ..bark });
    clay.mesh().with_coarse(far.mesh(), EDGE)
}

/// A crown in a box of 1 m each way: that of a conifer, or one of broad leaves.
pub(crate) fn crown(conifer: bool, colour: [f32; 3]) -> Mesh {
    let leaves = Matter::new(SurfaceKind::Grown, colour, Semantic::Vegetation);
    let mut clay = Clay::default();
    if conifer {
        for (low, wide, high, narrow) in [(0.0, 0.5, 0.45, 0.18), (0.28, 0.4, 0.74, 0.12), (0.56, 0.28, 1.0, 0.0)] {
            clay.loft(&[oval(at(0.0, 0.0, low), wide, wide, 9), oval(at(0.0, 0.0, high), narrow, narrow, 9)], leaves);
        }
    } else {
        let boughs = [
            (at(0.0, 0.02, 0.62), [0.40, 0.38, 0.38]),
            (at(0.25, 0.06, 0.38), [0.25, 0.27, 0.26]),
            (at(-0.18, 0.24, 0.34), [0.28, 0.26, 0.27]),
            (at(-0.06, -0.25, 0.36), [0.30, 0.25, 0.29]),
            (at(-0.22, -0.08, 0.56), [0.28, 0.30, 0.28]),
        ];
        for (centre, radii) in boughs {
            clay.ball(centre, radii, 8, leaves);
        }
    }
    clay.fitted([1.0; 3]).mesh()
}

/// A crown with few triangles, for trees that are so far away that leaves have no texture.
pub(crate) fn far_crown(conifer: bool, colour: [f32; 3]) -> Mesh {
    let leaves = Matter::new(SurfaceKind::Plain, colour, Semantic::Vegetation);
    let mut clay = Clay::default();
    if conifer {
        for (low, wide, high, narrow) in [(0.0, 0.5, 0.6, 0.16), (0.4, 0.34, 1.0, 0.0)] {
            clay.hose(&[oval(at(0.0, 0.0, low), wide, wide, 5), oval(at(0.0, 0.0, high), narrow, narrow, 5)], leaves);
        }
    } else {
        clay.ball(at(-0.04, 0.02, 0.56), [0.44, 0.42, 0.44], 6, leaves);
        clay.ball(at(0.02, 0.0, 0.34), [0.47, 0.46, 0.32], 6, leaves);
    }
    clay.fitted([1.0; 3]).mesh()
}
