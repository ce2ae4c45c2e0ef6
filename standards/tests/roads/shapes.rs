//! Any shape of a reference line becomes a network whose lanes are as long as their places say, or is refused.

use super::cases::{parse, with};
use proptest::prelude::*;

/// A coefficient of any magnitude.
fn coefficient() -> impl Strategy<Value = f64> {
    let sign = prop_oneof![Just(1.0), Just(-1.0)];
    let nonzero = (sign, -12.0..12.0).prop_map(|(sign, digits): (f64, f64)| sign * libm::exp10(digits));
    prop_oneof![1 => Just(0.0), 2 => nonzero]
}

fn lane_of(shape: &str, length: f64) -> Result<f64, String> {
    let length = format!("length=\"{length}\"");
    let text = with(&[("length=\"50\"", &length), ("length=\"50\"", &length), ("<line/>", shape)]);
    let network = parse(text)?.network().map_err(|error| error.to_string())?;
    Ok(network.lanes()[0].length())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn every_cubic_becomes_a_lane_or_is_refused(c in prop::array::uniform4(coefficient()), length in 1.0..500.0) {
        let [a, b, c, d] = c;
        let shape = format!("<poly3 a=\"{a:e}\" b=\"{b:e}\" c=\"{c:e}\" d=\"{d:e}\"/>");
        if let Err(message) = lane_of(&shape, length) {
            prop_assert!(message.contains("coefficients of a curve") || message.contains("has no lanes"), "{message}");
        }
    }

    #[test]
    fn every_pair_of_cubics_becomes_a_lane_or_is_refused(
        u in prop::array::uniform4(coefficient()),
        v in prop::array::uniform4(coefficient()),
        length in 1.0..500.0,
        range in prop_oneof![Just("normalized"), Just("arcLength")],
    ) {
        let of = |name, c: [f64; 4]| {
            let parts = "abcd".chars().zip(c).map(|(letter, value)| format!(" {letter}{name}=\"{value:e}\""));
            parts.collect::<String>()
        };
        let shape = format!("<paramPoly3 pRange=\"{range}\"{}{}/>", of("U", u), of("V", v));
        if let Err(message) = lane_of(&shape, length) {
            prop_assert!(message.contains("coefficients of a curve") || message.contains("has no lanes"), "{message}");
        }
    }

    /// The middle of lane -1 lies 1.75 m to the right.
    #[test]
    fn lanes_of_arcs_and_spirals_are_as_long_as_their_turns_say(from in -0.3..0.3, to in -0.3..0.3, length in 1.0..3000.0) {
        let expected = |from: f64, to: f64| {
            // The integral of |1 + 1.75 κ|, which is positive throughout.
            length * (1.0 + 0.5 * 1.75 * (from + to))
        };
        let arc = lane_of(&format!("<arc curvature=\"{from}\"/>"), length).map_err(TestCaseError::fail)?;
        prop_assert!((arc / expected(from, from) - 1.0).abs() < 1e-3, "{arc} {}", expected(from, from));
        let spiral = lane_of(&format!("<spiral curvStart=\"{from}\" curvEnd=\"{to}\"/>"), length).map_err(TestCaseError::fail)?;
        prop_assert!((spiral / expected(from, to) - 1.0).abs() < 1e-3, "{spiral} {}", expected(from, to));
    }
}

#[test]
fn a_long_tight_arc_keeps_its_lanes() {
    let metres = lane_of("<arc curvature=\"0.02\"/>", 1250.0).expect("it is sound");
    assert!((metres - 1250.0 * 1.035).abs() < 0.01, "{metres}");
}

#[test]
fn a_graph_that_is_longer_than_any_road_is_refused_with_its_coefficient() {
    let message = lane_of("<poly3 a=\"0\" b=\"0\" c=\"0\" d=\"1e9\"/>", 50.0).expect_err("it was accepted");
    let says = "`d=\"1e9\"` of <poly3> is not allowed, expected coefficients of a curve that is at most 100000 m long";
    assert!(message.contains(says), "{message}");
}
