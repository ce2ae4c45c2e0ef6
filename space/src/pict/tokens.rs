//! Divides the constraints of a model into tokens.

use super::PictFlaw;
use crate::constraint::enclosed;
use std::fmt;

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    /// A word of letters, such as `IF`.
    Word(String),
    /// A name in brackets.
    Name(String),
    /// A word in quotes.
    Text(String),
    Number(f64),
    Sign(&'static str),
    /// A text that is not a token, and the reason. The reader reports the reason only when it comes to this text, after
    /// the errors before this text.
    Broken(PictFlaw),
    End,
}

impl Token {
    /// Returns `true` if the token is this word of the language, in upper or lower case.
    pub fn is(&self, word: &str) -> bool {
        matches!(self, Token::Word(found) if found.eq_ignore_ascii_case(word))
    }
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Token::Word(word) => write!(f, "`{word}`"),
            Token::Name(name) => write!(f, "`[{name}]`"),
            Token::Text(text) => write!(f, "`\"{text}\"`"),
            Token::Number(number) => write!(f, "`{number}`"),
            Token::Sign(sign) => write!(f, "`{sign}`"),
            Token::Broken(flaw) => flaw.fmt(f),
            Token::End => f.write_str("the end of the model"),
        }
    }
}

/// The signs of the language. Longer signs come first.
const SIGNS: [&str; 12] = ["<>", "<=", ">=", "=", "<", ">", "(", ")", "{", "}", ",", ";"];

/// Signs of other languages, with the signs of this language that replace the other signs.
const FOREIGN: [(&str, &str); 6] =
    [("==", "`=`"), ("!=", "`<>`"), ("&&", "`AND`"), ("||", "`OR`"), ("'", "`\"`"), ("!", "`NOT`")];

/// Returns the tokens of the text from `start` on with their offsets, up to the first broken token. The last token is
/// [`Token::End`]. Lines that begin with `#` are ignored.
pub(super) fn tokens(text: &str, start: usize) -> Vec<(Token, usize)> {
    let mut found = Vec::new();
    let mut offset = start;
    loop {
        let rest = text[offset..].trim_start();
        offset = text.len() - rest.len();
        let line = text[..offset].rfind('\n').map_or(0, |end| end + 1);
        if rest.starts_with('#') && text[line..offset].trim().is_empty() {
            offset += rest.find('\n').unwrap_or(rest.len());
            continue;
        }
        let (token, length) = token(rest);
        let last = matches!(token, Token::Broken(_) | Token::End);
        if last {
            let end = text.trim_end().len().max(start);
            found.extend([(token, offset.min(end)), (Token::End, end)]);
            return found;
        }
        found.push((token, offset));
        offset += length;
    }
}

/// Returns the token at the start of the text, and its length.
fn token(rest: &str) -> (Token, usize) {
    let Some(sign) = rest.chars().next() else { return (Token::End, 0) };
    let broken = |flaw: PictFlaw| (Token::Broken(flaw), 0);
    if sign.is_alphabetic() || sign == '_' {
        let word = &rest[..rest.find(|sign: char| !sign.is_alphanumeric() && sign != '_').unwrap_or(rest.len())];
        return (Token::Word(word.to_owned()), word.len());
    }
    if sign == '[' || sign == '"' {
        let close = if sign == '[' { ']' } else { '"' };
        return match enclosed(rest, close) {
            Some((_, length)) if let Some(sign) = wrong_escape(&rest[..length]) => broken(PictFlaw::Escape { sign }),
            Some((name, length)) if sign == '[' => (Token::Name(name), length),
            Some((word, length)) => (Token::Text(word), length),
            None => broken(PictFlaw::Open { close }),
        };
    }
    if sign.is_ascii_digit() || matches!(sign, '-' | '+' | '.') {
        return match number(rest) {
            (written, Some(number)) => (Token::Number(number), written.len()),
            (written, None) => broken(PictFlaw::NoNumber { written: written.to_owned() }),
        };
    }
    if sign == '#' {
        return broken(PictFlaw::LateComment);
    }
    if let Some((foreign, meant)) = FOREIGN.into_iter().find(|(foreign, _)| rest.starts_with(foreign)) {
        return broken(PictFlaw::Foreign { sign: foreign, meant });
    }
    match SIGNS.into_iter().find(|sign| rest.starts_with(sign)) {
        Some(sign) => (Token::Sign(sign), sign.len()),
        None => broken(PictFlaw::UnknownSign { sign }),
    }
}

/// Returns the first character after a backslash that needs no backslash. PICT refuses such texts.
fn wrong_escape(text: &str) -> Option<char> {
    let mut characters = text.chars();
    while characters.any(|c| c == '\\') {
        let escaped = characters.next()?;
        if !matches!(escaped, '\\' | '"' | ']') {
            return Some(escaped);
        }
    }
    None
}

/// Returns the text of the number at the start, and its value if the text is a finite number.
fn number(text: &str) -> (&str, Option<f64>) {
    let mut last = ' ';
    let ends = |sign: char| {
        let exponent = matches!(last, 'e' | 'E') && matches!(sign, '-' | '+');
        let belongs = last == ' ' || sign.is_alphanumeric() || sign == '.' || exponent;
        last = sign;
        !belongs
    };
    let written = &text[..text.find(ends).unwrap_or(text.len())];
    (written, written.parse().ok().filter(|number: &f64| number.is_finite()))
}
