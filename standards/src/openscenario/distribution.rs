//! Distributions of parameters: which parameters a file opens, with which values.

use super::chances::{chances, levels};
use super::kind::Kind;
use super::scope::Node;
use crate::xml::{Flaw, ReadError};
use paracosm_engine::Declared;
use paracosm_space::{self as space, Domain, Parameter, Space, Value};

/// The greatest number of values that a range with a step may list.
const MOST_LEVELS: f64 = 10_000.0;
/// The share of a step by which a range may exceed its upper limit, because steps are sums of rounded numbers.
const TOLERANCE: f64 = 1e-9;
/// The sign between the names and between the values of parameters that change together.
const JOINT: &str = "|";

/// The parameters that a distribution opens, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Distribution(pub Vec<Opened>);

/// Parameters that a distribution opens together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Opened {
    names: Vec<String>,
    kinds: Vec<Kind>,
    values: Choices,
}

/// The values of parameters that a distribution opens.
#[derive(Debug, Clone, PartialEq)]
enum Choices {
    /// The tuples of values.
    Tuples(Vec<Vec<String>>),
    /// All numbers of an interval, of which a test has those of `levels` by default.
    Range { lo: f64, hi: f64, levels: Vec<Value> },
    /// The numbers of an interval or the values of a list, with their chances.
    Chance(Domain, space::Distribution),
}

impl Distribution {
    /// Reads an element `ParameterValueDistribution` of a scenario that declares parameters with the given names and types.
    pub fn read(root: Node<'_>, declared: &[(String, Kind)]) -> Result<Self, ReadError> {
        let name = |node: Node<'_>| name(node, "parameterName", declared);
        if let Some(chances) = root.first("Stochastic") {
            let mut all: Vec<Opened> = Vec::new();
            for node in some(chances, "StochasticDistribution")? {
                let (name, of) = name(node)?;
                if all.iter().any(|other| other.names.contains(&name)) {
                    return Err(twice_distributed(node, &name));
                }
                all.push(Opened::chance(name, of, node)?);
            }
            return Ok(Self(all));
        }
        let mut all = Vec::new();
        for node in root.child("Deterministic")?.elements() {
            let kind = node.choice("a kind of distribution such as DistributionSet")?;
            let (names, kinds, values) = match kind.name() {
                "DistributionSet" => {
                    let (name, of) = name(node)?;
                    let levels = levels(kind, of)?.into_iter().map(|text| vec![text]).collect();
                    (vec![name], vec![of], Choices::Tuples(levels))
                }
                "DistributionRange" => {
                    let (name, of) = name(node)?;
                    let values = range(kind, &name, of)?;
                    (vec![name], vec![of], values)
                }
                "ValueSetDistribution" => tuples(kind, declared)?,
                _ => return Err(kind.refused("use a DistributionSet, a DistributionRange or a ValueSetDistribution")),
            };
            let twice = |name: &&String| all.iter().any(|other: &Opened| other.names.contains(name));
            if let Some(name) = names.iter().find(twice) {
                return Err(twice_distributed(node, name));
            }
            all.push(Opened { names, kinds, values });
        }
        Ok(Self(all))
    }

    /// Returns the parameters that a distribution opens together with this parameter.
    pub fn of(&self, name: &str) -> Option<&Opened> {
        self.0.iter().find(|opened| opened.has(name))
    }
}

impl Opened {
    fn chance(name: String, of: Kind, node: Node<'_>) -> Result<Self, ReadError> {
        let (domain, chances) = chances(node, &name, of)?;
        let opened = Self { names: vec![name], kinds: vec![of], values: Choices::Chance(domain, chances) };
        let parameter = opened.declared(|_| None).parameter;
        let kind = node.elements().next().unwrap_or(node);
        let misfit = |flaw| Flaw::Parameter { element: kind.name().to_owned(), flaw };
        Space::new(vec![parameter]).map_err(|flaw| kind.error(misfit(flaw)))?;
        Ok(opened)
    }

    /// Returns the type of the parameter if the distribution opens a single one.
    pub fn single(&self) -> Option<Kind> {
        match self.kinds.as_slice() {
            [kind] => Some(*kind),
            _ => None,
        }
    }

    /// Returns `true` if the distribution opens a parameter with this name.
    pub fn has(&self, name: &str) -> bool {
        self.names.iter().any(|known| known == name)
    }

    /// Returns the name of the parameter that stands for these parameters in a test.
    pub fn name(&self) -> String {
        self.names.join(JOINT)
    }

    /// Returns the values of these parameters as one value of a test.
    fn value(&self, level: &[String]) -> Value {
        match (self.kinds.as_slice(), level) {
            ([kind], [text]) => kind.value(text),
            (_, texts) => Value::from(texts.join(JOINT).as_str()),
        }
    }

    /// Returns the parameter that stands for these parameters in a test. `nominal` gives the value of a declaration.
    pub fn declared(&self, nominal: impl Fn(&str) -> Option<Value>) -> Declared {
        let (domain, opens) = match &self.values {
            Choices::Tuples(levels) => (Domain::Choice(levels.iter().map(|level| self.value(level)).collect()), None),
            Choices::Range { lo, hi, levels } => {
                (Domain::Interval { lo: *lo, hi: *hi }, Some(Domain::Choice(levels.clone())))
            }
            Choices::Chance(domain, _) => (domain.clone(), None),
        };
        let mut parameter = Parameter::new(self.name(), domain);
        if let Choices::Chance(_, chances) = &self.values {
            parameter.distribution = chances.clone();
        }
        let declared: Vec<Option<Value>> = self.names.iter().map(|name| nominal(name)).collect();
        parameter.default = self.nearest(&declared);
        Declared { opens, ..Declared::open(parameter) }
    }

    /// Returns the value that is nearest to the values of the declarations: the same words, and the nearest numbers.
    fn nearest(&self, declared: &[Option<Value>]) -> Option<Value> {
        let apart = |value: &Value, declared: &Option<Value>| match (value, declared) {
            (Value::Number(value), Some(Value::Number(declared))) => (value - declared).abs(),
            (value, declared) => f64::from(u8::from(Some(value) != declared.as_ref())),
        };
        let nearest = |levels: &[Value]| {
            let first = declared.first()?;
            levels.iter().min_by(|a, b| apart(a, first).total_cmp(&apart(b, first))).cloned()
        };
        match &self.values {
            Choices::Tuples(levels) => {
                let distance = |level: &&Vec<String>| -> f64 {
                    let values = level.iter().zip(&self.kinds).map(|(text, kind)| kind.value(text));
                    values.zip(declared).map(|(value, declared)| apart(&value, declared)).sum()
                };
                levels.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|level| self.value(level))
            }
            Choices::Range { levels, .. } | Choices::Chance(Domain::Choice(levels), _) => nearest(levels),
            Choices::Chance(Domain::Interval { lo, hi }, _) => {
                declared.first()?.as_ref()?.number().map(|number| Value::Number(number.clamp(*lo, *hi)))
            }
        }
    }

    /// Returns the tuples of values of parameters that change together; `None` for a single parameter.
    pub fn tuples(&self) -> Option<Vec<Value>> {
        match &self.values {
            Choices::Tuples(levels) if self.names.len() > 1 => {
                Some(levels.iter().map(|level| self.value(level)).collect())
            }
            _ => None,
        }
    }

    /// Returns the value of a test if the single parameters have these texts as values, however these are written.
    pub fn stated<'t>(&self, text: impl Fn(&str) -> &'t str) -> Value {
        let texts: Vec<String> = self.names.iter().map(|name| text(name).to_owned()).collect();
        let is_same = |level: &&Vec<String>| {
            let mut pairs = self.kinds.iter().zip(level.iter().zip(&texts));
            pairs.all(|(kind, (one, two))| kind.value(one) == kind.value(two))
        };
        match &self.values {
            Choices::Tuples(levels) => self.value(levels.iter().find(is_same).unwrap_or(&texts)),
            Choices::Range { .. } | Choices::Chance(..) => self.value(&texts),
        }
    }

    /// Returns the values of the single parameters, by their names, that the value of a test stands for.
    pub fn parts(&self, value: &Value) -> Vec<(&str, String)> {
        let level = match &self.values {
            Choices::Tuples(levels) => levels.iter().find(|level| self.value(level) == *value).cloned(),
            Choices::Range { .. } | Choices::Chance(..) => None,
        };
        let level = level.unwrap_or_else(|| vec![value.to_string()]);
        self.names.iter().map(String::as_str).zip(level).collect()
    }
}

/// Returns the name and the type of a parameter that the scenario declares.
fn name(node: Node<'_>, attribute: &'static str, declared: &[(String, Kind)]) -> Result<(String, Kind), ReadError> {
    let name = node.element.required(attribute)?;
    let known = declared.iter().find(|(known, _)| known == name).cloned();
    known.ok_or_else(|| node.dangling(attribute, "parameter", declared.iter().map(|(known, _)| known.as_str())))
}

/// Returns the children with a name, of which there is at least one.
fn some<'a>(node: Node<'a>, child: &'static str) -> Result<impl Iterator<Item = Node<'a>>, ReadError> {
    node.child(child)?;
    Ok(node.all(child))
}

/// Makes the error that a parameter has a second distribution.
fn twice_distributed(node: Node<'_>, name: &str) -> ReadError {
    node.unexpected("parameterName", name, "one distribution of each parameter")
}

fn range(node: Node<'_>, name: &str, of: Kind) -> Result<Choices, ReadError> {
    let limits = node.child("Range")?;
    if of.is_text() {
        return Err(node.unexpected("parameterName", name, "a parameter whose type is a number"));
    }
    for (node, attribute) in [(limits, "lowerLimit"), (limits, "upperLimit"), (node, "stepWidth")] {
        node.of_kind(attribute, of)?;
    }
    let (lo, hi, step) = (limits.number("lowerLimit")?, limits.number("upperLimit")?, node.number("stepWidth")?);
    if lo > hi {
        return Err(limits.unexpected(
            "upperLimit",
            &limits.required("upperLimit")?,
            format!("a number of at least {lo}"),
        ));
    }
    let count = (hi - lo) / step + TOLERANCE;
    if !(step > 0.0 && (0.0..MOST_LEVELS).contains(&count)) {
        let expected = format!("a step above 0 that divides {lo} to {hi} into at most {MOST_LEVELS} parts");
        return Err(node.unexpected("stepWidth", &node.required("stepWidth")?, expected));
    }
    // With these decimals, the levels are written in the file.
    let decimals = decimals(&limits.required("lowerLimit")?).zip(decimals(&node.required("stepWidth")?));
    let decimals = decimals.map(|(lower, step)| lower.max(step));
    let level = |index: usize| {
        let sum = lo + index as f64 * step;
        decimals.map_or(sum, |decimals| rounded_to(sum, decimals)).min(hi).into()
    };
    let levels: Vec<Value> = (0..=count as usize).map(level).collect();
    // A range of a single value is no interval.
    let single = || Choices::Tuples(vec![vec![lo.to_string()]]);
    Ok(if lo < hi { Choices::Range { lo, hi, levels } } else { single() })
}

/// Returns the number of decimals with which a number is written; `None` if it has an exponent.
fn decimals(text: &str) -> Option<usize> {
    let plain = !text.contains(['e', 'E']);
    plain.then(|| text.split_once('.').map_or(0, |(_, decimals)| decimals.len()))
}

/// Returns a sum of numbers with so many decimals as this number of decimals, without the noise of the sum.
fn rounded_to(number: f64, decimals: usize) -> f64 {
    format!("{number:.decimals$}").parse().unwrap_or(number)
}

fn tuples(kind: Node<'_>, declared: &[(String, Kind)]) -> Result<(Vec<String>, Vec<Kind>, Choices), ReadError> {
    let (mut names, mut kinds): (Vec<String>, Vec<Kind>) = Default::default();
    let mut levels = Vec::new();
    for set in some(kind, "ParameterValueSet")? {
        let mut level: Vec<(String, String)> = Vec::new();
        for assignment in some(set, "ParameterAssignment")? {
            let (name, of) = name(assignment, "parameterRef", declared)?;
            if level.iter().any(|(known, _)| *known == name) {
                let expected = "a parameter to which the set has not assigned a value yet";
                return Err(assignment.unexpected("parameterRef", &name, expected));
            }
            if levels.is_empty() {
                names.push(name.clone());
                kinds.push(of);
            } else if !names.contains(&name) {
                let expected = "a parameter of the first set";
                let known = names.iter().map(String::as_str);
                return Err(assignment.element.unexpected_value("parameterRef", &name, expected, known));
            }
            level.push((name, assignment.of_kind("value", of)?.into_owned()));
        }
        let value = |name: &String| {
            let own = level.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone());
            let expected = || format!("an assignment of `{name}` as in the first set");
            own.ok_or_else(|| set.unexpected("parameterRef", "", expected()))
        };
        levels.push(names.iter().map(value).collect::<Result<Vec<_>, ReadError>>()?);
    }
    Ok((names, kinds, Choices::Tuples(levels)))
}
