//! Finite fields, as tables.

/// A finite field whose elements have numbers, from 0 for zero and 1 for one.
#[derive(Debug, Clone)]
pub(super) struct Field {
    order: usize,
    sums: Vec<usize>,
    products: Vec<usize>,
}

impl Field {
    /// Makes the finite field with `order` elements; `None` if the order is not a power of a prime.
    pub(super) fn new(order: usize) -> Option<Self> {
        let prime = (2..=order).find(|factor| order.is_multiple_of(*factor))?;
        let degree = (1..).find(|&degree| power(prime, degree) >= order)?;
        if power(prime, degree) != order {
            return None;
        }
        let digits = |element: usize| (0..degree).map(move |i| element / power(prime, i) % prime);
        let number = |digits: &[usize]| digits.iter().rev().fold(0, |number, digit| number * prime + digit);
        let pairs = || (0..order * order).map(|pair| (pair / order, pair % order));
        let sum = |(a, b)| number(&digits(a).zip(digits(b)).map(|(a, b)| (a + b) % prime).collect::<Vec<_>>());
        let sums = pairs().map(sum).collect();
        // Elements are polynomials over the integers modulo the prime, modulo a polynomial of this degree. The first
        // such modulus without zero divisors is irreducible.
        let products = (0..order).map(|tail| digits(tail).collect::<Vec<_>>()).find_map(|tail| {
            let product = |(a, b): (usize, usize)| {
                let mut product = vec![0; 2 * degree];
                for (i, a) in digits(a).enumerate() {
                    for (j, b) in digits(b).enumerate() {
                        product[i + j] += a * b;
                    }
                }
                for i in (degree..2 * degree).rev() {
                    let top = std::mem::take(&mut product[i]) % prime;
                    for (j, digit) in tail.iter().enumerate() {
                        product[i - degree + j] += top * (prime - digit);
                    }
                }
                product.iter_mut().for_each(|digit| *digit %= prime);
                number(&product[..degree])
            };
            let products: Vec<usize> = pairs().map(product).collect();
            let without_divisors = pairs().zip(&products).all(|((a, b), product)| *product != 0 || a == 0 || b == 0);
            without_divisors.then_some(products)
        })?;
        Some(Self { order, sums, products })
    }

    pub(super) fn order(&self) -> usize {
        self.order
    }

    pub(super) fn sum(&self, a: usize, b: usize) -> usize {
        self.sums[a * self.order + b]
    }

    pub(super) fn product(&self, a: usize, b: usize) -> usize {
        self.products[a * self.order + b]
    }
}

fn power(base: usize, exponent: usize) -> usize {
    (0..exponent).fold(1, |power, _| power * base)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_obey_their_laws() {
        for order in [2, 3, 4, 5, 7, 8, 9, 16, 25, 27] {
            let field = Field::new(order).unwrap();
            for a in 0..order {
                assert_eq!((field.sum(a, 0), field.product(a, 1), field.product(a, 0)), (a, a, 0));
                assert_eq!((0..order).filter(|&b| field.sum(a, b) == 0).count(), 1);
                assert!(a == 0 || (0..order).filter(|&b| field.product(a, b) == 1).count() == 1);
                for b in 0..order {
                    assert_eq!(field.product(a, b), field.product(b, a));
                    for c in 0..order {
                        let distributed = field.sum(field.product(a, b), field.product(a, c));
                        assert_eq!(field.product(a, field.sum(b, c)), distributed);
                        assert_eq!(field.product(a, field.product(b, c)), field.product(field.product(a, b), c));
                    }
                }
            }
        }
    }

    #[test]
    fn orders_that_are_no_prime_powers_have_no_field() {
        assert!([0, 1, 6, 10, 12, 15].into_iter().all(|order| Field::new(order).is_none()));
    }
}
