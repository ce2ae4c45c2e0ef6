//! Reads the lines that declare parameters.

use super::{Fault, MOST_VALUES, OPENING, PictFlaw, begins_with, fail, indent};
use crate::constraint::Relation;
use crate::names::nearest;
use crate::plural::some_of;
use crate::value::Meaning;
use crate::{Position, Value};
use std::collections::{HashMap, HashSet};
use std::ops::Deref;

/// The most values that a note lists.
const MOST_LISTED: usize = 10;

/// A parameter of a model.
pub(super) struct Declared {
    pub name: String,
    pub values: Vec<Listed>,
    /// True if all values are numbers. Constraints then compare the parameter with numbers.
    pub numeric: bool,
    /// The values as constraints see them.
    known: HashSet<Seen>,
}

/// A value as constraints see it: numbers in all notations are one number, and words in all cases are one word.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Seen {
    Number(u64),
    Word(String),
}

impl Seen {
    pub fn word(word: &str) -> Self {
        Self::Word(folded(word))
    }

    /// Returns the value as constraints see it. If the value is no number, its text counts.
    pub fn of(value: &Value) -> Self {
        match value.meaning() {
            Meaning::Number(number) => Self::Number(number),
            Meaning::Word(_) | Meaning::List(_) => Self::word(&value.to_string()),
        }
    }
}

/// Returns the text in upper case, character by character, as PICT compares words.
pub(super) fn folded(text: &str) -> String {
    let upper = |c: char| {
        let mut upper = c.to_uppercase();
        match (upper.next(), upper.next()) {
            (Some(one), None) => one,
            _ => c,
        }
    };
    text.chars().map(upper).collect()
}

/// The parameters of a model in their order. Their names are found without regard to case.
#[derive(Default)]
pub(super) struct Declarations {
    list: Vec<Declared>,
    positions: HashMap<String, usize>,
}

impl Deref for Declarations {
    type Target = [Declared];

    fn deref(&self) -> &[Declared] {
        &self.list
    }
}

impl Declarations {
    fn push(&mut self, declared: Declared) {
        self.positions.insert(folded(&declared.name), self.list.len());
        self.list.push(declared);
    }

    /// Returns the position of the parameter of this name, ignoring case.
    ///
    /// # Errors
    /// No parameter has the name: [`PictFlaw::Unknown`] suggests the nearest name.
    pub fn find(&self, name: &str) -> Result<usize, PictFlaw> {
        self.positions.get(&folded(name)).copied().ok_or_else(|| {
            let nearest = nearest(name, self.list.iter().map(|parameter| parameter.name.as_str()));
            PictFlaw::Unknown { name: name.to_owned(), nearest: nearest.map(str::to_owned) }
        })
    }
}

/// A value of a parameter.
#[derive(Clone)]
pub(super) struct Listed {
    /// The text of the value, without its sign, aliases and weight.
    pub text: String,
    pub aliases: Vec<String>,
    pub value: Value,
    pub negative: bool,
}

impl Listed {
    /// Returns `true` if the relation holds between this value of a parameter and `value` in a constraint. Words are
    /// compared in upper case.
    pub fn related(&self, relation: Relation, value: &Value) -> bool {
        match value.word() {
            Some(word) => relation.holds(&folded(&self.text), &folded(word)),
            None => self.value.number().zip(value.number()).is_some_and(|(own, number)| relation.holds(&own, &number)),
        }
    }
}

impl Declared {
    /// Makes a parameter, after the texts of all its values are known. If all values are numbers, each value is a
    /// number that keeps its text, so that constraints see numbers. Otherwise constraints see texts, and a number that
    /// is written in an unusual way becomes a word.
    fn new(name: String, mut values: Vec<Listed>) -> Self {
        let numeric = values.iter().all(|listed| listed.value.number().is_some());
        for listed in &mut values {
            listed.value = match Value::written(&listed.text) {
                Value::Written(..) if !numeric => Value::Word(listed.text.clone()),
                value => value,
            };
        }
        let mut declared = Self { name, values, numeric, known: HashSet::new() };
        declared.known = declared.values.iter().map(|listed| declared.seen(listed)).collect();
        declared
    }

    /// Returns a value of the parameter as constraints see the value.
    pub fn seen(&self, listed: &Listed) -> Seen {
        if self.numeric { Seen::of(&listed.value) } else { Seen::word(&listed.text) }
    }

    /// Returns `true` if a value of the parameter is the same as the value in a constraint.
    pub fn takes(&self, value: &Value) -> bool {
        self.known.contains(&Seen::of(value))
    }

    /// Returns `true` if a value of the parameter is the same for constraints as a value of the other parameter.
    pub fn shares_a_value(&self, other: &Self) -> bool {
        !self.known.is_disjoint(&other.known)
    }

    pub fn has_negatives(&self) -> bool {
        self.values.iter().any(|listed| listed.negative)
    }
}

/// The values of a line, as far as they are read.
#[derive(Default)]
struct Values {
    listed: Vec<Listed>,
    /// The texts of the values.
    texts: HashSet<String>,
    /// The sign of each value, which is the same in all notations of a number.
    signs: HashMap<Seen, bool>,
    /// The texts that the line lists again.
    again: Vec<String>,
}

impl Values {
    /// Adds a value. If the line has the text already, the value counts as listed again.
    ///
    /// # Errors
    /// The value also stands in the line with the other sign.
    fn add(&mut self, listed: Listed) -> Result<(), PictFlaw> {
        let sign = match listed.value.number() {
            Some(_) => Seen::of(&listed.value),
            None => Seen::Word(listed.text.clone()),
        };
        if *self.signs.entry(sign).or_insert(listed.negative) != listed.negative {
            return Err(PictFlaw::BothSigns { value: listed.text });
        }
        if self.texts.insert(listed.text.clone()) {
            self.listed.push(listed);
        } else {
            self.again.push(format!("`{}`", listed.text));
        }
        Ok(())
    }
}

/// The parameters read so far.
#[derive(Default)]
pub(super) struct Parameters {
    pub declared: Declarations,
    pub notes: Vec<String>,
    without_colon: Vec<String>,
    weighted: Vec<String>,
    aliased: Vec<String>,
    /// Names in `<` and `>` that no parameter above has, with their places.
    unknown: Vec<(String, usize)>,
    /// The number of values read so far.
    values: usize,
}

impl Parameters {
    /// Reads the line of a parameter, which begins at `offset` in the file. `line` has no line end.
    pub fn read(&mut self, line: &str, offset: usize) -> Result<(), Fault> {
        let is_statement = line.contains('[') && line.ends_with(';');
        let comma = line.split_once(',').filter(|_| !is_statement);
        let Some((head, list)) = line.split_once(':').or(comma) else {
            let constraint = line.contains('[') || OPENING.iter().any(|word| begins_with(line, word));
            return fail(offset + line.len(), PictFlaw::NoColon { constraint });
        };
        let name = head.trim();
        let at = offset + indent(head);
        if name.is_empty() {
            return fail(at, PictFlaw::Nameless);
        }
        if name.starts_with('$') {
            return fail(at, PictFlaw::ResultParameter { name: name.to_owned() });
        }
        let order = name.split_once('@').filter(|(_, order)| order.trim().parse::<f64>().is_ok());
        if let Some((name, _)) = order {
            return fail(at + name.len(), PictFlaw::OrderOfParameter);
        }
        if !line.contains(':') {
            self.without_colon.push(format!("`{name}`"));
        }
        if let Ok(known) = self.declared.find(name) {
            return fail(at, PictFlaw::Twice { name: self.declared[known].name.clone() });
        }
        // PICT makes a test of each empty value, and prints empty lines.
        if list.split(',').all(|piece| piece.trim().is_empty()) {
            return fail(offset + line.len(), PictFlaw::NoValues { name: name.to_owned() });
        }
        let mut values = Values::default();
        let mut at = offset + head.len() + 1;
        for piece in list.split(',') {
            let place = at + indent(piece);
            for listed in self.piece(piece, place) {
                self.values += 1;
                if self.values > MOST_VALUES {
                    return fail(place, PictFlaw::TooManyValues { most: MOST_VALUES });
                }
                values.add(listed).or_else(|flaw| fail(place, flaw))?;
            }
            at += piece.len() + 1;
        }
        let Values { listed, again, .. } = values;
        if listed.iter().all(|listed| listed.negative) {
            let flaw = PictFlaw::OnlyNegative { name: name.to_owned() };
            return fail(offset + head.len() + 1 + indent(list), flaw);
        }
        if listed.iter().any(|listed| listed.text.is_empty()) {
            self.notes.push(format!("parameter `{name}` lists the empty word as a value"));
        }
        if !again.is_empty() {
            self.notes.push(format!(
                "parameter `{name}` lists {} twice; both are read as one value",
                some_of(&again, MOST_LISTED)
            ));
        }
        self.declared.push(Declared::new(name.to_owned(), listed));
        Ok(())
    }

    /// Returns the value between two commas, or the values of the parameter to which the text between the commas
    /// refers.
    fn piece(&mut self, piece: &str, at: usize) -> Vec<Listed> {
        let mut text = piece.trim();
        if let Some(other) = text.strip_prefix('<').and_then(|text| text.strip_suffix('>')) {
            match self.declared.find(other.trim()) {
                Ok(known) => return self.declared[known].values.clone(),
                Err(_) => self.unknown.push((other.trim().to_owned(), at)),
            }
        }
        if let Some(value) = without_weight(text) {
            self.weighted.push(format!("`{text}`"));
            text = value;
        }
        let mut aliases = Vec::new();
        if let Some((first, others)) = text.split_once('|') {
            self.aliased.push(format!("`{text}`"));
            aliases = others.split('|').map(|alias| alias.trim().to_owned()).collect();
            text = first.trim();
        }
        let negative = text.starts_with('~');
        if negative {
            text = text[1..].trim();
        }
        vec![Listed { text: text.to_owned(), aliases, value: Value::parse(text), negative }]
    }

    /// Checks all references to other parameters, and returns all parameters and notes.
    ///
    /// # Errors
    /// A reference stands above the parameter that it names, or its name is similar to the name of a parameter.
    pub fn finish(mut self, text: &str) -> Result<(Declarations, Vec<String>), Fault> {
        for (name, at) in std::mem::take(&mut self.unknown) {
            match self.declared.find(&name) {
                Ok(_) => return fail(at, PictFlaw::BeforeItsParameter { name }),
                // PICT reads the text as a value, too. `<none>` may well be a value.
                Err(unknown @ PictFlaw::Unknown { nearest: None, .. }) => {
                    let Position { line, column } = Position::of(text, at);
                    let note = format!("line {line}, column {column}: {unknown}, so `<{name}>` is read as a value");
                    self.notes.push(note);
                }
                Err(flaw) => return fail(at, flaw),
            }
        }
        for (what, found) in [
            ("without `:` the name of a parameter ends at the first comma", &self.without_colon),
            ("tests are made with the first name of a value only", &self.aliased),
            ("weights are ignored", &self.weighted),
        ] {
            if !found.is_empty() {
                self.notes.push(format!("{what}: {}", some_of(found, MOST_LISTED)));
            }
        }
        Ok((self.declared, self.notes))
    }
}

/// Returns the value before a weight, which is a number of at least 1 in parentheses at the end. `None` if there is no
/// weight.
fn without_weight(text: &str) -> Option<&str> {
    let (value, weight) = text.strip_suffix(')')?.rsplit_once('(')?;
    let weight: f64 = weight.trim().parse().ok()?;
    (weight >= 1.0).then_some(value.trim_end())
}
