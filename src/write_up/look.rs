//! How strategies are told apart in figures.

use crate::plot::{Look, Shape};
use paracosm_generators::Strategy;

/// The same strategy looks the same in every figure; those of one family have colours of one kind.
pub(crate) fn look(strategy: Strategy) -> Look {
    let (colour, shape, filled) = match strategy {
        Strategy::Random => (0x99_9999, Shape::Circle, true),
        Strategy::RandomCorners => (0x99_9999, Shape::Triangle, false),
        Strategy::Lhs => (0x99_9999, Shape::Square, false),
        Strategy::LhsCentred => (0x99_9999, Shape::Diamond, false),
        Strategy::Halton => (0x00_72b2, Shape::Circle, true),
        Strategy::HaltonShifted => (0x00_72b2, Shape::Circle, false),
        Strategy::HaltonScrambled => (0x56_b4e9, Shape::Tip, true),
        Strategy::Sobol => (0xd5_5e00, Shape::Diamond, true),
        Strategy::SobolOwen => (0xe6_9f00, Shape::Diamond, false),
        Strategy::Kronecker => (0x00_9e73, Shape::Square, true),
        Strategy::Hammersley => (0xcc_79a7, Shape::Triangle, true),
        Strategy::Fibonacci => (0x8c_510a, Shape::Tip, false),
        Strategy::Greedy => (0x00_0000, Shape::Triangle, true),
        Strategy::Anneal => (0xf0_8080, Shape::Tip, false),
        Strategy::Pso => (0xf0_8080, Shape::Square, false),
        Strategy::NelderMead => (0xf0_8080, Shape::Triangle, false),
        Strategy::Cmaes => (0xa0_1c1c, Shape::Diamond, true),
        Strategy::GpCmaes => (0xa0_1c1c, Shape::Diamond, false),
        Strategy::Bayes => (0x7b_3294, Shape::Circle, true),
        Strategy::Boundary => (0x7b_3294, Shape::Circle, false),
        Strategy::Auto => (0x7b_3294, Shape::Diamond, true),
    };
    let byte = |shift: u32| (colour >> shift) as u8;
    Look { colour: (byte(16), byte(8), byte(0)), shape, filled }
}
