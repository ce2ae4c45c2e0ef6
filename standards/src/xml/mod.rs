//! Reading of XML files: elements with their places, values with their limits, and a check of every element against the
//! table of a standard, so that nothing is ignored silently.

mod document;
mod edits;
mod element;
mod encoding;
mod error;
mod expression;
mod number;
mod row;
mod schema;
mod source;
mod writer;

pub(crate) use document::Document;
pub(crate) use edits::Edits;
pub(crate) use element::{Element, TRUTHS, brief};
pub use error::{Flaw, Malformed, Misfit, ReadError};
pub use expression::ExpressionFlaw;
pub(crate) use expression::{Expression, MOST_OPERATORS, Value};
pub(crate) use number::{rounded, short};
pub(crate) use row::{Form, Row, no_effect, read, refused};
pub use row::{Support, Supported};
pub use schema::NoEffect;
pub(crate) use schema::{Choice, Counts, Schema, note};
pub(crate) use writer::{Attributes, Writer, escaped};
