//! Measures how long it takes to measure sets of points, to cover combinations and to place points: the work of
//! `paracosm-cover`. `baseline` is plain integer arithmetic, to compare two machines.

mod baseline;

use divan::{Bencher, black_box};
use paracosm::coverage::dispersion::dispersion;
use paracosm::coverage::extreme::extreme_discrepancy;
use paracosm::coverage::fill::fill;
use paracosm::coverage::kwise_dispersion::kwise_dispersion;
use paracosm::coverage::star::star_discrepancy;
use paracosm::coverage::{Deadline, PointSet, l2};
use paracosm::generators::covering::{CoveringRequest, covering_array};
use paracosm::generators::{Request, Strategy};
use paracosm::space::rules::Rules;
use paracosm::space::{Point, Space};

fn main() {
    divan::main();
}

fn points(strategy: Strategy, dims: usize, n: usize) -> Vec<Point> {
    let space = Space::unit_cube(dims);
    strategy.build(&Request::new(&space, n)).unwrap().ask(n)
}

fn halton(dims: usize, n: usize) -> PointSet {
    PointSet::new(dims, points(Strategy::HALTON, dims, n).iter().map(|point| &point.continuous)).unwrap()
}

/// Exact dispersion of Halton points; the arguments are the dimensions and the number of points.
#[divan::bench(args = [(2, 100_000), (3, 10_000), (4, 10_000), (5, 1_000), (6, 1_000), (8, 1_000), (10, 100)], sample_count = 3)]
fn exact_dispersion(bencher: Bencher, (dims, n): (usize, usize)) {
    let points = halton(dims, n);
    bencher.bench(|| dispersion(black_box(&points), Deadline::never()));
}

/// Exact dispersion of points of the Sobol sequence.
#[divan::bench(args = [(10, 1_024)], sample_count = 3)]
fn exact_dispersion_of_sobol(bencher: Bencher, (dims, n): (usize, usize)) {
    let points = PointSet::new(dims, points(Strategy::SOBOL, dims, n).iter().map(|point| &point.continuous)).unwrap();
    bencher.bench(|| dispersion(black_box(&points), Deadline::never()));
}

#[divan::bench(args = [(2, 100_000), (5, 500), (8, 100)], sample_count = 10)]
fn exact_star(bencher: Bencher, (dims, n): (usize, usize)) {
    let points = halton(dims, n);
    bencher.bench(|| star_discrepancy(black_box(&points), Deadline::never()));
}

#[divan::bench(args = [(3, 100)], sample_count = 10)]
fn exact_extreme(bencher: Bencher, (dims, n): (usize, usize)) {
    let points = halton(dims, n);
    bencher.bench(|| extreme_discrepancy(black_box(&points), Deadline::never()));
}

#[divan::bench(args = [(2, 10_000), (3, 1_000), (5, 500), (10, 500)], sample_count = 10)]
fn exact_fill(bencher: Bencher, (dims, n): (usize, usize)) {
    let points = halton(dims, n);
    bencher.bench(|| fill(black_box(&points), Deadline::never()));
}

/// The centered, the wraparound and the mixture discrepancy together.
#[divan::bench(args = [(20, 4_000)], sample_count = 10)]
fn l2_family(bencher: Bencher, (dims, n): (usize, usize)) {
    let points = halton(dims, n);
    bencher.bench(|| {
        [l2::centered, l2::wraparound, l2::mixture].map(|measure| measure(black_box(&points), Deadline::never()))
    });
}

/// K-wise dispersion of 1,000 points in 20 dimensions: 190 projections on two coordinates, 1,140 on three.
#[divan::bench(args = [2, 3], sample_count = 3)]
fn kwise_dispersion_of_20_dimensions(bencher: Bencher, k: usize) {
    let (rules, points) = (Rules::free(&[]), points(Strategy::HALTON, 20, 1_000));
    bencher.bench(|| kwise_dispersion(20, &rules, None, black_box(&points), k, Deadline::never()));
}

/// Covering arrays; the arguments are the number of parameters, the levels of each, and the strength.
#[divan::bench(args = [(16, 10, 3), (16, 10, 4), (100, 2, 3), (20, 10, 2), (10, 4, 3)], sample_count = 3)]
fn array(bencher: Bencher, (parameters, levels, k): (usize, usize, usize)) {
    let rules = Rules::free(&vec![levels; parameters]);
    bencher.bench(|| covering_array(&CoveringRequest::new(black_box(&rules), k)));
}
