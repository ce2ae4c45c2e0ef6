//! Tests if a point is inside a mesh.

use crate::Mesh;
use nalgebra::Vector3;

/// The least winding number of a point inside. Around a closed mesh it is 1 for points inside and 0 for points outside;
/// around a mesh with holes it is less, and above a single sheet, however wide, at most 1/2.
const INSIDE: f64 = 0.6;

/// Returns `true` if a point in the mesh's coordinates is inside, by the generalised winding number: the sum of the
/// solid angles under which the triangles are seen (Jacobson et al. 2013; the angle after van Oosterom and Strackee
/// 1983).
pub(super) fn inside(mesh: &Mesh, point: &Vector3<f64>) -> bool {
    let towards = |corner: &u32| Vector3::from(mesh.vertices()[*corner as usize].position).cast::<f64>() - point;
    let half_angle = |triangle: &[u32]| {
        let [a, b, c] = [towards(&triangle[0]), towards(&triangle[1]), towards(&triangle[2])];
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let spanned = a.dot(&b.cross(&c));
        libm::atan2(spanned, la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb)
    };
    let half: f64 = mesh.indices().chunks_exact(3).map(half_angle).sum();
    half / (2.0 * std::f64::consts::PI) > INSIDE
}
