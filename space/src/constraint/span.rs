//! Spans: intervals of numbers that contain every value of a term, whatever values the parameters have in their own
//! spans (interval arithmetic: Moore, Interval Analysis, 1966).
//!
//! Rounding never takes a value out of a span. Where the error of an operation can be computed without rounding, a bound
//! moves only if the operation was not exact. So a bound that numbers of the test can reach is not lost.

use super::Function;

/// The share by which the bounds of functions of libm are moved outwards. The errors of these functions are below two
/// units in the last place, far less than this share.
const SLACK: f64 = 1e-14;

/// The numbers from `lo` to `hi`. Both bounds are finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub lo: f64,
    pub hi: f64,
}

/// The direction in which a bound is rounded.
#[derive(Clone, Copy)]
enum Bound {
    Lower,
    Upper,
}

impl Bound {
    /// Returns a bound on an exact number that is the sum of `rounded` and an error with this sign.
    fn of(self, rounded: f64, error: f64) -> f64 {
        match self {
            Bound::Lower if error < 0.0 || error.is_nan() => rounded.next_down(),
            Bound::Upper if error > 0.0 || error.is_nan() => rounded.next_up(),
            _ => rounded,
        }
    }
}

/// The error of a sum (Knuth, The Art of Computer Programming, volume 2, section 4.2.2: two-sum).
fn sum(a: f64, b: f64, bound: Bound) -> f64 {
    let sum = a + b;
    let part = sum - a;
    bound.of(sum, (a - (sum - part)) + (b - part))
}

fn product(a: f64, b: f64, bound: Bound) -> f64 {
    let product = a * b;
    let error = a.mul_add(b, -product);
    // An error below the smallest float is lost.
    let is_exact = product != 0.0 && product.abs() > 1e-280 || a == 0.0 || b == 0.0;
    bound.of(product, if is_exact { error } else { f64::NAN })
}

fn quotient(a: f64, b: f64, bound: Bound) -> f64 {
    let quotient = a / b;
    let error = (-quotient).mul_add(b, a) * b.signum();
    let is_exact = quotient.abs() > 1e-280 && a.abs() > 1e-280 || a == 0.0;
    bound.of(quotient, if is_exact { error } else { f64::NAN })
}

impl Span {
    /// Makes the span of one number.
    pub fn exact(number: f64) -> Self {
        Self { lo: number, hi: number }
    }

    /// Makes the span of all numbers that `value` can give at the corners of two spans.
    fn corners(a: Self, b: Self, value: impl Fn(f64, f64, Bound) -> f64) -> Self {
        let corners = [(a.lo, b.lo), (a.lo, b.hi), (a.hi, b.lo), (a.hi, b.hi)];
        let least = corners.iter().map(|(x, y)| value(*x, *y, Bound::Lower)).fold(f64::INFINITY, f64::min);
        let greatest = corners.iter().map(|(x, y)| value(*x, *y, Bound::Upper)).fold(f64::NEG_INFINITY, f64::max);
        Self { lo: least, hi: greatest }
    }

    /// Returns the span of a function that does not fall as its operand grows, and that is computed exactly.
    fn rising(self, value: impl Fn(f64) -> f64) -> Self {
        Self { lo: value(self.lo), hi: value(self.hi) }
    }

    /// Returns the span with both bounds moved outwards by the error of a function of libm.
    fn widened(self) -> Self {
        let slack = |bound: f64| (bound.abs() * SLACK).max(1e-300);
        Self { lo: self.lo - slack(self.lo), hi: self.hi + slack(self.hi) }
    }

    /// Returns a span with the values of a function for all operands in the given spans; `None` if the function has no value
    /// for some of the operands, or if no bounds are known.
    pub fn of(function: Function, operands: &[Self]) -> Option<Self> {
        let a = operands[0];
        let b = operands.get(1).copied().unwrap_or(a);
        let span = match function {
            Function::Add => Self { lo: sum(a.lo, b.lo, Bound::Lower), hi: sum(a.hi, b.hi, Bound::Upper) },
            Function::Subtract => Self { lo: sum(a.lo, -b.hi, Bound::Lower), hi: sum(a.hi, -b.lo, Bound::Upper) },
            Function::Multiply => Self::corners(a, b, product),
            Function::Divide if b.lo > 0.0 || b.hi < 0.0 => Self::corners(a, b, quotient),
            Function::Remainder if b.lo > 0.0 || b.hi < 0.0 => {
                // The remainder has the sign of the dividend, and is smaller than both operands.
                let most = b.lo.abs().max(b.hi.abs());
                Self { lo: a.lo.min(0.0).max(-most), hi: a.hi.max(0.0).min(most) }
            }
            Function::Negate => Self { lo: -a.hi, hi: -a.lo },
            Function::Least => Self { lo: a.lo.min(b.lo), hi: a.hi.min(b.hi) },
            Function::Greatest => Self { lo: a.lo.max(b.lo), hi: a.hi.max(b.hi) },
            Function::Absolute if a.lo <= 0.0 && a.hi >= 0.0 => Self { lo: 0.0, hi: a.hi.max(-a.lo) },
            Function::Absolute => Self { lo: a.lo.abs().min(a.hi.abs()), hi: a.lo.abs().max(a.hi.abs()) },
            Function::Root if a.lo >= 0.0 => {
                let root = a.rising(f64::sqrt);
                let bound = |x: f64, root: f64, bound: Bound| bound.of(root, (-root).mul_add(root, x));
                Self { lo: bound(a.lo, root.lo, Bound::Lower).max(0.0), hi: bound(a.hi, root.hi, Bound::Upper) }
            }
            // Where the base is positive, the greatest and the least power lie at corners.
            Function::Power if a.lo > 0.0 => Self::corners(a, b, |x, y, _| libm::pow(x, y)).widened(),
            Function::Floor => a.rising(f64::floor),
            Function::Ceiling => a.rising(f64::ceil),
            Function::Round => a.rising(f64::round),
            Function::Sign => a.rising(|x| if x == 0.0 { 0.0 } else { x.signum() }),
            Function::Sine | Function::Cosine => {
                let exact = (a.lo == a.hi).then(|| function.value(&[a.lo]).map(|value| Self::exact(value).widened()));
                exact.flatten().unwrap_or(Self { lo: -1.0, hi: 1.0 })
            }
            Function::ArcSine if a.lo >= -1.0 && a.hi <= 1.0 => a.rising(libm::asin).widened(),
            Function::ArcCosine if a.lo >= -1.0 && a.hi <= 1.0 => {
                Self { lo: libm::acos(a.hi), hi: libm::acos(a.lo) }.widened()
            }
            Function::ArcTangent => a.rising(libm::atan).widened(),
            Function::Divide
            | Function::Remainder
            | Function::Root
            | Function::Power
            | Function::Tangent
            | Function::ArcSine
            | Function::ArcCosine => return None,
        };
        (span.lo.is_finite() && span.hi.is_finite()).then_some(span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALL: [Function; 21] = [
        Function::Add,
        Function::Subtract,
        Function::Multiply,
        Function::Divide,
        Function::Remainder,
        Function::Negate,
        Function::Least,
        Function::Greatest,
        Function::Absolute,
        Function::Root,
        Function::Power,
        Function::Floor,
        Function::Ceiling,
        Function::Round,
        Function::Sign,
        Function::Sine,
        Function::Cosine,
        Function::Tangent,
        Function::ArcSine,
        Function::ArcCosine,
        Function::ArcTangent,
    ];

    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![-3.0..3.0f64, -1e6..1e6f64, (-40..40i32).prop_map(|n| f64::from(n) / 8.0), Just(0.0)]
    }

    proptest! {
        #[test]
        fn a_span_has_the_value_of_every_operand_inside(
            ends in prop::collection::vec((number(), number()), 2),
            at in prop::collection::vec(0.0..=1.0f64, 2),
        ) {
            let spans: Vec<Span> = ends.iter().map(|(a, b)| Span { lo: a.min(*b), hi: a.max(*b) }).collect();
            let inside = |(span, at): (&Span, &f64)| (span.lo + at * (span.hi - span.lo)).clamp(span.lo, span.hi);
            let operands: Vec<f64> = spans.iter().zip(&at).map(inside).collect();
            for function in ALL {
                if let Some(span) = Span::of(function, &spans) {
                    let value = function.value(&operands);
                    let holds = value.is_some_and(|value| span.lo <= value && value <= span.hi);
                    prop_assert!(holds, "{function:?} {spans:?} {operands:?} {value:?} {span:?}");
                }
            }
        }
    }

    #[test]
    fn bounds_of_exact_operations_do_not_move() {
        let (a, b) = (Span { lo: 20.0, hi: 60.0 }, Span { lo: -50.0, hi: -10.0 });
        assert_eq!(Span::of(Function::Add, &[a, b]), Some(Span { lo: -30.0, hi: 50.0 }));
        assert_eq!(Span::of(Function::Multiply, &[a, b]), Some(Span { lo: -3000.0, hi: -200.0 }));
        assert_eq!(Span::of(Function::Divide, &[b, Span::exact(2.0)]), Some(Span { lo: -25.0, hi: -5.0 }));
        let third = Span::of(Function::Divide, &[Span::exact(1.0), Span::exact(3.0)]).unwrap();
        assert!(third.lo < third.hi && third.hi == third.lo.next_up());
    }

    #[test]
    fn a_function_without_a_value_somewhere_has_no_span() {
        let around = Span { lo: -1.0, hi: 1.0 };
        assert_eq!(Span::of(Function::Divide, &[Span::exact(1.0), around]), None);
        assert_eq!(Span::of(Function::Root, &[around]), None);
        assert_eq!(Span::of(Function::Multiply, &[Span::exact(1e300), Span::exact(1e300)]), None);
    }
}
