//! Colours verdicts in results on a terminal. A sign goes with each colour, for people who do not see it. Pipes and files get neither.

use crate::oracles::Verdict;
use std::io::{self, IsTerminal};

/// Returns true if results are coloured: standard output is a terminal, and the user has not said otherwise (no-color.org).
pub(super) fn is_wanted() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    io::stdout().is_terminal() && !is_set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Returns the sign and the colour of a verdict, as the number of a colour of terminals.
const fn look(verdict: Verdict) -> (char, u8) {
    match verdict {
        Verdict::Pass => ('✓', 32),
        Verdict::Fail => ('✗', 31),
        Verdict::Unpreventable | Verdict::Inconclusive => ('?', 33),
        Verdict::Invalid | Verdict::Error => ('!', 35),
    }
}

/// Colours the rows of verdicts and headings that end in a verdict, such as `test 2: fail`. Nothing moves: the sign of a row stands in its
/// margin.
pub(super) fn painted(text: &str) -> String {
    text.split_inclusive('\n').map(line).collect()
}

fn line(line: &str) -> String {
    let (content, end) = line.strip_suffix('\n').map_or((line, ""), |content| (content, "\n"));
    for verdict in Verdict::ALL {
        let ((sign, colour), word) = (look(verdict), verdict.to_string());
        if let Some(rest) = content.strip_prefix("  ").and_then(|row| row.strip_prefix(word.as_str()))
            && rest.starts_with("  ")
        {
            return format!("\x1b[{colour}m{sign} {word}\x1b[0m{rest}{end}");
        }
        if let Some(before) = content.strip_suffix(word.as_str()).filter(|before| before.ends_with(": ")) {
            return format!("{before}\x1b[{colour}m{sign} {word}\x1b[0m{end}");
        }
    }
    line.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_get_a_colour_and_a_sign_and_everything_else_stays() {
        let text =
            "aeb: 40 tests\n  fail                  5     12.5 %\n  failure modes         3 tests\ntest 2: pass\n";
        let expected = "aeb: 40 tests\n\x1b[31m✗ fail\x1b[0m                  5     12.5 %\n  failure modes         3 tests\n\
                        test 2: \x1b[32m✓ pass\x1b[0m\n";
        assert_eq!(painted(text), expected);
    }
}
