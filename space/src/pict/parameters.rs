//! Reads the lines that declare parameters, and the lines that group parameters.

use super::{Fault, PictFlaw, fail, indent};
use crate::constraint::Relation;
use crate::names::nearest;
use crate::{Position, Value};

/// A parameter of a model.
pub(super) struct Declared {
    pub name: String,
    pub values: Vec<Listed>,
}

/// A value of a parameter.
#[derive(Clone)]
pub(super) struct Listed {
    /// The text of the value, without its sign, aliases and weight.
    pub text: String,
    pub value: Value,
    pub negative: bool,
}

impl Listed {
    /// Returns `true` if this value of a parameter is the same as `value` in a constraint, ignoring the case of words.
    pub fn is(&self, value: &Value) -> bool {
        self.related(Relation::Equal, value)
    }

    /// Returns `true` if the relation holds between this value of a parameter and `value` in a constraint. Words are
    /// compared in lower case.
    pub fn related(&self, relation: Relation, value: &Value) -> bool {
        match value.word() {
            Some(word) => relation.holds(&self.text.to_lowercase(), &word.to_lowercase()),
            None => self.value.number().zip(value.number()).is_some_and(|(own, number)| relation.holds(&own, &number)),
        }
    }
}

impl Declared {
    /// Returns `true` if all values of the parameter are numbers. Constraints then compare the parameter with numbers.
    pub fn numeric(&self) -> bool {
        self.values.iter().all(|listed| listed.value.number().is_some())
    }

    /// Turns the texts into values, after all texts are known. If all of them are numbers, each value is a number that
    /// keeps its text, so that constraints see numbers. Otherwise constraints see texts, and a number that is written
    /// in an unusual way becomes a word.
    fn settle(&mut self) {
        let numeric = self.numeric();
        for listed in &mut self.values {
            listed.value = match Value::written(&listed.text) {
                Value::Written(..) if !numeric => Value::Word(listed.text.clone()),
                value => value,
            };
        }
    }

    pub fn has_negatives(&self) -> bool {
        self.values.iter().any(|listed| listed.negative)
    }
}

/// Finds the parameter of this name, ignoring case.
///
/// # Errors
/// No parameter has the name: [`PictFlaw::Unknown`] suggests the nearest name.
pub(super) fn find(declared: &[Declared], name: &str) -> Result<usize, PictFlaw> {
    let lower = name.to_lowercase();
    declared.iter().position(|parameter| parameter.name.to_lowercase() == lower).ok_or_else(|| {
        let nearest = nearest(name, declared.iter().map(|parameter| parameter.name.as_str()));
        PictFlaw::Unknown { name: name.to_owned(), nearest: nearest.map(str::to_owned) }
    })
}

/// The parameters read so far.
#[derive(Default)]
pub(super) struct Parameters {
    pub declared: Vec<Declared>,
    pub notes: Vec<String>,
    without_colon: Vec<String>,
    weighted: Vec<String>,
    aliased: Vec<String>,
    /// Names in `<` and `>` that no parameter above has, with their places.
    unknown: Vec<(String, usize)>,
}

impl Parameters {
    /// Reads the line of a parameter, which begins at `offset` in the file. `line` has no line end.
    pub fn read(&mut self, line: &str, offset: usize) -> Result<(), Fault> {
        let comma = line.split_once(',').filter(|(name, _)| !name.contains(['[', '{']));
        let Some((head, list)) = line.split_once(':').or(comma) else {
            return fail(offset + line.len(), PictFlaw::NoColon { bracket: line.contains('[') });
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
        if let Ok(known) = find(&self.declared, name) {
            return fail(at, PictFlaw::Twice { name: self.declared[known].name.clone() });
        }
        if list.trim().is_empty() {
            return fail(offset + line.len(), PictFlaw::NoValues { name: name.to_owned() });
        }
        let mut declared = Declared { name: name.to_owned(), values: Vec::new() };
        let mut at = offset + head.len() + 1;
        for piece in list.split(',') {
            let place = at + indent(piece);
            for listed in self.piece(piece, place) {
                self.add(&mut declared, listed, place)?;
            }
            at += piece.len() + 1;
        }
        if declared.values.iter().all(|listed| listed.negative) {
            let flaw = PictFlaw::OnlyNegative { name: name.to_owned() };
            return fail(offset + head.len() + 1 + indent(list), flaw);
        }
        declared.settle();
        self.declared.push(declared);
        Ok(())
    }

    /// Returns the value between two commas, or the values of the parameter to which the text between the commas
    /// refers.
    fn piece(&mut self, piece: &str, at: usize) -> Vec<Listed> {
        let mut text = piece.trim();
        if let Some(other) = text.strip_prefix('<').and_then(|text| text.strip_suffix('>')) {
            match find(&self.declared, other.trim()) {
                Ok(known) => return self.declared[known].values.clone(),
                Err(_) => self.unknown.push((other.trim().to_owned(), at)),
            }
        }
        if let Some(value) = without_weight(text) {
            self.weighted.push(format!("`{text}`"));
            text = value;
        }
        if let Some((first, _)) = text.split_once('|') {
            self.aliased.push(format!("`{text}`"));
            text = first.trim();
        }
        let negative = text.starts_with('~');
        if negative {
            text = text[1..].trim();
        }
        vec![Listed { text: text.to_owned(), value: Value::parse(text), negative }]
    }

    fn add(&mut self, declared: &mut Declared, listed: Listed, at: usize) -> Result<(), Fault> {
        let (name, text) = (&declared.name, &listed.text);
        let same = |known: &&Listed| known.value.means(&listed.value);
        if declared.values.iter().filter(same).any(|known| known.negative != listed.negative) {
            return fail(at, PictFlaw::BothSigns { value: text.clone() });
        }
        if !declared.values.iter().any(|known| known.text == *text) {
            if listed.text.is_empty() {
                self.notes.push(format!("parameter `{}` lists the empty word as a value", declared.name));
            }
            declared.values.push(listed);
            return Ok(());
        }
        self.notes.push(format!("parameter `{name}` lists `{text}` twice; both are read as one value"));
        Ok(())
    }

    /// Checks all references to other parameters, and returns all parameters and notes.
    ///
    /// # Errors
    /// A reference stands above the parameter that it names, or its name is similar to the name of a parameter.
    pub fn finish(mut self, text: &str) -> Result<(Vec<Declared>, Vec<String>), Fault> {
        for (name, at) in std::mem::take(&mut self.unknown) {
            match find(&self.declared, &name) {
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
            ("only the first alias of a value is used", &self.aliased),
            ("weights are ignored", &self.weighted),
        ] {
            if !found.is_empty() {
                self.notes.push(format!("{what}: {}", found.join(", ")));
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

/// Reads a line like `{A, B, C} @ 3`. Returns the positions of the parameters in ascending order, and the order if
/// there is one.
pub(super) fn sub_model(
    line: &str,
    offset: usize,
    declared: &[Declared],
) -> Result<(Vec<usize>, Option<usize>), Fault> {
    let open = indent(line);
    let Some(close) = line.find('}') else {
        return fail(offset + line.len(), PictFlaw::OpenSubModel);
    };
    let mut set = Vec::new();
    let mut at = open + 1;
    for piece in line[at..close].split(',') {
        let place = offset + at + indent(piece);
        let name = piece.trim();
        if name.is_empty() {
            return fail(place, PictFlaw::NamelessInSubModel);
        }
        let position = find(declared, name).or_else(|flaw| fail(place, flaw))?;
        if set.contains(&position) {
            return fail(place, PictFlaw::TwiceInSubModel { name: name.to_owned() });
        }
        set.push(position);
        at += piece.len() + 1;
    }
    set.sort_unstable();
    let tail = &line[close + 1..];
    let place = offset + close + 1 + indent(tail);
    let tail = tail.trim();
    let Some(order) = tail.strip_prefix('@') else {
        return if tail.is_empty() {
            Ok((set, None))
        } else {
            fail(place, PictFlaw::AfterSubModel { found: tail.to_owned() })
        };
    };
    let place = place + 1 + indent(order);
    let order = order.trim();
    match order.parse() {
        Ok(order) if (1..=set.len()).contains(&order) => Ok((set, Some(order))),
        _ => fail(place, PictFlaw::Order { found: order.to_owned(), most: set.len() }),
    }
}
