//! Stochastic distributions: parameters get values and chances, and mistakes are refused.

use super::bad::{changed_in, messages_of};
use super::worlds::{file, program};
use paracosm_engine::Declaration;
use paracosm_space::{Distribution, Domain, Parameter, Value};
use paracosm_standards::openscenario::Xosc;
use std::fs;

fn parameter<'d>(declaration: &'d Declaration, name: &str) -> &'d Parameter {
    &declaration.parameters.iter().find(|declared| declared.parameter.name == name).unwrap().parameter
}

/// Returns the domain and the distribution of the parameter `gap` of a type with this element as its distribution, or the message.
fn of_gap(kind: &str, distribution: &str) -> Result<(Domain, Distribution), String> {
    let declared = "name=\"gap\" parameterType=\"double\" value=\"50\"";
    let (folder, _) = changed_in("slow-leader.xosc", declared, &declared.replace("double", kind));
    let text = fs::read_to_string(file("slow-leader-chances.xosc")).unwrap();
    let (from, to) = (text.find("<StochasticDistribution ").unwrap(), text.find("</Stochastic>").unwrap());
    let one = format!("<StochasticDistribution parameterName=\"gap\">{distribution}</StochasticDistribution>");
    let path = folder.path().join("chances.xosc");
    fs::write(&path, [&text[..from], &one, &text[to..]].concat().replace("slow-leader.xosc", "bad.xosc")).unwrap();
    let program = Xosc::read(&path).map_err(|error| error.to_string())?.program();
    let declaration = program.declare().map_err(|error| error.to_string())?;
    let gap = parameter(&declaration, "gap");
    Ok((gap.domain.clone(), gap.distribution.clone()))
}

fn range(lo: f64, hi: f64) -> String {
    format!("<Range lowerLimit=\"{lo}\" upperLimit=\"{hi}\"/>")
}

fn bin(weight: f64, lo: f64, hi: f64) -> String {
    format!("<Bin weight=\"{weight}\">{}</Bin>", range(lo, hi))
}

#[test]
fn normal_and_uniform_distributions_and_sets_give_parameters_their_chances() {
    let declaration = program("slow-leader-chances.xosc").declare().unwrap();
    let [speed, gap, start] = ["speed", "gap", "start"].map(|name| parameter(&declaration, name));
    assert_eq!(
        (&speed.domain, &speed.distribution),
        (&Domain::Interval { lo: 20.0, hi: 60.0 }, &Distribution::Normal(35.0, 5.0))
    );
    assert_eq!((gap.levels().unwrap().len(), &gap.distribution), (2, &Distribution::Weights(vec![1.0, 3.0])));
    assert_eq!(
        (&start.domain, &start.distribution),
        (&Domain::Interval { lo: 30.0, hi: 60.0 }, &Distribution::Uniform)
    );
    // The values of the declarations are the nominal values.
    assert_eq!(declaration.nominal().get("speed"), Some(&Value::Number(30.0)));
    assert_eq!(declaration.nominal().get("gap"), Some(&Value::Number(50.0)));
}

#[test]
fn poisson_and_lognormal_distributions_and_histograms_give_parameters_their_chances() {
    let declaration = program("slow-leader-shapes.xosc").declare().unwrap();
    let [speed, gap, start] = ["speed", "gap", "start"].map(|name| parameter(&declaration, name));
    let levels: Vec<Value> = (20_u8..=45).map(|level| Value::Number(level.into())).collect();
    assert_eq!(speed.domain, Domain::Choice(levels));
    let Distribution::Weights(weights) = &speed.distribution else { panic!("{}", speed.distribution) };
    // The probability of 30 is 30 times the probability of 29 divided by 30, and so on.
    for (step, pair) in weights.windows(2).enumerate() {
        let next = pair[0] * 30.0 / (21.0 + step as f64);
        assert!((pair[1] - next).abs() < 1e-14, "{step}: {pair:?}");
    }
    assert_eq!(gap.domain, Domain::Interval { lo: 20.0, hi: 80.0 });
    let Distribution::LogNormal(mean, deviation) = gap.distribution else { panic!("{}", gap.distribution) };
    // The expected value and the variance of a lognormal number follow from the mean and the variance of its logarithm.
    let variance = deviation * deviation;
    let expected = libm::exp(mean + variance / 2.0);
    assert!((expected - 40.0).abs() < 1e-12 && (expected * expected * libm::expm1(variance) - 100.0).abs() < 1e-10);
    // The bins are in the order of their numbers, and the gap between two of them is a bin of the weight 0.
    let bins = vec![30.0, 1.0, 40.0, 2.0, 45.0, 0.0, 50.0, 3.0, 60.0];
    assert_eq!(
        (&start.domain, &start.distribution),
        (&Domain::Interval { lo: 30.0, hi: 60.0 }, &Distribution::Histogram(bins))
    );
}

#[test]
fn distributions_without_a_range_have_all_their_numbers() {
    let (normal, _) = of_gap("double", "<NormalDistribution expectedValue=\"35\" variance=\"25\"/>").unwrap();
    assert_eq!(normal, Domain::Interval { lo: 35.0 - 6.5 * 5.0, hi: 35.0 + 6.5 * 5.0 });
    let (lognormal, shape) =
        of_gap("double", "<LogNormalDistribution expectedValue=\"40\" variance=\"100\"/>").unwrap();
    let (Domain::Interval { lo, hi }, Distribution::LogNormal(mean, deviation)) = (lognormal, shape) else { panic!() };
    assert!(
        (libm::log(lo) - (mean - 6.5 * deviation)).abs() < 1e-12
            && (libm::log(hi) - (mean + 6.5 * deviation)).abs() < 1e-12
    );
    for (expected, first, last) in [(0.5, 0, 11), (30.0, 1, 75), (400.0, 270, 544)] {
        let text = format!("<PoissonDistribution expectedValue=\"{expected}\"/>");
        let (Domain::Choice(levels), Distribution::Weights(weights)) = of_gap("unsignedInt", &text).unwrap() else {
            panic!("{text}")
        };
        let numbers: Vec<f64> = levels.iter().map(|level| level.number().unwrap()).collect();
        assert_eq!([numbers[0], numbers[numbers.len() - 1]], [first, last].map(f64::from), "{text}");
        let sum: f64 = weights.iter().sum();
        let mean = numbers.iter().zip(&weights).map(|(number, weight)| number * weight).sum::<f64>();
        assert!((sum - 1.0).abs() < 1e-10 && (mean / expected - 1.0).abs() < 1e-9, "{text}: {sum} {mean}");
    }
}

#[test]
fn chances_that_cannot_be_are_refused_in_words() {
    let histogram = |bins: &[String]| format!("<Histogram>{}</Histogram>", bins.concat());
    let poisson = |expected: &str, range: &str| {
        format!("<PoissonDistribution expectedValue=\"{expected}\">{range}</PoissonDistribution>")
    };
    let lognormal = |expected: &str| {
        format!("<LogNormalDistribution expectedValue=\"{expected}\" variance=\"1\"></LogNormalDistribution>")
    };
    for (kind, distribution, says) in [
        ("double", histogram(&[]), "<Histogram> contains no <Bin>, expected at least one"),
        (
            "double",
            histogram(&[bin(1.0, 5.0, 5.0)]),
            "`upperLimit=\"5\"` of <Range> is not allowed, expected a number above 5",
        ),
        (
            "double",
            histogram(&[bin(1.0, 5.0, 9.0), bin(1.0, 1.0, 6.0)]),
            "`lowerLimit=\"5\"` of <Range> is not allowed, expected a number of at least 6, where another bin ends",
        ),
        ("double", histogram(&[bin(-1.0, 5.0, 9.0)]), "`weight=\"-1\"` of <Bin> is not allowed"),
        ("double", histogram(&[bin(0.0, 5.0, 9.0)]), "<Histogram> gives the parameter values or chances that it cannot have"),
        ("int", histogram(&[bin(1.0, 5.0, 9.0)]), "expected a parameter of the type double"),
        ("double", lognormal("-2"), "expected a number above 0"),
        (
            "double",
            "<NormalDistribution expectedValue=\"2\" variance=\"0\"/>".to_owned(),
            "`variance=\"0\"` of <NormalDistribution> is not allowed, expected a number above 0",
        ),
        (
            "double",
            "<ProbabilityDistributionSet><Element value=\"0\" weight=\"1\"/><Element value=\"-0\" weight=\"1\"/></ProbabilityDistributionSet>".to_owned(),
            "`value=\"-0\"` of <Element> is not allowed, expected a value that the set does not have yet",
        ),
        ("int", lognormal("2"), "expected a parameter of the type double"),
        ("string", poisson("2", ""), "expected a parameter whose type is a number"),
        ("double", poisson("0", ""), "expected a number above 0"),
        ("double", poisson("1e6", ""), "expected a number of at most 400000"),
        ("double", poisson("3", &range(-9.0, -1.0)), "expected a range with 1 to 10000 whole numbers"),
        ("double", poisson("3", &range(2.1, 2.9)), "expected a range with 1 to 10000 whole numbers"),
        ("double", poisson("3", &range(0.0, 1e5)), "expected a range with 1 to 10000 whole numbers"),
        ("double", poisson("3", &range(500.0, 600.0)), "a finite sum above 0"),
        ("unsignedShort", poisson("65500", ""), "each a whole number from 0 to 65535"),
    ] {
        let message = of_gap(kind, &distribution).unwrap_err();
        assert!(message.contains(says), "{distribution}: {message}");
    }
}

#[test]
fn the_number_of_test_runs_is_there_and_a_whole_number() {
    let count = "numberOfTestRuns=\"100\"";
    for (by, says) in [
        ("", "<Stochastic> has no attribute `numberOfTestRuns`, which the standard requires"),
        (
            "numberOfTestRuns=\"1.5\"",
            "`numberOfTestRuns=\"1.5\"` of <Stochastic> is not allowed, expected a whole number",
        ),
        (
            "numberOfTestRuns=\"1\" randomSeed=\"x\"",
            "`randomSeed=\"x\"` of <Stochastic> is not allowed, expected a finite number",
        ),
    ] {
        let message = messages_of("slow-leader-chances.xosc", &format!("{count} randomSeed=\"1\""), by);
        assert!(message.contains(says), "{by}: {message}");
    }
}
