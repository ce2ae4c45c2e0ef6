//! Lets the lamps of a vehicle shine: brake lamps and direction indicators, on any mesh that has lamps.

use super::clay::{Clay, Matter};
use super::{Mesh, SurfaceKind, Vertex};

/// The colours of a brake lamp and of an indicator that shine, in linear light.
const BRAKE: [f32; 3] = [1.0, 0.08, 0.05];
const AMBER: [f32; 3] = [1.0, 0.32, 0.01];
/// The share of a lamp's width that its indicator takes at the outer end, the share of its height from below, the greatest
/// depth of an indicator in metres, and how far it stands out.
const WIDE: f32 = 0.45;
const HIGH: f32 = 0.60;
const DEEP: f32 = 0.09;
const OUT: f32 = 0.006;

/// The lamps of a vehicle that shine now.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Lit {
    pub brakes: bool,
    pub left: bool,
    pub right: bool,
}

impl Lit {
    pub fn is_any(self) -> bool {
        self != Self::default()
    }
}

/// Returns a copy of a vehicle's mesh whose lamps shine.
pub(crate) fn shining(mesh: &Mesh, lit: Lit) -> Mesh {
    let mut vertices = mesh.vertices().to_vec();
    let mut indices = mesh.indices().to_vec();
    for side in [(lit.left, 1.0), (lit.right, -1.0)].into_iter().filter_map(|(is_lit, side)| is_lit.then_some(side)) {
        for lamp in [SurfaceKind::RedLamp, SurfaceKind::WhiteLamp] {
            if let Some(indicator) = indicator(mesh, lamp, side) {
                let first = vertices.len() as u32;
                vertices.extend_from_slice(indicator.vertices());
                indices.extend(indicator.indices().iter().map(|index| first + index));
            }
        }
    }
    if lit.brakes {
        for vertex in vertices.iter_mut().filter(|vertex| vertex.surface == SurfaceKind::RedLamp) {
            (vertex.surface, vertex.colour) = (SurfaceKind::Glow, BRAKE);
        }
    }
    let shown = Mesh::new(vertices, indices);
    match mesh.coarse() {
        Some(coarse) => shown.with_coarse(shining(coarse, lit), mesh.detail()),
        None => shown,
    }
}

/// Makes the indicator at the outer end of the lamps of a kind on a side: 1 is left, -1 is right.
fn indicator(mesh: &Mesh, lamp: SurfaceKind, side: f32) -> Option<Mesh> {
    let lamps = || mesh.vertices().iter().filter(|vertex| vertex.surface == lamp && side * vertex.position[1] > 0.0);
    let Vertex { semantic, .. } = lamps().next()?;
    let end = |axis: usize, best: fn(f32, f32) -> f32| lamps().map(|vertex| vertex.position[axis]).reduce(best);
    let ([x0, x1], [z0, z1]) = ([end(0, f32::min)?, end(0, f32::max)?], [end(2, f32::min)?, end(2, f32::max)?]);
    let far = |sign: f32| lamps().map(|vertex| sign * vertex.position[1] * side).fold(f32::NEG_INFINITY, f32::max);
    let (outer, inner) = (far(1.0), -far(-1.0));
    let y = [side * (outer - WIDE * (outer - inner)), side * (outer + OUT)];
    // Rear lamps are at the low end, and head lamps at the high end.
    let x = match lamp {
        SurfaceKind::RedLamp => [x0 - OUT, x1.min(x0 + DEEP)],
        _ => [x0.max(x1 - DEEP), x1 + OUT],
    };
    let mut clay = Clay::default();
    clay.cuboid(
        [x[0], y[0].min(y[1]), z0],
        [x[1], y[0].max(y[1]), z0 + HIGH * (z1 - z0)],
        Matter::new(SurfaceKind::Glow, AMBER, *semantic),
    );
    Some(clay.mesh())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{bus, cars, motorcycle, truck, van};

    fn count(mesh: &Mesh, is_meant: impl Fn(&Vertex) -> bool) -> usize {
        mesh.vertices().iter().filter(|vertex| vertex.surface == SurfaceKind::Glow && is_meant(vertex)).count()
    }

    #[test]
    fn every_vehicle_has_brake_lamps_behind_and_indicators_at_all_four_corners() {
        let cars = (0..cars::KINDS.len()).map(|kind| cars::car(kind, cars::KINDS[kind].size));
        for mesh in cars.chain([van::van(), truck::truck(), bus::bus(), motorcycle::motorcycle()]) {
            for near in [true, false] {
                let seen = |lit: Lit| {
                    let mesh = shining(&mesh, lit);
                    let coarse = mesh.coarse().cloned();
                    match coarse.filter(|_| !near) {
                        Some(coarse) => (0..4).map(|corner| corner_count(&coarse, corner)).collect::<Vec<_>>(),
                        None => (0..4).map(|corner| corner_count(&mesh, corner)).collect(),
                    }
                };
                let is_lit = |lit: Lit| seen(lit).iter().map(|count| *count > 0).collect::<Vec<_>>();
                // The corners are: front left, front right, rear left, rear right.
                assert_eq!(is_lit(Lit { brakes: true, ..Lit::default() }), [false, false, true, true]);
                assert_eq!(is_lit(Lit { left: true, ..Lit::default() }), [true, false, true, false]);
                assert_eq!(is_lit(Lit { right: true, ..Lit::default() }), [false, true, false, true]);
            }
        }
    }

    fn corner_count(mesh: &Mesh, corner: usize) -> usize {
        let (front, left) = (corner < 2, corner.is_multiple_of(2));
        count(mesh, |vertex| (vertex.position[0] > 0.0) == front && (vertex.position[1] > 0.0) == left)
    }
}
