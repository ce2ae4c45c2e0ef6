//! Shows a campaign in Markdown, for the summary of a step in a GitHub workflow.
//!
//! GitHub shows no image in a summary that is not on the web, so the failure map is a grid of coloured squares: it is text, and looks the same in every
//! Markdown viewer. Names and messages come from files of anybody, so every character that Markdown or HTML could read is written as a number.

use crate::html::Finding;
use crate::with_units::with_units;
use crate::{FailureMap, Mark, shell_word};
use paracosm_analysis::{Modes, Plausible, Summary, Worst};
use paracosm_campaign::{Log, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::{digits, plural};
use std::fmt::Write;

/// The columns and rows of the map.
const COLUMNS: usize = 24;
const ROWS: usize = 12;
/// The greatest number of failure modes, and of characters of a text.
const MODES: usize = 5;
const CHARACTERS: usize = 300;

/// The results of a campaign that a summary shows.
#[derive(Debug, Clone)]
pub struct StepSummary<'a> {
    /// The log of the campaign.
    pub log: &'a Log,
    /// The counts of verdicts, and the result of each requirement.
    pub summary: &'a Summary,
    /// The summary of the plausible tests; `None` if all tests are plausible.
    pub plausible: Option<&'a Plausible>,
    /// The failure map; `None` if there is none.
    pub map: Option<&'a FailureMap>,
    /// The failure modes of the campaign.
    pub modes: &'a Modes,
    /// Results in words.
    pub findings: Vec<Finding>,
    /// The folder of the campaign, and the name of the program, for commands.
    pub folder: String,
    /// The name of the program that has the commands.
    pub program: String,
}

impl StepSummary<'_> {
    /// Returns the summary in Markdown.
    pub fn markdown(&self) -> String {
        // A blank line ends the summary of an earlier step.
        let mut text = format!("\n## {}\n\n{}\n\n", escaped(&self.log.study().title()), self.verdict());
        let broken = self.log.trials().iter().find_map(|trial| Some((trial.index, trial.error()?)));
        if let Some((index, error)) = broken {
            let _ = writeln!(text, "First error, test {index}: {}\n", escaped(error));
        }
        let shown = self.shown();
        if let Some((worst, title)) = &shown {
            self.say_worst(&mut text, worst, title);
        }
        if let Some(map) = self.map {
            text.push_str(&grid(map));
        }
        self.say_requirements(&mut text);
        self.say_modes(&mut text);
        for Finding { label, lines, .. } in &self.findings {
            let lines = lines.iter().map(|line| escaped(line)).collect::<Vec<_>>().join("<br>");
            let _ = writeln!(text, "**{label}**: {lines}\n");
        }
        self.say_commands(&mut text, shown.map(|(worst, _)| worst.index));
        text
    }

    /// Returns the result of the campaign in a sentence, with all numbers that it needs.
    fn verdict(&self) -> String {
        let count = |verdict| self.summary.count(verdict);
        let (all, fail, pass) = (self.summary.tests(), count(Verdict::Fail), count(Verdict::Pass));
        let judged = fail + pass + count(Verdict::Unpreventable);
        let share = 100.0 * fail as f64 / all.max(1) as f64;
        let said = match (all, fail, judged) {
            (0, ..) => "⚠️ No test has run".to_owned(),
            (_, 1.., _) => format!("❌ {fail} of {} fail ({share:.1} %), {pass} pass", plural(all, "test")),
            (.., 0) => format!("⚠️ None of {} shows whether it passes", plural(all, "test")),
            _ => {
                // That no test fails says little if tests have no result.
                let sign = if pass == 0 || count(Verdict::Error) > 0 { "⚠️" } else { "✅" };
                format!("{sign} No failure in {}: {pass} pass", plural(all, "test"))
            }
        };
        let others = [Verdict::Unpreventable, Verdict::Inconclusive, Verdict::Invalid, Verdict::Error];
        let others = others.into_iter().filter(|verdict| count(*verdict) > 0);
        let others: String = others.map(|verdict| format!(", {} {verdict}", count(verdict))).collect();
        format!("**{said}{others}.**")
    }

    /// Returns the worst test, or the test nearest to a failure, with its title: a plausible failure comes before a worse one that is not
    /// plausible.
    fn shown(&self) -> Option<(Worst, &'static str)> {
        let scales = self.log.scales();
        let is_failure = |worst: &Worst| self.trial(worst.index).is_some_and(Trial::is_failure);
        if let Some(worst) = self.plausible.and_then(|plausible| plausible.summary.worst(scales)).filter(is_failure) {
            return Some((worst, "Worst plausible failure"));
        }
        let worst = self.summary.worst(scales)?;
        let title = match (is_failure(&worst), self.plausible.is_some()) {
            (true, false) => "Worst failure",
            (true, true) => "Worst failure, not plausible",
            (false, _) => "Nearest to a failure",
        };
        Some((worst, title))
    }

    fn say_worst(&self, text: &mut String, worst: &Worst, title: &str) {
        let Some(trial) = self.trial(worst.index) else { return };
        let study = self.log.study();
        let unit = study.requirement(&worst.requirement).map_or("", |stated| stated.unit.as_str());
        let robustness = trial.robustness(&worst.requirement).map_or("undecided".to_owned(), digits);
        let _ = writeln!(
            text,
            "**{title}**: test {}, {}. {}\n",
            worst.index,
            escaped(format!("{} {robustness} {unit}", worst.requirement).trim_end()),
            escaped(&with_units(study, &trial.test)),
        );
    }

    fn trial(&self, index: usize) -> Option<&Trial> {
        self.log.trials().get(index)
    }

    fn say_requirements(&self, text: &mut String) {
        if self.summary.requirements().is_empty() {
            text.push_str("The campaign has no requirement.\n\n");
            return;
        }
        text.push_str("| requirement | violated | undecided | least robustness |\n| --- | ---: | ---: | --- |\n");
        for judged in self.summary.requirements() {
            let unit = self.log.study().requirement(&judged.id).map_or("", |stated| stated.unit.as_str());
            let worst = judged.worst.map(|(robustness, index)| {
                let robustness = format!("{} {unit}", digits(robustness));
                format!("{} in test {index}", escaped(robustness.trim_end()))
            });
            let (id, worst) = (escaped(&judged.id), worst.unwrap_or_default());
            let _ = writeln!(text, "| {id} | {} | {} | {worst} |", judged.violated, judged.undecided);
        }
        text.push('\n');
    }

    fn say_modes(&self, text: &mut String) {
        let Modes { failures, modes } = self.modes;
        if modes.is_empty() {
            return;
        }
        text.push_str("| failure mode | tests | typical | worst |\n| --- | ---: | ---: | ---: |\n");
        for mode in modes.iter().take(MODES) {
            let (words, typical, worst) = (escaped(&mode.words), mode.representative, mode.worst);
            let _ = writeln!(text, "| {words} | {} of {failures} | test {typical} | test {worst} |", mode.count);
        }
        if let Some(more) = modes.len().checked_sub(MODES).filter(|more| *more > 0) {
            let _ = writeln!(text, "\nand {}", plural(more, "further failure mode"));
        }
        text.push('\n');
    }

    fn say_commands(&self, text: &mut String, shown: Option<usize>) {
        let (program, folder) = (shell_word(&self.program), shell_word(&self.folder));
        let mut commands = format!("{program} report {folder} --out report.html\n");
        if let Some(index) = shown {
            let _ = writeln!(commands, "{program} replay {folder} {index}");
        }
        let _ = writeln!(commands, "{program} repeat {folder}");
        // A block ends only at a fence that is as long as its own.
        let longest = commands.split(|c| c != '`').map(str::len).max().unwrap_or_default();
        let fence = "`".repeat(longest.max(2) + 1);
        let hash = self.log.hash().map(|hash| format!("Study {}. ", escaped(hash))).unwrap_or_default();
        let _ = write!(text, "{hash}To see a test, and to repeat the campaign:\n\n{fence}sh\n{commands}{fence}\n");
    }
}

/// The content of a square of the map, the least telling first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Square {
    Never,
    Pass,
    Unjudged,
    Unpreventable,
    Fail,
}

impl Square {
    /// All squares, in the order of the legend.
    const ALL: [Self; 5] = [Self::Fail, Self::Unpreventable, Self::Unjudged, Self::Pass, Self::Never];

    fn of(mark: Mark) -> Self {
        match mark {
            Mark::Verdict(Verdict::Pass) => Self::Pass,
            Mark::Verdict(Verdict::Unpreventable) => Self::Unpreventable,
            Mark::Verdict(Verdict::Fail) | Mark::Fault(_) => Self::Fail,
            Mark::Verdict(Verdict::Inconclusive | Verdict::Invalid | Verdict::Error) => Self::Unjudged,
        }
    }

    /// Returns the sign of the square. Red and blue differ for every colour vision, and the others have another shape.
    fn sign(self) -> char {
        match self {
            Self::Never => '⬜',
            Self::Pass => '🟦',
            Self::Unjudged => '🟡',
            Self::Unpreventable => '🔶',
            Self::Fail => '🟥',
        }
    }

    fn meaning(self) -> &'static str {
        match self {
            Self::Never => "never tested",
            Self::Pass => "all tests pass",
            Self::Unjudged => "a test without a verdict, and no failure",
            Self::Unpreventable => "an unpreventable violation, and no failure",
            Self::Fail => "a test fails",
        }
    }
}

/// Returns the map as squares, with its axes and its legend.
fn grid(map: &FailureMap) -> String {
    let mut squares = [[Square::Never; COLUMNS]; ROWS];
    let place = |value: f64, (least, greatest): (f64, f64), count: usize| {
        (((value - least) / (greatest - least) * count as f64) as usize).min(count - 1)
    };
    for (x, y, mark) in &map.marks {
        // The least y is in the lowest row.
        let row = ROWS - 1 - place(*y, map.y.range, ROWS);
        let square = &mut squares[row][place(*x, map.x.range, COLUMNS)];
        *square = Square::of(*mark).max(*square);
    }
    let ends = [map.y.range.1, map.y.range.0].map(digits);
    let width = ends.iter().map(String::len).max().unwrap_or_default();
    let mut text = String::from("<pre>\n");
    for (row, line) in squares.iter().enumerate() {
        let label = match row {
            0 => &ends[0],
            row if row == ROWS - 1 => &ends[1],
            _ => "",
        };
        let line: String = line.iter().map(|square| square.sign()).collect();
        let _ = writeln!(text, "{label:>width$} {line}");
    }
    let [x, y] = [&map.x, &map.y].map(|axis| {
        let (least, greatest) = axis.range;
        format!("{} from {} to {}", escaped(&axis.label), digits(least), digits(greatest))
    });
    let is_there = |square: &Square| squares.iter().flatten().any(|other| other == square);
    let legend =
        Square::ALL.into_iter().filter(is_there).map(|square| format!("{} {}", square.sign(), square.meaning()));
    let legend = legend.collect::<Vec<_>>().join(", ");
    let _ = writeln!(text, "</pre>\n\nTo the right: {x}. Upwards: {y}.<br>{legend}\n");
    text
}

/// Returns a text in which neither Markdown nor HTML finds a sign of its own: each such character is written as a number. A long text is cut,
/// and signs that cannot be seen are left out.
fn escaped(text: &str) -> String {
    let is_hidden = |c: char| {
        c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
    };
    let mut escaped = String::new();
    let mut characters = text.chars().take(CHARACTERS).peekable();
    while let Some(c) = characters.next() {
        match c {
            // A dot makes a link only before a letter.
            '.' if characters.peek().is_none_or(|next| !next.is_alphabetic()) => escaped.push(c),
            '\n' | '\t' => escaped.push(' '),
            c if is_hidden(c) => {}
            ' ' | ',' | '%' | '(' | ')' | '/' | ';' | '-' | '+' | '=' => escaped.push(c),
            c if c.is_ascii_punctuation() => {
                let _ = write!(escaped, "&#{};", u32::from(c));
            }
            c => escaped.push(c),
        }
    }
    if text.chars().nth(CHARACTERS).is_some() {
        escaped.push('…');
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_markdown_and_html_are_numbers_and_hidden_signs_are_left_out() {
        assert_eq!(escaped("a|b <b>`c`\n*d*"), "a&#124;b &#60;b&#62;&#96;c&#96; &#42;d&#42;");
        assert_eq!(escaped("-1.5 m at www.example.com."), "-1.5 m at www&#46;example&#46;com.");
        assert_eq!(escaped("safe\u{202e}\u{0}name"), "safename");
        assert_eq!(escaped(&"x".repeat(10_000)).chars().count(), CHARACTERS + 1);
    }
}
