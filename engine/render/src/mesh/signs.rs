//! The traffic signs of the look `textured`, after the Vienna Convention on Road Signs and Signals (1968).

use super::clay::{Clay, Matter, Point, at, ring};
use super::colours::{BLACK, GREY, WHITE};
use super::furniture::PLATE;
use super::{Mesh, Semantic, SurfaceKind};
use std::f32::consts::FRAC_PI_2;

const RED: [f32; 3] = [0.50, 0.012, 0.015];
const BLUE: [f32; 3] = [0.010, 0.085, 0.36];
const YELLOW: [f32; 3] = [0.82, 0.50, 0.02];

/// The distance between two layers of a sign, in metres.
const LAYER: f32 = 0.004;

/// A sign that is being painted, layer by layer.
struct Board {
    clay: Clay,
    /// The place of the uppermost layer.
    x: f32,
}

/// Makes the signs, whose kinds are equally frequent. They stand around the origin and face along x.
pub(crate) const SIGNS: [fn() -> Mesh; 13] = [
    || limit([3, 0]),
    || limit([5, 0]),
    || limit([7, 0]),
    give_way,
    stop,
    no_entry,
    priority,
    || warning(|board| board.bar([-0.022, 0.022], [-0.02, 0.13], BLACK)),
    || warning(|board| board.shape(&[[-0.10, -0.05], [0.10, -0.05], [0.0, 0.10]], BLACK)),
    crossing,
    parking,
    no_parking,
    keep_right,
];

/// Returns the corners of a regular polygon; `turn` is the angle of a corner, in radians from straight up.
fn polygon(sides: usize, radius: f32, turn: f32) -> Vec<[f32; 2]> {
    let (sin, cos) = libm::sincosf(turn);
    let turned = |corner: &Point| [corner.y * cos - corner.z * sin, corner.z * cos + corner.y * sin];
    ring(Point::zeros(), Point::x(), radius, sides).iter().map(turned).collect()
}

fn disc(radius: f32) -> Vec<[f32; 2]> {
    polygon(16, radius, 0.0)
}

impl Board {
    /// Begins a sign with its grey back and a first layer.
    fn new(outline: &[[f32; 2]], colour: [f32; 3]) -> Self {
        let mut clay = Clay::default();
        let layer = |x: f32| outline.iter().map(|[y, z]| at(x, *y, *z)).collect();
        clay.loft(&[layer(-0.012), layer(0.0)], matter(GREY));
        let mut board = Self { clay, x: 0.0 };
        board.shape(outline, colour);
        board
    }

    /// Adds a layer of a convex shape, whose corners are to the right and up, counter-clockwise as seen from before.
    fn shape(&mut self, corners: &[[f32; 2]], colour: [f32; 3]) {
        self.x += LAYER;
        let corners: Vec<Point> = corners.iter().map(|[y, z]| at(self.x, *y, *z)).collect();
        self.clay.facet(&corners, matter(colour));
    }

    fn bar(&mut self, y: [f32; 2], z: [f32; 2], colour: [f32; 3]) {
        self.shape(&[[y[0], z[0]], [y[1], z[0]], [y[1], z[1]], [y[0], z[1]]], colour);
    }

    /// Adds a digit of seven bars, whose middle is to the right of the middle of the sign.
    fn digit(&mut self, digit: usize, middle: f32) {
        // Bits for the bars: top, upper right, lower right, bottom, lower left, upper left, middle.
        const BARS: [u8; 10] = [0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f];
        let [y, z, thick] = [0.042, 0.085, 0.026];
        let wide = [middle - y, middle + y];
        let (left, right) = ([wide[0], wide[0] + thick], [wide[1] - thick, wide[1]]);
        let bars = [
            (wide, [z - thick, z]),
            (right, [0.0, z]),
            (right, [-z, 0.0]),
            (wide, [-z, thick - z]),
            (left, [-z, 0.0]),
            (left, [0.0, z]),
            (wide, [-0.5 * thick, 0.5 * thick]),
        ];
        for (bit, (y, z)) in bars.into_iter().enumerate() {
            if BARS[digit] & 1 << bit != 0 {
                self.bar(y, z, BLACK);
            }
        }
    }

    fn mesh(self) -> Mesh {
        self.clay.mesh()
    }
}

fn matter(colour: [f32; 3]) -> Matter {
    Matter::new(SurfaceKind::Plain, colour, Semantic::TrafficSign)
}

fn limit(digits: [usize; 2]) -> Mesh {
    let mut board = Board::new(&disc(PLATE), RED);
    board.shape(&disc(0.80 * PLATE), WHITE);
    board.digit(digits[0], -0.062);
    board.digit(digits[1], 0.062);
    board.mesh()
}

fn give_way() -> Mesh {
    let down = |radius: f32| polygon(3, radius, 2.0 * FRAC_PI_2);
    let mut board = Board::new(&down(PLATE), RED);
    board.shape(&down(0.66 * PLATE), WHITE);
    board.mesh()
}

fn stop() -> Mesh {
    let octagon = |radius: f32| polygon(8, radius, 0.25 * FRAC_PI_2);
    let mut board = Board::new(&octagon(PLATE), WHITE);
    board.shape(&octagon(0.94 * PLATE), RED);
    // Four letters, from afar.
    for letter in 0..4 {
        let left = 0.205 - 0.11 * letter as f32;
        board.bar([left - 0.08, left], [-0.065, 0.065], WHITE);
    }
    board.mesh()
}

fn no_entry() -> Mesh {
    let mut board = Board::new(&disc(PLATE), RED);
    board.bar([-0.22, 0.22], [-0.055, 0.055], WHITE);
    board.mesh()
}

fn priority() -> Mesh {
    let mut board = Board::new(&polygon(4, PLATE, 0.0), WHITE);
    board.shape(&polygon(4, 0.70 * PLATE, 0.0), YELLOW);
    board.mesh()
}

fn warning(symbol: impl Fn(&mut Board)) -> Mesh {
    let mut board = Board::new(&polygon(3, PLATE, 0.0), RED);
    board.shape(&polygon(3, 0.70 * PLATE, 0.0), WHITE);
    symbol(&mut board);
    board.mesh()
}

fn square() -> Vec<[f32; 2]> {
    polygon(4, 1.1 * PLATE, 0.5 * FRAC_PI_2)
}

fn crossing() -> Mesh {
    let mut board = Board::new(&square(), BLUE);
    board.shape(&[[-0.20, -0.16], [0.20, -0.16], [0.0, 0.20]], WHITE);
    // A person who walks over stripes.
    board.shape(&[[-0.028, 0.06], [0.028, 0.06], [0.028, 0.11], [-0.028, 0.11]], BLACK);
    board.shape(&[[-0.03, -0.04], [0.03, -0.04], [0.03, 0.05], [-0.03, 0.05]], BLACK);
    board.shape(&[[-0.075, -0.13], [-0.045, -0.13], [0.02, -0.04], [-0.02, -0.04]], BLACK);
    board.shape(&[[0.045, -0.13], [0.075, -0.13], [0.02, -0.04], [-0.02, -0.04]], BLACK);
    board.mesh()
}

fn parking() -> Mesh {
    let mut board = Board::new(&square(), BLUE);
    board.bar([-0.10, -0.05], [-0.17, 0.17], WHITE);
    board.bar([-0.06, 0.09], [0.12, 0.17], WHITE);
    board.bar([-0.06, 0.09], [-0.03, 0.02], WHITE);
    board.bar([0.05, 0.10], [-0.02, 0.16], WHITE);
    board.mesh()
}

fn no_parking() -> Mesh {
    let mut board = Board::new(&disc(PLATE), RED);
    board.shape(&disc(0.82 * PLATE), BLUE);
    board.shape(&[[-0.20, 0.17], [0.17, -0.20], [0.20, -0.17], [-0.17, 0.20]], RED);
    board.mesh()
}

fn keep_right() -> Mesh {
    let mut board = Board::new(&disc(PLATE), BLUE);
    board.shape(&[[0.05, -0.10], [0.10, -0.05], [-0.12, 0.17], [-0.17, 0.12]], WHITE);
    board.shape(&[[-0.02, -0.18], [0.18, -0.18], [0.18, 0.02]], WHITE);
    board.mesh()
}
