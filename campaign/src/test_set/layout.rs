//! Finds the columns of a file of tests, and how the file separates and names them.
//!
//! Other programs write points in two ways. Spreadsheets, pandas and PICT write a header. `numpy.savetxt` and MATLAB write numbers only,
//! mostly between spaces, and `numpy.savetxt` writes a header as a comment.

use std::io::{self, BufRead, BufReader, Read};

/// The greatest number of comments before the first numbers.
const MOST_COMMENTS: usize = 1000;

/// The beginning of a line with a comment, as `numpy.savetxt` writes it.
const COMMENT: u8 = b'#';

/// The way in which a file of tests separates and names its columns.
pub(super) enum Layout {
    /// The file has no byte.
    Empty,
    /// The first line names the columns.
    Header {
        /// The byte between two columns. Files of PICT have tabs, and no quotes.
        separator: u8,
    },
    /// The file has numbers and comments only.
    Numbers {
        /// The number of columns.
        columns: usize,
        /// True if spaces or tabs separate the columns, and false if commas do.
        is_spaced: bool,
        /// The words of the last comment before the numbers.
        comment: Vec<String>,
    },
}

impl Layout {
    /// Reads the beginning of a file, and returns the layout with the whole file.
    pub fn of(source: impl Read + 'static) -> io::Result<(Self, impl BufRead)> {
        let mut source = BufReader::new(source);
        let mut begin = Vec::new();
        let mut last = 0;
        let mut comment = 0..0;
        for _ in 0..=MOST_COMMENTS {
            last = begin.len();
            source.read_until(b'\n', &mut begin)?;
            if begin.get(last) != Some(&COMMENT) {
                break;
            }
            comment = last + 1..begin.len();
        }
        let layout = match numbers(&begin[last..]) {
            _ if begin.is_empty() => Self::Empty,
            Some((columns, is_spaced)) => {
                Self::Numbers { columns, is_spaced, comment: words(&String::from_utf8_lossy(&begin[comment])) }
            }
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
            Self::Numbers { .. } => builder.has_headers(false).comment(Some(COMMENT)).trim(csv::Trim::All),
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

/// Returns the number of columns of a line of numbers, and whether the line has no commas; `None` if something in the line is not a number.
fn numbers(line: &[u8]) -> Option<(usize, bool)> {
    let line = std::str::from_utf8(line).ok()?;
    let is_spaced = !line.contains(',');
    let cells: Vec<&str> =
        if is_spaced { line.split_whitespace().collect() } else { line.split(',').map(str::trim).collect() };
    (!cells.is_empty() && cells.iter().all(|cell| cell.parse::<f64>().is_ok())).then_some((cells.len(), is_spaced))
}

/// Returns the words of a comment.
fn words(comment: &str) -> Vec<String> {
    let ends = |c: char| c == ',' || c.is_whitespace();
    comment.split(ends).filter(|word| !word.is_empty()).map(str::to_owned).collect()
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
