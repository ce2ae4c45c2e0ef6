//! Piecewise cubic polynomials along a road: widths, borders, offsets and heights.

/// A cubic polynomial a + b·ds + c·ds² + d·ds³ from a place on, where ds is the distance from the place in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// The place at which the polynomial begins, in metres along the road.
    pub s: f64,
    /// The coefficients a, b, c and d.
    pub coefficients: [f64; 4],
}

impl Cubic {
    /// Returns the value at a place, in metres along the road.
    pub fn at(&self, s: f64) -> f64 {
        value(&self.coefficients, s - self.s)
    }

    /// Returns the derivative at a place, in metres along the road.
    pub fn slope(&self, s: f64) -> f64 {
        slope(&self.coefficients, s - self.s)
    }
}

/// Returns the value of the polynomial a + b·x + c·x² + d·x³.
pub(super) fn value([a, b, c, d]: &[f64; 4], x: f64) -> f64 {
    a + x * (b + x * (c + x * d))
}

/// Returns the derivative of the polynomial a + b·x + c·x² + d·x³.
pub(super) fn slope([_, b, c, d]: &[f64; 4], x: f64) -> f64 {
    b + x * (2.0 * c + x * 3.0 * d)
}

/// Returns the second derivative of the polynomial a + b·x + c·x² + d·x³.
pub(super) fn bend([_, _, c, d]: &[f64; 4], x: f64) -> f64 {
    2.0 * c + 6.0 * d * x
}

/// A function of the place along a road that consists of cubic polynomials. It is zero before the first polynomial.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cubics(Vec<Cubic>);

impl Cubics {
    /// Makes the function from polynomials, in the order of their places.
    pub(super) fn new(pieces: Vec<Cubic>) -> Self {
        debug_assert!(pieces.is_sorted_by_key(|piece| piece.s));
        Self(pieces)
    }

    /// Returns all polynomials in the order of their places.
    pub fn pieces(&self) -> &[Cubic] {
        &self.0
    }

    /// Returns the value at a place, in metres along the road.
    pub fn at(&self, s: f64) -> f64 {
        self.piece(s).map_or(0.0, |piece| piece.at(s))
    }

    /// Returns the derivative at a place, in metres along the road.
    pub fn slope(&self, s: f64) -> f64 {
        self.piece(s).map_or(0.0, |piece| piece.slope(s))
    }

    /// Returns the value and the derivative at a place, in metres along the road.
    pub(super) fn at_with_slope(&self, s: f64) -> [f64; 2] {
        self.piece(s).map_or([0.0; 2], |piece| [piece.at(s), piece.slope(s)])
    }

    fn piece(&self, s: f64) -> Option<&Cubic> {
        // Most functions have one polynomial.
        match self.0.as_slice() {
            [only] => (only.s <= s).then_some(only),
            pieces => pieces.get(pieces.partition_point(|piece| piece.s <= s).checked_sub(1)?),
        }
    }

    /// Returns the greatest magnitude of the function between two places, in metres along the road.
    pub fn greatest(&self, from: f64, to: f64) -> f64 {
        self.extremes(from, to).into_iter().map(|extreme| extreme.value.abs()).fold(0.0, f64::max)
    }

    /// Returns the places between two places at which the function can be least or greatest: its local extremes, and both ends of
    /// each polynomial.
    pub(super) fn extremes(&self, from: f64, to: f64) -> Vec<Extreme> {
        let ends = self.0.iter().map(|piece| piece.s).skip(1).chain([to]);
        let of = |(index, (piece, end)): (usize, (&Cubic, f64))| {
            let [from, to] = [piece.s.max(from), end.min(to)];
            let [_, b, c, d] = piece.coefficients;
            let inner = extremes(b, c, d).map(|x| piece.s + x).into_iter().filter(move |s| from < *s && *s < to);
            let places = [from, to].into_iter().filter(move |_| from <= to).chain(inner);
            places.map(|s| Extreme { piece: index, s, value: piece.at(s) }).collect::<Vec<_>>()
        };
        self.0.iter().zip(ends).enumerate().flat_map(of).collect()
    }
}

/// A place at which a function can be least or greatest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extreme {
    /// The index of the polynomial.
    pub piece: usize,
    /// The place in metres along the road.
    pub s: f64,
    /// The value of the function.
    pub value: f64,
}

/// Returns the places at which b + 2·c·x + 3·d·x² is zero; NaN for places that do not exist.
fn extremes(b: f64, c: f64, d: f64) -> [f64; 2] {
    if d == 0.0 {
        return [-b / (2.0 * c), f64::NAN];
    }
    let root = (c * c - 3.0 * b * d).sqrt();
    [(-c - root) / (3.0 * d), (-c + root) / (3.0 * d)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_value_of_a_function_is_greater_than_its_greatest_magnitude(
            pieces in prop::collection::vec(prop::array::uniform4(-2.0..2.0), 1..4), from in -1.0..2.0, length in 0.0..9.0
        ) {
            let place = |(i, coefficients)| Cubic { s: 2.0 * i as f64, coefficients };
            let cubics = Cubics::new(pieces.into_iter().enumerate().map(place).collect());
            let values = (0..=300).map(|i| cubics.at(from + length * f64::from(i) / 300.0).abs());
            let (greatest, seen) = (cubics.greatest(from, from + length), values.fold(0.0, f64::max));
            prop_assert!(seen <= greatest + 1e-9 * (1.0 + greatest), "{seen} of {greatest}");
        }

        #[test]
        fn the_slope_of_a_function_is_the_quotient_of_its_differences(
            coefficients in prop::array::uniform4(-2.0..2.0), s in 0.0..5.0
        ) {
            let cubics = Cubics::new(vec![Cubic { s: 0.0, coefficients }]);
            let quotient = (cubics.at(s + 1e-5) - cubics.at(s - 1e-5)) / 2e-5;
            prop_assert!((cubics.slope(s + 1e-5) - quotient).abs() < 0.01);
        }
    }

    #[test]
    fn a_function_is_zero_before_its_first_polynomial() {
        let cubics = Cubics::new(vec![Cubic { s: 10.0, coefficients: [3.0, 1.0, 0.0, 0.0] }]);
        assert_eq!([9.9, 10.0, 11.0].map(|s| cubics.at(s)), [0.0, 3.0, 4.0]);
    }
}
