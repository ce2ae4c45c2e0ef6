//! The assumption about signals before the first test: neighbouring pieces are correlated.
//!
//! A signal of seven pieces is seven axes, and a search that treats each axis separately begins with jagged signals.
//! But systems often fail at a level or a trend that lasts. So the first steps change a signal as an autoregressive
//! process would: the correlation of two pieces falls exponentially with their distance. This is only the start of a
//! search, which can learn any shape.

use nalgebra::DMatrix;
use paracosm_space::Space;

/// The correlation of two neighbouring pieces.
const NEIGHBOURS: f64 = 0.9;

/// Returns the covariance of the steps along the continuous coordinates of a space. Each step has variance 1.
pub(super) fn covariance(space: &Space) -> DMatrix<f64> {
    let owners: Vec<&str> = space.continuous().map(|coordinate| coordinate.parameter.name.as_str()).collect();
    DMatrix::from_fn(owners.len(), owners.len(), |i, j| {
        if owners[i] != owners[j] {
            return 0.0;
        }
        libm::pow(NEIGHBOURS, i.abs_diff(j) as f64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_of_a_signal_go_together_the_nearer_the_more_and_parameters_do_not() {
        let text = "parameter = [{ name = \"throttle\", interval = [0, 100], signal = { shape = \"piecewise-constant\",
            pieces = 3 } }, { name = \"slope\", interval = [0, 1] }, { name = \"brake\", interval = [0, 325],
            signal = { shape = \"polynomial\", degree = 1 } }]";
        let expected = [
            [1.0, 0.9, 0.81, 0.0, 0.0, 0.0],
            [0.9, 1.0, 0.9, 0.0, 0.0, 0.0],
            [0.81, 0.9, 1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0, 0.9],
            [0.0, 0.0, 0.0, 0.0, 0.9, 1.0],
        ];
        let covariance = covariance(&Space::from_toml(text).unwrap());
        let close = |i: usize, j: usize| (covariance[(i, j)] - expected[i][j]).abs() < 1e-12;
        assert!((0..6).all(|i| (0..6).all(|j| close(i, j))), "{covariance}");
        assert_eq!(super::covariance(&Space::unit_cube(2)), DMatrix::identity(2, 2));
    }
}
