//! Reads the CSV files from which figures are drawn.

use flate2::read::GzDecoder;
use std::io::Read;

/// A table with named columns.
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// A row of a table.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    table: &'a Table,
    cells: &'a [String],
}

impl Table {
    /// Reads the text of a CSV file. A file that is compressed with gzip is read, too.
    pub fn read(file: &[u8]) -> csv::Result<Self> {
        let mut unpacked = Vec::new();
        let plain = if GzDecoder::new(file).read_to_end(&mut unpacked).is_ok() { &unpacked } else { file };
        let mut csv = csv::Reader::from_reader(plain);
        let names = csv.headers()?.iter().map(str::to_owned).collect();
        let rows = csv.records().map(|row| Ok(row?.iter().map(str::to_owned).collect())).collect::<csv::Result<_>>()?;
        Ok(Self { names, rows })
    }

    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { table: self, cells })
    }

    /// Returns the different words of a column, in the order of the rows.
    pub fn different(&self, column: &str) -> Vec<&str> {
        let mut words = Vec::new();
        for row in self.rows() {
            if !words.contains(&row.word(column)) {
                words.push(row.word(column));
            }
        }
        words
    }
}

impl<'a> Row<'a> {
    /// Returns the word in a column.
    ///
    /// # Panics
    /// The table has no such column.
    pub fn word(self, column: &str) -> &'a str {
        let place = self.table.names.iter().position(|name| name == column);
        &self.cells[place.unwrap_or_else(|| panic!("no column {column}"))]
    }

    /// Returns the number in a column, or NaN if the cell has no number.
    pub fn number(self, column: &str) -> f64 {
        self.word(column).parse().unwrap_or(f64::NAN)
    }
}
