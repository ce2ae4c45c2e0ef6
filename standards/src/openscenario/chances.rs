//! Stochastic distributions of parameters: which values a parameter has, with which chances.

use super::kind::Kind;
use super::scope::Node;
use crate::xml::ReadError;
use paracosm_space::{Distribution, Domain, Value};
use std::collections::BTreeSet;

/// The standard deviations on either side of the mean to which a normal distribution without a range reaches. Less than one number in
/// ten billion lies outside.
const WIDTH: f64 = 6.5;
/// The least probability of a whole number that a Poisson distribution without a range has among its values.
const RAREST: f64 = 1e-12;
/// The greatest number of values of a Poisson distribution. A greater expected value has more.
const MOST_LEVELS: f64 = 10_000.0;
/// The greatest expected value of a Poisson distribution, whose values are then less than [`MOST_LEVELS`].
const GREATEST_MEAN: f64 = 400_000.0;

/// Returns the values of the parameter `name` of the type `of`, and their chances, from a `StochasticDistribution`.
pub(super) fn chances(node: Node<'_>, name: &str, of: Kind) -> Result<(Domain, Distribution), ReadError> {
    let kind = node.choice("a kind of distribution such as UniformDistribution")?;
    let of_intervals = match kind.name() {
        "UniformDistribution" => uniform,
        "NormalDistribution" => normal,
        "LogNormalDistribution" => lognormal,
        "Histogram" => histogram,
        "PoissonDistribution" if !of.is_number() => {
            return Err(node.unexpected("parameterName", name, "a parameter whose type is a number"));
        }
        "PoissonDistribution" => return poisson(kind, of),
        _ => return set(kind, of),
    };
    if of != Kind::Double {
        let expected =
            "a parameter of the type double; a ProbabilityDistributionSet gives chances to values of other types";
        return Err(node.unexpected("parameterName", name, expected));
    }
    of_intervals(kind)
}

fn uniform(kind: Node<'_>) -> Result<(Domain, Distribution), ReadError> {
    Ok((interval(kind.child("Range")?)?, Distribution::Uniform))
}

fn normal(kind: Node<'_>) -> Result<(Domain, Distribution), ReadError> {
    let (mean, deviation) = (kind.number("expectedValue")?, libm::sqrt(kind.positive("variance")?));
    let whole = Domain::Interval { lo: mean - WIDTH * deviation, hi: mean + WIDTH * deviation };
    let domain = kind.first("Range").map(interval).transpose()?.unwrap_or(whole);
    Ok((domain, Distribution::Normal(mean, deviation)))
}

/// The file has the expected value m and the variance v of the number. Its logarithm has the variance ln(1 + v/m²) and the mean
/// ln m less half of that variance.
fn lognormal(kind: Node<'_>) -> Result<(Domain, Distribution), ReadError> {
    let (expected, variance) = (kind.positive("expectedValue")?, kind.positive("variance")?);
    let of_logarithm = libm::log1p(variance / expected / expected);
    let (mean, deviation) = (libm::log(expected) - of_logarithm / 2.0, libm::sqrt(of_logarithm));
    let [lo, hi] = [-WIDTH, WIDTH].map(|deviations| libm::exp(mean + deviations * deviation));
    let domain = kind.first("Range").map(interval).transpose()?.unwrap_or(Domain::Interval { lo, hi });
    Ok((domain, Distribution::LogNormal(mean, deviation)))
}

/// Between two bins, the density is 0.
fn histogram(kind: Node<'_>) -> Result<(Domain, Distribution), ReadError> {
    let mut bins = Vec::new();
    for bin in kind.all("Bin") {
        let range = bin.child("Range")?;
        bins.push((range.number("lowerLimit")?, bin.length("weight")?, range.number("upperLimit")?, range));
    }
    bins.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut numbers: Vec<f64> = Vec::new();
    for (lower, weight, upper, range) in bins {
        if upper <= lower {
            let expected = format!("a number above {lower}");
            return Err(range.unexpected("upperLimit", &range.required("upperLimit")?, expected));
        }
        match numbers.last() {
            Some(&end) if lower < end => {
                let expected = format!("a number of at least {end}, where another bin ends");
                return Err(range.unexpected("lowerLimit", &range.required("lowerLimit")?, expected));
            }
            Some(&end) if lower > end => numbers.extend([0.0, lower]),
            Some(_) => {}
            None => numbers.push(lower),
        }
        numbers.extend([weight, upper]);
    }
    let (Some(&lo), Some(&hi)) = (numbers.first(), numbers.last()) else { return Err(kind.element.lacks("Bin")) };
    Ok((Domain::Interval { lo, hi }, Distribution::Histogram(numbers)))
}

/// A Poisson distribution gives chances to whole numbers.
fn poisson(kind: Node<'_>, of: Kind) -> Result<(Domain, Distribution), ReadError> {
    let mean = kind.positive("expectedValue")?;
    if mean > GREATEST_MEAN {
        let expected = format!("a number of at most {GREATEST_MEAN}");
        return Err(kind.unexpected("expectedValue", &kind.required("expectedValue")?, expected));
    }
    let probability = |number: f64| libm::exp(number * libm::log(mean) - mean - libm::lgamma(number + 1.0));
    let (first, last) = match kind.first("Range") {
        Some(range) => {
            let (lower, upper) = (range.number("lowerLimit")?.max(0.0).ceil(), range.number("upperLimit")?.floor());
            if !(0.0..MOST_LEVELS).contains(&(upper - lower)) {
                let expected = format!("a range with 1 to {MOST_LEVELS} whole numbers that are not negative");
                return Err(range.unexpected("upperLimit", &range.required("upperLimit")?, expected));
            }
            (lower, upper)
        }
        None => {
            let (mut first, mut last) = (mean.floor(), mean.floor());
            while first > 0.0 && probability(first - 1.0) >= RAREST {
                first -= 1.0;
            }
            while probability(last + 1.0) >= RAREST {
                last += 1.0;
            }
            (first, last)
        }
    };
    let numbers: Vec<f64> = (0..=(last - first) as u32).map(|step| first + f64::from(step)).collect();
    if let Some(misfit) = numbers.iter().find(|number| !of.takes(&number.to_string())) {
        let expected = format!("a distribution whose numbers are values of the parameter, each {}", of.expected());
        return Err(kind.unexpected("expectedValue", &misfit.to_string(), expected));
    }
    let levels = numbers.iter().map(|number| Value::Number(*number)).collect();
    Ok((Domain::Choice(levels), Distribution::Weights(numbers.into_iter().map(probability).collect())))
}

fn set(kind: Node<'_>, of: Kind) -> Result<(Domain, Distribution), ReadError> {
    let levels = levels(kind, of)?.into_iter().map(|text| of.value(&text)).collect();
    let weights = kind.all("Element").map(|element| element.length("weight")).collect::<Result<_, _>>()?;
    Ok((Domain::Choice(levels), Distribution::Weights(weights)))
}

/// Returns the texts of the values of a set, which are different.
pub(super) fn levels(set: Node<'_>, of: Kind) -> Result<Vec<String>, ReadError> {
    let (mut levels, mut known) = (Vec::new(), BTreeSet::new());
    set.child("Element")?;
    for element in set.all("Element") {
        let text = element.of_kind("value", of)?;
        // A zero with a sign is a zero.
        let written = match of.value(&text) {
            Value::Number(number) => (number + 0.0).to_string(),
            other => other.to_string(),
        };
        if !known.insert(written) {
            return Err(element.unexpected("value", &text, "a value that the set does not have yet"));
        }
        levels.push(text.into_owned());
    }
    Ok(levels)
}

/// Returns the interval of an element `Range`.
fn interval(range: Node<'_>) -> Result<Domain, ReadError> {
    Ok(Domain::Interval { lo: range.number("lowerLimit")?, hi: range.number("upperLimit")? })
}
