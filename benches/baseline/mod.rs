//! Plain integer arithmetic, to compare two machines, or one machine at two times.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

/// Measures steps of Marsaglia's xorshift (2003): three shifts each, one after the other.
#[divan::bench]
fn baseline(bencher: Bencher) {
    const STEPS: u64 = 1_000_000;
    let step = |x: u64, _| {
        let x = x ^ (x << 13);
        let x = x ^ (x >> 7);
        x ^ (x << 17)
    };
    bencher.counter(ItemsCount::new(STEPS)).bench(|| (0..black_box(STEPS)).fold(1, step));
}
