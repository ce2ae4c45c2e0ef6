//! A car from very far away, where it is only a few pixels wide: a body, a cabin, wheels and lamps in some sixty triangles.

use super::super::SurfaceKind;
use super::super::clay::{Clay, Point, at, ring};
use super::super::colours::{BLACK, GLASS, LAMP, RUBBER};
use super::LENS;
use super::shell::{Shell, matter, paint};

/// The width of the cabin at its lower edge, as a share of the width of the body.
const CABIN: f32 = 0.93;

impl Shell {
    /// Adds a car with very few triangles.
    pub fn far(&self, clay: &mut Clay) {
        let (end, wide, low) = (self.half[0], self.wide(0.0), self.sill + 0.06);
        let (cowl, deck) = (self.cowl(), self.deck().max(0.02 - end));
        let profile = [
            [-end, low],
            [end, low],
            [end, self.belt(end)],
            [cowl, self.belt(cowl)],
            [deck, self.belt(deck)],
            [-end, self.belt(-end)],
        ];
        clay.prism(&profile, [-wide, wide], paint());
        let [rear, front] = self.roof_ends();
        let level = |[x0, z0]: [f32; 2], [x1, z1]: [f32; 2], y: f32| {
            vec![at(x0, -y, z0), at(x1, -y, z1), at(x1, y, z1), at(x0, y, z0)]
        };
        let base = level([deck, self.belt(deck)], [cowl, self.belt(cowl)], CABIN * wide);
        let roof = level(rear, front, self.roof_half_width());
        clay.facet(&roof, paint());
        clay.hose(&[base, roof], matter(SurfaceKind::Glass, GLASS));
        clay.mirrored(|clay| {
            for axle in self.axles {
                let wheel = ring(at(axle, self.half[1] - 0.005, self.wheel), Point::y(), self.wheel, 6);
                clay.facet(&wheel, matter(SurfaceKind::Plain, RUBBER));
            }
            let (nose, tail) = (self.belt(end), self.belt(-end));
            let quad = |x: f32, y: [f32; 2], z: [f32; 2]| {
                [at(x, y[0], z[0]), at(x, y[1], z[0]), at(x, y[1], z[1]), at(x, y[0], z[1])]
            };
            let [inner, outer] = [0.55 * wide, 0.97 * wide];
            clay.facet(
                &quad(end + 0.01, [inner, outer], [nose - 0.17, nose - 0.03]),
                matter(SurfaceKind::WhiteLamp, LAMP),
            );
            let lamp = quad(-end - 0.01, [outer, inner], [tail - 0.30, tail - 0.05]);
            clay.facet(&lamp, matter(SurfaceKind::RedLamp, LENS));
        });
        // The bumpers.
        let dark = matter(SurfaceKind::Plain, BLACK);
        for (x, side) in [(end + 0.01, 1.0), (-end - 0.01, -1.0)] {
            let y = 0.66 * wide * side;
            clay.facet(&[at(x, -y, low), at(x, y, low), at(x, y, low + 0.2), at(x, -y, low + 0.2)], dark);
        }
    }
}
