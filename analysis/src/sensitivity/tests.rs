use super::*;
use std::f64::consts::PI;

/// Parameters with one coordinate each.
fn factors(count: usize) -> Vec<Factor> {
    (0..count).map(|at| Factor { name: format!("x{at}"), coordinates: 1 }).collect()
}

fn explained(factors: &[Factor], pairs: usize, f: impl Fn(&[f64]) -> f64) -> Explained {
    let mut evaluate = |points: &[Vec<f64>]| Ok(points.iter().map(|point| Some(vec![f(point)])).collect());
    explain(factors, pairs, 7, &mut evaluate).unwrap().explained.remove(0)
}

/// Checks that the known indices lie within the intervals, and that the estimates are near them.
fn check(found: &Explained, known: &[(f64, f64)]) {
    assert_eq!(found.parameters.len(), known.len());
    for Indices { name, first_order, total } in &found.parameters {
        let at: usize = name[1..].parse().unwrap();
        for (index, known) in [(first_order, known[at].0), (total, known[at].1)] {
            assert!((index.estimate - known).abs() < 0.02, "{name}: {index:?}, known {known}");
            assert!(index.lower <= known + 1e-12 && known - 1e-12 <= index.upper, "{name}: {index:?}, known {known}");
        }
    }
    assert!(found.parameters.is_sorted_by(|a, b| a.total.estimate >= b.total.estimate));
}

#[test]
fn the_indices_of_ishigami_are_the_known_ones() {
    // Ishigami and Homma, 1990: sin x0 + a sin² x1 + b x2⁴ sin x0 over [-π, π]³.
    let (a, b) = (7.0, 0.1);
    let found = explained(&factors(3), 4096, |u| {
        let [x, y, z] = [0, 1, 2].map(|at| PI * (2.0 * u[at] - 1.0));
        libm::sin(x) + a * libm::sin(y) * libm::sin(y) + b * z * z * z * z * libm::sin(x)
    });
    let pi4 = PI * PI * PI * PI;
    let (alone, second) = (0.5 * (1.0 + b * pi4 / 5.0) * (1.0 + b * pi4 / 5.0), a * a / 8.0);
    let together = b * b * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
    let variance = alone + second + together;
    assert!((found.variance / variance - 1.0).abs() < 0.01 && (found.mean - a / 2.0).abs() < 0.02);
    let [alone, second, together] = [alone, second, together].map(|part| part / variance);
    check(&found, &[(alone, alone + together), (second, second), (0.0, together)]);
}

#[test]
fn the_indices_of_the_function_g_are_the_known_ones() {
    // Saltelli and Sobol', 1995: the product of (|4 x - 2| + a) / (1 + a), whose parts are those of a product.
    let shapes = [0.0, 0.5, 3.0, 9.0, 99.0];
    let found = explained(&factors(5), 8192, |u| {
        u.iter().zip(shapes).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product()
    });
    let parts = shapes.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
    let variance = parts.iter().map(|part| 1.0 + part).product::<f64>() - 1.0;
    let known = parts.map(|part| (part / variance, part * (variance + 1.0) / (1.0 + part) / variance));
    check(&found, &known);
}

#[test]
fn the_indices_of_a_corner_that_fails_are_the_known_ones() {
    // A test fails if both numbers are below one half: the probability is p = 1/4, and the variance is p (1 - p).
    let found = explained(&factors(3), 4096, |u| f64::from(u8::from(u[0] < 0.5 && u[1] < 0.5)));
    assert!((found.mean - 0.25).abs() < 0.005);
    check(&found, &[(1.0 / 3.0, 2.0 / 3.0), (1.0 / 3.0, 2.0 / 3.0), (0.0, 0.0)]);
    // A parameter without effect has exactly no share.
    let last = &found.parameters[2];
    assert_eq!((last.name.as_str(), last.total), ("x2", Index { estimate: 0.0, lower: 0.0, upper: 0.0 }));
}

#[test]
fn the_coordinates_of_a_signal_are_one_parameter() {
    let signal = [Factor { name: "x0".to_owned(), coordinates: 2 }, Factor { name: "x1".to_owned(), coordinates: 1 }];
    // The product of both coordinates of the signal is a part of the signal alone.
    let found = explained(&signal, 4096, |u| (u[0] - 0.5) * (u[1] - 0.5) + 0.5 * (u[2] - 0.5));
    let (of_signal, other) = (1.0 / 144.0, 0.25 / 12.0);
    let share = |part: f64| (part / (of_signal + other), part / (of_signal + other));
    check(&found, &[share(of_signal), share(other)]);
}

#[test]
fn a_quantity_that_is_the_same_everywhere_has_no_indices() {
    let found = explained(&factors(2), 64, |_| 0.1);
    assert_eq!((found.variance, found.parameters.len()), (0.0, 0));
}

#[test]
fn points_that_cannot_be_judged_are_left_out_with_their_pairs_or_refused_if_they_are_many() {
    let ask = |share: f64| {
        explain(&factors(2), 256, 0, &mut |points| {
            let judged = |point: &Vec<f64>| (point[0] > share).then(|| vec![point[0] + point[1]]);
            Ok(points.iter().map(judged).collect())
        })
    };
    let found = ask(0.01).unwrap();
    assert!(found.left_out > 0 && found.pairs + found.left_out == 256 && found.evaluations == 1024);
    let refused = ask(0.2).unwrap_err().to_string();
    assert!(refused.contains("of 1024 tests could not be judged"), "{refused}");
}

#[test]
fn what_cannot_be_asked_is_refused_in_words() {
    for (count, pairs, says) in [(0, 64, "no parameter is open"), (2, 8, "the budget is 32, expected at least 64")] {
        let refused = explain(&factors(count), pairs, 0, &mut |_| unreachable!()).unwrap_err().to_string();
        assert!(refused.contains(says), "{refused}");
    }
    assert_eq!(tests_within(1000, 2), Ok(512));
}
