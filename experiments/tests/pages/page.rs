//! Holds a page against numbers that a test has computed from files, and finds the numbers on the page that nothing accounts for.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// A page of a study. Each number on it is computed by a test, or given.
pub struct Page {
    name: &'static str,
    /// The page with all its marks.
    old: String,
    /// The page with the computed tables.
    new: String,
    /// The prose: the page without code blocks and computed tables, with one space between words.
    prose: String,
    /// The parts of the prose whose numbers are accounted for.
    told: Vec<Range<usize>>,
    /// The computed tables.
    tables: Vec<String>,
    flaws: Vec<String>,
}

impl Page {
    /// Opens the page with this name, such as `fig9.md`.
    pub fn open(name: &'static str) -> Self {
        let old = fs::read_to_string(path(name)).unwrap();
        let prose = prose(&old);
        Self { name, new: old.clone(), old, prose, told: Vec::new(), tables: Vec::new(), flaws: Vec::new() }
    }

    /// Puts a computed table between its marks `<!-- table: NAME -->` and `<!-- end -->`.
    ///
    /// # Panics
    /// The page has no such marks.
    pub fn table(&mut self, name: &str, table: &str) {
        let begin = format!("<!-- table: {name} -->\n\n");
        let from = self.new.find(&begin).unwrap_or_else(|| panic!("{} has no mark {begin}", self.name)) + begin.len();
        let to = from + self.new[from..].find("\n<!-- end -->").expect("a table ends");
        self.new.replace_range(from..to, table);
        self.tables.push(name.to_owned());
    }

    /// Checks that the prose says this text, whose numbers the test has computed.
    pub fn says(&mut self, text: impl AsRef<str>) {
        let text = text.as_ref().split_whitespace().collect::<Vec<_>>().join(" ");
        // A bare number would account for the same number anywhere.
        assert!(text.len() >= 6, "`{text}` is too short for a statement");
        let found: Vec<usize> = self.prose.match_indices(&text).map(|(at, _)| at).collect();
        if found.is_empty() {
            self.flaws.push(format!("the page does not say `{text}`"));
        }
        self.told.extend(found.into_iter().map(|at| at..at + text.len()));
    }

    /// Declares texts of the page with numbers that do not follow from a file: settings, sources, and statements of others.
    pub fn given(&mut self, texts: &[&str]) {
        texts.iter().for_each(|text| self.says(text));
    }

    /// Declares the first cells of each row of a table, such as statements of the paper. The table has this header.
    ///
    /// # Panics
    /// The page has no such table.
    pub fn given_cells(&mut self, header: &str, cells: usize) {
        let page = self.old.clone();
        let at = page.find(header).unwrap_or_else(|| panic!("{} has no table `{header}`", self.name));
        for row in page[at..].lines().take_while(|line| line.starts_with('|')) {
            let end = row.match_indices('|').nth(cells).map_or(row.len(), |(at, _)| at);
            self.says(&row[..end]);
        }
    }

    /// Checks the tables and sentences, and that every number on the page is computed or given. With UPDATE_GOLDEN=1 it writes the tables.
    ///
    /// # Panics
    /// A table is old, a sentence is missing, or nothing accounts for a number.
    pub fn close(self) {
        let untold = numbers(&self.prose)
            .into_iter()
            .filter(|number| !self.told.iter().any(|told| told.start <= number.start && number.end <= told.end));
        let around = |number: Range<usize>| {
            let from = (0..=number.start.saturating_sub(40)).rev().find(|at| self.prose.is_char_boundary(*at)).unwrap();
            let to =
                (number.end + 30..).find(|at| *at >= self.prose.len() || self.prose.is_char_boundary(*at)).unwrap();
            let text = &self.prose[from..to.min(self.prose.len())];
            format!("nothing accounts for {} in `{text}`", &self.prose[number])
        };
        let marked = self.old.split("<!-- table: ").skip(1).filter_map(|rest| rest.split(" -->").next());
        let empty = marked.filter(|name| !self.tables.iter().any(|table| table == name));
        let empty = empty.map(|name| format!("nothing computes the table `{name}`"));
        let pictures = self.old.split("](figures/").skip(1).filter_map(|rest| rest.split(')').next());
        let absent = pictures.filter(|file| !path("figures").join(file).exists());
        let absent = absent.map(|file| format!("there is no figures/{file}"));
        let odd = (self.prose.matches('`').count() % 2 == 1).then(|| "a backtick has no partner".to_owned());
        let flaws: Vec<String> = self
            .flaws
            .iter()
            .cloned()
            .chain(untold.map(around))
            .chain(self.settled())
            .chain(empty)
            .chain(absent)
            .chain(odd)
            .collect();
        assert!(flaws.is_empty(), "{}:\n{}", self.name, flaws.join("\n"));
    }

    /// Returns what is old in the tables. With UPDATE_GOLDEN=1, writes the tables instead.
    fn settled(&self) -> Option<String> {
        if self.old != self.new && env::var_os("UPDATE_GOLDEN").is_some_and(|update| update == "1") {
            fs::write(path(self.name), &self.new).unwrap();
            return None;
        }
        let changed: Vec<&str> =
            self.new.lines().filter(|line| !self.old.lines().any(|other| other == *line)).collect();
        let is_old = self.old != self.new;
        is_old.then(|| format!("tables are old; with UPDATE_GOLDEN=1 the test writes:\n{}", changed.join("\n")))
    }
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Returns the page without code blocks and computed tables, with one space between words.
fn prose(page: &str) -> String {
    let (mut lines, mut skipped_to): (Vec<&str>, Option<&str>) = (Vec::new(), None);
    for line in page.lines() {
        match skipped_to {
            Some(end) if line.starts_with(end) => skipped_to = None,
            Some(_) => {}
            None if line.starts_with("<!-- table") => skipped_to = Some("<!-- end -->"),
            None if line.starts_with("```") => skipped_to = Some("```"),
            None if line.starts_with("    ") => {}
            None => lines.push(line),
        }
    }
    lines.join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns where numbers are in prose, but for numbers in code, in targets of links, within names such as `R157`, and numbers of figures.
fn numbers(prose: &str) -> Vec<Range<usize>> {
    let (mut numbers, mut is_code, mut is_target) = (Vec::new(), false, false);
    let (mut before, mut until) = (' ', 0);
    for (at, character) in prose.char_indices() {
        match character {
            '`' => is_code = !is_code,
            '(' if before == ']' => is_target = true,
            ')' => is_target = false,
            '0'..='9' if at >= until => {
                let length =
                    prose[at..].find(|c: char| !c.is_ascii_digit() && c != '.' && c != ',').unwrap_or(prose.len() - at);
                let number = prose[at..at + length].trim_end_matches(['.', ',']);
                until = at + number.len();
                let is_name = before.is_alphabetic() || before == '_';
                let is_title = ["Figure ", "Figures ", "Part "].iter().any(|word| prose[..at].ends_with(word));
                if !is_code && !is_target && !is_name && !is_title {
                    numbers.push(at..until);
                }
            }
            _ => {}
        }
        before = character;
    }
    numbers
}

#[test]
fn a_number_in_a_sentence_needs_a_reason_and_a_number_in_code_or_a_name_does_not() {
    let text = prose(
        "Of 1,000 tests,\n12.5 % fail (UN R157, `k 2`).\n\n    run 3\n\n<!-- table: t -->\n\n| 4 |\n<!-- end -->\nSee [5](a6.md), Figure 7.",
    );
    let found: Vec<&str> = numbers(&text).into_iter().map(|number| &text[number]).collect();
    assert_eq!(found, ["1,000", "12.5", "5"]);
}
