//! Shared parts of the write-ups of benches and comparisons: numbers, tables, pictures, and their folder.

pub mod latex;

use crate::plot::Picture;
use paracosm_campaign::Error;
use paracosm_campaign::files::write_whole;
use paracosm_space::{WordFlaw, word_flaw};
use std::path::Path;

/// Formats a number with three significant digits.
pub fn three_digits(number: f64) -> String {
    let scientific = format!("{number:.2e}");
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return scientific;
    }
    format!("{number:.*}", (2 - exponent).max(0) as usize)
}

/// Formats a p-value for a plain-text table.
pub fn p_value(p: f64) -> String {
    if p < 0.001 { format!("{p:.1e}") } else { format!("{p:.3}") }
}

/// Writes rows of a table as a CSV file, whose first row is the header.
pub fn write_csv(path: &Path, rows: &[Vec<String>]) -> Result<(), Error> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    rows.iter().for_each(|row| csv.write_record(row).expect("rows of one length fit into memory"));
    write_whole(path, &csv.into_inner().expect("memory does not fail to flush"))
}

/// Formats a text for a cell of a table. A text that a spreadsheet would compute as a formula gets a `'` in front,
/// which makes it a text for spreadsheets. The end of a line becomes a space, and
/// other control characters except tabs become the replacement character U+FFFD.
pub fn as_text(text: &str) -> String {
    let printable = |character| match character {
        '\n' => ' ',
        '\t' => '\t',
        _ if char::is_control(character) => char::REPLACEMENT_CHARACTER,
        _ => character,
    };
    let printable: String = text.chars().map(printable).collect();
    if word_flaw(&printable) == Some(WordFlaw::Formula) { format!("'{printable}") } else { printable }
}

/// Formats a value for a table; a missing value gives an empty field.
pub fn maybe(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Writes each picture to a folder, as the files `NAME.svg` and `NAME.png`.
pub fn write_pictures(folder: &Path, pictures: &[(String, Picture)]) -> Result<(), Error> {
    for (name, picture) in pictures {
        let (svg, png) = (folder.join(format!("{name}.svg")), folder.join(format!("{name}.png")));
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| paracosm_campaign::Failure::Drawing { path, source }
        };
        write_whole(&svg, picture.svg().map_err(failed(&svg))?.as_bytes())?;
        write_whole(&png, &picture.png().map_err(failed(&png))?)?;
    }
    Ok(())
}
