//! The details of a car: wheels with rims, lamps, plates, grille, bumpers, mirrors, seams, handles.

use super::super::SurfaceKind;
use super::super::clay::{Clay, Matter, Point, at, patch, ring};
use super::super::colours::{BLACK, GREY, LAMP, RUBBER, STEEL, WHITE};
use super::LENS;
use super::shell::{Shell, matter, paint};

/// The sides of a wheel, and its spokes.
const SIDES: usize = 12;
const SPOKES: usize = 5;
/// The radius of a rim as a share of the radius of its wheel.
const RIM: f32 = 0.66;
/// The width of a tyre in metres.
const TYRE: f32 = 0.21;

/// A bright and glossy surface.
fn chrome() -> Matter {
    matter(SurfaceKind::Glass, STEEL)
}

impl Shell {
    /// Adds all details.
    pub fn details(&self, clay: &mut Clay) {
        let dark = matter(SurfaceKind::Plain, BLACK);
        // The floor, and the insides of the wheel arches.
        let (length, inner) = (self.half[0] - 0.08, self.wide(0.0) - 0.22);
        clay.cuboid([-length, -inner, self.sill - 0.03], [length, inner, self.sill + 0.10], dark);
        let [rear, front] = [self.axles[0] - self.wheel, self.axles[1] + self.wheel];
        let top = self.belt(rear).min(self.belt(front)) - 0.04;
        if !self.coarse {
            clay.cuboid([rear - 0.06, -inner, self.sill], [front + 0.06, inner, top], dark);
        }
        self.front(clay);
        self.rear(clay);
        clay.mirrored(|clay| {
            self.axles.into_iter().for_each(|axle| self.wheel(clay, axle));
            self.side(clay);
        });
        if let Some([rear, front]) = self.bed {
            let (floor, top) = (self.sill + 0.26, self.belt(0.5 * (rear + front)) - 0.02);
            let inner = self.wide(0.5 * (rear + front)) - 0.09;
            let wall = |x: f32| [at(x, -inner, floor), at(x, inner, floor), at(x, inner, top), at(x, -inner, top)];
            clay.facet(&wall(rear), dark);
            clay.facet(&wall(front).into_iter().rev().collect::<Vec<_>>(), dark);
            clay.mirrored(|clay| {
                clay.facet(
                    &[at(rear, inner, floor), at(front, inner, floor), at(front, inner, top), at(rear, inner, top)],
                    dark,
                );
            });
        }
    }

    fn wheel(&self, clay: &mut Clay, x: f32) {
        let out = self.wide(x) - 0.012;
        let axle = |y: f32| at(x, y, self.wheel);
        let rubber = matter(SurfaceKind::Plain, RUBBER);
        if self.coarse {
            clay.tube([axle(out - TYRE), axle(out)], [self.wheel; 2], 8, rubber);
            let rim = ring(axle(out + 0.004), Point::y(), RIM * self.wheel, 6);
            return clay.facet(&rim, matter(SurfaceKind::Plain, GREY));
        }
        let tread = ring(axle(out - 0.015), Point::y(), self.wheel, SIDES);
        let edge = ring(axle(out), Point::y(), RIM * self.wheel, SIDES);
        clay.hose(&[ring(axle(out - TYRE), Point::y(), self.wheel, SIDES), tread, edge], rubber);
        let deep = ring(axle(out - 0.02), Point::y(), RIM * self.wheel, SIDES);
        clay.facet(&deep, matter(SurfaceKind::Plain, BLACK));
        let rim = ring(axle(out - 0.004), Point::y(), 0.97 * RIM * self.wheel, 4 * SPOKES);
        let hub = ring(axle(out - 0.010), Point::y(), 0.22 * self.wheel, 4 * SPOKES);
        for spoke in 0..SPOKES {
            let of = |corner: usize| (4 * spoke + corner) % (4 * SPOKES);
            let corners = [hub[of(4 * SPOKES - 1)], rim[of(0)], rim[of(1)], hub[of(2)]];
            clay.facet(&corners, chrome());
        }
        clay.facet(&ring(axle(out - 0.009), Point::y(), 0.22 * self.wheel, SPOKES), chrome());
    }

    fn front(&self, clay: &mut Clay) {
        let end = self.half[0];
        let (nose, wide) = (self.belt(end), self.wide(end));
        let low = self.sill + 0.10;
        let dark = matter(SurfaceKind::Plain, BLACK);
        // The intake below, the plate, and the grille between the lamps with a bright bar in it.
        let intake = low + 0.26 * (nose - low);
        clay.cuboid([end - 0.25, -0.66 * wide, low - 0.07], [end + 0.008, 0.66 * wide, intake], dark);
        let grille = [low + 0.60 * (nose - low), nose - 0.005];
        clay.cuboid([end - 0.10, -0.46 * wide, grille[0]], [end + 0.006, 0.46 * wide, grille[1]], dark);
        let middle = 0.5 * (grille[0] + grille[1]);
        let bar = [at(end + 0.010, -0.44 * wide, middle - 0.012), at(end + 0.010, 0.44 * wide, middle - 0.012)];
        let up = Point::z() * 0.024;
        clay.facet(&[bar[0], bar[1], bar[1] + up, bar[0] + up], chrome());
        self.plate(clay, end + 0.014, 1.0, (0.5 * (intake + grille[0]) - 0.055).min(grille[0] - 0.115));
        clay.mirrored(|clay| {
            // A lamp is a bright reflector in a dark housing that goes around the corner.
            let [bottom, top] = [grille[0] + 0.01, nose + 0.015];
            let (housing, lamp) = (matter(SurfaceKind::Glass, GREY), matter(SurfaceKind::WhiteLamp, LAMP));
            let tip = [at(end + 0.004, 0.50 * wide, bottom), at(end + 0.004, 0.99 * wide, bottom)];
            let back = at(end - 0.30, self.wide(end - 0.30) + 0.004, bottom + 0.05);
            let up = Point::z() * (top - bottom);
            let rise = Point::z() * (0.5 * (self.belt(end - 0.30) - nose));
            let front = [tip[0], tip[1], tip[1] + up, tip[0] + up];
            let side = [tip[1], back, back + 0.6 * up + rise, tip[1] + up];
            clay.facet(&front, housing);
            clay.facet(&side, housing);
            if self.coarse {
                return clay.facet(&patch(front, [0.1, 0.9], [0.18, 0.80], 0.006), lamp);
            }
            clay.facet(&[tip[0] + up, tip[1] + up, back + 0.6 * up + rise], housing);
            for [from, to] in [[0.10, 0.42], [0.54, 0.90]] {
                clay.facet(&patch(front, [from, to], [0.18, 0.80], 0.006), lamp);
            }
            clay.facet(&patch(side, [0.04, 0.45], [0.25, 0.75], 0.006), lamp);
        });
    }

    fn rear(&self, clay: &mut Clay) {
        let end = -self.half[0];
        let (top, wide) = (self.belt(end), self.wide(end));
        let low = self.sill + 0.10;
        let dark = matter(SurfaceKind::Plain, BLACK);
        clay.cuboid([end - 0.006, -0.80 * wide, low - 0.07], [end + 0.25, 0.80 * wide, low + 0.10], dark);
        if !self.coarse {
            clay.cuboid([end - 0.012, -0.98 * wide, low + 0.12], [end + 0.2, 0.98 * wide, low + 0.22], paint());
        }
        let bed = self.bed.is_some();
        self.plate(clay, end - 0.014, -1.0, if bed { low - 0.03 } else { low + 0.30 });
        clay.mirrored(|clay| {
            let lamp = matter(SurfaceKind::RedLamp, LENS);
            let inner = if bed { 0.80 * wide } else { 0.58 * wide };
            let bottom = if bed { low + 0.24 } else { low + 0.34 };
            let tip = [at(end - 0.008, inner, bottom), at(end - 0.008, 1.005 * wide, bottom)];
            let back = at(end + 0.20, self.wide(end + 0.20) + 0.008, bottom + 0.03);
            let up = Point::z() * (top + 0.02 - bottom).max(0.12);
            clay.facet(&[tip[1], tip[0], tip[0] + up, tip[1] + up], lamp);
            clay.facet(&[back, tip[1], tip[1] + up, back + 0.8 * up], lamp);
            let reverse = [at(end - 0.012, inner, bottom), at(end - 0.012, inner + 0.10, bottom)];
            let part = 0.25 * up;
            clay.facet(
                &[reverse[1], reverse[0], reverse[0] + part, reverse[1] + part],
                matter(SurfaceKind::Plain, WHITE),
            );
        });
    }

    /// Adds a number plate whose lower edge is at a height; it faces ahead for `side` 1, and back for -1.
    fn plate(&self, clay: &mut Clay, x: f32, side: f32, low: f32) {
        let quad = |clay: &mut Clay, off: f32, y: [f32; 2], z: [f32; 2], colour: [f32; 3]| {
            let x = x + side * off;
            let corner = |y: f32, z: f32| at(x, side * y, low + z);
            let corners = [corner(y[0], z[0]), corner(y[1], z[0]), corner(y[1], z[1]), corner(y[0], z[1])];
            clay.facet(&corners, matter(SurfaceKind::Plain, colour));
        };
        quad(clay, 0.0, [-0.26, 0.26], [0.0, 0.11], WHITE);
        if self.coarse {
            return;
        }
        quad(clay, 0.003, [-0.26, -0.22], [0.0, 0.11], [0.0, 0.03, 0.35]);
        // Letters, from afar.
        for letters in [[-0.19, -0.05], [-0.01, 0.08], [0.11, 0.22]] {
            quad(clay, 0.003, letters, [0.030, 0.080], GREY);
        }
    }

    /// Adds the mirror, the seams of the doors, their handles and a dark strip below, on the left side.
    fn side(&self, clay: &mut Clay) {
        let dark = matter(SurfaceKind::Plain, BLACK);
        let cowl = self.cowl();
        let mirror = cowl - 0.40;
        let belt = self.belt(mirror);
        clay.cuboid(
            [mirror - 0.08, self.wide(mirror) - 0.12, belt + 0.0],
            [mirror, self.half[1] - 0.08, belt + 0.03],
            dark,
        );
        clay.cuboid(
            [mirror - 0.10, self.half[1] - 0.19, belt + 0.02],
            [mirror + 0.02, self.half[1], belt + 0.15],
            paint(),
        );
        clay.facet(
            &[
                at(mirror - 0.102, self.half[1] - 0.01, belt + 0.03),
                at(mirror - 0.102, self.half[1] - 0.18, belt + 0.03),
                at(mirror - 0.102, self.half[1] - 0.18, belt + 0.14),
                at(mirror - 0.102, self.half[1] - 0.01, belt + 0.14),
            ],
            matter(SurfaceKind::Glass, STEEL),
        );
        if self.coarse {
            return;
        }
        let [rear, front] = [self.axles[0] + self.wheel + 0.14, self.axles[1] - self.wheel - 0.14];
        let ahead = cowl - 0.42;
        let middle = 0.5 * (rear.max(self.deck() + 0.3) + ahead) + 0.05;
        for seam in [rear.max(self.deck() + 0.3), middle, ahead.min(front)] {
            let (out, top) = (self.wide(seam) + 0.004, self.belt(seam));
            let corner = |x: f32, z: f32| at(x, out, z);
            clay.facet(
                &[
                    corner(seam + 0.014, self.sill + 0.08),
                    corner(seam, self.sill + 0.08),
                    corner(seam, top - 0.17),
                    corner(seam + 0.014, top - 0.17),
                ],
                dark,
            );
        }
        for handle in [middle - 0.24, ahead.min(front) - 1.0] {
            let (out, z) = (self.wide(handle), self.belt(handle) - 0.21);
            if handle > rear && handle < front {
                clay.cuboid([handle, out - 0.02, z], [handle + 0.17, out + 0.012, z + 0.03], paint());
            }
        }
        let out = self.wide(0.0) - 0.03;
        clay.cuboid([rear - 0.1, out - 0.12, self.sill - 0.02], [front + 0.1, out, self.sill + 0.05], dark);
    }
}
