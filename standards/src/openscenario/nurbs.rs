//! Rational B-splines (NURBS): smooth curves that control points attract.
//!
//! L. Piegl, W. Tiller: The NURBS Book, 2nd edition, 1997, algorithms A2.1 and A2.2 and equation 4.2.

use super::scope::Node;
use crate::xml::{Flaw, ReadError};

/// The weights and the knots of a curve.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Nurbs {
    degree: usize,
    weights: Vec<f64>,
    knots: Vec<f64>,
}

impl Nurbs {
    /// Reads an element `Nurbs` with `count` control points.
    pub fn read(node: Node<'_>, count: usize) -> Result<Self, ReadError> {
        let weight =
            |point: Node<'_>| if point.element.text("weight").is_some() { point.positive("weight") } else { Ok(1.0) };
        let weights = node.all("ControlPoint").map(weight).collect::<Result<Vec<_>, ReadError>>()?;
        let knots = node.all("Knot").map(|knot| knot.number("value")).collect::<Result<Vec<_>, ReadError>>()?;
        let order = node.whole("order")?;
        let degree = usize::try_from(order).ok().and_then(|order| order.checked_sub(1)).filter(|degree| *degree >= 1);
        let wrong = |expected: String| {
            let (element, attribute, found) = (node.name().to_owned(), "order".to_owned(), order.to_string());
            node.error(Flaw::Value { element, attribute, found, expected, nearest: None })
        };
        let degree = degree.filter(|degree| count > *degree);
        let degree =
            degree.ok_or_else(|| wrong(format!("a number from 2 to {count}, the number of control points")))?;
        let rises = knots.windows(2).all(|pair| pair[0] <= pair[1]);
        if knots.len() != count + degree + 1 || !rises || knots.get(degree) >= knots.get(count) {
            return Err(wrong(format!("with {} knots that rise, not {}", count + degree + 1, knots.len())));
        }
        Ok(Self { degree, weights, knots })
    }

    /// Returns the shares of the control points in a place on the curve. `u` in [0, 1] is the part of the knots before the place. The
    /// shares add up to 1.
    pub fn shares(&self, u: f64) -> Vec<f64> {
        let mut shares: Vec<f64> =
            self.functions(u).iter().zip(&self.weights).map(|(value, weight)| value * weight).collect();
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        shares
    }

    /// Returns the value of the function of each control point, without its weight. The values add up to 1.
    pub fn functions(&self, u: f64) -> Vec<f64> {
        let (p, count) = (self.degree, self.weights.len());
        let (first, last) = (self.knots[p], self.knots[count]);
        let at = first + (last - first) * u.clamp(0.0, 1.0);
        // The last span that is not empty, for the last place.
        let after = if at < last {
            self.knots.partition_point(|knot| *knot <= at)
        } else {
            self.knots.partition_point(|knot| *knot < last)
        };
        let span = after.clamp(p + 1, count) - 1;
        // The functions of the degrees 0 to p that are not 0 at this place.
        let mut values = vec![1.0];
        for degree in 1..=p {
            let mut next = vec![0.0; degree + 1];
            for (r, value) in values.iter().enumerate() {
                let (left, right) = (self.knots[span + 1 + r - degree], self.knots[span + 1 + r]);
                let share = value / (right - left);
                next[r] += (right - at) * share;
                next[r + 1] += (at - left) * share;
            }
            values = next;
        }
        let mut functions = vec![0.0; count];
        functions[span - p..=span].copy_from_slice(&values);
        functions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_of_a_circle_is_a_rational_curve() {
        let weights = vec![1.0, std::f64::consts::FRAC_1_SQRT_2, 1.0];
        let quarter = Nurbs { degree: 2, weights, knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0] };
        for u in [0.0, 0.2, 0.5, 1.0] {
            let shares = quarter.shares(u);
            let (x, y) = (shares[0] + shares[1], shares[1] + shares[2]);
            assert!((libm::hypot(x, y) - 1.0).abs() < 1e-12, "({x}, {y})");
        }
        assert_eq!(quarter.shares(1.0), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_knot_that_occurs_more_often_than_needed_changes_nothing() {
        let curve = Nurbs { degree: 2, weights: vec![1.0; 4], knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0] };
        assert_eq!(curve.shares(1.0), [0.0, 0.0, 1.0, 0.0]);
        assert_eq!(curve.shares(0.5), [0.25, 0.5, 0.25, 0.0]);
    }
}
