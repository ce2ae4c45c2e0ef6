//! Reads the CSV files of studies.

use flate2::read::GzDecoder;
use std::collections::BTreeMap;
use std::io::Read;

/// A row of a CSV: the cells by the names of their columns.
pub type Row = BTreeMap<&'static str, &'static str>;

/// Returns the rows of a CSV file, which may be compressed with gzip. Their texts last as long as the test.
pub fn rows(file: &[u8]) -> Vec<Row> {
    let mut unpacked = Vec::new();
    let plain = if GzDecoder::new(file).read_to_end(&mut unpacked).is_ok() { &unpacked } else { file };
    let mut csv = csv::Reader::from_reader(plain);
    let cells = |record: &csv::StringRecord| record.iter().map(|cell| &*cell.to_owned().leak()).collect::<Vec<&str>>();
    let names = cells(csv.headers().unwrap());
    csv.records().map(|record| names.iter().copied().zip(cells(&record.unwrap())).collect()).collect()
}

/// Returns the number in a column.
///
/// # Panics
/// The cell is no number.
pub fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?} is no number"))
}

/// Returns the different values of a column, in the order of the rows.
pub fn different(rows: &[Row], column: &str) -> Vec<&'static str> {
    let mut values = Vec::new();
    for row in rows {
        if !values.contains(&row[column]) {
            values.push(row[column]);
        }
    }
    values
}

/// Returns how many rows satisfy a condition.
pub fn count(rows: &[Row], condition: impl Fn(&Row) -> bool) -> usize {
    rows.iter().filter(|row| condition(row)).count()
}

/// Returns the mean of numbers.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the least and the greatest of some numbers.
pub fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    values
        .into_iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
}

/// Returns the visibility in a density of fog, in two digits that count, such as `1.4 km` (docs/cameras.md has the formula).
pub fn visibility(fog: f64) -> String {
    let metres = 9990.0 / (libm::pow(1000.0, fog) - 1.0);
    if metres < 1000.0 { format!("{} m", 10.0 * (metres / 10.0).round()) } else { format!("{:.1} km", metres / 1000.0) }
}

/// Returns the numbers of a column in the rows that satisfy a condition.
pub fn numbers_of(rows: &[Row], column: &str, condition: impl Fn(&Row) -> bool) -> Vec<f64> {
    rows.iter().filter(|row| condition(row)).map(|row| number(row, column)).collect()
}
