//! The reasons why a file of a standard cannot be used: each with its place in the file.

use super::expression::ExpressionFlaw;
use paracosm_engine::road::RoadError;
use paracosm_space::{SpaceError, did_you_mean, plural};
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// An error in a file of a standard, with its place.
#[derive(Debug, Error)]
#[error("{}{}: {flaw}", file.display(), line.map(|line| format!(":{line}")).unwrap_or_default())]
pub struct ReadError {
    /// The path of the file.
    pub file: PathBuf,
    /// The number of the line, from 1; `None` if the error concerns the whole file.
    pub line: Option<u32>,
    /// The error itself.
    #[source]
    pub flaw: Box<Flaw>,
}

/// A value that an action gives a variable or a parameter, and that is not of its type.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{name}` becomes {value}, expected {expected}")]
pub struct Misfit {
    /// The name of the variable or the parameter.
    pub name: String,
    /// The value.
    pub value: String,
    /// The values of the type, in words.
    pub expected: String,
}

/// The description of an error in a file of a standard. The names of elements and attributes are those of the file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Flaw {
    /// The file cannot be read.
    #[error("the file cannot be read: {0}")]
    Unreadable(#[source] io::Error),
    /// The file is larger than the limit.
    #[error("the file has {bytes} bytes, at most {limit} are allowed")]
    TooLarge {
        /// The size of the file in bytes.
        bytes: u64,
        /// The greatest allowed size in bytes.
        limit: u64,
    },
    /// The file begins like a text in UTF-16, and is none.
    #[error("it begins like a text in UTF-16, and is none; save the file in the encoding UTF-8")]
    NotUtf16,
    /// The file is not encoded in UTF-8.
    #[error("the byte at position {at} is not part of a UTF-8 text; save the file in the encoding UTF-8")]
    NotUtf8 {
        /// The position of the first wrong byte, from 0.
        at: usize,
    },
    /// The file has a document type declaration, whose entities could expand without limit.
    #[error(
        "the file declares a document type (`<!DOCTYPE`), whose entities could expand without limit; remove the declaration"
    )]
    DocumentType,
    /// The text is not well-formed XML.
    #[error("the file is not well-formed XML: {0}")]
    Malformed(#[source] Malformed),
    /// The outermost element has an unexpected name.
    #[error("the outermost element is <{found}>, expected <{expected}>")]
    Root {
        /// The name of the outermost element.
        found: String,
        /// The expected name.
        expected: &'static str,
    },
    /// An element is not part of the standard.
    #[error("<{parent}> has an element <{element}>, which the standard does not have{}", did_you_mean(nearest))]
    UnknownElement {
        /// The name of the unknown element.
        element: String,
        /// The name of the element that contains it.
        parent: String,
        /// The most similar name of an element that `parent` can contain; `None` if no name is similar.
        nearest: Option<&'static str>,
    },
    /// An element of the standard is not supported.
    #[error("<{element}> is not supported: {reason}")]
    Refused {
        /// The name of the element.
        element: String,
        /// The reason, and the nearest supported element if there is one.
        reason: &'static str,
    },
    /// An element occurs twice where the standard allows it once.
    #[error("<{parent}> has a second <{element}>, expected at most one")]
    Repeated {
        /// The name of the element.
        element: String,
        /// The name of the element that contains it.
        parent: String,
    },
    /// An element contains two elements where the standard wants one of several.
    #[error("<{parent}> has <{element}> beside <{first}>, expected only one of them")]
    Chosen {
        /// The name of the second element.
        element: String,
        /// The name of the element that contains both.
        parent: String,
        /// The name of the first element.
        first: String,
    },
    /// An element lacks a required attribute.
    #[error(
        "<{element}> has no attribute `{attribute}`, which the standard requires{}",
        similar.as_ref().map(|name| format!("; it has `{name}`, which the standard does not have")).unwrap_or_default()
    )]
    MissingAttribute {
        /// The name of the element.
        element: String,
        /// The name of the missing attribute.
        attribute: &'static str,
        /// The name of an attribute that the standard does not have, and that is similar to the missing one.
        similar: Option<String>,
    },
    /// An element contains a text where the standard wants elements only.
    #[error("<{element}> contains the text `{text}`, expected elements only")]
    Text {
        /// The name of the element.
        element: String,
        /// The beginning of the text.
        text: String,
    },
    /// An element has none or both of two attributes.
    #[error(
        "<{element}> has {} `{}` {} `{}`, expected one of them",
        if *both { "both" } else { "neither" }, attributes[0], if *both { "and" } else { "nor" }, attributes[1]
    )]
    OneAttribute {
        /// The name of the element.
        element: String,
        /// The names of the attributes.
        attributes: [&'static str; 2],
        /// `true` if the element has both attributes, `false` if it has none.
        both: bool,
    },
    /// An element lacks a required child.
    #[error("<{element}> contains no <{child}>, expected at least one")]
    MissingElement {
        /// The name of the element.
        element: String,
        /// The name of the missing child; several names with `or` between them if one of them is required.
        child: &'static str,
    },
    /// An element has fewer children of a kind than it needs.
    #[error("<{element}> has {}, expected at least {least}", plural(*found, child))]
    TooFew {
        /// The name of the element.
        element: String,
        /// The children, in a word.
        child: &'static str,
        /// The number of the children.
        found: usize,
        /// The least number of the children.
        least: usize,
    },
    /// An element has more children of a kind than are allowed.
    #[error("<{element}> has {}, expected at most {most}", plural(*found, child))]
    TooMany {
        /// The name of the element.
        element: String,
        /// The children, in a word.
        child: &'static str,
        /// The number of the children.
        found: usize,
        /// The greatest allowed number of the children.
        most: usize,
    },
    /// The value of an attribute is not allowed.
    #[error("`{attribute}=\"{found}\"` of <{element}> is not allowed, expected {expected}{}", did_you_mean(nearest))]
    Value {
        /// The name of the element.
        element: String,
        /// The name of the attribute.
        attribute: String,
        /// The value of the attribute.
        found: String,
        /// The allowed values, in words.
        expected: String,
        /// The most similar allowed value; `None` if no value is similar.
        nearest: Option<String>,
    },
    /// The value of an attribute has a parameter or an expression without a value.
    #[error("`{attribute}=\"{text}\"` of <{element}> has no value: {flaw}")]
    Expression {
        /// The name of the element.
        element: String,
        /// The name of the attribute.
        attribute: String,
        /// The text of the attribute.
        text: String,
        /// The reason.
        flaw: ExpressionFlaw,
    },
    /// A folder that an element names cannot be read.
    #[error("the folder {} of <Directory> cannot be read, expected a folder of catalogs: {error}", folder.display())]
    Folder {
        /// The path of the folder.
        folder: PathBuf,
        /// The error of the system.
        #[source]
        error: io::Error,
    },
    /// The values and the chances of a parameter do not fit.
    #[error("<{element}> gives the parameter values or chances that it cannot have: {flaw}")]
    Parameter {
        /// The name of the element.
        element: String,
        /// The reason why the values or the chances do not fit.
        #[source]
        flaw: SpaceError,
    },
    /// The roads of a map form no network.
    #[error("the map has no roads to drive on: {0}")]
    Roads(#[source] RoadError),
    /// A file with the values of a test differs from the scenario in something else than values.
    #[error(
        "found {found}, expected {expected} as in {}:{line}; the file of a test differs from its scenario only in the values of \
         the parameters that the scenario declares", scenario.display()
    )]
    Differs {
        /// The part of the file, in words.
        found: String,
        /// The part of the scenario, in words.
        expected: String,
        /// The path of the scenario.
        scenario: PathBuf,
        /// The line of the part in the scenario.
        line: u32,
    },
    /// A rule of arithmetic changes something that is no number.
    #[error("`{name}` is no number, so nothing can be added to it and it cannot be multiplied; use a SetAction")]
    NoNumber {
        /// The name of the variable or parameter.
        name: String,
    },
    /// An initial action gives a variable or a parameter a value that is not of its type.
    #[error(transparent)]
    Misfit(Misfit),
    /// Two elements have the same identifier.
    #[error("`{attribute}=\"{found}\"` of <{element}> is taken: the element in line {first} has the same value")]
    Taken {
        /// The name of the second element.
        element: String,
        /// The name of the attribute.
        attribute: &'static str,
        /// The value of the attribute.
        found: String,
        /// The line of the first element.
        first: u32,
    },
    /// Two files of a catalog have an entry with the same name.
    #[error("the catalog has a second <{element}> with the name `{name}`: the first one is in {}:{line}", file.display())]
    SecondEntry {
        /// The name of the element.
        element: String,
        /// The name of the entry.
        name: String,
        /// The path of the file with the first entry.
        file: PathBuf,
        /// The line of the first entry.
        line: u32,
    },
    /// An attribute names several elements.
    #[error(
        "`{attribute}=\"{found}\"` of <{element}> names more than one {kind}: write `{}` or `{}`",
        candidates[0], candidates[1]
    )]
    Ambiguous {
        /// The name of the element with the reference.
        element: String,
        /// The name of the attribute.
        attribute: &'static str,
        /// The value of the attribute.
        found: String,
        /// The kind of the elements, for example `event`.
        kind: &'static str,
        /// The full names of the first two elements.
        candidates: [String; 2],
    },
    /// An attribute names an element that does not exist.
    #[error("`{attribute}=\"{found}\"` of <{element}> names no {kind} of the file{}", did_you_mean(nearest))]
    Dangling {
        /// The name of the element with the reference.
        element: String,
        /// The name of the attribute.
        attribute: &'static str,
        /// The value of the attribute.
        found: String,
        /// The kind of the missing element, for example `road`.
        kind: &'static str,
        /// The most similar name of an element of this kind; `None` if no name is similar.
        nearest: Option<String>,
    },
}

/// The description of a place where a text is not well-formed XML.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct Malformed(pub(super) roxmltree::Error);
