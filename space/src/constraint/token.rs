//! Divides the text of a constraint into tokens, each with its place.

use super::expression::Relation;
use super::written::{KEYWORDS, Name, Written, begins_name, continues_name};
use super::{ConstraintError, ConstraintFlaw, Function};
use crate::Value;
use std::fmt;

/// A token of the language.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Name(String),
    Value(Value),
    Relation(Relation),
    /// An operator between two numbers. The minus of one number is the operator of the difference.
    Operator(Function),
    /// A reserved word of the language, as listed in [`KEYWORDS`].
    Keyword(&'static str),
    Open,
    Close,
    ListOpen,
    ListClose,
    Comma,
    End,
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Token::Name(name) => write!(f, "`{}`", Name(name)),
            Token::Value(value) => write!(f, "`{}`", Written(value)),
            Token::Relation(relation) => write!(f, "`{relation}`"),
            Token::Operator(function) => write!(f, "`{}`", function.sign().unwrap_or_default()),
            Token::Keyword(word) => write!(f, "`{word}`"),
            Token::Open => f.write_str("`(`"),
            Token::Close => f.write_str("`)`"),
            Token::ListOpen => f.write_str("`[`"),
            Token::ListClose => f.write_str("`]`"),
            Token::Comma => f.write_str("`,`"),
            Token::End => f.write_str("the end of the constraint"),
        }
    }
}

/// Signs of other languages, with the signs of this language for them. Longer signs come first.
const FOREIGN: [(&str, &str); 23] = [
    ("<=>", "`==` or `implies`"),
    ("**", "`pow(a, b)`"),
    ("^", "`pow(a, b)`"),
    ("\u{2212}", "`-`"),
    ("\u{d7}", "`*`"),
    ("\u{b7}", "`*`"),
    ("\u{f7}", "`/`"),
    ("\u{2264}", "`<=`"),
    ("\u{2265}", "`>=`"),
    ("\u{2260}", "`!=`"),
    ("&&", "`and`"),
    ("||", "`or`"),
    ("=>", "`>=` or `implies`"),
    ("->", "`implies`"),
    ("=<", "`<=`"),
    ("<>", "`!=`"),
    ("&", "`and`"),
    ("|", "`or`"),
    ("!", "`not` or `!=`"),
    ("~", "`not` or `!=`"),
    ("=", "`==`"),
    ("{", "`(`, or `[` around a list"),
    ("}", "`)`, or `]` after a list"),
];

/// The signs of this language. Longer signs come first.
const SIGNS: [(&str, Token); 16] = [
    ("==", Token::Relation(Relation::Equal)),
    ("!=", Token::Relation(Relation::NotEqual)),
    ("<=", Token::Relation(Relation::LessOrEqual)),
    (">=", Token::Relation(Relation::GreaterOrEqual)),
    ("<", Token::Relation(Relation::Less)),
    (">", Token::Relation(Relation::Greater)),
    ("(", Token::Open),
    (")", Token::Close),
    ("[", Token::ListOpen),
    ("]", Token::ListClose),
    (",", Token::Comma),
    ("+", Token::Operator(Function::Add)),
    ("-", Token::Operator(Function::Subtract)),
    ("*", Token::Operator(Function::Multiply)),
    ("/", Token::Operator(Function::Divide)),
    ("%", Token::Operator(Function::Remainder)),
];

/// Returns the tokens of the text with their offsets in bytes. The last token is [`Token::End`].
pub(super) fn tokens(text: &str) -> Result<Vec<(Token, usize)>, ConstraintError> {
    let mut found: Vec<(Token, usize)> = Vec::new();
    let mut offset = 0;
    loop {
        let rest = text[offset..].trim_start();
        offset = text.len() - rest.len();
        if rest.is_empty() {
            found.push((Token::End, text.trim_end().len()));
            return Ok(found);
        }
        let listed = matches!(found.last(), Some((Token::Keyword("in"), _)));
        // After a number, a sign is an operator; elsewhere it belongs to the number that begins there.
        let is_operand = |token: &Token| matches!(token, Token::Name(_) | Token::Value(_) | Token::Close);
        let follows = found.last().is_some_and(|(token, _)| is_operand(token));
        let (token, length) = token(rest, listed, follows).map_err(|flaw| ConstraintError::at(offset, flaw))?;
        found.push((token, offset));
        offset += length;
    }
}

/// Returns the token at the start of the text and its length. The text is not empty. A bracket begins a list if a list
/// may stand at this place (`listed`), and otherwise a name. A sign is an operator if it follows a number (`follows`).
fn token(rest: &str, listed: bool, follows: bool) -> Result<(Token, usize), ConstraintFlaw> {
    if rest.starts_with(begins_name) {
        let name = run(rest, continues_name);
        let keyword = KEYWORDS.into_iter().find(|keyword| *keyword == name);
        return Ok((keyword.map_or_else(|| Token::Name(name.to_owned()), Token::Keyword), name.len()));
    }
    if begins_number(rest) && !(follows && rest.starts_with(['-', '+'])) {
        return match number(rest) {
            (written, Some(number)) => Ok((Token::Value(Value::Number(number)), written.len())),
            (written, None) => Err(ConstraintFlaw::NoNumber { written: written.to_owned() }),
        };
    }
    if let Some(quote) = ['\'', '"'].into_iter().find(|quote| rest.starts_with(*quote)) {
        let word = enclosed(rest, quote).map(|(word, length)| (Token::Value(Value::Word(word)), length));
        return word.ok_or(ConstraintFlaw::OpenWord { quote });
    }
    if rest.starts_with('[') && !listed {
        let name = enclosed(rest, ']').map(|(name, length)| (Token::Name(name), length));
        return name.ok_or(ConstraintFlaw::OpenName);
    }
    let native = SIGNS.into_iter().find(|(native, _)| rest.starts_with(native));
    let foreign = FOREIGN.into_iter().find(|(foreign, _)| rest.starts_with(foreign));
    let known = native.as_ref().map_or(0, |(native, _)| native.len());
    match (native, foreign) {
        (_, Some((sign, meant))) if sign.len() > known => Err(ConstraintFlaw::Foreign { sign, meant }),
        (Some((sign, token)), _) => Ok((token, sign.len())),
        _ => Err(ConstraintFlaw::UnknownSign { sign: rest.chars().next().expect("the text is not empty") }),
    }
}

/// Returns the characters at the start of the text for which `belongs` is true.
fn run(text: &str, belongs: impl Fn(char) -> bool) -> &str {
    &text[..text.find(|sign| !belongs(sign)).unwrap_or(text.len())]
}

/// Returns `true` if the text begins like a number, even if the number is not valid.
fn begins_number(text: &str) -> bool {
    let unsigned = text.strip_prefix(['-', '+']).unwrap_or(text);
    let digits = unsigned.strip_prefix('.').unwrap_or(unsigned);
    digits.starts_with(|sign: char| sign.is_ascii_digit())
}

/// Returns the text of the number at the start, and its value if it is a finite number.
fn number(text: &str) -> (&str, Option<f64>) {
    let signed = usize::from(text.starts_with(['-', '+']));
    let mut length = signed + run(&text[signed..], continues_name).len();
    if text[..length].ends_with(['e', 'E']) && text[length..].starts_with(['-', '+']) {
        length += 1 + run(&text[length + 1..], continues_name).len();
    }
    let written = &text[..length];
    (written, written.parse().ok().filter(|number: &f64| number.is_finite()))
}

/// Returns the text between the first character and the next `close`, and the length including both. A backslash takes
/// the next character literally.
pub(crate) fn enclosed(text: &str, close: char) -> Option<(String, usize)> {
    let mut inside = String::new();
    let mut signs = text.char_indices().skip(1);
    while let Some((at, sign)) = signs.next() {
        match sign {
            '\\' => inside.push(signs.next()?.1),
            sign if sign == close => return Some((inside, at + close.len_utf8())),
            sign => inside.push(sign),
        }
    }
    None
}
