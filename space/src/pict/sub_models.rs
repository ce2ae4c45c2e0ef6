//! Reads the lines that group parameters, which PICT calls sub-models.

use super::parameters::Declarations;
use super::{Fault, PictFlaw, fail, indent};
use crate::Position;
use std::collections::BTreeSet;

/// The positions of the parameters of a sub-model in ascending order, and its order if it has one.
type SubModel = (Vec<usize>, Option<usize>);

/// Reads a line like `{A, B, C} @ 3`. A sub-model with an unknown parameter is ignored, as in PICT: then the result is
/// `None`.
pub(super) fn sub_model(
    text: &str,
    line: &str,
    offset: usize,
    declared: &Declarations,
    notes: &mut Vec<String>,
) -> Result<Option<SubModel>, Fault> {
    let open = indent(line);
    let Some(close) = line.find('}') else {
        return fail(offset + line.len(), PictFlaw::OpenSubModel);
    };
    let mut set = BTreeSet::new();
    let mut at = open + 1;
    for piece in line[at..close].split(',') {
        let place = offset + at + indent(piece);
        let name = piece.trim();
        if name.is_empty() {
            return fail(place, PictFlaw::NamelessInSubModel);
        }
        let Position { line: number, column } = Position::of(text, place);
        let position = match declared.find(name) {
            Ok(position) => position,
            Err(unknown) => {
                notes.push(format!("line {number}, column {column}: {unknown}, so this sub-model is ignored"));
                return Ok(None);
            }
        };
        if !set.insert(position) {
            notes.push(format!(
                "line {number}, column {column}: the sub-model names `{name}` twice, which changes nothing"
            ));
        }
        at += piece.len() + 1;
    }
    let set: Vec<usize> = set.into_iter().collect();
    let tail = &line[close + 1..];
    let place = offset + close + 1 + indent(tail);
    let tail = tail.trim();
    let Some(order) = tail.strip_prefix('@') else {
        return if tail.is_empty() {
            Ok(Some((set, None)))
        } else {
            fail(place, PictFlaw::AfterSubModel { found: tail.to_owned() })
        };
    };
    let place = place + 1 + indent(order);
    let order = order.trim();
    match order.parse() {
        Ok(order) if (1..=set.len()).contains(&order) => Ok(Some((set, Some(order)))),
        _ => fail(place, PictFlaw::Order { found: order.to_owned(), most: set.len() }),
    }
}
