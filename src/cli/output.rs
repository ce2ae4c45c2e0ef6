//! Prints results: as a table for people, as JSON for programs.

use super::arguments::OUTPUT;
use crate::coverage::Bracket;
use crate::space::{Domain, Point, Record, Space, Value};
pub(super) use crate::space::{digits, plural};
use clap::{Args, ValueEnum};
use paracosm_analysis::Impacts;
use paracosm_analysis::estimate::{Continuous, Coverage, Discrete, KEpsilon, Measured, Strength};
use std::fmt::Write;

/// The form of a printed result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum Format {
    /// For people
    #[default]
    Table,
    /// For programs
    Json,
}

/// The option that chooses the form of a printed result.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct FormatOption {
    /// The form of the result
    #[arg(long, value_enum, value_name = "table|json", default_value_t, hide_possible_values = true, help_heading = OUTPUT)]
    pub format: Format,
}

/// Returns a value as indented JSON.
pub(super) fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("results are always JSON");
    text.push('\n');
    text
}

/// Describes the tests of a source that break a constraint, with the first of these constraints; `None` if all keep them.
pub(super) fn broken(space: &Space, tests: &[Point], source: &str) -> Option<String> {
    let broken = tests.iter().enumerate().filter_map(|(at, test)| Some((at, space.broken(test)?.text())));
    broken_words(&broken.collect::<Vec<_>>(), tests.len(), source)
}

/// Says how many of the tests of a source break a constraint, from the position of each such test with the constraint.
pub(super) fn broken_words(broken: &[(usize, &str)], tests: usize, source: &str) -> Option<String> {
    let (first, constraint) = broken.first()?;
    let count = broken.len();
    let (cover, count, first) = (if count == 1 { "covers" } else { "cover" }, plural(count, "test"), first + 1);
    Some(format!("{count} of the {tests} in {source} {cover} nothing: test {first} breaks `{constraint}`"))
}

/// A table with names on the left and values on the right.
#[derive(Default)]
pub(super) struct Table {
    lines: Vec<Line>,
}

enum Line {
    Text(String),
    Row(String, String),
}

/// The column at which values begin, if no name is longer.
const LABEL: usize = 22;

impl Table {
    pub fn heading(&mut self, text: &str) {
        self.lines.push(Line::Text(text.to_owned()));
    }

    pub fn row(&mut self, label: &str, value: &str) {
        self.lines.push(Line::Row(label.to_owned(), value.to_owned()));
    }

    /// Adds a line of text that does not use the table's columns.
    pub fn line(&mut self, text: &str) {
        self.lines.push(Line::Text(format!("  {text}")));
    }

    pub fn finish(self) -> String {
        let labels = self.lines.iter().map(|line| match line {
            Line::Text(_) => 0,
            Line::Row(label, _) => label.chars().count() + 1,
        });
        let width = column(labels.fold(LABEL, usize::max));
        let mut text = String::new();
        for line in &self.lines {
            let _ = match line {
                Line::Text(line) => writeln!(text, "{line}"),
                Line::Row(label, value) => writeln!(text, "  {label:<width$}{value}"),
            };
        }
        text
    }

    /// Adds the rows of a coverage report.
    pub fn coverage(&mut self, coverage: &Coverage) {
        let is_part = coverage.continuous.as_ref().is_some_and(|continuous| continuous.valid_share.is_some());
        let bracket = |found: &Bracket| if is_part { bracket_of_part(found) } else { bracket(found) };
        if let Some(continuous) = &coverage.continuous {
            self.continuous(continuous, coverage.tests);
        }
        if let Some(Some(discrete)) = &coverage.discrete {
            self.discrete(discrete);
        }
        if coverage.violating > 0 {
            let tests = plural(coverage.violating, "test");
            self.row("violate constraints", &format!("{tests}; these tests cover nothing"));
        }
        if let Some(KEpsilon { k, complete, epsilon_over_covered_rows, epsilon_at_least, .. }) = &coverage.k_epsilon {
            let worst = Bracket { lower: *epsilon_at_least, upper: *epsilon_over_covered_rows };
            let value = match (complete, worst.is_exact()) {
                (true, true) => format!("({k}, {})-covering", digits(worst.upper)),
                (true, false) => {
                    format!("({k}, {})-covering, perhaps better: {}", digits(worst.upper), bracket(&worst))
                }
                (false, _) => format!("no: {k}-wise incomplete; epsilon over the covered rows {}", bracket(&worst)),
            };
            self.row("(k, epsilon)", &value);
        }
        if let Some(hole) = &coverage.k_wise_dispersion {
            self.row(&format!("{}-wise dispersion", hole.k), &bracket(&hole.volume));
            if hole.volume.upper == 0.0 {
                return;
            }
            let fixed = hole.worst.fixed.iter().map(|(name, value)| format!("{name} {value}"));
            let place: Vec<String> = fixed.chain(hole.worst.empty_box.iter().map(side)).collect();
            self.row("  largest hole", &place.join(", "));
        }
    }

    fn continuous(&mut self, measured: &Continuous, tests: usize) {
        if let Some(share) = &measured.valid_share {
            self.row("valid share", &format!("{} of the box of the continuous parameters", short_bracket(share)));
        }
        for (measure, result) in &measured.measured {
            let label = measure.descriptor().label;
            match result {
                Measured::Number(number) => {
                    let why = if tests == 0 { "no tests" } else { CUT_SHORT };
                    self.row(label, &number.map_or(format!("unknown: {why}"), digits));
                }
                Measured::Bracket(found) => self.row(label, &bracket(found)),
                Measured::Hole(hole) => {
                    let is_part = measured.valid_share.is_some();
                    self.row(label, &if is_part { bracket_of_part(&hole.volume) } else { bracket(&hole.volume) });
                    let sides: Vec<String> = hole.largest_empty_box.iter().map(side).collect();
                    self.row("  largest empty box", &sides.join(", "));
                }
                Measured::Ball(ball) => {
                    self.row(label, &ball.as_ref().map_or("unknown: no tests".into(), |ball| bracket(&ball.radius)));
                    let place = |(name, value): (&str, &f64)| format!("{name} {}", digits(*value));
                    let centre: Vec<String> = ball.iter().flat_map(|ball| ball.centre.iter()).map(place).collect();
                    if !centre.is_empty() {
                        self.row("  centre of the ball", &centre.join(", "));
                    }
                }
            }
        }
        let measures = measured.measured.iter().map(|(measure, _)| measure);
        let of_the_box = measures.filter(|measure| !measure.is_of_the_valid_part());
        let whole: Vec<&str> = of_the_box.map(|measure| measure.name()).collect();
        if measured.valid_share.is_some() && !whole.is_empty() {
            self.row("  of the whole box", &whole.join(", "));
        }
    }

    /// Adds the rows of the k-wise coverage of discrete parameters.
    pub fn discrete(&mut self, measured: &Discrete) {
        let Discrete { k, covered, valid, ratio, missing, combinations, strengths } = measured;
        self.row(&format!("{k}-wise coverage"), &format!("{covered} of {valid} ({})", percent(*ratio)));
        self.row("  of all combinations", &combinations.map_or("too many to count".into(), percent));
        self.missing(valid - covered, missing);
        for Strength { parameters, k, valid, covered, ratio, missing } in strengths {
            let (share, names) = (percent(*ratio), parameters.join(", "));
            self.row("  of a group", &format!("{covered} of {valid} ({share}), {k}-wise among {names}"));
            self.missing(valid - covered, missing);
        }
    }

    /// Adds rows for combinations that no test contains: the listed combinations, and the number of the others.
    fn missing(&mut self, all: u64, listed: &[Record<Value>]) {
        for (i, tuple) in listed.iter().enumerate() {
            let values: Vec<String> = tuple.iter().map(|(name, value)| format!("{name} {value}")).collect();
            self.row(if i == 0 { "  missing" } else { "" }, &values.join(", "));
        }
        let unlisted = all - listed.len() as u64;
        if unlisted > 0 {
            self.row("", &format!("and {unlisted} more"));
        }
    }
}

/// Describes a side of a box: a parameter with its range.
fn side((name, [lo, hi]): (&str, &[f64; 2])) -> String {
    format!("{name} {}..{}", digits(*lo), digits(*hi))
}

/// The reason why a measure is not exact, with the option that gives the search more time.
const CUT_SHORT: &str = "the limit ended the search; `paracosm-cover estimate --time-limit` sets the limit";

/// Prints an exact value as one number, and a bracket as two numbers.
pub(super) fn bracket(bracket: &Bracket) -> String {
    if bracket.is_exact() {
        digits(bracket.lower)
    } else {
        format!("between {} and {} ({CUT_SHORT})", digits(bracket.lower), digits(bracket.upper))
    }
}

/// Prints the bracket of a measure that counts the valid part of a space.
fn bracket_of_part(found: &Bracket) -> String {
    let reason = if found.is_exact() { "" } else { " (open: edges of the valid part, or the limit)" };
    format!("{}{reason}", short_bracket(found))
}

/// Prints a bracket in little room.
pub(super) fn short_bracket(bracket: &Bracket) -> String {
    if bracket.is_exact() {
        digits(bracket.lower)
    } else {
        format!("{}..{}", digits(bracket.lower), digits(bracket.upper))
    }
}

/// Prints a share in percent with one decimal.
pub(super) fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Says in words how severe the contacts of a campaign are.
pub(super) fn impacts_in_words(Impacts { contacts, median, greatest, index }: &Impacts) -> String {
    let speeds = format!("median {} m/s, at most {} m/s (test {index})", digits(*median), digits(*greatest));
    format!("{speeds}, in {}", plural(*contacts, "contact"))
}

/// Prints the domain of a parameter as `--open` takes it.
pub(super) fn domain_words(domain: &Domain) -> String {
    match domain {
        Domain::Interval { lo, hi } => format!("{lo}..{hi}"),
        Domain::Choice(levels) => levels.iter().map(ToString::to_string).collect::<Vec<_>>().join(","),
    }
}

/// The widest column of a table. A longer cell stands out of its column.
const WIDEST: usize = 100;

/// Returns the width of a column for a longest cell.
pub fn column(longest: usize) -> usize {
    longest.min(WIDEST)
}

/// Prints a value of a parameter, its numbers with five digits. A long list is shortened to its first values and its
/// last value.
pub(super) fn value_words(value: &Value) -> String {
    let scalar = |value: &Value| value.number().map_or_else(|| value.to_string(), digits);
    match value {
        Value::List(values) if values.len() > 8 => {
            let ends =
                [&values[..3], &values[values.len() - 1..]].map(|part| part.iter().map(scalar).collect::<Vec<_>>());
            format!("[{}, .., {}] ({} values)", ends[0].join(", "), ends[1].join(", "), values.len())
        }
        Value::List(values) => format!("[{}]", values.iter().map(scalar).collect::<Vec<_>>().join(", ")),
        value => scalar(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_with_five_digits_and_no_more_than_they_have() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (0.040_509_259, "0.040509"),
            (-12.345_678, "-12.346"),
            (60.0, "60"),
            (123_456.7, "123457"),
            (1.5e-9, "1.5000e-9"),
            (f64::INFINITY, "inf"),
        ];
        for (number, text) in cases {
            assert_eq!(digits(number), text);
        }
    }

    #[test]
    fn values_stand_below_each_other_however_long_the_longest_name_is() {
        let mut table = Table::default();
        table.heading("test 3");
        table.row("speed", "1 m/s");
        assert_eq!(table.finish(), "test 3\n  speed                 1 m/s\n");
        let mut table = Table::default();
        table.row("speed", "1 m/s");
        table.row("critical_time.no-collision", "5.3");
        assert_eq!(table.finish(), "  speed                      1 m/s\n  critical_time.no-collision 5.3\n");
    }
}
