//! The parameters that an element sees, and the values of attributes with parameters in them.

use super::kind::{KINDS, Kind};
use crate::xml::{Element, Expression, ExpressionFlaw, Flaw, ReadError, TRUTHS, Value, brief};
use paracosm_space::nearest;
use std::borrow::Cow;
use std::sync::Arc;

/// The greatest magnitude of a number: beyond it, a place in metres has less than six decimals.
const GREATEST: f64 = 1e9;
/// The greatest speed of a target in m/s.
const FASTEST: f64 = 1e6;

/// The values of the parameters that an element sees. Later parameters hide earlier parameters with the same name. The parameters
/// of the whole scenario come first.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope(Vec<Arc<Entry>>);

/// A parameter with its value.
#[derive(Debug)]
struct Entry {
    name: String,
    kind: Kind,
    value: String,
    /// The text of the value, and the number of parameters that the text sees; `None` for a parameter of the whole scenario.
    local: Option<(String, usize)>,
}

impl Scope {
    /// Returns the value of a parameter.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.position(self.len(), name).map(|at| self.0[at].value.as_str())
    }

    /// Returns the type of a parameter.
    pub fn kind(&self, name: &str) -> Option<Kind> {
        self.position(self.len(), name).map(|at| self.0[at].kind)
    }

    /// Returns the number of parameters.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns the names of all parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|entry| entry.name.as_str())
    }

    /// Adds a parameter of the whole scenario.
    pub fn set(&mut self, name: &str, kind: Kind, value: &str) {
        self.add(name, kind, value, None);
    }

    /// Adds a parameter of a part of the scenario. The text of its value sees the first `seen` parameters.
    pub fn define(&mut self, name: &str, kind: Kind, value: &str, (text, seen): (&str, usize)) {
        self.add(name, kind, value, Some((text.to_owned(), seen)));
    }

    fn add(&mut self, name: &str, kind: Kind, value: &str, local: Option<(String, usize)>) {
        self.0.push(Arc::new(Entry { name: name.to_owned(), kind, value: kind.plain(value).to_owned(), local }));
    }

    /// Returns the text of a parameter of a part of the scenario, and the number of parameters that the text sees; `None` for a
    /// parameter of the whole scenario.
    pub fn local(&self, at: usize) -> Option<(&str, usize)> {
        self.0[at].local.as_ref().map(|(text, among)| (text.as_str(), *among))
    }

    /// Returns the indices of the parameters of the whole scenario on which a parameter and texts depend.
    pub fn sources<'t>(&'t self, at: usize, texts: impl Iterator<Item = &'t str>) -> Vec<usize> {
        let mut open: Vec<(&str, usize)> = texts.map(|text| (text, self.len())).collect();
        let (mut seen, mut found) = (vec![at], Vec::new());
        match self.local(at) {
            None => found.push(at),
            Some(local) => open.push(local),
        }
        while let Some((text, among)) = open.pop() {
            for at in references(text).filter_map(|name| self.position(among, name)) {
                if seen.contains(&at) {
                    continue;
                }
                seen.push(at);
                match self.local(at) {
                    None => found.push(at),
                    Some(local) => open.push(local),
                }
            }
        }
        found
    }

    fn position(&self, among: usize, name: &str) -> Option<usize> {
        self.0[..among].iter().rposition(|entry| entry.name == name)
    }

    /// Returns the index of a parameter among the first `among` parameters, which must exist.
    pub fn find(&self, among: usize, name: &str) -> Result<usize, ExpressionFlaw> {
        self.position(among, name).ok_or_else(|| {
            let nearest = nearest(name, self.names().take(among)).map(str::to_owned);
            ExpressionFlaw::NoParameter { name: name.to_owned(), nearest }
        })
    }

    /// Returns the text of an attribute with the values of its parameters.
    pub fn resolve<'t>(&self, text: &'t str) -> Result<Cow<'t, str>, ExpressionFlaw> {
        self.resolve_among(self.len(), text)
    }

    /// Returns the text of an attribute that sees the first `among` parameters.
    fn resolve_among<'t>(&self, among: usize, text: &'t str) -> Result<Cow<'t, str>, ExpressionFlaw> {
        let Some(name) = text.strip_prefix('$') else { return Ok(Cow::Borrowed(text)) };
        let entry = |name: &str| self.find(among, name).map(|at| &self.0[at]);
        match name.strip_prefix('{').map(|inside| inside.strip_suffix('}')) {
            None => Ok(Cow::Owned(entry(name)?.value.clone())),
            Some(None) => Err(ExpressionFlaw::Unexpected { found: text.to_owned(), expected: "`}` at the end" }),
            Some(Some(inside)) => {
                let parameter = |name: &str| entry(name).map(|entry| Value::of(&entry.value));
                Ok(Cow::Owned(Expression::parse(inside)?.value(&parameter)?.to_string()))
            }
        }
    }
}

/// Returns the names of the parameters to which the text of an attribute refers.
pub(super) fn references(text: &str) -> impl Iterator<Item = &str> {
    let is_of_name = |sign: char| sign.is_alphanumeric() || sign == '_';
    let name = move |part: &str| part.find(|sign| !is_of_name(sign)).unwrap_or(part.len());
    text.split('$').skip(1).map(move |part| &part[..name(part)]).filter(|name| !name.is_empty())
}

/// An element with the parameters that it sees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node<'a> {
    pub element: Element<'a, 'a>,
    pub scope: &'a Scope,
}

impl<'a> Node<'a> {
    /// Returns the name of the element.
    pub fn name(self) -> &'a str {
        self.element.name()
    }

    /// Makes an error at the place of the element.
    pub fn error(self, flaw: Flaw) -> ReadError {
        self.element.error(flaw)
    }

    /// Returns all elements directly within this one.
    pub fn elements(self) -> impl Iterator<Item = Self> {
        self.element.elements().map(move |element| Self { element, ..self })
    }

    /// Returns the elements with a name directly within this one.
    pub fn all(self, name: &'static str) -> impl Iterator<Item = Self> {
        self.element.all(name).map(move |element| Self { element, ..self })
    }

    /// Returns the first element with a name directly within this one.
    pub fn first(self, name: &'static str) -> Option<Self> {
        self.all(name).next()
    }

    /// Returns the first element with a name directly within this one, which must exist.
    pub fn child(self, name: &'static str) -> Result<Self, ReadError> {
        self.first(name).ok_or_else(|| self.element.lacks(name))
    }

    /// Returns the only choice of an element that stands for one of several: its first child.
    pub fn choice(self, expected: &'static str) -> Result<Self, ReadError> {
        self.elements().next().ok_or_else(|| self.element.lacks(expected))
    }

    /// Makes the error that this element is not supported.
    pub fn refused(self, reason: &'static str) -> ReadError {
        self.error(Flaw::Refused { element: self.name().to_owned(), reason })
    }

    /// Makes the error that the value `found` of an attribute is not allowed.
    pub fn unexpected(self, attribute: &str, found: &str, expected: impl Into<String>) -> ReadError {
        self.element.unexpected_value(attribute, found, expected, [])
    }

    /// Returns the value of an attribute; `None` if the attribute is absent or empty.
    pub fn text(self, attribute: &'static str) -> Result<Option<Cow<'a, str>>, ReadError> {
        self.text_among(self.scope.len(), attribute)
    }

    /// Returns the value of an attribute that sees the first `among` parameters; `None` if the attribute is absent or empty.
    pub fn text_among(self, among: usize, attribute: &'static str) -> Result<Option<Cow<'a, str>>, ReadError> {
        let Some(text) = self.element.text(attribute) else { return Ok(None) };
        let resolved = self.scope.resolve_among(among, text).map_err(|flaw| {
            let flaw = self.told_of_later(flaw);
            let (element, attribute) = (self.name().to_owned(), attribute.to_owned());
            self.error(Flaw::Expression { element, attribute, text: brief(text), flaw })
        })?;
        Ok(Some(resolved))
    }

    /// Returns the flaw of an expression that names a parameter, after a look at the declarations beside this one: the parameter may be
    /// declared later.
    fn told_of_later(self, flaw: ExpressionFlaw) -> ExpressionFlaw {
        let is_declared = |name: &str| {
            self.name() == "ParameterDeclaration" && self.element.beside().any(|other| other.text("name") == Some(name))
        };
        match flaw {
            ExpressionFlaw::NoParameter { name, .. } if self.element.text("name") == Some(&name) => {
                ExpressionFlaw::Itself { name }
            }
            ExpressionFlaw::NoParameter { name, .. } if is_declared(&name) => ExpressionFlaw::Later { name },
            flaw => flaw,
        }
    }

    /// Returns the value of an attribute, which must exist.
    pub fn required(self, attribute: &'static str) -> Result<Cow<'a, str>, ReadError> {
        self.text(attribute)?.ok_or_else(|| self.element.missing(attribute))
    }

    /// Returns the value of an attribute, which must exist and be of a type.
    pub fn of_kind(self, attribute: &'static str, kind: Kind) -> Result<Cow<'a, str>, ReadError> {
        let text = self.required(attribute)?;
        if kind.takes(&text) { Ok(text) } else { Err(self.unexpected(attribute, &text, kind.expected())) }
    }

    /// Returns the type that an attribute names.
    pub fn kind(self, attribute: &'static str) -> Result<Kind, ReadError> {
        self.element.one_of(attribute, &KINDS)
    }

    /// Returns the name of the element; `None` if it has none. A name is a part of messages and of signals, so it has no line breaks.
    pub fn label(self) -> Result<Option<Cow<'a, str>>, ReadError> {
        match self.text("name")? {
            Some(name) if name.contains(char::is_control) => {
                let shown = name.escape_debug().to_string();
                Err(self.unexpected("name", &shown, "a name without line breaks and other control characters"))
            }
            name => Ok(name),
        }
    }

    /// Returns the name of the element, which must have one.
    pub fn label_required(self) -> Result<Cow<'a, str>, ReadError> {
        self.label()?.ok_or_else(|| self.element.missing("name"))
    }

    /// Returns the number in an attribute, which must exist and be finite.
    pub fn number(self, attribute: &'static str) -> Result<f64, ReadError> {
        self.bounded(attribute, ("a finite number", |_| true), GREATEST)
    }

    /// Returns the speed in an attribute in m/s, which must exist.
    pub fn speed(self, attribute: &'static str) -> Result<f64, ReadError> {
        self.bounded(attribute, ("a finite number", |_| true), FASTEST)
    }

    /// Returns the number in an attribute; `default` if the attribute is absent.
    pub fn number_or(self, attribute: &'static str, default: f64) -> Result<f64, ReadError> {
        if self.element.text(attribute).is_some() { self.number(attribute) } else { Ok(default) }
    }

    /// Returns the number in an attribute if the attribute is there.
    pub fn optional(self, attribute: &'static str) -> Result<Option<f64>, ReadError> {
        self.element.text(attribute).map(|_| self.number(attribute)).transpose()
    }

    /// Returns the number in an attribute, which must exist and must not be negative.
    pub fn length(self, attribute: &'static str) -> Result<f64, ReadError> {
        self.bounded(attribute, ("a number that is not negative", |number| number >= 0.0), GREATEST)
    }

    /// Returns the number in an attribute, which must not be negative; `default` if the attribute is absent.
    pub fn length_or(self, attribute: &'static str, default: f64) -> Result<f64, ReadError> {
        if self.element.text(attribute).is_some() { self.length(attribute) } else { Ok(default) }
    }

    /// Returns the greatest allowed value in an attribute, which must exist and must not be negative. A very great one has no effect.
    pub fn limit(self, attribute: &'static str) -> Result<f64, ReadError> {
        self.bounded(attribute, ("a number that is not negative", |number| number >= 0.0), f64::MAX)
    }

    /// Returns the number in an attribute, which must exist and must be above 0.
    pub fn positive(self, attribute: &'static str) -> Result<f64, ReadError> {
        let sound = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
        self.parsed(attribute, "a number above 0", sound)
    }

    /// Returns the whole number in an attribute, which must exist. A parameter may write it with decimals.
    pub fn whole(self, attribute: &'static str) -> Result<i32, ReadError> {
        let whole = |text: &str| {
            let number = text.parse().ok().filter(|number: &f64| number.fract() == 0.0);
            number.filter(|number| number.abs() <= f64::from(i32::MAX)).map(|number| number as i32)
        };
        self.parsed(attribute, "a whole number", whole)
    }

    /// Returns the whole number in an attribute, which must exist and must be above 0.
    pub fn positive_count(self, attribute: &'static str) -> Result<u32, ReadError> {
        let number = self.whole(attribute)?;
        let wrong = || self.unexpected(attribute, &number.to_string(), "a whole number above 0");
        u32::try_from(number).ok().filter(|number| *number > 0).ok_or_else(wrong)
    }

    /// Returns the number of a lane in an attribute, which must exist.
    pub fn lane(self, attribute: &'static str) -> Result<i32, ReadError> {
        let number = self.whole(attribute)?;
        let expected = "the number of a lane with a width, which is not 0; a RoadPosition gives places on lane 0";
        if number == 0 { Err(self.unexpected(attribute, "0", expected)) } else { Ok(number) }
    }

    /// Returns the truth in an attribute; `default` if the attribute is absent.
    pub fn truth_or(self, attribute: &'static str, default: bool) -> Result<bool, ReadError> {
        if self.element.text(attribute).is_some() { self.one_of(attribute, &TRUTHS) } else { Ok(default) }
    }

    /// Returns the value in an attribute that has one of the given names.
    pub fn one_of<T: Copy>(self, attribute: &'static str, names: &[(&'static str, T)]) -> Result<T, ReadError> {
        self.element.chosen(attribute, &self.required(attribute)?, names)
    }

    /// Makes the error that an attribute names something that does not exist. `names` are the existing names.
    pub fn dangling<'n>(
        self,
        attribute: &'static str,
        kind: &'static str,
        names: impl IntoIterator<Item = &'n str>,
    ) -> ReadError {
        let found = self.text(attribute).ok().flatten().unwrap_or_default();
        self.element.dangling_value(attribute, &found, kind, names)
    }

    /// Returns the number in an attribute, which must exist, be sound, and have a magnitude of at most `most`.
    fn bounded(
        self,
        attribute: &'static str,
        (expected, is_sound): (&'static str, fn(f64) -> bool),
        most: f64,
    ) -> Result<f64, ReadError> {
        let sound = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite() && is_sound(*number));
        let number = self.parsed(attribute, expected, sound)?;
        if number.abs() <= most {
            return Ok(number);
        }
        Err(self.unexpected(attribute, &self.required(attribute)?, format!("a magnitude of at most {most}")))
    }

    fn parsed<T>(
        self,
        attribute: &'static str,
        expected: &'static str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Result<T, ReadError> {
        let text = self.required(attribute)?;
        parse(&text).ok_or_else(|| self.element.unexpected_value(attribute, &text, expected, []))
    }
}
