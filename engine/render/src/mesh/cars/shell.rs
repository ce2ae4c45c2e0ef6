//! The shell of a car: cross-sections along the car, connected to a body and to a cabin of glass.

use super::super::clay::{Clay, Matter, Point, at};
use super::super::colours::{BLACK, GLASS};
use super::super::{Semantic, SurfaceKind};
use super::Lines;

/// The width of the gap between a wheel and its arch, in metres.
const GAP: f32 = 0.055;
/// The share of the outline's half-width that the body fills; the mirrors fill the rest.
const WITHOUT_MIRRORS: f32 = 0.965;
/// The length over which the body becomes narrower towards its ends, in metres, and the narrowing at the very end.
const TAPER: [f32; 2] = [0.55, 0.16];

/// A car of some size that is being modelled.
pub(super) struct Shell {
    pub axles: [f32; 2],
    pub wheel: f32,
    pub sill: f32,
    /// Half of the length and half of the width of the outline.
    pub half: [f32; 2],
    pub bed: Option<[f32; 2]>,
    /// True if the car is modelled for a view from afar, with few triangles.
    pub coarse: bool,
    belt: Vec<[f32; 2]>,
    roof: Vec<[f32; 2]>,
    windows: Vec<[f32; 2]>,
    narrow: f32,
}

pub(super) fn matter(surface: SurfaceKind, colour: [f32; 3]) -> Matter {
    Matter::new(surface, colour, Semantic::Car)
}

pub(super) fn paint() -> Matter {
    Matter::painted(SurfaceKind::Paint, Semantic::Car)
}

/// Returns the height of a line of points at a place along the car.
fn height(line: &[[f32; 2]], x: f32) -> f32 {
    let [last, end] = line[line.len() - 1];
    let part = line.windows(2).find(|pair| x <= pair[1][0]);
    part.map_or(if x > last { end } else { line[0][1] }, |pair| {
        let share = ((x - pair[0][0]) / (pair[1][0] - pair[0][0])).clamp(0.0, 1.0);
        pair[0][1] + (pair[1][1] - pair[0][1]) * share
    })
}

impl Shell {
    /// Makes the shell of a kind of car for a length, a width and a height in metres.
    pub fn new(lines: &Lines, size: [f32; 3], coarse: bool) -> Self {
        let [along, _, up] = [0, 1, 2].map(|axis| size[axis] / lines.size[axis]);
        let scaled = |line: &[[f32; 2]]| line.iter().map(|[x, z]| [along * x, up * z]).collect();
        Self {
            axles: lines.axles.map(|x| along * x),
            wheel: up * lines.wheel,
            sill: up * lines.sill,
            half: [0.5 * size[0], 0.5 * size[1]],
            bed: lines.bed.map(|bed| bed.map(|x| along * x)),
            coarse,
            belt: scaled(lines.belt),
            roof: scaled(lines.roof),
            windows: lines.windows.iter().map(|window| window.map(|x| along * x)).collect(),
            narrow: lines.narrow,
        }
    }

    /// Returns the height of the upper edge of the body at a place along the car.
    pub fn belt(&self, x: f32) -> f32 {
        height(&self.belt, x)
    }

    /// Returns the place of the lower edge of the windscreen along the car.
    pub fn cowl(&self) -> f32 {
        self.roof[self.roof.len() - 1][0]
    }

    /// Returns the place of the lower edge of the rear window along the car.
    pub fn deck(&self) -> f32 {
        self.roof[0][0]
    }

    /// Returns the rear end and the front end of the roof: metres along the car, and metres up.
    pub fn roof_ends(&self) -> [[f32; 2]; 2] {
        [self.roof[1], self.roof[self.roof.len() - 2]]
    }

    /// Returns the half-width of the roof.
    pub fn roof_half_width(&self) -> f32 {
        self.narrow * self.half[1]
    }

    /// Returns the half-width of the body at a place along the car.
    pub fn wide(&self, x: f32) -> f32 {
        let near = ((x.abs() - (self.half[0] - TAPER[0])) / TAPER[0]).clamp(0.0, 1.0);
        WITHOUT_MIRRORS * self.half[1] * (1.0 - TAPER[1] * near * near)
    }

    /// Returns the height of the lower edge of a side: it goes around the wheels, and rises to the bumpers.
    fn low(&self, x: f32) -> f32 {
        let radius = self.wheel + GAP;
        let over = |axle: f32| {
            let off = x - axle;
            let square = radius * radius - off * off;
            if square > 0.0 { self.wheel + square.sqrt() } else { 0.0 }
        };
        let end = ((x.abs() - (self.half[0] - 0.14)) / 0.14).clamp(0.0, 1.0);
        over(self.axles[0]).max(over(self.axles[1])).max(self.sill + 0.10 * end * end)
    }

    /// Returns the places of the cross-sections of the body, from the rear to the front.
    fn stations(&self) -> Vec<f32> {
        let radius = self.wheel + GAP;
        let shares: &[f32] =
            if self.coarse { &[-1.001, -0.8, 0.8, 1.001] } else { &[-1.001, -0.95, -0.62, 0.0, 0.62, 0.95, 1.001] };
        let arches = self.axles.into_iter().flat_map(|axle| shares.iter().map(move |share| axle + share * radius));
        let belt = self.belt.iter().map(|point| point[0]);
        let inset: &[f32] = if self.coarse { &[0.0, 0.14] } else { &[0.0, 0.08, 0.3] };
        let ends = [-1.0, 1.0].into_iter().flat_map(|end| inset.iter().map(move |off| end * (self.half[0] - off)));
        let mut all: Vec<f32> = arches.chain(belt).chain(ends).chain(self.bed.into_iter().flatten()).collect();
        all.retain(|x| x.abs() <= self.half[0]);
        all.sort_by(f32::total_cmp);
        all.dedup_by(|a, b| (*a - *b).abs() < 0.012);
        all
    }

    /// Returns the left half of a cross-section of the body, from its lower edge to its middle.
    fn section(&self, x: f32) -> [Point; 6] {
        let (low, belt, wide) = (self.low(x), self.belt(x), self.wide(x));
        let waist = (belt - 0.19).max(low + 0.6 * (belt - low));
        let bulge = low + 0.45 * (waist - low);
        let crown = belt + 0.035;
        [
            at(x, wide - 0.05, low),
            at(x, wide - 0.006, bulge),
            at(x, wide, waist),
            at(x, wide - 0.085, belt),
            at(x, 0.5 * wide, crown),
            at(x, 0.0, crown + 0.012),
        ]
    }

    /// Adds the body without the cabin.
    pub fn body(&self, clay: &mut Clay) {
        let sections: Vec<[Point; 6]> = self.stations().into_iter().map(|x| self.section(x)).collect();
        // From afar, a side is flat, and so is the bonnet.
        let steps: &[[usize; 2]] =
            if self.coarse { &[[0, 2], [2, 3], [3, 5]] } else { &[[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]] };
        let in_bed = |x: f32| self.bed.is_some_and(|[rear, front]| rear < x && x < front);
        clay.mirrored(|clay| {
            for pair in sections.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                let open = in_bed(0.5 * (a[0].x + b[0].x));
                for [low, high] in steps.iter().filter(|[low, _]| !open || *low < 3) {
                    clay.facet(&[a[*low], a[*high], b[*high], b[*low]], paint());
                }
            }
            let end = |section: &[Point; 6]| {
                let mut end = vec![at(section[0].x, 0.0, section[0].z)];
                end.extend(section);
                end
            };
            clay.facet(&end(&sections[sections.len() - 1]), paint());
            clay.facet(&end(&sections[0]).into_iter().rev().collect::<Vec<_>>(), paint());
        });
    }

    /// Returns the left half of a cross-section of the cabin, from its lower edge to its middle.
    fn arch(&self, x: f32) -> [Point; 5] {
        let (belt, top) = (self.belt(x), height(&self.roof, x).max(self.belt(x) + 0.02));
        let full = self.roof.iter().map(|point| point[1]).fold(0.0, f32::max);
        let base = self.wide(x) - 0.085;
        let up = ((top - belt) / (full - belt)).clamp(0.0, 1.0);
        let eaves = base + (self.narrow * self.half[1] - base) * up;
        let side = belt + 0.86 * (top - belt);
        [
            at(x, base, belt),
            at(x, base + (eaves - base) * 0.80, side),
            at(x, eaves - 0.04, top - 0.25 * (top - side)),
            at(x, 0.55 * eaves, top + 0.006),
            at(x, 0.0, top + 0.014),
        ]
    }

    /// Adds the cabin: side windows between pillars, the windscreen, the rear window and the roof.
    pub fn cabin(&self, clay: &mut Clay) {
        // From afar, the side windows are one, and the roof is flat.
        let (count, whole) = (self.roof.len(), [self.windows[0][0], self.cowl()]);
        let windows = if self.coarse { std::slice::from_ref(&whole) } else { &self.windows };
        let ends = self.roof.iter().enumerate().filter(|(i, _)| !self.coarse || *i < 2 || *i + 2 >= count);
        let ends = ends.map(|(_, point)| point[0]);
        let mut stations: Vec<f32> = ends.chain(windows.iter().flatten().copied()).collect();
        stations.sort_by(f32::total_cmp);
        stations.dedup_by(|a, b| (*a - *b).abs() < 0.012);
        let (glass, dark) = (matter(SurfaceKind::Glass, GLASS), matter(SurfaceKind::Plain, BLACK));
        let roof = [self.roof[1][0], self.roof[self.roof.len() - 2][0]];
        let of = |x: f32, row: usize| match row {
            0 if windows.iter().any(|[rear, front]| *rear < x && x < *front) => glass,
            // The pillars between the windows, and before the first.
            0 if whole[0] < x => dark,
            2 | 3 if x < roof[0] || x > roof[1] => glass,
            _ => paint(),
        };
        let sections: Vec<[Point; 5]> = stations.iter().map(|x| self.arch(*x)).collect();
        clay.mirrored(|clay| {
            for (pair, x) in sections.windows(2).zip(stations.windows(2)) {
                let (a, b) = (pair[0], pair[1]);
                let steps: &[[usize; 2]] =
                    if self.coarse { &[[0, 1], [1, 2], [2, 4]] } else { &[[0, 1], [1, 2], [2, 3], [3, 4]] };
                for [low, high] in steps {
                    let of = of(0.5 * (x[0] + x[1]), *low);
                    clay.facet(&[a[*low], a[*high], b[*high], b[*low]], of);
                }
            }
        });
    }
}
