//! Houses of several storeys, with as many windows to a side as fit.

use super::clay::{Clay, Matter, Point, at, patch};
use super::colours::{GLASS, GREY, TILES, WHITE, WOOD};
use super::{Mesh, Semantic, SurfaceKind};

/// The plan of a house. The finished mesh is stretched to the size of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Plan {
    storeys: usize,
    /// The numbers of windows along and across the house.
    bays: [usize; 2],
}

/// The heights of a storey, of a gable roof, and of the wall around a flat roof.
const STOREY: f32 = 2.8;
const ROOF: f32 = 2.2;
const PARAPET: f32 = 0.5;
/// The length of the wall that belongs to a window.
const BAY: f32 = 2.9;
/// The most storeys under a gable roof, the most storeys of any house, and the most windows in a row.
const GABLED: usize = 3;
const STOREYS: usize = 30;
const BAYS: usize = 20;
/// The size of the panes, sills and frames that windows lack from afar, in metres.
const FRAME: f32 = 0.15;
/// The length in metres that is too small to be seen where the windows of a storey are one band.
const BETWEEN: f32 = 0.2 * BAY;
/// The colour of a roof of slate, in linear light.
const SLATE: [f32; 3] = [0.085, 0.085, 0.095];
/// The distance by which the roof extends beyond the walls.
const EAVES: f32 = 0.2;

fn matter(surface: SurfaceKind, colour: [f32; 3]) -> Matter {
    Matter::new(surface, colour, Semantic::Building)
}

/// The surfaces of a house.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Walls {
    /// Walls and roofs of one colour, in the look `flat`.
    Flat,
    /// Walls of brick under tiles.
    Brick,
    /// Plastered walls under tiles.
    Plaster,
}

/// The windows of a house, from near to very far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Windows {
    Framed,
    Panes,
    Rows,
    None,
}

impl Windows {
    const ALL: [Self; 4] = [Self::Framed, Self::Panes, Self::Rows, Self::None];

    /// Returns `true` if bricks and tiles still show where the house has such windows.
    fn is_near(self) -> bool {
        matches!(self, Self::Framed | Self::Panes)
    }
}

impl Walls {
    fn wall(self) -> Matter {
        let surface = match self {
            Self::Flat => SurfaceKind::Cloth,
            Self::Brick => SurfaceKind::Brick,
            Self::Plaster => SurfaceKind::Plaster,
        };
        Matter::painted(surface, Semantic::Building)
    }

    fn roof(self) -> Matter {
        match self {
            Self::Flat => matter(SurfaceKind::Plain, TILES),
            Self::Brick => matter(SurfaceKind::Tiles, SLATE),
            Self::Plaster => matter(SurfaceKind::Tiles, TILES),
        }
    }
}

impl Plan {
    /// Returns the plan of the house whose size is nearest to a length, a width and a height in metres.
    pub fn of([length, width, height]: [f32; 3]) -> Self {
        let count = |metres: f32, one: f32, most: usize| ((metres / one).round() as usize).clamp(1, most);
        let gabled = count(height - ROOF, STOREY, STOREYS);
        let storeys = if gabled <= GABLED { gabled } else { count(height - PARAPET, STOREY, STOREYS) };
        Self { storeys, bays: [length, width].map(|side| count(side, BAY, BAYS)) }
    }

    fn gabled(&self) -> bool {
        self.storeys <= GABLED
    }

    /// Returns the length, the width and the height of the house in metres.
    pub fn size(&self) -> [f32; 3] {
        let roof = if self.gabled() { ROOF } else { PARAPET };
        let [length, width] = self.bays.map(|bays| bays as f32 * BAY);
        [length, width, self.storeys as f32 * STOREY + roof]
    }

    /// Makes the house. In the look `textured`, windows have fewer parts from afar.
    pub fn mesh(&self, walls: Walls) -> Mesh {
        match walls {
            Walls::Flat => self.modelled(walls, Windows::Framed),
            Walls::Brick | Walls::Plaster => {
                let [framed, panes, rows, none] = Windows::ALL.map(|windows| self.modelled(walls, windows));
                framed.with_coarse(panes.with_coarse(rows.with_coarse(none, STOREY), BETWEEN), FRAME)
            }
        }
    }

    fn modelled(&self, walls: Walls, windows: Windows) -> Mesh {
        let [length, width, height] = self.size();
        let eaves = self.storeys as f32 * STOREY;
        let (x, y) = (0.5 * length - EAVES, 0.5 * width - EAVES);
        // From afar, bricks and tiles are too small to be seen.
        let far = |of: Matter, surface| if windows.is_near() { of } else { Matter { surface, ..of } };
        let (wall, top) = (far(walls.wall(), SurfaceKind::Cloth), far(walls.roof(), SurfaceKind::Plain));
        let mut clay = Clay::default();
        if self.gabled() {
            let gable = |x: f32| {
                vec![at(x, -y, 0.0), at(x, y, 0.0), at(x, y, eaves), at(x, 0.0, height - 0.1), at(x, -y, eaves)]
            };
            clay.loft(&[gable(-x), gable(x)], wall);
            clay.mirrored(|clay| roof(clay, [0.5 * length, 0.5 * width], [eaves, height], top));
        } else {
            clay.cuboid([-x, -y, 0.0], [x, y, height - 0.08], wall);
            clay.cuboid(
                [-x - EAVES, -y - EAVES, height - 0.3],
                [x + EAVES, y + EAVES, height],
                matter(SurfaceKind::Plain, GREY),
            );
        }
        let front = [at(x, -y, 0.0), at(x, y, 0.0), at(x, y, eaves), at(x, -y, eaves)];
        let back = [at(-x, y, 0.0), at(-x, -y, 0.0), at(-x, -y, eaves), at(-x, y, eaves)];
        let left = [at(x, y, 0.0), at(-x, y, 0.0), at(-x, y, eaves), at(x, y, eaves)];
        let add = |clay: &mut Clay, wall: [Point; 4], bays: usize, door: Option<usize>| match windows {
            Windows::Framed => self.windows(clay, wall, bays, door),
            Windows::Panes => self.panes(clay, wall, bays),
            Windows::Rows => self.rows(clay, wall),
            Windows::None => (),
        };
        add(&mut clay, front, self.bays[1], Some(self.bays[1] / 2));
        add(&mut clay, back, self.bays[1], None);
        clay.mirrored(|clay| add(clay, left, self.bays[0], None));
        clay.fitted([length, width, height]).mesh()
    }

    /// Adds a window for every storey and bay of a wall, and a door in one of the bays.
    fn windows(&self, clay: &mut Clay, wall: [Point; 4], bays: usize, door: Option<usize>) {
        let (white, glass) = (matter(SurfaceKind::Plain, WHITE), matter(SurfaceKind::Glass, GLASS));
        for (storey, bay) in (0..self.storeys).flat_map(|storey| (0..bays).map(move |bay| (storey, bay))) {
            let u = |share: f32| (bay as f32 + share) / bays as f32;
            let v = |share: f32| (storey as f32 + share) / self.storeys as f32;
            if storey == 0 && door == Some(bay) {
                clay.facet(&patch(wall, [u(0.28), u(0.72)], [0.0, v(0.80)], 0.02), white);
                clay.facet(&patch(wall, [u(0.32), u(0.68)], [0.0, v(0.77)], 0.04), matter(SurfaceKind::Plain, WOOD));
            } else {
                clay.facet(&patch(wall, [u(0.26), u(0.74)], [v(0.30), v(0.82)], 0.02), white);
                // Two panes.
                for [from, to] in [[0.29, 0.49], [0.51, 0.71]] {
                    clay.facet(&patch(wall, [u(from), u(to)], [v(0.33), v(0.79)], 0.04), glass);
                }
            }
        }
    }
}

impl Plan {
    /// Adds a pane for every storey and bay of a wall.
    fn panes(&self, clay: &mut Clay, wall: [Point; 4], bays: usize) {
        for (storey, bay) in (0..self.storeys).flat_map(|storey| (0..bays).map(move |bay| (storey, bay))) {
            let u = [0.27, 0.73].map(|share| (bay as f32 + share) / bays as f32);
            let v = [0.32, 0.81].map(|share| (storey as f32 + share) / self.storeys as f32);
            clay.facet(&patch(wall, u, v, 0.03), matter(SurfaceKind::Glass, GLASS));
        }
    }

    /// Adds a low pane for every storey of a wall, of the same area as the windows of the storey.
    fn rows(&self, clay: &mut Clay, wall: [Point; 4]) {
        for storey in 0..self.storeys {
            let v = [0.44, 0.69].map(|share| (storey as f32 + share) / self.storeys as f32);
            clay.facet(&patch(wall, [0.05, 0.95], v, 0.03), matter(SurfaceKind::Glass, GLASS));
        }
    }
}

/// Adds the left half of a gable roof.
fn roof(clay: &mut Clay, [x, y]: [f32; 2], [eaves, ridge]: [f32; 2], of: Matter) {
    let slab = |x: f32| vec![at(x, y, eaves - 0.18), at(x, y, eaves), at(x, 0.0, ridge), at(x, 0.0, ridge - 0.18)];
    clay.loft(&[slab(-x), slab(x)], of);
}
