use super::*;
use proptest::prelude::*;

/// An integral by Gauss's rule of five nodes on many pieces: knows nothing of what it is held against.
fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    const PIECES: usize = 2_000;
    let width = (to - from) / PIECES as f64;
    let piece = |i: usize| {
        let middle = from + (i as f64 + 0.5) * width;
        0.5 * width * NODES.iter().map(|(at, weight)| weight * f(middle + 0.5 * width * at)).sum::<f64>()
    };
    (0..PIECES).map(piece).sum()
}

/// How much of a density, that need not be normalised, lies below `x`.
fn share(density: impl Fn(f64) -> f64, x: f64) -> f64 {
    integral(&density, 0.0, x) / (integral(&density, 0.0, x) + integral(&density, x, 1.0))
}

proptest! {
    #[test]
    fn the_beta_function_and_its_inverse_agree_with_the_integral(a in 1.0..40.0_f64, b in 1.0..40.0_f64, p in 1e-6..1.0) {
        // With ln instead of powers, and scaled by its greatest value, so that nothing underflows.
        let log = |x: f64| -> f64 { (a - 1.0) * libm::log(x) + (b - 1.0) * libm::log1p(-x) };
        // Where a shape is just above 1 the density has a kink in its derivatives at an end: substituted away.
        let top = log((a / (a + b)).clamp(1e-3, 1.0 - 1e-3));
        let smooth = |t: f64| {
            let x = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
            if x <= 0.0 || x >= 1.0 { 0.0 } else { libm::exp(log(x) - top) * 30.0 * (t * (1.0 - t)) * (t * (1.0 - t)) }
        };
        let x = beta_quantile(a, b, p);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let t: f64 = 0.5 * (low + high);
            if t * t * t * (10.0 - 15.0 * t + 6.0 * t * t) < x { low = t } else { high = t }
        }
        prop_assert!((share(smooth, low) - p).abs() < 1e-12, "{} {p}", share(smooth, low));
        prop_assert!((beta_cdf(a, b, x) - p).abs() < 1e-13);
    }

    #[test]
    fn beta_quantiles_of_any_shapes_are_inverses_and_mirrored(a in -3.0..5.0, b in -3.0..5.0, p in 0.0..1.0) {
        let [a, b] = [a, b].map(|exponent| libm::pow(10.0, exponent));
        let x = beta_quantile(a, b, p);
        prop_assert!((0.0..=1.0).contains(&x));
        // Next to an end a step of one in the last place of x may be worth more than the tolerance.
        let around = [x.next_down().max(0.0), x.next_up()].map(|x| beta_cdf(a, b, x));
        prop_assert!(around[0] - 1e-11 <= p && p <= around[1] + 1e-11, "{around:?} {p}");
        // With few enough digits that 1 - x has them all.
        let digits = libm::exp2(40.0);
        let x = (x * digits).round() / digits;
        prop_assert!((beta_cdf(a, b, x) + beta_cdf(b, a, 1.0 - x) - 1.0).abs() < 1e-11);
    }

    #[test]
    fn the_normal_quantile_is_the_inverse_of_the_distribution_function(z in -37.0..8.0) {
        let p = normal_cdf(z);
        // What of z is lost in p cannot come back.
        let lost = f64::EPSILON * p / (libm::exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt());
        prop_assert!((normal_quantile(p) - z).abs() <= 1e-12 + 2.0 * lost, "{} {z}", normal_quantile(p));
    }

    #[test]
    fn normal_numbers_in_an_interval_agree_with_the_integral(mean in -2.0..3.0, sd in 0.3..20.0_f64, u in 0.0..1.0) {
        // On the interval [-1, 3], coordinates x of which are -1 + 4 x.
        let density = |x: f64| { let z = (4.0 * x - 1.0 - mean) / sd; libm::exp(-0.5 * z * z) };
        let x = Distribution::Normal(mean, sd).quantile(-1.0, 3.0, u);
        prop_assert!((share(density, x) - u).abs() < 1e-12, "{} {u}", share(density, x));
    }

    #[test]
    fn lognormal_numbers_in_an_interval_agree_with_the_integral(
        mean in -1.0..2.0, sd in 0.2..3.0_f64, lo in 0.2..2.0_f64, u in 0.0..1.0,
    ) {
        // On the interval [lo, lo + 4]; the density falls with the number itself.
        let density = |x: f64| {
            let number = lo + 4.0 * x;
            let z = (libm::log(number) - mean) / sd;
            libm::exp(-0.5 * z * z) / number
        };
        let distribution = Distribution::LogNormal(mean, sd);
        prop_assume!(distribution.check(&Domain::Interval { lo, hi: lo + 4.0 }).is_ok());
        let x = distribution.quantile(lo, lo + 4.0, u);
        prop_assert!((share(density, x) - u).abs() < 1e-9, "{} {u}", share(density, x));
    }

    #[test]
    fn numbers_of_a_histogram_agree_with_counted_bins(
        bins in prop::collection::vec((1_u8..9, 0_u8..9), 1..6), cut in 0.0..0.5, u in 0.0..1.0,
    ) {
        prop_assume!(bins.iter().any(|(_, weight)| *weight > 0));
        let mut numbers = vec![3.0];
        for (width, weight) in &bins {
            numbers.extend([f64::from(*weight), numbers[numbers.len() - 1] + f64::from(*width)]);
        }
        let (lo, hi) = (3.0 + cut, numbers[numbers.len() - 1] + cut);
        let distribution = Distribution::Histogram(numbers.clone());
        prop_assume!(distribution.check(&Domain::Interval { lo, hi }).is_ok());
        // The share below a number, counted on slices that no edge divides but for the cut ones.
        let below = |number: f64| -> f64 {
            numbers.windows(3).step_by(2)
                .map(|bin| bin[1] * ((number.min(bin[2]) - lo.max(bin[0])) / (bin[2] - bin[0])).max(0.0))
                .sum()
        };
        let x = lo + (hi - lo) * distribution.quantile(lo, hi, u);
        prop_assert!((below(x) / below(hi) - u).abs() < 1e-12, "{} {u}", below(x) / below(hi));
        // No number lies within an empty bin.
        let is_within_empty = |bin: &[f64]| bin[1] == 0.0 && bin[0] + 1e-9 < x && x < bin[2] - 1e-9;
        prop_assert!(!numbers.windows(3).step_by(2).any(is_within_empty), "{numbers:?} {x}");
    }

    #[test]
    fn triangular_numbers_agree_with_the_integral(mode in 2.0..=4.0_f64, u in 0.0..1.0) {
        let m: f64 = (mode - 2.0) / 2.0;
        let x = Distribution::Triangular(mode).quantile(2.0, 4.0, u);
        // The density has a corner at the mode, so that its sides are integrated one by one.
        let rise = |x: f64| if m > 0.0 { 2.0 * x / m } else { 0.0 };
        let fall = |x: f64| 2.0 * (1.0 - x) / (1.0 - m);
        let below = integral(rise, 0.0, x.min(m)) + if x > m { integral(fall, m, x) } else { 0.0 };
        prop_assert!((below - u).abs() < 1e-12, "{below} {u}");
    }

    #[test]
    fn levels_come_as_often_as_their_weights_say(weights in prop::collection::vec(0_u8..9, 1..6)) {
        prop_assume!(weights.iter().any(|weight| *weight > 0));
        let sum: usize = weights.iter().map(|weight| usize::from(*weight)).sum();
        let distribution = Distribution::Weights(weights.iter().map(|weight| f64::from(*weight)).collect());
        let mut counts = vec![0; weights.len()];
        for i in 0..sum {
            counts[distribution.level(weights.len(), (i as f64 + 0.5) / sum as f64)] += 1_u8;
        }
        prop_assert_eq!(&counts, &weights);
        let last = weights.iter().rposition(|weight| *weight > 0).unwrap();
        prop_assert_eq!(distribution.level(weights.len(), 1.0), last);
    }
}

#[test]
fn known_values_are_met() {
    // I_x(1, b) = 1 - (1-x)^b, I_x(a, 1) = x^a, and I_(1/2)(a, a) = 1/2.
    assert!((beta_cdf(1.0, 5.0, 0.2) - (1.0 - 0.8_f64 * 0.8 * 0.8 * 0.8 * 0.8)).abs() < 1e-15);
    assert!((beta_quantile(2.0, 1.0, 1e-12) - 1e-6).abs() < 1e-20);
    assert!((beta_cdf(1e5, 1e5, 0.5) - 0.5).abs() < 1e-12);
    // Of 10 throws of a coin 3 or fewer are heads in 176 of 1024 cases.
    assert!((beta_cdf(7.0, 4.0, 0.5) - 176.0 / 1024.0).abs() < 1e-15);
    // Wichura's own examples.
    assert!((normal_quantile(0.25) + 0.674_489_750_196_081_7).abs() < 1e-15);
    assert!((normal_quantile(1e-3) + 3.090_232_306_167_813_5).abs() < 1e-14);
    assert!((normal_quantile(1e-20) + 9.262_340_089_798_408).abs() < 1e-14);
}

#[test]
fn ends_are_ends_whatever_the_distribution() {
    let all = [
        Distribution::Uniform,
        Distribution::Beta(0.001, 1e6),
        Distribution::Beta(2.0, 5.0),
        Distribution::Normal(3.0, 0.4),
        Distribution::Normal(-1.0, 100.0),
        Distribution::LogNormal(0.3, 0.1),
        Distribution::LogNormal(-3.0, 20.0),
        Distribution::Histogram(vec![0.0, 1.0, 1.5, 2.0, 3.0]),
        Distribution::Triangular(1.0),
        Distribution::Triangular(2.0),
    ];
    for distribution in all {
        assert_eq!(distribution.check(&Domain::Interval { lo: 1.0, hi: 2.0 }), Ok(()), "{distribution}");
        assert_eq!([0.0, 1.0].map(|u| distribution.quantile(1.0, 2.0, u)), [0.0, 1.0], "{distribution}");
    }
}

#[test]
fn a_lognormal_number_in_an_interval_from_0_has_its_median() {
    // The interval begins where the logarithm has no value.
    let median = Distribution::LogNormal(0.5, 0.8).quantile(0.0, 1e6, 0.5) * 1e6;
    assert!((median - libm::exp(0.5)).abs() < 1e-9, "{median}");
    let refused = Distribution::LogNormal(0.0, 1.0).check(&Domain::Interval { lo: -2.0, hi: -1.0 });
    assert!(matches!(refused, Err(DistributionError::Outside { .. })));
}

#[test]
fn a_histogram_with_empty_bins_at_its_ends_gives_no_test_in_them() {
    let histogram = Distribution::Histogram(vec![0.0, 0.0, 2.0, 1.0, 3.0, 0.0, 10.0]);
    assert_eq!([0.0, 0.5, 1.0].map(|u| histogram.quantile(0.0, 10.0, u)), [0.2, 0.25, 0.3]);
}

#[test]
fn a_part_of_a_domain_keeps_the_distribution_as_far_as_it_reaches() {
    let interval = |lo, hi| Domain::Interval { lo, hi };
    let choice = |levels: &[i32]| Domain::Choice(levels.iter().map(|level| f64::from(*level).into()).collect());
    let weights = Distribution::Weights(vec![1.0, 3.0, 0.0]);
    let (normal, histogram) = (Distribution::Normal(35.0, 5.0), Distribution::Histogram(vec![0.0, 1.0, 2.0, 0.0, 9.0]));
    for (distribution, domain, part, expected) in [
        (&weights, choice(&[20, 50, 70]), choice(&[50, 20]), Distribution::Weights(vec![3.0, 1.0])),
        (&weights, choice(&[20, 50, 70]), choice(&[50]), Distribution::Weights(vec![3.0])),
        (&weights, choice(&[20, 50, 70]), choice(&[70]), Distribution::Uniform),
        (&normal, interval(20.0, 60.0), interval(30.0, 40.0), normal.clone()),
        (&normal, interval(20.0, 60.0), interval(30.1, 30.11), Distribution::Uniform),
        (&normal, interval(20.0, 60.0), choice(&[30, 40]), Distribution::Uniform),
        (&histogram, interval(0.0, 9.0), interval(1.0, 5.0), histogram.clone()),
        (&histogram, interval(0.0, 9.0), interval(3.0, 5.0), Distribution::Uniform),
    ] {
        assert_eq!(distribution.within(&domain, &part), expected, "{distribution} {part}");
    }
}

#[test]
fn text_and_files_say_the_same() {
    for text in [
        "uniform",
        "beta:2,5",
        "normal:1.4,0.3",
        "lognormal:0.3,0.2",
        "triangular:1.4",
        "histogram:0,1,5,3,10",
        "weights:0.7,0.2,0.1",
        "weights:1",
    ] {
        let distribution: Distribution = text.parse().unwrap();
        let file = serde_json::to_string(&distribution).unwrap();
        assert_eq!(serde_json::from_str::<Distribution>(&file).unwrap(), distribution, "{file}");
    }
    assert_eq!(serde_json::to_string(&Distribution::Beta(2.0, 5.0)).unwrap(), "{\"beta\":[2,5]}");
    assert_eq!(Distribution::Beta(2.0, 5.5).to_string(), "beta(2, 5.5)");
}

#[test]
fn what_cannot_be_is_refused_in_words() {
    let interval = Domain::Interval { lo: 0.0, hi: 1.0 };
    let choice = Domain::Choice(vec![2.into(), 4.into()]);
    let cases = [
        ("beat:2,5", &interval, "`beat`"),
        ("beat:2,5", &interval, "`beta`"),
        ("beta:2", &interval, "two numbers"),
        ("beta:2,x", &interval, "`x`"),
        ("beta:0,1", &interval, "0.001"),
        ("beta:nan,1", &interval, "finite"),
        ("normal:0.5,0", &interval, "above 0"),
        ("normal:0.5,1000", &interval, "at most 100"),
        ("normal:50,1", &interval, "almost nothing"),
        ("lognormal:0.5", &interval, "the logarithm"),
        ("lognormal:0.5,0", &interval, "above 0"),
        ("lognormal:50,1", &interval, "almost nothing"),
        ("histogram:0,1", &interval, "a weight between each two edges"),
        ("histogram:0,1,1,2", &interval, "found 4"),
        ("histogram:0,1,0", &interval, "ascending"),
        ("histogram:0,-1,1", &interval, "at least 0"),
        ("histogram:0,0,1", &interval, "a finite sum above 0"),
        ("histogram:2,1,3", &interval, "almost nothing"),
        ("weights:1,1", &interval, "triangular, histogram"),
        ("triangular:2", &interval, "[0, 1]"),
        ("weights:1,1", &interval, "choice"),
        ("beta:2,5", &choice, "weights"),
        ("weights:1", &choice, "a weight for each value"),
        ("weights:1,-1", &choice, "at least 0"),
        ("weights:0,0", &choice, "a finite sum above 0"),
    ];
    for (text, domain, says) in cases {
        let refused =
            text.parse::<Distribution>().and_then(|distribution| distribution.check(domain)).unwrap_err().to_string();
        assert!(refused.contains(says), "{text}: {refused}");
    }
}
