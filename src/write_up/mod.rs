//! What studies of strategies have in common when they are written up: numbers, tables, pictures, and the folder they go to.

pub(crate) mod latex;
mod look;

pub(crate) use look::look;

use crate::Error;
use crate::folder::write_whole;
use crate::plot::Picture;
use std::fs;
use std::path::Path;

/// With how many pairs tests and intervals have enough power; fewer are remarked upon.
pub(crate) const ENOUGH_SEEDS: usize = 30;

/// A number with three significant digits.
pub(crate) fn three_digits(number: f64) -> String {
    let scientific = format!("{number:.2e}");
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return scientific;
    }
    format!("{number:.*}", (2 - exponent).max(0) as usize)
}

/// A p-value in a table.
pub(crate) fn p_value(p: f64) -> String {
    if p < 0.001 { format!("{p:.1e}") } else { format!("{p:.3}") }
}

/// Checks a list that a user gave.
pub(crate) fn each_once(of: &str, names: impl Iterator<Item = String>) -> Result<(), Error> {
    let names: Vec<String> = names.collect();
    if names.is_empty() {
        return Err(Error::Usage(format!("the list of {of} is empty")));
    }
    let twice = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name));
    twice.map_or(Ok(()), |(_, name)| Err(Error::Usage(format!("{name} is twice among the {of}"))))
}

/// Checks that there are seeds enough to compare, and that none is too large.
pub(crate) fn check_seeds(seeds: usize, first: u64) -> Result<(), Error> {
    if seeds < 2 {
        return Err(Error::Usage(format!(
            "the number of seeds is {seeds}, expected at least 2, or better {ENOUGH_SEEDS}"
        )));
    }
    if first.checked_add(seeds as u64 - 1).is_none() {
        return Err(Error::Usage(format!("{seeds} seeds from {first} on go beyond {}", u64::MAX)));
    }
    Ok(())
}

/// What a reader should know where there are few seeds.
pub(crate) fn few_seeds(seeds: usize) -> Option<String> {
    (seeds < ENOUGH_SEEDS).then(|| format!("{seeds} seeds are few; from {ENOUGH_SEEDS} on the tests have enough power"))
}

/// Makes a folder for a study, if need be.
///
/// # Errors
/// It cannot be made, or has something in it.
pub(crate) fn new_folder(path: &Path) -> Result<(), Error> {
    make_folder(path)?;
    let mut there = fs::read_dir(path).map_err(Error::file("read", path))?;
    match there.next() {
        None => Ok(()),
        Some(_) => Err(Error::Usage(format!("{} is not empty: write elsewhere", path.display()))),
    }
}

/// Makes a folder, if need be.
///
/// # Errors
/// It cannot be made.
pub(crate) fn make_folder(path: &Path) -> Result<(), Error> {
    if path.exists() && !path.is_dir() {
        return Err(Error::Usage(format!("{} is a file, expected a folder to write to", path.display())));
    }
    fs::create_dir_all(path).map_err(Error::file("create", path))
}

/// Writes rows, the first of which is the header.
pub(crate) fn write_csv(path: &Path, rows: &[Vec<String>]) -> Result<(), Error> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    rows.iter().for_each(|row| csv.write_record(row).expect("rows of one length fit into memory"));
    write_whole(path, &csv.into_inner().expect("memory does not fail to flush"))
}

/// A value, or an empty field.
pub(crate) fn maybe(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Writes pictures, each as `NAME.svg` and `NAME.png`.
pub(crate) fn write_pictures(folder: &Path, pictures: &[(String, Picture)]) -> Result<(), Error> {
    for (name, picture) in pictures {
        let (svg, png) = (folder.join(format!("{name}.svg")), folder.join(format!("{name}.png")));
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |error: Box<dyn std::error::Error + Send + Sync>| Error::Picture { path, message: error.to_string() }
        };
        write_whole(&svg, picture.svg().map_err(failed(&svg))?.as_bytes())?;
        write_whole(&png, &picture.png().map_err(failed(&png))?)?;
    }
    Ok(())
}
