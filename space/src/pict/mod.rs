//! Model files of PICT, the pairwise testing tool, read as spaces.
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
//! What is read, and as what:
//!
//! - A value that is written as a number becomes a number, any other one a word. A parameter of numbers only is compared
//!   with numbers, any other one with quoted words, as PICT has it. Levels are told apart by their texts: `1.1` and `1.10`
//!   are two levels, and keep their texts; as numbers they are equal to constraints.
//! - Names of parameters, words of the language and words in constraints are compared without regard to case; words keep
//!   the case in which they are declared. `<` and its kin order words by their lower-case letters.
//! - `IF .. THEN .. ELSE`, `AND`, `OR`, `NOT`, `IN {..}`, `LIKE` with `*` and `?`, `IsNegative(P)` and `IsPositive(P)`
//!   (without a name: some parameter, and all of them) become constraints of the space in the language of
//!   [`constraint`](crate::constraint), where words that differ in case are listed one by one.
//! - Negative values (`~`) lose their sign. Constraints see to it that no test has two of them, and which they are is part
//!   of the [`demand`](crate::demand): combinations of other values count only in tests that have none.
//! - `{A, B, C} @ 3` asks for all combinations of three of these parameters beside what is asked of all. PICT also
//!   keeps the number of different rows of a sub-model small; this is not done.
//! - `<P>` stands for the values of a parameter above. Where no parameter is called so or nearly so, it is a value, and a
//!   note says so. Where a line has no colon, the name ends at the first comma, as in old models.
//!
//! Aliases other than the first and weights, which say nothing of what has to be covered, are passed over; a note says
//! so. Refused are result parameters (`$`), a parameter's own order (`P @ 2: ..`), a
//! parameter of negative values only, and what is unknown. The separators of values and of aliases and the negative sign are those that PICT
//! takes unless told otherwise.

mod flaw;
mod parameters;
mod statements;
mod terms;
mod tokens;

use crate::constraint::Expression;
use crate::demand::Demand;
use crate::{Domain, Parameter, Position, Space, SpaceError};
use parameters::{Declared, Parameters, sub_model};
use statements::Statement;
use std::ops::Range;

pub use flaw::{PictError, PictFlaw, Section};

/// What a model file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The parameters, all of them discrete, and the constraints.
    pub space: Space,
    /// The sub-models, as groups, and the negative values.
    pub demand: Demand,
    /// The line, from 1, at which a statement of the file begins, and the statement in one line: one for each of the
    /// space's constraints but the last ones, which are about negative values.
    pub statements: Vec<(usize, String)>,
    /// What was read otherwise than its author may expect, for people.
    pub notes: Vec<String>,
}

/// A flaw, and the byte of the text where it stands.
struct Fault {
    offset: usize,
    flaw: PictFlaw,
}

fn fail<T>(offset: usize, flaw: PictFlaw) -> Result<T, Fault> {
    Err(Fault { offset, flaw })
}

impl Model {
    /// Reads a model file.
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
    /// The text is no model, or one that holds what is refused: the error says where.
    pub fn from_pict(text: &str) -> Result<Self, PictError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        read(text).map_err(|Fault { offset, flaw }| {
            let Position { line, column } = Position::of(text, offset);
            PictError { line, column, flaw: Box::new(flaw) }
        })
    }
}

/// What a line of a model is.
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
                let (set, order) = sub_model(line.trim_end(), offset, &parameters.declared)?;
                match order {
                    Some(order) => groups.push((set, order)),
                    None => parameters.notes.push(format!(
                        "line {}: a sub-model without an order is covered as all parameters are",
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
    Ok(Model { space, statements: statements.collect(), demand, notes })
}

/// What a line is, by how it begins. A colon before the first bracket makes it a parameter, whatever it begins with.
fn kind(line: &str) -> Line {
    let line = line.trim();
    let begins = |word: &str| {
        let head = line.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word));
        head && !line[word.len()..].starts_with(|sign: char| sign.is_alphanumeric() || sign == '_')
    };
    let plain = &line[..line.find('[').unwrap_or(line.len())];
    match line.chars().next() {
        None | Some('#') => Line::Nothing,
        Some('{') => Line::SubModel,
        Some('[') => Line::Statement,
        Some('(') if !plain.contains(':') => Line::Statement,
        Some(_) if !plain.contains(':') && statements::OPENING.into_iter().any(begins) => Line::Statement,
        Some(_) => Line::Parameter,
    }
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn parameter(declared: &Declared) -> Parameter {
    let levels = declared.values.iter().map(|listed| listed.value.clone()).collect();
    Parameter::new(declared.name.clone(), Domain::Choice(levels))
}

/// The negative values, as positions of parameters and levels.
fn negatives(declared: &[Declared]) -> Vec<(usize, usize)> {
    let of = |(position, parameter): (usize, &Declared)| {
        let levels = parameter.values.iter().enumerate().filter(|(_, listed)| listed.negative);
        levels.map(|(level, _)| (position, level)).collect::<Vec<_>>()
    };
    declared.iter().enumerate().flat_map(of).collect()
}

/// That no test has two negative values, said of each parameter and those after it.
fn one_negative(declared: &[Declared]) -> Vec<Expression> {
    let negatives: Vec<&Declared> = declared.iter().filter(|parameter| parameter.has_negatives()).collect();
    let others = |i: usize| {
        let mut parts: Vec<_> = negatives[i + 1..].iter().map(|other| terms::of_sign(other, false)).collect();
        if parts.len() == 1 { parts.remove(0) } else { Expression::And(parts) }
    };
    let last = negatives.len().saturating_sub(1);
    (0..last).map(|i| Expression::Implies(Box::new(terms::of_sign(negatives[i], true)), Box::new(others(i)))).collect()
}
