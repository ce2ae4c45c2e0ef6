//! Represents the value of a parameter during shrinking: its nominal value, or a few values of its own.
//!
//! A signal with many coordinates may be equal to a signal with fewer: a constant, or a signal with longer pieces or
//! a lower degree. Here the signal is kept as the knots that define the smaller signal, and expanded only to be run.

use super::number::{Decimals, simpler};
use paracosm_space::{Domain, Parameter, Shape, Value};
use std::cmp::Ordering;

/// The form of a parameter's value, which is nominal or given by knots.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    /// The nominal value of the parameter.
    Nominal,
    /// A value other than the nominal value, given by knots. A constant has one knot; a signal not simplified has all
    /// its coordinates.
    Own(Vec<Value>),
}

/// A parameter with its nominal value, to which shrinking moves the parameter.
#[derive(Debug, Clone)]
pub(super) struct Dimension<'a> {
    pub parameter: &'a Parameter,
    pub nominal: Value,
}

impl Dimension<'_> {
    /// Returns the form of a given value of the parameter.
    pub fn form(&self, value: &Value) -> Form {
        if self.value(&Form::Nominal) == *value { Form::Nominal } else { Form::Own(value.scalars().to_vec()) }
    }

    /// Returns the value that has the given form.
    pub fn value(&self, form: &Form) -> Value {
        match (form, self.parameter.signal) {
            (Form::Nominal, None) => self.nominal.clone(),
            (Form::Nominal, Some(shape)) => Value::List(self.expanded(shape, self.nominal.scalars()).into()),
            (Form::Own(knots), None) => knots[0].clone(),
            (Form::Own(knots), Some(shape)) => Value::List(self.expanded(shape, knots).into()),
        }
    }

    /// Returns the nominal value of the parameter, given by `count` knots.
    pub fn nominal_knots(&self, count: usize) -> Vec<Value> {
        match self.parameter.signal {
            Some(shape) if self.nominal.scalars().len() > 1 => reduced(shape, self.nominal.scalars(), count),
            _ => vec![self.nominal.scalars()[0].clone(); count],
        }
    }

    /// Returns the knots of the signal with `count` knots that is nearest to a given signal.
    pub fn with_knots(&self, knots: &[Value], count: usize) -> Vec<Value> {
        match self.parameter.signal {
            Some(shape) => reduced(shape, &self.expanded(shape, knots), count),
            None => knots.to_vec(),
        }
    }

    /// Compares two forms by simplicity. The nominal value is simplest, then forms with fewer knots, then forms with
    /// more nominal knots, then forms with simpler knots.
    pub fn compare(&self, a: &Form, b: &Form) -> Ordering {
        match (a, b) {
            (Form::Nominal, Form::Nominal) => Ordering::Equal,
            (Form::Nominal, Form::Own(_)) => Ordering::Less,
            (Form::Own(_), Form::Nominal) => Ordering::Greater,
            (Form::Own(a), Form::Own(b)) => a.len().cmp(&b.len()).then_with(|| {
                let nominal = self.nominal_knots(a.len());
                let other = |knots: &[Value]| knots.iter().zip(&nominal).filter(|(knot, own)| knot != own).count();
                other(a).cmp(&other(b)).then_with(|| simpler(self.cost(a, &nominal), self.cost(b, &nominal)))
            }),
        }
    }

    /// Returns the sum of the precision of the numbers, or of the positions of the levels in their choice, and the
    /// sum of the distances to the nominal values.
    fn cost(&self, knots: &[Value], nominal: &[Value]) -> (i32, f64) {
        let costs = knots.iter().zip(nominal).map(|(knot, nominal)| match &self.parameter.domain {
            _ if knot == nominal => (0, 0.0),
            Domain::Interval { lo, hi } => {
                let [number, nominal] = [knot, nominal].map(|value| value.number().unwrap_or(f64::NAN));
                (Decimals::of(*lo, *hi).level(number), (number - nominal).abs())
            }
            Domain::Choice(levels) => {
                (levels.iter().position(|level| level == knot).unwrap_or(levels.len()) as i32, 0.0)
            }
        });
        costs.fold((0, 0.0), |sum, cost| (sum.0 + cost.0, sum.1 + cost.1))
    }

    fn expanded(&self, shape: Shape, knots: &[Value]) -> Vec<Value> {
        expanded(shape, knots, shape.coordinates())
    }
}

/// Expands knots to this number of coordinates of a signal of this shape. Numbers stay between those of the knots.
fn expanded(shape: Shape, knots: &[Value], count: usize) -> Vec<Value> {
    match shape {
        _ if knots.len() == count => knots.to_vec(),
        _ if knots.len() == 1 => vec![knots[0].clone(); count],
        Shape::PiecewiseConstant { .. } => (0..count).map(|i| knots[i * knots.len() / count].clone()).collect(),
        Shape::PiecewiseLinear { .. } => along(&numbers(knots), count),
        Shape::Polynomial { .. } => {
            let mut coefficients = numbers(knots);
            while coefficients.len() < count {
                coefficients = elevated(&coefficients);
            }
            coefficients.into_iter().map(Value::Number).collect()
        }
    }
}

/// Returns a signal of this shape with fewer knots, which are means of the coordinates that a knot replaces, or
/// points of the line through the coordinates.
fn reduced(shape: Shape, coordinates: &[Value], count: usize) -> Vec<Value> {
    match shape {
        Shape::PiecewiseConstant { .. } => (0..count)
            .map(|knot| {
                let group: Vec<Value> = (0..coordinates.len())
                    .filter(|i| i * count / coordinates.len() == knot)
                    .map(|i| coordinates[i].clone())
                    .collect();
                mean(&group)
            })
            .collect(),
        Shape::PiecewiseLinear { .. } | Shape::Polynomial { .. } if count == 1 => vec![mean(coordinates)],
        Shape::PiecewiseLinear { .. } | Shape::Polynomial { .. } => along(&numbers(coordinates), count),
    }
}

/// Returns the mean of some numbers, between the least and the greatest; of words the first.
fn mean(values: &[Value]) -> Value {
    let numbers = numbers(values);
    if numbers.len() < values.len() || values.iter().all(|value| *value == values[0]) {
        return values[0].clone();
    }
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let share = 1.0 / numbers.len() as f64;
    Value::Number(numbers.iter().map(|number| number * share).sum::<f64>().clamp(least, most))
}

fn numbers(values: &[Value]) -> Vec<f64> {
    values.iter().filter_map(Value::number).collect()
}

/// Returns this number of evenly spread points of the line through evenly spread values. The ends are exact.
fn along(values: &[f64], count: usize) -> Vec<Value> {
    let (last, pieces) = (values.len() - 1, (count - 1).max(1));
    let point = |i: usize| {
        let piece = (i * last / pieces).min(last.saturating_sub(1));
        let share = (i * last - piece * pieces) as f64 / pieces as f64;
        let (from, to) = (values[piece], values[(piece + 1).min(last)]);
        Value::Number(((1.0 - share) * from + share * to).clamp(from.min(to), from.max(to)))
    };
    (0..count).map(point).collect()
}

/// Returns the same polynomial in the Bernstein basis of the next degree (Farin, "Curves and Surfaces for CAGD",
/// section 6.1).
fn elevated(coefficients: &[f64]) -> Vec<f64> {
    let degree = coefficients.len();
    let coefficient = |i: usize| match i {
        0 => coefficients[0],
        _ if i == degree => coefficients[degree - 1],
        _ => {
            let (share, before, here) = (i as f64 / degree as f64, coefficients[i - 1], coefficients[i]);
            (share * before + (1.0 - share) * here).clamp(before.min(here), before.max(here))
        }
    };
    (0..=degree).map(coefficient).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fewer_knots_written_out_are_the_same_signal_where_it_was_one_of_fewer() {
        let shapes = [
            Shape::PiecewiseConstant { pieces: 12 },
            Shape::PiecewiseLinear { pieces: 12 },
            Shape::Polynomial { degree: 12 },
        ];
        for shape in shapes {
            for knots in [vec![0.3], vec![0.2, 0.8], vec![0.2, 0.8, 0.5]] {
                let knots: Vec<Value> = knots.into_iter().map(Value::Number).collect();
                let written = expanded(shape, &knots, shape.coordinates());
                for tick in 0..=120 {
                    let of = |values: &[Value], shape: Shape| shape.number_at(&numbers(values), tick, 120);
                    let short = match shape {
                        _ if knots.len() == 1 => Shape::PiecewiseConstant { pieces: 1 },
                        Shape::PiecewiseConstant { .. } => Shape::PiecewiseConstant { pieces: knots.len() },
                        Shape::PiecewiseLinear { .. } => Shape::PiecewiseLinear { pieces: knots.len() - 1 },
                        Shape::Polynomial { .. } => Shape::Polynomial { degree: knots.len() - 1 },
                    };
                    assert!((of(&written, shape) - of(&knots, short)).abs() < 1e-12, "{shape} at {tick}: {written:?}");
                }
            }
        }
    }

    #[test]
    fn a_piecewise_constant_signal_keeps_the_means_of_its_parts() {
        let shape = Shape::PiecewiseConstant { pieces: 4 };
        let values = [1.0, 3.0, 5.0, 5.0].map(Value::Number);
        assert_eq!(reduced(shape, &values, 2), [2.0, 5.0].map(Value::Number));
        assert_eq!(reduced(shape, &values, 1), [3.5].map(Value::Number));
    }
}
