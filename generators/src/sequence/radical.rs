//! Helpers for constructions in prime bases: the primes, and digits mirrored at the point.

/// The number of indices whose radical inverses in base 2 fit in a double. Base 2 needs a bit of the mantissa for every
/// bit of the index.
pub(super) const INDICES: u64 = 1 << 53;

/// Returns the radical inverse of `index`, which is the number in `[0,1)` whose digits in `base` are the digits of
/// `index`, mirrored at the point.
///
/// One division of two integers needs one rounding; a sum would need a rounding for every digit.
pub(super) fn radical_inverse(base: u64, mut index: u64) -> f64 {
    let (mut mirrored, mut scale) = (0_u128, 1_u128);
    while index > 0 {
        mirrored = mirrored * u128::from(base) + u128::from(index % base);
        scale *= u128::from(base);
        index /= base;
    }
    ratio(mirrored, scale)
}

/// Divides a part by a whole, where the part is below the whole. The result is below 1 even if both, beyond 2^53, are
/// rounded to the same.
pub(super) fn ratio(part: u128, whole: u128) -> f64 {
    (part as f64 / whole as f64).min(1.0_f64.next_down())
}

/// Iterates over the primes in ascending order. It uses trial division, because dimensions are few.
pub(super) fn primes() -> impl Iterator<Item = u64> {
    let mut found: Vec<u64> = Vec::new();
    (2..).filter(move |&n| {
        let prime = found.iter().take_while(|&&p| p * p <= n).all(|p| n % p != 0);
        if prime {
            found.push(n);
        }
        prime
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bases_are_the_first_primes() {
        assert_eq!(primes().take(10).collect::<Vec<_>>(), [2, 3, 5, 7, 11, 13, 17, 19, 23, 29]);
    }

    #[test]
    fn digits_are_mirrored_at_the_point() {
        assert_eq!(radical_inverse(2, 0), 0.0);
        assert_eq!(radical_inverse(2, 0b1101), 0b1011 as f64 / 16.0);
        assert_eq!(radical_inverse(3, 5), 7.0 / 9.0);
    }

    #[test]
    fn coordinates_stay_below_one_at_the_far_end() {
        for base in primes().take(200) {
            assert!((0.0..1.0).contains(&radical_inverse(base, INDICES - 1)));
            let digits_all_largest = std::iter::successors(Some(base), |power| power.checked_mul(base)).last();
            assert!(radical_inverse(base, digits_all_largest.expect("a first power") - 1) < 1.0);
        }
    }
}
