//! Strategies on the command line that are sets of points in files: `mine=folder/*.csv`.

use super::usage;
use crate::generators::{Look, PointSets, Strategy};
use crate::space::Point;
use paracosm_campaign::{Error, TestSet};
use std::fmt;
use std::path::{Path, PathBuf};

/// Reads the strategies of a list. `strategy` reads the name of a strategy that comes with the software. `targets` has the names of the
/// continuous coordinates of each target: if a file names its columns, the columns take the order of these names.
///
/// # Errors
/// A name is unknown, or a file does not hold points in the unit cube, or a target has other names than the columns of a file.
pub(super) fn strategies(
    names: &[String],
    targets: &[Vec<String>],
    strategy: impl Fn(&str) -> Result<Strategy, Error>,
) -> Result<Vec<Strategy>, Error> {
    let mut looks = Look::OTHERS.into_iter().cycle();
    let mut one = |name: &String| match name.split_once('=') {
        None => strategy(name),
        Some((name, _)) if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c)) => {
            Err(usage(format!(
                "--strategies: found the name `{name}` for files, expected letters, digits, `-` and `_`"
            )))
        }
        Some((name, _)) if name.parse::<Strategy>().is_ok() => Err(usage(format!(
            "--strategies: a strategy is called `{name}` already; choose another name for the files"
        ))),
        Some((name, files)) => {
            Ok(Strategy::of_sets(name, looks.next().expect("they go on"), read(name, files, targets)?))
        }
    };
    names.iter().map(&mut one).collect()
}

/// Reads the sets of points in the files of a pattern, in the order of their names.
fn read(name: &str, pattern: &str, targets: &[Vec<String>]) -> Result<PointSets, Error> {
    let wrong = |why: String| usage(format!("--strategies {name}={pattern}: {why}"));
    let files = glob::glob(pattern).map_err(|error| wrong(error.to_string()))?;
    let mut files: Vec<PathBuf> = files.collect::<Result<_, _>>().map_err(|error| wrong(error.to_string()))?;
    files.retain(|path| path.is_file());
    files.sort();
    if files.is_empty() {
        let hint = match pattern {
            folder if Path::new(folder).is_dir() => ", expected files, for example FOLDER/*.csv",
            part if part.contains(['{', '}']) => "; a pattern has `*` and `?`, and no comma",
            _ => "",
        };
        return Err(wrong(format!("found no file{hint}")));
    }
    let mut sets = PointSets::default();
    for file in &files {
        let tests = TestSet::read_points(file)?;
        if tests.points.is_empty() {
            return Err(wrong(format!("{} has no points", file.display())));
        }
        sets.add(match order(&tests, targets).map_err(|why| wrong(format!("{}: {why}", file.display())))? {
            None => tests.points,
            Some(order) => tests.points.iter().map(|point| in_order(point, &order)).collect(),
        });
    }
    Ok(sets)
}

/// Returns the columns of a file in the order of the targets; `None` if they have this order already, or if the file or all targets of this
/// size have no names but `x1`, `x2` and so on. The error has the names that are expected.
fn order(tests: &TestSet, targets: &[Vec<String>]) -> Result<Option<Vec<usize>>, Expected> {
    let columns: Vec<String> = tests.space.coordinates().map(|coordinate| coordinate.name()).collect();
    let is_named = |names: &[String]| names.iter().enumerate().any(|(at, name)| *name != format!("x{}", at + 1));
    let named = targets.iter().filter(|target| target.len() == columns.len() && is_named(target));
    let of_size: Vec<&Vec<String>> = named.collect();
    if !is_named(&columns) || of_size.is_empty() {
        return Ok(None);
    }
    let place = |name: &String| columns.iter().position(|column| column == name);
    let orders: Option<Vec<Vec<usize>>> = of_size.iter().map(|target| target.iter().map(place).collect()).collect();
    match orders {
        Some(mut orders) if orders.iter().all(|order| *order == orders[0]) => {
            let order = orders.swap_remove(0);
            Ok((!order.is_sorted()).then_some(order))
        }
        _ => Err(Expected(columns, of_size.into_iter().cloned().collect())),
    }
}

/// The columns of a file, and the names that the targets have for them.
struct Expected(Vec<String>, Vec<Vec<String>>);

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(columns, targets) = self;
        let targets: Vec<String> = targets.iter().map(|target| target.join(", ")).collect();
        let (columns, targets) = (columns.join(", "), targets.join("; and for another target "));
        write!(f, "found the columns {columns}, expected {targets}; or x1, x2 and so on for columns without names")
    }
}

fn in_order(point: &Point, order: &[usize]) -> Point {
    Point { continuous: order.iter().map(|column| point.continuous[*column]).collect(), ..point.clone() }
}
