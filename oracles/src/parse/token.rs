//! Divides the text of a formula into words, numbers and symbols.

use super::ParseError;

/// A token of the text.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Word(String),
    /// A name in quotation marks. It is never a word of the language.
    Quoted(String),
    Symbol(&'static str),
    End,
}

impl std::fmt::Display for Token {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Token::Number(number) => write!(f, "`{number}`"),
            Token::Word(word) => write!(f, "`{word}`"),
            Token::Quoted(name) => write!(f, "the name {name:?}"),
            Token::Symbol(symbol) => write!(f, "`{symbol}`"),
            Token::End => f.write_str("the end"),
        }
    }
}

/// The symbols of the language. A symbol comes before the symbols that it begins with. The colon has no meaning; the
/// parser refuses it.
const SYMBOLS: [&str; 18] =
    ["->", "<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "(", ")", "[", "]", ",", "~", ":"];

/// Symbols of other languages, with the symbols of this language for them.
const FOREIGN: [(&str, &str); 16] = [
    ("&&", "and"),
    ("&", "and"),
    ("∧", "and"),
    ("||", "or"),
    ("|", "or"),
    ("∨", "or"),
    ("!", "not"),
    ("¬", "not"),
    ("=>", "->"),
    ("→", "->"),
    ("=", "=="),
    ("≤", "<="),
    ("≥", ">="),
    ("≠", "!="),
    ("□", "always"),
    ("◇", "eventually"),
];

/// Returns the tokens of the text with their columns. The last token is [`Token::End`].
pub(super) fn tokens(text: &str) -> Result<Vec<(usize, Token)>, ParseError> {
    let mut tokens = Vec::new();
    let mut rest = text;
    let mut column = 1;
    loop {
        let trimmed = rest.trim_start();
        column += rest[..rest.len() - trimmed.len()].chars().count();
        rest = trimmed;
        let Some(first) = rest.chars().next() else { break };
        let (token, length) = token(rest, first, column)?;
        tokens.push((column, token));
        column += rest[..length].chars().count();
        rest = &rest[length..];
    }
    tokens.push((column, Token::End));
    Ok(tokens)
}

/// Returns the token at the start of the text, and its length in bytes.
fn token(text: &str, first: char, column: usize) -> Result<(Token, usize), ParseError> {
    if first.is_ascii_digit() || first == '.' {
        return number(text, column);
    }
    if is_initial(first) {
        let length = text.find(|c| !is_inner(c)).unwrap_or(text.len());
        return Ok((Token::Word(text[..length].to_owned()), length));
    }
    if first == '"' || first == '\'' {
        return quoted(text, first, column);
    }
    // A symbol of this language wins: `==` and `!=` begin like the foreign `=` and `!`, but are longer.
    let foreign = FOREIGN.iter().find(|(foreign, _)| text.starts_with(foreign));
    let own = SYMBOLS.iter().find(|symbol| text.starts_with(**symbol));
    match (own, foreign) {
        (Some(symbol), _) => Ok((Token::Symbol(symbol), symbol.len())),
        (None, Some((foreign, ours))) => Err(ParseError {
            column,
            found: format!("`{foreign}`"),
            expected: format!("`{ours}`"),
            help: Some("formulas use this operator".to_owned()),
        }),
        (None, None) => Err(ParseError {
            column,
            found: format!("`{}`", first.escape_debug()),
            expected: "a formula".to_owned(),
            help: Some("write names with characters other than letters, digits, `_` and `.` in quotes".to_owned()),
        }),
    }
}

fn is_initial(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn is_inner(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.'
}

/// Returns `true` if the name is divided off from a text as one word.
pub(super) fn is_word(name: &str) -> bool {
    name.starts_with(is_initial) && name.chars().all(is_inner)
}

/// Reads a decimal number. The characters directly behind it belong to it, so that `3x` is an error and not two
/// tokens.
fn number(text: &str, column: usize) -> Result<(Token, usize), ParseError> {
    let mut length = text.find(|c| !is_inner(c)).unwrap_or(text.len());
    let signed = text[..length].ends_with(['e', 'E']) && text[length..].starts_with(['+', '-']);
    if signed && text[..length - 1].parse::<f64>().is_ok() {
        let exponent = &text[length + 1..];
        length += 1 + exponent.find(|c| !is_inner(c)).unwrap_or(exponent.len());
    }
    match text[..length].parse::<f64>() {
        Ok(number) if number.is_finite() => Ok((Token::Number(number), length)),
        _ => Err(ParseError {
            column,
            found: format!("`{}`", &text[..length]),
            expected: "a finite number".to_owned(),
            help: None,
        }),
    }
}

/// Reads a name in quotation marks. A backslash takes the next character literally.
fn quoted(text: &str, mark: char, column: usize) -> Result<(Token, usize), ParseError> {
    let mut name = String::new();
    let mut characters = text.char_indices().skip(1);
    while let Some((at, c)) = characters.next() {
        match c {
            '\\' => name.extend(characters.next().map(|(_, c)| c)),
            c if c == mark => return Ok((Token::Quoted(name), at + 1)),
            c => name.push(c),
        }
    }
    Err(ParseError {
        column,
        found: "a name without a closing quotation mark".to_owned(),
        expected: format!("a closing `{mark}`"),
        help: None,
    })
}
