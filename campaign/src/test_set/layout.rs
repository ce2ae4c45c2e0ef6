//! Finds the columns of a file of tests, and how the file separates and names them.
//!
//! Other programs write points in two ways. Spreadsheets, pandas and PICT write a header. `numpy.savetxt` and MATLAB write numbers only,
//! mostly between spaces, and `numpy.savetxt` writes a header as a comment.

use std::io::{self, BufRead, BufReader, Read};

/// The greatest number of comments before the first numbers.
const MOST_COMMENTS: usize = 1000;

/// The beginning of a line with a comment, as `numpy.savetxt` writes it.
const COMMENT: char = '#';

/// The bytes with which a file in UTF-8 may begin.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// The way in which a file of tests separates and names its columns.
pub(super) enum Layout {
    /// The file has neither tests nor names of columns.
    Empty,
    /// The first line names the columns.
    Header {
        /// The byte between two columns. Files of PICT have tabs, and no quotes.
        separator: u8,
    },
    /// The file has numbers and comments only.
    Numbers {
        /// The cells of the first line of numbers.
        first: Vec<String>,
        /// True if spaces or tabs separate the columns, and false if commas do.
        is_spaced: bool,
        /// The words of each comment before the numbers.
        comments: Vec<Vec<String>>,
    },
}

impl Layout {
    /// Reads the beginning of a file, and returns the layout with the whole file.
    pub fn of(source: impl Read + 'static) -> io::Result<(Self, impl BufRead)> {
        let mut source = BufReader::new(source);
        let mut begin = Vec::new();
        let (mut last, mut comments, mut is_over) = (0, Vec::new(), false);
        for _ in 0..=MOST_COMMENTS {
            last = begin.len();
            is_over = source.read_until(b'\n', &mut begin)? == 0;
            if last == 0 && begin.starts_with(MARK) {
                begin.drain(..MARK.len());
            }
            match String::from_utf8_lossy(&begin[last..]).trim() {
                line if line.starts_with(COMMENT) => comments.push(words(&line[1..])),
                "" if !is_over => {}
                _ => break,
            }
        }
        let layout = match numbers(&begin[last..]) {
            _ if is_over => Self::Empty,
            Some((first, is_spaced)) => Self::Numbers { first, is_spaced, comments },
            None => {
                let first = begin.split(|byte| *byte == b'\n').next().unwrap_or_default();
                let has_tabs = first.contains(&b'\t') && !first.contains(&b',');
                Self::Header { separator: if has_tabs { b'\t' } else { b',' } }
            }
        };
        Ok((layout, io::Cursor::new(begin).chain(source)))
    }

    /// Returns a reader of the records. The header is the first record, if there is one.
    pub fn reader(&self, source: impl BufRead + 'static) -> csv::Reader<Box<dyn Read>> {
        let mut builder = csv::ReaderBuilder::new();
        match self {
            Self::Empty | Self::Header { .. } => builder.trim(csv::Trim::Headers),
            Self::Numbers { .. } => builder.has_headers(false).comment(Some(COMMENT as u8)).trim(csv::Trim::All),
        };
        if let Self::Header { separator: separator @ b'\t' } = self {
            builder.delimiter(*separator).quoting(false);
        }
        match self {
            Self::Numbers { is_spaced: true, .. } => {
                builder.from_reader(Box::new(Spaced { source, line: io::Cursor::default() }))
            }
            _ => builder.from_reader(Box::new(source)),
        }
    }
}

/// Returns the cells of a line of numbers, and whether the line has no commas; `None` if something in the line is not a number.
fn numbers(line: &[u8]) -> Option<(Vec<String>, bool)> {
    let line = std::str::from_utf8(line).ok()?;
    let is_spaced = !line.contains(',');
    let cells: Vec<&str> =
        if is_spaced { line.split_whitespace().collect() } else { line.split(',').map(str::trim).collect() };
    let cells: Vec<String> = cells.into_iter().map(|cell| cell.trim_matches('"').to_owned()).collect();
    (!cells.is_empty() && cells.iter().all(|cell| cell.parse::<f64>().is_ok())).then_some((cells, is_spaced))
}

/// Returns the words of a comment, without units in brackets. Commas separate words, or spaces if there are no commas.
fn words(comment: &str) -> Vec<String> {
    let word = |text: &str| text.split(['[', '(']).next().unwrap_or_default().trim().to_owned();
    let all: Vec<&str> =
        if comment.contains(',') { comment.split(',').collect() } else { comment.split_whitespace().collect() };
    all.into_iter().map(word).filter(|word| !word.is_empty()).collect()
}

/// Text whose columns are separated by spaces or tabs, read as text with one comma between two columns.
struct Spaced<R> {
    source: R,
    line: io::Cursor<Vec<u8>>,
}

impl<R: BufRead> Read for Spaced<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.line.position() == self.line.get_ref().len() as u64 {
            let mut line = Vec::new();
            if self.source.read_until(b'\n', &mut line)? == 0 {
                return Ok(0);
            }
            let cells: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty()).collect();
            let mut line = cells.join(&b',');
            line.push(b'\n');
            self.line = io::Cursor::new(line);
        }
        self.line.read(buffer)
    }
}
