//! Words that the tables, pictures and reports of a campaign can show without harm.

use thiserror::Error;

/// The reason why a name or a value cannot stand in tables, pictures and reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum WordFlaw {
    /// The word has a control character other than a tab. Pictures and reports cannot show the character.
    #[error("has the control character {0:?}, expected printable text")]
    Control(char),
    /// A spreadsheet that opens the table of the tests would compute the word as a formula.
    #[error("is a formula that a spreadsheet would compute, expected a name or a value")]
    Formula,
}

/// Returns the reason why a word cannot stand in tables, pictures and reports; `None` if it can. Formulas of
/// spreadsheets begin with `=`, `+`, `-` or `@`. A formula that does more than add up cells calls a function, names
/// another program or another sheet: with `(`, `|` or `!`. So `-O2` and `@home` are ordinary words.
pub fn word_flaw(word: &str) -> Option<WordFlaw> {
    if let Some(character) = word.chars().find(|character| character.is_control() && *character != '\t') {
        return Some(WordFlaw::Control(character));
    }
    let is_formula = word.trim_start().starts_with(['=', '+', '-', '@']) && word.contains(['(', '|', '!']);
    is_formula.then_some(WordFlaw::Formula)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_a_spreadsheet_would_compute_are_found() {
        for word in ["=HYPERLINK(\"http://x\")", "=cmd|' /C calc'!A0", "@SUM(1)", "-1+[1]x!A1", " +f(1)"] {
            assert_eq!(word_flaw(word), Some(WordFlaw::Formula), "{word}");
        }
        for word in ["=", "-O2", "+5", "@home", "a=f(x)", "100 % (wet)", "", "é 東"] {
            assert_eq!(word_flaw(word), None, "{word}");
        }
        assert_eq!(word_flaw("a\u{7}b"), Some(WordFlaw::Control('\u{7}')));
        assert_eq!(word_flaw("a\tb"), None);
    }
}
