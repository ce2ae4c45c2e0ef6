//! Kernels: the weights by which a lens spreads a point of light over the pixels around it.

/// A point spread function, which states how a lens distributes the light of a point over pixels. A kernel is a list of
/// pixels to the right of the point and down from it, with their shares of the point's light.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    shares: Vec<(i32, i32, f32)>,
}

/// The number of places along a pixel at which its coverage is sampled.
const PLACES: i32 = 16;

impl Kernel {
    /// Makes a Gaussian point spread function with a standard deviation in pixels, cut off at four standard deviations.
    /// It consists of one kernel along the rows and one along the columns. Apply the two kernels one after the other.
    pub fn gaussian(deviation: f64) -> [Self; 2] {
        let reach = libm::ceil(4.0 * deviation) as i32;
        let weight = |at: i32| libm::exp(-0.5 * f64::from(at * at) / (deviation * deviation));
        let along = |turn: fn(i32) -> (i32, i32)| Self::normalised((-reach..=reach).map(|at| (turn(at), weight(at))));
        [along(|at| (at, 0)), along(|at| (0, at))]
    }

    /// Makes the point spread function of an evenly bright disc with a radius in pixels.
    pub fn disc(radius: f64) -> Self {
        let reach = libm::ceil(radius + 0.5) as i32;
        let places = || (0..PLACES).map(|place| (f64::from(place) + 0.5) / f64::from(PLACES) - 0.5);
        let covered = |x: i32, y: i32| {
            let inside = |dx: f64, dy: f64| {
                let (x, y) = (f64::from(x) + dx, f64::from(y) + dy);
                x * x + y * y <= radius * radius
            };
            places().flat_map(|dx| places().map(move |dy| (dx, dy))).filter(|(dx, dy)| inside(*dx, *dy)).count() as f64
        };
        let all = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y)));
        let weights: Vec<_> = all.map(|(x, y)| ((x, y), covered(x, y))).filter(|(_, weight)| *weight > 0.0).collect();
        if weights.is_empty() {
            // The disc is smaller than the distance between samples: a point remains a point.
            return Self::normalised([((0, 0), 1.0)]);
        }
        Self::normalised(weights)
    }

    /// Makes the point spread function of an evenly bright line with a length in pixels, centred on the point. The line
    /// runs along an angle in radians, counter-clockwise from the right.
    pub fn line(length: f64, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        let steps = (f64::from(PLACES) * libm::ceil(length)).max(1.0) as i32;
        let mut weights = std::collections::BTreeMap::<(i32, i32), f64>::new();
        for step in 0..steps {
            let at = length * ((f64::from(step) + 0.5) / f64::from(steps) - 0.5);
            let (x, y) = (at * cos, -at * sin);
            let (left, above) = (libm::floor(x), libm::floor(y));
            // Each place gives its light to the four pixels around it, by their distance.
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let near = |far: f64, side: i32| if side == 1 { far } else { 1.0 - far };
                *weights.entry((left as i32 + dx, above as i32 + dy)).or_default() +=
                    near(x - left, dx) * near(y - above, dy);
            }
        }
        Self::normalised(weights.into_iter().filter(|(_, weight)| *weight > 0.0))
    }

    fn normalised(weights: impl IntoIterator<Item = ((i32, i32), f64)>) -> Self {
        let weights: Vec<_> = weights.into_iter().collect();
        let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
        Self { shares: weights.into_iter().map(|((x, y), weight)| (x, y, (weight / sum) as f32)).collect() }
    }

    /// Returns the shares of a point's light, each with the offset of its pixel to the right and down; the shares sum
    /// to 1.
    pub fn shares(&self) -> &[(i32, i32, f32)] {
        &self.shares
    }

    /// Spreads the light of every pixel of an image. The image has `width` pixels across, and the numbers red, green
    /// and blue for each pixel. Pixels beyond the edge are as bright as the edge.
    pub fn apply(&self, image: &[f32], width: usize) -> Vec<f32> {
        let height = image.len() / 3 / width;
        let mut spread = vec![0.0; image.len()];
        for (row, line) in spread.chunks_exact_mut(3 * width).enumerate() {
            for (dx, dy, share) in &self.shares {
                // If a point gives light to the right, a pixel receives light from its left.
                let from = (row as i32 - dy).clamp(0, height as i32 - 1) as usize;
                let source = &image[3 * width * from..][..3 * width];
                for (column, pixel) in line.chunks_exact_mut(3).enumerate() {
                    let at = (column as i32 - dx).clamp(0, width as i32 - 1) as usize;
                    pixel.iter_mut().zip(&source[3 * at..]).for_each(|(value, light)| *value += share * light);
                }
            }
        }
        spread
    }
}
