//! A test as coordinates, which strategies propose and coverage measures use.

/// The coordinates of a test, in the order of the space's parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Point {
    /// The coordinates in `[0,1]` of the continuous parameters, one for each parameter and several for a signal.
    pub continuous: Vec<f64>,
    /// The level indices of the discrete parameters, one for each parameter and several for a signal.
    pub discrete: Vec<usize>,
}
