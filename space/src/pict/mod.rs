//! Reads model files of PICT, the pairwise testing tool, as spaces.
//!
//! A model has parameters, then sub-models, then constraints:
//!
//! ```
//! let model = paracosm_space::pict::Model::from_pict(r#"
//!     ## Lines that begin with # are comments.
//!     Surface: dry, wet, ice
//!     Tyres:   summer, winter
//!     Speed:   ~-1, 30, 50, 120
//!     Limit:   <Speed>, 200
//!
//!     { Surface, Tyres, Speed } @ 3
//!
//!     IF [Surface] = "Ice" AND [Tyres] <> "winter" THEN [Speed] <= 30 ELSE [Surface] LIKE "*";
//!     [Speed] <= [Limit];
//! "#)?;
//! assert_eq!(model.space.levels(), [3, 2, 4, 5]);
//! assert_eq!(model.demand.groups, [(vec![0, 1, 2], 3)]);
//! assert_eq!(model.demand.negatives, [(2, 0), (3, 0)]);
//! // The third one is about the negative values.
//! assert_eq!(model.space.constraints().len(), 3);
//! assert_eq!(model.space.constraints()[2].text(), "Speed == -1 implies Limit != -1");
//! # Ok::<(), paracosm_space::pict::PictError>(())
//! ```
//!
//! PARACOSM reads the parts of a model as follows:
//!
//! - A value that is written as a number becomes a number, any other value becomes a word. A parameter whose values
//!   are all numbers is compared with numbers, any other parameter with quoted words, as in PICT. Levels differ if
//!   their texts differ: `1.1` and `1.10` are two levels and keep their texts. To constraints they are the same
//!   number.
//! - Constraints ignore the case of parameter names, words of the language and values. A word keeps the case in which
//!   it is declared. `<`, `<=`, `>` and `>=` order words by their upper-case letters. A constraint or a
//!   sub-model that names an unknown parameter is ignored, and a note says so.
//! - `IF .. THEN .. ELSE`, `AND`, `OR`, `NOT`, `IN {..}`, `LIKE` with `*` and `?`, `IsNegative(P)` and `IsPositive(P)`
//!   become constraints in the language of [`constraint`](crate::constraint). Words that differ only in case are
//!   listed one by one. Without a name, `IsNegative()` means some parameter and `IsPositive()` means all parameters.
//! - Negative values (`~`) lose their sign. Constraints ensure that no test has two negative values. The
//!   [`demand`](crate::demand) lists the negative values: combinations of other values count only in tests without
//!   negative values.
//! - `{A, B, C} @ 3` asks for all combinations of any three of these parameters, beside the demand on all parameters.
//!   All parameters together keep the strength k. In PICT each row of a sub-model counts as one value: `@ 1` asks for
//!   less than all pairs, each row of a sub-model meets each value outside of it, and the number of different rows of a
//!   sub-model stays small. PARACOSM does none of these three.
//! - `<P>` stands for the values of a parameter above. If no parameter has this name or a similar one, `<P>` is a
//!   value, and a note says so. If a line has no colon, the name ends at the first comma, as in old models.
//!
//! Weights and aliases do not change the combinations that tests have to cover. Notes name both. PARACOSM ignores
//! weights. It makes tests with the first name of a value; [`Aliases`] holds the other names, which tests of PICT may
//! contain. These parts are refused: result parameters (`$`), a parameter's own order (`P @ 2: ..`), a
//! parameter with negative values only, and everything unknown. The separators of values and of aliases and the
//! negative sign are those that PICT uses by default.

mod aliases;
mod flaw;
mod parameters;
mod statements;
mod sub_models;
mod terms;
mod tokens;

use crate::constraint::Expression;
use crate::demand::Demand;
use crate::{Domain, Parameter, Position, Space, SpaceError};
use parameters::{Declared, Parameters};
use statements::Statement;
use std::ops::Range;
use sub_models::sub_model;

pub use aliases::Aliases;
pub use flaw::{PictError, PictFlaw, Section};

/// The most values of all parameters of a model together. Values of parameters that other parameters refer to count
/// each time.
const MOST_VALUES: usize = 1_000_000;

/// The words that begin a constraint. As in PICT, only `IF` begins the first constraint of a model.
const OPENING: [&str; 4] = ["IF", "NOT", "IsNegative", "IsPositive"];

/// The content of a model file of PICT.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The space of the model's parameters, which are all discrete, with the model's constraints.
    pub space: Space,
    /// The combinations that tests have to cover because of the sub-models and the negative values. The groups are the
    /// sub-models.
    pub demand: Demand,
    /// The constraints of the model file, each with the number of its first line, from 1, and its text in one line. The
    /// first constraints of the space come from these constraints, in the same order. The other constraints are about
    /// negative values.
    pub statements: Vec<(usize, String)>,
    /// The aliases of values, which tests of PICT may contain.
    pub aliases: Aliases,
    /// Notes for people about parts of the file whose meaning may differ from the author's expectation.
    pub notes: Vec<String>,
}

/// A flaw, and its place in the text as an offset in bytes.
struct Fault {
    offset: usize,
    flaw: PictFlaw,
}

fn fail<T>(offset: usize, flaw: PictFlaw) -> Result<T, Fault> {
    Err(Fault { offset, flaw })
}

impl Model {
    /// Reads the text of a model file of PICT.
    ///
    /// ```
    /// use paracosm_space::pict::Model;
    /// let model = Model::from_pict("
    ///     Weather: clear, rain, fog
    ///     Lanes:   2, 4, 6
    ///     IF [Lanes] = 2 THEN [Weather] <> \"Fog\";
    /// ")?;
    /// assert_eq!(model.space.levels(), [3, 3]);
    /// assert_eq!(model.space.constraints()[0].text(), "Lanes == 2 implies Weather != 'fog'");
    /// # Ok::<(), paracosm_space::pict::PictError>(())
    /// ```
    ///
    /// # Errors
    /// The text is not a model, or has a part that is refused. The error says where.
    pub fn from_pict(text: &str) -> Result<Self, PictError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        read(text).map_err(|Fault { offset, flaw }| {
            let Position { line, column } = Position::of(text, offset);
            PictError { line, column, flaw: Box::new(flaw) }
        })
    }
}

/// The kinds of lines of a model.
#[derive(PartialEq)]
enum Line {
    Nothing,
    Parameter,
    SubModel,
    Statement,
}

fn read(text: &str) -> Result<Model, Fault> {
    let mut parameters = Parameters::default();
    let mut groups = Vec::new();
    let mut sub_models = false;
    let mut statements = text.len();
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        match kind(line) {
            Line::Nothing => {}
            Line::Parameter if sub_models => {
                let flaw = PictFlaw::Misplaced { found: Section::Parameter, after: Section::SubModel };
                return fail(offset + indent(line), flaw);
            }
            Line::Parameter => parameters.read(line.trim_end(), offset)?,
            Line::SubModel => {
                sub_models = true;
                let found = sub_model(text, line.trim_end(), offset, &parameters.declared, &mut parameters.notes)?;
                match found {
                    None => {}
                    Some((set, Some(order))) => groups.push((set, order)),
                    Some((_, None)) => parameters.notes.push(format!(
                        "line {}: the sub-model has no order, so it asks for no further combinations",
                        Position::of(text, offset).line
                    )),
                }
            }
            Line::Statement => {
                statements = offset;
                break;
            }
        }
        offset += line.len();
    }
    if parameters.declared.is_empty() {
        return fail(statements, PictFlaw::NoParameters);
    }
    let (declared, mut notes) = parameters.finish(text)?;
    let read = statements::read(text, statements, &declared, &mut notes)?;
    let signs = one_negative(&declared);
    let texts = read.iter().map(|statement| &statement.expression).chain(&signs).map(Expression::to_string);
    let texts: Vec<String> = texts.collect();
    let space = declared.iter().map(parameter).collect();
    let space = Space::new(space).and_then(|space| space.with_constraints(texts));
    let space = space.or_else(|error| match error {
        SpaceError::Constraint { index, error, .. } => {
            fail(read.get(index).map_or(0, |statement| statement.span.start), PictFlaw::Constraint(error))
        }
        error => fail(0, PictFlaw::Space(error)),
    })?;
    let in_a_line = |span: Range<usize>| text[span].split_whitespace().collect::<Vec<_>>().join(" ");
    let statements =
        read.into_iter().map(|Statement { span, .. }| (Position::of(text, span.start).line, in_a_line(span)));
    let demand = Demand { groups, negatives: negatives(&declared) };
    Ok(Model { space, statements: statements.collect(), demand, aliases: Aliases::of(&declared), notes })
}

/// Finds the kind of a line by its beginning. A colon before the first bracket makes the line a parameter, unless the
/// line begins with `#`, `{` or `[`.
fn kind(line: &str) -> Line {
    let line = line.trim();
    let plain = &line[..line.find('[').unwrap_or(line.len())];
    match line.chars().next() {
        None | Some('#') => Line::Nothing,
        Some('{') => Line::SubModel,
        Some('[') => Line::Statement,
        Some('(') if !plain.contains(':') && line.contains('[') => Line::Statement,
        Some(_) if !plain.contains(':') && begins_with(line, "IF") => Line::Statement,
        Some(_) => Line::Parameter,
    }
}

/// Returns `true` if a line begins with the word, in upper or lower case.
fn begins_with(line: &str, word: &str) -> bool {
    let line = line.trim_start();
    let head = line.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word));
    head && !line[word.len()..].starts_with(|sign: char| sign.is_alphanumeric() || sign == '_')
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn parameter(declared: &Declared) -> Parameter {
    let levels = declared.values.iter().map(|listed| listed.value.clone()).collect();
    Parameter::new(declared.name.clone(), Domain::Choice(levels))
}

/// Returns the negative values as positions of parameters and levels.
fn negatives(declared: &[Declared]) -> Vec<(usize, usize)> {
    let of = |(position, parameter): (usize, &Declared)| {
        let levels = parameter.values.iter().enumerate().filter(|(_, listed)| listed.negative);
        levels.map(|(level, _)| (position, level)).collect::<Vec<_>>()
    };
    declared.iter().enumerate().flat_map(of).collect()
}

/// Returns expressions that exclude tests with two negative values, each for a parameter and the parameters after it.
fn one_negative(declared: &[Declared]) -> Vec<Expression> {
    let negatives: Vec<&Declared> = declared.iter().filter(|parameter| parameter.has_negatives()).collect();
    let others = |i: usize| {
        let mut parts: Vec<_> = negatives[i + 1..].iter().map(|other| terms::of_sign(other, false)).collect();
        if parts.len() == 1 { parts.remove(0) } else { Expression::And(parts) }
    };
    let last = negatives.len().saturating_sub(1);
    (0..last).map(|i| Expression::Implies(Box::new(terms::of_sign(negatives[i], true)), Box::new(others(i)))).collect()
}
